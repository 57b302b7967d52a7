//! `+phase`: the departure of a method from the exact motion, taken back at output.

use super::PhaseError;
use super::drift::{PhaseDrift, TAKEN_BACK, check, drift};
use super::forced::Forced;
use super::undo::{Undo, inverse_norm_of};
use crate::body::{Body, Clock, Evaluated, Point, Problem, Time};
use crate::flow::{Departure, direction};
use crate::method::{AnyMethod, Claimed, Claims, SideBySide, Step, StepError, Stuck, Work};
use crate::num::{Dd, Precise};
use crate::rotation::Vec3;

/// A method whose departure from the exact motion is taken back at output.
///
/// The steps are those of the base, bit for bit. Before the first one a short run predicts the [departure](super::PhaseDrift::departure):
/// how fast shift in time and twist about L grow, and how they and the energy oscillate with the period of the momentum. At each output
/// the state is turned back to its polhode, goes back by the exact free motion by the shift, and is turned back about L by the twist.
/// What rounding has added stays, and so do harmonics beyond those of the short run.
///
/// Under weak forces shift and twist grow as those of the free body, but for a share that is measured at the start, from a short run beside
/// Taylor series: they are taken back, and what oscillates stays. More than a hundredth is refused, and so are readings [after
/// which](super::PhaseDrift::holds_until) it would be more, were the forces to go on as in the short run, and readings of states whose |L| or
/// distance from the separatrix has changed by a hundredth. Nothing is claimed of such runs.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::{Body, FreeMotion, Inertia, Run, method};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(1e4)?;
/// let error = |name: &str| -> Result<f64, polhode::Error> {
///     let end = Run::new(&method(name)?, &body, &start, 0.01)?.advance_to(1_000_000)?;
///     Ok(end.state.rotation().angle_to(&exact.rotation()))
/// };
/// assert!(error("rattle")? > 0.2 && error("rattle+phase")? < 1e-9); // rad
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone)]
pub struct PhaseCorrected {
    base: Box<dyn AnyMethod>,
}

impl PhaseCorrected {
    /// Of `base`.
    ///
    /// # Errors
    /// A method that does not keep energy and |m| in bounds, or one whose phase error is taken back already.
    pub fn new(base: &dyn AnyMethod) -> Result<Self, PhaseError> {
        check(base)?;
        Ok(PhaseCorrected { base: base.boxed() })
    }
}

impl Claimed for PhaseCorrected {
    fn name(&self) -> String {
        self.base.name() + TAKEN_BACK
    }

    fn claims(&self, problem: Problem) -> Option<Claims> {
        let base = self.base.claims(problem).filter(|_| problem == Problem::Free)?;
        // what is left depends on the harmonics of the short run, which are doubles, and on the step by no power
        let (order, to_doubles) = (None, true);
        let [symmetric, poisson, symplectic] = [false; 3];
        let source = "deviation from the exact motion, predicted by a short run and corrected at output";
        Some(Claims { order, to_doubles, symmetric, poisson, symplectic, source, ..base })
    }
}

impl AnyMethod for PhaseCorrected {
    fn prepare_f64(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        let base = self.base.prepare_f64(clock, body)?;
        Ok(Box::new(self.step(base, clock, body)?))
    }

    fn prepare_dd(&self, clock: Clock, body: &Body) -> Result<Box<dyn Step<Dd>>, StepError> {
        let base = self.base.prepare_dd(clock, body)?;
        Ok(Box::new(self.step(base, clock, body)?))
    }

    fn prepare_part(&self, clock: Clock, h: Dd, body: &Body) -> Result<Box<dyn Step<f64>>, StepError> {
        self.base.prepare_part(clock, h, body)
    }

    fn boxed(&self) -> Box<dyn AnyMethod> {
        Box::new(self.clone())
    }
}

impl PhaseCorrected {
    fn step<S: Evaluated + Precise>(
        &self,
        base: Box<dyn Step<S>>,
        clock: Clock,
        body: &Body,
    ) -> Result<CorrectedStep<S>, StepError> {
        let free = Body::free(body.inertia().clone());
        Ok(CorrectedStep {
            base,
            precise: self.base.prepare_dd(clock, &free)?,
            forced: Forced::new(self.base.as_ref(), body, clock)?,
            undo: Undo::new(&body.rotor()),
            body: free,
            clock,
            opened: 0,
            taken_back: None,
            refusal: None,
        })
    }
}

