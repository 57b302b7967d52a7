//! The effect of torque noise on the derivatives of the weak equations.
//!
//! Torque noise ξ turns the body: its share J⁻¹ ∫ φ ξ dt in the slopes ∫ φ ω' dt is that of the residuals r = ∫ φ ξ dt
//! themselves. Derivatives B ∫ φ ω' dt + … with respect to the tensor would therefore be correlated with the residuals, and least
//! squares biased towards tensors that make the residuals small. What r tells of ∫ φ ξ dt is T C⁻¹ r, T being the part of C
//! that torque noise has; the derivatives without B J⁻¹ T C⁻¹ r are not correlated with r.

use nalgebra::{Matrix3, Vector3};

use crate::columns::column::Column;
use crate::physical::coordinates::basis;
use crate::signal::banded::Banded;
use crate::signal::covariance::{Levels, torque_shape};
use crate::signal::test_functions::TestFunctions;

/// T C⁻¹ r by tests: the expected effect of torque noise in the residuals `r`, C being given by its `factor`.
fn effect(
    r: Vec<f64>,
    factor: &Banded,
    levels: Levels,
    j: &Matrix3<f64>,
    tests: &TestFunctions,
) -> Vec<Vector3<f64>> {
    let mut multipliers = r;
    factor.forward(&mut multipliers, 1);
    factor.backward(&mut multipliers);
    let each: Vec<Vector3<f64>> = multipliers.chunks_exact(3).map(Vector3::from_column_slice).collect();
    let shape = torque_shape(levels.shape, j) * levels.torque;
    (0..each.len())
        .map(|m| {
            let mut sum = Vector3::zeros();
            for (apart, overlap) in tests.overlaps().iter().enumerate() {
                let before = m.checked_sub(apart).filter(|_| apart > 0).map(|k| each[k]);
                let after = each.get(m + apart).copied();
                sum += (before.unwrap_or_default() + after.unwrap_or_default()) * *overlap;
            }
            shape * sum
        })
        .collect()
}

/// The effect of torque noise on the derivatives of all tests: on those of the tensor, and of errors of scale and alignment, which have
/// slopes as well.
pub(crate) struct Driven {
    width: usize,
    /// The columns with their B J⁻¹.
    maps: Vec<(usize, Matrix3<f64>)>,
    effect: Vec<Vector3<f64>>,
}

impl Driven {
    /// By the residuals of all tests, which nobody asks for where there is no torque noise: then it is `None`.
    pub(crate) fn new(
        residuals: impl FnOnce() -> Vec<f64>,
        columns: &[Column],
        j: &Matrix3<f64>,
        factor: &Banded,
        levels: Levels,
        tests: &TestFunctions,
    ) -> Option<Self> {
        let inverse = j.try_inverse().filter(|_| levels.torque > 0.0)?;
        let of_columns = columns.iter().enumerate();
        let by_column = of_columns.filter_map(|(k, c)| Some((k, j * c.effect().distortion()? * inverse)));
        let by_tensor = (0..5).map(|k| (columns.len() + k, basis(k) * inverse));
        let maps = by_column.chain(by_tensor).collect();
        let effect = effect(residuals(), factor, levels, j, tests);
        Some(Driven { width: columns.len() + 6, maps, effect })
    }

    /// Takes it out of the rows of the tests from `first` on, not whitened.
    pub(crate) fn take_out(&self, rows: &mut [f64], first: usize) {
        for (rows, effect) in rows.chunks_exact_mut(3 * self.width).zip(&self.effect[first..]) {
            for (column, map) in &self.maps {
                let share = map * effect;
                for p in 0..3 {
                    rows[p * self.width + column] -= share[p];
                }
            }
        }
    }
}
