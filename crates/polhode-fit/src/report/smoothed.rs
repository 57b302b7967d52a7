//! The report on attitudes of a body on which torques act.

use nalgebra::Matrix3;

use crate::columns::sets::torque_columns;
use crate::error::FitError;
use crate::models::weighed::spread;
use crate::physical::coordinates::Form;
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;
use crate::physical::nearest::nearest;
use crate::poses::free::Read;
use crate::report::answer::{Answer, of_entries, ratios, ratios_at, sigmas};
use crate::report::attitudes::AttitudeFit;
use crate::report::deviations::{Deviations, deviations};
use crate::report::estimate::{Estimate, Method, Residuals};
use crate::report::likelihood::{Of, Told, absolute, identify, joined};
use crate::report::model::models;
use crate::report::nuisance::{FittedTorque, Nuisance};
use crate::report::scale::{Noise, Scale, scale_of};
use crate::report::segments::{SegmentSummary, WithoutSegment, to_shares};
use crate::report::torque_free::Whiteness;
use crate::report::warnings::of_smoothed;
use crate::settings::Settings;
use crate::settings::known::Known;
use crate::settings::torque::TorqueModel;
use crate::signal::covariance::{acceleration_density, torque_shape};
use crate::signal::stretch::Stretch;
use crate::smoothed::choice::Chosen;

/// Everything that can be said of the answer; `read` is what was known of the attitudes before.
pub(crate) fn report(
    repeated: usize,
    settings: &Settings,
    read: &Read,
    chosen: &Chosen,
    told: Told,
) -> Result<Estimate, FitError> {
    let found = &chosen.found;
    let singular = || FitError::Solver(SolverFailure::Information);
    let squares: f64 = found.whitened.iter().flatten().map(|(_, left)| left.norm_squared()).sum();
    let misfit = squares / found.dof.max(1.0);
    // what the noise does not explain enlarges the deviations
    let excess = misfit.max(1.0);
    let own = found.covariance().ok_or_else(singular)? * excess;
    let of_choice = match settings.torque {
        TorqueModel::Auto => spread(&chosen.models, chosen.model),
        _ => Form::zeros(),
    };
    let covariance = own + of_choice;
    let information = covariance.cholesky().ok_or_else(singular)?.inverse();
    let rates: Vec<Stretch> = found
        .tracks
        .iter()
        .zip(&found.paths)
        .zip(&read.used)
        .map(|((track, path), &(segment, _))| {
            let rates = path.iter().map(|at| at.rate).collect();
            Stretch { segment, ..Stretch::new(track.times.clone(), rates) }
        })
        .collect();
    let identifiability = identify(&rates, &found.at.x, &information);
    let (joined, agreed) = joined(settings, &identifiability, found.is_still, &found.at.x, &information)?;
    let answer = nearest(&joined, &settings.limits, &[])?;
    let Deviations { free: factor, on_face, .. } = deviations(&joined, &[], &settings.limits, &[], &answer)?;
    let Answer { shape, moments, axes, v } = Answer::new(&answer.x)?;
    let (sigma_principal, sigma_axes) = sigmas(&on_face, &v, &moments);
    let ratios = ratios(&on_face, &v, &moments);
    let (j, both) = (shape.tensor(), on_face * on_face.transpose());
    let noise_sigma = found.variance.sqrt() * excess.sqrt();
    let torques = torque_shape(found.level.axes(), &j) * (found.level.torque * found.variance);
    let scale =
        |known: Known, path: &[Stretch], _: Of| size(known, path, read.unit, &j, noise_sigma, torques);
    let (inertia, inertia_covariance) =
        absolute(settings, &rates, chosen.model, &j, &both, &answer.x, scale)?;
    let residuals: Vec<Residuals> = found
        .whitened
        .iter()
        .zip(&found.tracks)
        .zip(&read.used)
        .map(|((left, track), &(segment, middle))| {
            let times = left.iter().map(|(sample, _)| middle + track.times[*sample] / read.unit);
            let values: Vec<[f64; 3]> = left.iter().map(|(_, left)| (*left).into()).collect();
            Residuals::new(segment, times.collect(), values)
        })
        .collect();
    let density = torque_noise(chosen, read.unit, &j);
    let left_out: usize = found.tracks.iter().flat_map(|t| &t.used).filter(|used| !**used).count();
    let attitudes = AttitudeFit {
        noise_sigma,
        noise_is_given: settings.attitude_noise.is_some(),
        residual: found.variance.sqrt() * misfit.sqrt(),
        local_noise: read.local_noise,
        is_inverse: told.is_inverse,
        direction_gain: told.gain,
        largest_turn: read.largest_turn,
        left_out: read.jumps + left_out,
        repeated,
        alignment: None,
    };
    let mut estimate = Estimate {
        principal: moments.into(),
        sigma_principal,
        axes,
        sigma_axes,
        ratios: ratios.map(|r| r.0),
        sigma_ratios: ratios.map(|r| r.1),
        covariance: of_entries(&on_face),
        free_covariance: of_entries(&factor),
        bound: None,
        bound_ratio: None,
        inertia,
        inertia_covariance,
        quanta: [0.0; 3],
        rms_rate: read.unit,
        noise_sigma: 0.0,
        chi2_per_dof: misfit + answer.pull * answer.pull / found.dof.max(1.0),
        pull: answer.pull,
        dof: found.dof as usize,
        samples: found.whitened.iter().map(Vec::len).sum(),
        segments: read.used.len(),
        method: Method::Smoother,
        radius: None,
        identifiability,
        triangle_slack: (2.0 * (LARGEST_SHARE - moments[2])).max(0.0),
        active_constraints: answer.active,
        certificate: answer.certificate,
        momentum_trend: None,
        energy_trend: None,
        whiteness: Whiteness::new(residuals.iter().map(|r| r.values.as_flattened())),
        torque: torque(chosen, excess, read.unit, settings.torque == TorqueModel::Auto),
        models: models(&chosen.models, chosen.model, None),
        reading_errors: Vec::new(),
        nuisances: Vec::new(),
        systematic: Vec::new(),
        prior: agreed,
        per_segment: summaries(chosen, read, &information, (excess, of_choice), density),
        unexplained: None,
        attitudes: Some(attitudes),
        mirror: None,
        sigma_mirror: None,
        unseen_change: None,
        spikes: Vec::new(),
        residuals,
        warnings: Vec::new(),
        shape,
    };
    let known = settings.attitude_noise.or(read.local_noise);
    let over = known.map(|known| found.variance * misfit / (known * known));
    estimate.warnings = of_smoothed(&estimate, over, density);
    Ok(estimate)
}

