//! Normal equations of one stretch, and of all with their starts taken out.

use nalgebra::{SMatrix, SVector};

use crate::likelihood::track::{ALL, COMMON, Left, Model, OWN};
use crate::physical::coordinates::{Coordinates, Form};

/// Alignment and drag.
const REST: usize = COMMON - 5;

/// Of all unknowns of one stretch.
#[derive(Clone, Debug)]
pub(crate) struct Sums {
    matrix: SMatrix<f64, ALL, ALL>,
    gradient: SVector<f64, ALL>,
}

/// Of what all stretches share, each start at its best for it.
pub(crate) struct Reduced {
    pub(crate) information: SMatrix<f64, COMMON, COMMON>,
    gradient: SVector<f64, COMMON>,
    /// Of each stretch: inverse of the information on the start, its gradient, and what it shares with the common unknowns.
    starts: Vec<(SMatrix<f64, OWN, OWN>, SVector<f64, OWN>, SMatrix<f64, OWN, COMMON>)>,
}

/// A step of everything.
pub(crate) struct Step {
    pub(crate) common: SVector<f64, COMMON>,
    pub(crate) starts: Vec<SVector<f64, OWN>>,
    /// By how much the linear problem lowers the sum of squares.
    pub(crate) gain: f64,
}

impl Sums {
    pub(crate) fn zero() -> Self {
        Sums { matrix: SMatrix::zeros(), gradient: SVector::zeros() }
    }

    pub(crate) fn add(&mut self, left: &Left, weight: f64) {
        self.matrix += left.rows.tr_mul(&left.rows) * weight;
        self.gradient += left.rows.tr_mul(&left.residual) * weight;
    }

    /// What is not among the unknowns of a stretch stays where it is; `damping` enlarges the diagonal.
    fn damped(&self, damping: f64) -> SMatrix<f64, ALL, ALL> {
        let mut matrix = self.matrix;
        for k in 0..ALL {
            matrix[(k, k)] *= 1.0 + damping;
        }
        matrix
    }
}

/// Further equations of the coordinates, |root (x − centre)|², and of the drag, which is drawn to 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    pub(crate) information: Form,
    pub(crate) centre: Coordinates,
    /// Information on the drag.
    pub(crate) drag: f64,
}

impl Pull {
    pub(crate) fn squares(&self, model: &Model) -> f64 {
        let (off, drag) = (model.x - self.centre, model.drag.unwrap_or(0.0));
        off.dot(&(self.information * off)) + self.drag * drag * drag
    }
}

impl Reduced {
    /// Of readings alone. `None` where a start is not determined.
    pub(crate) fn new(all: &[Sums]) -> Option<Reduced> {
        Reduced::damped(all, None, 0.0)
    }

    /// With a pull at a model, and with damped squares of the readings.
    pub(crate) fn damped(all: &[Sums], pull: Option<(&Pull, &Model)>, damping: f64) -> Option<Reduced> {
        let mut information = SMatrix::<f64, COMMON, COMMON>::zeros();
        let mut gradient = SVector::<f64, COMMON>::zeros();
        let mut starts = Vec::with_capacity(all.len());
        for sums in all {
            let matrix = sums.damped(damping);
            let mut own = matrix.fixed_view::<OWN, OWN>(0, 0).into_owned();
            fill(own.as_mut_slice(), OWN);
            let inverse = own.cholesky()?.inverse();
            let mixed = matrix.fixed_view::<OWN, COMMON>(0, OWN).into_owned();
            let of_start = sums.gradient.fixed_rows::<OWN>(0).into_owned();
            information += matrix.fixed_view::<COMMON, COMMON>(OWN, OWN) - mixed.tr_mul(&(inverse * mixed));
            gradient += sums.gradient.fixed_rows::<COMMON>(OWN) - mixed.tr_mul(&(inverse * of_start));
            starts.push((inverse, of_start, mixed));
        }
        if let Some((pull, model)) = pull {
            let mut of_tensor = information.fixed_view_mut::<5, 5>(0, 0);
            of_tensor += pull.information;
            let mut of_tensor = gradient.fixed_rows_mut::<5>(0);
            of_tensor += pull.information * (pull.centre - model.x);
            if let Some(drag) = model.drag {
                information[(COMMON - 1, COMMON - 1)] += pull.drag;
                gradient[COMMON - 1] -= pull.drag * drag;
            }
        }
        // without both attitudes and rates there is no alignment, and not always drag
        for k in 5..COMMON {
            if all.iter().all(|sums| sums.matrix[(OWN + k, OWN + k)] == 0.0) {
                information[(k, k)] = 1.0;
            }
        }
        Some(Reduced { information, gradient, starts })
    }

