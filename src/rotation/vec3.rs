//! Three components over any [`Real`].

use core::cmp::Ordering;
use core::ops::{Add, Index, IndexMut, Mul, Neg, Sub};

use nalgebra::Vector3;

use crate::num::{Dd, Precise, Real};

/// Names of the axes.
pub(crate) const AXES: [char; 3] = ['x', 'y', 'z'];

/// A vector of three components.
///
/// ```
/// use polhode::num::Dd;
/// use polhode::rotation::Vec3;
/// let (x, y) = (Vec3::<f64>::unit(0), Vec3::unit(1));
/// assert_eq!(x.cross(y), Vec3::unit(2));
/// assert_eq!(Vec3::<Dd>::of(x).dot(Vec3::of(y)), Dd::ZERO);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Vec3<S>(pub [S; 3]);

impl<S: Real> Vec3<S> {
    /// The zero vector.
    #[inline]
    pub fn zero() -> Self {
        Vec3([S::of(0.0); 3])
    }

    /// The unit vector along axis 0, 1 or 2.
    ///
    /// # Panics
    /// For any other axis.
    #[inline]
    pub fn unit(axis: usize) -> Self {
        let mut e = Self::zero();
        e[axis] = S::of(1.0);
        e
    }

    /// Each component mapped by `f`.
    #[inline(always)]
    pub fn map<T>(self, mut f: impl FnMut(S) -> T) -> Vec3<T> {
        // the map of an array is a call, through memory
        let [a, b, c] = self.0;
        Vec3([f(a), f(b), f(c)])
    }

    /// The same numbers in another scalar.
    #[inline]
    pub fn of(v: Vec3<f64>) -> Self {
        Vec3(v.0.map(S::of))
    }

    /// Scalar product.
    #[inline]
    pub fn dot(self, b: Self) -> S {
        self[0] * b[0] + self[1] * b[1] + self[2] * b[2]
    }

    /// Vector product.
    #[inline]
    pub fn cross(self, b: Self) -> Self {
        Vec3([
            self[1] * b[2] - self[2] * b[1],
            self[2] * b[0] - self[0] * b[2],
            self[0] * b[1] - self[1] * b[0],
        ])
    }

    /// Component by component product, as of a diagonal matrix.
    #[inline]
    pub fn times(self, b: Self) -> Self {
        Vec3([self[0] * b[0], self[1] * b[1], self[2] * b[2]])
    }

    /// Squared length.
    #[inline]
    pub fn norm_squared(self) -> S {
        self.dot(self)
    }

    /// Length.
    #[inline]
    pub fn norm(self) -> S {
        self.norm_squared().sqrt()
    }

    /// The largest |component| as `f64`; NaN if one is NaN.
    #[inline]
    pub fn magnitude(self) -> f64 {
        let Vec3([a, b, c]) = self.map(S::magnitude);
        // f64::max would drop a NaN
        if a.is_nan() || b.is_nan() || c.is_nan() { f64::NAN } else { a.max(b).max(c) }
    }
}

impl<S: Precise> Vec3<S> {
    /// The axes of the smallest, middle and largest component; equal ones, and those that are NaN, in their own order.
    pub(crate) fn ascending(self) -> [usize; 3] {
        let mut order = [0, 1, 2];
        order.sort_by(|&j, &k| self[j].partial_cmp(&self[k]).unwrap_or(Ordering::Equal));
        order
    }
}

impl Vec3<Dd> {
    /// Length, also where its square leaves the range of a double: a power of two is taken out, which changes no bit.
    pub(crate) fn norm_of_any_size(self) -> Dd {
        let largest = self.magnitude();
        if largest == 0.0 {
            return Dd::ZERO;
        }
        let n = libm::ilogb(largest);
        Vec3(self.0.map(|x| x.scaled(-n))).norm().scaled(n)
    }
}

impl<S> Index<usize> for Vec3<S> {
    type Output = S;
    #[inline]
    fn index(&self, axis: usize) -> &S {
        &self.0[axis]
    }
}
impl<S> IndexMut<usize> for Vec3<S> {
    #[inline]
    fn index_mut(&mut self, axis: usize) -> &mut S {
        &mut self.0[axis]
    }
}
impl<S: Real> Add for Vec3<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Vec3([self[0] + b[0], self[1] + b[1], self[2] + b[2]])
    }
}
impl<S: Real> Sub for Vec3<S> {
    type Output = Self;
    #[inline]
    fn sub(self, b: Self) -> Self {
        Vec3([self[0] - b[0], self[1] - b[1], self[2] - b[2]])
    }
}
impl<S: Real> Neg for Vec3<S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Vec3([-self[0], -self[1], -self[2]])
    }
}
impl<S: Real> Mul<S> for Vec3<S> {
    type Output = Self;
    #[inline]
    fn mul(self, k: S) -> Self {
        Vec3([self[0] * k, self[1] * k, self[2] * k])
    }
}

impl From<Vector3<f64>> for Vec3<f64> {
    fn from(v: Vector3<f64>) -> Self {
        Vec3([v.x, v.y, v.z])
    }
}
impl From<Vec3<f64>> for Vector3<f64> {
    fn from(v: Vec3<f64>) -> Self {
        Vector3::new(v[0], v[1], v[2])
    }
}
