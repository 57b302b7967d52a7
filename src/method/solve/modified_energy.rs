//! What a splitting of the kinetic energy does to the motion: the leading term of its modified energy, and what follows
//! for the attitude.
//!
//! # Notation
//! A splitting of order 2 follows the exact motion of `H̃ = H + h² H₃ + …`. With s_i = m_i², H₃ of turns about principal
//! axes is `Σ κ_i s_j s_k`, (i, j, k) the three axes.
//!
//! | letter | meaning |
//! |---|---|
//! | E, G | energy and \|m\| of the orbit |
//! | T, Ω_J = 2π/T | period of the momentum in the body, its angular frequency |
//! | Ω_G | mean rate at which the body turns about L beyond that |
//! | ⟨·⟩ | mean over the orbit |
//!
//! # Error of the attitude
//! In action-angle variables (J, θ; G, g) of the free body the modified energy is H(J, G) + h²⟨H₃⟩, and the start has the
//! action J + h² (H₃(m₀) − ⟨H₃⟩)/Ω_J. Its frequencies differ from the true ones by
//!
//! ```text
//! δΩ_J = h² (Ω_J ∂_E⟨H₃⟩ + ∂_EΩ_J (H₃(m₀) − ⟨H₃⟩))
//! δΩ_G = h² ((∂_G + Ω_G ∂_E)⟨H₃⟩ + ∂_EΩ_G (H₃(m₀) − ⟨H₃⟩))
//! ```
//!
//! and the attitude runs away at the rate ρ ω + (δΩ_G − Ω_G ρ) L/G with ρ = δΩ_J/Ω_J: time along the polhode, and a turn
//! about L. ⟨H₃⟩ is homogeneous of degree 4 in m, which gives its derivative in G. Derived here by first-order averaging;
//! tests/two_turns.rs compares it with runs.

use core::cmp::Ordering;
use core::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

use multiversion::multiversion;

use crate::num::Real;
use crate::num::elliptic::Modulus;
use crate::rotation::Vec3;

/// H₃ of turns about the principal axes: the coefficients of s₂s₃, s₁s₃ and s₁s₂, s_i = m_i².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::method) struct ModifiedEnergy(pub(in crate::method) [f64; 3]);

/// An orbit of the free momentum, with the means that the leading error is made of.
#[derive(Clone, Copy, Debug)]
pub(in crate::method) struct Orbit {
    start: Vec3<f64>,
    energy: f64,
    norm: f64,
    here: Means,
    /// Change of the means with the energy.
    slope: Means,
    /// ⟨p₁²⟩, ⟨p₂²⟩, ⟨p₃²⟩, ⟨p₂p₃⟩, ⟨p₁p₃⟩, ⟨p₁p₂⟩ of the products p₁ = s₂s₃, …
    squares: [f64; 6],
    /// ⟨ω²⟩.
    omega_squared: f64,
}

/// The leading error of the attitude of a splitting of order 2, in its two parts: the attitude of step n is that of the exact
/// motion at the time t + τ, turned about L by ψ, with τ and ψ proportional to t but for an oscillation of the size of h².
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PhaseErrorRates {
    /// τ/t over h², 1/s²: the shift in time along the polhode.
    pub shift: f64,
    /// ψ/t over h², rad/s³: the twist about L.
    pub twist: f64,
}

/// Means over one orbit, or how they change.
#[derive(Clone, Copy, Debug)]
struct Means {
    period: f64,
    /// Ω_G.
    turn: f64,
    /// ⟨s₂s₃⟩, ⟨s₁s₃⟩, ⟨s₁s₂⟩.
    products: [f64; 3],
}

/// Points over a quarter of a period of the momentum at most, and at least: the mean of a periodic function that is even converges
/// like the nome to the power of twice their number, and of a body with two equal moments five are exact.
const MOST_POINTS: usize = 24;
const FEWEST_POINTS: f64 = 5.0;

/// A number at each point, and zeros where there are fewer points.
type AtPoints = [f64; MOST_POINTS];

/// sin² of angles from 0 to π/2, for each number of points: from −π/2 to 0 it is the same.
static SINES_SQUARED: LazyLock<[AtPoints; MOST_POINTS + 1]> = LazyLock::new(|| {
    let mut all = [[0.0; MOST_POINTS]; MOST_POINTS + 1];
    for (points, squares) in all.iter_mut().enumerate() {
        for n in 0..points.div_ceil(2) {
            let (s, c) = Real::sin_cos(FRAC_PI_2 * (n as f64 + 0.5) / points as f64);
            (squares[n], squares[points - 1 - n]) = (s * s, c * c);
        }
    }
    all
});

