//! Relative errors of what a motion conserves.

use crate::body::Conserved;

/// Relative errors of the invariants against the start; `None` where the motion does not conserve the quantity, or where
/// that follows from one that is shown. All 0 for a free body at rest.
///
/// With forces, energy errors are divided by W = T₀ + |c| + Σ (|U₀| + |τ₀|): the kinetic energy at the start, the weight
/// moment, and potential and torque of every other force at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct Errors {
    /// |E − E₀| / |E₀|; with forces |E − E₀| / W.
    pub energy: Option<f64>,
    /// ||m| − |m₀|| / |m₀|.
    pub momentum_norm: Option<f64>,
    /// |L − L₀| / |L₀|, L in space.
    pub momentum_vector: Option<f64>,
    /// |L_z − L_z0| / √(2 I W), z of space, I the largest moment; where L as a whole is not conserved.
    pub momentum_z: Option<f64>,
    /// |J − J₀| / (W + n |L₀|) of Jacobi's constant J = E − n L_z; where the energy is not conserved.
    pub jacobi: Option<f64>,
    /// n of that constant, rad/s.
    pub jacobi_rate: Option<f64>,
}

impl Errors {
    /// No error is evaluated.
    pub(crate) const NONE: Errors = Errors {
        energy: None,
        momentum_norm: None,
        momentum_vector: None,
        momentum_z: None,
        jacobi: None,
        jacobi_rate: None,
    };

    /// The error of `quantity`; `None` where the motion does not conserve it, as with Jacobi's constant of another rate.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::{Body, Conserved};
    /// use polhode::inertia::Inertia;
    /// use polhode::method::method;
    /// use polhode::run::Run;
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
    /// let end = Run::new(&method("rattle")?, &body, &start, 0.1)?.advance_to(1000)?;
    /// assert!(end.worst.of(Conserved::MomentumNorm).is_some_and(|error| error < 1e-14));
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn of(&self, quantity: Conserved) -> Option<f64> {
        match quantity {
            Conserved::Energy => self.energy,
            Conserved::MomentumNorm => self.momentum_norm,
            Conserved::Momentum => self.momentum_vector,
            Conserved::MomentumZ => self.momentum_z.or(self.momentum_vector),
            Conserved::Jacobi { rate } => self.jacobi.filter(|_| self.jacobi_rate == Some(rate)),
        }
    }

    pub(crate) fn parts(&self) -> [Option<f64>; 5] {
        [self.energy, self.momentum_norm, self.momentum_vector, self.momentum_z, self.jacobi]
    }

    pub(crate) fn from_parts(parts: [Option<f64>; 5]) -> Self {
        let [energy, momentum_norm, momentum_vector, momentum_z, jacobi] = parts;
        Errors { energy, momentum_norm, momentum_vector, momentum_z, jacobi, jacobi_rate: None }
    }

    pub(super) fn max(self, other: Self) -> Self {
        let mut worst = self.parts();
        for (worst, other) in worst.iter_mut().zip(other.parts()) {
            *worst = worst.zip(other).map(|(a, b)| a.max(b));
        }
        Errors { jacobi_rate: self.jacobi_rate, ..Errors::from_parts(worst) }
    }

    pub(crate) fn is_finite(self) -> bool {
        self.parts().iter().all(|error| error.is_none_or(f64::is_finite))
    }
}
