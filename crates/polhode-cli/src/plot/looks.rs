//! A motion as it is drawn: states at equal times, by the closed form or by a method.

use nalgebra::Vector3;
use polhode::body::{Body, Clock, Conserved, Point, State};
use polhode::flow::{ExactMotion, FreeMotion, LagrangeTop};
use polhode::method::Claimed;
use polhode::num::Dd;
use polhode::observe::{Errors, Monitor};
use polhode::rotation::Quat;
use polhode::run::{Run, RunError, Schedule, ScheduleError};
use polhode::truth::Ending;
use polhode_files::error::Error;
use polhode_files::text::short;

use crate::cost;
use crate::flags::motion::{MotionArguments, stepping_method};
use crate::methods::{Unusable, adaptive, at_tolerance, moving, not_taken, unknown};

/// Points of a curve: at least so many, and at most.
pub(crate) const FEWEST: u64 = 600;
pub(crate) const MOST: u64 = 20_000;
/// Points for each radian that the body turns at the rate of the start.
const PER_RADIAN: f64 = 12.0;
/// Marks of flips that can be told apart.
const MOST_FLIPS: u64 = 400;
/// Beyond this turn between two points, rad, they are not joined.
const RESOLVED: f64 = 0.8;
/// A smaller relative change of the energy is not seen.
const SEEN: f64 = 1e-3;

/// What is followed: a motion, by which method, for how long.
#[derive(Clone, Copy)]
pub(crate) struct Course<'a> {
    pub(crate) motion: &'a MotionArguments,
    pub(crate) method: &'a str,
    pub(crate) step: Option<f64>,
    pub(crate) tolerance: Option<f64>,
    pub(crate) start_time: f64,
    /// The end by the same clock, s; it comes after the start.
    pub(crate) until: f64,
    /// Whether one round of a closed polhode is enough.
    pub(crate) one_round: bool,
    /// How many looks, at least and at most, where the method has no steps of its own.
    pub(crate) fewest: u64,
    pub(crate) most: u64,
    /// What messages call the flags of method and step.
    pub(crate) flags: Flags,
}

impl Course<'_> {
    /// From the start to the end, s.
    pub(crate) fn span(&self) -> f64 {
        self.until - self.start_time
    }
}

/// Names of the flags of a course.
#[derive(Clone, Copy)]
pub(crate) struct Flags {
    pub(crate) method: &'static str,
    pub(crate) step: &'static str,
}

impl Flags {
    pub(crate) const OWN: Flags = Flags { method: "--method", step: "--step" };
}

/// States at ascending times.
pub(crate) struct Looks {
    pub(crate) body: Body,
    /// The closed form, where there is one.
    pub(crate) exact: Option<ExactMotion>,
    /// s.
    pub(crate) times: Vec<f64>,
    pub(crate) states: Vec<State>,
    /// Body axes, rad/s.
    pub(crate) omegas: Vec<Vector3<f64>>,
    pub(crate) errors: Vec<Errors>,
    /// (E − E₀) / E₀ with its sign, of a method; empty of the closed form.
    pub(crate) energy_changes: Vec<f64>,
    /// Sign changes of the momentum along the axis of the middle moment; `None` where they are not counted or the body does not
    /// turn over.
    pub(crate) flips: Option<Flips>,
    /// Why the run ended early, where it did.
    pub(crate) ended: Option<Ended>,
}

/// The end of a run that came no further, or of whose numbers no more are those of a rotation.
pub(crate) struct Ended {
    /// In words.
    pub(crate) why: String,
    /// Since the start; `None` where it is the fault of a force.
    pub(crate) ending: Option<Ending>,
}

/// Flips of a motion.
#[derive(Default)]
pub(crate) struct Flips {
    pub(crate) count: u64,
    /// s; not of all where there are more than marks can tell apart.
    pub(crate) times: Vec<f64>,
}

impl Flips {
    /// Whether each has its mark.
    pub(crate) fn can_be_told_apart(&self) -> bool {
        self.count <= MOST_FLIPS
    }
}

