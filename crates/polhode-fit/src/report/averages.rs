//! Bounds on the principal axes from averages over a record, where no tensor was found.
//!
//! One test function over a whole segment turns Euler's equation into [M, J]_ij = ε_ijk (J v)_k with M = ∫ φ ω ωᵀ dt and
//! v = ∫ φ' ω dt. Noise adds a multiple of 1 to M, which commutes with J. In the eigenframe of M, with eigenvalues λ,
//! (λ_i − λ_j) J_ij is a component of J v, and no moment of a body exceeds half the trace: |J_ij| ≤ ½ |v| / |λ_i − λ_j|.

use crate::thresholds::averages::{PARTS, UNEVEN};
use core::fmt;

use nalgebra::{Matrix3, Vector3};

use crate::physical::coordinates::eigen;
use crate::report::identifiability::direction;
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::{Seen, TestFunctions};
use crate::thresholds::identifiability::VAGUE;
use crate::thresholds::noise::SURE;

/// An axis that is principal to within a bound, if no torque acted on the body.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AverageAxis {
    /// Unit vector in sensor axes.
    pub axis: Vector3<f64>,
    /// Upper bound on the products of inertia of this axis with the others, as a share of the trace.
    pub product: f64,
}

impl fmt::Display for AverageAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = direction(&self.axis);
        write!(
            f,
            "{axis} is a principal axis if no torque acted, with products of inertia of at most {:.4} of the trace",
            self.product
        )
    }
}

/// Whether the mean square of the rates stays the same along a stretch: a hand that holds the body changes it.
fn steady(s: &Stretch) -> bool {
    let size = s.rates.len().div_ceil(PARTS).max(1);
    let means = s
        .rates
        .chunks(size)
        .map(|part| part.iter().map(|w| w.norm_squared()).sum::<f64>() / part.len() as f64);
    let (low, high) = means.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), m| (a.min(m), b.max(m)));
    high - low <= UNEVEN * 0.5 * (high + low)
}

/// The axes whose products of inertia have a useful bound.
pub(crate) fn axes(stretches: &[Stretch], variance: f64) -> Vec<AverageAxis> {
    if !stretches.iter().all(steady) {
        return Vec::new();
    }
    let (mut m, mut v) = (Matrix3::zeros(), Vector3::zeros());
    let (mut squares, mut slopes) = (0.0, 0.0);
    for s in stretches {
        let Some(tests) = TestFunctions::new(s, 0.5 * s.duration()) else { continue };
        for ((&t, w), &weight) in s.times.iter().zip(&s.rates).zip(&s.weights) {
            let seen = Seen::new(&tests, t);
            let (slope, value) = (weight * seen.slope[0], weight * seen.value[0]);
            m += w * w.transpose() * value;
            v += w * slope;
            squares += value * value * w.norm_squared();
            slopes += slope * slope;
        }
    }
    // expected squares of the noise in v, and of that in M (Frobenius), whose commutator with J is at most half of it
    let noise = SURE * ((3.0 * variance * slopes).sqrt() + (8.0 * variance * squares).sqrt());
    let (values, directions) = eigen(m);
    (0..3)
        .map(|k| {
            let gap = (0..3)
                .filter(|&i| i != k)
                .map(|i| (values[i] - values[k]).abs())
                .fold(f64::INFINITY, f64::min);
            AverageAxis { axis: directions.column(k).into_owned(), product: 0.5 * (v.norm() + noise) / gap }
        })
        .filter(|a| a.product <= VAGUE)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    fn spin() -> Stretch {
        let times: Vec<f64> = (0..201).map(|k| 0.05 * f64::from(k)).collect();
        Stretch::new(times, vec![Vector3::new(0.0, 0.6, -0.8); 201])
    }

    /// The mean square of eight parts may differ by half of its middle, from 1 to 5/3, and no more.
    #[test]
    fn a_steady_rotation_keeps_its_mean_square() {
        for (square, is_steady) in [(1.66, true), (1.67, false), (0.601, true), (0.599, false)] {
            let mut rates = vec![Vector3::new(0.0, 1.0, 0.0); 16];
            rates[14..].fill(Vector3::new(0.0, 0.0, f64::sqrt(square)));
            let s = Stretch::new((0..16).map(f64::from).collect(), rates);
            assert_eq!(steady(&s), is_steady, "{square}");
            assert!(is_steady || axes(&[spin(), s], 0.0).is_empty());
        }
    }

    /// A constant rate shows its axis, and of the others across it nothing; the bound is as large as the noise, and has no unit.
    #[test]
    fn a_constant_rate_shows_its_axis() {
        let of = |s: &Stretch, variance: f64| {
            let found = axes(core::slice::from_ref(s), variance);
            assert_eq!(found.len(), 1, "{found:?}");
            found[0]
        };
        let noisy = of(&spin(), 1e-6);
        assert!(noisy.axis.dot(&Vector3::new(0.0, 0.6, -0.8)).abs() > 1.0 - 1e-12);
        let twice = of(&spin(), 4e-6);
        assert!(noisy.product > 1e-6 && (twice.product / noisy.product - 2.0).abs() < 1e-3);
        let s = spin();
        let times = s.times.iter().map(|t| 0.25 * t).collect();
        let fast = of(&Stretch::new(times, s.rates.iter().map(|w| w * 4.0).collect()), 16e-6);
        assert!((fast.product / noisy.product - 1.0).abs() < 1e-9);
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.7, 1.1));
        let turned = of(&Stretch::new(s.times.clone(), s.rates.iter().map(|w| turn * w).collect()), 1e-6);
        assert!((turn * noisy.axis).dot(&turned.axis).abs() > 1.0 - 1e-12);
        assert!((turned.product / noisy.product - 1.0).abs() < 1e-9);
    }

    /// An axis is said with the products of inertia that it may have.
    #[test]
    fn an_axis_is_said_with_its_bound() {
        let axis = AverageAxis { axis: Vector3::new(0.0, 0.6, -0.8), product: 0.0123 };
        assert_eq!(
            axis.to_string(),
            "(0.0000, -0.6000, 0.8000) is a principal axis if no torque acted, with products of inertia of at most 0.0123 of the trace"
        );
    }

    /// At a constant rate of 1 the bound is half of five deviations over ∫ φ: with u = t/R those are √(3 σ² (h/R) ∫ φ'² du) and
    /// √(8 σ² h R ∫ φ² du), at samples that are h apart.
    #[test]
    fn the_bound_of_a_constant_rate_is_that_of_the_integrals() {
        // ∫ (1 − u²)ⁿ du from −1 to 1 is 2 (2/3) (4/5) … 2n/(2n + 1)
        let integral = |n: u32| (1..=n).map(f64::from).fold(2.0, |all, k| all * 2.0 * k / (2.0 * k + 1.0));
        // of φ'² = 64 u² (1 − u²)⁶, with u² = 1 − (1 − u²)
        let (area, slopes, squares) = (integral(4), 64.0 * (integral(6) - integral(7)), integral(8));
        let (radius, step, sigma): (f64, f64, f64) = (5.0, 0.05, 1e-3);
        let of_slopes = (3.0 * step / radius * slopes).sqrt();
        let of_squares = (8.0 * step * radius * squares).sqrt();
        let [found] = axes(&[spin()], sigma * sigma)[..] else { panic!() };
        let expected = 0.5 * SURE * sigma * (of_slopes + of_squares) / (radius * area);
        assert!((found.product / expected - 1.0).abs() < 1e-3, "{} {expected}", found.product);
    }
}
