//! Bodies: inertia with forces and wheels, states of rotation, and the solver frame (principal axes), in which methods compute.

#[allow(clippy::module_inception)]
mod body;
mod constant_torque;
mod drag;
mod error;
mod exit;
mod field;
mod force;
mod gravity;
mod gravity_gradient;
mod known_forces;
mod law;
mod linear_potential;
mod orbit;
mod orbit_table;
mod point;
#[cfg(any(test, feature = "random"))]
mod population;
mod rotor;
mod state;
mod switched;
mod time;
mod wheel;

pub use body::{Body, Problem};
pub(crate) use drag::Drag;
pub use error::{ForceError, StateError};
pub(crate) use exit::Exit;
#[doc(hidden)]
pub use field::Instant;
pub use field::{Field, Free};
pub(crate) use field::{Forces, Witness};
pub use force::Force;
pub(crate) use gravity_gradient::{CircularGradient, gradient_torque};
pub(crate) use known_forces::KnownForces;
pub(crate) use law::Evaluated;
pub use law::{Conserved, Potential, Torque};
pub use linear_potential::{LinearPotential, vertical};
pub use orbit::Orbit;
pub(crate) use orbit::{Place, TrueAnomaly};
pub(crate) use point::RENORMALIZE_EVERY;
pub use point::{Phase, Point};
#[cfg(any(test, feature = "random"))]
pub use population::{AttitudeSpread, Member, NoMember, Population, Tensors};
pub use rotor::Rotor;
pub(crate) use rotor::{Gyroscopic, kinetic_energy};
pub use state::State;
pub use time::{Clock, Time};
pub use wheel::{Wheel, WheelAtStart, WheelError, Wheels};
