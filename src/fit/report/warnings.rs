//! What a reader of an estimate must know before its figures are used.

use super::estimate::Estimate;
use crate::fit::record::Record;
use crate::fit::weak::mistaken_units::Better;
use crate::fit::weak::rounds::WeakEstimate;

/// Standard deviations by which noise alone does not carry five numbers off the physical tensors.
const FAR: f64 = 6.0;

/// Both to two digits of the deviation.
fn with_sigma(value: f64, sigma: f64) -> String {
    let digits = if sigma > 0.0 { 1.0 - libm::floor(libm::log10(sigma)) } else { 2.0 };
    let digits = digits.clamp(0.0, 15.0) as usize;
    format!("{value:.digits$} +- {sigma:.digits$}")
}

/// "1 sample has", "2 samples have".
fn samples(count: usize, one: &str, more: &str) -> String {
    if count == 1 { format!("1 sample {one}") } else { format!("{count} samples {more}") }
}

/// What warnings are drawn from, besides the estimate.
pub(super) struct Grounds<'a> {
    pub(super) record: &'a Record,
    pub(super) weak: &'a WeakEstimate,
    /// Mean square of the residuals over the noise.
    pub(super) misfit: f64,
    pub(super) better: Option<&'a Better>,
}

/// In words: what of the record, the residuals and the answer limits the use of `e`.
pub(crate) fn warnings(e: &Estimate, grounds: &Grounds<'_>) -> Vec<String> {
    let mut list = Vec::new();
    let Grounds { record, weak, misfit, better } = *grounds;
    if record.merged() > 0 {
        let samples = samples(record.merged(), "was", "were");
        list.push(format!("{samples} merged with the sample of the same time"));
    }
    if record.saturated() > 0 {
        let samples = samples(record.saturated(), "stands", "stand");
        list.push(format!("{samples} at the end of the sensor's range (flat tops), left out"));
    }
    let unused = record.segments.len() - e.segments;
    if unused > 0 {
        list.push(format!(
            "{unused} of {} segments are too short for the test functions",
            record.segments.len()
        ));
    }
    if misfit > (1.0 + 5.0 * (2.0 / e.dof.max(1) as f64).sqrt()).max(1.2) {
        let times = misfit.sqrt();
        let times = if times < 1e4 { format!("{times:.1}") } else { format!("{times:.1e}") };
        list.push(format!(
            "the residuals are {times} times what the noise of {:.2e} rad/s explains: torques, outliers or a sensor that \
             filters; deviations are enlarged by that factor",
            e.noise_sigma
        ));
    }
    if !weak.still() {
        list.push(format!(
            "the reweighting did not come to rest: a further round would move the tensor by {:.2} standard deviations",
            weak.moved
        ));
    }
    if let Some(Better { factor, hint, misfit: with, .. }) = better {
        list.push(format!(
            "with rate x time {factor:.4e} times as large the misfit falls from {:.2e} to {with:.2e}: {hint}?",
            misfit
        ));
    }
    if e.whiteness.significant() {
        list.push(format!(
            "neighbouring residuals are correlated by {:.2} +- {:.2}: the noise is not white or the model is wrong",
            e.whiteness.correlation, e.whiteness.sigma
        ));
    }
    for (name, drift) in [("momentum |J w|", e.momentum_drift), ("energy w J w", e.energy_drift)] {
        if drift.significant() {
            list.push(format!(
                "not free of torques: the {name} changes by {} per cent per second",
                with_sigma(100.0 * drift.rate, 100.0 * drift.sigma)
            ));
        }
    }
    let mut levels: Vec<f64> = e.residuals.iter().map(|r| r.misfit).collect();
    levels.sort_by(f64::total_cmp);
    if let Some(&median) = levels.get(levels.len() / 2).filter(|_| levels.len() > 2) {
        for r in e.residuals.iter().filter(|r| r.misfit > 4.0 * median) {
            list.push(format!(
                "segment {} (from {} s) has {:.1} times the residuals of the median segment: check it",
                r.segment + 1,
                record.segments[r.segment].times().first().copied().unwrap_or(0.0),
                (r.misfit / median).sqrt()
            ));
        }
    }
    for constraint in &e.active_constraints {
        list.push(format!("{} holds the answer (multiplier {:.3e})", constraint.name, constraint.multiplier));
    }
    if e.pull > FAR {
        list.push(format!(
            "law and bounds hold the answer {:.1} standard deviations off what the record says: it contradicts them",
            e.pull
        ));
    }
    // Frobenius, which no turn of the sensor changes
    let c = &e.free_covariance;
    let largest = (c.trace() + c[(3, 3)] + c[(4, 4)] + c[(5, 5)]).sqrt();
    if largest > 5e-3 {
        list.push(format!(
            "the tensor is known to {:.1} per cent of its trace only: beyond half a per cent the linear covariance is a guide",
            100.0 * largest
        ));
    }
    for (low, high) in [(0, 1), (1, 2)] {
        let (a, b) = (e.sigma_principal[low], e.sigma_principal[high]);
        if e.principal[high] - e.principal[low] < 3.0 * (a * a + b * b).sqrt() {
            list.push(format!(
                "moments {} and {} agree within their errors: the directions of their axes are arbitrary",
                low + 1,
                high + 1
            ));
        }
    }
    if e.dof < 20 {
        list.push(format!("only {} equations beyond the unknowns: the misfit says little", e.dof));
    }
    list
}
