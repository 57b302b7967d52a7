//! Accurate long-time rotation of rigid bodies.

pub mod body;
pub mod catalog;
#[cfg(feature = "fit")]
pub mod fit;
pub mod flow;
pub mod method;
pub mod num;
pub mod observe;
pub mod rotation;
pub mod run;
