//! Which units of rate and time a record can be in: its motion tells their product, one number.
//!
//! With rate × time f times as large as read, ω' = −f J⁻¹ (ω × J ω): the ratios of the moments that a record shows are f times
//! the true ones. Three ratios of a body obey one law, a₁ + a₂ + a₃ + a₁ a₂ a₃ = 0, and lie within ±1, which another f breaks:
//! what free bodies leave of |ω'|² tells the units apart, unless the product of the ratios vanishes (a symmetric body) or no
//! ratio shows (a pure spin).
//!
//! Units are compared by the likelihood of their free bodies, with drag, a constant torque and torque noise in each.

pub(crate) mod free_body;
pub(crate) mod product;
mod sums;

use nalgebra::Matrix3;
use polhode::units::RateUnit;

use crate::signal::stretch::Stretch;
use crate::thresholds::judgement::AUDIBLE;
use crate::thresholds::units::{CLEARER, EXPLAINED, HELPLESS, LISTED, OPEN, OUT_OF_QUESTION, SECOND, SURELY};
use free_body::FreeBody;
use product::UnitProduct;
use sums::{Gram, Sums, Weighted};

/// Other units that explain a record.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Others {
    /// Those that do, at most [`LISTED`], the smallest factors first.
    pub(crate) products: Vec<UnitProduct>,
    /// Share of |ω'|² that free bodies leave unexplained in the unit that was read.
    pub(crate) as_read: f64,
    /// The same in the best of the others.
    pub(crate) best: f64,
}

/// What a record tells of its units.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Units {
    /// No other product of common units comes near.
    AsRead,
    /// Others explain the record, and those that were read do not.
    Mistaken(Others),
    /// Others explain it as well.
    Open(Others),
}

/// A record whose units are asked for.
pub(crate) struct Motion {
    sums: Sums,
    plain: Gram,
    /// Share of |ω'|² that the noise of the rates accounts for.
    noise: f64,
}

/// A free body in one unit.
struct Found {
    product: Option<UnitProduct>,
    factor: f64,
    body: FreeBody,
    /// Share of |ω'|² that it leaves.
    share: f64,
    likelihood: f64,
}

impl Motion {
    /// Of a record whose noise has this variance; `None` where it is too short.
    pub(crate) fn new(stretches: &[Stretch], variance: f64) -> Option<Motion> {
        let sums = Sums::of(stretches)?;
        let (plain, noise) = (sums.plain(), sums.noise_share(variance));
        (sums.sizes()[0] > 0.0).then_some(Motion { sums, plain, noise })
    }

    /// Share of |ω'|² that the free body `j` leaves unexplained beyond the noise of the rates; `None` where that is most of it.
    pub(crate) fn unexplained(&self, j: &Matrix3<f64>) -> Option<f64> {
        self.beyond_noise(FreeBody::known(j)?.squares_by(&self.plain, 1.0)?)
    }

    /// The same of the best free body under drag and a constant torque.
    pub(crate) fn unexplained_by_torques(&self) -> Option<f64> {
        self.beyond_noise(FreeBody::nearest(&self.plain, 1.0)?.squares)
    }

    fn beyond_noise(&self, squares: f64) -> Option<f64> {
        let share = squares / self.sums.sizes()[0];
        (self.noise < AUDIBLE).then(|| ((share - self.noise) / (1.0 - self.noise)).clamp(0.0, 1.0))
    }

    /// What it tells of its units, where the body turns by `turn` between samples; `numbered` times may count the samples.
    pub(crate) fn units(&self, read: RateUnit, turn: f64, numbered: bool) -> Units {
        let Some(own) = self.body(None, 1.0) else { return Units::AsRead };
        let mut products = UnitProduct::common(read);
        if numbered {
            let factors = core::iter::successors(Some(1e-4), |f| Some(f * SECOND)).take_while(|f| *f < 1.0);
            products.extend(factors.map(UnitProduct::numbered));
        }
        // no body has ratios beyond 1; noise and drag may make most of the derivatives
        let [slopes, squares] = self.sums.sizes();
        let least = HELPLESS * (slopes * (1.0 - self.noise).max(0.0) / squares).sqrt();
        products.retain(|p| p.factor * turn <= core::f64::consts::PI && p.factor >= least);
        let tried = products.into_iter().filter_map(|p| self.body(Some(p), p.factor));
        let mut tried: Vec<Found> =
            tried.filter(|other| other.share <= OUT_OF_QUESTION * own.share).collect();
        if tried.is_empty() {
            return Units::AsRead;
        }
        let weighted = self.sums.weighted();
        let own = self.with_likelihood(own, &weighted);
        tried = tried.into_iter().map(|other| self.with_likelihood(other, &weighted)).collect();
        tried.retain(|other| other.likelihood >= own.likelihood - OPEN);
        let Some(best) = tried.iter().max_by(|a, b| a.likelihood.total_cmp(&b.likelihood)) else {
            return Units::AsRead;
        };
        let (likelihood, share) = (best.likelihood, best.share);
        // in larger units, a body next to a sphere moves as most bodies do whose sensor is slightly off
        let is_clear = best.factor < 1.0 || own.share >= EXPLAINED;
        let is_mistaken = likelihood - own.likelihood > SURELY
            && own.share >= CLEARER * share
            && share <= EXPLAINED
            && is_clear;
        if is_mistaken {
            tried.retain(|other| other.likelihood >= likelihood - OPEN);
        }
        tried.sort_by(|a, b| a.factor.total_cmp(&b.factor));
        let net = |share: f64| (share - self.noise).max(0.0);
        let others = Others {
            products: tried.iter().filter_map(|other| other.product).take(LISTED).collect(),
            as_read: net(own.share),
            best: net(share),
        };
        if is_mistaken { Units::Mistaken(others) } else { Units::Open(others) }
    }

