//! The motion that a fit stands for, beside the readings.

use crate::thresholds::motion::{CHANGE, CLOSE, DAMPING, FIRST, GROWTH, PARTS, STEP, STEPS};
use nalgebra::{Matrix3, Vector3};
use polhode::record::{Record, Segment};

use crate::report::estimate::Estimate;
use crate::report::nuisance::Nuisance;
use crate::signal::terms::Terms;

/// One segment of a record, measured and fitted.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct FittedMotion {
    /// Index of the segment in the record.
    pub segment: usize,
    /// Whether each sample was used: spikes were not.
    pub used: Vec<bool>,
    /// Angular velocities at the times of the segment from its readings and what was found of the sensor, rad/s, sensor axes.
    pub measured: Vec<Vector3<f64>>,
    /// The motion of the fitted tensor, torque and wheels nearest to them, rad/s; `None` where none was found.
    pub fitted: Option<Vec<Vector3<f64>>>,
}

impl FittedMotion {
    /// Measured less fitted, rad/s, of the samples that were used; the others are 0.
    pub fn residuals(&self) -> Option<Vec<Vector3<f64>>> {
        let fitted = self.fitted.as_ref()?;
        let left = self.measured.iter().zip(fitted).zip(&self.used);
        Some(left.map(|((a, b), used)| if *used { a - b } else { Vector3::zeros() }).collect())
    }

    /// Root mean square of a component of the residuals, rad/s.
    pub fn rms(&self) -> Option<f64> {
        let count = self.used.iter().filter(|used| **used).count().max(1);
        let sum: f64 = self.residuals()?.iter().map(Vector3::norm_squared).sum();
        Some((sum / (3 * count) as f64).sqrt())
    }
}

impl Estimate {
    /// The motion of the fitted tensor, with its torques and wheels, nearest to each segment of `record` that the fit has
    /// used; `record` is the one that was fitted.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode_fit::{Record, Settings, fit, simulate};
    /// use polhode::{inertia::Inertia, num::Random};
    /// # let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
    /// # let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
    /// # let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3, &mut Random::new(7))?;
    /// let record = Record::from_samples(&times, &rates)?;
    /// let fitted = fit(&record, &Settings::default())?.fitted(&record);
    /// let rates = fitted[0].fitted.as_ref().ok_or("a motion")?;
    /// assert!((rates[0] - Vector3::new(0.3, 1.0, 0.4)).norm() < 1e-3);
    /// assert!(fitted[0].rms().is_some_and(|rms| (rms / 1e-3 - 1.0).abs() < 0.1)); // the noise
    /// # Ok::<(), polhode::Error>(())
    /// ```
    #[must_use]
    pub fn fitted(&self, record: &Record) -> Vec<FittedMotion> {
        let mut sensor = Terms::at(self.shape.tensor());
        add(&self.nuisances, &mut sensor);
        let segments = record.segments.iter().enumerate();
        segments
            .filter(|(k, _)| self.residuals.iter().any(|r| r.segment == *k))
            .map(|(segment, s)| {
                let measured: Vec<Vector3<f64>> = s.rates().iter().map(|w| sensor.rate(w)).collect();
                let mut used = vec![true; measured.len()];
                for spike in self.spikes.iter().filter(|spike| spike.segment == segment) {
                    if let Some(used) = used.get_mut(spike.sample) {
                        *used = false;
                    }
                }
                let law = Law::new(self);
                let fitted = law.and_then(|law| law.nearest(s, &measured, &used));
                FittedMotion { segment, used, measured, fitted }
            })
            .collect()
    }
}

/// What these make of torque and sensor.
fn add<'a>(of: impl IntoIterator<Item = &'a Nuisance>, terms: &mut Terms) {
    for nuisance in of {
        nuisance.column.effect().add_to(terms, nuisance.value);
    }
}

/// p' = p × ω − k J ω − D ω − c |ω| J ω + τ with p = J ω + h, everything over the trace of the tensor.
struct Law {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// k J + D.
    damping: Matrix3<f64>,
    /// c.
    quadratic: f64,
    torque: Vector3<f64>,
    /// Trace of the tensor, kg m², where it is known.
    trace: Option<f64>,
}

