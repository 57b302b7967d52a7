//! `kick-drift`: the exact flow of the free body as a part of a splitting.

use super::exact_step::{ExactStep, ExactStepMap};
use super::schemes::Scheme;
use super::{Cost, Energy, FreePart, Kicks, Map, Method, SideBySide, Splitting, Symmetric};
use crate::body::{Field, Free, Point, RENORMALIZE_EVERY, Rotor, Time};
use crate::flow::{FreeFlow, Last, apart};
use crate::method::contract::lanes::LaneFlow;
use crate::num::{Dd, Precise, Real};

/// The exact free flow with [kicks](Kicks) around it. The name is the field's: *drift* is the free motion between two kicks,
/// elsewhere in this crate the [secular growth of an error](crate::observe::Drift).
pub type KickDrift = Splitting<ExactFlow, Kicks>;

/// The [free flow](FreeFlow): with kicks around it, the splitting of H = T + U into the two flows that are known exactly.
///
/// The bracket is kept, L_z where the potential conserves it, and the energy of a potential that does not depend on time stays
/// within O(h^order) for exponentially long times. The error is proportional to the torque; without torque the motion is
/// exact, and that of [`ExactStep`].
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, ExactFlow, KickDrift, Kicks};
/// let method = KickDrift::strang(ExactFlow, Kicks);
/// assert_eq!(method.claims(Problem::Free).and_then(|claims| claims.order), None); // exact at any step
/// assert_eq!(method.claims(Problem::Linear).and_then(|claims| claims.order), Some(2));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExactFlow;

impl Symmetric for ExactFlow {}

impl FreePart for ExactFlow {
    fn name(&self) -> String {
        "kick-drift".into()
    }
    fn order(&self) -> Option<u32> {
        None
    }
    fn energy(&self) -> Energy {
        Energy::Exact
    }
    fn cost(&self) -> Cost {
        Cost::free_flows(1)
    }
    fn free_cost(&self, _: &Scheme) -> Option<Cost> {
        Some(Cost::additions(1))
    }
    fn wheel_cost(&self) -> Option<Cost> {
        Some(self.cost())
    }
    fn source(&self) -> &'static str {
        "Strang, SIAM J. Numer. Anal. 5 (1968) 506; Celledoni, Fasso, Safstrom and Zanna, SIAM J. Sci. Comput. 30 (2008) 2084"
    }
}

impl<S: Precise> Method<S> for ExactFlow {
    type Map<F: Field<S>> = ExactFlowMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> ExactFlowMap<S> {
        ExactFlowMap(Kind::AnyOrbit { flow: FreeFlow::new(rotor), h: S::from_dd(h), last: Last::NOTHING })
    }

    /// Where nothing acts, the flows of a step are one along an orbit that stays the same. In double-double the series of
    /// the flow is kept: along a rod it loses fewer digits.
    fn free_map<F: Field<S>>(&self, _: &Scheme, h: Dd, rotor: &Rotor, _: &F) -> Option<ExactFlowMap<S>> {
        let precise = S::ROUNDOFF < f64::ROUNDOFF;
        (!precise).then(|| ExactFlowMap(Kind::OneOrbit(ExactStep.map(h, rotor, &Free))))
    }
}

/// A prepared [`ExactFlow`].
#[derive(Clone, Debug)]
pub struct ExactFlowMap<S>(Kind<S>);

#[derive(Clone, Debug)]
enum Kind<S> {
    /// From any point, as after a kick.
    AnyOrbit {
        flow: FreeFlow<S>,
        h: S,
        last: Last<S>,
    },
    OneOrbit(ExactStepMap<S>),
}

impl<S: Precise> Map<S> for ExactFlowMap<S> {
    #[inline(always)]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        match &mut self.0 {
            Kind::AnyOrbit { flow, h, last } => {
                flow.flow_again(at, *h, last, x);
                x.renormalize_at_times();
            }
            Kind::OneOrbit(steps) => apart(x, |x| steps.apply(at, x)),
        }
    }

    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        let Kind::AnyOrbit { flow, h, .. } = &self.0 else { return None };
        let renormalize = [(LaneFlow::Renormalize(RENORMALIZE_EVERY), S::of(0.0))];
        flow.goes_side_by_side().then(|| SideBySide::free(*flow, *h, renormalize))
    }

    fn open(&mut self, at: Time, x: &mut Point<S>) {
        if let Kind::OneOrbit(steps) = &mut self.0 {
            steps.open(at, x);
        }
    }

    #[inline]
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        match &mut self.0 {
            Kind::OneOrbit(steps) => steps.advance(at, x),
            Kind::AnyOrbit { .. } => self.apply(at, x),
        }
    }
}
