//! Rows of all stretches stacked into one triangle.

use faer::Mat;
use nalgebra::SMatrix;

use super::linearised::Linearised;
use crate::fit::physical::coordinates::{Coordinates, Form};

/// min |R (x − origin) + z|²: what all stretches say together.
pub(crate) struct Stacked {
    origin: Coordinates,
    /// Upper triangular, Rᵀ R = H.
    pub(crate) root: Form,
    z: Coordinates,
    /// Sum of squares of the whitened residuals that no x removes.
    pub(crate) squares: f64,
    /// Equations.
    pub(crate) rows: usize,
}

impl Stacked {
    /// The triangle of all whitened rows, without forming their squares.
    pub(crate) fn new(stretches: &[Linearised]) -> Stacked {
        let rows: Vec<[f64; 6]> = stretches.iter().flat_map(|s| s.rows.iter().copied()).collect();
        Stacked::triangle(&rows, stretches.first().map_or(Coordinates::zeros(), |s| s.origin))
    }

    pub(crate) fn triangle(rows: &[[f64; 6]], origin: Coordinates) -> Stacked {
        let stack = Mat::from_fn(rows.len().max(6), 6, |i, k| rows.get(i).map_or(0.0, |row| row[k]));
        let qr = stack.qr();
        let r = qr.thin_R();
        Stacked {
            origin,
            root: Form::from_fn(|i, k| if i <= k { r[(i, k)] } else { 0.0 }),
            z: Coordinates::from_fn(|i, _| r[(i, 5)]),
            squares: r[(5, 5)] * r[(5, 5)],
            rows: rows.len(),
        }
    }

    /// Mean square of what is left over that of the noise, where it is more than 1.
    pub(crate) fn excess(&self, variance: f64) -> f64 {
        (self.squares / variance / self.rows.saturating_sub(5).max(1) as f64).max(1.0)
    }

    pub(crate) fn information(&self) -> Form {
        self.root.transpose() * self.root
    }

    /// The x that makes |R (x − origin) + z|² + ridge |x|² least.
    pub(crate) fn ridge(&self, ridge: f64) -> Option<Coordinates> {
        // far above the rounding of R, where the record tells nothing and has no noise either; only weights are at stake
        let weight = ridge.sqrt().max(1e-7 * self.root.norm());
        let mut stack = SMatrix::<f64, 10, 6>::zeros();
        stack.fixed_view_mut::<5, 5>(0, 0).copy_from(&self.root);
        stack.fixed_view_mut::<5, 1>(0, 5).copy_from(&self.z);
        stack.fixed_view_mut::<5, 5>(5, 0).copy_from(&(Form::identity() * weight));
        stack.fixed_view_mut::<5, 1>(5, 5).copy_from(&(self.origin * weight));
        let r = stack.qr().r();
        let step = r.fixed_view::<5, 5>(0, 0).solve_upper_triangular(&-r.fixed_view::<5, 1>(0, 5))?;
        Some(self.origin + step)
    }

    /// The x that makes |R (x − origin) + z| least.
    pub(crate) fn minimiser(&self) -> Option<Coordinates> {
        Some(self.origin + self.root.solve_upper_triangular(&-self.z)?)
    }
}
