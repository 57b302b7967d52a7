//! Mistaken units of a record, which Euler's equation tells: rates enter it squared, their derivatives do not.

use super::radius;
use super::rounds::WeakEstimate;
use super::test_functions::Stretch;

/// Other units, as factors on rate × time, and what would have happened.
const UNITS: [(f64, &str); 12] = [
    (core::f64::consts::PI / 180.0, "degrees per second taken for radians per second"),
    (180.0 / core::f64::consts::PI, "radians per second taken for degrees per second"),
    (core::f64::consts::PI / 30.0, "revolutions per minute taken for radians per second"),
    (30.0 / core::f64::consts::PI, "radians per second taken for revolutions per minute"),
    (6.0, "revolutions per minute taken for degrees per second"),
    (1.0 / 6.0, "degrees per second taken for revolutions per minute"),
    (1e-3, "milliseconds taken for seconds"),
    (1e3, "seconds taken for milliseconds"),
    (1e-6, "microseconds taken for seconds"),
    (1e6, "seconds taken for microseconds"),
    (1e-9, "nanoseconds taken for seconds"),
    (1e9, "seconds taken for nanoseconds"),
];

/// Units that explain the record better than the one it was read in.
pub(crate) struct Better {
    /// The smallest factor on rate × time.
    pub(crate) factor: f64,
    /// What would have happened, of the smallest factors first.
    pub(crate) hint: String,
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

/// The units that explain the record best, where they do so at least three times better.
pub(crate) fn better_unit(stretches: &[Stretch], variance: f64, misfit: f64) -> Option<Better> {
    let pilot = radius::pilot(stretches);
    let mut found = Vec::new();
    for (factor, hint) in UNITS.into_iter().chain([(ANY, "")]) {
        let scaled: Vec<Stretch> = pilot
            .iter()
            .map(|s| Stretch::new(s.times.iter().map(|t| t * factor).collect(), s.rates.clone()))
            .collect();
        let settled = radius::estimate(&scaled, None, variance).ok().filter(WeakEstimate::settled);
        found.extend(settled.map(|weak| Found {
            factor,
            hint,
            misfit: weak.misfit_per_dof(variance),
            dof: weak.dof() as f64,
            credible: credible(&weak, variance),
        }));
    }
    found.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let best = found.first().filter(|best| best.misfit < misfit / 3.0)?;
    let equal = |f: &Found| (f.misfit - best.misfit) * best.dof <= EQUAL * best.misfit.max(1.0);
    let mut units: Vec<&Found> = found.iter().filter(|f| equal(f)).collect();
    units.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    let vague = units.pop_if(|f| f.factor == ANY).is_some() || units.len() > LISTED;
    let hints: Vec<&str> = units.iter().take(LISTED).map(|f| f.hint).collect();
    units.first().map(|first| Better {
        factor: first.factor,
        hint: hints.join(", or "),
        misfit: first.misfit,
        credible: best.credible,
        vague,
    })
}

/// A unit at which a tensor settled.
struct Found {
    factor: f64,
    hint: &'static str,
    misfit: f64,
    dof: f64,
    credible: bool,
}

/// Largest deviation, as a share of the distance from the sphere, at which a tensor tells one unit from another.
const TOLD: f64 = 0.2;

/// Whether the record determines the estimate: with rates too large a tensor next to the sphere explains most motions.
fn credible(weak: &WeakEstimate, variance: f64) -> bool {
    let Some((singular, _)) = weak.spectrum() else { return false };
    let deviation = (variance * weak.misfit_per_dof(variance).max(1.0)).sqrt() / singular[4];
    deviation <= TOLD * weak.x.norm()
}
