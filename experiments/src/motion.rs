//! `polhode motion`: what kind of free motion a body makes.

use std::path::PathBuf;

use clap::Args;
use polhode::flow::FreeMotion;

use crate::body_arguments::{BodyArguments, StartArguments};
use crate::error::Error;
use crate::files::emit;
use crate::table::{Column, Format, Table, row};

const USAGE: &str = "polhode motion <BODY> --omega <wx,wy,wz> [OPTIONS]
  BODY:  --moments <I1,I2,I3> | --inertia <Ixx,...,Iyz> | --body <NAME>";

const EXAMPLES: &str = "Examples:
  polhode motion --moments 1,2,3 --omega 0.4,1,-0.3
  polhode motion --body racket --omega 0.3,15,0.2 --format json";

/// Mode, periods and distance to the separatrix of torque-free motion
///
/// The angular momentum circulates in the body about the axis of the smallest moment (long-axis mode) or of the largest
/// (short-axis mode). polhode_period: once round the polhode. nutation_period: that axis nods towards the angular momentum L and
/// back. precession_period: mean time in which it goes once round L. spin: 2E/|L|. separatrix_distance: 0 on the separatrix,
/// negative in long-axis mode.
#[derive(Args, Clone, Debug)]
#[command(override_usage = USAGE, after_help = EXAMPLES)]
pub(crate) struct Motion {
    #[command(flatten)]
    body: BodyArguments,
    #[command(flatten)]
    start: StartArguments,
    /// How rows are printed: table on a terminal, csv otherwise
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Motion {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let body = self.body.free()?;
        let motion = FreeMotion::from_point(body.inertia(), self.start.inside(&body)?);
        let character = motion.character().map_err(|error| Error::Input(format!("--omega: {error}")))?;
        let mode = character.mode.name();
        let column = Column::new;
        let mut table = Table::new(
            "motion",
            "Character of a free motion.",
            vec![
                column("mode", "", "long-axis, short-axis, separatrix or steady"),
                column("modulus", "", "k of the elliptic functions").digits(6),
                column("complement", "", "1 - k^2").digits(6),
                column("polhode_period", "s", "once round the polhode").heading("polhode period").digits(6),
                column("nutation_period", "s", "the axis nods once").heading("nutation period").digits(6),
                column("precession_period", "s", "mean time of the axis once round L")
                    .heading("precession period")
                    .digits(6),
                column("precession_rate", "rad/s", "mean rate of the axis round L").hidden(),
                column("spin", "rad/s", "2E/|L|").digits(6),
                column("separatrix_distance", "", "(|L|^2/2E - I_middle)/I_middle, 0 on the separatrix")
                    .heading("to separatrix")
                    .digits(6),
            ],
        );
        table.push(row![
            mode,
            character.parameter.map(f64::sqrt),
            character.complement,
            character.polhode_period,
            character.nutation_period,
            character.precession_rate.map(|rate| std::f64::consts::TAU / rate.abs()),
            character.precession_rate,
            character.spin,
            character.separatrix_distance,
        ]);
        emit(&Format::or_default(self.format, self.out.is_some()).write(&table), self.out.as_deref())
    }
}
