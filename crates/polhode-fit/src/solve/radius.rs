//! The half width of the test functions: chosen by least predicted covariance, doubled where the rounds do not settle.

use crate::columns::column::{Column, Unknowns};
use crate::physical::coordinates::{Coordinates, Form};
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::TestFunctions;
use crate::solve::linearised::{Linearised, Whitened};
use crate::solve::rounds::{Noise, Reached, Rounds};
use crate::solve::weak_estimate::{Convergence, WeakEstimate};
use crate::thresholds::radius::{CANDIDATES, COMPARED, DENSE, OF_SHORT, PILOT_SAMPLES, ROOM, SHORTEST};
use crate::thresholds::rounds::{RESTLESS, STANDS, TORQUES};
use crate::thresholds::test_functions::{ROUNDED, SAMPLES_PER_TEST};

/// Why there is no weak estimate.
pub(crate) enum Failure {
    /// No stretch carries enough test functions.
    TooShort,
    /// The equations of the radius that was asked for are nearly as many as the samples.
    Dense,
    /// A covariance has no factor.
    Singular,
}

/// The covariance (H/σ² − V)⁻¹ (H/σ²) (H/σ² − V)⁻¹ of an estimate at raw samples.
fn covariance(information: &Form, inflation: &Form, variance: f64) -> Option<Form> {
    let noisy = information / variance;
    let inverse = (noisy - inflation).cholesky()?.inverse();
    Some(inverse * noisy * inverse)
}

/// Radii to choose from, ascending: doubling from half the time in which the body turns by one radian.
pub(crate) fn candidates(stretches: &[Stretch]) -> Vec<f64> {
    let longest = stretches.iter().map(Stretch::duration).fold(0.0, f64::max);
    let samples: usize = stretches.iter().map(|s| s.times.len()).sum();
    let duration: f64 = stretches.iter().map(Stretch::duration).sum();
    let lowest = (SAMPLES_PER_TEST * duration / samples as f64).max(SHORTEST);
    let mut radii: Vec<f64> =
        (0..CANDIDATES).scan(lowest, |r, _| Some(core::mem::replace(r, 2.0 * *r))).collect();
    let enough = |s: &Stretch, r: f64| s.times.len() as f64 * 2.0 * r >= SAMPLES_PER_TEST * s.duration();
    radii.retain(|&r| stretches.iter().any(|s| ROOM * r <= s.duration() && enough(s, r)));
    if radii.is_empty() {
        let densest = stretches.iter().max_by_key(|s| s.times.len()).map_or(longest, Stretch::duration);
        radii.push(OF_SHORT * densest);
    }
    radii
}

/// Rounds at the middle radius, from the sphere: where radii are compared.
///
/// Torque noise that was fitted at one radius is that of all: its level is a property of the body.
fn compared_at<'a>(
    stretches: &'a [Stretch],
    radii: &[f64],
    columns: &'a [Column],
    variance: f64,
    noise: Option<Noise>,
) -> Option<Rounds<'a>> {
    let start = Unknowns::at(Coordinates::zeros(), columns);
    let mut rounds = Rounds::new(stretches, radii[radii.len() / 2], columns, start.clone())?;
    if let Some(noise) = noise {
        if rounds.descend(variance, noise).is_none() {
            rounds.at = start;
        }
    } else {
        for _ in 0..COMPARED {
            if rounds.round(variance, true).is_none() {
                break;
            }
        }
    }
    Some(rounds)
}

/// Equations of one radius, whose covariance is predicted.
struct Judged<'a> {
    radius: f64,
    rounds: Rounds<'a>,
    parts: Vec<Linearised>,
    whitened: Vec<Whitened>,
    information: Form,
    /// Variance of the noise, as large as the misfit makes it.
    variance: f64,
}

