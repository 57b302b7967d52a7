//! Trajectories from files of other programs: CSV and other tables of rows, and dumps of LAMMPS.

mod dump;
mod layout;
mod lines;
mod names;
mod rows;

use std::path::Path;

use polhode::audit::{Claims, Trajectory};

use crate::error::Error;
pub use layout::ColumnNames;
use layout::Layout;
use lines::{Delimiter, Lines};
pub use names::{angle_unit, rate_unit};
use rows::Rows;

/// What a file holds.
pub struct Found {
    /// Trajectories with the name of their body, where there are several.
    pub bodies: Vec<(Option<String>, Trajectory)>,
    /// What names and layout claim of the convention.
    pub claims: Claims,
    /// Whether the times are counts of steps, of a length that the file does not tell.
    pub counts_steps: bool,
    /// Lines before the header that begin with #, without that.
    pub comments: Vec<String>,
}

/// Reads `path`, or standard input where it is `-`; `unit` is that of time, s, where it was given.
pub fn read(path: &Path, flags: &ColumnNames, unit: Option<f64>) -> Result<Found, Error> {
    let mut lines = Lines::open(path)?;
    let mut comments: Vec<String> = Vec::new();
    let first = loop {
        let Some(line) = lines.next()? else {
            let remedy = "name a file with a header and one row for each time";
            return Err(Error::input(&lines.name, "", "has no rows", remedy));
        };
        if let Some(comment) = line.strip_prefix(['#', '%']) {
            comments.push(comment.trim().to_string());
        } else if !line.is_empty() {
            break line.to_string();
        }
    };
    if first.starts_with("ITEM:") {
        return dump::read(lines, flags, unit);
    }
    let delimiter = Delimiter::of(&first);
    let cells = delimiter.names(&first);
    let has_header = cells.iter().any(|cell| !cell.is_empty() && cell.parse::<f64>().is_err());
    let names = if has_header {
        cells
    } else {
        // numpy writes the header as a comment
        let told = comments.last().map(|comment| Delimiter::of(comment).names(comment));
        let count = cells.len();
        told.filter(|names| names.len() == count)
            .unwrap_or_else(|| (1..=count).map(|k| format!("column {k}")).collect())
    };
    let layout =
        Layout::of(&names, flags, false).map_err(|(rule, remedy)| lines.refused("", &rule, &remedy))?;
    let unit = unit.unwrap_or_else(|| layout.time_unit.map_or(1.0, |unit| unit.0));
    let mut rows = Rows::new(layout, names, unit);
    if !has_header {
        lines.split(delimiter);
        rows.push(&lines, None)?;
    }
    while let Some(line) = lines.next()? {
        if line.is_empty() || line.starts_with(['#', '%']) {
            continue;
        }
        lines.split(delimiter);
        rows.push(&lines, None)?;
    }
    let (bodies, layout) = rows.finish();
    if bodies.is_empty() {
        let remedy = "name a file with a header and one row for each time";
        return Err(Error::input(&lines.name, "", "has a header and no rows", remedy));
    }
    Ok(Found { bodies, claims: layout.claims, counts_steps: false, comments })
}

#[cfg(test)]
mod tests {
    use polhode::audit::{Attitudes, Direction, Frame, QuaternionOrder};

    use super::*;

    fn found(text: &str, columns: &str) -> Result<Found, String> {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("run.csv");
        std::fs::write(&path, text).unwrap();
        let flags =
            if columns.is_empty() { ColumnNames::default() } else { ColumnNames::parse(columns).unwrap() };
        read(&path, &flags, None).map_err(|error| {
            error.to_string().rsplit_once("run.csv").map_or(String::new(), |(_, rest)| rest.into())
        })
    }