impl Looks {
    pub(crate) fn of(course: &Course) -> Result<Self, Error> {
        let body = course.motion.body(course.start_time)?;
        let start = course.motion.start(&body, course.start_time)?;
        let exact = ExactMotion::from_point(&body, start);
        let mut looks = Looks {
            body,
            exact: None,
            times: Vec::new(),
            states: Vec::new(),
            omegas: Vec::new(),
            errors: Vec::new(),
            energy_changes: Vec::new(),
            flips: None,
            ended: None,
        };
        if course.method == "exact" {
            let exact = exact.map_err(|error| {
                let method = stepping_method(&looks.body);
                Error::Input(format!("--method exact: {error}; use --method {method} with a --step"))
            })?;
            looks.exact = Some(exact.clone());
            looks.follow_exact(course, &exact, start)?;
        } else {
            looks.exact = exact.ok();
            looks.follow_method(course, start)?;
        }
        Ok(looks)
    }

    pub(crate) fn free(&self) -> Option<&FreeMotion> {
        match &self.exact {
            Some(ExactMotion::Free(motion)) => Some(motion),
            _ => None,
        }
    }

    pub(crate) fn top(&self) -> Option<&LagrangeTop> {
        match &self.exact {
            Some(ExactMotion::Lagrange(top)) => Some(top),
            _ => None,
        }
    }

    /// The direction of the weight moment in body axes; `None` without gravity.
    pub(crate) fn weight(&self) -> Option<Vector3<f64>> {
        Some(weight_moment(&self.body)?.normalize())
    }

    /// The largest turn between two looks, rad.
    pub(crate) fn turn(&self) -> f64 {
        let intervals = self.times.windows(2).zip(&self.omegas);
        intervals.map(|(times, omega)| (times[1] - times[0]) * omega.norm()).fold(0.0, f64::max)
    }

    /// Whether lines between the looks follow the motion.
    pub(crate) fn is_resolved(&self) -> bool {
        self.turn() <= RESOLVED
    }

    /// Whether the ellipsoid ω·Iω = 2T stays what it is at the start, to the eye.
    pub(crate) fn keeps_ellipsoid(&self) -> bool {
        self.energy_changes.iter().all(|change| change.abs() < SEEN)
    }

    fn push(&mut self, t: f64, state: State, omega: Vector3<f64>, errors: Errors) {
        self.times.push(t);
        self.states.push(state);
        self.omegas.push(omega);
        self.errors.push(errors);
    }

    fn follow_exact(&mut self, course: &Course, exact: &ExactMotion, start: Point<Dd>) -> Result<(), Error> {
        if let Some(step) = course.step {
            let rule = "--method exact takes no step";
            return Err(Error::input(
                "--step",
                &short(step),
                rule,
                "leave it out, or name a stepping method",
            ));
        }
        if let Some(tolerance) = course.tolerance {
            return Err(without_tolerance(course, tolerance));
        }
        let refused = |error| Error::Input(format!("--until: '{}': {error}", short(course.until)));
        exact.check_time(course.span()).map_err(refused)?;
        // a polhode is closed, and one round of it is all there is to see
        let mut span = course.span();
        if let (true, ExactMotion::Free(motion)) = (course.one_round, exact) {
            let period = motion.character().ok().and_then(|character| character.polhode_period);
            span = period.map_or(span, |period| span.min(period));
        }
        let turned = self.body.omega_of(&start).norm() * span;
        let intervals = (PER_RADIAN * turned).clamp(course.fewest as f64, course.most as f64) as u64;
        let monitor = Monitor::new(&self.body, Clock::new(1.0), &start.to_f64());
        for n in 0..=intervals {
            let t = Dd::from(span) * (n as f64 / intervals as f64);
            let x = exact.point_at(t);
            if !x.is_finite() {
                return Err(Error::Failed(format!(
                    "--method exact: at {:?} s the state is not finite; use a stepping method",
                    t.hi()
                )));
            }
            let (state, omega) = (self.body.leave(&x), self.body.omega_of(&x));
            self.push(course.start_time + t.hi(), state, omega, monitor.errors(&x));
        }
        if let (ExactMotion::Free(motion), Some(_)) = (exact, middle_axis(&self.body)) {
            self.flips = Some(flips_of(motion, course, &self.times)).filter(|_| self.turns_over());
        }
        Ok(())
    }

