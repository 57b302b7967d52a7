//! Extended Kalman filter with the rate and the tensor as its state, and the iterated smoother.
//!
//! The tensor does not change and no torque acts, so there is no process noise. The filter runs over the record several
//! times, each time linearised about the tensor that the last run ended with, and with the wide prior of the first. The smoother is
//! linearised about the motion that ends where the last run ended: without process noise that motion is its smoothed one, and its
//! rounds are those of Gauss and Newton for the prior and the record.
//!
//! Source: B. M. Bell, SIAM J. Optim. 4 (1994) 626.

use nalgebra::{Matrix3, Matrix5, SMatrix, SVector, Vector3, Vector5};

use super::Answer;
use super::coordinates::tensor;
use super::euler::{Euler, Sensitivity, at_start};
use super::record::Stretch;

const RUNS: usize = 3;
/// Most rounds of the smoother.
const ROUNDS: usize = 20;
/// Step of the tensor, in standard deviations, that ends them.
const STILL: f64 = 1e-2;
/// Moments stay above this share of the trace, where a step of the filter would take them below.
const SMALLEST: f64 = 0.01;

/// A tensor, its covariance, and the rate at the end of each stretch.
type Passed = (Vector5<f64>, Matrix5<f64>, Vec<Vector3<f64>>);
type State = SVector<f64, 8>;
type Covariance = SMatrix<f64, 8, 8>;

/// From the coordinates `x`, which are known to `prior` beforehand, a share of the trace. `None` where the filter has diverged.
pub(super) fn filtered(stretches: &[Stretch], x: Vector5<f64>, prior: f64, sigma: f64) -> Option<Answer> {
    let (mut x, mut covariance) = (x, Matrix5::zeros());
    for _ in 0..RUNS {
        (x, covariance, _) = pass(stretches, x, prior, sigma)?;
    }
    Answer::constrained(x, covariance.try_inverse()?)
}

/// The same, smoothed. `None` where the rounds do not come to rest.
pub(super) fn smoothed(stretches: &[Stretch], first: Vector5<f64>, prior: f64, sigma: f64) -> Option<Answer> {
    let (mut x, _, mut ends) = pass(stretches, first, prior, sigma)?;
    for _ in 0..ROUNDS {
        let euler = Euler::new(&x)?;
        let (mut off, mut covariance) = (first - x, Matrix5::identity() * (prior * prior));
        let mut next_ends = Vec::with_capacity(ends.len());
        for (s, end) in stretches.iter().zip(&ends) {
            let (z, p) = about(s, &euler, end, (&off, &covariance), sigma)?;
            off = z.fixed_rows::<5>(0).into_owned();
            covariance = p.fixed_view::<5, 5>(0, 0).into_owned();
            next_ends.push(end + z.fixed_rows::<3>(5));
        }
        let information = covariance.try_inverse()?;
        (x, ends) = (x + off, next_ends);
        if !x.iter().all(|v| v.is_finite()) {
            return None;
        }
        if off.dot(&(information * off)).sqrt() < STILL {
            return Answer::constrained(x, information);
        }
    }
    None
}

/// One run of the filter over all stretches.
fn pass(stretches: &[Stretch], mut x: Vector5<f64>, prior: f64, sigma: f64) -> Option<Passed> {
    let mut covariance = Matrix5::identity() * (prior * prior);
    let mut ends = Vec::with_capacity(stretches.len());
    for s in stretches {
        let (z, p) = filter(s, &x, &covariance, sigma)?;
        x = z.fixed_rows::<5>(0).into_owned();
        covariance = p.fixed_view::<5, 5>(0, 0).into_owned();
        ends.push(z.fixed_rows::<3>(5).into_owned());
    }
    Some((x, covariance, ends))
}

