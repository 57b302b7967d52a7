//! `polhode motion`: what kind of free motion a body makes.

use std::path::PathBuf;

use clap::Args;
use nalgebra::Vector3;
use polhode::body::{Body, Point};
use polhode::flow::{Character, FreeMotion, Mode, Stability};
use polhode::num::Dd;
use polhode_files::error::Error;
use polhode_pages::output::emit;
use polhode_pages::table::{Cell, Column, Format, Table, row};

use crate::flags::body::BodyArguments;
use crate::flags::start::StartArguments;

const USAGE: &str = "polhode motion <BODY> [START] [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  START: --omega <wx,wy,wz> | --momentum-body <mx,my,mz> | ...
         and --attitude <w,x,y,z> | --angles <phi,theta,psi> | ...,
         or --periods <P_phi,P_psi> --mode <lam|sam>";

const EXAMPLES: &str = "Examples:
  polhode motion --body toutatis
  polhode motion --moments 1,2,3 --omega 0,1,0 --format json
  polhode motion --moments 0.61,0.965,1 --periods 27.38h,263h --mode sam \\
    --pole 250,-75 --phases 152,14 --angle-unit deg";

/// Mode, periods, stability and distance to the separatrix of torque-free motion
///
/// In free motion the angular momentum L goes round one principal axis of the
/// body, and this axis goes round L: the axis of the smallest moment (long-axis
/// mode) or of the largest (short-axis mode). The table has these quantities:
///
///   mode                 long-axis, short-axis, separatrix or steady
///   polhode_period       L once round the axis, seen from the body; P_psi of
///                        light curves
///   precession_period    the axis once round L, mean; P_phi of light curves
///   combined_period      P_1 of light curves: 1/P_1 = 1/P_phi + 1/P_psi in
///                        long-axis mode, 1/P_phi - 1/P_psi in short-axis mode
///   nutation_period      the axis towards L and back
///   separatrix_distance  (|L|^2/2E - I_middle)/I_middle, negative in long-axis
///                        mode
///   energy_ratio         energy over the least energy with this L
///   stability            of a steady spin, with the growth_rate of deviations
///   theta_min, _max      least and largest angle between the axis and L
///   lambda, beta         longitude and latitude of L in space
///   phi, psi             Euler angles at the start (z-x-z, z along L and along
///                        the axis)
///   frame, epoch         of a catalogued body: the axes of space (unknown: the
///                        attitude at the start is the identity) and the date
///
/// csv and json have angles in rad and times in s.
#[derive(Args, Clone, Debug)]
#[command(verbatim_doc_comment, override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Motion {
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    pub(crate) start: StartArguments,
    /// How the quantities are printed [default: table on a terminal, csv otherwise]
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output; its ending names the format: .csv, .json or .txt
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

/// Name, symbol of the field, unit, meaning and value of a quantity.
type Quantity = (&'static str, &'static str, &'static str, &'static str, Cell);

impl Motion {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let body = self.body.free()?;
        let published = self.body.published_start();
        let start = self.start.inside(&body, published.clone())?;
        let motion = FreeMotion::from_point(body.inertia(), start);
        let character = motion.character().map_err(|error| Error::Input(format!("--omega: {error}")))?;
        let mut quantities = quantities(&body, &start, &motion, &character);
        let published = published.filter(|_| !self.start.has_attitude());
        let frame = published.as_ref().map(|found| found.orientation.map_or("unknown", |known| known.frame));
        let epoch = published.and_then(|found| found.orientation?.epoch);
        quantities.push(("frame", "", "", "axes of space, of the catalogue", frame.into()));
        quantities.push(("epoch", "", "", "of the start, UTC", epoch.into()));
        let format = Format::of(self.format, self.out.as_deref())?;
        let text = if format == Format::Table { sheet(quantities) } else { format.write(&wide(quantities)) };
        emit(&text, self.out.as_deref())
    }
}

