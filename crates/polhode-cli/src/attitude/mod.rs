//! `polhode attitude`: attitudes from measured angular velocity.

mod against;
mod flight;
mod readings;
mod rule;
mod sensor;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use nalgebra::UnitQuaternion;
use polhode::record::Segment;
use polhode::rotation::{EulerAngles, EulerSequence, Quat};
use polhode::strapdown::{Estimate, Kind, Rule, attitudes};
use polhode_files::error::{Error, tell, warn};
use polhode_files::numbers::{quaternion, turn};
use polhode_files::text::rounded;
use polhode_pages::table::{Cell, Column, Format, RowWriter, Table};

use crate::flags::record::RecordArguments;
use crate::flags::start::sequence;
use crate::flags::table::Order;
use crate::memory;
use against::Reference;
use readings::{KindArguments, Readings};
use rule::RuleArguments;
use sensor::SensorArguments;

const EXAMPLES: &str = "Examples:
  polhode simulate --body spacecraft --omega 0.3,1,0.4 --until 60 \\
    --every 0.05 --noise 1e-4 --out gyro.csv
  polhode attitude gyro.csv --kind rate --out attitude.csv
  polhode attitude gyro.csv --kind rate --rule trapezoid --against attitude.csv
  polhode attitude gyro.csv --kind rate --bias 1e-5 --scale-error 1e-4 \\
    --euler zyx --format table";

/// Attitude from the readings of a gyroscope, with an error budget
///
/// Between two samples the rates are a polynomial through the samples around, and the turn is the exponential of its Magnus
/// series. Order and number of samples are chosen from the record, with its noise. Columns: t, q_w, q_x, q_y, q_z (body to space,
/// scalar first), attitude_sigma (standard deviation of each component of the attitude error by all causes, rad), truncation
/// (estimated error of the method, rad). The start counts as exact. Exit code 1: the attitude is lost, its standard deviation is
/// above 1 rad.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Attitude {
    /// Record with a header: t, wx, wy, wz, or the names of phone apps; - reads standard input
    #[arg(value_name = "RECORD.csv")]
    record: PathBuf,
    #[command(flatten)]
    reading: RecordArguments,
    #[command(flatten)]
    kind: KindArguments,
    /// Attitude at the first sample, body to space, scalar first [default: that of --against, else 1,0,0,0]
    #[arg(long, value_name = "w,x,y,z", value_parser = quaternion, allow_hyphen_values = true, help_heading = "Record")]
    start: Option<[f64; 4]>,
    #[command(flatten)]
    rule: RuleArguments,
    #[command(flatten)]
    sensor: SensorArguments,
    /// A free body in sensor axes: the attitudes are those of its exact motion that fits all rates best, and a last column integrated has the angle to the attitude by the readings alone, rad
    #[arg(long, value_name = "NAME|FILE[:LINK]", help_heading = "Method")]
    body: Option<String>,
    /// Compare with the attitudes of this file at the same times: a last column attitude_error, rad
    #[arg(long, value_name = "REFERENCE.csv", help_heading = "Output")]
    against: Option<PathBuf>,
    /// Also print Euler angles in this sequence, intrinsic, such as zyx: phi, theta, psi, rad
    #[arg(long, value_name = "SEQUENCE", value_parser = sequence, help_heading = "Output")]
    euler: Option<EulerSequence>,
    /// Order of the columns of the quaternion
    #[arg(long, value_enum, default_value_t = Order::Wxyz, help_heading = "Output")]
    quaternion: Order,
    /// What an attitude takes where: body components to space, or space components to body (the quaternion of JPL's product)
    #[arg(long, value_enum, default_value_t = Direction::BodyToSpace, help_heading = "Output")]
    direction: Direction,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

/// The direction of the attitudes that are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Direction {
    BodyToSpace,
    SpaceToBody,
}

/// An attitude with a larger standard deviation is lost, rad.
const LOST: f64 = 1.0;

