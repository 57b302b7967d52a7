//! A straight line and oscillations of a known period, by least squares.

use core::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

/// The slopes of all `series` against the times `t`, each a line and `count` harmonics of the angles 2π `turns`.
///
/// `None` where these times do not tell them apart.
pub(super) fn slopes<const N: usize>(
    t: &[f64],
    turns: &[f64],
    series: [&[f64]; N],
    count: usize,
) -> Option<[f64; N]> {
    let unknowns = 2 + 2 * count;
    if t.len() < unknowns {
        return None;
    }
    let longest = t.iter().fold(0.0, |most: f64, t| most.max(t.abs()));
    let mut normal = DMatrix::<f64>::zeros(unknowns, unknowns);
    let mut right = [(); N].map(|()| DVector::<f64>::zeros(unknowns));
    let mut row = vec![0.0; unknowns];
    for (k, (t, turns)) in t.iter().zip(turns).enumerate() {
        (row[0], row[1]) = (t / longest, 1.0);
        for n in 1..=count {
            let (sin, cos) = libm::sincos(TAU * (n as f64 * turns).fract());
            (row[2 * n], row[2 * n + 1]) = (sin, cos);
        }
        for i in 0..unknowns {
            for j in 0..=i {
                normal[(i, j)] += row[i] * row[j];
            }
            right.iter_mut().zip(series).for_each(|(right, values)| right[i] += row[i] * values[k]);
        }
    }
    let factor = normal.cholesky()?;
    let found = right.map(|right| factor.solve(&right)[0] / longest);
    found.iter().all(|slope| slope.is_finite()).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_told_from_what_oscillates() {
        let t: Vec<f64> = (0..60).map(|k| 0.1 + 0.153 * f64::from(k)).collect();
        let turns: Vec<f64> = t.iter().map(|t| t / 4.0).collect();
        let wave = |t: &f64| 1e3 / (1.0 - 0.2 * libm::cos(TAU * t / 4.0));
        let first: Vec<f64> = t.iter().map(|t| 0.3 * t + wave(t)).collect();
        let second: Vec<f64> = t.iter().map(|t| -0.7 * t - 2.0).collect();
        let [a, b] = slopes(&t, &turns, [&first, &second], 16).unwrap();
        // the harmonics left out are a tenth to the power of 17 of the wave
        assert!((a - 0.3).abs() < 1e-9 && (b + 0.7).abs() < 1e-12, "{a} {b}");
        // without harmonics the wave is taken for a slope
        let [a, _] = slopes(&t, &turns, [&first, &second], 0).unwrap();
        assert!((a - 0.3).abs() > 0.1, "{a}");
        // three times do not tell four numbers
        assert_eq!(slopes(&t[..3], &turns[..3], [&first, &second], 1), None);
    }
}
