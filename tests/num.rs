//! Numbers against mpmath (tests/data/num/generate.py), and the accuracy tables in their documentation.

use polhode::num::elliptic::{Modulus, incomplete, jacobi, r_c, r_d, r_f, r_j};
use polhode::num::{Compensated, Dd, Expansion, Precise, Real, add_carried, trig};
use proptest::prelude::*;

// ---------------------------------------------------------------------------------------- fixtures

struct Row {
    function: String,
    regime: String,
    inputs: Vec<f64>,
    value: Dd,
}

fn rows(text: &str) -> Vec<Row> {
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let inputs = fields[2..fields.len() - 1].iter().map(|field| field.parse().unwrap()).collect();
        let value = fields[fields.len() - 1].parse().unwrap();
        Row { function: fields[0].to_owned(), regime: fields[1].to_owned(), inputs, value }
    };
    text.lines().skip(1).map(row).collect()
}

fn relative_error(x: Dd, value: Dd) -> f64 {
    if x == value { 0.0 } else { ((x - value) / value).hi().abs() }
}

fn significant(error: f64) -> String {
    if error < 1e4 { format!("{error:.2}") } else { format!("{error:.1e}") }
}

/// The worst of several columns of errors, by row title, in the order of first appearance.
#[derive(Default)]
struct Worst(Vec<(String, Vec<f64>)>);

impl Worst {
    fn record(&mut self, title: String, errors: &[f64]) {
        assert!(errors.iter().all(|error| error.is_finite()), "{title}: {errors:?}");
        match self.0.iter_mut().find(|(known, _)| *known == title) {
            Some((_, worst)) => {
                worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(*error))
            }
            None => self.0.push((title, errors.to_vec())),
        }
    }

    fn table(&self, head: &str) -> String {
        let columns = head.lines().last().unwrap_or_default().matches('|').count() - 1;
        let mut text = format!("{head}\n{}|\n", "|---".repeat(columns));
        for (title, errors) in &self.0 {
            let cells: Vec<String> = errors.iter().map(|&error| significant(error)).collect();
            text += &format!("| {title} | {} |\n", cells.join(" | "));
        }
        text
    }

    fn assert_below(&self, bounds: &[f64]) {
        for (title, errors) in &self.0 {
            assert!(errors.iter().zip(bounds).all(|(error, bound)| error <= bound), "{title}: {errors:?}");
        }
    }
}

// ---------------------------------------------------------------------------------- accuracy tables

fn dd_errors() -> Worst {
    let mut worst = Worst::default();
    for row in rows(include_str!("data/num/dd.csv")) {
        let a = Dd::sum(row.inputs[0], row.inputs[1]);
        let b = Dd::sum(row.inputs[2], row.inputs[3]);
        let x = match row.function.as_str() {
            "add" => a + b,
            "mul" => a * b,
            "div" => a / b,
            "sqrt" => a.sqrt(),
            "sin" => a.sin_cos().0,
            "cos" => a.sin_cos().1,
            "atan2" => a.atan2(b),
            "exp" => a.exp(),
            "exp_m1" => a.exp_m1(),
            "ln" => a.ln(),
            other => panic!("unknown function {other}"),
        };
        let title = format!("`{}` | {}", row.function, row.regime);
        worst.record(title, &[relative_error(x, row.value) * 1e32]);
    }
    worst
}

fn integral_errors() -> Worst {
    let mut worst = Worst::default();
    for row in rows(include_str!("data/num/elliptic.csv")) {
        let narrow = integral(&row.function, row.inputs.clone());
        let wide = integral(&row.function, row.inputs.iter().map(|&x| Dd::from(x)).collect());
        if let (Some(narrow), Some(wide)) = (narrow, wide) {
            let errors = [relative_error(narrow, row.value) * 1e16, relative_error(wide, row.value) * 1e32];
            worst.record(format!("`{}` | {}", row.function, row.regime), &errors);
        }
    }
    worst
}