/// Power spectral density of the angular acceleration, (rad/s²)² s.
fn torque_noise(chosen: &Chosen, unit: f64, j: &Matrix3<f64>) -> f64 {
    let level = chosen.found.level;
    level.torque * chosen.found.variance * acceleration_density(level.axes(), j) * unit * unit * unit
}

/// The size by the rates of a path, in this unit, on which torque noise of the density `torques` acts: what is known has walked from the start of
/// each segment to its samples. The attitudes of the path had a component of the noise with that deviation: a straight line through the turns
/// leaves as much open of its slope.
fn size(
    known: Known,
    path: &[Stretch],
    unit: f64,
    j: &Matrix3<f64>,
    noise: f64,
    torques: Matrix3<f64>,
) -> Scale {
    let (mut slopes, mut samples) = (0.0, 0.0);
    for s in path {
        let (slope, count) = (noise / s.duration(), s.times.len() as f64);
        slopes += 12.0 * slope * slope * count;
        samples += count;
    }
    let noise = Noise { variance: slopes / samples, is_in_rates: false };
    scale_of(known, path, unit, j, noise).walking(path, unit, |_| torques)
}

fn torque(chosen: &Chosen, excess: f64, unit: f64, is_chosen: bool) -> FittedTorque {
    let found = &chosen.found;
    let covariance = found.information.clone().cholesky().map(|c| c.inverse() * excess);
    let each = torque_columns(chosen.model).into_iter().zip(&found.at.c).enumerate();
    let coefficients = each.map(|(k, (column, value))| {
        let sigma = covariance.as_ref().map_or(f64::INFINITY, |c| c[(5 + k, 5 + k)].sqrt());
        Nuisance::new(&column, *value, sigma, unit)
    });
    let acts = is_chosen && chosen.model != TorqueModel::None;
    FittedTorque {
        model: chosen.model,
        is_chosen,
        coefficients: coefficients.collect(),
        gain: acts.then_some(chosen.gain),
        ratios_without: acts.then(|| ratios_at(&chosen.without)),
    }
}

