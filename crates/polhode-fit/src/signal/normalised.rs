//! A record in its own units.

use nalgebra::Vector3;
use polhode::record::{Record, Segment};
use polhode::units::RateUnit;

use crate::error::FitError;
use crate::signal::stretch::{KnownInputs, Stretch};
use crate::thresholds::test_functions::SAMPLES_PER_TEST;

/// A record in units of its own mean square rate and of the time in which the body turns by one radian.
pub(crate) struct Normalised {
    pub(crate) stretches: Vec<Stretch>,
    /// Root mean square rate, rad/s.
    pub(crate) rms: f64,
    /// Unit of wheel momenta over rates and of torques over their squares, kg m², where the record has any.
    pub(crate) input: Option<f64>,
}

pub(crate) fn normalised(record: &Record) -> Result<Normalised, FitError> {
    let samples = record.samples();
    let longest = record.segments.iter().map(|s| s.times().len()).max().unwrap_or(0);
    let needed = 2 * SAMPLES_PER_TEST as usize;
    if longest < needed {
        let (segments, saturated) = (record.segments.len(), record.saturated());
        return Err(FitError::TooFewSamples { samples, segments, longest, saturated, needed });
    }
    check_sensors(record)?;
    // the largest component first, so that squares neither over- nor underflow
    let rates = || record.segments.iter().flat_map(Segment::rates);
    let largest = rates().map(|w| w.amax()).fold(0.0, f64::max);
    if largest == 0.0 {
        return Err(FitError::NoRotation { rms: 0.0, noise: 0.0 });
    }
    let mean = rates().map(|w| (w / largest).norm_squared()).sum::<f64>() / samples as f64;
    let rms = largest * mean.sqrt();
    // the largest of them is 1
    let sizes = record.segments.iter().filter_map(Segment::inputs).flat_map(|inputs| {
        let wheel = inputs.wheel.iter().map(|h| h.amax() / rms);
        wheel.chain(inputs.torque.iter().map(|torque| torque.amax() / rms / rms))
    });
    let input = Some(sizes.fold(0.0, f64::max)).filter(|size| size.is_normal());
    let segments = record.segments.iter().enumerate();
    let parts = segments.flat_map(|(segment, s)| s.stretches().map(move |range| (segment, s, range)));
    let stretches = parts.enumerate().map(|(index, (segment, s, range))| {
        let start = s.times().get(range.start).copied().unwrap_or(0.0);
        let times = s.times()[range.clone()].iter().map(|t| (t - start) * rms).collect();
        let rates = s.rates()[range.clone()].iter().map(|w| w / rms).collect();
        let inputs = input.map(|unit| {
            let scaled = |list: Option<&[Vector3<f64>]>, factor: f64| {
                list.map_or(vec![Vector3::zeros(); range.len()], |list| {
                    list[range.clone()].iter().map(|v| v / factor).collect()
                })
            };
            KnownInputs { wheel: scaled(s.wheel(), unit * rms), torque: scaled(s.torque(), unit * rms * rms) }
        });
        Stretch { inputs, index, segment, start, ..Stretch::new(times, rates) }
    });
    Ok(Normalised { stretches: stretches.collect(), rms, input })
}

