//! The flags that say how a record is to be read.

use clap::{Args, ValueEnum};
use polhode::audit::{Convention, Frame};
use polhode::units::RateUnit;
use polhode_files::ReadOptions;
use polhode_files::error::Error;
use polhode_files::trajectory::FoundTrajectory;

use crate::flags::attitude::AttitudeArguments;
use crate::flags::table::{TableArguments, rate_unit};

/// What is claimed of the convention, and where the columns stand.
#[derive(Args, Clone, Debug)]
pub(super) struct ReadingArguments {
    #[command(flatten)]
    table: TableArguments,
    #[command(flatten)]
    attitude: AttitudeArguments,
    /// State the axes of the angular velocity [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    omega_frame: Option<Axes>,
    /// State the axes of the angular momentum [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    momentum_frame: Option<Axes>,
    /// State the unit of the angular velocity: rad/s, deg/s or rpm
    #[arg(long, value_name = "UNIT", value_parser = rate_unit, help_heading = "Reading")]
    rate_unit: Option<RateUnit>,
    /// The moments may belong to the axes in any order
    #[arg(long, help_heading = "Reading")]
    any_order: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Axes {
    Body,
    Space,
}

impl From<Axes> for Frame {
    fn from(axes: Axes) -> Self {
        match axes {
            Axes::Body => Self::Body,
            Axes::Space => Self::Space,
        }
    }
}

impl ReadingArguments {
    /// How the table is read.
    pub(super) fn table(&self) -> ReadOptions {
        self.table.reading(self.rate_unit)
    }

    /// Whether a flag names columns.
    pub(super) fn names_columns(&self) -> bool {
        self.table.names_columns()
    }

    /// The Euler angles in the order of the sequence that is stated.
    pub(super) fn order(&self, found: &mut FoundTrajectory) -> Result<(), Error> {
        self.attitude.order(found)
    }

    /// What is claimed: by flags first, then by the names of the file.
    pub(super) fn claims(&self, of_file: Convention) -> Convention {
        let mut claims = self.attitude.claims(of_file);
        claims.omega_frame = self.omega_frame.map(Frame::from).or(claims.omega_frame);
        claims.momentum_frame = self.momentum_frame.map(Frame::from).or(claims.momentum_frame);
        claims.rate_unit = self.rate_unit.or(claims.rate_unit);
        if self.any_order {
            claims.moments = None;
        }
        claims
    }
}
