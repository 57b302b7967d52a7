//! `propagate --through`: the exact motion between the attitudes of a file.

use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion};
use polhode::audit::{Attitudes, Direction, QuaternionOrder};
use polhode::body::{Body, Problem, Time};
use polhode::flow::{Interpolation, ThroughError};
use polhode_files::error::{Error, tell, warn};
use polhode_files::text::visible;
use polhode_files::{ReadOptions, trajectory};
use polhode_pages::table::{Cell, Column, RowWriter, Table};

use super::Propagate;
use super::columns::{Columns, Reading};
use crate::flags::times::regular;
use crate::reference::beside_attitudes;

/// Jumps of the angular velocity below this share of it are rounding.
const SMOOTH: f64 = 1e-6;

/// The momentum in space of a free body stays where it is; by more than this share no noise of attitudes worth having moves it.
const BROKEN: f64 = 0.1;

impl Propagate {
    /// Writes a row every DT from the first attitude of `file` to the last.
    pub(super) fn through(&self, body: &Body, file: &Path) -> Result<(), Error> {
        if body.problem() != Problem::Free {
            return Err(Error::Input(
                "--through: the motion between two attitudes is known for free bodies; leave out what acts on the body".into(),
            ));
        }
        let columns = Columns::of_states(&self.fields, self.asked()?, body)?;
        let attitudes = read(file, self.times.epoch().is_some())?;
        let turns = self.turns.unwrap_or(1.0);
        let refused = |error: ThroughError| {
            let flag = match error {
                ThroughError::Turns { .. } | ThroughError::NoneWithin { .. } => "--turns",
                _ => "--through",
            };
            Error::Input(format!("{flag}: {error}"))
        };
        let between = Interpolation::new(body.inertia(), &attitudes, turns).map_err(refused)?;
        let [first, last] = between.span();
        let every = self.times.every().unwrap_or(last - first);
        let times = regular(first, last, every).map_err(Error::Input)?;

        let mut all = columns.columns();
        all.push(
            Column::new("slerp_error", "rad", "angle between this attitude and that of slerp").digits(2),
        );
        let table = Table::new("through", "Exact motion between attitudes.", all);
        let mut rows = RowWriter::new(table, self.format, self.out.as_deref(), Some(times.len()))?;
        let (mut worst, mut fastest) = (0.0_f64, 0.0_f64);
        for t in times {
            let (state, slerp_error) = between.at(t).map_err(refused)?;
            let point = body.enter(&state).map_err(|error| Error::Failed(error.to_string()))?.to_f64();
            let reading = Reading {
                state,
                omega: body.omega_body(&state),
                at: Time::from_seconds(t),
                point: &point,
                worst: None,
                attitude_error: None,
            };
            (worst, fastest) = (worst.max(slerp_error), fastest.max(reading.omega.norm()));
            let mut cells: Vec<Cell> = columns.cells(body, &reading).collect();
            cells.push(slerp_error.into());
            rows.push(cells)?;
        }
        rows.finish()?;
        tell(
            "note",
            &format!("at these times spherical linear interpolation differs by up to {worst:.1e} rad"),
        );
        let jump = between.largest_jump();
        let told = format!(
            "these are not attitudes of one free motion: the angular velocity jumps by up to {jump:.1e} rad/s at them"
        );
        // of dense rows each jump is small, whatever they add up to
        let moved = momentum_changes(body, &between, &attitudes);
        let is_broken = moved > BROKEN;
        if jump > SMOOTH * fastest && !is_broken {
            warn(&told);
        }
        if !between.pieces().iter().all(|piece| piece.complete) {
            tell(
                "note",
                "between some attitudes the search may have missed motions; --turns sets how far it looks",
            );
        }
        if is_broken {
            let percent = 100.0 * moved;
            return Err(Error::Failed(format!(
                "--through: {told}, and the angular momentum in space changes by up to {percent:.0} %"
            )));
        }
        Ok(())
    }
}

/// By which share of it the momentum in space of a motion between two of the `attitudes` differs from that between the first two.
fn momentum_changes(body: &Body, between: &Interpolation, attitudes: &[(f64, UnitQuaternion<f64>)]) -> f64 {
    let tensor = body.inertia().tensor();
    let momenta =
        between.pieces().iter().zip(attitudes).map(|(piece, (_, q))| q * (tensor * piece.omega_body));
    let mut momenta = momenta.peekable();
    let first = momenta.peek().copied().unwrap_or_default();
    momenta.map(|momentum| (momentum - first).norm() / first.norm()).fold(0.0, f64::max)
}

/// Times and attitudes of a file; whether t = 0 has a date.
fn read(file: &Path, has_epoch: bool) -> Result<Vec<(f64, UnitQuaternion<f64>)>, Error> {
    let name = visible(&file.display().to_string()).into_owned();
    let refused = |rule: &str, remedy: &str| Err(Error::input("--through", &name, rule, remedy));
    let found = trajectory::read(file, &ReadOptions::default())?;
    if found.counts_steps {
        return refused("counts steps of unknown length", "write the times in s");
    }
    if !found.second_attitude.is_empty() {
        let second = found.second_attitude.join(", ");
        let rule = format!("the columns {second} hold another attitude, which is not read");
        return refused(&rule, "write a file with one attitude");
    }
    let (times, _) = &found.read_as.times;
    let is_dated = times == "dates" || times == "s and ns" || times.ends_with("since 1970");
    if has_epoch && is_dated {
        let rule = format!("the times of {name} are {times}, and t counts from the first of them");
        return Err(Error::input("--epoch", "", &rule, "leave it out"));
    }
    let beside = beside_attitudes(&found);
    let mut bodies = found.bodies;
    let (1, Some((_, rows))) = (bodies.len(), bodies.pop()) else {
        return refused("has several bodies", "name a file of one body");
    };
    let Some(Attitudes::Quaternions(attitudes)) = rows.attitude else {
        return refused("has no quaternions", "write the attitudes as q_w, q_x, q_y, q_z, body to space");
    };
    if found.claims.quaternion != Some(QuaternionOrder::ScalarFirst) {
        return refused(
            "does not show whether the scalar is first or last",
            "name the columns q_w, q_x, q_y, q_z",
        );
    }
    let is_inverse = found.claims.attitude == Some(Direction::SpaceToBody);
    let unit = |[w, x, y, z]: [f64; 4]| {
        let unit = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 0.0)?;
        Some(if is_inverse { unit.inverse() } else { unit })
    };
    let all: Option<Vec<_>> = rows.times.iter().zip(attitudes).map(|(t, q)| Some((*t, unit(q)?))).collect();
    if let Some(beside) = beside {
        warn(&format!("{name}: {beside}"));
    }
    match all {
        Some(all) => Ok(all),
        None => refused("has a quaternion of norm 0", "leave out rows without an attitude"),
    }
}
