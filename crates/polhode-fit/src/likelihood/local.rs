//! Attitude and rate at nodes along a stretch of attitudes, each by a parabola of the rotation vectors about it.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use polhode::record::median;
use polhode::rotation::{Quat, Vec3};

use crate::thresholds::likelihood::{FEWEST, NODE};
use crate::thresholds::noise::OUTLYING;

/// Attitude and rate at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) time: f64,
    pub(crate) attitude: Quat<f64>,
    pub(crate) rate: Vector3<f64>,
    /// Variance of a component of the rate, per variance of a component of an attitude.
    pub(crate) variance: f64,
}

/// Nodes half a width apart, of at least [`FEWEST`] samples each.
pub(crate) fn nodes(times: &[f64], attitudes: &[Quat<f64>], width: f64) -> Vec<Node> {
    let mut found: Vec<Node> = Vec::new();
    let mut middle = 0;
    while middle < times.len() {
        found.extend(node(times, attitudes, middle, width));
        let next = times.partition_point(|t| *t < times[middle] + 0.5 * width);
        middle = next.max(middle + 1);
    }
    found
}

/// The node at sample `middle`, of the samples within half of `width`, and at least of the nearest few.
pub(crate) fn node(times: &[f64], attitudes: &[Quat<f64>], middle: usize, width: f64) -> Option<Node> {
    let t = times[middle];
    let mut low = times.partition_point(|u| *u < t - 0.5 * width);
    let mut high = times.partition_point(|u| *u <= t + 0.5 * width);
    while high - low < FEWEST && high - low < times.len() {
        let before = low.checked_sub(1).map(|k| t - times[k]);
        let after = times.get(high).map(|u| u - t);
        match (before, after) {
            (Some(before), Some(after)) if before < after => low -= 1,
            (Some(_), None) => low -= 1,
            _ => high += 1,
        }
    }
    let unit = times[high - 1] - times[low];
    if high - low < FEWEST || unit <= 0.0 {
        return None;
    }
    let from = attitudes[middle].conjugate();
    let (mut normal, mut right) = (Matrix3::zeros(), SMatrix::<f64, 3, 3>::zeros());
    for k in low..high {
        let u = (times[k] - t) / unit;
        let powers = SVector::<f64, 3>::new(1.0, u, u * u);
        let turn: Vector3<f64> = (from * attitudes[k]).logarithm().into();
        normal += powers * powers.transpose();
        right += powers * turn.transpose();
    }
    let inverse = normal.cholesky()?.inverse();
    let fitted = inverse * right;
    let turn: Vector3<f64> = fitted.row(0).transpose();
    Some(Node {
        time: t,
        attitude: attitudes[middle] * Quat::exponential(Vec3::from(turn)),
        rate: fitted.row(1).transpose() / unit,
        variance: inverse[(1, 1)] / (unit * unit),
    })
}

/// A width within which the body turns by about [`NODE`], by doubling; `noise` is the standard deviation of a component of an attitude.
pub(crate) fn width(stretches: &[(Vec<f64>, Vec<Quat<f64>>)], noise: f64) -> Option<f64> {
    let step = |times: &[f64]| Some((times.last()? - times.first()?) / (times.len().checked_sub(1)? as f64));
    let steps = stretches.iter().filter_map(|(times, _)| step(times)).filter(|step| *step > 0.0);
    let longest = stretches.iter().filter_map(|(t, _)| Some(t.last()? - t.first()?)).fold(0.0, f64::max);
    let mut width = (FEWEST - 1) as f64 * steps.fold(f64::INFINITY, f64::min);
    while width < longest {
        let (mut square, mut count) = (0.0, 0.0);
        for node in stretches.iter().flat_map(|(times, attitudes)| nodes(times, attitudes, width)) {
            square += node.rate.norm_squared() - 3.0 * node.variance * noise * noise;
            count += 1.0;
        }
        if width * (square / count).max(0.0).sqrt() >= NODE {
            return Some(width);
        }
        width *= 2.0;
    }
    longest.is_finite().then_some(longest).filter(|longest| *longest > 0.0)
}

