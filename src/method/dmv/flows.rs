//! The exact flow from several momenta as power series in the time.
//!
//! A coefficient is a long chain of double-double operations, each of which waits for the one before. So the momenta are taken side
//! by side.

use multiversion::multiversion;

use crate::num::{Dd, DdLanes, Real};

/// Momenta that are taken side by side: the largest order needs ten, and sixteen fill vectors of every length.
pub(super) const FLOWS: usize = 16;

/// A number of each of them.
pub(super) type Lanes = DdLanes<FLOWS>;

/// The components of p in a coefficient, behind those of m.
const INCREMENT: usize = 3;

/// A coefficient of m and of p.
type Coefficient = [Lanes; INCREMENT + 4];

/// Coefficients of h⁰ … h^`last` in `r_k = (4 β_k/h)/σ_k` along each axis k of `axes`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
pub(super) fn ratios(
    momenta: &[Lanes; 3],
    inverse_moments: &[Dd; 3],
    axes: [usize; 2],
    last: usize,
) -> [Vec<Lanes>; 2] {
    let flow = flow(momenta, inverse_moments, last + 1);
    let [low, high] = axes;
    [ratio(&flow, low, last), ratio(&flow, high, last)]
}

/// Coefficients up to that of h^`last`.
#[inline(always)]
fn flow(momenta: &[Lanes; 3], i: &[Dd; 3], last: usize) -> Vec<Coefficient> {
    let (zero, half) = (Lanes::all(Dd::ZERO), Lanes::all(Dd::of(0.5)));
    let inverse = [Lanes::all(i[0]), Lanes::all(i[1]), Lanes::all(i[2])];
    let apart = [Lanes::all(i[2] - i[1]), Lanes::all(i[0] - i[2]), Lanes::all(i[1] - i[0])];
    let [x, y, z] = *momenta;
    let mut flow = Vec::with_capacity(last + 1);
    flow.push([x, y, z, Lanes::all(Dd::ONE), zero, zero, zero]);
    for n in 0..last {
        let over = Lanes::all(Dd::ONE / Dd::of((n + 1) as f64));
        let mut next = [zero; INCREMENT + 4];
        // m_a' = (1/I_c − 1/I_b) m_b m_c
        for (a, [b, c]) in [[1, 2], [2, 0], [0, 1]].into_iter().enumerate() {
            next[a] = apart[a] * product(&flow, [b, c], n) * over;
        }
        // p' = ½ p ∘ (0, ω)
        let mut q = [[zero; 3]; 4];
        for (a, row) in q.iter_mut().enumerate() {
            for (k, term) in row.iter_mut().enumerate() {
                *term = product(&flow, [INCREMENT + a, k], n) * inverse[k] * half;
            }
        }
        let [w, x, y, z] = q;
        next[INCREMENT] = -(x[0] + y[1] + z[2]) * over;
        next[INCREMENT + 1] = (w[0] + y[2] - z[1]) * over;
        next[INCREMENT + 2] = (w[1] + z[0] - x[2]) * over;
        next[INCREMENT + 3] = (w[2] + x[1] - y[0]) * over;
        flow.push(next);
    }
    flow
}

/// Coefficients of r along the axis `k` up to that of h^`last`.
#[inline(always)]
fn ratio(flow: &[Coefficient], k: usize, last: usize) -> Vec<Lanes> {
    let four = Lanes::all(Dd::of(4.0));
    let first = flow[0][k] * Lanes::all(Dd::of(2.0));
    let mut terms: Vec<Lanes> = Vec::with_capacity(last + 1);
    for n in 0..=last {
        let mut known = Lanes::all(Dd::ZERO);
        for (term, sigma) in terms.iter().zip(flow[1..=n].iter().rev()) {
            known.add_product(term, &sigma[k]);
        }
        let beta = product(flow, [INCREMENT, INCREMENT + 1 + k], n + 1) * four;
        terms.push((beta - known) / first);
    }
    terms
}

/// The coefficient of h^`n` in the product of two components.
#[inline(always)]
fn product(flow: &[Coefficient], [a, b]: [usize; 2], n: usize) -> Lanes {
    let mut sum = Lanes::all(Dd::ZERO);
    for (x, y) in flow[..=n].iter().zip(flow[..=n].iter().rev()) {
        sum.add_product(&x[a], &y[b]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Several;

    /// The same of one momentum.
    fn alone(m: [Dd; 3], i: [Dd; 3], axis: usize, last: usize) -> Vec<Dd> {
        let product = |a: &[Dd], b: &[Dd], n: usize| (0..=n).fold(Dd::ZERO, |sum, k| sum + a[k] * b[n - k]);
        let mut momentum = m.map(|m| vec![m]);
        let mut increment = [Dd::ONE, Dd::ZERO, Dd::ZERO, Dd::ZERO].map(|p| vec![p]);
        for n in 0..=last {
            let over = Dd::ONE / Dd::of((n + 1) as f64);
            let rates =
                [(1, 2), (2, 0), (0, 1)].map(|(b, c)| (i[c] - i[b]) * product(&momentum[b], &momentum[c], n));
            let q = |a: usize, k: usize| product(&increment[a], &momentum[k], n) * i[k] * 0.5;
            let turned = [
                -(q(1, 0) + q(2, 1) + q(3, 2)),
                q(0, 0) + q(2, 2) - q(3, 1),
                q(0, 1) + q(3, 0) - q(1, 2),
                q(0, 2) + q(1, 1) - q(2, 0),
            ];
            for (component, rate) in momentum.iter_mut().zip(rates).chain(increment.iter_mut().zip(turned)) {
                component.push(rate * over);
            }
        }
        let mut terms: Vec<Dd> = Vec::new();
        for n in 0..=last {
            let known = (0..n).fold(Dd::ZERO, |sum, k| sum + terms[k] * momentum[axis][n - k]);
            let beta = product(&increment[0], &increment[axis + 1], n + 1) * 4.0;
            terms.push((beta - known) / (m[axis] * 2.0));
        }
        terms
    }

    /// Each momentum has the bits that it has alone: of a body with three moments, of two that are next to symmetric and to a sphere,
    /// where coefficients underflow, and of a needle, where they overflow.
    #[test]
    fn momenta_side_by_side_have_the_bits_of_each_alone() {
        let bodies =
            [[1.0, 0.6, 0.55], [1.0, 1.0, 1.0 - 1e-15], [1.0, 1.0 + 2.5e-16, 1.0 - 1e-15], [1.0, 1.0, 1e-60]];
        let last = 18;
        for moments in bodies {
            let i = moments.map(|moment| Dd::ONE / Dd::of(moment));
            let each = |n: usize| [0.3 + 0.01 * n as f64, -0.7, 0.02 * n as f64 - 0.1].map(Dd::of);
            let mut momenta = [Lanes::all(Dd::ZERO); 3];
            for n in 0..FLOWS {
                for (lanes, m) in momenta.iter_mut().zip(each(n)) {
                    lanes.set(n, m);
                }
            }
            let found = ratios(&momenta, &i, [0, 2], last);
            for (found, axis) in found.iter().zip([0, 2]) {
                for n in 0..FLOWS {
                    for (found, alone) in found.iter().map(|r| r.get(n)).zip(alone(each(n), i, axis, last)) {
                        let bits = |x: Dd| [x.hi().to_bits(), x.lo().to_bits()];
                        let same = bits(found) == bits(alone) || (found.hi().is_nan() && alone.hi().is_nan());
                        assert!(same, "{moments:?}, {n}, {axis}: {found:?}, {alone:?}");
                    }
                }
            }
        }
    }
}
