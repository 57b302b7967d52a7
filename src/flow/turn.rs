//! The turn about a principal axis: the exact flow of `m_i²/(2 I_i)`.

use super::Flow;
use crate::body::{Point, Rotor, Time};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// The exact flow of `½ κ m_k²`, a part of the kinetic energy that belongs to one principal axis k.
///
/// Φ_t: the body turns about k by the angle κ m_k t, which does not change; m turns back by the same angle, so that L stays in space.
/// κ is a reciprocal moment 1/I_k, or a difference of such where the rest of the energy is taken by another flow; t in seconds,
/// momenta and moments in the units of the [solver frame](crate::body::Rotor). Rounding makes |m| walk at random and not drift.
///
/// Source: McLachlan, Phys. Rev. Lett. 71 (1993) 3043.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Time};
/// use polhode::flow::{Flow, Turn};
/// use polhode::inertia::Inertia;
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let mut x = body.enter(&start)?.to_f64();
/// let [_, _, about_z] = Turn::of(&body.rotor());
/// about_z.flow(Time::from_seconds(0.0), 0.5, &mut x);
/// let end = body.leave(&x);
/// assert!((end.rotation().angle_to(&start.rotation()) - 0.3 * 0.5).abs() < 1e-15);
/// assert!((end.momentum_space() - start.momentum_space()).norm() < 1e-15);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Turn<S> {
    axis: usize,
    half_rate: S,
}

impl<S: Real> Turn<S> {
    /// The turns about each of the three axes whose energies add up to that of the body, `½ Σ m_k²/I_k`.
    #[must_use]
    pub fn of(rotor: &Rotor) -> [Self; 3] {
        let rates = rotor.inverse_moments::<Dd>();
        core::array::from_fn(|axis| Turn { axis, half_rate: S::from_dd(rates[axis] * 0.5) })
    }

    /// The turn about `AXIS` (0, 1 or 2) with κ = `rate`, of either sign.
    ///
    /// ```compile_fail
    /// let there_are_three = polhode::flow::Turn::<f64>::about::<3>(polhode::num::Dd::ONE);
    /// ```
    #[must_use]
    pub fn about<const AXIS: usize>(rate: Dd) -> Self {
        const { assert!(AXIS < 3, "the axes are 0, 1 and 2") }
        Turn { axis: AXIS, half_rate: S::from_dd(rate * 0.5) }
    }
}

impl<S: Real> Flow<S> for Turn<S> {
    #[inline]
    fn flow(&self, _: Time, t: S, x: &mut Point<S>) {
        turn_about_axis(self.axis, x, t * self.half_rate);
    }
}

/// As [`turn_about`], about an axis that is known at run time only.
#[inline]
pub(crate) fn turn_about_axis<S: Real>(axis: usize, x: &mut Point<S>, half_rate_time: S) {
    match axis {
        0 => turn_about::<0, S>(x, half_rate_time),
        1 => turn_about::<1, S>(x, half_rate_time),
        _ => turn_about::<2, S>(x, half_rate_time),
    }
}

/// Turns `x` about `AXIS` by the angle `2 · half_rate_time · m_AXIS`, rounding errors carried: the exact flow of the kinetic
/// energy of one axis (McLachlan, Phys. Rev. Lett. 71 (1993) 3043).
///
/// The momentum moves by `2 sin · (cos m_k − sin m_j)` and `−2 sin · (cos m_j + sin m_k)` of the *half* angle. An error of
/// the sine then turns it by another angle, one of the cosine changes |m| by the fraction sin² of it, and what rounding adds
/// has no preferred sign: |m| walks at random instead of drifting. The quaternion takes the same sine and cosine, so that
/// `q m q*` keeps its direction; it needs `1 − cos`, which is not rounded as a number next to 1 is, so that |q| hardly
/// wanders where the angle is small. The axis is a constant: which components move is known when the code is compiled.
#[inline]
pub(crate) fn turn_about<const AXIS: usize, S: Real>(x: &mut Point<S>, half_rate_time: S) {
    turn_by::<AXIS, S>(x, (x.momentum_body[AXIS] * half_rate_time).sin_versine());
}

/// The same by an angle of which half is at most [`SMALL`](crate::num::trig::SMALL).
#[inline(always)]
pub(crate) fn turn_a_little_about<const AXIS: usize, S: Real>(x: &mut Point<S>, half_rate_time: S) {
    turn_by::<AXIS, S>(x, (x.momentum_body[AXIS] * half_rate_time).sin_versine_small());
}

/// The same by the sine of half the angle, and one less its cosine.
#[inline(always)]
pub(crate) fn turn_by<const AXIS: usize, S: Real>(x: &mut Point<S>, (s, less): (S, S)) {
    let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    let (m, twice, c) = (x.momentum_body, s + s, S::of(1.0) - less);
    x.add_component(j, twice * (c * m[k] - s * m[j]));
    x.add_component(k, -(twice * (c * m[j] + s * m[k])));
    // q ∘ (c, s e_i) − q, without the products by zero
    let q = x.attitude;
    let mut change = Quat::new(-(s * q.v[AXIS] + less * q.w), Vec3::zero());
    change.v[AXIS] = s * q.w - less * q.v[AXIS];
    change.v[j] = s * q.v[k] - less * q.v[j];
    change.v[k] = -(s * q.v[j] + less * q.v[k]);
    x.add_attitude(change);
}
