//! How fast shift and twist grow, from one short run.

use super::PhaseError;
use super::forced::{self, Forced, MOST_LEFT};
use super::harmonics::Harmonics;
use crate::body::{Body, Clock, Point, Problem, State};
use crate::flow::{Departure, FreeMotion, Mode};
use crate::method::{AnyMethod, Energy, SOLVED, Step};
use crate::num::{Dd, Precise, Real};

/// What the names of methods end in whose phase error is taken back.
pub(in crate::method) const TAKEN_BACK: &str = "+phase";

/// Rates that differ by a larger share between two fits to the short run predict nothing.
pub(super) const MOST_DOUBT: f64 = 1e-3;

/// Most steps of the short run.
pub(super) const MOST_STEPS: f64 = 5e5;

/// Nothing is gained where the rates are settled to this share.
const SETTLED: f64 = 1e-11;

/// So near to each other two fits differ by rounding, once more harmonics do not bring them closer.
const CLOSE: f64 = 1e-8;

/// Shift and twist that stay proportional to the number of steps to this share are linear, but for rounding.
const LINEAR: f64 = 1e-9;

/// Departures of so many radians are rounding of the double-doubles of the short run.
const ROUNDING: f64 = 1e-26;

/// Half periods of the momentum in the short run; more where they have few steps, whose phases fill the period all the same.
const HALF_PERIODS: f64 = 3.0;

/// So many times the short run goes on beyond the fit, and at so many looks it must be as predicted.
const BEYOND: f64 = 2.0;
const LOOKS_BEYOND: u64 = 48;

/// Periods of the momentum that it takes altogether.
pub(super) const SHORT_RUN: f64 = 0.5 * HALF_PERIODS * (1.0 + BEYOND);

/// Fewest steps in half a period.
const FEW_STEPS: f64 = 4.0;

/// Fewest harmonics, and how often they are doubled.
const FEWEST: usize = 2;
const DOUBLINGS: u32 = 6;

/// How fast the attitude error of a method grows from one start, predicted before the run.
///
/// After the time t the state is that of the exact motion at the time t (1 + [`shift`](Self::shift)), turned about L by t times
/// [`twist`](Self::twist), but for [oscillations](Self::departure) that do not grow. What rounding adds is not in it.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::{Body, FreeMotion, Inertia, Run, method};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let rattle = method("rattle")?;
/// let drift = rattle.phase(&body, &start, 0.01)?;
/// let end = Run::new(&rattle, &body, &start, 0.01)?.advance_to(1_000_000)?; // t = 1e4 s
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(1e4)?;
/// let error = end.state.rotation().angle_to(&exact.rotation()); // 0.237 rad
/// assert!((drift.attitude_error(1e4)? / error - 1.0).abs() < 1e-8);
/// // the energy of rk4 drifts
/// assert!(method("rk4")?.phase(&body, &start, 0.01).is_err());
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct PhaseDrift {
    rates: [Dd; 2],
    oscillation: Option<Oscillation>,
    pub(super) doubt: f64,
    /// Under forces.
    pub(super) until: Option<Until>,
    step: f64,
    pub(super) motion: FreeMotion,
}

/// Under which forces it holds, and to which time (s).
#[derive(Clone, Debug)]
pub(super) struct Until {
    pub(super) force: String,
    pub(super) t: f64,
    pub(super) body: Body,
    pub(super) start: Point<f64>,
    /// Time of the start, s.
    pub(super) from: f64,
}

/// What does not grow, of shift, twist and tilt.
#[derive(Clone, Debug)]
struct Oscillation {
    harmonics: Harmonics<3>,
    /// Half a period of the momentum, s.
    half: f64,
}

/// Rounds for the phase in which a state is, which its shift depends on: each is nearer by the share of the oscillation in a period.
const PHASE_ROUNDS: usize = 8;

impl Oscillation {
    /// After the time `t` (s), at which the shift has grown to `shift`.
    fn after(&self, t: Dd, shift: Dd) -> [f64; 3] {
        let mut found = [0.0; 3];
        for _ in 0..PHASE_ROUNDS {
            let turns = (t + shift + Dd::of(found[0])) / Dd::of(self.half);
            found = self.harmonics.bounded((turns - turns.round()).hi());
        }
        found
    }
}

impl PhaseDrift {
    /// Growth of the shift per time, s/s.
    #[must_use]
    pub fn shift(&self) -> f64 {
        self.rates[0].hi()
    }

    /// Growth of the twist about L, rad/s.
    #[must_use]
    pub fn twist(&self) -> f64 {
        self.rates[1].hi()
    }

    /// The share of the growth that is in doubt: by which two fits to the short run differ, or by which the run departs otherwise than
    /// predicted after the part that was fitted, whichever is more. What comes later than twice that part is not seen.
    #[must_use]
    pub fn doubt(&self) -> f64 {
        self.doubt
    }