/// How far it is taken: the natural logarithm of the power of the nome that is left.
const LEFT: f64 = -36.0;

/// Step of the derivative in the energy, as a share of the distance to the next orbit of another kind.
const SHARE: f64 = 1e-3;

/// As many points as the nome asks for, by the first terms of its series in k' (NIST DLMF 19.5.5): where the next would count, all
/// are taken.
fn enough(complementary_modulus: f64) -> usize {
    let root = complementary_modulus.sqrt();
    let e = 0.5 * (1.0 - root) / (1.0 + root);
    let square = e * e;
    let nome = e + 2.0 * (square * square * e);
    (0.5 * LEFT / libm::log(nome)).ceil().clamp(FEWEST_POINTS, MOST_POINTS as f64) as usize
}

impl ModifiedEnergy {
    /// At the momentum `m`.
    pub(in crate::method) fn at(self, m: Vec3<f64>) -> f64 {
        let s = m.0.map(|m| m * m);
        self.0[0] * s[1] * s[2] + self.0[1] * s[0] * s[2] + self.0[2] * s[0] * s[1]
    }

    /// Root mean square over the orbit of the rate at which the attitude runs away, over h², rad/s³, for the start at the
    /// momentum that the orbit was made from.
    pub(in crate::method) fn attitude_error_rate(self, orbit: &Orbit) -> f64 {
        let apart = self.at(orbit.start) - self.mean(&orbit.here);
        self.rate(orbit, apart, apart * apart)
    }

    /// The two parts of the same error, for the same start.
    pub(in crate::method) fn phase_error_rates(self, orbit: &Orbit) -> PhaseErrorRates {
        let apart = self.at(orbit.start) - self.mean(&orbit.here);
        let [shift, twist] = self.parts(orbit).map(|[constant, slope]| constant + slope * apart);
        PhaseErrorRates { shift, twist }
    }

    /// The same as a root mean square over all starts on the orbit.
    fn mean_attitude_error_rate(self, orbit: &Orbit) -> f64 {
        let [k1, k2, k3] = self.0;
        let [s11, s22, s33, s23, s13, s12] = orbit.squares;
        let square = k1 * k1 * s11 + k2 * k2 * s22 + k3 * k3 * s33;
        let square = square + 2.0 * (k2 * k3 * s23 + k1 * k3 * s13 + k1 * k2 * s12);
        let mean = self.mean(&orbit.here);
        self.rate(orbit, 0.0, (square - mean * mean).max(0.0))
    }

    /// ⟨H₃⟩.
    fn mean(self, means: &Means) -> f64 {
        self.0.iter().zip(means.products).map(|(k, s)| k * s).sum()
    }

    /// ρ and δΩ_G − Ω_G ρ as constant + slope times H₃(m₀) − ⟨H₃⟩, over h².
    fn parts(self, orbit: &Orbit) -> [[f64; 2]; 2] {
        let (here, slope) = (&orbit.here, &orbit.slope);
        let (f, f_e) = (self.mean(here), self.mean(slope));
        let f_g = (4.0 * f - 2.0 * orbit.energy * f_e) / orbit.norm;
        // ∂_EΩ_J / Ω_J = −∂_E T / T
        let rho = [f_e, -slope.period / here.period];
        let turn = [f_g + here.turn * f_e, slope.turn];
        [rho, [0, 1].map(|k| turn[k] - here.turn * rho[k])]
    }

    /// Of the given H₃(m₀) − ⟨H₃⟩ and its square, or the means of both.
    fn rate(self, orbit: &Orbit, apart: f64, apart_squared: f64) -> f64 {
        let [rho, about] = self.parts(orbit);
        let product = |a: [f64; 2], b: [f64; 2]| {
            a[0] * b[0] + (a[0] * b[1] + a[1] * b[0]) * apart + a[1] * b[1] * apart_squared
        };
        let along_l = 2.0 * orbit.energy / orbit.norm; // ω·L/G
        let square = product(rho, rho) * orbit.omega_squared
            + 2.0 * product(rho, about) * along_l
            + product(about, about);
        square.max(0.0).sqrt()
    }
}