impl<'a> Judged<'a> {
    fn new(
        stretches: &'a [Stretch],
        radius: f64,
        columns: &'a [Column],
        variance: f64,
        compared: &Rounds<'_>,
    ) -> Option<Self> {
        let rounds = Rounds::new(stretches, radius, columns, compared.at.clone())?.with_levels(compared);
        let parts = rounds.linearise();
        let whitened = rounds.whiten(&parts)?;
        let stacked = rounds.stack(&whitened, variance);
        let information = stacked.information();
        // a misfit counts as noise, so that radii too short for the sampling or too long for the torques lose
        let variance = variance * stacked.excess(variance);
        Some(Judged { radius, rounds, parts, whitened, information, variance })
    }

    /// Trace of the covariance, infinite where there is none.
    fn trace(&self, inflation: &Form) -> f64 {
        covariance(&self.information, inflation, self.variance).map_or(f64::INFINITY, |c| c.trace())
    }

    /// The same without noise in G, which only adds to it.
    fn least(&self) -> f64 {
        self.trace(&Form::zeros())
    }
}

/// The radius of least predicted covariance where `compared` stands.
fn least_covariance(
    stretches: &[Stretch],
    radii: &[f64],
    columns: &[Column],
    variance: f64,
    compared: &Rounds<'_>,
) -> f64 {
    let each = radii.iter().filter_map(|&radius| Judged::new(stretches, radius, columns, variance, compared));
    let mut judged: Vec<Judged<'_>> = each.collect();
    judged.sort_by(|a, b| a.least().total_cmp(&b.least()));
    let mut best = (f64::INFINITY, radii[radii.len() / 2]);
    for judged in judged {
        // what the noise in G adds is dear, and not asked for where the rest is too much already
        if judged.least() >= best.0 {
            break;
        }
        let trace = judged.trace(&judged.rounds.inflation(&judged.parts, &judged.whitened));
        if trace < best.0 {
            best = (trace, judged.radius);
        }
    }
    best.1
}

/// The radius of least predicted covariance, and the unknowns it was judged at.
fn choose_radius(
    stretches: &[Stretch],
    columns: &[Column],
    variance: f64,
    noise: Option<Noise>,
) -> Option<(f64, Unknowns)> {
    let radii = candidates(stretches);
    let compared = compared_at(stretches, &radii, columns, variance, noise)?;
    let radius = least_covariance(stretches, &radii, columns, variance, &compared);
    Some((radius, compared.at))
}

/// Refuses a radius whose equations are nearly as many as the samples.
fn check_radius(stretches: &[Stretch], radius: f64) -> Result<(), Failure> {
    let dense = |s: &Stretch| {
        let tests = TestFunctions::new(s, radius);
        tests.is_some_and(|tests| tests.count as f64 > DENSE * s.times.len() as f64)
    };
    if stretches.iter().any(dense) { Err(Failure::Dense) } else { Ok(()) }
}

/// What ends the rounds of an estimate without torque noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// That they settled, or cannot.
    Rest,
    /// That too, or a misfit that stands and that only torques explain.
    Torques,
}

/// The weak estimate without torque noise; `variance` is that of the noise in units of the mean square rate. `None` where
/// torques ended it.
pub(crate) fn estimate(
    stretches: &[Stretch],
    radius: Option<f64>,
    columns: &[Column],
    variance: f64,
    ends: Ends,
) -> Result<Option<WeakEstimate>, Failure> {
    let (first, start, largest) = match radius {
        Some(radius) => {
            check_radius(stretches, radius)?;
            (radius, Unknowns::at(Coordinates::zeros(), columns), radius)
        }
        None => {
            let pilot = pilot(stretches);
            let (radius, start) = choose_radius(&pilot, columns, variance, None).ok_or(Failure::TooShort)?;
            (radius, start, candidates(&pilot).into_iter().fold(radius, f64::max))
        }
    };
    // a weak wobble in strong noise may need longer test functions than its information alone asks for
    let mut radius = first;
    let mut best: Option<WeakEstimate> = None;
    while radius <= largest * (1.0 + ROUNDED) {
        let mut rounds = Rounds::new(stretches, radius, columns, start.clone()).ok_or(Failure::TooShort)?;
        let are_torques = |before: f64, now: f64| now > TORQUES && (now / before - 1.0).abs() < STANDS;
        let settled = match ends {
            Ends::Rest => rounds.settle(variance),
            Ends::Torques => rounds.settle_unless(variance, are_torques),
        };
        if settled == Some(f64::INFINITY) {
            return Ok(None);
        }
        let moved = settled.filter(|&moved| moved <= RESTLESS);
        let weak = moved.and_then(|moved| rounds.finish(variance, moved));
        if let Some(weak) = weak.filter(|weak| weak.possible(variance)) {
            if weak.convergence() == Convergence::Still {
                return Ok(Some(weak));
            }
            // mere noise comes to rest on a motion, if there is one; torques may not let it
            let torques = weak.misfit(variance) > TORQUES;
            if torques && best.as_ref().is_none_or(|b| weak.moved < b.moved) {
                best = Some(weak);
            }
        }
        radius *= 2.0;
    }
    let sphere = || Rounds::new(stretches, first, columns, start)?.at_sphere(variance);
    best.or_else(sphere).map(Some).ok_or(Failure::Singular)
}

