//! The trajectory of another program: times and attitudes, and angular velocities where it has them.

use std::path::Path;

use polhode::body::{Clock, State};
use polhode::num::Dd;
use polhode::observe::{Errors, Monitor};
use polhode::rotation::{Quat, Vec3};
use polhode::truth::{Ending, LOST, Truth};
use polhode_files::error::{Error, unexpected};
use polhode_files::numbers::number;
use polhode_files::read;
use polhode_files::text::short;

/// Spellings of the columns: time, then the quaternion, scalar first.
const COLUMNS: [&[&str]; 5] = [
    &["t", "time"],
    &["q_w", "qw", "q0", "w"],
    &["q_x", "qx", "q1", "x"],
    &["q_y", "qy", "q2", "y"],
    &["q_z", "qz", "q3", "z"],
];

/// Spellings of the columns of the angular velocity in body axes, rad/s: all three or none.
const OMEGA: [&[&str]; 3] = [
    &["omega_body_x", "omega_x", "wx"],
    &["omega_body_y", "omega_y", "wy"],
    &["omega_body_z", "omega_z", "wz"],
];

const REMEDY: &str = "name a CSV file with the columns t, q_w, q_x, q_y, q_z";

/// Rows of a file.
pub(super) struct Trajectory {
    pub(super) name: String,
    rows: Vec<Row>,
}

/// One row of a file.
struct Row {
    t: f64,
    attitude: [f64; 4],
    omega_body: Option<[f64; 3]>,
}

/// How far a trajectory is off.
pub(super) struct Off {
    /// At the last row, rad.
    pub(super) attitude_error: f64,
    /// When that is, s since the start; `None` where the true motion is not known so far.
    pub(super) at: Option<f64>,
    pub(super) ending: Ending,
    /// Where it has angular velocities: largest errors of the invariants at its rows, the changes of sign of the momentum along
    /// the middle axis from row to row, and the flips of the true motion until its last row.
    pub(super) invariants: Option<(Errors, u64, Option<u64>)>,
}

impl Trajectory {
    /// Of the file at `path`, whose times lie from the start to the end.
    pub(super) fn read(path: &Path, (start, end): (f64, f64)) -> Result<Self, Error> {
        let text = read(path, REMEDY)?;
        let name = path.display().to_string();
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
        let refused = |error: csv::Error| Error::Input(format!("{name}: {error}; {REMEDY}"));
        let header = reader.headers().map_err(refused)?.clone();
        let place = |spellings: &[&str]| {
            let found = header.iter().position(|column| spellings.contains(&column));
            found.ok_or_else(|| Error::input(&name, spellings[0], "no such column", REMEDY))
        };
        let mut places = [0; 5];
        for (slot, spellings) in places.iter_mut().zip(COLUMNS) {
            *slot = place(spellings)?;
        }
        let omega: Vec<Option<usize>> = OMEGA
            .iter()
            .map(|spellings| header.iter().position(|column| spellings.contains(&column)))
            .collect();
        let omega: Option<Vec<usize>> = match omega.iter().flatten().count() {
            0 => None,
            3 => omega.into_iter().collect(),
            _ => {
                let missing = omega.iter().position(Option::is_none).unwrap_or(0);
                let remedy =
                    "give omega_body_x, omega_body_y and omega_body_z, rad/s in body axes, or none of them";
                return Err(Error::input(&name, OMEGA[missing][0], "no such column", remedy));
            }
        };
        let mut rows: Vec<Row> = Vec::new();
        for record in reader.records() {
            let record = record.map_err(refused)?;
            let line = record.position().map_or(0, csv::Position::line);
            let at = format!("{name}:{line}");
            let value = |place: usize| {
                number(record.get(place).unwrap_or(""))
                    .map_err(|error| Error::Input(format!("{at}: {error}")))
            };
            let mut values = [0.0; 5];
            for (slot, place) in values.iter_mut().zip(places) {
                *slot = value(place)?;
            }
            let mut omega_body = omega.as_ref().map(|_| [0.0; 3]);
            for (slot, place) in omega_body.iter_mut().flatten().zip(omega.iter().flatten()) {
                *slot = value(*place)?;
            }
            let [t, w, x, y, z] = values;
            let rule = |rule: &str, remedy: &str| Err(Error::input(&at, &short(t), rule, remedy));
            if !(start..=end).contains(&t) {
                let span = format!("lies outside of the run, t from {} to {}", short(start), short(end));
                return rule(&span, "give another --until or --start-time, or fewer rows");
            }
            if rows.last().is_some_and(|before| before.t >= t) {
                return rule("does not come after the time before it", "sort the rows by time");
            }
            if [w, x, y, z] == [0.0; 4] {
                return rule("has the zero quaternion, which has no direction", "leave the row out");
            }
            rows.push(Row { t, attitude: [w, x, y, z], omega_body });
        }
        if rows.is_empty() {
            return Err(Error::input(&name, "", "has no rows", REMEDY));
        }
        Ok(Trajectory { name, rows })
    }

    /// How far it is from the true motion, whose clock starts at `start_time`.
    pub(super) fn against(&self, truth: &Truth, start_time: f64) -> Result<Off, Error> {
        let known = truth.known_until();
        let invariants = self.invariants(truth, start_time)?;
        let mut off = Off { attitude_error: 0.0, at: None, ending: Ending::Held, invariants };
        for row in &self.rows {
            let elapsed = Dd::from(row.t) - Dd::from(start_time);
            if elapsed.hi() > known {
                break;
            }
            let attitude = Quat::from_components(row.attitude);
            let state = State { attitude, momentum_body: Vec3::zero() };
            let point = truth.body().enter(&state).map_err(unexpected)?;
            off.attitude_error = truth.attitude_error(&point, elapsed).map_err(unexpected)?;
            off.at = Some(elapsed.hi());
            if off.attitude_error > LOST {
                off.ending = Ending::Lost(elapsed.hi());
                break;
            }
        }
        Ok(off)
    }

    /// Invariants and flips at the rows, against the start of the truth.
    fn invariants(
        &self,
        truth: &Truth,
        start_time: f64,
    ) -> Result<Option<(Errors, u64, Option<u64>)>, Error> {
        // what is conserved here does not depend on time
        let clock = Clock { start: start_time, step: 1.0 };
        let mut monitor = Monitor::new(truth.body(), clock, &truth.start());
        for row in &self.rows {
            let Some(omega) = row.omega_body else { return Ok(None) };
            let refused = |error| Error::Input(format!("{}: t = {}: {error}", self.name, short(row.t)));
            let attitude = Quat::from_components(row.attitude);
            let point = truth.body().enter_omega(attitude, Vec3(omega)).map_err(refused)?;
            monitor.observe(&[point.to_f64()]);
        }
        let last = self.rows.last().map_or(0.0, |row| row.t - start_time);
        Ok(Some((monitor.worst(), monitor.flips(), truth.flips(last))))
    }
}
