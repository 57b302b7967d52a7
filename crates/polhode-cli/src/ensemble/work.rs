//! The members of a shard, propagated and written as they come.

use std::fmt;
use std::io::{self, IsTerminal as _};
use std::ops::Range;
use std::path::Path;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use nalgebra::{UnitQuaternion, Vector3};
use polhode::observe::Errors;
use polhode::run::{Ensemble, EnsembleError, Observed, Rows};
use polhode_files::error::{Error, tell};
use polhode_files::npy::Array;
use polhode_pages::output::{Staging, unwritable};

use super::Means;
use super::passages::{Passage, passages};
use super::spec::{Motion, Spec};

/// Names of the arrays.
pub(super) const ATTITUDES: &str = "attitudes.npy";
pub(super) const OMEGAS: &str = "omegas.npy";

/// What a shard has besides its arrays.
#[derive(Debug, Default)]
pub(super) struct Shares {
    /// Times of the rows, s.
    pub(super) times: Vec<f64>,
    /// Of every time.
    pub(super) largest: Vec<Largest>,
    /// Members that have no rows from some time on.
    pub(super) failures: Vec<Failure>,
    /// Where an event is looked for.
    pub(super) passages: Vec<Passage>,
    /// Tensors that were drawn.
    pub(super) draws: u64,
}

/// Largest errors of the members at one time; `None` where nothing of the kind is conserved or watched.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Largest {
    pub(super) energy: Option<f64>,
    pub(super) momentum_vector: Option<f64>,
}

impl Largest {
    /// The larger of two; the same in any order.
    pub(super) fn or(self, other: Self) -> Self {
        let larger = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(a.max(b)),
            (a, b) => a.or(b),
        };
        Self {
            energy: larger(self.energy, other.energy),
            momentum_vector: larger(self.momentum_vector, other.momentum_vector),
        }
    }
}

/// A member without rows from some time on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Failure {
    pub(super) member: u64,
    pub(super) t: f64,
    pub(super) reason: String,
}

/// Why the work stopped.
enum Stop {
    All(EnsembleError),
    Unwritten(io::Error),
}

impl From<EnsembleError> for Stop {
    fn from(error: EnsembleError) -> Self {
        Self::All(error)
    }
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        Self::Unwritten(error)
    }
}

/// Arrays of a shard in the making, and where they will stand.
pub(super) struct Arrays {
    pub(super) attitudes: Array<4>,
    omegas: Option<Array<3>>,
}

/// Propagates the members of `range` and writes their arrays.
pub(super) fn propagate(
    spec: &Spec,
    range: Range<u64>,
    means: Means,
    staging: &Staging,
    folder: &Path,
) -> Result<(Arrays, Shares), Error> {
    let (times, count) = (spec.plan.times.len() as u64, range.end - range.start);
    let made = |error: io::Error| unwritable("--out", folder, &error);
    let mut arrays = Arrays {
        attitudes: Array::create(staging.file(ATTITUDES)?, times, count).map_err(made)?,
        omegas: match spec.omegas {
            true => Some(Array::create(staging.file(OMEGAS)?, times, count).map_err(made)?),
            false => None,
        },
    };
    let mut shares = Shares {
        times: spec.plan.times.clone(),
        largest: vec![Largest::default(); times as usize],
        ..Shares::default()
    };
    let first = range.start;
    let ensemble = members(spec, range, means, &mut shares)?;
    let bar = progress(count);
    let each = |rows: &Rows| -> Result<(), Stop> {
        take(rows, &mut arrays, &mut shares, first)?;
        bar.inc(rows.members() as u64);
        Ok(())
    };
    let done = match &spec.plan.motion {
        Motion::Stepped { method, clock, steps, .. } => {
            ensemble.advance(method.as_ref(), *clock, steps, each)
        }
        Motion::Exact { elapsed } => ensemble.at(elapsed, each),
    };
    bar.finish_and_clear();
    match done {
        Ok(()) => {}
        Err(Stop::All(error)) => return Err(Error::Input(format!("{}: {error}", spec.path.display()))),
        Err(Stop::Unwritten(error)) => return Err(made(error)),
    }
    if let Some(watched) = &spec.watched {
        if watched.may_miss {
            let (event, spacing) = (watched.event.text(), watched.spacing);
            let rule = "may be missed; every in [event] sets the time between looks";
            tell("note", &format!("{event}: what begins and ends within {spacing} s {rule}"));
        }
        shares.passages = passages(spec, watched, &ensemble, first);
    }
    arrays.attitudes.sync().map_err(made)?;
    if let Some(omegas) = &arrays.omegas {
        omegas.sync().map_err(made)?;
    }
    Ok((arrays, shares))
}

/// The members as an ensemble of the library.
fn members(spec: &Spec, range: Range<u64>, means: Means, shares: &mut Shares) -> Result<Ensemble, Error> {
    let acting = spec.acting();
    let mut ensemble = Ensemble::with_capacity((range.end - range.start) as usize)
        .carrying(acting.wheels().to_vec())
        .acted_on(move |inertia| acting.on(inertia))
        .observing(Observed::default().with_invariants(spec.plan.errors))
        .by(means.instructions)
        .threads(means.threads);
    for k in range {
        let member = spec.member(k).map_err(|error| {
            Error::Input(format!("{}: member {}: {error}; give it less spread", spec.path.display(), k + 1))
        })?;
        shares.draws += u64::from(member.draws);
        let attitude = UnitQuaternion::from(member.attitude);
        ensemble.push_omega(&member.inertia, attitude, Vector3::from(member.omega_body));
    }
    Ok(ensemble)
}

/// Writes the rows of one part.
fn take(rows: &Rows, arrays: &mut Arrays, shares: &mut Shares, first: u64) -> Result<(), Stop> {
    let place = rows.first() as u64;
    for time in 0..rows.times() {
        let attitudes = rows.states(time).iter().map(|state| state.attitude.components());
        arrays.attitudes.write(time as u64, place, attitudes)?;
        if let Some(omegas) = &mut arrays.omegas {
            omegas.write(time as u64, place, rows.omegas(time).iter().map(|omega| (*omega).into()))?;
        }
        let of = |errors: &Errors| Largest { energy: errors.energy, momentum_vector: errors.momentum_vector };
        let errors = rows.errors(time).into_iter().flatten().map(of);
        shares.largest[time] = errors.fold(shares.largest[time], Largest::or);
    }
    for (member, time, error) in rows.failures() {
        let t = shares.times.get(time).copied().unwrap_or_default();
        shares.failures.push(Failure { member: first + member as u64 + 1, t, reason: error.to_string() });
    }
    Ok(())
}

/// A bar with rate and time left, on a terminal and for work of more than a second.
fn progress(members: u64) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(members);
    let template = "{bar:30} {pos}/{len} members, {rate} a second, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        let rate = |state: &ProgressState, text: &mut dyn fmt::Write| {
            let _ = write!(text, "{:.0}", state.per_sec());
        };
        bar.set_style(style.with_key("rate", rate));
    }
    bar.enable_steady_tick(Duration::from_secs(1));
    bar
}