/// The weak estimate with torque noise, from the convex least squares downwards; at a given radius first from where a simpler
/// estimate ended, `near`.
pub(crate) fn descended(
    stretches: &[Stretch],
    radius: Option<f64>,
    columns: &[Column],
    variance: f64,
    noise: Noise,
    near: Option<&WeakEstimate>,
) -> Result<WeakEstimate, Failure> {
    let (radii, near) = match radius {
        Some(radius) => {
            check_radius(stretches, radius)?;
            (vec![radius], near.map(Reached::of))
        }
        None => {
            let pilot = pilot(stretches);
            let (first, _) =
                choose_radius(&pilot, columns, variance, Some(noise)).ok_or(Failure::TooShort)?;
            let all = candidates(&pilot);
            let longer = all.iter().copied().filter(|r| *r > first * (1.0 + ROUNDED));
            let shorter = all.iter().rev().copied().filter(|r| *r < first * (1.0 - ROUNDED));
            (core::iter::once(first).chain(longer).chain(shorter).collect(), None)
        }
    };
    let origin = Unknowns::at(Coordinates::zeros(), columns);
    let new = |radius: f64| Rounds::new(stretches, radius, columns, origin.clone());
    // from near by where that settles, and else as if nothing were known
    let resumed = || radii.first().copied().and_then(new)?.resumed(near.as_ref()?);
    let each = core::iter::once_with(resumed).flatten().chain(radii.iter().filter_map(|radius| new(*radius)));
    let mut best: Option<WeakEstimate> = None;
    for mut rounds in each {
        let moved = rounds.descend(variance, noise).filter(|&moved| moved <= RESTLESS);
        let weak = moved.and_then(|moved| rounds.finish(variance, moved));
        if let Some(weak) = weak.filter(|weak| weak.possible(variance)) {
            if weak.convergence() == Convergence::Still {
                return Ok(weak);
            }
            if best.as_ref().is_none_or(|b| weak.moved < b.moved) {
                best = Some(weak);
            }
        }
    }
    let sphere = || new(*radii.first()?)?.at_sphere(variance);
    best.or_else(sphere).ok_or(Failure::Singular)
}

/// The longest stretches, up to the samples of a pilot, in their order.
pub(crate) fn pilot(stretches: &[Stretch]) -> Vec<Stretch> {
    longest(stretches, PILOT_SAMPLES)
}

/// The longest stretches, up to a number of samples, in their order.
pub(crate) fn longest(stretches: &[Stretch], samples: usize) -> Vec<Stretch> {
    let mut longest: Vec<usize> = (0..stretches.len()).collect();
    longest.sort_by_key(|&k| core::cmp::Reverse(stretches[k].times.len()));
    let mut left = samples;
    let mut counts = vec![0; stretches.len()];
    for k in longest {
        counts[k] = left.min(stretches[k].times.len());
        left -= counts[k];
    }
    let part =
        |(s, &count): (&Stretch, &usize)| if count < s.times.len() { s.head(count) } else { s.clone() };
    stretches.iter().zip(&counts).filter(|(_, count)| **count > 3).map(part).collect()
}
