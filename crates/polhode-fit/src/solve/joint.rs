//! What all stretches say of some columns and the tensor together, the other columns each at its best for them.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::columns::column::{Column, Unknowns};
use crate::physical::coordinates::{Coordinates, Form};
use crate::physical::nearest::Normal;
use crate::solve::weak_estimate::WeakEstimate;

/// A weak estimate as the normal distribution of kept columns and the tensor.
pub(crate) struct Joint {
    /// The columns that are kept, by their numbers: the unknowns of `told` before the coordinates of the tensor.
    pub(crate) kept: Vec<usize>,
    pub(crate) told: Normal,
    /// The other columns, by their numbers.
    rest: Vec<usize>,
    /// Their triangle, and their part in the columns that are kept and the tensor.
    own: DMatrix<f64>,
    shared: DMatrix<f64>,
    /// Where everything is best.
    best: Unknowns,
}

impl Joint {
    /// Of the columns that `keeps` picks; `deviation` is that of the noise with what it does not explain.
    pub(crate) fn new(weak: &WeakEstimate, keeps: impl Fn(&Column) -> bool, deviation: f64) -> Option<Joint> {
        let columns = weak.columns.iter().enumerate();
        let (kept, rest): (Vec<usize>, Vec<usize>) = match &weak.stacked {
            Some(_) => columns.map(|(k, _)| k).partition(|&k| keeps(&weak.columns[k])),
            None => (Vec::new(), Vec::new()),
        };
        let (first, behind) = (rest.len(), kept.len());
        let order: Vec<usize> = rest.iter().chain(&kept).copied().collect();
        let (mut triangle, mut with_tensor) = (DMatrix::zeros(0, 0), DMatrix::zeros(0, 5));
        if let Some(stacked) = weak.stacked.as_ref().filter(|_| !order.is_empty()) {
            let permuted = DMatrix::from_fn(order.len(), order.len(), |i, k| stacked.own[(i, order[k])]);
            let qr = permuted.qr();
            with_tensor = qr.q().transpose() * &stacked.shared;
            triangle = qr.r();
        }
        let size = behind + 5;
        let mut root = DMatrix::zeros(size, size);
        root.view_mut((0, 0), (behind, behind)).copy_from(&triangle.view((first, first), (behind, behind)));
        root.view_mut((0, behind), (behind, 5)).copy_from(&with_tensor.rows(first, behind));
        root.view_mut((behind, behind), (5, 5)).copy_from(&weak.root);
        root /= deviation;
        let best = weak.at.clone();
        let values = kept.iter().map(|&k| best.c[k]).chain(best.x.iter().copied());
        let centre = DVector::from_iterator(size, values);
        let mut shared = DMatrix::zeros(first, size);
        shared.view_mut((0, 0), (first, behind)).copy_from(&triangle.view((0, first), (first, behind)));
        shared.view_mut((0, behind), (first, 5)).copy_from(&with_tensor.rows(0, first));
        let own = triangle.view((0, 0), (first, first)).into_owned();
        let finite = root.iter().chain(&centre).all(|v| v.is_finite());
        finite.then_some(Joint { kept, told: Normal { centre, root }, rest, own, shared, best })
    }

    /// With the covariance of the kept columns and the tensor enlarged by M Mᵀ.
    pub(crate) fn widened(mut self, more: &DMatrix<f64>) -> Option<Joint> {
        if more.iter().all(|entry| *entry == 0.0) {
            return Some(self);
        }
        // C + M Mᵀ = F Fᵀ with F = (R⁻¹, M), and Fᵀ = Q T: a root of its inverse is T⁻ᵀ
        let size = self.told.root.ncols();
        let mut factors = DMatrix::zeros(size + more.ncols(), size);
        let own = self.told.root.clone().try_inverse()?;
        factors.view_mut((0, 0), (size, size)).copy_from(&own.transpose());
        factors.view_mut((size, 0), (more.ncols(), size)).copy_from(&more.transpose());
        let inverse = factors.qr().r().try_inverse()?;
        self.told.root = inverse.transpose().qr().r();
        self.told.root.iter().all(|v| v.is_finite()).then_some(self)
    }

    /// By how much the kept columns and the tensor are moved at other unknowns.
    pub(crate) fn moved(&self, to: &Unknowns) -> DMatrix<f64> {
        let columns = self.kept.iter().map(|&k| to.c[k] - self.best.c[k]);
        let steps = columns.chain((to.x - self.best.x).iter().copied()).collect::<Vec<f64>>();
        DMatrix::from_column_slice(steps.len(), 1, &steps)
    }

    /// A factor of a covariance that the tensor alone has, as of the kept columns and the tensor.
    pub(crate) fn of_tensor(&self, spread: &Form) -> DMatrix<f64> {
        let size = self.told.root.ncols();
        let mut more = DMatrix::zeros(size, 5);
        more.view_mut((size - 5, 0), (5, 5)).copy_from(&factor(spread));
        more
    }

    /// All unknowns where those that are kept are `others`, and the tensor is `x`.
    pub(crate) fn unknowns(&self, others: &[f64], x: Coordinates) -> Unknowns {
        let mut at = Unknowns { x, c: self.best.c.clone() };
        for (&k, value) in self.kept.iter().zip(others) {
            at.c[k] = *value;
        }
        let best = self.kept.iter().map(|&k| self.best.c[k]).chain(self.best.x.iter().copied());
        let moved = others.iter().chain(x.iter()).zip(best).map(|(new, old)| new - old);
        let step = DVector::from_iterator(self.shared.ncols(), moved);
        if let Some(follows) = self.own.solve_upper_triangular(&-(&self.shared * step)) {
            self.rest.iter().zip(follows.iter()).for_each(|(&k, step)| at.c[k] += step);
        }
        at
    }
}

/// F of a form F Fᵀ.
pub(crate) fn factor(form: &Form) -> Form {
    let SymmetricEigen { eigenvectors: v, eigenvalues } = SymmetricEigen::new(*form);
    v * Form::from_diagonal(&eigenvalues.map(|value| value.max(0.0).sqrt()))
}
