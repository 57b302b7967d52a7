//! Attitudes that others are compared with: nothing but their names tells how they are read.

use polhode::audit::{Attitudes, Direction, Reading, Trajectory};
use polhode_files::ReadAs;
use polhode_files::error::Error;
use polhode_files::text::{short, visible};
use polhode_files::trajectory::FoundTrajectory;

use crate::flags::attitude::check_matrices;

/// The attitudes of the file `name` and how they are read. `refused`: the refusal by a rule, and what to do.
///
/// # Errors
/// Counts of steps, several bodies or attitudes, a convention that is left open, and what is no attitude.
pub(crate) fn attitudes(
    found: FoundTrajectory,
    name: &str,
    refused: impl Fn(&str, &str) -> Error,
) -> Result<(Trajectory, Reading), Error> {
    if found.counts_steps {
        return Err(refused("counts steps of unknown length", "write its times in s"));
    }
    if !found.second_attitude.is_empty() {
        let second = found.second_attitude.join(", ");
        let rule = format!("the columns {second} hold another attitude, which is not read");
        return Err(refused(&rule, "write a file with one attitude"));
    }
    let claims = found.claims;
    let mut bodies = found.bodies;
    let rows = match (bodies.len(), bodies.pop()) {
        (1, Some((_, rows))) if rows.attitude.is_some() => rows,
        _ => {
            let rule = "is not the trajectory of one body with its attitude";
            return Err(refused(rule, "name a file with t, q_w, q_x, q_y, q_z"));
        }
    };
    let open = match (&rows.attitude, claims.quaternion) {
        (Some(Attitudes::Quaternions(_)), None) => {
            Some("its quaternions do not show whether the scalar is first or last")
        }
        (Some(Attitudes::Angles(_)), _) => Some("the sequence of its Euler angles is not known"),
        _ => None,
    };
    if let Some(rule) = open {
        return Err(refused(rule, "write its attitudes in columns q_w, q_x, q_y, q_z"));
    }
    if let Some(Attitudes::Matrices(matrices)) = &rows.attitude {
        check_matrices(matrices, &rows.times, name)?;
    }
    let mut reading = Reading::default();
    reading.quaternion = claims.quaternion;
    reading.attitude = Some(claims.attitude.unwrap_or(Direction::BodyToSpace));
    // a distance from what is no number is never too large
    for (row, &t) in rows.times.iter().enumerate() {
        let attitude = reading.attitude(&rows, row);
        let is_number = attitude.is_some_and(|q| q.components().iter().all(|x| x.is_finite()));
        if !is_number {
            let rule = format!("the attitude at t = {} s is outside the range of a double", short(t));
            return Err(refused(&rule, "write its attitudes in columns q_w, q_x, q_y, q_z"));
        }
    }
    Ok((rows, reading))
}

/// What a file holds beside its attitudes where these alone are used, in words; `None` where nothing is.
pub(crate) fn beside_attitudes(found: &FoundTrajectory) -> Option<String> {
    let has = |of: fn(&Trajectory) -> bool| found.bodies.iter().any(|(_, rows)| of(rows));
    let unused = |is_there: bool, what: &str| is_there.then(|| format!("its {what} are not used"));
    let beside = [
        found.remark(),
        unused(has(|rows| rows.rates.is_some()), "angular velocities"),
        unused(has(|rows| rows.momentum.is_some()), "angular momenta"),
    ];
    let beside: Vec<String> = beside.into_iter().flatten().collect();
    (!beside.is_empty()).then(|| beside.join("; "))
}

/// By how many seconds the times that are read as `own` are later on the clock of the `record`, where they count from a moment of their
/// own. `refused`: the refusal by a rule, and what to do.
///
/// # Errors
/// A record that counts from no moment, and moments whose difference is open.
pub(crate) fn shift(
    own: &ReadAs,
    record: &ReadAs,
    refused: impl Fn(&str, &str) -> Error,
) -> Result<f64, Error> {
    let Some(begins) = own.begins else { return Ok(0.0) };
    let refused = |rule: &str| {
        let remedy =
            "write the times of both as dates or counts since 1970, or of both in s since one moment";
        refused(rule, remedy)
    };
    let Some(other) = record.begins else {
        let (times, since) = (&own.times.0, own.since.as_deref().unwrap_or_default());
        return Err(refused(&format!(
            "its times are {times} and are counted from its first row, {}; the times of the record have no such origin",
            visible(since)
        )));
    };
    begins.seconds_since(&other).map_err(|error| refused(&error.to_string()))
}
