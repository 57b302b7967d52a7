//! Convergence orders, measured in double-double so that no plateau of rounding flatters or hides a slope.

use crate::body::{Body, State};
use crate::flow::FreeMotion;
use crate::method::{AnyMethod, StepError};
use crate::num::Dd;
use crate::rotation::rotation_angle;

/// Global errors at one step size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halving {
    /// Step, s.
    pub h: f64,
    /// Angle in rad between computed and exact attitude at the end.
    pub attitude_error: f64,
    /// |m − m_exact| / |m_exact| at the end.
    pub momentum_error: f64,
}

/// Errors after the time `span` for steps `span / 2^k`, k in `exponents`, integrated in double-double.
///
/// `start` is a state as kernels see it; `span` should be a power of two, so that every step is exact.
///
/// # Errors
/// A span that is no usable step.
pub fn halvings(
    method: &dyn AnyMethod,
    body: &Body,
    start: &State<Dd>,
    span: f64,
    exponents: core::ops::Range<u32>,
) -> Result<Vec<Halving>, StepError> {
    let exact = FreeMotion::new(body, *start).inside_at_dd(Dd::from(span));
    exponents
        .map(|k| {
            let steps = 1_u64 << k;
            let h = span / steps as f64;
            let mut x = *start;
            let mut step = method.prepare_dd(h, body, &x)?;
            for _ in 0..steps {
                step.step(&mut x);
            }
            let difference = x.momentum_body - exact.momentum_body;
            Ok(Halving {
                h,
                attitude_error: rotation_angle(x.attitude, exact.attitude).hi(),
                momentum_error: (difference.norm() / exact.momentum_body.norm()).hi(),
            })
        })
        .collect()
}

/// The slope of log error against log h over the last two halvings.
pub fn observed_order(errors: &[(f64, f64)]) -> Option<f64> {
    let [.., (h0, e0), (h1, e1)] = errors else { return None };
    (*e0 > 0.0 && *e1 > 0.0).then(|| libm::log(e0 / e1) / libm::log(h0 / h1))
}
