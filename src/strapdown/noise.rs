//! The white noise of readings, from the readings alone.

use nalgebra::Vector3;

use crate::record::median;

/// Degrees of the polynomials that are taken out of the readings, plus one: differences of these orders are tried.
const ORDERS: [usize; 4] = [4, 6, 8, 10];

/// Samples that [`noise`] tells anything of, at least.
pub const NOISE_SAMPLES: usize = ORDERS[0] + 1;

/// Squares above so many medians are blows and catches, not noise.
const OUTLYING: f64 = 30.0;

/// Parts of a record whose noise may differ, and samples that each has at least.
const PARTS: (usize, usize) = (16, 128);

/// Parts are louder than the whole if their mean square is this many times larger, as root; of steady noise both are alike.
const LOUDER: f64 = 2.0;

/// Standard deviation of the white noise of a component, in the unit of the readings; 0 of fewer than [`NOISE_SAMPLES`].
///
/// The combination Σ c_i r_i of p + 1 neighbours with c_i = 1/Π(t_i − t_j) vanishes for polynomials of degree p − 1; divided by |c|
/// it has the deviation of the noise, and beside it a rest of the motion that falls with p. Of several p the least is taken: what is
/// left of the motion can only add. Noise that is not white, as behind a filter, is underestimated.
///
/// ```
/// use nalgebra::Vector3;
/// let times: Vec<f64> = (0..1000).map(|k| 0.1 * f64::from(k)).collect();
/// let rates: Vec<_> = times.iter().map(|t| Vector3::new(libm::sin(*t), libm::cos(*t), 0.0)).collect();
/// assert!(polhode::strapdown::noise(&times, &rates) < 1e-10);
/// ```
#[must_use]
pub fn noise(times: &[f64], readings: &[Vector3<f64>]) -> f64 {
    let found = ORDERS.iter().filter_map(|order| variance(times, readings, *order));
    found.fold(f64::INFINITY, f64::min).sqrt().min(f64::MAX) * f64::from(times.len() >= NOISE_SAMPLES)
}

/// The same of readings whose noise may change, as where an engine starts: what is loud for long is noise, and no blow to be left out.
///
/// The root mean square of the parts of the record, where that is far above the noise of the whole.
pub(super) fn changing_noise(times: &[f64], readings: &[Vector3<f64>]) -> f64 {
    let whole = noise(times, readings);
    let size = (times.len() / PARTS.0).max(PARTS.1);
    let squares = times.chunks(size).zip(readings.chunks(size)).map(|(times, readings)| {
        let part = noise(times, readings);
        part * part * times.len() as f64
    });
    let parts = (squares.sum::<f64>() / times.len().max(1) as f64).sqrt().min(f64::MAX);
    if parts > LOUDER * whole { parts } else { whole }
}

fn variance(times: &[f64], readings: &[Vector3<f64>], order: usize) -> Option<f64> {
    let mut squares: Vec<f64> = Vec::new();
    let mut even: Option<(f64, Vec<f64>)> = None;
    for (t, r) in times.windows(order + 1).zip(readings.windows(order + 1)) {
        let span = t[order] - t[0];
        // weights do not change where steps are even to what counts here
        let is_even = |known: f64| {
            let step = span / order as f64;
            (span / known - 1.0).abs() < 1e-6
                && t.iter().enumerate().all(|(k, t_k)| (t_k - t[0] - step * k as f64).abs() < 1e-6 * step)
        };
        let known = even.as_ref().filter(|(known, _)| is_even(*known)).map(|(_, weights)| weights);
        let fresh;
        let weights = match known {
            Some(weights) => weights,
            None => {
                let others = |i: usize| (0..=order).filter(move |j| *j != i);
                let weight = |i: usize| others(i).fold(1.0, |w, j| w * span / (order as f64 * (t[i] - t[j])));
                fresh = (0..=order).map(weight).collect::<Vec<f64>>();
                even = Some((span, fresh.clone()));
                &fresh
            }
        };
        let norm: f64 = weights.iter().map(|w| w * w).sum();
        let left = r.iter().zip(weights).fold(Vector3::zeros(), |sum, (r, w)| sum + r * *w);
        squares.push(left.norm_squared() / (3.0 * norm));
    }
    let median = median(&mut squares)?;
    let limit = if median > 0.0 { OUTLYING * median } else { f64::INFINITY };
    let kept = || squares.iter().filter(|square| **square <= limit);
    Some(kept().sum::<f64>() / kept().count().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    /// Noise of the last eighth of a record, a hundred times louder, has an eighth of its variance in the mean; a few blows have none, and
    /// steady noise is that of the whole to the last bit.
    #[test]
    fn noise_that_is_loud_for_long_counts_and_blows_do_not() {
        let mut random = Random::new(5);
        let times: Vec<f64> = (0..2048).map(|k| 0.02 * f64::from(k)).collect();
        let steady: Vec<Vector3<f64>> = times.iter().map(|_| random.normal_vector() * 1e-4).collect();
        let with = |change: &dyn Fn(usize, Vector3<f64>) -> Vector3<f64>| -> Vec<Vector3<f64>> {
            steady.iter().enumerate().map(|(k, reading)| change(k, *reading)).collect()
        };
        let loud = with(&|k, reading| if k < 1792 { reading } else { reading * 100.0 });
        let found = changing_noise(&times, &loud);
        assert!((found / (1e-2 / 8.0_f64.sqrt()) - 1.0).abs() < 0.15, "{found}");
        assert!(noise(&times, &loud) < 2e-4);
        let struck = with(&|k, reading| if k % 600 == 300 { reading.add_scalar(1.0) } else { reading });
        for readings in [&struck, &steady] {
            let found = changing_noise(&times, readings);
            assert_eq!(found, noise(&times, readings));
            assert!((found / 1e-4 - 1.0).abs() < 0.1, "{found}");
        }
    }
}
