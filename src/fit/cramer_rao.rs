//! The Cramér–Rao bound: what no unbiased estimator can undercut.
//!
//! F = σ⁻² Σ Sᵢᵀ Sᵢ with S = ∂ω/∂(x, ω₀) from the variational equations of J ω' = J ω × ω; each segment has an ω₀ of its
//! own, which the Schur complement takes out.

use core::ops::Range;

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::coordinates::{Coordinates, Form, basis, eigen, entries_of_coordinates, tensor};
use super::test_functions::Stretch;
use super::weak::cross_derivative;
use crate::inertia::Inertia;

/// ∂ω/∂(x, ω₀), or ∂ω/∂ω₀ alone where N is 3.
type Sensitivity<const N: usize> = SMatrix<f64, 3, N>;

/// Largest turn of one step of the integrator, in units of the Jacobian's norm: errors of order 1e-6, plenty for a bound.
const STEP: f64 = 0.1;

struct Euler {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
}

impl Euler {
    fn new(j: Matrix3<f64>) -> Option<Euler> {
        Some(Euler { j, inverse: j.try_inverse()? })
    }

    /// ω' and S'.
    fn derivative<const N: usize>(
        &self,
        w: &Vector3<f64>,
        s: &Sensitivity<N>,
    ) -> (Vector3<f64>, Sensitivity<N>) {
        let rate = -self.inverse * w.cross(&(self.j * w));
        let mut ds = self.inverse * cross_derivative(&self.j, w) * -s;
        for k in 0..N - 3 {
            let b = basis(k);
            let own = self.inverse * (w.cross(&(b * w)) + b * rate);
            ds.set_column(k, &(ds.column(k) - own));
        }
        (rate, ds)
    }

    /// The classical Runge–Kutta step, in as many parts as the rate asks for.
    fn advance<const N: usize>(&self, w: &mut Vector3<f64>, s: &mut Sensitivity<N>, time: f64) {
        let speed = (self.inverse * cross_derivative(&self.j, w)).norm();
        let parts = (speed * time.abs() / STEP).ceil().clamp(1.0, 100.0);
        let h = time / parts;
        for _ in 0..parts as usize {
            let (w1, s1) = self.derivative(w, s);
            let (w2, s2) = self.derivative(&(*w + w1 * (0.5 * h)), &(*s + s1 * (0.5 * h)));
            let (w3, s3) = self.derivative(&(*w + w2 * (0.5 * h)), &(*s + s2 * (0.5 * h)));
            let (w4, s4) = self.derivative(&(*w + w3 * h), &(*s + s3 * h));
            *w += (w1 + (w2 + w3) * 2.0 + w4) * (h / 6.0);
            *s += (s1 + (s2 + s3) * 2.0 + s4) * (h / 6.0);
        }
    }

    /// The motion through `start`, with its sensitivities: `visit` sees it at each of `times`.
    fn sweep<const N: usize>(
        &self,
        times: &[f64],
        start: &Start,
        mut visit: impl FnMut(usize, &Vector3<f64>, &Sensitivity<N>),
    ) {
        let identity = Sensitivity::from_fn(|i, k| if k + 3 == i + N { 1.0 } else { 0.0 });
        let split = times.partition_point(|&t| t < start.time);
        let mut go = |i: usize, last: &mut f64, w: &mut Vector3<f64>, s: &mut Sensitivity<N>| {
            self.advance(w, s, times[i] - *last);
            *last = times[i];
            visit(i, w, s);
        };
        let (mut last, mut w, mut s) = (start.time, start.rate, identity);
        (split..times.len()).for_each(|i| go(i, &mut last, &mut w, &mut s));
        let (mut last, mut w, mut s) = (start.time, start.rate, identity);
        (0..split).rev().for_each(|i| go(i, &mut last, &mut w, &mut s));
    }

    /// Σ Sᵀ S.
    fn information(&self, times: &[f64], start: &Start) -> SMatrix<f64, 8, 8> {
        let mut sum = SMatrix::zeros();
        self.sweep(times, start, |_, _, s: &Sensitivity<8>| sum += s.transpose() * s);
        sum
    }
}

/// Where a motion is at one time.
#[derive(Clone, Copy)]
struct Start {
    time: f64,
    rate: Vector3<f64>,
}

/// Information about x alone.
fn of_tensor(information: &SMatrix<f64, 8, 8>) -> Option<Form> {
    let own = information.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?;
    let mixed = information.fixed_view::<3, 5>(5, 0).into_owned();
    Some(information.fixed_view::<5, 5>(0, 0) - mixed.transpose() * own.solve(&mixed))
}

/// Means of neighbouring samples.
struct Means {
    times: Vec<f64>,
    rates: Vec<Vector3<f64>>,
    counts: Vec<f64>,
}

