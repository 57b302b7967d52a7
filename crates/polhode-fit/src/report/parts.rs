//! Whether the parts of a record have the same tensor: both sides of a cut, and all parts of equal length.

use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::warnings::{CUTS, HALVES, SCATTERED};

/// Two tensors of one record that contradict each other, cut where they do so most.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halves {
    /// Share of the equations before the cut: an eighth or a multiple of it.
    pub share: f64,
    /// Principal moments by the equations before the cut, ascending, as shares of the trace.
    pub first: [f64; 3],
    /// The same by those after it.
    pub second: [f64; 3],
    /// Square of their distance in standard deviations of it: χ² of five degrees of freedom where both are right.
    pub chi2: f64,
}

/// The tensors of both parts, where they differ by more than chance brings; `variance` is that of the noise with what it does
/// not explain.
pub(crate) fn halves(weak: &WeakEstimate, variance: f64) -> Option<Halves> {
    let each = (1..CUTS).filter_map(|k| parts(weak, variance, k as f64 / CUTS as f64));
    each.max_by(|a, b| a.chi2.total_cmp(&b.chi2)).filter(|most| most.chi2 > HALVES)
}

/// The tensors of the parts of a record, each by itself, contradict each other.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Parts of the same number of equations.
    pub parts: usize,
    /// Square of their distances from their weighted mean, in standard deviations.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub dof: usize,
}

impl Scatter {
    /// By how much the variance of the answer is enlarged.
    pub(crate) fn excess(&self) -> f64 {
        self.chi2 / self.dof as f64
    }
}

/// How the tensors of all parts scatter, where that is more than chance brings; `variance` as above.
pub(crate) fn scatter(weak: &WeakEstimate, variance: f64) -> Option<Scatter> {
    let each = (0..CUTS).map(|k| solved(weak, variance, [k, k + 1].map(|k| k as f64 / CUTS as f64)));
    let each = each.collect::<Option<Vec<(Coordinates, Form)>>>()?;
    let total = each.iter().fold(Form::zeros(), |sum, (_, information)| sum + information);
    let weighted = each.iter().fold(Coordinates::zeros(), |sum, (x, information)| sum + information * x);
    let mean = total.cholesky()?.solve(&weighted);
    let chi2 = each.iter().map(|(x, information)| (x - mean).dot(&(information * (x - mean)))).sum::<f64>();
    let dof = 5 * (CUTS - 1);
    (chi2 > quantile(dof as f64, SCATTERED)).then_some(Scatter { parts: CUTS, chi2, dof })
}

/// The value that chi squared exceeds as rarely as a normal deviate exceeds `z` standard deviations.
///
/// Source: E. B. Wilson and M. M. Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684.
fn quantile(dof: f64, z: f64) -> f64 {
    let variance = 2.0 / (9.0 * dof);
    let root = 1.0 - variance + z * variance.sqrt();
    dof * root * root * root
}

/// Both tensors, the record being cut after a share of the equations.
fn parts(weak: &WeakEstimate, variance: f64, share: f64) -> Option<Halves> {
    let (one, of_one) = solved(weak, variance, [0.0, share])?;
    let (other, of_other) = solved(weak, variance, [share, 1.0])?;
    let apart = one - other;
    let both = of_one.cholesky()?.inverse() + of_other.cholesky()?.inverse();
    let chi2 = apart.dot(&both.cholesky()?.solve(&apart));
    let moments = |x: &Coordinates| eigen(tensor(x)).0.into();
    Some(Halves { share, first: moments(&one), second: moments(&other), chi2 })
}

/// The tensor by the equations between two shares of them, and its information.
fn solved(weak: &WeakEstimate, variance: f64, shares: [f64; 2]) -> Option<(Coordinates, Form)> {
    let stacked = weak.stacked.as_ref()?;
    let width = 3 * (weak.columns.len() + 6);
    let equations: usize = weak.parts.iter().map(|part| part.rows.len() / width).sum();
    let [from, to] = shares.map(|share| (share * equations as f64) as usize);
    let (mut rows, mut first) = (Vec::new(), 0);
    for part in &weak.parts {
        let last = first + part.rows.len() / width;
        let [from, to] = [from, to].map(|place| width * (place.clamp(first, last) - first));
        rows.push(&part.rows[from..to]);
        first = last;
    }
    let part = Stacked::new(&rows, &weak.columns, &stacked.origin, variance.sqrt());
    Some((part.minimiser()?.x, part.information() / variance))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chances of 1e-6 and 1e-5, by the incomplete gamma function.
    #[test]
    fn quantiles_are_those_of_chi_squared() {
        for (dof, z, exact) in
            [(35.0, 4.753_424, 89.947), (35.0, 4.264_891, 82.640), (5.0, 4.264_891, 30.856)]
        {
            assert!((quantile(dof, z) / exact - 1.0).abs() < 0.04, "{}", quantile(dof, z));
        }
    }
}
