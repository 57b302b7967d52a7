//! The laboratory: experiments, the judge that they share, and their results.

#![allow(missing_docs)]

pub mod build;
pub mod experiment;
mod experiments;
pub mod measured;
pub mod methods;
pub mod parallel;
pub mod results;
