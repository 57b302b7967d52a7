//! `lie-poisson` and `no-squish`: the variational Lie–Poisson splitting: three turns about the principal axes.

mod axis_order;

pub use axis_order::{AxisOrder, AxisOrderError};

use std::cell::OnceCell;

use super::schemes::{STRANG, Scheme, Stages};
use super::{Cost, Energy, FreePart, Kicks, Map, Method, SideBySide, Splitting, Symmetric, WheelSplit};
use crate::body::{Clock, Field, Point, Rotor, Time};
use crate::method::solve::turns::Turns;
use crate::num::{Dd, Precise};

/// Turns about the principal axes, with [kicks](Kicks) around them.
pub type LiePoisson = Splitting<AxisSplit, Kicks>;

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
    /// Outermost axis first; `None` takes that with the smallest leading error of the attitude as a root mean square over all
    /// starts of the [orbit](AxisOrder::best_for_orbit), and under forces and in compositions the [best](AxisOrder::best) for the
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
    fn free_cost(&self, scheme: &Scheme) -> Option<Cost> {
        match scheme.stages {
            Stages::Composition(_) => Some(Cost::turns(4) * scheme.lengths()?.len() as u32),
            _ => None,
        }
    }
    fn wheel_cost(&self) -> Option<Cost> {
        Some(Cost::turns(5))
    }
    fn wheel_split(&self, rotor: &Rotor) -> WheelSplit {
        let order = self.axes.unwrap_or_else(|| AxisOrder::best(rotor.moments()));
        let inverse = rotor.inverse_moments::<Dd>();
        WheelSplit::Turns { axes: order.axes().map(|axis| (axis, inverse[axis])), ball: None }
    }
    fn source(&self) -> &'static str {
        "McLachlan, Phys. Rev. Lett. 71 (1993) 3043; Touma and Wisdom, Astron. J. 107 (1994) 1189"
    }
}

impl<S: Precise> Method<S> for AxisSplit {
    type Map<F: Field<S>> = AxisSplitMap<S>;

    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> AxisSplitMap<S> {
        Method::<S>::maps(self, rotor, field)(h)
    }

    fn maps<F: Field<S>>(&self, rotor: &Rotor, _: &F) -> impl Fn(Dd) -> AxisSplitMap<S> {
        let (axes, best) = (self.axes, OnceCell::<AxisOrder>::new());
        move |h| {
            let order = axes.unwrap_or_else(|| *best.get_or_init(|| AxisOrder::best(rotor.moments())));
            AxisSplitMap::new(Some(order), vec![Dd::ONE], h, rotor)
        }
    }

    fn free_map<F: Field<S>>(&self, scheme: &Scheme, h: Dd, rotor: &Rotor, _: &F) -> Option<AxisSplitMap<S>> {
        let _ = self.free_cost(scheme)?;
        let by_orbit = self.axes.is_none() && *scheme == STRANG;
        let order = (!by_orbit).then(|| self.axes.unwrap_or_else(|| AxisOrder::best(rotor.moments())));
        Some(AxisSplitMap::new(order, scheme.lengths()?, h, rotor))
    }
}

/// A prepared [`AxisSplit`].
#[derive(Clone, Debug)]
pub struct AxisSplitMap<S> {
    rotor: Rotor,
    /// Of the steps that make up one, in shares of it.
    shares: Vec<Dd>,
    h: Dd,
    /// Whether the axes may be chosen by the orbit when the motion is opened.
    free_to_choose: bool,
    /// `None` until it is known whether they are.
    turns: Option<Turns<S>>,
}

impl<S: Precise> AxisSplitMap<S> {
    /// With the axes in the order `order`, or as the orbit says.
    fn new(order: Option<AxisOrder>, shares: Vec<Dd>, h: Dd, rotor: &Rotor) -> Self {
        let turns = order.map(|order| turns(order, rotor, h, &shares));
        AxisSplitMap { rotor: *rotor, shares, h, free_to_choose: order.is_none(), turns }
    }

    /// The turns; of no orbit in the order that is best for the energy.
    #[inline(always)]
    fn turns(&mut self) -> &mut Turns<S> {
        let AxisSplitMap { rotor, shares, h, turns, .. } = self;
        turns.get_or_insert_with(|| usual(rotor, *h, shares))
    }
}

fn turns<S: Precise>(order: AxisOrder, rotor: &Rotor, h: Dd, shares: &[Dd]) -> Turns<S> {
    let inverse = rotor.inverse_moments::<Dd>();
    Turns::three(order.axes(), order.axes().map(|axis| inverse[axis] * h), shares)
}

#[cold]
#[inline(never)]
fn usual<S: Precise>(rotor: &Rotor, h: Dd, shares: &[Dd]) -> Turns<S> {
    turns(AxisOrder::best(rotor.moments()), rotor, h, shares)
}

impl<S: Precise> Map<S> for AxisSplitMap<S> {
    #[inline]
    fn apply(&mut self, _: Time, x: &mut Point<S>) {
        self.turns().apply(x);
    }

    fn open(&mut self, _: Time, x: &mut Point<S>) {
        if self.free_to_choose {
            let m = x.momentum_body.map(S::to_f64);
            let order = AxisOrder::best_for_orbit(m, self.rotor.moments());
            self.turns = Some(turns(order, &self.rotor, self.h, &self.shares));
        }
        self.turns().open(x);
    }

    #[inline]
    fn advance(&mut self, _: Time, x: &mut Point<S>) {
        self.turns().advance(x);
    }

    #[inline]
    fn advance_by(&mut self, n: u64, _: &Clock, x: &mut Point<S>) {
        self.turns().advance_by(n, x);
    }

    #[inline]
    fn fill(&mut self, _: &Clock, x: &mut Point<S>, block: &mut [Point<S>]) {
        self.turns().fill(x, block);
    }

    fn side_by_side(&self) -> Option<SideBySide<S>> {
        self.turns.as_ref()?.side_by_side()
    }

    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        Some(SideBySide::flows(self.turns.as_ref()?.flows()))
    }

    #[inline]
    fn close(&mut self, _: Time, x: &mut Point<S>) {
        self.turns().close(x);
    }
}
