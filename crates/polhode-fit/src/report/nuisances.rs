//! Names, units and values of what was estimated beside the tensor.

use crate::report::differing::Differing;
use crate::report::nuisance::Nuisance;
use crate::solve::weak_estimate::WeakEstimate;

/// The unknowns beside the tensor at `values`, with deviations for residuals of `variance` and for what parts of the record differ in, or
/// those of `held` by number.
pub(crate) fn nuisances(
    weak: &WeakEstimate,
    values: &[f64],
    variance: f64,
    rms: f64,
    held: &[(usize, f64)],
    differing: Option<&Differing>,
) -> Vec<Nuisance> {
    let Some(factor) = weak.stacked.as_ref().and_then(|stacked| stacked.joint_factor()) else {
        return Vec::new();
    };
    let each = weak.columns.iter().zip(values).enumerate();
    each.map(|(k, (column, value))| {
        let own = held.iter().find(|(place, _)| *place == k).map(|(_, sigma)| *sigma);
        let more = differing.map_or(0.0, |differing| differing.variance(k));
        let sigma = own.unwrap_or_else(|| (factor.row(k).norm_squared() * variance + more).sqrt());
        Nuisance::new(column, *value, sigma, rms)
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::{Column, Unknowns};
    use crate::columns::drag::Drag;
    use crate::columns::offset::Offset;
    use crate::columns::scale::Scale;
    use crate::physical::coordinates::Coordinates;
    use crate::solve::weak_estimate::tests::one_row_each;

    /// Of an unknown that is told with a weight the deviation is that of the noise over it, in the unit of the report; one that a wall holds has
    /// its own.
    #[test]
    fn an_unknown_has_the_deviation_of_its_weight() {
        let columns = [Column::new(Drag, None), Column::new(Offset(1), None), Column::new(Scale, None)];
        let at = Unknowns::at(Coordinates::zeros(), &columns);
        let weights = [10.0, 20.0, 40.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        let mut weak = WeakEstimate::of_rows(&columns, &at, vec![one_row_each(&weights, &[0.0; 8])], 0.5);
        let found = nuisances(&weak, &[0.1, 0.2, 0.3], 0.25, 4.0, &[(2, 0.75)], None);
        let expected = [("drag", 0.4, 0.2), ("offset_y", 0.8, 0.1), ("scale", 0.3, 0.75)];
        assert_eq!(found.len(), 3);
        for (found, (name, value, sigma)) in found.iter().zip(expected) {
            assert_eq!(found.name, name);
            assert!((found.value / value - 1.0).abs() < 1e-12, "{name}: {}", found.value);
            assert!((found.sigma / sigma - 1.0).abs() < 1e-6, "{name}: {}", found.sigma);
        }
        weak.stacked = None;
        assert!(nuisances(&weak, &[0.1, 0.2, 0.3], 0.25, 4.0, &[], None).is_empty());
    }
}
