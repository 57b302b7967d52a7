//! What a program is compared with: states of the record by a reading, in the frame of its columns.

use super::program::{Dynamics, Program, Turn};
use super::rows::Windows;
use super::shape::Look;
use super::{Attitudes, Frame, Reading, Trajectory};
use crate::rotation::{Quat, Vec3};

/// What the angular velocity is read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Rates,
    Momentum,
    Attitude,
}

/// Typical distances between what a program does over a window and what the record has at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Defects {
    /// rad.
    pub(super) attitude: Option<f64>,
    /// Relative to the size of ω.
    pub(super) rates: Option<f64>,
}

/// The share of windows whose defects are at most the typical one: what jumps now and then does not count.
const SHARE: f64 = 0.8;

/// Iterations by which programs are told apart.
const SHOTS: usize = 12;

/// Most for a state that others are compared with: of a flat body that turns by 0.7 rad each one leaves two fifths.
const MOST_SHOTS: usize = 60;

pub(super) struct Columns<'a> {
    pub(super) record: &'a Trajectory,
    pub(super) source: Source,
}

impl<'a> Columns<'a> {
    pub(super) fn new(record: &'a Trajectory) -> Self {
        let source = match (&record.rates, &record.momentum) {
            (Some(_), _) => Source::Rates,
            (None, Some(_)) => Source::Momentum,
            (None, None) => Source::Attitude,
        };
        Columns { record, source }
    }

    /// Whether no row differs from the first in attitude, and none has an angular velocity or momentum.
    pub(super) fn is_at_rest(&self) -> bool {
        let none = |vectors: &Option<Vec<[f64; 3]>>| {
            vectors.as_ref().is_none_or(|vectors| vectors.iter().flatten().all(|x| *x == 0.0))
        };
        let stays =
            |attitude: &Attitudes| (1..attitude.len()).all(|row| attitude.row(row) == attitude.row(0));
        none(&self.record.rates)
            && none(&self.record.momentum)
            && self.record.attitude.as_ref().is_none_or(stays)
    }

    /// Windows that a program is tried on: two in a row where ω is to be found from the attitudes.
    pub(super) fn windows(&self) -> Windows {
        Windows::of(self.record, if self.source == Source::Attitude { 2 } else { 1 })
    }

    /// The frame of ω by `reading`; what is derived is in the body.
    pub(super) fn frame(&self, reading: &Reading) -> Frame {
        match self.source {
            Source::Rates => reading.omega_frame.unwrap_or(Frame::Body),
            Source::Momentum | Source::Attitude => Frame::Body,
        }
    }

    /// ω at `row` in its frame, rad/s.
    fn omega(&self, reading: &Reading, dynamics: &Dynamics, row: usize) -> Option<Vec3<f64>> {
        match self.source {
            Source::Rates => {
                self.record.rates.as_ref().map(|rates| Vec3(rates[row]) * reading.unit_of_rates())
            }
            Source::Momentum => reading.momentum_body(self.record, row).map(|m| dynamics.omega(m)),
            Source::Attitude => None,
        }
    }

    /// How far `turn` leads from the attitudes that the record has, typically, rad, by the angular velocity at the nodes of a
    /// window; `None` without either. Unlike [`defects`](Self::defects) it asks for no equation of motion.
    pub(super) fn kinematic(
        &self,
        reading: &Reading,
        turn: Turn,
        dynamics: &Dynamics,
        windows: &Windows,
        every: usize,
    ) -> Option<f64> {
        let mut found = Vec::new();
        for &start in windows.starts.iter().step_by(every) {
            let mut q = reading.attitude(self.record, start)?;
            let end = start + windows.stride;
            let mut before = self.omega(reading, dynamics, start)?;
            for row in (start + windows.node..=end).step_by(windows.node) {
                let dt = self.record.times[row] - self.record.times[row - windows.node];
                let next = self.omega(reading, dynamics, row)?;
                let by = Quat::exponential((before + next) * (0.5 * dt * turn.factor));
                q = if turn.frame == Frame::Body { q * by } else { by * q };
                before = next;
            }
            found.push(angle_between(q, reading.attitude(self.record, end)?));
        }
        Some(typical(found))
    }