fn quantities(body: &Body, start: &Point<Dd>, motion: &FreeMotion, character: &Character) -> Vec<Quantity> {
    let (tumbling, spin) = (motion.tumbling(), motion.pure_spin());
    let tilt = motion.tilt_range();
    let (axis_name, axis) = axis(body, motion, character);
    let precession_period = character.precession_rate.map(|rate| core::f64::consts::TAU / rate.abs());
    // the frequency of the light curve: the turn about L seen with the turn about the axis
    let sign = if character.mode == Mode::LongAxis { 1.0 } else { -1.0 };
    let combined = tumbling.map(|found| 1.0 / (1.0 / found.precession_period + sign / found.rotation_period));
    let moments = body.inertia().principal_moments();
    let largest = moments.iter().fold(0.0_f64, |most, moment| most.max(*moment));
    let state = body.leave(start);
    let momentum = state.momentum_body.norm();
    let omega = body.omega_of(start);
    let q = state.attitude.components();
    let pole = tumbling.map(|found| found.pole);
    let angles = tumbling.map(|found| found.angles);
    vec![
        ("mode", "", "", "long-axis, short-axis, separatrix or steady", character.mode.name().into()),
        ("modulus", "k", "", "of the elliptic functions", character.parameter.map(|k| k.sqrt() + 0.0).into()),
        ("complement", "1-k^2", "", "", character.complement.into()),
        (
            "polhode_period",
            "P_psi",
            "s",
            "L once round the axis in the body",
            character.polhode_period.into(),
        ),
        ("nutation_period", "", "s", "the axis nods towards L and back", character.nutation_period.into()),
        ("precession_period", "P_phi", "s", "mean, the axis once round L", precession_period.into()),
        ("precession_rate", "", "rad/s", "mean, positive about L", character.precession_rate.into()),
        ("spin", "2E/|L|", "rad/s", "constant part of omega along L", character.spin.into()),
        (
            "separatrix_distance",
            "",
            "",
            "(|L|^2/2E - I_middle)/I_middle, 0 on the separatrix",
            character.separatrix_distance.into(),
        ),
        (
            "combined_period",
            "P_1",
            "s",
            "1/P_1 = 1/P_phi + 1/P_psi (long-axis) or - (short)",
            combined.into(),
        ),
        (
            "energy_ratio",
            "E/E_0",
            "",
            "to the least energy with this L",
            (largest * character.spin / momentum).into(),
        ),
        ("axis", "", "", "of the mode or of the spin", axis_name.into()),
        ("axis_x", "", "", "unit vector, body axes", axis.map(|axis| axis.x + 0.0).into()),
        ("axis_y", "", "", "", axis.map(|axis| axis.y + 0.0).into()),
        ("axis_z", "", "", "", axis.map(|axis| axis.z + 0.0).into()),
        ("stability", "", "", "of a steady spin", spin.map(|spin| spin.stability.name()).into()),
        (
            "growth_rate",
            "",
            "rad/s",
            "of deviations from it, e-fold",
            spin.map(|spin| spin.growth_rate).into(),
        ),
        ("theta_min", "theta", "rad", "least angle of the axis to L", tilt.map(|tilt| tilt[0]).into()),
        ("theta_max", "theta", "rad", "largest", tilt.map(|tilt| tilt[1]).into()),
        (
            "lambda",
            "lambda",
            "rad",
            "longitude of L in space, 0 to 2 pi",
            pole.map(|pole| pole[0].rem_euclid(core::f64::consts::TAU)).into(),
        ),
        ("beta", "beta", "rad", "latitude of L in space", pole.map(|pole| pole[1]).into()),
        ("phi", "phi_0", "rad", "of the axis about L at the start", angles.map(|angles| angles[0]).into()),
        (
            "psi",
            "psi_0",
            "rad",
            "of the body about the axis at the start",
            angles.map(|angles| angles[1]).into(),
        ),
        ("q_w", "", "", "attitude at the start, body to space", q[0].into()),
        ("q_x", "", "", "", q[1].into()),
        ("q_y", "", "", "", q[2].into()),
        ("q_z", "", "", "", q[3].into()),
        ("omega_body_x", "", "rad/s", "angular velocity at the start", omega.x.into()),
        ("omega_body_y", "", "rad/s", "", omega.y.into()),
        ("omega_body_z", "", "rad/s", "", omega.z.into()),
    ]
}

/// The axis of the mode or of a steady spin by its place among the moments, and its direction in body axes.
fn axis(
    body: &Body,
    motion: &FreeMotion,
    character: &Character,
) -> (Option<&'static str>, Option<Vector3<f64>>) {
    const NAMES: [&str; 3] = ["long", "middle", "short"];
    let principal = |rank: usize| Some(body.inertia().principal_axes() * Vector3::ith(rank, 1.0));
    if let Some(spin) = motion.pure_spin() {
        let [least, _, most] = body.inertia().principal_moments();
        let name = match spin.stability {
            Stability::Neutral if least == most => "any",
            Stability::Neutral => "equatorial",
            _ => NAMES[spin.rank],
        };
        return (Some(name), Some(spin.axis));
    }
    match character.mode {
        Mode::LongAxis => (Some(NAMES[0]), principal(0)),
        Mode::ShortAxis => (Some(NAMES[2]), principal(2)),
        _ => (Some(NAMES[1]), principal(1)),
    }
}

/// One row with a column for each.
fn wide(quantities: Vec<Quantity>) -> Table {
    let column = |(name, _, unit, meaning, _): &Quantity| Column::new(name, unit, meaning);
    let mut table =
        Table::new("motion", "Character of a free motion.", quantities.iter().map(column).collect());
    table.push(quantities.into_iter().map(|(.., value)| value));
    table
}

/// One line a quantity; what the motion does not have is left out.
fn sheet(quantities: Vec<Quantity>) -> String {
    let columns = vec![
        Column::new("quantity", "", ""),
        Column::new("symbol", "", ""),
        Column::new("value", "", "").digits(7),
        Column::new("unit", "", ""),
        Column::new("also", "", ""),
    ];
    let mut table = Table::new("motion", "Character of a free motion.", columns);
    for (name, symbol, unit, _, value) in quantities {
        if value != Cell::Empty {
            let also = also(&value, unit);
            table.push(row![name, symbol, value, unit, also]);
        }
    }
    table.terminal()
}

/// The same in the unit that people say: hours and days, degrees.
fn also(value: &Cell, unit: &str) -> String {
    let Cell::Number(value) = *value else { return String::new() };
    match unit {
        "s" if value.abs() >= 2.0 * 86_400.0 => format!("{:.4} d", value / 86_400.0),
        "s" if value.abs() >= 3600.0 => format!("{:.4} h", value / 3600.0),
        "rad" => format!("{:.4} deg", value * (180.0 / core::f64::consts::PI)),
        _ => String::new(),
    }
}
