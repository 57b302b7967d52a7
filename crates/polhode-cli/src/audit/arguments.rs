//! The flags that say how a record is to be read.

use clap::{Args, ValueEnum};
use polhode::audit::{Attitudes, Convention, Frame, Trajectory};
use polhode::units::RateUnit;
use polhode_files::ReadOptions;
use polhode_files::error::Error;
use polhode_files::trajectory::FoundTrajectory;

use crate::flags::attitude::{AttitudeArguments, check_used};
use crate::flags::table::{TableArguments, rate_unit};

/// What is claimed of the convention, and where the columns stand.
#[derive(Args, Clone, Debug)]
pub(super) struct ReadingArguments {
    #[command(flatten)]
    table: TableArguments,
    #[command(flatten)]
    attitude: AttitudeArguments,
    /// Axes of the angular velocity [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    omega_frame: Option<Axes>,
    /// Axes of the angular momentum [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    momentum_frame: Option<Axes>,
    /// Unit of the angular velocity: rad/s, deg/s or rpm
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

    /// Whether a flag names columns of a quantity.
    pub(super) fn names_quantities(&self) -> bool {
        self.table.names_quantities()
    }

    /// Refuses moments in any order where none are given, or where wheels stay on their axes.
    pub(super) fn check_order(&self, has_body: bool, has_wheels: bool) -> Result<(), Error> {
        let rule = match (has_body, has_wheels) {
            (false, _) => "no moments are given",
            (true, true) => "a body with wheels has its moments in a fixed order",
            (true, false) => return Ok(()),
        };
        if self.any_order { Err(Error::input("--any-order", "", rule, "leave it out")) } else { Ok(()) }
    }

    /// Refuses a flag that says how columns are written that no body has, and a unit of times that have theirs.
    pub(super) fn check_used(&self, found: &FoundTrajectory) -> Result<(), Error> {
        self.table.check_times(&found.read_as)?;
        let has = |of: fn(&Trajectory) -> bool| found.bodies.iter().any(|(_, rows)| of(rows));
        let frame = |axes: Axes| String::from(if axes == Axes::Body { "body" } else { "space" });
        let of_momentum = self.momentum_frame.map(|axes| ("--momentum-frame", frame(axes)));
        let of_rates = self.omega_frame.map(|axes| ("--omega-frame", frame(axes)));
        let of_unit = self.rate_unit.map(|unit| ("--rate-unit", unit.to_string()));
        let has_quaternions = has(|rows| matches!(rows.attitude, Some(Attitudes::Quaternions(_))));
        let has_angles = has(|rows| matches!(rows.attitude, Some(Attitudes::Angles(_))));
        let has_rates = has(|rows| rows.rates.is_some());
        self.attitude.check_forms(has_quaternions, has_angles)?;
        for (flag, is_used, what) in [
            (self.attitude.given_of_direction(), has(|rows| rows.attitude.is_some()), "an attitude"),
            (of_momentum, has(|rows| rows.momentum.is_some()), "an angular momentum"),
            (of_rates, has_rates, "an angular velocity"),
            (of_unit, has_rates, "an angular velocity"),
        ] {
            check_used(flag, is_used, what)?;
        }
        Ok(())
    }

    /// The Euler angles in the order of the sequence that is stated; says where that of a quaternion is told already.
    pub(super) fn order(&self, found: &mut FoundTrajectory, name: &str) -> Result<(), Error> {
        self.attitude.note_order(&found.claims, name);
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
