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
            *row = *self::row(lane, part);
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
            self.terms.momentum[0] = Rows::of(momentum, part);
            self.terms.attitude[0] = Rows::of(attitude, part);
            let mut last = Rows::<1>::ZERO;
            let ends = self.expand(part, row(t, part), &mut last.0[0]);
            settled += self.add(part, ends, &last.0[0]);
        }
        settled
    }

    /// The terms of the bodies of `part`, until all series are long enough; the numbers with which the first of them ends, and the last.
    #[inline(always)]
    fn expand(&mut self, part: usize, t: &[f64; WIDTH], last: &mut [f64; WIDTH]) -> (usize, usize) {
        let ([a, b, c], [d, e, f]) = (&self.inverse_moments, &self.gyroscopic);
        let (a, b, c) = (row(a, part), row(b, part), row(c, part));
        let (d, e, f) = (row(d, part), row(e, part), row(f, part));
        let Terms { momentum: m, turn, attitude: q } = &mut self.terms;
        let (Rows(mut least), mut sums) = (Rows::<2>::ZERO, Rows::<7>::ZERO);
        let (Rows(momentum), Rows(spin)) = (&m[0], &mut turn[0]);
        for l in 0..WIDTH {
            let omega = [momentum[0][l] * a[l], momentum[1][l] * b[l], momentum[2][l] * c[l]];
            (spin[0][l], spin[1][l], spin[2][l]) = (omega[0] * 0.5, omega[1] * 0.5, omega[2] * 0.5);
            last[l] = if largest(omega) * t[l].abs() < SHORT { 0.0 } else { OTHERWISE };
        }
        let mut going = 0;
        for last in &*last {
            going += usize::from(*last == 0.0);
        }
        let (mut first, mut top) = (TERMS, 0);
        while top < TERMS - 2 && going > 0 {
            let terms = (&m[..=top], &q[..=top], &turn[..=top]);
            // of more, some registers would be put away
            let mut k = top % 3 + 1;
            match k {
                1 => products::<1, true>(&mut sums, terms, 0),
                2 => products::<2, true>(&mut sums, terms, 0),
                _ => products::<3, true>(&mut sums, terms, 0),
            }
            while k <= top {
                products::<3, false>(&mut sums, terms, k);
                k += 3;
            }
            let reciprocal = self.reciprocals[top + 1];
            top += 1;
            let (Rows(m), Rows(spin), Rows(q), Rows(sums)) =
                (&mut m[top], &mut turn[top], &mut q[top], &sums);
            if top == 1 {
                for l in 0..WIDTH {
                    let factor = t[l] * reciprocal;
                    let momentum =
                        [d[l] * sums[0][l] * factor, e[l] * sums[1][l] * factor, f[l] * sums[2][l] * factor];
                    let attitude = [sums[3][l] * factor, sums[4][l] * factor, sums[5][l] * factor];
                    let attitude = larger(largest(attitude), (sums[6][l] * factor).abs());
                    least[0][l] = 0.25 * f64::ROUNDOFF * largest(momentum);
                    least[1][l] = 0.25 * f64::ROUNDOFF * attitude;
                }
            }
            let (number, before) = (top as f64, going);
            going = 0;
            for l in 0..WIDTH {
                let factor = t[l] * reciprocal;
                let x = d[l] * sums[0][l] * factor;
                let y = e[l] * sums[1][l] * factor;
                let z = f[l] * sums[2][l] * factor;
                (m[0][l], m[1][l], m[2][l]) = (x, y, z);
                (spin[0][l], spin[1][l], spin[2][l]) = (x * a[l] * 0.5, y * b[l] * 0.5, z * c[l] * 0.5);
                let (p, u) = (sums[3][l] * factor, sums[4][l] * factor);
                let (v, w) = (sums[5][l] * factor, sums[6][l] * factor);
                (q[0][l], q[1][l], q[2][l], q[3][l]) = (p, u, v, w);
                let (momentum, attitude) = (least[0][l], least[1][l]);
                let small = (x.abs() <= momentum)
                    & (y.abs() <= momentum)
                    & (z.abs() <= momentum)
                    & (p.abs() <= attitude)
                    & (u.abs() <= attitude)
                    & (v.abs() <= attitude)
                    & (w.abs() <= attitude);
                // a sum: what is written to some lanes only takes ten times as long on many processors
                last[l] += if (last[l] == 0.0) & small { number } else { 0.0 };
                going += usize::from(last[l] == 0.0);
            }
            if going < before {
                first = first.min(top);
            }
        }
        (first, top)
    }

    /// Adds up the terms to the number `top`, of each body to its last, which is none before `first`, and counts the bodies whose sums
    /// are good.
    #[inline(always)]
    fn add(&mut self, part: usize, (first, top): (usize, usize), last: &[f64; WIDTH]) -> usize {
        // what leaves the last term as it is, also a zero
        let nothing = [-0.0; WIDTH];
        let (mut m, mut q) = (Rows([nothing; 3]), Rows([nothing; 4]));
        let mut k = top;
        while k > first {
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
            k -= 1;
        }
        while k > 0 {
            let terms = (&self.terms.momentum[..=k], &self.terms.attitude[..=k]);
            match k {
                1 => add_terms::<1>(&mut m, &mut q, terms),
                2 => add_terms::<2>(&mut m, &mut q, terms),
                3 => add_terms::<3>(&mut m, &mut q, terms),
                _ => add_terms::<4>(&mut m, &mut q, terms),
            }
            k = k.saturating_sub(4);
        }
        let (Rows(momentum), Rows([x, y, z])) = (&self.terms.momentum[0], &m);
        let (mut ends, mut settled) = (Rows::<1>::ZERO, 0);
        for l in 0..WIDTH {
            let size = largest([momentum[0][l], momentum[1][l], momentum[2][l]]);
            let steady = largest([x[l], y[l], z[l]]) <= STEADY * f64::ROUNDOFF * size;
            let end = if steady { OTHERWISE } else { last[l] };
            ends.0[0][l] = end;
            settled += usize::from(end > 0.0);
        }
        ends.write_to(&mut self.last, part);
        m.write_to(&mut self.momentum, part);
        q.write_to(&mut self.attitude, part);
        settled
    }
}

