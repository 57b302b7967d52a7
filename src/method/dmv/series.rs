//! The moments and the clock with which the discrete Moser–Veselov map is the exact motion: power series for one body.
//!
//! # Derivation
//! With modified moments `1/J_i = s/I_i + d` the map follows the exact flow of the body over h if s and d are functions of the
//! invariants, even in h (Hairer and Vilmart, J. Phys. A 39 (2006) 13225, give them to order 10). For the increment p of the
//! attitude and the momenta m₀, m(h) before and after, the map reads
//!
//! ```text
//! (4/h) β_i = (s/I_i + d) σ_i,   β = p₀ (p₁, p₂, p₃),   σ = m₀ + m(h),   i = 1, 2, 3
//! ```
//!
//! which is linear in s and d. So s and d as power series in h come from the Taylor series of the exact flow at any momentum
//! without a zero component. Their terms of degree 2n in h are homogeneous of degree n in C = ½|m|² and H, and n + 1 momenta of
//! different H/C determine them. We found no earlier use of this to any order.
//!
//! # Notation
//! X = h² C and A = h² (H − μC)/ν, with μ and ν the centre and half the width of the range of H/C, so that |A| ≤ X.

use std::sync::Arc;

use super::flows::{Lanes, ratios};
use crate::body::Rotor;
use crate::num::{Dd, Real, Several};
use crate::rotation::Vec3;

/// Terms of s and d up to X⁹: order 20.
pub(in crate::method) const LARGEST_ORDER: u32 = 20;

/// Coefficients of `X^(n−j) A^j` in s − 1 and in d, n = 1, 2, …; j = 0 … n.
#[derive(Clone, Debug)]
pub(in crate::method) struct Series {
    inverse_moments: Vec3<Dd>,
    /// μ.
    centre: Dd,
    /// 1/ν; 0 for a sphere, where A does not matter.
    inverse_width: Dd,
    terms: Vec<Vec<[Dd; 2]>>,
}

impl Series {
    /// Of the body with the constants `rotor`, for a map of the even order `order`.
    pub(in crate::method) fn new(rotor: &Rotor, order: u32) -> Self {
        let inverse_moments = rotor.inverse_moments::<Dd>();
        let mut sorted = [0, 1, 2];
        sorted.sort_by(|&i, &j| inverse_moments[i].hi().total_cmp(&inverse_moments[j].hi()));
        let [low, _, high] = sorted;
        let half = Dd::of(0.5);
        let width = (inverse_moments[high] - inverse_moments[low]) * half;
        let inverse_width = if width == Dd::ZERO { Dd::ZERO } else { Dd::ONE / width };
        let mut series = Series {
            inverse_moments,
            centre: (inverse_moments[high] + inverse_moments[low]) * half,
            inverse_width,
            terms: Vec::new(),
        };
        let degree = (order as usize).div_ceil(2) - 1;
        // momenta of length 1 with a fifth of |m|² along the middle axis and the rest shared between the others
        let mut momenta = [Lanes::all(Dd::ONE); 3];
        let nodes: Vec<Dd> = (0..=degree)
            .map(|k| {
                // Chebyshev points of the share
                let angle = (2 * k + 1) as f64 / (2 * degree + 2) as f64 * core::f64::consts::PI;
                let share = 0.5 + 0.45 * Real::sin_cos(angle).1;
                let mut squares = [Dd::ONE - Dd::of(0.8); 3];
                squares[high] = Dd::of(0.8) * share;
                squares[low] = Dd::of(0.8) - squares[high];
                let m = Vec3(squares.map(Dd::sqrt));
                for (lanes, component) in momenta.iter_mut().zip(m.0) {
                    lanes.set(k, component);
                }
                let (x, a) = series.arguments(m, Dd::ONE);
                a / x
            })
            .collect();
        // odd powers vanish
        let [r_low, r_high] = ratios(&momenta, &inverse_moments.0, [low, high], 2 * degree);
        series.terms = (1..=degree)
            .map(|n| {
                // divided by X^n with X = C = ½
                let scale = Dd::of((1_u64 << n) as f64);
                let value = |k: usize| {
                    let (r_low, r_high) = (r_low[2 * n].get(k), r_high[2 * n].get(k));
                    series.solved([r_low, r_high], [low, high]).map(|value| value * scale)
                };
                if inverse_width == Dd::ZERO {
                    // A is zero
                    let mut coefficients = vec![[Dd::ZERO; 2]; n + 1];
                    coefficients[0] = value(0);
                    return coefficients;
                }
                interpolate(&nodes[..=n], (0..=n).map(value).collect())
            })
            .collect();
        series
    }

