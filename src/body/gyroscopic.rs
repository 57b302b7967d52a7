//! The gyroscopic term of Euler's equation.

use super::{Body, of_dd};
use crate::num::{Dd, Real};
use crate::rotation::Vec3;

/// `factor · u × I⁻¹u` with principal moments: `D_i u_j u_k`, (i, j, k) cyclic, `D_i = factor (1/I_k − 1/I_j)`.
///
/// One product with one rounded constant, so that a method which uses it at every place keeps its symmetry whatever the
/// constant's rounding. As a difference of two products the rounding is biased, and the energy follows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gyroscopic<S>(Vec3<S>);

impl<S: Real> Gyroscopic<S> {
    pub(crate) fn new(body: &Body, factor: f64) -> Self {
        let (i, factor) = (body.moments::<Dd>(), Dd::of(factor));
        // not as a difference of reciprocals: near a symmetric body it has fewer digits than the moments
        Gyroscopic(Vec3([(1, 2), (2, 0), (0, 1)].map(|(j, k)| of_dd(factor * (i[j] - i[k]) / (i[j] * i[k])))))
    }

    /// The term at `u`.
    #[inline]
    pub(crate) fn at(&self, u: Vec3<S>) -> Vec3<S> {
        self.of(u, u)
    }

    /// `D_i u_j v_k`; with `D_i v_j u_k` added it is `factor (u × I⁻¹v + v × I⁻¹u)`.
    #[inline]
    pub(crate) fn of(&self, u: Vec3<S>, v: Vec3<S>) -> Vec3<S> {
        Vec3([self.component(0, u[1], v[2]), self.component(1, u[2], v[0]), self.component(2, u[0], v[1])])
    }

    /// Its component i, of u_j and u_k.
    #[inline]
    pub(crate) fn component(&self, i: usize, u_j: S, u_k: S) -> S {
        self.0[i] * u_j * u_k
    }
}
