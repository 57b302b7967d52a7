//! The variational Lie–Poisson splitting: three turns about the principal axes.

use super::{AxisOrder, Cost, Energy, FreePart, Map, Method, Symmetric};
use crate::body::{Field, Point, Rotor, Time};
use crate::flow::{turn_a_little_about, turn_about, turn_about_axis};
use crate::num::trig::SMALL;
use crate::num::{Dd, Precise, Real};

/// Strang splitting of the kinetic energy by axes.
///
/// Φ_h = R_a(h/2) R_b(h/2) R_c(h) R_b(h/2) R_a(h/2), R_i the exact turn of `m_i²/(2 I_i)`.
/// A product of exact flows: keeps |m|, L and the Lie–Poisson bracket, and the energy within O(h²) for
/// exponentially long times. The order of the axes changes the size of that oscillation up to a hundredfold.
///
/// ```
/// use polhode::method::{AxisSplit, Claimed, Kicks, LiePoisson};
/// let outermost_z = AxisSplit { axes: Some("321".parse()?) };
/// assert_eq!(LiePoisson::strang(outermost_z, Kicks).name(), "lie-poisson:321");
/// # Ok::<(), polhode::method::AxisOrderError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisSplit {
    /// Outermost axis first; `None` takes that with the smallest leading error of the attitude on the
    /// [orbit](AxisOrder::best_for_orbit) of the start, and under forces and in compositions the [best](AxisOrder::best) for the
    /// energy.
    pub axes: Option<AxisOrder>,
}

impl Symmetric for AxisSplit {}

impl FreePart for AxisSplit {
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
    fn cost_in_sequence(&self) -> Cost {
        Cost::turns(4)
    }
    fn source(&self) -> &'static str {
        "McLachlan, Phys. Rev. Lett. 71 (1993) 3043; Touma and Wisdom, Astron. J. 107 (1994) 1189"
    }
}

impl<S: Precise> Method<S> for AxisSplit {
    type Map<F: Field<S>> = AxisSplitMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> AxisSplitMap<S> {
        let mut map = AxisSplitMap {
            rotor: *rotor,
            h,
            free_to_choose: false,
            axes: [0, 1, 2],
            half_rates: [S::of(0.0); 3],
            small: false,
        };
        map.choose(self.axes.unwrap_or_else(|| AxisOrder::best(rotor.moments())));
        map.free_to_choose = self.axes.is_none();
        map
    }
}

/// A prepared [`AxisSplit`].
#[derive(Clone, Copy, Debug)]
pub struct AxisSplitMap<S> {
    rotor: Rotor,
    h: Dd,
    free_to_choose: bool,
    axes: [usize; 3],
    half_rates: [S; 3], // time of the turn over 2 I
    /// Whether half of each angle of an opened motion is at most [`SMALL`].
    small: bool,
}

impl<S: Precise> Map<S> for AxisSplitMap<S> {
    #[inline]
    fn apply(&mut self, _: Time, x: &mut Point<S>) {
        let [outer, middle, inner] = self.half_rates;
        self.turns::<5, false>(x, [(0, outer), (1, middle), (2, inner), (1, middle), (0, outer)]);
    }

    fn open(&mut self, _: Time, x: &mut Point<S>) {
        if self.free_to_choose {
            let m = x.momentum_body.map(S::to_f64);
            self.choose(AxisOrder::best_for_orbit(m, self.rotor.moments()));
        }
        let largest = self.half_rates.map(S::magnitude).into_iter().fold(0.0, f64::max);
        // twice the half rate of the outer axis, and |m| walks by rounding
        self.small = 2.01 * largest * x.momentum_body.norm().magnitude() <= SMALL;
        turn_about_axis(self.axes[0], x, self.half_rates[0]);
    }

    #[inline]
    fn advance(&mut self, _: Time, x: &mut Point<S>) {
        let [outer, middle, inner] = self.half_rates;
        let turns = [(1, middle), (2, inner), (1, middle), (0, outer + outer)];
        if self.small { self.turns::<4, true>(x, turns) } else { self.turns::<4, false>(x, turns) }
    }

    #[inline]
    fn close(&mut self, _: Time, x: &mut Point<S>) {
        turn_about_axis(self.axes[0], x, -self.half_rates[0]);
    }
}

impl<S: Precise> AxisSplitMap<S> {
    fn choose(&mut self, order: AxisOrder) {
        let inverse = self.rotor.inverse_moments::<Dd>();
        let rate = |axis: usize, time: Dd| S::from_dd(inverse[axis] * (time * 0.5));
        let axes = order.axes();
        let [outer, middle, inner] = axes;
        self.axes = axes;
        self.half_rates = [rate(outer, self.h * 0.5), rate(middle, self.h * 0.5), rate(inner, self.h)];
    }

    /// Turns about outer (0), middle (1) and inner axis (2).
    #[inline]
    fn turns<const N: usize, const SMALL: bool>(&self, x: &mut Point<S>, turns: [(usize, S); N]) {
        match self.axes {
            [0, 1, _] => turns_about::<0, 1, 2, N, SMALL, S>(x, turns),
            [0, ..] => turns_about::<0, 2, 1, N, SMALL, S>(x, turns),
            [1, 0, _] => turns_about::<1, 0, 2, N, SMALL, S>(x, turns),
            [1, ..] => turns_about::<1, 2, 0, N, SMALL, S>(x, turns),
            [_, 0, _] => turns_about::<2, 0, 1, N, SMALL, S>(x, turns),
            _ => turns_about::<2, 1, 0, N, SMALL, S>(x, turns),
        }
        x.renormalize_at_times();
    }
}

#[inline(always)]
fn turns_about<
    const OUTER: usize,
    const MIDDLE: usize,
    const INNER: usize,
    const N: usize,
    const SMALL: bool,
    S: Real,
>(
    x: &mut Point<S>,
    turns: [(usize, S); N],
) {
    for (which, half_rate) in turns {
        match which {
            0 => turn_one::<OUTER, SMALL, S>(x, half_rate),
            1 => turn_one::<MIDDLE, SMALL, S>(x, half_rate),
            _ => turn_one::<INNER, SMALL, S>(x, half_rate),
        }
    }
}

#[inline(always)]
pub(super) fn turn_one<const AXIS: usize, const SMALL: bool, S: Real>(x: &mut Point<S>, half_rate: S) {
    if SMALL { turn_a_little_about::<AXIS, S>(x, half_rate) } else { turn_about::<AXIS, S>(x, half_rate) }
}
