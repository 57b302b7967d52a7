//! The derivative of the motion of a top in the axes and units of its body.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use super::ball::Ball;
use super::passage::Passages;
use super::vertical;
use crate::body::{Point, State};
use crate::flow::TimeError;
use crate::flow::derivative::{DerivativeError, TurnAxes, in_axes, rotation};
use crate::flow::lagrange::LagrangeTop;
use crate::flow::lagrange::top::Motion;
use crate::num::Dd;
use crate::rotation::{Quat, Vec3};

/// The state of Lagrange's top at one time, with its derivative by the state at t = 0 and by the constants of the top.
///
/// The matrices are 6 × 9. Rows: the rotation vector δθ of the attitude (rad), then δm (kg m²/s) or δω (rad/s) in body axes, at the
/// time. Columns: the same six at t = 0, then the transverse moment, the axial moment (kg m²) and the weight moment (N m).
#[derive(Clone, Debug)]
#[must_use]
pub struct TopDerivative {
    state: State,
    attitude: Matrix3<f64>,
    attitude_at_start: Matrix3<f64>,
    /// By rotation vector, momentum and constants, rotation vectors in space.
    columns: SMatrix<f64, 6, 9>,
    exponent: i32,
    /// Projections across and along the symmetry axis.
    across: Matrix3<f64>,
    along: Matrix3<f64>,
    moments: [f64; 2],
    omega: Vector3<f64>,
    omega_at_start: Vector3<f64>,
}

impl TopDerivative {
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
    /// [`at_with_scaled_derivative`](LagrangeTop::at_with_scaled_derivative).
    #[must_use]
    pub fn exponent(&self) -> i32 {
        self.exponent
    }

    /// With the exponent 0.
    fn unscaled(mut self) -> Self {
        self.columns.apply(|x| *x = libm::scalbn(*x, self.exponent));
        self.exponent = 0;
        self
    }

    /// The derivative of (δθ, δm) by (δθ, δm, transverse moment, axial moment, weight moment) at the start.
    #[must_use]
    pub fn by_momentum(&self, axes: TurnAxes) -> SMatrix<f64, 6, 9> {
        in_axes(axes, self.columns, self.attitude_at_start, self.attitude)
    }

    /// The derivative of (δθ, δω) by (δθ, δω, transverse moment, axial moment, weight moment) at the start.
    #[must_use]
    pub fn by_omega(&self, axes: TurnAxes) -> SMatrix<f64, 6, 9> {
        let [transverse, axial] = self.moments;
        // δm = I δω + δI ω at the start, δω = I⁻¹ (δm − δI ω) at the time
        let mut whole = self.columns;
        let by_momentum = self.columns.fixed_columns::<3>(3).into_owned();
        let inertia = self.across * transverse + self.along * axial;
        whole.fixed_columns_mut::<3>(3).copy_from(&(by_momentum * inertia));
        for (column, part) in [(6, self.across), (7, self.along)] {
            let mut by_moment = whole.fixed_columns_mut::<1>(column);
            by_moment += by_momentum * (part * self.omega_at_start);
            let mut momentum = by_moment.fixed_rows_mut::<3>(3);
            momentum -= part * self.omega * libm::scalbn(1.0, -self.exponent);
        }
        let inverse = self.across / transverse + self.along / axial;
        let rates = inverse * whole.fixed_rows::<3>(3);
        whole.fixed_rows_mut::<3>(3).copy_from(&rates);
        in_axes(axes, whole, self.attitude_at_start, self.attitude)
    }
}

/// Constants of the derivative of the motion of one top.
#[derive(Clone, Debug)]
pub(in crate::flow::lagrange) struct Derivative {
    /// Takes coordinates with e₃ along the weight moment to body axes.
    axes: Matrix3<f64>,
    attitude_at_start: Matrix3<f64>,
    omega_at_start: Vector3<f64>,
    /// 1/A in the units of the solver frame.
    inverse_transverse: f64,
    inverse_inertia: Matrix3<f64>,
    /// Projections across and along the symmetry axis.
    across: Matrix3<f64>,
    along: Matrix3<f64>,
    passages: Option<Passages>,
    /// The changes of the ball in the units of time of the nutation by the nine of the top: δθ by δθ, then δω by δm, then
    /// δω and δg by the constants.
    turns: Matrix3<f64>,
    rates: Matrix3<f64>,
    by_transverse: [f64; 4],
    by_weight: f64,
    /// ω₁ and ω₂ per momentum, and back in the units of the body.
    per_momentum: f64,
    per_rate: f64,
    /// Turns of the top beside those of the ball, and their changes by m₃ and the two moments, rad/s.
    beside: Dd,
    further: [f64; 3],
}

