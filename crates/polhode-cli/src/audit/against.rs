//! A record beside a golden trajectory.

use std::path::Path;

use nalgebra::Vector3;
use polhode::audit::{Direction, Reading, Trajectory, Verdict};
use polhode::body::Body;
use polhode::inertia::Inertia;
use polhode::rotation::rotation_angle;
use polhode_files::ReadOptions;
use polhode_files::error::Error;
use polhode_files::numbers::numbers;
use polhode_files::text::visible;
use polhode_files::trajectory::read;
use polhode_pages::verdict::Difference;

/// A trajectory that is right, with its body.
pub(super) struct Golden {
    name: String,
    rows: Trajectory,
    reading: Reading,
    pub(super) body: Body,
}

/// Times agree within this share of the interval of the golden trajectory.
const SAME_TIME: f64 = 1e-6;

/// Noise of so many standard deviations is allowed beside the tolerance.
const SIGMAS: f64 = 6.0;

impl Golden {
    /// Of a file that `polhode audit --golden` has written, or one with the same columns and the line `# moments: I1,I2,I3`.
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let found = read(path, &ReadOptions::default())?;
        let name = visible(&path.display().to_string()).into_owned();
        let refused = |value: &str, rule: &str| {
            Error::input(&name, value, rule, "write golden trajectories by `polhode audit --golden DIR`")
        };
        if found.counts_steps {
            return Err(refused("", "counts steps of a length that it does not tell"));
        }
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
        let claims = found.claims;
        let mut bodies = found.bodies;
        let rows = match (bodies.len(), bodies.pop()) {
            (1, Some((_, rows))) if rows.attitude.is_some() && rows.times.len() > 1 => rows,
            _ => return Err(refused("", "is not the trajectory of one body with its attitude")),
        };
        let mut reading = Reading::default();
        reading.quaternion = claims.quaternion;
        reading.attitude = Some(claims.attitude.unwrap_or(Direction::BodyToSpace));
        Ok(Self { name, rows, reading, body })
    }

    /// The distance of `record`, read as the verdict has it.
    pub(super) fn difference(
        &self,
        file: &str,
        record: &Trajectory,
        verdict: &Verdict,
        tolerance: f64,
    ) -> Result<Difference, Error> {
        let (golden, times) = (&self.rows.times, &record.times);
        let interval = (golden[golden.len() - 1] - golden[0]) / (golden.len() - 1) as f64;
        let allowed = tolerance.max(SIGMAS * verdict.resolution.attitude.unwrap_or(0.0));
        let (name, of) = (self.name.clone(), golden.len());
        let mut found = Difference { name, rows: 0, of, largest: 0.0, at: golden[0], tolerance: allowed };
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
        }
        if found.rows == 0 {
            let rule = format!("no row at a time of {}, t = {}, {}, ...", self.name, golden[0], golden[1]);
            return Err(Error::input(file, "", &rule, "write rows at these times"));
        }
        Ok(found)
    }
}
