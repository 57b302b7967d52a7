//! Whether the wheels of all records are one.

use nalgebra::Vector3;
use polhode::record::{Record, Segment};

use crate::carrier::error::CarrierError;
use crate::carrier::records::CarrierRecords;
use crate::error::FitError;
use crate::thresholds::carrier::PARALLEL;

/// Refuses wheels of only some of the records, or an unknown one about different axes.
pub(super) fn check_wheels(records: &CarrierRecords) -> Result<(), CarrierError> {
    let wheels = |record: &Record| record.segments.iter().any(|s| s.wheel().is_some());
    let having = |wanted: bool| records.tumbles.iter().find(|tumble| wheels(&tumble.record) == wanted);
    if let (Some(with), Some(without)) = (having(true), having(false)) {
        return Err(CarrierError::Wheels { with: with.attached, without: without.attached });
    }
    if !records.finds_wheel {
        return Ok(());
    }
    let mut first: Option<Vector3<f64>> = None;
    for tumble in &records.tumbles {
        let of_record = |error| CarrierError::Record { attached: tumble.attached, error: Box::new(error) };
        if tumble.record.segments.iter().any(|s| s.torque().is_some()) {
            return Err(of_record(FitError::WheelWithTorques));
        }
        if !wheels(&tumble.record) {
            return Err(of_record(FitError::NoWheelSpeed));
        }
        for axis in tumble.record.segments.iter().filter_map(Segment::wheel).flatten() {
            let Some(axis) = axis.try_normalize(0.0) else { continue };
            let angle = first.get_or_insert(axis).cross(&axis).norm();
            if angle > PARALLEL {
                return Err(CarrierError::WheelAxis { attached: tumble.attached, angle });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::carrier::records::Attached;

    fn segment() -> Segment {
        Segment::new("bench", vec![0.0, 1.0, 2.0], vec![Vector3::x(); 3]).unwrap()
    }

    fn record(momenta: [Vector3<f64>; 3]) -> Record {
        let mut record = Record::default();
        record.segments.push(segment().with_wheel(momenta.to_vec()).unwrap());
        record
    }

    /// Momenta of one wheel lie along one line, whatever their size and sense; rounding turns them by less than 1e-9.
    #[test]
    fn one_unknown_wheel_has_one_axis() {
        let axis = Vector3::new(0.0, 3.0, 4.0);
        let carrier = record([Vector3::zeros(), axis, axis * -7.0]);
        let with = |angle: f64| {
            let tilted = Vector3::new(angle, 0.6, 0.8) * 9.0;
            CarrierRecords::new(carrier.clone()).with_object(record([axis, tilted, Vector3::zeros()]))
        };
        assert_eq!(check_wheels(&with(5e-10).with_unknown_wheel()), Ok(()));
        let found = check_wheels(&with(2e-9).with_unknown_wheel());
        let Err(CarrierError::WheelAxis { attached: Attached::Object, angle }) = found else {
            panic!("{found:?}")
        };
        assert!((angle / 2e-9 - 1.0).abs() < 1e-6, "{angle:e}");
        // of a known momentum the axis is known too
        assert_eq!(check_wheels(&with(1.0)), Ok(()));
    }

    /// Either all records have a wheel or none; what looks for its inertia needs one, and no torque beside it.
    #[test]
    fn all_records_have_the_wheel_or_none() {
        let wheel = record([Vector3::z(); 3]);
        let mut none = Record::default();
        none.segments.push(segment());
        let mut pushed = Record::default();
        let both = segment().with_wheel(vec![Vector3::z(); 3]).unwrap();
        pushed.segments.push(both.with_torque(vec![Vector3::x(); 3]).unwrap());
        let check = |carrier: &Record, object: &Record, unknown: bool| {
            let records = CarrierRecords::new(carrier.clone()).with_object(object.clone());
            check_wheels(&if unknown { records.with_unknown_wheel() } else { records })
        };
        let (nothing, object) = (Attached::Nothing, Attached::Object);
        assert_eq!(check(&wheel, &none, false), Err(CarrierError::Wheels { with: nothing, without: object }));
        assert_eq!(check(&none, &wheel, false), Err(CarrierError::Wheels { with: object, without: nothing }));
        assert_eq!((check(&none, &none, false), check(&wheel, &pushed, false)), (Ok(()), Ok(())));
        let of = |attached, error| Err::<(), _>(CarrierError::Record { attached, error: Box::new(error) });
        assert_eq!(check(&none, &none, true), of(nothing, FitError::NoWheelSpeed));
        assert_eq!(check(&wheel, &pushed, true), of(object, FitError::WheelWithTorques));
    }
}