    /// How a run departs from the exact motion after the time `t` (s): shift, twist and tilt with their oscillations, as far as the
    /// short run tells them. Under forces it is that of the free body.
    #[must_use]
    pub fn departure(&self, t: f64) -> Departure {
        self.departure_at(Dd::of(t))
    }

    /// What has grown of it after the time `t` (s).
    pub(super) fn grown(&self, t: Dd) -> Departure {
        Departure::grown(self.rates, t)
    }

    /// As [`departure`](Self::departure).
    pub(super) fn departure_at(&self, t: Dd) -> Departure {
        let mut departure = self.grown(t);
        if let Some(oscillation) = &self.oscillation {
            let [shift, twist, tilt] = oscillation.after(t, departure.shift).map(Dd::of);
            (departure.shift, departure.twist, departure.tilt) =
                (departure.shift + shift, departure.twist + twist, tilt);
        }
        departure
    }

    /// The attitude error after the time `t` (s), without oscillations and rounding, rad.
    ///
    /// # Errors
    /// A time that is not finite, or beyond the [reach](FreeMotion::reach) of the exact motion; under forces one [to
    /// which](Self::holds_until) it does not hold, or by which they have changed the polhode by a hundredth.
    pub fn attitude_error(&self, t: f64) -> Result<f64, PhaseError> {
        self.motion.check_time(t)?;
        self.check(t)?;
        let grown = self.grown(Dd::of(t));
        match &self.until {
            // by how much a shift turns depends on where the body is
            Some(Until { body, start, from, .. }) => {
                let along = |t, point| self.check_polhode(t, point);
                forced::turned(body, *start, (*from, t), grown, along)
            }
            None => Ok(self.motion.attitude_error_of(Dd::of(t), grown)),
        }
    }

    /// The time to which it holds, s: infinite of a free body; under forces that at which a hundredth of the growth is another, where what
    /// the short run shows of them goes on in proportion.
    #[must_use]
    pub fn holds_until(&self) -> f64 {
        self.until.as_ref().map_or(f64::INFINITY, |until| until.t)
    }

    /// Refuses times to which it does not hold.
    pub(super) fn check(&self, t: f64) -> Result<(), PhaseError> {
        match &self.until {
            Some(Until { force, t: until, .. }) if t.abs() > *until => {
                Err(PhaseError::Late { t, force: force.clone(), until: *until })
            }
            _ => Ok(()),
        }
    }

    /// Refuses the state `point` after the time `t` (s), where forces have made its polhode another: the rates were those of the start.
    pub(super) fn check_polhode(&self, t: f64, point: Point<Dd>) -> Result<(), PhaseError> {
        let Some(Until { force, body, start, .. }) = &self.until else { return Ok(()) };
        let now = FreeMotion::from_point(body.inertia(), point);
        let change = match (self.motion.character(), now.character()) {
            (Ok(before), Ok(now)) => {
                let norm = point.momentum_body.norm() / start.to_dd().momentum_body.norm();
                // 0/0 of a sphere, whose polhodes are points
                let distance = now.separatrix_distance / before.separatrix_distance;
                [norm.hi(), distance].into_iter().fold(0.0, |most: f64, ratio| most.max((ratio - 1.0).abs()))
            }
            _ => f64::INFINITY,
        };
        if change > MOST_LEFT {
            return Err(PhaseError::Changed { t, force: force.clone(), change });
        }
        Ok(())
    }

    /// What rounding adds to the attitude of a run in doubles after the time `t` (s), by order of magnitude, rad.
    ///
    /// Each step changes the energy by a rounding, which is random; the error of the rate walks as the root of the number of steps, and
    /// the attitude as its integral (Brouwer, Astron. J. 46 (1937) 149). Next to the separatrix the period depends on the energy as on
    /// the logarithm of k'², which multiplies the error of the rate by 1/k'².
    #[must_use]
    pub fn rounding(&self, t: f64) -> f64 {
        let Ok(character) = self.motion.character() else { return 0.0 };
        let sensitivity = 1.0 + character.complement.map_or(0.0, |complement| 1.0 / complement);
        let of_rate = f64::ROUNDOFF * (t / self.step).abs().max(1.0).sqrt() * sensitivity;
        (of_rate * character.spin * t).abs()
    }
}

impl PhaseDrift {
    /// The period of the momentum, s, and the angle by which the body turns about L in it, rad; `None` where it stands still.
    pub(super) fn period(&self) -> Option<[Dd; 2]> {
        let about = Dd::of(self.motion.character().ok()?.polhode_period?);
        // in double-double: when the start comes next to a period that is known as a double
        let start = self.motion.point_at_dd(Dd::ZERO);
        let from_there = self.motion.departure(about, &start, Departure::NONE);
        Some([about + from_there.shift, -from_there.twist])
    }
}

