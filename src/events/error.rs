//! Why events could not be looked for.

use thiserror::Error;

use crate::flow::TimeError;
use crate::num::Shown;

/// Why events could not be looked for.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum EventError {
    /// A time that has no state.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// The end does not come after the beginning.
    #[error("events are searched for from {} s to {} s; the end must come after the beginning", Shown(*from), Shown(*to))]
    NotAscending {
        /// The beginning, s.
        from: f64,
        /// The end, s.
        to: f64,
    },
    /// The spacing is not positive.
    #[error("the time between looks of the search is {} s; it must be positive", Shown(*spacing))]
    Spacing {
        /// The spacing, s.
        spacing: f64,
    },
    /// More looks than can be taken.
    #[error(
        "a search with {looks:.1e} looks, {} s apart, is too long: at most {:.0e} are allowed; use a longer time between looks or a shorter time",
        Shown(*spacing), super::along::MOST_LOOKS
    )]
    TooMany {
        /// How many there would be.
        looks: f64,
        /// The spacing, s.
        spacing: f64,
    },
    /// The function is no number.
    #[error("the event {event:?} is not a number at t = {} s", Shown(*time))]
    NotANumber {
        /// Name of the event.
        event: String,
        /// When, s.
        time: f64,
    },
    /// The function jumps.
    #[error(
        "the event {event:?} jumps from {before:.3e} to {after:.3e} at t = {} s: it is not continuous; state it as a condition, \
         by Event::when, if it is one", Shown(*time)
    )]
    NotContinuous {
        /// Name of the event.
        event: String,
        /// When, s.
        time: f64,
        /// The value before.
        before: f64,
        /// The value behind.
        after: f64,
    },
    /// The function changes faster than it was said to.
    #[error(
        "the event {event:?} changes by {change:.3e} within {} s before t = {} s, and at most {allowed:.3e} was stated; \
         state a larger rate", Shown(*within), Shown(*time)
    )]
    FasterThanStated {
        /// Name of the event.
        event: String,
        /// When, s.
        time: f64,
        /// In which time, s.
        within: f64,
        /// By how much it changes.
        change: f64,
        /// By how much it may.
        allowed: f64,
    },
    /// The axis or the angle of a cone, or a rate, that is none.
    #[error("{quantity} of the event is {}; {rule}", Shown(*value))]
    Parameter {
        /// What.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it has to be.
        rule: &'static str,
    },
}
