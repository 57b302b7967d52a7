//! Populations of tumbling bodies: elements and moments with the uncertainty that observers publish. Needs the feature `random`.

use thiserror::Error;

use super::tumbling::{TumblingElements, TumblingError};
use crate::body::{Body, Member};
use crate::inertia::{Inertia, InertiaError};
use crate::num::{Covariance, Random};

/// A draw that no body has is drawn again, up to this many times for one member.
const MOST_DRAWS: u32 = 10_000;

/// One solution of a light curve: elements and moments about which members are drawn.
///
/// The covariance is of P_φ and P_ψ (s), λ, β, φ and ψ (rad), and the moments that the smallest and the middle one are
/// in units of the largest.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TumblingSolution {
    /// Moments of the mean.
    pub inertia: Inertia,
    /// Elements of the mean.
    pub elements: TumblingElements,
    /// Of the eight quantities.
    pub covariance: Box<Covariance<8>>,
}

/// Solutions with weights, as where light curves leave several periods open.
///
/// Member k is the same however many others are drawn: it takes stream k of the seed. A draw whose moments no body has, or whose
/// periods do not fit its moments, is drawn again: what remains is the distribution cut off at these laws.
///
/// ```
/// use polhode::flow::{FreeMotion, Mode, TumblingElements, TumblingPopulation, TumblingSolution};
/// use polhode::inertia::Inertia;
/// use polhode::num::Covariance;
/// let hour = 3600.0;
/// let solution = |rotation: f64| -> Result<TumblingSolution, polhode::Error> {
///     let elements = TumblingElements::new(Mode::ShortAxis, [27.4 * hour, rotation * hour]);
///     let deviations = [0.1 * hour, 6.0 * hour, 0.2, 0.1, 0.3, 0.1, 0.05, 0.01];
///     let covariance = Covariance::independent(deviations)?;
///     Ok(TumblingSolution::new(Inertia::from_moments([0.61, 0.965, 1.0])?, elements, covariance))
/// };
/// let aliases = TumblingPopulation::new(vec![(0.8, solution(263.0)?), (0.2, solution(290.0)?)])?;
/// let member = aliases.member(2029, 17)?;
/// let motion = FreeMotion::from_omega(&member.inertia, member.attitude.into(), member.omega_body.into())?;
/// assert!(motion.tumbling().is_some() && aliases.solution_of(2029, 17) < 2);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct TumblingPopulation {
    /// Each with the sum of weights up to it, of which the last is 1.
    solutions: Vec<(f64, TumblingSolution)>,
}

impl TumblingSolution {
    /// About `elements` of a body with these moments.
    pub fn new(inertia: Inertia, elements: TumblingElements, covariance: Covariance<8>) -> Self {
        TumblingSolution { inertia, elements, covariance: Box::new(covariance) }
    }

    fn draw(&self, random: &mut Random) -> Result<Member, NoTumbler> {
        let mut draws = 1;
        loop {
            match self.moved(self.covariance.draw(random)) {
                Ok(member) => return Ok(Member { draws, ..member }),
                Err(last) if draws >= MOST_DRAWS => return Err(NoTumbler::Drawn { draws, last }),
                Err(_) => draws += 1,
            }
        }
    }

    /// The member that is off the mean by this much.
    fn moved(&self, deviation: [f64; 8]) -> Result<Member, NoElements> {
        let [precession, rotation, longitude, latitude, phi, psi, smallest, middle] = deviation;
        let inertia = self.with_ratios([smallest, middle])?;
        let mean = &self.elements;
        let elements = TumblingElements {
            precession_period: mean.precession_period + precession,
            rotation_period: mean.rotation_period + rotation,
            pole: [mean.pole[0] + longitude, mean.pole[1] + latitude],
            angles: [mean.angles[0] + phi, mean.angles[1] + psi],
            ..*mean
        };
        let body = Body::free(inertia);
        let point = elements.point(body.inertia())?;
        let (omega_body, attitude) = (body.omega_of(&point), body.leave(&point).attitude);
        Ok(Member::new(body.inertia().clone(), attitude, omega_body.into()))
    }

