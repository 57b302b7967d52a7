//! In which axes the rates beside attitudes are.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::Direction;
use polhode::rotation::Quat;

/// Turns between two samples beyond which the mean of their rates says little, rad.
const LARGEST: f64 = 0.5;
/// Share of the mean square rate that the attitudes leave in the axes that are right, at most: errors of both, and of the mean over a step.
const AGREE: f64 = 0.1;
/// The least share in the axes of the body, and over that in space, of rates that are not in axes of the body.
const DISAGREE: (f64, f64) = (0.04, 9.0);

/// Root mean square of what the turns of attitudes leave of rates, rad/s.
pub(super) struct Left {
    pub(super) body: f64,
    pub(super) space: f64,
}

/// Of rates that are those about the axes of space, and not those about the axes of the body: what the attitudes leave of them in both. A direction
/// that nothing states is the one in which they agree best.
pub(super) fn about_space(
    times: &[f64],
    attitudes: &[UnitQuaternion<f64>],
    rates: &[Vector3<f64>],
    direction: Option<Direction>,
) -> Option<Left> {
    // about the axes of body and space, of attitudes from body to space and from space to body
    let (mut left, mut all, mut count) = ([[0.0; 2]; 2], 0.0, 0.0);
    for k in 1..times.len() {
        let step = times[k] - times[k - 1];
        let turn = rotation_vector(attitudes[k - 1].inverse() * attitudes[k]);
        if !(step > 0.0 && turn.norm() < LARGEST) {
            continue;
        }
        let behind = turn / step;
        let before = rotation_vector(attitudes[k] * attitudes[k - 1].inverse()) / step;
        let rate = (rates[k - 1] + rates[k]) * 0.5;
        left[0][0] += (rate - behind).norm_squared();
        left[0][1] += (rate - before).norm_squared();
        left[1][0] += (rate + before).norm_squared();
        left[1][1] += (rate + behind).norm_squared();
        all += rate.norm_squared();
        count += 1.0;
    }
    let of = |frame: usize| match direction {
        Some(Direction::BodyToSpace) => left[0][frame],
        Some(Direction::SpaceToBody) => left[1][frame],
        None => left[0][frame].min(left[1][frame]),
    };
    let (body, space) = (of(0), of(1));
    let is_space = space < AGREE * all && body > DISAGREE.0 * all && body > DISAGREE.1 * space;
    is_space.then(|| Left { body: (body / count).sqrt(), space: (space / count).sqrt() })
}

/// The same bits on every CPU, of length 0 to pi.
fn rotation_vector(turn: UnitQuaternion<f64>) -> Vector3<f64> {
    Quat::from(turn).logarithm().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A steady turn about an axis that turns about another.
    fn attitude(t: f64) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(Vector3::z() * 0.7 * t)
            * UnitQuaternion::from_scaled_axis(Vector3::new(0.6, 0.0, 0.0))
            * UnitQuaternion::from_scaled_axis(Vector3::z() * 1.1 * t)
    }

    #[test]
    fn rates_are_told_by_their_axes_in_either_direction() {
        let times: Vec<f64> = (0..200).map(|i| 0.05 * f64::from(i)).collect();
        let direct: Vec<_> = times.iter().map(|t| attitude(*t)).collect();
        let inverse: Vec<_> = direct.iter().map(UnitQuaternion::inverse).collect();
        let turn = |t: f64| (attitude(t - 1e-4).inverse() * attitude(t + 1e-4)).scaled_axis() / 2e-4;
        let body: Vec<_> = times.iter().map(|t| turn(*t)).collect();
        let space: Vec<_> = body.iter().zip(&direct).map(|(rate, q)| q * rate).collect();
        for (attitudes, direction) in [(&direct, Direction::BodyToSpace), (&inverse, Direction::SpaceToBody)]
        {
            for stated in [None, Some(direction)] {
                assert!(about_space(&times, attitudes, &body, stated).is_none());
                let found = about_space(&times, attitudes, &space, stated).unwrap();
                assert!(found.space < 1e-2 && found.body > 0.2, "{} {}", found.space, found.body);
            }
        }
        // about one fixed axis both are the same
        let steady = vec![Vector3::z(); 200];
        let about_z: Vec<_> =
            times.iter().map(|t| UnitQuaternion::from_scaled_axis(Vector3::z() * *t)).collect();
        assert!(about_space(&times, &about_z, &steady, None).is_none());
    }
}
