//! The flags that say how a record is to be read.

use clap::{Args, ValueEnum};
use polhode::audit::{Angles, Convention, Direction, Frame, Turns};
use polhode::rotation::EulerSequence;
use polhode::units::{AngleUnit, RateUnit};
use polhode_files::ReadOptions;

use crate::flags::table::{Order, TableArguments, rate_unit};

/// What is claimed of the convention, and where the columns stand.
#[derive(Args, Clone, Debug)]
pub(super) struct ReadingArguments {
    #[command(flatten)]
    table: TableArguments,
    /// State the place of the scalar [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    quaternion: Option<Order>,
    /// State the direction of the attitude [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    attitude: Option<To>,
    /// Product of the quaternions for which --attitude is meant [default: hamilton]
    #[arg(long, value_enum, requires = "attitude", help_heading = "Reading")]
    product: Option<Product>,
    /// State the axes of the angular velocity [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    omega_frame: Option<Axes>,
    /// State the axes of the angular momentum [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    momentum_frame: Option<Axes>,
    /// State the unit of the angular velocity: rad/s, deg/s or rpm
    #[arg(long, value_name = "UNIT", value_parser = rate_unit, help_heading = "Reading")]
    rate_unit: Option<RateUnit>,
    /// Sequence of the Euler angles in the order of their columns, about turned axes, as zyx; about fixed axes with :extrinsic
    #[arg(long, value_name = "SEQUENCE[:extrinsic]", value_parser = sequence, help_heading = "Reading")]
    euler: Option<(EulerSequence, Turns)>,
    /// Unit of the Euler angles: rad or deg
    #[arg(long, value_name = "UNIT", value_parser = angle, help_heading = "Reading")]
    angle_unit: Option<AngleUnit>,
    /// The moments may belong to the axes in any order
    #[arg(long, help_heading = "Reading")]
    any_order: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum To {
    BodyToSpace,
    SpaceToBody,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Product {
    /// i j = k
    Hamilton,
    /// i j = -k
    Jpl,
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

fn angle(text: &str) -> Result<AngleUnit, String> {
    AngleUnit::named(text).ok_or_else(|| format!("'{text}' is no unit of angles here; write rad or deg"))
}

fn sequence(text: &str) -> Result<(EulerSequence, Turns), String> {
    let (name, turns) = match text.split_once(':') {
        None | Some((_, "intrinsic")) => (text.split(':').next().unwrap_or(text), Turns::Intrinsic),
        Some((name, "extrinsic")) => (name, Turns::Extrinsic),
        Some((_, other)) => return Err(format!("'{other}' is neither intrinsic nor extrinsic")),
    };
    name.parse()
        .map(|sequence| (sequence, turns))
        .map_err(|error: polhode::rotation::EulerSequenceError| error.to_string())
}

impl ReadingArguments {
    /// How the table is read.
    pub(super) fn table(&self) -> ReadOptions {
        self.table.reading(self.rate_unit)
    }

    /// What is claimed: by flags first, then by the names of the file.
    pub(super) fn claims(&self, of_file: Convention) -> Convention {
        let mut claims = of_file;
        if let Some(order) = self.quaternion {
            claims.quaternion = Some(order.into());
        }
        if let Some(to) = self.attitude {
            let direct = match to {
                To::BodyToSpace => Direction::BodyToSpace,
                To::SpaceToBody => Direction::SpaceToBody,
            };
            let jpl = self.product == Some(Product::Jpl);
            claims.attitude = Some(if jpl { direct.other() } else { direct });
        }
        claims.omega_frame = self.omega_frame.map(Frame::from).or(claims.omega_frame);
        claims.momentum_frame = self.momentum_frame.map(Frame::from).or(claims.momentum_frame);
        claims.rate_unit = self.rate_unit.or(claims.rate_unit);
        claims.angle_unit = self.angle_unit.or(claims.angle_unit);
        if let (Some((sequence, turns)), Some(unit)) =
            (self.euler, claims.angle_unit.or(Some(AngleUnit::Radians)))
        {
            claims.angles = Some(Angles { sequence, turns, unit });
        }
        if self.any_order {
            claims.moments = None;
        }
        claims
    }
}
