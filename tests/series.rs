//! Power series of laws, against the coefficients of functions that are known.

use polhode::body::{Clock, Time};
use polhode::num::{Dd, Real, Series, Tape};

const WIDTH: usize = 41;

/// The coefficients of what `law` makes of `c₀ + s` and of s as the time of a law.
fn coefficients<const N: usize>(
    c: f64,
    law: impl FnOnce(Series<Dd>, Series<Dd>) -> [Series<Dd>; N],
) -> [[Dd; WIDTH]; N] {
    let mut tape = Tape::new(WIDTH);
    tape.record(&[Dd::of(c)], |given| law(given[0], Time::from_seconds(0.0).seconds()));
    tape.count_in(1.0);
    tape.push(&[Dd::ONE]);
    (2..WIDTH).for_each(|_| tape.push(&[Dd::ZERO]));
    core::array::from_fn(|k| core::array::from_fn(|n| tape.result(k, n)))
}

/// The largest |a_n − b_n|, relative to |b_n| where that is not 0.
fn apart(a: [Dd; WIDTH], b: impl Fn(usize) -> Dd) -> f64 {
    let off = |n: usize| {
        let off = (a[n] - b(n)).magnitude();
        if b(n) == Dd::ZERO { off } else { off / b(n).magnitude() }
    };
    (0..WIDTH).map(off).fold(0.0, f64::max)
}

#[test]
fn quotients_roots_and_sines_have_the_coefficients_of_their_taylor_series() {
    let (one, two) = (Series::<Dd>::of(1.0), Series::<Dd>::of(2.0));
    // 1/(2 − s) = Σ s^n/2^(n+1), of an argument and of the time
    for found in coefficients(0.0, |s, t| [one / (two - s), one / (two - t)]) {
        assert!(apart(found, |n| Dd::of(libm::scalbn(0.5, -(n as i32)))) < 1e-30);
    }
    // √(1 + s): each coefficient is the last one times (3/2 − n)/n
    let mut binomial = vec![Dd::ONE];
    for n in 1..WIDTH {
        binomial.push(binomial[n - 1] * Dd::of(1.5 - n as f64) / Dd::of(n as f64));
    }
    for found in coefficients(1.0, |s, t| [s.sqrt(), (one + t).sqrt()]) {
        assert!(apart(found, |n| binomial[n]) < 1e-29);
    }
    // sin(0.3 + s): its derivatives over n!
    let (sine, cosine) = Dd::of(0.3).sin_cos();
    let mut factorial = Dd::ONE;
    let mut derivatives = Vec::new();
    for n in 0..WIDTH {
        factorial = if n == 0 { factorial } else { factorial * Dd::of(n as f64) };
        derivatives.push([sine, cosine, -sine, -cosine][n % 4] / factorial);
    }
    for found in coefficients(0.3, |s, t| [s.sin_cos().0, (Series::of(0.3) + t).sin_cos().0]) {
        assert!(apart(found, |n| derivatives[n]) < 1e-29);
    }
    // a product and its quotient, a square and its root, of a series with every power
    let [a, quotient, b, root] = coefficients(0.3, |s, t| {
        let geometric = one / (two - t);
        let a = geometric * ((s + Series::of(0.4)) * (s - Series::of(0.7))) + one;
        let b = s.sin_cos().1 + geometric;
        [a, a * b / b, b, (b * b).sqrt()]
    });
    assert!(apart(quotient, |n| a[n]) < 1e-26);
    assert!(apart(root, |n| b[n]) < 1e-26);
}

/// x' = −x y, y' = x y through (1, 1): both by their sum of 2 and their quotient, whose rate is -2.
#[test]
fn solutions_have_the_coefficients_of_their_series() {
    let (one, two) = (Series::<Dd>::of(1.0), Series::<Dd>::of(2.0));
    let [sum, residual, here] = coefficients(0.0, |_, _| {
        let [x, y] = Series::solution([one, one], |[x, y]| [-(x * y), x * y]).unwrap();
        // x'/x = −y, so that the logarithmic rate of x/y is −(x + y)
        let [ratio] = Series::solution([one], |[ratio]| [-(two * ratio)]).unwrap();
        [x + y, x - ratio * y, x]
    });
    assert!(apart(sum, |n| if n == 0 { Dd::of(2.0) } else { Dd::ZERO }) < 1e-30);
    assert!(apart(residual, |_| Dd::ZERO) < 1e-28);
    assert_eq!([here[0], here[1]], [Dd::ONE, -Dd::ONE]);
    // x' = s, whose rate is an argument
    let [square] = coefficients(0.0, |s, _| Series::solution([one], |_| [s]).unwrap());
    assert!(apart(square, |n| Dd::of([1.0, 0.0, 0.5].get(n).copied().unwrap_or(0.0))) < 1e-30);
    assert!(<f64 as Real>::solution([1.0], |x| x).is_none());
}

