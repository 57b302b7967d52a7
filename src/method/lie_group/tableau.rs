//! The methods on the group as data. Exponentials multiply from the right, as turns of the body about its own axes do.

use crate::num::{Dd, Real};

/// The most stages that there are.
pub(in crate::method) const MOST_STAGES: usize = 4;

/// A ratio of two integers.
type Ratio = (f64, f64);

/// One exponential of a product: the weights of the turns k_1, k_2, …, and a share of the bracket k_a × k_b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::method) struct Exponential {
    weights: &'static [Ratio],
    bracket: Option<(usize, usize, Ratio)>,
}

pub(in crate::method) const fn of(weights: &'static [Ratio]) -> Exponential {
    Exponential { weights, bracket: None }
}

pub(in crate::method) const fn with_bracket(
    weights: &'static [Ratio],
    a: usize,
    b: usize,
    share: Ratio,
) -> Exponential {
    Exponential { weights, bracket: Some((a, b, share)) }
}

fn value((numerator, denominator): Ratio) -> Dd {
    Dd::of(numerator) / denominator
}

impl Exponential {
    pub(in crate::method) fn weights(&self) -> [Dd; MOST_STAGES] {
        core::array::from_fn(|j| self.weights.get(j).map_or(Dd::ZERO, |ratio| value(*ratio)))
    }

    pub(in crate::method) fn bracket(&self) -> Option<(usize, usize, Dd)> {
        self.bracket.map(|(a, b, share)| (a, b, value(share)))
    }
}

/// An explicit Runge–Kutta method on rotations and momenta in space.
///
/// Φ_h: with the turns `k_i = h I⁻¹ Q_iᵀ L_i` of the stages `Q_i = Q Π exp(…)`, each exponential of a sum of turns before, the
/// step is such a product too, and L' = τ in space is taken by the same weights. Without torque L is a constant, so that it is
/// exact for every such method, and |m| and |q| with it; under a potential that the vertical leaves alone L_z is. The energy
/// drifts.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Conserved;
/// use polhode::method::LieGroup;
/// use polhode::{Body, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// for method in [LieGroup::RKMK_4, LieGroup::COMMUTATOR_FREE_4, LieGroup::CROUCH_GROSSMAN_3] {
///     let end = Run::new(&method, &body, &start, 0.1)?.advance_to(1000)?;
///     assert!(end.worst.of(Conserved::Momentum).is_some_and(|error| error < 1e-13));
///     assert!(end.worst.of(Conserved::Energy).is_some_and(|error| error > 1e-9));
/// }
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct LieGroup {
    pub(in crate::method) name: &'static str,
    pub(in crate::method) order: u32,
    pub(in crate::method) source: &'static str,
    pub(in crate::method) stages: &'static [&'static [Exponential]],
    pub(in crate::method) last: &'static [Exponential],
}
