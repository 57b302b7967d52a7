//! Order conditions of every scheme, without any integrator.
//!
//! A step is the product of the exponentials of its flows, a series in words of two letters A and B that do not
//! commute; the exact step is exp(A + B), in which every word of d letters has the coefficient 1/d!. A word of d
//! letters stands at the index that its letters spell in binary, A = 0, B = 1, among the 2ᵈ of its degree.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::HashSet;
use std::fs;

use polhode::method::schemes::{
    ALL, BLANES_MOAN_S6, Pairs, Part, SRKN_6B, SRKN_11B, SUZUKI_4, Scheme, Stages, scheme,
};
use polhode::num::{Dd, Real};

/// Coefficients of all words, by degree.
type Series = Vec<Vec<Dd>>;

/// The product of the exponentials of `flows`, a part, its share and the share of [B,[A,B]], up to words of `degree` letters.
fn product(flows: &[(Part, Dd, Dd)], degree: usize) -> Series {
    let mut series: Series = (0..=degree).map(|d| vec![Dd::ZERO; 1 << d]).collect();
    series[0][0] = Dd::ONE;
    for &(part, share, gradient) in flows {
        if gradient != Dd::ZERO {
            times_kick(&mut series, share, gradient);
            continue;
        }
        let letter = usize::from(part == Part::B);
        // a word gains from those that lack its last j letters, if all of these are of this flow; longest first
        for d in (1..=degree).rev() {
            for word in 0..1 << d {
                let mut weight = Dd::ONE;
                let mut sum = series[d][word];
                for j in 1..=d {
                    if (word >> (j - 1)) & 1 != letter {
                        break;
                    }
                    weight = weight * share / j as f64;
                    sum = sum + weight * series[d - j][word >> j];
                }
                series[d][word] = sum;
            }
        }
    }
    series
}

/// The series times the exponential of b B + c [B,[A,B]], which is 2 BAB − ABB − BBA.
fn times_kick(series: &mut Series, b: Dd, c: Dd) {
    let mut power = series.clone();
    for n in 1..series.len() {
        let before = power.clone();
        for d in 0..series.len() {
            for word in 0..1 << d {
                let mut value = Dd::ZERO;
                if d >= 1 && word & 1 == 1 {
                    value = before[d - 1][word >> 1] * b;
                }
                let factor = match word & 0b111 {
                    0b101 => 2.0,
                    0b011 | 0b110 => -1.0,
                    _ => 0.0,
                };
                if d >= 3 && factor != 0.0 {
                    value = value + before[d - 3][word >> 3] * c * factor;
                }
                power[d][word] = value / n as f64;
            }
        }
        for (sum, words) in series.iter_mut().zip(&power) {
            add(sum, words, Dd::ONE);
        }
    }
}

/// The words of `degree` letters in the product less those in exp(A + B).
fn defect(series: &Series, degree: usize) -> Vec<Dd> {
    let exact = (1..=degree).fold(Dd::ONE, |value, d| value / d as f64);
    series[degree].iter().map(|&word| word - exact).collect()
}

fn largest(words: &[Dd]) -> f64 {
    words.iter().fold(0.0, |size, word| size.max(word.magnitude()))
}

/// The logarithm of a series that begins with 1.
fn logarithm(series: &Series) -> Series {
    let degree = series.len() - 1;
    let mut rest = series.clone();
    rest[0][0] = Dd::ZERO;
    let mut power = rest.clone();
    let mut log = rest.clone();
    for n in 2..=degree {
        power = (0..=degree)
            .map(|d| {
                let mut words = vec![Dd::ZERO; 1 << d];
                for left in 1..d {
                    add(&mut words, &concatenated(&power[left], &rest[d - left]), Dd::ONE);
                }
                words
            })
            .collect();
        let weight = Dd::ONE / if n % 2 == 0 { -(n as f64) } else { n as f64 };
        for (sum, words) in log.iter_mut().zip(&power) {
            add(sum, words, weight);
        }
    }
    log
}

