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