    /// The inertia whose smaller moments are larger by these shares of the largest.
    fn with_ratios(&self, shares: [f64; 2]) -> Result<Inertia, NoElements> {
        if shares == [0.0; 2] {
            return Ok(self.inertia.clone());
        }
        let mut moments = self.inertia.moments_along_axes();
        let mut ranks = [0, 1, 2];
        ranks.sort_by(|i, k| moments[*i].total_cmp(&moments[*k]));
        let largest = moments[ranks[2]];
        shares.into_iter().zip(ranks).for_each(|(share, rank)| moments[rank] += share * largest);
        // in another order the axis of the mode would be another axis of the body
        let ascending = ranks.map(|rank| moments[rank]);
        if !ascending.is_sorted() {
            return Err(NoElements::Order { moments: ascending });
        }
        Ok(self.inertia.with_moments(moments)?)
    }
}

impl TumblingPopulation {
    /// Of solutions with weights, which need not add up to 1.
    ///
    /// # Errors
    /// No solution, a weight that is not positive and finite, and a mean that no body has.
    pub fn new(weighted: Vec<(f64, TumblingSolution)>) -> Result<Self, NoTumbler> {
        let whole: f64 = weighted.iter().map(|(weight, _)| weight).sum();
        let is_usable = |weight: f64| weight.is_finite() && weight > 0.0;
        let each = weighted.iter().map(|(weight, _)| *weight);
        if let Some(weight) = each.chain([whole]).find(|weight| !is_usable(*weight)) {
            return Err(NoTumbler::Weight { weight });
        }
        let mut below = 0.0;
        let mut solutions = Vec::with_capacity(weighted.len());
        for (weight, solution) in weighted {
            solution.moved([0.0; 8]).map_err(|last| NoTumbler::Drawn { draws: 0, last })?;
            below += weight / whole;
            solutions.push((below, solution));
        }
        Ok(TumblingPopulation { solutions })
    }

    /// The solutions.
    pub fn solutions(&self) -> impl ExactSizeIterator<Item = &TumblingSolution> {
        self.solutions.iter().map(|(_, solution)| solution)
    }

    /// Which solution member `k` is drawn from.
    #[must_use]
    pub fn solution_of(&self, seed: u64, k: u64) -> usize {
        self.chosen(&mut Random::new(seed).stream(k))
    }

    /// Member number `k` of the population with this seed.
    ///
    /// # Errors
    /// Ten thousand draws in a row that no body has.
    pub fn member(&self, seed: u64, k: u64) -> Result<Member, NoTumbler> {
        let mut random = Random::new(seed).stream(k);
        let chosen = self.chosen(&mut random);
        self.solutions[chosen].1.draw(&mut random)
    }

    fn chosen(&self, random: &mut Random) -> usize {
        let last = self.solutions.len() - 1;
        if last == 0 {
            return 0;
        }
        let place = random.uniform();
        self.solutions.iter().position(|(below, _)| place < *below).unwrap_or(last)
    }
}

/// No tumbling body can be drawn.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoTumbler {
    /// The weight of a solution, or the sum of them.
    #[error(
        "the weight or the sum of the weights is {weight}; weights must be above 0 and finite, and there must be at least one"
    )]
    Weight {
        /// The weight.
        weight: f64,
    },
    /// No draw, or the mean.
    #[error("{}{last}", if *.draws == 0 { String::new() } else { format!("none of {draws} draws belongs to a physical body; the last: ") })]
    Drawn {
        /// How many were drawn; 0 of the mean.
        draws: u32,
        /// What is wrong with the last.
        last: NoElements,
    },
}

/// Moments and elements that do not go together.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoElements {
    /// The moments have changed their order.
    #[error("moments {}, {}, {} were drawn as the smallest, the middle and the largest; they are not in this order", .moments[0], .moments[1], .moments[2])]
    Order {
        /// Those drawn for the smallest, the middle and the largest.
        moments: [f64; 3],
    },
    /// No body has the moments.
    #[error(transparent)]
    Inertia(#[from] InertiaError),
    /// No motion has the elements.
    #[error(transparent)]
    Elements(#[from] TumblingError),
}
