//! The physical law of carrier and object.

use nalgebra::{DVector, Matrix3};

use crate::carrier::records::CarrierRecords;
use crate::carrier::start::of_entries;
use crate::carrier::system::System;
use crate::physical::coordinates::eigen;
use crate::thresholds::carrier::HELD;

/// A body that must be physical: the place of its first entry, its unit, and what is added to the entries in that unit.
pub(super) type Lawful = (usize, f64, Matrix3<f64>);

/// The bodies that must be physical, the carrier first.
pub(super) fn bodies(system: &System, records: &CarrierRecords) -> Vec<Lawful> {
    let term = records.object_term.unwrap_or_else(Matrix3::zeros);
    let carrier = Some((system.carrier.0, system.carrier.1, Matrix3::zeros()));
    let object = system.object.map(|(place, unit)| (place, unit, -term / unit));
    carrier.into_iter().chain(object).collect()
}

/// The largest of 2 I − tr T over the moments I of a body, and its trace, in its unit.
fn excess((place, _, base): &Lawful, z: &DVector<f64>) -> (f64, f64) {
    let tensor = base + of_entries(&z.as_slice()[*place..place + 6]);
    (2.0 * eigen(tensor).0[2] - tensor.trace(), tensor.trace())
}

pub(super) fn is_physical(body: &Lawful, z: &DVector<f64>) -> bool {
    excess(body, z).0 <= 0.0
}

pub(super) fn is_held(body: &Lawful, z: &DVector<f64>) -> bool {
    let (excess, trace) = excess(body, z);
    excess >= -HELD * trace.abs().max(1.0)
}
