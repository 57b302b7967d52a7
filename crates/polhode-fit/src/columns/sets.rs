//! The columns that settings ask for.

use crate::columns::axis_scale::AxisScale;
use crate::columns::column::Column;
use crate::columns::constant::Constant;
use crate::columns::drag::Drag;
use crate::columns::magnet::Magnet;
use crate::columns::misalignment::Misalignment;
use crate::columns::offset::Offset;
use crate::columns::quadratic::Quadratic;
use crate::columns::scale::Scale;
use crate::columns::skew::Skew;
use crate::columns::viscous::Viscous;
use crate::columns::walk::Walk;
use crate::settings::sensor::SensorPriors;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::thresholds::walk::SHORTEST;

/// The columns of a torque.
pub(crate) fn torque_columns(model: TorqueModel) -> Vec<Column> {
    match model {
        TorqueModel::None | TorqueModel::Auto => Vec::new(),
        TorqueModel::Drag => vec![Column::new(Drag, None)],
        TorqueModel::Drag3 => (0..3).map(|k| Column::new(Viscous(k), None)).collect(),
        TorqueModel::Quadratic => vec![Column::new(Quadratic, None)],
        TorqueModel::Constant => (0..3).map(|k| Column::new(Constant(k), None)).collect(),
    }
}

/// The columns of what may be wrong with a sensor, in units of the rate `rms`.
pub(crate) fn sensor_columns(priors: &SensorPriors, rms: f64) -> Vec<Column> {
    let offsets = [0, 1, 2].map(|k| Column::new(Offset(k), None));
    let scales = [0, 1, 2].map(|k| Column::new(AxisScale(k), None));
    let angles = [0, 1, 2].map(|k| Column::new(Misalignment(k), None));
    let delays = [1, 2].map(|k| Column::new(Skew(k), None));
    let all = offsets.into_iter().chain([Column::new(Scale, None)]).chain(scales).chain(angles).chain(delays);
    let with_prior = |column: Column| {
        let prior = column.effect().prior(priors, rms);
        prior.is_some().then_some(column.with_prior(prior))
    };
    all.filter_map(with_prior).collect()
}

/// The errors of a sensor that a report speaks of, in its order.
pub(crate) fn reported_errors() -> Vec<Column> {
    let offsets = [0, 1, 2].map(|k| Column::new(Offset(k), None));
    let delays = [1, 2].map(|k| Column::new(Skew(k), None));
    let all = [Column::new(Scale, None)].into_iter().chain(axis_scales());
    all.chain(misalignments()).chain(offsets).chain(delays).collect()
}

/// The errors of scale of each axis.
pub(crate) fn axis_scales() -> Vec<Column> {
    (0..3).map(|k| Column::new(AxisScale(k), None)).collect()
}

/// The errors of right angles, that of x and y first.
pub(crate) fn misalignments() -> Vec<Column> {
    (0..3).rev().map(|third| Column::new(Misalignment(third), None)).collect()
}

/// The columns of a random walk of the offsets, whose standard deviation after a unit of time is `walk`: in each stretch
/// at most `most` steps of a line from knot to knot, which are independent.
pub(crate) fn walk_columns(stretches: &[Stretch], walk: f64, most: usize) -> Vec<Column> {
    let mut columns = Vec::new();
    for stretch in stretches {
        let (Some(first), duration) = (stretch.times.first(), stretch.duration()) else { continue };
        let steps = ((duration / SHORTEST) as usize).clamp(1, most);
        let width = duration / steps as f64;
        for step in 0..steps {
            let from = first + step as f64 * width;
            let walks = (0..3).map(|axis| Walk { axis, from, until: from + width });
            let prior = Some(walk * width.sqrt());
            columns.extend(walks.map(|walk| Column::new(walk, prior).of_segment(stretch.index)));
        }
    }
    columns
}

/// The columns of a magnet in the body; how the axes of a stretch stand in the field at its first sample is not known.
pub(crate) fn magnet_columns(stretches: &[Stretch]) -> Vec<Column> {
    let of = |stretch: &Stretch| {
        let segment = stretch.index;
        let each = (0..9).map(move |k| Magnet { magnet: k / 3, field: k % 3, segment });
        each.map(move |magnet| Column::new(magnet, None).of_segment(segment))
    };
    stretches.iter().flat_map(of).collect()
}
