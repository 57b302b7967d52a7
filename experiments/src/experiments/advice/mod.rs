//! Whether advice keeps its word, on random bodies, starts, times and demands under every kind of force.
//!
//! # Definitions
//! A demand is an attitude error E up to a time T. *Met*: a method was named, and the largest error of its run at 61 looks up to T
//! is at most E and at most the predicted error times the stated factor. *Missed*: a method was named, and the error is larger than
//! either. *Refused*: no method was named; the reason is that of the refusal. The thinking time is the processor time of all threads
//! until the answer (where the system does not tell it, what passes), so that other programs on the machine do not count, and its
//! ratio is that over two seconds and ten times the run that was named; of a refusal, over two seconds.
//!
//! What is refused because of the motion is the same on every machine. A motion that is *undecided*, and a demand that is *unreached*,
//! may be met on a quicker machine, or a less busy one: their counts, and that of the demands that are met, stand with the times.
//!
//! The true motion is Taylor's method to the rounding of a double, which is neither of the two methods that advice follows a motion
//! by, never what is compared with itself (`taylor` is excluded from the advice), and is begun anew at every look; where it says
//! *missed*, Taylor's method in double-double decides. A thruster that is switched is followed from switch to switch.
//!
//! E is log-uniform from 1e-9 to 1e-3 rad, and the turn to T log-uniform from 10 rad on, by the rate at the start; of spin-ups, by
//! the mean rate. Pulses of thrusters last a radian of the turn at the start or more.

mod problems;

use std::time::Instant;

use polhode::advise::{Advice, AdviseError, Choice, Setting, advise};
use polhode::body::{Body, Clock, Point};
use polhode::method::{AdaptiveTaylor, AnyMethod as _, Step, StepError, method};
use polhode::num::Precise;
use polhode::run::{Run, Watch};
use polhode::truth::attitude_error;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Cell, Column, Table, row};

use self::problems::{KINDS, Problem};
use crate::experiment::{Context, Report};

/// Looks at a run.
const LOOKS: u64 = 61;
const SEED: u64 = 1834;

/// Reasons of refusals that lie in the motion, in the order of the columns, and those that the time to think decides.
const LASTING: [&str; 4] = ["conditioning", "chaotic", "jumps", "other"];
const PASSING: [&str; 2] = ["undecided", "unreached"];

/// The part of the demands that may be refused for want of time.
const OPEN: f64 = 0.1;

/// Why no method was named.
#[derive(Clone, Copy, PartialEq)]
enum Reason {
    /// Which of [`LASTING`].
    Lasting(usize),
    /// Which of [`PASSING`].
    Passing(usize),
}

/// The clocks at the beginning of a thought.
struct Thinking {
    passed: Instant,
    processor: Option<f64>,
}

impl Thinking {
    fn begun() -> Self {
        Thinking { passed: Instant::now(), processor: processor_seconds() }
    }

    /// The processor time since then, s.
    fn seconds(&self) -> f64 {
        let used = processor_seconds().zip(self.processor).map(|(now, begun)| now - begun);
        used.unwrap_or_else(|| self.passed.elapsed().as_secs_f64())
    }
}

