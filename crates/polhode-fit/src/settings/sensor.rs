//! What may be wrong with the sensor.

use crate::setters::setters;

/// Prior standard deviations of errors of the sensor, Gaussian about zero. An error with a prior is estimated with the tensor; one that
/// is `None` is assumed to be zero.
///
/// ```
/// use polhode_fit::{SensorPriors, Settings};
/// // an offset of some 0.02 rad/s on each axis, and a scale of 2 per cent
/// let sensor = SensorPriors::default().with_offset(0.02).with_scale(0.02);
/// let settings = Settings::default().with_sensor(sensor);
/// assert!(settings.sensor.skew.is_none());
/// ```
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorPriors {
    /// Of the offset of each axis, rad/s.
    pub offset: Option<f64>,
    /// Of the relative error of scale that the axes share.
    pub scale: Option<f64>,
    /// Of the relative errors of scale of each axis by itself.
    pub axis_scales: Option<f64>,
    /// Of the angles by which pairs of axes are not at right angles, rad.
    pub misalignment: Option<f64>,
    /// Of the delays of the readings of the y and z axes against the x axis, s: positive where a reading shows the motion of an earlier time.
    pub skew: Option<f64>,
}

impl SensorPriors {
    setters! {
        options {
            offset => with_offset(f64),
            scale => with_scale(f64),
            axis_scales => with_axis_scales(f64),
            misalignment => with_misalignment(f64),
            skew => with_skew(f64),
        }
        values {}
    }

    /// With their names.
    pub(crate) fn named(&self) -> [(&'static str, Option<f64>); 5] {
        [
            ("the deviation of the offset", self.offset),
            ("the deviation of the scale", self.scale),
            ("the deviation of the axis scales", self.axis_scales),
            ("the deviation of the misalignment", self.misalignment),
            ("the deviation of the skew", self.skew),
        ]
    }
}
