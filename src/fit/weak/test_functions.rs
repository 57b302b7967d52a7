//! Test functions of compact support on a stretch of samples, and their weights in sums over samples.

use std::rc::Rc;

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use crate::num::banded::Banded;
use crate::num::quadrature;

/// Test functions per radius.
pub(crate) const TESTS_PER_RADIUS: f64 = 4.0;
/// Fewest samples in the support of one test function.
pub(crate) const SAMPLES_PER_TEST: f64 = 8.0;

/// One stretch of samples without gaps, in units of the root mean square rate and its inverse.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    pub(crate) times: Vec<f64>,
    pub(crate) rates: Vec<Vector3<f64>>,
    pub(crate) weights: Vec<f64>,
    /// What acts on the body and is known.
    pub(crate) inputs: Option<KnownInputs>,
    /// Its number in the record.
    pub(crate) index: usize,
}

/// Wheel momenta and torques at the times of a stretch, in units of the unit rate and its square.
#[derive(Clone, Debug)]
pub(crate) struct KnownInputs {
    pub(crate) wheel: Vec<Vector3<f64>>,
    pub(crate) torque: Vec<Vector3<f64>>,
}

impl Stretch {
    pub(crate) fn new(times: Vec<f64>, rates: Vec<Vector3<f64>>) -> Self {
        let weights = quadrature::weights(&times);
        Stretch { times, rates, weights, inputs: None, index: 0 }
    }

    pub(crate) fn duration(&self) -> f64 {
        self.times.last().zip(self.times.first()).map_or(0.0, |(b, a)| b - a)
    }

    /// Its first `count` samples.
    pub(crate) fn head(&self, count: usize) -> Stretch {
        let head = |of: &[Vector3<f64>]| of[..count].to_vec();
        let inputs = self.inputs.as_ref();
        Stretch {
            inputs: inputs.map(|i| KnownInputs { wheel: head(&i.wheel), torque: head(&i.torque) }),
            index: self.index,
            ..Stretch::new(self.times[..count].to_vec(), head(&self.rates))
        }
    }
}

/// The test functions of one stretch: φ = (1 − u²)⁴, u = (t − centre)/radius, centres evenly spaced.
#[derive(Clone, Debug)]
pub(crate) struct TestFunctions {
    first: f64,
    spacing: f64,
    pub(crate) radius: f64,
    pub(crate) count: usize,
    /// How many neighbours on one side a test overlaps.
    pub(crate) reach: usize,
    /// Cubics q(u) of each test, with which φ' + φ q/radius sums by parts exactly: see [`by_parts`](Self::by_parts).
    corrections: Rc<[Vector4<f64>]>,
}

impl TestFunctions {
    /// `None` where the stretch is shorter than one test function, or has too few samples for it.
    pub(crate) fn new(stretch: &Stretch, radius: f64) -> Option<TestFunctions> {
        let duration = stretch.duration();
        let samples = stretch.times.len() as f64;
        // a radius that was cut from this very duration may exceed half of it by rounding
        if 2.0 * radius > duration * (1.0 + 1e-9) || samples * 2.0 * radius < SAMPLES_PER_TEST * duration {
            return None;
        }
        let room = (duration - 2.0 * radius).max(0.0);
        // nudged off the ties, so that a change of units cannot change the count
        let steps = (TESTS_PER_RADIUS * room / radius + 1e-6).round();
        let count = steps as usize + 1;
        let spacing = if count > 1 { room / steps } else { radius };
        let overlap = if count > 1 { (2.0 * radius / spacing - 1e-9) as usize } else { 0 };
        let mut tests = TestFunctions {
            first: stretch.times[0] + radius,
            spacing,
            radius,
            count,
            reach: overlap.min(count - 1),
            corrections: vec![Vector4::zeros(); count].into(),
        };
        tests.corrections = tests.by_parts(stretch);
        Some(tests)
    }

