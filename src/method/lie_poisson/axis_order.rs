//! The order of the three turns of a Lie–Poisson splitting, and which one to take.

use core::fmt;
use core::str::FromStr;

use thiserror::Error;

use crate::method::solve::modified_energy::{ModifiedEnergy, Orbit, PhaseErrorRates, of_least_error};
use crate::rotation::Vec3;

/// An order of the three axes, outermost turn first: `321` is Φ = R3(h/2) R2(h/2) R1(h) R2(h/2) R3(h/2).
///
/// ```
/// use polhode::method::AxisOrder;
/// let order: AxisOrder = "321".parse()?;
/// assert_eq!(order.axes(), [2, 1, 0]);
/// # Ok::<(), polhode::method::AxisOrderError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisOrder([usize; 3]);

impl AxisOrder {
    /// All six orders.
    pub const ALL: [AxisOrder; 6] = [
        AxisOrder([0, 1, 2]),
        AxisOrder([0, 2, 1]),
        AxisOrder([1, 0, 2]),
        AxisOrder([1, 2, 0]),
        AxisOrder([2, 0, 1]),
        AxisOrder([2, 1, 0]),
    ];

    /// That of NO_SQUISH: the third axis outside, the first inside.
    pub(in crate::method) const NO_SQUISH: AxisOrder = AxisOrder([2, 1, 0]);

    /// The axes from 0, outermost first.
    #[must_use]
    pub fn axes(self) -> [usize; 3] {
        self.0
    }

    /// The order with the smallest [energy oscillation](Self::energy_oscillation) for these moments.
    #[must_use]
    pub fn best(moments: Vec3<f64>) -> Self {
        let mut best = (f64::INFINITY, AxisOrder([2, 1, 0]));
        for (order, size) in Self::ALL.into_iter().zip(Self::energy_oscillations(moments)) {
            if size < best.0 {
                best = (size, order);
            }
        }
        best.1
    }

    /// Root mean square over the sphere |m| = 1 of the part of H₃ that moves the energy, where H̃ = H + h² H₃ + …
    /// is what the splitting keeps.
    ///
    /// With a, b, c the reciprocal moments of the inner, middle and outer axis, expanding the
    /// symmetric Baker–Campbell–Hausdorff series,
    /// `24 H₃ = (−2a²b + 2a²c + ab² − 4abc + 2b²c) m₁²m₂² + (2a²b − 2a²c + 2abc + ac² − bc²) m₁²m₃²
    /// + (−ab² + 2abc − ac² − 2b²c + bc²) m₂²m₃²`; the part in the span of H², HC and C² is constant and drops out.
    #[must_use]
    pub fn energy_oscillation(self, moments: Vec3<f64>) -> f64 {
        let found = Self::ALL.iter().position(|order| *order == self);
        Self::energy_oscillations(moments)[found.unwrap_or(0)]
    }

    /// That of each of [`ALL`](Self::ALL): what is summed up for one order waits for nothing of the others.
    fn energy_oscillations(moments: Vec3<f64>) -> Six {
        let mut all = [Quadratics([[0.0; 6]; 6]); 4];
        for (n, order) in Self::ALL.into_iter().enumerate() {
            let [outer, middle, inner] = order.0;
            let (a, b, c) = (1.0 / moments[inner], 1.0 / moments[middle], 1.0 / moments[outer]);
            let h = [0.5 * a, 0.5 * b, 0.5 * c];
            let forms = [
                mixed(order.leading_term(moments).0, [inner, middle, outer]),
                linear_product([1.0; 3], [1.0; 3]),
                linear_product(h, [1.0; 3]),
                linear_product(h, h),
            ];
            for (quadratics, form) in all.iter_mut().zip(forms) {
                quadratics.0.iter_mut().zip(form).for_each(|(six, coefficient)| six[n] = coefficient);
            }
        }
        let [h3, constants @ ..] = all;
        h3.outside(constants)
    }

    /// H₃ of [`energy_oscillation`](Self::energy_oscillation) at the momentum `m`: the splitting keeps H + h² H₃ up to O(h⁴).
    pub fn modified_energy(self, m: Vec3<f64>, moments: Vec3<f64>) -> f64 {
        self.leading_term(moments).at(m)
    }

