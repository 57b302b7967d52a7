//! The segments of a record, each with its noise and what it contributes.

use nalgebra::Matrix3;

use crate::physical::coordinates::{Coordinates, Form};
use crate::report::answer::ratios_of;
use crate::signal::covariance::{Levels, acceleration_density};
use crate::signal::stretch::Stretch;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::{Part, WeakEstimate};

/// One segment of a record in a fit, or a part of one between bursts of eight samples and more that were left out.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentSummary {
    /// Index of the segment in the record.
    pub segment: usize,
    /// Samples that were used.
    pub samples: usize,
    /// Noise of one component of its rates, rad/s.
    pub noise_sigma: f64,
    /// Power spectral density of the angular acceleration that its torque noise makes, the mean of the three components, (rad/s²)² s.
    pub torque_noise: f64,
    /// Its share of the information about the tensor: the shares of all segments sum to 1.
    pub weight: f64,
    /// The answer by the other segments; `None` where they do not determine the tensor.
    pub without: Option<WithoutSegment>,
}

/// The answer by all segments but one, of the record alone: before a prior, the physical law and limits, and with wheels by the weak form.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithoutSegment {
    /// I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
    /// Their standard deviations.
    pub sigma_ratios: [f64; 2],
    /// Distance from the tensor by all segments, in standard deviations of that.
    pub shift: f64,
}

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
    to_shares(summaries.iter_mut().map(|s| &mut s.own.weight).collect());
    summaries
}

/// Divides weights by their sum, where there is one.
pub(super) fn to_shares(weights: Vec<&mut f64>) {
    let sum: f64 = weights.iter().map(|weight| **weight).sum();
    if sum > 0.0 {
        weights.into_iter().for_each(|weight| *weight /= sum);
    }
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
    use crate::columns::column::Unknowns;
    use crate::physical::coordinates::coordinates;
    use crate::signal::covariance::Shape;
    use crate::solve::weak_estimate::tests::one_row_each;
    use nalgebra::Vector3;

    /// Three segments that tell each number with the weights 1, 2 and 2, of which the second lies d off: their shares of the information are
    /// 1/9 and twice 4/9, and without one of them the tensor is the weighted mean of the others, so many deviations of all from that of all.
    #[test]
    fn segments_weigh_by_their_information() {
        let (weights, d, variance, rms) = ([10.0, 20.0, 20.0], 0.01, 0.25_f64, 2.0);
        let at = Unknowns { x: Coordinates::repeat(4.0 / 9.0 * d), c: Vec::new() };
        let off = [0.0, d, 0.0].map(|off| 4.0 / 9.0 * d - off);
        let part = |k: usize| one_row_each(&[weights[k]; 5], &[weights[k] * off[k]; 5]);
        let mut weak = WeakEstimate::of_rows(&[], &at, (0..3).map(part).collect(), variance.sqrt());
        weak.parts[1].levels = Levels { white: 4.0, torque: 3.0, shape: Shape::Alike };
        let stretches = [5, 6, 7].map(|segment| Stretch {
            segment,
            ..Stretch::new((0..segment).map(|k| k as f64).collect(), vec![Vector3::x(); segment])
        });
        let found = summaries(&weak, &stretches, variance, rms);
        // the means 4d/8, 0 and 4d/5
        let others = [(0.5, 8.0), (0.0, 5.0), (0.8, 5.0)];
        for (k, (summary, (mean, squares))) in found.iter().zip(others).enumerate() {
            let SegmentSummary { segment, samples, noise_sigma, torque_noise, weight, .. } = &summary.own;
            assert_eq!((*segment, *samples), (5 + k, 5 + k));
            let (noise, torque) = if k == 1 { (2.0, 3.0 * variance * 8.0) } else { (1.0, 0.0) };
            assert!((noise_sigma / noise - 1.0).abs() < 1e-12 && (torque_noise - torque).abs() < 1e-12);
            let share = weights[k] * weights[k] / 900.0;
            assert!((weight / share - 1.0).abs() < 1e-9, "{k}: {weight}");
            let own = summary.others.as_ref().unwrap();
            assert!((own.x - Coordinates::repeat(mean * d)).amax() < 1e-12, "{k}: {}", own.x);
            assert!((own.covariance * (100.0 * squares) - Form::identity()).amax() < 1e-9, "{k}");
            // of five numbers, each known to σ/30
            let shift = 5.0_f64.sqrt() * (mean - 4.0 / 9.0).abs() * d * 30.0 / variance.sqrt();
            assert!((own.shift / shift - 1.0).abs() < 1e-9, "{k}: {} {shift}", own.shift);
        }
        let alone = WeakEstimate::of_rows(&[], &at, vec![part(0)], variance.sqrt());
        let found = summaries(&alone, &stretches, variance, rms);
        assert!(found.len() == 1 && found[0].others.is_none() && (found[0].own.weight - 1.0).abs() < 1e-12);
    }

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
