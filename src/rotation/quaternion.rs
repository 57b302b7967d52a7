//! Quaternions over any [`Real`], scalar first.

use core::ops::{Add, Mul, Neg, Sub};

use nalgebra::{Quaternion, UnitQuaternion};

use super::Vec3;
use crate::num::{Precise, Real};

/// A quaternion `w + v`. As an attitude it takes body vectors to space: `v_space = q v_body q*`.
///
/// ```
/// use polhode::rotation::{Quat, Vec3};
/// let half = 0.5_f64.sqrt();
/// let quarter_turn = Quat::new(half, Vec3([0.0, 0.0, half])); // about z: x to y
/// assert!((quarter_turn.rotate(Vec3::unit(0)) - Vec3::unit(1)).norm() < 1e-15);
/// assert!(((quarter_turn * quarter_turn).v[2] - 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Quat<S> {
    /// Scalar part.
    pub w: S,
    /// Vector part.
    pub v: Vec3<S>,
}

impl<S: Real> Quat<S> {
    /// From scalar and vector part.
    #[inline]
    pub fn new(w: S, v: Vec3<S>) -> Self {
        Quat { w, v }
    }

    /// From the components w, x, y, z.
    #[inline]
    pub fn from_components([w, x, y, z]: [S; 4]) -> Self {
        Quat { w, v: Vec3([x, y, z]) }
    }

    /// The components w, x, y, z.
    #[inline]
    pub fn components(self) -> [S; 4] {
        [self.w, self.v[0], self.v[1], self.v[2]]
    }

    /// No rotation.
    #[inline]
    pub fn identity() -> Self {
        Quat { w: S::of(1.0), v: Vec3::zero() }
    }

    /// All components zero, as an increment.
    #[inline]
    pub fn zero() -> Self {
        Quat { w: S::of(0.0), v: Vec3::zero() }
    }

    /// Each component mapped by `f`.
    #[inline]
    pub fn map<T>(self, mut f: impl FnMut(S) -> T) -> Quat<T> {
        Quat { w: f(self.w), v: self.v.map(f) }
    }

    /// The same numbers in another scalar.
    #[inline]
    pub fn of(q: Quat<f64>) -> Self {
        Quat { w: S::of(q.w), v: Vec3::of(q.v) }
    }

    /// The conjugate, for a unit quaternion its inverse.
    #[inline]
    pub fn conjugate(self) -> Self {
        Quat { w: self.w, v: -self.v }
    }

    /// Squared norm.
    #[inline]
    pub fn norm_squared(self) -> S {
        self.w * self.w + self.v.norm_squared()
    }

    /// Scaled to norm 1.
    #[inline]
    pub fn normalized(self) -> Self {
        self * (S::of(1.0) / self.norm_squared().sqrt())
    }

    /// The Cayley transform `(1, c)/√(1 + |c|²)`: a turn by `2 atan |c|` about `c`.
    #[inline]
    pub fn cayley(c: Vec3<S>) -> Self {
        let w = S::of(1.0) / (S::of(1.0) + c.norm_squared()).sqrt();
        Quat { w, v: c * w }
    }

    /// The turn by |u| rad about u, `(cos ½|u|, sin ½|u| · u/|u|)`: the exponential of a rotation vector.
    ///
    /// ```
    /// use polhode::rotation::{Quat, Vec3};
    /// let third = Quat::exponential(Vec3([0.0, 0.0, core::f64::consts::TAU / 3.0]));
    /// assert!((third * third * third + Quat::identity()).magnitude() < 1e-15); // a whole turn is −1
    /// ```
    #[inline]
    pub fn exponential(u: Vec3<S>) -> Self {
        let half = u * S::of(0.5);
        let angle = half.norm();
        if angle.magnitude() == 0.0 {
            return Quat::new(S::of(1.0), half);
        }
        let (sin, cos) = angle.sin_cos();
        Quat::new(cos, half * (sin / angle))
    }

    /// `q v q*`: the body vector `v` in space. Not divided by |q|².
    #[inline]
    pub fn rotate(self, v: Vec3<S>) -> Vec3<S> {
        let u = self.v;
        let two = S::of(2.0);
        v * (self.w * self.w - u.norm_squared()) + u * (two * u.dot(v)) + u.cross(v) * (two * self.w)
    }

    /// `q* v q`: the space vector `v` in the body. Not divided by |q|².
    #[inline]
    pub fn rotate_back(self, v: Vec3<S>) -> Vec3<S> {
        self.conjugate().rotate(v)
    }

    /// `½ q ∘ (0, ω)`, the rate of an attitude with angular velocity `omega` in body axes.
    #[inline]
    pub fn rate(self, omega: Vec3<S>) -> Self {
        let half = omega * S::of(0.5);
        Quat { w: -self.v.dot(half), v: half * self.w + self.v.cross(half) }
    }

    /// The largest |component| as `f64`; NaN if one is NaN.
    #[inline]
    pub fn magnitude(self) -> f64 {
        let (w, v) = (self.w.magnitude(), self.v.magnitude());
        if w.is_nan() || v.is_nan() { f64::NAN } else { w.max(v) }
    }
}

impl<S: Precise> Quat<S> {
    /// The rotation vector of the turn, of length 0 to π: the same of q and −q, whatever the norm.
    ///
    /// ```
    /// use polhode::rotation::{Quat, Vec3};
    /// let u = Vec3([0.3, -0.2, 1e-9]);
    /// assert!((Quat::exponential(u).logarithm() - u).norm() < 1e-16);
    /// ```
    pub fn logarithm(self) -> Vec3<S> {
        let sine = self.v.norm();
        let two = S::of(if self.w < S::of(0.0) { -2.0 } else { 2.0 });
        if sine.magnitude() == 0.0 {
            return self.v * two;
        }
        self.v * (two * sine.atan2(self.w.abs()) / sine)
    }
}

impl<S: Real> Mul for Quat<S> {
    type Output = Self;
    /// Hamilton product.
    #[inline]
    fn mul(self, p: Self) -> Self {
        Quat { w: self.w * p.w - self.v.dot(p.v), v: p.v * self.w + self.v * p.w + self.v.cross(p.v) }
    }
}
impl<S: Real> Mul<S> for Quat<S> {
    type Output = Self;
    #[inline]
    fn mul(self, k: S) -> Self {
        Quat { w: self.w * k, v: self.v * k }
    }
}
impl<S: Real> Add for Quat<S> {
    type Output = Self;
    #[inline]
    fn add(self, p: Self) -> Self {
        Quat { w: self.w + p.w, v: self.v + p.v }
    }
}
impl<S: Real> Sub for Quat<S> {
    type Output = Self;
    #[inline]
    fn sub(self, p: Self) -> Self {
        Quat { w: self.w - p.w, v: self.v - p.v }
    }
}
impl<S: Real> Neg for Quat<S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Quat { w: -self.w, v: -self.v }
    }
}

impl From<UnitQuaternion<f64>> for Quat<f64> {
    fn from(q: UnitQuaternion<f64>) -> Self {
        Quat { w: q.w, v: Vec3([q.i, q.j, q.k]) }
    }
}
impl From<Quat<f64>> for UnitQuaternion<f64> {
    /// Normalised: the attitude of a method that lets |q| drift still is a rotation.
    fn from(q: Quat<f64>) -> Self {
        UnitQuaternion::new_normalize(Quaternion::new(q.w, q.v[0], q.v[1], q.v[2]))
    }
}
