//! A record beside a golden trajectory.

use std::path::Path;

use nalgebra::Vector3;
use polhode::audit::{Reading, Trajectory, Verdict};
use polhode::body::Body;
use polhode::inertia::Inertia;
use polhode::rotation::rotation_angle;
use polhode_files::error::Error;
use polhode_files::numbers::numbers;
use polhode_files::text::{rounded, visible};
use polhode_files::trajectory::read;
use polhode_files::{ReadAs, ReadOptions};
use polhode_pages::verdict::Difference;

use crate::reference::{attitudes, shift};

/// A trajectory that is right, with its body.
pub(super) struct Golden {
    name: String,
    rows: Trajectory,
    reading: Reading,
    read_as: ReadAs,
    pub(super) body: Body,
    /// What of its file is not read, in words.
    pub(super) remark: Option<String>,
}

/// Times agree within this share of the interval of the golden trajectory.
const SAME_TIME: f64 = 1e-6;

/// Noise of so many standard deviations is allowed beside the tolerance.
const SIGMAS: f64 = 6.0;

/// What digits leave open is known to this share: it is looked for at some rows.
const ROUNDED: f64 = 1.05;

impl Golden {
    /// Of a file that `polhode audit --golden` has written, or one with the same columns and the line `# moments: I1,I2,I3`.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let found = read(path, &ReadOptions::default())?;
        let name = visible(&path.display().to_string()).into_owned();
        let refused = |value: &str, rule: &str| {
            Error::input(&name, value, rule, "write golden trajectories by `polhode audit --golden DIR`")
        };
        let line = |key: &str| -> Result<Option<[f64; 3]>, Error> {
            let text =
                found.comments.iter().find_map(|line| line.strip_prefix(key)?.trim().strip_prefix(':'));
            let read = |text: &str| numbers::<3>(text).map_err(|rule| refused(text.trim(), &rule));
            text.map(read).transpose()
        };
        let Some(moments) = line("moments")? else {
            return Err(refused("", "no line '# moments: I1,I2,I3' above the header"));
        };
        let inertia =
            Inertia::from_moments(moments).map_err(|error| refused("# moments", &error.to_string()))?;
        let body = match line("weight-moment")? {
            Some(weight) if weight != [0.0; 3] => Body::heavy(inertia, Vector3::from(weight))
                .map_err(|error| refused("# weight-moment", &error.to_string()))?,
            _ => Body::free(inertia),
        };
        let read_as = found.read_as.clone();
        let remark = found.remark().map(|remark| format!("{name}: {remark}"));
        let (rows, reading) = attitudes(found, &name, |rule, _| refused("", rule))?;
        if rows.times.len() < 2 {
            return Err(refused("", "has one row"));
        }
        Ok(Self { name, rows, reading, read_as, body, remark })
    }

    /// Brings its times to the clock of the `record`, where they count from a moment of their own.
    pub(super) fn align(&mut self, record: &ReadAs) -> Result<(), Error> {
        let refused = |rule: &str, remedy: &str| Error::input(&self.name, "", rule, remedy);
        let shift = shift(&self.read_as, record, refused)?;
        self.rows.times.iter_mut().for_each(|t| *t += shift);
        Ok(())
    }

    /// The distance of `record`, read as the verdict has it; `is_noisy`: a noise was declared.
    pub(super) fn difference(
        &self,
        file: &str,
        record: &Trajectory,
        verdict: &Verdict,
        (tolerance, is_noisy): (f64, bool),
    ) -> Result<Difference, Error> {
        let (golden, times) = (&self.rows.times, &record.times);
        let interval = (golden[golden.len() - 1] - golden[0]) / (golden.len() - 1) as f64;
        // digits leave no more open than they do; only noise is now and then larger than it usually is
        let times_resolution = if is_noisy { SIGMAS } else { ROUNDED };
        let allowed = tolerance.max(times_resolution * verdict.resolution.attitude.unwrap_or(0.0));
        let (name, of) = (self.name.clone(), golden.len());
        let (largest, at, tolerance) = (0.0, golden[0], allowed);
        let mut found = Difference { name, rows: 0, of, is_whole: false, largest, at, tolerance };
        // one row of the record may be near to two rows
        let (mut shared, mut last) = (0, None);
        for (row, &t) in golden.iter().enumerate() {
            let after = times.partition_point(|time| *time < t);
            let near = [after.checked_sub(1), Some(after)].into_iter().flatten();
            let near =
                near.filter(|k| times.get(*k).is_some_and(|time| (time - t).abs() <= SAME_TIME * interval));
            let Some(place) = near.min_by(|a, b| (times[*a] - t).abs().total_cmp(&(times[*b] - t).abs()))
            else {
                continue;
            };
            let right = self.reading.attitude(&self.rows, row);
            let (Some(right), Some(theirs)) = (right, verdict.reading.attitude(record, place)) else {
                let remedy = "record q_w,q_x,q_y,q_z too, or leave --against out";
                return Err(Error::input(file, "", "has no attitude to compare", remedy));
            };
            let angle = rotation_angle(right, theirs);
            if angle > found.largest {
                (found.largest, found.at) = (angle, t);
            }
            found.rows += 1;
            shared += usize::from(last.replace(place) != Some(place));
        }
        if found.rows == 0 {
            return Err(Error::input(file, "", &self.coverage(record, 0), "write rows at its times"));
        }
        found.is_whole = found.rows == of || shared == times.len();
        Ok(found)
    }

    /// How much of both was compared, where it is not all of this trajectory.
    pub(super) fn note(&self, record: &Trajectory, found: &Difference) -> Option<String> {
        let open = if found.is_whole {
            ""
        } else {
            "; for the verdict right, all times of one file must be in the other"
        };
        (found.rows < found.of).then(|| self.coverage(record, found.rows) + open)
    }

    fn coverage(&self, record: &Trajectory, shared: usize) -> String {
        let span = |times: &[f64]| {
            let ends = times.first().zip(times.last());
            ends.map_or(String::new(), |(first, last)| {
                format!(" (t = {} to {} s)", rounded(*first), rounded(*last))
            })
        };
        format!(
            "{shared} of the {} rows of {}{} are at a time of one of the {} rows of the record{}",
            self.rows.times.len(),
            self.name,
            span(&self.rows.times),
            record.times.len(),
            span(&record.times)
        )
    }
}
