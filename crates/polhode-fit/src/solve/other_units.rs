//! Mistaken units of a record, found by Euler's equation: rates enter it squared, their derivatives linearly.

use crate::thresholds::units::{
    ANY, CREDIBLE, EQUAL, EXPLAINED, FAR, FARTHER, HOPELESS, LISTED, SAMPLES, SPHERICAL, SURELY,
};
use crate::verdict::mistaken_unit::MistakenUnit;
use core::f64::consts::PI;

use polhode::units::RateUnit::{self, DegreesPerSecond, RadiansPerSecond, RevolutionsPerMinute};
use polhode::units::TimeUnit::{self, Microseconds, Milliseconds, Nanoseconds, Seconds};

use crate::columns::column::Column;
use crate::columns::sets::torque_columns;
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

/// What the units that explain a record tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Support {
    /// Few do, and the record determines the tensor in the best of them: they can be named.
    Named,
    /// Many do, or one of any size: a small wobble then is that of a body next to a sphere.
    Any {
        /// Whether the record determines the tensor in the best of them.
        determined: bool,
        /// Whether the misfit in the unit that was read is so much larger that no torque noise is likely to be its cause.
        far: bool,
    },
    /// Few do, and the record determines the tensor in none of them.
    Undetermined,
}

/// Units that explain the record better than the one it was read in.
#[derive(Clone, Debug)]
pub(crate) struct Better {
    /// The smallest factor on rate × time.
    pub(crate) factor: f64,
    /// What would have happened, of the smallest factors first.
    pub(crate) mistakes: Vec<MistakenUnit>,
    /// Mean square of the residuals over the noise in that unit.
    pub(crate) misfit: f64,
    /// What they tell.
    pub(crate) support: Support,
    /// Distance from the sphere, as a share of the trace, of the tensor in the unit that was read, where it is that which
    /// speaks against the unit.
    pub(crate) sphere: Option<f64>,
}

/// Whether an estimate explains its record by a tensor so near to a sphere that a mistaken unit is more likely.
pub(crate) fn suspicious(weak: &WeakEstimate, variance: f64) -> bool {
    weak.has_settled() && weak.misfit(variance) < EXPLAINED && weak.x().norm() < SPHERICAL
}

/// The units that explain the record, where there are such and the unit that it was read in is none of them: with the
/// columns of `weak`, where it was fitted, and with drag, which slows a body in any, but without torque noise. Where that unit explains it by a
/// body next to a sphere, those in which it is an ordinary body.
pub(crate) fn better_unit(
    stretches: &[Stretch],
    weak: Option<&WeakEstimate>,
    variance: f64,
) -> Option<Better> {
    let trial = Trial::new(stretches, variance);
    let read = trial.read(weak)?;
    let sphere = read.sphere;
    let mut found = trial.units(sphere);
    if found.is_empty() {
        return None;
    }
    let quick = match read.quick {
        None if sphere.is_none() => trial.as_read(&trial.pilot),
        quick => quick.flatten(),
    };
    if sphere.is_none() && trial.is_noise(quick.as_ref()) {
        return None;
    }
    let quick = quick.map(|weak| weak.misfit(variance));
    if quick.is_some_and(|misfit| misfit < EXPLAINED) {
        found.retain(|found| found.factor < 1.0);
    }
    found.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let best = found.first()?;
    let as_read = match sphere {
        Some(_) => best.misfit,
        None => as_read([&trial.short, &trial.pilot], weak, &trial.drag, quick, best.misfit, variance)?,
    };
    let far = as_read > (FAR * best.misfit).max(EXPLAINED);
    // the noise of the rates alone explains the record in the best of them: torques would leave more in any unit
    let sure = best.by_noise && as_read - best.misfit > SURELY * (2.0 / best.dof).sqrt();
    if sphere.is_none() && !sure && !far {
        return None;
    }
    let equal = |f: &Found| (f.misfit - best.misfit) * best.dof <= EQUAL * best.misfit.max(1.0);
    let mut units: Vec<&Found> = found.iter().filter(|f| sphere.is_some() || equal(f)).collect();
    units.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    let any = units.pop_if(|f| f.mistake.is_none()).is_some();
    let support = match sphere.is_none() && (any || units.len() > LISTED) {
        true => Support::Any { determined: best.credible, far },
        false if best.credible => Support::Named,
        false => Support::Undetermined,
    };
    units.first().map(|first| Better {
        factor: first.factor,
        mistakes: units.iter().take(LISTED).filter_map(|f| f.mistake).collect(),
        misfit: first.misfit,
        support,
        sphere,
    })
}