    /// Root mean square of the rate at which the attitude of free motion runs away on the orbit through the momentum `m`, over
    /// h²: rad/s³. `None` for pure spins, spheres and next to the separatrix.
    pub fn attitude_error_rate(self, m: Vec3<f64>, moments: Vec3<f64>) -> Option<f64> {
        Some(self.leading_term(moments).attitude_error_rate(&Orbit::through(m, moments)?))
    }

    /// The shift in time along the polhode and the twist about L that this error is made of, for a run that begins at the
    /// momentum `m`. `None` where [`attitude_error_rate`](Self::attitude_error_rate) is.
    pub fn phase_error_rates(self, m: Vec3<f64>, moments: Vec3<f64>) -> Option<PhaseErrorRates> {
        Some(self.leading_term(moments).phase_error_rates(&Orbit::through(m, moments)?))
    }

    /// The order whose leading error of the attitude is smallest on the orbit through the momentum `m`, as a root mean square
    /// over all starts on it; where there is none, the [best](Self::best) for the energy.
    pub fn best_for_orbit(m: Vec3<f64>, moments: Vec3<f64>) -> Self {
        let candidates = Self::ALL.map(|order| (order, order.leading_term(moments)));
        of_least_error(candidates, m, moments).unwrap_or_else(|| Self::best(moments))
    }

    pub(in crate::method) fn leading_term(self, moments: Vec3<f64>) -> ModifiedEnergy {
        let [outer, middle, inner] = self.0;
        let (a, b, c) = (1.0 / moments[inner], 1.0 / moments[middle], 1.0 / moments[outer]);
        let mut mixed = [0.0; 3];
        mixed[outer] =
            (-2.0 * a * a * b + 2.0 * a * a * c + a * b * b - 4.0 * a * b * c + 2.0 * b * b * c) / 24.0;
        mixed[middle] = (2.0 * a * a * b - 2.0 * a * a * c + 2.0 * a * b * c + a * c * c - b * c * c) / 24.0;
        mixed[inner] = (-a * b * b + 2.0 * a * b * c - a * c * c - 2.0 * b * b * c + b * c * c) / 24.0;
        ModifiedEnergy(mixed)
    }
}

/// A number of each of the six orders.
type Six = [f64; 6];

/// Six quadratic forms in the squares s_i = m_i²: coefficients of s₁², s₂², s₃², s₂s₃, s₁s₃, s₁s₂.
#[derive(Clone, Copy)]
struct Quadratics([Six; 6]);

/// Of the products of two of the squares of squares, the mean over the sphere times (3/2)₄: E s^α = Π (½)_{α_i} / (3/2)₄ for |α| = 4.
const MOMENTS: [[f64; 6]; 6] = {
    const POWERS: [[usize; 3]; 6] = [[2, 0, 0], [0, 2, 0], [0, 0, 2], [0, 1, 1], [1, 0, 1], [1, 1, 0]];
    const RISING_HALF: [f64; 5] = [1.0, 0.5, 0.75, 1.875, 6.5625];
    let (mut moments, mut n) = ([[0.0; 6]; 6], 0);
    while n < 36 {
        let (p, q) = (POWERS[n / 6], POWERS[n % 6]);
        moments[n / 6][n % 6] =
            RISING_HALF[p[0] + q[0]] * RISING_HALF[p[1] + q[1]] * RISING_HALF[p[2] + q[2]];
        n += 1;
    }
    moments
};
const RISING_THREE_HALVES: f64 = 59.0625;

/// Coefficients of Σ κ_i s_j s_k, the axes in the order `axes`.
fn mixed(coefficients: [f64; 3], axes: [usize; 3]) -> [f64; 6] {
    let [k1, k2, k3] = axes.map(|axis| coefficients[axis]);
    [0.0, 0.0, 0.0, k1, k2, k3]
}

