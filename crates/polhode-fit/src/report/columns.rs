//! Names, units and values of what was estimated beside the tensor.

use super::nuisance::Nuisance;
use crate::physical::dissipation::Dissipation;
use crate::weak::model::{Column, Kind};
use crate::weak::weak_estimate::WeakEstimate;

/// Name and unit of an unknown, and the power of the unit rate that it goes with.
pub(crate) fn named(kind: Kind) -> (&'static str, &'static str, i32) {
    let of = |names: [&'static str; 6], k: usize| names[k.min(5)];
    match kind {
        Kind::Drag => ("drag", "1/s", 1),
        Kind::Viscous(k) => {
            (of(["drag_xx", "drag_yy", "drag_zz", "drag_xy", "drag_xz", "drag_yz"], k), "1/s", 1)
        }
        Kind::Quadratic => ("quadratic_drag", "1/rad", 0),
        Kind::Walk { axis, .. } => (of(["walk_x", "walk_y", "walk_z", "", "", ""], axis), "rad/s", 1),
        Kind::Rotor(k) => (of(["wheel_x", "wheel_y", "wheel_z", "", "", ""], k), "of |L|", 0),
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
    is_drag(column) || matches!(column.kind, Kind::Constant(_))
}

/// Whether it is a coefficient of drag, which takes energy.
pub(crate) fn is_drag(column: &Column) -> bool {
    matches!(column.kind, Kind::Drag | Kind::Viscous(_) | Kind::Quadratic)
}

/// The conditions by which the columns `kept` take energy, as far as they are drag.
pub(crate) fn dissipation(columns: &[Column], kept: &[usize]) -> Vec<Dissipation> {
    let of = |place: usize| &columns[kept[place]];
    let drags: Vec<usize> = (0..kept.len()).filter(|&place| is_drag(of(place))).collect();
    // the columns of one segment stand together
    let groups = drags.chunk_by(|&a, &b| of(a).segment == of(b).segment);
    let conditions = |group: &[usize]| {
        let segment = of(group[0]).segment;
        if let Ok(places) = <[usize; 6]>::try_from(group) {
            return vec![Dissipation::Matrix { places, segment }];
        }
        let alone = |&place: &usize| {
            let name = named(of(place).kind).0;
            Dissipation::Coefficient { place, name, segment }
        };
        group.iter().map(alone).collect()
    };
    groups.flat_map(conditions).collect()
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

/// The unknowns beside the tensor at `values`, with deviations for residuals of `variance`, or those of `held` by number.
pub(crate) fn nuisances(
    weak: &WeakEstimate,
    values: &[f64],
    variance: f64,
    rms: f64,
    held: &[(usize, f64)],
) -> Vec<(Column, Nuisance)> {
    let Some(factor) = weak.stacked.as_ref().and_then(|stacked| stacked.joint_factor()) else {
        return Vec::new();
    };
    let fitted = |segment: usize| weak.parts.iter().any(|part| part.stretch == segment);
    let each = weak.columns.iter().zip(values).enumerate();
    // steps of a walk are many, and none of them matters
    let listed = each.filter(|(_, (column, _))| {
        column.segment.is_none_or(fitted) && !matches!(column.kind, Kind::Walk { .. })
    });
    listed
        .map(|(k, (column, value))| {
            let (name, unit_name, _) = named(column.kind);
            let unit = unit(column.kind, rms);
            let own = held.iter().find(|(place, _)| *place == k).map(|(_, sigma)| *sigma);
            let sigma = own.unwrap_or_else(|| factor.row(k).norm() * variance.sqrt());
            let nuisance = Nuisance {
                name,
                unit: unit_name,
                value: value * unit,
                sigma: sigma * unit,
                prior: column.prior.map(|prior| prior * unit),
                segment: column.segment,
            };
            (*column, nuisance)
        })
        .collect()
}