/// Momentum of wheels and torque of a record at its samples, over the trace; empty where there is none.
struct Inputs {
    wheel: Vec<Vector3<f64>>,
    torque: Vec<Vector3<f64>>,
}

impl Inputs {
    /// Between samples `i` and the next.
    fn at(&self, i: usize, share: f64) -> (Vector3<f64>, Vector3<f64>) {
        let between = |list: &[Vector3<f64>]| match (list.get(i), list.get(i + 1)) {
            (Some(a), Some(b)) => a + (b - a) * share,
            (Some(a), None) => *a,
            _ => Vector3::zeros(),
        };
        (between(&self.wheel), between(&self.torque))
    }
}

impl Law {
    /// `None` where the tensor has no inverse.
    fn new(e: &Estimate) -> Option<Self> {
        let j = e.shape.tensor();
        let mut terms = Terms::at(j);
        add(&e.torque.coefficients, &mut terms);
        Some(Law {
            j,
            inverse: j.try_inverse()?,
            damping: j * terms.drag + terms.viscous,
            quadratic: terms.quadratic,
            torque: terms.constant,
            trace: e.inertia.as_ref().map(|inertia| inertia.tensor().trace()),
        })
    }

    fn inputs(&self, s: &Segment) -> Inputs {
        let scaled = |list: Option<&[Vector3<f64>]>| match (list, self.trace) {
            (Some(list), Some(trace)) => list.iter().map(|v| v / trace).collect(),
            _ => Vec::new(),
        };
        Inputs { wheel: scaled(s.wheel()), torque: scaled(s.torque()) }
    }

    /// p', and its derivative with respect to p.
    fn slope(
        &self,
        p: &Vector3<f64>,
        (wheel, torque): (Vector3<f64>, Vector3<f64>),
    ) -> (Vector3<f64>, Matrix3<f64>) {
        let w = self.inverse * (p - wheel);
        let size = w.norm();
        let along = if size > 0.0 { w * w.transpose() / size } else { Matrix3::zeros() };
        let damping = self.damping + self.j * (self.quadratic * size);
        let by_rate = damping + self.j * along * self.quadratic;
        let linear = (p.cross_matrix() - by_rate) * self.inverse - w.cross_matrix();
        (self.torque + torque + p.cross(&w) - damping * w, linear)
    }

    /// From sample `i` to the next by the classical Runge–Kutta step, for p and its derivative with respect to the start.
    fn advance(&self, p: &mut Vector3<f64>, s: &mut Matrix3<f64>, time: f64, inputs: &Inputs, i: usize) {
        let speed = (self.inverse * (*p - inputs.at(i, 0.0).0)).norm();
        let parts = (speed * time / STEP).ceil().clamp(1.0, PARTS);
        let h = time / parts;
        for part in 0..parts as usize {
            let at = |share: f64| inputs.at(i, (part as f64 + share) / parts);
            let (p1, l1) = self.slope(p, at(0.0));
            let s1 = l1 * *s;
            let (p2, l2) = self.slope(&(*p + p1 * (0.5 * h)), at(0.5));
            let s2 = l2 * (*s + s1 * (0.5 * h));
            let (p3, l3) = self.slope(&(*p + p2 * (0.5 * h)), at(0.5));
            let s3 = l3 * (*s + s2 * (0.5 * h));
            let (p4, l4) = self.slope(&(*p + p3 * h), at(1.0));
            let s4 = l4 * (*s + s3 * h);
            *p += (p1 + (p2 + p3) * 2.0 + p4) * (h / 6.0);
            *s += (s1 + (s2 + s3) * 2.0 + s4) * (h / 6.0);
        }
    }

