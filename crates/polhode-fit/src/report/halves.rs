//! Whether both parts of a record, wherever it is cut, have the same tensor.

use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::warnings::{CUTS, HALVES};

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

/// Both tensors, the record being cut after a share of the equations.
fn parts(weak: &WeakEstimate, variance: f64, share: f64) -> Option<Halves> {
    let stacked = weak.stacked.as_ref()?;
    let width = weak.columns.len() + 6;
    let equations: usize = weak.parts.iter().map(|part| part.rows.len() / width / 3).sum();
    let mut left = (share * equations as f64) as usize;
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for part in &weak.parts {
        let own = left.min(part.rows.len() / width / 3);
        left -= own;
        let (first, second) = part.rows.split_at(3 * own * width);
        before.push(first);
        after.push(second);
    }
    let solved = |rows: &[&[f64]]| -> Option<(Coordinates, Form)> {
        let part = Stacked::new(rows, &weak.columns, &stacked.origin, variance.sqrt());
        let with = part.minimiser()?;
        Some((with.x, (part.information() / variance).cholesky()?.inverse()))
    };
    let ((one, of_one), (other, of_other)) = (solved(&before)?, solved(&after)?);
    let apart = one - other;
    let chi2 = apart.dot(&(of_one + of_other).cholesky()?.solve(&apart));
    let moments = |x: &Coordinates| eigen(tensor(x)).0.into();
    Some(Halves { share, first: moments(&one), second: moments(&other), chi2 })
}
