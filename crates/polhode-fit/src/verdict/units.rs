//! Whether a record is in the units in which it was read.

use polhode::record::{Record, Segment, median};

use crate::error::FitError;
use crate::signal::stretch::Stretch;
use crate::units::{Motion, Others, Units};

/// Refuses units that are mistaken, or in which the body turns too far between samples; units that explain the record as well
/// as those that were read.
pub(crate) fn open_units(
    record: &Record,
    stretches: &[Stretch],
    motion: Option<&Motion>,
    rms: f64,
) -> Result<Option<Others>, FitError> {
    let [turn, step] = steps(stretches);
    let units = motion.map(|motion| {
        let read = record.segments.iter().find_map(Segment::rate_unit).unwrap_or_default();
        let steps = record.segments.iter().flat_map(|s| s.times().windows(2)).map(|t| t[1] - t[0]);
        motion.units(read, turn, steps.into_iter().all(|step| step == 1.0))
    });
    match units {
        Some(Units::Mistaken(others)) => Err(FitError::Units {
            products: others.products,
            unexplained: others.as_read,
            better: others.best,
        }),
        _ if turn > core::f64::consts::PI => Err(FitError::Undersampled { turn, step: step / rms }),
        Some(Units::Open(others)) => Ok(Some(others)),
        Some(Units::AsRead) | None => Ok(None),
    }
}

/// Medians of |ω| Δt and of Δt.
fn steps(stretches: &[Stretch]) -> [f64; 2] {
    let each = stretches.iter().flat_map(|s| s.times.windows(2).zip(&s.rates));
    let (mut turns, mut steps): (Vec<f64>, Vec<f64>) =
        each.map(|(t, w)| ((t[1] - t[0]) * w.norm(), t[1] - t[0])).unzip();
    [&mut turns, &mut steps].map(|list| median(list).unwrap_or(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn stretch(size: f64) -> Stretch {
        let rates = [5.0, 2.0, 1.0, 9.0].map(|rate| Vector3::new(0.0, -rate * size, 0.0));
        Stretch::new(vec![0.0, 1.0, 3.0, 6.0], rates.to_vec())
    }

    /// The middle of the turns 5, 4 and 3 and of the steps 1, 2 and 3; the last rate turns nothing.
    #[test]
    fn turns_and_steps_are_medians() {
        assert_eq!(steps(&[stretch(1.0)]), [4.0, 2.0]);
        // with a slow stretch beside it: 0, 0, 0, 3, 4, 5
        assert_eq!(steps(&[stretch(1.0), stretch(0.0)]), [3.0, 2.0]);
        assert_eq!(steps(&[]), [0.0, 0.0]);
        assert_eq!(steps(&[Stretch::new(vec![0.0], vec![Vector3::x()])]), [0.0, 0.0]);
    }

    /// A body that turns by more than half a turn between samples is refused with its step in seconds.
    #[test]
    fn half_a_turn_between_samples_is_too_far() {
        let open = |size: f64| open_units(&Record::default(), &[stretch(size)], None, 4.0);
        assert_eq!(open(0.785), Ok(None));
        assert_eq!(open(0.786), Err(FitError::Undersampled { turn: 4.0 * 0.786, step: 0.5 }));
    }
}
