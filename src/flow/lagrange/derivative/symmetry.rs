//! The constants of the motion of the heavy ball: what they say of changes of the motion.
//!
//! Each constant has a flow, along which a change stays what it is, and a gradient, whose value of a change stays too. They are taken of m₃,
//! of the energy less ω₃m₃ and of m·Γ − m₃ (over A): next to the upright axis, where changes grow, those of the last two are small without a
//! difference, and so have all their digits.

use nalgebra::{RowSVector, SMatrix, SVector};

use super::ball::Ball;
use super::curve::Curve;
use super::step::Response;
use crate::rotation::Vec3;

/// Size from which a response is split.
const LARGE: f64 = 32.0;
/// Least part of a flow or gradient that is independent of those before.
const INDEPENDENT: f64 = 0.05;

pub(super) type Three = SMatrix<f64, 3, 7>;

/// Flows and gradients at one point of the motion.
#[derive(Clone, Debug)]
pub(super) struct Symmetry {
    /// δθ and δω, one column each.
    pub(super) flows: SMatrix<f64, 6, 3>,
    /// By δθ, δω and δg, one row each.
    gradients: Three,
}

impl Symmetry {
    /// Of the `ball`.
    pub(super) fn of(ball: &Ball, &Curve { g, a, .. }: &Curve) -> Self {
        let (up, [_, below]) = (ball.up(), ball.tilt());
        let ([g1, g2], [o1, o2]) = ([up.re, up.im], [ball.zeta.re, ball.zeta.im]);
        let tilt = [g1, g2, -below];
        let flows = SMatrix::from_columns(&[
            [0.0, 0.0, 1.0, o2, -o1, 0.0].into(),
            [o1, o2, 0.0, g * g2 - a * o2, a * o1 - g * g1, 0.0].into(),
            [tilt[0], tilt[1], tilt[2], -o2, o1, 0.0].into(),
        ]);
        let Vec3(turned) = Vec3([o1, o2, a]).cross(Vec3([g1, g2, 1.0 - below]));
        let gradients = Three::from_rows(&[
            [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0].into(),
            [-g * g2, g * g1, 0.0, o1, o2, 0.0, -below].into(),
            [turned[0], turned[1], turned[2], tilt[0], tilt[1], tilt[2], 0.0].into(),
        ]);
        Symmetry { flows, gradients }
    }

    /// Splits off what is along the flows of the last two constants, once the response is large; gives its coefficients.
    pub(super) fn split(&self, response: &mut Response) -> Three {
        let mut found = Three::zeros();
        if response.norm_squared() < LARGE * LARGE {
            return found;
        }
        // the turn about e₃ is left to the response: the flow of m₃ is that and never small
        let across = |mut column: SVector<f64, 6>| {
            (column[2], column[5]) = (0.0, 0.0);
            column
        };
        let both = [1, 2].map(|k| across(self.flows.column(k).into_owned()));
        // squares of what is small leave the range of a double
        let size = both[0].amax().max(both[1].amax());
        let [second, third] = both.map(|flow| flow / size);
        let common = second.dot(&third) / second.norm_squared();
        let rest = third - second * common;
        // no number where the second vanishes
        let is_independent = rest.norm() > INDEPENDENT * third.norm();
        if !is_independent {
            return found;
        }
        let along_third = rest.transpose() * *response / rest.norm_squared();
        let along_second = second.transpose() * *response / second.norm_squared() - along_third * common;
        found.set_row(1, &(along_second / size));
        found.set_row(2, &(along_third / size));
        *response -= self.flows * found;
        found
    }

    /// Gives the constants in a `response` the values that they had at the `start`.
    pub(super) fn hold(&self, start: &Symmetry, response: &mut Response) {
        let mut off = self.gradients.fixed_columns::<6>(0) * *response - start.gradients;
        let mut by_weight = off.column_mut(6);
        by_weight += self.gradients.column(6);
        let (mut units, mut parts) = (SMatrix::<f64, 6, 3>::zeros(), Three::zeros());
        for k in 0..3 {
            let gradient: SVector<f64, 6> = self.gradients.fixed_view::<1, 6>(k, 0).transpose();
            let largest = gradient.amax();
            let gradient = gradient / largest;
            let along = units.transpose() * gradient;
            let rest = gradient - units * along;
            let size = rest.norm();
            if size.is_nan() || size < INDEPENDENT * gradient.norm() {
                continue;
            }
            let part: RowSVector<f64, 7> = (off.row(k) / largest - along.transpose() * parts) / size;
            units.set_column(k, &(rest / size));
            parts.set_row(k, &part);
        }
        *response -= units * parts;
    }

    /// What combination of the flows a change over a whole period is, with the coefficients `along` of what was split off, and without the
    /// rounding by which they depend on anything but the constants.
    pub(super) fn combination(&self, change: &Response, along: &Three) -> Three {
        let (mut units, mut triangle) = (SMatrix::<f64, 6, 3>::zeros(), SMatrix::<f64, 3, 3>::identity());
        for k in 0..3 {
            let flow = self.flows.column(k).into_owned();
            let mut rest: SVector<f64, 6> = flow;
            for _ in 0..2 {
                let along = units.transpose() * rest;
                rest -= units * along;
                let mut entries = triangle.column_mut(k);
                entries += along;
            }
            let size = rest.norm();
            if size > 16.0 * f64::EPSILON * flow.norm() {
                units.set_column(k, &(rest / size));
                triangle[(k, k)] = size;
            }
        }
        let parts = units.transpose() * change;
        let mut found = Three::zeros();
        for k in (0..3).rev() {
            let mut row = parts.row(k).into_owned();
            for j in k + 1..3 {
                row -= found.row(j) * triangle[(k, j)];
            }
            found.set_row(k, &(row / triangle[(k, k)]));
        }
        found += along;
        let by_start = found.fixed_columns::<6>(0) * onto(self.gradients.fixed_columns::<6>(0).transpose());
        found.fixed_columns_mut::<6>(0).copy_from(&by_start);
        found
    }
}

/// The projection onto the span of three vectors, which may be linearly dependent.
fn onto(vectors: SMatrix<f64, 6, 3>) -> SMatrix<f64, 6, 6> {
    let mut projection = SMatrix::zeros();
    for vector in vectors.column_iter() {
        let mut rest: SVector<f64, 6> = vector.into_owned();
        for _ in 0..2 {
            rest -= projection * rest;
        }
        // what is smaller is rounding
        if rest.norm() > 16.0 * f64::EPSILON * vector.norm() {
            let unit = rest.normalize();
            projection += unit * unit.transpose();
        }
    }
    projection
}
