//! Bodies: inertia tensors and where they come from, gravity about a fixed point, states of rotation, and the frame in
//! which kernels see them.

mod carry;
mod distribution;
mod doctor;
mod frame;
mod gravity;
mod gyroscopic;
mod inertia;
mod mass;
mod mesh;
mod principal;
mod solids;
mod state;
mod tensor;

pub use carry::Carry;
pub use distribution::{DistributionError, Region, integrate_mass};
pub use doctor::{Cause, Diagnosis, Entry, Evidence, Explanation, Misfit, Verdict, diagnose};
pub(crate) use frame::of_dd;
pub use frame::{Body, StateError};
pub use gravity::{Gravity, vertical};
pub(crate) use gyroscopic::Gyroscopic;
pub use inertia::{Inertia, InertiaError, InertiaShape, Symmetry};
pub use mass::{Amount, Class, MassError, MassProperties};
pub use mesh::{Edge, Mesh, MeshError};
pub use solids::Solid;
pub use state::State;
