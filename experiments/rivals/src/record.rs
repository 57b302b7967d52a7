//! Records in their own units.

use nalgebra::Vector3;
use polhode_fit::{Record, Segment};

/// A segment in units of the root mean square rate of its record and its inverse.
pub(super) struct Stretch {
    pub(super) times: Vec<f64>,
    pub(super) rates: Vec<Vector3<f64>>,
}

/// The segments, and the root mean square rate, rad/s.
pub(super) fn normalised(record: &Record) -> (Vec<Stretch>, f64) {
    let rates = || record.segments.iter().flat_map(Segment::rates);
    let largest = rates().map(|w| w.amax()).fold(0.0, f64::max);
    let mean = rates().map(|w| (w / largest).norm_squared()).sum::<f64>() / record.samples() as f64;
    let rms = largest * mean.sqrt();
    let scaled = |s: &Segment| Stretch {
        times: s.times().iter().map(|t| (t - s.times()[0]) * rms).collect(),
        rates: s.rates().iter().map(|w| w / rms).collect(),
    };
    (record.segments.iter().map(scaled).collect(), rms)
}
