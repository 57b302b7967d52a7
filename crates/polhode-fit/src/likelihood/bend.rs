//! How much the ellipsoid of a weak estimate is too small: by the profile of the likelihood on the exact motion.
//!
//! The weak equations are linear in the tensor, and so is what they say of its deviations. Next to a steady spin bodies of other moments
//! follow the samples nearly as well, along a path that bends.

use nalgebra::Vector3;
use polhode::rotation::Quat;

use crate::likelihood::descent::Levels;
use crate::likelihood::growth::search;
use crate::likelihood::track::Track;
use crate::physical::coordinates::{Coordinates, Form};
use crate::signal::stretch::Stretch;
use crate::thresholds::likelihood::{ALIKE, MEANS, MOST, SEARCHES};
use crate::thresholds::poses::FEWEST;

/// What is to be added to the covariance of the coordinates `x` of a free body; nothing where no motion is found,
/// or the record is so long that the search would take minutes.
pub(crate) fn beyond(stretches: &[Stretch], x: Coordinates, variance: f64) -> Form {
    let samples: usize = stretches.iter().map(|s| s.times.len()).sum();
    let duration: f64 = stretches.iter().map(Stretch::duration).sum();
    let together = together(samples, duration);
    let tracks: Vec<Track> =
        stretches.iter().map(|s| means(s, together)).filter(|track| track.times.len() >= FEWEST).collect();
    if tracks.iter().map(|track| track.times.len()).sum::<usize>() > MOST {
        return Form::zeros();
    }
    let levels = Levels { attitude: 0.0, rate: (variance / together as f64).sqrt() };
    let mut from = x;
    for _ in 0..SEARCHES {
        let Some(found) = search(&tracks, from, Quat::identity(), levels, false) else { break };
        if found.is_still {
            let apart = found.model.x - x;
            return found.beyond.iter().chain([&apart]).map(|d| d * d.transpose()).sum();
        }
        from = found.model.x;
    }
    // it goes on along the path: so far at least
    let apart = from - x;
    apart * apart.transpose()
}

/// Of so many neighbours the mean that the body hardly turns among them, and enough means are left.
fn together(samples: usize, duration: f64) -> usize {
    let within = (ALIKE * samples as f64 / duration).max(1.0);
    ((samples / MEANS).max(1)).min(within as usize)
}

/// Means of as many neighbours each, about the middle of a stretch.
fn means(s: &Stretch, together: usize) -> Track {
    let middle = 0.5 * (s.times.first().unwrap_or(&0.0) + s.times.last().unwrap_or(&0.0));
    let count = together as f64;
    let times = s.times.chunks_exact(together).map(|own| own.iter().map(|t| t - middle).sum::<f64>() / count);
    let rates = s.rates.chunks_exact(together).map(|own| own.iter().sum::<Vector3<f64>>() / count);
    let (times, rates): (Vec<f64>, Vec<Vector3<f64>>) = (times.collect(), rates.collect());
    Track { used: vec![true; times.len()], times, attitudes: Vec::new(), rates }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use crate::simulate::simulate;
    use nalgebra::Matrix3;
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    /// Means of three about the middle of all times; what is left over is in none.
    #[test]
    fn means_of_neighbours_count_from_the_middle() {
        let times = vec![0.0, 1.0, 2.0, 3.0, 4.0, 7.0, 8.0];
        let rates = (0..7).map(|k| Vector3::new(f64::from(k), 1.0, 0.0)).collect();
        let found = means(&Stretch::new(times, rates), 3);
        // the middle is at 4
        assert!((found.times[0] + 3.0).abs() < 1e-15 && (found.times[1] - 2.0 / 3.0).abs() < 1e-15);
        assert_eq!(found.rates, [Vector3::new(1.0, 1.0, 0.0), Vector3::new(4.0, 1.0, 0.0)]);
        assert!(found.times.len() == 2 && found.used == [true; 2] && found.attitudes.is_empty());
    }

    /// A quarter of a radian is told by 8, 10, 2, none or 25 neighbours; the means are 200 at least, where there are as many samples.
    #[test]
    fn means_are_of_neighbours_that_are_alike() {
        for (samples, duration, count) in
            [(1000, 30.0, 5), (1600, 40.0, 8), (1000, 100.0, 2), (1000, 1000.0, 1), (100, 1.0, 1)]
        {
            assert_eq!(together(samples, duration), count, "{samples} {duration}");
        }
    }

    /// Eight means tell how far off an estimate is, seven do not.
    #[test]
    fn eight_means_are_enough() {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let times: Vec<f64> = (0..8).map(|k| 0.75 * f64::from(k)).collect();
        let (body, start) = (Inertia::from_tensor(j).unwrap(), Vector3::new(0.5, 0.8, -0.4));
        let rates = simulate(&body, start, &times, 1e-6, &mut Random::new(2)).unwrap();
        let off = Coordinates::new(0.01, -0.005, 0.0, 0.008, 0.0);
        let eight = Stretch::new(times, rates);
        let of = |stretch: Stretch| beyond(&[stretch], coordinates(&j) + off, 1e-12);
        let expected = off * off.transpose();
        assert!((of(eight.clone()) - expected).amax() < 0.1 * expected.amax());
        assert_eq!(of(eight.head(7)), Form::zeros());
    }

    /// By as much as the likeliest tensor is off the estimate the ellipsoid is too small; of more means than a search takes nothing is said.
    #[test]
    fn the_way_to_the_likeliest_tensor_is_a_deviation() {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let x = coordinates(&j);
        let times: Vec<f64> = (0..300).map(|k| 0.1 * f64::from(k)).collect();
        let (body, start) = (Inertia::from_tensor(j).unwrap(), Vector3::new(0.5, 0.8, -0.4));
        let rates = simulate(&body, start, &times, 1e-4, &mut Random::new(2)).unwrap();
        let off = Coordinates::new(0.01, -0.005, 0.0, 0.008, 0.0);
        let found = beyond(&[Stretch::new(times, rates)], x + off, 1e-8);
        let expected = off * off.transpose();
        assert!((found - expected).amax() < 0.1 * expected.amax(), "{found}");
        let long = Stretch::new((0..=MOST).map(|k| k as f64).collect(), vec![Vector3::x(); MOST + 1]);
        assert_eq!(beyond(&[long], x, 1e-8), Form::zeros());
    }
}
