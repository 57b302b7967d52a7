//! Whether records agree.

use crate::report::nuisance::Agreement;
use crate::thresholds::carrier::CONTRADICTED;

/// Whether mere noise does not carry the records so far apart.
///
/// Source: E. B. Wilson, M. M. Hilferty, Proceedings of the National Academy of Sciences 17 (1931) 684: the cube root of chi
/// squared over its degrees of freedom n is all but normal, with the mean 1 − 2/(9 n) and the variance 2/(9 n).
pub(super) fn contradicts(Agreement { chi2, dof }: Agreement) -> bool {
    let of_one = 2.0 / (9.0 * dof as f64);
    dof > 0 && libm::cbrt(chi2 / dof as f64) > 1.0 - of_one + CONTRADICTED * of_one.sqrt()
}
