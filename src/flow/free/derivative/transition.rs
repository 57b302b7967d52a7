//! The derivative of a free motion in the axes and units of its body.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use super::variation::{Columns, Variation};
use crate::body::{Body, Point, State};
use crate::flow::derivative::{TurnAxes, in_axes, rotation};
use crate::num::Dd;
use crate::rotation::Vec3;

/// The state of a free body at one time, with its derivative by the state at t = 0 and by the inertia tensor.
///
/// The matrices are 6 × 12. Rows: the rotation vector δθ of the attitude (rad), then δm (kg m²/s) or δω (rad/s) in body axes, at the
/// time. Columns: the same six at t = 0, then the entries xx, yy, zz, xy, xz, yz of the tensor (kg m², body axes; xy stands for
/// both equal entries).
#[derive(Clone, Debug)]
#[must_use]
pub struct StateDerivative {
    state: State,
    attitude: Matrix3<f64>,
    attitude_at_start: Matrix3<f64>,
    /// By the momentum and the tensor, rotation vectors in space.
    columns: SMatrix<f64, 6, 9>,
    exponent: i32,
    inertia: Matrix3<f64>,
    inverse_inertia: Matrix3<f64>,
    omega: Vector3<f64>,
    omega_at_start: Vector3<f64>,
}

impl StateDerivative {
    /// The state itself, body axes.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Angular velocity, body axes, rad/s.
    #[must_use]
    pub fn omega_body(&self) -> Vector3<f64> {
        self.omega
    }

    /// The power of two that the matrices are to be multiplied by: 0 but for
    /// [`at_with_scaled_derivative`](crate::flow::FreeMotion::at_with_scaled_derivative).
    #[must_use]
    pub fn exponent(&self) -> i32 {
        self.exponent
    }

    /// The derivative of (δθ, δm) by (δθ, δm, tensor) at the start.
    #[must_use]
    pub fn by_momentum(&self, axes: TurnAxes) -> SMatrix<f64, 6, 12> {
        let mut whole = SMatrix::<f64, 6, 12>::zeros();
        whole.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(self.one());
        whole.fixed_view_mut::<6, 9>(0, 3).copy_from(&self.columns);
        in_axes(axes, whole, self.attitude_at_start, self.attitude)
    }

    /// The derivative of (δθ, δω) by (δθ, δω, tensor) at the start.
    #[must_use]
    pub fn by_omega(&self, axes: TurnAxes) -> SMatrix<f64, 6, 12> {
        let by_momentum = self.columns.fixed_columns::<3>(0);
        // δm = I δω + δI ω at the start, δω = I⁻¹ (δm − δI ω) at the time
        let mut whole = SMatrix::<f64, 6, 12>::zeros();
        whole.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(self.one());
        whole.fixed_view_mut::<6, 3>(0, 3).copy_from(&(by_momentum * self.inertia));
        let by_tensor = self.columns.fixed_columns::<6>(3) + by_momentum * tensor_times(self.omega_at_start);
        whole.fixed_view_mut::<6, 6>(0, 6).copy_from(&by_tensor);
        let mut rates = whole.fixed_rows::<3>(3).into_owned();
        let mut last = rates.fixed_columns_mut::<6>(6);
        last -= tensor_times(self.omega) * self.one();
        whole.fixed_rows_mut::<3>(3).copy_from(&(self.inverse_inertia * rates));
        in_axes(axes, whole, self.attitude_at_start, self.attitude)
    }

    /// 1 beside the exponent.
    fn one(&self) -> f64 {
        libm::scalbn(1.0, -self.exponent)
    }
}

/// δI v as a matrix times the entries xx, yy, zz, xy, xz, yz of δI.
fn tensor_times(v: Vector3<f64>) -> SMatrix<f64, 3, 6> {
    let (x, y, z) = (v.x, v.y, v.z);
    SMatrix::from_rows(&[
        [x, 0.0, 0.0, y, z, 0.0].into(),
        [0.0, y, 0.0, x, 0.0, z].into(),
        [0.0, 0.0, z, 0.0, x, y].into(),
    ])
}

/// Constants of the derivative of one motion, with what takes it to the axes of the body.
#[derive(Clone, Debug)]
pub(in crate::flow::free) struct Derivative {
    variation: Variation,
    start: Point<f64>,
    scale: f64,
    /// Takes coordinates along the principal axes to body axes, and entries of a tensor in body axes to those along the principal
    /// ones, where the axes differ.
    frame: Option<(Matrix3<f64>, SMatrix<f64, 6, 6>)>,
    attitude_at_start: Matrix3<f64>,
    inverse_moments: Vec3<f64>,
    inertia: Matrix3<f64>,
    inverse_inertia: Matrix3<f64>,
    omega_at_start: Vector3<f64>,
}

