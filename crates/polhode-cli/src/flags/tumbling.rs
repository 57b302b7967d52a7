//! The flags that name the start of a tumbling body by what its light curve tells.

use clap::{Args, ValueEnum};
use polhode::flow::{Mode, TumblingElements, TumblingError};
use polhode_files::error::Error;
use polhode_files::instant::positive_duration;
use polhode_files::numbers::numbers;

/// Periods, mode and angles of a tumbling body.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Start of a tumbling body")]
pub(crate) struct TumblingArguments {
    /// Start by periods in place of --omega: P_phi of the precession about the angular momentum and P_psi of the rotation about the body axis of --mode, s or with a unit: 27.38h,263h
    #[arg(long, value_name = "P_phi,P_psi", value_parser = periods, requires = "mode",
          conflicts_with_all = ["omega", "momentum_body", "momentum_space", "attitude", "angles", "rotation"])]
    periods: Option<Periods>,
    /// Axis of the rotation: lam (long-axis mode, the axis of the smallest moment) or sam (short-axis mode, of the largest)
    #[arg(long, value_enum, requires = "periods")]
    mode: Option<ModeArgument>,
    /// Direction of the angular momentum in space: longitude from x towards y and latitude from the x-y plane, rad or --angle-unit [default: along z]
    #[arg(long, value_name = "lambda,beta", value_parser = numbers::<2>, allow_hyphen_values = true, requires = "periods")]
    pole: Option<[f64; 2]>,
    /// Angles of precession phi and rotation psi at the start (z-x-z, z along the angular momentum and along the axis of --mode), rad or --angle-unit [default: 0,0]
    #[arg(long, value_name = "phi,psi", value_parser = numbers::<2>, allow_hyphen_values = true, requires = "periods")]
    phases: Option<[f64; 2]>,
    /// The axis of the mode points away from the angular momentum: theta is above 90 degrees
    #[arg(long, requires = "periods")]
    reversed: bool,
}

#[derive(Clone, Copy, Debug)]
struct Periods([f64; 2]);

fn periods(text: &str) -> Result<Periods, String> {
    let found: Vec<f64> = text.split(',').map(positive_duration).collect::<Result<_, _>>()?;
    let count = found.len();
    let both = found.try_into().map(Periods);
    both.map_err(|_| format!("{count} given, 2 needed: P_phi and P_psi, separated by a comma"))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ModeArgument {
    /// Long-axis mode
    Lam,
    /// Short-axis mode
    Sam,
}

impl TumblingArguments {
    pub(crate) fn is_given(&self) -> bool {
        self.periods.is_some()
    }

    /// The elements that the flags state, if they do.
    pub(crate) fn elements(&self, angle_unit: f64) -> Result<Option<TumblingElements>, Error> {
        let Some(Periods(periods)) = self.periods else { return Ok(None) };
        let mode = match self.mode {
            Some(ModeArgument::Lam) => Mode::LongAxis,
            Some(ModeArgument::Sam) => Mode::ShortAxis,
            None => return Err(Error::input("--mode", "", "missing beside --periods", "give lam or sam")),
        };
        let angles = |typed: Option<[f64; 2]>| typed.map(|angles| angles.map(|angle| angle * angle_unit));
        let elements = TumblingElements::new(mode, periods).with_reversed(self.reversed);
        let elements = angles(self.pole).map_or(elements, |pole| elements.with_pole(pole));
        Ok(Some(angles(self.phases).map_or(elements, |phases| elements.with_angles(phases))))
    }

    /// What is wrong with them for a body.
    pub(crate) fn refused(&self, error: &TumblingError) -> Error {
        let flag = if matches!(error, TumblingError::Mode { .. }) { "--mode" } else { "--periods" };
        Error::Input(format!("{flag}: {error}"))
    }
}
