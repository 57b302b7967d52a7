//! Whether records agree.

use crate::report::nuisance::Agreement;
use crate::report::parts::quantile;
use crate::thresholds::carrier::CONTRADICTED;

/// Whether mere noise does not carry the records so far apart.
pub(super) fn contradicts(Agreement { chi2, dof }: Agreement) -> bool {
    dof > 0 && chi2 > quantile(dof as f64, CONTRADICTED)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With z = 4.7534 the cube root may reach 1 − 1/9 + z/3 of two degrees of freedom and 1 − 1/36 + z/6 of eight, whose cubes times the
    /// degrees are 30.26 and 43.95.
    #[test]
    fn records_contradict_each_other_beyond_a_chance_of_a_millionth() {
        for (dof, below, above) in [(2, 30.2, 30.3), (8, 43.9, 44.0)] {
            assert!(!contradicts(Agreement { chi2: below, dof }), "{dof}");
            assert!(contradicts(Agreement { chi2: above, dof }), "{dof}");
        }
        assert!(!contradicts(Agreement { chi2: 1e9, dof: 0 }));
    }
}
