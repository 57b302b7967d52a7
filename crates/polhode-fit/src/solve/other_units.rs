//! Mistaken units of a record, found by Euler's equation: rates enter it squared, their derivatives linearly.

use crate::verdict::mistaken_unit::MistakenUnit;
use core::f64::consts::PI;

use polhode::units::RateUnit::{self, DegreesPerSecond, RadiansPerSecond, RevolutionsPerMinute};
use polhode::units::TimeUnit::{self, Microseconds, Milliseconds, Nanoseconds, Seconds};

use crate::columns::model::{Column, columns_of};
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::solve::radius;
use crate::solve::rounds::Noise;
use crate::solve::weak_estimate::WeakEstimate;

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
#[derive(Clone, Debug)]
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
    /// Whether the misfit in the unit that was read is so much larger that no torque noise is likely to be its cause.
    pub(crate) far: bool,
    /// Whether the noise of the rates alone explains the record in the best of them, and by no chance in the unit that was
    /// read: torques would leave more in any unit.
    pub(crate) sure: bool,
    /// Distance from the sphere, as a share of the trace, of the tensor in the unit that was read, where it is that which
    /// speaks against the unit.
    pub(crate) sphere: Option<f64>,
}

/// Differences of χ² up to which units explain a record equally well.
const EQUAL: f64 = 50.0;

/// A factor beyond those of all units.
const ANY: f64 = 1e12;

/// Units that a message lists.
const LISTED: usize = 3;

/// Largest misfit of a unit that explains a record.
const EXPLAINED: f64 = 2.0;

/// Misfit of the first rounds from which no unit comes to explain a record.
const HOPELESS: f64 = 10.0 * EXPLAINED;

/// Fall of the misfit that torque noise is not likely to hide.
const FAR: f64 = 20.0;

/// Standard deviations of the misfit of noise by which the unit that was read must explain less than one in which noise explains
/// all.
const SURELY: f64 = 10.0;

/// Distance from the sphere, as a share of the trace, below which another unit is asked for: rates that are read too large
/// by a factor make a body nearer to a sphere by the same factor.
const SPHERICAL: f64 = 0.01;

/// How much farther from the sphere the body must be in the other unit.
const FARTHER: f64 = 20.0;

/// Samples on which units are tried; one that explains them is tried on those of a pilot.
const SAMPLES: usize = 1_500;

/// Whether an estimate explains its record by a tensor so near to a sphere that a mistaken unit is more likely.
pub(crate) fn suspicious(weak: &WeakEstimate, variance: f64) -> bool {
    weak.settled() && weak.misfit(variance) < EXPLAINED && weak.x().norm() < SPHERICAL
}