    fn body(&self, product: Option<UnitProduct>, factor: f64) -> Option<Found> {
        let body = FreeBody::nearest(&self.plain, factor)?;
        let share = body.squares / self.sums.sizes()[0];
        Some(Found { product, factor, body, share, likelihood: f64::NEG_INFINITY })
    }

    /// With its log-likelihood, the sizes of both noises and the body at their best.
    fn with_likelihood(&self, found: Found, weighted: &[Weighted]) -> Found {
        let rows = self.sums.rows() as f64;
        let each = weighted.iter().filter_map(|weighted| {
            let body = found.body.clone().descended(&weighted.gram, found.factor)?;
            Some(-0.5 * (rows * libm::log(body.squares / rows) + weighted.log_determinant))
        });
        let likelihood = each.fold(f64::NEG_INFINITY, f64::max);
        Found { likelihood, ..found }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    use crate::simulate::simulate;

    /// Free motion leaves nothing of a record of its body, in its unit, and something of it for another body; where the noise makes half of
    /// the changes nothing is said.
    #[test]
    fn what_is_unexplained_is_what_the_body_does_not_do() {
        let j = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6));
        let times: Vec<f64> = (0..1000).map(|k| 0.02 * f64::from(k)).collect();
        let (body, start) = (Inertia::from_tensor(j).unwrap(), Vector3::new(0.5, 0.8, -0.4));
        let rates = simulate(&body, start, &times, 0.0, &mut Random::new(1)).unwrap();
        let s = [Stretch::new(times, rates)];
        let motion = Motion::new(&s, 0.0).unwrap();
        let exact = motion.unexplained(&j).unwrap();
        assert!((0.0..1e-4).contains(&exact), "{exact:e}");
        assert!(motion.unexplained_by_torques().unwrap() < 1e-4);
        // the ratios of its moments are off by 0.4/0.6, 0.2/0.8 and 0.07/0.385 of themselves
        let other = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.2));
        let share = motion.unexplained(&other).unwrap();
        assert!((0.03..0.45).contains(&share), "{share}");
        // a share of noise is taken off what is left and off what there is
        let variance = 0.02 / motion.sums.noise_share(1.0);
        let noisy = Motion::new(&s, variance).unwrap();
        let expected = (share - 0.02) / 0.98;
        assert!((noisy.unexplained(&other).unwrap() - expected).abs() < 1e-9);
        assert_eq!(noisy.unexplained(&j), Some(0.0));
        assert!(Motion::new(&s, 24.9 * variance).unwrap().unexplained(&j).is_some());
        assert!(Motion::new(&s, 25.1 * variance).unwrap().unexplained(&j).is_none());
    }

    /// A free body that leaves q of n equations has the log-likelihood −(n log(q/n) + log |C|)/2 at the weights of the largest; a noise of half the size
    /// changes nothing, as it has four times the q and n log 4 less in |C|.
    #[test]
    fn the_likelihood_does_not_depend_on_the_size_of_the_noise() {
        let times: Vec<f64> = (0..500).map(|k| 0.04 * f64::from(k)).collect();
        let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
        let rates = simulate(&body, Vector3::new(0.5, 0.8, -0.4), &times, 0.02, &mut Random::new(2)).unwrap();
        let motion = Motion::new(&[Stretch::new(times, rates)], 0.0).unwrap();
        let rows = motion.sums.rows() as f64;
        let weighted = |larger: f64, determinant: f64| Weighted {
            gram: motion.plain * larger,
            log_determinant: determinant - rows * libm::log(larger),
        };
        let likelihood = |all: &[Weighted]| {
            let found = motion.with_likelihood(motion.body(None, 1.0).unwrap(), all);
            assert!(found.factor == 1.0 && found.product.is_none());
            found.likelihood
        };
        let squares = motion.body(None, 1.0).unwrap().body.squares;
        // a further step of the body brings next to nothing
        let expected = -0.5 * (rows * libm::log(squares / rows) + 3.0);
        let one = likelihood(&[weighted(1.0, 3.0)]);
        assert!((one - expected).abs() < 0.1, "{one} {expected}");
        assert!((likelihood(&[weighted(4.0, 3.0)]) - one).abs() < 1e-6 * one.abs());
        let best = likelihood(&[weighted(1.0, 9.0), weighted(4.0, 1.0), weighted(1.0, 5.0)]);
        assert!((best - one - 1.0).abs() < 1e-6 * one.abs(), "{best} {one}");
        assert_eq!(likelihood(&[]), f64::NEG_INFINITY);
    }
}
