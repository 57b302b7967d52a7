//! What every inertia tensor obeys: finite, symmetric, triangle inequalities.

use nalgebra::Matrix3;

use super::InertiaError;
use super::symmetric::power_of_two_below;
use crate::num::{Dd, Real};
use crate::rotation::AXES;

/// Rounding that a tensor may show, relative to its trace: symmetry and triangle inequalities are judged up to it.
pub(super) const ROUNDING: f64 = 1e-12;

/// Every entry is a finite number.
pub(super) fn check_finite(values: &[f64]) -> Result<(), InertiaError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(InertiaError::NotFinite { value }),
        None => Ok(()),
    }
}

/// Finite entries that agree across the diagonal up to rounding.
pub(super) fn check_symmetric(tensor: &Matrix3<f64>) -> Result<(), InertiaError> {
    check_finite(tensor.as_slice())?;
    let largest = tensor.amax();
    if largest == 0.0 {
        return Ok(());
    }
    let scaled = tensor / power_of_two_below(largest);
    let trace = scaled.trace().abs();
    for (row, column) in [(0, 1), (0, 2), (1, 2)] {
        let difference = (scaled[(row, column)] - scaled[(column, row)]).abs();
        if difference > ROUNDING * trace {
            return Err(InertiaError::NotSymmetric {
                row: AXES[row],
                column: AXES[column],
                upper: tensor[(row, column)],
                lower: tensor[(column, row)],
                relative: difference / trace,
            });
        }
    }
    Ok(())
}

/// By how much the sum of the other two moments exceeds the k-th.
pub(super) fn triangle_margins<S: Real>([a, b, c]: [S; 3]) -> [S; 3] {
    [b + c - a, a + c - b, a + b - c]
}

/// The triangle inequalities for moments divided by `scale`.
pub(super) fn check_triangle(scaled: [f64; 3], scale: f64) -> Result<(), InertiaError> {
    let rounding = ROUNDING * (scaled[0] + scaled[1] + scaled[2]);
    for (largest, pair) in [(0, [1, 2]), (1, [0, 2]), (2, [0, 1])] {
        let excess = (Dd::of(scaled[largest]) - Dd::sum(scaled[pair[0]], scaled[pair[1]])).hi();
        if excess > rounding {
            return Err(InertiaError::Triangle {
                moments: scaled.map(|i| i * scale),
                pair,
                largest,
                excess: excess * scale,
                percent: 100.0 * excess / scaled[largest],
            });
        }
    }
    Ok(())
}
