//! Conditions of order of every scheme, to the last digit of its source.

use super::quotient::{LETTERS, bracket, logarithm, nested, orthonormal, product, residual, vanishing};
use super::words::flows;
use super::{Defect, claimed, defects_of_flows, pairs};
use crate::method::schemes::{ALL, BLANES_MOAN_S6, Pairs, SRKN_6B, SRKN_11B, SUZUKI_4, Scheme, Stages};
use crate::num::{Dd, Real};

/// A defect beyond the order must be at least this large: the smallest of all schemes is that of aba-10-6-4.
const VISIBLE: f64 = 1e-11;

/// How well the coefficients can satisfy their conditions: to a unit in the last decimal that their source prints, or
/// to the rounding of the words if that is larger.
fn floor(scheme: &Scheme) -> f64 {
    match scheme.name {
        "blanes-moan-s6" | "blanes-moan-s10" | "srkn-6b" | "srkn-11b" | "srkn-14a" => 1e-15,
        "yoshida-6" | "kahan-li-6" | "suzuki-umeno-8" | "kahan-li-8" => 1e-26,
        "bce-22" | "blanes-casas-murua-8-13" | "blanes-casas-murua-10-23" => 1e-30,
        _ => 1e-31,
    }
}

fn largest(words: &[Dd]) -> f64 {
    words.iter().fold(0.0, |size, word| size.max(word.magnitude()))
}

fn with_pairs(scheme: Scheme, pairs: Pairs) -> Scheme {
    let Stages::Alternating { first, a, b, .. } = scheme.stages else { return scheme };
    Scheme { stages: Stages::Alternating { first, a, b, pairs }, ..scheme }
}

/// What contradicts the order of a scheme, if anything does. A composition is looked at over Strang's map.
fn contradiction(scheme: &Scheme) -> Option<String> {
    let flows = flows(scheme);
    let pairs = pairs(scheme).unwrap_or(Pairs::Any);
    let (order, power) = (scheme.order as usize, |of_b: usize| claimed(scheme, of_b));
    let below = |degree: usize| {
        let found = defects_of_flows(&flows, pairs, degree, |of_b| degree <= power(of_b));
        let wrong = found.into_iter().find(|defect| defect.size.is_nan() || defect.size > floor(scheme));
        wrong.map(|Defect { of_b, size, .. }| {
            format!("{}: {of_b:?} letters B of degree {degree}: {size:e}", scheme.name)
        })
    };
    let above = |pairs, degree, asked: &dyn Fn(usize) -> bool| {
        let found = defects_of_flows(&flows, pairs, degree, asked);
        let size = found.iter().fold(0.0, |largest: f64, defect| largest.max(defect.size));
        (size < VISIBLE).then(|| format!("{}: {pairs:?} of degree {degree}: only {size:e}", scheme.name))
    };
    // for these pairs alone
    let needed = || {
        let invisible: Option<Vec<_>> =
            (4..=order).map(|degree| above(Pairs::Any, degree, &|of_b| of_b >= 3)).collect();
        invisible.map(|all| all.concat())
    };
    let contradicted = (1..=power(1)).find_map(below);
    match pairs {
        Pairs::Any => contradicted.or_else(|| above(pairs, order + 1, &|_| true)),
        Pairs::Nystrom => contradicted.or_else(|| above(pairs, order + 1, &|_| true)).or_else(needed),
        Pairs::NearIntegrable(powers) | Pairs::NearIntegrableNystrom(powers) => {
            let nystrom = matches!(pairs, Pairs::NearIntegrableNystrom(_));
            let beyond = |k: usize| above(pairs, power(k) + 1, &|of_b| of_b == k);
            contradicted
                .or_else(|| nystrom.then(needed).flatten())
                .or_else(|| (1..=powers.len()).find_map(beyond))
        }
    }
}

