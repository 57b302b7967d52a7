//! Rows of all stretches and priors stacked into one triangle.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector, SMatrix};

use crate::columns::column::{Column, Unknowns};
use crate::physical::coordinates::{Coordinates, Form};
use crate::solve::triangle::Triangle;
use crate::thresholds::stacked::{FLAT, RIDGE};

/// Further equations W (x − centre) = 0 of the tensor alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    pub(crate) root: Form,
    pub(crate) centre: Coordinates,
}

/// min |R (x − origin) + z|²: what all stretches say together, each column at its best for x.
pub(crate) struct Stacked {
    pub(crate) origin: Unknowns,
    /// Upper triangular, Rᵀ R = H.
    pub(crate) root: Form,
    z: Coordinates,
    /// Rows of the columns: their own triangle, their part in x, and their right-hand side.
    pub(crate) own: DMatrix<f64>,
    pub(crate) shared: DMatrix<f64>,
    right: DVector<f64>,
    /// Sum of squares of the whitened residuals that no x removes.
    pub(crate) squares: f64,
    /// Equations beyond the columns without a prior.
    pub(crate) rows: usize,
}

impl Stacked {
    /// The triangle of all whitened rows, without forming their squares. `deviation` is that of the noise.
    pub(crate) fn new(rows: &[&[f64]], columns: &[Column], origin: &Unknowns, deviation: f64) -> Stacked {
        let count = columns.len();
        let width = count + 6;
        let equations: usize = rows.iter().map(|rows| rows.len() / width).sum();
        let mut triangle = Triangle::new(width);
        for row in triangles(rows, columns, width).iter().flat_map(|rows| rows.chunks_exact(width)) {
            triangle.push(row.iter().copied());
        }
        for (k, column) in columns.iter().enumerate() {
            let weight = deviation / column.prior.unwrap_or(FLAT);
            let entry = |i| match i {
                i if i == k => weight,
                i if i == width - 1 => weight * origin.c[k],
                _ => 0.0,
            };
            triangle.push((0..width).map(entry));
        }
        let r = triangle.finished();
        let flat = columns.iter().filter(|column| column.prior.is_none()).count();
        let left = r[(width - 1, width - 1)];
        Stacked {
            origin: origin.clone(),
            root: Form::from_fn(|i, k| if i <= k { r[(count + i, count + k)] } else { 0.0 }),
            z: Coordinates::from_fn(|i, _| r[(count + i, width - 1)]),
            own: DMatrix::from_fn(count, count, |i, k| if i <= k { r[(i, k)] } else { 0.0 }),
            shared: DMatrix::from_fn(count, 5, |i, k| r[(i, count + k)]),
            right: DVector::from_fn(count, |i, _| r[(i, width - 1)]),
            squares: left * left,
            rows: equations - flat.min(equations),
        }
    }

    /// Mean square of what is left over that of the noise, where it is more than 1.
    pub(crate) fn excess(&self, variance: f64) -> f64 {
        (self.squares / variance / self.rows.saturating_sub(5).max(1) as f64).max(1.0)
    }

    /// z of |R (x − origin) + z|².
    pub(crate) fn left(&self) -> Coordinates {
        self.z
    }

    /// With the least at `best` and the information of (c, x) about it in the place of those of the rows.
    pub(crate) fn at_least(&self, best: &Unknowns, information: &DMatrix<f64>) -> Option<Stacked> {
        let r = information.clone().cholesky()?.l().transpose();
        let (count, origin) = (best.c.len(), &self.origin);
        let moved =
            best.c.iter().zip(&origin.c).chain(best.x.iter().zip(&origin.x)).map(|(new, old)| new - old);
        let left = -&r * DVector::from_iterator(count + 5, moved);
        Some(Stacked {
            origin: origin.clone(),
            root: r.fixed_view::<5, 5>(count, count).into_owned(),
            z: left.fixed_rows::<5>(count).into_owned(),
            own: r.view((0, 0), (count, count)).into_owned(),
            shared: r.view((0, count), (count, 5)).into_owned(),
            right: left.rows(0, count).into_owned(),
            squares: self.squares,
            rows: self.rows,
        })
    }

    pub(crate) fn information(&self) -> Form {
        self.root.transpose() * self.root
    }

