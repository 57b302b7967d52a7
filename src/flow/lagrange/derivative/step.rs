//! The response of the ball in closed form, over less than half a nutation.

use nalgebra::SMatrix;

use super::Row;
use super::ball::{Ball, Functions, Moving, times_i};
use super::curve::{Change, Changes, Cubic, Curve};
use super::elapsed::Values;
use super::symmetry::Three;
use crate::num::complex::Complex;

/// δθ and δω by δθ, δω at the start and δg.
pub(super) type Response = SMatrix<f64, 6, 7>;

/// The ball at one time with its response to changes of the start.
#[derive(Clone, Debug)]
pub(super) struct Node {
    functions: Functions,
    /// Real and imaginary part of f and of f'.
    by: [[Row; 4]; 3],
    changes: Changes,
    axial: Row,
    above: f64,
    slope: f64,
    /// Coefficients of what was split off from the response, along the flows of [`Symmetry`](super::symmetry::Symmetry).
    pub(super) along: Three,
}

impl Node {
    pub(super) fn new(curve: &Curve, ball: &Ball, response: &Response, along: Three) -> Self {
        let zero = [0.0; 8];
        let mut node = Node {
            functions: ball.functions(curve.a, curve.g),
            by: [[zero; 4]; 3],
            changes: Changes {
                p: zero,
                rest: zero,
                point: zero,
                slope: zero,
                last: [zero; 3],
                logarithms: [[zero; 3]; 3],
            },
            axial: zero,
            above: curve.above(ball),
            slope: curve.slope(ball),
            along,
        };
        let Ball { alpha, beta, zeta } = *ball;
        let (up, [x, y]) = (ball.up(), ball.tilt());
        for (n, column) in response.column_iter().enumerate() {
            let (across, turn) = (Complex::new(column[0], column[1]), column[2]);
            let d_up = times_i(across.scaled(0.5 * (x - y)) - up.scaled(turn));
            let (d_zeta, da, dg) =
                (Complex::new(column[3], column[4]), column[5], if n == 6 { 1.0 } else { 0.0 });
            let d_alpha = (times_i(alpha.scaled(turn)) - beta * across.conjugate()).scaled(0.5);
            let d_beta = (alpha * across - times_i(beta.scaled(turn))).scaled(0.5);
            let (a, g) = (curve.a, curve.g);
            let alpha_rate = times_i(alpha.scaled(da) + d_alpha.scaled(a))
                - (d_beta * zeta.conjugate() + beta * d_zeta.conjugate());
            let beta_rate = d_alpha * zeta + alpha * d_zeta - times_i(beta.scaled(da) + d_beta.scaled(a));
            let zeta_rate =
                times_i((zeta.scaled(da) + d_zeta.scaled(a)).scaled(0.5) - (up.scaled(dg) + d_up.scaled(g)));
            let all =
                [(d_alpha, alpha_rate.scaled(0.5)), (d_beta, beta_rate.scaled(0.5)), (d_zeta, zeta_rate)];
            for (by, (value, rate)) in node.by.iter_mut().zip(all) {
                for (row, x) in by.iter_mut().zip([value.re, value.im, rate.re, rate.im]) {
                    row[n] = x;
                }
            }
            node.axial[n] = da;
            curve.change(
                ball,
                &Change { across, zeta: d_zeta, a: da, g: dg, up: d_up },
                n,
                &mut node.changes,
            );
        }
        node
    }

