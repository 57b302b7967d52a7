//! The flags that name the start of a motion: attitude and spin, in the quantities that people have.

use clap::Args;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use polhode::body::{Body, Point, State};
use polhode::num::Dd;
use polhode::rotation::{CelestialFrame, EulerSequence, Quat, Vec3};
use polhode_files::error::{Error, tell, warn};
use polhode_files::instant::seconds_in;
use polhode_files::numbers::{number, numbers, quaternion, turn};
use polhode_files::text::short;

use crate::flags::body::{BodyArguments, PublishedStart, note_density};
use crate::flags::tumbling::TumblingArguments;

/// Attitude and spin at the start.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Start")]
pub(crate) struct StartArguments {
    /// Angular velocity at the start, body axes, rad/s or --rate-unit [default: that of the catalogue's body]
    #[arg(long, value_name = "wx,wy,wz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    omega: Option<[f64; 3]>,
    /// Unit of --omega: rpm, or rad, deg or rev per s, min, h or d, as deg/s [default: rad/s]
    #[arg(long, value_name = "UNIT", value_parser = rate_unit, requires = "omega")]
    rate_unit: Option<Factor>,
    /// Angular momentum at the start, wheels included, in place of --omega: body axes, kg m^2/s
    #[arg(long, value_name = "mx,my,mz", value_parser = numbers::<3>, allow_hyphen_values = true, conflicts_with = "omega")]
    momentum_body: Option<[f64; 3]>,
    /// Angular momentum at the start, wheels included, in place of --omega: axes of space, kg m^2/s
    #[arg(long, value_name = "Lx,Ly,Lz", value_parser = numbers::<3>, allow_hyphen_values = true,
          conflicts_with_all = ["omega", "momentum_body"])]
    momentum_space: Option<[f64; 3]>,
    /// Attitude at the start: quaternion from body to space axes, scalar first; it is divided by its norm [default: that of the catalogue's body, else 1,0,0,0]
    #[arg(long, value_name = "w,x,y,z", value_parser = quaternion, allow_hyphen_values = true)]
    attitude: Option<[f64; 4]>,
    /// Attitude at the start as Euler angles in the sequence of --euler, rad or --angle-unit
    #[arg(long, value_name = "phi,theta,psi", value_parser = numbers::<3>, allow_hyphen_values = true, conflicts_with = "attitude")]
    angles: Option<[f64; 3]>,
    /// Attitude at the start as a rotation matrix from body to space axes, nine entries by rows
    #[arg(long, value_name = "r11,r12,...,r33", value_parser = rotation, allow_hyphen_values = true,
          conflicts_with_all = ["attitude", "angles"])]
    rotation: Option<TypedRotation>,
    /// Sequence of intrinsic Euler angles, each about an axis already turned, such as zyx [default: zxz]; where it is given, propagate also prints the angles phi, theta, psi, rad
    #[arg(long, value_name = "SEQUENCE", value_parser = sequence)]
    pub(crate) euler: Option<EulerSequence>,
    /// Unit of the angles on the command line: rad or deg [default: rad]
    #[arg(long, value_name = "UNIT", value_parser = angle_unit)]
    angle_unit: Option<Factor>,
    /// Axes of space to which the given attitude or pole refers: ecliptic (J2000) or icrf [default: those of the catalogue's body]
    #[arg(long, value_name = "FRAME", value_parser = frame)]
    frame: Option<CelestialFrame>,
    /// Axes of space of the results, ecliptic or icrf: the start is transformed to them, and --orbit-plane and all else that is given in space refers to them [default: those of the start]
    #[arg(long, value_name = "FRAME", value_parser = frame)]
    to_frame: Option<CelestialFrame>,
    #[command(flatten)]
    tumbling: TumblingArguments,
}

pub(crate) fn frame(text: &str) -> Result<CelestialFrame, String> {
    CelestialFrame::named(text).ok_or_else(|| format!("unknown frame '{text}'; write ecliptic or icrf"))
}

/// What a unit is in rad or rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Factor(pub(crate) f64);

fn angle(name: &str) -> Option<f64> {
    match name {
        "rad" => Some(1.0),
        "deg" | "°" => Some(core::f64::consts::PI / 180.0),
        "rev" => Some(core::f64::consts::TAU),
        _ => None,
    }
}

pub(crate) fn angle_unit(text: &str) -> Result<Factor, String> {
    let known = angle(text).filter(|_| text != "rev").map(Factor);
    known.ok_or_else(|| format!("unknown unit of angles '{text}'; write rad or deg"))
}

/// A number with the unit behind it, as in `example`.
pub(crate) fn with_unit(
    text: &str,
    unit: impl Fn(&str) -> Result<Factor, String>,
    example: &str,
) -> Result<f64, String> {
    // where the unit begins; the e of an exponent has a digit or a sign behind it
    let begins = |(at, c): (usize, char)| {
        let exponent = matches!(c, 'e' | 'E')
            && text[at + 1..].starts_with(|next: char| next.is_ascii_digit() || matches!(next, '+' | '-'));
        ((c.is_alphabetic() || c == '°') && !exponent).then_some(at)
    };
    let Some(at) = text.char_indices().find_map(begins) else {
        return Err(format!("'{text}' has no unit; write it as {example}"));
    };
    Ok(number(text[..at].trim())? * unit(&text[at..])?.0)
}

