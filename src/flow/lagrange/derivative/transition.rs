//! The derivative of the motion of a top in the axes and units of its body.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use super::passage::{MOST_STEPS, Moved, Passages, turned};
use super::vertical;
use crate::body::{Point, State};
use crate::flow::TimeError;
use crate::flow::derivative::{DerivativeError, TurnAxes, in_axes, rotation};
use crate::flow::lagrange::LagrangeTop;
use crate::flow::lagrange::top::Motion;
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

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
            momentum -= part * self.omega;
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
    passages: Option<Passages>,
}

impl Derivative {
    fn of(top: &LagrangeTop) -> Self {
        let axes: UnitQuaternion<f64> = (top.body.inertia().frame() * top.frame).map(Dd::hi).into();
        let start = top.point_at_dd(Dd::ZERO);
        let passages = match &top.motion {
            Motion::Vertical => None,
            Motion::Nutating { nutation, unit, .. } => {
                let g = (top.weight / top.transverse).scaled(2 * unit).hi();
                let spin = (top.start.momentum_body[2] / top.transverse).scaled(*unit).hi();
                Some(Passages::new(nutation, g, spin))
            }
        };
        Derivative {
            axes: axes.to_rotation_matrix().into_inner(),
            attitude_at_start: rotation(top.body.leave(&start)),
            omega_at_start: top.body.omega_of(&start),
            passages,
        }
    }
}

impl LagrangeTop {
    /// The state at time `t` (s, of either sign) with its derivative by the state at t = 0, by the transverse and the axial moment
    /// and by the weight moment. The first call works out one nutation; each takes the same time at any `t`.
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
    /// As [`at`](Self::at); a derivative that has grown beyond the range of a double, next to the upright axis; and an axis that nods
    /// so slowly beside the spin, next to the sleeping top of critical spin, that one nutation takes more than 20 000 steps.
    pub fn at_with_derivative(&self, t: f64) -> Result<TopDerivative, DerivativeError> {
        TimeError::check(t, self.reach())?;
        let constants = self.derivative.get_or_init(|| Box::new(Derivative::of(self)));
        let now = self.point_at(t);
        let state = self.body.leave(&now);
        let mut columns = self.columns(constants, t, &now)?;
        let attitude = rotation(state);
        // along e₃ and across it → body axes; small turns → space
        let scale = self.body.scale();
        for n in 0..9 {
            for k in 0..3 {
                if n < 3 {
                    columns[(3 + k, n)] *= scale;
                } else {
                    columns[(k, n)] /= scale;
                }
            }
        }
        for (first, axes) in [(0, attitude * constants.axes), (3, constants.axes)] {
            let rows = axes * columns.fixed_rows::<3>(first);
            columns.fixed_rows_mut::<3>(first).copy_from(&rows);
        }
        for (first, axes) in [(0, constants.attitude_at_start * constants.axes), (3, constants.axes)] {
            let by_start = columns.fixed_columns::<3>(first) * axes.transpose();
            columns.fixed_columns_mut::<3>(first).copy_from(&by_start);
        }
        if !columns.iter().all(|x| x.is_finite()) {
            return Err(DerivativeError::OutOfRange { t });
        }
        let axis = constants.axes.column(2);
        let along = axis * axis.transpose();
        Ok(TopDerivative {
            state,
            attitude,
            attitude_at_start: constants.attitude_at_start,
            columns,
            across: Matrix3::identity() - along,
            along,
            moments: [self.transverse, self.axial].map(|moment| moment.hi() * scale),
            omega: self.body.omega_of(&now),
            omega_at_start: constants.omega_at_start,
        })
    }

    /// The columns of a [`TopDerivative`] in axes with e₃ along the weight moment, all of the body, in the units of the solver frame.
    fn columns(
        &self,
        constants: &Derivative,
        t: f64,
        now: &Point<f64>,
    ) -> Result<SMatrix<f64, 6, 9>, DerivativeError> {
        let (a, c, m3) = (self.transverse, self.axial, self.start.momentum_body[2]);
        let t_dd = Dd::from(t);
        let (moved, unit) = match (&self.motion, &constants.passages) {
            (Motion::Nutating { nutation, unit, .. }, Some(passages)) => {
                let moved = passages.at(nutation, t_dd.scaled(-unit));
                let reach = Dd::of(passages.reach()).scaled(*unit).hi();
                (moved.ok_or(DerivativeError::Slow { t, most: MOST_STEPS, reach })?, *unit)
            }
            _ => {
                let up = self.start.attitude.rotate_back(Vec3::unit(2))[2];
                let sign = if up < Dd::ZERO { -Dd::ONE } else { Dd::ONE };
                (vertical::at(t_dd, self.weight / a * sign, m3 / a), 0)
            }
        };
        let Moved { response, turn } = moved;
        let more = (a - c) / (a * c); // turns of the top beside those of the ball, per momentum
        let response = turned(response, -(turn + m3 * more * t_dd));

        // ω = m/A and g = c/A in units of time of 2^unit
        let power = |n: i32| libm::scalbn(1.0, n * unit);
        let moment = a.hi();
        let start = self.start.momentum_body.map(|m| m.hi() / moment * power(1));
        let g = (self.weight / a).hi() * power(2);
        let mut inner = SMatrix::<f64, 7, 9>::zeros();
        inner.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        inner.fixed_view_mut::<3, 3>(3, 3).fill_diagonal(power(1) / moment);
        for k in 0..3 {
            inner[(3 + k, 6)] = -start[k] / moment;
        }
        inner[(6, 6)] = -g / moment;
        inner[(6, 8)] = power(2) / moment;
        let mut columns = response * inner;

        let now = self.frame.map(Dd::hi).rotate_back(now.momentum_body);
        let by_rate = moment * power(-1);
        for n in 0..9 {
            for k in 0..3 {
                columns[(3 + k, n)] *= by_rate;
            }
        }
        for k in 0..3 {
            columns[(3 + k, 6)] += now[k] / moment;
        }
        let further = [(5, more.hi() * t), (6, (m3 / (a * a)).hi() * t), (7, -(m3 / (c * c)).hi() * t)];
        for (column, angle) in further {
            columns[(2, column)] += angle;
            columns[(3, column)] += now[1] * angle;
            columns[(4, column)] -= now[0] * angle;
        }
        Ok(columns)
    }
}
