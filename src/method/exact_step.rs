//! `exact-step`: the exact motion of the free body in equal steps, by products, divisions and square roots.

use super::{Claimed, Claims, Cost, Energy, Kept, Map, Method};
use crate::body::{Field, Phase, Point, Problem, Rotor, Time};
use crate::flow::{Addition, Curve, FreeOrbit};
use crate::num::{Dd, Precise, Real};

/// Steps from one evaluation of the closed form to the next, a power of two. Meanwhile the constants, rounded to doubles,
/// turn the body wrongly by some 1e-16 rad a step.
const RENEW_EVERY: u64 = 64;

/// The exact motion of the free body in steps of one size, for attitude and momentum at every step.
///
/// Φ_h: the momentum by the addition theorem of Jacobi's functions, `m(u) → m(u + νh)`, a rational map whose constants are
/// those of the orbit of the start; the attitude by `q ∘ p` with `p_w p_i = (s/I_i + d)(m_i + m_i')`, the relation of the
/// discrete Moser–Veselov map, whose s and d are constants of that orbit too. No iteration, no sine: three divisions and
/// two square roots a step. The energy and |m| are restored at each step.
///
/// In every 64th step counted from the start, and in each one that turns the body by more than 1.25 rad, the point is that of
/// the closed form ([`FreeMotion`](crate::flow::FreeMotion)), in `f64` good to 2e-15 at any time; so too in each step of a turn
/// about a fixed axis and where k'² < 1e-4, next to the separatrix. So the error does not grow, with either number of steps or
/// time.
///
/// Reference: DLMF 22.8 for the addition theorem; Moser and Veselov, Commun. Math. Phys. 139 (1991) 217, and Hairer and
/// Vilmart, J. Phys. A 39 (2006) 13225, for the map that is exact with other constants. We found no earlier use of the two
/// together.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::method::ExactStep;
/// use polhode::{Body, FreeMotion, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&ExactStep, &body, &start, 0.25)?.advance_to(100_000)?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(25_000.0)?;
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-13);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExactStep;

impl Claimed for ExactStep {
    fn name(&self) -> String {
        "exact-step".into()
    }
    fn claims(&self, problem: Problem) -> Option<Claims> {
        let kept = Kept::all_of_free_motion(Energy::Exact);
        let source = "addition theorem, DLMF 22.8; Moser and Veselov, Commun. Math. Phys. 139 (1991) 217";
        let claims = Claims::new(None, kept, Cost::additions(1), source);
        (problem == Problem::Free).then_some(Claims {
            symmetric: true,
            poisson: true,
            symplectic: true,
            ..claims
        })
    }
}

impl<S: Precise> Method<S> for ExactStep {
    type Map<F: Field<S>> = ExactStepMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> ExactStepMap<S> {
        ExactStepMap { rotor: *rotor, h, opened: None }
    }
}

/// A prepared [`ExactStep`].
#[derive(Clone, Debug)]
pub struct ExactStepMap<S> {
    rotor: Rotor,
    h: Dd,
    opened: Option<Opened<S>>,
}

/// The orbit of a start, and the map along it.
#[derive(Clone, Debug)]
struct Opened<S> {
    orbit: Box<FreeOrbit>,
    /// Steps that the start had taken.
    steps: u64,
    curve: Option<Curve<S>>,
    addition: Option<Addition<S>>,
}

impl<S: Precise> ExactStepMap<S> {
    /// The closed form `n` steps after the start.
    fn renew(h: Dd, opened: &Opened<S>, n: u64, x: &mut Point<S>) {
        let t = h * Dd::from(n);
        let precise = S::ROUNDOFF < f64::ROUNDOFF;
        let at = if precise { opened.orbit.at_dd(t) } else { opened.orbit.at(t).to_dd() };
        x.set_phase(Phase {
            attitude: at.attitude.map(S::from_dd),
            momentum_body: at.momentum_body.map(S::from_dd),
        });
        if let Some(curve) = &opened.curve {
            curve.restore(x);
        }
    }
}

impl<S: Precise> Map<S> for ExactStepMap<S> {
    /// One step of the orbit through `x`, whose constants are made for it: [`open`](Map::open) makes them once for many.
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.open(at, x);
        self.advance(at, x);
    }

    fn open(&mut self, _: Time, x: &mut Point<S>) {
        let orbit = Box::new(FreeOrbit::new(self.rotor.moments(), x.to_dd()));
        let (curve, addition) = (orbit.curve(), orbit.addition(self.h));
        self.opened = Some(Opened { orbit, steps: x.steps(), curve, addition });
    }

    #[inline]
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        let Some(opened) = &self.opened else { return self.apply(at, x) };
        // a point before the one that was opened begins anew
        let Some(taken) = x.steps().checked_sub(opened.steps) else { return self.apply(at, x) };
        let n = taken + 1;
        match &opened.addition {
            Some(addition) if !n.is_multiple_of(RENEW_EVERY) => addition.advance(x),
            _ => Self::renew(self.h, opened, n, x),
        }
    }
}
