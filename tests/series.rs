//! Power series as scalars, against the coefficients of functions that are known.

use polhode::body::{Clock, Time};
use polhode::num::{Dd, Real, Series};

/// `c₀ + s`, with as many coefficients known as a series holds.
fn variable(c: f64) -> Series<Dd> {
    let mut coefficients = [Dd::ZERO; 41];
    (coefficients[0], coefficients[1]) = (Dd::of(c), Dd::ONE);
    Series::from_coefficients(&coefficients)
}

/// The largest |a_n − b_n|, relative to |b_n| where that is not 0.
fn apart(a: Series<Dd>, b: impl Fn(usize) -> Dd) -> f64 {
    let off = |n: usize| {
        let off = (a.coefficient(n) - b(n)).magnitude();
        if b(n) == Dd::ZERO { off } else { off / b(n).magnitude() }
    };
    (0..=Series::<Dd>::LARGEST_POWER).map(off).fold(0.0, f64::max)
}

#[test]
fn quotients_roots_and_sines_have_the_coefficients_of_their_taylor_series() {
    let (one, two) = (Series::<Dd>::of(1.0), Series::<Dd>::of(2.0));
    // 1/(2 − s) = Σ s^n/2^(n+1)
    let geometric = one / (two - variable(0.0));
    assert!(apart(geometric, |n| Dd::of(libm::scalbn(0.5, -(n as i32)))) < 1e-30);
    // √(1 + s): each coefficient is the last one times (3/2 − n)/n
    let mut binomial = vec![Dd::ONE];
    for n in 1..=40 {
        binomial.push(binomial[n - 1] * Dd::of(1.5 - n as f64) / Dd::of(n as f64));
    }
    assert!(apart(variable(1.0).sqrt(), |n| binomial[n]) < 1e-29);
    // sin(0.3 + s): its derivatives over n!
    let (sine, cosine) = Dd::of(0.3).sin_cos();
    let mut factorial = Dd::ONE;
    let mut derivatives = Vec::new();
    for n in 0..=40 {
        factorial = if n == 0 { factorial } else { factorial * Dd::of(n as f64) };
        derivatives.push([sine, cosine, -sine, -cosine][n % 4] / factorial);
    }
    assert!(apart(variable(0.3).sin_cos().0, |n| derivatives[n]) < 1e-29);
    // a product and its quotient, a square and its root, of a series with every power
    let a = geometric * (variable(0.7) * variable(-0.4)) + one;
    let b = variable(0.3).sin_cos().1 + geometric;
    assert!(apart(a * b / b, |n| a.coefficient(n)) < 1e-26);
    assert!(apart((b * b).sqrt(), |n| b.coefficient(n)) < 1e-26);
}

#[test]
fn numbers_are_series_with_the_bits_of_numbers() {
    let (a, b) = (Series::of(0.1), Series::of(-0.7));
    let (sine, cosine) = a.sin_cos();
    let both = Real::sin_cos(0.1_f64);
    assert_eq!((sine.coefficient(0), cosine.coefficient(0)), both);
    for (found, expected) in
        [(a + b, 0.1 - 0.7), (a - b, 0.1 + 0.7), (a * b, 0.1 * -0.7), (a / b, 0.1 / -0.7), (-a, -0.1)]
    {
        assert_eq!((found.coefficient(0), found.coefficient(1), found.known()), (expected, 0.0, 41));
    }
    assert_eq!(a.sqrt().coefficient(0), 0.1_f64.sqrt());
    assert_eq!(b.magnitude(), 0.7);
}

#[test]
fn no_more_coefficients_are_known_than_of_the_operands() {
    let (three, five) = (Series::from_coefficients(&[1.0, 2.0, 3.0]), Series::from_coefficients(&[1.0; 5]));
    for found in [three + five, three * five, five / three, five.sqrt() * three, three.sin_cos().0 - five] {
        assert_eq!((found.known(), found.coefficient(3)), (3, 0.0));
    }
    assert_eq!((three * Series::of(2.0)).coefficient(2), 6.0);
    assert_eq!(Series::from_coefficients(&[1.0; 50]).known(), 41);
    assert_eq!(Series::<f64>::from_coefficients(&[]).magnitude(), 0.0);
}

#[test]
fn what_is_not_analytic_is_not_finite() {
    let zero = Series::from_coefficients(&[0.0, 1.0]);
    assert!(!(Series::of(1.0) / zero).magnitude().is_finite());
    assert!(!zero.sqrt().magnitude().is_finite());
    assert!(!Series::from_coefficients(&[-1.0, 1.0]).sqrt().magnitude().is_finite());
    assert_eq!(Series::from_coefficients(&[0.0, 0.0]).sqrt().magnitude(), 0.0);
}

#[test]
fn the_time_of_a_law_that_is_evaluated_on_series_goes_on() {
    let at = Clock { start: 2.0, step: 0.5 }.at(3);
    let time: Series<f64> = at.seconds();
    assert_eq!([0, 1, 2].map(|n| time.coefficient(n)), [3.5, 1.0, 0.0]);
    let angle: Series<f64> = Time::from_seconds(100.0).angle(0.25);
    assert!((angle.coefficient(0) - (25.0 - 4.0 * core::f64::consts::TAU)).abs() < 1e-14);
    assert_eq!(angle.coefficient(1), 0.25);
}