    /// `None` where the common unknowns are not determined.
    pub(crate) fn step(&self) -> Option<Step> {
        let common = self.information.cholesky()?.solve(&self.gradient);
        let mut gain = common.dot(&self.gradient);
        let starts = self.starts.iter().map(|(inverse, gradient, mixed)| {
            gain += gradient.dot(&(inverse * gradient));
            inverse * (gradient - mixed * common)
        });
        let starts: Vec<_> = starts.collect();
        (common.iter().chain(starts.iter().flatten()).all(|v| v.is_finite())).then_some(Step {
            common,
            starts,
            gain,
        })
    }

    /// The step that takes the coordinates by `x`, and all else to its best for them.
    pub(crate) fn following(&self, x: &Coordinates) -> Option<Step> {
        let own = self.information.fixed_view::<REST, REST>(5, 5).into_owned().cholesky()?;
        let mixed = self.information.fixed_view::<REST, 5>(5, 0).into_owned();
        let mut common = SVector::<f64, COMMON>::zeros();
        common.fixed_rows_mut::<5>(0).copy_from(x);
        common.fixed_rows_mut::<REST>(5).copy_from(&own.solve(&(-mixed * x)));
        let starts = self.starts.iter().map(|(inverse, _, mixed)| -(inverse * (mixed * common)));
        Some(Step { common, starts: starts.collect(), gain: 0.0 })
    }

    /// The gradient of the coordinates, the alignment at its best for them.
    pub(crate) fn gradient_of_tensor(&self) -> Option<Coordinates> {
        let own = self.information.fixed_view::<REST, REST>(5, 5).into_owned().cholesky()?;
        let mixed = self.information.fixed_view::<REST, 5>(5, 0).into_owned();
        let rest = self.gradient.fixed_rows::<REST>(5).into_owned();
        Some(self.gradient.fixed_rows::<5>(0) - mixed.tr_mul(&own.solve(&rest)))
    }

    /// The information about the coordinates alone.
    pub(crate) fn of_tensor(&self) -> Option<Form> {
        let own = self.information.fixed_view::<REST, REST>(5, 5).into_owned().cholesky()?;
        let mixed = self.information.fixed_view::<REST, 5>(5, 0).into_owned();
        let form = self.information.fixed_view::<5, 5>(0, 0) - mixed.tr_mul(&own.solve(&mixed));
        Some((form + form.transpose()) * 0.5)
    }
}

