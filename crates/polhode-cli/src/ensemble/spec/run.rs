//! What is done with the members: times, and the method by which they get there.

use std::path::Path;
use std::sync::Arc;

use polhode::body::{Body, Clock};
use polhode::flow::ExactMotion;
use polhode::method::{AnyMethod, Claimed, method};
use polhode::rotation::{Quat, Vec3};
use polhode::run::Schedule;
use polhode_files::error::{Error, unexpected};
use polhode_files::instant::Epoch;
use polhode_files::toml_file::Section;
use toml::Spanned;
use toml::de::DeValue;

use super::nominal::Nominal;
use crate::flags::times::{Regular, of_file, regular};
use crate::methods::{Unusable, adaptive, at_tolerance, unknown};

const KEYS: [&str; 12] = [
    "members",
    "seed",
    "method",
    "step",
    "tolerance",
    "times",
    "times_file",
    "times_column",
    "until",
    "every",
    "start_time",
    "errors",
];

/// Times of the rows and how members get there.
#[derive(Clone, Debug)]
pub(in crate::ensemble) struct Plan {
    /// Time of the start, s.
    pub(in crate::ensemble) start: f64,
    /// Times of the rows, s.
    pub(in crate::ensemble) times: Vec<f64>,
    pub(in crate::ensemble) motion: Motion,
    /// Whether errors of the invariants are watched in every row.
    pub(in crate::ensemble) errors: bool,
}

#[derive(Clone, Debug)]
pub(in crate::ensemble) enum Motion {
    /// In closed form; times since the start, s.
    Exact { elapsed: Vec<f64> },
    /// By a method, and the number of steps to each row.
    Stepped { name: String, method: Arc<dyn AnyMethod>, clock: Clock, steps: Vec<u64> },
}

impl Plan {
    pub(super) fn read(run: &Section<'_>, nominal: &Nominal) -> Result<Self, Error> {
        run.only("[run]", &KEYS)?;
        let epoch = nominal.epoch;
        let start = run.moment("start_time", epoch)?.unwrap_or(0.0);
        let every = run.seconds("every")?;
        let times = times(run, start, every, epoch)?;
        let name = run.text("method")?.unwrap_or("exact");
        let tolerance = run.positive("tolerance")?;
        let step = run.seconds("step")?;
        let motion = if name == "exact" {
            if tolerance.is_some() {
                return Err(run.at("tolerance", &without_tolerance(name)));
            }
            if step.is_some() {
                return Err(
                    run.at("step", "method exact takes no step; leave it out, or name a stepping method")
                );
            }
            let elapsed = times.iter().map(|t| t - start).collect();
            Motion::Exact { elapsed }
        } else {
            let found = method_of(run, name, tolerance)?;
            let regular = every.filter(|every| found.tolerance().is_some() && *every > 0.0);
            let missing = || run.at("step", &format!("missing; method {name} needs a step in seconds"));
            let clock = Clock { start, step: step.or(regular).ok_or_else(missing)? };
            if let Some(inertia) = &nominal.inertia {
                let omega = nominal.omega.unwrap_or_else(Vec3::zero);
                let body = nominal.acting.of_start(inertia.clone(), start, omega).map_err(unexpected)?;
                found.prepare_f64(clock, &body).map_err(|error| run.at("method", &error.to_string()))?;
            }
            let count = |t: &f64| {
                let steps =
                    Schedule::at_times(clock, &[*t]).map_err(|error| run.at("step", &error.to_string()))?;
                Ok(steps.into_iter().last().unwrap_or(0))
            };
            let steps: Vec<u64> = times.iter().map(count).collect::<Result<_, Error>>()?;
            if let Some(k) = (1..steps.len()).find(|k| steps[*k] < steps[*k - 1]) {
                let rule = format!(
                    "{:?} comes after {:?}; a stepping method needs ascending times",
                    times[k],
                    times[k - 1]
                );
                let key = if run.value("times_file").is_some() { "times_file" } else { "times" };
                return Err(run.at(key, &format!("{rule}; sort them, or use method exact")));
            }
            let name = if tolerance.is_some() { found.name() } else { name.into() };
            Motion::Stepped { name, method: found.into(), clock, steps }
        };
        let errors = match run.value("errors").map(Spanned::get_ref) {
            None => true,
            Some(DeValue::Boolean(errors)) => *errors,
            Some(other) => {
                return Err(run.at("errors", &format!("{} given, true or false needed", other.type_str())));
            }
        };
        Ok(Self { start, times, motion, errors })
    }