/// Refuses segments of which only some have wheels or torques, or a unit.
fn check_sensors(record: &Record) -> Result<(), FitError> {
    let place = |k: usize| {
        let s = &record.segments[k];
        let from = s.times().first().copied().unwrap_or(0.0);
        format!("segment {} ({}, from {from} s)", k + 1, s.source())
    };
    type Has = fn(&Segment) -> bool;
    let kinds: [(&'static str, Has); 2] =
        [("wheel momenta", |s| s.wheel().is_some()), ("torques", |s| s.torque().is_some())];
    for (what, has) in kinds {
        let found = |wanted: bool| record.segments.iter().position(|s| has(s) == wanted);
        if let (Some(with), Some(without)) = (found(true), found(false)) {
            return Err(FitError::Sensors { what, with: place(with), without: place(without) });
        }
    }
    let units = || record.segments.iter().map(Segment::rate_unit).enumerate();
    let named = units().find_map(|(k, unit)| unit.filter(|u| *u != RateUnit::default()).map(|u| (k, u)));
    let unnamed = units().find(|(_, unit)| unit.is_none()).map(|(k, _)| k);
    if let (Some((named, unit)), Some(unnamed)) = (named, unnamed) {
        return Err(FitError::MixedUnits { named: place(named), unit, unnamed: place(unnamed) });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty samples a tenth of a second apart.
    fn segment(source: &str, from: f64, rate: Vector3<f64>) -> Segment {
        let times = (0..20).map(|k| from + 0.1 * f64::from(k)).collect();
        Segment::new(source, times, vec![rate; 20]).unwrap()
    }

    fn record(segments: [Segment; 2]) -> Record {
        let mut record = Record::default();
        record.segments.extend(segments);
        record
    }

    /// Rates of 5 rad/s are 1, times five times as long, each from its own start; of momenta over 5 and torques over 25 the largest is 1.
    #[test]
    fn a_record_is_measured_by_its_own_rate() {
        let one = segment("one", 2.0, Vector3::new(0.0, 3.0, -4.0));
        let one = one.with_wheel(vec![Vector3::new(20.0, -10.0, 0.0); 20]).unwrap();
        let one = one.with_torque(vec![Vector3::new(0.0, 0.0, -150.0); 20]).unwrap();
        let two = segment("two", 0.0, Vector3::new(-5.0, 0.0, 0.0));
        let two = two.with_wheel(vec![Vector3::z(); 20]).unwrap();
        let two = two.with_torque(vec![Vector3::zeros(); 20]).unwrap();
        let Normalised { stretches, rms, input } = normalised(&record([one, two])).ok().unwrap();
        assert!((rms - 5.0).abs() < 1e-14 && (input.unwrap() - 6.0).abs() < 1e-14, "{rms} {input:?}");
        let [one, two] = &stretches[..] else { panic!() };
        assert_eq!((one.index, one.segment, one.start), (0, 0, 2.0));
        assert_eq!((two.index, two.segment, two.start), (1, 1, 0.0));
        for s in &stretches {
            assert!(s.times[0] == 0.0 && (s.times[19] - 9.5).abs() < 1e-13, "{:?}", s.times);
        }
        assert!((one.rates[7] - Vector3::new(0.0, 0.6, -0.8)).amax() < 1e-14);
        assert!((two.rates[7] - Vector3::new(-1.0, 0.0, 0.0)).amax() < 1e-14);
        let (of_one, of_two) = (one.inputs.as_ref().unwrap(), two.inputs.as_ref().unwrap());
        assert!((of_one.wheel[3] - Vector3::new(20.0, -10.0, 0.0) / 30.0).amax() < 1e-14);
        assert!((of_one.torque[3] - Vector3::new(0.0, 0.0, -1.0)).amax() < 1e-14);
        assert!((of_two.wheel[3] - Vector3::z() / 30.0).amax() < 1e-14);
        assert_eq!(of_two.torque[3], Vector3::zeros());
    }

    /// Squares of rates neither under- nor overflow, and momenta that are zero have no unit.
    #[test]
    fn rates_of_any_size_have_a_mean_square() {
        for size in [1e-200, 1e200] {
            let segments = [Vector3::new(0.0, 0.6, 0.8), Vector3::x()].map(|rate| {
                let times = (0..20).map(|k| f64::from(k) / size).collect();
                let segment = Segment::new("any", times, vec![rate * size; 20]).unwrap();
                segment.with_wheel(vec![Vector3::zeros(); 20]).unwrap()
            });
            let Normalised { stretches, rms, input } = normalised(&record(segments)).ok().unwrap();
            assert!((rms / size - 1.0).abs() < 1e-14 && input.is_none(), "{rms:e} {input:?}");
            assert!(stretches.iter().all(|s| s.inputs.is_none()));
        }
    }

    /// Too few samples, no rotation, and segments of which only one has wheels or torques are refused with their places.
    #[test]
    fn records_without_a_unit_are_refused() {
        let refused = |segments: [Segment; 2]| normalised(&record(segments)).err().unwrap();
        let spin = |source: &str, from: f64| segment(source, from, Vector3::z());
        let short = |count: usize| {
            let times = (0..count).map(|k| k as f64).collect();
            Segment::new("short", times, vec![Vector3::z(); count]).unwrap()
        };
        let few = FitError::TooFewSamples { samples: 29, segments: 2, longest: 15, saturated: 0, needed: 16 };
        assert_eq!(refused([short(15), short(14)]), few);
        assert!(normalised(&record([short(16), short(3)])).is_ok());
        let still = [0.0, 3.0].map(|from| segment("still", from, Vector3::zeros()));
        assert_eq!(refused(still), FitError::NoRotation { rms: 0.0, noise: 0.0 });
        let (with, without) = ("segment 2 (two, from 0.5 s)".into(), "segment 1 (one, from 2 s)".into());
        let wheel = spin("two", 0.5).with_wheel(vec![Vector3::x(); 20]).unwrap();
        let expected = FitError::Sensors { what: "wheel momenta", with, without };
        assert_eq!(refused([spin("one", 2.0), wheel]), expected);
        let (with, without) = ("segment 1 (two, from 0.5 s)".into(), "segment 2 (one, from 2 s)".into());
        let torque = spin("two", 0.5).with_torque(vec![Vector3::x(); 20]).unwrap();
        let expected = FitError::Sensors { what: "torques", with, without };
        assert_eq!(refused([torque, spin("one", 2.0)]), expected);
    }
}
