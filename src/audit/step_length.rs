//! Times of records that count steps: the length of a step from how far the body turns.

use super::{Attitudes, Trajectory};
use crate::body::Body;
use crate::rotation::{Quat, Vec3, rotation_angle};

/// Intervals that are looked at.
const LOOKS: usize = 1000;

/// Rounded numbers this near to the estimate are taken for it.
const NEAR: f64 = 0.01;

/// Length of a step, s, of a record whose times are counts of steps: the median of the turn between rows over the rate there.
///
/// The quaternions are scalar first, from body to space; rates and momenta are along the axes of space. Rates are in rad/s, momenta
/// in the unit of the body's inertia times rad/s. `None` where the body turns too far between rows, where the record has no rates
/// and no momenta with a body, and where its columns and its times differ in length.
///
/// ```
/// use polhode::audit::{Attitudes, Trajectory, step_length};
/// // a row after every 100 steps, in which a body of 0.5 rad/s turns by 0.25 rad
/// let row = |k: u32| [libm::cos(0.125 * f64::from(k)), 0.0, 0.0, libm::sin(0.125 * f64::from(k))];
/// let record = Trajectory::new((0..20).map(|k| 100.0 * f64::from(k)).collect())
///     .with_attitude(Attitudes::Quaternions((0..20).map(row).collect()))
///     .with_rates(vec![[0.0, 0.0, 0.5]; 20]);
/// assert_eq!(step_length(&record, None), Some(0.005));
/// ```
pub fn step_length(record: &Trajectory, body: Option<&Body>) -> Option<f64> {
    let Some(Attitudes::Quaternions(rows)) = &record.attitude else { return None };
    let length = |column: &Option<Vec<[f64; 3]>>| column.as_ref().map_or(rows.len(), Vec::len);
    let lengths = [record.times.len(), length(&record.rates), length(&record.momentum)];
    if lengths.iter().any(|length| *length != rows.len()) {
        return None;
    }
    let attitude = |k: usize| Quat::from_components(rows[k]).normalized();
    let inverse = body.and_then(|body| body.inertia().tensor().try_inverse());
    let speed = |k: usize| -> Option<f64> {
        if let Some(rates) = &record.rates {
            return Some(Vec3(rates[k]).norm());
        }
        let momentum = attitude(k).rotate_back(Vec3(record.momentum.as_ref()?[k]));
        let omega = inverse? * nalgebra::Vector3::from(momentum.0);
        Some(omega.norm())
    };
    let every = (rows.len() / LOOKS).max(1);
    let mut found = Vec::new();
    for k in (1..rows.len()).step_by(every) {
        let (angle, count) =
            (rotation_angle(attitude(k - 1), attitude(k)), record.times[k] - record.times[k - 1]);
        let rate = 0.5 * (speed(k - 1)? + speed(k)?);
        if rate > 0.0 && angle > 0.0 {
            found.push((angle, angle / (rate * count)));
        }
    }
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    let &(angle, estimate) = found.get(found.len() / 2)?;
    if !estimate.is_finite() || angle > 1.0 {
        return None;
    }
    Some(rounded(estimate))
}

/// The number with the fewest digits that is within a per cent, with at most three.
fn rounded(x: f64) -> f64 {
    let round = |digits: usize| format!("{x:.*e}", digits).parse::<f64>().unwrap_or(x);
    (0..3).map(round).find(|near| (near / x - 1.0).abs() < NEAR).unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_found_from_a_turn() {
        let rows = (0..20).map(|k| {
            let (sin, cos) = libm::sincos(0.5 * 0.25 * f64::from(k));
            [cos, 0.0, 0.0, sin]
        });
        let record = Trajectory::new((0..20).map(|k| 100.0 * f64::from(k)).collect())
            .with_attitude(Attitudes::Quaternions(rows.collect()))
            .with_rates(vec![[0.0, 0.0, 0.5]; 20]);
        assert_eq!(step_length(&record, None), Some(0.005));
        assert_eq!(rounded(0.002_504), 0.0025);
        let with = |times: usize, rates: usize| {
            let mut other = record.clone().with_rates(vec![[0.0, 0.0, 0.5]; rates]);
            other.times.truncate(times);
            step_length(&other, None)
        };
        assert_eq!((with(20, 20), with(20, 19), with(19, 20)), (Some(0.005), None, None));
    }
}
