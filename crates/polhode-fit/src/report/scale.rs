//! The absolute size of a tensor whose shape is known.

use crate::error::FitError;
use crate::physical::failure::SolverFailure;
use crate::physical::prior::Told;
use crate::report::parts::quantile;
use crate::settings::known::Known;
use crate::thresholds::judgement::ALIKE;
use crate::thresholds::noise::SURE;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use polhode::inertia::Inertia;

use crate::bound::motions::Motions;
use crate::columns::column::Column;
use crate::columns::effect::Class;
use crate::physical::coordinates::{Coordinates, ENTRIES, Form, basis, eigen, entries_of_coordinates, pair};
use crate::signal::stretch::Stretch;

/// Variance of a component of the noise of rates, in units of their root mean square.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Of the readings.
    pub(crate) variance: f64,
    /// Whether the rates are those readings; else they are those of the motion that was fitted to them.
    pub(crate) is_in_rates: bool,
}

/// What a free motion keeps, where that gives the size.
fn kept(known: Known) -> Option<&'static str> {
    match known {
        Known::Momentum(_) => Some("the angular momentum"),
        Known::TwiceEnergy(_) => Some("the kinetic energy"),
        Known::Moment { .. } | Known::Trace(_) => None,
    }
}

/// Refuses a size by a momentum or an energy that is not constant, or whose mean cannot be read: `columns` were fitted.
///
/// # Errors
/// With the names of those that act on the body or on the readings.
pub(crate) fn check_constant(known: Known, columns: &[Column]) -> Result<(), FitError> {
    let Some(quantity) = kept(known) else { return Ok(()) };
    let mut names: Vec<&'static str> = columns
        .iter()
        .filter(|column| column.class() != Class::Input)
        .map(|column| column.label().name)
        .collect();
    names.dedup();
    if names.is_empty() { Ok(()) } else { Err(FitError::SizeVaries { quantity, names }) }
}

/// The mean of ω·M ω over one segment.
struct OfSegment {
    segment: usize,
    value: f64,
    slope: Coordinates,
    /// One over its variance at a given shape.
    weight: f64,
}

/// Refuses a size by a momentum or an energy that differs between segments by more than chance brings. `scale` is that by the stretches of one
/// segment, from the place of the first of them. `covariance` is that of the coordinates of the shape, and `excess` as in [`Scale::covariance`].
///
/// # Errors
/// With the two segments that differ most.
pub(crate) fn check_same(
    known: Known,
    stretches: &[Stretch],
    covariance: &Form,
    excess: f64,
    scale: impl Fn(&[Stretch], usize) -> Scale,
) -> Result<(), FitError> {
    let Some(quantity) = kept(known) else { return Ok(()) };
    let (mut first, mut means) = (0, Vec::new());
    for segment in stretches.chunk_by(|a, b| a.segment == b.segment) {
        if let Some((mean, _)) = scale(segment, first).mean {
            let weight = 1.0 / (mean.variance * excess + mean.walk + mean.bias * mean.bias);
            means.push(OfSegment {
                segment: segment[0].segment,
                value: mean.value,
                slope: mean.slope,
                weight,
            });
        }
        first += segment.len();
    }
    means.retain(|mean| mean.weight.is_finite() && mean.weight > 0.0);
    if means.len() < 2 {
        return Ok(());
    }
    let total: f64 = means.iter().map(|mean| mean.weight).sum();
    let value = means.iter().map(|mean| mean.value * mean.weight).sum::<f64>() / total;
    let slope = means.iter().map(|mean| mean.slope * mean.weight).sum::<Coordinates>() / total;
    let (values, directions) = eigen(*covariance);
    let deviations = Form::from_fn(|i, k| directions[(i, k)] * values[k].max(0.0).sqrt());
    let (mut information, mut right, mut chi2) = (Form::identity(), Coordinates::zeros(), 0.0);
    for mean in &means {
        let by_shape = deviations.tr_mul(&(mean.slope - slope));
        let apart = mean.value - value;
        information += by_shape * by_shape.transpose() * mean.weight;
        right += by_shape * (apart * mean.weight);
        chi2 += apart * apart * mean.weight;
    }
    // a shape within its deviations explains as much; shape and means share noise: (a + b)(a + b)ᵀ <= 2 (a aᵀ + b bᵀ)
    let explained = information.cholesky().map_or(0.0, |factor| right.dot(&factor.solve(&right)));
    let chi2 = 0.5 * (chi2 - explained);
    let apart = |mean: &OfSegment| (mean.value - value) * mean.weight.sqrt();
    means.sort_by(|a, b| apart(a).total_cmp(&apart(b)));
    if let [least, .., most] = means.as_slice() {
        let ratio = most.value / least.value.max(1.0 / least.weight.sqrt());
        let factor = if matches!(known, Known::Momentum(_)) { ratio.sqrt() } else { ratio };
        if chi2 > quantile((means.len() - 1) as f64, SURE) && factor > 1.0 + ALIKE {
            let (largest, smallest) = (most.segment, least.segment);
            return Err(FitError::SizeDiffers { quantity, factor, largest, smallest });
        }
    }
    Ok(())
}

