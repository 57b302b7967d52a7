//! The weak equations of one stretch, linearised.

use core::ops::Range;

use crate::solve::rows::rows;
use multiversion::multiversion;
use nalgebra::{Matrix3, Vector3};
use polhode::record::both;

use crate::columns::column::{Column, Unknowns, terms_of};
use crate::physical::coordinates::{Form, basis};
use crate::signal::banded::Banded;
use crate::signal::covariance::{Covariance, Levels, Whites};
use crate::signal::moments::groups;
use crate::signal::stretch::Stretch;
use crate::signal::terms::{Terms, cross_derivative, slope};
use crate::signal::test_functions::{Blocks, Seen, TestFunctions};
use crate::solve::blocks::{TOGETHER, whitened};
use crate::solve::driven::Driven;
use crate::thresholds::radius::LONG;
use crate::thresholds::rounds::BESIDE;

/// The weak equations of one stretch, linearised at samples `rates` − `noise`, a tensor and values of the columns.
///
/// Rows hold the derivatives with respect to the columns, to the coordinates of the tensor, and the residual.
pub(crate) struct Linearised {
    pub(crate) tests: TestFunctions,
    /// Numbers in a row.
    pub(crate) width: usize,
    /// Row by row, not whitened.
    pub(crate) rows: Vec<f64>,
    /// What the unknowns make of torque and sensor.
    pub(crate) terms: Terms,
    /// Where it was linearised.
    pub(crate) origin: Unknowns,
}

/// Equations that are whitened by the covariance of their noise.
pub(crate) struct Whitened {
    factor: Banded,
    pub(crate) levels: Levels,
    pub(crate) width: usize,
    pub(crate) rows: Vec<f64>,
}

impl Linearised {
    pub(crate) fn new(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        columns: &[Column],
        origin: Unknowns,
        tests: TestFunctions,
    ) -> Self {
        let terms = terms_of(columns, &origin, stretch);
        let rows = rows(stretch, noise, columns, &origin, &tests);
        Linearised { tests, width: columns.len() + 6, rows, terms, origin }
    }

    /// The same with the covariance of the equations.
    pub(crate) fn with_covariance(
        stretch: &Stretch,
        noise: &[Vector3<f64>],
        columns: &[Column],
        origin: Unknowns,
        tests: TestFunctions,
    ) -> (Self, Covariance) {
        let terms = terms_of(columns, &origin, stretch);
        // of a long stretch each is made by halves, and what the first is made of is gone when the other needs its room
        let (rows, covariance) = both(
            (BESIDE + 1..=LONG).contains(&noise.len()),
            || rows(stretch, noise, columns, &origin, &tests),
            || Covariance::new(stretch, noise, &terms, &tests),
        );
        (Linearised { tests, width: columns.len() + 6, rows, terms, origin }, covariance)
    }

    /// The covariance of the equations, which were linearised at the samples of `stretch` less their `noise`.
    pub(crate) fn covariance(&self, stretch: &Stretch, noise: &[Vector3<f64>]) -> Covariance {
        Covariance::new(stretch, noise, &self.terms, &self.tests)
    }

    /// The equations whitened by the factor of the covariance of their residuals at `levels`; with `driven` columns the
    /// effect of torque noise is taken out of their derivatives.
    pub(crate) fn whitened(&self, factor: Banded, levels: Levels, driven: Option<&[Column]>) -> Whitened {
        self.whiten(self.rows.clone(), factor, levels, driven)
    }

    /// The same in the place of its rows, which nobody asks for any more.
    pub(crate) fn take_whitened(
        &mut self,
        factor: Banded,
        levels: Levels,
        driven: Option<&[Column]>,
    ) -> Whitened {
        let rows = core::mem::take(&mut self.rows);
        self.whiten(rows, factor, levels, driven)
    }

    /// Its rows whitened by the noise of the rates alone; of the covariance nothing is kept.
    pub(crate) fn whitened_by_rates(&self, stretch: &Stretch, noise: &[Vector3<f64>]) -> Option<Vec<f64>> {
        let whites = Whites::new(stretch, noise, &self.terms, &self.tests, 1.0);
        let own = |tests: Range<usize>| {
            let rows = &self.rows[3 * tests.start * self.width..3 * tests.end * self.width];
            (whites.of(tests), rows.to_vec())
        };
        let mut all = Vec::with_capacity(self.rows.len());
        let take = |rows: &[f64]| all.extend_from_slice(rows);
        whitened(self.tests.count, TOGETHER, false, own, take)?;
        Some(all)
    }

    fn whiten(
        &self,
        mut rows: Vec<f64>,
        factor: Banded,
        levels: Levels,
        driven: Option<&[Column]>,
    ) -> Whitened {
        if let Some(columns) = driven {
            let residuals = || last_column(&rows, self.width);
            let driven = Driven::new(residuals, columns, &self.terms.j, &factor, levels, &self.tests);
            driven.iter().for_each(|driven| driven.take_out(&mut rows, 0));
        }
        factor.forward(&mut rows, self.width);
        Whitened { factor, levels, width: self.width, rows }
    }

    /// Residuals at other unknowns, not whitened.
    pub(crate) fn residuals(&self, at: &Unknowns) -> Vec<f64> {
        residuals(&self.rows, self.width, &self.origin, at)
    }

