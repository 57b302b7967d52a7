//! Why a scheme does not fit its base.

use thiserror::Error;

/// A scheme does not fit its base.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SchemeError {
    /// The scheme alternates two flows, and the free part of the base has a lower order than the scheme.
    #[error(
        "scheme {scheme:?} alternates kicks with free motion that is exact or at least of its own order, and that of {base} has \
         order {order}; take a composition, such as suzuki-4, or kick-drift@{scheme}"
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
        "scheme {scheme:?} alternates two flows, and {base} is one map; take a composition, such as suzuki-4"
    )]
    OneMap {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
    /// The two lists of a scheme do not alternate.
    #[error(
        "scheme {scheme:?} lists {outer} shares of the flow that is first and {inner} of the other; of the first there are as \
         many or one more"
    )]
    Lengths {
        /// Name of the scheme.
        scheme: &'static str,
        /// Shares listed of the flow that is first and last.
        outer: usize,
        /// Shares listed of the other.
        inner: usize,
    },
    /// A composition needs a base that is symmetric under every force.
    #[error(
        "{base} foretells ω at the end of a step, so that it is symmetric only where the torque does not depend on ω, and scheme \
         {scheme:?} raises the order of methods that are symmetric under every force; take implicit-midpoint, rattle, lie-poisson \
         or kick-drift"
    )]
    Foretells {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
    /// A composition is of higher order only over a symmetric base.
    #[error(
        "{base} is not symmetric, and scheme {scheme:?} raises the order of symmetric methods only; take implicit-midpoint, \
         rattle, lie-poisson or kick-drift"
    )]
    NotSymmetric {
        /// Name of the scheme.
        scheme: &'static str,
        /// Name of the base.
        base: String,
    },
}