    /// The cubics q that make Σ w (φ' + φ q/radius) p + Σ w φ p' = 0 for every cubic p.
    ///
    /// It is by this identity that the weak form rests on Euler's equation; a quadrature alone obeys it up to its error,
    /// which a short support or irregular times would make a bias.
    fn by_parts(&self, stretch: &Stretch) -> Rc<[Vector4<f64>]> {
        let mut sums = vec![(Matrix4::<f64>::zeros(), Vector4::<f64>::zeros()); self.count];
        for (&t, &weight) in stretch.times.iter().zip(&stretch.weights) {
            for m in self.at(t) {
                let (value, slope) = self.value(m, t);
                let u = self.position(m, t);
                let powers = Vector4::new(1.0, u, u * u, u * u * u);
                let slopes = Vector4::new(0.0, 1.0, 2.0 * u, 3.0 * u * u);
                sums[m].0 += powers * powers.transpose() * (weight * value);
                sums[m].1 -= powers * (weight * slope * self.radius) + slopes * (weight * value);
            }
        }
        sums.into_iter().map(|(m, b)| m.cholesky().map_or(Vector4::zeros(), |m| m.solve(&b))).collect()
    }

    /// u of test `m` at `t`.
    fn position(&self, m: usize, t: f64) -> f64 {
        (t - self.first - m as f64 * self.spacing) / self.radius
    }

    /// The tests that are not zero at `t`.
    fn at(&self, t: f64) -> core::ops::Range<usize> {
        let low = ((t - self.radius - self.first) / self.spacing).ceil().max(0.0) as usize;
        let high = ((t + self.radius - self.first) / self.spacing).floor();
        if high < 0.0 { 0..0 } else { low..(high as usize + 1).min(self.count) }
    }

    pub(crate) fn centres(&self) -> Vec<f64> {
        (0..self.count).map(|m| self.first + m as f64 * self.spacing).collect()
    }

    /// ∫ φ_m φ_n dt of tests that are 0, 1, … `reach` apart.
    pub(crate) fn overlaps(&self) -> Vec<f64> {
        // the integrand vanishes with its first seven derivatives at both ends, so that a plain sum is exact to rounding
        const PARTS: usize = 64;
        let step = 2.0 * self.radius / PARTS as f64;
        let overlap = |apart: usize| {
            let at = |i: usize| self.first - self.radius + (i as f64 + 0.5) * step;
            (0..PARTS).map(|i| self.value(0, at(i)).0 * self.value(apart, at(i)).0).sum::<f64>() * step
        };
        (0..=self.reach).map(overlap).collect()
    }

    /// φ_m and φ'_m at `t`.
    fn value(&self, m: usize, t: f64) -> (f64, f64) {
        let u = self.position(m, t);
        let v = (1.0 - u * u).max(0.0);
        (v * v * v * v, -8.0 * u * v * v * v / self.radius)
    }
}

/// Most tests that overlap at one time.
pub(crate) const MOST: usize = 10;

/// The tests that are not zero at one time, with their φ' and φ.
pub(crate) struct Seen {
    pub(crate) first: usize,
    pub(crate) count: usize,
    pub(crate) slope: [f64; MOST],
    pub(crate) value: [f64; MOST],
}

impl Seen {
    pub(crate) fn new(tests: &TestFunctions, t: f64) -> Seen {
        let range = tests.at(t);
        let count = range.len().min(MOST);
        let mut seen = Seen { first: range.start, count, slope: [0.0; MOST], value: [0.0; MOST] };
        for (k, m) in range.take(count).enumerate() {
            let (u, q) = (tests.position(m, t), &tests.corrections[m]);
            let v = (1.0 - u * u).max(0.0);
            let cube = v * v * v;
            let cubic = q[0] + u * (q[1] + u * (q[2] + u * q[3]));
            seen.slope[k] = (v * cubic - 8.0 * u) * cube / tests.radius;
            seen.value[k] = v * cube;
        }
        seen
    }

    /// Each test with its φ' and φ.
    pub(crate) fn each(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        (0..self.count).map(|k| (self.first + k, self.slope[k], self.value[k]))
    }

    /// Σ over pairs of tests of the blocks Z of `inverse`, weighted by slope·slope, value·slope and value·value; in
    /// the second the row belongs to the value.
    pub(crate) fn sums(&self, inverse: &Banded) -> [Matrix3<f64>; 3] {
        let mut sums = [Matrix3::zeros(); 3];
        for (m, a, b) in self.each() {
            for (n, c, d) in self.each() {
                let z = Matrix3::from_fn(|p, q| inverse.get(3 * m + p, 3 * n + q));
                sums[0] += z * (a * c);
                sums[1] += z * (b * c);
                sums[2] += z * (b * d);
            }
        }
        sums
    }
}