    /// A time `h` later, where the ball is at `end`.
    pub(super) fn after(&self, curve: &Curve, h: f64, end: &Ball) -> Response {
        let Curve { p, q, .. } = *curve;
        let Values { s, c, d, t, v } = curve.elapsed.at(h);
        let (s2, c2, d2) = (s * s, c * c, d * d);
        let s3 = s2 * s;
        let (m3, slope) = (self.above, self.slope);
        let r = c2 + m3 * s2;
        let (cd, by_r) = (c * d, 1.0 / r);
        let k = (cd + slope * s3) * by_r;
        let k_rate = by_r * (3.0 * slope * s2 * cd - s * (p * d2 + q * c2) - 2.0 * (m3 - p) * s * cd * k);

        // changes of s, of c² and of k
        let changes = &self.changes;
        let (mut ds, mut dc2, mut dk) = ([0.0; 8], [0.0; 8], [0.0; 8]);
        let (half_d, s2_by_d) = (0.5 / d, s2 / d);
        for n in 0..8 {
            let (dp, rest) = (changes.p[n], changes.rest[n]);
            let grown = t * dp + v * rest;
            let by_s = 0.5 * (cd * grown - s3 * dp);
            let by_c = -0.5 * (c * s2 * dp + p * s * d * grown);
            let by_d = s2 * half_d * rest - 0.5 * (d * s2 * dp + q * s * c * grown);
            let by_c2 = 2.0 * c * by_c;
            let dr = by_c2 + s2 * changes.point[n] + 2.0 * m3 * s * by_s;
            let numerator = d * by_c + c * by_d + s3 * changes.slope[n] + 3.0 * slope * s2 * by_s;
            (ds[n], dc2[n], dk[n]) = (by_s, by_c2, (numerator - k * dr) * by_r);
        }

        let ends = end.functions(curve.a, curve.g);
        let phase = |function: usize| {
            let Cubic { root, zeros: [m1, _, m3] } = curve.about[function];
            let (from, to) = (self.functions[function], ends[function]);
            // n e^{−iψ} f and f'; f and f' together are clear of zero
            let by_n2 = 1.0 / (c2 + m3 * s2);
            let value = from.value.scaled(k) + from.rate.scaled(s);
            let logarithmic = Complex::new(-(m1 * s * cd * by_n2), root * s2 * by_n2);
            let rate = from.value.scaled(k_rate) + from.rate.scaled(cd) + value * logarithmic;
            unit(to.value * value.conjugate() + (to.rate * rate.conjugate()).scaled(1.0 / p))
        };
        let [of_alpha, of_beta] = [phase(0), phase(1)];
        // of ω₁ + iω₂, which may be too small to tell it
        let line = unit(Complex::new(cd, s * (0.5 * curve.a - curve.line * s2)));
        let of_zeta = of_beta * (of_alpha * line).conjugate();
        let mut found = [[[0.0; 8]; 2]; 3];
        for (function, (found, phase)) in found.iter_mut().zip([of_alpha, of_beta, of_zeta]).enumerate() {
            let Cubic { zeros: [_, _, m3], .. } = curve.about[function];
            let Moving { value: from, rate: from_rate } = self.functions[function];
            let value = ends[function].value;
            let by_n2 = 1.0 / (c2 + m3 * s2);
            let factor = phase.scaled(by_n2.sqrt());
            let [value_re, value_im, rate_re, rate_im] = &self.by[function];
            let [first, second, third] = &changes.logarithms[function];
            let last = &changes.last[function];
            // ζ turns by −a/2 beside its function
            let turn = if function == 2 { -0.5 * h } else { 0.0 };
            for n in 0..8 {
                let phase_by = by_n2
                    * (t * (first[n] - c2 * third[n])
                        + v * (d2 * second[n] - c2 * third[n])
                        + c * s * s2_by_d * third[n])
                    + turn * self.axial[n];
                let size_by = -0.5 * by_n2 * (dc2[n] + s2 * last[n] + 2.0 * m3 * s * ds[n]);
                let re = value_re[n] * k + rate_re[n] * s + from.re * dk[n] + from_rate.re * ds[n];
                let im = value_im[n] * k + rate_im[n] * s + from.im * dk[n] + from_rate.im * ds[n];
                found[0][n] = factor.re * re - factor.im * im + value.re * size_by - value.im * phase_by;
                found[1][n] = factor.re * im + factor.im * re + value.im * size_by + value.re * phase_by;
            }
        }
        let [[alpha_re, alpha_im], [beta_re, beta_im], [zeta_re, zeta_im]] = found;
        let (alpha, beta) = (end.alpha, end.beta);
        let mut response = Response::zeros();
        for n in 0..7 {
            let (d_alpha, d_beta) =
                (Complex::new(alpha_re[n], alpha_im[n]), Complex::new(beta_re[n], beta_im[n]));
            let across = (alpha.conjugate() * d_beta - beta * d_alpha.conjugate()).scaled(2.0);
            let turn = 2.0 * ((alpha.conjugate() * d_alpha).im - (beta.conjugate() * d_beta).im);
            let column = [across.re, across.im, turn, zeta_re[n], zeta_im[n], self.axial[n]];
            response.column_mut(n).copy_from_slice(&column);
        }
        response
    }
}

/// z/|z|, also where |z|² leaves the range of a double; 1 for 0.
fn unit(mut z: Complex<f64>) -> Complex<f64> {
    if z.norm_squared() < f64::MIN_POSITIVE / f64::EPSILON {
        let largest = z.re.abs().max(z.im.abs());
        if largest == 0.0 {
            return Complex::new(1.0, 0.0);
        }
        z = Complex::new(z.re / largest, z.im / largest);
    }
    z.scaled(1.0 / z.norm_squared().sqrt())
}
