//! The segments of a record, each with its noise and what it contributes.

use polhode::record::Record;

use crate::physical::coordinates::Form;
use crate::report::nuisance::SegmentSummary;
use crate::signal::covariance::Shape;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::{Part, WeakEstimate};

/// One summary for each stretch of a weak estimate; `variance` is that of the noise in units of the rate `rms`.
pub(crate) fn summaries(
    weak: &WeakEstimate,
    record: &Record,
    variance: f64,
    rms: f64,
) -> Vec<SegmentSummary> {
    let Some(stacked) = &weak.stacked else { return Vec::new() };
    let total = stacked.information();
    let stack = |parts: &[&Part]| {
        let rows: Vec<&[f64]> = parts.iter().map(|part| part.rows.as_slice()).collect();
        Stacked::new(&rows, &weak.columns, &stacked.origin, variance.sqrt())
    };
    let each = weak.parts.iter().enumerate().map(|(k, part)| {
        let rest: Vec<&Part> =
            weak.parts.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, p)| p).collect();
        let others = (!rest.is_empty()).then(|| stack(&rest));
        // what the others leave of the information that all have together
        let kept = others.as_ref().map_or(Form::zeros(), Stacked::information);
        let weight = total.cholesky().map_or(0.0, |total| 1.0 - total.solve(&kept).trace() / 5.0);
        let without = others.and_then(|others| others.minimiser());
        let shift = without.map_or(0.0, |without| (stacked.root * (without.x - weak.x())).norm());
        let levels = part.levels;
        let share = match levels.shape {
            Shape::Moments => 1.0,
            Shape::Alike => 1.0 / 9.0,
        };
        SegmentSummary {
            segment: part.stretch,
            samples: record.segments[part.stretch].times().len(),
            noise_sigma: (levels.white * variance).sqrt() * rms,
            torque_noise: levels.torque * share * variance * rms * rms * rms,
            weight,
            shift: shift / variance.sqrt(),
        }
    });
    let mut summaries: Vec<SegmentSummary> = each.collect();
    let sum: f64 = summaries.iter().map(|s| s.weight).sum();
    if sum > 0.0 {
        summaries.iter_mut().for_each(|s| s.weight /= sum);
    }
    summaries
}
