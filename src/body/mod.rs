//! Bodies: inertia tensors and where they come from, forces, states of rotation, and the solver frame of kernels.

mod constant_torque;
mod distribution;
mod doctor;
mod drag;
mod field;
mod force;
mod frame;
mod gravity;
mod gravity_gradient;
mod inertia;
mod mass;
mod mesh;
mod point;
mod principal;
mod rotor;
mod solids;
mod state;
mod tensor;
mod time;

pub use distribution::{DistributionError, Region, integrate_mass};
pub use doctor::{Cause, Diagnosis, Entry, Evidence, Explanation, Misfit, Verdict, diagnose};
pub(crate) use field::{Evaluated, Forces, Witness};
pub use field::{Field, Free};
pub use force::{Conserved, Force, ForceError, Potential, Torque};
pub use frame::{Body, Problem, StateError};
pub use gravity::{Gravity, vertical};
pub use inertia::{Inertia, InertiaError, InertiaShape, Symmetry};
pub use mass::{Amount, Class, MassError, MassProperties};
pub use mesh::{Edge, Mesh, MeshError};
pub use point::{Phase, Point};
pub(crate) use rotor::Gyroscopic;
pub use rotor::Rotor;
pub use solids::Solid;
pub use state::State;
pub use time::{Clock, Time};
