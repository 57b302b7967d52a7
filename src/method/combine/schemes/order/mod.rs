//! Conditions of order of a scheme, without any integrator.
//!
//! A step is the product of the exponentials of its flows, a series in words of two letters A and B that do not
//! commute; the exact step is exp(A + B), in which every word of d letters has the coefficient 1/d!. A symmetric map of
//! order 2 is exp(h Y₁ + h³ Y₃ + …), Y₁ = A + B: in a composition of such the letters are these, Y_k of the weight k, and the
//! exact step is exp(Y₁).

mod quotient;
#[cfg(test)]
mod tests;
mod words;

use quotient::{logarithm, product, residual, vanishing};
use words::{Factor, coefficient, flows, maps, odd_words, sizes, words};

use super::{Pairs, Scheme, Stages};
use crate::method::SchemeError;
use crate::num::{Dd, Real};

/// More than coefficients of fifteen digits leave of a condition, relative to the size of its terms: of all schemes here 2e-16.
const ALLOWED: f64 = 1e-14;

/// How far the terms of one degree in h are from those of the exact step.
#[derive(Clone, Copy, Debug)]
struct Defect {
    /// Number of letters B; `None` where the letters are maps.
    of_b: Option<usize>,
    /// The largest difference of a coefficient.
    size: f64,
    /// The largest sum of sizes that such a coefficient is made of.
    terms: f64,
}

impl Defect {
    /// The difference over the sum; infinite where the sum is beyond the range of a double.
    fn relative(&self) -> f64 {
        let quotient = self.size / self.terms;
        if quotient.is_nan() || self.terms.is_infinite() { f64::INFINITY } else { quotient }
    }
}

/// Whether `scheme` has the order that it claims.
pub(super) fn check(scheme: &Scheme) -> Result<(), SchemeError> {
    let claimed = |of_b: Option<usize>| claimed(scheme, of_b.unwrap_or(1));
    for degree in 1..=claimed(None) {
        let found = defects(scheme, degree, |of_b| degree <= claimed(Some(of_b)));
        // also of coefficients so large that nothing can be told
        let fails = |defect: &Defect| defect.relative() > ALLOWED;
        let worst = found.into_iter().filter(fails).max_by(|a, b| a.relative().total_cmp(&b.relative()));
        if let Some(worst) = worst {
            let near_integrable = pairs(scheme).is_some_and(|pairs| powers(pairs).is_some());
            return Err(SchemeError::Order {
                scheme: scheme.name,
                order: claimed(worst.of_b) as u32,
                degree: degree as u32,
                of_b: worst.of_b.filter(|_| near_integrable).map(|of_b| of_b as u32),
                defect: worst.relative(),
                allowed: ALLOWED,
            });
        }
    }
    Ok(())
}

/// The order claimed of the terms with `of_b` letters B.
fn claimed(scheme: &Scheme, of_b: usize) -> usize {
    let powers = pairs(scheme).and_then(powers);
    let power = powers.and_then(|powers| powers.get(of_b.clamp(1, powers.len().max(1)) - 1));
    *power.unwrap_or(&scheme.order) as usize
}

/// The pairs of flows that a scheme is for; none for a composition.
pub(super) fn pairs(scheme: &Scheme) -> Option<Pairs> {
    match scheme.stages {
        Stages::Composition(_) | Stages::Processed { .. } => None,
        Stages::ForceGradient { .. } => Some(Pairs::Any),
        Stages::Alternating { pairs, .. } | Stages::ProcessedAlternating { pairs, .. } => Some(pairs),
    }
}

/// The orders in h by powers of ε.
pub(super) fn powers(pairs: Pairs) -> Option<&'static [u32]> {
    match pairs {
        Pairs::Any | Pairs::Nystrom => None,
        Pairs::NearIntegrable(powers) | Pairs::NearIntegrableNystrom(powers) => Some(powers),
    }
}

/// The defects of the terms of `degree`; of a splitting by the number of letters B, where it is `asked` for.
fn defects(scheme: &Scheme, degree: usize, asked: impl Fn(usize) -> bool) -> Vec<Defect> {
    match (maps(scheme), pairs(scheme)) {
        (Some(maps), _) => vec![defect(&maps, None, odd_words(degree))],
        (None, pairs) => defects_of_flows(&flows(scheme), pairs.unwrap_or(Pairs::Any), degree, asked),
    }
}

/// How far the coefficients of `words` in the product of the exponentials of `factors` are from those of the exact step.
fn defect(factors: &[Factor], of_b: Option<usize>, words: Vec<Vec<u8>>) -> Defect {
    let sizes = sizes(factors);
    let size = words.iter().map(|word| (coefficient(factors, word) - exact(word)).magnitude());
    let terms = words.iter().map(|word| (coefficient(&sizes, word) + exact(word)).magnitude());
    Defect { of_b, size: largest(size), terms: largest(terms) }
}

/// The defects of flows by the number of letters B; what vanishes for `pairs` is left out.
fn defects_of_flows(
    flows: &[Factor],
    pairs: Pairs,
    degree: usize,
    asked: impl Fn(usize) -> bool,
) -> Vec<Defect> {
    let mut found: Vec<Defect> = (0..=degree)
        .filter(|&of_b| asked(of_b))
        .map(|of_b| defect(flows, Some(of_b), words(degree, of_b)))
        .collect();
    // what vanishes has three letters B at least
    if matches!(pairs, Pairs::Nystrom | Pairs::NearIntegrableNystrom(_)) && (3..=degree).any(asked) {
        let log = logarithm(&product(flows, degree));
        let left = residual(&log[degree], &vanishing(degree));
        for defect in found.iter_mut().filter(|defect| defect.of_b >= Some(3)) {
            let with = |word: usize| Some(word.count_ones() as usize) == defect.of_b;
            let words = left.iter().enumerate().filter(|(word, _)| with(*word));
            defect.size = largest(words.map(|(_, value)| value.magnitude()));
        }
    }
    found
}

/// The coefficient of `word` in the exact step: 1/d! for d letters A and B, or Y₁.
fn exact(word: &[u8]) -> Dd {
    if word.iter().any(|&letter| letter > 1) {
        return Dd::ZERO;
    }
    (1..=word.len()).fold(Dd::ONE, |value, d| value / d as f64)
}

/// The largest of `sizes`; NaN if one is NaN.
fn largest(sizes: impl Iterator<Item = f64>) -> f64 {
    sizes.fold(0.0, |largest, size| if size.is_nan() || size > largest { size } else { largest })
}
