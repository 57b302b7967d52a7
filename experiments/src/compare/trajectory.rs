//! The trajectory of another program: times and attitudes.

use std::path::Path;

use polhode::body::State;
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3};

use crate::arguments::number;
use crate::error::{Error, unexpected};
use crate::files::read;
use crate::measured::{Ending, LOST, Motion};
use crate::text::short;

/// Spellings of the columns: time, then the quaternion, scalar first.
const COLUMNS: [&[&str]; 5] = [
    &["t", "time"],
    &["q_w", "qw", "q0", "w"],
    &["q_x", "qx", "q1", "x"],
    &["q_y", "qy", "q2", "y"],
    &["q_z", "qz", "q3", "z"],
];

const REMEDY: &str = "name a CSV file with the columns t, q_w, q_x, q_y, q_z";

/// Rows of a file.
pub(super) struct Trajectory {
    pub(super) name: String,
    rows: Vec<(f64, [f64; 4])>,
}

/// How far a trajectory is off.
pub(super) struct Off {
    /// At the last row, rad.
    pub(super) attitude_error: f64,
    /// When that is, s since the start; `None` where the true motion is not known so far.
    pub(super) at: Option<f64>,
    pub(super) ending: Ending,
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
        let mut rows: Vec<(f64, [f64; 4])> = Vec::new();
        for record in reader.records() {
            let record = record.map_err(refused)?;
            let line = record.position().map_or(0, csv::Position::line);
            let at = format!("{name}:{line}");
            let mut values = [0.0; 5];
            for (value, place) in values.iter_mut().zip(places) {
                let cell = record.get(place).unwrap_or("");
                *value = number(cell).map_err(|error| Error::Input(format!("{at}: {error}")))?;
            }
            let [t, w, x, y, z] = values;
            let rule = |rule: &str, remedy: &str| Err(Error::input(&at, &short(t), rule, remedy));
            if !(start..=end).contains(&t) {
                let span = format!("lies outside of the run, t from {} to {}", short(start), short(end));
                return rule(&span, "give another --until or --start-time, or fewer rows");
            }
            if rows.last().is_some_and(|(before, _)| *before >= t) {
                return rule("does not come after the time before it", "sort the rows by time");
            }
            if [w, x, y, z] == [0.0; 4] {
                return rule("has the zero quaternion, which has no direction", "leave the row out");
            }
            rows.push((t, [w, x, y, z]));
        }
        if rows.is_empty() {
            return Err(Error::input(&name, "", "has no rows", REMEDY));
        }
        Ok(Trajectory { name, rows })
    }

    /// How far it is from the true motion, whose clock starts at `start_time`.
    pub(super) fn against(&self, motion: &Motion, start_time: f64) -> Result<Off, Error> {
        let known = motion.reference().known_until();
        let mut off = Off { attitude_error: 0.0, at: None, ending: Ending::Held };
        for &(t, attitude) in &self.rows {
            let elapsed = Dd::from(t) - Dd::from(start_time);
            if elapsed.hi() > known {
                break;
            }
            let state = State { attitude: Quat::from_components(attitude), momentum_body: Vec3::zero() };
            let point = motion.body().enter(&state).map_err(unexpected)?;
            off.attitude_error = motion.attitude_error(&point, elapsed).map_err(unexpected)?;
            off.at = Some(elapsed.hi());
            if off.attitude_error > LOST {
                off.ending = Ending::Lost(elapsed.hi());
                break;
            }
        }
        Ok(off)
    }
}
