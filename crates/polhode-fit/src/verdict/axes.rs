//! Whether each axis of the sensor reads the motion.

use polhode::record::{Record, Segment};

use crate::error::FitError;
use crate::signal::noise::white;
use crate::signal::stretch::Stretch;
use crate::thresholds::axes::{FEWEST, LEAST};
use crate::thresholds::filtered::DITHERED;

/// Axes of which there are three pairs.
const PAIRS: [(usize, usize); 3] = [(0, 1), (1, 2), (2, 0)];

/// Refuses a segment in which one axis reads one number, or what another axis reads, while the readings have a noise beyond their steps.
pub(crate) fn check_axes(record: &Record) -> Result<(), FitError> {
    for (k, s) in record.segments.iter().enumerate().filter(|(_, s)| s.times().len() >= FEWEST) {
        let rates = s.rates();
        let held = (0..3).find(|&axis| rates.iter().all(|w| w[axis] == rates[0][axis]));
        let is_pair = |(a, b): &(usize, usize)| {
            rates.iter().all(|w| w[*a] == w[*b]) || rates.iter().all(|w| w[*a] == -w[*b])
        };
        let pair = PAIRS.into_iter().find(is_pair);
        if held.is_none() && pair.is_none() {
            continue;
        }
        let Some(noise) = noise_beyond_steps(s, held) else { continue };
        let (samples, from) = (rates.len(), s.times().first().copied().unwrap_or(0.0));
        let place = format!("segment {} ({}, from {from} s)", k + 1, s.source());
        let name = |axis: usize| ['x', 'y', 'z'][axis];
        if let Some(axis) = held {
            let (value, axis) = (rates[0][axis], name(axis));
            return Err(FitError::HeldAxis { place, axis, value, samples, noise });
        }
        if let Some((a, b)) = pair {
            return Err(FitError::SameAxes { place, axes: [name(a), name(b)], samples, noise });
        }
    }
    Ok(())
}

/// Deviation of the noise of the axes that read, rad/s, where it is white and more than half of any step that their readings may have: on
/// coarser steps a quiet axis may rest.
fn noise_beyond_steps(s: &Segment, held: Option<usize>) -> Option<f64> {
    let rates = s.rates();
    let variance = white(&[Stretch::new(s.times().to_vec(), rates.to_vec())])?;
    // it is the mean of three axes
    let own = if held.is_some() { 1.5 * variance } else { variance };
    let step = |axis: usize| {
        let mut values: Vec<f64> = rates.iter().map(|w| w[axis]).collect();
        values.sort_by(f64::total_cmp);
        let apart = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|apart| *apart > 0.0);
        apart.fold(f64::INFINITY, f64::min)
    };
    let largest = (0..3).filter(|axis| held != Some(*axis)).map(step).fold(0.0, f64::max);
    let square = rates.iter().map(|w| w.norm_squared()).sum::<f64>() / rates.len() as f64;
    let is_more = own > DITHERED * largest * largest / 12.0 && own > LEAST * LEAST * square;
    is_more.then(|| own.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// A slow motion with noise of one deviation, whose readings are then changed.
    fn read(noise: f64, count: u32, change: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Result<(), FitError> {
        let times: Vec<f64> = (0..count).map(|k| 0.01 * f64::from(k)).collect();
        let one = |k: u32| {
            let (t, square) = (0.01 * f64::from(k), f64::from(k * k));
            let base = Vector3::new(
                0.3 + 0.01 * libm::sin(t),
                0.4 + 0.01 * libm::cos(t),
                4.0 + 0.1 * libm::sin(2.0 * t),
            );
            // chirps, which are white
            let [x, y, z] = [(1.7, 0.0), (0.9, 1.0), (2.6, 2.0)].map(|(f, at)| libm::sin(f * square + at));
            change(base + Vector3::new(x, y, z) * (noise * core::f64::consts::SQRT_2))
        };
        let segment = Segment::new("a.csv", times, (0..count).map(one).collect()).unwrap();
        let mut record = Record::default();
        record.segments.push(segment);
        check_axes(&record)
    }

    /// An axis that is held reads nothing where the others have noise, and neither does one that reads what another one reads.
    #[test]
    fn axes_that_read_nothing_are_refused_beside_noise() {
        let held = read(0.01, 300, |w| Vector3::new(w.x, w.y, 3.5));
        let Err(FitError::HeldAxis { place, axis: 'z', value: 3.5, samples: 300, noise }) = held else {
            panic!("{held:?}")
        };
        assert!(
            place == "segment 1 (a.csv, from 0 s)" && (noise / 0.01 - 1.0).abs() < 0.15,
            "{place} {noise}"
        );
        for sign in [1.0, -1.0] {
            let same = read(0.01, 300, |w| Vector3::new(w.x, sign * w.x, w.z));
            let Err(FitError::SameAxes { axes: ['x', 'y'], samples: 300, .. }) = same else {
                panic!("{same:?}")
            };
        }
        assert_eq!(read(0.01, 300, |w| w), Ok(()));
        // of a size, and not of one sign
        assert_eq!(read(0.01, 300, |w| Vector3::new(w.x - 0.3, (w.x - 0.3).abs(), w.z)), Ok(()));
    }

    /// Few readings may be alike; so may those of a quiet axis on steps of more than twice the noise, and all of a motion without noise.
    #[test]
    fn a_quiet_axis_may_rest() {
        let held = |noise: f64, count: u32, step: f64| {
            let stepped = |x: f64| if step > 0.0 { (x / step).round() * step } else { x };
            read(noise, count, |w| Vector3::new(stepped(w.x), stepped(w.y), 4.0))
        };
        assert!(held(0.01, 49, 0.0).is_ok() && held(0.01, 50, 0.0).is_err());
        assert!(held(0.01, 300, 0.03).is_ok() && held(0.01, 300, 0.01).is_err());
        assert!(held(0.0, 300, 0.0).is_ok());
        // as of digits that were left out
        assert!(held(3e-5, 300, 0.0).is_ok() && held(5e-5, 300, 0.0).is_err());
    }
}