impl Derivative {
    pub(in crate::flow::free) fn new(body: &Body, variation: Variation, start: Point<Dd>) -> Self {
        let inertia = body.inertia();
        let principal: UnitQuaternion<f64> = inertia.frame().map(Dd::hi).into();
        let frame = (!inertia.is_along_principal_axes()).then(|| {
            let matrix = principal.to_rotation_matrix().into_inner();
            (matrix, tensor_along(matrix))
        });
        let axes = principal.to_rotation_matrix().into_inner();
        let inverse = body.rotor().inverse_moments::<f64>().map(|i| i / body.scale());
        Derivative {
            variation,
            start: start.to_f64(),
            scale: body.scale(),
            frame,
            attitude_at_start: rotation(body.leave(&start)),
            inverse_moments: body.rotor().inverse_moments(),
            inertia: inertia.tensor(),
            inverse_inertia: axes * Matrix3::from_diagonal(&inverse.into()) * axes.transpose(),
            omega_at_start: body.omega_of(&start),
        }
    }

    pub(in crate::flow::free) fn inverse_inertia(&self) -> Matrix3<f64> {
        self.inverse_inertia
    }

    /// e-folds by which the derivative has grown after the time `t` on the separatrix; 0 elsewhere.
    pub(super) fn folds(&self, t: f64) -> f64 {
        self.variation.folds(t)
    }

    /// The columns along the axes of the solver frame, at the time `t`, where the motion is at `now`.
    pub(in crate::flow::free) fn columns(&self, t: f64, now: &Point<f64>) -> Columns {
        if self.start.momentum_body.magnitude() == 0.0 {
            self.at_rest(t)
        } else {
            self.variation.at(Dd::from(t), self.start.attitude, now.attitude)
        }
    }

    /// At the time `t`, where the motion is at `now`.
    pub(in crate::flow::free) fn at(&self, body: &Body, t: f64, now: &Point<f64>) -> Option<StateDerivative> {
        self.found(body, now, self.in_body_axes(&self.columns(t, now)), 0)
    }

    /// Where the motion is at `now`, from the columns with rotation vectors in the body, times 2^`exponent`.
    pub(super) fn scaled(
        &self,
        body: &Body,
        now: &Point<f64>,
        mut columns: SMatrix<f64, 6, 9>,
        exponent: i32,
    ) -> Option<StateDerivative> {
        let turned = rotation(body.leave(now)) * columns.fixed_rows::<3>(0);
        columns.fixed_rows_mut::<3>(0).copy_from(&turned);
        self.found(body, now, columns, exponent)
    }

    fn found(
        &self,
        body: &Body,
        now: &Point<f64>,
        columns: SMatrix<f64, 6, 9>,
        exponent: i32,
    ) -> Option<StateDerivative> {
        let state = body.leave(now);
        columns.iter().all(|x| x.is_finite()).then(|| StateDerivative {
            attitude: rotation(state),
            state,
            attitude_at_start: self.attitude_at_start,
            columns,
            exponent,
            inertia: self.inertia,
            inverse_inertia: self.inverse_inertia,
            omega: body.omega_of(now),
            omega_at_start: self.omega_at_start,
        })
    }

    /// What a small momentum does to a body at rest.
    fn at_rest(&self, t: f64) -> Columns {
        let mut columns = Columns::zero();
        for k in 0..3 {
            columns.momentum[k] = Vec3::unit(k);
            columns.rotation[k] = self.start.attitude.rotate(Vec3::unit(k)) * (t * self.inverse_moments[k]);
        }
        columns
    }

    /// The columns for changes in the axes and units of the body.
    fn in_body_axes(&self, columns: &Columns) -> SMatrix<f64, 6, 9> {
        let mut whole = SMatrix::<f64, 6, 9>::zeros();
        let per_scale = 1.0 / self.scale;
        for n in 0..9 {
            let (rotation, momentum) = (columns.rotation[n], columns.momentum[n]);
            for k in 0..3 {
                whole[(k, n)] = rotation[k] * per_scale;
                whole[(3 + k, n)] = momentum[k];
            }
        }
        if let Some((axes, tensor)) = &self.frame {
            let by_momentum = whole.fixed_columns::<3>(0) * axes.transpose();
            let by_tensor = whole.fixed_columns::<6>(3) * tensor;
            whole.fixed_columns_mut::<3>(0).copy_from(&by_momentum);
            whole.fixed_columns_mut::<6>(3).copy_from(&by_tensor);
            let momentum = axes * whole.fixed_rows::<3>(3);
            whole.fixed_rows_mut::<3>(3).copy_from(&momentum);
        }
        whole
    }
}

/// The entries xx, yy, zz, xy, xz, yz of RᵀTR as a matrix times those of T.
fn tensor_along(r: Matrix3<f64>) -> SMatrix<f64, 6, 6> {
    const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    SMatrix::from_fn(|row, column| {
        let ((i, j), (k, l)) = (ENTRIES[row], ENTRIES[column]);
        if k == l { r[(k, i)] * r[(l, j)] } else { r[(k, i)] * r[(l, j)] + r[(l, i)] * r[(k, j)] }
    })
}
