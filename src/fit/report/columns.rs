//! Names, units and values of what was estimated beside the tensor.

use super::nuisance::Nuisance;
use crate::fit::weak::model::{Column, Kind};
use crate::fit::weak::weak_estimate::WeakEstimate;

/// Name and unit of an unknown, and the power of the unit rate that it goes with.
pub(crate) fn named(kind: Kind) -> (&'static str, &'static str, i32) {
    let of = |names: [&'static str; 6], k: usize| names[k.min(5)];
    match kind {
        Kind::Drag => ("drag", "1/s", 1),
        Kind::Viscous(k) => {
            (of(["drag_xx", "drag_yy", "drag_zz", "drag_xy", "drag_xz", "drag_yz"], k), "1/s", 1)
        }
        Kind::Constant(k) => (of(["torque_x", "torque_y", "torque_z", "", "", ""], k), "rad/s^2", 2),
        Kind::Offset(k) => (of(["offset_x", "offset_y", "offset_z", "", "", ""], k), "rad/s", 1),
        Kind::Scale => ("scale", "", 0),
        Kind::AxisScale(k) => (of(["scale_x", "scale_y", "scale_z", "", "", ""], k), "", 0),
        Kind::Misalignment(k) => {
            (of(["misalignment_yz", "misalignment_xz", "misalignment_xy", "", "", ""], k), "rad", 0)
        }
        Kind::Skew(k) => (of(["skew_x", "skew_y", "skew_z", "", "", ""], k), "s", -1),
        Kind::Input => ("inverse_trace", "1/(kg m^2)", 0),
    }
}

/// Whether an unknown is a torque rather than an error of the sensor.
pub(crate) fn is_torque(column: &Column) -> bool {
    matches!(column.kind, Kind::Drag | Kind::Viscous(_) | Kind::Constant(_))
}

/// The factor from the fit's units to SI of an unknown; `rms` is the unit rate, rad/s.
pub(crate) fn unit(kind: Kind, rms: f64) -> f64 {
    match named(kind).2 {
        2 => rms * rms,
        1 => rms,
        -1 => 1.0 / rms,
        _ => 1.0,
    }
}

/// The unknowns beside the tensor at `values`, with deviations for residuals of `variance`.
pub(crate) fn nuisances(
    weak: &WeakEstimate,
    values: &[f64],
    variance: f64,
    rms: f64,
) -> Vec<(Column, Nuisance)> {
    let Some(factor) = weak.stacked.as_ref().and_then(|stacked| stacked.joint_factor()) else {
        return Vec::new();
    };
    let each = weak.columns.iter().zip(values).enumerate();
    each.map(|(k, (column, value))| {
        let (name, unit_name, _) = named(column.kind);
        let unit = unit(column.kind, rms);
        let nuisance = Nuisance {
            name,
            unit: unit_name,
            value: value * unit,
            sigma: factor.row(k).norm() * variance.sqrt() * unit,
            prior: column.prior.map(|prior| prior * unit),
        };
        (*column, nuisance)
    })
    .collect()
}
