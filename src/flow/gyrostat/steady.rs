//! The steady spins of a gyrostat: m fixed in the body, ω = λ m.
//!
//! With the wheel momentum h and G = |m|, `m_k (1 − λ I_k) = h_k` and
//!
//! `F(λ) = Σ_k h_k²/(1 − λ I_k)² = G²`.
//!
//! F is convex between its poles a_k = 1/I_k and falls to zero outside of them, so that there is one λ below the least and one
//! above the largest, and none or two in each of the gaps: two, four or six spins. Each λ is found as its distance from the
//! nearer pole, since a weak wheel leaves it there. Where h_k = 0 there is no pole, but λ = a_k itself, with
//! `m_k = ±√(G² − Σ_{j≠k} m_j²)`: on the free body these are the spins about the principal axes.
//!
//! Small deviations x obey `x' = m × (I⁻¹ − λ) x` and turn about m at the rate Ω,
//!
//! `Ω² = Σ_k m_k² Π_{j≠k} (a_j − λ)`,
//!
//! or grow, where Ω² < 0. Since `F' = 2 Ω²/Π_k (a_k − λ)`, of the two spins in a gap one is unstable.
//!
//! Source: J. Wittenburg, Dynamics of Multibody Systems, 2nd ed. (2008), chapter 4, on the permanent rotations of a gyrostat; the
//! derivation here is self-contained.

use crate::flow::free::Stability;
use crate::num::{Dd, Precise, Real};
use crate::rotation::Vec3;

/// Of its terms, below which Ω² is rounding.
const ROUNDING: f64 = 1e-13;

/// A spin at a constant rate about an axis that is fixed in the body and in space, in the solver frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SteadySpin {
    /// The total momentum m along the principal axes.
    pub(crate) momentum: Vec3<f64>,
    /// λ, with ω = λ m: the spin rate over |m|; negative where the body turns against its momentum.
    pub(crate) lambda: f64,
    /// What becomes of a small deviation.
    pub(crate) stability: Stability,
    /// Frequency of small oscillations of m in the body, rad/s; 0 unless it is stable.
    pub(crate) frequency: f64,
    /// Rate at which a small deviation grows, 1/s; 0 unless it is unstable.
    pub(crate) growth_rate: f64,
    /// Kinetic energy without that of the wheels in the body, ½ Σ (m_k − h_k)²/I_k.
    pub(crate) energy: f64,
    /// Whether it stands for a circle of spins about the axis of symmetry, all with this energy (for all directions, of a ball
    /// without a wheel).
    pub(crate) is_circle: bool,
}

/// λ as a pole and the distance from it.
#[derive(Clone, Copy)]
struct Place {
    pole: usize,
    distance: Dd,
}

/// Poles of F, with the amplitudes h/G.
struct Poles {
    moments: Vec3<Dd>,
    amplitude: Vec3<Dd>,
    /// The amplitudes times a power of two, so that squares of the largest do not vanish.
    relative: Vec3<Dd>,
}

impl Poles {
    /// 1 − λ I_k.
    fn gap(&self, at: Place, k: usize) -> Dd {
        let (i, pole) = (self.moments[k], self.moments[at.pole]);
        (pole - i) / pole - at.distance * i
    }

    /// h_k/(1 − λ I_k) over G.
    fn part(&self, at: Place, k: usize) -> Dd {
        if self.amplitude[k] == Dd::ZERO { Dd::ZERO } else { self.amplitude[k] / self.gap(at, k) }
    }

    /// F − G² over G².
    fn excess(&self, at: Place) -> Dd {
        let square = |k: usize| {
            let part = self.part(at, k);
            part * part
        };
        (square(0) + square(1)) + (square(2) - 1.0)
    }

    /// F', up to a positive factor.
    fn slope(&self, at: Place) -> Dd {
        let term = |k: usize| {
            if self.relative[k] == Dd::ZERO {
                return Dd::ZERO;
            }
            let gap = self.gap(at, k);
            let part = self.relative[k] / gap;
            part * part * self.moments[k] / gap
        };
        term(0) + term(1) + term(2)
    }

    /// The distance of `sign` from the pole, below `most`, at which `is_beyond` changes from false to true; it halves the set of
    /// doubles, so that no scale is assumed.
    fn search(&self, pole: usize, sign: f64, most: f64, is_beyond: impl Fn(Place) -> bool) -> Place {
        let place = |bits: u64| Place { pole, distance: Dd::of(f64::from_bits(bits) * sign) };
        let (mut low, mut high) = (0, most.to_bits());
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if is_beyond(place(middle)) { high = middle } else { low = middle }
        }
        place(high)
    }

    /// The root of F − G² next to a double, by Newton's method.
    fn refined(&self, mut at: Place) -> Place {
        for _ in 0..3 {
            let slope = |k: usize| {
                let part = self.part(at, k);
                if part == Dd::ZERO { part } else { part * part * self.moments[k] / self.gap(at, k) }
            };
            let step = self.excess(at) / ((slope(0) + slope(1) + slope(2)) * 2.0);
            // at a double root the slope is rounding
            if step.magnitude().is_nan() || step.magnitude() > 1e-6 * at.distance.magnitude() {
                break;
            }
            at.distance = at.distance - step;
        }
        at
    }

    /// One root outside of all poles, on the side `sign` of the outermost.
    fn outside(&self, pole: usize, sign: f64) -> Place {
        self.refined(self.search(pole, sign, f64::MAX, |at| self.excess(at).hi() < 0.0))
    }

    /// The roots between two neighbouring poles, if there are any.
    fn between(&self, low: usize, high: usize) -> Vec<Place> {
        let (i, k) = (self.moments[low], self.moments[high]);
        let width = (i - k) / (i * k);
        let half = width * 0.5;
        let middle = Place { pole: low, distance: half };
        // the least of F, from the nearer pole
        let (pole, sign) = if self.slope(middle).hi() > 0.0 { (low, 1.0) } else { (high, -1.0) };
        let least = self.search(pole, sign, half.hi(), |at| self.slope(at).hi() * sign >= 0.0);
        if self.excess(least).hi() > 0.0 {
            return Vec::new();
        }
        let from_low = if pole == low { least.distance } else { width + least.distance };
        let root = |pole: usize, sign: f64, most: Dd| {
            // at the least place F − G² may be zero
            let at = self.search(pole, sign, most.hi().abs(), |at| self.excess(at).hi() <= 0.0);
            self.refined(at)
        };
        vec![root(low, 1.0, from_low), root(high, -1.0, width - from_low)]
    }
}

