//! What is wrong with a gyroscope, as standard deviations.

use super::error::StrapdownError;

/// Errors of a gyroscope, as standard deviations of each axis: what an attitude is worth that is integrated from its readings.
///
/// ```
/// use polhode::strapdown::Sensor;
/// // a data sheet: 0.3 °/√h of angular random walk, 10 °/h of bias, at 50 samples a second
/// let degree = core::f64::consts::PI / 180.0;
/// let sensor = Sensor::default()
///     .with_noise(Sensor::noise_of_walk(0.3 * degree / 60.0, 0.02))
///     .with_bias(10.0 * degree / 3600.0);
/// assert!((sensor.noise - 6.17e-4).abs() < 1e-6); // rad/s of each reading
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Sensor {
    /// White noise of a reading, rad/s; of increments rad.
    pub noise: f64,
    /// Constant bias, rad/s.
    pub bias: f64,
    /// Error of the scale, a ratio: 0.01 for one per cent.
    pub scale: f64,
    /// Error of each time stamp, s, independent of the others.
    pub stamps: f64,
}

impl Sensor {
    /// With white noise of this standard deviation of a reading, rad/s; of increments rad.
    #[must_use]
    pub fn with_noise(self, noise: f64) -> Self {
        Sensor { noise, ..self }
    }

    /// With a constant bias of this standard deviation, rad/s.
    #[must_use]
    pub fn with_bias(self, bias: f64) -> Self {
        Sensor { bias, ..self }
    }

    /// With a scale error of this standard deviation, a ratio.
    #[must_use]
    pub fn with_scale(self, scale: f64) -> Self {
        Sensor { scale, ..self }
    }

    /// With errors of the time stamps of this standard deviation, s.
    #[must_use]
    pub fn with_stamps(self, stamps: f64) -> Self {
        Sensor { stamps, ..self }
    }

    /// Noise of a reading (rad/s) that makes an angular random walk of `walk` rad/√s where readings come every `interval` s;
    /// the noise of an increment is `walk` times the root of the interval.
    #[must_use]
    pub fn noise_of_walk(walk: f64, interval: f64) -> f64 {
        walk / interval.sqrt()
    }

    pub(super) fn check(&self) -> Result<(), StrapdownError> {
        let all = [
            ("the noise", self.noise),
            ("the bias", self.bias),
            ("the scale error", self.scale),
            ("the error of the stamps", self.stamps),
        ];
        // a larger one has a square that no double holds, and covariances that are no numbers
        match all.into_iter().find(|(_, value)| !(0.0..1e154).contains(value)) {
            Some((name, value)) => Err(StrapdownError::Sensor { name, value }),
            None => Ok(()),
        }
    }
}
