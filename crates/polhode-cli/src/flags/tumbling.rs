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
    /// Two periods in place of --omega, s or with a unit: P_phi of the precession about the angular momentum and P_psi of the rotation about the body axis of --mode, as 27.38h,263h; or two of P_phi, P_psi and P_1 by name, as P_1=30.56h,P_psi=263h
    #[arg(long, value_name = "P_phi,P_psi", value_parser = periods, requires = "mode",
          conflicts_with_all = ["omega", "momentum_body", "momentum_space", "attitude", "angles", "rotation"])]
    periods: Option<Periods>,
    /// Axis of the rotation: that of the smallest moment (lam, long-axis mode) or of the largest (sam, short-axis mode)
    #[arg(long, value_enum, requires = "periods")]
    mode: Option<ModeArgument>,
    /// Direction of the angular momentum in space: longitude from x towards y and latitude from the x-y plane, rad or --angle-unit [default: along z]
    #[arg(long, value_name = "lambda,beta", value_parser = numbers::<2>, allow_hyphen_values = true, requires = "periods")]
    pole: Option<[f64; 2]>,
    /// Euler angles of precession phi and rotation psi at the start (z-x-z, with z along the angular momentum and along the axis of --mode), rad or --angle-unit [default: 0,0]
    #[arg(long, value_name = "phi,psi", value_parser = numbers::<2>, allow_hyphen_values = true, requires = "periods")]
    phases: Option<[f64; 2]>,
    /// The axis of the mode points away from the angular momentum (theta above 90 degrees)
    #[arg(long, requires = "periods")]
    reversed: bool,
}

/// Two of the three periods, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Periods {
    /// P_phi and P_psi.
    Both([f64; 2]),
    /// P_phi and P_1.
    PrecessionAndCombined([f64; 2]),
    /// P_1 and P_psi.
    CombinedAndRotation([f64; 2]),
}

/// Their names, in the order in which they are understood without.
const NAMES: [&str; 3] = ["P_phi", "P_psi", "P_1"];

pub(crate) fn periods(text: &str) -> Result<Periods, String> {
    let mut found = [None; 3];
    let items: Vec<&str> = text.split(',').collect();
    let named = items.iter().filter(|item| item.contains('=')).count();
    if named > 0 && named < items.len() {
        return Err("name both periods or none, as in P_1=30.56h,P_psi=263h".into());
    }
    for (place, item) in items.iter().enumerate() {
        let (which, period) = match item.split_once('=') {
            None => (place, *item),
            Some((name, period)) => {
                let known = NAMES.iter().position(|known| known.eq_ignore_ascii_case(name.trim()));
                (
                    known.ok_or_else(|| {
                        format!("unknown period '{}'; write P_phi, P_psi or P_1", name.trim())
                    })?,
                    period,
                )
            }
        };
        let period = positive_duration(period)?;
        match found.get_mut(which) {
            Some(slot @ None) => *slot = Some(period),
            Some(Some(_)) => return Err(format!("{} is given twice", NAMES[which])),
            None => break,
        }
    }
    let count = items.len();
    match found {
        _ if count != 2 => Err(format!("{count} given, 2 needed: P_phi and P_psi, separated by a comma")),
        [Some(precession), Some(rotation), _] => Ok(Periods::Both([precession, rotation])),
        [Some(precession), _, Some(combined)] => Ok(Periods::PrecessionAndCombined([precession, combined])),
        [_, Some(rotation), Some(combined)] => Ok(Periods::CombinedAndRotation([combined, rotation])),
        _ => Err("give two of P_phi, P_psi and P_1".into()),
    }
}

impl Periods {
    /// The elements with these periods.
    pub(crate) fn elements(self, mode: Mode) -> Result<TumblingElements, TumblingError> {
        match self {
            Periods::Both(periods) => Ok(TumblingElements::new(mode, periods)),
            Periods::PrecessionAndCombined(periods) => {
                TumblingElements::from_precession_and_combined(mode, periods)
            }
            Periods::CombinedAndRotation(periods) => {
                TumblingElements::from_combined_and_rotation(mode, periods)
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModeArgument {
    /// Long-axis mode
    Lam,
    /// Short-axis mode
    Sam,
}

impl From<ModeArgument> for Mode {
    fn from(mode: ModeArgument) -> Mode {
        match mode {
            ModeArgument::Lam => Mode::LongAxis,
            ModeArgument::Sam => Mode::ShortAxis,
        }
    }
}

/// Refuses what is no latitude, as degrees are that were taken for rad.
pub(crate) fn latitude([_, latitude]: [f64; 2], unit: f64) -> Result<(), String> {
    if (latitude * unit).abs() <= core::f64::consts::FRAC_PI_2 {
        return Ok(());
    }
    let remedy = if unit == 1.0 { "; degrees need the unit of angles deg" } else { "" };
    Err(format!("the latitude {latitude:?} is beyond a quarter of a turn{remedy}"))
}

impl TumblingArguments {
    pub(crate) fn is_given(&self) -> bool {
        self.periods.is_some()
    }

    /// The angles of all flags, as they were typed; a pole whose latitude will be refused has none.
    pub(crate) fn angles(&self) -> impl Iterator<Item = &f64> {
        let pole = self.pole.iter().filter(|pole| latitude(**pole, 1.0).is_ok());
        pole.flatten().chain(self.phases.iter().flatten())
    }

    /// Whether a flag has angles.
    pub(crate) fn has_angles(&self) -> bool {
        self.pole.is_some() || self.phases.is_some()
    }

    /// The elements that the flags state, if they do.
    pub(crate) fn elements(&self, angle_unit: f64) -> Result<Option<TumblingElements>, Error> {
        let Some(periods) = self.periods else { return Ok(None) };
        let Some(mode) = self.mode else {
            return Err(Error::input("--mode", "", "missing beside --periods", "give lam or sam"));
        };
        if let Some(pole) = self.pole {
            latitude(pole, angle_unit).map_err(|error| Error::Input(format!("--pole: {error}")))?;
        }
        let angles = |typed: Option<[f64; 2]>| typed.map(|angles| angles.map(|angle| angle * angle_unit));
        let elements = periods.elements(mode.into()).map_err(|error| self.refused(&error))?;
        let elements = elements.with_reversed(self.reversed);
        let elements = angles(self.pole).map_or(elements, |pole| elements.with_pole(pole));
        Ok(Some(angles(self.phases).map_or(elements, |phases| elements.with_angles(phases))))
    }

    /// What is wrong with them for a body.
    pub(crate) fn refused(&self, error: &TumblingError) -> Error {
        let flag = if matches!(error, TumblingError::Mode { .. }) { "--mode" } else { "--periods" };
        Error::Input(format!("{flag}: {error}"))
    }
}
