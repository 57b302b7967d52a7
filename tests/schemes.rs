//! Coefficients of every scheme, without any integrator, and what is refused of one's own.

use std::collections::HashSet;
use std::fs;

use polhode::method::SchemeError;
use polhode::method::schemes::{
    ALL, CHIN_4B, Pairs, Part, SABA_2, SRKN_6B, SRKN_11B, SUZUKI_4, Scheme, Stages, scheme,
};
use polhode::num::{Dd, Real};

/// The lists of a scheme, as in coefficients.csv.
fn lists(scheme: &Scheme) -> Vec<(&'static str, &'static [Dd])> {
    match scheme.stages() {
        Stages::Composition(gamma) => vec![("gamma", gamma)],
        Stages::Alternating { a, b, .. } => vec![("a", a), ("b", b)],
        Stages::ForceGradient { a, b, c, .. } => vec![("a", a), ("b", b), ("c", c)],
        Stages::Processed { kernel, processor } => vec![("kernel", kernel), ("processor", processor)],
        Stages::ProcessedAlternating { a, b, processor_a, processor_b, .. } => {
            vec![("kernel-a", a), ("kernel-b", b), ("processor-a", processor_a), ("processor-b", processor_b)]
        }
    }
}

/// The same scheme through the door of users, with another order.
fn claimed(scheme: &Scheme, order: u32) -> Result<Scheme, SchemeError> {
    Scheme::new(scheme.name(), order, scheme.stages(), scheme.source())
}

/// Its coefficients as doubles.
fn as_doubles(scheme: &Scheme) -> Stages {
    let doubles = |values: &[Dd]| -> &'static [Dd] {
        values.iter().map(|value| Dd::of(value.hi())).collect::<Vec<_>>().leak()
    };
    match scheme.stages() {
        Stages::Composition(gamma) => Stages::Composition(doubles(gamma)),
        Stages::Alternating { first, a, b, pairs } => {
            Stages::Alternating { first, a: doubles(a), b: doubles(b), pairs }
        }
        Stages::ForceGradient { first, a, b, c } => {
            Stages::ForceGradient { first, a: doubles(a), b: doubles(b), c: doubles(c) }
        }
        Stages::Processed { kernel, processor } => {
            Stages::Processed { kernel: doubles(kernel), processor: doubles(processor) }
        }
        Stages::ProcessedAlternating { a, b, processor_a, processor_b, pairs } => {
            Stages::ProcessedAlternating {
                a: doubles(a),
                b: doubles(b),
                processor_a: doubles(processor_a),
                processor_b: doubles(processor_b),
                pairs,
            }
        }
    }
}

#[test]
fn every_scheme_passes_the_check_of_users_also_with_doubles_for_coefficients() {
    for scheme in ALL {
        assert_eq!(claimed(scheme, scheme.order()).as_ref(), Ok(scheme));
        let rounded = Scheme::new(scheme.name(), scheme.order(), as_doubles(scheme), scheme.source());
        assert!(rounded.is_ok(), "{}: {rounded:?}", scheme.name());
    }
}

#[test]
fn an_order_that_is_too_high_is_refused_with_the_degree_that_fails() {
    for scheme in ALL {
        let stages = scheme.stages();
        let Err(error) = claimed(scheme, scheme.order() + 2) else { panic!("{} passed", scheme.name()) };
        match error {
            // of near-integrable pairs the last order has to be that of the scheme
            SchemeError::Claim { powers, .. } => assert!(powers.is_some(), "{error}"),
            SchemeError::Order { degree, defect, allowed, .. } => {
                assert_eq!(degree, scheme.order() + 1, "{error}");
                assert!((1e2 * allowed..=1.0).contains(&defect), "{error}");
            }
            _ => panic!("{error} of {stages:?}"),
        }
    }
}

