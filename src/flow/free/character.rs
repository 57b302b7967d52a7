//! What kind of motion it is: periods, mode, distance to the separatrix.

use thiserror::Error;

use super::circulation::Circulation;
use super::polhode::Polhode;
use crate::num::{Dd, Precise};

/// About which axis the angular momentum circulates in the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Mode {
    /// The axis of the smallest moment: the body rolls about its long axis while that precesses.
    LongAxis,
    /// The axis of the largest moment: the body turns about its short axis, which nods.
    ShortAxis,
    /// Neither: the momentum goes from one end of the middle axis to the other, once.
    Separatrix,
    /// It does not move: a turn at a constant rate about a principal axis, or of a sphere.
    Steady,
}

impl Mode {
    /// In one lowercase word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Mode::LongAxis => "long-axis",
            Mode::ShortAxis => "short-axis",
            Mode::Separatrix => "separatrix",
            Mode::Steady => "steady",
        }
    }
}

/// Readings of a free motion. Times in s, rates in rad/s; what a mode does not have is `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Character {
    /// About which axis the momentum circulates.
    pub mode: Mode,
    /// Parameter k² of the elliptic functions.
    pub parameter: Option<f64>,
    /// Complementary parameter 1 − k², with all its digits also where it is tiny.
    pub complement: Option<f64>,
    /// Time in which the momentum runs once round its polhode, 4K/|ν|.
    pub polhode_period: Option<f64>,
    /// Time in which the body's axis nods once towards L and back, half of that.
    pub nutation_period: Option<f64>,
    /// Mean rate at which that axis goes round L, positive about L.
    pub precession_rate: Option<f64>,
    /// Effective spin 2E/|L|, the constant part of ω along L.
    pub spin: f64,
    /// (|L|²/2E − I_μ)/I_μ with the middle moment I_μ: 0 on the separatrix, negative in long-axis mode.
    pub separatrix_distance: f64,
}

/// The body is at rest: its attitude is constant, and there is no period or mode to speak of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the body is at rest: its attitude is constant, it has no periods and no mode")]
pub struct AtRest;

impl Character {
    pub(super) fn circulating(polhode: &Polhode<Dd>, circulation: &Circulation<Dd>) -> Self {
        let rate = polhode.rate.abs();
        let half_period = circulation.half_period().map(|half| half / rate);
        // the axis goes round L with the twist, less or more one turn for each that m makes round the axis
        let precession = half_period.map(|half| {
            let turns = Dd::PI / half;
            circulation.mean_twist_rate() - if polhode.about_smallest { turns } else { -turns }
        });
        let mode = match (polhode.is_separatrix(), polhode.about_smallest) {
            (true, _) => Mode::Separatrix,
            (false, true) => Mode::LongAxis,
            (false, false) => Mode::ShortAxis,
        };
        Character {
            mode,
            parameter: Some(polhode.parameter.to_f64()),
            complement: Some(polhode.complement.to_f64()),
            polhode_period: half_period.map(|half| (half * 2.0).to_f64()),
            nutation_period: half_period.map(Dd::to_f64),
            precession_rate: precession.map(Dd::to_f64),
            spin: (polhode.twice_energy / polhode.norm).to_f64(),
            separatrix_distance: (polhode.separation / (polhode.twice_energy * polhode.moments[1])).to_f64(),
        }
    }

    /// A turn with `moment` = |L|²/2E at the rate `spin`, of a body whose middle moment is `middle`.
    pub(super) fn steady(spin: Dd, moment: Dd, middle: Dd) -> Self {
        Character {
            mode: Mode::Steady,
            parameter: None,
            complement: None,
            polhode_period: None,
            nutation_period: None,
            precession_rate: None,
            spin: spin.to_f64(),
            separatrix_distance: ((moment - middle) / middle).to_f64(),
        }
    }
}