/// The numbers of the bodies of `part`.
#[inline(always)]
fn row(lane: &Lane, part: usize) -> &[f64; WIDTH] {
    lane.as_chunks().0.get(part).unwrap_or(&ZERO)
}

/// Adds to `sums`, or where they are the `FIRST` to zero, the products of the terms `k` and the next ones, `N` in all, with those from the
/// other end.
#[inline(always)]
fn products<const N: usize, const FIRST: bool>(
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
        let (mut x, mut p) = ([0.0; 3], [0.0; 4]);
        if !FIRST {
            x = [sums[0][l], sums[1][l], sums[2][l]];
            p = [sums[3][l], sums[4][l], sums[5][l], sums[6][l]];
        }
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

/// Adds the last `N` of the terms, from the last on.
#[inline(always)]
fn add_terms<const N: usize>(Rows(m): &mut Rows<3>, Rows(q): &mut Rows<4>, terms: (&[Rows<3>], &[Rows<4>])) {
    let (Some(momenta), Some(attitudes)) = (terms.0.last_chunk::<N>(), terms.1.last_chunk::<N>()) else {
        return;
    };
    for l in 0..WIDTH {
        let (mut x, mut y, mut z) = (m[0][l], m[1][l], m[2][l]);
        let (mut p, mut u, mut v, mut w) = (q[0][l], q[1][l], q[2][l], q[3][l]);
        for n in (0..N).rev() {
            let (Rows(m), Rows(q)) = (&momenta[n], &attitudes[n]);
            (x, y, z) = (x + m[0][l], y + m[1][l], z + m[2][l]);
            (p, u, v, w) = (p + q[0][l], u + q[1][l], v + q[2][l], w + q[3][l]);
        }
        (m[0][l], m[1][l], m[2][l]) = (x, y, z);
        (q[0][l], q[1][l], q[2][l], q[3][l]) = (p, u, v, w);
    }
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
