//! The motion that a fit stands for, beside the readings.

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::fit::{Estimate, Nuisance, Record, Segment};

/// One segment, measured and fitted.
pub(super) struct Fitted {
    /// Index of the segment in the record.
    pub(super) segment: usize,
    /// Whether each sample was used: spikes were not.
    pub(super) used: Vec<bool>,
    /// Angular velocities from the readings and what was found of the sensor, rad/s.
    pub(super) measured: Vec<Vector3<f64>>,
    /// The motion of the fitted tensor and torque nearest to them, rad/s; `None` where none was found.
    pub(super) fitted: Option<Vec<Vector3<f64>>>,
}

impl Fitted {
    /// Measured less fitted, rad/s, of the samples that were used; the others are 0.
    pub(super) fn residuals(&self) -> Option<Vec<Vector3<f64>>> {
        let fitted = self.fitted.as_ref()?;
        let left = self.measured.iter().zip(fitted).zip(&self.used);
        Some(left.map(|((a, b), used)| if *used { a - b } else { Vector3::zeros() }).collect())
    }

    /// Root mean square of a component of the residuals, rad/s.
    pub(super) fn rms(&self) -> Option<f64> {
        let count = self.used.iter().filter(|used| **used).count().max(1);
        let sum: f64 = self.residuals()?.iter().map(Vector3::norm_squared).sum();
        Some((sum / (3 * count) as f64).sqrt())
    }
}

/// The segments that the fit has used.
pub(super) fn fitted(e: &Estimate, record: &Record) -> Vec<Fitted> {
    let law = Law::new(e);
    let sensor = Sensor::new(&e.nuisances);
    let segments = record.segments.iter().enumerate();
    segments
        .filter(|(k, _)| e.residuals.iter().any(|r| r.segment == *k))
        .map(|(segment, s)| {
            let measured: Vec<Vector3<f64>> = s.rates().iter().map(|w| sensor.rate(w)).collect();
            let mut used = vec![true; measured.len()];
            for spike in e.spikes.iter().filter(|spike| spike.segment == segment) {
                if let Some(used) = used.get_mut(spike.sample) {
                    *used = false;
                }
            }
            let fitted = law.as_ref().and_then(|law| law.nearest(s, &measured, &used));
            Fitted { segment, used, measured, fitted }
        })
        .collect()
}

fn value(of: &[Nuisance], name: &str) -> Option<f64> {
    of.iter().find(|n| n.name == name).map(|n| n.value)
}

/// The symmetric matrix of coefficients called `stem`_xx and so on; those that are not there are 0.
fn symmetric(of: &[Nuisance], stem: &str) -> Matrix3<f64> {
    let entry = |pair: &str| value(of, &format!("{stem}_{pair}"));
    let axis = |name: &str| entry(&format!("{name}{name}")).or(entry(name)).unwrap_or(0.0);
    let [xy, xz, yz] = ["xy", "xz", "yz"].map(|pair| entry(pair).unwrap_or(0.0));
    Matrix3::new(axis("x"), xy, xz, xy, axis("y"), yz, xz, yz, axis("z"))
}

fn vector(of: &[Nuisance], stem: &str) -> Vector3<f64> {
    Vector3::from(["x", "y", "z"].map(|axis| value(of, &format!("{stem}_{axis}")).unwrap_or(0.0)))
}

/// Readings to rates, ω = P y − b.
struct Sensor {
    matrix: Matrix3<f64>,
    offset: Vector3<f64>,
}

impl Sensor {
    fn new(nuisances: &[Nuisance]) -> Self {
        let common = Matrix3::identity() * value(nuisances, "scale").unwrap_or(0.0);
        let own = Matrix3::from_diagonal(&vector(nuisances, "scale"));
        let lean = symmetric(nuisances, "misalignment");
        // an angle between two axes is shared by both
        Sensor {
            matrix: Matrix3::identity() + common + own + lean * 0.5,
            offset: vector(nuisances, "offset"),
        }
    }

    fn rate(&self, reading: &Vector3<f64>) -> Vector3<f64> {
        self.matrix * reading - self.offset
    }
}

/// J ω' = −ω × J ω − k J ω − D ω + τ with trace 1.
struct Law {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
    damping: Matrix3<f64>,
    torque: Vector3<f64>,
}

/// Radians of the first window, and how much each is longer than the one before.
const FIRST: f64 = 1.0;
const GROWTH: f64 = 1.6;
/// Steps of the search in each window.
const STEPS: usize = 12;
/// Longest step of the integrator, rad: errors of order 1e-7.
const STEP: f64 = 0.05;