/// Standard deviation of a component of the attitudes, from what local cubics leave of the rotation vectors of five neighbouring samples:
/// the motion itself is left too where the body turns far between samples.
pub(crate) fn noise(stretches: &[(Vec<f64>, Vec<Quat<f64>>)]) -> Option<f64> {
    let mut squares: Vec<f64> = Vec::new();
    for (times, attitudes) in stretches {
        for (t, q) in times.windows(5).zip(attitudes.windows(5)) {
            let h = t[4] - t[0];
            let c: [f64; 5] = core::array::from_fn(|i| {
                (0..5).filter(|&j| j != i).map(|j| (t[i] - t[j]) / h).fold(1.0, |p, d| p / d)
            });
            let norm: f64 = c.iter().map(|c| c * c).sum();
            let from = q[2].conjugate();
            let left = (0..5).fold(Vec3([0.0; 3]), |sum, i| sum + (from * q[i]).logarithm() * c[i]);
            squares.push(left.norm_squared() / (3.0 * norm));
        }
    }
    let median = median(&mut squares)?;
    let limit = if median > 0.0 { OUTLYING * median } else { f64::INFINITY };
    let kept = squares.iter().filter(|square| **square <= limit);
    let (sum, count) = kept.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
    Some((sum / count).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::num::Random;

    /// A steady spin of 2 rad/s at 50 Hz, with noise.
    fn spin(noise: f64) -> (Vec<f64>, Vec<Quat<f64>>) {
        let mut random = Random::new(5);
        let times: Vec<f64> = (0..500).map(|k| 0.02 * f64::from(k)).collect();
        let turn = |t: &f64| Quat::exponential(Vec3([0.0, 2.0 * t, 0.0]));
        let off = |random: &mut Random| Quat::exponential(Vec3::from(random.normal_vector() * noise));
        let attitudes = times.iter().map(|t| turn(t) * off(&mut random)).collect();
        (times, attitudes)
    }

    #[test]
    fn noise_and_rate_of_a_steady_spin() {
        for sigma in [1e-4, 1e-2] {
            let stretch = [spin(sigma)];
            let found = noise(&stretch).unwrap();
            assert!((found / sigma - 1.0).abs() < 0.1, "{found:e}");
            let width = super::width(&stretch, found).unwrap();
            assert!((NODE..2.5 * NODE).contains(&(2.0 * width)), "{width}");
            let nodes = super::nodes(&stretch[0].0, &stretch[0].1, width);
            let (mut off, mut stated) = (0.0, 0.0);
            for node in &nodes {
                off += (node.rate - Vector3::new(0.0, 2.0, 0.0)).norm_squared() / 3.0;
                stated += node.variance * sigma * sigma;
            }
            assert!((0.5..2.0).contains(&(off / stated)), "{off:e} {stated:e}");
        }
    }

    /// The fourth divided difference of five attitudes leaves of one that is off what its weight is among all: of even times 1, −4, 6, −4, 1,
    /// whose squares are 70, of 0, 1, 3, 4 and 5 s 2, −5, 10, −10, 3, whose squares are 238.
    #[test]
    fn noise_is_what_the_fourth_difference_leaves() {
        let even = ([0.0, 0.5, 1.0, 1.5, 2.0], [1.0, -4.0, 6.0, -4.0, 1.0], 70.0);
        let uneven = ([0.0, 1.0, 3.0, 4.0, 5.0], [2.0, -5.0, 10.0, -10.0, 3.0], 238.0);
        for (times, weights, squares) in [even, uneven] {
            for (k, weight) in weights.into_iter().enumerate() {
                let off = |i: usize| Quat::exponential(Vec3([0.0, if i == k { 0.01 } else { 0.0 }, 0.0]));
                let found = noise(&[(times.to_vec(), (0..5).map(off).collect())]).unwrap();
                let expected = f64::abs(weight) * 0.01 / f64::sqrt(3.0 * squares);
                assert!((found / expected - 1.0).abs() < 1e-12, "{k}: {found:e} {expected:e}");
            }
        }
    }

    /// Widths double from two intervals of the densest stretch until the body turns by a radian; where it never does the longest is one.
    #[test]
    fn widths_double_to_a_radian() {
        let turning = |rate: f64, step: f64, count: u32| {
            let times: Vec<f64> = (0..count).map(|k| step * f64::from(k)).collect();
            let turned = |t: &f64| Quat::exponential(Vec3([0.0, rate * t, 0.0]));
            let attitudes: Vec<Quat<f64>> = times.iter().map(turned).collect();
            (times, attitudes)
        };
        // of 2/64 · 1, 2, 4, 8 and 16 the last takes 1.1 rad
        let dense = turning(2.2, 1.0 / 64.0, 320);
        assert_eq!(super::width(core::slice::from_ref(&dense), 0.0), Some(0.5));
        assert_eq!(super::width(&[turning(2.2, 0.25, 20), dense], 0.0), Some(0.5));
        assert_eq!(super::width(&[turning(0.01, 0.25, 17)], 0.0), Some(4.0));
        assert!(super::width(&[(vec![1.0], vec![Quat::identity()])], 0.0).is_none());
    }
}
