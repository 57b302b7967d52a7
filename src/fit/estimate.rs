//! The estimate: from a record to a physical tensor and everything that can be said of it.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};

use super::averages;
use super::coordinates::{Coordinates, Form, eigen, entries_of_coordinates, pair, tensor};
use super::cramer_rao::Motions;
use super::error::FitError;
use super::identifiability::Identifiability;
use super::limits::Bound;
use super::noise;
use super::qp::{self, ActiveConstraint, Certificate, LIMIT};
use super::radius::{self, Failure};
use super::record::{Record, Segment};
use super::rounds::{ROUNDS, WeakEstimate};
use super::scale::Known;
use super::test_functions::{SAMPLES_PER_TEST, Stretch};
use super::torque_free::{Drift, Whiteness, drifts};
use super::units::{Better, better_unit};
use super::warnings::warnings;
use crate::inertia::{Inertia, InertiaShape};

/// What the user may fix; the default leaves everything to the record.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Half width of the test functions, s; chosen by least predicted covariance without it.
    pub radius: Option<f64>,
    /// Standard deviation of the noise of one component, rad/s, at least 1e-10 of the rates; read from the samples
    /// without it.
    pub noise: Option<f64>,
    /// What is known of the moments beforehand.
    pub bounds: Vec<Bound>,
    /// What gives the absolute size.
    pub known: Option<Known>,
    /// Whether a unit that explains the record ten times better is an error.
    pub check_units: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { radius: None, noise: None, bounds: Vec::new(), known: None, check_units: true }
    }
}

/// Whitened residuals of one segment: standard normal where model and noise are right.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// Which segment of the record.
    pub segment: usize,
    /// Centres of the test functions, s.
    pub times: Vec<f64>,
    /// The residuals of each.
    pub values: Vec<[f64; 3]>,
    /// Their mean square.
    pub misfit: f64,
}

/// A fitted tensor and how far to trust it.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The tensor with trace 1, sensor axes.
    pub shape: InertiaShape,
    /// Its principal moments, ascending, as shares of the trace.
    pub principal: [f64; 3],
    /// Their standard deviations.
    pub sigma_principal: [f64; 3],
    /// Takes coordinates along the principal axes (ascending, right-handed) to sensor axes.
    pub axes: UnitQuaternion<f64>,
    /// Standard deviations of the turn about each principal axis, rad; infinite where two moments agree.
    pub sigma_axes: [f64; 3],
    /// I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
    /// Their standard deviations.
    pub sigma_ratios: [f64; 2],
    /// Covariance of the entries xx, yy, zz, xy, xz, yz of the shape; rank 5, less on the face of an active constraint.
    pub covariance: SMatrix<f64, 6, 6>,
    /// Covariance of the same before the physical law was imposed: what a test of other tensors should use.
    pub free_covariance: SMatrix<f64, 6, 6>,
    /// The Cramér–Rao bound on it; `None` where the tensor has no inverse, or no free motion of it explains the samples.
    pub bound: Option<SMatrix<f64, 6, 6>>,
    /// Root of the trace of the covariance over that of the bound.
    pub bound_ratio: Option<f64>,
    /// Absolute tensor, kg m², where something gave the scale.
    pub inertia: Option<Inertia>,
    /// Covariance of its entries.
    pub inertia_covariance: Option<SMatrix<f64, 6, 6>>,
    /// Noise of one component of the rates, rad/s.
    pub noise_sigma: f64,
    /// Mean square of the residuals over the noise; the covariance is multiplied by it, before law and bounds are
    /// imposed, where it exceeds 1.
    pub chi2_per_dof: f64,
    /// Standard deviations by which law and bounds hold the answer off what the record alone says.
    pub pull: f64,
    /// Equations beyond the five unknowns.
    pub dof: usize,
    /// Samples of the segments that were long enough.
    pub samples: usize,
    /// Segments that were long enough.
    pub segments: usize,
    /// Half width of the test functions, s.
    pub radius: f64,
    /// What the record determines.
    pub identifiability: Identifiability,
    /// I₁ + I₂ − I₃ as a share of the trace; never negative.
    pub triangle_slack: f64,
    /// Constraints that hold the answer.
    pub active_constraints: Vec<ActiveConstraint>,
    /// Check of the answer's optimality.
    pub certificate: Certificate,
    /// Drift of |J ω|.
    pub momentum_drift: Drift,
    /// Drift of 2T = ω·J ω.
    pub energy_drift: Drift,
    /// Correlation of neighbouring residuals.
    pub whiteness: Whiteness,
    /// Residuals by segment.
    pub residuals: Vec<Residuals>,
    /// What a reader of the figures must know.
    pub warnings: Vec<String>,
}