impl Law {
    /// `None` where the tensor has no inverse.
    fn new(e: &Estimate) -> Option<Self> {
        let j = e.shape.tensor();
        let of = &e.torque.coefficients;
        let drag = value(of, "drag").unwrap_or(0.0);
        Some(Law {
            j,
            inverse: j.try_inverse()?,
            damping: j * drag + symmetric(of, "drag"),
            torque: vector(of, "torque"),
        })
    }

    fn slope(&self, w: &Vector3<f64>) -> Vector3<f64> {
        self.inverse * (self.torque - w.cross(&(self.j * w)) - self.damping * w)
    }

    /// The derivative of the slope.
    fn linear(&self, w: &Vector3<f64>) -> Matrix3<f64> {
        let own = (self.j * w).cross_matrix() - w.cross_matrix() * self.j;
        self.inverse * (own - self.damping)
    }

    /// The classical Runge–Kutta step, for a rate and its derivative with respect to the start.
    fn advance(&self, w: &mut Vector3<f64>, s: &mut Matrix3<f64>, time: f64) {
        let parts = (w.norm() * time / STEP).ceil().clamp(1.0, 1000.0);
        let h = time / parts;
        for _ in 0..parts as usize {
            let (w1, s1) = (self.slope(w), self.linear(w) * *s);
            let middle = *w + w1 * (0.5 * h);
            let (w2, s2) = (self.slope(&middle), self.linear(&middle) * (*s + s1 * (0.5 * h)));
            let middle = *w + w2 * (0.5 * h);
            let (w3, s3) = (self.slope(&middle), self.linear(&middle) * (*s + s2 * (0.5 * h)));
            let end = *w + w3 * h;
            let (w4, s4) = (self.slope(&end), self.linear(&end) * (*s + s3 * h));
            *w += (w1 + (w2 + w3) * 2.0 + w4) * (h / 6.0);
            *s += (s1 + (s2 + s3) * 2.0 + s4) * (h / 6.0);
        }
    }

    /// The motion from `start`, and the normal equations of its distance from the samples.
    fn shoot(
        &self,
        times: &[f64],
        measured: &[Vector3<f64>],
        used: &[bool],
        start: Vector3<f64>,
    ) -> (Vec<Vector3<f64>>, Matrix3<f64>, Vector3<f64>, f64) {
        let (mut w, mut s) = (start, SMatrix::identity());
        let (mut normal, mut gradient, mut sum) = (Matrix3::zeros(), Vector3::zeros(), 0.0);
        let mut rates = Vec::with_capacity(times.len());
        for i in 0..times.len() {
            if i > 0 {
                self.advance(&mut w, &mut s, times[i] - times[i - 1]);
            }
            rates.push(w);
            if used[i] {
                let left = measured[i] - w;
                normal += s.transpose() * s;
                gradient += s.transpose() * left;
                sum += left.norm_squared();
            }
        }
        (rates, normal, gradient, sum)
    }

    /// By least squares in windows that grow: within the first the motion turns by little, and each start is good enough
    /// for the next.
    fn nearest(&self, s: &Segment, measured: &[Vector3<f64>], used: &[bool]) -> Option<Vec<Vector3<f64>>> {
        let times = s.times();
        let speed = (measured.iter().map(Vector3::norm_squared).sum::<f64>() / measured.len() as f64).sqrt();
        let mut start = measured[used.iter().position(|used| *used)?];
        let mut radius = FIRST / speed;
        loop {
            let count = times.partition_point(|t| *t <= times[0] + radius).max(4).min(times.len());
            let part = (&times[..count], &measured[..count], &used[..count]);
            let (mut rates, mut normal, mut gradient, mut sum) = self.shoot(part.0, part.1, part.2, start);
            let mut damping = 0.0;
            for _ in 0..STEPS {
                let ridge = Matrix3::identity() * (damping * normal.trace());
                let step = (normal + ridge).cholesky()?.solve(&gradient);
                let next = self.shoot(part.0, part.1, part.2, start + step);
                if next.3 < sum {
                    let gain = sum - next.3;
                    start += step;
                    (rates, normal, gradient, sum) = next;
                    damping *= 0.1;
                    if gain < 1e-9 * sum {
                        break;
                    }
                } else if step.norm() < 1e-9 * speed {
                    break;
                } else {
                    damping = f64::max(10.0 * damping, 1e-4);
                }
            }
            if count == times.len() {
                return sum.is_finite().then_some(rates);
            }
            radius *= GROWTH;
        }
    }
}
