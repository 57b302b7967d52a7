//! What explicit methods on (q, m) share: the equations, and pairs with steps of their own.

mod adaptive;
mod embedded;
mod equations;
mod pair;

pub use embedded::Embedded;
pub(super) use equations::{Equations, claims};
pub(super) use pair::sum;
pub use pair::{Control, Pair, Stage, Terms};
