//! The spin about an axis that stays: which axis it is, and whether the spin is stable.

use nalgebra::Vector3;

use crate::num::{Dd, Precise, Real};
use crate::rotation::Vec3;

/// What becomes of a small deviation from a steady spin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stability {
    /// It circulates about the axis and stays small.
    Stable,
    /// It grows exponentially: the spin is about the axis of the middle moment.
    Unstable,
    /// It grows at most linearly: another moment equals that about the axis.
    Neutral,
}

impl Stability {
    /// In one lowercase word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Stability::Stable => "stable",
            Stability::Unstable => "unstable",
            Stability::Neutral => "neutral",
        }
    }
}

/// A spin about an axis that is fixed in the body and in space.
///
/// With the moments I_k about the axis and I_a, I_b about the other two, small deviations obey
/// δω̈ = −ω² (I_k − I_a)(I_k − I_b)/(I_a I_b) δω (Landau and Lifshitz, Mechanics, §37).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PureSpin {
    /// Unit vector along the angular velocity, body axes.
    pub axis: Vector3<f64>,
    /// Place of the moment about the axis among the three in ascending order, from 0: the longest axis is 0, the shortest 2.
    pub rank: usize,
    /// What becomes of a small deviation.
    pub stability: Stability,
    /// Rate λ at which a deviation grows as e^{λt}, rad/s; 0 unless it is unstable.
    pub growth_rate: f64,
    /// Rate at which a deviation circulates, rad/s; 0 unless it is stable.
    pub circulation_rate: f64,
}

impl PureSpin {
    /// Of a spin with the `momentum` m; `axis` is that of ω in body axes.
    pub(super) fn of(moments: Vec3<Dd>, momentum: Vec3<Dd>, axis: Vector3<f64>) -> Self {
        let largest = (0..3).max_by(|&a, &b| momentum[a].abs().hi().total_cmp(&momentum[b].abs().hi()));
        let k = largest.unwrap_or(0);
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        let share = (moments[k] - moments[a]) * (moments[k] - moments[b]) / (moments[a] * moments[b]);
        let rate = ((momentum.norm() / moments[k]) * share.abs().sqrt()).to_f64();
        let stability = match share.hi() {
            share if share > 0.0 => Stability::Stable,
            share if share < 0.0 => Stability::Unstable,
            _ => Stability::Neutral,
        };
        let rate_if = |wanted: Stability| if stability == wanted { rate } else { 0.0 };
        PureSpin {
            axis,
            rank: moments.ascending().iter().position(|&place| place == k).unwrap_or(0),
            stability,
            growth_rate: rate_if(Stability::Unstable),
            circulation_rate: rate_if(Stability::Stable),
        }
    }
}