/// The trace that a known quantity gives to a tensor of shape `j` from rates in units of their root mean square `rms`, rad/s.
pub(crate) fn scale_of(
    known: Known,
    stretches: &[Stretch],
    rms: f64,
    j: &Matrix3<f64>,
    noise: Noise,
) -> Scale {
    match known {
        Known::Trace(trace) => Scale { trace, slope: Coordinates::zeros(), mean: None },
        Known::Moment { axis, value } => {
            let n = axis.normalize();
            let share = n.dot(&(j * n));
            let trace = value / share;
            Scale { trace, slope: pair(&n, &n) * (-trace / share), mean: None }
        }
        Known::TwiceEnergy(value) => {
            let mean = Mean::new(stretches, *j, basis, noise, Matrix3::identity());
            // one by one, so that no square of a rate underflows
            let trace = value / rms / rms / mean.value;
            mean.scale(trace, 1.0)
        }
        Known::Momentum(value) => {
            let change = |k| j * basis(k) + basis(k) * j;
            let mean = Mean::new(stretches, j * j, change, noise, *j);
            let trace = value / rms / mean.value.sqrt();
            mean.scale(trace, 0.5)
        }
    }
}

/// The mean of ω·M ω over all samples, free of the bias by noise.
struct Mean {
    m: Matrix3<f64>,
    value: f64,
    /// Its gradient with respect to the coordinates of the shape.
    slope: Coordinates,
    /// Of the mean at a given shape.
    variance: f64,
    samples: f64,
    /// What was taken off it for the noise of the readings.
    bias: f64,
    /// J⁻¹ M.
    lever: Matrix3<f64>,
    /// Variance of what torque noise makes of the mean from its value at the start.
    walk: f64,
}

impl Mean {
    /// ω + n has ω·M ω + 2 n·M ω + n·M n: a mean that is larger by σ² tr M, a variance of 4 σ² |M ω|² + 2 σ⁴ tr M². The mean over a motion
    /// that was fitted to the readings has no such bias, and at a given shape no larger variance.
    fn new(
        stretches: &[Stretch],
        m: Matrix3<f64>,
        change: impl Fn(usize) -> Matrix3<f64>,
        noise: Noise,
        lever: Matrix3<f64>,
    ) -> Mean {
        let variance = noise.variance;
        let (mut scatter, mut samples) = (Matrix3::zeros(), 0.0);
        for w in stretches.iter().flat_map(|s| &s.rates) {
            scatter += w * w.transpose();
            samples += 1.0;
        }
        let bias = if noise.is_in_rates { variance } else { 0.0 };
        let scatter = scatter / samples - Matrix3::identity() * bias;
        let of_one = 4.0 * scatter.dot(&(m * m)).max(0.0) + 2.0 * variance * m.norm_squared();
        let slope = Coordinates::from_fn(|k, _| scatter.dot(&change(k)));
        let (value, variance) = (scatter.dot(&m), variance * of_one / samples);
        Mean { m, value, slope, variance, samples, bias: bias * m.trace(), lever, walk: 0.0 }
    }

    /// The scale from a trace that goes with the inverse `power` of the mean.
    fn scale(self, trace: f64, power: f64) -> Scale {
        let per_mean = -power * trace / self.value;
        Scale { trace, slope: self.slope * per_mean, mean: Some((self, per_mean)) }
    }
}

