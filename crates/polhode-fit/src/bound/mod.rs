//! The Cramér–Rao bound: what no unbiased estimator can undercut.
//!
//! F = σ⁻² Σ Sᵢᵀ Sᵢ with S = ∂ω/∂(x, ω₀) from the variational equations of J ω' = J ω × ω; each segment has an ω₀ of its
//! own, which the Schur complement takes out.

pub(crate) mod attitudes;
pub(crate) mod motions;
pub(crate) mod nearest_motion;
pub(crate) mod planned;
pub(crate) mod sensitivity;

use nalgebra::SMatrix;

use crate::physical::coordinates::{Form, eigen, entries_of_coordinates};
use crate::thresholds::bound::OPEN;

/// The covariance of the entries of a tensor by that of its coordinates, which `covariance` makes of their information; `None` where that
/// leaves one of them open.
fn of_entries(information: Form, covariance: impl Fn(Form) -> Option<Form>) -> Option<SMatrix<f64, 6, 6>> {
    let (spectrum, _) = eigen(information);
    // what a pure spin leaves open is zero up to the rounding of sums of squares
    if spectrum[0].is_nan() || spectrum[0] <= OPEN * spectrum[4] {
        return None;
    }
    let entries = entries_of_coordinates();
    Some(entries * covariance(information)? * entries.transpose()).filter(|b| b.iter().all(|v| v.is_finite()))
}

#[cfg(test)]
mod tests;
