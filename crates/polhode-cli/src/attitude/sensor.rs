//! What is wrong with the sensor.

use clap::Args;
use polhode::record::Record;
use polhode::strapdown::{Findings, Sensor};
use polhode_files::numbers::not_negative;

/// Standard deviations of the errors of the sensor.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Sensor (standard deviations)")]
pub(super) struct SensorArguments {
    /// White noise of a reading, rad/s; of increments rad [default: found in the record]
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, allow_hyphen_values = true)]
    noise: Option<f64>,
    /// Constant bias of each axis, rad/s [default: none]
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, allow_hyphen_values = true)]
    bias: Option<f64>,
    /// Scale error of each axis: 0.01 for one per cent [default: none]
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, allow_hyphen_values = true)]
    scale_error: Option<f64>,
    /// Error of each time stamp, s; a noise that is found in the record already contains it [default: none]
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, allow_hyphen_values = true)]
    stamps: Option<f64>,
}

/// The noise of a reading, and what tells it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    sigma: f64,
    pub(super) by: NoiseBy,
}

/// What tells the noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoiseBy {
    Flag,
    Record,
    /// The record has too few samples.
    Nothing,
}

impl SensorArguments {
    /// As given, or that of the longest segment; steps of digital readings count as noise.
    pub(super) fn noise(&self, record: &Record) -> Noise {
        if let Some(sigma) = self.noise {
            return Noise { sigma, by: NoiseBy::Flag };
        }
        let (sigma, is_enough) = Findings::noise(record);
        Noise { sigma, by: if is_enough { NoiseBy::Record } else { NoiseBy::Nothing } }
    }

    /// Where the steps of digital readings cannot be told, in words; `None` where they can, or what they leave open is stated.
    pub(super) fn resting(&self, noise_by: NoiseBy, record: &Record) -> Option<String> {
        let is_found = noise_by == NoiseBy::Record && self.bias.is_none();
        is_found.then(|| Findings::resting(record, "attitude_sigma", "--bias")).flatten()
    }

    pub(super) fn sensor(&self, noise: Noise) -> Sensor {
        Sensor::default()
            .with_noise(noise.sigma)
            .with_bias(self.bias.unwrap_or(0.0))
            .with_scale(self.scale_error.unwrap_or(0.0))
            .with_stamps(self.stamps.filter(|_| noise.by != NoiseBy::Record).unwrap_or(0.0))
    }
}
