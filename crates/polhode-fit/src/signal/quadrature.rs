//! Weights of order 4 on irregular samples.

use crate::thresholds::quadrature::NEAREST;

/// Weights w with Σ w_i f(t_i) ≈ ∫ f over the span of ascending `times`: each interval integrates the cubic
/// through its two ends and one more sample on each side.
///
/// A neighbour closer than a quarter of the interval is passed over for the next one: through two samples that
/// nearly coincide a cubic would magnify their noise. On a uniform grid all inner weights are the spacing.
pub(crate) fn weights(times: &[f64]) -> Vec<f64> {
    let n = times.len();
    let mut weights = vec![0.0; n];
    for i in 0..n.saturating_sub(1) {
        let (a, b) = (times[i], times[i + 1]);
        let h = b - a;
        let before = (0..i).rev().find(|&k| a - times[k] >= NEAREST * h);
        let after = (i + 2..n).find(|&k| times[k] - b >= NEAREST * h);
        // at an end both come from the same side
        let second = |from: usize, up: bool| {
            let far = |k: &usize| (times[*k] - times[from]).abs() >= NEAREST * h;
            if up { (from + 1..n).find(far) } else { (0..from).rev().find(far) }
        };
        let (p, q) = match (before, after) {
            (Some(p), Some(q)) => (Some(p), Some(q)),
            (Some(p), None) => (Some(p), second(p, false)),
            (None, Some(q)) => (Some(q), second(q, true)),
            (None, None) => (None, None),
        };
        let (mut nodes, mut count) = ([i, i + 1, 0, 0], 2);
        for node in [p, q].into_iter().flatten() {
            nodes[count] = node;
            count += 1;
        }
        for (k, &node) in nodes[..count].iter().enumerate() {
            let (mut zeros, mut found) = ([0.0; 3], 0);
            for (_, &other) in nodes[..count].iter().enumerate().filter(|(l, _)| *l != k) {
                zeros[found] = times[other];
                found += 1;
            }
            weights[node] += lagrange_integral(times[node], &zeros[..found], a, b);
        }
    }
    weights
}

/// ∫ from a to b of Π (t − z)/(node − z) over at most three zeros z, by Simpson's rule, exact for cubics.
fn lagrange_integral(node: f64, zeros: &[f64], a: f64, b: f64) -> f64 {
    let value = |t: f64| zeros.iter().map(|z| t - z).product::<f64>();
    (b - a) / 6.0 * (value(a) + 4.0 * value(0.5 * (a + b)) + value(b)) / value(node)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_integrated_exactly_on_irregular_samples() {
        let times = [0.0, 0.1, 0.35, 0.351, 0.6, 0.62, 1.1, 1.3, 1.9, 2.0];
        let w = weights(&times);
        for (power, exact) in [(0, 2.0), (1, 2.0), (2, 8.0 / 3.0), (3, 4.0)] {
            let sum: f64 = times.iter().zip(&w).map(|(t, w)| w * (0..power).fold(1.0, |p, _| p * t)).sum();
            assert!((sum - exact).abs() < 1e-14, "power {power}: {sum}");
        }
        assert!(w.iter().all(|w| w.abs() < 0.9), "no weight is blown up by the pair at 0.35: {w:?}");
    }

    #[test]
    fn inner_weights_of_a_uniform_grid_are_its_spacing() {
        let times: Vec<f64> = (0..20).map(|i| 0.5 * f64::from(i)).collect();
        assert!(weights(&times)[4..16].iter().all(|w| (w - 0.5).abs() < 1e-15));
    }

    /// Few samples give the classic rules: the trapezoid, Simpson's, that of three eighths; one sample spans nothing.
    #[test]
    fn few_samples_have_the_classic_rules() {
        let near = |times: &[f64], expected: &[f64]| {
            let w = weights(times);
            assert!(w.len() == expected.len(), "{w:?}");
            assert!(w.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{w:?} {expected:?}");
        };
        near(&[], &[]);
        near(&[3.0], &[0.0]);
        near(&[0.0, 2.0], &[1.0, 1.0]);
        near(&[0.0, 1.0, 2.0], &[1.0 / 3.0, 4.0 / 3.0, 1.0 / 3.0]);
        near(&[0.0, 1.0, 2.0, 3.0], &[0.375, 1.125, 1.125, 0.375]);
    }

    /// A third sample at a quarter of the interval still serves, a nearer one leaves the trapezoid, on either side.
    #[test]
    fn a_neighbour_serves_from_a_quarter_of_the_interval() {
        let sum = |times: [f64; 3]| weights(&times).iter().zip(times).map(|(w, t)| w * t * t).sum::<f64>();
        let exact = |end: f64| end * end * end / 3.0;
        for sign in [1.0, -1.0] {
            let of = |end: f64| {
                let times = [0.0, 1.0, end];
                sum(if sign > 0.0 { times } else { [-end, -1.0, 0.0] })
            };
            assert!((of(1.25) - exact(1.25)).abs() < 1e-14);
            // the trapezoid of t² from 0 to 1 is a half, not a third
            assert!((of(1.125) - exact(1.125) - 1.0 / 6.0).abs() < 1e-14);
        }
    }
}
