//! The true motion of a body from a start, and how a run departs from it.
//!
//! The true motion is the [closed form](crate::flow::ExactMotion) where there is one. For any other body it is a run in
//! double-double, q₁(t), as long as a second run with other steps, q₂(t), agrees with it: the angle `2 atan2(|v|, |w|)` of
//! `q₁* q₂ = (w, v)` must be at most [`AGREEMENT`], or what the caller states. So a chaotic motion with the Lyapunov exponent λ is known
//! up to about `ln(1e-13 / 1e-31) / λ ≈ 40 / λ`.
//!
//! ```
//! use polhode::truth::{AGREEMENT, Care, Ending, Truth, evenly};
//! use polhode::{Body, Inertia, method};
//!
//! // an asymmetric top: no closed form
//! let body = Body::heavy(Inertia::from_moments([0.5, 0.85, 1.0])?, [0.0, 0.0, 1.0].into())?;
//! let start = body.state(Default::default(), [0.4, 1.2, 0.4].into())?;
//! let truth = Truth::new(&body, &start, &evenly(8.0, 16))?;
//! assert!(truth.closed_form().is_none() && truth.known_until() == 8.0);
//! let run = truth.judge(&method("kick-drift@srkn-6b")?, 1.0 / 64.0, Care::default())?;
//! assert_eq!(run.ending, Ending::Held);
//! assert!(run.attitude_error().is_some_and(|error| error < 1e-8 && error > AGREEMENT)); // rad
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ending;
mod error;
mod follow;
mod judge;
mod pair;
mod together;
#[allow(clippy::module_inception)]
mod truth;
mod turning;

pub use ending::{Ending, LOST};
pub use error::TruthError;
pub use follow::AGREEMENT;
pub use judge::{Care, Judged, Look};
pub(crate) use truth::Wanted;
pub use truth::{Truth, evenly};
pub(crate) use turning::Turning;

use crate::num::{Dd, Precise};
use crate::rotation::{Quat, rotation_angle};

/// Angle between the attitude `q` of a run and the true one, rad: 2 atan2(|v|, |w|), worked out in double-double.
///
/// ```
/// use polhode::rotation::{Quat, Vec3};
/// let quarter = Quat::new(0.5f64.sqrt(), Vec3([0.5f64.sqrt(), 0.0, 0.0]));
/// let angle = polhode::truth::attitude_error(quarter, Quat::identity());
/// assert!((angle - core::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// ```
#[must_use]
pub fn attitude_error<S: Precise>(q: Quat<S>, exact: Quat<Dd>) -> f64 {
    rotation_angle(q.map(S::to_dd), exact).hi()
}
