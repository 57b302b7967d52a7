//! The exact motion of a body, where there is a closed form.

use polhode::body::{Body, State};
use polhode::flow::{FreeMotion, LagrangeError, LagrangeTop, TimeError};
use polhode::num::Dd;

/// A motion in closed form.
pub(crate) enum Reference {
    Free(Box<FreeMotion>),
    Lagrange(Box<LagrangeTop>),
}

impl Reference {
    /// Of `body` from `start`, as kernels see it.
    ///
    /// # Errors
    /// A heavy body that is no Lagrange top, with the condition that fails.
    pub(crate) fn new(body: &Body, start: State<Dd>) -> Result<Self, LagrangeError> {
        Ok(if body.gravity::<f64>().is_some() {
            Self::Lagrange(Box::new(LagrangeTop::new(body, start)?))
        } else {
            Self::Free(Box::new(FreeMotion::new(body, start)))
        })
    }

    /// The state at the time `t` since the start, as kernels see it.
    pub(crate) fn inside_at_dd(&self, t: Dd) -> State<Dd> {
        match self {
            Self::Free(motion) => motion.inside_at_dd(t),
            Self::Lagrange(top) => top.inside_at_dd(t),
        }
    }

    /// Whether there is a state at `t`.
    pub(crate) fn check(&self, t: f64) -> Result<(), TimeError> {
        match self {
            Self::Free(motion) => motion.at(t).map(|_| ()),
            Self::Lagrange(top) => top.at(t).map(|_| ()),
        }
    }
}
