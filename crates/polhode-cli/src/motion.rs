//! `polhode motion`: what kind of free motion a body makes.

use std::path::PathBuf;

use clap::Args;
use polhode::body::Point;
use polhode::flow::{FreeMotion, GyrostatMotion};
use polhode::num::Dd;
use polhode_files::error::Error;
use polhode_pages::character::{Quantity, quantities, steady_spins, with_wheels};
use polhode_pages::output::emit;
use polhode_pages::table::{Cell, Column, Format, Table, row};

use crate::flags::body::BodyArguments;
use crate::flags::start::StartArguments;
use crate::flags::wheel::WheelArguments;

const USAGE: &str = "polhode motion <BODY> [START] [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>
  START: --omega <wx,wy,wz> | --momentum-body <mx,my,mz> | ...
         and --attitude <w,x,y,z> | --angles <phi,theta,psi> | ...,
         or --periods <P_phi,P_psi> --mode <lam|sam>";

const EXAMPLES: &str = "Examples:
  polhode motion --body toutatis
  polhode motion --moments 1,2,3 --omega 0,1,0 --format json
  polhode motion --moments 0.61,0.965,1 --periods 27.38h,263h --mode sam \\
    --pole 250,-75 --phases 152,14 --angle-unit deg
  polhode motion --body toutatis --to-frame icrf
  polhode motion --moments 10,12,15 --wheel 0,0,1,0.05@3000rpm \\
    --omega 0.1,0.02,0.3";

/// Mode, periods, stability and distance to the separatrix of torque-free motion
///
/// In free motion the angular momentum L goes round one principal axis of the
/// body, and this axis goes round L: the axis of the smallest moment (long-axis
/// mode) or of the largest (short-axis mode). The table has these quantities:
///
///   mode                 long-axis, short-axis, separatrix or steady
///   modulus, complement  k of the elliptic functions, and 1 - k^2, which is 0 on
///                        the separatrix
///   polhode_period       L once round the axis, seen from the body; P_psi of
///                        light curves
///   precession_period    the axis once round L, mean; P_phi of light curves;
///                        precession_rate is 2 pi over it
///   combined_period      P_1 of light curves: 1/P_1 = 1/P_phi + 1/P_psi in
///                        long-axis mode, 1/P_phi - 1/P_psi in short-axis mode
///   nutation_period      the axis from its least angle to L back to the least
///   spin                 2E/|L|, the component of omega along L
///   separatrix_distance  (|L|^2/2E - I_middle)/I_middle, negative in long-axis
///                        mode
///   energy_ratio         energy over the least energy with this L
///   damping              time in which inner friction with the loss 1 lets the
///                        energy above that of the steady spin fall by a factor
///                        of e; for a smaller loss divide by it
///   axis                 of the mode or of a steady spin: long (smallest moment),
///                        middle or short, or where moments are equal, equatorial
///                        or any; axis_x and so on, its direction in body axes
///   stability            of a steady spin, with the growth_rate of deviations
///   theta_min, _max      least and largest angle between the axis and L
///   lambda, beta         longitude and latitude of L in space
///   phi, psi             Euler angles at the start (z-x-z, z along L and along
///                        the axis)
///   q_w, omega_body_x    and so on, attitude and angular velocity at the start
///   frame, epoch         axes of space, from --frame or from the catalogue
///                        (unknown: the attitude at the start is the identity),
///                        and the date of the start
///
/// For a body with wheels the table has instead:
///
///   period               period of the angular velocity in the body
///   turn_per_period      angle of the turn about L in one period
///   energy               1/2 w.I w; the energies of the unstable steady spins
///                        with the same |L| are those of the separatrices
///   steady_spins         their number with this |L|; --steady lists them
///
/// csv and json have angles in rad and times in s. --to-frame gives the angles in
/// other axes of space.
#[derive(Args, Clone, Debug)]
#[command(verbatim_doc_comment, override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Motion {
    #[command(flatten)]
    pub(crate) body: BodyArguments,
    #[command(flatten)]
    wheels: WheelArguments,
    #[command(flatten)]
    pub(crate) start: StartArguments,
    /// With wheels: list only the steady spins with the |L| of the start, with energy and stability
    #[arg(long, help_heading = "Output")]
    steady: bool,
    /// How the quantities are printed [default: table on a terminal, csv otherwise]
    #[arg(long, value_enum, help_heading = "Output")]
    format: Option<Format>,
    /// Write to this file instead of standard output; its ending names the format: .csv, .json or .txt
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
}

impl Motion {
    pub(crate) fn run(&self) -> Result<(), Error> {
        self.start.check_angles(false, false)?;
        self.body.check_size(self.wheels.is_any())?;
        let (body, of_file) = self.body.free()?;
        let body = self
            .wheels
            .carried(body, of_file, 0.0, |held| self.start.inside(held, 0.0, self.body.published_start()))?;
        let published = self.body.published_start();
        let start = self.start.inside(&body, 0.0, published.clone())?;
        let format = Format::of(self.format, self.out.as_deref())?;
        if !body.wheels().is_empty() {
            let motion = GyrostatMotion::from_point(&body, start);
            return self.of_wheels(
                &motion.map_err(|error| Error::Input(format!("--wheel: {error}")))?,
                &start,
                format,
            );
        }
        if self.steady {
            let rule = "lists the steady spins of a body with wheels";
            return Err(Error::input(
                "--steady",
                "",
                rule,
                "without wheels these are the spins about the principal axes",
            ));
        }
        let motion = FreeMotion::from_point(body.inertia(), start);
        let quantities = quantities(&body, &start, &motion);
        let mut quantities = quantities.map_err(|error| Error::Input(format!("--omega: {error}")))?;
        let known = self.start.frame_of_motion(published.as_ref()).map(|frame| frame.name());
        let published = published.filter(|_| !self.start.has_attitude());
        let of_body =
            published.as_ref().map(|found| found.orientation.map_or("unknown", |known| known.frame));
        let frame = known.or(of_body);
        let epoch = published.and_then(|found| found.orientation?.epoch);
        quantities.push(("frame", "", "", "axes of space", frame.into()));
        quantities.push(("epoch", "", "", "of the start", epoch.into()));
        let text = if format == Format::Table { sheet(quantities) } else { format.write(&wide(quantities)) };
        emit(&text, self.out.as_deref())
    }
}

impl Motion {
    /// The quantities of a motion with wheels, or its steady spins; on a terminal both.
    fn of_wheels(&self, motion: &GyrostatMotion, start: &Point<Dd>, format: Format) -> Result<(), Error> {
        let (quantities, spins) = (with_wheels(motion, start), steady_spins(&motion.steady_spins()));
        let text = match (format, self.steady) {
            (Format::Table, true) => spins.terminal(),
            (Format::Table, false) => format!("{}\n{}", sheet(quantities), spins.terminal()),
            (_, true) => format.write(&spins),
            (_, false) => format.write(&wide(quantities)),
        };
        emit(&text, self.out.as_deref())
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
