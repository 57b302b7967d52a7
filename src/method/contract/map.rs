//! One step of size h as a map: prepared once for a body and a step, then applied many times.

use super::SideBySide;
use crate::body::{Clock, Field, Point, Rotor, Time, Wheels};
use crate::method::phase::PhaseError;
use crate::method::schemes::Scheme;
use crate::num::{Dd, Precise, Real};

/// A family of maps Φ_h, one for each duration, body and field of forces.
///
/// A method of one's own implements this for every scalar and field, and [`Claimed`](super::Claimed).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Conserved, Field, Point, Problem, Rotor, Time};
/// use polhode::flow::{Flow, FreeFlow, Kick};
/// use polhode::inertia::Inertia;
/// use polhode::method::{Claimed, Claims, Cost, Energy, Kept, Map, Method};
/// use polhode::num::{Dd, Precise};
/// use polhode::run::Run;
///
/// /// A kick, then the free flow, Φ_h = A(h) B(h): of order 1, and not symmetric.
/// #[derive(Clone)]
/// struct KickFirst;
/// struct KickFirstMap<S, F> {
///     h: S,
///     kick: Kick<S, F>,
///     free: FreeFlow<S>,
/// }
///
/// impl<S: Precise> Method<S> for KickFirst {
///     type Map<F: Field<S>> = KickFirstMap<S, F>;
///     fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> KickFirstMap<S, F> {
///         KickFirstMap { h: S::from_dd(h), kick: Kick::new(field.clone()), free: FreeFlow::new(rotor) }
///     }
/// }
///
/// impl<S: Precise, F: Field<S>> Map<S> for KickFirstMap<S, F> {
///     fn apply(&mut self, at: Time, x: &mut Point<S>) {
///         self.kick.flow(at, self.h, x);
///         self.free.flow(at, self.h, x);
///         x.renormalize_at_times();
///     }
/// }
///
/// impl Claimed for KickFirst {
///     fn name(&self) -> String {
///         "kick-first".into()
///     }
///     fn claims(&self, problem: Problem) -> Option<Claims> {
///         let mut kept = Kept::NOTHING;
///         (kept.energy, kept.momentum_z, kept.norm) = (Energy::Bounded, true, true);
///         let cost = Cost::kicks(1) + Cost::free_flows(1);
///         (problem == Problem::Linear).then(|| Claims::new(Some(1), kept, cost, "symplectic Euler"))
///     }
/// }
///
/// let top = Body::heavy(Inertia::from_moments([1.0, 1.0, 0.25])?, Vector3::new(0.0, 0.0, 2.0))?;
/// let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
/// let start = top.state(tilted, Vector3::new(0.0, 0.0, 20.0))?;
/// let end = Run::new(&KickFirst, &top, &start, 0.001)?.advance_to(1000)?;
/// assert!(end.worst.of(Conserved::MomentumZ).is_some_and(|error| error < 1e-13));
/// # Ok::<(), polhode::Error>(())
/// ```
pub trait Method<S: Real> {
    /// The map for one duration, with everything that does not change from step to step worked out.
    type Map<F: Field<S>>: Map<S>;

    /// The map for the duration `h` (s, may be negative), a body with the constants `rotor` and the field `field`.
    fn map<F: Field<S>>(&self, h: Dd, rotor: &Rotor, field: &F) -> Self::Map<F>;

    /// The maps for one body and any duration, with everything that does not change from one to another worked out once.
    fn maps<F: Field<S>>(&self, rotor: &Rotor, field: &F) -> impl Fn(Dd) -> Self::Map<F> {
        |h| self.map(h, rotor, field)
    }

    /// The map for free motion by `scheme`, where that takes fewer flows than the maps of the scheme one after another.
    fn free_map<F: Field<S>>(&self, _: &Scheme, _: Dd, _: &Rotor, _: &F) -> Option<Self::Map<F>> {
        None
    }

    /// The map for a body with `wheels`, besides which `field` acts. It moves the momentum of body and wheels together. `None`, the
    /// default, where [`map`](Self::map) takes wheels as one of the torques of its field, and moves the momentum I ω of the carrier.
    fn wheel_map<F: Field<S>>(&self, _: Dd, _: &Rotor, _: &F, _: &Wheels) -> Option<Box<dyn Map<S>>>
    where
        S: Precise,
    {
        None
    }
}

