//! The motion of a given tensor that is nearest to a stretch of samples.

use crate::thresholds::bound::{CHANGE, DAMPING, LEFT, STARTS, STEPS, STILL, SURE, WIDTH};
use core::ops::Range;
use std::borrow::Cow;

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::record::both;

use crate::bound::sensitivity::{Euler, Sensitivity, Start};
use crate::signal::stretch::Stretch;
use crate::thresholds::radius::LONG;

/// Samples, or means of neighbouring ones.
struct Means<'a> {
    times: Cow<'a, [f64]>,
    rates: Cow<'a, [Vector3<f64>]>,
    /// How many each is of; of single samples there are none.
    counts: Vec<f64>,
}

impl<'a> Means<'a> {
    fn of_one(s: &'a Stretch) -> Self {
        Means { times: s.times.as_slice().into(), rates: s.rates.as_slice().into(), counts: Vec::new() }
    }

    /// Over at most `width`.
    fn new(s: &Stretch, width: f64) -> Self {
        let (mut times, mut rates, mut counts) = (Vec::new(), Vec::new(), Vec::new());
        let mut low = 0;
        while low < s.times.len() {
            let high = s.times.partition_point(|&t| t <= s.times[low] + width).max(low + 1);
            let count = (high - low) as f64;
            // about the first, so that one sample stays as it is
            let first = s.times[low];
            times.push(first + s.times[low..high].iter().map(|t| t - first).sum::<f64>() / count);
            rates.push(s.rates[low..high].iter().sum::<Vector3<f64>>() / count);
            counts.push(count);
            low = high;
        }
        Means { times: times.into(), rates: rates.into(), counts }
    }

    /// Those at most `radius` from `time`.
    fn around(&self, time: f64, radius: f64) -> Range<usize> {
        let low = self.times.partition_point(|&t| t < time - radius);
        low..self.times.partition_point(|&t| t <= time + radius)
    }
}

/// How far a motion is from samples, and which way leads nearer.
struct Distance {
    information: Matrix3<f64>,
    gradient: Vector3<f64>,
    sum: f64,
}

impl Distance {
    fn new(euler: &Euler, means: &Means<'_>, range: Range<usize>, start: &Start) -> Distance {
        // a step of the integrator takes as long as many other sums over a sample
        if range.len() <= LONG / 10 {
            return Distance::one_by_one(euler, means, range, start);
        }
        // what comes before and after the start side by side, whatever the machine is
        let split = range.start + means.times[range.clone()].partition_point(|t| *t < start.time);
        let of = |own: Range<usize>| Distance::one_by_one(euler, means, own, start);
        let (after, before) = both(true, || of(split..range.end), || of(range.start..split));
        Distance {
            information: after.information + before.information,
            gradient: after.gradient + before.gradient,
            sum: after.sum + before.sum,
        }
    }

    fn one_by_one(euler: &Euler, means: &Means<'_>, range: Range<usize>, start: &Start) -> Distance {
        let mut distance = Distance { information: Matrix3::zeros(), gradient: Vector3::zeros(), sum: 0.0 };
        let low = range.start;
        euler.sweep(&means.times[range], start, |i, w, s: &Sensitivity<3>| {
            let count = means.counts.get(low + i).copied().unwrap_or(1.0);
            let residual = means.rates[low + i] - w;
            distance.information += s.transpose() * s * count;
            distance.gradient += s.transpose() * residual * count;
            distance.sum += residual.norm_squared() * count;
        });
        distance
    }
}

/// The start of the motion nearest to the samples of a window by Levenberg's damped steps, the tensor held.
fn descend(
    euler: &Euler,
    means: &Means<'_>,
    range: Range<usize>,
    mut start: Start,
    variance: f64,
) -> Option<(Start, f64)> {
    let equations = 3.0 * range.len() as f64;
    let mut now = Distance::new(euler, means, range.clone(), &start);
    let mut damping = 0.0;
    for _ in 0..STEPS {
        let ridge = Matrix3::identity() * (damping * now.information.trace());
        let step = (now.information + ridge).cholesky()?.solve(&now.gradient);
        if step.dot(&now.gradient) <= STILL * variance.max(now.sum / equations) {
            break;
        }
        let there = Start { rate: start.rate + step, ..start };
        let next = Distance::new(euler, means, range.clone(), &there);
        if next.sum < now.sum {
            (start, now) = (there, next);
            damping *= 0.1;
        } else {
            damping = (CHANGE * damping).max(DAMPING);
        }
    }
    Some((start, now.sum)).filter(|(_, sum)| sum.is_finite())
}

