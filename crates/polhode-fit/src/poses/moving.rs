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
    if is_of_rates {
        let rates = back.rates.iter_mut().zip(&track.times);
        rates.for_each(|(w, t)| *w = by(t).rotate((*w).into()).into());
    } else {
        let attitudes = back.attitudes.iter_mut().zip(&track.times);
        attitudes.for_each(|(q, t)| *q = *q * by(t).conjugate());
    }
    back
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::alternatives::{self, Alternatives, MovingAxes};
    use crate::likelihood::choice::{Acting, Moved};
    use crate::likelihood::descent::Levels;
    use crate::likelihood::growth::Followed;
    use crate::likelihood::track::Model;

    /// Axes that still turn by so much, of which a step finds a share: a gain of 10⁴ times the square.
    fn left(turn: Vector3<f64>, share: f64, is_of_rates: bool) -> Found {
        let (x, alignment) = (Coordinates::zeros(), Quat::identity());
        let model = Model { x, alignment, is_aligned: true, drag: None, starts: Vec::new() };
        let levels = Levels { attitude: 0.0, rate: libm::exp(turn.norm_squared()) };
        let followed = Followed::at(model, levels, [0.0, 1e4]);
        let values = (turn * share).as_slice().to_vec();
        let found =
            alternatives::Found { values, ..alternatives::Found::gaining(1e4 * turn.norm_squared(), 3) };
        let mut all = Alternatives::gaining([0.0; 5]);
        all.moving = Some(MovingAxes { found, is_of_rates });
        let moved = Moved { followed, alternatives: Some(all) };
        Found { moved, torque: Acting::Nothing, gain: None, without: None, models: Vec::new() }
    }

    /// From a gain of 15 on axes are turned back, step by step up to six, while a step gains a hundredth and the samples are likelier for it, and while
    /// it is the same sensor that moves; the gain is that of the first step.
    #[test]
    fn axes_are_turned_back_while_that_is_likelier() {
        let turn = Vector3::new(0.5, 0.0, 0.0);
        let times = vec![-1.0, 1.0];
        let attitudes = times.iter().map(|t| Quat::exponential(Vec3::from(turn * (0.5 * t)))).collect();
        let tracks = [Track { attitudes, rates: Vec::new(), used: vec![true; 2], times }];
        // from the middle to the end is half of it
        let rest = |tracks: &[Track]| {
            let half: Vector3<f64> = tracks[0].attitudes[1].logarithm().into();
            half * 2.0
        };
        let near = |moving: Option<Moving>, share: f64| {
            let Moving { turn: found, gain, .. } = moving.unwrap();
            assert!((found - turn * share).norm() < 1e-12 && (gain / 2500.0 - 1.0).abs() < 1e-12, "{found}");
        };
        // 2500, 25 and 0.25 are gained by steps of nine tenths, and then no hundredth
        for (share, expected) in [(0.9, 0.999), (0.1, 1.0 - 0.531_441)] {
            let of = |tracks: &[Track]| Some(left(rest(tracks), share, false));
            near(with_moving_axes(&tracks, left(turn, share, false), of).1, expected);
        }
        let other = |tracks: &[Track]| Some(left(rest(tracks), 0.9, true));
        near(with_moving_axes(&tracks, left(turn, 0.9, false), other).1, 0.9);
        let worse = |_: &[Track]| Some(left(turn * 2.0, 0.9, false));
        near(with_moving_axes(&tracks, left(turn, 0.9, false), worse).1, 0.0);
        near(with_moving_axes(&tracks, left(turn, 0.9, false), |_| None).1, 0.0);
        for (gain, is_moving) in [(14.9, false), (15.1, true)] {
            let found = left(Vector3::y() * f64::sqrt(gain * 1e-4), 0.9, false);
            assert_eq!(with_moving_axes(&tracks, found, |_| None).1.is_some(), is_moving, "{gain}");
        }
    }

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