impl Means {
    /// Over at most `width`; of zero width, the samples themselves.
    fn new(s: &Stretch, width: f64) -> Means {
        let mut means = Means { times: Vec::new(), rates: Vec::new(), counts: Vec::new() };
        let mut low = 0;
        while low < s.times.len() {
            let high = s.times.partition_point(|&t| t <= s.times[low] + width).max(low + 1);
            let count = (high - low) as f64;
            // about the first, so that one sample stays as it is
            let first = s.times[low];
            means.times.push(first + s.times[low..high].iter().map(|t| t - first).sum::<f64>() / count);
            means.rates.push(s.rates[low..high].iter().sum::<Vector3<f64>>() / count);
            means.counts.push(count);
            low = high;
        }
        means
    }

    /// Those at most `radius` from `time`.
    fn around(&self, time: f64, radius: f64) -> Range<usize> {
        let low = self.times.partition_point(|&t| t < time - radius);
        low..self.times.partition_point(|&t| t <= time + radius)
    }
}

/// How far a motion is from samples, and which way leads nearer.
struct Misfit {
    information: Matrix3<f64>,
    gradient: Vector3<f64>,
    sum: f64,
}

impl Misfit {
    fn new(euler: &Euler, means: &Means, range: Range<usize>, start: &Start) -> Misfit {
        let mut misfit = Misfit { information: Matrix3::zeros(), gradient: Vector3::zeros(), sum: 0.0 };
        let low = range.start;
        euler.sweep(&means.times[range], start, |i, w, s: &Sensitivity<3>| {
            let (count, residual) = (means.counts[low + i], means.rates[low + i] - w);
            misfit.information += s.transpose() * s * count;
            misfit.gradient += s.transpose() * residual * count;
            misfit.sum += residual.norm_squared() * count;
        });
        misfit
    }
}

/// Steps towards the motion nearest to one window of samples.
const STEPS: usize = 12;
/// A fall of the misfit, in units of the variance, that no longer matters: a tenth of a standard deviation.
const STILL: f64 = 0.01;

/// The start of the motion nearest to the samples of a window by Levenberg's damped steps, the tensor held.
fn descend(
    euler: &Euler,
    means: &Means,
    range: Range<usize>,
    mut start: Start,
    variance: f64,
) -> Option<(Start, f64)> {
    let equations = 3.0 * range.len() as f64;
    let mut now = Misfit::new(euler, means, range.clone(), &start);
    let mut damping = 0.0;
    for _ in 0..STEPS {
        let ridge = Matrix3::identity() * (damping * now.information.trace());
        let step = (now.information + ridge).cholesky()?.solve(&now.gradient);
        if step.dot(&now.gradient) <= STILL * variance.max(now.sum / equations) {
            break;
        }
        let there = Start { rate: start.rate + step, ..start };
        let next = Misfit::new(euler, means, range.clone(), &there);
        if next.sum < now.sum {
            (start, now) = (there, next);
            damping *= 0.1;
        } else {
            damping = (10.0 * damping).max(1e-4);
        }
    }
    Some((start, now.sum)).filter(|(_, sum)| sum.is_finite())
}

/// Where in a stretch to start, as a share of its samples, and the radius of the first window.
const STARTS: [(f64, f64); 6] = [(0.5, 1.0), (0.25, 1.0), (0.75, 1.0), (0.5, 2.0), (0.25, 2.0), (0.75, 2.0)];
/// Duration of the samples that the search sees as one.
const WIDTH: f64 = 0.1;
/// Share of what noise does not explain that a motion may leave, too.
const LEFT: f64 = 0.05;

/// The motion of a given tensor that explains the samples of a stretch; `None` if none was found.
///
/// The misfit of a whole stretch has many minima, one for each number of turns that the motion may be ahead or behind.
/// A window within which the motion turns by little has one, and what it leaves uncertain of the motion in a window
/// twice as long is small against a turn: each window starts where the one before has ended.
fn nearest_motion(euler: &Euler, s: &Stretch, variance: f64) -> Option<Start> {
    let samples = Means::new(s, 0.0);
    let coarse = Means::new(s, WIDTH);
    let mean = s.rates.iter().sum::<Vector3<f64>>() / s.rates.len() as f64;
    let variation: f64 = s.rates.iter().map(|w| (w - mean).norm_squared()).sum();
    // noise of 3n components, and five standard deviations of the sum of their squares
    let components = 3.0 * s.rates.len() as f64;
    let noise = variance * components;
    let slack = 5.0 * variance * (2.0 * components).sqrt();
    STARTS.iter().find_map(|&(share, first)| {
        let at = (share * s.times.len() as f64) as usize;
        let mut start = Start { time: s.times[at], rate: local_cubic(s, at, first)?.0 };
        let mut radius = first;
        loop {
            let range = coarse.around(start.time, radius);
            if range.len() >= 4 {
                start = descend(euler, &coarse, range, start, variance)?.0;
            }
            if radius >= s.duration() || radius.is_infinite() {
                break;
            }
            radius *= 2.0;
        }
        let (start, left) = descend(euler, &samples, 0..s.times.len(), start, variance)?;
        (left - noise <= LEFT * (variation - noise).max(0.0) + slack).then_some(start)
    })
}

/// The motions of a given tensor that explain a record.
pub(super) struct Motions<'a> {
    euler: Euler,
    each: Vec<(&'a Stretch, Start)>,
}

