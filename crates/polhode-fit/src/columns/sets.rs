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
use crate::signal::stretch::{KnownInputs, Stretch};
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

/// Components of the momentum of wheels, by their axes, whose error can be told from the size of the tensor: another one is not zero
/// either, or a torque.
pub(crate) fn told_components(stretches: &[Stretch]) -> Vec<usize> {
    let inputs = || stretches.iter().filter_map(|stretch| stretch.inputs.as_ref());
    let turns =
        |axis: &usize| inputs().any(|inputs: &KnownInputs| inputs.wheel.iter().any(|h| h[*axis] != 0.0));
    let is_pushed = inputs().flat_map(|inputs| &inputs.torque).any(|torque| torque.amax() > 0.0);
    let turning: Vec<usize> = (0..3).filter(turns).collect();
    if turning.len() + usize::from(is_pushed) > 1 { turning } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    #[test]
    fn every_axis_has_its_errors_of_the_sensor_once() {
        let priors = SensorPriors::default().with_offset(1.0).with_scale(1.0).with_axis_scales(1.0);
        let priors = priors.with_misalignment(1.0).with_skew(1.0);
        for columns in [sensor_columns(&priors, 1.0), reported_errors()] {
            let mut names: Vec<&str> = columns.iter().map(|column| column.label().name).collect();
            names.sort_unstable();
            names.dedup();
            // three offsets, a common scale, three scales, three angles, two delays
            assert_eq!((columns.len(), names.len()), (12, 12), "{names:?}");
        }
    }

    /// The steps of a walk take its readings from knot to knot without a gap: their shares add up to the part of the way.
    #[test]
    fn steps_of_a_walk_follow_each_other_on_every_axis() {
        let times = vec![2.0, 4.0, 6.0, 8.0, 10.0];
        let stretch = |index, times: Vec<f64>| {
            let rates = vec![Vector3::zeros(); times.len()];
            Stretch { index, ..Stretch::new(times, rates) }
        };
        let all = [stretch(0, times.clone()), stretch(1, vec![0.0, SHORTEST])];
        let columns = walk_columns(&all, 3.0, 4);
        // of the short stretch one step
        assert_eq!(columns.len(), 3 * 4 + 3);
        assert_eq!(columns.iter().filter(|column| column.acts_on(&all[1])).count(), 3);
        for t in times {
            let own = columns.iter().filter(|column| column.acts_on(&all[0]));
            let change =
                own.filter_map(|c| c.effect().change_of_reading(&Vector3::zeros(), &Vector3::zeros(), t));
            let sum: Vector3<f64> = change.sum();
            // four steps of 2 from 2 to 10
            assert_eq!(sum, Vector3::repeat((t - 2.0) / 2.0));
        }
    }
}
