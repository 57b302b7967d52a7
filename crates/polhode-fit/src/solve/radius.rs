//! The half width of the test functions: chosen by least predicted covariance, doubled where the rounds do not settle.

use crate::columns::column::{Column, Unknowns};
use crate::physical::coordinates::{Coordinates, Form};
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::TestFunctions;
use crate::solve::linearised::{Linearised, Whitened};
use crate::solve::rounds::{Noise, Reached, Rounds};
use crate::solve::weak_estimate::{Convergence, WeakEstimate};
use crate::thresholds::radius::{
    CANDIDATES, COMPARED, DENSE, LONG, OF_SHORT, PART, PILOT_SAMPLES, ROOM, SHORTEST, SPARED,
};
use crate::thresholds::rounds::{BESIDE, RESTLESS, STANDS, TORQUES};
use crate::thresholds::test_functions::{ROUNDED, SAMPLES_PER_TEST};
use polhode::record::both;

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

/// Rounds at the middle radius, from the sphere: where radii are compared; and by how much the last of a descent has moved them.
///
/// Torque noise that was fitted at one radius is that of all: its level is a property of the body.
fn compared_at<'a>(
    stretches: &'a [Stretch],
    radii: &[f64],
    columns: &'a [Column],
    variance: f64,
    noise: Option<Noise>,
) -> Option<(Rounds<'a>, Option<f64>)> {
    let start = Unknowns::at(Coordinates::zeros(), columns);
    let mut rounds = Rounds::new(stretches, radii[radii.len() / 2], columns, start.clone())?;
    if let Some(noise) = noise {
        let moved = rounds.descend(variance, noise);
        if moved.is_none() {
            rounds.at = start;
        }
        return Some((rounds, moved));
    }
    for _ in 0..COMPARED {
        if rounds.round(variance, true).is_none() {
            break;
        }
    }
    Some((rounds, None))
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
        let (parts, whitened) = rounds.whiten()?;
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

/// The radius of least predicted covariance where `compared` stands; the longest of those whose covariance is at most `spared` times as
/// large.
fn least_covariance(
    stretches: &[Stretch],
    radii: &[f64],
    columns: &[Column],
    variance: f64,
    compared: &Rounds<'_>,
    spared: f64,
) -> f64 {
    let every_other = |first: usize| {
        let each = radii.iter().skip(first).step_by(2);
        let judged = each.filter_map(|&radius| Judged::new(stretches, radius, columns, variance, compared));
        judged.collect::<Vec<Judged<'_>>>()
    };
    let samples: usize = stretches.iter().map(|s| s.times.len()).sum();
    let (mut judged, others) = both(samples > BESIDE, || every_other(0), || every_other(1));
    judged.extend(others);
    judged.sort_by(|a, b| a.least().total_cmp(&b.least()).then(a.radius.total_cmp(&b.radius)));
    let mut traces: Vec<(f64, f64)> = Vec::new();
    let mut best = (f64::INFINITY, radii[radii.len() / 2]);
    for judged in judged {
        // what the noise in G adds is dear, and not asked for where the rest is too much already
        if judged.least() >= spared * best.0 {
            break;
        }
        let trace = judged.trace(&judged.rounds.inflation(&judged.parts, &judged.whitened));
        if trace < best.0 {
            best = (trace, judged.radius);
        }
        traces.push((trace, judged.radius));
    }
    let alike = traces.iter().filter(|(trace, _)| trace.is_finite() && *trace <= spared * best.0);
    alike.fold(best.1, |longest, (_, radius)| longest.max(*radius))
}

/// The radius of least predicted covariance, and the rounds it was judged at with their last move.
fn choose_radius<'a>(
    stretches: &'a [Stretch],
    columns: &'a [Column],
    variance: f64,
    noise: Option<Noise>,
    spared: f64,
) -> Option<(f64, Rounds<'a>, Option<f64>)> {
    let radii = candidates(stretches);
    let (compared, moved) = compared_at(stretches, &radii, columns, variance, noise)?;
    let radius = least_covariance(stretches, &radii, columns, variance, &compared, spared);
    Some((radius, compared, moved))
}

