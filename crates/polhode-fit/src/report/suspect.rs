//! What a fit takes to be zero, and what would explain the record better.

use crate::columns::column::{Column, Unknowns, terms_of_all};
use crate::columns::rotor::Rotor;
use crate::columns::scale::Scale;
use crate::columns::sets::{magnet_columns, told_components, walk_columns};
use crate::models::equations::Equations;
use crate::models::reading_error::{ReadingError, Units};
use crate::physical::coordinates::tensor;
use crate::report::next_step::Origin;
use crate::report::parts::{quantile, rows_between};
use crate::report::systematic::momentum;
use crate::signal::stretch::Stretch;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::errors::{LARGEST, LARGEST_MAGNET, RANDOM_WALK, WALK_STEPS};
use crate::thresholds::warnings::{LEFT_OUT, SENSOR};

/// Errors or torques of one kind that would explain a record better.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Suspect {
    /// What they are, in words.
    pub(crate) what: &'static str,
    /// Where they come from.
    pub(crate) origin: Origin,
    /// The largest of them.
    pub(crate) size: f64,
    /// Its unit, empty for a ratio.
    pub(crate) unit: &'static str,
    /// Gain of log-likelihood with the torque noise as it was fitted without them.
    pub(crate) gain: f64,
    /// Columns and coordinates of the estimate as they are with them, where the deviations of the answer are to reach there.
    pub(crate) reached: Option<Unknowns>,
}

/// What may be left out of a fit, with its columns.
struct Kind {
    what: &'static str,
    origin: Origin,
    /// Each with the deviation that is plausible for it.
    columns: Vec<Column>,
    /// The unit of the fit in that of the report.
    unit: (f64, &'static str),
}

/// What it is called that there is a wheel.
pub(crate) const ROTOR: &str = "a wheel that turns in the body";

/// All of them in a record whose unit of the rates is `rms`, rad/s.
fn kinds(weak: &WeakEstimate, stretches: &[Stretch], rms: f64) -> Vec<Kind> {
    let of = |what, origin, columns: Vec<Column>| {
        let unit =
            columns.first().map(Column::label).map_or((1.0, ""), |label| (label.factor(rms), label.unit));
        Kind { what, origin, columns, unit }
    };
    let units = Units { rms, input: terms_of_all(&weak.columns, &weak.at).input };
    let sensor = |error: ReadingError| of(error.in_words(), Origin::Sensor, error.columns(stretches, units));
    let sized = |column: Column, size| column.with_prior(Some(size));
    let walk = walk_columns(stretches, RANDOM_WALK / rms / rms.sqrt(), WALK_STEPS);
    let momentum = momentum(stretches, &tensor(&weak.x()));
    let rotors = [0, 1, 2].map(|k| Column::new(Rotor(k), None));
    let largest = LARGEST_MAGNET / rms / rms;
    let magnet = magnet_columns(stretches).into_iter().map(|column| sized(column, largest)).collect();
    let told = told_components(stretches).into_iter().filter(|_| units.input != 0.0).map(|axis| {
        let error = ReadingError::Wheel(axis);
        let (columns, unit) = (error.columns(stretches, units), (error.factor(units), "of it"));
        Kind { what: error.in_words(), origin: Origin::Wheels, columns, unit }
    });
    let all = [
        sensor(ReadingError::Misalignment),
        sensor(ReadingError::AxisScales),
        sensor(ReadingError::Offsets),
        sensor(ReadingError::Delays),
        of("changing offsets of the sensor", Origin::Drift, walk),
        of(ROTOR, Origin::Body, rotors.map(|column| sized(column, momentum)).to_vec()),
        of("a torque on a magnet in a field fixed in space, or by a suspension", Origin::Body, magnet),
    ];
    all.into_iter().chain(told).collect()
}

/// What the fit takes to be zero and the record does not: of all that it shows by more than chance brings, what explains most.
///
/// `equations` are those of the estimate; `rms` is the unit rate, rad/s.
pub(crate) fn suspect(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    equations: &Equations,
    (variance, rms): (f64, f64),
) -> Option<Suspect> {
    let errors = equations.errors();
    let whitened = equations.with_errors(&weak.columns)?;
    let is_noisy = weak.has_torque_noise();
    let tried = Tried { weak, errors, whitened: &whitened, variance };
    let each = kinds(weak, stretches, rms).into_iter().filter_map(|kind| {
        let (best, gain) = tried.with(&kind.columns)?;
        let Kind { what, origin, columns, unit } = kind;
        let by_chance = 0.5 * quantile(columns.len() as f64, LEFT_OUT);
        // torques of real bodies, of which some look like torque noise, are not those of the fit either
        let least = if is_noisy { by_chance.max(SENSOR) } else { by_chance };
        let (own, others) = best.c.split_at(columns.len());
        let size = own.iter().fold(0.0, |largest: f64, value| largest.max(value.abs())) * unit.0;
        let is_told = origin == Origin::Wheels;
        let reached = is_told.then(|| Unknowns { x: best.x, c: others.to_vec() });
        let suspect = Suspect { what, origin, size, unit: unit.1, gain, reached };
        (gain > least).then_some((gain - columns.len() as f64, suspect))
    });
    // more unknowns explain more in any case
    each.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, suspect)| suspect)
}

