//! `polhode simulate`: a noisy record of a known body, to simulate a measurement.

mod arguments;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use nalgebra::Vector3;
use polhode::num::Random;
use polhode_files::error::Error;
use polhode_files::instant::positive_duration;
use polhode_files::numbers::{not_negative, number, numbers};
use polhode_files::text::rounded;
use polhode_fit::{Gyroscope, SimulatedPoses, simulate_poses};
use polhode_pages::table::{Cell, Column, Format, RowWriter, Table};

use crate::flags::body::BodyArguments;
use crate::flags::start::{Factor, rate_unit};
use crate::flags::times::{Regular, regular};
use crate::flags::wheel::{WheelArguments, refused};
use arguments::{DisturbanceArguments, GyroscopeArguments};

const USAGE: &str = "polhode simulate <BODY> [--omega <wx,wy,wz>] --until <T> --every <DT>
  BODY: --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>";

const EXAMPLES: &str = "Examples:
  polhode simulate --body phone --omega 1,9,2 --until 5 --every 0.01 \\
    --noise 0.01 --out record.csv
  polhode simulate --body racket --omega 1,9,2 --until 1 --every 0.01 \\
    --tosses 10 --scatter 1 --relative-drag 0.2 --noise 0.01 \\
    --offset 0.01,0,0 --spikes 0.01,2 --out tosses.csv";

/// Record of a rate sensor, or of attitudes, of a known body
///
/// `polhode fit` and `polhode attitude` read its CSV, so that a measurement can be tried before it is made. The same seed gives the
/// same record on every machine.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Simulate {
    #[command(flatten)]
    body: BodyArguments,
    #[command(flatten)]
    wheels: WheelArguments,
    /// Angular velocity at the start, body axes, rad/s or --rate-unit [default: that of the catalogue's body]
    #[arg(long, value_name = "wx,wy,wz", value_parser = numbers::<3>, allow_hyphen_values = true, help_heading = "Start")]
    omega: Option<[f64; 3]>,
    /// Unit of --omega alone: rpm, or rad, deg or rev per s, min, h or d, as deg/s [default: rad/s]
    #[arg(long, value_name = "UNIT", value_parser = rate_unit, requires = "omega", help_heading = "Start")]
    rate_unit: Option<Factor>,
    /// Duration: s, or with a unit (ms, min, h, d)
    #[arg(long, value_name = "T", value_parser = positive_duration, allow_hyphen_values = true, help_heading = "Record")]
    until: f64,
    /// Time between samples: s, or with a unit
    #[arg(long, value_name = "DT", value_parser = positive_duration, allow_hyphen_values = true, help_heading = "Record")]
    every: f64,
    /// Scatter of the sample times, a fraction of DT below 1
    #[arg(long, value_name = "FRACTION", value_parser = jitter, allow_hyphen_values = true, default_value = "0", hide_default_value = true, help_heading = "Record")]
    jitter: f64,
    /// Scatter of the true times about those that the record has, a fraction of DT; together with --jitter below 1
    #[arg(long, value_name = "FRACTION", value_parser = jitter, allow_hyphen_values = true, default_value = "0", hide_default_value = true, help_heading = "Record")]
    hidden_jitter: f64,
    /// Number of tosses, each a free motion of duration T with its own start
    #[arg(long, value_name = "N", default_value = "1", help_heading = "Record")]
    tosses: NonZeroUsize,
    /// Time between two tosses: s, or with a unit [default: 20 DT]
    #[arg(long, value_name = "P", value_parser = positive_duration, allow_hyphen_values = true, help_heading = "Record")]
    pause: Option<f64>,
    /// Standard deviation of the starts of the later tosses, each component about --omega, rad/s
    #[arg(long, value_name = "SIGMA", value_parser = not_negative, allow_hyphen_values = true, default_value = "0", hide_default_value = true, help_heading = "Record")]
    scatter: f64,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value = "1", help_heading = "Record")]
    seed: u64,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
    #[command(flatten)]
    disturbances: DisturbanceArguments,
    #[command(flatten)]
    gyroscope: GyroscopeArguments,
}

/// Samples of all tosses: more are rather a slip of the pen than a wish.
const MOST_SAMPLES: usize = 2_000_000;

/// A fraction of the time between samples.
fn jitter(text: &str) -> Result<f64, String> {
    match number(text)? {
        value if (0.0..1.0).contains(&value) => Ok(value),
        _ => Err("samples must keep their order; give a fraction from 0 to below 1".into()),
    }
}