/// Steps of the base, and what is taken back where they are read.
struct CorrectedStep<S> {
    base: Box<dyn Step<S>>,
    /// The base once more, for the short run of the free body.
    precise: Box<dyn Step<Dd>>,
    forced: Option<Forced>,
    undo: Undo<S>,
    /// On which nothing acts.
    body: Body,
    clock: Clock,
    /// Steps taken when it was opened.
    opened: u64,
    taken_back: Option<TakenBack>,
    refusal: Option<PhaseError>,
}

/// What is known of the departure from a start.
struct TakenBack {
    drift: PhaseDrift,
    /// Of the momentum, and the angle about L that the body turns in it.
    period: Option<[Dd; 2]>,
    /// Direction of L.
    along: Vec3<Dd>,
    /// 1/|m|.
    inverse_norm: Dd,
}

impl<S: Evaluated + Precise> Step<S> for CorrectedStep<S> {
    fn open(&mut self, x: &mut Point<S>) {
        self.opened = x.steps();
        let start = Point::new(x.attitude.map(S::to_dd), x.momentum_body.map(S::to_dd));
        let known = drift(&self.body, start, self.precise.as_mut(), self.clock);
        let known = known.and_then(|drift| match &mut self.forced {
            Some(forced) => forced.bounded(start, drift),
            None => Ok(drift),
        });
        match known {
            Ok(drift) => {
                let inverse_norm = inverse_norm_of(&start);
                let (period, along) = (drift.period(), direction(start.momentum_space()));
                (self.taken_back, self.refusal) =
                    (Some(TakenBack { drift, period, along, inverse_norm }), None);
            }
            Err(error) => {
                // whoever does not ask why sees a run that has no state
                x.momentum_body = x.momentum_body * S::of(f64::NAN);
                self.refusal = Some(error);
            }
        }
        self.base.open(x);
    }

    fn open_at(&mut self, _: Time, x: &mut Point<S>) {
        self.open(x);
    }

    fn reading(&mut self, x: &Point<S>) -> Point<S> {
        let point = self.base.reading(x);
        let Some(TakenBack { drift, period, along, inverse_norm }) = &self.taken_back else { return point };
        let elapsed = self.clock.elapsed(x.steps()) - self.clock.elapsed(self.opened);
        let at = self.clock.at(x.steps());
        let mut point = point;
        if self.forced.is_some() {
            let (t, now) =
                (elapsed.hi(), Point::new(point.attitude.map(S::to_dd), point.momentum_body.map(S::to_dd)));
            if let Err(refusal) = drift.check(t).and_then(|()| drift.check_polhode(t, now)) {
                point.momentum_body = point.momentum_body * S::of(f64::NAN);
                self.refusal = Some(refusal);
                return point;
            }
            // L and the energy change, and with them the phase of what oscillates: shift and twist grow all the same
            let Departure { shift, twist, .. } = drift.grown(elapsed);
            let inverse_norm = inverse_norm_of(&point);
            self.undo.shift_and_twist(at, &mut point, [shift, twist], inverse_norm);
            return point;
        }
        let Departure { mut shift, mut twist, tilt, .. } = drift.departure_at(elapsed);
        self.undo.lean(&mut point, *along);
        self.undo.tilt(&mut point, tilt);
        if let Some([period, turn]) = *period {
            // Whole periods are a turn about L. The free motion of the state has another energy by a rounding, and another period than
            // that of the start: over many of them it would carry the state away from where it belongs.
            let periods = (shift / period).round();
            (shift, twist) = (shift - periods * period, twist + periods * turn);
        }
        self.undo.shift_and_twist(at, &mut point, [shift, twist], *inverse_norm);
        point
    }

    fn takes_back(&self) -> bool {
        true
    }

    fn refusal(&self) -> Option<&PhaseError> {
        self.refusal.as_ref()
    }

    fn advance(&mut self, x: &mut Point<S>, n: u64) {
        self.base.advance(x, n);
    }

    fn fill(&mut self, x: &mut Point<S>, block: &mut [Point<S>]) {
        self.base.fill(x, block);
    }

    fn memory(&self) -> Vec<f64> {
        self.base.memory()
    }

    fn remember(&mut self, memory: &[f64]) {
        self.base.remember(memory);
    }

    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.base.apply(at, x);
    }

    fn base(&self) -> Option<Dd> {
        self.base.base()
    }

    fn dense(&mut self, until: Time, x: &mut Point<S>) -> Point<S> {
        self.base.dense(until, x)
    }

    fn side_by_side(&self) -> Option<SideBySide<S>> {
        None
    }

    fn worst_residual(&self) -> f64 {
        self.base.worst_residual()
    }

    fn work(&self) -> Option<Work> {
        self.base.work()
    }

    fn stuck(&self) -> Option<Stuck> {
        self.base.stuck()
    }
}
