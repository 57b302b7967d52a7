//! The methods on the group as data. Exponentials multiply from the right, as turns of the body about its own axes do.

use crate::num::{Dd, Real};

/// The most stages that there are.
pub(super) const MOST_STAGES: usize = 4;

/// A ratio of two integers.
type Ratio = (f64, f64);

/// One exponential of a product: the weights of the turns k_1, k_2, …, and a share of the bracket k_a × k_b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exponential {
    weights: &'static [Ratio],
    bracket: Option<(usize, usize, Ratio)>,
}

const fn of(weights: &'static [Ratio]) -> Exponential {
    Exponential { weights, bracket: None }
}

const fn with_bracket(weights: &'static [Ratio], a: usize, b: usize, share: Ratio) -> Exponential {
    Exponential { weights, bracket: Some((a, b, share)) }
}

fn value((numerator, denominator): Ratio) -> Dd {
    Dd::of(numerator) / denominator
}

impl Exponential {
    pub(super) fn weights(&self) -> [Dd; MOST_STAGES] {
        core::array::from_fn(|j| self.weights.get(j).map_or(Dd::ZERO, |ratio| value(*ratio)))
    }

    pub(super) fn bracket(&self) -> Option<(usize, usize, Dd)> {
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
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct LieGroup {
    pub(super) name: &'static str,
    pub(super) order: u32,
    pub(super) source: &'static str,
    pub(super) stages: &'static [&'static [Exponential]],
    pub(super) last: &'static [Exponential],
}

impl LieGroup {
    /// The classical Runge–Kutta method in the algebra, with the brackets that its order needs.
    pub const RKMK_4: LieGroup = LieGroup {
        name: "rkmk4",
        order: 4,
        source: "Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115",
        stages: &[
            &[],
            &[of(&[(1.0, 2.0)])],
            &[with_bracket(&[(0.0, 1.0), (1.0, 2.0)], 0, 1, (1.0, 8.0))],
            &[of(&[(0.0, 1.0), (0.0, 1.0), (1.0, 1.0)])],
        ],
        last: &[with_bracket(&[(1.0, 6.0), (1.0, 3.0), (1.0, 3.0), (1.0, 6.0)], 0, 3, (1.0, 12.0))],
    };

    /// Two exponentials in place of the brackets.
    pub const COMMUTATOR_FREE_4: LieGroup = LieGroup {
        name: "commutator-free-4",
        order: 4,
        source: "Celledoni, Marthinsen and Owren, Future Gener. Comput. Syst. 19 (2003) 341",
        stages: &[
            &[],
            &[of(&[(1.0, 2.0)])],
            &[of(&[(0.0, 1.0), (1.0, 2.0)])],
            &[of(&[(1.0, 2.0)]), of(&[(-1.0, 2.0), (0.0, 1.0), (1.0, 1.0)])],
        ],
        last: &[
            of(&[(1.0, 4.0), (1.0, 6.0), (1.0, 6.0), (-1.0, 12.0)]),
            of(&[(-1.0, 12.0), (1.0, 6.0), (1.0, 6.0), (1.0, 4.0)]),
        ],
    };

    /// One exponential for each stage.
    pub const CROUCH_GROSSMAN_3: LieGroup = LieGroup {
        name: "crouch-grossman-3",
        order: 3,
        source: "Crouch and Grossman, J. Nonlinear Sci. 3 (1993) 1; Hairer, Lubich and Wanner, Geometric Numerical Integration, IV.8.1",
        stages: &[&[], &[of(&[(3.0, 4.0)])], &[of(&[(119.0, 216.0)]), of(&[(0.0, 1.0), (17.0, 108.0)])]],
        last: &[
            of(&[(13.0, 51.0)]),
            of(&[(0.0, 1.0), (-2.0, 3.0)]),
            of(&[(0.0, 1.0), (0.0, 1.0), (24.0, 17.0)]),
        ],
    };
}