    fn follow_method(&mut self, course: &Course, start: Point<Dd>) -> Result<(), Error> {
        let method = match course.tolerance {
            None => moving(course.flags.method, course.method)?,
            Some(tolerance) => at_tolerance(course.method, tolerance).map_err(|why| match why {
                Unusable::Unknown(error) => unknown(course.flags.method, error),
                Unusable::FixedSteps | Unusable::Twice => without_tolerance(course, tolerance),
                Unusable::OutOfRange(allowed) => not_taken("--tolerance", tolerance, course.method, &allowed),
            })?,
        };
        let adaptive = method.tolerance().is_some();
        let speed = self.body.omega_of(&start).norm();
        let regular = (PER_RADIAN * speed * course.span()).clamp(course.fewest as f64, course.most as f64);
        let interval = adaptive.then(|| course.span() / libm::ceil(regular));
        let Some(step) = course.step.or(interval) else {
            let rule = format!("missing: {} needs a step in seconds", course.method);
            return Err(Error::input(course.flags.step, "", &rule, "give --step h"));
        };
        let clock = Clock { start: course.start_time, step };
        let steps =
            if course.step.is_some() { whole_steps(course, clock)? } else { libm::ceil(regular) as u64 };
        if !adaptive {
            cost::warn_coarse(course.flags.step, step, speed);
        }
        let mut run =
            Run::from_point(method.as_ref(), &self.body, start.to_f64(), clock).map_err(|error| {
                let flag =
                    if matches!(error, RunError::Step(_)) { course.flags.method } else { course.flags.step };
                Error::Input(format!("{flag}: {error}"))
            })?;
        let turn = speed * course.span();
        let trial = if adaptive && speed > 0.0 {
            cost::check_turn("--until", course.until, turn)?;
            (Clock { step: step.min(1.0 / speed), ..clock }, libm::ceil(turn) as u64)
        } else {
            cost::check(course.flags.step, step, steps as f64, "use a larger step or an earlier end")?;
            (clock, steps)
        };
        cost::announce(method.as_ref(), &self.body, start.to_f64(), trial.0, trial.1);
        let middle = middle_axis(&self.body);
        let mut flips = middle.map(|_| Flips::default());
        let mut before: Option<(f64, f64, u64)> = None;
        for sample in run.samples(Schedule::every(steps.div_ceil(course.most).max(1), steps)) {
            let sample = match sample {
                Ok(sample) => sample,
                Err(error) => {
                    self.ended = Some(Ended { why: error.to_string(), ending: Ending::of(&error, step) });
                    break;
                }
            };
            if let Some(why) = sample.nonsense() {
                self.ended = Some(Ended { why, ending: Some(Ending::Diverged(sample.elapsed.hi())) });
                break;
            }
            let t = sample.time.hi();
            if let (Some(axis), Some(found), Some(count)) = (&middle, &mut flips, sample.flips) {
                let along = sample.state.momentum().dot(axis);
                if let Some((time, from, counted)) = before {
                    found.count += count - counted;
                    if found.can_be_told_apart() {
                        found.times.extend(crossings((time, from), (t, along), count - counted));
                    }
                }
                before = Some((t, along, count));
            }
            self.push(t, sample.state, sample.omega_body, sample.errors);
            self.energy_changes.push(sample.energy_change);
        }
        self.flips = flips.filter(|_| self.turns_over());
        Ok(())
    }

    /// Whether L comes within 45° of the middle axis: around the others its side along that axis changes too, but the body
    /// only wobbles.
    fn turns_over(&self) -> bool {
        let Some(axis) = middle_axis(&self.body) else { return false };
        let momenta = self.states.iter().map(|state| state.momentum());
        momenta.into_iter().any(|m| m.dot(&axis).abs() > core::f64::consts::FRAC_1_SQRT_2 * m.norm())
    }

    /// The wheels of the body and what acts on it, as part of a title.
    pub(crate) fn forces(&self) -> String {
        let names = self.body.forces().iter().map(|force| force.name()).collect::<Vec<_>>();
        let wheels = match self.body.wheels().len() {
            0 => String::new(),
            1 => " with a wheel".into(),
            n => format!(" with {n} wheels"),
        };
        if names.is_empty() { wheels } else { format!("{wheels} under {}", names.join(", ")) }
    }

