//! What is looked for.

use core::fmt;
use std::sync::Arc;

use crate::body::State;

/// A function of time (s) and state.
type Law = Arc<dyn Fn(f64, &State) -> f64 + Send + Sync>;

/// Something that happens along a motion: a change of sign of a function g of the time and the state.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::events::Event;
/// use polhode::{Body, FreeMotion, Inertia};
/// // when does a star tracker along body z look below the horizon?
/// let below = Event::zero("tracker below horizon", |_, x| (x.rotation() * Vector3::z()).z).falling();
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let motion = FreeMotion::from_omega(body.inertia(), UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let first = motion.events(&[below.stopping()], 0.0, 100.0, 0.1)?.found[0].clone();
/// assert!((first.state.rotation() * Vector3::z()).z.abs() < 1e-14);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone)]
#[must_use]
pub struct Event {
    name: String,
    law: Law,
    pub(super) direction: Direction,
    /// g jumps between −1 and 1.
    pub(super) jumps: bool,
    /// It is the case wherever g > 0.
    pub(super) lasts: bool,
    pub(super) stops: bool,
    pub(super) bound: Bound,
    /// What rounding makes of g where it is zero; where nobody knows, every sign counts.
    noise: Option<Law>,
}

/// Which changes of sign count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Both,
    Rising,
    Falling,
}

/// What g changes by at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bound {
    Unknown,
    /// In a second.
    PerSecond(f64),
    /// While the body turns by one radian.
    PerRadian(f64),
    /// While the angular velocity changes by 1 rad/s.
    PerRate(f64),
}

impl Event {
    /// The function `law` of the time (s) and the state (body axes) is zero. It has to be continuous.
    pub fn zero(name: impl Into<String>, law: impl Fn(f64, &State) -> f64 + Send + Sync + 'static) -> Self {
        Event {
            name: name.into(),
            law: Arc::new(law),
            direction: Direction::Both,
            jumps: false,
            lasts: false,
            stops: false,
            bound: Bound::Unknown,
            noise: None,
        }
    }

    /// The condition `holds` begins to hold.
    ///
    /// ```
    /// use polhode::events::Event;
    /// let eclipse = Event::when("eclipse", |t, _| (t / 5400.0).fract() > 0.6);
    /// assert_eq!(eclipse.name(), "eclipse");
    /// ```
    pub fn when(
        name: impl Into<String>,
        holds: impl Fn(f64, &State) -> bool + Send + Sync + 'static,
    ) -> Self {
        let law = move |t: f64, x: &State| if holds(t, x) { 1.0 } else { -1.0 };
        Event { jumps: true, ..Event::zero(name, law).lasting() }
    }

    /// Only where g goes from negative to positive.
    pub fn rising(self) -> Self {
        Event { direction: Direction::Rising, ..self }
    }

    /// Only where g goes from positive to negative.
    pub fn falling(self) -> Self {
        Event { direction: Direction::Falling, ..self }
    }

    /// The search ends where it happens.
    pub fn stopping(self) -> Self {
        Event { stops: true, ..self }
    }

    /// g changes by at most `rate` in a second: closed forms then miss no event between looks. A rate that is too small is an
    /// error as soon as it is seen.
    pub fn changing_at_most(self, rate: f64) -> Self {
        Event { bound: Bound::PerSecond(rate), ..self }
    }

    /// Begins where g rises, and is the case until it falls.
    pub(super) fn lasting(self) -> Self {
        Event { lasts: true, ..self.rising() }
    }

    pub(super) fn bounded(self, bound: Bound) -> Self {
        Event { bound, ..self }
    }

    /// A value within `noise` has no sign.
    pub(super) fn known_to(self, noise: impl Fn(f64, &State) -> f64 + Send + Sync + 'static) -> Self {
        Event { noise: Some(Arc::new(noise)), ..self }
    }

    /// What is zero to rounding at the time `t`, s, and the state `x`.
    pub(super) fn noise(&self, t: f64, x: &State) -> f64 {
        self.noise.as_ref().map_or(0.0, |noise| noise(t, x))
    }

    /// Whether the rate of g is bounded: closed forms then [miss](super) no event between looks, and runs may.
    ///
    /// ```
    /// use polhode::events::Event;
    /// let noon = Event::zero("noon", |t, _| t - 43_200.0);
    /// assert!(!noon.is_bounded() && noon.changing_at_most(1.0).is_bounded());
    /// ```
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.bound != Bound::Unknown
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// g at the time `t`, s, and the state `x`, body axes.
    #[must_use]
    pub fn value(&self, t: f64, x: &State) -> f64 {
        (self.law)(t, x)
    }
}

impl fmt::Debug for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Event({:?}, {:?})", self.name, self.direction)
    }
}
