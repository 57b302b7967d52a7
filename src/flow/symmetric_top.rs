//! The free symmetric top: two turns.

use super::{Casimir, Flow, turn};
use crate::body::{Body, Carry, State, of_dd};
use crate::num::{Dd, Real};

/// The exact flow of the free symmetric body, `T = |m|²/(2A) + ½ (1/C − 1/A) m_k²`.
///
/// Φ_t: a turn about the symmetry axis k at the rate `(1/C − 1/A) m_k`, which moves m on its cone in the body, then
/// one about m at the rate |m|/A, the precession in space. The two commute.
#[derive(Clone, Copy, Debug)]
pub struct SymmetricTop<S> {
    axis: usize,
    half_rate: S,
    precession: Casimir<S>,
}

impl<S: Real> SymmetricTop<S> {
    /// The flow of `body` without its torque; `None` unless two of its principal moments are equal, exactly.
    ///
    /// ```
    /// use polhode::body::{Body, Inertia};
    /// use polhode::flow::SymmetricTop;
    /// let plate = Body::free(Inertia::from_moments([1.0, 1.0, 2.0])?);
    /// assert!(SymmetricTop::<f64>::new(&plate).is_some());
    /// # Ok::<(), polhode::body::InertiaError>(())
    /// ```
    pub fn new(body: &Body) -> Option<Self> {
        let moments = body.moments::<Dd>();
        let axis = (0..3).find(|axis| moments[(axis + 1) % 3] == moments[(axis + 2) % 3])?;
        let (along, across) = (Dd::ONE / moments[axis], Dd::ONE / moments[(axis + 1) % 3]);
        let half_rate = of_dd((along - across) * 0.5);
        Some(SymmetricTop { axis, half_rate, precession: Casimir::new(of_dd(across)) })
    }

    /// The flow, rounding errors carried.
    #[inline]
    pub fn carried(&self, t: S, x: &mut State<S>, carry: &mut Carry<S>) {
        let half_rate_time = t * self.half_rate;
        match self.axis {
            0 => turn::<0, S>(x, carry, half_rate_time),
            1 => turn::<1, S>(x, carry, half_rate_time),
            _ => turn::<2, S>(x, carry, half_rate_time),
        }
        self.precession.carried(t, x, carry);
    }
}

impl<S: Real> Flow<S> for SymmetricTop<S> {
    fn flow(&self, t: S, x: &mut State<S>) {
        let mut carry = Carry::default();
        self.carried(t, x, &mut carry);
        carry.renormalize(x);
    }
}