/// A one on the diagonal in place of each zero.
pub(crate) fn fill(square: &mut [f64], size: usize) {
    for k in 0..size {
        let entry = &mut square[k * (size + 1)];
        if *entry == 0.0 {
            *entry = 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use polhode::num::Random;
    use polhode::rotation::Quat;

    /// Of two stretches, of which the first and the last `zeros` unknowns are in none of the readings.
    fn stretches(zeros: core::ops::Range<usize>) -> [Sums; 2] {
        let mut random = Random::new(4);
        [1.0, 0.5].map(|size| {
            let mut rows = SMatrix::<f64, 24, ALL>::from_fn(|_, _| size * random.normal());
            zeros.clone().for_each(|k| rows.column_mut(k).fill(0.0));
            let residuals = SVector::<f64, 24>::from_fn(|_, _| random.normal());
            Sums { matrix: rows.tr_mul(&rows), gradient: rows.tr_mul(&residuals) }
        })
    }

    /// The equations of all starts and of what is shared, the starts first.
    fn whole(all: &[Sums; 2], damping: f64) -> (DMatrix<f64>, DVector<f64>) {
        let place = |stretch: usize, k: usize| if k < OWN { OWN * stretch + k } else { OWN + k };
        let (mut matrix, mut gradient) =
            (DMatrix::zeros(2 * OWN + COMMON, 2 * OWN + COMMON), DVector::zeros(2 * OWN + COMMON));
        for (stretch, sums) in all.iter().enumerate() {
            for i in 0..ALL {
                gradient[place(stretch, i)] += sums.gradient[i];
                for k in 0..ALL {
                    let grown = if i == k { 1.0 + damping } else { 1.0 };
                    matrix[(place(stretch, i), place(stretch, k))] += sums.matrix[(i, k)] * grown;
                }
            }
        }
        (matrix, gradient)
    }

    fn model(drag: Option<f64>) -> Model {
        let x = Coordinates::new(0.1, -0.05, 0.02, 0.0, 0.03);
        Model { x, alignment: Quat::identity(), is_aligned: true, drag, starts: Vec::new() }
    }

    /// The step of all unknowns, and what the tensor alone tells, as by the equations of everything together.
    #[test]
    fn starts_that_are_taken_out_are_at_their_best() {
        let all = stretches(0..0);
        let first = 2 * OWN;
        for damping in [0.0, 0.3] {
            let (matrix, gradient) = whole(&all, damping);
            let reduced = Reduced::damped(&all, None, damping).unwrap();
            let (step, expected) =
                (reduced.step().unwrap(), matrix.clone().cholesky().unwrap().solve(&gradient));
            let found =
                step.starts.iter().flat_map(|start| start.iter().copied()).chain(step.common.iter().copied());
            let apart = DVector::from_iterator(first + COMMON, found) - &expected;
            assert!(apart.amax() < 1e-12 && (step.gain / expected.dot(&gradient) - 1.0).abs() < 1e-12);

            let covariance = matrix.clone().try_inverse().unwrap();
            let of_tensor: Form = covariance.fixed_view::<5, 5>(first, first).into_owned();
            let form = reduced.of_tensor().unwrap();
            assert!((form * of_tensor - Form::identity()).amax() < 1e-11);
            // F Δx is the gradient where everything else is at its best
            let dx: Coordinates = expected.fixed_rows::<5>(first).into_owned();
            assert!((reduced.gradient_of_tensor().unwrap() - form * dx).amax() < 1e-10 * form.amax());

            // everything else follows a change of the coordinates: H_rr u = −H_rx x
            let x = Coordinates::new(0.3, -0.1, 0.2, 0.5, -0.4);
            let followed = reduced.following(&x).unwrap();
            let rest: Vec<usize> = (0..first).chain(first + 5..first + COMMON).collect();
            let own = DMatrix::from_fn(rest.len(), rest.len(), |i, k| matrix[(rest[i], rest[k])]);
            let mixed = DMatrix::from_fn(rest.len(), 5, |i, k| matrix[(rest[i], first + k)]);
            let expected = -own.cholesky().unwrap().solve(&(mixed * x));
            let found = followed.starts.iter().flat_map(|start| start.iter().copied());
            let found = found.chain(followed.common.iter().skip(5).copied());
            assert!((DVector::from_iterator(rest.len(), found) - expected).amax() < 1e-11);
            assert_eq!(followed.common.fixed_rows::<5>(0).into_owned(), x);
        }
    }

    /// A pull is a sum of squares beside those of the readings: its gradient and curvature are added.
    #[test]
    fn a_pull_is_a_further_sum_of_squares() {
        let all = stretches(0..0);
        let information = Form::from_fn(|i, k| if i == k { 40.0 } else { 3.0 });
        let centre = Coordinates::new(0.3, 0.1, -0.2, 0.05, 0.0);
        let pull = Pull { information, centre, drag: 7.0 };
        for drag in [Some(0.2), None] {
            let at = model(drag);
            let (mut matrix, mut gradient) = whole(&all, 0.0);
            // minus half the gradient of the squares, by differences
            let h = 1e-4;
            for k in 0..5 {
                let moved = |by: f64| {
                    let mut at = model(drag);
                    at.x[k] += by;
                    pull.squares(&at)
                };
                gradient[2 * OWN + k] -= (moved(h) - moved(-h)) / (4.0 * h);
            }
            let mut own = matrix.fixed_view_mut::<5, 5>(2 * OWN, 2 * OWN);
            own += information;
            if let Some(drag) = drag {
                let last = 2 * OWN + COMMON - 1;
                matrix[(last, last)] += 7.0;
                gradient[last] -= 7.0 * drag;
            }
            let expected = matrix.cholesky().unwrap().solve(&gradient);
            let found = Reduced::damped(&all, Some((&pull, &at)), 0.0).unwrap().step().unwrap();
            assert!(
                (DVector::from_column_slice(found.common.as_slice()) - expected.rows(2 * OWN, COMMON)).amax()
                    < 1e-9
            );
            let off = at.x - centre;
            let squares = off.dot(&(information * off)) + drag.map_or(0.0, |drag| 7.0 * drag * drag);
            assert!((pull.squares(&at) / squares - 1.0).abs() < 1e-14);
        }
    }

    /// What no reading depends on stays where it is, and changes nothing of the rest.
    #[test]
    fn unknowns_of_no_reading_stay_where_they_are() {
        for zeros in [0..3, OWN + 5..OWN + 8, ALL - 1..ALL] {
            let all = stretches(zeros.clone());
            let step = Reduced::new(&all).unwrap().step().unwrap();
            let (matrix, gradient) = whole(&all, 0.0);
            let kept: Vec<usize> = (0..matrix.nrows()).filter(|k| matrix[(*k, *k)] > 0.0).collect();
            let own = DMatrix::from_fn(kept.len(), kept.len(), |i, k| matrix[(kept[i], kept[k])]);
            let expected =
                own.cholesky().unwrap().solve(&DVector::from_fn(kept.len(), |i, _| gradient[kept[i]]));
            let found: Vec<f64> = step.starts.iter().flatten().chain(&step.common).copied().collect();
            for (k, value) in found.iter().enumerate() {
                let own = kept.iter().position(|kept| *kept == k).map_or(0.0, |place| expected[place]);
                assert!((value - own).abs() < 1e-11, "{zeros:?} {k}");
            }
        }
    }
}
