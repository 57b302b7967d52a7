//! Jacobi's functions of the time since a node, with two integrals, as quotients of entire functions.
//!
//! With τ = Ωh and sn = S/N, cn = C/N, dn = D/N, ∫sn² = M/N, ∫(sn/dn)² = W/D all six are entire, and the rules of differentiation give their
//! series: `N' = −k² M`, `N S' − S N' = C D`, `N C' − C N' = −S D`, `N D' − D N' = −k² S C`, `N M' − M N' = S²`, `D W' − W D' = S²`.

/// Terms of a series in τ²; they leave out less than 1e-17 of it where |τ| ≤ 1.
const TERMS: usize = 16;

/// Coefficients of N, C, D, S/τ, M/τ³ and W/τ³.
#[derive(Clone, Debug)]
pub(super) struct Elapsed {
    terms: [[f64; 6]; TERMS],
    rate: f64,
}

/// sn/Ω, cn and dn with ∫(sn/Ω)² and ∫(sn/Ω dn)² over the time.
pub(super) struct Values {
    pub(super) s: f64,
    pub(super) c: f64,
    pub(super) d: f64,
    pub(super) t: f64,
    pub(super) v: f64,
}

impl Elapsed {
    /// For Ω and k².
    pub(super) fn new(rate: f64, parameter: f64) -> Self {
        let mut terms = [[0.0; 6]; TERMS];
        for k in 0..TERMS {
            let order = k as f64;
            let [mut n, mut c, mut d] = if k == 0 { [1.0; 3] } else { [0.0; 3] };
            if k > 1 {
                n = -0.5 * parameter * terms[k - 2][4] / order;
            }
            if k > 0 {
                let [mut by_c, mut by_d] = [n * order; 2]; // from −(k − 2k) n
                for j in 1..k {
                    let weight = terms[j][0] * (order - 2.0 * j as f64);
                    by_c -= terms[k - j][1] * weight;
                    by_d -= terms[k - j][2] * weight;
                }
                for j in 0..k {
                    by_c -= 0.5 * terms[j][3] * terms[k - 1 - j][2];
                    by_d -= 0.5 * parameter * terms[j][3] * terms[k - 1 - j][1];
                }
                (c, d) = (by_c / order, by_d / order);
            }
            (terms[k][0], terms[k][1], terms[k][2]) = (n, c, d);
            let (mut s, mut square) = (0.0, 0.0);
            for j in 0..=k {
                s += terms[j][1] * terms[k - j][2];
            }
            for j in 1..=k {
                s -= terms[j][0] * terms[k - j][3] * (1.0 + 2.0 * order - 4.0 * j as f64);
            }
            terms[k][3] = s / (1.0 + 2.0 * order);
            for j in 0..=k {
                square += terms[j][3] * terms[k - j][3];
            }
            let (mut m, mut w) = (square, square);
            for j in 1..=k {
                let weight = 3.0 + 2.0 * order - 4.0 * j as f64;
                m -= terms[j][0] * terms[k - j][4] * weight;
                w -= terms[j][2] * terms[k - j][5] * weight;
            }
            (terms[k][4], terms[k][5]) = (m / (3.0 + 2.0 * order), w / (3.0 + 2.0 * order));
        }
        Elapsed { terms, rate }
    }

    /// At the time `h`, |Ωh| ≤ 1.
    pub(super) fn at(&self, h: f64) -> Values {
        let tau = self.rate * h;
        let square = tau * tau;
        let mut sums = self.terms[TERMS - 1];
        for terms in self.terms[..TERMS - 1].iter().rev() {
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum = *sum * square + term;
            }
        }
        let [n, c, d, s, m, w] = sums;
        let (by_n, cube) = (1.0 / n, h * h * h);
        Values { s: h * s * by_n, c: c * by_n, d: d * by_n, t: cube * m * by_n, v: cube * w / d }
    }
}
