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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use crate::signal::covariance::Shape;
    use nalgebra::Vector3;

    /// Its torque noise becomes that of the body, a third of tr J⁻²/9, and what the others say gets the deviations of enlarged noise and of
    /// what is added.
    #[test]
    fn a_summary_is_completed_by_the_body_and_the_noise() {
        let j = Matrix3::from_diagonal(&Vector3::new(0.2, 0.3, 0.5));
        let x = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.25, 0.3, 0.45)));
        let (covariance, added) = (Form::identity() * 3e-6, Form::identity() * 4e-6);
        let own = SegmentSummary {
            segment: 4,
            samples: 70,
            noise_sigma: 0.01,
            torque_noise: 2.0,
            weight: 0.3,
            without: None,
        };
        let alike = 2.0 * (25.0 + 100.0 / 9.0 + 4.0) / 27.0;
        for (shape, density) in [(Shape::Moments, 2.0), (Shape::Alike, alike)] {
            let levels = Levels { shape, ..Levels::WHITE };
            let others = Some(Others { x, covariance, shift: 1.5 });
            let found = Summary { own: own.clone(), levels, others }.complete(&j, 2.0, &added);
            assert!((found.torque_noise / density - 1.0).abs() < 1e-12, "{shape:?}: {}", found.torque_noise);
            let WithoutSegment { ratios, sigma_ratios, shift } = found.without.unwrap();
            assert!((ratios[0] - 25.0 / 45.0).abs() < 1e-12 && (ratios[1] - 30.0 / 45.0).abs() < 1e-12);
            // gradients of moments have the squares 2/3 and the products −1/3
            for (r, sigma) in ratios.into_iter().zip(sigma_ratios) {
                let square = 1e-5 * (2.0 + 2.0 * r + 2.0 * r * r) / 3.0 / (0.45 * 0.45);
                assert!((sigma * sigma / square - 1.0).abs() < 1e-9, "{r} {sigma}");
            }
            assert!(shift == 1.5 && (found.segment, found.samples) == (4, 70));
            assert!(found.noise_sigma == 0.01 && found.weight == 0.3);
        }
        let alone = Summary { own, levels: Levels::WHITE, others: None };
        assert!(alone.complete(&j, 2.0, &added).without.is_none());
    }
}
