//! Errors of the sensor that explain a record better than the torques that a fit has found.

use crate::columns::column::Column;
use crate::columns::sets::{axis_scales, misalignments};
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::errors::LARGEST;
use crate::thresholds::warnings::SENSOR;

/// Errors of one kind that would explain a record better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Suspect {
    /// What they are, in words.
    pub(crate) what: &'static str,
    /// The largest of them.
    pub(crate) size: f64,
    /// Its unit, empty for a ratio.
    pub(crate) unit: &'static str,
    /// Gain of log-likelihood with the torque noise as it was fitted without them.
    pub(crate) gain: f64,
}

/// The likelier of misalignments and axis scales, where it brings more than torques of real bodies do.
///
/// `whitened` are the rows of each stretch with the columns `columns`, of which the first `errors` are those that the fit takes
/// to be zero.
pub(crate) fn suspect(
    weak: &WeakEstimate,
    columns: &[Column],
    errors: usize,
    whitened: &[Vec<f64>],
    variance: f64,
) -> Option<Suspect> {
    let kinds = [
        ("a misalignment of the axes of the sensor", misalignments()),
        ("relative errors of scale of the axes of the sensor", axis_scales()),
    ];
    let each = kinds.into_iter().filter_map(|(what, kind)| {
        let unit = kind.first()?.label().unit;
        let place = |column: &Column| columns[..errors].iter().position(|own| own.is_alike(column));
        let first = kind.iter().map(place).collect::<Option<Vec<usize>>>()?;
        let (size, gain) = gain_of(weak, columns, &first, errors, whitened, variance)?;
        (gain > SENSOR).then_some(Suspect { what, size, unit, gain })
    });
    each.max_by(|a, b| a.gain.total_cmp(&b.gain))
}

/// The largest of the errors `first` and the gain of log-likelihood by all of them, each with a prior.
fn gain_of(
    weak: &WeakEstimate,
    columns: &[Column],
    first: &[usize],
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
    let tried = first.iter().map(|&k| columns[k].with_prior(Some(LARGEST)));
    let with: Vec<Column> = tried.chain(weak.columns.iter().copied()).collect();
    let mut at = weak.at.clone();
    at.c = vec![0.0; first.len()].into_iter().chain(at.c).collect();
    let stacked = Stacked::new(&rows, &with, &at, variance.sqrt());
    let gain = 0.5 * (weak.squares - stacked.squares) / variance;
    let best = stacked.minimiser()?;
    let size = best.c[..first.len()].iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    Some((size, gain))
}
