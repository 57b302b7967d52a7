//! Energy and momentum with more digits than were integrated.

use crate::body::{Body, Point, Time};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Energy and momentum of a point in double-double, in the solver frame and divided by [`Body::scale`].
/// [`Body::conserved`] tells which of them are constant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct Invariants {
    /// Energy ½ m·I⁻¹m + U.
    pub energy: Dd,
    /// |m|².
    pub momentum_squared: Dd,
    /// L = q m q*.
    pub momentum_space: Vec3<Dd>,
}

impl Invariants {
    /// Of the point `x` at the time `at`.
    pub fn of(body: &Body, at: Time, x: &Point<f64>) -> Self {
        let x = x.to_dd();
        Invariants {
            energy: body.scaled_energy(at, &x),
            momentum_squared: x.momentum_body.norm_squared(),
            momentum_space: x.momentum_space(),
        }
    }

    /// |m|.
    pub fn momentum_norm(&self) -> Dd {
        self.momentum_squared.sqrt()
    }
}