/// An error of the sensor that is larger than the deviation of its prior allows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Refuted {
    /// What it is, in words.
    pub(crate) what: &'static str,
    /// The largest of its components, with a plausible deviation.
    pub(crate) size: f64,
    /// The deviation that was given for it.
    pub(crate) prior: f64,
    /// The unit of both, empty for a ratio.
    pub(crate) unit: &'static str,
    /// Gain of log-likelihood by the plausible deviation, the torque noise as it was fitted without it.
    pub(crate) gain: f64,
}

/// Of the errors of the sensor that are fitted, the one that explains most with the deviation that is plausible for it in the place of a smaller
/// one that was given, where that is more than chance brings.
pub(crate) fn refuted(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    (variance, rms): (f64, f64),
) -> Option<Refuted> {
    let origin = &weak.stacked.as_ref()?.origin;
    // torques have no prior
    weak.columns.iter().find(|column| column.prior.is_some())?;
    let rows = rows_between(weak, [0.0, 1.0]);
    let solved = |columns: &[Column]| Stacked::new(&rows, columns, origin, variance.sqrt());
    let given = solved(&weak.columns);
    let units = Units { rms, input: terms_of_all(&weak.columns, &weak.at).input };
    let of = |error: ReadingError| (error.in_words(), error.columns(stretches, units));
    let all = [
        of(ReadingError::Offsets),
        ("a scale error of the sensor", vec![Column::new(Scale, Some(LARGEST))]),
        of(ReadingError::AxisScales),
        of(ReadingError::Misalignment),
        of(ReadingError::Delays),
    ];
    let each = all.into_iter().filter_map(|(what, plausible)| {
        let wider = |own: &Column| {
            let other = plausible.iter().find(|other| other.is_alike(own))?;
            other.prior.zip(own.prior).is_some_and(|(other, own)| other > own).then_some(*other)
        };
        let columns: Vec<Column> = weak.columns.iter().map(|own| wider(own).unwrap_or(*own)).collect();
        let places: Vec<usize> = (0..columns.len()).filter(|&k| wider(&weak.columns[k]).is_some()).collect();
        let own = weak.columns[*places.first()?];
        let free = solved(&columns);
        let at = free.minimiser()?;
        let gain = 0.5 * (given.squares - free.squares) / variance;
        let by_chance = 0.5 * quantile(places.len() as f64, LEFT_OUT);
        let least = if weak.has_torque_noise() { by_chance.max(SENSOR) } else { by_chance };
        let (label, unit) = (own.label(), own.label().factor(rms));
        let size = places.iter().fold(0.0, |largest: f64, &k| largest.max(at.c[k].abs())) * unit;
        let refuted = Refuted { what, size, prior: own.prior? * unit, unit: label.unit, gain };
        // what neither of them explains counts as noise
        (gain > least * free.excess(variance)).then_some(refuted)
    });
    each.max_by(|a, b| a.gain.total_cmp(&b.gain))
}

