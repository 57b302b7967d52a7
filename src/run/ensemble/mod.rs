//! Many bodies, each from its own start: exact motion at many times, or many steps side by side.
//!
//! Members do not act on each other, so that results do not depend on how they are divided: member k has the bits of a
//! [`Run`](super::Run) or a [`FreeMotion`](crate::flow::FreeMotion) of its own, on any number of threads and with any set of
//! instructions, and rows come in the order of the members.

mod error;
mod exact;
mod first;
mod members;
mod parts;
mod rows;
mod spread;
mod stepped;

use std::sync::Arc;

use nalgebra::{UnitQuaternion, Vector3};

pub use self::error::{EnsembleError, MemberError};
use self::members::{Inertias, Start};
pub use self::rows::Rows;
pub use self::spread::{Spread, Tally};
use self::stepped::Course;
use crate::body::{Body, Clock, Point, State, WheelAtStart};
use crate::inertia::Inertia;
use crate::method::AnyMethod;
use crate::num::{Dd, Instructions};
use crate::rotation::Vec3;

/// Makes the body of a member from its inertia.
type Acting = Arc<dyn Fn(Inertia) -> Result<Body, MemberError> + Send + Sync>;

/// What is compared with the start or with the exact motion in every row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Observed {
    /// Relative errors of the invariants, in double-double.
    pub invariants: bool,
    /// The angle to the exact attitude, rad, where the motion has a closed form.
    pub attitude: bool,
}

impl Observed {
    /// With the relative errors of the invariants, or without.
    #[must_use]
    pub fn with_invariants(self, invariants: bool) -> Self {
        Observed { invariants, ..self }
    }

    /// With the angle to the exact attitude, or without.
    #[must_use]
    pub fn with_attitude(self, attitude: bool) -> Self {
        Observed { attitude, ..self }
    }
}

/// Bodies with their starts, propagated together.
///
/// A member takes 64 bytes, 24 more where moments differ from member to member, and 192 more where tensors do that are not
/// along the body axes. While it runs, parts of at most 8192 members are held, one for a single thread and some two for each of several,
/// with 80 bytes for each of their rows, and more where errors are observed.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::inertia::Inertia;
/// use polhode::flow::FreeMotion;
/// use polhode::run::{Ensemble, EnsembleError};
/// let mut ensemble = Ensemble::new();
/// for k in 0..100 {
///     let inertia = Inertia::from_moments([1.0, 2.0, 2.5 + 0.005 * f64::from(k)])?;
///     ensemble.push_omega(&inertia, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3));
/// }
/// let mut latest = Vec::new();
/// ensemble.at(&[10.0, 1e6], |rows| {
///     latest.extend_from_slice(rows.states(1));
///     Ok::<(), EnsembleError>(())
/// })?;
/// let inertia = Inertia::from_moments([1.0, 2.0, 2.75])?;
/// let alone = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// assert_eq!(latest[50], alone.at(1e6)?);
/// # Ok::<(), polhode::Error>(())
/// ```
#[must_use]
pub struct Ensemble {
    inertias: Inertias,
    starts: Vec<Start>,
    /// Members that were given up before the start, ascending.
    failed: Vec<(usize, MemberError)>,
    acting: Option<Acting>,
    wheels: Vec<WheelAtStart>,
    observed: Observed,
    instructions: Instructions,
    #[cfg(feature = "parallel")]
    threads: usize,
}

impl Default for Ensemble {
    fn default() -> Self {
        Self::new()
    }
}

impl Ensemble {
    /// Without members, on one thread.
    pub fn new() -> Self {
        Self::with_capacity(0)
    }

    /// The same with room for `members`.
    pub fn with_capacity(members: usize) -> Self {
        Ensemble {
            inertias: Inertias::with_capacity(members),
            starts: Vec::with_capacity(members),
            failed: Vec::new(),
            acting: None,
            wheels: Vec::new(),
            observed: Observed::default(),
            instructions: Instructions::default(),
            #[cfg(feature = "parallel")]
            threads: 1,
        }
    }

