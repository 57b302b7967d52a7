//! The variational Lie–Poisson splitting: three turns about the principal axes.

use super::{AxisOrder, Claimed, Claims, Cost, Energy, Kept, KeptHeavy, Method, Step, StepError, usable};
use crate::body::{Body, Carry, State, of_dd};
use crate::flow::{Kick, turn};
use crate::num::{Dd, Real};

/// Strang splitting of the kinetic energy by axes.
///
/// Φ_h = R_a(h/2) R_b(h/2) R_c(h) R_b(h/2) R_a(h/2), R_i the exact [turn](crate::flow::AxisTurn) of `m_i²/(2 I_i)`.
/// A product of exact flows: keeps |m|, L and the Lie–Poisson bracket, and the energy within O(h²) for
/// exponentially long times. Under gravity half a [kick](Kick) goes before and after. The order of the axes changes the size of that oscillation up to a hundredfold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LiePoisson {
    /// Outermost axis first; `None` takes the [best](AxisOrder::best) for the body.
    pub axes: Option<AxisOrder>,
}

/// A prepared step of [`LiePoisson`].
#[derive(Clone, Copy, Debug)]
pub struct LiePoissonStep<S> {
    axes: [usize; 3],
    half_rates: [S; 3], // time of the turn over 2 I
    half: S,
    kick: Kick<S>,
    carry: Carry<S>,
}

impl Claimed for LiePoisson {
    fn name(&self) -> String {
        match self.axes {
            Some(order) => format!("lie-poisson:{order}"),
            None => "lie-poisson".into(),
        }
    }
    fn claims(&self) -> Claims {
        Claims {
            order: 2,
            symmetric: true,
            poisson: true,
            free: Kept { energy: Energy::Bounded, momentum: true, momentum_space: true, norm: true },
            exact_when_free: false,
            potential: Some(KeptHeavy { energy: Energy::Bounded, momentum_z: true, norm: true }),
            cost: Cost::Turns(5),
            source: "McLachlan, Phys. Rev. Lett. 71 (1993) 3043; Touma and Wisdom, Astron. J. 107 (1994) 1189",
        }
    }
}

impl<S: Real> Method<S> for LiePoisson {
    type Step = LiePoissonStep<S>;
    fn prepare(&self, h: f64, body: &Body, _: &State<S>) -> Result<LiePoissonStep<S>, StepError> {
        let h = usable(h)?;
        let axes = self.axes.unwrap_or_else(|| AxisOrder::best(body.moments())).axes();
        let inverse = body.inverse_moments::<Dd>();
        let rate = |axis: usize, time: f64| of_dd(inverse[axis] * (0.5 * time));
        let [outer, middle, inner] = axes;
        let half_rates = [rate(outer, 0.5 * h), rate(middle, 0.5 * h), rate(inner, h)];
        let (half, kick) = (S::of(0.5 * h), Kick::new(body));
        Ok(LiePoissonStep { axes, half_rates, half, kick, carry: Carry::default() })
    }
}

impl<S: Real> Step<S> for LiePoissonStep<S> {
    #[inline]
    fn step(&mut self, x: &mut State<S>) {
        self.kick.carried(self.half, x, &mut self.carry);
        match self.axes {
            [0, 1, _] => self.turns::<0, 1, 2>(x),
            [0, ..] => self.turns::<0, 2, 1>(x),
            [1, 0, _] => self.turns::<1, 0, 2>(x),
            [1, ..] => self.turns::<1, 2, 0>(x),
            [_, 0, _] => self.turns::<2, 0, 1>(x),
            _ => self.turns::<2, 1, 0>(x),
        }
        self.kick.carried(self.half, x, &mut self.carry);
        self.carry.end_step(x);
    }
}

impl<S: Real> LiePoissonStep<S> {
    #[inline]
    fn turns<const OUTER: usize, const MIDDLE: usize, const INNER: usize>(&mut self, x: &mut State<S>) {
        let [outer, middle, inner] = self.half_rates;
        let carry = &mut self.carry;
        turn::<OUTER, S>(x, carry, outer);
        turn::<MIDDLE, S>(x, carry, middle);
        turn::<INNER, S>(x, carry, inner);
        turn::<MIDDLE, S>(x, carry, middle);
        turn::<OUTER, S>(x, carry, outer);
    }
}