fn add(to: &mut [Dd], words: &[Dd], weight: Dd) {
    for (sum, &word) in to.iter_mut().zip(words) {
        *sum = *sum + word * weight;
    }
}

fn concatenated(left: &[Dd], right: &[Dd]) -> Vec<Dd> {
    left.iter().flat_map(|&x| right.iter().map(move |&y| x * y)).collect()
}

fn bracket(x: &[Dd], y: &[Dd]) -> Vec<Dd> {
    let mut words = concatenated(x, y);
    add(&mut words, &concatenated(y, x), -Dd::ONE);
    words
}

fn letter(part: Part) -> Vec<Dd> {
    if part == Part::A { vec![Dd::ONE, Dd::ZERO] } else { vec![Dd::ZERO, Dd::ONE] }
}

/// Brackets of degree `d` that vanish if A is quadratic in the momenta and B a function of the attitude.
///
/// A bracket of n A's and k B's is of degree n + 1 − k in the momenta. Those with k = n + 1 are functions of the
/// attitude and commute: [B,[B,[B,A]]] = 0 is the first case. What follows from it is found by brackets with A and B.
fn vanishing(d: usize) -> Vec<Vec<Dd>> {
    if d < 4 {
        return Vec::new();
    }
    let shorter = vanishing(d - 1);
    let mut all: Vec<Vec<Dd>> = [Part::A, Part::B]
        .iter()
        .flat_map(|&part| shorter.iter().map(move |words| bracket(&letter(part), words)))
        .collect();
    for left in (1..d).filter(|left| 2 * left <= d) {
        let (x, y) = (of_attitude(left), of_attitude(d - left));
        all.extend(x.iter().flat_map(|x| y.iter().map(move |y| bracket(x, y))));
    }
    orthonormal(all)
}

/// Brackets of degree `d` with one B more than A: those nested to the right span them.
fn of_attitude(d: usize) -> Vec<Vec<Dd>> {
    let words = (0..1_usize << d).filter(|word| 2 * word.count_ones() as usize == d + 1);
    orthonormal(words.map(|word| nested(word, d)).collect())
}

/// [X₁,[X₂,[…, X_d]]] of the letters of a word.
fn nested(word: usize, d: usize) -> Vec<Dd> {
    let at = |n: usize| letter(if (word >> n) & 1 == 1 { Part::B } else { Part::A });
    (1..d).fold(at(0), |inner, n| bracket(&at(n), &inner))
}

