//! The free symmetric top: two turns.

use crate::body::{Point, Rotor, Time};
use crate::flow::{AxisTurn, Casimir, Flow};
use crate::num::{Dd, Real};

/// The exact flow of the free symmetric body, `T = |m|²/(2A) + ½ (1/C − 1/A) m_k²`.
///
/// Φ_t: a turn about the symmetry axis k at the rate `(1/C − 1/A) m_k`, which moves m on its cone in the body, then
/// one about m at the rate |m|/A, the precession in space. The two commute.
#[derive(Clone, Copy, Debug)]
pub struct SymmetricTop<S> {
    spin: AxisTurn<S>,
    precession: Casimir<S>,
}

impl<S: Real> SymmetricTop<S> {
    /// The free flow of a body with the constants `rotor`; `None` unless two of its principal moments are equal, exactly.
    ///
    /// ```
    /// use polhode::body::Body;
    /// use polhode::inertia::Inertia;
    /// use polhode::flow::SymmetricTop;
    /// let plate = Body::free(Inertia::from_moments([1.0, 1.0, 2.0])?);
    /// assert!(SymmetricTop::<f64>::new(&plate.rotor()).is_some());
    /// # Ok::<(), polhode::inertia::InertiaError>(())
    /// ```
    #[must_use]
    pub fn new(rotor: &Rotor) -> Option<Self> {
        let moments = rotor.moments::<Dd>();
        let axis = (0..3).find(|axis| moments[(axis + 1) % 3] == moments[(axis + 2) % 3])?;
        let (along, across) = (Dd::ONE / moments[axis], Dd::ONE / moments[(axis + 1) % 3]);
        let spin = AxisTurn::new(axis, S::from_dd((along - across) * 0.5));
        Some(SymmetricTop { spin, precession: Casimir::new(S::from_dd(across)) })
    }
}

impl<S: Real> Flow<S> for SymmetricTop<S> {
    #[inline]
    fn flow(&self, at: Time, t: S, x: &mut Point<S>) {
        self.spin.flow(at, t, x);
        self.precession.flow(at, t, x);
    }
}
