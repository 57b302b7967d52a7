//! A straight line and oscillations of a known period, by least squares.

use core::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

/// What `N` series are made of: lines, and oscillations of one period.
#[derive(Clone, Debug)]
pub(super) struct Harmonics<const N: usize> {
    /// Of the lines.
    pub(super) slopes: [f64; N],
    constants: [f64; N],
    /// Of each harmonic, of each series: the parts by sine and cosine.
    waves: Vec<[[f64; 2]; N]>,
}

impl<const N: usize> Harmonics<N> {
    /// Of all `series` over the times `t`, each a line and `count` harmonics of the angles 2π `turns`.
    ///
    /// `None` where these times do not tell them apart.
    pub(super) fn fit(t: &[f64], turns: &[f64], series: [&[f64]; N], count: usize) -> Option<Self> {
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
                let (sin, cos) = harmonic(n, *turns);
                (row[2 * n], row[2 * n + 1]) = (sin, cos);
            }
            for i in 0..unknowns {
                // the column from the diagonal down
                let column = &mut normal.as_mut_slice()[i * unknowns + i..(i + 1) * unknowns];
                column.iter_mut().zip(&row[i..]).for_each(|(sum, other)| *sum += row[i] * other);
                right.iter_mut().zip(series).for_each(|(right, values)| right[i] += row[i] * values[k]);
            }
        }
        let factor = normal.cholesky()?;
        let found = right.map(|right| factor.solve(&right));
        let waves = (1..=count).map(|n| found.each_ref().map(|x| [x[2 * n], x[2 * n + 1]])).collect();
        let fit = Harmonics {
            slopes: found.each_ref().map(|x| x[0] / longest),
            constants: found.each_ref().map(|x| x[1]),
            waves,
        };
        found.iter().all(|x| x.iter().all(|part| part.is_finite())).then_some(fit)
    }

    /// What they are beside their lines through zero, after `turns`.
    pub(super) fn bounded(&self, turns: f64) -> [f64; N] {
        let mut sums = self.constants;
        for (n, parts) in self.waves.iter().enumerate() {
            let (sin, cos) = harmonic(n + 1, turns);
            sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part[0] * sin + part[1] * cos);
        }
        sums
    }
}

/// Sine and cosine of the `n`-th harmonic.
fn harmonic(n: usize, turns: f64) -> (f64, f64) {
    libm::sincos(TAU * (n as f64 * turns).fract())
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
        let fit = Harmonics::fit(&t, &turns, [&first, &second], 16).unwrap();
        // the harmonics left out are a tenth to the power of 17 of the wave
        let [a, b] = fit.slopes;
        assert!((a - 0.3).abs() < 1e-9 && (b + 0.7).abs() < 1e-12, "{a} {b}");
        // between the times of the fit, and long after it
        for t in [0.33, 7.05, 123.4] {
            let [a, b] = fit.bounded(t / 4.0);
            assert!((a / wave(&t) - 1.0).abs() < 1e-9 && (b + 2.0).abs() < 1e-9, "{a} {b}");
        }
        // without harmonics the wave is taken for a slope
        let fit = Harmonics::fit(&t, &turns, [&first, &second], 0).unwrap();
        assert!((fit.slopes[0] - 0.3).abs() > 0.1, "{fit:?}");
        // three times do not tell four numbers
        assert!(Harmonics::fit(&t[..3], &turns[..3], [&first, &second], 1).is_none());
    }
}
