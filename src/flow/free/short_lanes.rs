//! The free body over a short time, of many bodies side by side.

use super::FreeFlow;
use super::short_flow::{Constants, SHORT, STEADY, TERMS, half_turn};
use crate::num::{LANES, Lane, Real as _};

/// Bodies whose terms are worked out together: those of all would leave the first cache.
const WIDTH: usize = 32;

const ZERO: [f64; WIDTH] = [0.0; WIDTH];

/// Of a series that is not tried, or whose sum is not taken.
const OTHERWISE: f64 = -1.0;

/// `K` numbers of each body. They begin with a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Rows<const K: usize>([[f64; WIDTH]; K]);

impl<const K: usize> Rows<K> {
    const ZERO: Self = Rows([ZERO; K]);

    /// Those of the bodies of `part`.
    #[inline(always)]
    fn of(lanes: &[Lane; K], part: usize) -> Self {
        let mut rows = Self::ZERO;
        for (row, lane) in rows.0.iter_mut().zip(lanes) {
            *row = *lane.as_chunks().0.get(part).unwrap_or(&ZERO);
        }
        rows
    }

    #[inline(always)]
    fn write_to(&self, lanes: &mut [Lane; K], part: usize) {
        for (row, lane) in self.0.iter().zip(lanes) {
            if let Some(to) = lane.as_chunks_mut().0.get_mut(part) {
                *to = *row;
            }
        }
    }
}

/// Free flows of a block, and room for their series.
#[derive(Clone, Debug)]
pub(crate) struct FreeLanes {
    flows: Vec<FreeFlow<f64>>,
    inverse_moments: [Lane; 3],
    gyroscopic: [Lane; 3],
    reciprocals: [f64; TERMS],
    terms: Terms,
    /// What is added to the momenta, and to the attitudes.
    pub(crate) momentum: [Lane; 3],
    pub(crate) attitude: [Lane; 4],
    /// The last term of each series, nothing above 0 where it has no sum.
    last: [Lane; 1],
}

/// The terms of [`ShortFlow`](super::short_flow::ShortFlow): m_n, ½ I⁻¹m_n and q_n.
#[derive(Clone, Debug)]
struct Terms {
    momentum: [Rows<3>; TERMS],
    turn: [Rows<3>; TERMS],
    attitude: [Rows<4>; TERMS],
}