/// One map Φ_h.
///
/// Where a symmetric map begins and ends with the same flow, Φ_h = P(h/2) M P(h/2), the last P of a step and the first of
/// the next are one: [`open`](Self::open) takes P(h/2), each [`advance`](Self::advance) M and then P(h), and
/// [`close`](Self::close) takes P(−h/2) back.
///
/// ```
/// use polhode::body::{Body, Free, Time};
/// use polhode::inertia::Inertia;
/// use polhode::method::{Dmv, Map, Method};
/// use polhode::num::{Dd, Precise, Real};
/// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
/// let start = body.state(Default::default(), [0.4, 1.0, -0.3].into())?;
/// let mut x = body.enter(&start)?.to_f64();
/// Dmv.map(Dd::of(0.1), &body.rotor(), &Free).apply(Time::from_seconds(0.0), &mut x);
/// assert!((body.leave(&x).momentum_space() - start.momentum_space()).norm() < 1e-15);
/// # Ok::<(), polhode::Error>(())
/// ```
pub trait Map<S: Real>: Send + 'static {
    /// x ← Φ_h(x), from the time `at` on. Cannot fail; an implicit map keeps its worst residual instead.
    fn apply(&mut self, at: Time, x: &mut Point<S>);

    /// Before the first step: takes a state to the form in which [`advance`](Self::advance) moves it.
    #[inline]
    fn open(&mut self, _at: Time, _x: &mut Point<S>) {}

    /// One step in that form.
    #[inline]
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        self.apply(at, x);
    }

    /// `n` steps in that form, which are counted.
    #[doc(hidden)]
    #[inline]
    fn advance_by(&mut self, n: u64, clock: &Clock, x: &mut Point<S>) {
        for _ in 0..n {
            self.advance(clock.at(x.steps()), x);
            x.count_steps(1);
        }
    }

    /// As [`Step::fill`].
    #[doc(hidden)]
    #[inline]
    fn fill(&mut self, clock: &Clock, x: &mut Point<S>, block: &mut [Point<S>]) {
        fill_in_turn(self, clock, x, block);
    }

    /// Takes that form to one with the energy and the momenta of the state, from which it differs by no more than a turn
    /// about the momentum.
    #[inline]
    fn close(&mut self, _at: Time, _x: &mut Point<S>) {}

    /// Takes that turn, of the time `elapsed` (s) since [`open`](Self::open).
    fn synchronize(&self, _elapsed: Dd, _x: &mut Point<S>) {}

    /// What [`advance`](Self::advance) needs to know besides the point, for a map whose form is not of the time of its step:
    /// as many numbers at any time, finite, the time that it is of among them. Empty for all others.
    fn memory(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Takes the map back, or on, to where its [`memory`](Self::memory) was `memory`; the point has to be the one of then.
    fn remember(&mut self, _memory: &[f64]) {}

    /// The time since the start (s) that the point is of between outputs, of a map that chooses its steps; `None` of all others.
    fn base(&self) -> Option<Dd> {
        None
    }

    /// Takes the steps of a map that chooses them up to the last that ends by `until`, which is not before the
    /// [base](Self::base), and gives the state at `until`, by the dense output of the next one.
    fn dense(&mut self, _until: Time, x: &mut Point<S>) -> Point<S> {
        *x
    }

    /// How many bodies take the steps of [`advance`](Self::advance) side by side, of a map that has been opened; `None` where
    /// each takes them alone.
    fn side_by_side(&self) -> Option<SideBySide<S>> {
        None
    }

    /// As [`side_by_side`](Self::side_by_side), of [`apply`](Self::apply), for a map that is a part of another.
    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        None
    }

    /// The worst relative residual at which an implicit solve ended; 0 for explicit maps.
    fn worst_residual(&self) -> f64 {
        0.0
    }

    /// What the steps that a map chooses have cost since it was made; `None` where steps are as given.
    fn work(&self) -> Option<Work> {
        None
    }

    /// Why a map that chooses its steps cannot go on: the state that it leaves then is not finite.
    fn stuck(&self) -> Option<Stuck> {
        None
    }
}