    /// The x that makes |R (x − origin) + z|² + ridge |x|² least, with its columns.
    pub(crate) fn ridge(&self, ridge: f64) -> Option<Unknowns> {
        // far above the rounding of R, where the record tells nothing and has no noise either; only weights are at stake
        let weight = ridge.sqrt().max(RIDGE * self.root.norm());
        self.pulled(&Pull { root: Form::identity() * weight, centre: Coordinates::zeros() })
    }

    /// The x that makes |R (x − origin) + z|² + |W (x − centre)|² least, with its columns.
    pub(crate) fn pulled(&self, pull: &Pull) -> Option<Unknowns> {
        let mut stack = SMatrix::<f64, 10, 6>::zeros();
        stack.fixed_view_mut::<5, 5>(0, 0).copy_from(&self.root);
        stack.fixed_view_mut::<5, 1>(0, 5).copy_from(&self.z);
        stack.fixed_view_mut::<5, 5>(5, 0).copy_from(&pull.root);
        stack.fixed_view_mut::<5, 1>(5, 5).copy_from(&(pull.root * (self.origin.x - pull.centre)));
        let r = stack.qr().r();
        let step = r.fixed_view::<5, 5>(0, 0).solve_upper_triangular(&-r.fixed_view::<5, 1>(0, 5))?;
        self.with_columns(self.origin.x + step)
    }

    /// The x that makes |R (x − origin) + z| least, with its columns.
    pub(crate) fn minimiser(&self) -> Option<Unknowns> {
        self.with_columns(self.origin.x + self.root.solve_upper_triangular(&-self.z)?)
    }

    /// The columns that are best for `x`.
    pub(crate) fn with_columns(&self, x: Coordinates) -> Option<Unknowns> {
        let step = DVector::from_column_slice((x - self.origin.x).as_slice());
        let moved = self.own.solve_upper_triangular(&-(&self.right + &self.shared * step))?;
        let c: Vec<f64> = self.origin.c.iter().zip(moved.iter()).map(|(c, m)| c + m).collect();
        (x.iter().chain(&c).all(|v| v.is_finite())).then_some(Unknowns { x, c })
    }

    /// The triangle R of (c, x).
    pub(crate) fn whole(&self) -> DMatrix<f64> {
        let count = self.own.nrows();
        let mut r = DMatrix::zeros(count + 5, count + 5);
        r.view_mut((0, 0), (count, count)).copy_from(&self.own);
        r.view_mut((0, count), (count, 5)).copy_from(&self.shared);
        r.view_mut((count, count), (5, 5)).copy_from(&self.root);
        r
    }

    /// r of |R (c, x) + r|² with that triangle.
    pub(crate) fn at_zero(&self) -> DVector<f64> {
        let at_origin = self.right.iter().chain(&self.z).copied();
        let origin = self.origin.c.iter().chain(&self.origin.x).copied();
        let size = self.own.nrows() + 5;
        DVector::from_iterator(size, at_origin) - self.whole() * DVector::from_iterator(size, origin)
    }

    /// A factor F of the covariance F Fᵀ of (c, x), per variance of the noise.
    pub(crate) fn joint_factor(&self) -> Option<DMatrix<f64>> {
        self.whole().try_inverse()
    }

    /// |R (x − origin) + z|² + squares at `x`, the columns at their best.
    pub(crate) fn squares_at(&self, x: &Coordinates) -> f64 {
        (self.root * (x - self.origin.x) + self.z).norm_squared() + self.squares
    }
}

/// How far each of the first `errors` columns moves x where the others are to make up for it, per its unit; the rest are as in
/// [`Stacked::new`].
pub(crate) fn responses(
    rows: &[&[f64]],
    columns: &[Column],
    errors: usize,
    deviation: f64,
) -> Option<Vec<Coordinates>> {
    let (wide, own) = (columns.len() + 6, columns.len() - errors);
    let mut triangle = Triangle::new(wide - 1);
    // the errors are the right-hand sides, in the place of the residual
    for row in triangles(rows, columns, wide).iter().flat_map(|rows| rows.chunks_exact(wide)) {
        triangle.push(row[errors..wide - 1].iter().chain(&row[..errors]).copied());
    }
    for (k, column) in columns[errors..].iter().enumerate() {
        let weight = deviation / column.prior.unwrap_or(FLAT);
        triangle.push((0..wide - 1).map(|i| if i == k { weight } else { 0.0 }));
    }
    let r = triangle.finished();
    let root = Form::from_fn(|i, k| if i <= k { r[(own + i, own + k)] } else { 0.0 });
    let moved =
        |k: usize| root.solve_upper_triangular(&Coordinates::from_fn(|i, _| r[(own + i, own + 5 + k)]));
    (0..errors).map(moved).collect()
}

