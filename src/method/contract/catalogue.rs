//! The catalogue: every method that tables show.

use crate::method::schemes::SUZUKI_4;
use crate::method::{
    AdaptiveTaylor, AnyMethod, AxisSplit, Buss, Dmv, Dop853, ExactFlow, ExactStep, ExplicitEuler, Gauss,
    ImplicitMidpoint, Kicks, LieGroup, LieNewmark, MomentumEuler, MujocoRk4, PreprocessedDmv, ProjectedRk4,
    Richardson, Rk4, Rk8, SemiImplicitEuler, Splitting, SymmetricProjection, Tsit5, TwoTurn,
    VariationalCayley,
};

/// The methods that tables show, in their order; of those that take an argument or a scheme the usual ones.
///
/// ```
/// use polhode::method::{Claimed, catalogue, method};
/// assert!(catalogue().iter().all(|known| method(&known.name()).is_ok()));
/// ```
#[must_use]
pub fn catalogue() -> Vec<Box<dyn AnyMethod>> {
    let mut all = without_projections();
    all.push(Box::new(ProjectedRk4));
    all.push(Box::new(SymmetricProjection::new(AxisSplit { axes: None })));
    all
}

/// The catalogue without the two methods that project each step onto energy and |m|. Those show what conservation alone is worth,
/// and no program takes them: experiments, advice and audits go without.
#[doc(hidden)]
#[must_use]
pub fn without_projections() -> Vec<Box<dyn AnyMethod>> {
    vec![
        Box::new(ExplicitEuler),
        Box::new(SemiImplicitEuler),
        Box::new(Rk4 { normalized: false }),
        Box::new(Rk4 { normalized: true }),
        Box::new(Rk8),
        Box::new(Tsit5::default()),
        Box::new(Dop853::default()),
        Box::new(ImplicitMidpoint),
        Box::new(Splitting::strang(Dmv, Kicks)),
        Box::new(Splitting::strang(PreprocessedDmv::ORDER_10, Kicks)),
        Box::new(Splitting::strang(AxisSplit { axes: None }, Kicks)),
        Box::new(Splitting::strang(TwoTurn { axes: None }, Kicks)),
        Box::new(ExactStep),
        Box::new(Splitting::strang(ExactFlow, Kicks)),
        Box::new(Splitting::with_scheme(ExactFlow, Kicks, SUZUKI_4)),
        Box::new(AdaptiveTaylor::to_rounding()),
        Box::new(Gauss::ORDER_4),
        Box::new(Gauss::ORDER_8),
        Box::new(LieGroup::RKMK_4),
        Box::new(LieGroup::COMMUTATOR_FREE_4),
        Box::new(LieGroup::CROUCH_GROSSMAN_3),
        Box::new(MomentumEuler),
        Box::new(Buss { augmented: false }),
        Box::new(Buss { augmented: true }),
        Box::new(Richardson),
        Box::new(MujocoRk4),
        Box::new(LieNewmark),
        Box::new(Splitting::strang(VariationalCayley, Kicks)),
    ]
}