impl<S: Real> Map<S> for Box<dyn Map<S>> {
    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        (**self).apply(at, x);
    }
    fn open(&mut self, at: Time, x: &mut Point<S>) {
        (**self).open(at, x);
    }
    fn advance(&mut self, at: Time, x: &mut Point<S>) {
        (**self).advance(at, x);
    }
    fn advance_by(&mut self, n: u64, clock: &Clock, x: &mut Point<S>) {
        (**self).advance_by(n, clock, x);
    }
    fn fill(&mut self, clock: &Clock, x: &mut Point<S>, block: &mut [Point<S>]) {
        (**self).fill(clock, x, block);
    }
    fn close(&mut self, at: Time, x: &mut Point<S>) {
        (**self).close(at, x);
    }
    fn synchronize(&self, elapsed: Dd, x: &mut Point<S>) {
        (**self).synchronize(elapsed, x);
    }
    fn memory(&self) -> Vec<f64> {
        (**self).memory()
    }
    fn remember(&mut self, memory: &[f64]) {
        (**self).remember(memory);
    }
    fn base(&self) -> Option<Dd> {
        (**self).base()
    }
    fn dense(&mut self, until: Time, x: &mut Point<S>) -> Point<S> {
        (**self).dense(until, x)
    }
    fn side_by_side(&self) -> Option<SideBySide<S>> {
        (**self).side_by_side()
    }
    fn part_side_by_side(&self) -> Option<SideBySide<S>> {
        (**self).part_side_by_side()
    }
    fn worst_residual(&self) -> f64 {
        (**self).worst_residual()
    }
    fn work(&self) -> Option<Work> {
        (**self).work()
    }
    fn stuck(&self) -> Option<Stuck> {
        (**self).stuck()
    }
}

/// [`Map::fill`] step by step. The point is one's own, so that what is inlined keeps it in registers: a copy of one that has just been
/// written has to wait for it, and the next step with it.
#[inline(always)]
pub(in crate::method) fn fill_in_turn<S: Real, M: Map<S> + ?Sized>(
    map: &mut M,
    clock: &Clock,
    x: &mut Point<S>,
    block: &mut [Point<S>],
) {
    let mut moved = *x;
    for place in block {
        map.advance_by(1, clock, &mut moved);
        *place = moved;
        map.close(clock.at(moved.steps()), place);
    }
    *x = moved;
}

/// An implicit solve that ends further than this from its equation, relative, is no solution: the invariants would be
/// lost by as much in every step. Rounding alone leaves about 1e-16.
pub(crate) const SOLVED: f64 = 1e-13;

/// What the steps that a map chooses have cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Work {
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Steps that were accepted.
    pub accepted: u64,
    /// Steps that were tried and rejected.
    pub rejected: u64,
}

impl core::ops::Add for Work {
    type Output = Work;
    fn add(self, more: Work) -> Work {
        Work {
            evaluations: self.evaluations + more.evaluations,
            accepted: self.accepted + more.accepted,
            rejected: self.rejected + more.rejected,
        }
    }
}

/// Where no step that a map can choose has an error within its tolerance, or those that have are too short.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Stuck {
    /// When, s.
    pub time: f64,
    /// The last step tried, s.
    pub step: f64,
    /// The error estimate of the last step tried, in units of the tolerance; `None` where it is not finite or not known.
    pub estimate: Option<f64>,
    /// How many steps like those so far one step of the run would take, where these are too many: above 1e10.
    pub needed: Option<f64>,
}

/// Whole steps, counted and timed: what the dynamic outside sees of a [`Map`], with one virtual call for many steps.
///
/// [`steps`](Self::steps) takes a state to a state. A long run is [opened](Self::open) once, [advanced](Self::advance) in
/// pieces and [read](Self::reading) between them: so its bits do not depend on where it was read.
pub trait Step<S: Real>: Send {
    /// Takes a state to the form in which [`advance`](Self::advance) moves it.
    fn open(&mut self, x: &mut Point<S>);

    /// The same of a state of the time `at`, of a map that chooses its steps; all others begin with whole steps.
    fn open_at(&mut self, at: Time, x: &mut Point<S>);

