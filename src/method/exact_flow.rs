//! The exact flow of the free body as a part of a splitting.

use super::{Cost, Energy, FreePart, Map, Method, Symmetric};
use crate::body::{Field, Point, Rotor, Time};
use crate::flow::{Flow, FreeFlow};
use crate::num::{Dd, Precise};

/// The [free flow](FreeFlow): with kicks around it, the splitting of H = T + U into the two flows that are known exactly.
///
/// The bracket is kept, L_z where the potential conserves it, and the energy of a potential that does not depend on time stays
/// within O(h^order) for exponentially long times. The error is proportional to the torque; without torque the motion is
/// exact.
///
/// ```
/// use polhode::body::Problem;
/// use polhode::method::{Claimed, ExactFlow, KickDrift, Kicks};
/// let method = KickDrift::strang(ExactFlow, Kicks);
/// assert_eq!(method.claims(Problem::Free).and_then(|claims| claims.order), None); // exact at any step
/// assert_eq!(method.claims(Problem::Gravity).and_then(|claims| claims.order), Some(2));
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
    fn source(&self) -> &'static str {
        "Strang, SIAM J. Numer. Anal. 5 (1968) 506; Celledoni, Fasso, Safstrom and Zanna, SIAM J. Sci. Comput. 30 (2008) 2084"
    }
}

impl<S: Precise> Method<S> for ExactFlow {
    type Map<F: Field<S>> = ExactFlowMap<S>;
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, _: &F) -> ExactFlowMap<S> {
        ExactFlowMap { flow: FreeFlow::new(rotor), h: S::from_dd(h) }
    }
}

/// A prepared [`ExactFlow`].
#[derive(Clone, Copy, Debug)]
pub struct ExactFlowMap<S> {
    flow: FreeFlow<S>,
    h: S,
}

impl<S: Precise> Map<S> for ExactFlowMap<S> {
    #[inline]
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.flow.flow(at, self.h, x);
        x.renormalize_at_times();
    }
}