/// The trace of a tensor whose shape is known.
pub(crate) struct Scale {
    pub(crate) trace: f64,
    /// Its gradient with respect to the coordinates of the shape.
    slope: Coordinates,
    /// The mean that it was read from, and its derivative with respect to that.
    mean: Option<(Mean, f64)>,
}

impl Scale {
    /// With torque noise, of which `torque` is the density in each stretch by its place: what is known is known at the start of each segment, and
    /// has walked until a later sample. A torque τ changes ω·M ω by 2 ω·M J⁻¹ τ a unit of time.
    pub(crate) fn walking(
        mut self,
        stretches: &[Stretch],
        rms: f64,
        torque: impl Fn(usize) -> Matrix3<f64>,
    ) -> Scale {
        let Some((mean, _)) = &mut self.mean else { return self };
        let mut densities = (0..stretches.len()).map(torque);
        for segment in stretches.chunk_by(|a, b| a.segment == b.segment) {
            let mut later = segment.iter().map(|s| s.times.len()).sum::<usize>() as f64;
            let mut before = f64::INFINITY;
            for (s, density) in segment.iter().zip(&mut densities) {
                let growth = |w: &Vector3<f64>| {
                    let g = mean.lever * w;
                    4.0 * g.dot(&(density * g))
                };
                let growth = s.rates.iter().map(growth).sum::<f64>() / s.rates.len() as f64;
                for t in &s.times {
                    // what the walk gains from one sample to the next stays in all later ones
                    let now = s.start * rms + t;
                    mean.walk += later * later * growth * (now - before).max(0.0);
                    (before, later) = (now, later - 1.0);
                }
            }
        }
        mean.walk /= mean.samples * mean.samples;
        self
    }

    /// The absolute tensor of shape `j` and the covariance of its entries; `covariance` is that of the coordinates. A prior tensor must have
    /// this size, where it has one.
    pub(crate) fn sized(
        &self,
        known: Known,
        prior: Option<&Told>,
        j: &Matrix3<f64>,
        covariance: &Form,
        excess: f64,
        motions: Option<&Motions<'_>>,
    ) -> Result<(Inertia, SMatrix<f64, 6, 6>), FitError> {
        let trace = self.trace;
        if let Some(prior) = prior {
            let (expected, sigma) = (prior.trace, prior.size_deviation());
            if libm::log(trace / expected).abs() > SURE * sigma {
                return Err(FitError::PriorSize { prior: expected, sigma: expected * sigma, known: trace });
            }
        }
        // its covariance goes with the square
        if !(trace * trace).is_normal() {
            return Err(FitError::Setting { name: "the known quantity", value: known.value() });
        }
        let inertia =
            Inertia::from_tensor(j * trace).map_err(|error| FitError::Solver(SolverFailure::Scale(error)))?;
        Ok((inertia, self.covariance(j, covariance, excess, motions)))
    }

    /// Covariance of the entries of trace × J from that of the coordinates of J; what the noise does not explain has
    /// enlarged the latter by `excess`.
    ///
    /// Shape and mean carry the same noise. Their covariance is taken as for an efficient estimate of the shape at the
    /// given motions; without motions, the two are taken to err together as badly as they can.
    pub(crate) fn covariance(
        &self,
        j: &Matrix3<f64>,
        shape: &Form,
        excess: f64,
        motions: Option<&Motions<'_>>,
    ) -> SMatrix<f64, 6, 6> {
        let entries = SVector::<f64, 6>::from_fn(|k, _| j[ENTRIES[k]]);
        let map = entries_of_coordinates() * self.trace + entries * self.slope.transpose();
        let of_shape = map * shape * map.transpose();
        let Some((mean, per_mean)) = &self.mean else { return of_shape };
        let variance = mean.variance * excess;
        let own = entries * *per_mean;
        let of_mean = own * own.transpose() * (variance + mean.walk);
        if let Some(shared) = motions.and_then(|motions| motions.shared(&mean.m)) {
            let both = shape * shared / mean.samples;
            // no more than all of the mean's noise, which an estimate short of efficient would seem to share
            let most = (variance / shared.dot(&both).abs() * mean.samples).sqrt().min(1.0);
            let mixed = map * both * own.transpose() * most;
            return of_shape + mixed + mixed.transpose() + of_mean;
        }
        // (a + b)(a + b)ᵀ <= (1 + t) a aᵀ + (1 + 1/t) b bᵀ for every t; this one makes the trace least
        let t = (of_mean.trace() / of_shape.trace()).sqrt();
        if t > 0.0 && t.is_finite() {
            of_shape * (1.0 + t) + of_mean * (1.0 + 1.0 / t)
        } else {
            of_shape + of_mean
        }
    }
}

