//! How far an answer may be off: what record and prior tell, within the walls that hold it.

use nalgebra::{DMatrix, DVector};

use crate::error::FitError;
use crate::physical::coordinates::Form;
use crate::physical::dissipation::Dissipation;
use crate::physical::face::Nearest;
use crate::physical::failure::SolverFailure;
use crate::physical::limits::Limit;
use crate::physical::nearest::Normal;
use crate::physical::truncated::spread;

/// How far an answer may be off: factors of covariances.
pub(crate) struct Deviations {
    /// Of the tensor before law and limits are imposed.
    pub(crate) free: Form,
    /// Of the answer.
    pub(crate) on_face: Form,
    /// Covariance of the columns that are kept and the tensor.
    pub(crate) together: DMatrix<f64>,
    /// Standard deviations of the columns that are kept, by number, where a constraint holds the answer.
    pub(crate) held: Vec<(usize, f64)>,
}

/// Of the answer `nearest` to what is `told` of the columns with the numbers `kept` and the tensor.
pub(crate) fn deviations(
    told: &Normal,
    kept: &[usize],
    limits: &[Limit],
    dissipation: &[Dissipation],
    nearest: &Nearest,
) -> Result<Deviations, FitError> {
    let count = kept.len();
    // R⁻¹, a factor of the covariance
    let singular = FitError::Solver(SolverFailure::Information);
    let joint_factor = told.root.clone().try_inverse().ok_or(singular)?;
    let free: Form = joint_factor.fixed_view::<5, 5>(count, count).into_owned();
    // of an answer that is held, what the record tells inside the walls; far outside, what it tells without them
    let answer = DVector::from_iterator(count + 5, nearest.others.iter().chain(nearest.x.iter()).copied());
    let cut = if nearest.active.is_empty() {
        None
    } else {
        spread(&told.centre, &joint_factor, limits, dissipation, &answer)
    };
    let together = cut.clone().unwrap_or_else(|| &joint_factor * joint_factor.transpose());
    let of_tensor = cut.as_ref().map(|m| m.fixed_view::<5, 5>(count, count).into_owned());
    let on_face = of_tensor.and_then(|m| m.cholesky()).map_or(free, |factor| factor.l());
    let held: Vec<(usize, f64)> = cut
        .iter()
        .flat_map(|m| kept.iter().enumerate().map(|(place, &k)| (k, m[(place, place)].sqrt())))
        .collect();
    Ok(Deviations { free, on_face, together, held })
}