impl FreeLanes {
    /// Of the bodies of a block, in their order; `None` if one of them has no series.
    pub(crate) fn new<'a>(flows: impl Iterator<Item = &'a FreeFlow<f64>>) -> Option<Self> {
        let flows: Vec<FreeFlow<f64>> = flows.copied().collect();
        let mut lanes = FreeLanes {
            inverse_moments: [Lane::ZERO; 3],
            gyroscopic: [Lane::ZERO; 3],
            reciprocals: [0.0; TERMS],
            terms: Terms {
                momentum: [Rows::ZERO; TERMS],
                turn: [Rows::ZERO; TERMS],
                attitude: [Rows::ZERO; TERMS],
            },
            momentum: [Lane::ZERO; 3],
            attitude: [Lane::ZERO; 4],
            last: [Lane::ZERO],
            flows,
        };
        for (n, flow) in lanes.flows.iter().enumerate().take(LANES) {
            let Constants { inverse_moments, gyroscopic, reciprocals } = flow.short()?.constants();
            for k in 0..3 {
                lanes.inverse_moments[k][n] = inverse_moments[k];
                lanes.gyroscopic[k][n] = gyroscopic[k];
            }
            lanes.reciprocals = reciprocals;
        }
        Some(lanes)
    }

    /// The flow of the body in lane `n`.
    pub(crate) fn alone(&self, n: usize) -> Option<&FreeFlow<f64>> {
        self.flows.get(n)
    }

    /// Whether the series of lane `n` has a sum.
    pub(crate) fn is_settled(&self, n: usize) -> bool {
        self.last[0][n] > 0.0
    }

    /// The sums of all series at the times `t`; how many there are.
    #[inline(always)]
    pub(crate) fn sum(&mut self, t: &Lane, attitude: &[Lane; 4], momentum: &[Lane; 3]) -> usize {
        let mut settled = 0;
        for part in 0..LANES / WIDTH {
            let t = Rows::of(&[*t], part);
            let (attitude, momentum) = (Rows::of(attitude, part), Rows::of(momentum, part));
            let mut last = Rows::ZERO;
            let top = self.expand(part, &t.0[0], &attitude, &momentum, &mut last.0[0]);
            settled += self.add(part, top, &momentum, &mut last.0[0]);
            last.write_to(&mut self.last, part);
        }
        settled
    }

    /// The terms of the bodies of `part`, until all series are long enough; the number of the last.
    #[inline(always)]
    fn expand(
        &mut self,
        part: usize,
        t: &[f64; WIDTH],
        Rows(attitude): &Rows<4>,
        Rows(momentum): &Rows<3>,
        last: &mut [f64; WIDTH],
    ) -> usize {
        let Rows([a, b, c]) = Rows::of(&self.inverse_moments, part);
        let Rows([d, e, f]) = Rows::of(&self.gyroscopic, part);
        let Terms { momentum: m, turn, attitude: q } = &mut self.terms;
        let Rows(mut least) = Rows::<2>::ZERO;
        m[0] = Rows(*momentum);
        q[0] = Rows(*attitude);
        let Rows(spin) = &mut turn[0];
        for l in 0..WIDTH {
            let omega = [momentum[0][l] * a[l], momentum[1][l] * b[l], momentum[2][l] * c[l]];
            (spin[0][l], spin[1][l], spin[2][l]) = (omega[0] * 0.5, omega[1] * 0.5, omega[2] * 0.5);
            last[l] = if largest(omega) * t[l].abs() < SHORT { 0.0 } else { OTHERWISE };
        }
        let mut top = 0;
        while top < TERMS - 2 && zeros(last) > 0 {
            let mut sums = Rows::<7>::ZERO;
            let terms = (&m[..=top], &q[..=top], &turn[..=top]);
            let mut k = 0;
            while k + 4 <= top + 1 {
                products::<4>(&mut sums, terms, k);
                k += 4;
            }
            while k < top + 1 {
                products::<1>(&mut sums, terms, k);
                k += 1;
            }
            let reciprocal = self.reciprocals[top + 1];
            top += 1;
            let (Rows(m), Rows(spin), Rows(q), Rows(sums)) =
                (&mut m[top], &mut turn[top], &mut q[top], &sums);
            for l in 0..WIDTH {
                let factor = t[l] * reciprocal;
                let x = d[l] * sums[0][l] * factor;
                let y = e[l] * sums[1][l] * factor;
                let z = f[l] * sums[2][l] * factor;
                (m[0][l], m[1][l], m[2][l]) = (x, y, z);
                (spin[0][l], spin[1][l], spin[2][l]) = (x * a[l] * 0.5, y * b[l] * 0.5, z * c[l] * 0.5);
                (q[0][l], q[1][l]) = (sums[3][l] * factor, sums[4][l] * factor);
                (q[2][l], q[3][l]) = (sums[5][l] * factor, sums[6][l] * factor);
            }
            if top == 1 {
                for l in 0..WIDTH {
                    let attitude = larger(largest([q[0][l], q[1][l], q[2][l]]), q[3][l].abs());
                    least[0][l] = 0.25 * f64::ROUNDOFF * largest([m[0][l], m[1][l], m[2][l]]);
                    least[1][l] = 0.25 * f64::ROUNDOFF * attitude;
                }
            }
            let number = top as f64;
            for l in 0..WIDTH {
                let (momentum, attitude) = (least[0][l], least[1][l]);
                let small = (m[0][l].abs() <= momentum)
                    & (m[1][l].abs() <= momentum)
                    & (m[2][l].abs() <= momentum)
                    & (q[0][l].abs() <= attitude)
                    & (q[1][l].abs() <= attitude)
                    & (q[2][l].abs() <= attitude)
                    & (q[3][l].abs() <= attitude);
                last[l] = if (last[l] == 0.0) & small { number } else { last[l] };
            }
        }
        top
    }

    /// Adds up the terms to the number `top`, of each body to its last, and counts the bodies whose sums are good.
    #[inline(always)]
    fn add(&mut self, part: usize, top: usize, Rows(momentum): &Rows<3>, last: &mut [f64; WIDTH]) -> usize {
        // what leaves the last term as it is, also a zero
        let nothing = [-0.0; WIDTH];
        let (mut m, mut q) = (Rows([nothing; 3]), Rows([nothing; 4]));
        for k in (1..=top).rev() {
            let (Rows(x), Rows(p), number) = (&self.terms.momentum[k], &self.terms.attitude[k], k as f64);
            for l in 0..WIDTH {
                let counts = number <= last[l];
                m.0[0][l] += if counts { x[0][l] } else { -0.0 };
                m.0[1][l] += if counts { x[1][l] } else { -0.0 };
                m.0[2][l] += if counts { x[2][l] } else { -0.0 };
                q.0[0][l] += if counts { p[0][l] } else { -0.0 };
                q.0[1][l] += if counts { p[1][l] } else { -0.0 };
                q.0[2][l] += if counts { p[2][l] } else { -0.0 };
                q.0[3][l] += if counts { p[3][l] } else { -0.0 };
            }
        }
        let Rows([x, y, z]) = &m;
        for l in 0..WIDTH {
            let size = largest([momentum[0][l], momentum[1][l], momentum[2][l]]);
            let steady = largest([x[l], y[l], z[l]]) <= STEADY * f64::ROUNDOFF * size;
            last[l] = if steady { OTHERWISE } else { last[l] };
        }
        m.write_to(&mut self.momentum, part);
        q.write_to(&mut self.attitude, part);
        let mut settled = 0;
        for last in &*last {
            settled += usize::from(*last > 0.0);
        }
        settled
    }
}

