//! The noise of a sensor from its own samples.

use polhode::record::median;

use crate::signal::stretch::Stretch;
use crate::thresholds::noise::{DEVIATIONS, OUTLYING, STATED, WHITE};

/// Variance of one component, from what local cubics leave of five neighbouring samples.
///
/// The combination Σ c_i ω_i with c_i = 1/Π(t_i − t_j) vanishes for every cubic; divided by |c| it has the variance
/// of the noise. It sees only what is too fast for the motion, so that what is slow (torques, a wrong unit, a tensor
/// that does not fit) is left for χ² to show.
/// Windows that exceed thirty medians (a chance of 1e-15 under normal noise: a blow, a catch) are left out.
pub(crate) fn variance(stretches: &[Stretch]) -> f64 {
    let mut squares: Vec<f64> = Vec::new();
    for s in stretches {
        for (t, w) in s.times.windows(5).zip(s.rates.windows(5)) {
            let c = off_cubic([t[0], t[1], t[2], t[3], t[4]]);
            let norm: f64 = c.iter().map(|c| c * c).sum();
            let left = (0..5).map(|i| w[i] * c[i]).fold(nalgebra::Vector3::zeros(), |a, b| a + b);
            squares.push(left.norm_squared() / (3.0 * norm));
        }
    }
    let median = median(&mut squares).unwrap_or(0.0);
    let limit = if median > 0.0 { OUTLYING * median } else { f64::INFINITY };
    let (mut sum, mut count) = (0.0, 0.0);
    for square in squares.into_iter().filter(|square| *square <= limit) {
        sum += square;
        count += 1.0;
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The coefficients of values at five times of a combination that vanishes for every cubic.
pub(crate) fn off_cubic(t: [f64; 5]) -> [f64; 5] {
    let per = 1.0 / (t[4] - t[0]);
    core::array::from_fn(|i| 1.0 / (0..5).filter(|&j| j != i).map(|j| (t[i] - t[j]) * per).product::<f64>())
}

/// That variance of noise that is white, so that every second sample shows the same. Of a motion whose samples are far apart, and of a sensor
/// that filters, they show more.
pub(crate) fn white(stretches: &[Stretch]) -> Option<f64> {
    let second = |s: &Stretch| Stretch {
        times: s.times.iter().step_by(2).copied().collect(),
        rates: s.rates.iter().step_by(2).copied().collect(),
        weights: Vec::new(),
        inputs: None,
        ..*s
    };
    let halved: Vec<Stretch> = stretches.iter().map(second).collect();
    let (all, half) = (variance(stretches), variance(&halved));
    (all > 0.0 && half < WHITE * all && all < WHITE * half).then_some(all)
}

/// The variance that the samples show, where it surely is another than the `stated` one. `rounding` is that of the readings, and `misfit` the
/// mean square of so many residuals over the stated variance, 0 where there are none.
///
/// Neighbours show nothing of slow noise, and little of the rounding of readings that rest on a step; residuals do.
pub(crate) fn contradicting(
    stretches: &[Stretch],
    stated: f64,
    rounding: f64,
    (misfit, residuals): (f64, usize),
) -> Option<f64> {
    let shown = white(stretches)?;
    let chance = |numbers: usize| 1.0 + 2.0 * DEVIATIONS * (2.0 / numbers.max(1) as f64).sqrt();
    let samples: usize = stretches.iter().map(|s| s.times.len()).sum();
    let most = STATED * STATED * chance(3 * samples);
    let is_more = shown > most * (stated + rounding);
    let is_less = most * shown.max(rounding) < stated && STATED * STATED * chance(residuals) * misfit < 1.0;
    (is_more || is_less).then_some(shown)
}
