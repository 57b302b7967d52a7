//! The trajectory of another program: times and attitudes, and angular velocities where it has them.

use std::path::Path;

use nalgebra::Vector3;
use polhode::audit::{
    Attitudes, Convention, Direction, Frame, Judgement, QuaternionOrder, Question, Reading, Suspect,
    Trajectory as Columns, audit,
};
use polhode::body::{Body, Clock, State};
use polhode::flow::ExactMotion;
use polhode::num::Dd;
use polhode::observe::{Errors, Monitor};
use polhode::rotation::{Quat, Vec3};
use polhode::truth::{Ending, LOST, Truth, attitude_error};
use polhode::units::RateUnit;
use polhode_files::error::{Error, tell, unexpected, warn};
use polhode_files::text::{short, visible};
use polhode_files::trajectory;

use crate::flags::attitude::{check_matrices, note_order};
use crate::flags::table::TableArguments;

/// A smaller share of |ω| along the middle axis is rounding.
pub(super) const ROUNDING: f64 = 1e-11;
/// Nor is a flip what the errors of rates explain, up to this share of |ω|.
const EXPLAINED: f64 = 0.1;
/// Rates that are off by a larger share of |ω| contradict attitudes that are off by less than what they turn, over this number.
const CONTRADICTS: f64 = 0.01;
const CLEARLY: f64 = 10.0;

/// Rows of a file.
pub(crate) struct Trajectory {
    pub(crate) name: String,
    pub(crate) rows: Vec<Row>,
    /// Whether its attitudes are written as quaternions.
    pub(crate) has_quaternions: bool,
}

/// One row of a file.
pub(crate) struct Row {
    pub(crate) t: f64,
    /// Body to space, scalar first, of any norm.
    pub(crate) attitude: [f64; 4],
    /// rad/s.
    pub(crate) omega_body: Option<[f64; 3]>,
}

/// How far a trajectory is off.
pub(super) struct Off {
    /// At the last row, and the largest of all rows, rad.
    pub(super) attitude_error: f64,
    pub(super) largest: f64,
    /// When that is, s since the start; `None` where the true motion is not known so far.
    pub(super) at: Option<f64>,
    pub(super) ending: Ending,
    /// Where it has angular velocities: largest errors of the invariants at its rows, and the changes of sign of ω along the middle
    /// axis from row to row, which are larger than rounding and the errors of the rates.
    pub(super) invariants: Option<(Errors, u64)>,
    /// The same changes of sign of the true motion, from row to row: rows far apart miss flips of both.
    pub(super) true_flips: Option<u64>,
    /// What its rates are off those of the true motion, root mean square as a share of these, where its attitudes contradict it.
    pub(super) contradiction: Option<f64>,
    /// How far its first row is off, rad, where its attitude is lost there already.
    pub(super) elsewhere: Option<f64>,
}

impl Trajectory {
    /// Of the file at `path`, whose times lie from the start to the end; `order`: the place of the scalar, where a flag says it.
    pub(crate) fn read(
        path: &Path,
        table: &TableArguments,
        order: Option<QuaternionOrder>,
        body: &Body,
        (start, end): (f64, f64),
    ) -> Result<Self, Error> {
        let found = trajectory::read(path, &table.reading(None))?;
        table.check_times(&found.read_as)?;
        let name = visible(&path.display().to_string()).into_owned();
        let refused = |rule: &str, remedy: &str| Err(Error::input(&name, "", rule, remedy));
        if found.counts_steps {
            return refused("counts steps of unknown length", "give the length of a step, s, as --time-unit");
        }
        if !found.second_attitude.is_empty() && !table.names_quantities() {
            let rule = format!(
                "the columns {} hold another attitude, which is not read",
                found.second_attitude.join(", ")
            );
            return refused(&rule, "name those of one body by --columns");
        }
        let unread = found.remark();
        let mut bodies = found.bodies;
        let columns = match (bodies.len(), bodies.pop()) {
            (1, Some((_, columns))) => columns,
            (count, _) => {
                return refused(&format!("has {count} bodies"), "name a file of one body, or its --columns");
            }
        };
        if columns.attitude.is_none() {
            return refused("has no attitude", "add the columns q_w, q_x, q_y, q_z");
        }
        if let Some(Attitudes::Matrices(matrices)) = &columns.attitude {
            check_matrices(matrices, &columns.times, &name)?;
        }
        let mut claims = found.claims;
        // columns that are named w, x, y and z are read by their names
        note_order(order.is_some(), &claims, &name);
        claims.quaternion = claims.quaternion.or(order);
        let Some((reading, is_of_another_body)) = reading(&columns, claims, body) else {
            return match &columns.attitude {
                Some(Attitudes::Quaternions(_)) => refused(
                    "its rows do not show whether the scalar of the quaternion is first or last",
                    "state it by --quaternion wxyz or xyzw",
                ),
                _ => refused(
                    "its rows do not determine the sequence of the Euler angles, or contradict the names roll, pitch and yaw",
                    "write the attitude as a quaternion",
                ),
            };
        };
        let mut rows = Vec::new();
        for (k, &t) in columns.times.iter().enumerate() {
            if !(start..=end).contains(&t) {
                let span = format!("lies outside of the run, t from {} to {}", short(start), short(end));
                return Err(Error::input(
                    &name,
                    &short(t),
                    &span,
                    "give another --until or --start-time, or fewer rows",
                ));
            }
            rows.extend(row(&columns, &reading, k));
        }
        if is_of_another_body {
            return refused(
                "its rows are those of a body with other moments or other axes",
                "name its body; see `polhode audit` for more",
            );
        }
        let momenta = columns.momentum.is_some().then(|| "its angular momenta are not compared".to_owned());
        for remark in [unread, momenta].into_iter().flatten() {
            warn(&format!("{name}: {remark}"));
        }
        if let Some(reading) = shown(reading, &as_named(&claims), &columns) {
            tell("note", &format!("{name}: its rows show how it is read: {reading}"));
        }
        let has_quaternions = matches!(columns.attitude, Some(Attitudes::Quaternions(_)));
        Ok(Trajectory { name, rows, has_quaternions })
    }

