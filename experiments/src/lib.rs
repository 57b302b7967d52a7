//! The laboratory: the experiments behind the tables and figures of polhode, and their results.
//!
//! The command `polhode experiment` runs them; it also takes the tables of methods, the timing of steps, the threads and the
//! description of the build from here. The experiments themselves are private: their results are what is published.

pub mod build;
pub mod experiment;
mod experiments;
pub mod methods;
pub mod parallel;
pub mod results;
mod statistics;
pub mod timing;