#[test]
fn numbers_are_series_with_the_bits_of_numbers() {
    let found = |law: fn(Series<f64>, Series<f64>) -> Series<f64>| {
        let mut tape = Tape::new(3);
        tape.record(&[0.1, -0.7], |given| {
            let [numbers, entries] = [law(Series::of(0.1), Series::of(-0.7)), law(given[0], given[1])];
            assert_eq!(numbers.magnitude(), entries.magnitude());
            [numbers, entries]
        });
        tape.push(&[0.0, 0.0]);
        assert_eq!([tape.result(0, 1), tape.result(1, 1)], [0.0, 0.0]);
        assert_eq!(tape.result(0, 0), tape.result(1, 0));
        tape.result(1, 0)
    };
    let (sine, cosine) = Real::sin_cos(0.1_f64);
    assert_eq!([found(|a, _| a.sin_cos().0), found(|a, _| a.sin_cos().1)], [sine, cosine]);
    assert_eq!([found(|a, b| a + b), found(|a, b| a - b)], [0.1 - 0.7, 0.1 + 0.7]);
    assert_eq!([found(|a, b| a * b), found(|a, b| a / b)], [0.1 * -0.7, 0.1 / -0.7]);
    assert_eq!([found(|a, _| -a), found(|a, _| a.sqrt())], [-0.1, 0.1_f64.sqrt()]);
}

#[test]
fn no_more_coefficients_are_known_than_were_pushed_and_there_is_room_for() {
    let mut tape = Tape::new(3);
    tape.record(&[2.0], |given| [given[0] * given[0]]);
    let found = |tape: &Tape<f64>| [0, 1, 2, 3, 50].map(|n| tape.result(0, n));
    assert_eq!(found(&tape), [4.0, 0.0, 0.0, 0.0, 0.0]);
    tape.push(&[1.0]);
    assert_eq!(found(&tape), [4.0, 4.0, 0.0, 0.0, 0.0]);
    (0..5).for_each(|_| tape.push(&[3.0]));
    assert_eq!(found(&tape), [4.0, 4.0, 13.0, 0.0, 0.0]);
    assert_eq!(tape.result(1, 0), 0.0);
    // recorded anew, nothing is left of what was there
    tape.record(&[5.0], |given| [given[0] + given[0]]);
    assert_eq!(found(&tape), [10.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn what_is_not_analytic_is_not_finite() {
    let zero = |law: fn(Series<f64>) -> Series<f64>, c: f64, slope: f64| {
        let mut tape = Tape::new(3);
        tape.record(&[c], |given| [law(given[0])]);
        tape.push(&[slope]);
        [tape.result(0, 0), tape.result(0, 1)]
    };
    assert!(!zero(|s| Series::of(1.0) / s, 0.0, 1.0)[0].is_finite());
    assert!(!zero(Real::sqrt, 0.0, 1.0)[1].is_finite());
    assert!(!zero(Real::sqrt, -1.0, 1.0)[0].is_finite());
    assert_eq!(zero(Real::sqrt, 0.0, 0.0), [0.0, 0.0]);
    // its root has no series at 0: not the 1 of its first coefficient
    assert!(!zero(|s| s.sinc_cos_of_root().0, 0.0, 1.0)[0].is_finite());
}

/// One law evaluates another while it is recorded, and an entry outlives its tape.
#[test]
fn tapes_are_apart_and_entries_of_no_tape_are_no_numbers() {
    let mut outer = Tape::new(2);
    let mut kept = Series::of(0.0);
    outer.record(&[3.0], |given| {
        let mut inner = Tape::new(2);
        inner.record(&[Dd::of(5.0)], |given| [given[0] * given[0]]);
        kept = given[0] * given[0];
        [kept * Series::of(inner.result(0, 0).hi())]
    });
    outer.push(&[1.0]);
    assert_eq!([outer.result(0, 0), outer.result(0, 1)], [225.0, 150.0]);
    assert!((kept + kept).magnitude().is_nan() && kept.magnitude().is_nan());
    assert!(Time::from_seconds(1.0).seconds::<Series<f64>>().magnitude().is_nan());
}

#[test]
fn the_time_of_a_law_that_is_evaluated_on_series_goes_on() {
    let mut tape = Tape::new(3);
    let at = Clock { start: 2.0, step: 0.5 }.at(3);
    let law = |_: &[Series<f64>]| [at.seconds(), Time::from_seconds(100.0).angle(0.25)];
    // in seconds where nothing else is said
    tape.record(&[], law);
    tape.push(&[]);
    assert_eq!([tape.result(0, 1), tape.result(1, 1)], [1.0, 0.25]);
    tape.record(&[], law);
    tape.count_in(0.5);
    (0..2).for_each(|_| tape.push(&[]));
    assert_eq!([0, 1, 2].map(|n| tape.result(0, n)), [3.5, 0.5, 0.0]);
    assert!((tape.result(1, 0) - (25.0 - 4.0 * core::f64::consts::TAU)).abs() < 1e-14);
    assert_eq!(tape.result(1, 1), 0.125);
}
