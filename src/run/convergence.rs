//! Convergence orders, measured in double-double so that no plateau of rounding flatters or hides a slope.

use thiserror::Error;

use crate::body::{Body, Clock, Point};
use crate::flow::{ExactMotion, NoClosedForm, TimeError};
use crate::method::{AnyMethod, StepError};
use crate::num::Dd;
use crate::rotation::rotation_angle;

/// Global errors at one step size.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Halving {
    /// Step, s.
    pub h: f64,
    /// Angle in rad between computed and exact attitude at the end.
    pub attitude_error: f64,
    /// |m − m_exact| / |m_exact| at the end; 0 at rest.
    pub momentum_error: f64,
}

/// Why an order cannot be measured.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum HalvingError {
    /// The method does not take the step or the body.
    #[error(transparent)]
    Step(#[from] StepError),
    /// There is no exact motion to compare with.
    #[error(transparent)]
    NoClosedForm(#[from] NoClosedForm),
    /// The span is no time that the motion can be followed for.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// More halvings than steps can be counted.
    #[error("{exponent} halvings make 2^{exponent} steps; at most 2^53 can be counted")]
    TooMany {
        /// How often the span was to be halved.
        exponent: u32,
    },
}

/// Errors of exact motion after the time `span` for steps `span / 2^k`, k in `exponents`, integrated in double-double.
///
/// `span`, s, should be a power of two, so that every step is exact.
///
/// # Errors
/// A span that is no usable step, a body that the method is not for, or one whose motion has no closed form.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Body;
/// use polhode::inertia::Inertia;
/// use polhode::method::method;
/// use polhode::run::{halvings, observed_order};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let errors = halvings(&method("rk4")?, &body, &body.enter(&start)?, 1.0, 5..8)?;
/// let attitude: Vec<_> = errors.iter().map(|error| (error.h, error.attitude_error)).collect();
/// assert!(observed_order(&attitude).is_some_and(|order| (order - 4.0).abs() < 0.1));
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn halvings(
    method: &dyn AnyMethod,
    body: &Body,
    start: &Point<Dd>,
    span: f64,
    exponents: core::ops::Range<u32>,
) -> Result<Vec<Halving>, HalvingError> {
    let motion = ExactMotion::from_point(body, *start)?;
    motion.check_time(span)?;
    let exact = motion.point_at_dd(Dd::from(span));
    halvings_against(&exact, method, body, start, span, exponents)
}

/// As [`halvings`], for any body, against the point `exact` at the time `span`, s.
///
/// # Errors
/// As [`halvings`].
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Body;
/// use polhode::inertia::Inertia;
/// use polhode::method::method;
/// use polhode::run::{halvings_against, observed_order};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// // a spin of 1 rad/s about the third axis, and where it is after 1 s
/// let turned = |angle: f64| body.state(UnitQuaternion::from_scaled_axis(Vector3::z() * angle), Vector3::z());
/// let (start, end) = (body.enter(&turned(0.0)?)?, body.enter(&turned(1.0)?)?);
/// let errors = halvings_against(&end, &method("rk4")?, &body, &start, 1.0, 3..6)?;
/// let attitude: Vec<_> = errors.iter().map(|error| (error.h, error.attitude_error)).collect();
/// assert!(observed_order(&attitude).is_some_and(|order| (order - 4.0).abs() < 0.1));
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn halvings_against(
    exact: &Point<Dd>,
    method: &dyn AnyMethod,
    body: &Body,
    start: &Point<Dd>,
    span: f64,
    exponents: core::ops::Range<u32>,
) -> Result<Vec<Halving>, HalvingError> {
    exponents
        .map(|exponent| {
            if exponent > 53 {
                return Err(HalvingError::TooMany { exponent });
            }
            let steps = 1_u64 << exponent;
            let h = span / steps as f64;
            let mut x = Point::new(start.attitude, start.momentum_body);
            method.prepare_dd(Clock::new(h), body)?.steps(&mut x, steps);
            let difference = (x.momentum_body - exact.momentum_body).norm();
            let size = exact.momentum_body.norm();
            Ok(Halving {
                h,
                attitude_error: rotation_angle(x.attitude, exact.attitude).hi(),
                momentum_error: if difference == Dd::ZERO { 0.0 } else { (difference / size).hi() },
            })
        })
        .collect()
}

/// The slope of log error against log h over the last two of the pairs (h, error); `None` with fewer, or with an error of 0.
///
/// ```
/// use polhode::run::observed_order;
/// let quartered = observed_order(&[(0.5, 1e-2), (0.25, 2.5e-3)]);
/// assert!(quartered.is_some_and(|order| (order - 2.0).abs() < 1e-14));
/// assert_eq!(observed_order(&[(0.5, 1e-2)]), None);
/// ```
#[must_use]
pub fn observed_order(errors: &[(f64, f64)]) -> Option<f64> {
    let [.., (h0, e0), (h1, e1)] = errors else { return None };
    (*e0 > 0.0 && *e1 > 0.0).then(|| libm::log(e0 / e1) / libm::log(h0 / h1))
}
