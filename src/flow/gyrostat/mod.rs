//! The gyrostat: a rigid body with wheels at constant relative momentum, its motion at any time.

mod lattice;
mod level;
mod orbit;
mod pencil;
mod reason;
mod spinor;
mod steady;
mod weierstrass;

pub(crate) use orbit::GyrostatOrbit;
pub use reason::Reason;
pub(crate) use steady::{SteadySpin, steady_spins};
