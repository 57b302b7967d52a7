//! The symmetric top under gravity: its motion at any time.

mod cubic;
mod derivative;
mod nutation;
mod theta;
mod top;

pub use derivative::TopDerivative;
pub use top::{LagrangeError, LagrangeTop};
