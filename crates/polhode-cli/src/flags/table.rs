//! How a table is read where its header leaves it open: columns, units, counters, the place of the scalar.

use clap::{Args, ValueEnum};
use polhode::audit::QuaternionOrder;
use polhode::units::{RateUnit, TimeUnit};
use polhode_files::error::Error;
use polhode_files::numbers::positive;
use polhode_files::text::short;
use polhode_files::{ColumnNames, ReadAs, ReadOptions};

/// Columns and times of a table.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Reading")]
pub(crate) struct TableArguments {
    /// Columns by name or by number from 1, as t=time,wx=3. Keys: t, id; wx,wy,wz or x,y,z (rates); qw,qx,qy,qz, or q0..q3 if the place of the scalar is open; r11..r33 (matrix); e1..e3 (Euler angles); s1..s3 (MRP); lx,ly,lz (momentum)
    #[arg(long, value_name = "KEY=NAME,...", value_parser = ColumnNames::parse)]
    columns: Option<ColumnNames>,
    /// Unit of time where the header names none: s, ms, us, ns, or a number of seconds, such as the time step where the file counts steps [default: s]
    #[arg(long, value_name = "UNIT", value_parser = time_unit)]
    time_unit: Option<TimeUnit>,
    /// Samples per second, for files that count samples or have no times
    #[arg(long, value_name = "HZ", value_parser = positive, allow_hyphen_values = true, conflicts_with = "time_unit")]
    sample_rate: Option<f64>,
}

impl TableArguments {
    /// Refuses flags where no file is read by them; `naming` is what names one.
    pub(crate) fn check_read(&self, is_read: bool, naming: &str) -> Result<(), Error> {
        if is_read || (self.columns.is_none() && self.time_unit.is_none() && self.sample_rate.is_none()) {
            return Ok(());
        }
        Err(Error::Input(format!(
            "--columns, --time-unit and --sample-rate are for files; give {naming}, or leave them out"
        )))
    }

    /// Whether a flag names columns of a quantity.
    pub(crate) fn names_quantities(&self) -> bool {
        self.columns.as_ref().is_some_and(ColumnNames::name_quantities)
    }

    /// Refuses a unit of time or a rate of samples where times are dates, or seconds and nanoseconds in two columns.
    pub(crate) fn check_times(&self, read_as: &ReadAs) -> Result<(), Error> {
        let (times, _) = &read_as.times;
        let unit = self.time_unit.map(|unit| ("--time-unit", unit.to_string()));
        match unit.or_else(|| self.sample_rate.map(|rate| ("--sample-rate", short(rate)))) {
            Some((flag, value)) if times == "dates" || times == "s and ns" => {
                let rule = format!("the times of {} are {times} already", read_as.file);
                Err(Error::input(flag, &value, &rule, "leave it out"))
            }
            _ => Ok(()),
        }
    }

    /// What they say, with the unit of the angular velocity.
    pub(crate) fn reading(&self, rate_unit: Option<RateUnit>) -> ReadOptions {
        ReadOptions::default()
            .with_columns(self.columns.clone().unwrap_or_default())
            .with_time_unit(self.time_unit)
            .with_sample_rate(self.sample_rate)
            .with_rate_unit(rate_unit)
    }
}

fn time_unit(text: &str) -> Result<TimeUnit, String> {
    let number = || positive(text).ok().map(TimeUnit::Multiple);
    TimeUnit::named(text)
        .or_else(number)
        .ok_or_else(|| format!("unknown unit of time '{text}'; known: s, ms, us, ns, or a number of seconds"))
}

/// A unit of angular velocity.
pub(crate) fn rate_unit(text: &str) -> Result<RateUnit, String> {
    RateUnit::named(text).ok_or_else(|| format!("unknown unit of rates '{text}'; known: rad/s, deg/s, rpm"))
}

/// Place of the scalar in a quaternion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Order {
    /// Scalar first
    Wxyz,
    /// Scalar last
    Xyzw,
}

impl From<Order> for QuaternionOrder {
    fn from(order: Order) -> Self {
        match order {
            Order::Wxyz => Self::ScalarFirst,
            Order::Xyzw => Self::ScalarLast,
        }
    }
}
