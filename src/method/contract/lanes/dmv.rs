//! The discrete Moser–Veselov map, plain or modified, of all bodies of a block.

use super::acting::{set_vector, vector};
use super::block::PARTS;
use crate::method::rattle::{DMV_CONSTANTS, DmvMap};
use crate::num::{LANES, Lane};
use crate::rotation::Vec3;

/// Numbers of each body besides the coefficients: those of X, those of A, and h/2.
const ARGUMENTS: usize = 5;

/// How many numbers of each body polynomials of the degree `degree` take.
pub(super) fn constants(degree: usize) -> usize {
    if degree == 0 { 0 } else { ARGUMENTS + (1..=degree).map(|n| 2 * (n + 1)).sum::<usize>() }
}

/// Maps of a block and the solutions of their equations.
#[derive(Debug)]
pub(super) struct Solves {
    maps: [Lane; DMV_CONSTANTS],
    pub(super) solution: [Lane; 3],
    /// 1 where the solution is one to rounding.
    settled: Lane,
}

impl Solves {
    pub(super) const ZERO: Solves =
        Solves { maps: [Lane::ZERO; DMV_CONSTANTS], solution: [Lane::ZERO; 3], settled: Lane::ZERO };

    /// The map of the body in lane `n`.
    #[inline(always)]
    pub(super) fn map(&self, n: usize) -> DmvMap<f64> {
        let [a, b, c, d, e, f] = &self.maps;
        DmvMap::of([a[n], b[n], c[n], d[n], e[n], f[n]])
    }

    pub(super) fn is_settled(&self, n: usize) -> bool {
        self.settled[n] > 0.0
    }

    /// The maps `plain`, modified by the polynomials at `points`.
    #[inline(always)]
    pub(super) fn set(
        &mut self,
        degree: usize,
        plain: &[Lane; DMV_CONSTANTS],
        polynomials: &[Lane],
        points: &[Lane; PARTS],
    ) {
        let Some((arguments, mut coefficients)) = polynomials.split_first_chunk::<ARGUMENTS>() else {
            self.maps = *plain;
            return;
        };
        let [half_square, u, v, w, half] = arguments;
        let [_, _, _, _, m0, m1, m2, ..] = points;
        let (mut x, mut a, mut s, mut d) = (Lane::ZERO, Lane::ZERO, Lane::ZERO, Lane::ZERO);
        for n in 0..LANES {
            let m = Vec3([m0[n], m1[n], m2[n]]);
            x[n] = m.norm_squared() * half_square[n];
            a[n] = m.times(Vec3([u[n], v[n], w[n]])).dot(m);
        }
        // as the series itself, the coefficients from the last on
        for length in (2..degree + 2).rev() {
            let (mut s_form, mut d_form, mut power) = (Lane::ZERO, Lane::ZERO, Lane::ZERO);
            for n in 0..LANES {
                power[n] = 1.0;
            }
            for _ in 0..length {
                let Some(([s_n, d_n], others)) = coefficients.split_first_chunk() else { return };
                coefficients = others;
                for n in 0..LANES {
                    s_form[n] = s_form[n] * a[n] + s_n[n] * power[n];
                    d_form[n] = d_form[n] * a[n] + d_n[n] * power[n];
                    power[n] *= x[n];
                }
            }
            for n in 0..LANES {
                s[n] += s_form[n];
                d[n] += d_form[n];
            }
        }
        let ([a, b, c, e, f, g], [p0, p1, p2, p3, p4, p5]) = (&mut self.maps, plain);
        for n in 0..LANES {
            let (s, half_d) = (1.0 + s[n], d[n] * half[n]);
            (a[n], b[n], c[n]) = (p0[n] * s + half_d, p1[n] * s + half_d, p2[n] * s + half_d);
            (e[n], f[n], g[n]) = (p3[n] * s, p4[n] * s, p5[n] * s);
        }
    }

    /// Solves the equations of the maps at `points`; of how many the first try is the solution.
    #[inline(always)]
    pub(super) fn solve(&mut self, points: &[Lane; PARTS]) -> usize {
        let [_, _, _, _, m0, m1, m2, ..] = points;
        let momentum = [*m0, *m1, *m2];
        for n in 0..LANES {
            let (u, settled) = self.map(n).near(vector(&momentum, n));
            set_vector(&mut self.solution, n, u);
            self.settled[n] = if settled { 1.0 } else { 0.0 };
        }
        let mut settled = 0;
        for n in 0..LANES {
            settled += usize::from(self.settled[n] > 0.0);
        }
        settled
    }
}
