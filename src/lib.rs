//! Accurate long-time rotation of rigid bodies: free bodies, heavy tops, bodies under torques.
//!
//! * the exact motion of the free body, of a body with wheels and of Lagrange's top, at any time, to rounding;
//! * integrators on SO(3): what each keeps is stated and tested, and errors are computed with more digits than the steps;
//! * inertia tensors from moments, solids, meshes and parts, and what is wrong with a tensor that no body has;
//! * in the crate `polhode-fit`, inertia tensors from noisy records of angular velocity or attitude.
//!
//! ```
//! use nalgebra::{UnitQuaternion, Vector3};
//! use polhode::body::Conserved;
//! use polhode::{Body, Inertia, Run, method};
//!
//! let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
//! let start = body.state(UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
//! let mut run = Run::new(&method("two-turn")?, &body, &start, 0.01)?;
//! let after = run.advance_to(1_000_000)?;
//! let error = |quantity| after.worst.of(quantity);
//! assert!(error(Conserved::Energy).is_some_and(|error| error < 1e-5)); // it oscillates, and does not grow
//! assert!(error(Conserved::Momentum).is_some_and(|error| error < 1e-13)); // L in space: rounding alone
//! # Ok::<(), polhode::Error>(())
//! ```
//!
//! # Map
//!
//! | module | what lives there |
//! |---|---|
//! | [`num`] | numbers: `f64`, double-double, sums, elliptic functions |
//! | [`units`] | units by name, and dates |
//! | [`rotation`] | vectors, quaternions, distances on SO(3) |
//! | [`inertia`] | inertia tensors from moments, solids, meshes and mass distributions; what is wrong with a tensor |
//! | [`record`] | measured angular velocities: samples in segments without gaps |
//! | [`body`] | inertia with forces and wheels, states, the solver frame, in which methods compute |
//! | [`flow`] | exact flows and motions: the turn about an axis, the free body, the body with wheels, the top |
//! | [`events`] | when something happens: roots of functions of time and state |
//! | [`strapdown`] | attitude from measured rates: rules for rates, increments and averages, with an error budget |
//! | [`observe`] | invariants, largest errors over every step, secular drift |
//! | [`mod@method`] | the integrators, their schemes, what they claim, the catalogue |
//! | [`run`] | long propagation, schedules, checkpoints, orders of convergence; ensembles of many bodies |
//! | [`laws`] | what a method, a force or a scheme claims, measured |
//! | [`truth`] | the true motion of a body, how far a run departs from it, and how the run ended |
//! | [`advise`] | which method with which step, from short runs on the body itself |
//! | [`audit`] | whether a trajectory from elsewhere is right, in which convention, and how large its error is |
//! | [`catalogue`] | named bodies with their sources |
//! | [`guide`] | a chapter for each kind of user; your own force, your own method; the exact motion |
//!
//! Each module of code uses only those above it. The types that most programs need are also at the root:
//! [`Body`], [`Inertia`], [`State`], [`FreeMotion`], [`Run`], [`Schedule`], [`method()`](method()) and [`struct@Error`].
//!
//! # Features
//!
//! | feature | what it adds |
//! |---|---|
//! | `parallel` | [ensembles](run::Ensemble) on several threads, by rayon |
//! | `random` | seeded random numbers, and [populations](body) of bodies and starts drawn with them |
//!
//! None is on by default. The crate needs Rust 1.89 or newer.
//!
//! # Notation
//!
//! | symbol | meaning |
//! |---|---|
//! | q | attitude: unit quaternion, scalar first, active, body → space: `v_space = q v_body q*` |
//! | ω, `omega_body` | angular velocity, body axes, rad/s |
//! | I | inertia tensor, body axes, kg m² or any consistent unit; entries are `I_xy = −∫ x y dm` |
//! | m, `momentum_body` | angular momentum I ω, body axes |
//! | L, `momentum_space` | the same in space, q m q* |
//! | E | energy: kinetic, ½ m·I⁻¹m, and potential |
//! | h | step, s |
//!
//! The k-th moment that is given belongs to the k-th body axis; moments are not sorted.
//!
//! # Errors
//!
//! Functions that take user input return typed errors with the value and the law that it breaks; [`struct@Error`] holds any of them. The same input gives
//! the same bits on any processor.

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod advise;
pub mod audit;
pub mod body;
pub mod catalogue;
mod error;
pub mod events;
pub mod flow;
pub mod inertia;
pub mod laws;
pub mod method;
pub mod num;
pub mod observe;
pub mod record;
pub mod rotation;
pub mod run;
pub mod strapdown;
pub mod truth;
pub mod units;

/// A chapter for each kind of user, on your own force and method, and on the exact motion.
pub mod guide {
    #[doc = include_str!("../docs/attitude.md")]
    #[allow(rustdoc::broken_intra_doc_links, reason = "its tables name units in brackets")]
    pub mod attitude {}
    #[doc = include_str!("../docs/exact-motion.md")]
    pub mod exact_motion {}
    #[doc = include_str!("../docs/inertia-tensors.md")]
    pub mod inertia_tensors {}
    #[doc = include_str!("../docs/own-force-and-method.md")]
    pub mod own_force_and_method {}
    #[doc = include_str!("../docs/python.md")]
    #[allow(rustdoc::broken_intra_doc_links, reason = "its table names units in brackets")]
    pub mod python {}
    #[doc = include_str!("../docs/simulators.md")]
    pub mod simulators {}
    #[doc = include_str!("../docs/teaching.md")]
    pub mod teaching {}
    #[doc = include_str!("../docs/tumbling.md")]
    #[allow(rustdoc::broken_intra_doc_links, reason = "its tables name units in brackets")]
    pub mod tumbling {}
    #[doc = include_str!("../docs/wheels.md")]
    #[allow(rustdoc::broken_intra_doc_links, reason = "its tables name units in brackets")]
    pub mod wheels {}
}

pub use body::{Body, State};
pub use error::Error;
pub use flow::FreeMotion;
pub use inertia::Inertia;
pub use method::method;
pub use nalgebra;
pub use run::{Run, Schedule};

#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/crate.md")]
#[cfg(doctest)]
struct Readme;
