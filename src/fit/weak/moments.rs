//! Sums of a stretch against its test functions. They hold all that the weak equations ask of the samples, whatever the
//! tensor, the torque and the errors of the sensor are.

use nalgebra::{Matrix3, Vector3};

use super::test_functions::{Seen, Stretch, TestFunctions};

/// Sums against one test function φ with the weights w of the samples.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sums {
    /// Σ w φ' y.
    pub(crate) slope: Vector3<f64>,
    /// Σ w φ y.
    pub(crate) value: Vector3<f64>,
    /// Σ w φ y yᵀ.
    pub(crate) square: Matrix3<f64>,
    /// Σ w φ y hᵀ.
    pub(crate) mixed: Matrix3<f64>,
}

/// Sums that do not depend on the rates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inputs {
    /// Σ w φ' h.
    pub(crate) slope: Vector3<f64>,
    /// Σ w φ h.
    pub(crate) value: Vector3<f64>,
    /// Σ w φ τ.
    pub(crate) torque: Vector3<f64>,
}

/// Sums against each test function.
pub(crate) struct Moments {
    /// Σ w φ.
    pub(crate) area: Vec<f64>,
    /// At the readings; in the squares n nᵀ is taken off, which makes the equations linear in the noise n.
    pub(crate) readings: Vec<Sums>,
    /// At the readings less the noise.
    pub(crate) motion: Vec<Sums>,
    /// Of wheel momenta and known torques, where the record has them.
    pub(crate) inputs: Vec<Inputs>,
}

/// The six different entries of v vᵀ.
fn products(v: &Vector3<f64>) -> [f64; 6] {
    [v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.x * v.z, v.y * v.z]
}

fn full(s: &[f64]) -> Matrix3<f64> {
    Matrix3::new(s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2])
}

impl Moments {
    pub(crate) fn new(stretch: &Stretch, noise: &[Vector3<f64>], tests: &TestFunctions) -> Moments {
        let mut slopes = vec![[0.0; 6]; tests.count];
        let mut values = vec![[0.0; 19]; tests.count];
        for (i, n) in noise.iter().enumerate() {
            let (y, weight) = (stretch.rates[i], stretch.weights[i]);
            let w = y - n;
            let seen = Seen::new(tests, stretch.times[i]);
            let (of_readings, of_noise, of_motion) = (products(&y), products(n), products(&w));
            let slope = [y.x, y.y, y.z, w.x, w.y, w.z].map(|v| weight * v);
            let mut value = [weight; 19];
            for k in 0..3 {
                value[1 + k] *= y[k];
                value[4 + k] *= w[k];
            }
            for k in 0..6 {
                value[7 + k] *= of_readings[k] - of_noise[k];
                value[13 + k] *= of_motion[k];
            }
            let last = seen.first + seen.count;
            for (k, sums) in slopes[seen.first..last].iter_mut().enumerate() {
                let by = seen.slope[k];
                sums.iter_mut().zip(&slope).for_each(|(sum, s)| *sum += by * s);
            }
            for (k, sums) in values[seen.first..last].iter_mut().enumerate() {
                let by = seen.value[k];
                sums.iter_mut().zip(&value).for_each(|(sum, v)| *sum += by * v);
            }
        }
        let sums = |slope: &[f64], value: &[f64], square: &[f64]| Sums {
            slope: Vector3::from_column_slice(slope),
            value: Vector3::from_column_slice(value),
            square: full(square),
            mixed: Matrix3::zeros(),
        };
        let each = || slopes.iter().zip(&values);
        let mut moments = Moments {
            area: values.iter().map(|v| v[0]).collect(),
            readings: each().map(|(s, v)| sums(&s[..3], &v[1..4], &v[7..13])).collect(),
            motion: each().map(|(s, v)| sums(&s[3..], &v[4..7], &v[13..])).collect(),
            inputs: Vec::new(),
        };
        moments.add_inputs(stretch, noise, tests);
        moments
    }

    fn add_inputs(&mut self, stretch: &Stretch, noise: &[Vector3<f64>], tests: &TestFunctions) {
        let Some(inputs) = &stretch.inputs else { return };
        let none = Inputs { slope: Vector3::zeros(), value: Vector3::zeros(), torque: Vector3::zeros() };
        self.inputs = vec![none; tests.count];
        for (i, n) in noise.iter().enumerate() {
            let (y, weight) = (stretch.rates[i], stretch.weights[i]);
            let (h, torque) = (inputs.wheel[i], inputs.torque[i]);
            for (m, slope, value) in Seen::new(tests, stretch.times[i]).each() {
                let (slope, value) = (weight * slope, weight * value);
                self.inputs[m].slope += h * slope;
                self.inputs[m].value += h * value;
                self.inputs[m].torque += torque * value;
                self.readings[m].mixed += y * h.transpose() * value;
                self.motion[m].mixed += (y - n) * h.transpose() * value;
            }
        }
    }
}

/// Neighbouring samples seen as one, in the covariance of the equations: the test functions hardly differ among them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    pub(crate) time: f64,
    /// Mean of the readings less the noise.
    pub(crate) reading: Vector3<f64>,
    /// Mean of the squares δ δᵀ of what the samples differ from that mean.
    pub(crate) scatter: Matrix3<f64>,
    /// Mean wheel momentum.
    pub(crate) wheel: Vector3<f64>,
    /// Σ w.
    pub(crate) weight: f64,
    /// Σ w².
    pub(crate) square: f64,
}

/// Groups per half width of a test function: sums over its smooth support are then exact to a millionth.
const GROUPS: f64 = 12.0;
/// Longest group, in which the body turns by less than this angle.
const LONGEST: f64 = 0.15;

/// Groups of a stretch for test functions of half width `radius`.
pub(crate) fn groups(stretch: &Stretch, noise: &[Vector3<f64>], radius: f64) -> Vec<Group> {
    let width = (radius / GROUPS).min(LONGEST);
    let motion = |i: usize| stretch.rates[i] - noise[i];
    let mut groups = Vec::new();
    let mut low = 0;
    while low < stretch.times.len() {
        let end = stretch.times[low] + width;
        let high = low + stretch.times[low..].iter().take_while(|t| **t < end).count().max(1);
        let count = (high - low) as f64;
        let mut group = Group {
            time: 0.0,
            reading: Vector3::zeros(),
            scatter: Matrix3::zeros(),
            wheel: Vector3::zeros(),
            weight: 0.0,
            square: 0.0,
        };
        for ((t, weight), i) in
            stretch.times[low..high].iter().zip(&stretch.weights[low..high]).zip(low..high)
        {
            group.time += (t - stretch.times[low]) / count;
            group.reading += motion(i) / count;
            if let Some(inputs) = &stretch.inputs {
                group.wheel += inputs.wheel[i] / count;
            }
            group.weight += weight;
            group.square += weight * weight;
        }
        group.time += stretch.times[low];
        for apart in (low..high).map(|i| motion(i) - group.reading) {
            group.scatter += apart * apart.transpose() / count;
        }
        groups.push(group);
        low = high;
    }
    groups
}
