//! The laboratory: experiments and their results.

#![allow(missing_docs)]

pub mod build;
pub mod experiment;
mod experiments;
pub mod methods;
pub mod parallel;
pub mod results;
pub mod timing;
