//! Why a scheme does not fit its base.

use thiserror::Error;

/// A scheme does not fit its base.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SchemeError {
    /// The scheme alternates two flows, and the free part of the base has a lower order than the scheme.
    #[error(
        "scheme {scheme:?} alternates kicks with free motion, which must be exact or at least of its own order; that of {base} \
         has order {order}: use a composition, such as suzuki-4, or kick-drift@{scheme}"
    )]
    Inexact {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
        /// Order of its free part.
        order: u32,
    },
    /// The scheme alternates two flows, and the base is one map.
    #[error(
        "scheme {scheme:?} alternates two flows, and {base} is a single map; use a composition, such as suzuki-4"
    )]
    OneMap {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
    /// The two lists of a scheme do not alternate.
    #[error(
        "scheme {scheme:?} lists {outer} shares of the first flow and {inner} of the other; the first must have as many, or one \
         more"
    )]
    Lengths {
        /// Name of the scheme.
        scheme: &'static str,
        /// Shares listed of the flow that is first and last.
        outer: usize,
        /// Shares listed of the other.
        inner: usize,
    },
    /// The lists of a processed scheme do not alternate.
    #[error(
        "processed scheme {scheme:?} lists {} shares of A and {} of B for the kernel, {} and {} for the processor; the kernel \
         must have as many of both, the processor one more of B, or none of both",
        kernel[0], kernel[1], processor[0], processor[1]
    )]
    ProcessedLengths {
        /// Name of the scheme.
        scheme: &'static str,
        /// Shares listed of A and of B in the kernel.
        kernel: [usize; 2],
        /// Shares listed of A and of B in the processor.
        processor: [usize; 2],
    },
    /// The list of gradients does not belong to the kicks.
    #[error(
        "scheme {scheme:?} lists {given} gradients, and the first half of its step has {kicks} kicks, including the middle one: give a gradient for each"
    )]
    Gradients {
        /// Name of the scheme.
        scheme: &'static str,
        /// Gradients listed.
        given: usize,
        /// Kicks in the first half of the step.
        kicks: usize,
    },
    /// A coefficient is not a finite number.
    #[error("scheme {scheme:?} has the coefficient {value}; every coefficient must be a finite number")]
    NotFinite {
        /// Name of the scheme.
        scheme: &'static str,
        /// The offending value.
        value: f64,
    },
    /// What a scheme claims is no order, or contradicts itself.
    #[error(
        "scheme {scheme:?} claims order {order}{}; an order must be from 1 to 32, and the orders by powers of the small part \
         must decrease to that of the scheme",
        powers.map_or(String::new(), |powers| format!(" and orders {powers:?} by powers of the small part"))
    )]
    Claim {
        /// Name of the scheme.
        scheme: &'static str,
        /// The order claimed.
        order: u32,
        /// The orders claimed of a near-integrable pair, if the scheme is for one.
        powers: Option<&'static [u32]>,
    },
    /// The coefficients do not satisfy the conditions of the order that is claimed.
    #[error(
        "scheme {scheme:?} claims order {order}{}, and its terms of degree {degree} in h differ from those of the exact step by \
         {defect:.1e} of their size; a scheme of that order with fifteen digits stays below {allowed:.0e}",
        of_b.map_or(String::new(), |of_b| format!(" in the terms with {of_b} flows of B"))
    )]
    Order {
        /// Name of the scheme.
        scheme: &'static str,
        /// The order claimed.
        order: u32,
        /// The lowest degree in h whose conditions fail: the order is less by one.
        degree: u32,
        /// In which terms, by the number of flows of B that they hold; for near-integrable pairs.
        of_b: Option<u32>,
        /// The largest difference of a coefficient in the series of the step, over the largest sum of sizes of which such a
        /// coefficient is made.
        defect: f64,
        /// What rounding of the coefficients may leave of it.
        allowed: f64,
    },
    /// A composition needs a base that is symmetric under every force.
    #[error(
        "scheme {scheme:?} needs a method that is symmetric under every force, and {base}, which predicts ω at the end of a \
         step, is not if the torque depends on ω; use implicit-midpoint, rattle, lie-poisson or kick-drift"
    )]
    Foretells {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
    /// A composition is of higher order only over a symmetric base.
    #[error(
        "scheme {scheme:?} needs a symmetric method, and {base} is not symmetric; use implicit-midpoint, rattle, lie-poisson or \
         kick-drift"
    )]
    NotSymmetric {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
}
