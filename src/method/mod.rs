//! Methods: a step of size h is a map Φ_h that moves a point. What a method claims is data. The [laws](crate::laws) measure each
//! claim, also that a method does not keep what it does not claim to keep.
//!
#![doc = include_str!("../../docs/methods.md")]

mod buss_2;
mod combine;
mod commutator_free_4;
mod contract;
mod crouch_grossman_3;
mod dissipating;
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
mod linearly_implicit_euler;
mod momentum_euler;
mod mujoco_rk4;
mod phase;
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

pub use buss_2::Buss;
pub use combine::{
    Composed, FreePart, InTurn, Kicks, KineticSplit, Palindrome, SchemeError, Splitting, Symmetric,
    WheelSplit, schemes,
};
pub(crate) use contract::SOLVED;
pub(crate) use contract::lanes::Block;
pub use contract::{
    AnyMethod, Claimed, Claims, Cost, Energy, Kept, Listing, Map, Method, SideBySide, Step, StepError, Stuck,
    ToleranceError, UnknownMethod, Work, catalogue, listing, method, without_projections,
};
pub use dissipating::{Dissipating, LossError};
pub use dmv::{DmvOrderError, PreprocessedDmv};
pub use dop853::{Dop853, DormandPrince853};
pub use exact_step::ExactStep;
pub use explicit_euler::ExplicitEuler;
pub use gauss::{Gauss, GaussOrderError};
pub use implicit_midpoint::ImplicitMidpoint;
pub use kick_drift::{ExactFlow, KickDrift};
pub use lie_group::LieGroup;
pub use lie_newmark::LieNewmark;
pub use lie_poisson::{AxisOrder, AxisOrderError, AxisSplit, LiePoisson};
pub use lie_poisson_projected::SymmetricProjection;
pub use linearly_implicit_euler::LinearlyImplicitEuler;
pub use momentum_euler::MomentumEuler;
pub use mujoco_rk4::MujocoRk4;
pub(crate) use phase::throughout;
pub use phase::{PhaseCorrected, PhaseDrift, PhaseError};
pub use rattle::{Dmv, Rattle};
pub use richardson::Richardson;
pub use rk4::Rk4;
pub use rk4_projected::ProjectedRk4;
pub use rk8::Rk8;
pub use runge_kutta::{Control, Embedded, Pair, Stage, Terms};
pub use semi_implicit_euler::SemiImplicitEuler;
pub use solve::modified_energy::PhaseErrorRates;
pub use taylor::{AdaptiveTaylor, Taylor, TaylorOrderError};
pub use tsit5::{Tsit5, Tsitouras54};
pub use two_turn::{TwoAxes, TwoAxesError, TwoTurn};
pub use variational_cayley::VariationalCayley;
