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
