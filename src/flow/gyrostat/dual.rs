//! The dual form of the two theta functions: next to a separatrix, where the trigonometric sums cancel.
//!
//! With s = (2τ − d)/T and ε = y/T Jacobi's imaginary transformation makes sums of Gaussians of those over even and over odd
//! n, up to a common factor, on a straight lattice
//!
//! `Θ_e = Σ_k e^{−π(s + k)²/2ε}`, `Θ_o = Σ_k (−1)^k e^{−π(s + k)²/2ε}`,
//!
//! and on a skew one Θ_e at s + ½, and Θ_o times e^{iπ/4}: Gaussians at all multiples of σ = 1 or ½, with factors κ that repeat
//! after four. Where two of them meet, m passes from one saddle to the next. From there, at s = −σ(L + ½) + x + i s₂, and
//! without the Gaussian that all terms share,
//!
//! `f = e^{−iπ s₂x/ε} Σ_{i odd} κ_{L + (i + 1)/2} e^{−πσ²i²/8ε − iπ s₂σi/2ε} gⁱ`, `g = e^{−πσx/2ε}`.

use super::spinor::Basis;
use crate::flow::free::{Phase, TOO_FAR};
use crate::num::complex::Complex;
use crate::num::exponential::exp_of_positive;
use crate::num::trig::nearest;
use crate::num::{Dd, Precise, Real};

/// Powers of g on either side: the first left out are below 1e-18.
const TERMS: usize = 6;

/// Ratios y/T below which this form is taken, of a straight and of a skew lattice.
const STRAIGHT: f64 = 0.75;
const SKEW: f64 = 0.3;

/// Coefficients in Z and W of g, g³, … and of their reciprocals.
type Table = [[[Complex<f64>; 2]; 2]; TERMS];

/// The dual form of one motion, in `f64`.
#[derive(Clone, Debug)]
pub(super) struct Dual {
    /// −s/σ + ½, whose nearest integer is L with its sign changed.
    place: Phase,
    /// πσ²/2ε: −ln g a unit of the rest.
    fall: f64,
    /// Turns of the phase a unit of the rest.
    tilt: f64,
    /// For L modulo 4.
    tables: [Table; 4],
}

impl Dual {
    /// `None` where the trigonometric sums serve; `rate` is that of τ.
    pub(super) fn new(basis: &Basis, rate: Dd) -> Option<Self> {
        let Basis { lattice, place, factors: [even, odd] } = basis;
        let ratio = lattice.ratio();
        if ratio.hi() >= if lattice.is_skew { SKEW } else { STRAIGHT } {
            return None;
        }
        let sigma = if lattice.is_skew { 0.5 } else { 1.0 };
        let per_period = Dd::ONE / lattice.period;
        let lift = -(place.im * per_period); // s₂
        let minus = |c: Complex<Dd>| c.scaled(-Dd::ONE);
        let kappa: [[Complex<Dd>; 2]; 4] = if lattice.is_skew {
            let eighth = Complex::phase(Dd::FRAC_PI_4);
            let odd = odd.map(|c| c * eighth);
            [odd, *even, odd.map(minus), *even]
        } else {
            let sum = [even[0] + odd[0], even[1] + odd[1]];
            let difference = [even[0] - odd[0], even[1] - odd[1]];
            [sum, difference, sum, difference]
        };
        let fall = Dd::PI * (sigma * sigma) / (ratio * 2.0);
        let turn = Dd::PI * lift * sigma / (ratio * 2.0);
        let largest = kappa.iter().flatten().map(|c| c.norm_squared().hi()).fold(0.0, f64::max).sqrt();
        let coefficient = |l: i32, i: i32| {
            // over that of g, which all share
            let weight = (fall * (0.25 * (1.0 - f64::from(i * i)))).exp() / largest;
            let factor = Complex::phase(-(turn * f64::from(i))).scaled(weight);
            kappa[(l + (i + 1) / 2).rem_euclid(4) as usize].map(|c| {
                let c = c * factor;
                Complex::new(c.re.hi(), c.im.hi())
            })
        };
        let table = |l: i32| {
            core::array::from_fn(|n| {
                let i = 2 * n as i32 + 1;
                [coefficient(l, i), coefficient(l, -i)]
            })
        };
        Some(Dual {
            place: Phase::new(
                rate * per_period * (2.0 / sigma),
                Dd::of(0.5) - place.re * per_period * (1.0 / sigma),
            ),
            fall: fall.hi(),
            tilt: (-(lift * sigma) / (ratio * 2.0)).hi(),
            tables: [table(0), table(1), table(2), table(3)],
        })
    }

    /// Z and W, up to a common factor, and turns to be added to their phase.
    #[inline]
    pub(super) fn at(&self, t: [f64; 2]) -> Option<([Complex<f64>; 2], f64)> {
        let (place, low) = self.place.at(t);
        if place.is_nan() || place.abs() >= TOO_FAR {
            return None;
        }
        let n = nearest(place);
        let rest = (place - n) + low;
        let l = -n;
        let quarter = l - 4.0 * (0.25 * l).floor();
        let table = &self.tables[quarter as usize % 4];
        let grown = exp_of_positive((self.fall * rest).abs().min(300.0));
        let shrunk = 1.0 / grown;
        let (g, inverse) = if rest < 0.0 { (grown, shrunk) } else { (shrunk, grown) };
        let (up, down) = (g * g, inverse * inverse);
        let mut sums = [[Complex::new(0.0, 0.0); 2]; 2];
        for [positive, negative] in table.iter().rev() {
            for k in 0..2 {
                sums[0][k] = sums[0][k].scaled(up) + positive[k];
                sums[1][k] = sums[1][k].scaled(down) + negative[k];
            }
        }
        let f = [0, 1].map(|k| sums[0][k].scaled(g) + sums[1][k].scaled(inverse));
        Some((f, self.tilt * rest))
    }
}
