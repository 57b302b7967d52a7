//! Taylor series of the heavy ball and of the changes of its motion.

use nalgebra::SMatrix;

use super::symmetry::Three;
use crate::rotation::Vec3;

/// Terms of a series beyond the first.
const ORDER: usize = 24;

/// δθ and δω by δθ, δω at the start and δg.
pub(super) type Response = SMatrix<f64, 6, 7>;

/// Columns of a response side by side, the last one empty.
type Row = [f64; 8];

/// The ball at one time with its response to changes of the start.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Γ.
    pub(super) up: Vec3<f64>,
    /// 1 − Γ₃.
    pub(super) below: f64,
    pub(super) omega: Vec3<f64>,
    pub(super) response: Response,
    /// Coefficients of what was split off from the response, along the flows of [`Symmetry`](super::symmetry::Symmetry).
    pub(super) along: Three,
}

impl Node {
    /// A time `h` later, for the constant `g`.
    pub(super) fn after(&self, h: f64, g: f64) -> Node {
        let spin = self.omega[2];
        let ([mut up_1, mut up_2, mut up_3], [mut o_1, mut o_2]) =
            ([[0.0; ORDER + 1]; 3], [[0.0; ORDER + 1]; 2]);
        (up_1[0], up_2[0], up_3[0]) = (self.up[0], self.up[1], self.up[2]);
        (o_1[0], o_2[0]) = (self.omega[0], self.omega[1]);
        let mut turn = [[[0.0; 8]; 3]; ORDER + 1];
        let mut rate = [[[0.0; 8]; 2]; ORDER + 1];
        let axial = self.row(5);
        turn[0] = [0, 1, 2].map(|k| self.row(k));
        rate[0] = [3, 4].map(|k| self.row(k));
        for n in 0..ORDER {
            let mut product = [0.0; 3]; // of Γ × ω, but for ω₃
            // ω × δθ but for ω₃, and the first two components of Γ × δθ
            let (mut moved, mut tilted) = ([[0.0; 8]; 3], [[0.0; 8]; 2]);
            for k in 0..=n {
                let (o1, o2) = (o_1[k], o_2[k]);
                let (g1, g2, g3) = (up_1[k], up_2[k], up_3[k]);
                product[0] -= o2 * up_3[n - k];
                product[1] += o1 * up_3[n - k];
                product[2] += o2 * up_1[n - k] - o1 * up_2[n - k];
                let [t1, t2, t3] = &turn[n - k];
                for j in 0..8 {
                    moved[0][j] += o2 * t3[j];
                    moved[1][j] -= o1 * t3[j];
                    moved[2][j] += o1 * t2[j] - o2 * t1[j];
                    tilted[0][j] += g2 * t3[j] - g3 * t2[j];
                    tilted[1][j] += g3 * t1[j] - g1 * t3[j];
                }
            }
            let divisor = 1.0 / (n + 1) as f64;
            up_1[n + 1] = (up_2[n] * spin + product[0]) * divisor;
            up_2[n + 1] = (product[1] - up_1[n] * spin) * divisor;
            up_3[n + 1] = product[2] * divisor;
            o_1[n + 1] = g * up_2[n] * divisor;
            o_2[n + 1] = -g * up_1[n] * divisor;
            for j in 0..8 {
                let axial = if n == 0 { axial[j] } else { 0.0 };
                let [t1, t2, _] = turn[n];
                turn[n + 1][0][j] = (rate[n][0][j] - (moved[0][j] - spin * t2[j])) * divisor;
                turn[n + 1][1][j] = (rate[n][1][j] - (moved[1][j] + spin * t1[j])) * divisor;
                turn[n + 1][2][j] = (axial - moved[2][j]) * divisor;
                rate[n + 1][0][j] = g * tilted[1][j] * divisor;
                rate[n + 1][1][j] = -g * tilted[0][j] * divisor;
            }
            rate[n + 1][0][6] += up_2[n] * divisor;
            rate[n + 1][1][6] -= up_1[n] * divisor;
        }
        let sum = |terms: &dyn Fn(usize) -> Row| {
            (0..ORDER).rev().fold(terms(ORDER), |sum, n| {
                let term = terms(n);
                core::array::from_fn(|j| sum[j] * h + term[j])
            })
        };
        let rows: [Row; 6] = [
            sum(&|n| turn[n][0]),
            sum(&|n| turn[n][1]),
            sum(&|n| turn[n][2]),
            sum(&|n| rate[n][0]),
            sum(&|n| rate[n][1]),
            axial,
        ];
        let risen = up_3[1..].iter().rev().fold(0.0, |sum, term| sum * h + term) * h;
        let value = |terms: [f64; ORDER + 1]| terms.iter().rev().fold(0.0, |sum, term| sum * h + term);
        Node {
            up: Vec3([value(up_1), value(up_2), up_3[0] + risen]),
            below: self.below - risen,
            omega: Vec3([value(o_1), value(o_2), spin]),
            response: Response::from_fn(|row, column| rows[row][column]),
            along: self.along,
        }
    }

    fn row(&self, k: usize) -> Row {
        core::array::from_fn(|j| if j < 7 { self.response[(k, j)] } else { 0.0 })
    }
}