    /// Takes `n` steps in that form.
    fn advance(&mut self, x: &mut Point<S>, n: u64);

    /// The state behind that form.
    fn reading(&mut self, x: &Point<S>) -> Point<S>;

    /// Takes as many steps in that form as `block` has places. Leaves in each a point with the energy and the momenta of
    /// the state after its step, whose attitude may differ by a turn about the momentum.
    fn fill(&mut self, x: &mut Point<S>, block: &mut [Point<S>]);

    /// As [`Map::memory`]: to come back to a point, its memory has to be kept beside it.
    fn memory(&self) -> Vec<f64>;

    /// As [`Map::remember`].
    fn remember(&mut self, memory: &[f64]);

    /// As [`Map::apply`]: from a state to a state, without counting a step.
    fn apply(&mut self, at: Time, x: &mut Point<S>);

    /// As [`Map::base`].
    fn base(&self) -> Option<Dd>;

    /// As [`Map::dense`].
    fn dense(&mut self, until: Time, x: &mut Point<S>) -> Point<S>;

    /// As [`Map::side_by_side`].
    fn side_by_side(&self) -> Option<SideBySide<S>>;

    /// As [`Map::worst_residual`].
    fn worst_residual(&self) -> f64;

    /// As [`Map::work`].
    fn work(&self) -> Option<Work>;

    /// As [`Map::stuck`].
    fn stuck(&self) -> Option<Stuck>;

    /// Why steps cannot be taken from the state that was [opened](Self::open), or why there is no [reading](Self::reading); the state is not
    /// finite then.
    fn refusal(&self) -> Option<&PhaseError> {
        None
    }

    /// Whether readings lie so far from the states of the steps that what is counted along these, as flips, is not that of readings.
    fn takes_back(&self) -> bool {
        false
    }

    /// Takes `n` steps, from a state to a state.
    fn steps(&mut self, x: &mut Point<S>, n: u64) {
        if n > 0 {
            self.open(x);
            self.advance(x, n);
            *x = self.reading(x);
        }
    }
}

/// A map that is applied step by step.
#[derive(Clone, Debug)]
pub(super) struct Stepper<M> {
    map: M,
    clock: Clock,
    opened: u64, // steps taken when the map was opened
}

impl<M> Stepper<M> {
    pub(super) fn new(map: M, clock: Clock) -> Self {
        Stepper { map, clock, opened: 0 }
    }
}

impl<S: Real, M: Map<S>> Step<S> for Stepper<M> {
    fn open(&mut self, x: &mut Point<S>) {
        self.open_at(self.clock.at(x.steps()), x);
    }

    fn open_at(&mut self, at: Time, x: &mut Point<S>) {
        self.opened = x.steps();
        self.map.open(at, x);
    }

    fn advance(&mut self, x: &mut Point<S>, n: u64) {
        self.map.advance_by(n, &self.clock, x);
    }

    fn reading(&mut self, x: &Point<S>) -> Point<S> {
        let mut x = *x;
        self.map.close(self.clock.at(x.steps()), &mut x);
        self.map.synchronize(self.clock.elapsed(x.steps()) - self.clock.elapsed(self.opened), &mut x);
        x
    }

    fn fill(&mut self, x: &mut Point<S>, block: &mut [Point<S>]) {
        self.map.fill(&self.clock, x, block);
    }

    fn memory(&self) -> Vec<f64> {
        self.map.memory()
    }

    fn remember(&mut self, memory: &[f64]) {
        self.map.remember(memory);
    }

    fn apply(&mut self, at: Time, x: &mut Point<S>) {
        self.map.apply(at, x);
    }

    fn base(&self) -> Option<Dd> {
        self.map.base()
    }

    fn dense(&mut self, until: Time, x: &mut Point<S>) -> Point<S> {
        self.map.dense(until, x)
    }

    fn side_by_side(&self) -> Option<SideBySide<S>> {
        self.map.side_by_side()
    }

    fn worst_residual(&self) -> f64 {
        self.map.worst_residual()
    }

    fn work(&self) -> Option<Work> {
        self.map.work()
    }

    fn stuck(&self) -> Option<Stuck> {
        self.map.stuck()
    }
}
