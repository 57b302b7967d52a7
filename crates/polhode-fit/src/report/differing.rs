//! Whether the parts of a record differ in what they say of an unknown beside the tensor.

use nalgebra::{DMatrix, DVector};

use crate::physical::coordinates::eigen;
use crate::report::parts::{quantile, rows_between};
use crate::solve::linearised::residuals;
use crate::solve::stacked::Stacked;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::warnings::{CUTS, DIFFERING, NAMED, SCATTERED};

/// Unknowns in which the parts of a record differ by more than their noise.
pub(crate) struct Differing {
    /// What those are called in which they do so by far, each with the factor by which its standard deviation is enlarged.
    pub(crate) named: Vec<(&'static str, f64)>,
    /// Displacements of all columns and the tensor that enlarge their covariance, one deviation each.
    added: Vec<DVector<f64>>,
}

/// The unknowns of an estimate in which its parts differ; `variance` is that of the noise with what it does not explain.
///
/// With residuals r and derivatives A of a part, H⁻¹ Aᵀ r is how far that part pulls the estimate, and the sum of squares of all pulls is
/// its variance by the jackknife, whatever the noise is. If the noise is what it is taken for, a pull has the
/// covariance H⁻¹ (h − h H⁻¹ h) H⁻¹ with h = Aᵀ A. Where the pulls on an unknown are larger than that by more than chance brings, its variance is
/// enlarged by their ratio, and what is correlated with it follows. Of the tensor the axes of its ellipsoid are asked one by one.
/// Segments are the parts where there are enough of them.
///
/// Source: R. G. Miller, Biometrika 61 (1974) 1; C. F. J. Wu, Annals of Statistics 14 (1986) 1261.
pub(crate) fn differing(weak: &WeakEstimate, variance: f64) -> Option<Differing> {
    let count = weak.columns.len();
    let stacked = weak.stacked.as_ref()?;
    let (factor, size) = (stacked.joint_factor()?, count + 5);
    let parts: Vec<Vec<&[f64]>> = match weak.parts.len() {
        many if many >= CUTS => weak.parts.iter().map(|part| vec![part.rows.as_slice()]).collect(),
        _ => (0..CUTS).map(|k| rows_between(weak, [k, k + 1].map(|k| k as f64 / CUTS as f64))).collect(),
    };
    let mut covariance = &factor * factor.transpose() * variance;
    let (_, axes) = eigen(covariance.fixed_view::<5, 5>(count, count).into_owned());
    let alone = |at: usize| DVector::from_fn(size, |i, _| if i == at { 1.0 } else { 0.0 });
    let columns = (0..count).map(|k| (weak.columns[k].label().name, alone(k), DIFFERING, NAMED));
    let of_tensor = (0..5).map(|k| {
        let axis = DVector::from_fn(size, |i, _| if i < count { 0.0 } else { axes[(i - count, k)] });
        ("the tensor", axis, SCATTERED, SCATTERED)
    });
    let mut found = Differing { named: Vec::new(), added: Vec::new() };
    for (name, direction, chance, of_name) in columns.chain(of_tensor) {
        let towards = &factor * factor.tr_mul(&direction);
        let (ratio, dof) = pulls(weak, stacked, &parts, &factor, &towards, variance);
        let alone = direction.dot(&(&covariance * &direction));
        let before = direction.dot(&towards) * variance;
        if dof.is_finite() && ratio > quantile(dof, chance) / dof && ratio * before > alone {
            let added = &covariance * &direction * ((ratio * before - alone).sqrt() / alone);
            covariance += &added * added.transpose();
            found.added.push(added);
            if ratio > quantile(dof, of_name) / dof {
                found.named.push((name, ratio.sqrt()));
            }
        }
    }
    (!found.added.is_empty()).then_some(found)
}

/// Sum of squares of the pulls of all parts along `towards`, over what the noise makes of it, and its degrees of freedom.
fn pulls(
    weak: &WeakEstimate,
    stacked: &Stacked,
    parts: &[Vec<&[f64]>],
    factor: &DMatrix<f64>,
    towards: &DVector<f64>,
    variance: f64,
) -> (f64, f64) {
    let width = towards.len() + 1;
    let (mut pulls, mut expected, mut squares) = (0.0, 0.0, 0.0);
    for part in parts {
        let (mut pull, mut own, mut shared) = (0.0, 0.0, DVector::zeros(width - 1));
        for rows in part {
            let left = residuals(rows, width, &stacked.origin, &weak.at);
            for (row, left) in rows.chunks_exact(width).zip(left) {
                let moved: f64 = row.iter().zip(towards).map(|(a, u)| a * u).sum();
                pull += moved * left;
                own += moved * moved;
                shared.iter_mut().zip(row).for_each(|(sum, a)| *sum += a * moved);
            }
        }
        let known = own - factor.tr_mul(&shared).norm_squared();
        pulls += pull * pull;
        expected += known;
        squares += known * known;
    }
    // parts that weigh unequally are fewer
    (pulls / (variance * expected), expected * expected / squares)
}

impl Differing {
    /// By how much the variance of a column is enlarged.
    pub(crate) fn variance(&self, column: usize) -> f64 {
        self.added.iter().map(|added| added[column] * added[column]).sum()
    }

