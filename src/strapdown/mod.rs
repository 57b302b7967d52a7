//! Attitude from measured angular velocity: the integration that every gyroscope needs.
//!
//! Between the samples t_k and t_{k+1} the rates are interpolated by a polynomial through 2m samples, m on each side. The turn is the
//! exponential of its Magnus series: one exponential for each sample. For instantaneous rates the order is up to 6; rules that hold
//! a rate, or interpolate two linearly, have order 1 or 2.
//!
//! * [`Strapdown`] takes samples one by one in constant memory, for `f64` and double-double;
//! * [`Budgeted`] and [`attitudes`] give each attitude with its error budget, by cause; [`choose`] finds order and samples for a record;
//! * [`Rule`]: the Magnus rules by order and samples, and rules of other programs;
//! * [`Flight`]: the exact motion of a known free body that fits all the rates;
//! * [`Kind`]: whether a reading is a rate, an increment or an average.

mod budget;
mod checked;
mod choice;
mod error;
mod findings;
mod flight;
mod kind;
mod magnus;
mod noise;
mod response;
mod rule;
mod sensor;
mod stages;
mod stream;
mod turn;
mod window;

pub use budget::{Budget, Budgeted, Estimate};
pub use choice::{attitudes, choose};
pub use error::StrapdownError;
#[doc(hidden)]
pub use findings::Findings;
pub use flight::{Flight, FlightError};
pub use kind::{Kind, UnknownKind};
pub use noise::{NOISE_SAMPLES, noise};
pub use rule::{MOST_SAMPLES, Magnus, Rule, RuleError};
pub use sensor::Sensor;
pub use stream::{Stamped, Strapdown};