/// A record in units of its own mean square rate and of the time in which the body turns by one radian.
pub(super) struct Normalised {
    pub(super) stretches: Vec<Stretch>,
    /// Root mean square rate, rad/s.
    rms: f64,
}

pub(super) fn normalised(record: &Record) -> Result<Normalised, FitError> {
    let samples = record.samples();
    let longest = record.segments.iter().map(|s| s.times().len()).max().unwrap_or(0);
    let needed = 2 * SAMPLES_PER_TEST as usize;
    if longest < needed {
        let (segments, saturated) = (record.segments.len(), record.saturated());
        return Err(FitError::TooFewSamples { samples, segments, longest, saturated, needed });
    }
    // the largest component first, so that squares neither over- nor underflow
    let rates = || record.segments.iter().flat_map(Segment::rates);
    let largest = rates().map(|w| w.amax()).fold(0.0, f64::max);
    if largest == 0.0 {
        return Err(FitError::NoRotation { rms: 0.0, noise: 0.0 });
    }
    let mean = rates().map(|w| (w / largest).norm_squared()).sum::<f64>() / samples as f64;
    let rms = largest * mean.sqrt();
    let segments = record.segments.iter();
    let stretches = segments.map(|s| {
        let start = s.times().first().copied().unwrap_or(0.0);
        let times = s.times().iter().map(|t| (t - start) * rms).collect();
        Stretch::new(times, s.rates().iter().map(|w| w / rms).collect())
    });
    Ok(Normalised { stretches: stretches.collect(), rms })
}

/// A tensor as a checked shape.
pub(super) fn shape_of(j: &Matrix3<f64>) -> Result<InertiaShape, FitError> {
    InertiaShape::from_tensor(*j).map_err(|error| FitError::Solver { status: error.to_string() })
}

/// Fits one tensor to all segments of a record.
///
/// The estimator is the weak form of Euler's equation, weighted by the covariance of its noise at samples that are
/// moved onto the equations from round to round; the physical law enters by a quadratic program in whitened increments.
/// No unit of rate or time and no rotation of the sensor changes the result beyond rounding.
///
/// # Errors
/// Too few samples; no rotation; a record that does not determine the tensor, with what it does determine; units that
/// look mistaken; bounds that contradict each other or the physical law; a program without a certified answer.
pub fn fit(record: &Record, settings: &Settings) -> Result<Estimate, FitError> {
    check(settings)?;
    let Normalised { stretches, rms } = normalised(record)?;
    let variance = match settings.noise {
        Some(sigma) => Some((sigma / rms) * (sigma / rms))
            .filter(|v| v.is_normal())
            .ok_or(FitError::Setting { name: "the noise", value: sigma })?,
        None => noise::variance(&stretches),
    };
    // readings of a noiseless record carry at least the quadrature's error
    let variance = variance.max(1e-20);
    // the mean square is 1, of which the noise of three components is 3 σ²: a quarter is too much to fit
    if 3.0 * variance > 0.25 {
        return Err(FitError::NoRotation { rms, noise: variance.sqrt() * rms });
    }
    let singular = || FitError::Solver { status: "the residuals have no positive covariance".into() };
    let weak =
        radius::estimate(&stretches, settings.radius.map(|r| r * rms), variance).map_err(|failure| {
            match failure {
                Failure::Dense => settings.radius.map_or_else(singular, |radius| FitError::Dense { radius }),
                Failure::TooShort => too_short(record, settings, &stretches, rms),
                Failure::Singular => singular(),
            }
        })?;
    let misfit = weak.misfit_per_dof(variance);
    let better =
        if settings.check_units && misfit > 4.0 { better_unit(&stretches, variance, misfit) } else { None };
    // without a settled tensor to compare with, a unit must explain the record by itself, and one of any size must not:
    // there is a tensor next to the sphere for any small wobble in large enough a unit
    let convincing = |b: &&Better| {
        b.credible && if weak.settled() { b.misfit < 0.1 * misfit } else { b.misfit < 2.0 && !b.vague }
    };
    if let Some(b) = better.as_ref().filter(convincing) {
        return Err(FitError::Units { factor: b.factor, hint: b.hint.clone(), misfit, better: b.misfit });
    }
    // what the noise does not explain enlarges the deviations
    let identifiability = identify(&weak, &stretches, variance * misfit.max(1.0)).ok_or_else(singular)?;
    if !weak.settled() && misfit > 1.0 + 5.0 * (2.0 / weak.dof().max(1) as f64).sqrt() {
        // the rates are not constant, and still no tensor explains them
        let axes = averages::axes(&stretches, variance);
        let factor = better.filter(|b| b.misfit < 2.0).map(|b| b.factor);
        return Err(FitError::Unsettled { rounds: ROUNDS, noise: variance.sqrt() * rms, factor, axes });
    }
    if !identifiability.complete() {
        return Err(FitError::Unidentifiable(Box::new(identifiability)));
    }
    let root = weak.root / (variance * misfit.max(1.0)).sqrt();
    // R⁻¹, a factor of the covariance
    let free = root
        .try_inverse()
        .ok_or_else(|| FitError::Solver { status: "the information is not positive".into() })?;
    let nearest = qp::nearest(weak.x, root, &settings.bounds)?;
    let facts = Facts { record, settings, stretches: &stretches, rms, variance, weak: &weak, misfit };
    facts.report(nearest, free, identifiability, better.as_ref().filter(|b| b.credible))
}