/// The processor time of this program so far, s, where the system tells it.
#[cfg(target_os = "linux")]
fn processor_seconds() -> Option<f64> {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

/// The processor time of this program so far, s, where the system tells it.
#[cfg(not(target_os = "linux"))]
fn processor_seconds() -> Option<f64> {
    None
}

/// What became of a demand.
enum Outcome {
    Met,
    Missed(String),
    Refused(Reason),
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let each = context.scale.pick(2, 2, 46);
    let longest = context.scale.pick(60.0, 3e2, 1e5);
    let problems = problems::all(SEED, each, longest)?;
    // one after the other, as a user asks: the threads of others would count as thinking
    let mut asked = Vec::new();
    for problem in problems {
        let begun = Thinking::begun();
        let advice = advise(&problem.body, &problem.start, &problem.demand);
        let thought = begun.seconds();
        asked.push((problem, advice, thought));
    }
    let judged = context.in_parallel(asked, |(problem, advice, thought)| {
        let seconds = advice.as_ref().map_or(0.0, |advice| advice.best.seconds.value);
        let ratio = thought / (2.0 + 10.0 * seconds);
        Ok((problem.kind, judged(&problem, advice)?, thought, ratio))
    });
    let judged = judged.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let mut report = Report { seed: Some(SEED), ..Report::default() };
    let mut table = Table::new("advice", caption(each, longest), columns());
    let mut timing =
        Table::new("timing", "Processor time until the answer, and what it decides.", timing_columns());
    let (mut slow, mut open) = (0, 0);
    for (kind, name) in KINDS.iter().enumerate() {
        let of: Vec<_> = judged.iter().filter(|judged| judged.0 == kind).collect();
        let count = |is: &dyn Fn(&Outcome) -> bool| of.iter().filter(|judged| is(&judged.1)).count();
        let refused = |reason| count(&|outcome| matches!(outcome, Outcome::Refused(r) if *r == reason));
        let missed = count(&|outcome| matches!(outcome, Outcome::Missed(_)));
        let lasting = (0..LASTING.len()).map(|k| refused(Reason::Lasting(k)));
        let cell = |n: usize| Cell::Integer(n as i64);
        let counts = [of.len(), missed].into_iter().chain(lasting).map(cell);
        table.push(std::iter::once(Cell::from(*name)).chain(counts));
        for (_, outcome, ..) in &of {
            if let Outcome::Missed(how) = outcome {
                report.failures.push(format!("{name}: {how}"));
            }
        }
        let mut thoughts: Vec<f64> = of.iter().map(|judged| judged.2).collect();
        thoughts.sort_by(f64::total_cmp);
        let ratio = of.iter().map(|judged| judged.3).fold(0.0, f64::max);
        slow += of.iter().filter(|judged| judged.3 > 1.0).count();
        let median = thoughts.get(thoughts.len() / 2).copied().unwrap_or_default();
        let met = count(&|outcome| matches!(outcome, Outcome::Met));
        let passing = [0, 1].map(|k| refused(Reason::Passing(k)));
        open += passing.iter().sum::<usize>();
        let [undecided, unreached] = passing.map(cell);
        let longest = thoughts.last().copied().unwrap_or_default();
        timing.push(row![*name, cell(met), undecided, unreached, median, longest, ratio]);
    }
    timing.caption =
        format!("{} {slow} of {} took longer than ten runs and two seconds.", timing.caption, judged.len());
    if open as f64 > OPEN * judged.len() as f64 {
        report.failures.push(format!("{open} of {} refused for want of time", judged.len()));
    }
    report.tables.push(table);
    report.timing = Some(timing);
    Ok(report)
}

fn caption(each: usize, longest: f64) -> String {
    format!(
        "Random demands on the attitude, {each} under each kind of force, turns of 10 to {longest} rad: missed beyond the stated \
         factor, and refused by reason."
    )
}

fn columns() -> Vec<Column> {
    let mut columns = vec![
        Column::new("force", "", "what acts"),
        Column::new("asked", "", "demands"),
        Column::new("missed", "", "a method was named, and its error is larger than demanded or stated"),
    ];
    columns.extend(LASTING.map(|reason| Column::new(reason, "", "refusals for this reason")));
    columns
}

fn timing_columns() -> Vec<Column> {
    let mut columns = vec![
        Column::new("force", "", "what acts"),
        Column::new("met", "", "a method was named, and its error is as demanded and as stated"),
    ];
    columns.extend(PASSING.map(|reason| Column::new(reason, "", "refusals for this reason")));
    columns.extend([
        Column::new("median", "s", "processor time until the answer, the middle one").digits(2),
        Column::new("longest", "s", "the longest").digits(2),
        Column::new("ratio", "", "the largest over two seconds and ten times the run that was named")
            .digits(2),
    ]);
    columns
}

fn judged(problem: &Problem, advice: Result<Advice, AdviseError>) -> Result<Outcome, Error> {
    let best = match advice {
        Ok(advice) => advice.best,
        Err(error) => return Ok(Outcome::Refused(reason(&error))),
    };
    let stated = best.attitude_error.value * best.attitude_error.factor;
    let most = stated.min(problem.demand.attitude_error);
    let looks = looks(problem, &best)?;
    let taylor = AdaptiveTaylor::to_rounding();
    let start = problem.body.enter(&problem.start).map_err(unexpected)?.to_f64();
    let mut error = largest(problem, start, &looks, |clock, body| taylor.prepare_f64(clock, body))?;
    if error > most {
        error = largest(problem, start.to_dd(), &looks, |clock, body| taylor.prepare_dd(clock, body))?;
    }
    if error <= most {
        return Ok(Outcome::Met);
    }
    let (asked, until) = (problem.demand.attitude_error, problem.demand.until);
    let (value, factor) = (best.attitude_error.value, best.attitude_error.factor);
    Ok(Outcome::Missed(format!(
        "{} {:?} to {until:.3e} s: {error:.2e} rad; {asked:.2e} were asked for, {value:.2e} within {factor:.2} stated",
        best.method, best.setting
    )))
}

fn reason(error: &AdviseError) -> Reason {
    match error {
        AdviseError::Conditioning { .. } => Reason::Lasting(0),
        AdviseError::Chaotic { .. } => Reason::Lasting(1),
        AdviseError::Jumps { .. } | AdviseError::LongAcrossJump { .. } => Reason::Lasting(2),
        AdviseError::Undecided { .. } => Reason::Passing(0),
        AdviseError::Unreached { .. } => Reason::Passing(1),
        _ => Reason::Lasting(3),
    }
}

/// The run of `best`, with the times of the looks, s.
fn looks(problem: &Problem, best: &Choice) -> Result<Vec<(f64, Point<f64>)>, Error> {
    let mut of_name = method(&best.method).map_err(unexpected)?;
    let (step, steps) = match best.setting {
        Setting::Step(step) => (step, best.steps.unwrap_or(1)),
        Setting::Tolerance { tolerance, .. } => {
            of_name = of_name.with_tolerance(tolerance).map_err(unexpected)?;
            (problem.demand.until / LOOKS as f64, LOOKS)
        }
        _ => return Err(Error::Input("a closed form was named where none was wanted".into())),
    };
    let run = Run::new(&of_name, &problem.body, &problem.start, step).map_err(unexpected)?;
    let mut run = run.watching(Watch::Never);
    let mut looks = Vec::new();
    for k in 1..=LOOKS {
        let sample = run.advance_to(steps * k / LOOKS).map_err(unexpected)?;
        looks.push((sample.elapsed.hi(), sample.point));
    }
    looks.dedup_by(|a, b| a.0 == b.0);
    looks.retain(|(time, _)| *time > 0.0);
    Ok(looks)
}

/// The largest attitude error at `looks`, rad, against the motion by the steps that `prepare` makes.
fn largest<S: Precise>(
    problem: &Problem,
    start: Point<S>,
    looks: &[(f64, Point<f64>)],
    prepare: impl Fn(Clock, &Body) -> Result<Box<dyn Step<S>>, StepError>,
) -> Result<f64, Error> {
    let (mut x, mut from, mut worst) = (start, 0.0, 0.0_f64);
    for (to, look) in looks {
        while from < *to {
            let (end, body) = problem.law_at(from);
            let next = end.min(*to);
            let clock = Clock { start: from, step: next - from };
            let mut moved = Point::new(x.attitude.normalized(), x.momentum_body);
            prepare(clock, body).map_err(unexpected)?.steps(&mut moved, 1);
            (x, from) = (moved, next);
        }
        worst = worst.max(attitude_error(look.attitude, x.to_dd().attitude));
    }
    Ok(worst)
}
