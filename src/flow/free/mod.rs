//! The free body: its motion at any time, and its flow for splittings.

mod addition;
mod character;
mod circulation;
mod covariance;
mod departure;
mod derivative;
mod free_body;
mod free_flow;
mod motion;
mod orbit;
mod phase;
mod polhode;
mod pure_spin;
mod short_flow;
mod short_lanes;
mod symmetric_top;
mod theta;
mod through;
mod tumbling;
#[cfg(any(test, feature = "random"))]
mod tumbling_population;

pub(crate) use addition::{Addition, Curve};
pub use character::{AtRest, Character, Mode};
pub use covariance::{CovarianceError, StartCovariance, StateCovariance};
pub use departure::Departure;
pub(crate) use departure::{direction, smallest_turn};
pub use derivative::StateDerivative;
pub use free_body::FreeBody;
pub use free_flow::FreeFlow;
pub(crate) use free_flow::{Last, apart};
pub use motion::FreeMotion;
pub(crate) use orbit::FreeOrbit;
pub(super) use phase::{Pair, Phase, Spin, TOO_FAR, pair, reduce};
pub use pure_spin::{PureSpin, Stability};
pub(crate) use short_lanes::FreeLanes;
pub use symmetric_top::SymmetricTop;
pub(super) use theta::{Family, LEAST_TERMS, Powers, T, U, V_MINUS, V_PLUS, least_value, polynomial};
pub use through::{FittedMotion, Interpolation, Passage, Passages, ThroughError};
pub use tumbling::{TumblingElements, TumblingError};
#[cfg(any(test, feature = "random"))]
pub use tumbling_population::{NoElements, NoTumbler, TumblingPopulation, TumblingSolution};