#[test]
fn two_coefficients_out_of_the_air_have_order_2_and_no_more() {
    const A: &[Dd] = &[Dd::sum(0.3, 0.0)];
    const B: &[Dd] = &[Dd::sum(0.9, 0.0)];
    let stages = Stages::Alternating { first: Part::B, a: A, b: B, pairs: Pairs::Any };
    assert!(Scheme::new("mine", 2, stages, "").is_ok());
    let error = Scheme::new("mine", 4, stages, "").unwrap_err();
    let SchemeError::Order { order: 4, degree: 3, of_b: None, defect, .. } = error else { panic!("{error}") };
    // of the word AAB: Σ over flows of A before each kick, ½ a², less 1/6, over the sum of sizes
    let (a, b) = ([0.3, 0.4, 0.3], [0.9, -0.4, -0.4, 0.9]);
    let word = |size: fn(f64) -> f64| {
        let of_a = |n: usize| a[..=n].iter().map(|&a| size(a)).sum::<f64>();
        (0..3).map(|n| size(b[n + 1]) * of_a(n) * of_a(n) / 2.0).sum::<f64>()
    };
    assert!((word(|x| x) - 1.0 / 6.0).abs() / 2.0 < defect && defect < 1.0, "{defect}");
    assert_eq!(
        error.to_string(),
        format!(
            "scheme \"mine\" claims order 4, and its terms of degree 3 in h differ from those of the exact step by {defect:.1e} \
             of their size; a scheme of that order with fifteen digits stays below 1e-14"
        )
    );
}

#[test]
fn a_scheme_is_refused_for_pairs_that_it_is_not_made_for() {
    let for_pairs = |scheme: Scheme, pairs| {
        let Stages::Alternating { first, a, b, .. } = scheme.stages() else { panic!("{scheme:?}") };
        let stages = Stages::Alternating { first, a, b, pairs };
        Scheme::new("mine", scheme.order(), stages, "")
    };
    assert!(matches!(
        for_pairs(SRKN_11B, Pairs::Any),
        Err(SchemeError::Order { degree: 4..=6, of_b: None, .. })
    ));
    assert!(for_pairs(SRKN_6B, Pairs::Nystrom).is_ok());
    assert!(for_pairs(SABA_2, Pairs::Any).is_ok());
    let error = for_pairs(SABA_2, Pairs::NearIntegrable(&[6, 2])).unwrap_err();
    assert!(matches!(error, SchemeError::Order { order: 6, degree: 5, of_b: Some(1), .. }), "{error}");
    for powers in [&[4, 4, 2][..], &[2, 4], &[4], &[], &[60, 2]] {
        let error = for_pairs(SABA_2, Pairs::NearIntegrable(powers)).unwrap_err();
        assert!(matches!(error, SchemeError::Claim { powers: Some(p), .. } if p == powers), "{error}");
    }
}

#[test]
fn what_is_no_scheme_is_refused_by_what_is_wrong_with_it() {
    const NAN: &[Dd] = &[Dd::sum(f64::NAN, 0.0)];
    const HUGE: &[Dd] = &[Dd::sum(1e200, 0.0)];
    let new = |order, stages| Scheme::new("mine", order, stages, "").unwrap_err();
    assert!(
        matches!(new(2, Stages::Composition(NAN)), SchemeError::NotFinite { value, .. } if value.is_nan())
    );
    assert!(matches!(new(4, Stages::Composition(HUGE)), SchemeError::Order { .. }));
    for order in [0, 33, u32::MAX] {
        assert!(matches!(new(order, SUZUKI_4.stages()), SchemeError::Claim { powers: None, .. }));
    }
    let Stages::ForceGradient { first, a, b, c } = CHIN_4B.stages() else { panic!() };
    let wrong = |c| Stages::ForceGradient { first, a, b, c };
    assert!(matches!(new(4, wrong(&[])), SchemeError::Gradients { given: 0, kicks: 1, .. }));
    let twice: &'static [Dd] = vec![c[0] * 2.0].leak();
    assert!(matches!(new(4, wrong(twice)), SchemeError::Order { degree: 3, .. }));
    let processed = |a, processor_b| Stages::ProcessedAlternating {
        a,
        b: &[],
        processor_a: &[],
        processor_b,
        pairs: Pairs::Any,
    };
    let halves: &'static [Dd] = vec![Dd::of(0.5); 2].leak();
    for stages in [processed(halves, &[]), processed(&[], halves)] {
        assert!(matches!(new(2, stages), SchemeError::ProcessedLengths { .. }));
    }
}

