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
    // of so many neighbours the mean that the body hardly turns among them, and enough means are left
    let within = (ALIKE * samples as f64 / duration).max(1.0);
    let together = ((samples / MEANS).max(1)).min(within as usize);
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

/// Means of as many neighbours each, about the middle of a stretch.
fn means(s: &Stretch, together: usize) -> Track {
    let middle = 0.5 * (s.times.first().unwrap_or(&0.0) + s.times.last().unwrap_or(&0.0));
    let count = together as f64;
    let times = s.times.chunks_exact(together).map(|own| own.iter().map(|t| t - middle).sum::<f64>() / count);
    let rates = s.rates.chunks_exact(together).map(|own| own.iter().sum::<Vector3<f64>>() / count);
    let (times, rates): (Vec<f64>, Vec<Vector3<f64>>) = (times.collect(), rates.collect());
    Track { used: vec![true; times.len()], times, attitudes: Vec::new(), rates }
}