pub(crate) fn rate_unit(text: &str) -> Result<Factor, String> {
    if text == "rpm" {
        return Ok(Factor(core::f64::consts::PI / 30.0));
    }
    let parts = text.split_once('/').and_then(|(over, under)| Some((angle(over)?, seconds_in(under)?)));
    let unit = parts.map(|(angle, seconds)| Factor(angle / seconds));
    unit.ok_or_else(|| format!("unknown unit of rates '{text}'; write rad/s, deg/s, deg/d, rev/h or rpm"))
}

pub(crate) fn sequence(text: &str) -> Result<EulerSequence, String> {
    text.parse::<EulerSequence>().map_err(|error| error.to_string())
}

/// A matrix as typed and the rotation nearest to it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TypedRotation {
    turn: UnitQuaternion<f64>,
    /// How far the matrix is from one, as typed.
    deviation: f64,
}

/// Beyond this a matrix is not that of a rotation with few digits.
const MOST_DEVIATION: f64 = 1e-3;
/// Beyond this its digits say less of an attitude than most users would think.
const NOTED_DEVIATION: f64 = 1e-6;

fn rotation(text: &str) -> Result<TypedRotation, String> {
    let matrix = Matrix3::from_row_slice(&numbers::<9>(text)?);
    let deviation = (matrix.transpose() * matrix - Matrix3::identity()).amax();
    if deviation.is_nan() || deviation > MOST_DEVIATION {
        return Err(format!(
            "its columns are not orthonormal: R^T R differs from 1 by {deviation:.1e}, more than {MOST_DEVIATION:e} for rounding"
        ));
    }
    if matrix.determinant() < 0.0 {
        return Err("its determinant is -1, which is a reflection; change the sign of an axis".into());
    }
    // the factor of the polar decomposition, by Newton and Schulz; squares of the deviation
    let nearest = (0..5).fold(matrix, |r, _| r * (Matrix3::identity() * 1.5 - r.transpose() * r * 0.5));
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(nearest));
    Ok(TypedRotation { turn, deviation })
}

impl StartArguments {
    /// Whether the attitude at the start is given, so that a published one does not count.
    pub(crate) fn has_attitude(&self) -> bool {
        self.attitude.is_some()
            || self.rotation.is_some()
            || self.angles.is_some()
            || self.tumbling.is_given()
    }

    /// Refuses a unit of angles and a sequence of them that no flag uses; whether a command uses either elsewhere. Angles without a unit
    /// that are none of rad, as it seems, are told.
    pub(crate) fn check_angles(&self, uses_unit: bool, uses_sequence: bool) -> Result<(), Error> {
        let has_angles = self.angles.is_some();
        if let Some(Factor(unit)) = self.angle_unit
            && !(uses_unit || has_angles || self.tumbling.has_angles())
        {
            let value = if unit == 1.0 { "rad" } else { "deg" };
            let rule = "is the unit of angles, and none are given";
            let remedy = "leave it out, or give --angles, --pole or --phases; --rate-unit is that of --omega";
            return Err(Error::input("--angle-unit", value, rule, remedy));
        }
        if let Some(sequence) = self.euler
            && !(uses_sequence || has_angles)
        {
            let (rule, remedy) =
                ("is the sequence of angles, and none are given", "leave it out, or give --angles");
            return Err(Error::input("--euler", &sequence.to_string(), rule, remedy));
        }
        let mut typed = self.angles.iter().flatten().chain(self.tumbling.angles());
        if let (None, Some(angle)) =
            (self.angle_unit, typed.find(|angle| angle.abs() > core::f64::consts::TAU))
        {
            let angle = short(*angle);
            warn(&format!(
                "the angle {angle} is taken as rad and exceeds a whole turn; for degrees give --angle-unit deg"
            ));
        }
        Ok(())
    }

    /// Refuses axes of space beside the catalogue's orbit about `primary`, which has its own.
    pub(crate) fn check_no_frame(&self, primary: &str) -> Result<(), Error> {
        let named = self.frame.map(|frame| ("--frame", frame));
        let Some((flag, frame)) = named.or(self.to_frame.map(|frame| ("--to-frame", frame))) else {
            return Ok(());
        };
        let rule = format!("the gravity gradient of {primary} acts, on an orbit in other axes");
        let remedy = "leave it out, or give the orbit in these axes by --orbit and --orbit-plane";
        Err(Error::input(flag, frame.name(), &rule, remedy))
    }