#[test]
fn suzuki_has_the_smallest_sum_of_five_stages() {
    let condition = |x: f64, y: f64| {
        let centre = 1.0 - 2.0 * (x + y);
        2.0 * (x * x * x + y * y * y) + centre * centre * centre
    };
    let sum = |x: f64, y: f64| 2.0 * (x.abs() + y.abs()) + (1.0 - 2.0 * (x + y)).abs();
    let suzuki = SUZUKI_4.lengths().unwrap().iter().map(|length| length.hi().abs()).sum::<f64>();
    let bound = 1.0 + 2.0 / (libm::cbrt(16.0) - 1.0);
    assert!((suzuki - bound).abs() < 1e-15, "{suzuki} {bound}");
    let grid = || (-400..=400).map(|n| f64::from(n) / 200.0);
    let (mut solutions, mut smallest) = (0, f64::INFINITY);
    for x in grid() {
        for y in grid() {
            let (mut low, mut high) = (y, y + 1.0 / 200.0);
            if condition(x, low) * condition(x, high) > 0.0 {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if condition(x, low) * condition(x, middle) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            solutions += 1;
            smallest = smallest.min(sum(x, low));
        }
    }
    assert!(solutions > 500, "only {solutions} solutions");
    assert!(smallest > suzuki - 1e-12 && smallest < suzuki + 1e-3, "{smallest} {suzuki}");
}

#[test]
fn steps_are_palindromes_that_add_up_to_one_without_rounding() {
    for scheme in ALL {
        let flows = scheme.flows();
        let palindrome = flows.iter().eq(flows.iter().rev());
        assert_eq!(palindrome, scheme.name() != "processed-6-4", "{}", scheme.name());
        let processor = scheme.processor();
        assert_eq!(processor.is_empty(), !scheme.is_processed(), "{}", scheme.name());
        assert!(processor.windows(2).all(|pair| pair[0].0 != pair[1].0), "{}", scheme.name());
        let sum = scheme.processor_lengths().into_iter().fold(Dd::ZERO, |sum, length| sum + length);
        assert_eq!(sum, Dd::ZERO, "{}", scheme.name());
        assert!(flows.windows(2).all(|pair| pair[0].0 != pair[1].0), "{}", scheme.name());
        for part in [Part::A, Part::B] {
            let shares = || flows.iter().filter(|flow| flow.0 == part).map(|flow| flow.1);
            assert_eq!(shares().fold(Dd::ZERO, |sum, share| sum + share), Dd::ONE, "{}", scheme.name());
            let (even, odd): (Vec<_>, Vec<_>) = shares().enumerate().partition(|(n, _)| n % 2 == 0);
            let sum = even.into_iter().chain(odd).fold(Dd::ZERO, |sum, (_, share)| sum + share);
            assert_eq!(sum, Dd::ONE, "{} in another order", scheme.name());
        }
        let Some(lengths) = scheme.lengths() else {
            assert!(scheme.processor_lengths().is_empty(), "{}", scheme.name());
            continue;
        };
        assert!(lengths.iter().eq(lengths.iter().rev()), "{}", scheme.name());
        assert_eq!(lengths.iter().fold(Dd::ZERO, |sum, &length| sum + length), Dd::ONE, "{}", scheme.name());
        let turns: Vec<Dd> = flows.iter().filter(|flow| flow.0 == Part::A).map(|flow| flow.1).collect();
        assert_eq!(lengths, turns, "{}", scheme.name());
    }
}

#[test]
fn the_numbers_of_flows_are_those_of_the_sources() {
    let alternating = [
        ("mclachlan-s5", 5, 6),
        ("blanes-moan-s6", 6, 7),
        ("blanes-moan-s10", 10, 11),
        ("srkn-6b", 6, 7),
        ("srkn-11b", 11, 12),
        ("srkn-14a", 15, 14),
        ("bce-22", 20, 19),
        ("saba-2", 3, 2),
        ("saba-3", 4, 3),
        ("saba-4", 5, 4),
        ("aba-8-4", 6, 5),
        ("aba-8-6-4", 8, 7),
        ("aba-10-6-4", 9, 8),
        ("chin-4a", 2, 3),
        ("chin-4b", 3, 2),
        ("chin-4c", 4, 3),
        ("omelyan-mryglod-folk-4", 4, 3),
        ("processed-6-4", 2, 2),
    ];
    let composition = [
        ("strang", 1),
        ("yoshida-4", 3),
        ("suzuki-4", 5),
        ("mclachlan-4", 5),
        ("yoshida-6", 7),
        ("kahan-li-6", 9),
        ("sofroniou-spaletta-6", 11),
        ("suzuki-umeno-8", 15),
        ("kahan-li-8", 17),
        ("sofroniou-spaletta-8", 21),
        ("sofroniou-spaletta-10", 35),
        ("blanes-casas-murua-6-11", 11),
        ("blanes-casas-murua-6-13", 13),
        ("blanes-casas-murua-8-13", 13),
        ("blanes-casas-murua-10-23", 23),
    ];
    assert_eq!(alternating.len() + composition.len(), ALL.len());
    for (name, a, b) in alternating {
        let flows = scheme(name).unwrap().flows();
        let number = |part| flows.iter().filter(|flow| flow.0 == part).count();
        assert_eq!((number(Part::A), number(Part::B)), (a, b), "{name}");
    }
    for (name, stages) in composition {
        assert_eq!(scheme(name).unwrap().lengths().unwrap().len(), stages, "{name}");
    }
}

#[test]
fn coefficients_are_those_that_the_sources_print() {
    let path = format!("{}/data/schemes/coefficients.csv", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let mut read = 0;
    for scheme in ALL {
        for (list, values) in lists(scheme) {
            let printed = rows.iter().filter(|row| row[0] == scheme.name() && row[1] == list);
            let printed: Vec<Dd> = printed.map(|row| row[3].parse().unwrap()).collect();
            assert_eq!(values.len(), printed.len(), "{} {list}", scheme.name());
            for (&value, &printed) in values.iter().zip(&printed) {
                // both are rounded: to a multiple of 2^-104, and to the nearest double-double number
                let apart = (value - printed).magnitude();
                assert!(
                    apart <= 0.51 * Dd::ONE.scaled(-104).hi(),
                    "{} {list}: {value} {printed}",
                    scheme.name()
                );
                read += 1;
            }
        }
    }
    assert_eq!(read, rows.len());
}

#[test]
fn names_are_unique_and_found() {
    let names: HashSet<&str> = ALL.iter().map(|scheme| scheme.name()).collect();
    assert_eq!(names.len(), ALL.len());
    for known in ALL {
        assert_eq!(scheme(known.name()), Ok(known));
        assert!(known.name().bytes().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == b'-'));
    }
}

#[test]
fn an_unknown_name_is_refused_with_the_nearest() {
    let misspelled = [
        ("sukuzi-4", "suzuki-4"),
        ("Kahan-Li-8", "kahan-li-8"),
        ("blanesmoan-s10", "blanes-moan-s10"),
        ("sofroniu-spalleta-8", "sofroniou-spaletta-8"),
        ("srkn11b", "srkn-11b"),
        ("aba864", "aba-8-6-4"),
    ];
    for (name, meant) in misspelled {
        let error = scheme(name).unwrap_err();
        assert_eq!((error.name.as_str(), error.nearest), (name, Some(meant)));
    }
    let message = scheme("sukuzi-4").unwrap_err().to_string();
    assert!(
        message.starts_with(
            "there is no scheme \"sukuzi-4\", the nearest is suzuki-4; there are strang, yoshida-4, "
        ),
        "{message}"
    );
    assert!(ALL.iter().all(|scheme| message.contains(scheme.name())), "{message}");
    for name in ["", "gauss", "rk4"] {
        let error = scheme(name).unwrap_err();
        assert_eq!(error.nearest, None, "{name}");
        assert!(error.to_string().starts_with(&format!("there is no scheme {name:?}; there are strang, ")));
    }
}
