//! Events along a run.

use super::between::Between;
use super::schedule::Place;
use super::{Run, RunError};
use crate::body::Point;
use crate::events::{Event, EventError, Events, Occurrence, Search, intervals};
use crate::num::Dd;

impl Run {
    /// Goes on until `event` happens or the time `end` (s) comes: what happened, or `None`. The run then stands at the last step
    /// before: asked again, it finds the same. What comes behind it is found by [`events`](Self::events) in one go, or by a
    /// run that starts from the state of the event.
    ///
    /// Two changes of sign within one step may be missed. See [`events`](crate::events).
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::events::Event;
    /// use polhode::{Body, Inertia, Run, method};
    /// let racket = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    /// let start = racket.state(UnitQuaternion::identity(), Vector3::new(1e-3, 1.0, 0.0))?;
    /// let mut run = Run::new(&method("two-turn")?, &racket, &start, 0.01)?;
    /// let first = run.until(&Event::flip(&racket), 100.0)?.ok_or("it flips")?;
    /// assert!((run.sample().time.hi() - first.time.hi()).abs() < 0.01);
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`advance_to`](Self::advance_to), and as [`events`](Self::events).
    pub fn until(&mut self, event: &Event, end: f64) -> Result<Option<Occurrence>, RunError> {
        let spacing = self.clock.step.abs();
        let events = self.events(&[event.clone().stopping()], end, spacing)?;
        Ok(events.found.into_iter().next())
    }

    /// What happens of `events` from where the run is to the time `end`, s, with a look at each step, and more of them where
    /// steps are longer than `spacing`, s. Where an event that [stops](Event::stopping) happens, the run stands at the last
    /// step before it.
    ///
    /// Each look between steps costs a step of methods whose steps are given. Roots are found to rounding in the states of
    /// [`at`](Self::at), whose error is that of the method.
    ///
    /// # Errors
    /// As [`advance_to`](Self::advance_to); a run that goes backwards; an end that the run has passed; a spacing that is not
    /// positive; a function that is no number or jumps; [`RunError::Nonsense`] where something happens that is none of a rotation.
    pub fn events(&mut self, events: &[Event], end: f64, spacing: f64) -> Result<Events, RunError> {
        let (found, ended) = self.events_so_far(events, end, spacing);
        ended.map(|()| found)
    }

    /// As [`events`](Self::events): what happened, also before the error that ended the run, and that error.
    pub fn events_so_far(
        &mut self,
        events: &[Event],
        end: f64,
        spacing: f64,
    ) -> (Events, Result<(), RunError>) {
        let mut search = Search::new(events, None);
        let ended = self.search(&mut search, end, spacing);
        (search.finish(spacing.min(self.clock.step)), ended)
    }

    fn search(&mut self, search: &mut Search<'_>, end: f64, spacing: f64) -> Result<(), RunError> {
        let step = self.clock.step;
        let begun = self.clock.at(self.point.steps());
        if step < 0.0 {
            return Err(EventError::NotAscending {
                from: begun.seconds(),
                to: begun.seconds::<f64>() + step,
            }
            .into());
        }
        intervals(begun.seconds(), end, spacing)?;
        let (last, rest) = Place::of(self.clock, end)?.parts();
        let looks = (step / spacing).ceil().max(1.0);
        search.begin::<RunError>(begun.dd(), &self.body.leave(&self.reading))?;
        while !search.has_ended() && (self.point.steps() < last || rest != Dd::ZERO) {
            let whole = self.point.steps() < last;
            self.look_over(search, if whole { None } else { Some(rest) }, looks)?;
            if !whole {
                break;
            }
        }
        Ok(())
    }

    /// Looks over the next step, or the `rest` of it, and takes it unless the search ends in it.
    fn look_over(&mut self, search: &mut Search<'_>, rest: Option<Dd>, looks: f64) -> Result<(), RunError> {
        let mut here = self.here();
        let next = self.point.steps() + 1;
        let length = rest.unwrap_or(Dd::from(self.clock.step));
        let mut k = 1.0;
        while k < looks && !search.has_ended() {
            self.look(search, &mut here, length * (k / looks), None)?;
            k += 1.0;
        }
        if search.has_ended() {
            return Ok(());
        }
        if rest.is_some() {
            return self.look(search, &mut here, length, None);
        }
        // there is no way back from where forces are switched
        if self.steps_ahead() == Some(0) {
            self.look(search, &mut here, length, None)?;
            return if search.has_ended() { Ok(()) } else { self.go_to(next) };
        }
        let before = self.marked();
        self.go_to(next)?;
        self.look(search, &mut here, length, Some(self.reading))?;
        if search.has_ended() {
            self.go_back(before);
        }
        Ok(())
    }

    /// Looks at the time `later` s behind the step `here`, at the `point` of then, where the run has come to it.
    fn look(
        &mut self,
        search: &mut Search<'_>,
        here: &mut Between,
        later: Dd,
        point: Option<Point<f64>>,
    ) -> Result<(), RunError> {
        let (base, body) = (self.clock.at(here.reading.steps()).dd(), self.body.clone());
        let (point, since) = match point {
            Some(point) => (point, Dd::ZERO),
            None => (here.behind(self, later)?, later),
        };
        let known = search.found.len();
        let mut states = |t: Dd| here.behind(self, t - base).map(|point| body.leave(&point));
        let looked = search.go_on(base + later, &body.leave(&point), &mut states);
        // worked out in double-double, so of what counts alone
        if search.found.len() > known
            && let Some(why) = self.sample_of(point, since).nonsense()
        {
            search.found.truncate(known);
            return Err(RunError::Nonsense { why });
        }
        looked
    }
}