/// Each segment and its share of the information.
fn summaries(
    chosen: &Chosen,
    read: &Read,
    total: &Form,
    (excess, of_choice): (f64, Form),
    density: f64,
) -> Vec<SegmentSummary> {
    let inverse = total.cholesky().map(|c| c.inverse());
    let found = &chosen.found;
    let tracks = read.used.iter().zip(&found.tracks);
    let each =
        tracks.zip(found.of_each.iter().zip(&found.without)).map(|((&(segment, _), track), (own, rest))| {
            SegmentSummary {
                segment,
                samples: track.used.iter().filter(|used| **used).count(),
                noise_sigma: 0.0,
                torque_noise: density,
                weight: inverse.map_or(0.0, |inverse| (inverse * own).trace() / 5.0),
                without: rest.map(|(step, covariance)| {
                    let shift = step.dot(&(total * step)).sqrt();
                    WithoutSegment::new(&(found.at.x + step), &(covariance * excess + of_choice), shift)
                }),
            }
        });
    let mut each: Vec<SegmentSummary> = each.collect();
    to_shares(each.iter_mut().map(|s| &mut s.weight).collect());
    each
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode::rotation::Quat;

    use crate::likelihood::track::Track;
    use crate::physical::coordinates::{Coordinates, tensor};
    use crate::report::answer::ratios_of;
    use crate::report::parts::quantile;
    use crate::report::warning::Warning;
    use crate::settings::torque::TorqueNoise;
    use crate::signal::covariance::Shape;
    use crate::simulate::{Disturbances, Gyroscope, simulate_poses};
    use crate::smoothed::search::{Noise, first};
    use crate::thresholds::noise::SURE;

    const COUNT: usize = 10;
    const STEP: f64 = 0.3;

    fn body() -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(0.25, 0.3, 0.45))
    }

    /// A segment of steady spin about the axis of the largest moment.
    fn spin(segment: usize, rate: f64) -> Stretch {
        let times = (0..COUNT).map(|k| STEP * k as f64).collect();
        Stretch { segment, ..Stretch::new(times, vec![Vector3::z() * rate; COUNT]) }
    }

    /// Of a walk from its start, the sum of the covariances of all pairs of ten samples is that of the squares from 1 to 9, 285 steps.
    fn walk(rate: f64, density: f64) -> f64 {
        let momentum = 0.45 * rate;
        let growth = 4.0 * momentum * momentum * (0.45 * 0.45 * density);
        growth * 285.0 * STEP / 100.0
    }

    /// A size by the momentum goes with the root of its mean square, whose variance is that of the walk and of the slope of the turns.
    #[test]
    fn the_deviation_of_a_size_has_the_walk_and_the_noise_of_the_turns() {
        let (j, noise, density) = (body(), 0.02, 1e-3);
        let torques = torque_shape(Shape::Moments, &j) * density;
        let slope = noise / (STEP * (COUNT - 1) as f64);
        let v = 12.0 * slope * slope;
        let squares = (j * j).norm_squared();
        let own = v * (4.0 * libm::pow(0.45, 4.0) + 2.0 * v * squares) / COUNT as f64;
        let per_mean = 0.5 * (3.0 / 2.0 / 0.45) / (0.45 * 0.45);
        for segments in [1, 2] {
            let path: Vec<Stretch> = (0..segments).map(|k| spin(3 + k, 1.0)).collect();
            let scale = size(Known::Momentum(3.0), &path, 2.0, &j, noise, torques);
            assert!((scale.trace / (3.0 / 2.0 / 0.45) - 1.0).abs() < 1e-12, "{}", scale.trace);
            let of_trace = scale.covariance(&j, &Form::zeros(), 1.0, None).fixed_view::<3, 3>(0, 0).sum();
            // segments walk by themselves
            let expected = per_mean * per_mean * (own + walk(1.0, density)) / segments as f64;
            assert!((of_trace / expected - 1.0).abs() < 1e-9, "{segments}: {of_trace:e} {expected:e}");
        }
    }

    /// Momenta of segments that are d apart differ where half of d² over the sum of their variances by the walk is more than chance brings.
    #[test]
    fn momenta_of_segments_differ_beyond_their_walk() {
        let (j, path) = (body(), [spin(0, 1.0), spin(2, 1.1)]);
        let apart = 0.45 * 0.45 * (1.1 * 1.1 - 1.0);
        let most = apart * apart / (2.0 * quantile(1.0, SURE) * (walk(1.0, 1.0) + walk(1.1, 1.0)));
        let settings = Settings::default().with_known(Known::Momentum(1.0));
        for (share, is_refused) in [(0.99, true), (1.01, false)] {
            let torques = torque_shape(Shape::Moments, &j) * (share * most);
            let scale = |known: Known, path: &[Stretch], _: Of| size(known, path, 1.0, &j, 0.0, torques);
            let (covariance, x) = (Form::zeros(), Coordinates::zeros());
            match absolute(&settings, &path, TorqueModel::None, &j, &covariance, &x, scale) {
                Err(FitError::SizeDiffers { factor, largest: 2, smallest: 0, .. }) if is_refused => {
                    assert!((factor / 1.1 - 1.0).abs() < 1e-9, "{factor}");
                }
                found => assert!(found.is_ok() && !is_refused, "{share}: {found:?}"),
            }
        }
    }

    /// Two segments of a free body, searched without torque noise; a little of it is then said to act, and one sample to be left out.
    fn searched() -> Chosen {
        let x = Coordinates::new(-0.06, 0.02, 0.03, -0.02, 0.04);
        let (body, mut random) = (Inertia::from_tensor(tensor(&x)).unwrap(), Random::new(14));
        let tracks = [Vector3::new(0.5, 0.8, -0.4), Vector3::new(-0.7, 0.3, 0.6)].map(|start| {
            let times: Vec<f64> = (0..60).map(|k| 0.1 * f64::from(k)).collect();
            let (none, perfect) = (Disturbances::default(), Gyroscope::default());
            let made = simulate_poses(&body, start, &times, &none, &perfect, 3e-3, &mut random).unwrap();
            let attitudes = made.attitudes.iter().map(|q| Quat::from(*q)).collect();
            let times = times.iter().map(|t| t - 2.95).collect();
            Track { attitudes, rates: Vec::new(), used: vec![true; 60], times }
        });
        let noise = Noise { attitude: None, torque: TorqueNoise::None };
        let mut found = first(&tracks, x, &[], noise).unwrap();
        found.level.torque = 0.25;
        found.tracks[0].used[5] = false;
        let without = found.at.x;
        Chosen { found, model: TorqueModel::None, gain: 0.0, without, models: Vec::new() }
    }

    /// The same where the noise is stated to be so many times as large.
    fn stated(chosen: &Chosen, times: f64) -> Chosen {
        let (mut found, square) = (chosen.found.clone(), times * times);
        found.variance *= square;
        found.information /= square;
        found.level.torque /= square;
        found.of_each.iter_mut().for_each(|of| *of /= square);
        found.without.iter_mut().flatten().for_each(|(_, covariance)| *covariance *= square);
        found.whitened.iter_mut().flatten().for_each(|(_, left)| *left /= times);
        Chosen { found, model: chosen.model, gain: chosen.gain, without: chosen.without, models: Vec::new() }
    }

    fn read() -> Read {
        Read { used: vec![(0, 1.0), (2, 9.0)], largest_turn: 0.2, jumps: 4, ..Read::nothing() }
    }

    /// Without a segment the tensor is a step from that of all, and its covariance is that of the others, enlarged by what the noise does not explain,
    /// with what the choice of a torque adds; shares of the information sum to 1.
    #[test]
    fn without_a_segment_the_tensor_is_a_step_away() {
        let mut chosen = searched();
        let step = Coordinates::new(0.01, -0.02, 0.005, 0.01, -0.015);
        let covariance = Form::identity() * 1e-4;
        let of_choice = Form::from_diagonal(&Coordinates::new(1e-5, 2e-5, 3e-5, 4e-5, 5e-5));
        chosen.found.without = vec![Some((step, covariance)), None];
        chosen.found.of_each = vec![Form::identity() * 3.0, Form::identity()];
        let found = summaries(&chosen, &read(), &(Form::identity() * 4.0), (4.0, of_choice), 0.5);
        let [first, second] = &found[..] else { panic!("{found:?}") };
        let own = first.without.unwrap();
        let expected = ratios_of(&(chosen.found.at.x + step), &(covariance * 4.0 + of_choice));
        for (k, (ratio, sigma)) in expected.into_iter().enumerate() {
            assert!((own.ratios[k] / ratio - 1.0).abs() < 1e-12, "{k}: {}", own.ratios[k]);
            assert!((own.sigma_ratios[k] / sigma - 1.0).abs() < 1e-9, "{k}: {}", own.sigma_ratios[k]);
        }
        assert!((own.shift / (2.0 * step.norm()) - 1.0).abs() < 1e-12, "{}", own.shift);
        assert!(second.without.is_none() && (first.torque_noise, second.torque_noise) == (0.5, 0.5));
        assert!((first.weight - 0.75).abs() < 1e-12 && (second.weight - 0.25).abs() < 1e-12, "{found:?}");
    }

    /// A noise that is stated as half of what the motion leaves changes nothing but the misfit, which enlarges all deviations by as much; one that
    /// is stated as twice that is believed, and deviations are twice as large. What is left of the attitudes is the same.
    #[test]
    fn a_stated_noise_is_enlarged_by_what_it_does_not_explain() {
        let chosen = searched();
        let sigma = chosen.found.variance.sqrt();
        let read = read();
        let of = |times: f64| {
            let settings =
                Settings::default().with_torque(TorqueModel::None).with_attitude_noise(times * sigma);
            report(3, &settings, &read, &stated(&chosen, times), Told { is_inverse: true, gain: Some(7.0) })
                .unwrap()
        };
        let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-9;
        let own = of(1.0);
        for (times, deviations) in [(1.0, 1.0), (0.5, 1.0), (2.0, 2.0)] {
            let found = of(times);
            let attitudes = found.attitudes.as_ref().unwrap();
            assert!(
                near(attitudes.residual, sigma) && near(attitudes.noise_sigma, sigma * deviations),
                "{times}"
            );
            assert_eq!((attitudes.left_out, attitudes.repeated, attitudes.is_inverse), (5, 3, true));
            assert!(attitudes.noise_is_given && attitudes.direction_gain == Some(7.0));
            assert!(near(found.chi2_per_dof, 1.0 / (times * times)), "{times}: {}", found.chi2_per_dof);
            // 120 attitudes, two starts and the tensor
            assert_eq!((found.dof, found.samples, found.segments), (3 * 120 - 12 - 5, 120, 2));
            for k in 0..3 {
                assert!(near(found.sigma_principal[k], deviations * own.sigma_principal[k]), "{times} {k}");
                assert!(near(found.sigma_axes[k], deviations * own.sigma_axes[k]), "{times} {k}");
            }
            for (k, (segment, same)) in found.per_segment.iter().zip(&own.per_segment).enumerate() {
                assert_eq!((segment.segment, segment.samples), (2 * k, 59 + k));
                // level times variance times the third power of the unit
                assert!(
                    near(segment.torque_noise, 0.25 * sigma * sigma * 8.0)
                        && near(segment.weight, same.weight)
                );
                let (without, same) = (segment.without.unwrap(), same.without.unwrap());
                assert!(near(without.sigma_ratios[0], deviations * same.sigma_ratios[0]), "{times} {k}");
                assert!(near(without.shift * deviations, same.shift), "{times} {k}");
            }
            assert!(near(found.per_segment.iter().map(|segment| segment.weight).sum(), 1.0));
            let squares = |e: &Estimate| e.residuals[1].mean_square * times * times;
            assert!(near(squares(&found), own.residuals[1].mean_square), "{times}");
            // times are from the middle of the segment, in units of the inverse rate
            assert!(near(found.residuals[1].times[0], 9.0 - 2.95 / 2.0));
            let more = found.warnings.iter().find_map(|warning| match warning {
                Warning::AttitudeResiduals { times, noise } => Some((*times, *noise)),
                _ => None,
            });
            assert_eq!(more.is_some(), times < 1.0, "{:?}", found.warnings);
            assert!(
                more.is_none_or(|(times, noise)| near(times, 2.0) && near(noise, 0.5 * sigma)),
                "{more:?}"
            );
        }
    }
}
