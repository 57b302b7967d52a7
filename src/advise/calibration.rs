//! The search: a setting for each candidate from short runs, then the quickest over as much of the time as is affordable.

use std::cell::Cell;
use std::time::Instant;

use super::candidate::Candidate;
use super::progress::Stage;
use super::reference::{Reference, Span};
use super::trial::{SAME_RUN, Trial, trial};
use super::{Advice, AdviseError, Choice, Demand, Predicted, Progress, Setting};
use crate::body::Body;
use crate::rotation::rotation_angle;

/// The longest run of a candidate on a body whose motion has a closed form, s of processor time.
const AFFORDABLE: f64 = 3.0;

/// Thinking ends after so many seconds and so many times the quickest run, as soon as one method has been run.
const THOUGHT: (f64, f64) = (1.2, 6.0);

/// Candidates whose settings are refined, and up to which multiple of the quickest's time.
const FINALISTS: (usize, f64) = (6, 4.0);

/// Nobody waits so many times longer than the quickest method takes.
const SLOW: f64 = 30.0;

/// A short run may take so long in any case, s.
const LEAST_PATIENCE: f64 = 2e-3;

/// Rungs of a search, each half the step or a hundredth of the tolerance of the one before.
const RUNGS: usize = 14;

/// Runs of a candidate over the whole time at most.
const REFINEMENTS: usize = 6;

/// Shorter steps may make the run of a candidate so many times as long, at least this many seconds, as long as no other is known
/// to be fit.
const LENGTHENED: (f64, f64) = (4.0, 0.05);

/// Evaluations of the closed form, of which the quickest counts.
const EVALUATIONS: usize = 8;

/// By what a tolerance is made smaller at which a run was lost.
const LOST_TOLERANCE: f64 = 0.01;

/// What part of the demand is aimed at, and between which parts a setting is taken.
const AIM: f64 = 0.4;
const TAKEN: (f64, f64) = (0.12, 1.0 / SAME_RUN);

pub(super) struct Calibration<'a> {
    body: &'a Body,
    demand: &'a Demand,
    reference: Reference,
    conditioning: f64,
    /// The least time of a setting that meets the demand so far, s.
    quickest: f64,
    begun: Instant,
    /// Whether thinking ends, and whether it ended before everything was tried.
    ends: bool,
    ended: Cell<bool>,
    heed: &'a mut dyn FnMut(&Progress),
}

/// Choices that meet the demand, those of which only a short run says so, and methods that do not.
struct Sought {
    fit: Vec<Choice>,
    rest: Vec<Choice>,
    unfit: Vec<(String, Option<Nearest>)>,
}

/// The run of a method that came nearest to the demand.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    excess: f64,
    /// rad.
    attitude: f64,
    energy: Option<f64>,
}

/// A setting of a candidate, and what it is expected to do over the whole time.
#[derive(Clone, Debug)]
struct Found {
    value: f64,
    choice: Choice,
}