fn dot(x: &[Dd], y: &[Dd]) -> Dd {
    x.iter().zip(y).fold(Dd::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// What `basis`, of orthogonal unit vectors, cannot make of `words`; twice, so that rounding does not leave a part.
fn residual(words: &[Dd], basis: &[Vec<Dd>]) -> Vec<Dd> {
    let mut rest = words.to_vec();
    for unit in basis.iter().chain(basis) {
        let share = dot(&rest, unit);
        add(&mut rest, unit, -share);
    }
    rest
}

/// Orthogonal unit vectors that span the same space. The vectors are combinations of a few words with small
/// integers, so what is left of one that depends on the others is rounding alone.
fn orthonormal(vectors: Vec<Vec<Dd>>) -> Vec<Vec<Dd>> {
    let mut basis: Vec<Vec<Dd>> = Vec::new();
    for words in vectors {
        let rest = residual(&words, &basis);
        let size = dot(&rest, &rest).sqrt();
        if size.hi() > 1e-12 * dot(&words, &words).sqrt().hi() {
            basis.push(rest.iter().map(|&word| word / size).collect());
        }
    }
    basis
}

/// A defect beyond the order must be at least this large: the smallest of all schemes is that of aba-10-6-4.
const VISIBLE: f64 = 1e-11;

/// All flows of one step: of the processor, of the kernel, and of the inverse of the processor.
fn whole(scheme: &Scheme) -> Vec<(Part, Dd, Dd)> {
    let processor = scheme.processor();
    let inverse = processor.iter().rev().map(|&(part, share)| (part, -share));
    let mut gradients = scheme.gradients().into_iter();
    let mut with_gradient = |(part, share)| {
        let gradient = if part == Part::B { gradients.next() } else { None };
        (part, share, gradient.unwrap_or(Dd::ZERO))
    };
    let kernel: Vec<_> = scheme.flows().into_iter().map(&mut with_gradient).collect();
    assert!(gradients.next().is_none());
    let plain = |(part, share)| (part, share, Dd::ZERO);
    processor.iter().copied().map(plain).chain(kernel).chain(inverse.map(plain)).collect()
}

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

/// What contradicts the order of a scheme, if anything does.
fn contradiction(scheme: &Scheme) -> Option<String> {
    let pairs = match scheme.stages {
        Stages::Composition(_) | Stages::Processed { .. } | Stages::ForceGradient { .. } => Pairs::Any,
        Stages::Alternating { pairs, .. } | Stages::ProcessedAlternating { pairs, .. } => pairs,
    };
    let flows = whole(scheme);
    let order = scheme.order as usize;
    let below = |size: f64, what: &str, d: usize| {
        (size > floor(scheme)).then(|| format!("{}: {what} of degree {d} is {size:e}", scheme.name))
    };
    let above = |size: f64, what: &str, d: usize| {
        (size < VISIBLE).then(|| format!("{}: {what} of degree {d} is only {size:e}", scheme.name))
    };
    match pairs {
        Pairs::Any => {
            let series = product(&flows, order + 1);
            (1..=order)
                .find_map(|d| below(largest(&defect(&series, d)), "the defect", d))
                .or_else(|| above(largest(&defect(&series, order + 1)), "the defect", order + 1))
        }
        Pairs::Nystrom => {
            let series = product(&flows, order + 1);
            let log = logarithm(&series);
            let left = |d: usize| largest(&residual(&log[d], &vanishing(d)));
            let needed = (2..=order).map(|d| largest(&log[d])).fold(0.0, f64::max);
            below(largest(&defect(&series, 1)), "the defect", 1)
                .or_else(|| (2..=order).find_map(|d| below(left(d), "the part that does not vanish", d)))
                .or_else(|| above(left(order + 1), "the part that does not vanish", order + 1))
                .or_else(|| above(needed, "the part that vanishes for these pairs alone, up to that", order))
        }
        Pairs::NearIntegrable(powers) | Pairs::NearIntegrableNystrom(powers) => {
            let nystrom = matches!(pairs, Pairs::NearIntegrableNystrom(_));
            let highest = powers[0] as usize;
            if powers.last() != Some(&scheme.order) || !powers.is_sorted_by(|p, q| p > q) {
                return Some(format!("{}: order {order} of {powers:?}", scheme.name));
            }
            let series = product(&flows, highest + 1);
            let log = logarithm(&series);
            let left = |d: usize| largest(&residual(&log[d], &vanishing(d)));
            let with = |k: usize, d: usize| {
                let words = defect(&series, d).into_iter().enumerate();
                let with = words.filter(|(word, _)| word.count_ones() as usize == k);
                largest(&with.map(|(_, value)| value).collect::<Vec<_>>())
            };
            let power = |k: usize| powers[k.min(powers.len()) - 1] as usize;
            // what vanishes has three letters B at least
            let (last, most) = if nystrom { (order, powers.len()) } else { (1, highest) };
            let within = |k: usize, d: usize| {
                below(with(k, d), &format!("the defect with {k} letters B"), d)
                    .filter(|_| k == 0 || d <= power(k))
            };
            let beyond = |k: usize| {
                above(with(k, power(k) + 1), &format!("the defect with {k} letters B"), power(k) + 1)
            };
            (1..=highest)
                .find_map(|d| (0..=d.min(most)).find_map(|k| within(k, d)))
                .or_else(|| (2..=last).find_map(|d| below(left(d), "the part that does not vanish", d)))
                .or_else(|| above(if nystrom { with(3, 4) } else { 1.0 }, "the part that vanishes", 4))
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
        let parts = [Part::A, Part::B].map(letter);
        let shorter = vanishing(d - 1);
        let follows = parts.iter().flat_map(|part| shorter.iter().map(move |words| bracket(part, words)));
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
    let with = |scheme: Scheme, pairs| match scheme.stages {
        Stages::Alternating { first, a, b, .. } => {
            Scheme { stages: Stages::Alternating { first, a, b, pairs }, ..scheme }
        }
        _ => panic!("{} has no pairs", scheme.name),
    };
    let wrong = [
        with(SRKN_11B, Pairs::Any),
        with(SRKN_6B, Pairs::Nystrom),
        with(BLANES_MOAN_S6, Pairs::Nystrom),
        with(BLANES_MOAN_S6, Pairs::NearIntegrable(&[6, 4])),
    ];
    for scheme in wrong {
        assert!(contradiction(&scheme).is_some(), "{scheme:?} passed");
    }
}

/// The lists of a scheme, as in coefficients.csv.
fn lists(scheme: &Scheme) -> Vec<(&'static str, &'static [Dd])> {
    match scheme.stages {
        Stages::Composition(gamma) => vec![("gamma", gamma)],
        Stages::Alternating { a, b, .. } => vec![("a", a), ("b", b)],
        Stages::ForceGradient { a, b, c, .. } => vec![("a", a), ("b", b), ("c", c)],
        Stages::Processed { kernel, processor } => vec![("kernel", kernel), ("processor", processor)],
        Stages::ProcessedAlternating { a, b, processor_a, processor_b, .. } => {
            vec![("kernel-a", a), ("kernel-b", b), ("processor-a", processor_a), ("processor-b", processor_b)]
        }
    }
}

/// The scheme with one of its coefficients changed.
fn spoiled(scheme: &Scheme, list: &str, n: usize, by: f64) -> Scheme {
    let changed = |name: &str, values: &[Dd]| -> &'static [Dd] {
        let mut values = values.to_vec();
        if name == list {
            values[n] = values[n] + by;
        }
        values.leak()
    };
    let stages = match scheme.stages {
        Stages::Composition(gamma) => Stages::Composition(changed("gamma", gamma)),
        Stages::Alternating { first, a, b, pairs } => {
            Stages::Alternating { first, a: changed("a", a), b: changed("b", b), pairs }
        }
        Stages::ForceGradient { first, a, b, c } => {
            Stages::ForceGradient { first, a: changed("a", a), b: changed("b", b), c: changed("c", c) }
        }
        Stages::Processed { kernel, processor } => Stages::Processed {
            kernel: changed("kernel", kernel),
            processor: changed("processor", processor),
        },
        Stages::ProcessedAlternating { a, b, processor_a, processor_b, pairs } => {
            Stages::ProcessedAlternating {
                a: changed("kernel-a", a),
                b: changed("kernel-b", b),
                processor_a: changed("processor-a", processor_a),
                processor_b: changed("processor-b", processor_b),
                pairs,
            }
        }
    };
    Scheme { stages, ..*scheme }
}

#[test]
fn one_wrong_digit_is_noticed() {
    let mut spoilt = 0;
    for scheme in ALL {
        for (list, values) in lists(scheme) {
            for n in 0..values.len() {
                // where two lengths nearly agree, exchanging a little between them changes little
                let wrong = spoiled(scheme, list, n, 1e6 * floor(scheme));
                assert!(contradiction(&wrong).is_some(), "{} {list} {n}", scheme.name);
                spoilt += 1;
            }
        }
    }
    assert!(spoilt > 100, "only {spoilt} coefficients");
}

#[test]
fn srkn_6b_is_for_nystrom_systems_although_its_order_is_not() {
    let errors = |scheme: &Scheme| {
        let log = logarithm(&product(&whole(scheme), 5));
        (largest(&log[5]), largest(&residual(&log[5], &vanishing(5))))
    };
    let (srkn, s6) = (errors(&SRKN_6B), errors(&BLANES_MOAN_S6));
    assert!(srkn.0 > 2.0 * s6.0 && srkn.1 < 0.2 * s6.1, "{srkn:?} {s6:?}");
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
        assert_eq!(palindrome, scheme.name != "processed-6-4", "{}", scheme.name);
        let processor = scheme.processor();
        assert_eq!(processor.is_empty(), !scheme.is_processed(), "{}", scheme.name);
        assert!(processor.windows(2).all(|pair| pair[0].0 != pair[1].0), "{}", scheme.name);
        let sum = scheme.processor_lengths().into_iter().fold(Dd::ZERO, |sum, length| sum + length);
        assert_eq!(sum, Dd::ZERO, "{}", scheme.name);
        assert!(flows.windows(2).all(|pair| pair[0].0 != pair[1].0), "{}", scheme.name);
        for part in [Part::A, Part::B] {
            let shares = || flows.iter().filter(|flow| flow.0 == part).map(|flow| flow.1);
            assert_eq!(shares().fold(Dd::ZERO, |sum, share| sum + share), Dd::ONE, "{}", scheme.name);
            let (even, odd): (Vec<_>, Vec<_>) = shares().enumerate().partition(|(n, _)| n % 2 == 0);
            let sum = even.into_iter().chain(odd).fold(Dd::ZERO, |sum, (_, share)| sum + share);
            assert_eq!(sum, Dd::ONE, "{} in another order", scheme.name);
        }
        let Some(lengths) = scheme.lengths() else {
            assert!(scheme.processor_lengths().is_empty(), "{}", scheme.name);
            continue;
        };
        assert!(lengths.iter().eq(lengths.iter().rev()), "{}", scheme.name);
        assert_eq!(lengths.iter().fold(Dd::ZERO, |sum, &length| sum + length), Dd::ONE, "{}", scheme.name);
        let turns: Vec<Dd> = flows.iter().filter(|flow| flow.0 == Part::A).map(|flow| flow.1).collect();
        assert_eq!(lengths, turns, "{}", scheme.name);
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
    let path = format!("{}/tests/data/schemes/coefficients.csv", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let mut read = 0;
    for scheme in ALL {
        for (list, values) in lists(scheme) {
            let printed = rows.iter().filter(|row| row[0] == scheme.name && row[1] == list);
            let printed: Vec<Dd> = printed.map(|row| row[3].parse().unwrap()).collect();
            assert_eq!(values.len(), printed.len(), "{} {list}", scheme.name);
            for (&value, &printed) in values.iter().zip(&printed) {
                // both are rounded: to a multiple of 2^-104, and to the nearest double-double number
                let apart = (value - printed).magnitude();
                assert!(
                    apart <= 0.51 * Dd::ONE.scaled(-104).hi(),
                    "{} {list}: {value} {printed}",
                    scheme.name
                );
                read += 1;
            }
        }
    }
    assert_eq!(read, rows.len());
}

#[test]
fn names_are_unique_and_found() {
    let names: HashSet<&str> = ALL.iter().map(|scheme| scheme.name).collect();
    assert_eq!(names.len(), ALL.len());
    for known in ALL {
        assert_eq!(scheme(known.name), Ok(known));
        assert!(known.name.bytes().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == b'-'));
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
    assert!(ALL.iter().all(|scheme| message.contains(scheme.name)), "{message}");
    for name in ["", "gauss", "rk4"] {
        let error = scheme(name).unwrap_err();
        assert_eq!(error.nearest, None, "{name}");
        assert!(error.to_string().starts_with(&format!("there is no scheme {name:?}; there are strang, ")));
    }
}