/// The units that explain the record, where there are such and the unit that it was read in is none of them: with the
/// columns of `weak`, where it was fitted, and with drag, which slows a body in any, but without torque noise. Where that unit explains it by a
/// body next to a sphere, those in which it is an ordinary body.
pub(crate) fn better_unit(
    stretches: &[Stretch],
    weak: Option<&WeakEstimate>,
    variance: f64,
) -> Option<Better> {
    let pilot = radius::pilot(stretches);
    let drag = columns_of(TorqueModel::Drag);
    let spherical = |weak: &WeakEstimate| suspicious(weak, variance).then(|| weak.x().norm());
    let mut sphere = weak.and_then(spherical);
    let short = radius::longest(stretches, SAMPLES);
    let is_whole = samples(&short) == samples(&pilot);
    let explains = |stretches: &[Stretch], factor: f64| {
        let scaled: Vec<Stretch> = stretches
            .iter()
            .map(|s| Stretch::new(s.times.iter().map(|t| t * factor).collect(), s.rates.clone()))
            .collect();
        let tried = radius::tried(&scaled, &drag, variance, HOPELESS);
        tried.filter(|weak| weak.misfit(variance) < EXPLAINED)
    };
    let read = |stretches: &[Stretch]| radius::tried(stretches, &drag, variance, f64::INFINITY);
    let by_noise = |weak: &Option<WeakEstimate>| {
        weak.as_ref().is_some_and(|weak| weak.misfit(variance) <= weak.expected_misfit())
    };
    let mut quick = None;
    if sphere.is_none() {
        // what a part of the record does not gainsay the whole may not either; where it does, the units are tried first
        let part = read(&short);
        if by_noise(&part) || part.as_ref().and_then(spherical).is_some() {
            let whole = read(&pilot);
            sphere = whole.as_ref().and_then(spherical);
            if sphere.is_none() && by_noise(&whole) {
                return None;
            }
            quick = Some(whole);
        }
    }
    let mut found: Vec<Found> = Vec::new();
    let candidates = MISTAKES.into_iter().map(|(factor, mistake)| (factor, Some(mistake)));
    for (factor, mistake) in candidates.chain([(ANY, None)]) {
        // rates that are read too small make a body that no tensor comes near to
        if sphere.is_some() && factor >= 1.0 {
            continue;
        }
        let tried = explains(&short, factor);
        let whole = if is_whole { tried } else { tried.and_then(|_| explains(&pilot, factor)) };
        let Some(other) = whole else { continue };
        let (misfit, credible) = (other.misfit(variance), credible(&other, variance));
        // next to a sphere the misfits are alike, and the shapes must tell
        if sphere.is_none_or(|distance| credible && other.x().norm() >= FARTHER * distance) {
            let by_noise = misfit <= other.expected_misfit();
            found.push(Found { factor, mistake, misfit, dof: other.dof() as f64, credible, by_noise });
        }
    }
    if found.is_empty() {
        return None;
    }
    if sphere.is_none() && quick.is_none() {
        quick = Some(read(&pilot));
    }
    let quick = quick.flatten();
    if sphere.is_none() && by_noise(&quick) {
        return None;
    }
    let quick = quick.map(|weak| weak.misfit(variance));
    if quick.is_some_and(|misfit| misfit < EXPLAINED) {
        found.retain(|found| found.factor < 1.0);
    }
    found.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let best = found.first()?;
    let as_read = if sphere.is_some() {
        best.misfit
    } else {
        as_read([&short, &pilot], weak, &drag, quick, best.misfit, variance)?
    };
    let sure = best.by_noise && as_read - best.misfit > SURELY * (2.0 / best.dof).sqrt();
    let far = as_read > (FAR * best.misfit).max(EXPLAINED);
    if sphere.is_none() && !sure && !far {
        return None;
    }
    let equal = |f: &Found| (f.misfit - best.misfit) * best.dof <= EQUAL * best.misfit.max(1.0);
    let mut units: Vec<&Found> = found.iter().filter(|f| sphere.is_some() || equal(f)).collect();
    units.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    let any = units.pop_if(|f| f.mistake.is_none()).is_some();
    let vague = sphere.is_none() && (any || units.len() > LISTED);
    units.first().map(|first| Better {
        factor: first.factor,
        mistakes: units.iter().take(LISTED).filter_map(|f| f.mistake).collect(),
        misfit: first.misfit,
        credible: best.credible,
        vague,
        far,
        sure,
        sphere,
    })
}

/// The least misfit in the unit that was read, or less where that is [`FAR`] from `best` as well; `quick` is that of a first
/// trial. `None` where it can not be told.
fn as_read(
    [short, pilot]: [&[Stretch]; 2],
    weak: Option<&WeakEstimate>,
    drag: &[Column],
    quick: Option<f64>,
    best: f64,
    variance: f64,
) -> Option<f64> {
    if let Some(quick) = quick.filter(|quick| *quick > FAR * best) {
        return Some(quick);
    }
    // without columns it is what it is with drag, or more
    let own = weak.map(|weak| weak.columns.as_slice()).filter(|own| !own.is_empty() && *own != drag);
    let descended = |stretches: &[Stretch]| -> Vec<WeakEstimate> {
        let columns = own.into_iter().chain([drag]);
        columns
            .filter_map(|columns| radius::descended(stretches, None, columns, variance, Noise::White).ok())
            .collect()
    };
    let least = |weak: &[WeakEstimate]| weak.iter().map(|weak| weak.misfit(variance)).min_by(f64::total_cmp);
    // what a part of the record leaves, the whole leaves too
    if quick.is_none() {
        let share = samples(short) as f64 / samples(pilot).max(1) as f64;
        let part = descended(short);
        let settled = part.iter().all(WeakEstimate::settled);
        let bound = least(&part).filter(|_| settled).map(|misfit| misfit * share);
        if let Some(bound) = bound.filter(|bound| *bound > (FAR * best).max(EXPLAINED)) {
            return Some(bound);
        }
    }
    least(&descended(pilot)).into_iter().chain(quick).min_by(f64::total_cmp)
}

fn samples(stretches: &[Stretch]) -> usize {
    stretches.iter().map(|s| s.times.len()).sum()
}

/// A unit at which a tensor settled.
struct Found {
    factor: f64,
    /// `None` at a factor beyond all units.
    mistake: Option<MistakenUnit>,
    misfit: f64,
    dof: f64,
    credible: bool,
    /// Whether the noise of the rates alone explains it.
    by_noise: bool,
}

/// Largest standard deviation, relative to the distance from the sphere, of an estimate that supports its unit.
const MAX_RELATIVE_SIGMA: f64 = 0.2;

/// Whether the record determines the estimate: if rates are read too large, a nearly spherical tensor explains most motions.
fn credible(weak: &WeakEstimate, variance: f64) -> bool {
    let Some((singular, _)) = weak.spectrum() else { return false };
    let deviation = (variance * weak.misfit(variance).max(1.0)).sqrt() / singular[4];
    deviation <= MAX_RELATIVE_SIGMA * weak.x().norm()
}