impl Simulate {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let is_sized = self.disturbances.is_sized() || self.wheels.is_any();
        self.body.check_size(is_sized)?;
        let (body, of_file) = self.body.free()?;
        let wheels = self.wheels.all(of_file);
        let published = self.body.published_start().map(|start| start.omega);
        let unit = self.rate_unit.map_or(1.0, |Factor(unit)| unit);
        let Some(start) = self.omega.map(|omega| omega.map(|w| w * unit)).or(published) else {
            return Err(Error::Input(
                "--omega: missing; give --omega wx,wy,wz (only bodies of the catalogue have one)".into(),
            ));
        };
        let gyroscope = self.gyroscope.gyroscope();
        self.check_sensor(&gyroscope)?;
        let mut random = Random::new(self.seed);
        let grid: Vec<f64> =
            regular(0.0, self.until, self.every).and_then(Regular::kept).map_err(Error::Input)?;
        let tosses = self.tosses.get();
        if tosses.saturating_mul(grid.len()) > MOST_SAMPLES {
            let rule = format!("{} samples each, and at most {MOST_SAMPLES} are written", grid.len());
            return Err(Error::input("--tosses", &tosses.to_string(), &rule, "give fewer, or a larger DT"));
        }
        let tells_wheels = self.disturbances.has_wheel() || !wheels.is_empty();
        let mut rows =
            RowWriter::new(self.table(tells_wheels), self.format, self.out.as_deref(), tosses * grid.len())?;
        let pause = self.between_tosses()?;
        for toss in 0..tosses {
            let mut scattered = |share: f64, times: &[f64]| -> Vec<f64> {
                times.iter().map(|t| t + share * self.every * (random.uniform() - 0.5)).collect()
            };
            let written = scattered(self.jitter, &grid);
            let hidden = (self.hidden_jitter > 0.0).then(|| scattered(self.hidden_jitter, &written));
            let sampled = hidden.as_deref().unwrap_or(&written);
            let mut omega = Vector3::from(start);
            if toss > 0 {
                omega += random.normal_vector() * self.scatter;
            }
            let noise = self.gyroscope.attitude_noise();
            // each toss starts with the speeds of the wheels
            let carrier = body.clone().with_wheels_at_start(&wheels, 0.0, omega);
            let carrier = carrier.map_err(|error| refused(&error))?;
            let disturbances = self.disturbances.disturbances(carrier.wheels());
            let SimulatedPoses { rates, attitudes, wheel, .. } = simulate_poses(
                carrier.inertia(),
                omega,
                sampled,
                &disturbances,
                &gyroscope,
                noise.unwrap_or(0.0),
                &mut random,
            )
            .map_err(|error| Error::Input(error.to_string()))?;
            let thrown = toss as f64 * (self.until + pause);
            // momenta are told for the time of the row, but for what the turning of the body makes of them when it is read
            let told = written.iter().zip(sampled).zip(&wheel).map(|((written, sampled), wheel)| {
                disturbances.wheel_at(*written) + (wheel - disturbances.wheel_at(*sampled))
            });
            for (((t, w), q), h) in written.iter().zip(&rates).zip(&attitudes).zip(told) {
                let attitude = noise.map(|_| [q.w, q.i, q.j, q.k]).into_iter().flatten();
                let vector =
                    |told: bool, v: Vector3<f64>| told.then(|| <[f64; 3]>::from(v)).into_iter().flatten();
                let cells = std::iter::once(thrown + t).chain(attitude);
                let cells =
                    cells.chain(vector(self.gyroscope.has_rates(), *w)).chain(vector(tells_wheels, h));
                let cells = cells.chain(self.disturbances.known_torque().into_iter().flatten());
                rows.push(cells.map(Cell::from))?;
            }
        }
        rows.finish()
    }

    /// Errors of a sensor are of one that is read, and its samples keep their order.
    fn check_sensor(&self, gyroscope: &Gyroscope) -> Result<(), Error> {
        if !self.gyroscope.has_rates() && *gyroscope != Gyroscope::default() {
            return Err(Error::Input(
                "--attitude-noise: without --noise the record has attitudes and no rates, and errors of the rate sensor do not change them; \
                 give --noise too, or leave these errors out"
                    .into(),
            ));
        }
        let scatter = self.jitter + self.hidden_jitter;
        if scatter >= 1.0 {
            let rule = format!(
                "with --jitter {} the true times scatter over {} DT, and samples must keep their order",
                rounded(self.jitter),
                rounded(scatter)
            );
            let remedy = "give fractions whose sum is below 1";
            return Err(Error::input("--hidden-jitter", &rounded(self.hidden_jitter), &rule, remedy));
        }
        Ok(())
    }

    /// Seconds from the end of a toss to the start of the next.
    fn between_tosses(&self) -> Result<f64, Error> {
        if self.tosses.get() == 1 && (self.pause.is_some() || self.scatter > 0.0) {
            let given = if self.pause.is_some() { "--pause" } else { "--scatter" };
            return Err(Error::Input(format!(
                "{given}: there is one toss; ask for more by --tosses, or leave it out"
            )));
        }
        let pause = self.pause.unwrap_or(20.0 * self.every);
        if pause <= self.jitter * self.every {
            let rule =
                format!("times scatter over {} s, so that tosses overlap", rounded(self.jitter * self.every));
            return Err(Error::input("--pause", &rounded(pause), &rule, "give a longer pause"));
        }
        Ok(pause)
    }

    fn table(&self, tells_wheels: bool) -> Table {
        let axes = |names: [&'static str; 3], unit, meaning: [&'static str; 3]| {
            names.into_iter().zip(meaning).map(move |(name, meaning)| Column::new(name, unit, meaning))
        };
        let mut columns = vec![Column::new("t", "s", "time").digits(6)];
        let about = [
            "angular velocity about the first body axis",
            "angular velocity about the second body axis",
            "angular velocity about the third body axis",
        ];
        if self.gyroscope.attitude_noise().is_some() {
            columns.push(Column::new("q_w", "", "scalar of the attitude, body to space"));
            let vector = "component of the vector of the quaternion";
            columns.extend(axes(["q_x", "q_y", "q_z"], "", [vector; 3]));
        }
        if self.gyroscope.has_rates() {
            columns.extend(axes(["wx", "wy", "wz"], "rad/s", about));
        }
        if tells_wheels {
            let meaning = "momentum of the wheels relative to the body along this axis";
            columns.extend(axes(["hx (N m s)", "hy (N m s)", "hz (N m s)"], "N m s", [meaning; 3]));
        }
        if self.disturbances.known_torque().is_some() {
            columns.extend(axes(
                ["tx (N m)", "ty (N m)", "tz (N m)"],
                "N m",
                ["torque about this body axis"; 3],
            ));
        }
        Table::new("record", "Readings of a rate sensor.", columns)
    }
}
