//! What the rows hold that are further from the motion than is allowed.

use super::columns::angle_between;
use super::deviation::{Allowances, Deviation};
use super::sweep::{Seen, Sweep};
use super::{Fault, Misplaced, Reading, Trajectory};
use crate::body::Problem;
use crate::rotation::{Quat, Vec3};

/// More than this share of the rows, and it is the motion that is another, not rows that are misplaced.
const MOST: f64 = 0.6;

/// A row is what another one is if it is nearer to that than this share of its distance from the motion.
const NEAR: f64 = 0.1;

/// The rows of `record` that are not where the motion is, by what they hold.
pub(super) fn misplaced(
    record: &Trajectory,
    reading: &Reading,
    found: &Deviation,
    allowed: &Allowances,
) -> Vec<Fault> {
    let rows = record.times.len();
    let beyond = &found.beyond;
    if beyond.is_empty() {
        return Vec::new();
    }
    let few = beyond.len() as f64 <= MOST * rows as f64;
    let sweep = Sweep { record, reading, start: &found.start, size: found.size, scale: found.scale };
    let of_rates = if record.rates.is_some() { allowed.rates } else { allowed.momentum };
    let limits = [allowed.attitude, of_rates, allowed.momentum].map(|allowance| allowance.largest(rows));
    let distance = |seen: &Seen| {
        let of = |vector: Option<Vec3<f64>>, limit: f64| {
            vector.map_or(0.0, |v| if v.norm() > limit { v.norm() } else { 0.0 })
        };
        of(seen.turn, limits[0]).max(of(seen.rates, limits[1])).max(of(seen.momentum, limits[2]))
    };
    let mut tallies: Vec<(Misplaced, usize, usize, f64)> = Vec::new();
    let mut note = |what: Misplaced, row: usize, size: f64| match tallies.iter_mut().find(|t| t.0 == what) {
        Some(tally) => (tally.2, tally.3) = (tally.2 + 1, tally.3.max(size)),
        None => tallies.push((what, row, 1, size)),
    };
    // three rows: the one before, the one that is looked at, and the one behind
    let mut window: [Option<Seen>; 3] = [None; 3];
    let mut look = |window: &[Option<Seen>; 3]| {
        let Some(now) = window[1] else { return };
        let beside = |other: usize| window[other].as_ref().filter(|seen| seen.row.abs_diff(now.row) == 1);
        let size = distance(&now);
        if size > 0.0 {
            note(kind(beside(0), &now, beside(2), size), now.row, size);
        }
    };
    let mut show = |seen: &Seen| {
        window = [window[1], window[2], Some(*seen)];
        look(&window);
    };
    // the closed form needs no row between; steps would be others
    let followed = if found.start.body.problem() == Problem::Free {
        let mut next = 0;
        let mut wanted = beyond.iter().flat_map(|&row| {
            let from = next.max(row.saturating_sub(1));
            next = (row + 2).min(rows);
            from..next
        });
        sweep.over(&mut wanted, &mut show)
    } else {
        sweep.every(&mut show)
    };
    if followed.is_none() {
        return Vec::new();
    }
    look(&[window[1], window[2], None]);
    tallies
        .into_iter()
        // a row that repeats the one before tells it without a motion
        .filter(|(what, ..)| few || *what == Misplaced::Repeated)
        .map(|(what, row, count, largest)| Fault::Misplaced { what, row, count, largest })
        .collect()
}

/// What the row `now` holds, which is `size` away from the motion.
fn kind(before: Option<&Seen>, now: &Seen, behind: Option<&Seen>, size: f64) -> Misplaced {
    let near = |a: (Option<Quat<f64>>, Option<Vec3<f64>>), b: (Option<Quat<f64>>, Option<Vec3<f64>>)| {
        let turn = a.0.zip(b.0).map_or(0.0, |(p, q)| angle_between(p, q));
        let scale = a.1.map_or(0.0, |omega| omega.norm());
        let rates = a.1.zip(b.1).map_or(0.0, |(v, w)| (v - w).norm() / scale.max(f64::MIN_POSITIVE));
        turn.max(rates) <= NEAR * size.min(1.0)
    };
    let written = |seen: &Seen| (seen.attitude, seen.omega);
    let exact = |seen: &Seen| (now.attitude.map(|_| seen.exact.0), now.omega.map(|_| seen.exact.1));
    if before.is_some_and(|before| written(before) == written(now)) {
        return Misplaced::Repeated;
    }
    let neighbours = || [before, behind].into_iter().flatten();
    if neighbours().any(|other| near(written(now), exact(other)) && near(written(other), exact(now))) {
        return Misplaced::Exchanged;
    }
    if neighbours().any(|other| near(written(now), exact(other))) {
        return Misplaced::Shifted;
    }
    if let (Some(before), Some(behind)) = (before, behind) {
        let part = (now.time - before.time) / (behind.time - before.time);
        let mean = |a: Vec3<f64>, b: Vec3<f64>| a + (b - a) * part;
        let attitude = before.attitude.zip(behind.attitude).map(|(p, q)| {
            let q = if p.w * q.w + p.v.dot(q.v) < 0.0 { -q } else { q };
            (p * (1.0 - part) + q * part).normalized()
        });
        let omega = before.omega.zip(behind.omega).map(|(a, b)| mean(a, b));
        if near(written(now), (attitude, omega)) {
            return Misplaced::Interpolated;
        }
    }
    Misplaced::Unknown
}
