//! What was estimated beside the tensor, and what errors of the sensor would do to the moments.

use crate::columns::column::Column;
use crate::settings::torque::TorqueModel;

/// A number that was estimated beside the tensor.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Nuisance {
    /// Its name, as `drag` or `offset_x`.
    pub name: &'static str,
    /// Its unit, empty for a ratio.
    pub unit: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// The standard deviation of its prior, where it has one.
    pub prior: Option<f64>,
    pub(crate) column: Column,
}

impl Nuisance {
    /// Of a column whose value and deviation are in units of the rate `rms`, rad/s.
    pub(crate) fn new(column: &Column, value: f64, sigma: f64, rms: f64) -> Nuisance {
        let label = column.label();
        let unit = label.factor(rms);
        Nuisance {
            name: label.name,
            unit: label.unit,
            value: value * unit,
            sigma: sigma * unit,
            prior: column.prior.map(|prior| prior * unit),
            column: *column,
        }
    }
}

/// The torque that a fit reckons with.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct FittedTorque {
    /// The model; never [`TorqueModel::Auto`].
    pub model: TorqueModel,
    /// Whether the fit has chosen it.
    pub is_chosen: bool,
    /// Its coefficients.
    pub coefficients: Vec<Nuisance>,
    /// Gain of log-likelihood over no torque, where both were fitted.
    pub gain: Option<f64>,
    /// I₁/I₃ and I₂/I₃ as they would be without the torque.
    pub ratios_without: Option<[f64; 2]>,
}

/// What an error of the sensor, or a wheel or a magnet in the body, that the fit takes to be zero would do to the moments.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Systematic {
    /// The error, as `offset_x`; `wheel_x` is a constant momentum inside the body, `walk` a random walk of the offsets,
    /// `magnet` the torque on a magnet in the body in a field that is fixed in space, both in random directions, over the trace.
    pub name: &'static str,
    /// Its size.
    pub size: f64,
    /// The unit of its size, empty for a ratio.
    pub unit: &'static str,
    /// The change of the principal moments, as shares of the trace, that an error of this size makes; of a walk and of a
    /// magnet its standard deviation.
    pub principal: [f64; 3],
    /// The same of I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
}

impl Systematic {
    /// Whether it is an error of the sensor, not a wheel or a magnet in the body.
    pub fn is_of_sensor(&self) -> bool {
        !self.name.starts_with("wheel") && self.name != "magnet"
    }
}

/// How a prior tensor and a record agree.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Square of their distance in standard deviations of it: χ² where both are right.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub dof: usize,
}

/// One segment of a record in a fit, or a part of one between bursts of eight samples and more that were left out.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentSummary {
    /// Index of the segment in the record.
    pub segment: usize,
    /// Samples that were used.
    pub samples: usize,
    /// Noise of one component of its rates, rad/s.
    pub noise_sigma: f64,
    /// Power spectral density of the angular acceleration that its torque noise makes, the mean of the three components, (rad/s²)² s.
    pub torque_noise: f64,
    /// Its share of the information about the tensor: the shares of all segments sum to 1.
    pub weight: f64,
    /// The answer by the other segments; `None` where they do not determine the tensor.
    pub without: Option<WithoutSegment>,
}

/// The answer by all segments but one, of the record alone: before a prior, the physical law and limits, and with wheels by the weak form.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithoutSegment {
    /// I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
    /// Their standard deviations.
    pub sigma_ratios: [f64; 2],
    /// Distance from the tensor by all segments, in standard deviations of that.
    pub shift: f64,
}
