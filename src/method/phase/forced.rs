//! Under forces: how much of the growth is not as that of the free body.

use core::f64::consts::TAU;

use super::PhaseError;
use super::drift::{MOST_STEPS, PhaseDrift, SHORT_RUN, Until, read};
use super::undo::{Undo, inverse_norm_of};
use crate::body::{Body, Clock, Point};
use crate::flow::Departure;
use crate::method::taylor::AdaptiveTaylor;
use crate::method::{AnyMethod, Step, StepError};
use crate::num::Dd;
use crate::rotation::rotation_angle;

/// Where more of the growth is another than that of the free body, nothing is predicted.
pub(super) const MOST_LEFT: f64 = 0.01;

/// Looks at the last third of the run.
const LOOKS: u64 = 16;

/// Times at which the polhode is compared with that of the start.
const CHECKS: u64 = 64;

/// Turns of a body whose momentum stands still, in place of periods.
const TURNS: f64 = 3.0;

/// A method and the true motion under the same forces.
pub(super) struct Forced {
    force: String,
    body: Body,
    clock: Clock,
    steps: Box<dyn Step<Dd>>,
    /// In doubles: where the growth is not far beyond their rounding, it is refused.
    truth: Box<dyn Step<f64>>,
}

impl Forced {
    /// `None` where nothing acts on `body`.
    pub(super) fn new(
        method: &dyn AnyMethod,
        body: &Body,
        clock: Clock,
    ) -> Result<Option<Forced>, StepError> {
        let Some(force) = body.acts() else { return Ok(None) };
        Ok(Some(Forced {
            force,
            steps: method.prepare_dd(clock, body)?,
            truth: AdaptiveTaylor::to_rounding().prepare_f64(clock, body)?,
            body: body.clone(),
            clock,
        }))
    }

    /// `drift`, of the free body, with the share of the growth that is left where its departure is taken back from a run as long as its own,
    /// and the time to which it holds: where energy or L change slowly, the share grows in proportion.
    pub(super) fn bounded(
        &mut self,
        start: Point<Dd>,
        mut drift: PhaseDrift,
    ) -> Result<PhaseDrift, PhaseError> {
        let refused = |share| PhaseError::Force { force: self.force.clone(), share };
        let Ok(character) = drift.motion.character() else { return Err(refused(f64::INFINITY)) };
        let span = character.polhode_period.map_or(TURNS * TAU / character.spin, |period| SHORT_RUN * period);
        let end = libm::ceil(span / self.clock.step.abs()) as u64;
        if end as f64 > MOST_STEPS {
            return Err(PhaseError::Long { steps: end as f64 });
        }
        let stride = (end / (3 * LOOKS)).max(1);
        let (mut x, mut exact) = (start, start.to_f64());
        self.steps.open(&mut x);
        self.truth.open(&mut exact);
        let mut undo = Undo::new(&self.body.rotor());
        let (mut share, mut until): (f64, f64) = (0.0, f64::INFINITY);
        for look in 0..LOOKS {
            let more = if look == 0 { end.saturating_sub((LOOKS - 1) * stride).max(1) } else { stride };
            self.steps.advance(&mut x, more);
            self.truth.advance(&mut exact, more);
            let steps = x.steps();
            let t = self.clock.elapsed(steps);
            let mut point = read(self.steps.as_mut(), &x)?;
            let departure = drift.departure_at(t);
            undo.tilt(&mut point, departure.tilt);
            let (at, inverse_norm) = (self.clock.at(steps), inverse_norm_of(&point));
            undo.shift_and_twist(at, &mut point, [departure.shift, departure.twist], inverse_norm);
            let truth = self.truth.reading(&exact);
            if !truth.is_finite() {
                return Err(PhaseError::Diverged { steps });
            }
            let left = rotation_angle(point.attitude, truth.to_dd().attitude).hi();
            let grown = drift.grown(t);
            share = share.max(left / (grown.shift.hi().abs() * character.spin + grown.twist.hi().abs()));
            until = t.hi().abs() * MOST_LEFT / share;
        }
        if share > MOST_LEFT {
            return Err(refused(share));
        }
        let (force, body, start) = (self.force.clone(), self.body.clone(), start.to_f64());
        drift.doubt = drift.doubt.max(share);
        drift.until = Some(Until { force, t: until, body, start, from: self.clock.start });
        Ok(drift)
    }
}

/// By how much shift and twist of `departure` turn `body` where it is `t` s after the time `from`, rad; `check` sees the motion up to there.
pub(super) fn turned(
    body: &Body,
    start: Point<f64>,
    (from, t): (f64, f64),
    departure: Departure,
    check: impl Fn(f64, Point<Dd>) -> Result<(), PhaseError>,
) -> Result<f64, PhaseError> {
    let clock = Clock { start: from, step: t / CHECKS as f64 };
    let mut point = start;
    if t != 0.0 {
        let mut truth = AdaptiveTaylor::to_rounding().prepare_f64(clock, body)?;
        let mut x = start;
        truth.open(&mut x);
        for _ in 0..CHECKS {
            truth.advance(&mut x, 1);
            point = truth.reading(&x);
            check(clock.elapsed(x.steps()).hi(), point.to_dd())?;
        }
    }
    let (mut moved, inverse_norm) = (point, inverse_norm_of(&point));
    let forward = [-departure.shift, -departure.twist];
    Undo::new(&body.rotor()).shift_and_twist(clock.at(CHECKS), &mut moved, forward, inverse_norm);
    Ok(rotation_angle(point.attitude, moved.attitude))
}
