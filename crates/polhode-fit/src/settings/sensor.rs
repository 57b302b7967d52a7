//! What may be wrong with the sensor.

/// Standard deviations of what may be wrong with the sensor, each a Gaussian prior about zero; `None` takes the sensor
/// to be right.
///
/// ```
/// use polhode_fit::{SensorPriors, Settings};
/// // an offset of some 0.02 rad/s on each axis, and a scale of 2 per cent
/// let sensor = SensorPriors { offset: Some(0.02), scale: Some(0.02), ..SensorPriors::default() };
/// let settings = Settings { sensor, ..Settings::default() };
/// assert!(settings.sensor.skew.is_none());
/// ```
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
    /// Of the delays of the y and z axes behind the x axis, s.
    pub skew: Option<f64>,
}

impl SensorPriors {
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