/// Gain of log-likelihood by an error of one component of the momentum of wheels, the torque noise as it was fitted without it.
pub(crate) fn gain_of_told(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    equations: &Equations,
    (variance, rms): (f64, f64),
    axis: usize,
) -> Option<f64> {
    let whitened = equations.with_errors(&weak.columns)?;
    let tried = Tried { weak, errors: equations.errors(), whitened: &whitened, variance };
    let kind = kinds(weak, stretches, rms)
        .into_iter()
        .find(|kind| kind.what == ReadingError::Wheel(axis).in_words())?;
    Some(tried.with(&kind.columns)?.1)
}

/// An estimate beside which errors are tried.
struct Tried<'a> {
    weak: &'a WeakEstimate,
    /// The columns of the rows that are errors, which are the first.
    errors: &'a [Column],
    whitened: &'a [Vec<f64>],
    variance: f64,
}

impl Tried<'_> {
    /// Where everything is best with these errors, which come before the columns of the estimate; and the gain of log-likelihood.
    fn with(&self, columns: &[Column]) -> Option<(Unknowns, f64)> {
        let Tried { weak, errors, whitened, variance } = *self;
        columns.first()?;
        let place = |column: &Column| errors.iter().position(|own| own.is_alike(column));
        let first = columns.iter().map(place).collect::<Option<Vec<usize>>>()?;
        let width = errors.len() + weak.columns.len() + 6;
        let kept: Vec<usize> = first.iter().copied().chain(errors.len()..width).collect();
        let pick = |rows: &Vec<f64>| -> Vec<f64> {
            rows.chunks_exact(width).flat_map(|row| kept.iter().map(|&k| row[k])).collect()
        };
        let rows: Vec<Vec<f64>> = whitened.iter().map(pick).collect();
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        let with: Vec<Column> = columns.iter().chain(&weak.columns).copied().collect();
        let mut at = weak.at.clone();
        at.c = vec![0.0; first.len()].into_iter().chain(at.c).collect();
        let stacked = Stacked::new(&rows, &with, &at, variance.sqrt());
        let gain = 0.5 * (weak.squares - stacked.squares) / variance;
        Some((stacked.minimiser()?, gain))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::drag::Drag;
    use crate::estimator::fitted;
    use crate::report::systematic::errors;
    use crate::settings::Settings;
    use crate::settings::sensor::SensorPriors;
    use crate::settings::torque::{TorqueModel, TorqueNoise};
    use crate::signal::normalised::{Normalised, normalised};
    use crate::simulate::{Disturbances, Gyroscope, simulate, simulate_with};
    use nalgebra::Vector3;
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode::record::Record;

    /// Beside an estimate without a torque errors gain what they gain in the place of one, at the same tensor, and their units lead to SI.
    #[test]
    fn gains_beside_an_estimate_are_those_of_its_equations() {
        let (body, sigma) = (Inertia::from_moments([1.0, 2.0, 2.6]).unwrap(), 2e-3);
        let times: Vec<f64> = (0..600).map(|k| 0.05 * f64::from(k)).collect();
        let start = Vector3::new(1.0, 1.6, -0.8);
        let rates = simulate(&body, start, &times, sigma, &mut Random::new(4)).unwrap();
        let record = Record::from_samples(&times, &rates).unwrap();
        let settings = Settings::default().with_noise(sigma).with_torque(TorqueModel::None);
        let settings = settings.with_torque_noise(TorqueNoise::None).with_check_units(false);
        let weak = fitted(&record, &settings).unwrap().drawn.unwrap().weak;
        let Normalised { stretches, rms, .. } = normalised(&record).unwrap();
        let variance = (sigma / rms) * (sigma / rms);
        let own = errors(&[], &stretches, rms);
        let equations = Equations::new(&stretches, &weak, &own, &[], variance).unwrap();
        let whitened = equations.with_errors(&[]).unwrap();
        let tried = Tried { weak: &weak, errors: equations.errors(), whitened: &whitened, variance };
        let kinds = kinds(&weak, &stretches, rms);
        let units: Vec<(f64, &str)> = kinds.iter().map(|kind| kind.unit).collect();
        // misalignments, scales, offsets, delays, walks, wheels, magnets
        let expected = [
            (1.0, "rad"),
            (1.0, ""),
            (rms, "rad/s"),
            (1.0 / rms, "s"),
            (rms, "rad/s"),
            (1.0, "of |L|"),
            (rms * rms, "rad/s^2"),
        ];
        assert_eq!(units, expected);
        for kind in &kinds {
            let (at, gain) = tried.with(&kind.columns).unwrap();
            let alone = equations.of_errors(&kind.columns).unwrap().stacked();
            let expected = 0.5 * (weak.squares - alone.squares) / variance;
            let near = 1e-6 * (1.0 + expected.abs());
            assert!((gain - expected).abs() < near, "{}: {gain} {expected}", kind.what);
            // more unknowns leave no more, but for what the last round would have moved the estimate by
            assert!(at.c.len() == kind.columns.len() && gain > -0.1, "{}: {gain}", kind.what);
            let apart = (alone.root * (at.x - alone.minimiser().unwrap().x)).norm();
            assert!(apart < 1e-3 * variance.sqrt(), "{}: {apart:e}", kind.what);
        }
        assert!(tried.with(&[]).is_none() && tried.with(&[Column::new(Drag, None)]).is_none());
    }

    /// An error of scale v that the readings tell with the deviation s leaves v²/(s² + d²) over its prior d: what a plausible deviation gains over a
    /// smaller one is half of the difference, and the smaller one is refuted from the gain on that chance brings. The record then tells v L²/(s² + L²).
    #[test]
    fn a_prior_is_refuted_by_the_gain_of_a_plausible_one() {
        let (body, sigma) = (Inertia::from_moments([1.0, 2.0, 2.6]).unwrap(), 2e-3);
        let times: Vec<f64> = (0..600).map(|k| 0.05 * f64::from(k)).collect();
        let (start, none) = (Vector3::new(1.0, 1.6, -0.8), Disturbances::default());
        let gyroscope = Gyroscope::default().with_noise(sigma).with_scale(0.04);
        let rates = simulate_with(&body, start, &times, &none, &gyroscope, &mut Random::new(4)).unwrap();
        let record = Record::from_samples(&times, &rates).unwrap();
        let settings = Settings::default().with_noise(sigma).with_torque(TorqueModel::None).with_radius(0.5);
        let settings = settings.with_torque_noise(TorqueNoise::None).with_check_units(false);
        let settings = settings.with_sensor(SensorPriors::default().with_scale(LARGEST));
        let mut weak = fitted(&record, &settings).unwrap().drawn.unwrap().weak;
        let Normalised { stretches, rms, .. } = normalised(&record).unwrap();
        let variance = (sigma / rms) * (sigma / rms);
        assert_eq!(refuted(&weak, &stretches, (variance, rms)), None);

        let of = |prior: Option<f64>| {
            let columns = [Column::new(Scale, prior)];
            let origin = &weak.stacked.as_ref().unwrap().origin;
            Stacked::new(&rows_between(&weak, [0.0, 1.0]), &columns, origin, variance.sqrt())
        };
        let free = of(None);
        let (v, factor) = (free.minimiser().unwrap().c[0], free.joint_factor().unwrap());
        let square = factor.row(0).norm_squared() * variance;
        let excess = of(Some(LARGEST)).excess(variance);
        let of_plausible = v * v / (square + LARGEST * LARGEST);
        let by_chance = quantile(1.0, LEFT_OUT) * excess;
        // v²/(s² + d²) less that is twice the gain
        let most = (v * v / (by_chance + of_plausible) - square).sqrt();
        weak.columns[0].prior = Some(1.001 * most);
        assert_eq!(refuted(&weak, &stretches, (variance, rms)), None);
        for prior in [0.999 * most, 0.5 * most] {
            weak.columns[0].prior = Some(prior);
            let found = refuted(&weak, &stretches, (variance, rms)).unwrap();
            let gain = 0.5 * (v * v / (square + prior * prior) - of_plausible);
            assert!((found.gain / gain - 1.0).abs() < 1e-5, "{prior}: {} {gain}", found.gain);
            let size = v.abs() * LARGEST * LARGEST / (square + LARGEST * LARGEST);
            assert!((found.size / size - 1.0).abs() < 1e-5 && found.prior == prior, "{found:?} {size}");
            assert_eq!((found.what, found.unit), ("a scale error of the sensor", ""));
        }
    }
}