impl<'a> Motions<'a> {
    /// `None` where the tensor has no inverse, or a stretch is not explained: what is said of another motion is false.
    pub(super) fn nearest(stretches: &'a [Stretch], x: &Coordinates, variance: f64) -> Option<Self> {
        let euler = Euler::new(tensor(x))?;
        let long = stretches.iter().filter(|s| s.times.len() >= 5);
        let each = long.map(|s| Some((s, nearest_motion(&euler, s, variance)?))).collect::<Option<_>>()?;
        Some(Motions { euler, each })
    }

    /// The bound on the covariance of the coordinates; `None` where the motions do not determine them.
    pub(super) fn bound(&self, variance: f64) -> Option<Form> {
        let mut sum = Form::zeros();
        for (s, start) in &self.each {
            sum += of_tensor(&self.euler.information(&s.times, start))?;
        }
        Some((sum / variance).cholesky()?.inverse())
    }

    /// Σ Sᵀ ∂f/∂ω with f = ω·M ω, each ω₀ taken out: what the noise in the sum of f shares with that in the coordinates,
    /// which is the covariance of an efficient estimate times this.
    pub(super) fn shared(&self, m: &Matrix3<f64>) -> Option<Coordinates> {
        let mut shared = Coordinates::zeros();
        for (s, start) in &self.each {
            let (mut information, mut sum) = (SMatrix::<f64, 8, 8>::zeros(), SMatrix::<f64, 8, 1>::zeros());
            self.euler.sweep(&s.times, start, |_, w, s: &Sensitivity<8>| {
                information += s.transpose() * s;
                sum += s.transpose() * (m * w) * 2.0;
            });
            let own = information.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?;
            let mixed = information.fixed_view::<3, 5>(5, 0).into_owned();
            let start = sum.fixed_rows::<3>(5).into_owned();
            shared += sum.fixed_rows::<5>(0) - mixed.transpose() * own.solve(&start);
        }
        Some(shared)
    }
}

/// The Cramér–Rao bound on the tensor with trace 1 of a body that is known: what a record of its free motion can tell
/// at best, before it is made. Covariance of the entries xx, yy, zz, xy, xz, yz in body axes.
///
/// `omega_body` (rad/s, body axes) is the angular velocity at the first of `times` (s, ascending); `sigma` is the
/// standard deviation of the noise of one component, rad/s.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::{inertia::Inertia, fit::foreseen_bound};
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// let tumble = foreseen_bound(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3).ok_or("tumbles")?;
/// let wobble = foreseen_bound(&body, Vector3::new(0.03, 0.03, 1.0), &times, 1e-3).ok_or("wobbles")?;
/// assert!(wobble.trace() > 100.0 * tumble.trace());
/// assert!(foreseen_bound(&body, Vector3::new(0.0, 0.0, 1.0), &times, 1e-3).is_none()); // a pure spin
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// `None` where the motion does not determine the tensor, or an argument is not finite.
pub fn foreseen_bound(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    sigma: f64,
) -> Option<SMatrix<f64, 6, 6>> {
    let shape = inertia.tensor() / inertia.tensor().trace();
    let euler = Euler::new(shape)?;
    // in units of the rate, as in a fit
    let rate = omega_body.norm();
    let times: Vec<f64> = times.iter().map(|t| t * rate).collect();
    let start = Start { time: times.first().copied()?, rate: omega_body / rate };
    let deviation = sigma / rate;
    let information = of_tensor(&euler.information(&times, &start))?;
    let (spectrum, _) = eigen(information);
    // what a pure spin leaves open is zero up to the rounding of sums of squares
    if spectrum[0].is_nan() || spectrum[0] <= 1e-12 * spectrum[4] {
        return None;
    }
    let bound = (information / (deviation * deviation)).cholesky()?.inverse();
    let entries = entries_of_coordinates();
    Some(entries * bound * entries.transpose()).filter(|b| b.iter().all(|v| v.is_finite()))
}

/// Value and slope at sample `at` of the cubic through all samples within `radius`, or the nearest few.
pub(super) fn local_cubic(s: &Stretch, at: usize, radius: f64) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let t = s.times[at];
    let low = s.times.partition_point(|&u| u < t - radius).min(at.saturating_sub(3));
    let high = s.times.partition_point(|&u| u <= t + radius).max((at + 4).min(s.times.len()));
    let unit = (s.times[high - 1] - s.times[low]).max(f64::MIN_POSITIVE);
    let mut normal = SMatrix::<f64, 4, 4>::zeros();
    let mut right = SMatrix::<f64, 4, 3>::zeros();
    for i in low..high {
        let u = (s.times[i] - t) / unit;
        let powers = SMatrix::<f64, 4, 1>::new(1.0, u, u * u, u * u * u);
        normal += powers * powers.transpose();
        right += powers * s.rates[i].transpose();
    }
    let solution = normal.cholesky()?.solve(&right);
    Some((solution.row(0).transpose(), solution.row(1).transpose() / unit))
}
