//! What a fit found of the attitudes themselves.

use nalgebra::UnitQuaternion;

/// Attitudes that were fitted, with what was found of them.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct AttitudeFit {
    /// Noise of one component of the rotation vector, rad: as given, or what the motion leaves.
    pub noise_sigma: f64,
    /// Whether the noise was given.
    pub noise_is_given: bool,
    /// What is left of one component, rad.
    pub residual: f64,
    /// What neighbouring attitudes alone say of the noise, where the body turns little between them, rad.
    pub local_noise: Option<f64>,
    /// Whether the attitudes were taken the other way round than they came: as space → body axes.
    pub is_inverse: bool,
    /// Log-likelihood of this direction less that of the other, where both were tried; infinite where the other has no motion.
    pub direction_gain: Option<f64>,
    /// Largest turn from one attitude to the next, rad.
    pub largest_turn: f64,
    /// Samples that were left out because they jump or stand out of the noise.
    pub left_out: usize,
    /// Samples that were left out because they repeat the attitude before.
    pub repeated: usize,
    /// Where rates stand beside the attitudes, how both compare.
    pub alignment: Option<AlignmentFit>,
}

/// The turn between the body axes of attitudes and those of rates.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlignmentFit {
    /// Takes coordinates along the body axes of the attitudes to those of the rates, which are those of the tensor.
    pub turn: UnitQuaternion<f64>,
    /// Standard deviations of the turn about each axis of the attitudes, rad.
    pub sigma: [f64; 3],
    /// By how much the axes turn against each other from the first sample of a segment to its last, rad: fitted where the
    /// record shows it, else by one step of least squares.
    pub moving: f64,
    /// Gain of log-likelihood with that, by one step of least squares.
    pub moving_gain: f64,
}
