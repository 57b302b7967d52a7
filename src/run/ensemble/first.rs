//! When something first happens to each member.

use core::convert::Infallible;

use super::{Ensemble, MemberError, parts};
use crate::body::{Body, Clock, Point};
use crate::events::{Event, EventError, Occurrence};
use crate::flow::{ExactMotion, NoClosedForm};
use crate::method::AnyMethod;
use crate::num::Dd;
use crate::run::{Run, Watch};

/// What first happened to a member; `None` where it did not happen.
type First = Result<Option<Occurrence>, MemberError>;

impl Ensemble {
    /// When `event` first happens to each member along its exact motion, from its start to `end`, s, with a look each `spacing`
    /// s. `event` is made for the body of each member; what [may be missed](crate::events::Events::may_miss) is the same as of
    /// one motion.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::events::Event;
    /// use polhode::Inertia;
    /// use polhode::run::Ensemble;
    /// let mut rackets = Ensemble::new();
    /// for k in 1..=100 {
    ///     let inertia = Inertia::from_moments([1.0, 2.0, 3.0])?;
    ///     let omega = Vector3::new(1e-4 * f64::from(k), 1.0, 0.0);
    ///     rackets.push_omega(&inertia, UnitQuaternion::identity(), omega);
    /// }
    /// let first = rackets.first(|body| Ok(Event::flip(body)), 100.0, 1.0);
    /// let time = |k: usize| Some(first[k].as_ref().ok()?.as_ref()?.time.hi());
    /// assert!(time(0) > time(99)); // the less it is disturbed, the later it turns over
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn first(
        &self,
        event: impl Fn(&Body) -> Result<Event, EventError> + Sync,
        end: f64,
        spacing: f64,
    ) -> Vec<First> {
        self.each_by_itself(0.0, |body, start| {
            let motion = ExactMotion::from_point(body, start).map_err(|error| match error {
                NoClosedForm::State(error) => MemberError::from(error),
                error => error.into(),
            })?;
            let found = motion.events(&[event(body)?.stopping()], 0.0, end, spacing)?.found;
            Ok(found.into_iter().next())
        })
    }

    /// As [`first`](Self::first), along a [`Run`] of each member by `method` and the steps of `clock`, up to the time `end`, s,
    /// with the looks of [`Run::events`].
    pub fn first_by(
        &self,
        method: &dyn AnyMethod,
        clock: Clock,
        event: impl Fn(&Body) -> Result<Event, EventError> + Sync,
        end: f64,
        spacing: f64,
    ) -> Vec<First> {
        self.each_by_itself(clock.start, |body, start| {
            let mut run = Run::from_point(method, body, start.to_f64(), clock)?.watching(Watch::Never);
            let found = run.events(&[event(body)?.stopping()], end, spacing)?.found;
            Ok(found.into_iter().next())
        })
    }

    fn each_by_itself(&self, t: f64, one: impl Fn(&Body, Point<Dd>) -> First + Sync) -> Vec<First> {
        let mut all = Vec::with_capacity(self.len());
        let part = |part: core::ops::Range<usize>| -> Vec<First> {
            part.map(|k| self.member(k, t).and_then(|(body, start)| one(&body, start))).collect()
        };
        let Ok(()) = self.in_parts(parts::of_single(self.len()), part, |part| {
            all.extend(part);
            Ok::<(), Infallible>(())
        });
        all
    }
}
