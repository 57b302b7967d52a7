//! The segments of a record, each with its noise and what it contributes.

use nalgebra::Matrix3;

use crate::physical::coordinates::{Coordinates, Form};
use crate::report::answer::ratios_of;
use crate::report::nuisance::{SegmentSummary, WithoutSegment};
use crate::signal::covariance::{Levels, acceleration_density};
use crate::signal::stretch::Stretch;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::{Part, WeakEstimate};

/// A segment, and what the others say.
pub(crate) struct Summary {
    /// Its torque noise is still that of an angular acceleration that is alike along all axes.
    own: SegmentSummary,
    levels: Levels,
    others: Option<Others>,
}

/// The tensor by all segments but one.
struct Others {
    x: Coordinates,
    /// Covariance of its coordinates, per variance of the noise.
    covariance: Form,
    /// Distance from that by all, in standard deviations of that.
    shift: f64,
}

impl Summary {
    /// Of a body of the tensor `j` with the trace 1, with deviations for noise of the variance `enlarged`, and what else is `added` to the
    /// covariance of the tensor.
    pub(crate) fn complete(self, j: &Matrix3<f64>, enlarged: f64, added: &Form) -> SegmentSummary {
        let Summary { own, levels, others } = self;
        let without = others.map(|others| {
            WithoutSegment::new(&others.x, &(others.covariance * enlarged + added), others.shift)
        });
        let torque_noise = own.torque_noise * acceleration_density(levels.shape, j);
        SegmentSummary { torque_noise, without, ..own }
    }
}

/// One summary for each of the stretches of a weak estimate; `variance` is that of the noise in units of the rate `rms`.
pub(crate) fn summaries(weak: &WeakEstimate, stretches: &[Stretch], variance: f64, rms: f64) -> Vec<Summary> {
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
        let without = || {
            let x = others.as_ref()?.minimiser()?.x;
            let shift = (stacked.root * (x - weak.x())).norm() / variance.sqrt();
            Some(Others { x, covariance: kept.cholesky()?.inverse(), shift })
        };
        let (levels, stretch) = (part.levels, &stretches[part.stretch]);
        let own = SegmentSummary {
            segment: stretch.segment,
            samples: stretch.times.len(),
            noise_sigma: (levels.white * variance).sqrt() * rms,
            torque_noise: levels.torque * variance * rms * rms * rms,
            weight,
            without: None,
        };
        Summary { own, levels, others: without() }
    });
    let mut summaries: Vec<Summary> = each.collect();
    let sum: f64 = summaries.iter().map(|s| s.own.weight).sum();
    if sum > 0.0 {
        summaries.iter_mut().for_each(|s| s.own.weight /= sum);
    }
    summaries
}

impl WithoutSegment {
    /// Of the tensor by the other segments, and the covariance of its coordinates.
    pub(crate) fn new(x: &Coordinates, covariance: &Form, shift: f64) -> Self {
        let ratios = ratios_of(x, covariance);
        WithoutSegment { ratios: ratios.map(|r| r.0), sigma_ratios: ratios.map(|r| r.1), shift }
    }
}