    /// Adds a member that starts in the state `start`, body axes. A start that is not usable is the failure of this member.
    pub fn push(&mut self, inertia: &Inertia, start: &State) {
        let Vec3(momentum) = start.momentum_body;
        self.add(inertia, Start::of_momentum(start.attitude.components(), momentum));
    }

    /// Adds a member that starts with the attitude `attitude` and the angular velocity `omega_body`, rad/s, body axes.
    pub fn push_omega(&mut self, inertia: &Inertia, attitude: UnitQuaternion<f64>, omega_body: Vector3<f64>) {
        let [x, y, z, w]: [f64; 4] = attitude.coords.into();
        self.add(inertia, Start::of_omega([w, x, y, z], omega_body.into()));
    }

    /// Adds a member that has no motion, so that those behind it keep their places.
    pub fn push_failed(&mut self, error: impl Into<MemberError>) {
        self.failed.push((self.len(), error.into()));
        self.inertias.push_any();
        self.starts.push(Start::NOWHERE);
    }

    fn add(&mut self, inertia: &Inertia, start: Start) {
        self.inertias.push(inertia, self.starts.len());
        self.starts.push(start);
    }

    /// The same members, each of them the body that `body` makes of its inertia: heavy, with forces or wheels. An error is the failure
    /// of that member.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::body::Body;
    /// use polhode::run::Ensemble;
    /// let heavy = Ensemble::new().acted_on(|inertia| Body::heavy(inertia, Vector3::new(0.0, 0.0, 2.0)));
    /// assert!(heavy.is_empty());
    /// ```
    pub fn acted_on<E: Into<MemberError>>(
        mut self,
        body: impl Fn(Inertia) -> Result<Body, E> + Send + Sync + 'static,
    ) -> Self {
        self.acting = Some(Arc::new(move |inertia| body(inertia).map_err(Into::into)));
        self
    }

    /// The same members, each of them with `wheels` besides, whose momenta follow from its own start.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::body::{Wheel, WheelAtStart};
    /// use polhode::Inertia;
    /// use polhode::run::Ensemble;
    /// let wheel = WheelAtStart::free(Wheel::new(Vector3::z(), 0.5, 4.0)?);
    /// let mut ensemble = Ensemble::new().carrying(vec![wheel]);
    /// ensemble.push_omega(&Inertia::from_moments([3.0, 3.0, 5.0])?, Default::default(), Vector3::z());
    /// // relative to the body, which turns itself
    /// let body = ensemble.body(0).ok_or("a member")?;
    /// assert_eq!(body.momentum_of_wheels_at(0.0), Vector3::new(0.0, 0.0, 2.5));
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn carrying(self, wheels: Vec<WheelAtStart>) -> Self {
        Ensemble { wheels, ..self }
    }

    /// The same members, with errors in every row.
    pub fn observing(mut self, observed: Observed) -> Self {
        self.observed = observed;
        self
    }

    /// The same members, moved by no more than these instructions. The bits do not depend on it.
    pub fn by(mut self, instructions: Instructions) -> Self {
        self.instructions = instructions;
        self
    }

