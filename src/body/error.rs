//! Why a state is none of a body, and why a force cannot act.

use thiserror::Error;

use crate::num::Shown;

/// Why a start is not usable.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum StateError {
    /// A component is not a finite number.
    #[error("{quantity} has the component {value}; every component must be a finite number")]
    NotFinite {
        /// Which quantity.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// The quaternion of the attitude is zero.
    #[error("the attitude is the zero quaternion, which is not a rotation; any other norm is accepted")]
    NoAttitude,
    /// The spin is too large or too small for its energy to be a double.
    #[error(
        "{quantity} {} {unit} with this inertia puts the energy outside the range of a double; change the units", Shown(*value)
    )]
    OutOfRange {
        /// Angular velocity or momentum, which was given.
        quantity: &'static str,
        /// Its largest component.
        value: f64,
        /// In which unit.
        unit: &'static str,
    },
    /// The weight moment is too large or too small beside the inertia.
    #[error(
        "weight moment {} N m beside moments of inertia of {}: the rate of falling is outside the range \
         of a double; change the units",
        Shown(*weight_moment), Shown(*moment)
    )]
    WeightOutOfRange {
        /// Size of the weight moment, N m.
        weight_moment: f64,
        /// Largest moment of inertia, to a power of two.
        moment: f64,
    },
}

/// Why a force cannot act.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ForceError {
    /// A parameter is not a finite number.
    #[error("{quantity} of the {force} is {}; it must be a finite number", Shown(*value))]
    NotFinite {
        /// Name of the force.
        force: &'static str,
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A drag coefficient is negative.
    #[error(
        "{quantity} of the {force} is {}; drag takes energy from the body, so its coefficients must not be negative: change the sign",
        Shown(*value)
    )]
    Negative {
        /// Name of the force.
        force: &'static str,
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// The eccentricity is that of no ellipse.
    #[error(
        "the eccentricity is {}; that of an elliptic orbit is in [0, 1), and 0 is a circle; give a parabola or a hyperbola by \
         its periapsis distance",
        Shown(*eccentricity)
    )]
    Eccentricity {
        /// The value.
        eccentricity: f64,
    },
    /// The eccentricity is that of no conic.
    #[error(
        "the eccentricity is {}; it is at least 0: below 1 the orbit is an ellipse, at 1 a parabola, above 1 a hyperbola",
        Shown(*eccentricity)
    )]
    NoConic {
        /// The value.
        eccentricity: f64,
    },
    /// A parameter is zero or negative.
    #[error("{quantity} of the {force} is {}; it must be positive", Shown(*value))]
    NotPositive {
        /// Name of the force.
        force: &'static str,
        /// Which parameter.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// An orbit is run through too fast or too slowly.
    #[error("the angular velocity at the periapsis, {} rad/s, is outside the range of a double", Shown(*rate))]
    RateOutOfRange {
        /// The root of GM over the cube of the least distance, rad/s.
        rate: f64,
    },
    /// A table of an orbit has too few rows.
    #[error(
        "the orbit table has {times} times and {places} positions; it needs at least {needed} of each, and as many positions as times"
    )]
    Rows {
        /// Of times.
        times: usize,
        /// Of places.
        places: usize,
        /// At least.
        needed: usize,
    },
    /// The times of a table do not ascend.
    #[error("in the orbit table the time {} s follows {} s; times must ascend", Shown(*after), Shown(*before))]
    NotAscending {
        /// The time before, s.
        before: f64,
        /// The time after it in the table, s.
        after: f64,
    },
    /// Rows of a table are too far apart.
    #[error(
        "between {} s and {} s the rows of the orbit table are too far apart: interpolations through eight and six rows differ \
         by {error:.1e} of the distance; add rows between them", Shown(*from), Shown(*to)
    )]
    Gap {
        /// The row before, s.
        from: f64,
        /// The row after, s.
        to: f64,
        /// The difference over the distance.
        error: f64,
    },
    /// An interval in which it acts is none.
    #[error(
        "the interval from {} s to {} s comes after {} s; the intervals of a force must ascend, and each must end after its beginning",
        Shown(*from), Shown(*to), Shown(*before)
    )]
    Interval {
        /// The beginning, s.
        from: f64,
        /// The end, s.
        to: f64,
        /// The end of the interval before, s.
        before: f64,
    },
}
