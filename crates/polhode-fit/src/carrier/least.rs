//! Least squares by Gauss's and Newton's method, within the physical law.

use nalgebra::{DVector, Matrix3};

use crate::carrier::error::CarrierError;
use crate::carrier::law::Lawful;
use crate::carrier::system::System;
use crate::physical::failure::SolverFailure;
use crate::physical::nearest::{Normal, nearest_bodies};
use crate::thresholds::carrier::{HALVINGS, NEAR, ROUNDS, STILL};

/// The unknowns of least squares, among those with physical tensors where `within` says which, and the linear equations there.
pub(super) fn least(
    system: &System,
    start: DVector<f64>,
    within: Option<&[Lawful]>,
) -> Result<(DVector<f64>, Normal), CarrierError> {
    let walls: Option<Vec<(usize, Matrix3<f64>)>> =
        within.map(|bodies| bodies.iter().map(|(place, _, base)| (*place, *base)).collect());
    let mut z = start;
    let mut squares = system.squares(&z).ok_or(SolverFailure::Information)?;
    let mut moved = f64::INFINITY;
    for round in 0..ROUNDS {
        let normal = system.linearised(&z).ok_or(SolverFailure::Information)?;
        let target = match &walls {
            None => normal.centre.clone(),
            Some(walls) => nearest_bodies(&normal, walls)?.0,
        };
        let step = target - &z;
        moved = (&normal.root * &step).norm();
        if moved <= STILL {
            return Ok((z, normal));
        }
        // from outside the law its first point inside is taken as it is, and near the answer squares differ by rounding
        let free = moved < NEAR || (round == 0 && walls.is_some());
        let shares = core::iter::successors(Some(1.0), |share| Some(0.5 * share)).take(HALVINGS);
        let next = shares.map(|share| &z + &step * share).find_map(|next| {
            let found = system.squares(&next)?;
            (free || found <= squares).then_some((next, found))
        });
        let Some((next, found)) = next else { break };
        (z, squares) = (next, found);
    }
    Err(CarrierError::Unsettled { rounds: ROUNDS, moved })
}
