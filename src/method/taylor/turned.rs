//! A vector in the form in which cross products are summed.

use core::array::from_fn;

use crate::num::Real;
use crate::rotation::Vec3;

/// A vector by its next components and those after them: `a × b` is `a.next · b.after − a.after · b.next`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turned<S> {
    pub(super) next: [S; 4],
    pub(super) after: [S; 4],
}

impl<S: Real> Turned<S> {
    #[inline]
    pub(super) fn new(Vec3([x, y, z]): Vec3<S>) -> Self {
        let zero = S::of(0.0);
        Turned { next: [y, z, x, zero], after: [z, x, y, zero] }
    }

    #[inline]
    pub(super) fn components(&self) -> [S; 3] {
        let [y, z, x, _] = self.next;
        [x, y, z]
    }

    /// `sum + a × b`, lane by lane.
    #[inline]
    pub(super) fn add_cross(&self, b: &Turned<S>, sum: [S; 4]) -> [S; 4] {
        from_fn(|lane| sum[lane] + (self.next[lane] * b.after[lane] - self.after[lane] * b.next[lane]))
    }

    pub(super) fn is_finite(&self) -> bool {
        self.next.iter().all(|c| c.magnitude().is_finite())
    }
}
