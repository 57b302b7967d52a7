//! What one record tells, its torques and the choice of a torque each at their best.

use nalgebra::{DMatrix, DVector};

use crate::columns::column::Column;
use crate::columns::effect::Class;
use crate::estimator::Drawn;
use crate::physical::nearest::Normal;
use crate::solve::stacked::Stacked;
use crate::solve::triangle::Triangle;

/// |R m + r|² of readings m: the errors of the sensor in SI units, without their priors; one over the trace, where wheels or
/// torques tell it, 1/(kg m²); five coordinates of the shape.
pub(super) struct Told {
    pub(super) root: DMatrix<f64>,
    pub(super) right: DVector<f64>,
    pub(super) has_input: bool,
    drags: Drags,
}

/// How the drag of a record follows from the readings.
struct Drags {
    /// Triangle of all torques of the record, and of what is added to the covariance by its noise; how they depend on the readings, and their right-hand side.
    own: DMatrix<f64>,
    shared: DMatrix<f64>,
    right: DVector<f64>,
    /// Places among them that are drag, and their columns.
    places: Vec<(usize, usize)>,
}

impl Told {
    /// With the columns `held` at zero: drag that takes no energy.
    pub(super) fn new(drawn: &Drawn, held: &[usize]) -> Option<Told> {
        let Drawn { weak, deviation, beside, rms, input } = drawn;
        let origin = &weak.stacked.as_ref()?.origin;
        // priors of what records share would count once for each
        let columns: Vec<Column> = weak.columns.iter().map(|column| column.with_prior(None)).collect();
        let rows: Vec<&[f64]> = weak.parts.iter().map(|part| part.rows.as_slice()).collect();
        let stacked = Stacked::new(&rows, &columns, origin, *deviation);
        let (triangle, right) = (stacked.whole() / *deviation, stacked.at_zero() / *deviation);
        let of_class = |wanted: fn(Class) -> bool| -> Vec<usize> {
            (0..columns.len()).filter(|&k| wanted(columns[k].class())).collect()
        };
        let shared = of_class(|class| class == Class::Sensor);
        let inputs = of_class(|class| class == Class::Input);
        let mut own = of_class(|class| !matches!(class, Class::Sensor | Class::Input));
        own.retain(|k| !held.contains(k));
        // all of the record is off by M e, e standard normal, M Mᵀ being what is added to the covariance by its noise
        let (wider, first) = (beside.ncols(), columns.len());
        let width = own.len() + wider + shared.len() + inputs.len() + 6;
        let mut all = Triangle::new(width);
        for (row, right) in triangle.row_iter().zip(&right) {
            let off = |e: usize| row.iter().zip(&beside.column(e)).map(|(a, b)| a * b).sum::<f64>();
            let each = own.iter().map(|&k| row[k]).chain((0..wider).map(off));
            let each = each.chain(shared.iter().map(|&k| row[k] / columns[k].label().factor(*rms)));
            let each = each.chain(inputs.iter().map(|&k| row[k] * input.unwrap_or(1.0)));
            all.push(each.chain((0..5).map(|k| row[first + k])).chain([*right]));
        }
        for e in 0..wider {
            all.push((0..width).map(|k| f64::from(u8::from(k == own.len() + e))));
        }
        let (behind, size) = (own.len() + wider, shared.len() + inputs.len() + 5);
        let r = all.finished();
        let root = r.view((behind, behind), (size, size)).into_owned();
        let right = r.view((behind, width - 1), (size, 1)).column(0).into_owned();
        let finite = root.iter().chain(&right).all(|v| v.is_finite());
        let is_drag = |(_, k): &(usize, &usize)| columns[**k].class() == Class::Drag;
        let drags = Drags {
            own: r.view((0, 0), (behind, behind)).into_owned(),
            shared: r.view((0, behind), (behind, size)).into_owned(),
            right: r.view((0, width - 1), (behind, 1)).column(0).into_owned(),
            places: own.iter().enumerate().filter(is_drag).map(|(place, k)| (place, *k)).collect(),
        };
        finite.then_some(Told { root, right, has_input: !inputs.is_empty(), drags })
    }