    /// How far it is from the true motion, whose clock starts at `start_time`.
    pub(super) fn against(&self, truth: &Truth, start_time: f64) -> Result<Off, Error> {
        let known = truth.known_until();
        let invariants = self.invariants(truth, start_time)?;
        // as of methods: of a top or a gyrostat in closed form none are counted
        let is_counted =
            invariants.is_some() && matches!(truth.closed_form(), None | Some(ExactMotion::Free(_)));
        let body = truth.body();
        let axis: Vector3<f64> = body.inertia().principal_axes() * Vector3::y();
        let along = |omega: Vector3<f64>| omega.dot(&axis) / omega.norm();
        let begun = along(body.omega_of(&truth.start()));
        let mut followed = is_counted.then(|| vec![begun]);
        let mut off = Off {
            attitude_error: 0.0,
            largest: 0.0,
            at: None,
            ending: Ending::Held,
            invariants: None,
            true_flips: None,
            contradiction: None,
            elsewhere: None,
        };
        // squares of what rates are off, and of the true ones; the angle that these turn by, rad
        let [mut apart, mut squared, mut turned]: [f64; 3] = [0.0; 3];
        let mut before: Option<f64> = None;
        for row in &self.rows {
            let elapsed = Dd::from(row.t) - Dd::from(start_time);
            if elapsed.hi() > known {
                followed = None;
                break;
            }
            let exact = truth.point_at(elapsed).map_err(unexpected)?;
            let rate = body.omega_of(&exact);
            if let Some(followed) = &mut followed {
                followed.push(along(rate));
            }
            if off.ending != Ending::Held {
                continue;
            }
            if let Some(omega) = row.omega_body {
                apart += (Vector3::from(omega) - rate).norm_squared();
                squared += rate.norm_squared();
                turned += rate.norm() * before.map_or(0.0, |before| row.t - before);
                before = Some(row.t);
            }
            let attitude = Quat::from_components(row.attitude);
            let state = State { attitude, momentum_body: Vec3::zero() };
            let point = body.enter(&state).map_err(unexpected)?;
            off.attitude_error = attitude_error(point.attitude, exact.attitude);
            let is_first = off.at.is_none();
            (off.largest, off.at) = (off.largest.max(off.attitude_error), Some(elapsed.hi()));
            if off.attitude_error > LOST {
                off.ending = Ending::Lost(elapsed.hi());
                off.elsewhere = is_first.then_some(off.attitude_error);
                if followed.is_none() {
                    break;
                }
            }
        }
        let rates_off = (apart / squared).sqrt();
        let band = (2.0 * rates_off).clamp(ROUNDING, EXPLAINED);
        off.true_flips = followed.map(|seen| changes_of_sign(seen, band));
        off.invariants = invariants.map(|worst| {
            let rates = self.rows.iter().filter_map(|row| row.omega_body);
            let seen = rates.map(|omega| along(omega.into()));
            (worst, changes_of_sign(core::iter::once(begun).chain(seen), band))
        });
        // what rates are off, attitudes are off too before long
        let contradict = rates_off > CONTRADICTS && rates_off * turned.min(1.0) > CLEARLY * off.largest;
        off.contradiction = Some(rates_off).filter(|_| contradict && off.ending == Ending::Held);
        if let (None, Some(first)) = (off.at, self.rows.first()) {
            let rule = format!("the true motion is known until t = {}", short(start_time + known));
            return Err(Error::input(&self.name, &short(first.t), &rule, "give rows before that"));
        }
        Ok(off)
    }

    /// Invariants at the rows, against the start of the truth.
    fn invariants(&self, truth: &Truth, start_time: f64) -> Result<Option<Errors>, Error> {
        // rows are taken for points of the start: what is conserved depends on time through motors alone
        let mut monitor = Monitor::new(truth.body(), Clock { start: start_time, step: 1.0 }, &truth.start());
        for row in &self.rows {
            let Some(omega) = row.omega_body else { return Ok(None) };
            let refused = |error| Error::Input(format!("{}: t = {}: {error}", self.name, short(row.t)));
            let attitude = Quat::from_components(row.attitude);
            let point = truth.body().enter_omega(attitude, Vec3(omega)).map_err(refused)?;
            monitor.observe(&[point.to_f64()]);
        }
        let mut worst = monitor.worst();
        if truth.body().wheels().iter().any(|wheel| wheel.motor().is_some()) {
            (worst.momentum_norm, worst.momentum_vector, worst.momentum_z) = (None, None, None);
        }
        Ok(Some(worst))
    }
}

