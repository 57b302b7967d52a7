//! What readings and starts are refused for.

use super::Kind;
use super::error::StrapdownError;
use super::window::Sample;
use crate::num::Precise;
use crate::rotation::{Quat, Vec3};

/// A start of norm 1.
pub(super) fn attitude<S: Precise>(start: Quat<S>) -> Result<Quat<S>, StrapdownError> {
    let size = start.magnitude();
    if !size.is_finite() || size == 0.0 {
        return Err(StrapdownError::Start { size });
    }
    // the power of two keeps the squares in range
    let scale = libm::scalbn(1.0, -libm::ilogb(size));
    Ok((start * S::of(scale)).normalized())
}

/// A sample with number `number` after the sample `before`.
pub(super) fn sample<S: Precise>(
    kind: Kind,
    sample: &Sample<S>,
    before: Option<&Sample<S>>,
    number: usize,
) -> Result<(), StrapdownError> {
    const NAMES: [&str; 4] =
        ["the time", "the reading about x", "the reading about y", "the reading about z"];
    let [x, y, z] = sample.reading.0;
    for (value, name) in [sample.time, x, y, z].into_iter().zip(NAMES) {
        if !value.magnitude().is_finite() {
            return Err(StrapdownError::NotFinite { sample: number, name, value: value.to_f64() });
        }
    }
    let Some(before) = before else { return Ok(()) };
    if sample.time <= before.time {
        let (time, before) = (sample.time.to_f64(), before.time.to_f64());
        return Err(StrapdownError::Order { sample: number, time, before });
    }
    let h = (sample.time - before.time).to_f64();
    // the product first: squares of rates may leave the range of a double where those of angles do not
    let turn = |reading: Vec3<S>, h: f64| (reading.map(S::to_f64) * h).norm();
    let angle = match kind {
        Kind::Rate => turn(sample.reading, h).max(turn(before.reading, h)),
        Kind::Average => turn(sample.reading, h),
        Kind::Increment => turn(sample.reading, 1.0),
    };
    if angle.is_nan() || angle > core::f64::consts::PI {
        return Err(StrapdownError::HalfTurn { sample: number, time: sample.time.to_f64(), angle });
    }
    Ok(())
}