    /// The angular momentum of body and wheels in body axes, kg m^2/s, at each look.
    pub(crate) fn momenta(&self) -> impl Iterator<Item = Vector3<f64>> {
        let each = self.times.iter().zip(&self.states);
        each.map(|(t, state)| state.momentum() + self.body.momentum_of_wheels_at(*t))
    }

    /// L in space at the start, kg m^2/s; zero without a look.
    pub(crate) fn momentum_at_start(&self) -> Vector3<f64> {
        let first = self.times.first().zip(self.states.first());
        first.map_or(Vector3::zeros(), |(t, state)| self.body.momentum_space(*t, state))
    }

    /// Whether L is constant: nothing but wheels acts.
    pub(crate) fn keeps_momentum(&self) -> bool {
        self.body.conserved().contains(&Conserved::Momentum)
    }
}

/// Along the weight moment in body axes; `None` without gravity.
pub(crate) fn weight_moment(body: &Body) -> Option<Vector3<f64>> {
    let weight = body.linear_potential::<f64>()?.moment;
    // a momentum goes the same way out of the solver frame
    Some(body.leave(&Point::new(Quat::identity(), weight)).momentum())
}

/// The number of steps to the end.
fn whole_steps(course: &Course, clock: Clock) -> Result<u64, Error> {
    let end = course.until;
    let step = short(clock.step);
    match Schedule::at_times(clock, &[end]) {
        Ok(schedule) => Ok(schedule.into_iter().last().unwrap_or(0)),
        Err(ScheduleError::NotReached { nearest, .. }) => {
            let rule = format!("no whole number of steps leads to the end {}", short(end));
            let remedy = format!("take --until {}", short(nearest));
            Err(Error::input(course.flags.step, &step, &rule, &remedy))
        }
        Err(error) => Err(Error::Input(format!("{}: '{step}': {error}", course.flags.step))),
    }
}

fn without_tolerance(course: &Course, tolerance: f64) -> Error {
    let rule = format!("--method {} takes no --tolerance", course.method);
    let remedy = format!("leave it out, or use one of {}", adaptive());
    Error::input("--tolerance", &format!("{tolerance:e}"), &rule, &remedy)
}

/// Unit vector along the axis of the middle moment in body axes; `None` where two moments agree, as there is none, and with wheels, as
/// a body with them does not turn over about it.
pub(crate) fn middle_axis(body: &Body) -> Option<Vector3<f64>> {
    if !body.wheels().is_empty() {
        return None;
    }
    let [least, middle, most] = body.inertia().principal_moments();
    (least < middle && middle < most).then(|| body.inertia().principal_axes() * Vector3::y())
}

/// Times of the sign changes of a component between two looks: where a straight line has its zero, or evenly where there are
/// several.
fn crossings((t0, from): (f64, f64), (t1, to): (f64, f64), count: u64) -> Vec<f64> {
    let share = |k: u64| match count {
        1 if from != to && from * to <= 0.0 => from / (from - to),
        _ => (k as f64 + 0.5) / count as f64,
    };
    (0..count).map(|k| t0 + share(k) * (t1 - t0)).collect()
}

/// Flips of a free motion up to the last look, their times by halving the interval in which they are counted.
fn flips_of(motion: &FreeMotion, course: &Course, times: &[f64]) -> Flips {
    let counted = |t: f64| motion.flips(Dd::from(t) - Dd::from(course.start_time));
    let mut flips = Flips { count: times.last().map_or(0, |&end| counted(end)), times: Vec::new() };
    if !flips.can_be_told_apart() {
        return flips;
    }
    for pair in times.windows(2) {
        for number in counted(pair[0]) + 1..=counted(pair[1]) {
            let (mut low, mut high) = (pair[0], pair[1]);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if counted(middle) >= number { high = middle } else { low = middle }
            }
            flips.times.push(high);
        }
    }
    flips
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flip_stands_where_the_momentum_vanishes() {
        assert_eq!(crossings((1.0, -2.0), (2.0, 2.0), 1), [1.5]);
        assert_eq!(crossings((0.0, 1.0), (4.0, 1.0), 2), [1.0, 3.0]);
        assert!(crossings((0.0, 1.0), (4.0, 1.0), 0).is_empty());
    }
}
