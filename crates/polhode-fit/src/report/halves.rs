//! Whether both halves of a record have the same tensor.

use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::warnings::HALVES;

/// Two tensors of one record that contradict each other.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halves {
    /// Principal moments by the first half of the equations, ascending, as shares of the trace.
    pub first: [f64; 3],
    /// The same by the second half.
    pub second: [f64; 3],
    /// Square of their distance in standard deviations of it: χ² of five degrees of freedom where both are right.
    pub chi2: f64,
}

/// The tensors of both halves, where they differ by more than chance brings; `variance` is that of the noise with what it does
/// not explain.
pub(crate) fn halves(weak: &WeakEstimate, variance: f64) -> Option<Halves> {
    let stacked = weak.stacked.as_ref()?;
    let width = weak.columns.len() + 6;
    let equations: usize = weak.parts.iter().map(|part| part.rows.len() / width / 3).sum();
    let mut left = equations / 2;
    let (mut before, mut after) = (Vec::new(), Vec::new());
    for part in &weak.parts {
        let own = left.min(part.rows.len() / width / 3);
        left -= own;
        let (first, second) = part.rows.split_at(3 * own * width);
        before.push(first);
        after.push(second);
    }
    let solved = |rows: &[&[f64]]| -> Option<(Coordinates, Form)> {
        let half = Stacked::new(rows, &weak.columns, &stacked.origin, variance.sqrt());
        let with = half.minimiser()?;
        Some((with.x, (half.information() / variance).cholesky()?.inverse()))
    };
    let ((one, of_one), (other, of_other)) = (solved(&before)?, solved(&after)?);
    let apart = one - other;
    let chi2 = apart.dot(&(of_one + of_other).cholesky()?.solve(&apart));
    let moments = |x: &Coordinates| eigen(tensor(x)).0.into();
    (chi2 > HALVES).then(|| Halves { first: moments(&one), second: moments(&other), chi2 })
}
