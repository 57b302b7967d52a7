//! Spectrum and Allan deviation of residuals.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use polhode::num::Real;

/// Samples of a block of the spectrum, and the most blocks that are averaged.
const BLOCK: usize = 1024;
const BLOCKS: usize = 32;
/// Points of a decade of frequency.
const PER_DECADE: f64 = 12.0;

/// Power spectral density of a component, mean of the three axes: (Hz, (rad/s)²/Hz), one-sided, averaged over blocks with a
/// Hann window and over frequencies that are close on a logarithmic axis. Segments shorter than the median one are left
/// out. Empty where there are too few samples.
///
/// Source: P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70.
pub(super) fn spectrum(segments: &[Vec<Vector3<f64>>], interval: f64) -> Vec<(f64, f64)> {
    let mut lengths: Vec<usize> = segments.iter().map(Vec::len).collect();
    lengths.sort_unstable();
    let block = lengths.get(lengths.len() / 2).copied().unwrap_or(0).min(BLOCK);
    if block < 16 {
        return Vec::new();
    }
    // blocks overlap by half
    let mut blocks: Vec<&[Vector3<f64>]> = Vec::new();
    for s in segments.iter().filter(|s| s.len() >= block) {
        let count = (s.len() - block) / (block / 2) + 1;
        blocks.extend((0..count).map(|b| &s[b * (block / 2)..][..block]));
    }
    let every = blocks.len().div_ceil(BLOCKS);
    let blocks: Vec<&[Vector3<f64>]> = blocks.into_iter().step_by(every).collect();
    let turns: Vec<(f64, f64)> = (0..block).map(|k| Real::sin_cos(TAU * k as f64 / block as f64)).collect();
    let window: Vec<f64> = turns.iter().map(|(_, cos)| 0.5 - 0.5 * cos).collect();
    let norm: f64 = window.iter().map(|w| w * w).sum::<f64>() / interval;
    let mut power = vec![0.0; block / 2];
    for part in &blocks {
        let mean = part.iter().sum::<Vector3<f64>>() / block as f64;
        let windowed: Vec<Vector3<f64>> = part.iter().zip(&window).map(|(r, w)| (r - mean) * *w).collect();
        for (k, power) in power.iter_mut().enumerate().skip(1) {
            let (mut real, mut imaginary) = (Vector3::zeros(), Vector3::zeros());
            for (n, r) in windowed.iter().enumerate() {
                let (sin, cos) = turns[k * n % block];
                real += r * cos;
                imaginary += r * sin;
            }
            let square = real.norm_squared() + imaginary.norm_squared();
            *power += 2.0 * square / (3.0 * norm * blocks.len() as f64);
        }
    }
    let frequency = |k: usize| k as f64 / (block as f64 * interval);
    let mut points: Vec<(i64, f64, f64, f64)> = Vec::new();
    for (k, power) in power.iter().enumerate().skip(1) {
        let bin = libm::floor(PER_DECADE * libm::log10(k as f64)) as i64;
        match points.last_mut().filter(|p| p.0 == bin) {
            Some(p) => *p = (bin, p.1 + frequency(k), p.2 + power, p.3 + 1.0),
            None => points.push((bin, frequency(k), *power, 1.0)),
        }
    }
    points.into_iter().map(|(_, f, p, n)| (f / n, p / n)).filter(|(_, p)| *p > 0.0).collect()
}

/// Allan deviation of a component, mean of the three axes and of all segments: (s, rad/s), at averaging times of powers of
/// two.
///
/// Source: D. W. Allan, Proc. IEEE 54 (1966) 221; overlapping averages.
pub(super) fn allan(segments: &[Vec<Vector3<f64>>], interval: f64) -> Vec<(f64, f64)> {
    let sums: Vec<Vec<Vector3<f64>>> = segments.iter().map(|s| running(s)).collect();
    let longest = segments.iter().map(Vec::len).max().unwrap_or(0);
    let mut points = Vec::new();
    let mut width = 1;
    while 3 * width <= longest {
        let (mut sum, mut count) = (0.0, 0.0);
        for s in &sums {
            for k in 0..(s.len()).saturating_sub(2 * width) {
                sum += (s[k + 2 * width] - s[k + width] * 2.0 + s[k]).norm_squared();
                count += 1.0;
            }
        }
        let variance = sum / (6.0 * count * (width * width) as f64);
        if variance > 0.0 {
            points.push((width as f64 * interval, variance.sqrt()));
        }
        width *= 2;
    }
    points
}

/// Sums of the first samples, from none to all.
fn running(samples: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mut sums = vec![Vector3::zeros()];
    for sample in samples {
        sums.push(sums[sums.len() - 1] + sample);
    }
    sums
}

#[cfg(test)]
mod tests {
    use polhode::num::Random;

    use super::*;

    #[test]
    fn white_noise_has_a_flat_spectrum_and_a_falling_allan_deviation() {
        let mut random = Random::new(6);
        let noise: Vec<Vector3<f64>> = (0..8_000).map(|_| random.normal_vector() * 0.3).collect();
        let noise = [noise];
        let spectrum = spectrum(&noise, 0.01);
        // 2 σ² Δt
        let level = 2.0 * 0.09 * 0.01;
        for (f, power) in &spectrum {
            assert!((power / level - 1.0).abs() < 0.5, "{f}: {power}");
        }
        let mean = spectrum.iter().map(|p| p.1).sum::<f64>() / spectrum.len() as f64;
        assert!((mean / level - 1.0).abs() < 0.05, "{mean}");
        for (t, deviation) in allan(&noise, 0.01).into_iter().filter(|p| p.0 < 1.0) {
            let expected = 0.3 * (0.01 / t).sqrt();
            assert!((deviation / expected - 1.0).abs() < 0.15, "{t}: {deviation} {expected}");
        }
    }

    #[test]
    fn a_tone_stands_at_its_frequency() {
        let tone = |i: i32| Vector3::x() * Real::sin_cos(TAU * 7.0 * 0.01 * f64::from(i)).0;
        let samples: Vec<Vector3<f64>> = (0..4096).map(tone).collect();
        let short = [samples[..10].to_vec()];
        // tosses of one motion have its spectrum
        let parts = [samples[..900].to_vec(), samples[900..1800].to_vec(), samples[1800..1900].to_vec()];
        let highest = spectrum(&parts, 0.01).into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!((highest.0 - 7.0).abs() < 0.6, "{highest:?}");
        assert!(
            spectrum(&short, 0.01).is_empty()
                && spectrum(&[], 0.01).is_empty()
                && allan(&[], 0.01).is_empty()
        );
    }
}