fn integral<S: Precise>(function: &str, inputs: Vec<S>) -> Option<Dd> {
    let [a, b, c, d] = inputs[..] else { panic!("four inputs expected") };
    let value = match function {
        "r_f" => r_f(a, b, c),
        "r_c" => r_c(a, b),
        "r_j" => r_j(a, b, c, d),
        "r_d" => r_d(a, b, c),
        "quarter_period" => Modulus::new(a).quarter_period(),
        "incomplete" => {
            let (cn, m1) = (a.to_dd(), b.to_dd());
            let sn = ((Dd::ONE - cn) * (Dd::ONE + cn)).sqrt();
            incomplete(S::from_dd(sn), a, S::from_dd(Dd::ONE - m1), b)
        }
        _ => return None,
    };
    Some(value.to_dd())
}

/// Errors of sn, cn, dn, and the same divided by 1 + |u f'(u)/f(u)|, which is what a last-place error of u does.
fn function_errors() -> Worst {
    let mut worst = Worst::default();
    for row in rows(include_str!("data/num/elliptic.csv")) {
        let Some(k) = ["sn", "cn", "dn"].iter().position(|name| *name == row.function) else {
            continue;
        };
        let (u, m1) = (row.inputs[0], row.inputs[1]);
        let (wide_u, wide_m1) = (Dd::from(u), Dd::from(m1));
        let [sn, cn, dn] = <[Dd; 3]>::from(jacobi(wide_u, wide_m1)).map(Dd::hi);
        let slope = [cn * dn / sn, sn * dn / cn, (1.0 - m1) * sn * cn / dn][k];
        let condition = 1.0 + (u * slope).abs();
        let mut record = |name: &str, narrow: (f64, f64, f64), wide: (Dd, Dd, Dd)| {
            let narrow = relative_error(<[f64; 3]>::from(narrow)[k].into(), row.value) * 1e16;
            let wide = relative_error(<[Dd; 3]>::from(wide)[k], row.value) * 1e32;
            let errors = [narrow, narrow / condition, wide, wide / condition];
            worst.record(format!("`{name}` | {} | {}", row.function, row.regime), &errors);
        };
        record("jacobi", jacobi(u, m1), jacobi(wide_u, wide_m1));
        if !row.regime.starts_with("u to") {
            record("sn_cn_dn", Modulus::new(m1).sn_cn_dn(u), Modulus::new(wide_m1).sn_cn_dn(wide_u));
        }
    }
    worst.0.sort_by(|(a, _), (b, _)| a.split(" | ").next().cmp(&b.split(" | ").next()));
    worst
}

fn ulps(x: f64, value: Dd) -> f64 {
    let size = value.hi().abs();
    ((value - x).hi() / (size.next_up() - size)).abs()
}

const GOLDEN_RATIO: f64 = 1.618_033_988_749_895;

const ANGLES: [(&str, f64, f64); 6] = [
    ("0 to 0.1", 0.0, 0.1),
    ("0.1 to 0.3", 0.1, 0.3),
    ("0.3 to π/4", 0.3, core::f64::consts::FRAC_PI_4),
    ("π/4 to 10", core::f64::consts::FRAC_PI_4, 10.0),
    ("10 to 2²⁰", 10.0, 1_048_576.0),
    ("2²⁰ to 1e15", 1_048_576.0, 1e15),
];

fn trig_errors() -> Worst {
    let mut worst = Worst::default();
    for (range, low, high) in ANGLES {
        for k in 1..=50_000 {
            // multiples of the golden ratio modulo 1 fill an interval evenly
            let x = low + (high - low) * (f64::from(k) * GOLDEN_RATIO).fract();
            let ((sin, cos), (sin_dd, cos_dd)) = (trig::sin_cos(x), Dd::from(x).sin_cos());
            worst.record(range.to_owned(), &[ulps(sin, sin_dd), ulps(cos, cos_dd)]);
        }
    }
    worst
}