    /// (X, A) of the momentum `m` for the square of the step.
    fn arguments(&self, m: Vec3<Dd>, h_squared: Dd) -> (Dd, Dd) {
        let half = h_squared * 0.5;
        let (c, twice_h) = (m.norm_squared() * half, m.times(self.inverse_moments).dot(m) * half);
        (c, (twice_h - self.centre * c) * self.inverse_width)
    }

    /// s and d for the momentum `m` and the step `h`.
    pub(in crate::method) fn values(&self, m: Vec3<Dd>, h: Dd) -> [Dd; 2] {
        let (x, a) = self.arguments(m, h * h);
        evaluate(&self.terms, x, a)
    }

    /// The coefficients in the digits of `S`, which are those of every step.
    pub(in crate::method) fn coefficients<S: Real>(&self) -> Coefficients<S> {
        self.terms.iter().map(|row| row.iter().map(|pair| pair.map(S::from_dd)).collect()).collect()
    }

    /// The same series with `coefficients`, in their digits, for the step `h`.
    pub(in crate::method) fn rounded<S: Real>(
        &self,
        h: Dd,
        coefficients: &Coefficients<S>,
    ) -> RoundedSeries<S> {
        let half = h * h * 0.5;
        let to = |v: Dd| S::from_dd(v);
        RoundedSeries {
            half_square: to(half),
            weights: self.inverse_moments.map(|i| to((i - self.centre) * self.inverse_width * half)),
            terms: Arc::clone(coefficients),
        }
    }

    /// s and d, or their coefficients of a power of h, by those of r along two axes; of the sphere d = 0.
    fn solved(&self, [r_low, r_high]: [Dd; 2], [low, high]: [usize; 2]) -> [Dd; 2] {
        let i = self.inverse_moments;
        let apart = i[high] - i[low];
        if apart == Dd::ZERO {
            return [r_low / i[low], Dd::ZERO];
        }
        let s = (r_high - r_low) / apart;
        [s, r_low - s * i[low]]
    }
}

/// Coefficients of s − 1 and of d by degree, shared by the maps of a body.
pub(in crate::method) type Coefficients<S> = Arc<[Vec<[S; 2]>]>;

/// A [`Series`] in the digits of `S`, for one step size.
#[derive(Clone, Debug)]
pub(in crate::method) struct RoundedSeries<S> {
    half_square: S,
    weights: Vec3<S>,
    terms: Coefficients<S>,
}

impl<S: Real> RoundedSeries<S> {
    /// What [`values`](Self::values) reads, h/2 put in: what makes X and A, and the coefficients from the last on.
    pub(in crate::method) fn constants(&self, half: S) -> impl Iterator<Item = S> {
        let Vec3([a, b, c]) = self.weights;
        let coefficients = self.terms.iter().rev().flat_map(|row| row.iter().rev().flatten().copied());
        [self.half_square, a, b, c, half].into_iter().chain(coefficients)
    }

    /// The largest power of X.
    pub(in crate::method) fn degree(&self) -> usize {
        self.terms.len()
    }

    /// s and d for the momentum `m`.
    #[inline]
    pub(in crate::method) fn values(&self, m: Vec3<S>) -> [S; 2] {
        evaluate(&self.terms, m.norm_squared() * self.half_square, m.times(self.weights).dot(m))
    }
}

/// 1 + Σ s_nj X^(n−j) A^j and Σ d_nj X^(n−j) A^j.
#[inline]
fn evaluate<S: Real>(terms: &[Vec<[S; 2]>], x: S, a: S) -> [S; 2] {
    let zero = S::of(0.0);
    // Horner in X over the degrees n; the forms of degree n by Horner in A with rising powers of X
    let mut sums = [zero; 2];
    for row in terms.iter().rev() {
        let mut form = [zero; 2];
        let mut power = S::of(1.0);
        for pair in row.iter().rev() {
            for (form, &coefficient) in form.iter_mut().zip(pair) {
                *form = *form * a + coefficient * power;
            }
            power = power * x;
        }
        sums = [sums[0] + form[0], sums[1] + form[1]];
    }
    [S::of(1.0) + sums[0], sums[1]]
}

