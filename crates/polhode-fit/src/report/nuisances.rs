//! Names, units and values of what was estimated beside the tensor.

use crate::report::differing::Differing;
use crate::report::nuisance::Nuisance;
use crate::solve::weak_estimate::WeakEstimate;

/// The unknowns beside the tensor at `values`, with deviations for residuals of `variance` and for what parts of the record differ in, or
/// those of `held` by number.
pub(crate) fn nuisances(
    weak: &WeakEstimate,
    values: &[f64],
    variance: f64,
    rms: f64,
    held: &[(usize, f64)],
    differing: Option<&Differing>,
) -> Vec<Nuisance> {
    let Some(factor) = weak.stacked.as_ref().and_then(|stacked| stacked.joint_factor()) else {
        return Vec::new();
    };
    let each = weak.columns.iter().zip(values).enumerate();
    each.map(|(k, (column, value))| {
        let own = held.iter().find(|(place, _)| *place == k).map(|(_, sigma)| *sigma);
        let more = differing.map_or(0.0, |differing| differing.variance(k));
        let sigma = own.unwrap_or_else(|| (factor.row(k).norm_squared() * variance + more).sqrt());
        Nuisance::new(column, *value, sigma, rms)
    })
    .collect()
}