impl<'a> Calibration<'a> {
    pub(super) fn new(
        body: &'a Body,
        demand: &'a Demand,
        reference: Reference,
        (begun, heed): (Instant, &'a mut dyn FnMut(&Progress)),
    ) -> Result<Self, AdviseError> {
        let conditioning = reference.conditioning()?;
        let (wanted, until) = (demand.attitude_error, demand.until);
        if conditioning > wanted {
            return Err(AdviseError::Conditioning { demand: wanted, attainable: conditioning, until });
        }
        let quickest = f64::INFINITY;
        let (ends, ended) = (true, Cell::new(false));
        Ok(Calibration { body, demand, reference, conditioning, quickest, begun, ends, ended, heed })
    }

    /// Whether a thought of `seconds` more is too long.
    fn late(&self, seconds: f64) -> bool {
        let (least, times) = THOUGHT;
        let late = self.ends && self.begun.elapsed().as_secs_f64() + seconds > least + times * self.quickest;
        self.ended.set(self.ended.get() || late);
        late
    }

    pub(super) fn advice(mut self) -> Result<Advice, AdviseError> {
        let candidates = Candidate::all(self.body, self.demand);
        let mut sought = self.search(&candidates)?;
        if sought.fit.is_empty() && self.ended.get() {
            // nothing is refused because the machine was busy
            self.ends = false;
            sought = self.search(&candidates)?;
        }
        let Sought { mut fit, rest, unfit } = sought;
        fit.sort_by(|a, b| a.seconds.value.total_cmp(&b.seconds.value));
        if fit.is_empty() {
            return Err(self.unreached(&unfit));
        }
        let best = fit.remove(0);
        if let Some(budget) = self.demand.budget.filter(|budget| best.seconds.value > *budget) {
            return Err(AdviseError::Budget { budget, method: best.method, seconds: best.seconds.value });
        }
        fit.extend(rest);
        let unfit =
            unfit.into_iter().map(|(name, nearest)| (name, nearest.map(|run| run.attitude))).collect();
        let jump = self.reference.truth().jump();
        Ok(Advice { best, others: fit, unfit, conditioning: self.conditioning, jump })
    }

    /// What is found until thinking ends.
    fn search(&mut self, candidates: &[Candidate]) -> Result<Sought, AdviseError> {
        let mut found = Vec::new();
        let (mut fit, mut rest, mut unfit) = (self.closed_form(), Vec::new(), Vec::new());
        self.quickest = fit.first().map_or(f64::INFINITY, |closed| closed.seconds.value);
        let short = self.reference.short()?;
        for (place, candidate) in candidates.iter().enumerate() {
            (self.heed)(&Progress::new(&Stage::Methods, place as f64 / candidates.len() as f64, None));
            if !(found.is_empty() && fit.is_empty()) && self.late(0.0) {
                break;
            }
            match self.first(candidate, &short) {
                Ok(first) => {
                    self.quickest = self.quickest.min(first.choice.seconds.value);
                    found.push((candidate, first));
                }
                Err(nearest) => unfit.push((candidate.name.clone(), nearest)),
            }
        }
        let jump = self.reference.truth().jump();
        found.sort_by(|(a, first), (b, second)| {
            // what has no order across a jump comes after what chooses its steps
            let late = |candidate: &Candidate| jump.is_some() && !candidate.is_adaptive();
            let seconds = first.choice.seconds.value.total_cmp(&second.choice.seconds.value);
            late(a).cmp(&late(b)).then(seconds)
        });
        let quickest = found.first().map_or(0.0, |first| first.1.choice.seconds.value);
        let (most, multiple) = FINALISTS;
        for (place, (candidate, first)) in found.into_iter().enumerate() {
            let seconds = first.choice.seconds.value;
            let more = place < most && seconds <= multiple * quickest && !self.late(seconds);
            // one at least is run, and another few if none of those that were run is fit
            if (!fit.is_empty() || place >= most) && !more {
                // a short time may have been the whole
                let seen = first.choice.whole_time && self.excess(&first.choice) + self.doubt() <= TAKEN.1;
                if seen {
                    fit.push(first.choice)
                } else if self.excess(&first.choice) <= 1.0 {
                    rest.push(first.choice)
                } else {
                    // it may still be fit, as far as its short run can tell, and is not called so
                    unfit.push((candidate.name.clone(), self.nearer(None, &first.choice)));
                }
                continue;
            }
            let best = fit.iter().map(|choice| choice.seconds.value).reduce(f64::min);
            match self.refined(candidate, first, best) {
                Ok(choice) => fit.push(choice),
                Err(nearest) => unfit.push((candidate.name.clone(), nearest)),
            }
        }
        Ok(Sought { fit, rest, unfit })
    }

    /// The part of the demand that is missed by more, by the method that comes nearest.
    fn unreached(&self, unfit: &[(String, Option<Nearest>)]) -> AdviseError {
        let seen = unfit.iter().filter_map(|(name, nearest)| nearest.map(|nearest| (name, nearest)));
        let Some((name, nearest)) = seen.min_by(|a, b| a.1.excess.total_cmp(&b.1.excess)) else {
            return AdviseError::NoCandidate;
        };
        let (method, until) = (name.clone(), self.demand.until);
        let (demand, error) = (self.demand.attitude_error, nearest.attitude);
        match self.demand.energy_error.zip(nearest.energy) {
            Some((most, energy)) if energy / most > error / demand => {
                AdviseError::EnergyUnreached { demand: most, method, error: energy, until }
            }
            _ => AdviseError::Unreached { demand, method, error, until },
        }
    }

    /// The closed form, where there is one and it is wanted.
    fn closed_form(&self) -> Vec<Choice> {
        let excluded = self.demand.excluded.iter().any(|name| name == "exact");
        let Some(motion) = self.reference.truth().closed_form().filter(|_| !excluded) else {
            return Vec::new();
        };
        let Ok(state) = motion.at(self.demand.until) else { return Vec::new() };
        // an interruption lengthens some evaluations, never all of them
        let seconds = (0..EVALUATIONS).map(|_| {
            let begun = Instant::now();
            let _ = std::hint::black_box(motion.at(self.demand.until));
            begun.elapsed().as_secs_f64()
        });
        let seconds = seconds.fold(f64::INFINITY, f64::min);
        let exact = self.body.leave(&motion.point_at_dd(self.demand.until.into()));
        let error = rotation_angle(state.attitude, exact.attitude);
        if error > self.demand.attitude_error {
            return Vec::new();
        }
        vec![Choice {
            method: "exact".into(),
            setting: Setting::Nothing,
            steps: None,
            attitude_error: Predicted { value: error, factor: 2.0 },
            energy_error: None,
            seconds: Predicted { value: seconds, factor: 2.0 },
            whole_time: true,
        }]
    }

    /// A run of `candidate` at the step or tolerance `value` over `span`, of which `stage` is told.
    fn run(
        &mut self,
        candidate: &Candidate,
        value: f64,
        span: &Span,
        stage: Option<(&Stage, f64)>,
    ) -> Option<Trial> {
        let prepared = candidate.at(value).ok()?;
        let steps = if candidate.is_adaptive() || candidate.is_exact() { 1.0 } else { span.horizon / value };
        // of a short run what makes the whole one too slow
        let slow = (SLOW * self.quickest / span.times_longer).max(LEAST_PATIENCE);
        let patience = if stage.is_some() { f64::INFINITY } else { slow };
        let heed = &mut self.heed;
        let mut tell = |done| {
            if let Some((stage, seconds)) = stage {
                heed(&Progress::new(stage, done, Some(seconds)));
            }
        };
        trial(prepared.method(), self.body, span, (steps, patience), &mut tell)
    }

    /// What a run at `value` over `span` makes expect of the whole time.
    fn expected(&self, candidate: &Candidate, value: f64, span: &Span, run: &Trial) -> Choice {
        let (until, looks) = (self.demand.until, span.points.len() as u64);
        // what is exact takes the whole time in one step, and did so from look to look
        let (steps, seconds) = if candidate.is_exact() {
            (1, run.price * run.horizon / looks as f64)
        } else if candidate.is_adaptive() {
            (1, run.price * run.horizon * span.times_longer)
        } else {
            let steps = libm::ceil((looks * run.steps) as f64 * (until / span.horizon));
            (steps as u64, run.price * until)
        };
        let mut attitude_error = run.attitude_at(until, self.reference.rate, candidate.drifts());
        if attitude_error.value > 0.0 {
            // the motion itself is known to so much
            let known = attitude_error.value + 2.0 * self.reference.truth().apart();
            attitude_error.factor = attitude_error.factor.max(known / attitude_error.value);
        }
        Choice {
            method: candidate.name.clone(),
            setting: candidate.setting(value, until, steps),
            steps: (!candidate.is_adaptive()).then_some(steps),
            attitude_error,
            energy_error: run.energy_at(candidate.drifts()),
            seconds: Predicted { value: run.setup + seconds, factor: run.scatter },
            whole_time: span.times_longer <= 1.0,
        }
    }

    /// How many times the demand the errors are: the attitude's, or that of the energy where it is worse.
    fn excess(&self, choice: &Choice) -> f64 {
        let energy =
            self.demand.energy_error.zip(choice.energy_error).map_or(0.0, |(most, error)| error / most);
        (choice.attitude_error.value / self.demand.attitude_error).max(energy)
    }

    /// Of `before` and the run of `choice` the one that is nearer to the demand.
    fn nearer(&self, before: Option<Nearest>, choice: &Choice) -> Option<Nearest> {
        let (excess, attitude) = (self.excess(choice), choice.attitude_error.value);
        let now = Nearest { excess, attitude, energy: choice.energy_error };
        before.filter(|before| before.excess <= excess).or(Some(now))
    }

    /// The part of the demand that the truth itself may be off by.
    fn doubt(&self) -> f64 {
        2.0 * self.reference.truth().apart() / self.demand.attitude_error
    }

    /// A setting from short runs, or the run that came nearest.
    fn first(&mut self, candidate: &Candidate, short: &Span) -> Result<Found, Option<Nearest>> {
        let mut value = candidate.coarse(self.reference.rate);
        let factor = if candidate.is_adaptive() { 0.01 } else { 0.5 };
        let (mut nearest, mut before, mut plausible): (Option<Nearest>, Option<f64>, Option<Found>) =
            Default::default();
        for _ in 0..RUNGS {
            if self.late(0.0) {
                break;
            }
            if let Some(run) = self.run(candidate, value, short, None) {
                let choice = self.expected(candidate, value, short, &run);
                let excess = self.excess(&choice);
                nearest = self.nearer(nearest, &choice);
                let (seconds, doubt) = (choice.seconds.value, choice.attitude_error.factor);
                let found = Found { value, choice };
                if excess <= AIM {
                    return Ok(found);
                }
                if candidate.is_exact() || seconds > SLOW * self.quickest {
                    return plausible.ok_or(nearest);
                }
                if excess <= AIM * doubt && plausible.is_none() {
                    plausible = Some(found.clone());
                }
                // two runs that differ as the order says tell the rest
                let slope = before.map(|before: f64| libm::log(before / excess) / -libm::log(factor));
                let lawful = slope.is_some_and(|slope| (slope / candidate.power() - 1.0).abs() < 0.15);
                if lawful && run.attitude < 0.1 && !candidate.is_adaptive() {
                    let finer = libm::pow(AIM / excess, 1.0 / candidate.power());
                    let choice = scaled(found.choice, finer, AIM / excess);
                    let slow = choice.seconds.value > SLOW * self.quickest;
                    return if slow { Err(nearest) } else { Ok(Found { value: value * finer, choice }) };
                }
                before = Some(excess);
            }
            value *= factor;
        }
        plausible.ok_or(nearest)
    }

    /// The setting from runs over as much of the time as is affordable, or the run that came nearest. `best` is the time of the
    /// quickest that is known to be fit, s.
    fn refined(
        &mut self,
        candidate: &Candidate,
        first: Found,
        best: Option<f64>,
    ) -> Result<Choice, Option<Nearest>> {
        if candidate.is_exact() {
            return Ok(first.choice);
        }
        let (mut value, mut nearest) = (first.value, None);
        let mut taken: Option<Choice> = None;
        let mut seconds = first.choice.seconds.value;
        let (stage, doubt) = (Stage::Run(candidate.name.clone()), self.doubt());
        let (aim, most) = ((AIM - doubt).max(0.1), TAKEN.1.min(1.0 - doubt));
        // across a jump ever shorter steps gain little: that ends where the run could no longer be the one to name
        let (times, least) = LENGTHENED;
        let longest = best.map_or(times * seconds.max(least), |best| (FINALISTS.1 * best).max(least));
        let longest = if candidate.is_adaptive() { f64::INFINITY } else { longest };
        for _ in 0..REFINEMENTS {
            if seconds > longest || (taken.is_some() && self.late(seconds)) {
                break;
            }
            let span = self.reference.long(seconds / self.demand.until, AFFORDABLE).map_err(|_| nearest)?;
            let Some(run) = self.run(candidate, value, &span, Some((&stage, seconds))) else {
                // it was lost: nothing tells by how much
                value *= if candidate.is_adaptive() { LOST_TOLERANCE } else { 0.5 };
                seconds *= 2.0;
                continue;
            };
            let choice = self.expected(candidate, value, &span, &run);
            seconds = choice.seconds.value;
            let excess = self.excess(&choice);
            nearest = self.nearer(nearest, &choice);
            if excess <= most && taken.as_ref().is_none_or(|best| choice.seconds.value < best.seconds.value) {
                taken = Some(choice);
            }
            if excess <= most && excess >= TAKEN.0 {
                break;
            }
            let change = libm::pow(aim / excess, 1.0 / candidate.power()).clamp(0.1, 4.0);
            let larger = value * change;
            // a step of more than a radian is not asked of any method
            let before = value;
            value = if candidate.is_adaptive() {
                larger
            } else {
                larger.min(candidate.coarse(self.reference.rate))
            };
            if !candidate.is_adaptive() {
                seconds *= before / value;
            }
            if value >= larger.max(candidate.coarse(self.reference.rate)) && taken.is_some() {
                break;
            }
        }
        taken.ok_or(nearest)
    }
}

/// The same at a setting finer by `finer`, where errors are smaller by `smaller`.
fn scaled(mut choice: Choice, finer: f64, smaller: f64) -> Choice {
    choice.attitude_error.value *= smaller;
    choice.energy_error = choice.energy_error.map(|energy| energy * smaller);
    choice.seconds.value /= finer;
    if let (Setting::Step(h), Some(steps)) = (choice.setting, choice.steps) {
        let more = libm::ceil(steps as f64 / finer);
        (choice.setting, choice.steps) = (Setting::Step(h * steps as f64 / more), Some(more as u64));
    }
    choice
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inertia::Inertia;
    // named by their types: names would have all methods compiled into the program of these tests
    use crate::method::{AdaptiveTaylor, AnyMethod, ExplicitEuler, Rk4};

    #[test]
    fn a_finer_setting_takes_as_many_times_the_steps_over_the_same_time() {
        let choice = Choice {
            method: "rk4".into(),
            setting: Setting::Step(0.25),
            steps: Some(120),
            attitude_error: Predicted { value: 1e-4, factor: 1.5 },
            energy_error: Some(1e-6),
            seconds: Predicted { value: 2.0, factor: 1.0 },
            whole_time: true,
        };
        let finer = scaled(choice, 0.5, 0.0625);
        assert_eq!((finer.setting, finer.steps), (Setting::Step(0.125), Some(240)));
        assert_eq!((finer.attitude_error.value, finer.energy_error), (6.25e-6, Some(6.25e-8)));
        assert_eq!(finer.seconds.value, 4.0);
        // whole steps, that end when they did: 120/0.7 = 171.4 of 30 s
        let finer = scaled(finer, 0.7, 0.5);
        let (Setting::Step(h), Some(steps)) = (finer.setting, finer.steps) else { panic!("{finer:?}") };
        assert!(steps == 343 && (h * steps as f64 - 30.0).abs() < 1e-13, "{steps} of {h}");
    }

    #[test]
    fn what_is_not_known_of_the_motion_widens_the_stated_error() {
        let inertia = Inertia::from_moments([0.5, 0.85, 1.0]).unwrap();
        let top = Body::heavy(inertia, [0.0, 0.0, 1.0].into()).unwrap();
        let start = top.state(Default::default(), [0.4, 1.2, 0.4].into()).unwrap();
        let start = top.enter(&start).unwrap().to_f64();
        let demand = Demand::new(10.0, 1e-6);
        let reference = Reference::new(&top, start, &demand, &mut |_| {}).unwrap();
        let mut heed = |_: &Progress| {};
        let mut search = Calibration::new(&top, &demand, reference, (Instant::now(), &mut heed)).unwrap();
        let (apart, whole) = (search.reference.truth().apart(), search.reference.short().unwrap());
        let candidate = Candidate::of(Box::new(AdaptiveTaylor::to_rounding()), top.problem()).unwrap();
        let mut run = search.run(&candidate, 1e-8, &whole, Some((&Stage::Methods, 0.0))).unwrap();
        run.attitude = 1e-3 * apart;
        let Predicted { value, factor } = search.expected(&candidate, 1e-8, &whole, &run).attitude_error;
        assert!(apart > 0.0 && value * factor >= 2.0 * apart, "{value:e} by {factor}, known to {apart:e}");
    }

    /// What `look` finds of the candidate `method` for a free body that turns by 1 rad/s, for `until` s and to 1e-6 rad; `heed` is
    /// told how long runs are expected to take.
    fn of<T>(
        method: impl AnyMethod + 'static,
        until: f64,
        heed: &mut dyn FnMut(f64),
        look: impl FnOnce(&mut Calibration<'_>, &Candidate, &Span) -> T,
    ) -> T {
        let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
        let start = body.state(Default::default(), [0.6, 0.0, 0.8].into()).unwrap();
        let start = body.enter(&start).unwrap().to_f64();
        let demand = Demand::new(until, 1e-6);
        let reference = Reference::new(&body, start, &demand, &mut |_| {}).unwrap();
        let mut heed = |progress: &Progress| progress.seconds.into_iter().for_each(&mut *heed);
        let mut search = Calibration::new(&body, &demand, reference, (Instant::now(), &mut heed)).unwrap();
        let short = search.reference.short().unwrap();
        let candidate = Candidate::of(Box::new(method), body.problem()).unwrap();
        look(&mut search, &candidate, &short)
    }

    #[test]
    fn the_whole_time_takes_as_many_times_the_steps_of_a_part_as_it_is_longer() {
        of(Rk4 { normalized: false }, 1024.0, &mut |_| {}, |search, rk4, short| {
            let run = search.run(rk4, 0.25, short, None).unwrap();
            let choice = search.expected(rk4, 0.25, short, &run);
            assert_eq!((short.horizon, choice.whole_time), (512.0, false));
            assert_eq!((choice.steps, choice.setting), (Some(4096), Setting::Step(0.25)));
        });
    }

    #[test]
    fn short_runs_find_a_step_that_meets_the_demand_and_tell_its_error() {
        of(Rk4 { normalized: false }, 64.0, &mut |_| {}, |search, rk4, short| {
            let found = search.first(rk4, short).unwrap();
            let run = search.run(rk4, found.value, short, None).unwrap();
            let (told, seen) = (found.choice.attitude_error.value, run.attitude);
            assert!(seen < 1e-6 && seen > 1e-7, "{seen:e} at {}", found.value);
            assert!(told < 2.0 * seen && told > 0.5 * seen, "{told:e}, {seen:e}");
        });
    }

    #[test]
    fn a_step_that_is_too_long_is_shortened_until_the_demand_is_met() {
        of(Rk4 { normalized: false }, 64.0, &mut |_| {}, |search, rk4, short| {
            let choice = search.first(rk4, short).unwrap().choice;
            let met = search.refined(rk4, Found { value: 0.1, choice }, Some(1e3)).unwrap();
            let error = met.attitude_error.value;
            assert!(error < 1e-6 && error > 1e-7, "{error:e}");
        });
    }

    #[test]
    fn half_the_step_is_expected_to_take_twice_the_time_where_the_attitude_was_lost() {
        let mut told = Vec::new();
        of(ExplicitEuler, 64.0, &mut |seconds| told.push(seconds), |search, euler, short| {
            let run = search.run(euler, 1e-3, short, None).unwrap();
            let mut choice = search.expected(euler, 1e-3, short, &run);
            choice.seconds.value = 1.0;
            assert!(search.refined(euler, Found { value: 0.5, choice }, Some(1e3)).is_err());
        });
        told.dedup();
        assert_eq!(told[..2], [1.0, 2.0]);
    }
}
