//! What a fit takes to be zero, and what would explain the record better.

use crate::columns::column::Column;
use crate::columns::offset::Offset;
use crate::columns::rotor::Rotor;
use crate::columns::sets::{axis_scales, magnet_columns, misalignments};
use crate::columns::skew::Skew;
use crate::report::parts::quantile;
use crate::signal::stretch::Stretch;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::errors::LARGEST;
use crate::thresholds::warnings::{LEFT_OUT, SENSOR};

/// Errors or torques of one kind that would explain a record better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Suspect {
    /// What they are, in words.
    pub(crate) what: &'static str,
    /// What helps, in words that go on from what the tensor may be.
    pub(crate) remedy: &'static str,
    /// The largest of them.
    pub(crate) size: f64,
    /// Its unit, empty for a ratio.
    pub(crate) unit: &'static str,
    /// Gain of log-likelihood with the torque noise as it was fitted without them.
    pub(crate) gain: f64,
}

/// What may be left out of a fit, with its columns and what to do about it.
struct Kind {
    what: &'static str,
    remedy: &'static str,
    columns: Vec<Column>,
    /// Standard deviation of each column.
    prior: Option<f64>,
}

const FIT_IT: &str = ", unless they are fitted too, with a prior";

fn kinds(stretches: &[Stretch], errors: &[Column]) -> Vec<Kind> {
    let sensor = |what, columns| Kind { what, remedy: FIT_IT, columns, prior: None };
    let other = |what, columns| Kind { remedy: "", ..sensor(what, columns) };
    let axes = |what, columns| Kind { prior: Some(LARGEST), ..sensor(what, columns) };
    let walk = errors.iter().copied().filter(|column| column.label().name.starts_with("walk"));
    vec![
        axes("a misalignment of the axes of the sensor", misalignments()),
        axes("relative errors of scale of the axes of the sensor", axis_scales()),
        sensor("offsets of the sensor", (0..3).map(|k| Column::new(Offset(k), None)).collect()),
        sensor("delays of the axes of the sensor", [1, 2].map(|k| Column::new(Skew(k), None)).to_vec()),
        other("offsets of the sensor that change", walk.collect()),
        other("a wheel that turns in the body", (0..3).map(|k| Column::new(Rotor(k), None)).collect()),
        other(
            "a torque that is fixed in space, as on a magnet or of a suspension",
            magnet_columns(stretches),
        ),
    ]
}

/// What the fit takes to be zero and the record does not: of all that it shows by more than chance brings, what explains most.
///
/// `whitened` are the rows of each stretch with the columns `columns`, of which the first `errors` are those that the fit takes
/// to be zero; `rms` is the unit rate, rad/s.
pub(crate) fn suspect(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    columns: &[Column],
    errors: usize,
    whitened: &[Vec<f64>],
    (variance, rms): (f64, f64),
) -> Option<Suspect> {
    let is_noisy = weak.has_torque_noise();
    let kinds = kinds(stretches, &columns[..errors]).into_iter();
    let each = kinds.filter_map(|kind| {
        let Kind { what, remedy, prior, .. } = kind;
        let label = kind.columns.first()?.label();
        let place = |column: &Column| columns[..errors].iter().position(|own| own.is_alike(column));
        let first = kind.columns.iter().map(place).collect::<Option<Vec<usize>>>()?;
        let (size, gain) = gain_of(weak, columns, (&first, prior), errors, whitened, variance)?;
        let by_chance = 0.5 * quantile(first.len() as f64, LEFT_OUT);
        // torques of real bodies, of which some look like torque noise, are not those of the fit either
        let least = if is_noisy { by_chance.max(SENSOR) } else { by_chance };
        let size = size * label.factor(rms);
        let suspect = Suspect { what, remedy, size, unit: label.unit, gain };
        (gain > least).then_some((gain - first.len() as f64, suspect))
    });
    // more unknowns explain more in any case
    each.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, suspect)| suspect)
}

/// The largest of the errors `first`, each with a `prior`, and the gain of log-likelihood by all of them.
fn gain_of(
    weak: &WeakEstimate,
    columns: &[Column],
    (first, prior): (&[usize], Option<f64>),
    errors: usize,
    whitened: &[Vec<f64>],
    variance: f64,
) -> Option<(f64, f64)> {
    let kept: Vec<usize> = first.iter().copied().chain(errors..columns.len() + 6).collect();
    let rows: Vec<Vec<f64>> = whitened
        .iter()
        .map(|rows| {
            rows.chunks_exact(columns.len() + 6).flat_map(|row| kept.iter().map(|&k| row[k])).collect()
        })
        .collect();
    let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
    let tried = first.iter().map(|&k| columns[k].with_prior(prior));
    let with: Vec<Column> = tried.chain(weak.columns.iter().copied()).collect();
    let mut at = weak.at.clone();
    at.c = vec![0.0; first.len()].into_iter().chain(at.c).collect();
    let stacked = Stacked::new(&rows, &with, &at, variance.sqrt());
    let gain = 0.5 * (weak.squares - stacked.squares) / variance;
    let best = stacked.minimiser()?;
    let size = best.c[..first.len()].iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    Some((size, gain))
}
