//! Energy and momentum with more digits than were integrated.

use crate::body::{Body, State};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The quantities that motion keeps, in double-double, along a kernel's axes and in its scale.
///
/// Free motion keeps them all; under gravity the energy and the vertical component of L are left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Invariants {
    /// Energy ½ m·I⁻¹m + U.
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
            energy: body.scaled_energy(&x),
            momentum_squared: x.momentum_body.norm_squared(),
            momentum_space: x.momentum_space(),
        }
    }

    /// |m|.
    pub fn momentum(&self) -> Dd {
        self.momentum_squared.sqrt()
    }
}
