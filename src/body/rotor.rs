//! The constants of a body that every kernel reads.

use crate::inertia::{Inertia, InertiaError};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// Moments of a rotor lie within this factor of 1.
const FAR: f64 = (1_u64 << 40) as f64;

/// Principal moments in the solver frame, in double-double; what a kernel needs of them is worked out from here, each
/// constant rounded once.
///
/// The solver frame has the principal axes of the body, in the order of the moments here. Its moments, momenta and energies are those in
/// kg m² and so on divided by a power of two, [`Body::scale`](super::Body::scale): that of [`Body::rotor`](super::Body::rotor)
/// brings the largest moment to between 1 and 2, that of [`new`](Self::new) is 1. A [`Point`](super::Point) that a flow moves
/// has to be in the same units, as [`Body::enter`](super::Body::enter) makes it for the rotor of the same body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Rotor {
    moments: Vec3<Dd>,
}

impl Rotor {
    pub(crate) fn of_moments(moments: Vec3<Dd>) -> Self {
        Rotor { moments }
    }

    /// A body with these principal moments, taken as they are: the momenta of its points are then I ω, of any unit, along the
    /// principal axes.
    ///
    /// # Errors
    /// Moments that are no body's, as [`Inertia::from_moments`] says it, and a largest moment that is not within 2⁴⁰ of 1: powers of
    /// such moments leave the range of a double. A [`Body`](super::Body) takes moments of any size.
    ///
    /// ```
    /// use polhode::body::{Point, Rotor, Time};
    /// use polhode::flow::{Flow, FreeFlow};
    /// use polhode::rotation::{Quat, Vec3};
    /// let rotor = Rotor::new([1.0, 2.0, 3.0])?;
    /// let mut x = Point::new(Quat::identity(), Vec3([0.4, 2.0, -0.9]));
    /// FreeFlow::new(&rotor).flow(Time::from_seconds(0.0), 0.1, &mut x);
    /// assert!((x.momentum_space() - Vec3([0.4, 2.0, -0.9])).magnitude() < 1e-15);
    /// assert!(Rotor::new([1.0, 2.0, 4.0]).is_err());
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn new(moments: [f64; 3]) -> Result<Self, InertiaError> {
        let scale = Inertia::from_moments(moments)?.scale();
        if (1.0 / FAR..=FAR).contains(&scale) {
            Ok(Rotor { moments: Vec3(moments.map(Dd::of)) })
        } else {
            Err(InertiaError::FarFromOne { moments })
        }
    }

    /// Principal moments.
    pub fn moments<S: Real>(&self) -> Vec3<S> {
        self.moments.map(S::from_dd)
    }

    /// Reciprocals of the [moments](Self::moments), each rounded once.
    pub fn inverse_moments<S: Real>(&self) -> Vec3<S> {
        self.moments.map(|i| S::from_dd(Dd::ONE / i))
    }

    /// Kinetic energy ½ m·I⁻¹m, divided by the scale.
    pub(crate) fn kinetic_energy(&self, m: Vec3<Dd>) -> Dd {
        kinetic_energy(self.inverse_moments(), m)
    }

    /// The axis of the middle moment.
    pub(crate) fn middle_axis(&self) -> usize {
        self.moments.ascending()[1]
    }
}

/// ½ m·I⁻¹m.
#[inline]
pub(crate) fn kinetic_energy<S: Real>(inverse_moments: Vec3<S>, m: Vec3<S>) -> S {
    m.times(inverse_moments).dot(m) * S::of(0.5)
}

/// `factor · u × I⁻¹u` with principal moments: `D_i u_j u_k`, (i, j, k) cyclic, `D_i = factor (1/I_k − 1/I_j)`.
///
/// One product with one rounded constant, so that a method which uses it at every place keeps its symmetry whatever the
/// constant's rounding. As a difference of two products the rounding is biased, and the energy follows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gyroscopic<S>(Vec3<S>);

impl<S: Real> Gyroscopic<S> {
    pub(crate) fn new(rotor: &Rotor, factor: Dd) -> Self {
        let i = rotor.moments;
        // not as a difference of reciprocals: near a symmetric body it has fewer digits than the moments
        Gyroscopic(Vec3(
            [(1, 2), (2, 0), (0, 1)].map(|(j, k)| S::from_dd(factor * (i[j] - i[k]) / (i[j] * i[k]))),
        ))
    }

    /// With `scale` times the factor.
    #[inline(always)]
    pub(crate) fn scaled(&self, scale: S) -> Self {
        Gyroscopic(self.0 * scale)
    }

    /// With the factors D.
    #[inline(always)]
    pub(crate) fn of_factors(factors: Vec3<S>) -> Self {
        Gyroscopic(factors)
    }

    /// D.
    pub(crate) fn factors(&self) -> Vec3<S> {
        self.0
    }

    /// The term at `u`.
    #[inline(always)]
    pub(crate) fn at(&self, u: Vec3<S>) -> Vec3<S> {
        self.of(u, u)
    }

    /// `D_i u_j v_k`; with `D_i v_j u_k` added it is `factor (u × I⁻¹v + v × I⁻¹u)`.
    #[inline(always)]
    pub(crate) fn of(&self, u: Vec3<S>, v: Vec3<S>) -> Vec3<S> {
        Vec3([self.component(0, u[1], v[2]), self.component(1, u[2], v[0]), self.component(2, u[0], v[1])])
    }

    /// The same of the three products `u_j v_k`, or of sums of such.
    #[inline(always)]
    pub(crate) fn times(&self, products: Vec3<S>) -> Vec3<S> {
        self.0.times(products)
    }

    /// Its component i, of u_j and u_k.
    #[inline(always)]
    pub(crate) fn component(&self, i: usize, u_j: S, u_k: S) -> S {
        self.0[i] * u_j * u_k
    }
}