fn check(settings: &Settings) -> Result<(), FitError> {
    let known = settings.known.map(Known::value);
    for (name, value) in
        [("the radius", settings.radius), ("the noise", settings.noise), ("the known quantity", known)]
    {
        if let Some(value) = value.filter(|v| !(v.is_finite() && *v > 0.0)) {
            return Err(FitError::Setting { name, value });
        }
    }
    if let Some(Known::Moment { axis, .. }) = settings.known {
        let size = axis.norm();
        if !(size > 0.0 && size.is_finite()) {
            return Err(FitError::Setting {
                name: "the length of the axis of the known moment",
                value: size,
            });
        }
    }
    Ok(())
}

fn too_short(record: &Record, settings: &Settings, stretches: &[Stretch], rms: f64) -> FitError {
    let needed = SAMPLES_PER_TEST as usize;
    match settings.radius {
        Some(radius) => {
            let longest = stretches.iter().map(Stretch::duration).fold(0.0, f64::max) / rms;
            FitError::Radius { radius, longest, needed }
        }
        None => FitError::TooFewSamples {
            samples: record.samples(),
            segments: record.segments.len(),
            longest: stretches.iter().map(|s| s.times.len()).max().unwrap_or(0),
            saturated: record.saturated(),
            needed: 2 * needed,
        },
    }
}

fn identify(weak: &WeakEstimate, stretches: &[Stretch], variance: f64) -> Option<Identifiability> {
    let mut scatter = Matrix3::zeros();
    let mut count = 0.0;
    for w in stretches.iter().flat_map(|s| &s.rates) {
        scatter += w * w.transpose();
        count += 1.0;
    }
    let (singular, directions) = weak.spectrum()?;
    let spectrum = (singular / variance.sqrt(), directions);
    Some(Identifiability::new(&spectrum, &(scatter / count), &tensor(&weak.x)))
}

/// What the report is drawn from.
pub(super) struct Facts<'a> {
    pub(super) record: &'a Record,
    settings: &'a Settings,
    stretches: &'a [Stretch],
    rms: f64,
    variance: f64,
    pub(super) weak: &'a WeakEstimate,
    pub(super) misfit: f64,
}

