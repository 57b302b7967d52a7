//! `polhode attitude`: attitudes from measured angular velocity.

mod against;
mod columns;
mod flight;
mod integration;
mod readings;
mod rule;
mod sensor;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use nalgebra::UnitQuaternion;
use polhode::record::{Record, Segment};
use polhode::rotation::EulerSequence;
use polhode::strapdown::{Estimate, Findings};
use polhode_files::error::{Error, warn};
use polhode_files::numbers::{quaternion, turn};
use polhode_files::record::Part;
use polhode_files::text::rounded;
use polhode_pages::table::{Format, RowWriter};

use crate::flags::record::RecordArguments;
use crate::flags::start::sequence;
use crate::flags::table::Order;
use crate::memory;
use against::Reference;
use flight::Apart;
use integration::{Course, Found, Integration};
use readings::{KindArguments, Readings};
use rule::RuleArguments;
use sensor::{NoiseBy, SensorArguments};

const EXAMPLES: &str = "Examples:
  polhode simulate --body spacecraft --omega 0.3,1,0.4 --until 60 \\
    --every 0.05 --noise 1e-4 --out gyro.csv
  polhode attitude gyro.csv --kind rate --out attitude.csv
  polhode attitude gyro.csv --kind rate --rule trapezoid --against attitude.csv
  polhode attitude gyro.csv --kind rate --bias 1e-5 --scale-error 1e-4 \\
    --euler zyx --format table";

/// Attitude from the readings of a gyroscope, with an error budget
///
/// Between two samples the rates are interpolated by a polynomial through the neighbouring samples, and the turn is the exponential of
/// its Magnus series. Order and number of samples are chosen from the record and its noise. Columns: t, q_w, q_x, q_y, q_z (body to
/// space, scalar first), attitude_sigma (standard deviation of each component of the attitude error from all causes, rad), truncation
/// (estimated error of the method, rad). The start counts as exact.
///
/// Exit code 1: the standard deviation of an attitude exceeds 1 rad. With --against also: most attitudes differ by more than twice their
/// 95 % error bound, one differs by more than ten times its bound and ten times the median difference, or only the start is at a time of
/// both.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Attitude {
    /// Record with times and rates, in columns t, wx, wy, wz or as phone apps name them; - reads standard input
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
    /// A free body, its tensor in sensor axes: the attitudes are then those of its exact motion that fits all rates best. A last column integrated has the angle to the attitude that the readings alone give, rad
    #[arg(long, value_name = "NAME|FILE[:LINK]", help_heading = "Method")]
    body: Option<String>,
    /// Compare with the attitudes of this file at the same times, body to space unless the names of its columns say otherwise; adds a
    /// last column attitude_error, rad
    #[arg(long, value_name = "REFERENCE.csv", help_heading = "Output")]
    against: Option<PathBuf>,
    /// Also print the intrinsic Euler angles of the attitude (body to space) in this sequence, such as zyx: phi, theta, psi, rad
    #[arg(long, value_name = "SEQUENCE", value_parser = sequence, help_heading = "Output")]
    euler: Option<EulerSequence>,
    /// Order of the columns of the quaternion
    #[arg(long, value_enum, default_value_t = Order::Wxyz, help_heading = "Output")]
    quaternion: Order,
    /// Direction of the attitudes: from body to space components, or from space to body components (the quaternion of JPL's product).
    /// The latter are in columns q_space_to_body_w, ..., which every command reads in this direction
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

