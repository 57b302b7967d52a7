//! Mistaken units of a record, found by Euler's equation: rates enter it squared, their derivatives linearly.

use core::f64::consts::PI;
use core::fmt;

use super::ladder::columns_of;
use super::model::Column;
use super::radius;
use super::rounds::{Noise, WeakEstimate};
use super::test_functions::Stretch;
use crate::fit::record::RateUnit::{self, DegreesPerSecond, RadiansPerSecond, RevolutionsPerMinute};
use crate::fit::record::TimeUnit::{self, Microseconds, Milliseconds, Nanoseconds, Seconds};
use crate::fit::settings::TorqueModel;

/// A unit of the record that may have been taken for another.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MistakenUnit {
    /// Of the rates.
    Rate {
        /// The unit in which the rates seem to be.
        meant: RateUnit,
        /// The unit in which they were read.
        read: RateUnit,
    },
    /// Of the times.
    Time {
        /// The unit in which the times seem to be.
        meant: TimeUnit,
        /// The unit in which they were read.
        read: TimeUnit,
    },
}

impl fmt::Display for MistakenUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rate { meant, read } => write!(f, "{} taken for {}", meant.words(), read.words()),
            Self::Time { meant, read } => write!(f, "{} taken for {}", meant.words(), read.words()),
        }
    }
}

/// Several in one sentence.
pub(crate) fn alternatives(mistakes: &[MistakenUnit]) -> String {
    mistakes.iter().map(MistakenUnit::to_string).collect::<Vec<_>>().join(", or ")
}

const fn rate(meant: RateUnit, read: RateUnit) -> MistakenUnit {
    MistakenUnit::Rate { meant, read }
}

const fn time(meant: TimeUnit, read: TimeUnit) -> MistakenUnit {
    MistakenUnit::Time { meant, read }
}

/// Mistakes, with their factors on rate × time.
const MISTAKES: [(f64, MistakenUnit); 12] = [
    (PI / 180.0, rate(DegreesPerSecond, RadiansPerSecond)),
    (180.0 / PI, rate(RadiansPerSecond, DegreesPerSecond)),
    (PI / 30.0, rate(RevolutionsPerMinute, RadiansPerSecond)),
    (30.0 / PI, rate(RadiansPerSecond, RevolutionsPerMinute)),
    (6.0, rate(RevolutionsPerMinute, DegreesPerSecond)),
    (1.0 / 6.0, rate(DegreesPerSecond, RevolutionsPerMinute)),
    (1e-3, time(Milliseconds, Seconds)),
    (1e3, time(Seconds, Milliseconds)),
    (1e-6, time(Microseconds, Seconds)),
    (1e6, time(Seconds, Microseconds)),
    (1e-9, time(Nanoseconds, Seconds)),
    (1e9, time(Seconds, Nanoseconds)),
];

/// Units that explain the record better than the one it was read in.
pub(crate) struct Better {
    /// The smallest factor on rate × time.
    pub(crate) factor: f64,
    /// What would have happened, of the smallest factors first.
    pub(crate) mistakes: Vec<MistakenUnit>,
    /// Mean square of the residuals over the noise in that unit.
    pub(crate) misfit: f64,
    /// Whether the record determines the tensor in the best of them.
    pub(crate) credible: bool,
    /// Whether many do, or one of any size: a small wobble then is that of a body next to a sphere.
    pub(crate) vague: bool,
}

/// Differences of χ² up to which units explain a record equally well.
const EQUAL: f64 = 50.0;

/// A factor beyond those of all units.
const ANY: f64 = 1e12;

/// Units that a message lists.
const LISTED: usize = 3;

/// Largest misfit of a unit that explains a record.
const EXPLAINED: f64 = 2.0;

/// The units that explain the record, where there are such and the unit that it was read in is none of them: with the
/// columns that were fitted in that unit, and with drag, which slows a body in any, but without torque noise.
pub(crate) fn better_unit(stretches: &[Stretch], columns: &[Column], variance: f64) -> Option<Better> {
    let pilot = radius::pilot(stretches);
    let drag = columns_of(TorqueModel::Drag);
    let as_read = [columns, &drag[..]].into_iter().any(|columns| {
        let weak = radius::descended(&pilot, None, columns, variance, Noise::White);
        weak.is_ok_and(|weak| weak.settled() && weak.misfit(variance) < EXPLAINED)
    });
    if as_read {
        return None;
    }
    let mut found = Vec::new();
    let candidates = MISTAKES.into_iter().map(|(factor, mistake)| (factor, Some(mistake)));
    for (factor, mistake) in candidates.chain([(ANY, None)]) {
        let scaled: Vec<Stretch> = pilot
            .iter()
            .map(|s| Stretch::new(s.times.iter().map(|t| t * factor).collect(), s.rates.clone()))
            .collect();
        let weak = radius::descended(&scaled, None, &drag, variance, Noise::White);
        let settled = weak.ok().filter(WeakEstimate::settled);
        found.extend(settled.map(|weak| Found {
            factor,
            mistake,
            misfit: weak.misfit(variance),
            dof: weak.dof() as f64,
            credible: credible(&weak, variance),
        }));
    }
    found.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let best = found.first().filter(|best| best.misfit < EXPLAINED)?;
    let equal = |f: &Found| (f.misfit - best.misfit) * best.dof <= EQUAL * best.misfit.max(1.0);
    let mut units: Vec<&Found> = found.iter().filter(|f| equal(f)).collect();
    units.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    let vague = units.pop_if(|f| f.mistake.is_none()).is_some() || units.len() > LISTED;
    units.first().map(|first| Better {
        factor: first.factor,
        mistakes: units.iter().take(LISTED).filter_map(|f| f.mistake).collect(),
        misfit: first.misfit,
        credible: best.credible,
        vague,
    })
}

/// A unit at which a tensor settled.
struct Found {
    factor: f64,
    /// `None` at a factor beyond all units.
    mistake: Option<MistakenUnit>,
    misfit: f64,
    dof: f64,
    credible: bool,
}

/// Largest standard deviation, relative to the distance from the sphere, of an estimate that supports its unit.
const MAX_RELATIVE_SIGMA: f64 = 0.2;

/// Whether the record determines the estimate: if rates are read too large, a nearly spherical tensor explains most motions.
fn credible(weak: &WeakEstimate, variance: f64) -> bool {
    let Some((singular, _)) = weak.spectrum() else { return false };
    let deviation = (variance * weak.misfit(variance).max(1.0)).sqrt() / singular[4];
    deviation <= MAX_RELATIVE_SIGMA * weak.x().norm()
}