/// Adds to `sums` the products of the terms `k` and the next ones, `N` in all, with those from the other end.
#[inline(always)]
fn products<const N: usize>(
    Rows(sums): &mut Rows<7>,
    (m, q, turn): (&[Rows<3>], &[Rows<4>], &[Rows<3>]),
    k: usize,
) {
    let top = m.len() - 1;
    let Some(m_k) = m[k..].first_chunk::<N>() else { return };
    let Some(q_k) = q[k..].first_chunk::<N>() else { return };
    let Some(m_r) = m[..=top - k].last_chunk::<N>() else { return };
    let Some(turn_r) = turn[..=top - k].last_chunk::<N>() else { return };
    for l in 0..WIDTH {
        let mut x = [sums[0][l], sums[1][l], sums[2][l]];
        let mut p = [sums[3][l], sums[4][l], sums[5][l], sums[6][l]];
        for n in 0..N {
            let (Rows(u), Rows(v), Rows(q), Rows(w)) =
                (&m_k[n], &m_r[N - 1 - n], &q_k[n], &turn_r[N - 1 - n]);
            x[0] += u[1][l] * v[2][l];
            x[1] += u[2][l] * v[0][l];
            x[2] += u[0][l] * v[1][l];
            let half = half_turn([q[0][l], q[1][l], q[2][l], q[3][l]], [w[0][l], w[1][l], w[2][l]]);
            p[0] += half[0];
            p[1] += half[1];
            p[2] += half[2];
            p[3] += half[3];
        }
        (sums[0][l], sums[1][l], sums[2][l]) = (x[0], x[1], x[2]);
        (sums[3][l], sums[4][l], sums[5][l], sums[6][l]) = (p[0], p[1], p[2], p[3]);
    }
}

/// How many series go on.
#[inline(always)]
fn zeros(last: &[f64; WIDTH]) -> usize {
    let mut zeros = 0;
    for last in last {
        zeros += usize::from(*last == 0.0);
    }
    zeros
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The largest |component|. A NaN may be lost: then no term is small.
#[inline(always)]
fn largest(x: [f64; 3]) -> f64 {
    larger(larger(x[0].abs(), x[1].abs()), x[2].abs())
}