    /// The columns of drag that are negative where the readings are `m` and all else is at its best.
    pub(super) fn gains(&self, m: &DVector<f64>) -> Vec<usize> {
        let Drags { own, shared, right, places } = &self.drags;
        let Some(values) = own.solve_upper_triangular(&-(right + shared * m)) else { return Vec::new() };
        places.iter().filter(|(place, _)| values[*place] < 0.0).map(|(_, column)| *column).collect()
    }

    /// What it tells by itself of one over the trace and the shape, the errors of the sensor having these priors.
    pub(super) fn alone(&self, priors: &[f64]) -> Option<Normal> {
        let (first, size) = (priors.len(), self.right.len());
        let mut all = Triangle::new(size + 1);
        for (row, right) in self.root.row_iter().zip(&self.right) {
            all.push(row.iter().copied().chain([*right]));
        }
        for (k, prior) in priors.iter().enumerate() {
            all.push((0..=size).map(|i| if i == k { 1.0 / prior } else { 0.0 }));
        }
        let r = all.finished();
        let root = r.view((first, first), (size - first, size - first)).into_owned();
        let right = r.view((first, size), (size - first, 1)).column(0).into_owned();
        let centre = root.solve_upper_triangular(&-right)?;
        centre.iter().all(|v| v.is_finite()).then_some(Normal { centre, root })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::num::Random;

    /// Two torques, of which the first depends on the second: values follow from the last row to the first, and the drag that would be
    /// negative is told by its column.
    #[test]
    fn drag_that_gives_energy_is_told_by_its_column() {
        let drags = |places| Drags {
            own: DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 0.0, 4.0]),
            shared: DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, -2.0]),
            right: DVector::from_vec(vec![0.5, -3.0]),
            places,
        };
        let told = |places| Told {
            root: DMatrix::identity(2, 2),
            right: DVector::zeros(2),
            has_input: false,
            drags: drags(places),
        };
        let both = told(vec![(0, 7), (1, 3)]);
        // v₁ = (3 + 2 m₁)/4 and v₀ = (−½ − m₀ − v₁)/2
        for (m, gains) in [([0.0, 0.0], vec![7]), ([-2.0, 0.0], vec![]), ([-2.0, -2.0], vec![3])] {
            assert_eq!(both.gains(&DVector::from_column_slice(&m)), gains, "{m:?}");
        }
        assert_eq!(both.gains(&DVector::from_column_slice(&[0.0, -2.0])), [7, 3]);
        // another torque may have any sign
        assert!(told(vec![(1, 3)]).gains(&DVector::zeros(2)).is_empty());
    }

    /// Alone a record says what the normal distribution of all readings does when the errors of the sensor, with their priors, are left open.
    #[test]
    fn errors_of_the_sensor_are_at_their_best_by_their_priors() {
        let mut random = Random::new(8);
        let (priors, size) = ([0.5, 2.0], 7);
        let any = DMatrix::from_fn(size, size, |_, _| random.normal());
        let root = any.upper_triangle() + DMatrix::identity(size, size) * 6.0;
        let right = DVector::from_fn(size, |_, _| random.normal());
        let mut information = root.tr_mul(&root);
        priors.iter().enumerate().for_each(|(k, prior)| information[(k, k)] += 1.0 / (prior * prior));
        let covariance = information.try_inverse().unwrap();
        let centre = -(&covariance * root.tr_mul(&right));
        let drags = Drags {
            own: DMatrix::zeros(0, 0),
            shared: DMatrix::zeros(0, size),
            right: DVector::zeros(0),
            places: Vec::new(),
        };
        let found = Told { root, right, has_input: false, drags }.alone(&priors).unwrap();
        assert!((&found.centre - centre.rows(2, 5)).amax() < 1e-13, "{}", found.centre);
        let own = found.root.tr_mul(&found.root) * covariance.view((2, 2), (5, 5));
        assert!((own - DMatrix::<f64>::identity(5, 5)).amax() < 1e-12);
    }
}
