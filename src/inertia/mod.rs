//! Inertia tensors and where they come from: moments, mass properties, solids, distributions, meshes; and what is
//! wrong with a tensor that no body has.

mod checks;
mod distribution;
mod doctor;
mod error;
mod mass;
mod mesh;
mod principal;
mod solids;
mod symmetric;
mod symmetry;
mod tensor;

pub use distribution::{MassDistributionError, Region, integrate_mass};
pub use doctor::{Cause, Diagnosis, Entry, Evidence, Explanation, Misfit, Oddity, Twin, Validity, diagnose};
pub use error::{InertiaError, MassError};
pub use mass::{Amount, MassProperties};
pub use mesh::{Boundary, Closing, Edge, FLOAT_WELD, Mesh, MeshError, Repair, Surface, SurfaceBuilder};
pub use solids::Solid;
pub(crate) use symmetric::from_entries;
pub use symmetry::{Class, Symmetry};
pub use tensor::{Inertia, InertiaShape};
