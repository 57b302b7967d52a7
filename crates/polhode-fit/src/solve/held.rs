//! Rounds of the weak equations with the tensor held: what a record of a known body tells of the columns.

use crate::thresholds::noise::DEVIATIONS;
use nalgebra::Vector3;

use crate::columns::column::{Column, Unknowns};
use crate::physical::coordinates::Coordinates;
use crate::signal::covariance::{Covariance, Levels};
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::TestFunctions;
use crate::solve::levels::likeliest;
use crate::solve::linearised::{Linearised, Whitened};
use crate::solve::radius::candidates;
use crate::solve::rounds::Noise;
use crate::solve::stacked::Stacked;
use crate::thresholds::rounds::{ROUNDS, STILL};

/// The columns that explain a record with a given tensor.
pub(crate) struct Held {
    pub(crate) values: Vec<f64>,
    /// Their standard deviations, where the noise explains the residuals.
    pub(crate) sigmas: Vec<f64>,
    /// Mean square of the residuals over the noise.
    pub(crate) misfit: f64,
    pub(crate) dof: usize,
    pub(crate) radius: f64,
    /// Of each stretch that is long enough, by its number.
    pub(crate) levels: Vec<(usize, Levels)>,
}

/// At the radius of the smallest deviation of the first column, or the given one.
pub(crate) fn held(
    stretches: &[Stretch],
    x: Coordinates,
    columns: &[Column],
    variance: f64,
    noise: Noise,
    radius: Option<f64>,
) -> Option<Held> {
    let radii = radius.map_or_else(|| candidates(stretches), |radius| vec![radius]);
    let all = radii.iter().filter_map(|&radius| at(stretches, x, columns, variance, noise, radius));
    let spread = |held: &Held| held.sigmas[0] * held.misfit.max(1.0).sqrt();
    all.filter(|held| spread(held).is_finite()).min_by(|a, b| spread(a).total_cmp(&spread(b)))
}

