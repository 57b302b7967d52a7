//! Attitude from measured angular velocity: the integration that every gyroscope needs.
//!
//! Between the samples t_k and t_{k+1} the rates are a polynomial through 2m samples, m on each side, which is used in this middle
//! interval alone. The turn is the exponential of its Magnus series: one exponential a sample. For instantaneous rates the order is
//! up to 6, where rules that hold a rate or join two by a straight line have order 1 or 2.
//!
//! * [`Strapdown`] takes samples one by one in constant memory, for `f64` and double-double;
//! * [`Budgeted`] and [`attitudes`] put its error budget beside each attitude, by cause; [`choose`] finds order and samples for a record;
//! * [`Rule`]: the Magnus rules by order and samples, and the rules that people run;
//! * [`Flight`]: where the body is known and free, its exact motion through all the rates;
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