/// The motion of a given tensor that explains the samples of a stretch, and the sum of squares that it leaves; `None` if none was found.
///
/// The sum of squares over a whole stretch has many minima, one for each number of turns that the motion may be ahead or behind.
/// A window within which the motion turns by little has one, and what it leaves uncertain of the motion in a window
/// twice as long is small against a turn: each window starts where the one before has ended.
pub(super) fn nearest_motion(euler: &Euler, s: &Stretch, variance: f64) -> Option<(Start, f64)> {
    let samples = Means::of_one(s);
    let coarse = Means::new(s, WIDTH);
    let mean = s.rates.iter().sum::<Vector3<f64>>() / s.rates.len() as f64;
    let variation: f64 = s.rates.iter().map(|w| (w - mean).norm_squared()).sum();
    // noise of 3n components, and five standard deviations of the sum of their squares
    let components = 3.0 * s.rates.len() as f64;
    let noise = variance * components;
    let slack = SURE * variance * (2.0 * components).sqrt();
    let most = noise + LEFT * (variation - noise).max(0.0) + slack;
    STARTS.iter().find_map(|&(share, first)| {
        let at = (share * s.times.len() as f64) as usize;
        let mut start = Start { time: s.times[at], rate: local_cubic(s, at, first)? };
        let mut radius = first;
        loop {
            let range = coarse.around(start.time, radius);
            if range.len() >= 4 {
                let left;
                (start, left) = descend(euler, &coarse, range, start, variance)?;
                // what is left of all is no less
                if left > most {
                    return None;
                }
            }
            if radius >= s.duration() || radius.is_infinite() {
                break;
            }
            radius *= 2.0;
        }
        let (start, left) = descend(euler, &samples, 0..s.times.len(), start, variance)?;
        (left <= most).then_some((start, left))
    })
}