/// Coefficients of the two polynomials through the points, lowest first (Newton's divided differences).
fn interpolate(nodes: &[Dd], mut differences: Vec<[Dd; 2]>) -> Vec<[Dd; 2]> {
    let n = nodes.len();
    for width in 1..n {
        for k in (width..n).rev() {
            let ([s, d], [s_before, d_before]) = (differences[k], differences[k - 1]);
            let apart = nodes[k] - nodes[k - width];
            differences[k] = [(s - s_before) / apart, (d - d_before) / apart];
        }
    }
    let mut coefficients = vec![[Dd::ZERO; 2]; n];
    for k in (0..n).rev() {
        // times (x − node) plus the next difference; of a degree that is not reached yet all are zero
        for j in (0..n - k).rev() {
            let before = if j == 0 { differences[k] } else { coefficients[j - 1] };
            let [s, d] = coefficients[j];
            coefficients[j] = [before[0] - nodes[k] * s, before[1] - nodes[k] * d];
        }
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;
    use crate::inertia::Inertia;

    fn series(moments: [f64; 3], order: u32) -> (Series, [Dd; 3]) {
        let rotor = Body::free(Inertia::from_moments(moments).unwrap()).rotor();
        (Series::new(&rotor, order), rotor.moments::<Dd>().0)
    }

    /// s and d to order 10 in closed form: Hairer and Vilmart, J. Phys. A 39 (2006) 13225.
    fn published(i: [Dd; 3], x: Dd, y: Dd) -> [Dd; 2] {
        let n = |v: f64| Dd::of(v);
        let power = |v: Dd, k: i32| (0..k.abs()).fold(Dd::ONE, |p, _| if k > 0 { p * v } else { p / v });
        let sum = |k: i32| power(i[0], k) + power(i[1], k) + power(i[2], k);
        let mixed = |p: i32, q: i32| {
            let term = |a: usize, b: usize, c: usize| (power(i[a], p) + power(i[b], p)) / power(i[c], q);
            term(0, 1, 2) + term(1, 2, 0) + term(2, 0, 1)
        };
        let delta = i[0] * i[1] * i[2];
        let (d2, d3, d4) = (delta * delta, power(delta, 3), power(delta, 4));
        let (s1, s2, s3, s4) = (sum(1), sum(2), sum(3), sum(4));
        let (x1, x2, x3, x4) = (sum(-1), sum(-2), sum(-3), sum(-4));
        let (m11, m12, m13, m21, m22, m31) =
            (mixed(1, 1), mixed(1, 2), mixed(1, 3), mixed(2, 1), mixed(2, 2), mixed(3, 1));
        let s: [Vec<Dd>; 4] = [
            vec![s1 / (n(6.0) * delta), -x1 / n(3.0)],
            vec![
                (s2 / delta - x1) / (n(30.0) * delta),
                (n(1.0) - m11) / (n(30.0) * delta),
                (n(3.0) * s1 / delta + n(2.0) * x2) / n(60.0),
            ],
            vec![
                (n(4.0) * delta + n(17.0) * s3 - n(15.0) * delta * m11) / (n(2520.0) * d3),
                (n(9.0) * s1 + n(10.0) * delta * x2 - n(6.0) * m21) / (n(420.0) * d2),
                ((n(6.0) * m12 - n(100.0) * x1) * delta + n(53.0) * s2) / (n(2520.0) * d2),
                (n(15.0) - delta * x3 - n(2.0) * m11) / (n(630.0) * delta),
            ],
            vec![
                (n(62.0) * s4 - n(94.0) * delta * m21 + n(66.0) * d2 * x2 + n(81.0) * delta * s1)
                    / (n(45360.0) * d4),
                (n(-77.0) * m31 + n(75.0) * delta * m12 + n(214.0) * s2 - n(240.0) * delta * x1)
                    / (n(22680.0) * d3),
                (n(26.0) * delta * m22 + n(55.0) * s3 + n(204.0) * delta
                    - n(50.0) * d2 * x3
                    - n(59.0) * delta * m11)
                    / (n(7560.0) * d3),
                (n(137.0) * delta * x2 - delta * m13 + n(3.0) * s1 - n(69.0) * m21) / (n(11340.0) * d2),
                (n(2.0) * d2 * x4 + n(5.0) * delta * m12 - n(171.0) * delta * x1 + n(159.0) * s2)
                    / (n(45360.0) * d2),
            ],
        ];
        let d: [Vec<Dd>; 4] = [
            vec![n(-1.0) / (n(3.0) * delta), s1 / (n(6.0) * delta)],
            vec![
                -s1 / (n(60.0) * d2),
                x1 / (n(10.0) * delta) - s2 / (n(60.0) * d2),
                -(n(9.0) + m11) / (n(60.0) * delta),
            ],
            vec![
                (n(34.0) * delta * x1 - n(19.0) * s2) / (n(2520.0) * d3),
                (s3 + n(2.0) * delta * m11 - n(85.0) * delta) / (n(1260.0) * d3),
                (n(47.0) * s1 + n(13.0) * m21 - n(38.0) * delta * x2) / (n(2520.0) * d2),
                (n(9.0) * delta * x1 + delta * m12 - n(11.0) * s2) / (n(1260.0) * d2),
            ],
            vec![
                (n(60.0) * m11 * delta - n(61.0) * s3 - n(247.0) * delta) / (n(45360.0) * d4),
                (n(54.0) * delta * s1 - s4 + n(218.0) * delta * m21 - n(426.0) * d2 * x2) / (n(45360.0) * d4),
                (n(125.0) * delta * x1 - n(5.0) * m31 - n(130.0) * s2 + n(4.0) * delta * m12)
                    / (n(7560.0) * d3),
                (n(67.0) * s3 - n(735.0) * delta - n(15.0) * delta * m22
                    + n(87.0) * delta * m11
                    + n(34.0) * d2 * x3)
                    / (n(22680.0) * d3),
                (n(165.0) * s1 - delta * m13 - n(9.0) * m21 - n(145.0) * delta * x2) / (n(45360.0) * d2),
            ],
        ];
        let total = |rows: &[Vec<Dd>; 4]| {
            let form = |(k, row): (usize, &Vec<Dd>)| {
                row.iter().enumerate().fold(Dd::ZERO, |sum, (j, &c)| {
                    sum + c * power(x, (k + 1 - j) as i32) * power(y, j as i32)
                })
            };
            rows.iter().enumerate().map(form).fold(Dd::ZERO, |sum, term| sum + term)
        };
        [Dd::ONE + total(&s), total(&d)]
    }

    #[test]
    fn series_to_order_10_are_those_published() {
        for moments in [[0.6, 0.8, 1.0], [1.0, 1.75, 2.5], [2.0, 1.0, 1.0]] {
            let (series, i) = series(moments, 10);
            for m in [[1.8, 0.4, -0.9], [0.1, 1.0, 0.2], [0.0, 0.0, 1.0]] {
                let (m, h) = (Vec3(m.map(Dd::of)), Dd::of(0.25));
                let x = m.norm_squared() * h * h * 0.5;
                let y = m.times(series.inverse_moments).dot(m) * h * h * 0.5;
                let (ours, theirs) = (series.values(m, h), published(i, x, y));
                for k in 0..2 {
                    assert!(
                        (ours[k] - theirs[k]).magnitude() < 1e-29,
                        "{moments:?}: {:?}, {:?}",
                        ours[k],
                        theirs[k]
                    );
                }
            }
        }
    }

    #[test]
    fn the_terms_of_order_12_are_those_of_rational_arithmetic() {
        // h¹⁰ terms in powers of X and Y for the moments 3/5, 4/5, 1: exact fractions, tests/data/schemes/dmv.py
        let s: [(f64, f64); 6] = [
            (-24_875.0, 20_901_888.0),
            (5_043_425.0, 1_379_524_608.0),
            (-1_438_135.0, 344_881_152.0),
            (4_694_213.0, 2_069_286_912.0),
            (-409_559.0, 689_762_304.0),
            (774_083.0, 28_217_548_800.0),
        ];
        let d: [(f64, f64); 6] = [
            (10_625.0, 5_474_304.0),
            (-381_125.0, 62_705_664.0),
            (416_275.0, 57_480_192.0),
            (-4_385_245.0, 1_034_643_456.0),
            (3_885_923.0, 3_103_930_368.0),
            (-1_214_069.0, 10_346_434_560.0),
        ];
        // moments to 106 bits, which the doubles 0.6 and 0.8 are not
        let rotor = Rotor::of_moments(Vec3([Dd::of(3.0) / Dd::of(5.0), Dd::of(4.0) / Dd::of(5.0), Dd::ONE]));
        let (ten, twelve) = (Series::new(&rotor, 10), Series::new(&rotor, 12));
        let (m, h) = (Vec3([1.8, 0.4, -0.9].map(Dd::of)), Dd::of(0.25));
        let x = m.norm_squared() * h * h * 0.5;
        let y = m.times(ten.inverse_moments).dot(m) * h * h * 0.5;
        for (k, fractions) in [s, d].into_iter().enumerate() {
            let power = |v: Dd, n: usize| (0..n).fold(Dd::ONE, |p, _| p * v);
            let expected = fractions.iter().enumerate().fold(Dd::ZERO, |sum, (j, &(above, below))| {
                sum + Dd::of(above) / Dd::of(below) * power(x, 5 - j) * power(y, j)
            });
            let ours = twelve.values(m, h)[k] - ten.values(m, h)[k];
            assert!((ours - expected).magnitude() < 1e-29, "{ours:?}, {expected:?}");
        }
    }

    #[test]
    fn a_sphere_has_a_clock_and_no_change_of_moments() {
        let (series, _) = series([2.0; 3], 20);
        let (m, h) = (Vec3([1.0, -0.5, 0.25].map(Dd::of)), Dd::of(0.5));
        let [s, d] = series.values(m, h);
        // β = ½ sin θ m/|m| with θ = h|m|/I, so that s = sin θ/θ; the moment in the solver frame is 1
        let theta = m.norm() * h;
        assert!((s - theta.sin_cos().0 / theta).magnitude() < 1e-12 && d == Dd::ZERO, "{s:?}");
    }
}
