//! How errors of readings turn the attitude: the linear response of a rule, and the covariance that follows.

use nalgebra::{Matrix3, Vector3};

use super::stages::MOST_NODES;
use super::turn::Turned;
use super::window::{KEPT, Window};
use super::{Kind, Sensor};
use crate::rotation::{Quat, Vec3};

/// Places for the responses to readings, of which those in use are neighbours.
const PLACES: usize = 32;
const _: () = assert!(PLACES > KEPT && MOST_NODES < KEPT);

/// How the attitude error, a rotation vector in space axes, depends on each reading, on a bias and on scale errors.
///
/// `δφ = Σ_k ∫ Q(t) δω(t) dt` over the intervals, by the quadrature of the rule itself: a reading j counts
/// `C_j = Σ_k Σ_s share_s Q(t_s) weight_sj h`, summed over all intervals that it serves in. Of independent readings the covariance is
/// σ² Σ_j C_j C_jᵀ; those of a wide polynomial do not just add up where the body turns far between samples.
#[derive(Clone, Debug)]
pub(super) struct Response {
    kind: Kind,
    sensor: Sensor,
    /// C_j of the readings that may serve again, by their number modulo [`PLACES`].
    open: [Matrix3<f64>; PLACES],
    /// The first of these readings.
    first: usize,
    /// One after the last.
    last: usize,
    /// Σ C Cᵀ of the others.
    settled: Matrix3<f64>,
    /// Σ of the squares of what errors of their stamps do.
    settled_stamps: Matrix3<f64>,
    bias: Matrix3<f64>,
    scale: Matrix3<f64>,
}

/// Covariances by cause, space axes, rad².
#[derive(Clone, Copy, Debug)]
pub(super) struct Covariances {
    pub(super) walk: Matrix3<f64>,
    pub(super) bias: Matrix3<f64>,
    pub(super) scale: Matrix3<f64>,
    pub(super) stamps: Matrix3<f64>,
}

impl Response {
    pub(super) fn new(kind: Kind, sensor: Sensor) -> Self {
        let zero = Matrix3::zeros();
        Response {
            kind,
            sensor,
            open: [zero; PLACES],
            first: 0,
            last: 0,
            settled: zero,
            settled_stamps: zero,
            bias: zero,
            scale: zero,
        }
    }

    /// Adds an interval of length `h` that begins with the attitude `q`; its first reading has the number `start`.
    pub(super) fn add(
        &mut self,
        q: Quat<f64>,
        turned: &Turned<'_, f64>,
        h: f64,
        start: usize,
        samples: usize,
    ) {
        let stages = turned.stages;
        let whole = turned.turn.logarithm();
        for s in 0..stages.count {
            let there = matrix(q * Quat::exponential(whole * stages.at[s])) * stages.share[s];
            self.bias += there * h;
            self.scale += there * Matrix3::from_diagonal(&turned.values[s].into());
            let counted = there * turned.unit;
            for (j, weight) in stages.weights[s].iter().enumerate().take(samples) {
                self.open[(start + j) % PLACES] += counted * *weight;
            }
        }
        self.last = self.last.max(start + samples);
    }

    /// Closes the responses to readings before number `first`.
    pub(super) fn settle(&mut self, first: usize, window: &Window<f64>) {
        while self.first < first.min(self.last) {
            let own = self.open[self.first % PLACES];
            self.settled += own * own.transpose();
            if self.sensor.stamps > 0.0 {
                let moved = self.stamp(self.first, window);
                self.settled_stamps += moved * moved.transpose();
            }
            self.open[self.first % PLACES] = Matrix3::zeros();
            self.first += 1;
        }
    }

    /// What an error of the stamp of reading `j` does, rad/s: a rate is read where it has changed by ω̇ δt, an increment ends
    /// later by ω δt, and the next one begins there.
    fn stamp(&self, j: usize, window: &Window<f64>) -> Vector3<f64> {
        let of = |j: usize| self.open[j % PLACES];
        let next = || if j + 1 < self.last { of(j + 1) } else { Matrix3::zeros() };
        // the first reading of increments and averages is of an interval that is not known
        let known = usize::from(self.kind == Kind::Average);
        let high = (j + 2).min(window.count());
        let around = window.get(j.saturating_sub(1).max(known).min(high)..high);
        let (Some(a), Some(b)) = (around.first(), around.last()) else { return Vector3::zeros() };
        let span = b.time - a.time;
        if span <= 0.0 {
            return Vector3::zeros();
        }
        let slope = || Vector3::from(b.reading - a.reading) / span;
        match self.kind {
            Kind::Rate => of(j) * slope(),
            Kind::Average => (of(j) + next()) * slope() * 0.5,
            Kind::Increment => {
                let sum = around.iter().skip(1).fold(Vec3::zero(), |sum, sample| sum + sample.reading);
                (of(j) - next()) * Vector3::from(sum) / span
            }
        }
    }

    /// The covariances so far.
    pub(super) fn covariances(&self, window: &Window<f64>) -> Covariances {
        let square = |x: f64| x * x;
        let (mut walk, mut stamps) = (self.settled, self.settled_stamps);
        for j in self.first..self.last {
            let own = self.open[j % PLACES];
            walk += own * own.transpose();
            if self.sensor.stamps > 0.0 {
                let moved = self.stamp(j, window);
                stamps += moved * moved.transpose();
            }
        }
        Covariances {
            walk: walk * square(self.sensor.noise),
            bias: self.bias * self.bias.transpose() * square(self.sensor.bias),
            scale: self.scale * self.scale.transpose() * square(self.sensor.scale),
            stamps: stamps * square(self.sensor.stamps),
        }
    }
}

fn matrix(q: Quat<f64>) -> Matrix3<f64> {
    let column = |axis: usize| Vector3::from(q.rotate(Vec3::unit(axis)));
    Matrix3::from_columns(&[column(0), column(1), column(2)])
}
