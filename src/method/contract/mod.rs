//! What a method is: maps, claims, names.

mod any_method;
mod catalogue;
mod claims;
pub(super) mod lanes;
mod listing;
mod map;
mod name;
mod own_steps;
mod tolerance;
mod with_wheels;

pub use any_method::{AnyMethod, StepError};
pub use catalogue::{catalogue, without_projections};
pub use claims::{Claimed, Claims, Cost, Energy, Kept};
pub use lanes::SideBySide;
pub use listing::{Listing, listing};
pub(crate) use map::SOLVED;
pub(super) use map::fill_in_turn;
pub use map::{Map, Method, Step, Stuck, Work};
pub use name::{UnknownMethod, method};
pub(super) use own_steps::OwnSteps;
pub use tolerance::ToleranceError;