    /// What `program` does over the windows, compared with the record.
    pub(super) fn defects(
        &self,
        reading: &Reading,
        program: &Program,
        dynamics: &Dynamics,
        windows: &Windows,
        every: usize,
    ) -> Defects {
        let (mut attitude, mut rates, mut size) = (Vec::new(), Vec::new(), 0.0);
        for &start in windows.starts.iter().step_by(every) {
            let end = start + windows.stride;
            let (t, next) = (self.record.times[start], self.record.times[end]);
            let q = reading.attitude(self.record, start);
            let before = q.unwrap_or(Quat::identity());
            if self.source == Source::Attitude {
                let last = end + windows.stride;
                let looks = [end, last].map(|row| reading.attitude(self.record, row));
                if let [Some(middle), Some(after)] = looks {
                    let omega = shot(program, dynamics, [t, next], [before, middle], SHOTS);
                    let (_, omega) = dynamics.after(program, t, next - t, before, omega);
                    let dt = self.record.times[last] - next;
                    attitude.push(angle_between(dynamics.after(program, next, dt, middle, omega).0, after));
                }
                continue;
            }
            let omegas = [start, end].map(|row| self.omega(reading, dynamics, row));
            let [Some(omega), Some(wanted)] = omegas else { continue };
            let (turned, moved) = dynamics.after(program, t, next - t, before, omega);
            if let (Some(_), Some(wanted)) = (q, reading.attitude(self.record, end)) {
                attitude.push(angle_between(turned, wanted));
            }
            rates.push((moved - wanted).norm());
            size += omega.norm_squared();
        }
        let size = (size / rates.len().max(1) as f64).sqrt();
        Defects {
            attitude: (!attitude.is_empty()).then(|| typical(attitude)),
            rates: (!rates.is_empty() && size > 0.0).then(|| typical(rates) / size),
        }
    }

    /// The angular velocity at `row`, body axes, with which a program without mistake leads to the attitude `stride` rows later.
    pub(super) fn shot(
        &self,
        reading: &Reading,
        dynamics: &Dynamics,
        row: usize,
        stride: usize,
    ) -> Option<Vec3<f64>> {
        let later = row + stride;
        let times = [row, later].map(|row| self.record.times.get(row).copied().unwrap_or(f64::NAN));
        let ends = [reading.attitude(self.record, row)?, reading.attitude(self.record, later)?];
        Some(shot(&Program::right(Frame::Body), dynamics, times, ends, MOST_SHOTS))
    }

    /// States at the nodes of the windows, in body axes, by `reading`; ω of attitudes alone as their mean change between nodes.
    pub(super) fn looks(&self, reading: &Reading, windows: &Windows) -> Vec<Vec<Look>> {
        let at = |row: usize| -> Option<Look> {
            let time = self.record.times[row];
            let attitude = reading.attitude(self.record, row);
            match &self.record.rates {
                Some(rates) => {
                    let omega = Vec3(rates[row]) * reading.unit_of_rates();
                    let in_space = reading.omega_frame == Some(Frame::Space);
                    let omega = if in_space { attitude?.rotate_back(omega) } else { omega };
                    Some(Look { time, attitude, omega })
                }
                None => {
                    let next = (row + windows.node).min(self.record.times.len() - 1);
                    let (a, b) = (attitude?, reading.attitude(self.record, next)?);
                    let dt = self.record.times[next] - time;
                    let turn = (a.conjugate() * b).logarithm();
                    let middle = a * Quat::exponential(turn * 0.5);
                    Some(Look { time: time + 0.5 * dt, attitude: Some(middle), omega: turn * (1.0 / dt) })
                }
            }
        };
        windows
            .starts
            .iter()
            .map(|&start| (start..=start + windows.stride).step_by(windows.node).filter_map(at).collect())
            .collect()
    }
}

/// The angular velocity with which `program` leads from the first attitude to the second, body axes, after `most` iterations at most.
fn shot(
    program: &Program,
    dynamics: &Dynamics,
    [t, next]: [f64; 2],
    [from, to]: [Quat<f64>; 2],
    most: usize,
) -> Vec3<f64> {
    let dt = next - t;
    let mut omega = (from.conjugate() * to).logarithm() * (1.0 / dt);
    let mut before = f64::INFINITY;
    for n in 0..most {
        let (reached, _) = dynamics.after(program, t, dt, from, omega);
        // what is missing, turned into the axes of the start
        let missing = from.rotate_back(reached.rotate((reached.conjugate() * to).logarithm()));
        // on a way that is too long for it, the iteration leads away
        if n >= SHOTS && missing.magnitude() >= before {
            break;
        }
        before = missing.magnitude();
        omega = omega + missing * (1.0 / dt);
        if before < 1e-12 {
            break;
        }
    }
    omega
}

/// The angle between two attitudes of norm 1, rad.
pub(super) fn angle_between(a: Quat<f64>, b: Quat<f64>) -> f64 {
    (a.conjugate() * b).logarithm().norm()
}

/// What four out of five are at most.
fn typical(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let at = ((values.len() as f64 * SHARE) as usize).min(values.len().saturating_sub(1));
    values.get(at).copied().unwrap_or(f64::INFINITY)
}