impl dyn AnyMethod {
    /// How fast the attitude error of this method grows from `start` with the step `h` (s): shift and twist, from one short run in
    /// double-double over some three halves of a period of the momentum, from which oscillations of its period are taken off. The run
    /// goes on for three periods more, and must depart as predicted. Under forces it is that of the free body, and another short run, beside
    /// Taylor series, tells which share of the growth is another.
    ///
    /// # Errors
    /// A method that does not keep energy and |m| in bounds, by its claims; forces under which more than a hundredth of the growth is another
    /// than that of the free body, or that are switched; a step or a start that is not usable; where no prediction holds: on the
    /// separatrix, and so near it or with steps so long that shift and twist do not grow linearly within the short run.
    pub fn phase(&self, body: &Body, start: &State, h: f64) -> Result<PhaseDrift, PhaseError> {
        self.phase_by_clock(body, start, Clock::new(h))
    }

    /// As `phase`, from a time on which forces may depend.
    ///
    /// # Errors
    /// As there.
    pub fn phase_by_clock(&self, body: &Body, start: &State, clock: Clock) -> Result<PhaseDrift, PhaseError> {
        check(self)?;
        throughout(body)?;
        let (free, start) = (Body::free(body.inertia().clone()), body.enter(start)?);
        let mut step = self.prepare_dd(clock, &free)?;
        let drift = drift(&free, start, step.as_mut(), clock)?;
        match Forced::new(self, body, clock)? {
            Some(mut forced) => forced.bounded(start, drift),
            None => Ok(drift),
        }
    }
}

/// Refuses methods whose phase error has no constant rates.
pub(super) fn check(method: &dyn AnyMethod) -> Result<(), PhaseError> {
    let name = method.name();
    if name.ends_with(TAKEN_BACK) {
        return Err(PhaseError::TakenBack { method: name });
    }
    let Some(claims) = method.claims(Problem::Free) else { return Ok(()) };
    let lost = match (claims.kept.energy, claims.kept.momentum_norm) {
        (Energy::Drifts, _) => "its energy drifts",
        (_, false) => "its |m| is not constant",
        _ => return Ok(()),
    };
    Err(PhaseError::NotKept { method: name, lost })
}

/// Refuses forces that are switched: what oscillates would stay in the state from then on.
pub(crate) fn throughout(body: &Body) -> Result<(), PhaseError> {
    if body.switching_times().is_empty() {
        return Ok(());
    }
    let force = body.forces().iter().find(|force| force.intervals().is_some());
    let force = force.map_or("motor of a wheel", |force| force.name()).into();
    Err(PhaseError::Switched { force })
}

/// The rates of steps of `clock` from `start`.
pub(super) fn drift(
    body: &Body,
    start: Point<Dd>,
    step: &mut dyn Step<Dd>,
    clock: Clock,
) -> Result<PhaseDrift, PhaseError> {
    let motion = FreeMotion::from_point(body.inertia(), start);
    let Ok(character) = motion.character() else {
        // a body at rest stays so
        return Ok(PhaseDrift {
            rates: [Dd::ZERO; 2],
            oscillation: None,
            doubt: 0.0,
            until: None,
            step: clock.step,
            motion,
        });
    };
    if character.mode == Mode::Separatrix {
        return Err(PhaseError::Separatrix);
    }
    // the body is the same after half a turn about a principal axis: so is what oscillates after half a period
    let half = character.polhode_period.map(|period| 0.5 * period);
    let in_half = half.map_or(f64::INFINITY, |half| half / clock.step.abs());
    let span = if half.is_some() { HALF_PERIODS * in_half } else { 0.0 };
    if span > MOST_STEPS {
        return Err(PhaseError::Long { steps: span });
    }
    let radians = |[shift, twist]: [f64; 2]| shift.abs() * character.spin + twist.abs();
    let mut before: Option<[f64; 2]> = None;
    // the fit that differs least from the one before, and by how much
    let (mut best, mut doubt) = (None, f64::INFINITY);
    let mut state = start;
    for doubling in 0..=DOUBLINGS {
        let count = FEWEST << doubling;
        let looks = 3 * (2 + 2 * count) as u64;
        let stride = (libm::ceil(span / looks as f64) as u64).max(1);
        let run = ShortRun::new(&motion, start, step, clock, stride, looks)?;
        if let Some((rates, doubt)) = run.linear(radians) {
            return Ok(PhaseDrift { rates, oscillation: None, doubt, until: None, step: clock.step, motion });
        }
        state = run.state;
        let Some(half) = half else { continue };
        if in_half < FEW_STEPS {
            return Err(PhaseError::Coarse { steps: in_half });
        }
        let [shift, _, _] = &run.departures;
        let turns: Vec<f64> = run.times.iter().zip(shift).map(|(t, shift)| (t + shift) / half).collect();
        let series = run.departures.each_ref().map(Vec::as_slice);
        let Some(harmonics) = Harmonics::fit(&run.times, &turns, series, count) else { break };
        let [shift, twist, _] = harmonics.slopes;
        let rates = [shift, twist];
        if let Some(before) = before {
            let now = radians([rates[0] - before[0], rates[1] - before[1]]) / radians(rates);
            if now < doubt {
                (best, doubt) = (Some(Oscillation { harmonics, half }), now);
            }
            // where more harmonics bring them no closer it is rounding that differs
            if now <= SETTLED || (now > doubt && doubt <= CLOSE) {
                break;
            }
        }
        before = Some(rates);
    }
    let unsettled = |doubt| PhaseError::Unsettled { doubt, distance: character.separatrix_distance };
    let Some(oscillation) = best.filter(|_| doubt <= MOST_DOUBT) else { return Err(unsettled(doubt)) };
    let [shift, twist, _] = oscillation.harmonics.slopes;
    let rates = [shift, twist].map(Dd::of);
    let (oscillation, until) = (Some(oscillation), None);
    let mut drift = PhaseDrift { rates, oscillation, doubt, until, step: clock.step, motion };
    // two fits agree where the fitted part is like a line by chance
    let stride = (libm::ceil(BEYOND * span / LOOKS_BEYOND as f64) as u64).max(1);
    for _ in 0..LOOKS_BEYOND {
        step.advance(&mut state, stride);
        let t = clock.elapsed(state.steps());
        let expected = drift.departure_at(t);
        let departure = drift.motion.departure(t, &read(step, &state)?, expected);
        let off = [departure.shift - expected.shift, departure.twist - expected.twist].map(Dd::hi);
        let off = radians(off) + (departure.tilt - expected.tilt).hi().abs();
        drift.doubt = drift.doubt.max(off / (radians([shift, twist]) * t.hi().abs()));
    }
    if drift.doubt <= MOST_DOUBT { Ok(drift) } else { Err(unsettled(drift.doubt)) }
}

