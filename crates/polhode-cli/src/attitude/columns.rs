//! The columns of the answer.

use polhode::rotation::{EulerAngles, Quat};
use polhode::strapdown::Estimate;
use polhode_pages::table::{Cell, Column, Table};

use super::{Attitude, Direction};
use crate::flags::table::Order;

impl Attitude {
    pub(super) fn table(&self) -> Table {
        // the names by which files are read in this direction again
        let [w, x, y, z] = match self.direction {
            Direction::BodyToSpace => ["q_w", "q_x", "q_y", "q_z"],
            Direction::SpaceToBody => {
                ["q_space_to_body_w", "q_space_to_body_x", "q_space_to_body_y", "q_space_to_body_z"]
            }
        };
        let mut parts =
            [(w, "attitude, scalar part"), (x, "attitude, x"), (y, "attitude, y"), (z, "attitude, z")];
        if self.quaternion == Order::Xyzw {
            parts.rotate_left(1);
        }
        let mut columns = vec![Column::new("t", "s", "time").digits(6)];
        columns.extend(parts.map(|(name, meaning)| Column::new(name, "", meaning).digits(6)));
        columns.extend([
            Column::new("attitude_sigma", "rad", "standard deviation of a component, all causes").digits(2),
            Column::new("truncation", "rad", "estimated error of the method").digits(2),
        ]);
        if self.euler.is_some() {
            columns.push(Column::new("phi", "rad", "first Euler angle").digits(6));
            columns.push(Column::new("theta", "rad", "second Euler angle").digits(6));
            columns.push(Column::new("psi", "rad", "third Euler angle").digits(6));
        }
        if self.against.is_some() {
            columns.push(
                Column::new("attitude_error", "rad", "angle to the attitude of the reference").digits(2),
            );
        }
        if self.body.is_some() {
            columns.push(
                Column::new("integrated", "rad", "angle to the attitude that the readings alone give")
                    .digits(2),
            );
        }
        Table::new("attitude", "Attitudes from the readings of a gyroscope.", columns)
    }

    pub(super) fn cells(&self, estimate: &Estimate, error: Option<f64>, apart: Option<f64>) -> Vec<Cell> {
        let attitude = match self.direction {
            Direction::BodyToSpace => estimate.attitude,
            Direction::SpaceToBody => estimate.attitude.inverse(),
        };
        let budget = &estimate.budget;
        let mut parts = Quat::from(attitude).components();
        if self.quaternion == Order::Xyzw {
            parts.rotate_left(1);
        }
        let [a, b, c, d] = parts;
        let mut cells: Vec<Cell> =
            [estimate.time, a, b, c, d, budget.sigma(), budget.truncation].map(Cell::from).to_vec();
        if let Some(sequence) = self.euler {
            let EulerAngles { angles, .. } = sequence.angles(estimate.attitude);
            cells.extend(angles.map(Cell::from));
        }
        if self.against.is_some() {
            cells.push(error.into());
        }
        if self.body.is_some() {
            cells.push(apart.into());
        }
        cells
    }
}
