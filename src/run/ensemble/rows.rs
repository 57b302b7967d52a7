//! The rows of some members at all times.

use nalgebra::Vector3;

use super::{MemberError, Observed};
use crate::body::{Body, Exit, Phase, State};
use crate::observe::Errors;
use crate::rotation::{Quat, Vec3};

/// States of neighbouring members at every time that was asked for.
#[derive(Clone, Debug)]
#[must_use]
pub struct Rows {
    first: usize,
    members: usize,
    times: usize,
    // all in the order of the times, and for each in that of the members
    states: Vec<State>,
    omegas: Vec<Vector3<f64>>,
    errors: Vec<Errors>,
    attitude_errors: Vec<f64>,
    failures: Vec<Failure>,
}

/// From which time on a member has no state.
#[derive(Clone, Debug)]
struct Failure {
    member: usize,
    time: usize,
    error: MemberError,
}

/// In the place of a state.
const NO_STATE: State = State { attitude: Quat { w: 0.0, v: Vec3([0.0; 3]) }, momentum_body: Vec3([0.0; 3]) };

/// What reads points of one member.
pub(super) struct Reading {
    exit: Exit<f64>,
    inverse_moments: Vec3<f64>,
}

impl Reading {
    pub(super) fn of(body: &Body) -> Self {
        Reading { exit: Exit::of(body), inverse_moments: body.rotor().inverse_moments() }
    }
}

impl Rows {
    /// Empty ones of `members` members from number `first` on.
    pub(super) fn new(first: usize, members: usize, times: usize, observed: Observed) -> Self {
        let count = members * times;
        let room = |observed: bool| if observed { count } else { 0 };
        Rows {
            first,
            members,
            times,
            states: vec![NO_STATE; count],
            omegas: vec![Vector3::zeros(); count],
            errors: vec![Errors::NONE; room(observed.invariants)],
            attitude_errors: vec![f64::INFINITY; room(observed.attitude)],
            failures: Vec::new(),
        }
    }

    /// Writes the row of the `member`-th of these members at the `time`-th time; whether all of it is finite.
    ///
    /// Inline so that the point stays in registers: written to memory number by number and read in pairs it would wait.
    #[inline(always)]
    pub(super) fn set(&mut self, member: usize, time: usize, reading: &Reading, x: Phase<f64>) -> bool {
        let state = reading.exit.state(x);
        let omega = reading.exit.omega(reading.inverse_moments, x.momentum_body);
        let (q, m) = (state.attitude, state.momentum_body);
        // without branches: zero times a number is zero, unless it is infinite or none
        let zero = (0.0 * q.w + 0.0 * q.v[0]) + (0.0 * q.v[1] + 0.0 * q.v[2]);
        let zero = zero + (0.0 * m[0] + 0.0 * m[1]) + (0.0 * m[2] + 0.0 * omega[0]);
        let finite = zero + (0.0 * omega[1] + 0.0 * omega[2]) == 0.0;
        if finite {
            let place = time * self.members + member;
            (self.states[place], self.omegas[place]) = (state, omega);
        }
        finite
    }

    pub(super) fn set_errors(&mut self, member: usize, time: usize, errors: Errors) {
        self.errors[time * self.members + member] = errors;
    }

    pub(super) fn set_attitude_error(&mut self, member: usize, time: usize, angle: f64) {
        self.attitude_errors[time * self.members + member] = angle;
    }

    /// The `member`-th of these members has no state from the `time`-th time on.
    pub(super) fn fail(&mut self, member: usize, time: usize, error: MemberError) {
        for place in (time..self.times).map(|time| time * self.members + member) {
            self.states[place] = NO_STATE;
            self.omegas[place] = Vector3::zeros();
            if let Some(errors) = self.errors.get_mut(place) {
                *errors = Errors::NONE;
            }
            if let Some(angle) = self.attitude_errors.get_mut(place) {
                *angle = f64::INFINITY;
            }
        }
        self.failures.push(Failure { member: self.first + member, time, error });
    }

    /// Number of the first of these members.
    #[must_use]
    pub fn first(&self) -> usize {
        self.first
    }

    /// How many members these are.
    #[must_use]
    pub fn members(&self) -> usize {
        self.members
    }

    /// How many times there are.
    #[must_use]
    pub fn times(&self) -> usize {
        self.times
    }

    /// States of the members at the `time`-th time, body axes; zeros where a member has [failed](Self::failures), and nothing
    /// where there are not so many times.
    pub fn states(&self, time: usize) -> &[State] {
        self.states.get(self.place(time)).unwrap_or_default()
    }

    /// Angular velocities in body axes, rad/s; zeros where a member has failed.
    #[must_use]
    pub fn omegas(&self, time: usize) -> &[Vector3<f64>] {
        self.omegas.get(self.place(time)).unwrap_or_default()
    }

    /// Relative errors of the invariants; `None` where they were not [observed](super::Ensemble::observing). All empty where a
    /// member has failed.
    #[must_use]
    pub fn errors(&self, time: usize) -> Option<&[Errors]> {
        self.errors.get(self.place(time))
    }

    /// Angles to the exact attitude, rad; `None` where they were not observed, infinite where there is no closed form or the
    /// member has failed.
    #[must_use]
    pub fn attitude_errors(&self, time: usize) -> Option<&[f64]> {
        self.attitude_errors.get(self.place(time))
    }

    /// Members that have no state from some time on: the number of the member in the ensemble, that of the time, and why;
    /// ascending.
    pub fn failures(&self) -> impl Iterator<Item = (usize, usize, &MemberError)> {
        self.failures.iter().map(|failure| (failure.member, failure.time, &failure.error))
    }

    /// Whether the member with the number `member` in the ensemble has a state at the `time`-th time.
    #[must_use]
    pub fn has(&self, member: usize, time: usize) -> bool {
        let failure = self.failures.binary_search_by_key(&member, |failure| failure.member);
        failure.map_or(true, |place| time < self.failures[place].time)
    }

    /// Brings failures into the order of the members.
    pub(super) fn sorted(mut self) -> Self {
        self.failures.sort_by_key(|failure| failure.member);
        self
    }

    /// Where the rows of a time are; of one that there is not, behind all.
    fn place(&self, time: usize) -> core::ops::Range<usize> {
        let time = time.min(self.times);
        time * self.members..(time + 1) * self.members
    }
}
