//! In which convention attitudes are written: `audit` and `fit`; and what every command asks of such flags and of rotation matrices.

use clap::{Args, ValueEnum};
use nalgebra::Matrix3;
use polhode::audit::{Angles, Attitudes, Convention, Direction, Turns};
use polhode::rotation::EulerSequence;
use polhode::units::AngleUnit;
use polhode_files::error::{Error, tell};
use polhode_files::trajectory::FoundTrajectory;

use super::table::Order;

/// What is stated of the attitudes.
#[derive(Args, Clone, Debug)]
pub(crate) struct AttitudeArguments {
    /// Place of the scalar, where the names of the columns leave it open
    #[arg(long, value_enum, help_heading = "Reading")]
    quaternion: Option<Order>,
    /// Direction of the attitude [default: found from the rows]
    #[arg(long, value_enum, help_heading = "Reading")]
    attitude: Option<To>,
    /// Product of quaternions that --attitude assumes [default: hamilton]
    #[arg(long, value_enum, requires = "attitude", help_heading = "Reading")]
    product: Option<Product>,
    /// Sequence of the Euler angles in the order of their columns: zyx for turned (intrinsic) axes, zyx:extrinsic for fixed ones. Columns named roll,
    /// pitch and yaw belong to the letters x, y and z
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

/// A value as it is typed.
fn typed(value: impl ValueEnum) -> String {
    value.to_possible_value().map_or(String::new(), |value| value.get_name().to_string())
}

fn angle(text: &str) -> Result<AngleUnit, String> {
    AngleUnit::named(text).ok_or_else(|| format!("unknown unit of angles '{text}'; write rad or deg"))
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

/// The flag of the place of the scalar, and its value.
pub(crate) fn of_order(order: Option<Order>) -> Option<(&'static str, String)> {
    order.map(|order| ("--quaternion", typed(order)))
}

/// Refuses a flag and its value that say how `what` is written, where nothing that was read has one.
pub(crate) fn check_used(flag: Option<(&str, String)>, is_used: bool, what: &str) -> Result<(), Error> {
    let Some((flag, value)) = flag.filter(|_| !is_used) else { return Ok(()) };
    let rule = format!("is for {what}, and none is read");
    Err(Error::input(flag, &value, &rule, "leave it out, or name the columns by --columns"))
}

/// Says that --quaternion changes nothing where the names of the columns, by which they are read in any order, tell the scalar.
pub(crate) fn note_order(is_given: bool, of_file: &Convention, name: &str) {
    if is_given && of_file.quaternion.is_some() {
        tell(
            "note",
            &format!("{name}: --quaternion has no effect, as the names of its columns tell the scalar"),
        );
    }
}

/// How far a rotation matrix may be from one.
const ORTHOGONAL: f64 = 0.1;

/// Refuses matrices that mirror, or are no rotations.
pub(crate) fn check_matrices(matrices: &[[f64; 9]], times: &[f64], name: &str) -> Result<(), Error> {
    for (m, t) in matrices.iter().zip(times) {
        let m = Matrix3::from_row_slice(m);
        let determinant = m.determinant();
        let rule = if determinant < 0.0 {
            format!(
                "the matrix at {t} s has the determinant {determinant:.4}: one of its frames is left-handed"
            )
        } else {
            let off = ((m.transpose() * m) / (m.norm_squared() / 3.0) - Matrix3::identity()).amax();
            if off <= ORTHOGONAL {
                continue;
            }
            format!("the matrix at {t} s is not a rotation: M^T M differs from a multiple of 1 by {off:.2e}")
        };
        return Err(Error::input(name, "", &rule, "write rotation matrices with the determinant 1"));
    }
    Ok(())
}

impl AttitudeArguments {
    /// [`check_used`] of the flags of one form of attitudes, where these forms were read.
    pub(crate) fn check_forms(&self, has_quaternions: bool, has_angles: bool) -> Result<(), Error> {
        check_used(self.given_of_order(), has_quaternions, "a quaternion")?;
        check_used(self.given_of_angles(), has_angles, "a triple of Euler angles")
    }

    /// [`note_order`] of a file.
    pub(crate) fn note_order(&self, of_file: &Convention, name: &str) {
        note_order(self.quaternion.is_some(), of_file, name);
    }

    /// The first flag that is given, and its value.
    pub(crate) fn given(&self) -> Option<(&'static str, String)> {
        self.given_of_order().or_else(|| self.given_of_direction()).or_else(|| self.given_of_angles())
    }

    /// The flag of the place of the scalar, and its value.
    fn given_of_order(&self) -> Option<(&'static str, String)> {
        of_order(self.quaternion)
    }

    /// The flag of the direction, and its value.
    pub(crate) fn given_of_direction(&self) -> Option<(&'static str, String)> {
        self.attitude.map(|to| ("--attitude", typed(to)))
    }

    /// The first flag of Euler angles that is given, and its value.
    fn given_of_angles(&self) -> Option<(&'static str, String)> {
        let euler = self.euler.map(|(sequence, turns)| {
            let behind = if turns == Turns::Extrinsic { ":extrinsic" } else { "" };
            ("--euler", format!("{sequence}{behind}"))
        });
        let unit = self.angle_unit.map(|unit| ("--angle-unit", unit.to_string()));
        euler.or(unit)
    }

    /// Angles in columns of the names roll, pitch and yaw, in the order of the sequence that is stated.
    ///
    /// # Errors
    /// A unit of angles beside another one in the header, a sequence that turns about one axis twice.
    pub(crate) fn order(&self, found: &mut FoundTrajectory) -> Result<(), Error> {
        if let (Some(named), Some(stated)) = (found.claims.angle_unit, self.angle_unit)
            && named != stated
        {
            let rule = format!("the header says {named}");
            return Err(Error::input("--angle-unit", &stated.to_string(), &rule, "drop one of the two"));
        }
        let (Some(_), Some((sequence, _))) = (found.claims.angle_axes, self.euler) else { return Ok(()) };
        let axes = sequence.axes();
        if axes[0] == axes[2] {
            let rule = "turns about one axis twice, while roll, pitch and yaw are angles about x, y and z";
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
        // columns that are named w, x, y and z are read by their names, in whatever order they stand
        claims.quaternion = claims.quaternion.or(self.quaternion.map(Into::into));
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
