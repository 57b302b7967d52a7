//! When something happens: roots of functions of time and state, along closed forms and along runs.
//!
//! An [`Event`] is a function g(t, state); it happens where g changes sign. Ready-made ones are flips, an axis that enters a
//! cone, a rate above a limit, and the nearest approach to an attitude. [`FreeMotion::events`](crate::FreeMotion::events) and
//! [`ExactMotion::events`](crate::flow::ExactMotion::events) look for them on closed forms, at any time;
//! [`Run::events`](crate::Run::events) and [`Run::until`](crate::Run::until) along a run.
//!
//! g is evaluated at times of a spacing that the caller chooses. On closed forms, a bound on the rate of g excludes events between two
//! of these times. An interval that it does not exclude is halved, down to 1/4096 of the spacing (1/64 about a change of sign): only
//! events that come in pairs within that may be missed. Flips, cones and rates know their bounds; an event of your own states
//! [its bound](Event::changing_at_most). Without a bound, and along runs, two events that are nearer together than the spacing may be
//! missed; [`Events::may_miss`] says which.
//!
//! Changes of sign within rounding do not count: a cone, a rate or an axis that a motion keeps to within rounding is found once, where
//! the search begins, and a cone that is only touched, to within rounding, is found once or not at all.
//!
//! ```
//! use nalgebra::{UnitQuaternion, Vector3};
//! use polhode::events::Event;
//! use polhode::{Body, FreeMotion, Inertia};
//! let racket = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
//! let motion = FreeMotion::from_omega(racket.inertia(), UnitQuaternion::identity(), Vector3::new(1e-3, 1.0, 0.0))?;
//! let flips = motion.events(&[Event::flip(&racket)], 0.0, 1000.0, 1.0)?;
//! assert_eq!(flips.found.len() as u64, motion.flips(1000.0.into()));
//! assert!(flips.may_miss.is_empty());
//! # Ok::<(), polhode::Error>(())
//! ```

mod along;
mod bracket;
mod closed_form;
mod error;
mod event;
mod ready;

pub use along::{Crossing, Events, Occurrence};
pub(crate) use along::{Search, intervals};
pub use error::EventError;
pub use event::Event;