fn at(
    stretches: &[Stretch],
    x: Coordinates,
    columns: &[Column],
    variance: f64,
    noise: Noise,
    radius: f64,
) -> Option<Held> {
    let tests = stretches.iter().enumerate();
    let used: Vec<(usize, &Stretch, TestFunctions)> =
        tests.filter_map(|(k, s)| TestFunctions::new(s, radius).map(|tests| (k, s, tests))).collect();
    let mut at = Unknowns::at(x, columns);
    let mut samples: Vec<_> =
        used.iter().map(|(_, s, _)| vec![Vector3::<f64>::zeros(); s.times.len()]).collect();
    let mut levels: Vec<Levels> = vec![Levels::WHITE; used.len()];
    if let Noise::Given(torque) = noise {
        levels.iter_mut().for_each(|levels| levels.torque = torque);
    }
    let (mut best, mut fitted) = (None, noise != Noise::Fitted);
    for _ in 0..2 * ROUNDS {
        let each = used.iter().zip(&samples);
        let parts: Vec<Linearised> = each
            .map(|((_, s, tests), noise)| Linearised::new(s, noise, columns, at.clone(), tests.clone()))
            .collect();
        let each = parts.iter().zip(&used).zip(&samples);
        let covariances: Vec<Covariance> =
            each.map(|((part, (_, s, _)), noise)| part.covariance(s, noise)).collect();
        let each = parts.iter().zip(&covariances).zip(&levels);
        let whitened = each.map(|((part, covariance), levels)| {
            Some(part.whitened(covariance.factor(*levels)?, *levels, None))
        });
        let whitened: Vec<Whitened> = whitened.collect::<Option<_>>()?;
        let rows: Vec<&[f64]> = whitened.iter().map(|part| part.rows.as_slice()).collect();
        let stacked = Stacked::new(&rows, columns, &at, variance.sqrt());
        let next = stacked.with_columns(x)?;
        let inverse = stacked.own.clone().try_inverse()?;
        let steps = next.c.iter().zip(&at.c).enumerate();
        let sigmas: Vec<f64> = (0..columns.len()).map(|k| inverse.row(k).norm() * variance.sqrt()).collect();
        let moved = steps.map(|(k, (new, old))| ((new - old) / sigmas[k]).abs()).fold(0.0, f64::max);
        for (((part, white), (_, s, _)), old) in parts.iter().zip(&whitened).zip(&used).zip(&mut samples) {
            white.carry(part, s, old, &next, 1.0);
        }
        let misfit = stacked.squares_at(&x) / variance / stacked.rows.max(1) as f64;
        let (dof, several) = (stacked.rows, used.len() > 1);
        let unexplained = misfit > 1.0 + DEVIATIONS * (2.0 / dof.max(1) as f64).sqrt();
        if moved <= STILL && !fitted && unexplained {
            // what noise of the rates does not explain is torque noise
            fitted = true;
            for ((part, covariance), levels) in parts.iter().zip(&covariances).zip(&mut levels) {
                *levels = likeliest(covariance, &part.residuals(&next), variance, 1.0, several, None)?;
            }
        } else if moved <= STILL {
            let levels = used.iter().zip(&levels).map(|((k, ..), levels)| (*k, *levels)).collect();
            best = Some(Held { values: next.c, sigmas, misfit, dof, radius, levels });
            break;
        }
        at = next;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::drag::Drag;
    use crate::physical::coordinates::coordinates;
    use crate::signal::normalised::{Normalised, normalised};
    use crate::simulate::{Disturbances, Gyroscope, simulate_with};
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode::record::Record;

    /// A record of a known body tells its drag within five deviations, with residuals of its noise; without a radius at the one of the smallest
    /// deviation. Torque noise that is given stays.
    #[test]
    fn the_drag_of_a_known_body_is_told() {
        let (body, drag, sigma) = (Inertia::from_moments([1.0, 2.0, 2.6]).unwrap(), 0.01, 2e-3);
        let times: Vec<f64> = (0..800).map(|k| 0.05 * f64::from(k)).collect();
        let (by, with) =
            (Disturbances::default().with_relative_drag(drag), Gyroscope::default().with_noise(sigma));
        let start = Vector3::new(0.3, 0.9, 0.5);
        let rates = simulate_with(&body, start, &times, &by, &with, &mut Random::new(6)).unwrap();
        let Normalised { stretches, rms, .. } =
            normalised(&Record::from_samples(&times, &rates).unwrap()).unwrap();
        let (x, variance) = (coordinates(&(body.tensor() / 5.6)), (sigma / rms) * (sigma / rms));
        let columns = [Column::new(Drag, None)];
        let of = |noise, radius| held(&stretches, x, &columns, variance, noise, radius).unwrap();
        let spread = |held: &Held| held.sigmas[0] * held.misfit.max(1.0).sqrt();
        let best = of(Noise::White, None);
        let radii = candidates(&stretches);
        assert!(radii.contains(&best.radius), "{}", best.radius);
        for radius in radii {
            let found = of(Noise::White, Some(radius));
            let (value, deviation) = (found.values[0] * rms, found.sigmas[0] * rms);
            assert!((value - drag).abs() < 5.0 * deviation && deviation < 0.1 * drag, "{value} {deviation}");
            let chance = 5.0 * (2.0 / found.dof as f64).sqrt();
            assert!((found.misfit - 1.0).abs() < chance, "{radius}: {} of {}", found.misfit, found.dof);
            assert!(spread(&found) >= spread(&best) && found.radius == radius);
            assert_eq!(found.levels, [(0, Levels::WHITE)]);
            // of three equations for each test function one tells the drag
            let tests = TestFunctions::new(&stretches[0], radius).unwrap();
            assert_eq!(found.dof, 3 * tests.count - 1);
        }
        let given = of(Noise::Given(0.3), Some(best.radius));
        assert_eq!(given.levels, [(0, Levels { torque: 0.3, ..Levels::WHITE })]);
        assert!(given.misfit < best.misfit && given.sigmas[0] > best.sigmas[0]);
    }

    /// Of two segments, one with a third of the noise that is known and one with three times it, the quiet one has the mean of the square of its own
    /// and of the known one, 5/9. Noise of one segment alone stays the known one, and torque noise is what is more.
    #[test]
    fn segments_of_a_known_body_have_their_own_noise() {
        let (body, sigma) = (Inertia::from_moments([1.0, 2.0, 2.6]).unwrap(), 2e-3);
        let times: Vec<f64> = (0..400).map(|k| 0.05 * f64::from(k)).collect();
        let mut random = Random::new(8);
        let mut read = |share: f64| {
            let with = Gyroscope::default().with_noise(share * sigma);
            let (start, none) = (Vector3::new(0.3, 0.9, 0.5), Disturbances::default());
            let rates = simulate_with(&body, start, &times, &none, &with, &mut random).unwrap();
            Record::from_samples(&times, &rates).unwrap()
        };
        let (quiet, noisy) = (read(1.0 / 3.0), read(3.0));
        let x = coordinates(&(body.tensor() / 5.6));
        let of = |record: &Record| {
            let Normalised { stretches, rms, .. } = normalised(record).unwrap();
            let variance = (sigma / rms) * (sigma / rms);
            held(&stretches, x, &[Column::new(Drag, None)], variance, Noise::Fitted, Some(1.0)).unwrap()
        };
        let both = of(&quiet.join(noisy.clone()));
        let [(0, first), (1, _)] = both.levels[..] else { panic!("{:?}", both.levels) };
        // the drag of both is off by the noise of the other
        assert!((0.53..0.75).contains(&first.white) && first.torque == 0.0, "{first:?}");
        let alone = of(&noisy);
        let [(0, only)] = alone.levels[..] else { panic!("{:?}", alone.levels) };
        assert!(only.white == 1.0 && only.torque > 0.0, "{only:?}");
    }
}
