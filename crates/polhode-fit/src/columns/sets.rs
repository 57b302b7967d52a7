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
    let angles = [0, 1, 2].map(|k| Column::new(Misalignment(k), None));
    let delays = [1, 2].map(|k| Column::new(Skew(k), None));
    let all = offsets.into_iter().chain([Column::new(Scale, None)]).chain(axis_scales());
    let with_prior =
        |column: Column| column.effect().prior(priors, rms).map(|prior| column.with_prior(Some(prior)));
    all.chain(angles).chain(delays).filter_map(with_prior).collect()
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
    use nalgebra::{Matrix3, Vector3};

    use super::*;
    use crate::columns::dissipation::dissipation;
    use crate::columns::effect::Class;
    use crate::columns::input::Input;
    use crate::columns::rotor::Rotor;
    use crate::columns::wheel_axis::WheelAxis;
    use crate::thresholds::errors::HELD;

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

    /// Steps of a walk last half a radian at least, and are no more than what is asked for; together they vary as the whole walk does.
    #[test]
    fn steps_of_a_walk_share_its_variance() {
        for (duration, most, steps) in [(8.0, 4, 4), (8.0, 100, 16), (1.75, 100, 3), (0.25, 100, 1)] {
            let stretch = Stretch::new(vec![1.0, 1.0 + duration], vec![Vector3::zeros(); 2]);
            let columns = walk_columns(&[stretch], 3.0, most);
            assert_eq!(columns.len(), 3 * steps, "{duration} {most}");
            let squares = columns.iter().filter_map(|column| column.prior).map(|sigma| sigma * sigma);
            // of each axis 3² times the duration
            let expected = 27.0 * duration;
            assert!((squares.sum::<f64>() / expected - 1.0).abs() < 1e-14, "{duration} {most}");
        }
    }

    /// A value of the fit goes to SI with the power of the unit rate that its unit has.
    #[test]
    fn units_of_columns_tell_their_power_of_the_rate() {
        let magnet = Magnet { magnet: 0, field: 0, segment: 0 };
        let walk = Walk { axis: 0, from: 0.0, until: 1.0 };
        let rows = [
            (Column::new(Drag, None), "1/s", 4.0),
            (Column::new(Viscous(1), None), "1/s", 4.0),
            (Column::new(Quadratic, None), "1/rad", 1.0),
            (Column::new(magnet, None), "rad/s^2", 16.0),
            (Column::new(walk, None), "rad/s", 4.0),
            (Column::new(Skew(1), None), "s", 0.25),
            (Column::new(Scale, None), "", 1.0),
            (Column::new(AxisScale(2), None), "", 1.0),
            (Column::new(Misalignment(0), None), "rad", 1.0),
            (Column::new(Offset(2), None), "rad/s", 4.0),
            (Column::new(Constant(0), None), "rad/s^2", 16.0),
            (Column::new(Input, None), "1/(kg m^2)", 1.0),
            (Column::new(WheelAxis(1), None), "1/(kg m^2)", 1.0),
            (Column::new(Rotor(1), None), "of |L|", 1.0),
        ];
        for (column, unit, factor) in rows {
            assert_eq!((column.label().unit, column.label().factor(4.0)), (unit, factor));
        }
    }

    /// With ω = P y − b a reading y shows less of ω where P is larger, more of it where b is, and of a late axis the rate of an earlier time;
    /// what is no error of the sensor changes no reading. Each of these errors has a size of which a report speaks.
    #[test]
    fn errors_of_the_sensor_change_readings_and_rates() {
        let (w, slope, none) = (Vector3::new(2.0, 3.0, 5.0), Vector3::new(7.0, 11.0, 13.0), Vector3::zeros());
        let half = |x: f64, y: f64, z: f64| Vector3::new(x, y, z) * 0.5;
        let rows = [
            (Column::new(Scale, None), -w, Some(w)),
            (
                Column::new(AxisScale(1), None),
                Vector3::new(0.0, -3.0, 0.0),
                Some(Vector3::new(0.0, 3.0, 0.0)),
            ),
            // angles of y and z, of x and z, and of x and y
            (Column::new(Misalignment(0), None), half(0.0, -5.0, -3.0), Some(half(0.0, 5.0, 3.0))),
            (Column::new(Misalignment(1), None), half(-5.0, 0.0, -2.0), Some(half(5.0, 0.0, 2.0))),
            (Column::new(Misalignment(2), None), half(-3.0, -2.0, 0.0), Some(half(3.0, 2.0, 0.0))),
            (Column::new(Offset(2), None), Vector3::z(), Some(-Vector3::z())),
            (Column::new(Skew(1), None), Vector3::new(0.0, -11.0, 0.0), None),
        ];
        for (column, of_reading, of_rate) in rows {
            let (name, effect) = (column.label().name, column.effect());
            assert_eq!(effect.change_of_reading(&w, &slope, 0.0), Some(of_reading), "{name}");
            assert_eq!(effect.change_of_rate(&w), of_rate, "{name}");
            assert!(effect.reported_size().is_some() && column.class() == Class::Sensor, "{name}");
        }
        for column in [Column::new(Drag, None), Column::new(Constant(0), None), Column::new(Input, None)] {
            assert_eq!(column.effect().change_of_reading(&w, &none, 0.0), None);
            assert!(
                column.effect().change_of_rate(&w).is_none() && column.effect().reported_size().is_none()
            );
        }
        let classes = [Class::Drag, Class::Torque, Class::Sensor, Class::Momentum, Class::Input];
        assert_eq!(classes.map(Class::is_torque), [true, true, false, false, false]);
    }

    /// Of the columns that are kept those of drag take energy, by their places among them.
    #[test]
    fn drag_takes_energy_at_its_place() {
        let columns = [
            Column::new(Offset(0), None),
            Column::new(Drag, None),
            Column::new(Constant(0), None),
            Column::new(Viscous(2), None),
        ];
        let found = dissipation(&columns, &[3, 0, 1]);
        let found: Vec<(usize, &str)> = found.iter().map(|of| (of.place, of.name)).collect();
        assert_eq!(found, [(0, "drag_zz"), (2, "drag")]);
    }

    /// Drag slows a rate of size 13 by itself, by thirteen times itself, and by its own axis over that moment.
    #[test]
    fn drag_slows_in_closed_form() {
        let w = Vector3::new(3.0, 4.0, 12.0);
        let inverse = Matrix3::from_diagonal(&Vector3::new(0.5, 0.25, 2.0));
        let of = |column: Column| column.effect().acceleration(&inverse, &w);
        assert_eq!(of(Column::new(Drag, None)), Some(-w));
        assert_eq!(of(Column::new(Quadratic, None)), Some(w * -13.0));
        assert_eq!(of(Column::new(Viscous(0), None)), Some(Vector3::new(-1.5, 0.0, 0.0)));
        assert_eq!(of(Column::new(Viscous(2), None)), Some(Vector3::new(0.0, 0.0, -24.0)));
        assert_eq!(of(Column::new(Scale, None)), None);
    }

    /// The nine products of magnet and field push by the cross product of their axes, while the body has not turned.
    #[test]
    fn a_magnet_pushes_across_its_field() {
        let torques: Vec<Vector3<f64>> = magnet_columns(&[Stretch::new(vec![0.0], vec![Vector3::zeros()])])
            .iter()
            .filter_map(|column| column.effect().torque_at(&Matrix3::identity()))
            .collect();
        assert_eq!(torques.len(), 9);
        for (k, torque) in torques.iter().enumerate() {
            assert_eq!(*torque, Vector3::ith(k / 3, 1.0).cross(&Vector3::ith(k % 3, 1.0)));
        }
    }

    /// The momentum of a wheel is told from the size of the tensor by another axis or a torque beside it.
    #[test]
    fn a_lone_wheel_tells_no_component() {
        let told = |wheel: Vector3<f64>, torque: Vector3<f64>| {
            let inputs = Some(KnownInputs { wheel: vec![wheel], torque: vec![torque] });
            told_components(&[Stretch { inputs, ..Stretch::new(vec![0.0], vec![Vector3::zeros()]) }])
        };
        let (none, push) = (Vector3::zeros(), Vector3::new(0.0, -1.0, 0.0));
        assert!(told(Vector3::new(0.0, 0.0, 1.0), none).is_empty());
        assert_eq!(told(Vector3::new(0.0, 0.0, 1.0), push), [2]);
        assert_eq!(told(Vector3::new(1.0, 0.0, -1.0), none), [0, 2]);
        assert!(told(none, push).is_empty());
    }

    /// Two columns are the same unknown by kind and stretch, not by prior; one of a stretch acts on that alone.
    #[test]
    fn columns_are_alike_by_kind_and_stretch() {
        let column = Column::new(Offset(1), Some(0.5));
        assert!(column.is_alike(&column.with_prior(None)));
        assert!(!column.is_alike(&Column::new(Offset(2), Some(0.5))));
        assert!(!column.is_alike(&column.of_segment(0)));
        let stretch = Stretch::new(vec![0.0], vec![Vector3::zeros()]);
        assert!(column.acts_on(&stretch) && column.of_segment(0).acts_on(&stretch));
        assert!(!column.of_segment(1).acts_on(&stretch));
        // an offset is left as it is at a sphere, a scale is not
        assert_eq!(column.at_sphere(), column);
        let priors = [Some(0.5 * HELD), Some(2.0 * HELD), None];
        let held = priors.map(|prior| Column::new(Scale, prior).at_sphere().prior);
        assert_eq!(held, [Some(0.5 * HELD), Some(HELD), Some(HELD)]);
    }

    /// What is expected of a sensor goes to the units of the fit: offsets over the rate, delays times it, ratios as they are.
    #[test]
    fn priors_of_the_sensor_have_the_units_of_the_fit() {
        let priors = SensorPriors::default().with_offset(2.0).with_scale(3.0).with_axis_scales(5.0);
        let priors = priors.with_misalignment(7.0).with_skew(9.0);
        let found: Vec<f64> = sensor_columns(&priors, 4.0).iter().filter_map(|column| column.prior).collect();
        assert_eq!(found, [0.5, 0.5, 0.5, 3.0, 5.0, 5.0, 5.0, 7.0, 7.0, 7.0, 36.0, 36.0]);
    }
}
