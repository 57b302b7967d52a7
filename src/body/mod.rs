//! Bodies: inertia tensors, gravity about a fixed point, states of rotation, and the frame in which kernels see them.

mod carry;
mod frame;
mod gravity;
mod inertia;
mod principal;
mod state;

pub use carry::Carry;
pub(crate) use frame::of_dd;
pub use frame::{Body, StateError};
pub use gravity::{Gravity, vertical};
pub use inertia::{Inertia, InertiaError, InertiaShape, Symmetry};
pub use state::State;
