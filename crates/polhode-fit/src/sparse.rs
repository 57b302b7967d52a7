//! Rates so far apart that no test function has enough of them: the likelihood on the exact motion, which needs no quadrature.

use nalgebra::Vector3;
use polhode::record::{Record, Segment};
use polhode::rotation::Quat;

use crate::likelihood::choice::{Found, Moved, steady_within_noise, with_torque};
use crate::likelihood::descent::Levels;
use crate::likelihood::growth::follow;
use crate::likelihood::invariants::tensors_of;
use crate::likelihood::track::Track;
use crate::poses::free::{Free, Read};
use crate::report::estimate::Estimate;
use crate::report::exact::{Told, report};
use crate::settings::Settings;
use crate::settings::torque::{TorqueModel, TorqueNoise};
use crate::thresholds::bound::LEFT;
use crate::thresholds::identifiability::VAGUE;
use crate::thresholds::likelihood::SPARSE;
use crate::thresholds::noise::LEAST;
use crate::thresholds::poses::{FEWEST, OPEN};

/// The answer of the likelihood, where the rates are sparse and a motion explains them.
pub(crate) fn likeliest(record: &Record, settings: &Settings) -> Option<Estimate> {
    if is_sparse(record) && is_plain(record, settings) { explained(record, settings) } else { None }
}

/// Whether the body turns far from one sample to the next, at the median.
pub(crate) fn is_sparse(record: &Record) -> bool {
    let steps = record.segments.iter().flat_map(|s| s.times().windows(2).zip(s.rates()));
    let (mut all, mut far) = (0, 0);
    for (t, w) in steps {
        all += 1;
        far += usize::from((t[1] - t[0]) * w.norm() > SPARSE);
    }
    // the middle one of all in their order is far where no more than those before it are near
    all > 0 && all - far <= all / 2
}

/// Whether nothing is asked for that only the weak form has.
fn is_plain(record: &Record, settings: &Settings) -> bool {
    let torque = [TorqueModel::Auto, TorqueModel::None, TorqueModel::Drag, TorqueModel::Constant];
    settings.radius.is_none()
        && settings.sensor.named().iter().all(|(_, value)| value.is_none())
        && torque.contains(&settings.torque)
        && !matches!(settings.torque_noise, TorqueNoise::Given(_))
        && record.segments.iter().all(|s| s.inputs().is_none())
}

/// `None` where no motion explains the rates, or one and its mirror image do alike.
fn explained(record: &Record, settings: &Settings) -> Option<Estimate> {
    let long = record.segments.iter().enumerate().filter(|(_, s)| s.times().len() >= FEWEST);
    let long: Vec<(usize, &Segment)> = long.collect();
    let count = long.iter().map(|(_, s)| s.times().len()).sum::<usize>() as f64;
    let rates: Vec<&[Vector3<f64>]> = long.iter().map(|(_, s)| s.rates()).collect();
    let squares: f64 = rates.iter().flat_map(|rates| rates.iter()).map(Vector3::norm_squared).sum();
    let unit = (squares / count).sqrt();
    if !unit.is_normal() {
        return None;
    }
    let middle = |s: &Segment| 0.5 * (s.times()[0] + s.times()[s.times().len() - 1]);
    let track = |s: &Segment| Track {
        times: s.times().iter().map(|t| (t - middle(s)) * unit).collect(),
        attitudes: Vec::new(),
        rates: s.rates().iter().map(|w| w / unit).collect(),
        used: vec![true; s.times().len()],
    };
    let tracks: Vec<Track> = long.iter().map(|(_, s)| track(s)).collect();
    let noise = settings.noise.map_or(LEAST.sqrt(), |noise| noise / unit);
    let levels = Levels { attitude: 0.0, rate: noise };
    let scaled: Vec<Vec<Vector3<f64>>> = tracks.iter().map(|track| track.rates.clone()).collect();
    let slices: Vec<&[Vector3<f64>]> = scaled.iter().map(Vec::as_slice).collect();
    let each = tensors_of(&slices).into_iter().filter_map(|first| {
        let moved = |drag| Some(Moved::new(follow(&tracks, first, Quat::identity(), levels, drag)?));
        with_torque(settings.torque, moved)
    });
    let mut each: Vec<Found> = each.collect();
    each.sort_by(|a, b| a.moved.followed.cost().total_cmp(&b.moved.followed.cost()));
    if let [first, second, ..] = &each[..] {
        let apart = (first.moved.followed.model.x - second.moved.followed.model.x).norm();
        let gain = 0.5 * (second.moved.followed.cost() - first.moved.followed.cost());
        // both starts may lead to one motion
        if gain <= OPEN && apart > VAGUE {
            return None;
        }
    }
    let Found { moved, torque, gain, without, models } = each.into_iter().next()?;
    let Moved { followed, alternatives } = moved;
    if !explains(&tracks, followed.levels.rate) {
        return None;
    }
    let settings = &with_rounding(record, settings, followed.levels.rate * unit);
    let steady = steady_within_noise(&followed);
    let free = Free {
        steady,
        followed,
        torque,
        gain,
        without,
        models,
        alternatives,
        moving: None,
        misread: None,
        read: Read {
            unit,
            used: long.iter().map(|(k, s)| (*k, middle(s))).collect(),
            local_noise: None,
            rate_noise: None,
            largest_turn: 0.0,
            jumps: 0,
            has_rates: true,
        },
    };
    let told = Told { is_inverse: false, gain: None };
    let estimate = free.is_explained(settings).then(|| report(0, settings, &free, told).ok()).flatten();
    let mut estimate = estimate.filter(|estimate| !estimate.whiteness.significant())?;
    estimate.quanta = settings.quantum.map_or_else(|| record.quanta().into(), |quantum| [quantum; 3]);
    Some(estimate)
}

/// With the rounding of readings whose step is given as part of the noise; `left` is what the motion leaves of a component, rad/s.
fn with_rounding(record: &Record, settings: &Settings, left: f64) -> Settings {
    let Some(quantum) = settings.quantum else { return settings.clone() };
    let rounding = record.rounding(&Vector3::repeat(quantum));
    let noise = match settings.noise {
        Some(noise) => Some((noise * noise + rounding).sqrt()),
        // what is left holds it already, where it is not less
        None => Some(rounding.sqrt()).filter(|rounding| *rounding > left),
    };
    settings.clone().with_noise(noise)
}

/// Whether the motion leaves no more than a part of how the rates vary.
fn explains(tracks: &[Track], level: f64) -> bool {
    let (mut variation, mut components) = (0.0, 0.0);
    for track in tracks {
        let count = track.rates.len() as f64;
        let mean = track.rates.iter().sum::<Vector3<f64>>() / count;
        variation += track.rates.iter().map(|w| (w - mean).norm_squared()).sum::<f64>();
        components += 3.0 * count;
    }
    level * level * components <= LEFT * variation
}