/// A record in the unit that it was read in.
struct AsRead {
    /// Distance from the sphere of the tensor, where it is that which speaks against the unit.
    sphere: Option<f64>,
    /// The estimate of a first trial, where one was made.
    quick: Option<Option<WeakEstimate>>,
}

/// The samples on which units are tried.
struct Trial {
    short: Vec<Stretch>,
    pilot: Vec<Stretch>,
    /// Drag slows a body in any unit.
    drag: Vec<Column>,
    variance: f64,
}

impl Trial {
    fn new(stretches: &[Stretch], variance: f64) -> Trial {
        Trial {
            short: radius::longest(stretches, SAMPLES),
            pilot: radius::pilot(stretches),
            drag: torque_columns(TorqueModel::Drag),
            variance,
        }
    }

    fn as_read(&self, stretches: &[Stretch]) -> Option<WeakEstimate> {
        radius::tried(stretches, &self.drag, self.variance, f64::INFINITY)
    }

    fn explains(&self, stretches: &[Stretch], factor: f64) -> Option<WeakEstimate> {
        let scaled: Vec<Stretch> = stretches
            .iter()
            .map(|s| Stretch::new(s.times.iter().map(|t| t * factor).collect(), s.rates.clone()))
            .collect();
        let tried = radius::tried(&scaled, &self.drag, self.variance, HOPELESS);
        tried.filter(|weak| weak.misfit(self.variance) < EXPLAINED)
    }

    fn is_noise(&self, weak: Option<&WeakEstimate>) -> bool {
        weak.is_some_and(|weak| weak.misfit(self.variance) <= weak.expected_misfit())
    }

    /// What stands of the unit that was read; `None` where noise explains the record in it.
    fn read(&self, weak: Option<&WeakEstimate>) -> Option<AsRead> {
        let spherical = |weak: &WeakEstimate| suspicious(weak, self.variance).then(|| weak.x().norm());
        let sphere = weak.and_then(spherical);
        if sphere.is_some() {
            return Some(AsRead { sphere, quick: None });
        }
        // what a part of the record does not gainsay the whole may not either; where it does, the units are tried first
        let part = self.as_read(&self.short);
        if !self.is_noise(part.as_ref()) && part.as_ref().and_then(spherical).is_none() {
            return Some(AsRead { sphere, quick: None });
        }
        let whole = self.as_read(&self.pilot);
        let sphere = whole.as_ref().and_then(spherical);
        let explained = sphere.is_none() && self.is_noise(whole.as_ref());
        (!explained).then_some(AsRead { sphere, quick: Some(whole) })
    }

    /// The units that explain the record.
    fn units(&self, sphere: Option<f64>) -> Vec<Found> {
        let is_whole = samples(&self.short) == samples(&self.pilot);
        let mut found = Vec::new();
        let candidates = MISTAKES.into_iter().map(|(factor, mistake)| (factor, Some(mistake)));
        for (factor, mistake) in candidates.chain([(ANY, None)]) {
            // rates that are read too small make a body that no tensor comes near to
            if sphere.is_some() && factor >= 1.0 {
                continue;
            }
            let tried = self.explains(&self.short, factor);
            let whole = if is_whole { tried } else { tried.and_then(|_| self.explains(&self.pilot, factor)) };
            let Some(other) = whole else { continue };
            let (misfit, credible) = (other.misfit(self.variance), credible(&other, self.variance));
            // next to a sphere the misfits are alike, and the shapes must tell
            if sphere.is_none_or(|distance| credible && other.x().norm() >= FARTHER * distance) {
                let by_noise = misfit <= other.expected_misfit();
                found.push(Found { factor, mistake, misfit, dof: other.dof() as f64, credible, by_noise });
            }
        }
        found
    }
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
        let settled = part.iter().all(WeakEstimate::has_settled);
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

/// Whether the record determines the estimate: if rates are read too large, a nearly spherical tensor explains most motions.
fn credible(weak: &WeakEstimate, variance: f64) -> bool {
    let Some((singular, _)) = weak.spectrum() else { return false };
    let deviation = (variance * weak.misfit(variance).max(1.0)).sqrt() / singular[4];
    deviation <= CREDIBLE * weak.x().norm()
}
