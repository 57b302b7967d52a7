//! Bodies: inertia tensors, states of rotation, and the frame in which kernels see them.

mod carry;
mod frame;
mod inertia;
mod principal;
mod state;

pub use carry::Carry;
pub(crate) use frame::of_dd;
pub use frame::{Body, StateError};
pub use inertia::{Inertia, InertiaError, InertiaShape, Symmetry};
pub use state::State;
