//! The spread of an estimate that the physical law or a limit holds.
//!
//! On an active face the linear covariance has no extent across it, as if the record told the distance to the wall
//! exactly. What the record tells is the normal distribution about the unconstrained estimate, cut off at the walls; its
//! mean square distance from the answer is what may be said of the answer.

use super::coordinates::{Coordinates, Form, eigen, tensor};
use super::law::LARGEST_SHARE;
use super::limits::Limit;
use crate::num::Random;

/// Points that are drawn.
const DRAWN: usize = 10_000;
/// Fewest points inside the walls that tell the spread.
const INSIDE: usize = 200;

/// A factor F of the mean of (x − answer)(x − answer)ᵀ over physical x within the limits, x normal about `centre` with
/// the factor `free`; `None` where hardly any of them is physical.
pub(crate) fn spread(
    centre: &Coordinates,
    free: &Form,
    limits: &[Limit],
    answer: &Coordinates,
) -> Option<Form> {
    let mut random = Random::new(1);
    let (mut sum, mut inside) = (Form::zeros(), 0.0);
    for _ in 0..DRAWN {
        let x = centre + free * Coordinates::from_fn(|_, _| random.normal());
        let j = tensor(&x);
        let allowed = |limit: &Limit| {
            let n = limit.axis.normalize();
            let share = n.dot(&(j * n));
            limit.at_least.is_none_or(|low| share >= low) && limit.at_most.is_none_or(|high| share <= high)
        };
        if eigen(j).0[2] <= LARGEST_SHARE && limits.iter().all(allowed) {
            sum += (x - answer) * (x - answer).transpose();
            inside += 1.0;
        }
    }
    if inside < INSIDE as f64 {
        return None;
    }
    (sum / inside).cholesky().map(|factor| factor.l())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::physical::coordinates::{coordinates, pair};
    use nalgebra::{Matrix3, Vector3};

    /// Across a flat wall through the mean, half a normal distribution has the root mean square of the whole.
    #[test]
    fn half_a_normal_distribution_keeps_its_mean_square() {
        let flat = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.3, 0.5)));
        let free = Form::identity() * 1e-4;
        let factor = spread(&flat, &free, &[], &flat).unwrap();
        let across = pair(&Vector3::z(), &Vector3::z());
        let sigma = (factor.transpose() * across).norm() / across.norm();
        assert!((sigma / 1e-4 - 1.0).abs() < 0.05, "{sigma:e}");
    }

    #[test]
    fn far_outside_nothing_is_said() {
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.15, 0.25, 0.6)));
        assert!(spread(&centre, &(Form::identity() * 1e-3), &[], &centre).is_none());
    }
}
