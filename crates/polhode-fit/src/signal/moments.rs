//! Sums of a stretch against its test functions. They hold all that the weak equations ask of the samples, whatever the
//! tensor, the torque and the errors of the sensor are.

use crate::thresholds::groups::{GROUPS, LONGEST};
use crate::thresholds::radius::LONG;
use core::ops::Range;

use multiversion::multiversion;
use nalgebra::{Matrix3, Vector3};
use polhode::record::both;

use crate::signal::stretch::{KnownInputs, Stretch};
use crate::signal::test_functions::{LANES, Seen, TestFunctions};
use crate::signal::zeros::zeros;

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
    sums: Running,
    /// Of wheel momenta and known torques, where the record has them.
    pub(crate) inputs: Vec<Inputs>,
    /// Σ w φ y hᵀ and Σ w φ ω hᵀ, where the record has wheel momenta.
    mixed: Vec<[Matrix3<f64>; 2]>,
}

/// The six different entries of v vᵀ.
fn products(v: &Vector3<f64>) -> [f64; 6] {
    [v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.x * v.z, v.y * v.z]
}

fn full(s: &[f64; 6]) -> Matrix3<f64> {
    Matrix3::new(s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2])
}

/// Numbers of a sample that are summed with φ': y, ω; and with φ: 1, y, ω, y yᵀ − n nᵀ, ω ωᵀ.
const WITH_SLOPE: usize = 6;
const WITH_VALUE: usize = 19;

/// Sums over samples, those of one kind side by side for all tests, and room behind them.
type Running = [Vec<f64>; WITH_SLOPE + WITH_VALUE];

/// The same of the tests that are seen together, in whole registers.
#[repr(align(64))]
struct Near([f64; LANES]);

/// Samples that are added together, so that each sum is fetched once for all of them.
const TOGETHER: usize = 4;

/// Samples that wait to be added: they see the same tests.
struct Waiting {
    count: usize,
    slopes: [[f64; LANES]; TOGETHER],
    values: [[f64; LANES]; TOGETHER],
    with_slope: [[f64; WITH_SLOPE]; TOGETHER],
    with_value: [[f64; WITH_VALUE]; TOGETHER],
}

impl Waiting {
    const NONE: Waiting = Waiting {
        count: 0,
        slopes: [[0.0; LANES]; TOGETHER],
        values: [[0.0; LANES]; TOGETHER],
        with_slope: [[0.0; WITH_SLOPE]; TOGETHER],
        with_value: [[0.0; WITH_VALUE]; TOGETHER],
    };
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn add(
    stretch: &Stretch,
    noise: &[Vector3<f64>],
    samples: Range<usize>,
    tests: &TestFunctions,
    sums: &mut Running,
) {
    // each at a place of its own, so that the compiler adds test to test and not kind to kind
    let mut near: [Box<Near>; WITH_SLOPE + WITH_VALUE] =
        core::array::from_fn(|_| Box::new(Near([0.0; LANES])));
    let mut waiting = Waiting::NONE;
    let mut first = 0;
    for i in samples {
        let (y, n, weight) = (stretch.rates[i], &noise[i], stretch.weights[i]);
        let w = y - n;
        let seen = Seen::new(tests, stretch.times[i]);
        if seen.first != first {
            add_waiting(&mut near, &mut waiting);
            hand_over(&mut near, first, sums);
            first = seen.first;
        }
        let (of_readings, of_noise, of_motion) = (products(&y), products(n), products(&w));
        let mut slope = [0.0; WITH_SLOPE];
        let mut value = [weight; WITH_VALUE];
        for k in 0..3 {
            slope[k] = weight * y[k];
            slope[3 + k] = weight * w[k];
        }
        value[1..7].copy_from_slice(&slope);
        for k in 0..6 {
            value[7 + k] *= of_readings[k] - of_noise[k];
            value[13 + k] *= of_motion[k];
        }
        let place = waiting.count;
        (waiting.slopes[place], waiting.values[place]) = (seen.slope, seen.value);
        (waiting.with_slope[place], waiting.with_value[place]) = (slope, value);
        waiting.count += 1;
        if waiting.count == TOGETHER {
            add_waiting(&mut near, &mut waiting);
        }
    }
    add_waiting(&mut near, &mut waiting);
    hand_over(&mut near, first, sums);
}

/// Adds the samples that wait, in their order.
#[inline(always)]
fn add_waiting(near: &mut [Box<Near>; WITH_SLOPE + WITH_VALUE], waiting: &mut Waiting) {
    let (with_slope, with_value) = near.split_at_mut(WITH_SLOPE);
    // what does not wait adds nothing
    for place in waiting.count..TOGETHER {
        waiting.with_slope[place] = [0.0; WITH_SLOPE];
        waiting.with_value[place] = [0.0; WITH_VALUE];
    }
    let [a, b, c, d] = &waiting.slopes;
    let [of_a, of_b, of_c, of_d] = &waiting.with_slope;
    for (kind, near) in with_slope.iter_mut().enumerate() {
        let (p, q, r, s) = (of_a[kind], of_b[kind], of_c[kind], of_d[kind]);
        for k in 0..LANES {
            near.0[k] = near.0[k] + a[k] * p + b[k] * q + c[k] * r + d[k] * s;
        }
    }
    let [a, b, c, d] = &waiting.values;
    let [of_a, of_b, of_c, of_d] = &waiting.with_value;
    for (kind, near) in with_value.iter_mut().enumerate() {
        let (p, q, r, s) = (of_a[kind], of_b[kind], of_c[kind], of_d[kind]);
        for k in 0..LANES {
            near.0[k] = near.0[k] + a[k] * p + b[k] * q + c[k] * r + d[k] * s;
        }
    }
    waiting.count = 0;
}

/// Moves the sums of the tests from `first` on to those of all.
#[inline(always)]
fn hand_over(near: &mut [Box<Near>], first: usize, sums: &mut Running) {
    for (near, sums) in near.iter_mut().zip(sums) {
        for (near, sum) in near.0.iter_mut().zip(&mut sums[first..first + LANES]) {
            *sum += *near;
            *near = 0.0;
        }
    }
}

impl Moments {
    pub(crate) fn new(stretch: &Stretch, noise: &[Vector3<f64>], tests: &TestFunctions) -> Moments {
        // the halves of a long stretch side by side, whatever the machine is
        let (count, long) = (noise.len(), noise.len() > LONG);
        let middle = if long { count / 2 } else { 0 };
        let of = |samples: Range<usize>, room: usize| {
            let mut sums: Running = core::array::from_fn(|_| zeros(room + LANES));
            add(stretch, noise, samples, tests, &mut sums);
            sums
        };
        // those of the first half see no tests behind it
        let first = || long.then(|| of(0..middle, tests.at(stretch.times[middle]).end));
        let (mut sums, first) = both(long, || of(middle..count, tests.count), first);
        for (sum, first) in sums.iter_mut().zip(first.iter().flatten()) {
            sum.iter_mut().zip(first).for_each(|(sum, first)| *sum += first);
        }
        let mut moments = Moments { sums, inputs: Vec::new(), mixed: Vec::new() };
        moments.add_inputs(stretch, noise, tests);
        moments
    }