/// Refuses a radius whose equations are nearly as many as the samples.
fn check_radius(stretches: &[Stretch], radius: f64) -> Result<(), Failure> {
    let dense = |s: &Stretch| {
        let tests = TestFunctions::places(s, radius);
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
            let chosen = choose_radius(&pilot, columns, variance, None, spared(stretches));
            let (radius, compared, _) = chosen.ok_or(Failure::TooShort)?;
            (radius, compared.at, candidates(&pilot).into_iter().fold(radius, f64::max))
        }
    };
    // torques that stand in a part of a long record stand in all of it
    if ends == Ends::Torques && is_long(stretches) {
        let part = longest(stretches, PART);
        if let Ok(None) = estimate(&part, Some(first), columns, variance, ends) {
            return Ok(None);
        }
    }
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
    near: Option<Reached>,
) -> Result<WeakEstimate, Failure> {
    // of a short record the pilot is all of it
    let is_whole = stretches.iter().map(|s| s.times.len()).sum::<usize>() <= PILOT_SAMPLES
        && stretches.iter().all(|s| s.times.len() > 3);
    let part = if is_whole || radius.is_some() { Vec::new() } else { pilot(stretches) };
    let pilot: &[Stretch] = if is_whole { stretches } else { &part };
    let (radii, is_done, compared) = match radius {
        Some(radius) => {
            check_radius(stretches, radius)?;
            (vec![radius], false, None)
        }
        None => {
            let chosen = choose_radius(pilot, columns, variance, Some(noise), spared(stretches));
            let (first, rounds, moved) = chosen.ok_or(Failure::TooShort)?;
            let all = candidates(pilot);
            // radii were compared after this very descent
            let is_done = is_whole && first == all[all.len() / 2];
            let longer = all.iter().copied().filter(|r| *r > first * (1.0 + ROUNDED));
            let shorter = all.iter().rev().copied().filter(|r| *r < first * (1.0 - ROUNDED));
            let radii: Vec<f64> = core::iter::once(first).chain(longer).chain(shorter).collect();
            (radii, is_done, moved.filter(|_| is_done).map(|moved| (rounds, Some(moved))))
        }
    };
    let origin = Unknowns::at(Coordinates::zeros(), columns);
    let new = |radius: f64| Rounds::new(stretches, radius, columns, origin.clone());
    let of_part = || of_part(stretches, *radii.first()?, columns, variance, noise);
    let near = near.or_else(of_part);
    // from near by where that settles, and else as if nothing were known
    let resumed = || radii.first().copied().and_then(new)?.resumed(near?);
    let others = radii.iter().skip(usize::from(is_done)).filter_map(|radius| new(*radius));
    let to_do = core::iter::once_with(resumed).flatten().map(|rounds| (rounds, None));
    let each = to_do.chain(compared).chain(others.map(|rounds| (rounds, None)));
    let mut best: Option<WeakEstimate> = None;
    for (mut rounds, moved) in each {
        let moved = moved.or_else(|| rounds.descend(variance, noise)).filter(|&moved| moved <= RESTLESS);
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

/// Whether a record has so many samples that time is worth more than the last per cent of its information.
pub(crate) fn is_long(stretches: &[Stretch]) -> bool {
    stretches.iter().map(|s| s.times.len()).sum::<usize>() > LONG
}

/// How much of the covariance is given for fewer equations.
fn spared(stretches: &[Stretch]) -> f64 {
    if is_long(stretches) { SPARED } else { 1.0 }
}

/// Where the descent of a part of a long record ends: from there that of the whole has few rounds to go.
fn of_part(
    stretches: &[Stretch],
    radius: f64,
    columns: &[Column],
    variance: f64,
    noise: Noise,
) -> Option<Reached> {
    let part = is_long(stretches).then(|| longest(stretches, PART))?;
    let mut rounds = Rounds::new(&part, radius, columns, Unknowns::at(Coordinates::zeros(), columns))?;
    let moved = rounds.descend(variance, noise)?;
    (moved <= RESTLESS).then(|| Reached::of_part(&rounds))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::sets::torque_columns;
    use crate::settings::torque::TorqueModel;
    use crate::signal::normalised::{Normalised, normalised};
    use crate::simulate::{Disturbances, Gyroscope, simulate_with};
    use nalgebra::Vector3;
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode::record::Record;

    /// A body under drag of so many samples, with torque noise where it is asked for.
    fn record(samples: usize, torque_noise: f64) -> (Vec<Stretch>, f64) {
        let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
        let times: Vec<f64> = (0..samples).map(|k| 0.02 * k as f64).collect();
        let disturbances = Disturbances { relative_drag: 2e-5, torque_noise, ..Disturbances::default() };
        let (start, gyroscope) = (Vector3::new(0.3, 0.9, 0.5), Gyroscope::default().with_noise(1e-2));
        let rates = simulate_with(&body, start, &times, &disturbances, &gyroscope, &mut Random::new(3));
        let record = Record::from_samples(&times, &rates.unwrap()).unwrap();
        let Normalised { stretches, rms, .. } = normalised(&record).unwrap();
        (stretches, (1e-2 / rms) * (1e-2 / rms))
    }

    #[test]
    fn long_records_go_on_from_a_part_of_them() {
        let columns = torque_columns(TorqueModel::Drag);
        let (stretches, variance) = record(LONG + 10, 2e-2);
        let radius = 4.0;
        let long = descended(&stretches, Some(radius), &columns, variance, Noise::Fitted, None);
        let origin = Unknowns::at(Coordinates::zeros(), &columns);
        let mut rounds = Rounds::new(&stretches, radius, &columns, origin).unwrap();
        let moved = rounds.descend(variance, Noise::Fitted).unwrap();
        let (long, whole) = (long.ok().unwrap(), rounds.finish(variance, moved).unwrap());
        let apart = (whole.root * (long.x() - whole.x())).norm() / variance.sqrt();
        assert!(apart < 0.02, "{apart} deviations");
        assert!(long.has_torque_noise());
        assert!((long.root.norm() / whole.root.norm() - 1.0).abs() < 1e-3);
        // it stands out in a part already
        assert_eq!(long.doubt, Form::zeros());
    }

    #[test]
    fn a_long_record_takes_the_longest_of_radii_that_tell_as_much() {
        let (stretches, variance) = record(8_000, 0.0);
        let radius = |spared| choose_radius(&stretches, &[], variance, None, spared).unwrap().0;
        let (best, longer) = (radius(1.0), radius(SPARED));
        assert!(longer >= best && radius(1e3) > longer, "{best} {longer}");
    }

    /// So many samples, from 0 to a time.
    fn span(until: f64, samples: usize) -> Stretch {
        let step = until / (samples - 1) as f64;
        Stretch::new((0..samples).map(|k| step * k as f64).collect(), vec![Vector3::x(); samples])
    }

    /// Radii double from half a radian, or from that of eight samples, as long as a stretch holds four of them and has eight samples in two;
    /// where none has, the radius is a quarter of the stretch of the most samples.
    #[test]
    fn candidates_double_within_the_stretches() {
        assert_eq!(candidates(&[span(40.0, 4001)]), [0.5, 1.0, 2.0, 4.0, 8.0]);
        // of a long stretch with 2 rad from one sample to the next those from 7.6 rad on, of a dense one those up to a quarter of it
        assert_eq!(candidates(&[span(2.1, 1001), span(40.0, 21)]), [0.5, 8.0]);
        let near = |stretches: &[Stretch], expected: &[f64]| {
            let found = candidates(stretches);
            assert_eq!(found.len(), expected.len(), "{found:?}");
            assert!(found.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-12), "{found:?}");
        };
        near(&[span(40.0, 101)], &[320.0 / 101.0, 640.0 / 101.0]);
        near(&[span(1.9, 101)], &[0.475]);
        near(&[span(1.9, 101), span(1.0, 300)], &[0.25]);
    }

    /// A number of samples goes to the longest stretches first; what has three or fewer is none, and the order of the record stays.
    #[test]
    fn the_longest_stretches_come_first() {
        let all = [5, 9, 3, 7].map(|count| span((count - 1) as f64, count));
        let counts = |samples: usize| -> Vec<usize> {
            let found = longest(&all, samples);
            // each begins where its stretch begins
            assert!(found.iter().all(|own| all.iter().any(|s| s.times.starts_with(&own.times))));
            found.iter().map(|own| own.times.len()).collect()
        };
        assert_eq!(counts(14), [9, 5]);
        assert_eq!(counts(20), [4, 9, 7]);
        assert_eq!(counts(12), [9]);
        assert_eq!(counts(100), [5, 9, 7]);
    }

    /// Of an information of 8 with a variance of 2, of which the noise adds 1, the covariance is 4/3².
    #[test]
    fn noise_in_the_derivatives_widens_the_covariance() {
        let of = |inflation: f64| covariance(&(Form::identity() * 8.0), &(Form::identity() * inflation), 2.0);
        for (inflation, expected) in [(0.0, 0.25), (1.0, 4.0 / 9.0), (3.5, 16.0)] {
            assert!((of(inflation).unwrap() - Form::identity() * expected).amax() < 1e-13, "{inflation}");
        }
        assert!(of(4.0).is_none() && of(5.0).is_none());
    }

    /// What a radius tells at best is the inverse of its information times the variance, and noise in the derivatives only adds to it.
    #[test]
    fn what_a_radius_tells_at_best_is_without_noise_in_the_derivatives() {
        let (stretches, variance) = record(600, 0.0);
        let at = Unknowns::at(Coordinates::zeros(), &[]);
        let mut compared = Rounds::new(&stretches, 1.0, &[], at).unwrap();
        compared.round(variance, true).unwrap();
        for radius in [0.5, 1.0, 2.0] {
            let judged = Judged::new(&stretches, radius, &[], variance, &compared).unwrap();
            let (least, inverse) = (judged.least(), judged.information.try_inverse().unwrap());
            assert!((least / (inverse.trace() * judged.variance) - 1.0).abs() < 1e-6, "{radius}: {least:e}");
            let trace = judged.trace(&judged.rounds.inflation(&judged.parts, &judged.whitened));
            assert!(trace > least && least > 0.0, "{radius}: {trace:e} {least:e}");
        }
    }

    /// Of 101 samples 93 test functions are too many, 88 are not, and where none has eight samples there are none.
    #[test]
    fn equations_may_be_nine_tenths_of_the_samples() {
        let is_dense = |radius: f64| {
            let stretches = [span(10.0, 101), span(100.0, 9)];
            matches!(check_radius(&stretches, radius), Err(Failure::Dense))
        };
        // 4 (10 − 2 r)/r + 1 of them
        assert!(is_dense(0.4) && !is_dense(0.42) && !is_dense(0.39));
    }
}