impl Facts<'_> {
    fn report(
        &self,
        nearest: qp::Nearest,
        free: Form,
        identifiability: Identifiability,
        better: Option<&Better>,
    ) -> Result<Estimate, FitError> {
        let root = self.weak.root / (self.variance * self.misfit.max(1.0)).sqrt();
        let on_face = face_factor(&free, &nearest.face);
        let shape = shape_of(&tensor(&nearest.x))?;
        let j = shape.tensor();
        let (moments, _) = eigen(j);
        let axes = Inertia::from_tensor(j).map_or(UnitQuaternion::identity(), |i| i.principal_axes());
        let v: [Vector3<f64>; 3] = core::array::from_fn(|k| axes * Vector3::ith(k, 1.0));
        let deviation = |g: Coordinates| (on_face.transpose() * g).norm();
        let sigma_principal = core::array::from_fn(|k| deviation(pair(&v[k], &v[k])));
        let sigma_axes = core::array::from_fn(|k| {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            deviation(pair(&v[a], &v[b])) / (moments[a] - moments[b]).abs()
        });
        let ratio = |k: usize| {
            let slope = (pair(&v[k], &v[k]) - pair(&v[2], &v[2]) * (moments[k] / moments[2])) / moments[2];
            (moments[k] / moments[2], deviation(slope))
        };
        let entries = entries_of_coordinates();
        // of a factor, so that no variance is negative
        let spread = |factor: Form| (entries * factor) * (entries * factor).transpose();
        let motions = Motions::nearest(self.stretches, &nearest.x, self.variance);
        let bound = motions.as_ref().and_then(|m| m.bound(self.variance));
        let bound_ratio = bound.map(|b| free.norm() / b.trace().sqrt());
        let covariance = on_face * on_face.transpose();
        let (inertia, inertia_covariance) = self.absolute(&j, &covariance, motions.as_ref())?;
        let (momentum, energy) = drifts(self.stretches, &j, self.variance);
        let per_second = |d: Drift| Drift { rate: d.rate * self.rms, sigma: d.sigma * self.rms };
        let residuals = self.residuals(&nearest.x);
        let pull = (root * (nearest.x - self.weak.x)).norm();
        let mut estimate = Estimate {
            principal: [moments[0], moments[1], moments[2]],
            sigma_principal,
            axes,
            sigma_axes,
            ratios: [ratio(0).0, ratio(1).0],
            sigma_ratios: [ratio(0).1, ratio(1).1],
            covariance: spread(on_face),
            free_covariance: spread(free),
            bound: bound.map(|b| entries * b * entries.transpose()),
            bound_ratio,
            inertia,
            inertia_covariance,
            noise_sigma: self.variance.sqrt() * self.rms,
            chi2_per_dof: self.misfit + pull * pull * self.misfit.max(1.0) / self.weak.dof().max(1) as f64,
            pull,
            dof: self.weak.dof(),
            samples: residuals.iter().map(|r| self.record.segments[r.segment].times().len()).sum(),
            segments: residuals.len(),
            radius: self.weak.radius / self.rms,
            identifiability,
            triangle_slack: (2.0 * (LIMIT - moments[2])).max(0.0),
            active_constraints: nearest.active,
            certificate: nearest.certificate,
            momentum_drift: per_second(momentum),
            energy_drift: per_second(energy),
            whiteness: Whiteness::new(residuals.iter().map(|r| r.values.as_flattened())),
            residuals,
            warnings: Vec::new(),
            shape,
        };
        estimate.warnings = warnings(&estimate, self, better);
        Ok(estimate)
    }

    fn absolute(
        &self,
        j: &Matrix3<f64>,
        covariance: &Form,
        motions: Option<&Motions<'_>>,
    ) -> Result<(Option<Inertia>, Option<SMatrix<f64, 6, 6>>), FitError> {
        let Some(known) = self.settings.known else { return Ok((None, None)) };
        let scale = known.scale(self.stretches, self.rms, j, self.variance);
        let trace = scale.trace;
        // its covariance goes with the square
        if !(trace * trace).is_normal() {
            return Err(FitError::Setting { name: "the known quantity", value: known.value() });
        }
        let inertia = Inertia::from_tensor(j * trace)
            .map_err(|error| FitError::Solver { status: format!("no absolute tensor: {error}") })?;
        let excess = self.misfit.max(1.0);
        Ok((Some(inertia), Some(scale.covariance(j, covariance, excess, motions))))
    }

    fn residuals(&self, x: &Coordinates) -> Vec<Residuals> {
        let deviation = self.variance.sqrt();
        let each = self.weak.parts.iter();
        each.map(|part| {
            let start = self.record.segments[part.stretch].times().first().copied().unwrap_or(0.0);
            let e = part.residuals(x);
            let values: Vec<[f64; 3]> =
                e.chunks_exact(3).map(|r| [r[0], r[1], r[2]].map(|v| v / deviation)).collect();
            Residuals {
                segment: part.stretch,
                times: part.centres.iter().map(|c| start + c / self.rms).collect(),
                misfit: values.iter().flatten().map(|v| v * v).sum::<f64>() / e.len() as f64,
                values,
            }
        })
        .collect()
    }
}

/// A factor F, with covariance F Fᵀ, of an answer that is held on a face: increments along the active gradients are gone.
///
/// With the projector Q onto the face in whitened increments it is R⁻¹ Q.
fn face_factor(free: &Form, face: &[Coordinates]) -> Form {
    // gradients span a subspace of the whitened increments y; orthonormal by Gram and Schmidt
    let mut q: Vec<Coordinates> = Vec::new();
    for g in face {
        let rest = q.iter().chain(q.iter()).fold(*g, |r, u| r - u * u.dot(&r));
        if rest.norm() > 1e-10 * g.norm() {
            q.push(rest.normalize());
        }
    }
    q.iter().fold(*free, |f, u| f - (f * u) * u.transpose())
}
