//! Accurate long-time rotation of rigid bodies.

pub mod body;
pub mod catalog;
pub mod flow;
pub mod method;
pub mod num;
pub mod observe;
pub mod rotation;
pub mod run;
