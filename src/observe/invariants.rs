//! Energy and momentum with more digits than were integrated.

use crate::body::{Body, Point, Time, Wheels};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// The point `x` with the momentum of body and wheels.
pub(crate) fn with_wheels(wheels: Option<&Wheels>, at: Time, x: &Point<Dd>) -> Point<Dd> {
    let of_wheels = wheels.map_or(Vec3::zero(), |wheels| wheels.at(at));
    Point::new(x.attitude, x.momentum_body + of_wheels)
}

/// Energy and momentum of a point in double-double, in the solver frame and divided by [`Body::scale`].
/// [`Body::conserved`] tells which of them are constant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct Invariants {
    /// Energy ½ ω·Iω + U.
    pub energy: Dd,
    /// |m|², with the momentum of wheels.
    pub momentum_squared: Dd,
    /// L = q m q*, with the momentum of wheels.
    pub momentum_space: Vec3<Dd>,
}

impl Invariants {
    /// Of the point `x` at the time `at`.
    pub fn of(body: &Body, at: Time, x: &Point<f64>) -> Self {
        let x = x.to_dd();
        let energy = body.scaled_energy(at, &x);
        let whole = with_wheels(body.momentum_of_wheels().as_ref(), at, &x);
        Invariants {
            energy,
            momentum_squared: whole.momentum_body.norm_squared(),
            momentum_space: whole.momentum_space(),
        }
    }

    /// |m|.
    pub fn momentum_norm(&self) -> Dd {
        self.momentum_squared.sqrt()
    }
}
