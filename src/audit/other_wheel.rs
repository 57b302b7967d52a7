//! A wheel that is not as it was told: of another speed, or held in place of free.

use super::bodies::Told;
use super::deviation::{Allowances, GROUPS, deviation};
use super::resolution::triples;
use super::states::{Quantities, states};
use super::{Judgement, OtherWheel, Reading, Trajectory};
use crate::body::WheelAtStart;
use crate::rotation::Vec3;

/// L in space, and what it changes by with the speed of a wheel.
type Pair = (Vec3<f64>, Vec3<f64>);

/// L may scatter by so many times what a row may be off.
const SCATTER: f64 = 3.0;

/// The wheel with another speed, or of the other kind, with which every row of `record` is one of the motion; `None` where there is none, or
/// where the record does not tell.
pub(super) fn other_wheel(
    record: &Trajectory,
    reading: &Reading,
    told: &Told,
    allowances: &Allowances,
) -> Option<OtherWheel> {
    record.attitude.as_ref()?;
    record.rates.as_ref()?;
    let kinds = told.wheels.iter().enumerate().flat_map(|(number, wheel)| {
        let speed = wheel.at_speed();
        let other = if wheel.is_held() { WheelAtStart::free(speed) } else { WheelAtStart::held(speed) };
        [(number, *wheel), (number, other)]
    });
    kinds.into_iter().find_map(|(number, wheel)| {
        let mut told = told.clone();
        told.wheels[number] = wheel;
        let off = speed_off(record, reading, &told, number, allowances)?;
        let speed = wheel.at_speed().speed(record.times[0], Default::default()) + off;
        let wheel = wheel.with_speed(speed).ok()?;
        told.wheels[number] = wheel;
        let body = told.started(record, reading)?;
        let found = deviation(record, reading, &body, Some(&told), false, allowances)?;
        let is_held = wheel.is_held();
        (found.judgement == Judgement::Right).then_some(OtherWheel { number: number + 1, speed, is_held })
    })
}

/// By how much, rad/s, the speed of the wheel `number` is to change for L = q (I ω + Σ l a) q* to be the same in all rows: least squares,
/// as L is linear in it. `None` where L still scatters.
fn speed_off(
    record: &Trajectory,
    reading: &Reading,
    told: &Told,
    number: usize,
    allowances: &Allowances,
) -> Option<f64> {
    let body = told.started(record, reading)?;
    let quantities = Quantities::new(&body);
    let wheel = told.wheels[number].at_speed();
    let axis = Vec3::from(wheel.axis()) * (wheel.inertia() / body.scale());
    let rows = states(record, reading, &body, &triples(record.times.len(), GROUPS));
    let pairs: Vec<Pair> = rows
        .iter()
        .filter_map(|row| row.attitude.map(|q| (q.rotate(quantities.whole_momentum(row)), q.rotate(axis))))
        .collect();
    let count = pairs.len().max(1) as f64;
    let sum = |of: &dyn Fn(&Pair) -> f64| pairs.iter().map(of).sum::<f64>();
    let zero: Pair = (Vec3::zero(), Vec3::zero());
    let total = pairs.iter().fold(zero, |all, pair| (all.0 + pair.0, all.1 + pair.1));
    let (l_mean, a_mean) = (total.0 * (1.0 / count), total.1 * (1.0 / count));
    let along = sum(&|(l, a)| (*l - l_mean).dot(*a - a_mean));
    let square = sum(&|(_, a)| (*a - a_mean).norm_squared());
    let off = -along / square;
    let left = (sum(&|(l, a)| (*l - l_mean + (*a - a_mean) * off).norm_squared()) / count).sqrt();
    let size = (rows.iter().map(|row| row.omega.norm_squared()).sum::<f64>() / count).sqrt();
    let rates = quantities.largest_moment() * size * allowances.rates.largest(rows.len());
    let allowed = SCATTER * (rates + allowances.attitude.largest(rows.len()) * l_mean.norm());
    (off.is_finite() && left <= allowed).then_some(off)
}