/// Of the splittings `candidates`, each with its leading term, that with the smallest leading error of the attitude on the
/// orbit through the momentum `m`; `None` where there is no such orbit.
pub(in crate::method) fn of_least_error<C>(
    candidates: impl IntoIterator<Item = (C, ModifiedEnergy)>,
    m: Vec3<f64>,
    moments: Vec3<f64>,
) -> Option<C> {
    let orbit = Orbit::through(m, moments)?;
    let rated =
        candidates.into_iter().map(|(candidate, term)| (term.mean_attitude_error_rate(&orbit), candidate));
    rated.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, candidate)| candidate)
}

impl Orbit {
    /// Of the body with the moments `moments` through the momentum `m`; `None` for a pure spin, a sphere, a body at rest,
    /// and next to the separatrix, where no mean is worth much.
    pub(in crate::method) fn through(m: Vec3<f64>, moments: Vec3<f64>) -> Option<Orbit> {
        Orbit::by_points(enough, m, moments)
    }

    /// The same by as many points as `points` says.
    fn by_points(points: fn(f64) -> usize, m: Vec3<f64>, moments: Vec3<f64>) -> Option<Orbit> {
        let norm = m.norm();
        let energy = 0.5 * (m[0] * m[0] / moments[0] + m[1] * m[1] / moments[1] + m[2] * m[2] / moments[2]);
        // orbits change their kind at the energies of pure spins
        let spins = moments.0.map(|i| 0.5 * norm * norm / i);
        let room = spins.iter().map(|spin| (energy - spin).abs()).fold(f64::INFINITY, f64::min);
        let step = SHARE * room;
        if step.partial_cmp(&(f64::EPSILON * energy)) != Some(Ordering::Greater) {
            return None;
        }
        let kind = Kind::of(energy, norm, moments);
        let points = points((1.0 - kind.parameter).sqrt());
        let beside = |energy| {
            Orbit::of::<false>(points, Kind::of(energy, norm, moments), m, energy, norm, moments).here
        };
        let here = Orbit::of::<true>(points, kind, m, energy, norm, moments);
        let (below, above) = (beside(energy - step), beside(energy + step));
        let slope = |below: f64, above: f64| (above - below) / (2.0 * step);
        let slope = Means {
            period: slope(below.period, above.period),
            turn: slope(below.turn, above.turn),
            products: [0, 1, 2].map(|k| slope(below.products[k], above.products[k])),
        };
        let finite = |means: &Means| {
            means.period.is_finite() && means.turn.is_finite() && means.products.iter().all(|s| s.is_finite())
        };
        (finite(&here.here) && finite(&slope)).then_some(Orbit { slope, ..here })
    }