/// All steady spins with the total momentum `norm` of a body with the principal `moments` and the `wheel` momentum h along the
/// principal axes, by rising energy; none for a norm of zero.
pub(crate) fn steady_spins(moments: Vec3<Dd>, wheel: Vec3<Dd>, norm: Dd) -> Vec<SteadySpin> {
    if norm.hi().is_nan() || norm.hi() <= 0.0 {
        return Vec::new();
    }
    let amplitude = wheel.map(|h| h / norm);
    let size = amplitude.magnitude();
    let lift = if size > 0.0 { libm::ilogb(size) } else { 0 };
    let poles = Poles { moments, amplitude, relative: amplitude.map(|x| x.scaled(-lift)) };
    // by rising 1/I
    let [high, middle, low] = moments.ascending();
    let mut real: Vec<usize> = Vec::new();
    for k in [low, middle, high] {
        let is_pole = poles.amplitude[k] != Dd::ZERO;
        if is_pole && real.last().is_none_or(|&last| moments[last] != moments[k]) {
            real.push(k);
        }
    }
    let mut spins: Vec<SteadySpin> = Vec::new();
    let mut add =
        |at: Place| spins.push(poles.spin(at, norm, Vec3([0, 1, 2].map(|k| poles.part(at, k))), false));
    if let (Some(&first), Some(&last)) = (real.first(), real.last()) {
        add(poles.outside(first, -1.0));
        add(poles.outside(last, 1.0));
    }
    for pair in real.windows(2) {
        poles.between(pair[0], pair[1]).into_iter().for_each(&mut add);
    }
    spins.extend(poles.without_pole(norm));
    spins.sort_by(|a, b| a.energy.total_cmp(&b.energy));
    spins
}

impl Poles {
    /// The spins with λ = a_k of axes without a wheel.
    fn without_pole(&self, norm: Dd) -> Vec<SteadySpin> {
        let mut spins = Vec::new();
        for k in 0..3 {
            let same = |j: usize| self.moments[j] == self.moments[k];
            // one of equal moments speaks for all
            if (0..3).any(|j| same(j) && (self.amplitude[j] != Dd::ZERO || j < k)) {
                continue;
            }
            let at = Place { pole: k, distance: Dd::ZERO };
            let mut m = Vec3([0, 1, 2].map(|j| if same(j) { Dd::ZERO } else { self.part(at, j) }));
            let rest = Dd::ONE - m.norm_squared();
            if rest.hi() < 0.0 {
                continue;
            }
            let is_circle = (0..3).filter(|&j| same(j)).count() > 1;
            m[k] = rest.sqrt();
            spins.push(self.spin(at, norm, m, is_circle));
            if !is_circle && rest.hi() > 0.0 {
                m[k] = -m[k];
                spins.push(self.spin(at, norm, m, false));
            }
        }
        spins
    }

    fn spin(&self, at: Place, norm: Dd, m: Vec3<Dd>, is_circle: bool) -> SteadySpin {
        let lambda = Dd::ONE / self.moments[at.pole] + at.distance;
        // a_k − λ over G
        let apart = Vec3([0, 1, 2].map(|k| self.gap(at, k) / self.moments[k] * norm));
        let terms = [0, 1, 2].map(|k| m[k] * m[k] * apart[(k + 1) % 3] * apart[(k + 2) % 3]);
        let square = terms[0] + terms[1] + terms[2];
        let size = terms.iter().map(|x| x.magnitude()).fold(0.0, f64::max);
        let stability = if square.magnitude() <= ROUNDING * size {
            Stability::Neutral
        } else if square.hi() > 0.0 {
            Stability::Stable
        } else {
            Stability::Unstable
        };
        let rate = |of: Stability| if stability == of { square.abs().sqrt().hi() } else { 0.0 };
        let turning = lambda * norm;
        let inertia = m.times(self.moments).dot(m);
        SteadySpin {
            momentum: (m * norm).map(Dd::hi),
            lambda: lambda.hi(),
            stability,
            frequency: rate(Stability::Stable),
            growth_rate: rate(Stability::Unstable),
            energy: (turning * turning * inertia * 0.5).hi(),
            is_circle,
        }
    }
}

#[cfg(test)]
mod tests;
