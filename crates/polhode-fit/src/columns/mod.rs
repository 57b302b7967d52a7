//! The unknowns beside the tensor: torques on the body, and errors of the sensor, each in a file of its own.
//!
//! J ω' + ω × J ω + D ω + c |ω| J ω − τ₀ = 0 with ω = P y − b of the readings y. Every unknown but the tensor is one column:
//! what it adds to torque or sensor, the derivative of the equations, its prior and its line in the report are those of
//! [`effect::Effect`].

pub(crate) mod axis_scale;
pub(crate) mod column;
pub(crate) mod constant;
pub(crate) mod dissipation;
pub(crate) mod drag;
pub(crate) mod effect;
pub(crate) mod equation;
pub(crate) mod input;
pub(crate) mod magnet;
pub(crate) mod misalignment;
pub(crate) mod offset;
pub(crate) mod quadratic;
pub(crate) mod rotor;
pub(crate) mod scale;
pub(crate) mod sets;
pub(crate) mod skew;
pub(crate) mod squared;
pub(crate) mod viscous;
pub(crate) mod walk;
pub(crate) mod wheel_axis;
