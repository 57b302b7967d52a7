//! The library as its users call it: one program, so that it is linked once. Every file beside this one is named here.

#![cfg(test)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // what clippy.toml allows inside #[test], for the helpers too

mod adaptive;
mod advise;
mod atoms;
#[allow(clippy::disallowed_methods)] // sines of the records that another program would write
mod audit;
mod cases;
mod covariance;
#[allow(clippy::disallowed_methods)] // sizes of cases and tolerances
mod derivative;
mod dmv;
mod doctor;
mod ensemble;
mod euler;
mod events;
mod exact;
mod exact_step;
mod false_claims;
mod fixtures;
mod forces;
#[cfg(feature = "random")]
mod gyrostat;
mod gyrostat_programs;
mod hostile;
mod inertia;
mod laws;
mod mesh;
mod motions;
mod no_squish;
mod num;
mod observe;
mod phase;
#[cfg(feature = "random")]
mod population;
mod programs;
mod properties;
mod rotation;
mod rounding;
mod schemes;
mod series;
#[cfg(feature = "random")]
mod spikes;
mod strapdown;
mod surface;
mod switched;
mod taylor;
#[allow(clippy::disallowed_methods)] // sizes of cases and tolerances
mod through;
#[allow(clippy::disallowed_methods)] // sizes of cases and tolerances
mod top_derivative;
#[cfg(feature = "random")]
#[allow(clippy::disallowed_methods)] // sizes of cases and tolerances
mod top_differences;
mod tops;
mod truth;
mod tumbling;
mod two_turns;
mod units;
mod yardsticks;
