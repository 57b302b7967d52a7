//! `rk8`: the weights of order 8 of DOP853 with steps as given.

use crate::body::{Field, Phase, Point, Problem, Rotor, Time};
use crate::method::dop853::{STAGES, WEIGHTS};
use crate::method::runge_kutta::{Equations, sum};
use crate::method::{Claimed, Claims, Cost, Kept, Map, Method};
use crate::num::{Dd, Real};

/// Stages, the first included.
const COUNT: usize = STAGES.len() + 1;

/// The explicit Runge–Kutta method of order 8 of Dormand and Prince, of a fixed step.
///
/// Φ_h: `x + h Σ b_n k_n`, twelve stages, the sum compensated. Keeps nothing, and errors grow ∝ h⁸ t; in small steps what
/// remains is rounding. In double-double the digits of the coefficients are enough for errors down to 5e-28 in a step.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::method::Rk8;
/// use polhode::{Body, FreeMotion, Inertia, Run};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let end = Run::new(&Rk8, &body, &start, 0.125)?.advance_to(80)?;
/// let exact = FreeMotion::from_state(body.inertia(), &start)?.at(10.0)?;
/// assert!(end.state.rotation().angle_to(&exact.rotation()) < 1e-10);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rk8;

/// A prepared [`Rk8`].
#[derive(Clone, Debug)]
pub struct Rk8Map<S, F> {
    h: S,
    /// When the stages are, s since the beginning of the step.
    later: [Dd; COUNT],
    equations: Equations<S, F>,
}

impl Claimed for Rk8 {
    fn name(&self) -> String {
        "rk8".into()
    }
    fn claims(&self, _: Problem) -> Option<Claims> {
        let source = "Hairer, Norsett and Wanner, Solving ODEs I (1993), table II.5.4, the weights of DOP853";
        Some(Claims::new(Some(8), Kept::NOTHING, Cost::right_sides(COUNT as u32), source))
    }
}

impl<S: Real> Method<S> for Rk8 {
    type Map<F: Field<S>> = Rk8Map<S, F>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Rk8Map<S, F> {
        let later = core::array::from_fn(|n| if n == 0 { Dd::ZERO } else { h * STAGES[n - 1].0 });
        Rk8Map { h: S::from_dd(h), later, equations: Equations::new(rotor, field) }
    }
}

impl<S: Real, F: Field<S>> Map<S> for Rk8Map<S, F> {
    #[inline]
    fn apply(&mut self, at: Time, point: &mut Point<S>) {
        let x = point.phase();
        let mut rates = [Phase::zero(); COUNT];
        rates[0] = self.equations.rate(at, &x);
        for n in 1..COUNT {
            let stage = x + sum(&rates, STAGES[n - 1].1) * self.h;
            rates[n] = self.equations.rate(at.later(self.later[n]), &stage);
        }
        let change = sum(&rates, WEIGHTS) * self.h;
        point.add_momentum(change.momentum_body);
        point.add_attitude(change.attitude);
    }
}
