//! The torque noise of a stretch, and the noise of its rates, by restricted likelihood.

use super::linearised::{Levels, Linearised};

/// Gain of twice the log-likelihood up to which there is no torque noise: noise alone surpasses it once in forty records.
const GAIN: f64 = 4.0;
/// Decades of torque noise that are tried, from that whose share in the residuals is a thousandth of the noise's.
const DECADES: usize = 12;
/// Steps of the golden section within two decades: to a fortieth of the torque noise.
const SECTIONS: usize = 9;

/// What may be fitted of the noise of a stretch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// Whether the noise of the rates may differ from that of the record.
    pub(crate) white: bool,
    /// Least level of torque noise.
    pub(crate) least: f64,
    /// Largest; the same as the least where it is given.
    pub(crate) most: f64,
}

/// The likeliest levels for residuals `e` (not whitened) of variance `variance`; `free` is the share of the residuals
/// that the estimate has not fitted away.
pub(crate) fn likeliest(
    part: &Linearised,
    e: &[f64],
    variance: f64,
    free: f64,
    choice: Choice,
) -> Option<Levels> {
    let search = Search { part, e, variance, free, white: choice.white };
    let (noise, torque) = part.mean_variances();
    // per level of the noise of the rates
    let unit = noise / torque;
    let none = search.at(0.0);
    if choice.most <= choice.least {
        return search.at(choice.least).or(none).map(|found| Levels { torque: choice.least, ..found.levels });
    }
    let at = |exponent: f64| search.at(unit * libm::pow(10.0, exponent));
    let cost = |exponent: f64| at(exponent).map_or(f64::INFINITY, |found| found.cost);
    let tried = (0..=DECADES).map(|k| k as f64 - 3.0).map(|exponent| (cost(exponent), exponent));
    let middle = tried.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |best| best.1);
    let best = at(golden(cost, middle - 1.0, middle + 1.0));
    let best = match (best, none) {
        (Some(best), Some(none)) if none.cost - best.cost <= GAIN => Some(none),
        (best, none) => best.or(none),
    }?;
    let torque = best.levels.torque.clamp(choice.least, choice.most);
    Some(Levels { torque, ..best.levels })
}

/// Levels and twice their negative log-likelihood.
struct Found {
    levels: Levels,
    cost: f64,
}

struct Search<'a> {
    part: &'a Linearised,
    e: &'a [f64],
    variance: f64,
    free: f64,
    white: bool,
}

impl Search<'_> {
    /// The likeliest noise of the rates with torque noise of `ratio` times its level.
    fn at(&self, ratio: f64) -> Option<Found> {
        let (determinant, squares) = self.part.likelihood(self.e, Levels { white: 1.0, torque: ratio })?;
        let count = self.e.len() as f64;
        let squares = squares / self.variance / self.free;
        // what the samples themselves say of their noise counts as much as the residuals do
        let (white, equations) =
            if self.white { ((squares + count) / (2.0 * count), 2.0 * count) } else { (1.0, count) };
        let own = if self.white { count } else { 0.0 };
        let cost = determinant + equations * libm::log(white) + (squares + own) / white;
        Some(Found { levels: Levels { white, torque: white * ratio }, cost })
    }
}

/// Where a function with one minimum between `low` and `high` is least.
fn golden(cost: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const SHARE: f64 = 0.618_033_988_749_894_8;
    let (mut a, mut b) = (high - SHARE * (high - low), low + SHARE * (high - low));
    let (mut at_a, mut at_b) = (cost(a), cost(b));
    for _ in 0..SECTIONS {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - SHARE * (high - low);
            at_a = cost(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + SHARE * (high - low);
            at_b = cost(b);
        }
    }
    0.5 * (low + high)
}
