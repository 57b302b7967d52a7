//! The equations of motion that explicit methods on (q, m) integrate: Euler's, and the kinematic one.
//!
//! `m' = m × I⁻¹m + τ(t, q, ω)`, `q' = ½ q ∘ (0, I⁻¹m)`.

use crate::body::{Field, Phase, Rotor, Time};
use crate::method::{Claims, Cost, Kept};
use crate::num::Real;
use crate::rotation::Vec3;

/// What an explicit method on (q, m) claims of every motion: nothing kept but, with `norm`, |q|.
pub(in crate::method) fn claims(
    order: u32,
    norm: bool,
    right_sides: u32,
    source: &'static str,
) -> Option<Claims> {
    Some(Claims::new(Some(order), Kept { norm, ..Kept::NOTHING }, Cost::right_sides(right_sides), source))
}

/// The right-hand side.
#[derive(Clone, Copy, Debug)]
pub(in crate::method) struct Equations<S, F> {
    pub(in crate::method) inverse_moments: Vec3<S>,
    field: F,
}

impl<S: Real, F: Field<S>> Equations<S, F> {
    pub(in crate::method) fn new(rotor: &Rotor, field: &F) -> Self {
        Self::of(rotor.inverse_moments(), field.clone())
    }

    #[inline(always)]
    pub(in crate::method) fn of(inverse_moments: Vec3<S>, field: F) -> Self {
        Equations { inverse_moments, field }
    }

    /// q' and m'.
    #[inline]
    pub(in crate::method) fn rate(&self, at: Time, x: &Phase<S>) -> Phase<S> {
        let omega = x.momentum_body.times(self.inverse_moments);
        Phase { attitude: x.attitude.rate(omega), momentum_body: self.momentum_rate(at, x, omega) }
    }

    /// m × ω + τ.
    #[inline]
    pub(in crate::method) fn momentum_rate(&self, at: Time, x: &Phase<S>, omega: Vec3<S>) -> Vec3<S> {
        let rate = x.momentum_body.cross(omega);
        if F::ACTS { rate + self.field.torque(at, x.attitude, omega) } else { rate }
    }
}
