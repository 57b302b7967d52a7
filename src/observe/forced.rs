//! What a motion with forces conserves, and the scales of its errors.

use super::invariants::with_wheels;
use crate::body::{Body, Conserved, Point, Problem, Time};
use crate::num::{Dd, Real};

/// What a motion with forces conserves, and what its errors are measured by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forced {
    /// Whether a linear potential is all that acts, and energy and L_z all that is conserved.
    pub(super) linear_alone: bool,
    pub(super) energy: bool,
    pub(super) momentum_norm: bool,
    pub(super) momentum_vector: bool,
    pub(super) momentum_z: bool,
    /// Rate n of Jacobi's constant.
    pub(super) jacobi: Option<f64>,
    pub(super) energy_scale: f64,
    pub(super) momentum_scale: f64,
    pub(super) jacobi_scale: f64,
}

impl Forced {
    pub(super) fn of(body: &Body, at: Time, start: &Point<Dd>, kinetic: Dd) -> Option<Self> {
        let problem = body.problem();
        if problem == Problem::Free {
            return None;
        }
        let mut energy = kinetic;
        if let Some(linear) = body.linear_potential::<Dd>() {
            energy = energy + linear.moment.norm_of_any_size();
        }
        if problem != Problem::Linear {
            energy = energy + body.size_of_remainder(at, start);
        }
        // a force so large that its size is no double ends the run at its first step
        let energy_scale = if energy.hi().is_finite() { energy.hi() } else { f64::MAX };
        let largest = body.rotor().moments::<f64>().magnitude();
        let conserved = body.conserved();
        let has = |quantity| conserved.contains(&quantity);
        let jacobi = conserved.iter().find_map(|quantity| match quantity {
            Conserved::Jacobi { rate } if !has(Conserved::Energy) => Some(*rate),
            _ => None,
        });
        let whole =
            with_wheels(body.momentum_of_wheels().as_ref(), at, start).momentum_body.norm_of_any_size();
        let turning = (whole * jacobi.unwrap_or(0.0)).magnitude();
        let alone = problem == Problem::Linear && jacobi.is_none();
        Some(Forced {
            linear_alone: alone
                && conserved == [Conserved::Energy, Conserved::MomentumZ]
                && energy_scale > 0.0,
            energy: has(Conserved::Energy),
            momentum_norm: has(Conserved::MomentumNorm),
            momentum_vector: has(Conserved::Momentum),
            momentum_z: has(Conserved::MomentumZ) && !has(Conserved::Momentum),
            jacobi,
            energy_scale,
            momentum_scale: (2.0 * largest * energy_scale).sqrt(),
            jacobi_scale: energy_scale + turning,
        })
    }
}
