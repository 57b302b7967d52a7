//! The variational equations of the free body by Taylor series: what one integrates who has no closed form.
//!
//! `m' = m × ω`, `q' = ½ q ∘ ω`, and for each of nine columns `x' = x × ω + m × y`, `θ' = θ × ω + y`, where ω = I⁻¹m and
//! `y = I⁻¹(x − δI ω)`: every right side is quadratic, so that the series follow from Cauchy products.

use nalgebra::{SMatrix, SVector, UnitQuaternion, Vector3};

/// Terms of a series; a step leaves the last two below the tolerance.
const ORDER: usize = 24;
const TOLERANCE: f64 = 1e-17;

/// Entries of the tensor in the order of the columns.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

type Series = [f64; ORDER + 1];
type Series3 = [Series; 3];

/// Momentum, attitude, and the derivative of (rotation vector in the body, momentum) by the momentum and the tensor.
#[derive(Clone, Debug)]
pub(super) struct Variational {
    inverse: [f64; 3],
    /// m, q, then momentum and rotation of each column.
    state: [[f64; 3]; 20],
    q: [f64; 4],
}

impl Variational {
    /// From the momentum at t = 0 of a body with principal moments.
    pub(super) fn new(moments: [f64; 3], momentum: [f64; 3]) -> Self {
        let mut state = [[0.0; 3]; 20];
        state[0] = momentum;
        for k in 0..3 {
            state[1 + k][k] = 1.0;
        }
        Variational { inverse: moments.map(|i| 1.0 / i), state, q: [1.0, 0.0, 0.0, 0.0] }
    }

    /// Goes on to the time `t` after the start; gives the steps taken.
    pub(super) fn advance(&mut self, t: f64) -> u64 {
        let (mut now, mut steps) = (0.0_f64, 0);
        while now != t {
            let (series, q) = self.series();
            let largest = |n: usize| {
                let state = series
                    .iter()
                    .flatten()
                    .map(|s| (s[n] / s.iter().fold(1.0, |a: f64, b| a.max(b.abs()))).abs());
                state.chain(q.iter().map(|s| s[n].abs())).fold(0.0, f64::max)
            };
            let step = |n: usize| libm::pow(TOLERANCE / largest(n), 1.0 / n as f64);
            let h = step(ORDER).min(step(ORDER - 1)).min((t - now).abs()) * (t - now).signum();
            let h = if (t - now - h).abs() < 1e-12 * t.abs() { t - now } else { h };
            let value = |s: &Series| s.iter().rev().fold(0.0, |sum, c| sum * h + c);
            for (x, s) in self.state.iter_mut().zip(&series) {
                *x = [value(&s[0]), value(&s[1]), value(&s[2])];
            }
            self.q = [value(&q[0]), value(&q[1]), value(&q[2]), value(&q[3])];
            now = if (t - now - h).abs() < 1e-12 * t.abs() { t } else { now + h };
            steps += 1;
        }
        steps
    }

    /// The derivative with rotation vectors in space.
    pub(super) fn columns(&self) -> SMatrix<f64, 6, 9> {
        let [w, x, y, z] = self.q;
        let attitude = UnitQuaternion::new_normalize(nalgebra::Quaternion::new(w, x, y, z));
        let mut columns = SMatrix::<f64, 6, 9>::zeros();
        for n in 0..9 {
            let turn: Vector3<f64> = attitude * Vector3::from(self.state[10 + n]);
            columns.fixed_view_mut::<3, 1>(0, n).copy_from(&turn);
            columns.fixed_view_mut::<3, 1>(3, n).copy_from(&Vector3::from(self.state[1 + n]));
        }
        columns
    }

    fn series(&self) -> (Vec<Series3>, [Series; 4]) {
        let mut s = vec![[[0.0; ORDER + 1]; 3]; 20];
        for (series, x) in s.iter_mut().zip(&self.state) {
            for k in 0..3 {
                series[k][0] = x[k];
            }
        }
        let mut q = [[0.0; ORDER + 1]; 4];
        for (series, x) in q.iter_mut().zip(&self.q) {
            series[0] = *x;
        }
        let mut omega: Series3 = [[0.0; ORDER + 1]; 3];
        let mut rates = [[[0.0; ORDER + 1]; 3]; 9];
        for n in 0..ORDER {
            for k in 0..3 {
                omega[k][n] = s[0][k][n] * self.inverse[k];
            }
            for (column, rate) in rates.iter_mut().enumerate() {
                let mut x = [s[1 + column][0][n], s[1 + column][1][n], s[1 + column][2][n]];
                if column >= 3 {
                    let (i, j) = ENTRIES[column - 3];
                    x[i] -= omega[j][n];
                    if i != j {
                        x[j] -= omega[i][n];
                    }
                }
                for k in 0..3 {
                    rate[k][n] = x[k] * self.inverse[k];
                }
            }
            let next = 1.0 / (n + 1) as f64;
            let turned = cross(&s[0], &omega, n);
            for k in 0..3 {
                s[0][k][n + 1] = turned[k] * next;
            }
            for column in 0..9 {
                let (change, gyroscopic) =
                    (cross(&s[1 + column], &omega, n), cross(&s[0], &rates[column], n));
                let turn = cross(&s[10 + column], &omega, n);
                for k in 0..3 {
                    s[1 + column][k][n + 1] = (change[k] + gyroscopic[k]) * next;
                    s[10 + column][k][n + 1] = (turn[k] + rates[column][k][n]) * next;
                }
            }
            let [w, x, y, z] = &q;
            let by = |a: &Series, k: usize| product(a, &omega[k], n);
            let rate = [
                -by(x, 0) - by(y, 1) - by(z, 2),
                by(w, 0) + by(y, 2) - by(z, 1),
                by(w, 1) + by(z, 0) - by(x, 2),
                by(w, 2) + by(x, 1) - by(y, 0),
            ];
            for k in 0..4 {
                q[k][n + 1] = 0.5 * rate[k] * next;
            }
        }
        (s, q)
    }
}

/// Coefficient `n` of the product of two series.
fn product(a: &Series, b: &Series, n: usize) -> f64 {
    (0..=n).map(|k| a[k] * b[n - k]).sum()
}

/// Coefficient `n` of the vector product.
fn cross(a: &Series3, b: &Series3, n: usize) -> [f64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(j, k)| product(&a[j], &b[k], n) - product(&a[k], &b[j], n))
}

/// Largest difference of two sets of columns over the largest entry of the second, momenta in units of `norm` and tensors in units
/// of `moment`.
pub(super) fn relative_error(
    found: &SMatrix<f64, 6, 9>,
    exact: &SMatrix<f64, 6, 9>,
    norm: f64,
    moment: f64,
) -> f64 {
    let rows = SVector::<f64, 6>::from_fn(|k, _| if k < 3 { 1.0 } else { 1.0 / norm });
    let columns = SVector::<f64, 9>::from_fn(|k, _| if k < 3 { norm } else { moment });
    let unit = rows * columns.transpose();
    (found - exact).component_mul(&unit).amax() / exact.component_mul(&unit).amax()
}
