//! The variational Lie–Poisson splitting: three turns about the principal axes.

use super::{AxisOrder, Cost, Drift, Energy, Map, Method, Symmetric};
use crate::body::{Field, Point, Rotor, Time};
use crate::flow::turn;
use crate::num::{Dd, Real};

/// Strang splitting of the kinetic energy by axes.
///
/// Φ_h = R_a(h/2) R_b(h/2) R_c(h) R_b(h/2) R_a(h/2), R_i the exact [turn](crate::flow::AxisTurn) of `m_i²/(2 I_i)`.
/// A product of exact flows: keeps |m|, L and the Lie–Poisson bracket, and the energy within O(h²) for
/// exponentially long times. The order of the axes changes the size of that oscillation up to a hundredfold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisSplit {
    /// Outermost axis first; `None` takes the [best](AxisOrder::best) for the body.
    pub axes: Option<AxisOrder>,
}

impl Symmetric for AxisSplit {}

impl Drift for AxisSplit {
    fn name(&self) -> String {
        match self.axes {
            Some(order) => format!("lie-poisson:{order}"),
            None => "lie-poisson".into(),
        }
    }
    fn order(&self) -> Option<u32> {
        Some(2)
    }
    fn energy(&self) -> Energy {
        Energy::Bounded
    }
    fn cost(&self) -> Cost {
        Cost::turns(5)
    }
    fn source(&self) -> &'static str {
        "McLachlan, Phys. Rev. Lett. 71 (1993) 3043; Touma and Wisdom, Astron. J. 107 (1994) 1189"
    }
}

impl<S: Real> Method<S> for AxisSplit {
    type Map<F: Field<S>> = AxisSplitMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> AxisSplitMap<S> {
        let axes = self.axes.unwrap_or_else(|| AxisOrder::best(rotor.moments())).axes();
        let inverse = rotor.inverse_moments::<Dd>();
        let rate = |axis: usize, time: Dd| S::from_dd(inverse[axis] * (time * 0.5));
        let [outer, middle, inner] = axes;
        let half_rates = [rate(outer, h * 0.5), rate(middle, h * 0.5), rate(inner, h)];
        AxisSplitMap { axes, half_rates }
    }
}

/// A prepared [`AxisSplit`].
#[derive(Clone, Copy, Debug)]
pub struct AxisSplitMap<S> {
    axes: [usize; 3],
    half_rates: [S; 3], // time of the turn over 2 I
}

impl<S: Real> Map<S> for AxisSplitMap<S> {
    #[inline]
    fn apply(&mut self, _: Time, x: &mut Point<S>) {
        match self.axes {
            [0, 1, _] => self.turns::<0, 1, 2>(x),
            [0, ..] => self.turns::<0, 2, 1>(x),
            [1, 0, _] => self.turns::<1, 0, 2>(x),
            [1, ..] => self.turns::<1, 2, 0>(x),
            [_, 0, _] => self.turns::<2, 0, 1>(x),
            _ => self.turns::<2, 1, 0>(x),
        }
        x.renormalize_at_times();
    }
}

impl<S: Real> AxisSplitMap<S> {
    #[inline]
    fn turns<const OUTER: usize, const MIDDLE: usize, const INNER: usize>(&self, x: &mut Point<S>) {
        let [outer, middle, inner] = self.half_rates;
        turn::<OUTER, S>(x, outer);
        turn::<MIDDLE, S>(x, middle);
        turn::<INNER, S>(x, inner);
        turn::<MIDDLE, S>(x, middle);
        turn::<OUTER, S>(x, outer);
    }
}
