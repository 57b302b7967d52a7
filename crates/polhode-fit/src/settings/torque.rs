//! The torque that a fit reckons with.

use core::fmt;

/// The model of a torque that the record does not measure. Its coefficients are divided by the trace of the tensor, so that
/// they do not depend on its size.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TorqueModel {
    /// None: the body is free.
    None,
    /// Drag that slows every rotation alike: τ = −k J ω, k ≥ 0 in 1/s.
    Drag,
    /// Viscous drag with a coefficient for each sensor axis: τ = −D ω, D diagonal.
    Drag3,
    /// Drag that grows with the square of the rate: τ = −c |ω| J ω, c ≥ 0, per radian.
    Quadratic,
    /// A torque that is constant in body axes.
    Constant,
    /// The first of no torque, [`Drag`](Self::Drag) or [`Constant`](Self::Constant), and [`Drag3`](Self::Drag3) that
    /// the next one does not surpass in restricted likelihood.
    #[default]
    Auto,
}

impl fmt::Display for TorqueModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::None => "none",
            Self::Drag => "drag",
            Self::Drag3 => "drag3",
            Self::Quadratic => "quadratic",
            Self::Constant => "constant",
            Self::Auto => "auto",
        })
    }
}

/// White torque noise: what acts on the body at random, as turbulence does.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TorqueNoise {
    /// None.
    None,
    /// A white angular acceleration ξ of this power spectral density, (rad/s²)² s, and the torque J ξ.
    Given(f64),
    /// By restricted likelihood, for each segment: a torque J ξ, or one that is alike along all axes.
    #[default]
    Fitted,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Models are written as the command asks for them, and padded as a table asks.
    #[test]
    fn models_are_written_by_their_names() {
        let models = [
            (TorqueModel::None, "none"),
            (TorqueModel::Drag, "drag"),
            (TorqueModel::Drag3, "drag3"),
            (TorqueModel::Quadratic, "quadratic"),
            (TorqueModel::Constant, "constant"),
            (TorqueModel::Auto, "auto"),
        ];
        for (model, name) in models {
            assert_eq!(model.to_string(), name);
            assert_eq!(format!("{model:>9}"), format!("{name:>9}"));
        }
        assert_eq!(TorqueModel::default(), TorqueModel::Auto);
        assert_eq!(TorqueNoise::default(), TorqueNoise::Fitted);
    }
}
