//! `polhode simulate`: a noisy record of a known body, to simulate a measurement.

use std::path::PathBuf;

use clap::Args;
use nalgebra::Vector3;
use polhode::fit::simulate;
use polhode::num::Random;

use crate::arguments::{number, numbers, positive};
use crate::body_arguments::BodyArguments;
use crate::error::Error;
use crate::table::{Column, Format, Rows, Table, row};
use crate::times::{Regular, regular};

const USAGE: &str = "polhode simulate <BODY> --omega <wx,wy,wz> --until <T> --every <DT>
  BODY: --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>";

const EXAMPLES: &str = "Examples:
  polhode simulate --moments 1,2,2.6 --omega 0.3,1,0.4 --until 30 --every 0.01
  polhode simulate --body phone --omega 1,9,2 --until 5 --every 0.01 \\
    --noise 0.01 --out record.csv";

/// Noisy record of the angular velocity of a torque-free body
///
/// A simulated gyroscope; `polhode fit` reads its CSV. The same seed gives the same record on every machine.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Simulate {
    #[command(flatten)]
    body: BodyArguments,
    /// Angular velocity at time 0, body axes, rad/s
    #[arg(long, value_name = "wx,wy,wz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    omega: [f64; 3],
    /// Last time, s
    #[arg(long, value_name = "T", value_parser = positive, allow_hyphen_values = true)]
    until: f64,
    /// Time between samples, s
    #[arg(long, value_name = "DT", value_parser = positive, allow_hyphen_values = true)]
    every: f64,
    /// Standard deviation of the noise of each component, rad/s
    #[arg(long, value_name = "SIGMA", value_parser = number, allow_hyphen_values = true, default_value = "0")]
    noise: f64,
    /// Width of the random scatter of sample times, as a share of the time between samples; below 1
    #[arg(long, value_name = "SHARE", value_parser = number, allow_hyphen_values = true, default_value = "0")]
    jitter: f64,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value = "1")]
    seed: u64,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Simulate {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let refuse = |flag: &str, value: f64, rule: &str, remedy: &str| {
            Err(Error::input(flag, &format!("{value:?}"), rule, remedy))
        };
        if self.noise < 0.0 {
            return refuse("--noise", self.noise, "a standard deviation is not negative", "give 0 or more");
        }
        if !(0.0..1.0).contains(&self.jitter) {
            return refuse(
                "--jitter",
                self.jitter,
                "samples must keep their order",
                "give a share from 0 to below 1",
            );
        }
        let body = self.body.free()?;
        let mut random = Random::new(self.seed);
        let regular = regular(0.0, self.until, self.every).and_then(Regular::kept).map_err(Error::Input)?;
        let times: Vec<f64> =
            regular.into_iter().map(|t| t + self.jitter * self.every * (random.uniform() - 0.5)).collect();
        let rates = simulate(body.inertia(), Vector3::from(self.omega), &times, self.noise, &mut random)
            .map_err(|error| Error::Input(format!("--omega: {error}")))?;
        let rate = |name, axis| Column::new(name, "rad/s", axis);
        let table = Table::new(
            "record",
            "Angular velocity with noise.",
            vec![
                Column::new("t", "s", "time").digits(6),
                rate("wx", "angular velocity about the first body axis"),
                rate("wy", "angular velocity about the second body axis"),
                rate("wz", "angular velocity about the third body axis"),
            ],
        );
        let mut rows = Rows::new(table, self.format, self.out.as_deref(), times.len())?;
        for (t, w) in times.iter().zip(&rates) {
            rows.push(row![*t, w.x, w.y, w.z])?;
        }
        rows.finish()
    }
}
