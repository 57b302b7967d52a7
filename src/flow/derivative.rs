//! What the derivatives of exact motions share: the axes of small turns, and why there is no derivative.

use nalgebra::{Matrix3, SMatrix};
use thiserror::Error;

use super::TimeError;
use crate::body::State;

/// In which axes the rotation vector of a small turn is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TurnAxes {
    /// Axes of space: δQ = \[δθ\]× Q, the turn is multiplied on the left.
    Space,
    /// Axes of the body: δQ = Q \[δθ\]×, the turn is multiplied on the right.
    Body,
}

/// Why there is no derivative at a time.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DerivativeError {
    /// There is no state either.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// Next to the separatrix a derivative grows exponentially.
    #[error(
        "after {t:e} s the derivative with respect to the start exceeds the range of a double: next to the unstable axis it grows exponentially"
    )]
    OutOfRange {
        /// The time, s.
        t: f64,
    },
}

/// Small turns in space, in the first rows and first columns, in other axes: with the rotations of the attitudes before and after.
pub(super) fn in_axes<const N: usize>(
    axes: TurnAxes,
    mut whole: SMatrix<f64, 6, N>,
    before: Matrix3<f64>,
    after: Matrix3<f64>,
) -> SMatrix<f64, 6, N> {
    if axes == TurnAxes::Body {
        let turned = after.transpose() * whole.fixed_rows::<3>(0);
        whole.fixed_rows_mut::<3>(0).copy_from(&turned);
        let turned = whole.fixed_view::<6, 3>(0, 0) * before;
        whole.fixed_view_mut::<6, 3>(0, 0).copy_from(&turned);
    }
    whole
}

/// The matrix of the attitude, body to space.
pub(super) fn rotation(state: State) -> Matrix3<f64> {
    state.rotation().to_rotation_matrix().into_inner()
}