    /// Σ w φ.
    pub(crate) fn area(&self, m: usize) -> f64 {
        self.sums[WITH_SLOPE][m]
    }

    /// At the readings; in the squares n nᵀ is taken off, which makes the equations linear in the noise n.
    pub(crate) fn readings(&self, m: usize) -> Sums {
        self.of(m, [0, 1, 7], 0)
    }

    /// At the readings less the noise.
    pub(crate) fn motion(&self, m: usize) -> Sums {
        self.of(m, [3, 4, 13], 1)
    }

    /// The sums of one kind, of which the slopes, the values and the squares begin at these places.
    fn of(&self, m: usize, [slope, value, square]: [usize; 3], mixed: usize) -> Sums {
        let three = |first: usize| Vector3::from([0, 1, 2].map(|k| self.sums[first + k][m]));
        Sums {
            slope: three(slope),
            value: three(WITH_SLOPE + value),
            square: full(&core::array::from_fn(|k| self.sums[WITH_SLOPE + square + k][m])),
            mixed: self.mixed.get(m).map_or(Matrix3::zeros(), |both| both[mixed]),
        }
    }

    fn add_inputs(&mut self, stretch: &Stretch, noise: &[Vector3<f64>], tests: &TestFunctions) {
        let Some(inputs) = &stretch.inputs else { return };
        let none = Inputs { slope: Vector3::zeros(), value: Vector3::zeros(), torque: Vector3::zeros() };
        self.inputs = vec![none; tests.count];
        self.mixed = vec![[Matrix3::zeros(); 2]; tests.count];
        for (i, n) in noise.iter().enumerate() {
            let (y, weight) = (stretch.rates[i], stretch.weights[i]);
            let (h, torque) = (inputs.wheel[i], inputs.torque[i]);
            for (m, slope, value) in Seen::new(tests, stretch.times[i]).each() {
                let (slope, value) = (weight * slope, weight * value);
                self.inputs[m].slope += h * slope;
                self.inputs[m].value += h * value;
                self.inputs[m].torque += torque * value;
                self.mixed[m][0] += y * h.transpose() * value;
                self.mixed[m][1] += (y - n) * h.transpose() * value;
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

/// Groups of a stretch for test functions of half width `radius`.
pub(crate) fn groups(stretch: &Stretch, noise: &[Vector3<f64>], radius: f64) -> impl Iterator<Item = Group> {
    ranges(stretch, radius, 0).map(move |range| group(stretch, noise, range))
}

/// Samples of the groups from sample `low` on, where one begins.
pub(crate) fn ranges(stretch: &Stretch, radius: f64, mut low: usize) -> impl Iterator<Item = Range<usize>> {
    let width = (radius / GROUPS).min(LONGEST);
    core::iter::from_fn(move || {
        let end = stretch.times.get(low)? + width;
        let range = low..low + stretch.times[low..].iter().take_while(|t| **t < end).count().max(1);
        low = range.end;
        Some(range)
    })
}

/// The samples of a range as one.
pub(crate) fn group(stretch: &Stretch, noise: &[Vector3<f64>], range: Range<usize>) -> Group {
    let share = 1.0 / range.len() as f64;
    let first = stretch.times[range.start];
    let (mut time, mut weight, mut square) = (0.0, 0.0, 0.0);
    for (t, w) in stretch.times[range.clone()].iter().zip(&stretch.weights[range.clone()]) {
        time += t - first;
        weight += w;
        square += w * w;
    }
    let motion = || stretch.rates[range.clone()].iter().zip(&noise[range.clone()]).map(|(y, n)| y - n);
    let reading = motion().sum::<Vector3<f64>>() * share;
    let mut scatter = [0.0; 6];
    for w in motion() {
        scatter.iter_mut().zip(products(&(w - reading))).for_each(|(sum, product)| *sum += product);
    }
    let wheel = |inputs: &KnownInputs| inputs.wheel[range.clone()].iter().sum::<Vector3<f64>>() * share;
    Group {
        time: first + time * share,
        reading,
        scatter: full(&scatter) * share,
        wheel: stretch.inputs.as_ref().map_or(Vector3::zeros(), wheel),
        weight,
        square,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stretch() -> Stretch {
        let times = vec![0.0, 0.05, 0.1, 0.12, 0.3, 0.31, 0.9];
        let mut rates = vec![Vector3::zeros(); 7];
        (rates[4], rates[5]) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(3.0, 2.0, 5.0));
        let mut wheel = vec![Vector3::zeros(); 7];
        (wheel[4], wheel[5]) = (Vector3::new(1.0, 0.0, 0.0), Vector3::new(3.0, 4.0, 0.0));
        let inputs = Some(KnownInputs { wheel, torque: vec![Vector3::zeros(); 7] });
        let weights = vec![1.0, 1.0, 1.0, 1.0, 0.5, 0.25, 1.0];
        Stretch { weights, inputs, ..Stretch::new(times, rates) }
    }

    /// Groups last a twelfth of a radius, and at most 0.15; each begins with the first sample that the one before does not hold.
    #[test]
    fn groups_follow_each_other_without_a_gap() {
        let s = stretch();
        let of = |radius: f64, low: usize| ranges(&s, radius, low).collect::<Vec<Range<usize>>>();
        assert_eq!(of(0.66, 0), [0..2, 2..4, 4..6, 6..7]);
        assert_eq!(of(1.8, 0), [0..4, 4..6, 6..7]);
        assert_eq!(of(100.0, 0), of(1.8, 0));
        assert_eq!(of(1.8, 4), [4..6, 6..7]);
        assert!(of(1.8, 7).is_empty());
        assert_eq!(of(0.012, 0).len(), 7);
    }

    /// A group has the mean time, rate and momentum of its samples, the mean square of what they differ from that, and the sums of their weights and
    /// of the squares of these.
    #[test]
    fn a_group_has_the_means_of_its_samples() {
        let s = stretch();
        let mut noise = [Vector3::zeros(); 7];
        (noise[4], noise[5]) = (Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.0, 2.0, 1.0));
        let own = group(&s, &noise, 4..6);
        assert!((own.time - 0.305).abs() < 1e-15);
        // of (1, 2, 2) and (3, 0, 4)
        assert_eq!(own.reading, Vector3::new(2.0, 1.0, 3.0));
        assert_eq!(own.scatter, Matrix3::new(1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0));
        assert_eq!(own.wheel, Vector3::new(2.0, 2.0, 0.0));
        assert_eq!((own.weight, own.square), (0.75, 0.3125));
        let all = groups(&s, &noise, 1.8).map(|group| group.weight);
        assert_eq!(all.collect::<Vec<f64>>(), [4.0, 0.75, 1.0]);
        let one = group(&s, &noise, 5..6);
        assert_eq!((one.reading, one.scatter), (Vector3::new(3.0, 0.0, 4.0), Matrix3::zeros()));
        assert_eq!(group(&Stretch { inputs: None, ..s }, &noise, 4..6).wheel, Vector3::zeros());
    }
}
