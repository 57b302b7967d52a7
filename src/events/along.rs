//! The search along a motion, from look to look.

use super::bracket::{Place, minimum, root};
use super::event::{Bound, Direction};
use super::{Event, EventError};
use crate::body::State;
use crate::num::{Dd, Precise};

/// Most looks of one search.
pub(crate) const MOST_LOOKS: f64 = 1e10;

/// Between looks a closed form is divided so many times in two, where the bound of a rate does not exclude an event.
const DIVISIONS: u32 = 12;

/// After so many of them a change of sign is one crossing.
const SIMPLE: u32 = 6;

/// A least value of at most this share of its surroundings is zero.
const TOUCHES: f64 = 1e-12;

/// Values on both sides of a root that differ by this share of those at the ends of the interval are those of a jump.
const JUMP: f64 = 1e-6;

/// The share of an interval over which its slope is taken at the ends.
const SLOPE: f64 = 1.0 / 1024.0;

/// How a function passes zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Crossing {
    /// It is zero at the beginning, or what [lasts](Event::when) is the case there already.
    AtStart,
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
    /// It comes to zero and turns back.
    Touching,
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Occurrence {
    /// Which of the events, counted from 0.
    pub event: usize,
    /// How.
    pub crossing: Crossing,
    /// When, s.
    pub time: Dd,
    /// The state then, body axes.
    pub state: State,
}

/// What happened, and what may have been missed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Events {
    /// What happened, by time.
    pub found: Vec<Occurrence>,
    /// The events, counted from 0, that may have happened twice between two looks without being seen.
    pub may_miss: Vec<usize>,
    /// Time between looks, s.
    pub spacing: f64,
    /// How often a state was looked at.
    pub looks: u64,
}

/// A state and what the events say of it.
#[derive(Clone, Debug)]
struct Look {
    time: Dd,
    values: Vec<f64>,
}

/// What a motion changes by at most.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rates {
    /// |ω|, rad/s.
    pub(crate) speed: f64,
    /// |dω/dt| in the body, rad/s².
    pub(crate) acceleration: f64,
}

/// A search for `events`, look by look.
pub(crate) struct Search<'a> {
    events: &'a [Event],
    /// What g changes by at most in a second, of each event.
    pub(super) bounds: Vec<Option<f64>>,
    /// The last look.
    last: Option<Look>,
    /// Of each event the sign that counts, 0 where none is known.
    signs: Vec<f64>,
    /// Of each event what is zero to rounding, at the last look.
    noise: Vec<f64>,
    /// Of each event the largest change between two looks.
    changes: Vec<f64>,
    pub(crate) found: Vec<Occurrence>,
    looks: u64,
}

/// The states of a motion, by their time.
pub(crate) type States<'s, E> = dyn FnMut(Dd) -> Result<State, E> + 's;

impl<'a> Search<'a> {
    /// Of a motion with `rates`, where they are known.
    pub(crate) fn new(events: &'a [Event], rates: Option<Rates>) -> Self {
        let bound = |event: &Event| match (event.bound, rates) {
            (Bound::PerRadian(k), Some(rates)) => Some(k * rates.speed),
            (Bound::PerRate(k), Some(rates)) => Some(k * rates.acceleration),
            (Bound::PerSecond(k), Some(_)) => Some(k),
            _ => None,
        };
        Search {
            events,
            bounds: events.iter().map(bound).collect(),
            last: None,
            signs: vec![0.0; events.len()],
            noise: vec![0.0; events.len()],
            changes: vec![0.0; events.len()],
            found: Vec::new(),
            looks: 0,
        }
    }

    /// Whether an event that ends the search has happened.
    pub(crate) fn has_ended(&self) -> bool {
        self.found.last().is_some_and(|last| self.events[last.event].stops)
    }

    /// All that was found, by looks of `spacing` s.
    pub(crate) fn finish(self, spacing: f64) -> Events {
        let may_miss = (0..self.events.len()).filter(|&n| self.bounds[n].is_none()).collect();
        Events { found: self.found, may_miss, spacing, looks: self.looks }
    }

