//! A body with inner friction: free motion and the loss of energy, one after the other.

use thiserror::Error;

use super::{Cost, Energy, Kept, KineticSplit};
use crate::body::Rotor;
use crate::flow::{Dissipation, FreeFlow};
use crate::num::Precise;

/// The free motion by its exact flow and [internal dissipation](Dissipation) by its own, in turn: of order 2 by Strang's scheme, higher by
/// compositions, with kicks under a potential.
///
/// The loss δ is the share by which the body turns across its angular momentum beside I⁻¹m; the energy above that of the steady spin
/// about the axis of the largest moment then falls, next to that spin, at the mean rate δ |m| (1/I_a + 1/I_b − 2/I_max). L in space is kept to
/// rounding, and the energy never rises. It solves another problem than the methods of the [catalogue](super::catalogue()), and is none of them.
///
/// ```
/// use polhode::body::Conserved;
/// use polhode::method::{Dissipating, Splitting, schemes::STRANG};
/// use polhode::{Body, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(Default::default(), [0.4, 1.0, 0.8].into())?;
/// let method = Splitting::of_flows(Dissipating::new(1e-2)?, STRANG)?;
/// let end = Run::new(&method, &body, &start, 0.05)?.advance_to(40_000)?;
/// assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error < 1e-14));
/// let omega = end.omega_body; // about the third axis now
/// assert!(omega.xy().norm() < 0.02 * omega.norm());
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dissipating {
    loss: f64,
}

/// The loss is not usable.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the loss is {loss}; it must be above 0 and below 1, for planetary bodies far below 1")]
#[non_exhaustive]
pub struct LossError {
    /// What was given.
    pub loss: f64,
}

impl Dissipating {
    /// With the loss δ.
    ///
    /// # Errors
    /// A loss that is not above 0 and below 1.
    pub fn new(loss: f64) -> Result<Self, LossError> {
        if loss > 0.0 && loss < 1.0 { Ok(Dissipating { loss }) } else { Err(LossError { loss }) }
    }
}

impl KineticSplit for Dissipating {
    type Flows<S: Precise> = (FreeFlow<S>, Dissipation<S>);

    fn name(&self) -> String {
        format!("dissipating:{:?}", self.loss)
    }
    fn flows<S: Precise>(&self, rotor: &Rotor) -> Self::Flows<S> {
        (FreeFlow::new(rotor), Dissipation::new(rotor, self.loss))
    }
    fn kept(&self) -> Kept {
        Kept::all_of_free_motion(Energy::Drifts)
    }
    fn symplectic(&self) -> bool {
        false
    }
    fn cost(&self) -> Cost {
        Cost::free_flows(2)
    }
    fn source(&self) -> &'static str {
        "Brockett, Linear Algebra Appl. 146 (1991) 79; Bloch, Krishnaprasad, Marsden and Ratiu, Commun. \
         Math. Phys. 175 (1996) 1"
    }
}