    fn quaternions(found: &Found, body: usize) -> &[[f64; 4]] {
        match &found.bodies[body].1.attitude {
            Some(Attitudes::Quaternions(rows)) => rows,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn tables_with_a_header_in_a_comment_or_in_none() {
        for text in ["t,w,x,y,z\n0,1,0,0,0\n1,0,1,0,0\n", "# t w x y z\n0 1 0 0 0\n1  0 1 0 0\n"] {
            let found = found(text, "").unwrap();
            assert_eq!(found.bodies[0].1.times, [0.0, 1.0]);
            assert_eq!(quaternions(&found, 0), [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]);
            assert_eq!(found.claims.quaternion, Some(QuaternionOrder::ScalarFirst));
        }
        let found = found("0;1;2;3;4\n5;6;7;8;9\n", "t=1,q0=2,q1=3,q2=4,q3=5").unwrap();
        assert_eq!((quaternions(&found, 0)[1], found.claims.quaternion), ([6.0, 7.0, 8.0, 9.0], None));
    }

    #[test]
    fn generalized_positions_of_two_free_joints() {
        let header = |stem: &str, n: usize| (0..n).map(|k| format!(",{stem}_{k}")).collect::<String>();
        let row: String = (0..26).map(|k| format!(",{k}")).collect();
        let text = format!("time{}{}\n0{row}\n", header("qpos", 14), header("qvel", 12));
        let found = found(&text, "").unwrap();
        assert_eq!(quaternions(&found, 1), [[10.0, 11.0, 12.0, 13.0]]);
        assert_eq!(found.bodies[1].1.rates, Some(vec![[23.0, 24.0, 25.0]]));
        assert_eq!(found.bodies[1].0.as_deref(), Some("free joint 2"));
        assert_eq!(found.claims.omega_frame, Some(Frame::Body));
    }

    #[test]
    fn dumps_and_ids_part_the_bodies() {
        let block = |step: u32| {
            format!(
                "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n\
                 ITEM: ATOMS id c_q[1] c_q[2] c_q[3] c_q[4] angmomx angmomy angmomz\n\
                 7 {step} 0 0 1 1 2 3\n3 1 0 0 0 4 5 6\n"
            )
        };
        let found = found(&(block(0) + &block(100)), "").unwrap();
        assert!(found.counts_steps);
        assert_eq!(found.bodies[0].0.as_deref(), Some("7"));
        assert_eq!(found.bodies[0].1.times, [0.0, 100.0]);
        assert_eq!(quaternions(&found, 0)[1], [100.0, 0.0, 0.0, 1.0]);
        assert_eq!(found.bodies[1].1.momentum, Some(vec![[4.0, 5.0, 6.0]; 2]));
        assert_eq!(found.claims.attitude, Some(Direction::BodyToSpace));
    }

    #[test]
    fn what_cannot_be_read_is_refused_with_line_and_column() {
        for (text, columns, says) in [
            ("", "", ": has no rows"),
            ("t,w,x,y,z\n", "", ": has a header and no rows"),
            (
                "t,a,b\n0,1,2\n",
                "",
                ", line 1: neither an attitude nor an angular velocity is told by the names",
            ),
            (
                "a,w,x,y,z\n0,1,0,0,0\n",
                "",
                ", line 1: no column of times among 'a', 'w', 'x', 'y', 'z'; name it by",
            ),
            ("0,1\n", "", ", line 1: no column of times among 'column 1', 'column 2'"),
            ("t,w,x,y,z\n0,1,0,0\n", "", ", line 2, column 5 (z): missing: the line has 4 of 5 columns"),
            ("t,w,x,y,z\n0,1,0,,0\n", "", ", line 2, column 4 (y): a number is missing"),
            ("t,w,x,y,z\n0,1,0,0,x\n", "", ", line 2, column 5 (z): 'x': is not a number"),
            ("t,w,x,y,z\n0,1,0,0,nan\n", "", ", line 2, column 5 (z): 'nan': is not a finite number"),
            (
                "t,w,x,y,z\n1,1,0,0,0\n1,1,0,0,0\n",
                "",
                ", line 3, column 1 (t): '1': does not come after the time",
            ),
            ("t,wx,wy,wz\n", "wx=q", ", line 1: no column 'q' for wx; the file has 't', 'wx', 'wy', 'wz'"),
            ("t,wx,wy,wz\n", "wx=wx,wy=2", ", line 1: --columns names a part of wx, wy, wz; add wz=NAME"),
            (
                "t,wx,wy,wz,gyro_x,gyro_y,gyro_z\n",
                "",
                ", line 1: two angular velocities: from 'wx' and from 'gyro_x'",
            ),
            (
                "t,qpos0,qpos1\n",
                "",
                ", line 1: 2 columns qpos and 0 columns qvel are not those of free joints",
            ),
        ] {
            let error = found(text, columns).err().unwrap_or_default();
            assert!(error.starts_with(says), "{text:?}: {error}");
        }
    }
}
