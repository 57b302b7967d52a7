//! What the user may set.

use super::error::FitError;
use super::physical::limits::Limit;
use super::report::scale::Known;

/// What the user may set; the default leaves everything to the record.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::fit::{Known, Limit, Settings};
/// // test functions of half width 0.5 s, at least 0.4 of the trace about z, and a trace of 5.6 kg m²
/// let limit = Limit { axis: Vector3::z(), at_least: Some(0.4), at_most: None };
/// let settings = Settings {
///     radius: Some(0.5),
///     limits: vec![limit],
///     known: Some(Known::Trace(5.6)),
///     ..Settings::default()
/// };
/// assert!(settings.noise.is_none() && settings.check_units);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Half width of the test functions, s; chosen by least predicted covariance without it.
    pub radius: Option<f64>,
    /// Standard deviation of the noise of one component, rad/s, at least 1e-10 of the rates; read from the samples
    /// without it.
    pub noise: Option<f64>,
    /// What is known of the moments beforehand.
    pub limits: Vec<Limit>,
    /// What gives the absolute size.
    pub known: Option<Known>,
    /// Whether a unit that explains the record ten times better is an error.
    pub check_units: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { radius: None, noise: None, limits: Vec::new(), known: None, check_units: true }
    }
}

impl Settings {
    /// Whether each value is one that a fit can use.
    pub(super) fn check(&self) -> Result<(), FitError> {
        let known = self.known.map(Known::value);
        for (name, value) in
            [("the radius", self.radius), ("the noise", self.noise), ("the known quantity", known)]
        {
            if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
                return Err(FitError::Setting { name, value });
            }
        }
        if let Some(Known::Moment { axis, .. }) = self.known {
            let size = axis.norm();
            if !(size > 0.0 && size.is_finite()) {
                return Err(FitError::Setting {
                    name: "the length of the axis of the known moment",
                    value: size,
                });
            }
        }
        Ok(())
    }
}