    /// Whether the nominal member can be followed so far; what is wrong with it is mostly wrong with all.
    pub(super) fn check_nominal(&self, run: &Section<'_>, nominal: &Nominal) -> Result<(), Error> {
        let (Some(inertia), Some(omega)) = (&nominal.inertia, nominal.omega) else { return Ok(()) };
        let body = nominal.acting.of_start(inertia.clone(), self.start, omega).map_err(unexpected)?;
        self.check(&body, nominal.attitude, omega).map_err(|error| {
            let message = format!(
                "{error}; name a stepping method and a step, such as method = \"kick-drift@srkn-6b\""
            );
            run.at("method", &message)
        })
    }

    /// Whether a body has a motion in closed form as far as the last time, where that is asked for.
    pub(super) fn check(&self, body: &Body, attitude: Quat<f64>, omega: Vec3<f64>) -> Result<(), String> {
        let start = body.enter_omega(attitude, omega).map_err(|error| error.to_string())?;
        let Motion::Exact { elapsed } = &self.motion else { return Ok(()) };
        let motion = ExactMotion::from_point(body, start).map_err(|error| error.to_string())?;
        let out_of_reach = elapsed.iter().find_map(|t| motion.check_time(*t).err());
        out_of_reach.map_or(Ok(()), |error| Err(error.to_string()))
    }

    /// The name of the method.
    pub(in crate::ensemble) fn method_name(&self) -> &str {
        match &self.motion {
            Motion::Exact { .. } => "exact",
            Motion::Stepped { name, .. } => name,
        }
    }
}

/// The method `name`, at the tolerance where one is given.
fn method_of(run: &Section<'_>, name: &str, tolerance: Option<f64>) -> Result<Box<dyn AnyMethod>, Error> {
    let unknown = |error| unknown(&run.file.line(run.place_of("method")), error);
    let Some(tolerance) = tolerance else { return method(name).map_err(unknown) };
    at_tolerance(name, tolerance).map_err(|why| {
        let rule = match why {
            Unusable::Unknown(error) => return unknown(error),
            Unusable::FixedSteps => without_tolerance(name),
            Unusable::Twice => format!("method {name} has one already; give one of the two"),
            Unusable::OutOfRange(allowed) => {
                format!("method {name} cannot take {tolerance:e}; allowed: {allowed}")
            }
        };
        run.at("tolerance", &rule)
    })
}

fn without_tolerance(name: &str) -> String {
    format!("method {name} does not choose its steps; leave it out, or use one of {}", adaptive())
}

/// The times in a file that stands beside the specification.
fn times_of_file(run: &Section<'_>, epoch: Option<Epoch>) -> Result<Option<Vec<f64>>, Error> {
    let column = match run.value("times_column").map(Spanned::get_ref) {
        Some(DeValue::Integer(number)) => Some(number.to_string()),
        _ => run.text("times_column")?.map(String::from),
    };
    let Some(name) = run.text("times_file")? else {
        return match column {
            Some(_) => Err(run.at("times_column", "names a column of a file; give times_file too")),
            None => Ok(None),
        };
    };
    let path = run.file.path.parent().unwrap_or(Path::new("")).join(name);
    let place = format!("{}: key 'times_file'", run.file.line(run.place_of("times_file")));
    of_file(path, column, place, epoch).map(Some)
}

fn times(run: &Section<'_>, start: f64, every: Option<f64>, epoch: Option<Epoch>) -> Result<Vec<f64>, Error> {
    let until = run.moment("until", epoch)?;
    let list = run.moments("times", epoch)?;
    let key = if run.value("times_file").is_some() { "times_file" } else { "times" };
    if list.is_some() && key == "times_file" {
        return Err(run.at(key, "given beside times; leave one of them out"));
    }
    let file = times_of_file(run, epoch)?;
    let found = match (list.or(file), until, every) {
        (Some(list), None, None) => list,
        (Some(_), ..) => return Err(run.at(key, "given beside until and every; leave one of them out")),
        (None, Some(until), Some(every)) => {
            let found = regular(start, until, every).and_then(Regular::kept);
            found.map_err(|error| run.at("every", error.strip_prefix("--every: ").unwrap_or(&error)))?
        }
        (None, None, None) => {
            return Err(run.at("times", "missing; give times, times_file, or until and every"));
        }
        (None, None, Some(_)) => return Err(run.at("every", "needs the last time; give until too")),
        (None, Some(_), None) => return Err(run.at("until", "needs the time between rows; give every too")),
    };
    if found.is_empty() {
        return Err(run.at("times", "give at least one time"));
    }
    Ok(found)
}