/// Value at sample `at` of the cubic through all samples within `radius`, or the nearest few.
fn local_cubic(s: &Stretch, at: usize, radius: f64) -> Option<Vector3<f64>> {
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
    Some(solution.row(0).transpose())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means are of samples at most a width after the first of them, each with its count; around a time both ends belong to them.
    #[test]
    fn means_are_of_neighbours() {
        let times = vec![0.0, 1.0, 2.0, 10.0, 11.5, 11.75];
        let rates = (0..6).map(|k| Vector3::new(f64::from(k), 1.0, 0.0)).collect();
        let s = Stretch::new(times, rates);
        let means = Means::new(&s, 1.5);
        assert_eq!(means.times.to_vec(), [0.5, 2.0, 10.75, 11.75]);
        assert_eq!(means.rates.iter().map(|w| w.x).collect::<Vec<_>>(), [0.5, 2.0, 3.5, 5.0]);
        assert_eq!(means.counts, [2.0, 1.0, 2.0, 1.0]);
        assert!(means.rates.iter().all(|w| w.y == 1.0 && w.z == 0.0));
        assert_eq!(means.around(2.0, 1.5), 0..2);
        assert_eq!(means.around(6.0, 3.0), 2..2);
        assert_eq!(means.around(10.75, 1.0), 2..4);
        let one = Means::of_one(&s);
        assert!(one.times.to_vec() == s.times && one.rates.to_vec() == s.rates && one.counts.is_empty());
    }

    /// A cubic through samples of a cubic is that cubic, also where fewer than four lie within the radius, and at the ends.
    #[test]
    fn a_cubic_is_its_own_fit() {
        let times: Vec<f64> = [0, 1, 3, 4, 7, 9, 10, 14].map(f64::from).to_vec();
        let of = |t: &f64| Vector3::new(1.0 + t * (0.5 - t * (0.2 - t * 0.01)), -t * t * t * 1e-2, 3.0);
        let s = Stretch::new(times.clone(), times.iter().map(of).collect());
        for at in 0..times.len() {
            for radius in [0.5, 4.0, 100.0] {
                let found = local_cubic(&s, at, radius).unwrap();
                assert!((found - s.rates[at]).amax() < 1e-6, "{at} {radius}: {found}");
            }
        }
    }

    /// The sum of squares, each mean as often as it has samples, falls by twice its gradient and grows by its information.
    #[test]
    fn distances_fall_as_their_gradient_says() {
        let euler = Euler::new(Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45))).unwrap();
        let start = Start { time: 2.0, rate: Vector3::new(0.5, 0.8, -0.4) };
        let times: Vec<f64> = (0..40).map(|k| 0.125 * f64::from(k)).collect();
        let line = |t: &f64| Vector3::new(0.5 - 0.1 * t, 0.6, 0.1 * t - 0.4);
        let s = Stretch::new(times.clone(), times.iter().map(line).collect());
        // three samples each
        let means = Means::new(&s, 0.3);
        let sum = |means: &Means<'_>, rate: Vector3<f64>| {
            let mut sum = 0.0;
            euler.sweep(&means.times[2..11], &Start { rate, ..start }, |i, w, _: &Sensitivity<3>| {
                sum += 3.0 * (means.rates[2 + i] - w).norm_squared();
            });
            sum
        };
        let found = Distance::new(&euler, &means, 2..11, &start);
        assert!((found.sum / sum(&means, start.rate) - 1.0).abs() < 1e-12);
        // the number of steps of the integrator may change with the rate, and the sum by 1e-5 with it
        let h = 1e-3;
        for k in 0..3 {
            let step = Vector3::ith(k, h);
            let slope = (sum(&means, start.rate + step) - sum(&means, start.rate - step)) / (2.0 * h);
            let apart = (slope + 2.0 * found.gradient[k]).abs();
            assert!(apart < 2e-2 * found.gradient.amax(), "{k}: {slope} {}", found.gradient[k]);
        }
        // about the motion itself nothing but the quadratic form is left
        let mut rates = means.rates.to_vec();
        euler.sweep(&means.times, &start, |i, w, _: &Sensitivity<3>| rates[i] = *w);
        let (times, counts) = (means.times.clone(), means.counts.clone());
        let of_motion = Means { times, rates: rates.into(), counts };
        for step in [Vector3::new(0.6, -0.5, 0.3), Vector3::new(-0.2, 0.1, 0.7)].map(|step| step * 3e-4) {
            let expected = step.dot(&(found.information * step));
            assert!((sum(&of_motion, start.rate + step) / expected - 1.0).abs() < 3e-2, "{step}");
        }
    }

    /// A long range is gone through from its start to both ends side by side, which changes no sum.
    #[test]
    fn a_long_range_is_the_sum_of_both_sides() {
        let euler = Euler::new(Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45))).unwrap();
        let start = Start { time: 3.0, rate: Vector3::new(0.5, 0.8, -0.4) };
        let count = LONG / 10 + 4;
        let times: Vec<f64> = (0..count).map(|k| k as f64 / 1024.0).collect();
        let s = Stretch::new(times, vec![Vector3::new(0.4, 0.7, 0.0); count]);
        let means = Means::of_one(&s);
        let range = 2..count - 1;
        let found = Distance::new(&euler, &means, range.clone(), &start);
        let one = Distance::one_by_one(&euler, &means, range, &start);
        assert!((found.sum / one.sum - 1.0).abs() < 1e-10);
        assert!((found.gradient - one.gradient).amax() < 1e-10 * one.gradient.amax());
        assert!((found.information - one.information).amax() < 1e-10 * one.information.amax());
    }

    /// The cubic by least squares is a sum of the samples within the radius, three on each side at least, with weights that are known of
    /// seven and of nine.
    #[test]
    fn the_cubic_is_by_the_samples_within_the_radius() {
        let times: Vec<f64> = (0..11).map(f64::from).collect();
        let mut rates = vec![Vector3::zeros(); 11];
        rates[5] = Vector3::x();
        let s = Stretch::new(times, rates);
        // (−2, 3, 6, 7, 6, 3, −2)/21 and (−21, 14, 39, 54, 59, 54, 39, 14, −21)/231
        for (at, radius, weight) in [
            (5, 2.0, 7.0 / 21.0),
            (4, 2.0, 6.0 / 21.0),
            (3, 3.0, 3.0 / 21.0),
            (7, 3.0, 3.0 / 21.0),
            (5, 3.5, 7.0 / 21.0),
            (5, 4.0, 59.0 / 231.0),
            (4, 4.0, 54.0 / 231.0),
            (6, 4.0, 54.0 / 231.0),
        ] {
            let found = local_cubic(&s, at, radius).unwrap();
            assert!((found - Vector3::x() * weight).amax() < 1e-9, "{at} {radius}: {found}");
        }
    }
}
