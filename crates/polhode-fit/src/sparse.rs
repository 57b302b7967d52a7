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
use crate::report::exact::report;
use crate::report::likelihood::Told;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::sensor::SensorPriors;
    use crate::simulate::simulate;
    use polhode::inertia::Inertia;
    use polhode::num::Random;

    /// Of samples a second apart that turn by so much until the next.
    fn turning(turns: &[f64]) -> Segment {
        let times = (0..turns.len()).map(|k| 10.0 + k as f64).collect();
        Segment::new("a", times, turns.iter().map(|turn| Vector3::y() * *turn).collect()).unwrap()
    }

    fn of(segments: Vec<Segment>) -> Record {
        let mut record = Record::default();
        record.segments.extend(segments);
        record
    }

    /// The median of the turns from one sample to the next decides, the upper one of an even number; a tenth of a turn is 0.6283 rad.
    #[test]
    fn rates_are_sparse_beyond_a_tenth_of_a_turn() {
        let is = |all: &[&[f64]]| is_sparse(&of(all.iter().map(|turns| turning(turns)).collect()));
        // after the last sample nothing is known
        assert!(is(&[&[0.63, 0.0]]) && !is(&[&[0.62, 9.0]]));
        assert!(is(&[&[0.7, 0.1, 0.0]]) && !is(&[&[0.7, 0.1, 0.1, 0.0]]));
        assert!(is(&[&[0.7, 0.1, 0.7, 0.0]]) && is(&[&[0.1, 0.1, 0.0], &[0.7, 0.7, 0.0]]));
        assert!(!is(&[]) && !is(&[&[9.0]]));
    }

    /// The likelihood takes the torques that it has, and nothing that only the weak form has.
    #[test]
    fn what_only_the_weak_form_has_is_left_to_it() {
        let record = of(vec![turning(&[0.7, 0.7])]);
        let is = |settings: Settings| is_plain(&record, &settings);
        let plain = Settings::default;
        for (torque, expected) in [
            (TorqueModel::Auto, true),
            (TorqueModel::None, true),
            (TorqueModel::Drag, true),
            (TorqueModel::Constant, true),
            (TorqueModel::Drag3, false),
            (TorqueModel::Quadratic, false),
        ] {
            assert_eq!(is(plain().with_torque(torque)), expected, "{torque}");
        }
        assert!(is(plain().with_torque_noise(TorqueNoise::None)) && is(plain().with_noise(0.1)));
        assert!(!is(plain().with_torque_noise(TorqueNoise::Given(1e-6))) && !is(plain().with_radius(0.5)));
        assert!(!is(plain().with_sensor(SensorPriors::default().with_skew(1e-3))));
        let wheel = turning(&[0.7, 0.7]).with_wheel(vec![Vector3::z(); 2]).unwrap();
        assert!(!is_plain(&of(vec![turning(&[0.7, 0.7]), wheel]), &plain()));
    }

    /// A unit of time that is a power of two smaller changes no bit of the shape and of its deviations, and a noise that is given goes with it.
    #[test]
    fn sparse_rates_say_the_same_in_any_unit_of_time() {
        let body = Inertia::from_moments([1.0, 2.0, 2.6]).unwrap();
        let times: Vec<f64> = (0..124).map(|k| 0.65 * f64::from(k)).collect();
        let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 0.01, &mut Random::new(8)).unwrap();
        let told = |times_faster: f64| {
            let own_times = times.iter().map(|t| t / times_faster).collect();
            let own_rates = rates.iter().map(|w| w * times_faster).collect();
            let record = of(vec![Segment::new("a", own_times, own_rates).unwrap()]);
            explained(&record, &Settings::default().with_noise(0.01 * times_faster)).unwrap()
        };
        let (own, other) = (told(1.0), told(1024.0));
        assert_eq!((own.principal, own.sigma_principal), (other.principal, other.sigma_principal));
        assert_eq!((own.rms_rate * 1024.0, own.noise_sigma * 1024.0), (other.rms_rate, other.noise_sigma));
    }

    /// A step q of readings that all differ is noise of variance q²/12: beside a noise that is given, and where the motion leaves less.
    #[test]
    fn the_rounding_of_a_step_is_part_of_the_noise() {
        let rates = (0..4).map(|k| Vector3::repeat(f64::from(k))).collect();
        let record = of(vec![Segment::new("a", vec![0.0, 1.0, 2.0, 3.0], rates).unwrap()]);
        let plain = Settings::default();
        let stepped = plain.clone().with_quantum(0.6);
        let noise = |settings: &Settings, left: f64| with_rounding(&record, settings, left).noise;
        assert_eq!((noise(&plain, 0.1), noise(&plain.clone().with_noise(0.4), 0.1)), (None, Some(0.4)));
        let near = |found: Option<f64>, variance: f64| {
            found.is_some_and(|found| (found * found / variance - 1.0).abs() < 1e-12)
        };
        assert!(near(noise(&stepped.clone().with_noise(0.4), 9.0), 0.19));
        // 0.03 lies between the squares
        assert!(near(noise(&stepped, 0.17), 0.03) && noise(&stepped, 0.18).is_none());
        assert_eq!(with_rounding(&record, &stepped, 0.1).quantum, Some(0.6));
    }

    /// A twentieth of the squares about the mean of each track may be left: of ±1 about any mean 2 · 0.05 of six components.
    #[test]
    fn a_motion_explains_all_but_a_twentieth() {
        let track = |mean: f64| Track {
            times: vec![-0.5, 0.5],
            attitudes: Vec::new(),
            rates: [1.0, -1.0].map(|x| Vector3::new(mean + x, 0.0, mean)).to_vec(),
            used: vec![true; 2],
        };
        // the root of 0.1/6 is 0.1291
        for tracks in [vec![track(0.0)], vec![track(7.0)], vec![track(3.0), track(-5.0)]] {
            assert!(explains(&tracks, 0.129) && !explains(&tracks, 0.1295), "{}", tracks.len());
        }
    }
}