impl Attitude {
    pub(crate) fn run(&self) -> Result<(), Error> {
        if self.body.is_some() {
            // a motion is fitted to all samples together
            memory::check_files(std::slice::from_ref(&self.record), 4)?;
        }
        let mut readings = self.kind.readings(&self.record, &self.reading, self.body.is_some())?;
        let mut reference = self.against.as_deref().map(Reference::read).transpose()?;
        let (mut course, mut integration): (Option<Course>, Option<Integration>) = (None, None);
        let mut rows = RowWriter::new(self.table(), self.format, self.out.as_deref(), None)?;
        let (mut lost, mut apart): (Option<f64>, Apart) = (None, Apart::default());
        let (mut resting, mut noisier): (Option<String>, Option<String>) = (None, None);
        let mut found = Vec::new();
        while let Some(Part { record, continues, .. }) = readings.next()? {
            let read_as = readings.read_as();
            self.reading.check_times(&read_as)?;
            if let Some(reference) = &mut reference {
                reference.align(&read_as)?;
                let times = record.segments.iter().flat_map(|segment| segment.times());
                reference.check(times, readings.has_more())?;
            }
            if let (Some(course), None) = (course, &noisier) {
                noisier = course.noisier(&record);
            }
            for (k, segment) in record.segments.iter().enumerate() {
                let course = match course {
                    Some(course) => course,
                    None => {
                        let begun = self.course(&readings, &record)?;
                        resting = self.sensor.resting(begun.noise_by, &record);
                        *course.insert(begun)
                    }
                };
                let mut current = match integration.take() {
                    Some(integration) if k == 0 && continues => integration,
                    before => {
                        before.into_iter().for_each(|before| before.finish(&mut found));
                        if let (Some(reference), None) = (&mut reference, self.start) {
                            reference.starts.extend(segment.times().first());
                        }
                        self.begin(&readings, segment, course, reference.as_ref())?
                    }
                };
                current.push(&readings, segment, &mut found)?;
                integration = Some(current);
            }
            self.write(&mut found, &mut rows, reference.as_mut(), (&mut lost, &mut apart))?;
        }
        integration.into_iter().for_each(|last| last.finish(&mut found));
        self.write(&mut found, &mut rows, reference.as_mut(), (&mut lost, &mut apart))?;
        if let Some(reference) = &reference {
            reference.tell();
        }
        apart.tell();
        resting.iter().chain(&noisier).for_each(|warning| warn(warning));
        if course.is_some_and(|course| course.noise_by == NoiseBy::Nothing) {
            warn(&Findings::without_noise("attitude_sigma", "--noise"));
        }
        rows.finish()?;
        match lost {
            None => reference.map_or(Ok(()), |reference| reference.judge(readings.name())),
            Some(t) => Err(Error::Failed(format!(
                "{}: the attitude is lost: from t = {} s on its standard deviation is above {} rad",
                readings.name(),
                rounded(t),
                Estimate::LOST
            ))),
        }
    }

    /// Noise and rule, by the first samples.
    fn course(&self, readings: &Readings, record: &Record) -> Result<Course, Error> {
        let noise = self.sensor.noise(record);
        let sensor = self.sensor.sensor(noise);
        let rule = self.rule.rule(readings, record, sensor)?;
        Ok(Course { rule, sensor, noise_by: noise.by })
    }

    fn begin(
        &self,
        readings: &Readings,
        segment: &Segment,
        course: Course,
        reference: Option<&Reference>,
    ) -> Result<Integration, Error> {
        let start = self.start(segment, reference)?;
        let smoothed = match &self.body {
            Some(body) => flight::smoothed(body, readings, segment, start, course.sensor)?,
            None => Vec::new(),
        };
        Integration::new(readings, course, start, smoothed)
            .map_err(|error| readings.refused(segment, 0, &error))
    }

    /// Writes what was found, and notes when the attitude is `lost` and where both attitudes are most `apart`.
    fn write(
        &self,
        found: &mut Vec<Found>,
        rows: &mut RowWriter,
        mut reference: Option<&mut Reference>,
        (lost, apart): (&mut Option<f64>, &mut Apart),
    ) -> Result<(), Error> {
        for Found { integrated, smoothed } in found.drain(..) {
            let estimate = smoothed.unwrap_or(integrated);
            if estimate.budget.sigma() > Estimate::LOST {
                lost.get_or_insert(estimate.time);
            }
            let error = reference.as_mut().map(|reference| reference.error(&estimate));
            let angle = smoothed.map(|smoothed| apart.push(&smoothed, &integrated));
            rows.push(self.cells(&estimate, error.flatten(), angle))?;
        }
        Ok(())
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
}
