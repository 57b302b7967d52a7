//! In which convention attitudes are written: `audit` and `fit`.

use clap::{Args, ValueEnum};
use polhode::audit::{Angles, Attitudes, Convention, Direction, Turns};
use polhode::rotation::EulerSequence;
use polhode::units::AngleUnit;
use polhode_files::error::Error;
use polhode_files::trajectory::FoundTrajectory;

use super::table::Order;

/// What is stated of the attitudes.
#[derive(Args, Clone, Debug)]
pub(crate) struct AttitudeArguments {
    /// State the place of the scalar
    #[arg(long, value_enum, help_heading = "Reading")]
    quaternion: Option<Order>,
    /// State the direction of the attitude [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    attitude: Option<To>,
    /// Product of the quaternions for which --attitude is meant [default: hamilton]
    #[arg(long, value_enum, requires = "attitude", help_heading = "Reading")]
    product: Option<Product>,
    /// Sequence of the Euler angles in the order of their columns, about turned axes, as zyx; about fixed axes with :extrinsic. Columns roll, pitch and
    /// yaw are taken by the letters x, y and z
    #[arg(long, value_name = "SEQUENCE[:extrinsic]", value_parser = sequence, help_heading = "Reading")]
    euler: Option<(EulerSequence, Turns)>,
    /// Unit of the Euler angles: rad or deg
    #[arg(long, value_name = "UNIT", value_parser = angle, help_heading = "Reading")]
    angle_unit: Option<AngleUnit>,
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

impl AttitudeArguments {
    /// Angles in columns of the names roll, pitch and yaw, in the order of the sequence that is stated.
    pub(crate) fn order(&self, found: &mut FoundTrajectory) -> Result<(), Error> {
        let (Some(_), Some((sequence, _))) = (found.claims.angle_axes, self.euler) else { return Ok(()) };
        let axes = sequence.axes();
        if axes[0] == axes[2] {
            let rule = "turns about one axis twice, and roll, pitch and yaw are angles about x, y and z";
            return Err(Error::input(
                "--euler",
                &sequence.to_string(),
                rule,
                "state a sequence of the three, as zyx, or name the columns by --columns",
            ));
        }
        for (_, rows) in &mut found.bodies {
            if let Some(Attitudes::Angles(angles)) = &mut rows.attitude {
                angles.iter_mut().for_each(|row| *row = axes.map(|axis| row[axis]));
            }
        }
        found.claims.angle_axes = Some(axes);
        Ok(())
    }

    /// What is claimed: by flags first, then by the names of the file.
    pub(crate) fn claims(&self, of_file: Convention) -> Convention {
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
        claims.angle_unit = self.angle_unit.or(claims.angle_unit);
        if let Some((sequence, turns)) = self.euler {
            let unit = claims.angle_unit.unwrap_or(AngleUnit::Radians);
            claims.angles = Some(Angles { sequence, turns, unit });
        }
        claims
    }
}