    /// The means of the orbit of this `kind`, with the energy `energy` and |m| = `norm`, not of a pure spin, over `points` points; the
    /// slopes are left out, and what has none unless all is asked for.
    fn of<const ALL: bool>(
        points: usize,
        kind: Kind,
        start: Vec3<f64>,
        energy: f64,
        norm: f64,
        moments: Vec3<f64>,
    ) -> Orbit {
        let Kind { axes: [a, b, c], squares: [a2, b2, c2], parameter } = kind;
        let (ia, ic) = (moments[a], moments[c]);
        let modulus = Modulus::new(1.0 - parameter);
        let quarter = modulus.quarter_period();
        let rate = ((ic - ia) / (ia * ic)).abs() * (a2 * c2 / b2).sqrt();
        let [squares_a, squares_b, squares_c, turns] =
            at_points(&modulus, &kind, [energy, norm, ia], &SINES_SQUARED[points]);
        let share = 1.0 / points as f64;
        let mut here = Means { period: 4.0 * quarter / rate, turn: 0.0, products: [0.0; 3] };
        let (mut squares, mut omega_squared) = ([0.0; 6], 0.0);
        let along = squares_a.iter().zip(&squares_b).zip(&squares_c);
        for (((s_a, s_b), s_c), turn) in along.zip(&turns).take(points) {
            let mut s = [0.0; 3];
            (s[a], s[b], s[c]) = (*s_a, *s_b, *s_c);
            here.turn += turn * share;
            let p = [0, 1, 2].map(|k| s[(k + 1) % 3] * s[(k + 2) % 3]);
            for (product, p) in here.products.iter_mut().zip(p) {
                *product += p * share;
            }
            if !ALL {
                continue;
            }
            for (square, (j, k)) in squares.iter_mut().zip([(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]) {
                *square += p[j] * p[k] * share;
            }
            let square = |k: usize| s[k] / (moments[k] * moments[k]);
            omega_squared += (square(0) + square(1) + square(2)) * share;
        }
        let slope = Means { period: 0.0, turn: 0.0, products: [0.0; 3] };
        Orbit { start, energy, norm, here, slope, squares, omega_squared }
    }
}

/// m_a², m_b² and m_c² at the points whose sines are squared, and the rate at which the body turns about L: no point waits for another.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn at_points(
    modulus: &Modulus<f64>,
    kind: &Kind,
    [energy, norm, ia]: [f64; 3],
    sines_squared: &AtPoints,
) -> [AtPoints; 4] {
    let Kind { squares: [a2, b2, c2], parameter, .. } = *kind;
    let complement = 1.0 - parameter;
    let mut squares = *sines_squared;
    modulus.sn_squared(&mut squares);
    let [mut s_a, mut s_b, mut s_c, mut turns] = [[0.0; MOST_POINTS]; 4];
    for (n, &sn2) in squares.iter().enumerate() {
        let cn2 = 1.0 - sn2;
        (s_a[n], s_b[n], s_c[n]) = (a2 * (complement + parameter * cn2), b2 * sn2, c2 * cn2);
        let along = s_a[n].sqrt();
        turns[n] = (2.0 * energy / norm + along / ia) / (1.0 + along / norm);
    }
    [s_a, s_b, s_c, turns]
}

/// Which axis of an orbit has which of Jacobi's functions, dn, sn and cn, the squares of their amplitudes, and m = k².
struct Kind {
    axes: [usize; 3],
    squares: [f64; 3],
    parameter: f64,
}

impl Kind {
    fn of(energy: f64, norm: f64, moments: Vec3<f64>) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        let [small, middle, large] = order;
        // G² − 2E I_k: positive of the smallest moment, negative of the largest
        let delta = |k: usize| norm * norm - 2.0 * energy * moments[k];
        let (a, b, c) = if delta(middle) <= 0.0 { (small, middle, large) } else { (large, middle, small) };
        let (ia, ib, ic) = (moments[a], moments[b], moments[c]);
        let squares = [ia * delta(c) / (ia - ic), ib * delta(a) / (ib - ia), ic * delta(a) / (ic - ia)];
        let parameter = delta(a) * (ic - ib) / (-delta(c) * (ib - ia));
        Kind { axes: [a, b, c], squares, parameter }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{AxisOrder, TwoAxes};

    #[test]
    fn points_by_the_nome_choose_the_axes_that_all_points_choose() {
        let part = |k: u32, ratio: f64| (f64::from(k) * ratio).fract();
        let mut largest_error = 0.0_f64;
        for k in 1..3000 {
            let middle = 1.0 + part(k, 0.618_033_988_749_895);
            let moments = Vec3([1.0, middle, middle + 0.999 * part(k, 0.754_877_666_246_693)]);
            let m = Vec3([0.569_840_290_998, 0.324_717_957_244, 0.245_122_333_753].map(|x| part(k, x) - 0.5));
            let few = Orbit::through(m, moments).unwrap();
            let all = Orbit::by_points(|_| MOST_POINTS, m, moments).unwrap();
            let two = TwoAxes::ALL.map(|axes| axes.leading_term(moments));
            let three = AxisOrder::ALL.map(|order| order.leading_term(moments));
            for terms in [two, three] {
                let rates = |orbit: &Orbit| terms.map(|term| term.mean_attitude_error_rate(orbit));
                let least = |rates: [f64; 6]| (0..6).min_by(|&i, &j| rates[i].total_cmp(&rates[j]));
                let (few, all) = (rates(&few), rates(&all));
                assert_eq!(least(few), least(all), "{moments:?} {m:?}");
                for (few, all) in few.iter().zip(all) {
                    largest_error = largest_error.max((few / all - 1.0).abs());
                }
            }
        }
        // of single ones, where the separatrix is near or nearly all of a rate cancels
        assert!(largest_error < 1e-5 && largest_error > 1e-12, "{largest_error:e}");
    }
}