    /// The displacements of all columns and the tensor.
    pub(crate) fn all(&self) -> &[DVector<f64>] {
        &self.added
    }

    /// The displacements of some columns and the tensor, side by side.
    pub(crate) fn of(&self, kept: &[usize]) -> DMatrix<f64> {
        let size = self.added.first().map_or(0, DVector::len);
        let rows: Vec<usize> = kept.iter().copied().chain(size - 5..size).collect();
        DMatrix::from_fn(rows.len(), self.added.len(), |i, k| self.added[k][rows[i]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::{Column, Unknowns};
    use crate::columns::drag::Drag;
    use crate::physical::coordinates::Coordinates;
    use crate::solve::weak_estimate::tests::one_row_each;

    /// Displacements of three columns and the tensor: the squares of a column add up, and of those that are kept the rows stay in their order.
    #[test]
    fn displacements_add_their_squares() {
        let of = |from: f64| DVector::from_fn(8, |k, _| from + k as f64);
        let differing = Differing { named: Vec::new(), added: vec![of(1.0), of(-3.0)] };
        assert_eq!([0, 1, 2].map(|k| differing.variance(k)), [10.0, 8.0, 10.0]);
        assert_eq!(differing.all(), [of(1.0), of(-3.0)]);
        let kept = differing.of(&[2, 0]);
        let rows = [[3.0, -1.0], [1.0, -3.0], [4.0, 0.0], [5.0, 1.0], [6.0, 2.0], [7.0, 3.0], [8.0, 4.0]];
        assert_eq!(kept, DMatrix::from_fn(7, 2, |i, k| rows[i][k]));
        assert_eq!(differing.of(&[]), DMatrix::from_fn(5, 2, |i, k| rows[i + 2][k]));
    }

    /// Eight parts that tell each unknown alike, and one of them too high and too low by turns: a part has 7/8 of its noise beside the others, and
    /// the unknown the variance of the pulls, where their mean square is more than chance brings. It is the same in one segment or in as many.
    #[test]
    fn an_unknown_has_the_variance_of_the_pulls_of_all_parts() {
        let (weights, variance) = ([10.0, 20.0, 30.0, 40.0, 50.0, 60.0], 0.25_f64);
        let columns = [Column::new(Drag, None)];
        let at = Unknowns::at(Coordinates::zeros(), &columns);
        let of = |k: usize, ratio: f64, segments: usize| {
            let part = |part: usize| {
                let mut left = [0.0; 6];
                left[k] = (0.875 * variance * ratio).sqrt() * if part.is_multiple_of(2) { 1.0 } else { -1.0 };
                one_row_each(&weights, &left)
            };
            let parts: Vec<Vec<f64>> = (0..CUTS).map(part).collect();
            let parts: Vec<Vec<f64>> = parts.chunks(CUTS / segments).map(|own| own.concat()).collect();
            differing(&WeakEstimate::of_rows(&columns, &at, parts, variance.sqrt()), variance)
        };
        for (k, weight) in weights.iter().enumerate() {
            let (chance, name) = if k == 0 { (DIFFERING, "drag") } else { (SCATTERED, "the tensor") };
            let least = quantile(8.0, chance) / 8.0;
            let before = variance / (8.0 * weight * weight);
            for segments in [1, 2, 8] {
                assert!(of(k, 0.999 * least, segments).is_none(), "{k} {segments}");
                let found = of(k, 1.001 * least, segments).unwrap();
                assert_eq!(found.all().len(), 1, "{k} {segments}");
                for other in 0..6 {
                    let more = if other == k { (1.001 * least - 1.0) * before } else { 0.0 };
                    assert!((found.variance(other) - more).abs() < 1e-6 * before, "{k} {other}");
                }
                // what is named differs by far
                let of_name = if k == 0 { NAMED } else { SCATTERED };
                let by_far = quantile(8.0, of_name) / 8.0;
                assert!(k > 0 || of(k, 0.999 * by_far, segments).unwrap().named.is_empty());
                let named = of(k, 1.001 * by_far, segments).unwrap().named;
                let [(found, factor)] = named[..] else { panic!("{named:?}") };
                let expected = (1.001 * by_far).sqrt();
                assert!(found == name && (factor / expected - 1.0).abs() < 1e-6, "{k} {factor}");
            }
        }
    }
}