impl Derivative {
    fn of(top: &LagrangeTop) -> Self {
        let axes: UnitQuaternion<f64> = (top.body.inertia().frame() * top.frame).map(Dd::hi).into();
        let start = top.point_at_dd(Dd::ZERO);
        let (passages, unit) = match &top.motion {
            Motion::Vertical => (None, 0),
            Motion::Nutating { nutation, unit, .. } => {
                let g = (top.weight / top.transverse).scaled(2 * unit).hi();
                let spin = (top.start.momentum_body[2] / top.transverse).scaled(*unit).hi();
                (Some(Passages::new(nutation, g, spin)), *unit)
            }
        };
        // ω = m/A and g = c/A in units of time of 2^unit
        let power = |n: i32| libm::scalbn(1.0, n * unit);
        let (a, c, m3) = (top.transverse, top.axial, top.start.momentum_body[2]);
        let (moment, scale) = (a.hi(), top.body.scale());
        let Vec3([m1, m2, m3_start]) = top.start.momentum_body.map(|m| -(m.hi() / moment) * power(1));
        let g = (top.weight / a).hi() * power(2);
        let by_transverse = [m1, m2, m3_start, -g].map(|x| x / moment / scale);
        let more = (a - c) / (a * c);
        let axes = axes.to_rotation_matrix().into_inner();
        let along = axes.column(2) * axes.column(2).transpose();
        let across = Matrix3::identity() - along;
        let attitude_at_start = rotation(top.body.leave(&start));
        Derivative {
            axes,
            attitude_at_start,
            omega_at_start: top.body.omega_of(&start),
            inverse_transverse: 1.0 / moment,
            inverse_inertia: across / (moment * scale) + along / (c.hi() * scale),
            across,
            along,
            passages,
            turns: (attitude_at_start * axes).transpose(),
            rates: axes.transpose() * (power(1) / moment / scale),
            by_transverse,
            by_weight: power(2) / moment / scale,
            per_momentum: power(1) / moment,
            per_rate: moment * power(-1) * scale,
            beside: m3 * more,
            further: [more, m3 / (a * a), -(m3 / (c * c))].map(|rate| rate.hi() / scale),
        }
    }
}

impl LagrangeTop {
    /// The state at time `t` (s, of either sign) with its derivative by the state at t = 0, by the transverse and the axial moment
    /// and by the weight moment, in closed form. The first call works out one nutation; each takes the same time at any `t`.
    ///
    /// Both transverse moments change together and the weight moment stays on the axis, so that the body remains a Lagrange top; of a
    /// spherical body the axis is that of the weight moment. For a body without weight there is
    /// [`FreeMotion::at_with_derivative`](crate::flow::FreeMotion::at_with_derivative).
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::Body;
    /// use polhode::flow::{LagrangeTop, TurnAxes};
    /// use polhode::inertia::Inertia;
    /// let (inertia, omega) = (Inertia::from_moments([1.25, 1.25, 0.75])?, Vector3::new(0.0, 0.0, 20.0));
    /// let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
    /// let top = |weight: f64| {
    ///     LagrangeTop::from_omega(&Body::heavy(inertia.clone(), Vector3::new(0.0, 0.0, weight))?, tilted, omega)
    ///         .map_err(polhode::Error::from)
    /// };
    /// let later = top(2.0)?.at_with_derivative(100.0)?;
    /// // what one part in 10⁶ more weight makes of the attitude
    /// let turn = later.by_omega(TurnAxes::Space).fixed_view::<3, 1>(0, 8) * 2e-6;
    /// let heavier = top(2.0 * (1.0 + 1e-6))?.at(100.0)?.rotation() * later.state().rotation().inverse();
    /// assert!((heavier.scaled_axis() - turn).norm() < 1e-3 * turn.norm());
    /// # Ok::<(), polhode::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`at`](Self::at), and a derivative that has grown beyond the range of a double, next to the upright axis.
    pub fn at_with_derivative(&self, t: f64) -> Result<TopDerivative, DerivativeError> {
        TimeError::check(t, self.reach())?;
        let constants = self.constants();
        let inside = self.along_axis(t);
        let now = self.placed(inside);
        let state = self.body.leave(&now);
        let found = match self.columns(constants, t, inside, rotation(state)) {
            Some(columns) => self.found(constants, state, columns, 0),
            None => self.at_with_scaled_derivative(t)?.unscaled(),
        };
        let is_finite = found.columns.as_slice().iter().all(|x| x.is_finite());
        is_finite.then_some(found).ok_or(DerivativeError::OutOfRange { t })
    }

