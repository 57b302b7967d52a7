//! Axes of attitudes and of rates that turn against each other at an even rate, as part of the model.
//!
//! A turn m over the duration of each segment takes the samples of one of the two sensors along, from the middle of the segment on. Samples that are
//! turned back by it are those of a body whose sensors stand still: what the model then asks for beside is added to m, until it asks for no more.

use nalgebra::{DMatrix, DVector, Vector3};
use polhode::rotation::{Quat, Vec3};

use crate::likelihood::choice::Found;
use crate::likelihood::track::Track;
use crate::physical::coordinates::{Coordinates, Form};
use crate::thresholds::poses::{MOVING, REST, TURNS};

/// How far the axes turn, and what it is worth.
#[derive(Clone, Debug)]
pub(crate) struct Moving {
    /// From the first sample of a segment to its last, rad, axes of the sensor that moves.
    pub(crate) turn: Vector3<f64>,
    /// Gain of log-likelihood, by one step of least squares.
    pub(crate) gain: f64,
    /// What the turn adds to the covariance of the tensor.
    pub(crate) spread: Form,
}

/// The model of samples that are turned back, where axes move; `found` is that of axes which stand still, `of` fits others.
pub(crate) fn with_moving_axes(
    tracks: &[Track],
    found: Found,
    of: impl Fn(&[Track]) -> Option<Found>,
) -> (Found, Option<Moving>) {
    let named = |found: &Found| found.moved.alternatives.as_ref().and_then(|all| all.moving.clone());
    let Some(first) = named(&found).filter(|moving| moving.found.gain > MOVING) else { return (found, None) };
    let (mut turn, mut best) = (Vector3::zeros(), found);
    for _ in 0..TURNS {
        let Some(step) = named(&best).filter(|step| step.is_of_rates == first.is_of_rates) else { break };
        if step.found.gain < REST {
            break;
        }
        let further = turn + Vector3::from_column_slice(&step.found.values);
        let back: Vec<Track> =
            tracks.iter().map(|track| turned_back(track, further, first.is_of_rates)).collect();
        let Some(next) = of(&back).filter(|next| next.moved.followed.cost() < best.moved.followed.cost())
        else {
            break;
        };
        (turn, best) = (further, next);
    }
    // what a further step would move counts as a deviation
    let spread = best.moved.alternatives.as_ref().map_or(Form::zeros(), |all| {
        let of = all.of_axes(first.is_of_rates);
        of.map_or(Form::zeros(), |found| added(&found.spread, &found.moved))
    });
    (best, Some(Moving { turn, gain: first.found.gain, spread }))
}

/// The covariance of the tensor by a factor of that of all that is shared, and by a shift of it.
pub(super) fn added(spread: &DMatrix<f64>, moved: &DVector<f64>) -> Form {
    let shift = Coordinates::from_fn(|k, _| moved[k]);
    let own = spread.rows(0, 5) * spread.rows(0, 5).transpose();
    Form::from_fn(|i, k| own[(i, k)]) + shift * shift.transpose()
}

/// The samples of one sensor as they would be if it had not turned.
fn turned_back(track: &Track, turn: Vector3<f64>, is_of_rates: bool) -> Track {
    let span = track.times.last().zip(track.times.first()).map_or(1.0, |(last, first)| last - first);
    let by = |t: &f64| Quat::exponential(Vec3::from(turn * (t / span)));
    let mut back = track.clone();
    for (k, t) in track.times.iter().enumerate() {
        match is_of_rates {
            true => back.rates.iter_mut().skip(k).take(1).for_each(|w| *w = by(t).rotate((*w).into()).into()),
            false => back.attitudes.iter_mut().skip(k).take(1).for_each(|q| *q = *q * by(t).conjugate()),
        }
    }
    back
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is added to the tensor is the square of its own rows of the factor and of the shift.
    #[test]
    fn factor_and_shift_add_their_squares() {
        let spread = DMatrix::from_fn(7, 2, |i, k| (i + 1) as f64 * if k == 0 { 1.0 } else { -2.0 });
        let moved = DVector::from_fn(7, |i, _| 3.0 - i as f64);
        let expected = Form::from_fn(|i, k| {
            let (a, b) = (i as f64, k as f64);
            5.0 * (a + 1.0) * (b + 1.0) + (3.0 - a) * (3.0 - b)
        });
        assert_eq!(added(&spread, &moved), expected);
    }

    /// Samples that turned with a sensor from the middle of their times on are those that stood still once they are turned back.
    #[test]
    fn samples_are_turned_back_by_their_part_of_the_turn() {
        let (turn, times) = (Vector3::new(0.3, -0.1, 0.2), vec![-1.0, 0.0, 0.5, 3.0]);
        let still = Track {
            attitudes: times.iter().map(|t| Quat::exponential(Vec3([0.2 * t, 0.5, -0.3]))).collect(),
            rates: times.iter().map(|t| Vector3::new(0.5, -0.2 * t, 1.0)).collect(),
            used: vec![true; 4],
            times,
        };
        for is_of_rates in [true, false] {
            let mut moved = still.clone();
            // a quarter of the turn for each second of four
            for (k, t) in still.times.iter().enumerate() {
                let by = Quat::exponential(Vec3::from(turn * (0.25 * t)));
                if is_of_rates {
                    moved.rates[k] = by.rotate_back(Vec3::from(moved.rates[k])).into();
                } else {
                    moved.attitudes[k] = moved.attitudes[k] * by;
                }
            }
            let back = turned_back(&moved, turn, is_of_rates);
            for k in 0..4 {
                let apart = (still.attitudes[k].conjugate() * back.attitudes[k]).logarithm().norm();
                assert!(apart < 1e-14 && (back.rates[k] - still.rates[k]).norm() < 1e-14, "{k}");
            }
            let apart = if is_of_rates {
                (moved.rates[3] - still.rates[3]).norm()
            } else {
                (still.attitudes[3].conjugate() * moved.attitudes[3]).logarithm().norm()
            };
            assert!(apart > 0.1, "{is_of_rates}");
        }
    }
}