/// What `step` reads of `x`.
pub(super) fn read(step: &mut dyn Step<Dd>, x: &Point<Dd>) -> Result<Point<Dd>, PhaseError> {
    let point = step.reading(x);
    if !point.is_finite() || step.worst_residual() > SOLVED {
        return Err(PhaseError::Diverged { steps: x.steps() });
    }
    Ok(point)
}

/// Departures from the exact motion along a short run.
struct ShortRun {
    /// After one step, and at the last look.
    first: (Dd, Departure),
    last: (Dd, Departure),
    times: Vec<f64>,
    /// Shift, twist and tilt.
    departures: [Vec<f64>; 3],
    /// At its end.
    state: Point<Dd>,
}

impl ShortRun {
    /// Looks every `stride` steps.
    fn new(
        motion: &FreeMotion,
        start: Point<Dd>,
        step: &mut dyn Step<Dd>,
        clock: Clock,
        stride: u64,
        looks: u64,
    ) -> Result<ShortRun, PhaseError> {
        let mut x = start;
        step.open(&mut x);
        let mut look = |steps: u64, before: (Dd, Departure)| -> Result<_, PhaseError> {
            let more = steps - x.steps();
            step.advance(&mut x, more);
            let (t, point) = (clock.elapsed(steps), read(step, &x)?);
            Ok((t, motion.departure(t, &point, before.1.carried_on(before.0, t))))
        };
        let first = look(1, (Dd::ONE, Departure::NONE))?;
        let mut last = first;
        let (mut times, mut departures): (_, [Vec<f64>; 3]) = (Vec::new(), Default::default());
        for n in 1..=looks {
            last = look(n * stride, last)?;
            times.push(last.0.hi());
            let Departure { shift, twist, tilt, .. } = last.1;
            departures.iter_mut().zip([shift, twist, tilt]).for_each(|(all, one)| all.push(one.hi()));
        }
        Ok(ShortRun { first, last, times, departures, state: x })
    }

    /// The rates, where shift and twist are proportional to the time, and the share by which they are not.
    fn linear(&self, radians: impl Fn([f64; 2]) -> f64) -> Option<([Dd; 2], f64)> {
        let rates = |(t, departure): &(Dd, Departure)| [departure.shift / *t, departure.twist / *t];
        let last = radians([self.last.1.shift.hi(), self.last.1.twist.hi()]);
        if last <= ROUNDING {
            return Some(([Dd::ZERO; 2], 0.0));
        }
        let first = rates(&self.first).map(Dd::hi);
        let off =
            |k: usize| radians([0, 1].map(|part| self.departures[part][k] - first[part] * self.times[k]));
        let off = (0..self.times.len()).map(off).fold(0.0, f64::max) / last;
        (off <= LINEAR).then(|| (rates(&self.last), off))
    }
}