/// The linear filter of deviations from the motion of one tensor that ends at the rate `end`: those of the tensor, of which mean and
/// covariance are given, and of the rate at the end.
fn about(
    s: &Stretch,
    euler: &Euler,
    end: &Vector3<f64>,
    (mean, prior): (&Vector5<f64>, &Matrix5<f64>),
    sigma: f64,
) -> Option<(State, Covariance)> {
    // back from the end, then forth: rates, and derivatives from each sample to the next
    let mut rate = *end;
    let mut rates = vec![rate];
    for times in s.times.windows(2).rev() {
        euler.carry(&mut rate, times[0] - times[1]);
        rates.push(rate);
    }
    rates.reverse();
    let mut z = State::zeros();
    z.fixed_rows_mut::<5>(0).copy_from(mean);
    z.fixed_rows_mut::<3>(5).copy_from(&(s.rates[0] - rates[0]));
    let mut p = Covariance::identity() * (sigma * sigma);
    p.fixed_view_mut::<5, 5>(0, 0).copy_from(prior);
    for i in 1..s.times.len() {
        let (mut moved, mut by) = (rates[i - 1], at_start());
        euler.advance(&mut moved, &mut by, s.times[i] - s.times[i - 1]);
        let rate = by * z;
        z.fixed_rows_mut::<3>(5).copy_from(&rate);
        update(&mut z, &mut p, &by, sigma, |rate| s.rates[i] - rates[i] - rate)?;
    }
    z.iter().all(|v| v.is_finite()).then_some((z, p))
}

/// Moves the covariance by the derivative of the rate, and takes a reading in.
fn update(
    z: &mut State,
    p: &mut Covariance,
    by: &Sensitivity<8>,
    sigma: f64,
    left: impl Fn(Vector3<f64>) -> Vector3<f64>,
) -> Option<()> {
    let mut moved = Covariance::identity();
    moved.fixed_view_mut::<3, 8>(5, 0).copy_from(by);
    *p = moved * *p * moved.transpose();
    let innovation = p.fixed_view::<3, 3>(5, 5) + Matrix3::identity() * (sigma * sigma);
    let gain = p.fixed_view::<8, 3>(0, 5) * innovation.try_inverse()?;
    *z += gain * left(z.fixed_rows::<3>(5).into_owned());
    *p -= gain * p.fixed_view::<3, 8>(5, 0).into_owned();
    *p = (*p + p.transpose()) * 0.5;
    Some(())
}

fn filter(
    s: &Stretch,
    x: &Vector5<f64>,
    prior: &SMatrix<f64, 5, 5>,
    sigma: f64,
) -> Option<(State, Covariance)> {
    let variance = sigma * sigma;
    let mut z = State::zeros();
    z.fixed_rows_mut::<5>(0).copy_from(x);
    z.fixed_rows_mut::<3>(5).copy_from(&s.rates[0]);
    let mut p = Covariance::identity() * variance;
    p.fixed_view_mut::<5, 5>(0, 0).copy_from(prior);
    for i in 1..s.times.len() {
        let mut rate = Vector3::new(z[5], z[6], z[7]);
        let mut sensitivity = at_start();
        Euler::new(&z.fixed_rows::<5>(0).into_owned())?.advance(
            &mut rate,
            &mut sensitivity,
            s.times[i] - s.times[i - 1],
        );
        z.fixed_rows_mut::<3>(5).copy_from(&rate);
        update(&mut z, &mut p, &sensitivity, sigma, |rate| s.rates[i] - rate)?;
        let physical = bounded(&z.fixed_rows::<5>(0).into_owned());
        z.fixed_rows_mut::<5>(0).copy_from(&physical);
        if !z.iter().all(|v| v.is_finite()) {
            return None;
        }
    }
    Some((z, p))
}

/// The coordinates moved towards the sphere until no moment is too small.
pub(super) fn bounded(x: &Vector5<f64>) -> Vector5<f64> {
    let eigen = tensor(x).symmetric_eigenvalues();
    let smallest = eigen.min();
    if smallest >= SMALLEST {
        return *x;
    }
    x * ((1.0 / 3.0 - SMALLEST) / (1.0 / 3.0 - smallest))
}
