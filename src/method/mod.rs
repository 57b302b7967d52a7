//! Methods: one step of size h is a map Φ_h that moves a point; its claims are data, and the laws in `tests/laws.rs`
//! execute every one of them, also those that say no.

mod axis_order;
mod axis_split;
mod catalogue;
mod claims;
mod collocation;
mod composed;
mod dmv;
mod dmv_series;
mod embedded;
mod exact_flow;
mod exact_step;
mod exponential;
mod game_engine;
mod implicit_midpoint;
mod kicks;
mod lanes;
mod length;
mod lie_group;
mod lie_newmark;
mod map;
mod modified_energy;
mod preprocessed_dmv;
mod processor;
mod projected;
mod quadratic;
mod richardson;
mod runge_kutta;
pub mod schemes;
mod single_turn;
mod splitting;
mod stagnation;
mod symmetric_projection;
mod taylor;
mod tolerance;
mod turns;
mod two_turn;
mod variational_cayley;

pub use axis_order::{AxisOrder, AxisOrderError};
pub use axis_split::AxisSplit;
pub use catalogue::{AnyMethod, StepError, UnknownMethod, catalogue, method};
pub use claims::{Claimed, Claims, Cost, Energy, Kept};
pub use collocation::{Gauss, GaussMap, GaussOrderError};
pub use composed::{Composed, Symmetric};
pub use dmv::Dmv;
pub use embedded::{
    Control, Dop853, DormandPrince853, Embedded, EmbeddedMap, Pair, Rk8, Rk8Map, Stage, Terms, Tsit5,
    Tsitouras54,
};
pub use exact_flow::ExactFlow;
pub use exact_step::ExactStep;
pub use game_engine::{MomentumEuler, MomentumEulerMap};
pub use implicit_midpoint::ImplicitMidpoint;
pub use kicks::Kicks;
pub(crate) use lanes::Block;
pub use lanes::SideBySide;
pub use lie_group::{LieGroup, LieGroupMap, MujocoRk4, MujocoRk4Map};
pub use lie_newmark::{LieNewmark, LieNewmarkMap};
pub use map::{Map, Method, Step, Stuck, Work};
pub use modified_energy::PhaseErrorRates;
pub use preprocessed_dmv::{DmvOrderError, PreprocessedDmv};
pub use projected::{ProjectedRk4, ProjectedRk4Map};
pub use richardson::{Richardson, RichardsonMap};
pub use runge_kutta::{ExplicitEuler, Rk4, SemiImplicitEuler};
pub use single_turn::{Buss, BussMap};
pub use splitting::{FreePart, SchemeError, Splitting};
pub use symmetric_projection::{SymmetricProjection, SymmetricProjectionMap};
pub use taylor::{AdaptiveTaylor, AdaptiveTaylorMap, Taylor, TaylorMap, TaylorOrderError};
pub use tolerance::ToleranceError;
pub use two_turn::{TwoAxes, TwoAxesError, TwoTurn};
pub use variational_cayley::{VariationalCayley, VariationalCayleyMap};

/// Turns about the principal axes, with [kicks](Kicks) around them.
pub type LiePoisson = Splitting<AxisSplit, Kicks>;

/// The discrete Moser–Veselov map with [kicks](Kicks) around it.
pub type Rattle = Splitting<Dmv, Kicks>;

/// The exact free flow with [kicks](Kicks) around it. The name is the field's: *drift* is the free motion between two kicks,
/// elsewhere in this crate the [secular growth of an error](crate::observe::Drift).
pub type KickDrift = Splitting<ExactFlow, Kicks>;
