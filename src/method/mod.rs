//! Methods: one step of size h is a map Φ_h that moves a state; its claims are data, and the laws in `tests/laws.rs`
//! execute every one of them, also those that say no.

mod axis_order;
mod catalogue;
mod claims;
mod composition;
mod implicit_midpoint;
mod kick_drift;
mod lie_poisson;
mod rattle;
mod runge_kutta;
pub mod schemes;
mod stagnation;

pub use axis_order::AxisOrder;
pub use catalogue::{AnyMethod, UnknownMethod, catalogue, method};
pub use claims::{Claims, Cost, Energy, Kept, KeptHeavy};
pub use composition::{Composed, SUZUKI_4, Scheme};
pub use implicit_midpoint::ImplicitMidpoint;
pub use kick_drift::KickDrift;
pub use lie_poisson::LiePoisson;
pub use rattle::Rattle;
pub use runge_kutta::{ExplicitEuler, Rk4, SemiImplicitEuler};

use thiserror::Error;

use crate::body::{Body, State};
use crate::num::Real;
use crate::observe::{BLOCK, Monitor};

/// A family of maps Φ_h, one for each body and step size.
pub trait Method<S: Real>: Claimed {
    /// The map for one h and one body, with everything that does not change from step to step worked out.
    type Step: Step<S> + Send + 'static;

    /// Fixes the step size `h` (s, may be negative) and the body; `x` is the start as kernels see it.
    ///
    /// # Errors
    /// A step that is zero or not finite.
    fn prepare(&self, h: f64, body: &Body, x: &State<S>) -> Result<Self::Step, StepError>;
}

/// What a method says of itself.
pub trait Claimed {
    /// Name in the catalogue, with its argument.
    fn name(&self) -> String;
    /// What it keeps, its order and its source.
    fn claims(&self) -> Claims;
}

/// One map Φ_h.
pub trait Step<S: Real> {
    /// x ← Φ_h(x). Cannot fail; an implicit step keeps its worst residual instead.
    fn step(&mut self, x: &mut State<S>);

    /// The worst relative residual at which an implicit solve ended; 0 for explicit maps.
    fn worst_residual(&self) -> f64 {
        0.0
    }
}

/// Many steps at one virtual call: what the dynamic outside sees of a [`Step`].
pub trait Advance: Send {
    /// Takes up to `steps` steps, each seen by `monitor`; stops before the first state that is not finite and
    /// returns how many were taken.
    fn advance(&mut self, x: &mut State<f64>, steps: u64, monitor: &mut Monitor) -> u64;

    /// Takes `steps` steps that nobody watches.
    fn advance_unseen(&mut self, x: &mut State<f64>, steps: u64);

    /// As [`Step::worst_residual`].
    fn worst_residual(&self) -> f64;
}

impl<T: Step<f64> + Send> Advance for T {
    fn advance(&mut self, x: &mut State<f64>, steps: u64, monitor: &mut Monitor) -> u64 {
        let mut taken = 0;
        let mut block = [*x; BLOCK];
        while taken < steps {
            let wanted = (steps - taken).min(BLOCK as u64) as usize;
            let before = *x;
            for state in &mut block[..wanted] {
                self.step(x);
                *state = *x;
            }
            let finite = monitor.observe(&block[..wanted]);
            taken += finite as u64;
            if finite < wanted {
                *x = if finite == 0 { before } else { block[finite - 1] };
                return taken;
            }
        }
        steps
    }

    fn advance_unseen(&mut self, x: &mut State<f64>, steps: u64) {
        for _ in 0..steps {
            self.step(x);
        }
    }

    fn worst_residual(&self) -> f64 {
        Step::worst_residual(self)
    }
}

/// Why a method cannot take steps of this size, or of this body.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StepError {
    /// The step is zero or not finite.
    #[error("step {h} is not usable; it must be a finite number of seconds other than 0")]
    NotAStep {
        /// The step asked for, s.
        h: f64,
    },
    /// The body has a weight moment, the method no torque.
    #[error(
        "method {method:?} is for free bodies and this one has a weight moment; take kick-drift, for one"
    )]
    Torque {
        /// Name of the method.
        method: String,
    },
}

/// `h` if a map can be prepared for it.
fn usable(h: f64) -> Result<f64, StepError> {
    if h.is_finite() && h != 0.0 { Ok(h) } else { Err(StepError::NotAStep { h }) }
}
