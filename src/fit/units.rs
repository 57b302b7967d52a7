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

/// A unit that explains the record better than the one it was read in.
#[derive(Clone, Copy)]
pub(super) struct Better {
    /// On rate × time.
    pub(super) factor: f64,
    pub(super) hint: &'static str,
    /// Mean square of the residuals over the noise in this unit.
    pub(super) misfit: f64,
    /// The same in the next best.
    pub(super) next: f64,
}

/// The unit that explains the record best, where one does so at least three times better and with a credible tensor.
pub(super) fn better_unit(stretches: &[Stretch], variance: f64, misfit: f64) -> Option<Better> {
    let pilot = radius::pilot(stretches);
    let mut found = Vec::new();
    for (factor, hint) in UNITS {
        let scaled: Vec<Stretch> = pilot
            .iter()
            .map(|s| Stretch::new(s.times.iter().map(|t| t * factor).collect(), s.rates.clone()))
            .collect();
        let settled = radius::estimate(&scaled, None, variance).ok().filter(WeakEstimate::settled);
        found.extend(
            settled.map(|weak| (weak.misfit_per_dof(variance), factor, hint, credible(&weak, variance))),
        );
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let next = found.get(1).map_or(f64::INFINITY, |f| f.0);
    found.first().filter(|f| f.0 < misfit / 3.0 && f.3).map(|&(misfit, factor, hint, _)| Better {
        factor,
        hint,
        misfit,
        next,
    })
}

/// Largest deviation, as a share of the distance from the sphere, at which a tensor tells one unit from another.
const TOLD: f64 = 0.2;

/// Whether the record determines the estimate: with rates too large a tensor next to the sphere explains most motions.
fn credible(weak: &WeakEstimate, variance: f64) -> bool {
    let Some((singular, _)) = weak.spectrum() else { return false };
    let deviation = (variance * weak.misfit_per_dof(variance).max(1.0)).sqrt() / singular[4];
    deviation <= TOLD * weak.x.norm()
}
