//! Accurate long-time rotation of rigid bodies.

pub mod num;
