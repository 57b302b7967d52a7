//! What errors of the sensor that a fit takes to be zero would do to the moments.

use nalgebra::Vector3;

use super::columns::{named, unit};
use super::nuisance::Systematic;
use crate::fit::physical::coordinates::{Coordinates, pair};
use crate::fit::weak::model::{Column, Kind, Unknowns};
use crate::fit::weak::stacked::Stacked;
use crate::fit::weak::test_functions::Stretch;
use crate::fit::weak::weak_estimate::WeakEstimate;

/// Each error with its size: an offset of 0.01 rad/s, 1 per cent of scale, 0.01 rad of alignment, 1 ms of delay.
const ERRORS: [(Kind, f64); 12] = [
    (Kind::Scale, 0.01),
    (Kind::AxisScale(0), 0.01),
    (Kind::AxisScale(1), 0.01),
    (Kind::AxisScale(2), 0.01),
    (Kind::Misalignment(2), 0.01),
    (Kind::Misalignment(1), 0.01),
    (Kind::Misalignment(0), 0.01),
    (Kind::Offset(0), 0.01),
    (Kind::Offset(1), 0.01),
    (Kind::Offset(2), 0.01),
    (Kind::Skew(1), 1e-3),
    (Kind::Skew(2), 1e-3),
];

/// The lines of the report; `axes` and `moments` are the principal ones, ascending, and `rms` is the unit rate, rad/s.
///
/// With g the derivative of the equations with respect to an error, the estimate moves by what makes |G δ − g| least.
pub(crate) fn systematic(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    axes: &[Vector3<f64>; 3],
    moments: &[f64; 3],
    variance: f64,
    rms: f64,
) -> Vec<Systematic> {
    let estimated = |kind| weak.columns.iter().any(|column| column.kind == kind);
    let errors: Vec<(Kind, f64)> = ERRORS.into_iter().filter(|(kind, _)| !estimated(*kind)).collect();
    let first = errors.iter().map(|&(kind, _)| Column::new(kind, None));
    let columns: Vec<Column> = first.chain(weak.columns.iter().copied()).collect();
    let mut at = weak.at.clone();
    at.c = vec![0.0; errors.len()].into_iter().chain(at.c).collect();
    let parts = weak.parts.iter().map(|part| part.with_columns(&stretches[part.stretch], &columns, &at));
    let whitened: Vec<Vec<f64>> = parts.collect();
    let origin = Unknowns::at(Coordinates::zeros(), &weak.columns);
    let (wide, own) = (columns.len() + 6, weak.columns.len() + 6);
    let each = errors.iter().enumerate().filter_map(|(k, &(kind, size))| {
        let rows: Vec<Vec<f64>> = whitened
            .iter()
            .map(|part| {
                let row = |row: &[f64]| {
                    let mut kept = row[errors.len()..].to_vec();
                    kept[own - 1] = -row[k];
                    kept
                };
                part.chunks_exact(wide).flat_map(row).collect()
            })
            .collect();
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        let step = Stacked::new(&rows, &weak.columns, &origin, variance.sqrt()).minimiser()?.x;
        let step = step * (size / unit(kind, rms));
        let change: [f64; 3] = core::array::from_fn(|k| pair(&axes[k], &axes[k]).dot(&step));
        let ratio = |k: usize| (change[k] - change[2] * moments[k] / moments[2]) / moments[2];
        let (name, unit_name, _) = named(kind);
        Some(Systematic { name, size, unit: unit_name, principal: change, ratios: [ratio(0), ratio(1)] })
    });
    each.filter(|s| s.principal.iter().all(|v| v.is_finite())).collect()
}
