//! States of a record by its reading, in body axes.

use super::columns::{Columns, Source};
use super::program::Dynamics;
use super::{Reading, Trajectory};
use crate::body::{Body, Point, Problem, Time};
use crate::rotation::{Quat, Vec3};

/// One row in this library's convention.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) row: usize,
    pub(super) time: f64,
    /// Body → space.
    pub(super) attitude: Option<Quat<f64>>,
    /// Body axes, rad/s.
    pub(super) omega: Vec3<f64>,
}

/// The rows of a record by a reading, one at a time.
pub(super) struct States<'a> {
    columns: Columns<'a>,
    reading: &'a Reading,
    dynamics: Dynamics,
    /// Rows from one to the one that its angular velocity leads to, of a record of attitudes alone.
    stride: usize,
}

impl<'a> States<'a> {
    pub(super) fn new(record: &'a Trajectory, reading: &'a Reading, body: &Body) -> Self {
        let columns = Columns::new(record);
        let stride = if columns.source == Source::Attitude { columns.windows().stride } else { 1 };
        States { columns, reading, dynamics: Dynamics::new(body), stride }
    }

    /// The row `row`; of a record of attitudes alone with the angular velocity that leads to a later row, `None` where there is
    /// none.
    pub(super) fn at(&self, row: usize) -> Option<Row> {
        let (record, reading) = (self.columns.record, self.reading);
        let attitude = reading.attitude(record, row);
        let omega = match self.columns.source {
            Source::Rates => reading.omega_body(record, row)?,
            Source::Momentum => self.dynamics.omega(reading.momentum_body(record, row)?),
            Source::Attitude => self.columns.shot(reading, &self.dynamics, row, self.stride)?,
        };
        Some(Row { row, time: record.times[row], attitude, omega })
    }
}

/// The rows `rows` by `reading`, without those that have no angular velocity.
pub(super) fn states(record: &Trajectory, reading: &Reading, body: &Body, rows: &[usize]) -> Vec<Row> {
    let states = States::new(record, reading, body);
    rows.iter().filter_map(|&row| states.at(row)).collect()
}

/// Energy, angular momentum in body axes and in space, in units of the solver frame.
pub(super) struct Quantities<'a> {
    body: &'a Body,
    dynamics: Dynamics,
    free: bool,
}

impl<'a> Quantities<'a> {
    pub(super) fn new(body: &'a Body) -> Self {
        Quantities { body, dynamics: Dynamics::new(body), free: body.problem() == Problem::Free }
    }

    /// I ω and the momentum of wheels in body axes.
    pub(super) fn whole_momentum(&self, row: &Row) -> Vec3<f64> {
        let scale = self.body.scale();
        let at = Time::from_seconds(row.time);
        let wheels = self.body.wheels().iter().map(|wheel| wheel.momentum::<f64>(at).map(|l| l / scale));
        wheels.fold(self.momentum(row), |sum, one| sum + one)
    }

    /// I ω in body axes.
    pub(super) fn momentum(&self, row: &Row) -> Vec3<f64> {
        self.dynamics.momentum(row.omega)
    }

    /// In the units of [`momentum`](Self::momentum).
    pub(super) fn largest_moment(&self) -> f64 {
        self.dynamics.largest_moment()
    }

    pub(super) fn kinetic(&self, row: &Row) -> f64 {
        0.5 * self.momentum(row).dot(row.omega)
    }

    /// Kinetic and potential; kinetic alone of a row without attitude.
    pub(super) fn energy(&self, row: &Row) -> f64 {
        match row.attitude {
            Some(attitude) if !self.free => {
                let point: Point<f64> = match self.body.enter_omega(attitude, row.omega) {
                    Ok(point) => point.to_f64(),
                    Err(_) => return self.kinetic(row),
                };
                self.body.energy_of(Time::from_seconds(row.time), &point).hi() / self.body.scale()
            }
            _ => self.kinetic(row),
        }
    }
}