    /// Says what the attitude refers to where it is that of the catalogue, and which density a mesh has.
    pub(crate) fn note(&self, body: &BodyArguments) {
        if let Some(file) = body.mesh() {
            note_density(file);
        }
        if let Some(published) = body.published_start().filter(|_| !self.has_attitude()) {
            let turned = self.to_frame.map(|to| format!("; turned to {}", to.name()));
            tell("note", &format!("{}{}", published.known, turned.unwrap_or_default()));
        }
    }

    /// The exact start of `body` at the time `t`, s, in the solver frame; attitude and spin that are not given are those that are `published` with the
    /// body, if they are.
    pub(crate) fn inside(
        &self,
        body: &Body,
        t: f64,
        published: Option<PublishedStart>,
    ) -> Result<Point<Dd>, Error> {
        if let (Some(given), Some(known)) =
            (self.frame, published.as_ref().and_then(|start| start.orientation))
            && !self.has_attitude()
            && given.name() != known.frame
        {
            let rule = format!("the start of the catalogue is in the frame {}", known.frame);
            return Err(Error::input("--frame", given.name(), &rule, "give --to-frame to turn it"));
        }
        let mut point = self.as_given(body, t, &published)?;
        let Some(to) = self.to_frame else { return Ok(point) };
        let Some(from) = self.frame_of_start(published.as_ref()) else {
            return Err(Error::input(
                "--to-frame",
                to.name(),
                "needs the axes that the start refers to",
                "give --frame ecliptic or icrf, too",
            ));
        };
        point.attitude = Quat::<Dd>::of(from.turn_to(to).into()).normalized() * point.attitude;
        Ok(point)
    }

    /// The axes of space that the start refers to, if they are known.
    fn frame_of_start(&self, published: Option<&PublishedStart>) -> Option<CelestialFrame> {
        let of_body = || published.filter(|_| !self.has_attitude())?.orientation;
        self.frame.or_else(|| CelestialFrame::named(of_body()?.frame))
    }

    /// The axes of space that the motion is in, if they are known.
    pub(crate) fn frame_of_motion(&self, published: Option<&PublishedStart>) -> Option<CelestialFrame> {
        self.to_frame.or_else(|| self.frame_of_start(published))
    }

    fn as_given(&self, body: &Body, t: f64, published: &Option<PublishedStart>) -> Result<Point<Dd>, Error> {
        let angle_unit = self.angle_unit();
        if let Some(elements) = self.tumbling.elements(angle_unit)? {
            if !body.wheels().is_empty() {
                let rule = "these are elements of the motion of a body without wheels";
                return Err(Error::input("--periods", "", rule, "give --omega"));
            }
            return elements.point(body.inertia()).map_err(|error| self.tumbling.refused(&error));
        }
        let attitude = match (self.attitude(angle_unit), published) {
            (Some(attitude), _) => attitude,
            (None, Some(published)) => Quat::from_components(published.attitude),
            (None, None) => Quat::identity(),
        };
        let of_wheels = body.momentum_of_wheels_at(t);
        let from_momentum = |flag: &str, momentum_body: Vec3<f64>| {
            let momentum_body = momentum_body - of_wheels.into();
            let start = body.enter(&State { attitude, momentum_body });
            start.map_err(|error| Error::Input(format!("{flag}: {error}")))
        };
        if let Some(momentum) = self.momentum_body {
            return from_momentum("--momentum-body", Vec3(momentum));
        }
        if let Some(momentum) = self.momentum_space {
            let turn = turn(attitude.components()).unwrap_or_default();
            let turn = Quat::<Dd>::of(turn.into()).normalized();
            let momentum = turn.rotate_back(Vec3::of(Vec3(momentum)));
            return from_momentum("--momentum-space", momentum.map(Dd::hi));
        }
        let unit = self.rate_unit.map_or(1.0, |Factor(unit)| unit);
        let Some(omega) =
            self.omega.map(|omega| omega.map(|w| w * unit)).or(published.as_ref().map(|start| start.omega))
        else {
            return Err(Error::Input(
                "--omega: missing; give --omega wx,wy,wz, --momentum-body, --momentum-space or --periods; bodies of the catalogue have a start"
                    .into(),
            ));
        };
        let start = body.enter_omega(attitude, Vec3(omega));
        start.map_err(|error| Error::Input(format!("--omega: {error}")))
    }

    /// The unit of angles that are typed, rad.
    pub(crate) fn angle_unit(&self) -> f64 {
        self.angle_unit.map_or(1.0, |Factor(unit)| unit)
    }

    /// The attitude that was typed, of any norm but zero.
    fn attitude(&self, angle_unit: f64) -> Option<Quat<f64>> {
        if let Some(components) = self.attitude {
            return Some(Quat::from_components(components));
        }
        if let Some(typed) = self.rotation {
            if typed.deviation > NOTED_DEVIATION {
                warn(&format!(
                    "--rotation: R^T R differs from 1 by {:.1e}; the nearest rotation is taken",
                    typed.deviation
                ));
            }
            return Some(typed.turn.into());
        }
        let angles = self.angles?.map(|angle| angle * angle_unit);
        Some(self.euler.unwrap_or_default().attitude(angles).into())
    }
}
