//! The spread of an estimate that the physical law or a limit holds.
//!
//! On an active face the linear covariance has no extent across it, as if the record told the distance to the wall
//! exactly. What the record tells is the normal distribution about the unconstrained estimate, cut off at the walls; its
//! mean square distance from the answer is what may be said of the answer.

use crate::thresholds::spread::{DRAWN, INSIDE};
use nalgebra::{DMatrix, DVector};
use polhode::num::Random;

use crate::physical::coordinates::{Coordinates, eigen, tensor};
use crate::physical::dissipation::Dissipation;
use crate::physical::law::LARGEST_SHARE;
use crate::physical::limits::Limit;

/// The mean of (z − answer)(z − answer)ᵀ over unknowns z that are allowed, z normal about `centre` with the factor `free`;
/// `None` where hardly any of them is. The last five unknowns are the coordinates of a tensor.
pub(crate) fn spread(
    centre: &DVector<f64>,
    free: &DMatrix<f64>,
    limits: &[Limit],
    dissipation: &[Dissipation],
    answer: &DVector<f64>,
) -> Option<DMatrix<f64>> {
    let size = centre.len();
    spread_within(centre, free, answer, |z| {
        if !dissipation.iter().all(|of| of.allows(z)) {
            return false;
        }
        let j = tensor(&Coordinates::from_column_slice(&z.as_slice()[size - 5..]));
        let allowed = |limit: &Limit| {
            let n = limit.axis.normalize();
            let share = n.dot(&(j * n));
            limit.at_least.is_none_or(|low| share >= low) && limit.at_most.is_none_or(|high| share <= high)
        };
        eigen(j).0[2] <= LARGEST_SHARE && limits.iter().all(allowed)
    })
}

/// The same of unknowns that `allows` picks.
pub(crate) fn spread_within(
    centre: &DVector<f64>,
    free: &DMatrix<f64>,
    answer: &DVector<f64>,
    allows: impl Fn(&DVector<f64>) -> bool,
) -> Option<DMatrix<f64>> {
    let size = centre.len();
    let mut random = Random::new(1);
    let (mut sum, mut inside) = (DMatrix::zeros(size, size), 0.0);
    for _ in 0..DRAWN {
        let z = centre + free * DVector::from_fn(size, |_, _| random.normal());
        if allows(&z) {
            let apart = z - answer;
            sum.ger(1.0, &apart, &apart, 1.0);
            inside += 1.0;
        }
    }
    (inside >= INSIDE as f64).then(|| sum / inside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::{coordinates, pair};
    use nalgebra::{Matrix3, Vector3};

    fn listed(x: Coordinates) -> DVector<f64> {
        DVector::from_column_slice(x.as_slice())
    }

    /// Across a flat wall through the mean, half a normal distribution has the root mean square of the whole.
    #[test]
    fn half_a_normal_distribution_keeps_its_mean_square() {
        let flat = listed(coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.3, 0.5))));
        let free = DMatrix::identity(5, 5) * 1e-4;
        let moments = spread(&flat, &free, &[], &[], &flat).unwrap();
        let across = listed(pair(&Vector3::z(), &Vector3::z()));
        let sigma = across.dot(&(moments * &across)).sqrt() / across.norm();
        assert!((sigma / 1e-4 - 1.0).abs() < 0.05, "{sigma:e}");
    }

    /// A coefficient a standard deviation below zero, held at zero: of u normal, E[(u − 1)² | u > 1] = 2 − h with
    /// h = φ(1)/(1 − Φ(1)).
    #[test]
    fn a_coefficient_below_zero_keeps_the_moment_of_its_tail() {
        let inside = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.25, 0.35, 0.4)));
        let centre = DVector::from_iterator(6, core::iter::once(-1.0).chain(inside.iter().copied()));
        let mut free = DMatrix::identity(6, 6) * 1e-6;
        free[(0, 0)] = 1.0;
        let mut answer = centre.clone();
        answer[0] = 0.0;
        let of = [Dissipation { place: 0, name: "drag" }];
        let moments = spread(&centre, &free, &[], &of, &answer).unwrap();
        // φ(1) = 0.24197072, 1 − Φ(1) = 0.15865525
        let h = 0.241_970_72 / 0.158_655_25;
        assert!((moments[(0, 0)] / (2.0 - h) - 1.0).abs() < 0.1, "{}", moments[(0, 0)]);
    }

    #[test]
    fn far_outside_nothing_is_said() {
        let centre = listed(coordinates(&Matrix3::from_diagonal(&Vector3::new(0.15, 0.25, 0.6))));
        assert!(spread(&centre, &(DMatrix::identity(5, 5) * 1e-3), &[], &[], &centre).is_none());
    }

    /// Of a mean that lies a standard deviation beyond a limit, on either side: the tail is that of a normal distribution.
    #[test]
    fn beyond_a_limit_only_the_tail_is_left() {
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.25, 0.35, 0.4)));
        let across = pair(&Vector3::z(), &Vector3::z());
        let sigma = 1e-3;
        let free = DMatrix::identity(5, 5) * sigma;
        for side in [1.0, -1.0] {
            let share = Some(0.4 + side * sigma * across.norm());
            let (at_least, at_most) = if side > 0.0 { (share, None) } else { (None, share) };
            let limit = Limit { axis: Vector3::z() * 3.0, at_least, at_most };
            let answer = listed(centre + across.normalize() * (side * sigma));
            let moments = spread(&listed(centre), &free, &[limit], &[], &answer).unwrap();
            let own = listed(across.normalize());
            // 2 − h as above; on the wrong side it would be 2.29
            let square = own.dot(&(moments * &own)) / (sigma * sigma);
            assert!((square / 0.475 - 1.0).abs() < 0.25, "{side}: {square}");
        }
    }
}