    /// The first look, at the beginning.
    pub(crate) fn begin<E: From<EventError>>(&mut self, time: Dd, state: &State) -> Result<(), E> {
        let look = self.look(time, state)?;
        for (n, &value) in look.values.iter().enumerate() {
            self.signs[n] = sign(value, self.noise[n]);
            if self.signs[n] == 0.0 || (self.events[n].lasts && value > 0.0) {
                self.found.push(Occurrence { event: n, crossing: Crossing::AtStart, time, state: *state });
            }
        }
        // one that ends the search comes last
        self.found.sort_by_key(|found| self.events[found.event].stops);
        self.last = Some(look);
        Ok(())
    }

    /// The next look, at `time`, where the state is `state`; `states` gives those since the last one.
    pub(crate) fn go_on<E: From<EventError>>(
        &mut self,
        time: Dd,
        state: &State,
        states: &mut States<'_, E>,
    ) -> Result<(), E> {
        let look = self.look(time, state)?;
        let Some(before) = self.last.replace(look.clone()) else { return Ok(()) };
        let first = self.found.len();
        // what was found before an error is put in order too
        let ended = (0..self.events.len()).try_for_each(|n| {
            let span = (look.time - before.time).to_f64();
            let (a, b) =
                (Place { u: 0.0, value: before.values[n] }, Place { u: span, value: look.values[n] });
            self.changes[n] = self.changes[n].max((b.value - a.value).abs());
            self.between(n, before.time, (a, b), DIVISIONS, states)
        });
        self.found[first..].sort_by(|a, b| {
            let order = a.time.partial_cmp(&b.time).unwrap_or(core::cmp::Ordering::Equal);
            order.then(self.events[a.event].stops.cmp(&self.events[b.event].stops))
        });
        if let Some(end) = (first..self.found.len()).find(|&n| self.events[self.found[n].event].stops) {
            self.found.truncate(end + 1);
        }
        ended
    }

    fn look(&mut self, time: Dd, state: &State) -> Result<Look, EventError> {
        self.looks += 1;
        for (noise, event) in self.noise.iter_mut().zip(self.events) {
            *noise = event.noise(time.to_f64(), state);
        }
        let values = self.events.iter().map(|event| value(event, time, state));
        Ok(Look { time, values: values.collect::<Result<_, _>>()? })
    }