impl Attitude {
    pub(crate) fn run(&self) -> Result<(), Error> {
        memory::check_files(std::slice::from_ref(&self.record), 4)?;
        let readings = self.kind.readings(&self.record, &self.reading)?;
        let mut reference = self.against.as_deref().map(Reference::read).transpose()?;
        if let Some(reference) = &reference {
            reference.check(readings.segments().iter().flat_map(|segment| segment.times()))?;
        }
        let noise = self.sensor.noise(&readings);
        let sensor = self.sensor.sensor(noise);
        let rule = self.rule.rule(&readings, sensor)?;
        let mut rows = RowWriter::new(self.table(), self.format, self.out.as_deref(), readings.samples())?;
        let mut lost: Option<f64> = None;
        for segment in readings.segments() {
            let start = self.start(segment, reference.as_ref())?;
            let found = attitudes(segment.times(), segment.rates(), readings.kind, rule, start, sensor)
                .map_err(|error| readings.refused(segment, &error))?;
            let flight = match &self.body {
                Some(body) => Some(flight::smoothed(body, &readings, segment, start, sensor)?),
                None => None,
            };
            for (k, integrated) in found.iter().enumerate() {
                let smoothed = flight.as_ref().and_then(|flight| flight.get(k));
                let estimate = smoothed.unwrap_or(integrated);
                if estimate.budget.sigma() > LOST {
                    lost.get_or_insert(estimate.time);
                }
                let error = reference.as_mut().map(|reference| reference.error(estimate));
                let apart = smoothed.map(|smoothed| smoothed.error(integrated.attitude).norm());
                rows.push(self.cells(estimate, error.flatten(), apart))?;
            }
            self.tell(&readings, segment, rule, start, &found, noise.is_found);
        }
        if let Some(reference) = &reference {
            reference.tell();
        }
        rows.finish()?;
        match lost {
            None => Ok(()),
            Some(t) => Err(Error::Failed(format!(
                "{}: the attitude is lost: from t = {} s on its standard deviation is above {LOST} rad",
                readings.name,
                rounded(t)
            ))),
        }
    }

    fn start(&self, segment: &Segment, reference: Option<&Reference>) -> Result<UnitQuaternion<f64>, Error> {
        match (self.start.and_then(turn), reference, segment.times().first()) {
            (Some(start), ..) => Ok(start),
            (None, Some(reference), Some(time)) => reference.at(*time).ok_or_else(|| {
                let rule = format!("no attitude at the first time of the record, {time} s");
                Error::input("--against", &reference.name, &rule, "give --start w,x,y,z")
            }),
            _ => Ok(UnitQuaternion::identity()),
        }
    }

    fn table(&self) -> Table {
        let mut parts = [
            ("q_w", "attitude, scalar part"),
            ("q_x", "attitude, x"),
            ("q_y", "attitude, y"),
            ("q_z", "attitude, z"),
        ];
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
                Column::new("integrated", "rad", "angle to the attitude by the readings alone").digits(2),
            );
        }
        Table::new("attitude", "Attitudes from the readings of a gyroscope.", columns)
    }

    fn cells(&self, estimate: &Estimate, error: Option<f64>, apart: Option<f64>) -> Vec<Cell> {
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

    /// What was done and what it is worth, in a line.
    fn tell(
        &self,
        readings: &Readings,
        segment: &Segment,
        rule: Rule,
        start: UnitQuaternion<f64>,
        found: &[Estimate],
        noise_is_found: bool,
    ) {
        let Some(last) = found.last() else { return };
        let budget = &last.budget;
        let mut parts = vec![format!("truncation {:.1e} rad", budget.truncation)];
        let source = if noise_is_found { " (noise found in the record)" } else { "" };
        parts.push(format!("random walk {:.1e} rad{source}", budget.random_walk));
        let others = [("bias", budget.bias), ("scale", budget.scale), ("stamps", budget.stamps)];
        parts.extend(others.iter().filter(|(_, x)| *x > 0.0).map(|(name, x)| format!("{name} {x:.1e} rad")));
        let line = rule::last(readings.kind, segment, Rule::Trapezoid, start)
            .map(|other| last.attitude.angle_to(&other))
            .filter(|_| rule != Rule::Trapezoid);
        let line = line.map_or(String::new(), |angle| {
            format!("; the trapezoid with coning would be off by {angle:.1e} rad from it")
        });
        tell(
            "note",
            &format!("{}; at t = {} s: {}{line}", rule::words(rule), rounded(last.time), parts.join(", ")),
        );
        if readings.is_assumed {
            let mean = rule::last(Kind::Average, segment, rule, start);
            if let Some(angle) = mean.map(|other| last.attitude.angle_to(&other)) {
                let message = format!(
                    "the readings are taken for rates at the times of their rows, as their unit allows; were they averages since the row \
                     before, the attitude at the end would differ by {angle:.1e} rad; --kind says which they are"
                );
                if angle > 2.0 * budget.sigma() { warn(&message) } else { tell("note", &message) }
            }
        }
    }
}