    /// The motion from `start`, and the normal equations of its distance from the samples.
    fn shoot(
        &self,
        times: &[f64],
        measured: &[Vector3<f64>],
        used: &[bool],
        inputs: &Inputs,
        start: Vector3<f64>,
    ) -> (Vec<Vector3<f64>>, Matrix3<f64>, Vector3<f64>, f64) {
        let (mut p, mut s) = (self.j * start + inputs.at(0, 0.0).0, self.j);
        let (mut normal, mut gradient, mut sum) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
        let mut rates = Vec::with_capacity(times.len());
        for i in 0..times.len() {
            if i > 0 {
                self.advance(&mut p, &mut s, times[i] - times[i - 1], inputs, i - 1);
            }
            let w = self.inverse * (p - inputs.at(i, 0.0).0);
            let by_start = self.inverse * s;
            rates.push(w);
            if used[i] {
                let left = measured[i] - w;
                normal += by_start.transpose() * by_start;
                gradient += by_start.transpose() * left;
                sum += left.norm_squared();
            }
        }
        (rates, normal, gradient, sum)
    }

    /// By least squares in windows that grow: within the first the motion turns by little, and each start is good enough
    /// for the next.
    fn nearest(&self, s: &Segment, measured: &[Vector3<f64>], used: &[bool]) -> Option<Vec<Vector3<f64>>> {
        let times = s.times();
        let inputs = self.inputs(s);
        let speed = (measured.iter().map(Vector3::norm_squared).sum::<f64>() / measured.len() as f64).sqrt();
        let mut start = measured[used.iter().position(|used| *used)?];
        let mut radius = FIRST / speed;
        loop {
            let count = times.partition_point(|t| *t <= times[0] + radius).max(4).min(times.len());
            let part = (&times[..count], &measured[..count], &used[..count]);
            let (mut rates, mut normal, mut gradient, mut sum) =
                self.shoot(part.0, part.1, part.2, &inputs, start);
            let mut damping = 0.0;
            for _ in 0..STEPS {
                let ridge = Matrix3::identity() * (damping * normal.trace());
                let step = (normal + ridge).cholesky()?.solve(&gradient);
                let next = self.shoot(part.0, part.1, part.2, &inputs, start + step);
                if next.3 < sum {
                    let gain = sum - next.3;
                    start += step;
                    (rates, normal, gradient, sum) = next;
                    damping *= 0.1;
                    if gain < CLOSE * sum {
                        break;
                    }
                } else if step.norm() < CLOSE * speed {
                    break;
                } else {
                    damping = f64::max(CHANGE * damping, DAMPING);
                }
            }
            if count == times.len() {
                return sum.is_finite().then_some(rates);
            }
            radius *= GROWTH;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::simulate;
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    const HERE: Vector3<f64> = Vector3::new(0.3, -0.8, 0.5);

    fn none() -> Inputs {
        Inputs { wheel: Vec::new(), torque: Vec::new() }
    }

    /// Of a body of the tensor `j` on which nothing acts.
    fn free(j: Matrix3<f64>) -> Law {
        let (damping, torque) = (Matrix3::zeros(), Vector3::zeros());
        Law { j, inverse: j.try_inverse().unwrap(), damping, quadratic: 0.0, torque, trace: None }
    }

    fn law() -> Law {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let damping = j * 0.05 + Matrix3::from_diagonal(&Vector3::new(0.01, 0.02, 0.03));
        Law { damping, quadratic: 0.04, torque: Vector3::new(0.01, -0.02, 0.03), ..free(j) }
    }

    /// The change of the momentum is p × ω − D ω − c |ω| J ω + τ, and its derivative that of central differences; at rest nothing brakes.
    #[test]
    fn the_momentum_changes_by_all_that_acts() {
        let (law, wheel, torque) = (law(), Vector3::new(0.1, 0.2, -0.3), Vector3::new(-0.02, 0.01, 0.04));
        let p = law.j * HERE + wheel;
        let (found, by_momentum) = law.slope(&p, (wheel, torque));
        let drag = law.damping * HERE + law.j * HERE * (0.04 * HERE.norm());
        assert!((found - (p.cross(&HERE) - drag + law.torque + torque)).amax() < 1e-14);
        let h = 1e-5;
        for k in 0..3 {
            let moved = |by: f64| law.slope(&(p + Vector3::ith(k, by)), (wheel, torque)).0;
            let difference = (moved(h) - moved(-h)) / (2.0 * h);
            // the third derivatives are of order 10, and h²/6 of them is left
            assert!((difference - by_momentum.column(k)).amax() < 1e-8, "{k}");
        }
        let (at_rest, by_momentum) = law.slope(&wheel, (wheel, torque));
        assert_eq!(at_rest, law.torque + torque);
        let expected = (wheel.cross_matrix() - law.damping) * law.inverse;
        assert!((by_momentum - expected).amax() < 1e-14);
    }

    /// Between two samples what acts changes evenly, at the last one it stays, and where nothing is told it is zero. The trace divides it.
    #[test]
    fn inputs_change_evenly_between_samples() {
        let wheel = vec![Vector3::x() * 8.0, Vector3::y() * 4.0];
        let s = Segment::new("toss", vec![0.0, 1.0], vec![HERE; 2]).unwrap().with_wheel(wheel).unwrap();
        let inputs = Law { trace: Some(4.0), ..law() }.inputs(&s);
        assert_eq!(inputs.wheel, [Vector3::x() * 2.0, Vector3::y()]);
        assert_eq!(inputs.at(0, 0.25), (Vector3::new(1.5, 0.25, 0.0), Vector3::zeros()));
        assert_eq!(inputs.at(1, 0.5), (Vector3::y(), Vector3::zeros()));
        assert_eq!(inputs.at(2, 0.5), (Vector3::zeros(), Vector3::zeros()));
        let pushed = Inputs { torque: inputs.wheel.clone(), ..none() };
        assert_eq!(pushed.at(0, 0.75), (Vector3::zeros(), Vector3::new(0.5, 0.75, 0.0)));
        assert!(law().inputs(&s).wheel.is_empty());
    }

    /// A ball gains the mean of the torques at both ends times the time between them, in however many steps.
    #[test]
    fn a_ball_gains_the_integral_of_the_torque() {
        let law = free(Matrix3::identity() / 3.0);
        let torque = vec![Vector3::x(), HERE, HERE * -3.0];
        let inputs = Inputs { torque: torque.clone(), ..none() };
        let (mut p, mut s) = (HERE, Matrix3::identity());
        law.advance(&mut p, &mut s, 2.5, &inputs, 1);
        assert!((p - HERE - (torque[1] + torque[2]) * 1.25).amax() < 1e-12, "{p}");
    }

    /// The derivative by the start that goes with the motion is that of differences of motions.
    #[test]
    fn the_derivative_by_the_start_goes_with_the_motion() {
        let law = law();
        let ramp = |from: f64| vec![Vector3::new(from, 0.1, -0.2), Vector3::new(0.3, -from, 0.1)];
        let inputs = Inputs { wheel: ramp(0.1), torque: ramp(0.02) };
        let start = law.j * HERE + inputs.wheel[0];
        let end = |start: Vector3<f64>| {
            let (mut p, mut s) = (start, Matrix3::identity());
            law.advance(&mut p, &mut s, 0.73, &inputs, 0);
            (p, s)
        };
        let h = 1e-5;
        for k in 0..3 {
            let by = Vector3::ith(k, h);
            let difference = (end(start + by).0 - end(start - by).0) / (2.0 * h);
            assert!((difference - end(start).1.column(k)).amax() < 1e-7, "{k}");
        }
    }

    /// A wheel along the rate of a ball takes its momentum from it, three times as much as a rate; the derivative by the start turns about the
    /// wheel, so that each sample that is used counts as one in each direction.
    #[test]
    fn a_ball_gives_its_momentum_to_the_wheel() {
        let law = free(Matrix3::identity() / 3.0);
        let times = [0.0, 0.4, 1.0, 1.3];
        let shares = [0.1, 0.3, -0.2, 0.4];
        let inputs = Inputs { wheel: shares.map(|share| HERE * share).to_vec(), ..none() };
        let measured = [HERE; 4];
        let used = [true, true, false, true];
        let (rates, normal, gradient, sum) = law.shoot(&times, &measured, &used, &inputs, HERE);
        let mut squares = 0.0;
        for ((rate, share), used) in rates.iter().zip(shares).zip(used) {
            let lost = 3.0 * (share - 0.1);
            assert!((rate - HERE * (1.0 - lost)).amax() < 1e-12, "{share}: {rate}");
            squares += if used { lost * lost * HERE.norm_squared() } else { 0.0 };
        }
        assert!((sum / squares - 1.0).abs() < 1e-10, "{sum} {squares}");
        assert!((normal.trace() / 9.0 - 1.0).abs() < 1e-5, "{normal}");
        // along the wheel nothing turns: the sum of what is left, 0.6 + 0.9 of the rate
        assert!((gradient.dot(&HERE) / (1.5 * HERE.norm_squared()) - 1.0).abs() < 1e-10, "{gradient}");
    }

    /// The nearest motion to exact rates is that motion, also where one sample that is not used stands far out of it.
    #[test]
    fn the_nearest_motion_is_the_one_that_was_read() {
        let j = law().j;
        let times: Vec<f64> = (0..300).map(|k| 0.07 * f64::from(k)).collect();
        let body = Inertia::from_tensor(j).unwrap();
        let exact = simulate(&body, HERE, &times, 0.0, &mut Random::new(1)).unwrap();
        let mut read = exact.clone();
        read[0] = Vector3::new(5.0, 5.0, 5.0);
        read[100] = Vector3::new(-40.0, 0.0, 9.0);
        let used: Vec<bool> = (0..300).map(|k| k != 0 && k != 100).collect();
        let s = Segment::new("toss", times, read.clone()).unwrap();
        let found = free(j).nearest(&s, &read, &used).unwrap();
        // steps of up to 0.05 rad have errors of order 1e-7 a radian
        let apart = found.iter().zip(&exact).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(apart < 1e-4, "{apart:e}");
        assert!(free(j).nearest(&s, &read, &[false; 300]).is_none());
    }

    /// What is left of samples that are used is measured less fitted, 3 and 4 rad/s in two of three samples: the root of 25/6.
    #[test]
    fn residuals_are_those_of_the_samples_that_are_used() {
        let measured = vec![HERE + Vector3::x() * 3.0, HERE * 9.0, HERE - Vector3::y() * 4.0];
        let (used, fitted) = (vec![true, false, true], Some(vec![HERE; 3]));
        let motion = FittedMotion { segment: 0, used, measured, fitted };
        let left = motion.residuals().unwrap();
        assert!((left[0] - Vector3::x() * 3.0).amax() < 1e-14);
        assert!((left[2] + Vector3::y() * 4.0).amax() < 1e-14);
        assert_eq!(left[1], Vector3::zeros());
        assert!((motion.rms().unwrap() - (25.0_f64 / 6.0).sqrt()).abs() < 1e-14);
        assert!(FittedMotion { fitted: None, ..motion }.rms().is_none());
    }

    /// Pushed against its drag, w' = 1 − w², a ball that starts at rest has the rate tanh t. From readings that have nearly reached the last rate whole
    /// steps lead past the start, and damped ones to it, where the damping falls again.
    #[test]
    fn steps_that_go_too_far_are_damped_until_they_do_not() {
        let times = vec![0.0, 0.9, 1.0, 1.1];
        let measured: Vec<Vector3<f64>> = times.iter().map(|t| Vector3::x() * libm::tanh(*t)).collect();
        let ball = free(Matrix3::identity() / 3.0);
        let law = Law { quadratic: 1.0, torque: Vector3::x() / 3.0, ..ball };
        let s = Segment::new("toss", times, measured.clone()).unwrap();
        let found = law.nearest(&s, &measured, &[false, true, true, true]).unwrap();
        for (found, measured) in found.iter().zip(&measured).skip(1) {
            assert!((found - measured).amax() < 1e-6, "{found} {measured}");
        }
    }
}