    /// Looks for the event `n` between the places `a` and `b`, in s from `base` on.
    fn between<E: From<EventError>>(
        &mut self,
        n: usize,
        base: Dd,
        (a, b): (Place, Place),
        divisions: u32,
        states: &mut States<'_, E>,
    ) -> Result<(), E> {
        let event = &self.events[n];
        let mut looks = 0;
        let mut at = |u: f64| -> Result<f64, E> {
            looks += 1;
            let time = base + u;
            Ok(value(event, time, &states(time)?)?)
        };
        if let Bound::PerSecond(rate) = event.bound {
            let (change, allowed) = ((b.value - a.value).abs(), rate * (b.u - a.u));
            if change > allowed * (1.0 + 1e-6) + 1e-12 * (a.value.abs() + b.value.abs()) {
                let (time, within) = ((base + b.u).to_f64(), b.u - a.u);
                let event = event.name().into();
                return Err(EventError::FasterThanStated { event, time, within, change, allowed }.into());
            }
        }
        let (known, noise) = (self.signs[n], self.noise[n]);
        let is_zero = |place: Place| sign(place.value, noise) == 0.0;
        let crosses = sign(b.value, noise) * known < 0.0;
        if let Some(bound) = self.bounds[n] {
            let excluded = !crosses && !is_zero(b) && a.value.abs() + b.value.abs() > bound * (b.u - a.u);
            if excluded {
                return Ok(());
            }
            let least = if crosses { DIVISIONS - SIMPLE } else { 0 };
            if divisions > least {
                let u = 0.5 * (a.u + b.u);
                let middle = Place { u, value: at(u)? };
                self.looks += looks;
                self.between(n, base, (a, middle), divisions - 1, states)?;
                return self.between(n, base, (middle, b), divisions - 1, states);
            }
        }
        if crosses {
            // where the last looks were zero it left zero in this interval, also where rounding has the sign of b already
            let (left, right) = if a.value.signum() == b.value.signum() && a.value != 0.0 {
                (a, a)
            } else {
                root(a, b, &mut at)?
            };
            let jump = (right.value - left.value).abs();
            if !event.jumps && jump > noise.max(JUMP * (a.value.abs() + b.value.abs())) {
                let (event, time) = (event.name().into(), (base + right.u).to_f64());
                let (before, after) = (left.value, right.value);
                return Err(EventError::NotContinuous { event, time, before, after }.into());
            }
            self.looks += looks;
            // of a jump the place behind it, where the condition holds
            let place = if event.jumps || right.value.abs() < left.value.abs() { right } else { left };
            self.signs[n] = b.value.signum();
            let crossing = if b.value > 0.0 { Crossing::Rising } else { Crossing::Falling };
            return self.happened(n, crossing, base + place.u, states);
        }
        if known == 0.0 {
            self.signs[n] = sign(b.value, noise);
            return Ok(());
        }
        // it may come to zero and turn back in between, or at a look
        let near = a.value.abs().min(b.value.abs()) <= self.changes[n];
        if event.jumps || !near || is_zero(a) && is_zero(b) {
            return Ok(());
        }
        if is_zero(a) {
            self.looks += looks;
            return self.happened(n, Crossing::Touching, base + a.u, states);
        }
        let width = SLOPE * (b.u - a.u);
        let falls = known * (at(a.u + width)? - a.value) < 0.0;
        if !(falls && known * (b.value - at(b.u - width)?) > 0.0) {
            self.looks += looks;
            return Ok(());
        }
        // raised by what is zero to rounding, so that it goes on beyond that
        let least = minimum(a, b, |u| at(u).map(|value| known * value + noise))?;
        let value = least.value - noise;
        self.looks += looks;
        if least.value < 0.0 {
            let there = Place { u: least.u, value: known * value };
            self.between(n, base, (a, there), 0, states)?;
            return self.between(n, base, (there, b), 0, states);
        }
        // beside a look that is zero it is this look
        if !is_zero(b) && value <= noise.max(TOUCHES * a.value.abs().max(b.value.abs())) {
            return self.happened(n, Crossing::Touching, base + least.u, states);
        }
        Ok(())
    }

    fn happened<E: From<EventError>>(
        &mut self,
        event: usize,
        crossing: Crossing,
        time: Dd,
        states: &mut States<'_, E>,
    ) -> Result<(), E> {
        let counts = match self.events[event].direction {
            Direction::Both => true,
            Direction::Rising => crossing == Crossing::Rising,
            Direction::Falling => crossing == Crossing::Falling,
        };
        if counts {
            self.found.push(Occurrence { event, crossing, time, state: states(time)? });
        }
        Ok(())
    }
}

fn value(event: &Event, time: Dd, state: &State) -> Result<f64, EventError> {
    let t = time.to_f64();
    let value = event.value(t, state);
    if value.is_nan() {
        Err(EventError::NotANumber { event: event.name().into(), time: t })
    } else {
        Ok(value)
    }
}

/// −1, 0 or 1; 0 too where rounding makes so much of zero.
fn sign(value: f64, noise: f64) -> f64 {
    if value.abs() <= noise { 0.0 } else { value.signum() }
}

/// How many intervals of at most `spacing` s lead from `from` to `to`, s.
pub(crate) fn intervals(from: f64, to: f64, spacing: f64) -> Result<u64, EventError> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(EventError::Spacing { spacing });
    }
    // a NaN is no end either
    if !(to > from && (to - from).is_finite()) {
        return Err(EventError::NotAscending { from, to });
    }
    let looks = ((to - from) / spacing).ceil();
    if looks > MOST_LOOKS { Err(EventError::TooMany { looks, spacing }) } else { Ok(looks as u64) }
}
