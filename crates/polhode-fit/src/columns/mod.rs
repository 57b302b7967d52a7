//! The unknowns beside the tensor: torques on the body, and errors of the sensor.

pub(crate) mod dissipation;
pub(crate) mod model;
pub(crate) mod squared;