    /// The same members on `threads` threads; 0 takes as many as the processor runs at a time. The bits do not depend on it.
    #[cfg(feature = "parallel")]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// How many members there are, with those that failed.
    #[must_use]
    pub fn len(&self) -> usize {
        self.starts.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// The exact motion of every member at `times`, s from its start, of either sign and in any order.
    ///
    /// `each` is given the members part by part, in their order. Rows have the bits of
    /// [`FreeMotion::at`](crate::flow::FreeMotion::at), under gravity those of [`LagrangeTop::at`](crate::flow::LagrangeTop::at).
    ///
    /// # Errors
    /// A time that is not finite, and what `each` returns; what befalls one member is in its [`Rows`].
    pub fn at<E: From<EnsembleError>>(
        &self,
        times: &[f64],
        mut each: impl FnMut(&Rows) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Some(&t) = times.iter().find(|t| !t.is_finite()) {
            return Err(EnsembleError::Time { t }.into());
        }
        self.in_parts(
            parts::of_exact(self.len(), times.len()),
            |part| exact::rows(self, part, times),
            |rows| each(&rows),
        )
    }

    /// Every member after the numbers of `steps`, ascending, by `method` and the steps of `clock`.
    ///
    /// `each` is given the members part by part, in their order. Rows have the bits of a [`Run`](super::Run) of the member
    /// alone. The splittings by turns about axes, such as `two-turn` and `lie-poisson`, and `rk4` move bodies side by side: free
    /// ones, and those on which uniform gravity, a gravity gradient and drag act, or some of these (drag with `rk4` alone, as
    /// splittings do not take it). Under these forces so do `kick-drift`, `rattle` and `dmv`, in every scheme: `kick-drift` while a free flow
    /// turns by less than an eighth of a radian and no two moments are equal. Members on one orbit share it. Every other method, and bodies with other forces, with forces that
    /// are switched or with wheels, go member by member.
    ///
    /// # Errors
    /// Steps that descend, a step that is not usable or bodies that the method is not for, and what `each` returns; what befalls
    /// one member is in its [`Rows`].
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::{Clock, Conserved};
    /// use polhode::inertia::Inertia;
    /// use polhode::method::method;
    /// use polhode::run::{Ensemble, EnsembleError, Observed, Tally};
    /// let inertia = Inertia::from_moments([1.0, 2.0, 3.0])?;
    /// let mut ensemble = Ensemble::new().observing(Observed::default().with_invariants(true).with_attitude(true));
    /// for k in 0..100 {
    ///     let omega = Vector3::new(0.4, 1.0, -0.01 * f64::from(k));
    ///     ensemble.push_omega(&inertia, UnitQuaternion::identity(), omega);
    /// }
    /// let mut tally = Tally::new();
    /// ensemble.advance(&method("two-turn")?, Clock::new(0.01), &[1000], |rows| {
    ///     tally.add(rows);
    ///     Ok::<(), EnsembleError>(())
    /// })?;
    /// let energy = tally.errors(0, Conserved::Energy).ok_or("observed")?;
    /// assert!(energy.largest() < 1e-5 && energy.quantile(0.5) < energy.largest());
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn advance<E: From<EnsembleError>>(
        &self,
        method: &dyn AnyMethod,
        clock: Clock,
        steps: &[u64],
        mut each: impl FnMut(&Rows) -> Result<(), E>,
    ) -> Result<(), E> {
        if let Some(pair) = steps.windows(2).find(|pair| pair[1] < pair[0]) {
            return Err(EnsembleError::Descending { before: pair[0], after: pair[1] }.into());
        }
        // what is wrong with the method is wrong for all
        if let Some((body, _)) = (0..self.len()).find_map(|k| self.member(k, clock.start).ok()) {
            method.prepare_f64(clock, &body).map_err(EnsembleError::from)?;
        }
        let course = Course { ensemble: self, method, clock, steps };
        self.in_parts(
            parts::of_stepped(self.len(), steps.len()),
            |part| course.rows(part),
            |rows| each(&rows),
        )
    }

    /// The body of member `k` with all that acts on it, from a start at time 0; `None` where there is no such member, or none that has one.
    #[must_use]
    pub fn body(&self, k: usize) -> Option<Body> {
        self.member(k, 0.0).ok().map(|(body, _)| body)
    }

    /// Body and start of member `k`, in the solver frame, where it starts at the time `t`, s.
    fn member(&self, k: usize, t: f64) -> Result<(Body, Point<Dd>), MemberError> {
        if let Ok(place) = self.failed.binary_search_by_key(&k, |failed| failed.0) {
            return Err(self.failed[place].1.clone());
        }
        let inertia = self.inertias.of(k)?;
        let mut body = match &self.acting {
            Some(acting) => acting(inertia)?,
            None => Body::free(inertia),
        };
        let start = self.starts.get(k).copied().unwrap_or(Start::NOWHERE);
        if !self.wheels.is_empty() {
            // the inertia of the carrier, and so how it turns, is the same with any momenta of its wheels
            let carrying = body.clone().with_wheels_at_start(&self.wheels, t, Vector3::zeros())?;
            let omega = carrying.omega_of(&start.enter(&carrying)?);
            body = body.with_wheels_at_start(&self.wheels, t, omega)?;
        }
        let start = start.enter(&body)?;
        Ok((body, start))
    }
}
