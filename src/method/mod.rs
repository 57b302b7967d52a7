//! Methods: one step of size h is a map Φ_h that moves a point; its claims are data, and the laws in `tests/laws.rs`
//! execute every one of them, also those that say no.

mod buss_2;
mod combine;
mod commutator_free_4;
mod contract;
mod crouch_grossman_3;
mod dmv;
mod dop853;
mod exact_step;
mod explicit_euler;
mod gauss;
mod implicit_midpoint;
mod kick_drift;
mod lie_group;
mod lie_newmark;
mod lie_poisson;
mod lie_poisson_projected;
mod momentum_euler;
mod mujoco_rk4;
mod rattle;
mod richardson;
mod rk4;
mod rk4_projected;
mod rk8;
mod rkmk4;
mod runge_kutta;
mod semi_implicit_euler;
mod solve;
mod taylor;
mod tsit5;
mod two_turn;
mod variational_cayley;

pub use buss_2::{Buss, BussMap};
pub use combine::{Composed, FreePart, Kicks, SchemeError, Splitting, Symmetric, schemes};
pub(crate) use contract::lanes::Block;
pub use contract::{
    AnyMethod, Claimed, Claims, Cost, Energy, Kept, Listing, Map, Method, SideBySide, Step, StepError, Stuck,
    ToleranceError, UnknownMethod, Work, catalogue, listing, method, without_projections,
};
pub use dmv::{DmvOrderError, PreprocessedDmv};
pub use dop853::{Dop853, DormandPrince853};
pub use exact_step::ExactStep;
pub use explicit_euler::ExplicitEuler;
pub use gauss::{Gauss, GaussMap, GaussOrderError};
pub use implicit_midpoint::ImplicitMidpoint;
pub use kick_drift::{ExactFlow, KickDrift};
pub use lie_group::{LieGroup, LieGroupMap};
pub use lie_newmark::{LieNewmark, LieNewmarkMap};
pub use lie_poisson::{AxisOrder, AxisOrderError, AxisSplit, LiePoisson};
pub use lie_poisson_projected::{SymmetricProjection, SymmetricProjectionMap};
pub use momentum_euler::{MomentumEuler, MomentumEulerMap};
pub use mujoco_rk4::{MujocoRk4, MujocoRk4Map};
pub use rattle::{Dmv, Rattle};
pub use richardson::{Richardson, RichardsonMap};
pub use rk4::Rk4;
pub use rk4_projected::{ProjectedRk4, ProjectedRk4Map};
pub use rk8::{Rk8, Rk8Map};
pub use runge_kutta::{Control, Embedded, EmbeddedMap, Pair, Stage, Terms};
pub use semi_implicit_euler::SemiImplicitEuler;
pub use solve::modified_energy::PhaseErrorRates;
pub use taylor::{AdaptiveTaylor, AdaptiveTaylorMap, Taylor, TaylorMap, TaylorOrderError};
pub use tsit5::{Tsit5, Tsitouras54};
pub use two_turn::{TwoAxes, TwoAxesError, TwoTurn};
pub use variational_cayley::{VariationalCayley, VariationalCayleyMap};