/// Coefficients of (u·s)(v·s).
fn linear_product(u: [f64; 3], v: [f64; 3]) -> [f64; 6] {
    let mixed = |i: usize, j: usize| u[i] * v[j] + u[j] * v[i];
    [u[0] * v[0], u[1] * v[1], u[2] * v[2], mixed(1, 2), mixed(0, 2), mixed(0, 1)]
}

impl Quadratics {
    /// Mean of the product over the sphere.
    fn mean_product(&self, other: &Self) -> Six {
        let mut sum = [0.0; 6];
        for (x, moments) in self.0.iter().zip(&MOMENTS) {
            for (y, moment) in other.0.iter().zip(moments) {
                for n in 0..6 {
                    sum[n] += x[n] * y[n] * moment;
                }
            }
        }
        sum.map(|sum| sum / RISING_THREE_HALVES)
    }

    /// Less its part along `direction`, of which the mean square is `squared`; nothing where that is none.
    fn without(mut self, direction: &Self, squared: Six) -> Self {
        let mut times = self.mean_product(direction);
        for n in 0..6 {
            times[n] = if squared[n] > 0.0 { times[n] / squared[n] } else { 0.0 };
        }
        for (six, along) in self.0.iter_mut().zip(&direction.0) {
            for n in 0..6 {
                six[n] -= times[n] * along[n];
            }
        }
        self
    }

    /// Root mean square of what is orthogonal to the span of `others` (Gram–Schmidt; dependent ones are dropped).
    fn outside(mut self, others: [Self; 3]) -> Six {
        let mut basis: Vec<(Self, Six)> = Vec::with_capacity(3);
        for original in others {
            let mut direction = original;
            for _ in 0..2 {
                for (b, squared) in &basis {
                    direction = direction.without(b, *squared);
                }
            }
            let (mut squared, whole) = (direction.mean_product(&direction), original.mean_product(&original));
            for n in 0..6 {
                squared[n] = if squared[n] > 1e-20 * whole[n] { squared[n] } else { 0.0 };
            }
            basis.push((direction, squared));
        }
        for (b, squared) in &basis {
            self = self.without(b, *squared);
        }
        self.mean_product(&self).map(|square| square.max(0.0).sqrt())
    }
}

impl fmt::Display for AxisOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b, c] = self.0;
        write!(f, "{}{}{}", a + 1, b + 1, c + 1)
    }
}

/// The text is no order of three axes.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("axis order {text:?} is not a permutation of 123, such as 321 (outermost first)")]
#[non_exhaustive]
pub struct AxisOrderError {
    /// What was given.
    pub text: String,
}

impl FromStr for AxisOrder {
    type Err = AxisOrderError;
    fn from_str(text: &str) -> Result<Self, AxisOrderError> {
        Self::ALL
            .into_iter()
            .find(|order| order.to_string() == text)
            .ok_or_else(|| AxisOrderError { text: text.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn oscillations_are_those_of_an_independent_computation() {
        // rational arithmetic and a least-squares fit over the sphere, two digits
        for (moments, least, most) in [([0.6, 0.8, 1.0], 9.3e-3, 2.5e-2), ([1.0, 2.0, 3.0], 3.2e-4, 3.2e-3)] {
            let mut sizes = AxisOrder::ALL.map(|order| order.energy_oscillation(Vec3(moments)));
            sizes.sort_by(f64::total_cmp);
            approx::assert_relative_eq!(sizes[0], least, max_relative = 0.03);
            approx::assert_relative_eq!(sizes[5], most, max_relative = 0.03);
        }
    }

    #[test]
    fn fasso_flat_body_has_an_order_without_oscillation() {
        // outermost the smallest moment, then the middle one: H₃ vanishes identically
        let flat = Vec3([1.0, 0.75, 0.25]);
        let best = AxisOrder::best(flat);
        assert_eq!(best.to_string(), "321");
        assert!(best.energy_oscillation(flat) < 1e-16);
    }

    #[test]
    fn an_order_reads_and_prints_the_same() {
        for order in AxisOrder::ALL {
            assert_eq!(order.to_string().parse(), Ok(order));
        }
        assert!("322".parse::<AxisOrder>().is_err());
    }
}
