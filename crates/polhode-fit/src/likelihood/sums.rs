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
    /// `None` where a start is not determined.
    pub(crate) fn new(all: &[Sums], pull: Option<(&Pull, &Model)>, damping: f64) -> Option<Reduced> {
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
fn fill(square: &mut [f64], size: usize) {
    for k in 0..size {
        let entry = &mut square[k * (size + 1)];
        if *entry == 0.0 {
            *entry = 1.0;
        }
    }
}
