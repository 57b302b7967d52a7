//! A first tensor from measured attitudes: the angular momentum Q J ω of a free body is the same vector in space at all times.
//!
//! min Σ |Q_i J ω_i − L|² over J of trace 1 and an L for each stretch is linear least squares. Noise of variance v of the rates adds
//! v B_k·B_l to each square; this is taken off as far as the matrix stays positive.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use crate::likelihood::local::Node;
use crate::physical::coordinates::{Coordinates, Form, basis, eigen};
use crate::thresholds::likelihood::{LEAST_SHARE, SMALLEST};

type Columns = SMatrix<f64, 3, 5>;

/// The coordinates of the tensor; `noise` is the variance of a component of an attitude. `None` where it is not determined.
pub(crate) fn tensor_of(stretches: &[Vec<Node>], noise: f64) -> Option<Coordinates> {
    let (mut matrix, mut right, mut excess) = (Form::zeros(), Coordinates::zeros(), 0.0);
    let bases: [Matrix3<f64>; 5] = core::array::from_fn(basis);
    for nodes in stretches {
        let rows = nodes.iter().map(|node| {
            let q = UnitQuaternion::from(node.attitude.normalized()).to_rotation_matrix();
            let columns = bases.map(|b| q.matrix() * (b * node.rate));
            (Columns::from_columns(&columns), q.matrix() * node.rate / 3.0)
        });
        let rows: Vec<(Columns, Vector3<f64>)> = rows.collect();
        let count = rows.len().max(1) as f64;
        let mean = rows.iter().fold((Columns::zeros(), Vector3::zeros()), |(a, b), (c, d)| (a + c, b + d));
        let (mean_columns, mean_rate) = (mean.0 / count, mean.1 / count);
        for (columns, rate) in &rows {
            let columns = columns - mean_columns;
            matrix += columns.tr_mul(&columns);
            right -= columns.tr_mul(&(rate - mean_rate));
        }
        excess += nodes.iter().map(|node| node.variance * noise).sum::<f64>();
    }
    // B_k·B_l is 1 of each with itself, and each squared component of noise counts once
    let (values, _) = eigen(matrix);
    let taken = excess.min((1.0 - LEAST_SHARE) * values[0]).max(0.0);
    let x = (matrix - Form::identity() * taken).cholesky()?.solve(&right);
    physical(x)
}

/// Drawn towards the sphere until no moment is below a share of the trace.
pub(crate) fn physical(x: Coordinates) -> Option<Coordinates> {
    if x.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let (moments, _) = eigen(crate::physical::coordinates::tensor(&x));
    let third = 1.0 / 3.0;
    let share = if moments[0] < SMALLEST { (third - SMALLEST) / (third - moments[0]) } else { 1.0 };
    Some(x * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::rotation::Quat;

    #[test]
    fn what_is_drawn_inwards_stops_at_the_least_moment() {
        let far = Coordinates::new(0.3, 0.9, 0.2, -0.4, 0.1);
        for x in [far, far * 0.01] {
            let (moments, _) = eigen(crate::physical::coordinates::tensor(&physical(x).unwrap()));
            let (own, _) = eigen(crate::physical::coordinates::tensor(&x));
            assert!((moments[0] - own[0].max(SMALLEST)).abs() < 1e-15, "{moments}");
        }
    }

    /// Of rates ±1, ±1 and ±√2 along the axes of a body that does not turn in space the momenta vanish in the mean, and the sum of their
    /// squares Σ 2 a² J² is least for J in proportion to 1/a². Noise of the rates adds its variance times the squares of J, which is taken
    /// off: 1/(2 a² − e), with e up to nine tenths of the smallest eigenvalue, 2.
    #[test]
    fn noise_of_the_rates_is_taken_off_the_squares() {
        let sizes = [1.0, 1.0, core::f64::consts::SQRT_2];
        let node = |k: usize| {
            let rate = Vector3::ith(k / 2, sizes[k / 2] * if k.is_multiple_of(2) { 1.0 } else { -1.0 });
            Node { time: 0.0, attitude: Quat::identity(), rate, variance: 0.5 }
        };
        let nodes: Vec<Node> = (0..6).map(node).collect();
        // six variances of a half: 0, 1 and 30
        for (noise, [first, third]) in [
            (0.0, [2.0 / 5.0, 1.0 / 5.0]),
            (1.0 / 3.0, [3.0 / 7.0, 1.0 / 7.0]),
            (10.0, [11.0 / 23.0, 1.0 / 23.0]),
        ] {
            let x = tensor_of(core::slice::from_ref(&nodes), noise).unwrap();
            let found = crate::physical::coordinates::tensor(&x);
            let expected = Matrix3::from_diagonal(&Vector3::new(first, first, third));
            assert!((found - expected).amax() < 1e-12, "{noise}: {found}");
        }
        assert!(physical(Coordinates::repeat(f64::NAN)).is_none());
    }
}
