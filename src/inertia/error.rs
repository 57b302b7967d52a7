//! Why a tensor, or a body of mass, is refused.

use thiserror::Error;

use crate::num::{Computed, Shown};

/// Why a tensor is not the inertia of a body.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum InertiaError {
    /// An entry is not a finite number.
    #[error("inertia has the entry {value}; every entry must be a finite number")]
    NotFinite {
        /// The offending value.
        value: f64,
    },
    /// The tensor is not symmetric.
    #[error(
        "inertia tensor is not symmetric: I_{row}{column} = {} but I_{column}{row} = {}, apart by {relative:.3e} of the trace; \
         I_jk = -sum m x_j x_k is the same both ways",
        Shown(*upper), Shown(*lower)
    )]
    NotSymmetric {
        /// Axis name of the first index.
        row: char,
        /// Axis name of the second index.
        column: char,
        /// Entry above the diagonal.
        upper: f64,
        /// Entry below the diagonal.
        lower: f64,
        /// Their difference over the trace.
        relative: f64,
    },
    /// A principal moment is zero or negative.
    #[error(
        "principal moments {}, {}, {}: each must be positive (a moment is a sum of mass times distance squared)",
        Computed(moments[0]),
        Computed(moments[1]),
        Computed(moments[2])
    )]
    NotPositive {
        /// The principal moments.
        moments: [f64; 3],
    },
    /// A moment is so small beside the largest that nothing can be computed from both.
    #[error(
        "principal moments {}, {}, {}: the smallest is less than 2^-200 (6e-61) of the largest; so slender a body is beyond \
         the range of a double",
        Computed(moments[0]),
        Computed(moments[1]),
        Computed(moments[2])
    )]
    Slender {
        /// The principal moments.
        moments: [f64; 3],
    },
    /// The moments of a rotor are in units in which a kernel cannot take powers of them.
    #[error(
        "principal moments {}, {}, {}: the largest of a rotor must be within 2^40 (1e12) of 1; divide moments and momenta by a power \
         of two, or take the rotor of a body",
        Computed(moments[0]),
        Computed(moments[1]),
        Computed(moments[2])
    )]
    FarFromOne {
        /// The principal moments.
        moments: [f64; 3],
    },
    /// A moment is outside the range of a double, or so small that it has lost digits.
    #[error("inertia of the size {} puts a moment outside the range of a double; change the units", Shown(*value))]
    OutOfRange {
        /// The largest entry, or the trace that was asked for.
        value: f64,
    },
    /// Two moments together are less than the third.
    #[error(
        "principal moments {}, {}, {} violate I{} + I{} >= I{} by {} ({:.3} % of the largest); no mass distribution has them",
        Computed(moments[0]), Computed(moments[1]), Computed(moments[2]), pair[0] + 1, pair[1] + 1, largest + 1, Computed(*excess), percent
    )]
    Triangle {
        /// The principal moments.
        moments: [f64; 3],
        /// The two that are too small, from 0.
        pair: [usize; 2],
        /// The one that is too large, from 0.
        largest: usize,
        /// By how much, in the unit of the moments.
        excess: f64,
        /// The same in per cent of the largest moment.
        percent: f64,
    },
}

/// Why mass properties are invalid.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MassError {
    /// A mass, length or density is zero, negative or not finite.
    #[error("{quantity} is {}; it must be a finite number above zero", Shown(*value))]
    NotPositive {
        /// What was measured.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// A length that may be zero is negative, or no number.
    #[error("{quantity} is {}; it must be zero or a finite number above zero", Shown(*value))]
    Negative {
        /// What was measured.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// A coordinate is not a finite number.
    #[error("{quantity} has the component {value}; every component must be a finite number")]
    NotFinite {
        /// What was measured.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// One size of a shape must lie below another.
    #[error("{shape}: {small_name} {} must be below {large_name} {}", Shown(*small), Shown(*large))]
    Sizes {
        /// The shape.
        shape: &'static str,
        /// The size that is too large.
        small_name: &'static str,
        /// Its value.
        small: f64,
        /// The size that it must not reach.
        large_name: &'static str,
        /// Its value.
        large: f64,
    },
    /// No such shape.
    #[error("no such shape '{name}'; known: {known}")]
    UnknownShape {
        /// What was asked for.
        name: String,
        /// The shapes there are.
        known: String,
    },
    /// A shape with too many or too few sizes.
    #[error("{shape} takes {needed} ({names}), but {given} given")]
    SizeCount {
        /// The shape.
        shape: &'static str,
        /// The number of sizes it has.
        needed: usize,
        /// Their names.
        names: String,
        /// The number of sizes given.
        given: usize,
    },
    /// There is nothing to sum.
    #[error("a body needs at least one part")]
    Empty,
    /// The masses and lengths put a moment outside the range of a double.
    #[error("masses and lengths put a moment of inertia outside the range of a double; change the units")]
    OutOfRange,
    /// The tensor about the centre of mass is not physically valid.
    #[error("about the centre of mass: {0}")]
    Inertia(#[from] InertiaError),
}