/// The documentation's tables: file, text.
fn accuracy_tables() -> [(&'static str, String); 3] {
    let again = "The figures are the same on every machine; `cargo test --test num`\nmeasures them again.";
    let dd = dd_errors().table("| function | arguments | largest relative error, 1e-32 |");
    let trig = trig_errors().table("| x | sin, ulp | cos, ulp |");
    let integrals = integral_errors().table("| integral | arguments | `f64`, 1e-16 | `Dd`, 1e-32 |");
    let functions = function_errors().table(
        "| by | function | arguments | `f64`, 1e-16 | … over condition | `Dd`, 1e-32 | … over condition |",
    );
    let dd = format!(
        "Against mpmath with 150 digits, at the arguments of tests/data/num/dd.csv; 0.00 means the nearest number\n\
         everywhere. {again}\n\n{dd}"
    );
    let trig = format!("Against `Dd`, at 50 000 arguments spread evenly over each range. {again}\n\n{trig}");
    let elliptic = format!(
        "Largest relative errors against mpmath with 150 digits, at the arguments of\n\
         tests/data/num/elliptic.csv. {again}\n\n{integrals}\n\
         Functions of u: where u f'(u)/f(u), the condition, is large, the rounding of u alone costs that many units;\n\
         the columns *over condition* are divided by one plus it.\n\n{functions}"
    );
    [("dd", dd), ("trig", trig), ("elliptic", elliptic)]
        .map(|(name, text)| (name, format!("# Measured accuracy\n\n{text}")))
}

#[test]
fn measured_accuracy_is_what_the_documentation_says() {
    for (name, text) in accuracy_tables() {
        let file = format!("{}/../src/num/accuracy/{name}.md", env!("CARGO_MANIFEST_DIR"));
        let documented = std::fs::read_to_string(&file).unwrap();
        assert!(
            documented == text,
            "{name}.md is out of date: cargo test --test num -- --ignored write_accuracy"
        );
    }
}

#[test]
#[ignore = "writes src/num/accuracy/*.md"]
fn write_accuracy_tables() {
    for (name, text) in accuracy_tables() {
        std::fs::write(format!("{}/../src/num/accuracy/{name}.md", env!("CARGO_MANIFEST_DIR")), text)
            .unwrap();
    }
}

#[test]
fn errors_are_a_few_units_in_the_last_place() {
    dd_errors().assert_below(&[7.0]);
    trig_errors().assert_below(&[0.8, 0.8]);
    integral_errors().assert_below(&[9.0, 9.0]);
    function_errors().assert_below(&[f64::INFINITY, 6.5, f64::INFINITY, 6.5]);
}

// -------------------------------------------------------------------------------- double-double numbers

#[test]
fn infinite_undefined_and_zero_parts_do_not_spread() {
    let (inf, one) = (Dd::from(f64::INFINITY), Dd::ONE);
    for x in [
        inf + one,
        inf - one,
        one + inf,
        inf * one,
        inf / one,
        inf.sqrt(),
        inf.exp(),
        inf.ln(),
        one / Dd::ZERO,
    ] {
        assert_eq!(x, inf);
    }
    for x in [inf - inf, inf * Dd::ZERO, -one * inf + inf, Dd::ZERO / Dd::ZERO, (-one).sqrt(), (-one).ln()] {
        assert!(x.hi().is_nan() && x.lo() == 0.0, "{x:?}");
    }
    for x in [one / inf, (-inf).exp(), Dd::ZERO.sqrt(), Dd::ZERO * one] {
        assert_eq!(x, Dd::ZERO);
    }
    let large = Dd::from(1.7e308);
    assert_eq!(large * Dd::ONE, large);
    let root = large.sqrt();
    assert!(relative_error(root * root, large) < 1e-31);
    assert_eq!(large * 2.0, inf);
    assert_eq!(Dd::ZERO.ln(), -inf);
    assert!((-Dd::ZERO * one).hi().is_sign_negative() && (-Dd::ZERO).sqrt().hi().is_sign_negative());
    assert!((-Dd::ZERO).sin_cos().0.hi().is_sign_negative());
    // mpmath 1.3: sin and cos of 2^100, of 2^100 + 2^40 + 1/8 and of the largest double
    let two_100 = Dd::from(2.0).scaled(99);
    for (x, sin, cos) in [
        (two_100, -0.872_183_605_418_267_3, 0.489_178_656_974_721_46),
        (two_100 + libm::exp2(40.0) + 0.125, 0.494_186_201_602_538_6, -0.869_356_082_480_392_5),
        (Dd::from(f64::MAX), 0.004_961_954_789_184_062, -0.999_987_689_426_559_9),
    ] {
        let (s, c) = x.sin_cos();
        assert!((s.hi() - sin).abs() < 1e-15 && (c.hi() - cos).abs() < 1e-15, "{x:?}: {s:?}, {c:?}");
    }
    assert!(inf.sin_cos().0.hi().is_nan() && inf.sin_cos().1.hi().is_nan());
    assert!(trig::sin_cos(f64::NEG_INFINITY).0.is_nan() && trig::sin_cos(f64::NAN).1.is_nan());
}

#[test]
fn angles_of_special_points_are_those_of_f64() {
    let special = [0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for y in special {
        for x in special {
            let (angle, expected) = (Dd::from(y).atan2(Dd::from(x)).hi(), libm::atan2(y, x));
            assert_eq!(angle.to_bits(), expected.to_bits(), "atan2({y}, {x})");
        }
    }
    assert_eq!(Dd::ZERO.atan2(-Dd::ONE), Dd::PI);
    assert_eq!((-Dd::ONE).atan2(Dd::ZERO), -Dd::FRAC_PI_2);
}

#[test]
fn integers_are_exact() {
    let whole = |text: &str| text.parse::<Dd>().unwrap();
    for n in [0, 1, -1, i64::MAX, i64::MIN, (1 << 53) + 1, -(1 << 62) - 1] {
        assert_eq!(Dd::from(n).to_string(), n.to_string());
        assert_eq!(whole(&n.to_string()), Dd::from(n));
    }
    assert_eq!(Dd::from(u64::MAX).to_string(), u64::MAX.to_string());
    // High and low part on either side of an integer or of a half.
    for (x, floor, round) in [
        (Dd::sum(2.0, -1e-20), 1.0, 2.0),
        (Dd::sum(2.5, -1e-20), 2.0, 2.0),
        (Dd::sum(2.5, 1e-20), 2.0, 3.0),
        (Dd::sum(-2.5, 1e-20), -3.0, -2.0),
        (Dd::from(-2.5), -3.0, -3.0),
        (Dd::from(0.499_999_999_999_999_94), 0.0, 0.0),
    ] {
        assert_eq!((x.floor(), x.round()), (Dd::from(floor), Dd::from(round)), "{x:?}");
    }
    let large = Dd::sum(libm::ldexp(1.0, 60), 0.5);
    assert_eq!((large.floor(), large.round()), (Dd::from(1i64 << 60), Dd::from((1i64 << 60) + 1)));
    assert_eq!((-large).round(), Dd::from(-(1i64 << 60) - 1));
    assert_eq!(Dd::from((1i64 << 60) + 3).rem_euclid(4.0), 3.0);
    assert_eq!(Dd::from(-(1i64 << 60) - 1).rem_euclid(4.0), 3.0);
    assert_eq!(Dd::from((1i64 << 60) - 1).rem_euclid(2.0), 1.0);
}

#[test]
fn decimal_text_is_correctly_rounded() {
    let pi = "3.14159265358979323846264338327950288419716939937510582097494459";
    assert_eq!(pi.parse(), Ok(Dd::PI));
    assert_eq!(format!("-{pi}").parse(), Ok(-Dd::PI));
    assert_eq!("1e-1".parse::<Dd>().unwrap(), Dd::ONE / 10.0);
    assert_eq!(Dd::PI.to_string(), &pi[..33]);
    assert_eq!(format!("{:e}", -Dd::PI), format!("-{}e0", &pi[..33]));
    assert_eq!(
        format!("{:.3}|{:>9.4}|{:+.1}|{:.0}", Dd::PI, -Dd::PI, Dd::PI, Dd::from(0.4)),
        "3.142|  -3.1416|+3.1|0"
    );
    assert_eq!(format!("{:.3e} {:.0e}", Dd::PI * 1e10, Dd::from(9.7)), "3.142e10 1e1");
    assert_eq!(Dd::sum(1.0, -1e-20).to_string(), "0.99999999999999999999");
    assert_eq!(Dd::sum(1.0, 1e-40).to_string(), "1");
    assert_eq!(Dd::from(1e-300).to_string(), "1.0000000000000000250590918352088e-300");
    assert_eq!(
        [Dd::ZERO, -Dd::ONE / 0.0, Dd::from(1e22)].map(|x| x.to_string()),
        ["0", "-inf", "10000000000000000000000"]
    );
    for text in ["", "-", "1.2.3", "0x1", "1e", "e5", "1,5"] {
        assert!(text.parse::<Dd>().is_err(), "{text}");
    }
}

proptest! {
    #![proptest_config(crate::cases::usual(500))]

    #[test]
    fn numbers_are_read_as_they_are_written(hi in 0.0..1.0, lo in 0.0..1e-17, exponent in -200..200) {
        let x = Dd::sum(hi, lo) * libm::ldexp(1.0, exponent);
        prop_assert_eq!(format!("{x:.40e}").parse(), Ok(x));
        prop_assert!(relative_error(x.to_string().parse().unwrap(), x) < 1e-31);
    }
}

// ----------------------------------------------------------------------------------- sine and cosine

#[test]
fn sine_and_cosine_of_hard_arguments() {
    for line in include_str!("data/num/trig.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let x: f64 = fields[0].parse().unwrap();
        let (sin, cos) = trig::sin_cos(x);
        for (value, expected) in [(sin, fields[1]), (cos, fields[2])] {
            assert!(ulps(value, expected.parse().unwrap()) < 0.8, "{x}");
        }
    }
}

#[test]
fn sine_and_cosine_are_the_same_bits_everywhere() {
    let mut hash = 0xcbf2_9ce4_8422_2325;
    for k in 0..20_000 {
        let x = (f64::from(k) - 10_000.0) * 0.37 * f64::from(k % 97);
        let (sin, cos) = trig::sin_cos(x);
        for byte in sin.to_le_bytes().into_iter().chain(cos.to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3); // FNV-1a
        }
    }
    assert_eq!(hash, 11_548_464_448_382_015_154);
    let bits = [0.01, -0.1, 0.3, 0.7, 2.0, -30.0, 1e5, 3e6].map(|x| trig::sin_cos(x).0.to_bits());
    assert_eq!(
        bits,
        [
            0x3f84_7aca_e915_e807,
            0xbfb9_8eae_cb8b_cb2c,
            0x3fd2_e9cd_95ba_ba33,
            0x3fe4_9d6e_6946_19b8,
            0x3fed_18f6_ead1_b446,
            0x3fef_9df4_7f1c_903d,
            0x3fa2_4daa_9c52_7e96,
            0xbfec_1c97_2eb2_f878,
        ]
    );
}

// ---------------------------------------------------------------------------------- elliptic functions

#[test]
fn limits_of_the_modulus_are_reached() {
    for m1 in [1e-100, 1e-300, 5e-324] {
        // K = ln(4/√m1) to O(m1 ln m1).
        let (wide, narrow) = (Modulus::new(Dd::from(m1)).quarter_period(), Modulus::new(m1).quarter_period());
        let expected = (Dd::from(16.0).ln() - Dd::from(m1).ln()) * 0.5;
        assert!(relative_error(wide, expected) < if m1 > 1e-290 { 1e-31 } else { 1e-17 }, "{m1}");
        assert!(relative_error(narrow.into(), expected) < 1e-15, "{m1}");
    }
    let separatrix = Modulus::new(0.0);
    assert_eq!(separatrix.quarter_period(), f64::INFINITY);
    assert_eq!(separatrix.sn_cn_dn(-800.0), (-1.0, 0.0, 0.0));
    assert_eq!(separatrix.sn_cn_dn(0.0), (0.0, 1.0, 1.0));
    assert_eq!(incomplete(1.0, 0.0, 1.0, 0.0), f64::INFINITY);
    for m1 in [-1e-3, f64::NAN] {
        let modulus = Modulus::new(m1);
        assert!(modulus.quarter_period().is_nan() && modulus.sn_cn_dn(0.5).1.is_nan());
    }
}

#[test]
fn integrals_of_undefined_arguments_end() {
    assert_eq!(r_f(0.0, 0.0, 1.0), f64::INFINITY);
    assert_eq!([r_c(1.0, 0.0), r_j(1.0, 1.0, 1.0, 0.0), r_d(1.0, 1.0, 0.0)], [f64::INFINITY; 3]);
    assert!(
        [r_f(-1.0, 1.0, 1.0), r_c(f64::NAN, 1.0), r_j(1.0, 1.0, f64::NAN, 1.0), r_d(1.0, -1.0, 1.0)]
            .iter()
            .all(|value| value.is_nan())
    );
    const EXTREMES: [f64; 11] =
        [0.0, -0.0, 1.0, -1.0, 5e-324, 1e-200, 1e200, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    for x in EXTREMES {
        for y in EXTREMES {
            for z in EXTREMES {
                for p in EXTREMES {
                    let values = [r_f(x, y, z), r_c(x, y), r_d(x, y, z), r_j(x, y, z, p)];
                    let good = [x, y, z, p].iter().all(|argument| *argument >= 0.0);
                    assert!(!good || values.iter().all(|value| *value >= 0.0), "{x} {y} {z} {p}: {values:?}");
                }
            }
        }
    }
    assert_eq!(r_f(f64::INFINITY, 1.0, 2.0), 0.0);
}

/// mpmath 1.3 with 60 digits; for R_J the trapezoidal rule in ln t, as its own function errs at 1e±200.
#[test]
fn integrals_keep_their_digits_over_the_range_of_a_double() {
    let (tiny, max) = (5e-324, f64::MAX);
    let off = |value: f64, exact: f64| (value - exact).abs() / exact;
    for (value, exact) in [
        (r_f(max, max, max), 7.458340731200207e-155),
        (r_f(0.0, 1e-300, max), 5.233259742556014e-152),
        (r_f(tiny, tiny, 0.0), 7.066877263035343e161),
        (r_f(tiny, 2.0 * tiny, 3.0 * tiny), 3.270467096968179e161),
        (r_f(0.0, 1e-300, 1e-305), 7.142772450581778e150),
        (r_c(0.0, tiny), 7.066877263035343e161),
        (r_c(max, 0.5 * max), 9.296452386499823e-155),
        (r_d(1e200, 0.0, 1e-200), 3.0000000000000001e100),
        (r_d(1e-150, 2e-150, 1e200), 1.207371936144175e-297),
        (r_j(1e-215, 2e-216, 0.0, 1e153), 2.1413729938255953e-45),
        (r_j(1e200, 1e-200, 0.0, 1.0), 6.928549694398935e-98),
        (r_j(1e-190, 1e-190, 3e-190, 2e-190), 4.56054123043036e284),
        (r_j(1.0, 1e-80, 1e-90, 1e100), 2.8046906424279515e-98),
    ] {
        assert!(off(value, exact) < 2e-15, "{value:e} {exact:e}");
    }
    let [a, b, c] = [1e-215, 2e-216, 0.0].map(Dd::from);
    let exact: Dd = "2.141372993825595274060764630577741e-45".parse().unwrap();
    assert!(relative_error(r_j(a, b, c, Dd::from(1e153)), exact) < 1e-29);
}

#[test]
fn jacobi_stays_on_its_curve_where_no_digit_of_the_place_is_left() {
    for m1 in [0.0, 1e-300, 1e-221, 0.3, 1.0] {
        for u in [1e17, 1e60, 1e200, f64::MAX] {
            let (sn, cn, dn) = jacobi(u, m1);
            assert!(
                (sn * sn + cn * cn - 1.0).abs() < 1e-15 && (0.0..=1.0).contains(&dn),
                "{u} {m1}: {sn} {cn} {dn}"
            );
        }
    }
}

#[test]
fn what_a_sum_cannot_hold_is_carried_to_the_next() {
    let (mut total, mut carry) = (1.0, 0.0);
    for _ in 0..1000 {
        add_carried(&mut total, &mut carry, 1e-17);
    }
    assert_eq!(Dd::sum(total, carry).hi(), 1.0 + 1e-14);
    assert!((Dd::sum(total, carry) - Dd::sum(1.0, 1e-14)).magnitude() < 1e-29);
}

#[test]
fn turns_are_reduced_without_a_rounded_pi() {
    for k in -64..=64 {
        for (rest, low) in [(0.0, 0.0), (1e-17, 1e-30), (3e-3, -1e-4), (-7e-3, 9e-4), (0.0, 1e-300)] {
            let x = f64::from(k) / 128.0 + rest;
            if x.abs() > 0.5 {
                continue;
            }
            let (s, c) = trig::sin_cos_turns(x, low);
            let (sin, cos) = (Dd::TAU * Dd::sum(x, low)).sin_cos();
            let off = (Dd::from(s) - sin).magnitude().max((Dd::from(c) - cos).magnitude());
            assert!(off < 4e-16, "{x} {low}: {off:e}");
        }
    }
    // exact at whole quarters
    let quarters = [
        (0.0, (0.0, 1.0)),
        (0.25, (1.0, 0.0)),
        (0.5, (0.0, -1.0)),
        (-0.25, (-1.0, 0.0)),
        (-0.5, (0.0, -1.0)),
    ];
    for (x, exact) in quarters {
        assert_eq!(trig::sin_cos_turns(x, 0.0), exact, "{x}");
    }
}

#[test]
fn a_sum_of_two_parts_is_exact_next_to_the_end_of_the_range() {
    let sum = Dd::sum(-6.871931e307, f64::MAX);
    assert_eq!(sum.hi(), f64::MAX - 6.871931e307);
    assert_eq!((sum.hi() - f64::MAX) + sum.lo(), -6.871931e307);
    assert_eq!(Dd::sum(f64::MAX, -6.871931e307), sum);
}

// ---------------------------------------------------------------------------- sums and exact expansions

#[test]
fn compensated_sums_lose_nothing() {
    let mut sum = Compensated::new(1.0);
    for term in [1e100, 1.0, -1e100] {
        sum.add(term);
    }
    assert_eq!(sum.value(), 2.0);

    let mut small = Compensated::new(Dd::ONE);
    for _ in 0..1000 {
        small.add(Dd::from(1e-33));
    }
    assert!(relative_error(small.value() - 1.0, Dd::from(1e-30)) < 0.01);

    let (a, b) = ((1_i64 << 53) - 111, (1_i64 << 53) - 1_234_567);
    let (product, rest) = (a as f64).two_prod(b as f64);
    assert_eq!(product as i128 + rest as i128, i128::from(a) * i128::from(b));
    let third = Dd::ONE / 3.0;
    let (product, rest) = third.two_prod(third);
    assert_eq!(product, third * third);
    assert!(rest.hi() != 0.0 && rest.hi().abs() < 1e-32, "{rest}");
}

proptest! {
    #![proptest_config(crate::cases::usual(2000))]

    #[test]
    fn expansions_are_exact(numbers in prop::array::uniform4(-(1_i64 << 39)..1 << 39), shares_a in any::<bool>()) {
        let [a, b, c, d] = numbers;
        let d = if shares_a { a } else { d };
        // (a b − c d)(a + c) fits 128 bits.
        let [ea, eb, ec, ed] = [a, b, c, d].map(|x| Expansion::from(x as f64));
        let exact = &(&(&ea * &eb) - &(&ec * &ed)) * &(&ea + &ec);
        let [a, b, c, d] = [a, b, c, d].map(i128::from);
        let expected = (a * b - c * d) * (a + c);
        let hi = expected as f64;
        let lo = (expected - hi as i128) as f64;
        prop_assert_eq!(exact.sign(), expected.cmp(&0));
        prop_assert!(relative_error(exact.to_dd(), Dd::sum(hi, lo)) <= libm::ldexp(1.0, -105));
    }
}

#[test]
fn an_expansion_tells_the_separatrix_from_its_neighbours() {
    // Δ = m_h² I_l (I_h − I_μ) − m_l² I_h (I_μ − I_l), for moments (1, 2, 4)/7, is zero where m_h² = 2 m_l².
    let seventh = Dd::ONE / 7.0;
    let delta = |low: Dd, high_squared: Dd| {
        let [l, mu, h] = [1.0, 2.0, 4.0].map(|n| Expansion::from(seventh * n));
        let low = Expansion::from(low);
        let first = &(&Expansion::from(high_squared) * &l) * &(&h - &mu);
        &first - &(&(&(&low * &low) * &h) * &(&mu - &l))
    };
    // The square of 106 bits is no double-double number, so the separatrix is missed; that of 0.375 is one.
    let low = Dd::sum(0.3, 1e-18);
    assert!(delta(low, low * low * 2.0).sign().is_ne());
    let short = Dd::from(0.375);
    assert!(delta(short, short * short * 2.0).sign().is_eq());
    assert_eq!(delta(short, short * short * 2.0).to_dd(), Dd::ZERO);
    let next = delta(short, short * short * 2.0 + libm::ldexp(1.0, -100)).to_dd();
    assert!(relative_error(next, seventh * seventh * 2.0 * libm::ldexp(1.0, -100)) < 1e-31);
}

#[test]
fn sine_and_versine_are_right_to_rounding() {
    use polhode::num::trig::{SMALL, sin_versine, sin_versine_small};
    let check = |x: f64, (s, less): (f64, f64), most: f64| {
        let ((sin, _), (half, _)) = (Dd::of(x).sin_cos(), (Dd::of(x) * 0.5).sin_cos());
        let error = |value: f64, exact: Dd| ((Dd::of(value) - exact) / exact).hi().abs() / f64::EPSILON;
        assert!(x == 0.0 && s == 0.0 || error(s, sin) < most, "sin {x:e}: {s:e}");
        // not as 1 − cos, which has fewer digits; the square of the smallest angles leaves the range of a double
        let versine = half * half * 2.0;
        let underflows = versine.hi() < 1e-300 && less < 1e-300;
        assert!(underflows || error(less, versine) < 2.0 * most, "1 - cos {x:e}: {less:e}");
    };
    for n in 0..=20_000 {
        // a grid that meets both ends, and angles down to the smallest
        for x in [SMALL * f64::from(n) / 20_000.0, SMALL * libm::exp2(-f64::from(n) / 19.0)] {
            for x in [x, -x] {
                check(x, sin_versine_small(x), 0.52);
            }
        }
        // across the boundary of the reduction
        let x = 1.5 * f64::from(n) / 20_000.0;
        check(x, sin_versine(x), 0.8);
    }
}

#[test]
fn sinc_and_cosine_of_a_root_are_right_to_rounding() {
    use polhode::num::trig::SMALL;
    for n in 0..=20_000 {
        // both sides of the boundary between the two forms, and angles down to the smallest
        for x in [2.0 * SMALL * f64::from(n) / 20_000.0, SMALL * libm::exp2(-f64::from(n) / 19.0)] {
            let z = x * x;
            let (sinc, c) = z.sinc_cos_of_root();
            let (exact_sinc, exact_cos) = Dd::of(z).sinc_cos_of_root();
            let error = |value: f64, exact: Dd| ((Dd::of(value) - exact) / exact).hi().abs();
            assert!(error(sinc, exact_sinc) < 1.1 * f64::EPSILON, "sinc {x:e}: {sinc:e}");
            assert!(error(c, exact_cos) < 0.53 * f64::EPSILON, "cos {x:e}: {c:e}");
        }
    }
    assert_eq!(0.0.sinc_cos_of_root(), (1.0, 1.0));
    assert_eq!(Dd::ZERO.sinc_cos_of_root(), (Dd::ONE, Dd::ONE));
}