/// The absolute tensor where only a prior gives its size.
pub(crate) fn by_prior(
    j: &Matrix3<f64>,
    prior: &Told,
    covariance: &Form,
    x: &Coordinates,
) -> Result<(Option<Inertia>, Option<SMatrix<f64, 6, 6>>), FitError> {
    let (trace, slope, variance) = prior.size(x);
    let inertia =
        Inertia::from_tensor(j * trace).map_err(|error| FitError::Solver(SolverFailure::Scale(error)))?;
    let shape = SVector::<f64, 6>::from_fn(|row, _| j[ENTRIES[row]]) * trace;
    let map = entries_of_coordinates() * trace + shape * slope.transpose();
    let covariance = map * covariance * map.transpose() + shape * shape.transpose() * variance;
    Ok((Some(inertia), Some(covariance)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use crate::simulate::simulate;
    use polhode::num::Random;

    /// The walk of the mean is the double sum of the covariances of all samples, and a gap between stretches is part of it.
    #[test]
    fn torque_noise_lets_the_mean_walk() {
        let times: Vec<f64> = (0..30).map(|i| 0.1 * f64::from(i) + if i < 12 { 0.0 } else { 0.7 }).collect();
        let rates: Vec<_> = times.iter().map(|_| Vector3::new(0.3, 1.0, -0.2)).collect();
        let j = Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45));
        let density = Matrix3::new(3.0, 1.0, 0.0, 1.0, 2.0, 0.5, 0.0, 0.5, 1.0) * 1e-4;
        let (rms, noise) = (2.0, Noise { variance: 1e-4, is_in_rates: true });
        let part = |range: core::ops::Range<usize>| {
            let own = times[range.clone()].iter().map(|t| t - times[range.start]).collect();
            Stretch { start: times[range.start] / rms, ..Stretch::new(own, rates[range].to_vec()) }
        };
        let stretches = [part(0..12), part(12..30)];
        for (known, g) in [(Known::TwiceEnergy(3.0), rates[0]), (Known::Momentum(3.0), j * rates[0])] {
            let scale = scale_of(known, &stretches, rms, &j, noise).walking(&stretches, rms, |_| density);
            let growth = 4.0 * g.dot(&(density * g));
            let both = times.iter().flat_map(|a| times.iter().map(move |b| a.min(*b)));
            let expected = growth * both.sum::<f64>() / 900.0;
            let walk = scale.mean.map_or(f64::NAN, |(mean, _)| mean.walk);
            assert!((walk / expected - 1.0).abs() < 1e-12, "{walk:e} {expected:e}");
        }
    }

    /// Without motions the covariance holds for errors of shape and mean that are correlated as badly as they can be, in
    /// every direction, with the least trace of such bounds.
    #[test]
    fn without_motions_shape_and_mean_may_err_together() {
        let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let rates = times.iter().map(|t| Vector3::new(0.3, 1.0 - 0.1 * t, 0.2 * t)).collect();
        let j = Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45));
        let noise = Noise { variance: 1e-4, is_in_rates: true };
        let scale = scale_of(Known::TwiceEnergy(3.0), &[Stretch::new(times, rates)], 1.0, &j, noise);
        let factor = Form::from_fn(|i, k| 1e-3 / (1.0 + ((3 * i + 2 * k) % 7) as f64));
        let shape = factor * factor.transpose();
        let of_shape = scale.covariance(&j, &shape, 0.0, None);
        let traces = of_shape.trace() / scale.covariance(&j, &Form::zeros(), 1.0, None).trace();
        assert!(traces > 0.0 && traces.is_finite(), "{traces}");
        let root = |c: &SMatrix<f64, 6, 6>, v: &SVector<f64, 6>| v.dot(&(c * v)).max(0.0).sqrt();
        // the mean is known by so many deviations of the shape
        for deviations in [0.1, 0.9, 3.0] {
            let excess = deviations * deviations * traces;
            let of_mean = scale.covariance(&j, &Form::zeros(), excess, None);
            let both = scale.covariance(&j, &shape, excess, None);
            for k in 0..36 {
                let v = SVector::<f64, 6>::from_fn(|i, _| f64::from((k * (i as u32 + 3) * 7) % 11) - 5.0);
                let together = root(&of_shape, &v) + root(&of_mean, &v);
                assert!(root(&both, &v) >= together * (1.0 - 1e-12), "{deviations} {k}");
            }
            let least = of_shape.trace() * (1.0 + deviations) * (1.0 + deviations);
            assert!((both.trace() / least - 1.0).abs() < 1e-12, "{deviations}");
        }
    }

    /// By the motions shape and mean share noise as an efficient estimate would, yet no more than all of the mean's: where the shape is so uncertain that
    /// they would, their correlation is one along what they share, and below that it goes with the deviation of the shape.
    #[test]
    fn shape_and_mean_share_no_more_than_there_is() {
        let (j, noise) = example();
        let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
        let (body, start) = (Inertia::from_tensor(j).unwrap(), Vector3::new(0.5, 0.8, -0.4));
        let rates = simulate(&body, start, &times, 0.0, &mut Random::new(1)).unwrap();
        let stretches = [Stretch::new(times, rates)];
        let motions = Motions::nearest(&stretches, &coordinates(&j), noise.variance).unwrap();
        let scale = scale_of(Known::TwiceEnergy(3.0), &stretches, 1.0, &j, noise);
        let (mean, _) = scale.mean.as_ref().unwrap();
        let shared = motions.shared(&mean.m).unwrap();
        let entries = SVector::<f64, 6>::from_fn(|k, _| j[ENTRIES[k]]);
        let map = entries_of_coordinates() * scale.trace + entries * scale.slope.transpose();
        // the entries that follow what is shared
        let v = map * (map.tr_mul(&map).try_inverse().unwrap() * shared);
        let of = |c: SMatrix<f64, 6, 6>| v.dot(&(c * v));
        for (deviations, correlation) in [(0.5, 0.5), (0.9, 0.9), (3.0, 1.0)] {
            let deviation = deviations * mean.samples * mean.variance.sqrt() / shared.norm();
            let shape = Form::identity() * (deviation * deviation);
            let of_shape = of(scale.covariance(&j, &shape, 0.0, None));
            let of_mean = of(scale.covariance(&j, &Form::zeros(), 1.0, None));
            let both = of(scale.covariance(&j, &shape, 1.0, Some(&motions)));
            let found = (both - of_shape - of_mean).abs() / (2.0 * (of_shape * of_mean).sqrt());
            assert!(f64::abs(found / correlation - 1.0) < 1e-6, "{deviations}: {found}");
        }
    }

    fn example() -> (Matrix3<f64>, Noise) {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        (j, Noise { variance: 1e-4, is_in_rates: true })
    }

    /// The trace follows the shape so that the known quantity stays: by differences.
    #[test]
    fn the_slope_of_the_trace_is_that_of_differences() {
        let (j, noise) = example();
        let times: Vec<f64> = (0..40).map(|i| 0.1 * f64::from(i)).collect();
        let rates = times.iter().map(|t| Vector3::new(0.3 + 0.1 * t, 1.0 - 0.1 * t, 0.2 * t)).collect();
        let stretches = [Stretch::new(times, rates)];
        let axis = Vector3::new(1.0, -2.0, 0.5);
        let moment = Known::Moment { axis, value: 0.7 };
        for known in [Known::Trace(3.0), moment, Known::TwiceEnergy(3.0), Known::Momentum(3.0)] {
            let of = |j: &Matrix3<f64>| scale_of(known, &stretches, 2.0, j, noise);
            let (scale, h) = (of(&j), 1e-5);
            for k in 0..5 {
                let by = (of(&(j + basis(k) * h)).trace - of(&(j - basis(k) * h)).trace) / (2.0 * h);
                assert!((by - scale.slope[k]).abs() < 1e-6 * scale.trace, "{known:?} {k}: {by:e}");
            }
        }
    }

    /// A body of constant rate has the size of what is known over the mean, less what noise adds to that where the rates are readings;
    /// the mean of n readings has the variance (4 σ² |M ω|² + 2 σ⁴ tr M²)/n.
    #[test]
    fn the_size_is_what_is_known_over_the_mean() {
        let (j, noise) = example();
        let w = Vector3::new(0.3, 1.0, -0.2);
        let stretches = [Stretch::new((0..10).map(f64::from).collect(), vec![w; 10])];
        let n = Vector3::new(0.6, 0.8, 0.0);
        let v = noise.variance;
        for is_in_rates in [true, false] {
            let of = |known| scale_of(known, &stretches, 2.0, &j, Noise { is_in_rates, ..noise });
            let bias = if is_in_rates { v } else { 0.0 };
            let moment = of(Known::Moment { axis: n * 5.0, value: 0.7 });
            assert!((moment.trace * n.dot(&(j * n)) / 0.7 - 1.0).abs() < 1e-12 && moment.mean.is_none());
            assert!(of(Known::Trace(3.0)).trace == 3.0 && of(Known::Trace(3.0)).mean.is_none());
            for (known, m) in [(Known::TwiceEnergy(3.0), j), (Known::Momentum(3.0), j * j)] {
                let scale = of(known);
                let value = w.dot(&(m * w)) - bias * m.trace();
                let unit = if m == j { 4.0 * value } else { 2.0 * value.sqrt() };
                assert!((scale.trace * unit / 3.0 - 1.0).abs() < 1e-12, "{known:?}");
                let mean = scale.mean.unwrap().0;
                let square = (m * w).norm_squared() - bias * m.norm_squared();
                let variance = v * (4.0 * square + 2.0 * v * m.norm_squared()) / 10.0;
                assert!((mean.variance / variance - 1.0).abs() < 1e-12, "{known:?}");
                assert!((mean.bias - bias * m.trace()).abs() < 1e-18 && mean.samples == 10.0);
            }
        }
    }

    /// Where a record adds nothing to a prior, tensor and covariance are those of the prior.
    #[test]
    fn a_prior_alone_gives_itself_back() {
        let tensor = Matrix3::new(2.0, 0.2, -0.1, 0.2, 3.0, 0.3, -0.1, 0.3, 4.0);
        let factor = SMatrix::<f64, 6, 6>::from_fn(|i, k| 0.02 / (1.0 + ((3 * i + 2 * k) % 7) as f64));
        let covariance = factor * factor.transpose() + SMatrix::identity() * 1e-4;
        let told = crate::physical::prior::Prior::new(tensor, covariance).told().unwrap();
        let root = told.shape_root();
        let shape = (root.transpose() * root).try_inverse().unwrap();
        let (inertia, found) = by_prior(&(tensor / 9.0), &told, &shape, &told.x).unwrap();
        assert!((inertia.unwrap().tensor() - tensor).amax() < 1e-12);
        assert!((found.unwrap() - covariance).amax() < 1e-9 * covariance.amax());
    }

    /// A known size may lie five deviations from that of a prior, and no further.
    #[test]
    fn a_prior_of_another_size_is_refused() {
        let (j, noise) = example();
        let told = crate::physical::prior::Prior::relative(j * 3.0, 0.01).told().unwrap();
        let sigma = told.size_deviation();
        for (deviations, is_refused) in [(4.9, false), (5.1, true), (-4.9, false), (-5.1, true)] {
            let known = Known::Trace(3.0 * libm::exp(deviations * sigma));
            let scale = scale_of(known, &[], 1.0, &j, noise);
            let found = scale.sized(known, Some(&told), &j, &Form::zeros(), 1.0, None);
            match found {
                Err(FitError::PriorSize { prior, sigma: of, known }) if is_refused => {
                    assert!((prior - 3.0).abs() < 1e-12 && (of / (3.0 * sigma) - 1.0).abs() < 1e-12);
                    assert_eq!(known, scale.trace);
                }
                found => assert!(found.is_ok() && !is_refused, "{deviations}"),
            }
            assert!(scale.sized(known, None, &j, &Form::zeros(), 1.0, None).is_ok());
        }
        for trace in [1e-170, 1e170] {
            let scale = scale_of(Known::Trace(trace), &[], 1.0, &j, noise);
            let found = scale.sized(Known::Trace(trace), None, &j, &Form::zeros(), 1.0, None);
            assert!(matches!(found, Err(FitError::Setting { value, .. }) if value == trace));
        }
    }

    /// Whether two segments, the fourth and the sixth of a record, differ that have the means 1 and `larger` with variances of `each`, by noise
    /// that was enlarged four times, by a walk, by a bias and by a shape that is known to `sigma` and moves them apart by twice of that.
    fn differ(known: Known, larger: f64, each: [f64; 3], sigma: f64) -> Result<(), FitError> {
        let at = |segment: usize| Stretch { segment, ..Stretch::new(vec![0.0], vec![Vector3::x()]) };
        let mut covariance = Form::zeros();
        covariance[(2, 2)] = sigma * sigma;
        check_same(known, &[at(3), at(3), at(5)], &covariance, 4.0, |own, first| {
            let is_first = own[0].segment == 3;
            assert_eq!((own.len(), first), if is_first { (2, 0) } else { (1, 2) });
            let mut slope = Coordinates::repeat(0.7);
            slope[2] = if is_first { 1.0 } else { -1.0 };
            let mean = Mean {
                m: Matrix3::identity(),
                value: if is_first { larger } else { 1.0 },
                slope,
                variance: each[0] / 4.0,
                samples: 1.0,
                bias: -each[2].sqrt(),
                lever: Matrix3::identity(),
                walk: each[1],
            };
            Scale { trace: 1.0, slope, mean: Some((mean, 1.0)) }
        })
    }

    /// Two means of variance v that are d apart differ where half of d²/(2 v) is more than chance brings; what the shape explains is added to v,
    /// of each mean the square by which it moves, twice.
    #[test]
    fn sizes_differ_beyond_chance() {
        let most = (0.1 * 0.1 / 4.0) / quantile(1.0, SURE);
        for (each, shape) in [
            ([1.0, 0.0, 0.0], 0.0),
            ([0.0, 1.0, 0.0], 0.0),
            ([0.0, 0.0, 1.0], 0.0),
            ([0.25, 0.25, 0.25], 0.25),
            ([0.1, 0.0, 0.0], 0.9),
        ] {
            for (share, is_refused) in [(0.99, true), (1.01, false)] {
                let parts = each.map(|of| of * most * share);
                let sigma = (0.5 * shape * most * share).sqrt();
                let found = differ(Known::TwiceEnergy(1.0), 1.1, parts, sigma);
                assert_eq!(found.is_err(), is_refused, "{each:?} {shape} {share}: {found:?}");
            }
        }
    }

    /// However sure, energies that differ by three in a thousand are alike, and momenta, of which the mean is a square; a moment is the same
    /// in all segments.
    #[test]
    fn sizes_that_are_alike_are_no_contradiction() {
        let of = |known, larger| differ(known, larger, [1e-12, 0.0, 0.0], 0.0);
        assert_eq!(of(Known::TwiceEnergy(1.0), 1.0029), Ok(()));
        assert_eq!(of(Known::Momentum(1.0), 1.0059), Ok(()));
        assert_eq!(of(Known::Trace(1.0), 2.0), Ok(()));
        for (known, larger, quantity, factor) in [
            (Known::TwiceEnergy(1.0), 1.0031, "the kinetic energy", 1.0031),
            (Known::TwiceEnergy(1.0), 4.0, "the kinetic energy", 4.0),
            (Known::Momentum(1.0), 1.0062, "the angular momentum", 1.0062_f64.sqrt()),
            (Known::Momentum(1.0), 4.0, "the angular momentum", 2.0),
        ] {
            let expected = FitError::SizeDiffers { quantity, factor, largest: 3, smallest: 5 };
            assert_eq!(of(known, larger), Err(expected));
        }
        // the smaller one counts as no less than its own deviation
        let found = differ(Known::TwiceEnergy(1.0), 1e3, [4.0, 0.0, 0.0], 0.0);
        assert!(matches!(found, Err(FitError::SizeDiffers { factor, .. }) if (factor - 500.0).abs() < 1e-9));
    }
}
