//! The symmetric top under gravity: its motion at any time.

mod cubic;
mod nutation;
mod theta;
mod top;

pub use top::{LagrangeError, LagrangeTop};
