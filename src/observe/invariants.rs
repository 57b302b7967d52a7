//! Energy and momentum with more digits than were integrated.

use crate::body::{Body, State};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The quantities that free motion keeps, in double-double, along a kernel's axes and in its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Invariants {
    /// Kinetic energy ½ m·I⁻¹m.
    pub energy: Dd,
    /// |m|².
    pub momentum_squared: Dd,
    /// L = q m q*.
    pub momentum_space: Vec3<Dd>,
}

impl Invariants {
    /// Of the state `x` as kernels see it.
    pub fn of(body: &Body, x: &State<f64>) -> Self {
        let x = State::<Dd>::of(*x);
        Invariants {
            energy: energy(body.inverse_moments(), x.momentum_body),
            momentum_squared: x.momentum_body.norm_squared(),
            momentum_space: x.momentum_space(),
        }
    }

    /// |m|.
    pub fn momentum(&self) -> Dd {
        self.momentum_squared.sqrt()
    }
}

/// ½ m·I⁻¹m.
pub(super) fn energy<S: Real>(inverse_moments: Vec3<S>, m: Vec3<S>) -> S {
    m.times(inverse_moments).dot(m) * S::of(0.5)
}
