//! Files about rotating bodies.

#![allow(missing_docs)]

pub mod error;
pub mod given;
pub mod mesh;
pub mod moment;
pub mod npy;
pub mod numbers;
mod read;
pub mod record;
pub mod robots;
pub mod text;
pub mod times;
pub mod toml_file;
pub mod trajectory;

pub use error::Error;
pub use read::read;