/// Changes of sign of numbers that leave the `band` about zero on both sides.
fn changes_of_sign(numbers: impl IntoIterator<Item = f64>, band: f64) -> u64 {
    let beyond = numbers.into_iter().filter(|x| x.abs() > band);
    let positive: Vec<bool> = beyond.map(|x| x > 0.0).collect();
    positive.windows(2).filter(|pair| pair[0] != pair[1]).count() as u64
}

/// A row as this library reads it.
fn row(columns: &Columns, reading: &Reading, k: usize) -> Option<Row> {
    let attitude = match &columns.attitude {
        // any norm is fine, and none is changed
        Some(Attitudes::Quaternions(rows)) if reading.attitude == Some(Direction::BodyToSpace) => {
            let [a, b, c, d] = *rows.get(k)?;
            if reading.quaternion == Some(QuaternionOrder::ScalarLast) { [d, a, b, c] } else { [a, b, c, d] }
        }
        _ => reading.attitude(columns, k)?.components(),
    };
    let omega_body = reading.omega_body(columns, k).map(|omega| omega.0);
    Some(Row { t: *columns.times.get(k)?, attitude, omega_body })
}

/// As names and flags claim, and else as this program writes trajectories.
fn as_named(claims: &Convention) -> Reading {
    let mut own = Reading::default();
    own.quaternion = claims.quaternion;
    own.attitude = claims.attitude.or(Some(Direction::BodyToSpace));
    own.omega_frame = claims.omega_frame.or(Some(Frame::Body));
    own.rate_unit = claims.rate_unit.or(Some(RateUnit::RadiansPerSecond));
    own.angles = claims.angles;
    own
}

/// The reading of the columns that are there, where it is not the `named` one.
fn shown(mut reading: Reading, named: &Reading, columns: &Columns) -> Option<Reading> {
    if columns.rates.is_none() {
        (reading.omega_frame, reading.rate_unit) = (None, None);
    }
    reading.momentum_frame = None;
    let is_named = [
        reading.quaternion.is_none() || reading.quaternion == named.quaternion,
        reading.attitude.is_none() || reading.attitude == named.attitude,
        reading.angles.is_none() || reading.angles == named.angles,
        reading.omega_frame.is_none() || reading.omega_frame == named.omega_frame,
        reading.rate_unit.is_none() || reading.rate_unit == named.rate_unit,
    ];
    is_named.contains(&false).then_some(reading)
}

/// How the columns are read: as their names and flags claim and else as this program writes them, unless the rows are a motion
/// of the body in another convention, which is what `polhode audit` would say of them; and whether it would name another body.
fn reading(columns: &Columns, claims: Convention, body: &Body) -> Option<(Reading, bool)> {
    let mut own = as_named(&claims);
    let is_quaternion = matches!(columns.attitude, Some(Attitudes::Quaternions(_)));
    let is_open = match &columns.attitude {
        Some(Attitudes::Quaternions(_)) => own.quaternion.is_none(),
        Some(Attitudes::Angles(_)) => own.angles.is_none(),
        _ => false,
    };
    let mut question = Question::new(Some(body.clone()));
    question.claims = claims;
    let Ok(verdict) = audit(columns, &question) else { return (!is_open).then_some((own, false)) };
    let best = verdict.reading;
    let is_other = verdict.judgement == Judgement::Wrong
        && match verdict.suspect {
            Suspect::OtherBody => true,
            // rows that are far off may be nearest to another order without being its motion
            Suspect::MomentsOrder => {
                question.claims.moments = None;
                audit(columns, &question).is_ok_and(|found| found.judgement == Judgement::Right)
            }
            _ => false,
        };
    let ties = verdict.tie.map_or(Vec::new(), |tie| tie.readings);
    let differs = |other: &Reading| {
        (is_quaternion && other.quaternion != best.quaternion)
            || other.angles.map(|angles| angles.sequence) != best.angles.map(|angles| angles.sequence)
    };
    if is_open && (verdict.suspect == Suspect::AnglesOrder || ties.iter().any(differs)) {
        return None;
    }
    if verdict.judgement == Judgement::Right && !ties.contains(&own) {
        return Some((best, false));
    }
    if is_open {
        (own.quaternion, own.angles) = (best.quaternion, best.angles);
    }
    Some((own, is_other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stays_within_the_errors_of_rates_is_no_flip() {
        let seen = [0.5, 1e-3, -1e-3, 1e-3, f64::NAN, -0.5, -1e-3, 0.2];
        assert_eq!(changes_of_sign(seen, 2e-3), 2);
        assert_eq!(changes_of_sign(seen, 1e-4), 4);
        assert_eq!(changes_of_sign([1e-17, -1e-17], ROUNDING), 0);
    }
}
