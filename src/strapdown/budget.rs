//! Attitudes with what each is worth.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::error::StrapdownError;
use super::magnus::rotation_vector;
use super::response::{Covariances, Response};
use super::rule::Rule;
use super::stages::{MOST_NODES, Stages, Weighing};
use super::stream::turned;
use super::turn::Turner;
use super::window::{Sample, Window};
use super::{Kind, Sensor, checked};
use crate::rotation::{Quat, Vec3};

/// Errors of one attitude by their causes, rad, and their covariance.
///
/// The truncation is an estimate of the rule's own error, signed and summed along the motion; the others are standard deviations of a
/// component. Where readings are noisy, what noise does to the estimate of the truncation is part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Budget {
    /// Size of the estimated error of the rule: the turns of a richer one, with two samples more and two Magnus series of order 6 an interval, less its own.
    pub truncation: f64,
    /// By the white noise of the readings.
    pub random_walk: f64,
    /// By a constant bias.
    pub bias: f64,
    /// By scale errors of the axes.
    pub scale: f64,
    /// By errors of the time stamps.
    pub stamps: f64,
    /// Covariance of the attitude error by all causes, the truncation as an error of its size: of a rotation vector in space axes, rad².
    pub covariance: Matrix3<f64>,
}

impl Budget {
    /// By the covariances of each cause and the estimated `error` of the rule, in space axes.
    pub(super) fn of(
        error: Vector3<f64>,
        walk: Matrix3<f64>,
        bias: Matrix3<f64>,
        scale: Matrix3<f64>,
        stamps: Matrix3<f64>,
    ) -> Self {
        Budget {
            truncation: error.norm(),
            random_walk: deviation(&walk),
            bias: deviation(&bias),
            scale: deviation(&scale),
            stamps: deviation(&stamps),
            covariance: walk + bias + scale + stamps + error * error.transpose(),
        }
    }

    /// Standard deviation of one component of the attitude error, all causes, rad.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        deviation(&self.covariance)
    }
}

/// Root of the mean variance of the three axes.
fn deviation(covariance: &Matrix3<f64>) -> f64 {
    (covariance.trace() / 3.0).max(0.0).sqrt()
}

/// An attitude with its time and its budget.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Time of the sample, s.
    pub time: f64,
    /// Body to space.
    pub attitude: UnitQuaternion<f64>,
    /// What it is worth, beside the start, which counts as exact.
    pub budget: Budget,
}

impl Estimate {
    /// The error against the attitude `truth`: a rotation vector in space axes, rad.
    #[must_use]
    pub fn error(&self, truth: UnitQuaternion<f64>) -> Vector3<f64> {
        (Quat::from(truth) * Quat::from(self.attitude).conjugate()).logarithm().into()
    }

    /// Whether `truth` is inside the ellipsoid that holds 95 % of the attitudes of this budget, χ² of three degrees of freedom.
    #[must_use]
    pub fn holds(&self, truth: UnitQuaternion<f64>) -> bool {
        let error = self.error(truth);
        // where little but the truncation is in it, an inverse is one of its rounding, and may let any error in
        let root = self.budget.covariance.cholesky();
        root.map_or(error.norm() == 0.0, |root| error.dot(&root.solve(&error)) <= CHI_SQUARED_95)
    }

    /// How far another estimate of the same attitude is from this one, in standard deviations of their difference, as if their errors were
    /// independent: beyond [`CONTRADICTION`](Self::CONTRADICTION) one of both budgets leaves out what matters.
    #[must_use]
    pub fn deviations_from(&self, other: &Estimate) -> f64 {
        let error = self.error(other.attitude);
        match (self.budget.covariance + other.budget.covariance).try_inverse() {
            Some(inverse) => error.dot(&(inverse * error)).max(0.0).sqrt(),
            None if error.norm() == 0.0 => 0.0,
            None => f64::INFINITY,
        }
    }

    /// Deviations that one estimate in ten thousand exceeds by chance: the root of that quantile of χ² of three degrees of freedom.
    pub const CONTRADICTION: f64 = 4.594;

    /// An attitude with a larger standard deviation is lost, rad.
    pub const LOST: f64 = 1.0;
}

/// χ² of three degrees of freedom that 95 % stay below.
const CHI_SQUARED_95: f64 = 7.814_727_903_251_179;

/// As [`Strapdown`](super::Strapdown), with the [`Budget`] of each attitude: the same bits, one sample later, at several times the cost.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::strapdown::{Budgeted, Kind, Rule, Sensor};
/// let sensor = Sensor::default().with_noise(1e-3);
/// let mut budgeted = Budgeted::new(Kind::Rate, Rule::magnus(4, 4)?, UnitQuaternion::identity(), sensor)?;
/// for k in 0..=100 {
///     budgeted.push(0.01 * f64::from(k), Vector3::new(0.0, 0.0, 1.0))?;
/// }
/// let last = budgeted.finish().last().copied().ok_or("there are samples")?;
/// // a random walk of 1e-3 rad/s in each of 100 intervals of 0.01 s
/// assert!((last.budget.random_walk - 1e-4).abs() < 1e-6 && last.budget.truncation < 1e-14);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Budgeted {
    kind: Kind,
    rule: Rule,
    window: Window<f64>,
    turner: Turner<f64>,
    richer: Richer,
    response: Response,
    attitude: Quat<f64>,
    /// Estimated error of the attitude, a rotation vector in space axes.
    error: Vec3<f64>,
    known: usize,
    /// Whether covariances are worked out at the last sample alone.
    at_end: bool,
    ready: Vec<Estimate>,
}

