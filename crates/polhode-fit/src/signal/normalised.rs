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