/// The rows of each stretch, or their triangle where some have columns of their own: those of the others then cost nothing.
fn triangles<'a>(rows: &[&'a [f64]], columns: &[Column], width: usize) -> Vec<Cow<'a, [f64]>> {
    if rows.len() > 1 && columns.iter().any(|column| column.segment.is_some()) {
        rows.iter().map(|rows| small_triangle(rows, width).into()).collect()
    } else {
        rows.iter().map(|rows| Cow::Borrowed(*rows)).collect()
    }
}

/// Rows of `width` numbers as the rows of their triangle: the columns that are zero in all of them are left out of it.
pub(crate) fn small_triangle(rows: &[f64], width: usize) -> Vec<f64> {
    let used = (0..width).filter(|&k| rows.chunks_exact(width).any(|row| row[k] != 0.0));
    let mut small = SmallTriangle::new(width, used.collect());
    small.push(rows);
    small.finished()
}

/// The same of rows that come block by block.
pub(crate) struct SmallTriangle {
    width: usize,
    /// Columns that may have numbers, and those of them that had none so far: these change nothing in the triangle of the others.
    columns: Vec<usize>,
    zero: Vec<usize>,
    triangle: Triangle,
    count: usize,
    /// As many of the first rows as may be fewer than a triangle has.
    first: Vec<f64>,
}

impl SmallTriangle {
    /// Of rows in which all other columns are zero.
    pub(crate) fn new(width: usize, columns: Vec<usize>) -> Self {
        let (zero, triangle) = (columns.clone(), Triangle::new(columns.len()));
        SmallTriangle { width, columns, zero, triangle, count: 0, first: Vec::new() }
    }

    pub(crate) fn push(&mut self, rows: &[f64]) {
        for row in rows.chunks_exact(self.width) {
            if self.count < self.columns.len() {
                self.first.extend_from_slice(row);
            }
            self.count += 1;
            self.zero.retain(|&k| row[k] == 0.0);
            self.triangle.push(self.columns.iter().map(|&k| row[k]));
        }
    }

    pub(crate) fn finished(self) -> Vec<f64> {
        let used = self.columns.iter().copied().enumerate().filter(|(_, k)| !self.zero.contains(k));
        let used: Vec<(usize, usize)> = used.collect();
        if self.count <= used.len() {
            return self.first;
        }
        let r = self.triangle.finished();
        let mut small = vec![0.0; used.len() * self.width];
        for (i, (row, _)) in used.iter().enumerate() {
            for (column, k) in &used[i..] {
                small[i * self.width + k] = r[(*row, *column)];
            }
        }
        small
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use polhode::num::Random;

    /// Columns that are zero in all rows leave the triangle of the others as it is without them, to the last bit, wherever a block ends; rows that
    /// are fewer than a triangle has stay what they are.
    #[test]
    fn columns_of_zeros_change_nothing() {
        let (width, zero) = (7, [1, 4]);
        for count in [3, 5, 6, 7, 300, 1000] {
            let mut random = Random::new(5);
            let number = |i: usize| if zero.contains(&(i % width)) { 0.0 } else { random.normal() };
            let rows: Vec<f64> = (0..count * width).map(number).collect();
            let expected = small_triangle(&rows, width);
            assert_eq!(expected.len(), if count <= 5 { count * width } else { 5 * width });
            assert_eq!(expected == rows, count <= 5);
            for together in [1, 64, count] {
                let mut small = SmallTriangle::new(width, (0..width).filter(|k| *k != 1).collect());
                rows.chunks(together * width).for_each(|block| small.push(block));
                assert_eq!(small.finished(), expected, "{count} {together}");
            }
        }
    }
}