    /// Where the motion is at `now`, from the rows by momentum with rotation vectors in the body, times 2^`exponent`.
    pub(super) fn scaled(&self, now: &Point<f64>, rows: SMatrix<f64, 6, 9>, exponent: i32) -> TopDerivative {
        let constants = self.constants();
        let state = self.body.leave(now);
        let (before, after) = (constants.attitude_at_start.transpose(), rotation(state).transpose());
        let columns = in_axes(TurnAxes::Body, rows, before, after);
        self.found(constants, state, columns, exponent)
    }

    fn constants(&self) -> &Derivative {
        self.derivative.get_or_init(|| Box::new(Derivative::of(self)))
    }

    fn found(
        &self,
        constants: &Derivative,
        state: State,
        columns: SMatrix<f64, 6, 9>,
        exponent: i32,
    ) -> TopDerivative {
        TopDerivative {
            attitude: rotation(state),
            omega: constants.inverse_inertia * state.momentum(),
            state,
            attitude_at_start: constants.attitude_at_start,
            columns,
            exponent,
            across: constants.across,
            along: constants.along,
            moments: [self.transverse, self.axial].map(|moment| moment.hi() * self.body.scale()),
            omega_at_start: constants.omega_at_start,
        }
    }

    /// The columns of a [`TopDerivative`], by attitude and momentum at the time `t` in coordinates with e₃ along the weight moment and
    /// by the rotation of the body; `None` where they grow too far to be followed.
    fn columns(
        &self,
        constants: &Derivative,
        t: f64,
        (along, now): (Quat<f64>, Vec3<f64>),
        attitude: Matrix3<f64>,
    ) -> Option<SMatrix<f64, 6, 9>> {
        let Derivative { axes, turns, rates, by_transverse, by_weight, .. } = constants;
        let t_dd = Dd::from(t);
        let response = match (&self.motion, &constants.passages) {
            (Motion::Nutating { unit, .. }, Some(passages)) => {
                let ball = |(attitude, m): (Quat<f64>, Vec3<f64>)| {
                    Ball::new(attitude, [m[0], m[1]].map(|m| m * constants.per_momentum))
                };
                let place = |t: f64| ball(self.along_axis(libm::scalbn(t, *unit)));
                passages.at(t_dd.scaled(-unit), &ball((along, now)), place)?
            }
            _ => {
                let up = self.start.attitude.rotate_back(Vec3::unit(2))[2];
                let sign = if up < Dd::ZERO { -Dd::ONE } else { Dd::ONE };
                let (a, m3) = (self.transverse, self.start.momentum_body[2]);
                vertical::at(t_dd, self.weight / a * sign, m3 / a, constants.beside * t_dd)
            }
        };
        let mut inside = SMatrix::<f64, 6, 9>::zeros();
        inside.fixed_columns_mut::<3>(0).copy_from(&(response.fixed_columns::<3>(0) * turns));
        inside.fixed_columns_mut::<3>(3).copy_from(&(response.fixed_columns::<3>(3) * rates));
        for row in 0..6 {
            for (column, by) in by_transverse.iter().enumerate() {
                inside[(row, 6)] += response[(row, 3 + column)] * by;
            }
            inside[(row, 8)] = response[(row, 6)] * by_weight;
        }
        // momenta are rates times the moment
        let momentum = now * self.body.scale();
        let [by_m3, by_transverse, by_axial] = constants.further.map(|rate| rate * t);
        let axis = axes.column(2) * by_m3;
        let angles = [axis.x, axis.y, axis.z, by_transverse, by_axial, 0.0];
        for k in 0..3 {
            for column in 0..9 {
                inside[(3 + k, column)] *= constants.per_rate;
            }
            inside[(3 + k, 6)] += now[k] * constants.inverse_transverse;
        }
        for (column, angle) in angles.into_iter().enumerate() {
            inside[(2, 3 + column)] += angle;
            inside[(3, 3 + column)] += momentum[1] * angle;
            inside[(4, 3 + column)] -= momentum[0] * angle;
        }
        let mut columns = SMatrix::<f64, 6, 9>::zeros();
        columns.fixed_rows_mut::<3>(0).copy_from(&(attitude * axes * inside.fixed_rows::<3>(0)));
        columns.fixed_rows_mut::<3>(3).copy_from(&(axes * inside.fixed_rows::<3>(3)));
        Some(columns)
    }
}