#[test]
fn what_vanishes_below_degree_8_follows_from_one_bracket() {
    let source = nested(0b1110, 4);
    assert_eq!(source.iter().filter(|word| word.magnitude() > 0.0).count(), 4);
    assert!((1..4).all(|d| vanishing(d).is_empty()));
    assert_eq!(vanishing(4).len(), 1);
    assert!(largest(&residual(&source, &vanishing(4))) < 1e-30);
    for d in 5..8 {
        let shorter = vanishing(d - 1);
        let follows = LETTERS.iter().flat_map(|part| shorter.iter().map(move |words| bracket(part, words)));
        assert_eq!(vanishing(d).len(), orthonormal(follows.collect()).len(), "degree {d}");
    }
}

#[test]
fn every_scheme_has_its_order_and_no_higher_one() {
    for scheme in ALL {
        assert_eq!(contradiction(scheme), None);
    }
}

#[test]
fn a_wrong_order_or_pair_of_flows_is_noticed() {
    for wrong in [2, 6] {
        assert!(contradiction(&Scheme { order: wrong, ..SUZUKI_4 }).is_some());
    }
    let wrong = [
        with_pairs(SRKN_11B, Pairs::Any),
        with_pairs(SRKN_6B, Pairs::Nystrom),
        with_pairs(BLANES_MOAN_S6, Pairs::Nystrom),
        with_pairs(BLANES_MOAN_S6, Pairs::NearIntegrable(&[6, 4])),
    ];
    for scheme in wrong {
        assert!(contradiction(&scheme).is_some(), "{scheme:?} passed");
    }
}

/// The scheme with the n-th of all its coefficients changed; `None` beyond the last.
fn spoiled(scheme: &Scheme, n: usize, by: f64) -> Option<Scheme> {
    let mut left = n as isize;
    let mut changed = |values: &[Dd]| -> &'static [Dd] {
        let mut values = values.to_vec();
        if let Some(value) = usize::try_from(left).ok().and_then(|n| values.get_mut(n)) {
            *value = *value + by;
        }
        left -= values.len() as isize;
        values.leak()
    };
    let stages = match scheme.stages {
        Stages::Composition(gamma) => Stages::Composition(changed(gamma)),
        Stages::Alternating { first, a, b, pairs } => {
            Stages::Alternating { first, a: changed(a), b: changed(b), pairs }
        }
        Stages::ForceGradient { first, a, b, c } => {
            Stages::ForceGradient { first, a: changed(a), b: changed(b), c: changed(c) }
        }
        Stages::Processed { kernel, processor } => {
            Stages::Processed { kernel: changed(kernel), processor: changed(processor) }
        }
        Stages::ProcessedAlternating { a, b, processor_a, processor_b, pairs } => {
            Stages::ProcessedAlternating {
                a: changed(a),
                b: changed(b),
                processor_a: changed(processor_a),
                processor_b: changed(processor_b),
                pairs,
            }
        }
    };
    (left < 0).then_some(Scheme { stages, ..*scheme })
}

#[test]
fn one_wrong_digit_is_noticed() {
    let mut spoilt = 0;
    for scheme in ALL {
        // where two lengths nearly agree, exchanging a little between them changes little
        for wrong in (0..).map_while(|n| spoiled(scheme, n, 1e6 * floor(scheme))) {
            assert!(contradiction(&wrong).is_some(), "{wrong:?}");
            spoilt += 1;
        }
    }
    assert!(spoilt > 100, "only {spoilt} coefficients");
}

#[test]
fn srkn_6b_is_for_nystrom_systems_although_its_order_is_not() {
    let errors = |scheme: &Scheme| {
        let log = logarithm(&product(&flows(scheme), 5));
        (largest(&log[5]), largest(&residual(&log[5], &vanishing(5))))
    };
    let (srkn, s6) = (errors(&SRKN_6B), errors(&BLANES_MOAN_S6));
    assert!(srkn.0 > 2.0 * s6.0 && srkn.1 < 0.2 * s6.1, "{srkn:?} {s6:?}");
}