impl Budgeted {
    /// From the attitude `start` at the first sample, for readings of a `sensor`.
    ///
    /// # Errors
    /// As [`Strapdown::new`](super::Strapdown::new); deviations that are negative, or 1e154 and more.
    pub fn new(
        kind: Kind,
        rule: Rule,
        start: UnitQuaternion<f64>,
        sensor: Sensor,
    ) -> Result<Self, StrapdownError> {
        rule.check(kind)?;
        sensor.check()?;
        Ok(Budgeted {
            kind,
            rule,
            window: Window::new(),
            turner: Turner::new(rule, kind),
            richer: Richer::new(rule, kind),
            response: Response::new(kind, sensor),
            attitude: checked::attitude(start.into())?,
            error: Vec3::zero(),
            known: 0,
            at_end: false,
            ready: Vec::with_capacity(MOST_NODES),
        })
    }

    /// The same, for the estimate at the last sample alone, which [`finish`](Self::finish) gives: less work for each sample.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn ending(
        kind: Kind,
        rule: Rule,
        start: UnitQuaternion<f64>,
        sensor: Sensor,
    ) -> Result<Self, StrapdownError> {
        Ok(Budgeted { at_end: true, ..Self::new(kind, rule, start, sensor)? })
    }

    /// As [`Strapdown::push`](super::Strapdown::push).
    ///
    /// # Errors
    /// The same.
    pub fn push(&mut self, time: f64, reading: Vector3<f64>) -> Result<&[Estimate], StrapdownError> {
        let sample = Sample { time, reading: reading.into() };
        checked::sample(self.kind, &sample, self.window.last(), self.window.count())?;
        self.window.push(sample);
        Ok(self.advance(false))
    }

    /// As [`Strapdown::finish`](super::Strapdown::finish).
    pub fn finish(&mut self) -> &[Estimate] {
        self.advance(true)
    }

    fn advance(&mut self, is_over: bool) -> &[Estimate] {
        let count = self.window.count();
        self.ready.clear();
        if self.known == 0 && count > 0 {
            self.known = 1;
            self.give(0, is_over && count == 1);
        }
        while self.known > 0
            && self.known < count
            && (is_over || self.richer.rule.is_ready(self.known - 1, count))
        {
            let k = self.known - 1;
            let range = self.rule.range(k, count);
            let (first, samples) = (range.start, self.window.get(range.clone()));
            let h = samples[k + 1 - first].time - samples[k - first].time;
            let turned_by = self.turner.turn(samples, k - first, k == 0);
            let turn = turned_by.turn;
            self.response.add(self.attitude, &turned_by, h, first, samples.len());
            self.response.settle(first, &self.window);
            self.attitude = turned(self.attitude, turn);
            let range = self.richer.rule.range(k, count);
            let better = self.richer.turn(self.window.get(range.clone()), k - range.start);
            let missing = (turn.conjugate() * better).logarithm();
            self.error = self.error + self.attitude.rotate(missing);
            self.known += 1;
            self.give(k + 1, is_over && k + 2 == count);
        }
        &self.ready
    }

    /// Adds what is known at sample `k`.
    fn give(&mut self, k: usize, is_last: bool) {
        if self.at_end && !is_last {
            return;
        }
        let Covariances { walk, bias, scale, stamps } = self.response.covariances(&self.window);
        let budget = Budget::of(self.error.into(), walk, bias, scale, stamps);
        let time = self.window.get(k..k + 1)[0].time;
        self.ready.push(Estimate { time, attitude: self.attitude.into(), budget });
    }
}

/// The rule that another one is judged by: a polynomial through two samples more, and two Magnus series of order 6 in each interval.
#[derive(Clone, Debug)]
struct Richer {
    rule: Rule,
    kind: Kind,
    halves: [Weighing<f64>; 2],
}

impl Richer {
    fn new(rule: Rule, kind: Kind) -> Self {
        let rule = rule.richer();
        let half = |from: f64| Weighing::with(rule, kind, Stages::gauss(6).within(from, 0.5));
        Richer { rule, kind, halves: [half(0.0), half(0.5)] }
    }

    fn turn(&mut self, samples: &[Sample<f64>], k: usize) -> Quat<f64> {
        let h = samples[k + 1].time - samples[k].time;
        let unit = 0.5 * Stages::unit(self.kind, h);
        let [first, second] = self.halves.each_mut().map(|half| {
            let turn =
                |stages: &Stages<f64>| Quat::exponential(rotation_vector(6, &stages.values(unit, samples)));
            let found = turn(half.stages(samples, k, h, false));
            if found.magnitude().is_finite() { found } else { turn(half.straight(k)) }
        });
        first * second
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 + ε)², (1 − ε)² and 1 − ε² are rounded to 1 + 2ε, 1 − 2ε and 1 with ε = 2⁻²⁷: by the adjugate the determinant is near −2⁻⁵³ in
    /// place of 0, and the first entry of the inverse near 2.
    #[test]
    fn a_budget_of_the_truncation_alone_holds_no_error_across_it() {
        let tiny = 1.0 / f64::from(1 << 27);
        let none = Matrix3::zeros();
        let budget = Budget::of(Vector3::new(1.0, 1.0 + tiny, 1.0 - tiny), none, none, none, none);
        let estimate = Estimate { time: 0.0, attitude: UnitQuaternion::identity(), budget };
        assert!(estimate.holds(UnitQuaternion::identity()));
        assert!(!estimate.holds(Quat::exponential(Vec3::<f64>::unit(0)).into()));
    }
}
