//! Derivatives of a step by central differences in double-double.

use crate::method::StepError;
use crate::num::{Dd, Real};

/// The derivative of `f` at 0, component by component, by central differences of order 4: truncation 1e-24, rounding 1e-26.
pub(super) fn derivative<const N: usize>(
    f: impl Fn(Dd) -> Result<[Dd; N], StepError>,
) -> Result<[Dd; N], StepError> {
    let d = 2.0_f64.recip() / f64::from(1_u32 << 18);
    let at = |k: f64| f(Dd::of(k * d));
    let (near, back, far, far_back) = (at(1.0)?, at(-1.0)?, at(2.0)?, at(-2.0)?);
    Ok(core::array::from_fn(|n| {
        let slope = (near[n] - back[n]) * Dd::of(8.0) - (far[n] - far_back[n]);
        slope * (Dd::ONE / Dd::of(12.0 * d))
    }))
}
