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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use crate::physical::nearest::nearest;
    use nalgebra::{Matrix3, Vector3};

    fn told(drag: f64) -> Normal {
        let inside = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.25, 0.35, 0.4)));
        let centre = DVector::from_iterator(7, [drag, 0.3].into_iter().chain(inside.iter().copied()));
        let root = DMatrix::from_fn(7, 7, |i, k| {
            if i < k {
                ((7 * i + 3 * k) % 11) as f64 * 20.0
            } else if i == k {
                1e3
            } else {
                0.0
            }
        });
        Normal { centre, root }
    }

    /// Where nothing holds the answer, the covariance is the inverse of the information.
    #[test]
    fn a_free_answer_has_the_inverse_of_the_information() {
        let told = told(0.1);
        let nearest = nearest(&told, &[], &[]).unwrap();
        let found = deviations(&told, &[3, 8], &[], &[], &nearest).unwrap();
        let covariance = (told.root.transpose() * &told.root).try_inverse().unwrap();
        assert!((found.together - &covariance).amax() < 1e-9 * covariance.amax());
        let own = covariance.fixed_view::<5, 5>(2, 2).into_owned();
        assert!((found.free * found.free.transpose() - own).amax() < 1e-9 * own.amax());
        assert!(found.on_face == found.free && found.held.is_empty());
    }

    /// A drag a deviation below zero that is held there keeps the moment of its tail, 0.475 of its variance; a column that knows nothing of
    /// it keeps its own. Far below zero nothing inside is told, and the free covariance stays.
    #[test]
    fn a_held_answer_has_the_spread_inside() {
        let mut told = told(0.0);
        (1..7).for_each(|k| told.root[(0, k)] = 0.0);
        let of = [Dissipation { place: 0, name: "drag" }];
        let mut at = |below: f64| {
            told.centre[0] = -below / 1e3;
            let nearest = nearest(&told, &[], &of).unwrap();
            assert_eq!(nearest.active.len(), 1);
            deviations(&told, &[3, 8], &[], &of, &nearest).unwrap()
        };
        let near = at(1.0);
        let [(3, drag), (8, other)] = near.held[..] else { panic!("{:?}", near.held) };
        assert!((drag * 1e3 / 0.475_f64.sqrt() - 1.0).abs() < 0.2, "{drag:e}");
        let far = at(6.0);
        assert!(far.held.is_empty() && far.on_face == far.free);
        assert!((other / far.together[(1, 1)].sqrt() - 1.0).abs() < 0.15, "{other:e}");
        // the squares of a factor sum to the trace of its covariance
        let ratio = near.on_face.norm_squared() / far.free.norm_squared();
        assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
        assert_eq!(near.free, far.free);
    }
}
