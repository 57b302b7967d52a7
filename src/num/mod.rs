//! Numbers: the scalars that every kernel is written over, and functions of them. No physics.

pub mod dd;
pub mod elliptic;
pub mod expansion;
pub mod real;
pub mod sum;
pub mod trig;

pub use dd::Dd;
pub use expansion::Expansion;
pub use real::{Precise, Real};
