//! The step of digital readings.

use nalgebra::Vector3;

use super::segment::Segment;

/// Samples that are looked at.
const LOOKED_AT: usize = 4096;
/// Fewest distinct values that tell a step, and the share of the samples that they may be: readings that hardly repeat have
/// no step that matters.
const DISTINCT: (usize, f64) = (4, 0.5);
/// How far from a whole number of steps the differences of readings may be, by the rounding of their text.
const WHOLE: f64 = 0.02;

/// The common step of each component, 0 where it has none.
pub(crate) fn quanta<'a>(rates: impl Iterator<Item = &'a Vector3<f64>>) -> Vector3<f64> {
    let some: Vec<&Vector3<f64>> = rates.take(LOOKED_AT).collect();
    Vector3::from_fn(|axis, _| step(some.iter().map(|w| w[axis]).collect()).unwrap_or(0.0))
}

/// Whether readings rest on too few values to tell their step: on two or three of a component, or on one of each.
pub(crate) fn rests<'a>(rates: impl Iterator<Item = &'a Vector3<f64>>) -> bool {
    let mut known: [Vec<f64>; 3] = [Vec::new(), Vec::new(), Vec::new()];
    for rate in rates.take(LOOKED_AT) {
        for (values, x) in known.iter_mut().zip(rate.iter()) {
            if values.len() < DISTINCT.0 && !values.contains(x) {
                values.push(*x);
            }
        }
    }
    let counts = known.map(|values| values.len());
    counts == [1; 3] || counts.iter().any(|count| (2..DISTINCT.0).contains(count))
}

/// Variance of the rounding of one component to steps of `quanta`, the mean of all three.
///
/// An error of rounding is uniform within a step, q²/12. While a reading rests on a step its errors are one and the same:
/// n equal readings in a row tell as little as one of them, so that a mean counts each with n times that variance.
pub(crate) fn rounding(segments: &[Segment], quanta: &Vector3<f64>) -> f64 {
    let mut sum = 0.0;
    for axis in (0..3).filter(|&axis| quanta[axis] > 0.0) {
        let (mut squares, mut samples) = (0.0, 0.0);
        for segment in segments {
            for run in segment.rates().chunk_by(|a, b| a[axis] == b[axis]) {
                squares += (run.len() * run.len()) as f64;
                samples += run.len() as f64;
            }
        }
        sum += quanta[axis] * quanta[axis] / 36.0 * squares / f64::max(samples, 1.0);
    }
    sum
}

fn step(mut values: Vec<f64>) -> Option<f64> {
    let samples = values.len() as f64;
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < DISTINCT.0 || values.len() as f64 > DISTINCT.1 * samples {
        return None;
    }
    let apart: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // differences of conversions of one step scatter by their rounding
    let least = apart.iter().copied().fold(f64::INFINITY, f64::min);
    let mut count = 0.0;
    for difference in &apart {
        let steps = (difference / least).round();
        if (difference / least - steps).abs() > WHOLE * steps {
            return None;
        }
        count += steps;
    }
    Some((values[values.len() - 1] - values[0]) / count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    #[test]
    fn a_step_is_found_where_there_is_one() {
        let mut random = Random::new(3);
        let smooth: Vec<Vector3<f64>> = (0..3000).map(|_| random.normal_vector()).collect();
        assert_eq!(quanta(smooth.iter()), Vector3::zeros());
        let degree = core::f64::consts::PI / 180.0;
        let stepped: Vec<_> = smooth.iter().map(|w| w.map(|x| (x / degree).round() * degree)).collect();
        assert!((quanta(stepped.iter()) - Vector3::repeat(degree)).amax() < 1e-12);
        // six digits in a file
        let digits: Vec<_> = stepped.iter().map(|w| w.map(|x| (x * 1e6).round() / 1e6)).collect();
        assert!((quanta(digits.iter()) - Vector3::repeat(degree)).amax() < 1e-6);
        let fine: Vec<_> = smooth.iter().map(|w| w.map(|x| (x * 1e6).round() / 1e6)).collect();
        assert_eq!(quanta(fine.iter()), Vector3::zeros());
        assert_eq!(quanta([Vector3::zeros(); 100].iter()), Vector3::zeros());
    }

    /// Steps of which a component has fewer than four are not told; a component that stays beside others that move is not measured.
    #[test]
    fn readings_on_three_steps_rest_and_those_on_four_have_a_step() {
        let on = |steps: usize| -> Vec<Vector3<f64>> {
            let value = |k: usize| 0.02 * (k % steps) as f64;
            (0..300).map(|k| Vector3::new(value(k), 0.1 * k as f64, 0.0)).collect()
        };
        for steps in 1..6 {
            let readings = on(steps);
            assert_eq!(rests(readings.iter()), (2..4).contains(&steps), "{steps}");
            assert_eq!(quanta(readings.iter()).x > 0.0, steps >= 4, "{steps}");
        }
        assert!(rests([Vector3::repeat(0.02); 300].iter()));
    }
}
