//! Errors of an ensemble: root mean square and mean with their intervals, and the exponent of the growth.

use polhode::num::Random;

/// Of each body the errors at the looks, which all have as many.
pub(super) struct Walks(pub(super) Vec<Vec<f64>>);

/// The ensemble at one look.
pub(super) struct Statistics {
    pub(super) steps: u64,
    pub(super) rms: f64,
    /// 95 % interval of the root mean square, were the errors normal.
    pub(super) rms_low: f64,
    pub(super) rms_high: f64,
    pub(super) mean: f64,
}

/// Growth as steps^exponent.
pub(super) struct Growth {
    pub(super) exponent: f64,
    /// 95 % interval.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Steps from which it was fitted.
    pub(super) from: u64,
}

/// Ensembles that are drawn from the bodies, with repetition (Efron's bootstrap).
const DRAWS: usize = 400;

impl Walks {
    fn looks(&self) -> usize {
        self.0.iter().map(Vec::len).min().unwrap_or(0)
    }

    /// Root mean square at the look `k` over the bodies `members`.
    fn rms(&self, k: usize, members: &[usize]) -> f64 {
        let squares = members.iter().map(|&member| self.0[member][k] * self.0[member][k]);
        (squares.sum::<f64>() / members.len() as f64).sqrt()
    }

    pub(super) fn statistics(&self, looks: &[u64]) -> Vec<Statistics> {
        let all: Vec<usize> = (0..self.0.len()).collect();
        let count = all.len() as f64;
        // of a variance of `count` normal errors (Wilson and Hilferty's approximation of chi squared)
        let edge = |sign: f64| {
            let third = 2.0 / (9.0 * count);
            let root = 1.0 - third + sign * 1.959_964 * third.sqrt();
            1.0 / (root * root * root).sqrt()
        };
        let row = |(k, &steps): (usize, &u64)| {
            let rms = self.rms(k, &all);
            let mean = self.0.iter().map(|walk| walk[k]).sum::<f64>() / count;
            Statistics { steps, rms, rms_low: rms * edge(1.0), rms_high: rms * edge(-1.0), mean }
        };
        looks.iter().take(self.looks()).enumerate().map(row).collect()
    }

    /// The exponent over the last two decades of steps whose errors are above `floor`; `None` for fewer than four looks.
    pub(super) fn growth(&self, looks: &[u64], floor: f64, mut random: Random) -> Option<Growth> {
        let all: Vec<usize> = (0..self.0.len()).collect();
        let last = self.looks().checked_sub(1)?;
        let seen = |k: &usize| looks[*k] >= looks[last] / 100 && self.rms(*k, &all) > floor;
        let used: Vec<usize> = (0..=last).filter(seen).collect();
        if used.len() < 4 {
            return None;
        }
        let exponent = |members: &[usize]| {
            let x: Vec<f64> = used.iter().map(|&k| libm::log(looks[k] as f64)).collect();
            let y: Vec<f64> = used.iter().map(|&k| libm::log(self.rms(k, members))).collect();
            let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
            let (x_mean, y_mean) = (mean(&x), mean(&y));
            let sum = |f: &dyn Fn(f64, f64) -> f64| {
                x.iter().zip(&y).map(|(x, y)| f(x - x_mean, y - y_mean)).sum::<f64>()
            };
            sum(&|x, y| x * y) / sum(&|x, _| x * x)
        };
        let mut drawn: Vec<f64> = (0..DRAWS)
            .map(|_| {
                let members: Vec<usize> =
                    all.iter().map(|_| random.below(all.len() as u64) as usize).collect();
                exponent(&members)
            })
            .collect();
        drawn.sort_by(f64::total_cmp);
        Some(Growth {
            exponent: exponent(&all),
            low: drawn[DRAWS / 40],
            high: drawn[DRAWS - 1 - DRAWS / 40],
            from: looks[used[0]],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 64 sums of random steps, each with `bias` added.
    fn walks(looks: &[u64], bias: f64) -> Walks {
        let walk = |member| {
            let mut random = Random::new(3).stream(member);
            let (mut sum, mut taken) = (0.0, 0);
            looks
                .iter()
                .map(|&n| {
                    (taken..n).for_each(|_| sum += random.normal() + bias);
                    taken = n;
                    sum
                })
                .collect()
        };
        Walks((0..64).map(walk).collect())
    }

    #[test]
    fn random_steps_grow_as_the_root_and_a_bias_as_the_number() {
        let looks: Vec<u64> = (0..9).map(|k| 10 << k).collect();
        for (bias, exponent) in [(0.0, 0.5), (3.0, 1.0)] {
            let growth = walks(&looks, bias).growth(&looks, 0.0, Random::new(4)).unwrap();
            assert!(growth.low < exponent && exponent < growth.high + 0.01, "{bias}: {}", growth.exponent);
            assert!(growth.high - growth.low < 0.35, "{} {}", growth.low, growth.high);
            let all = walks(&looks, bias).statistics(&looks);
            let ratio = all.last().map(|last| last.mean / last.rms).unwrap();
            assert!((ratio.abs() > 0.9) == (bias > 0.0), "{ratio}");
        }
        let statistics = walks(&looks, 0.0).statistics(&looks);
        let last = statistics.last().unwrap();
        let expected = (*looks.last().unwrap() as f64).sqrt();
        assert!(last.rms_low < expected && expected < last.rms_high, "{} {}", last.rms_low, last.rms_high);
        assert!(walks(&looks, 0.0).growth(&looks, 1e9, Random::new(4)).is_none());
    }
}