    /// V of this stretch, at the samples that the equations were linearised at.
    pub(crate) fn inflation(&self, whitened: &Whitened, stretch: &Stretch, noise: &[Vector3<f64>]) -> Form {
        let inverse = whitened.factor.inverse_band();
        let mut blocks = Blocks::of(&inverse);
        let bases: [Matrix3<f64>; 5] = core::array::from_fn(basis);
        let mut sum = Form::zeros();
        for group in groups(stretch, noise, self.tests.radius) {
            let seen = Seen::new(&self.tests, group.time);
            let [aa, ba, bb] = blocks.sums(&seen);
            let ab = ba.transpose();
            let w = self.terms.rate(&group.reading);
            let drag = Matrix3::identity() * self.terms.drag + slope(&w) * self.terms.quadratic;
            let k = bases.map(|b| cross_derivative(&b, &w) + b * drag);
            // Σ tr D_kᵀ Z D_l with D_k = −φ' B_k + φ K_k
            for l in 0..5 {
                let from_slope = aa * bases[l] - ab * k[l];
                let from_value = bb * k[l] - ba * bases[l];
                for m in 0..=l {
                    // tr(M Nᵀ) is the entry by entry product
                    sum[(l, m)] += group.square * (from_slope.dot(&bases[m]) + from_value.dot(&k[m]));
                }
            }
        }
        sum.fill_upper_triangle_with_lower_triangle();
        sum * whitened.levels.white
    }
}

impl Whitened {
    /// log |C| less that of another factor; infinite where there is none.
    pub(crate) fn log_determinant_over(&self, other: Option<&Banded>) -> f64 {
        other.map_or(f64::INFINITY, |other| self.factor.log_determinant() - other.log_determinant())
    }

    /// Whitened residuals at `at`.
    pub(crate) fn residuals(&self, origin: &Unknowns, at: &Unknowns) -> Vec<f64> {
        residuals(&self.rows, self.width, origin, at)
    }

    /// Moves `noise` by a share of the way to n̂ = Aᵀ C⁻¹ r, which carries the samples onto the weak equations at `at`.
    pub(crate) fn carry(
        &self,
        part: &Linearised,
        stretch: &Stretch,
        noise: &mut [Vector3<f64>],
        at: &Unknowns,
        share: f64,
    ) {
        let by_axis = {
            let mut multipliers = self.residuals(&part.origin, at);
            self.factor.backward(&mut multipliers);
            [0, 1, 2].map(|axis| {
                let mut own = part.tests.room();
                let each = multipliers.iter().skip(axis).step_by(3);
                own.iter_mut().zip(each).for_each(|(own, l)| *own = *l);
                own
            })
        };
        // the halves of a long stretch side by side, whatever the machine is
        let long = noise.len() > LONG;
        let (before, after) = noise.split_at_mut(if long { noise.len() / 2 } else { 0 });
        let (middle, new, kept) = (before.len(), self.levels.white * share, 1.0 - share);
        both(
            long,
            || carry(part, stretch, before, 0, &by_axis, new, kept),
            || carry(part, stretch, after, middle, &by_axis, new, kept),
        );
    }
}

/// The noise of the samples from `first` on times `kept`, and w Aᵀ λ times `share`, λ being the multipliers about each axis.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl+fma", "x86_64+avx2+fma"))]
fn carry(
    part: &Linearised,
    stretch: &Stretch,
    noise: &mut [Vector3<f64>],
    first: usize,
    multipliers: &[Vec<f64>; 3],
    share: f64,
    kept: f64,
) {
    let terms = &part.terms;
    for (k, n) in noise.iter_mut().enumerate() {
        let i = first + k;
        let seen = Seen::new(&part.tests, stretch.times[i]);
        // no closure: one would not be compiled for wide registers
        let (x, y, z) = (seen.dot(&multipliers[0]), seen.dot(&multipliers[1]), seen.dot(&multipliers[2]));
        let (slopes, values) = (Vector3::new(x.0, y.0, z.0), Vector3::new(x.1, y.1, z.1));
        let w = terms.rate(&(stretch.rates[i] - *n));
        // Kᵀ of the values
        let mut own = terms.j * (values.cross(&w) - slopes) - values.cross(&(terms.j * w))
            + terms.viscous.tr_mul(&values);
        if let Some(inputs) = &stretch.inputs {
            own -= values.cross(&terms.wheel(&inputs.wheel[i]));
        }
        if terms.quadratic != 0.0 {
            own += slope(&w) * (terms.j * values) * terms.quadratic;
        }
        *n = *n * kept + own * (stretch.weights[i] * share);
    }
}

/// The residuals where the rows were linearised.
pub(crate) fn last_column(rows: &[f64], width: usize) -> Vec<f64> {
    rows.chunks_exact(width).map(|row| row[width - 1]).collect()
}

pub(crate) fn residuals(rows: &[f64], width: usize, origin: &Unknowns, at: &Unknowns) -> Vec<f64> {
    let columns = origin.c.len();
    let mut step: Vec<f64> = at.c.iter().zip(&origin.c).map(|(a, b)| a - b).collect();
    step.extend((at.x - origin.x).iter());
    rows.chunks_exact(width)
        .map(|row| row[columns + 5] + row.iter().zip(&step).map(|(g, s)| g * s).sum::<f64>())
        .collect()
}
