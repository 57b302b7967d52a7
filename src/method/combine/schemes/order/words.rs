//! The step of a scheme as a series of words, and the coefficient of one word in it.

use crate::method::schemes::{Part, Scheme};
use crate::num::{Dd, Precise};

/// One flow or map of a step: the exponential of a sum of letters.
///
/// Letters of flows are 0 for A and 1 for B, those of maps their weights 1, 3, 5, ….
#[derive(Clone, Copy, Debug)]
pub(super) enum Factor {
    /// The flow of one part for a share of the step.
    Flow { letter: u8, share: Dd },
    /// The flow of b B + c [B,[A,B]]; the bracket is 2 BAB − ABB − BBA.
    Kick { b: Dd, bab: Dd, abb: Dd },
    /// A symmetric map, exp(γ Y₁ + γ³ Y₃ + γ⁵ Y₅ + …).
    Map(Dd),
}

impl Factor {
    fn kick(b: Dd, c: Dd) -> Self {
        Factor::Kick { b, bab: c * 2.0, abb: -c }
    }

    /// With the sizes of its coefficients.
    fn size(self) -> Self {
        match self {
            Factor::Flow { letter, share } => Factor::Flow { letter, share: share.abs() },
            Factor::Kick { b, bab, abb } => Factor::Kick { b: b.abs(), bab: bab.abs(), abb: abb.abs() },
            Factor::Map(length) => Factor::Map(length.abs()),
        }
    }

    /// What its sum of letters makes of the coefficients `before` of the beginnings of `word`, for the one of `end` letters.
    fn times(self, before: &[Dd], word: &[u8], end: usize) -> Dd {
        let last = word[end - 1];
        match self {
            Factor::Flow { letter, share } if letter == last => before[end - 1] * share,
            Factor::Flow { .. } => Dd::ZERO,
            Factor::Kick { b, bab, abb } => {
                let one = if last == 1 { before[end - 1] * b } else { Dd::ZERO };
                match word[..end] {
                    [.., 1, 0, 1] => one + before[end - 3] * bab,
                    [.., 0, 1, 1] | [.., 1, 1, 0] => one + before[end - 3] * abb,
                    _ => one,
                }
            }
            Factor::Map(length) => (0..last).fold(before[end - 1], |power, _| power * length),
        }
    }
}

/// The maps of one whole step of a composition in order: of the processor, of the kernel, and of the inverse of the processor.
pub(super) fn maps(scheme: &Scheme) -> Option<Vec<Factor>> {
    let kernel = scheme.lengths()?;
    let processor = scheme.processor_lengths();
    let inverse = processor.iter().rev().map(|&length| -length);
    Some(processor.iter().copied().chain(kernel).chain(inverse).map(Factor::Map).collect())
}

/// The flows of one whole step likewise; of a composition those of Strang's map.
pub(super) fn flows(scheme: &Scheme) -> Vec<Factor> {
    let flow = |part, share| Factor::Flow { letter: u8::from(part == Part::B), share };
    let processor = scheme.processor();
    let inverse = processor.iter().rev().map(|&(part, share)| flow(part, -share));
    let mut gradients = scheme.gradients().into_iter();
    let kernel = scheme.flows().into_iter().map(|(part, share)| match part {
        Part::A => flow(part, share),
        Part::B => gradients.next().map_or(flow(part, share), |c| Factor::kick(share, c)),
    });
    processor.iter().map(|&(part, share)| flow(part, share)).chain(kernel).chain(inverse).collect()
}

/// The coefficient of `word` in the product of the exponentials of `factors`.
pub(super) fn coefficient(factors: &[Factor], word: &[u8]) -> Dd {
    let mut sums = vec![Dd::ZERO; word.len() + 1]; // of the beginnings of the word
    sums[0] = Dd::ONE;
    for factor in factors {
        let mut term = sums.clone();
        for power in 1..=word.len() {
            let next = (1..=word.len()).map(|end| factor.times(&term, word, end) / power as f64);
            term = core::iter::once(Dd::ZERO).chain(next).collect();
            if term.iter().all(|&part| part == Dd::ZERO) {
                break;
            }
            sums.iter_mut().zip(&term).for_each(|(sum, &part)| *sum = *sum + part);
        }
    }
    sums[word.len()]
}

/// The same factors with the sizes of their coefficients: words of their product bound the rounding of the others.
pub(super) fn sizes(factors: &[Factor]) -> Vec<Factor> {
    factors.iter().map(|factor| factor.size()).collect()
}

/// All words of `length` letters A and B, `of_b` of them B.
pub(super) fn words(length: usize, of_b: usize) -> Vec<Vec<u8>> {
    if length == 0 {
        return vec![Vec::new()];
    }
    let ending = |letter: u8, shorter: Vec<Vec<u8>>| {
        shorter.into_iter().map(move |mut word| {
            word.push(letter);
            word
        })
    };
    let a = if of_b < length { words(length - 1, of_b) } else { Vec::new() };
    let b = if of_b > 0 { words(length - 1, of_b - 1) } else { Vec::new() };
    ending(0, a).chain(ending(1, b)).collect()
}

/// All words of odd letters whose sum is `weight`.
pub(super) fn odd_words(weight: usize) -> Vec<Vec<u8>> {
    if weight == 0 {
        return vec![Vec::new()];
    }
    let ending = |last: usize| {
        odd_words(weight - last).into_iter().map(move |mut word| {
            word.push(last as u8);
            word
        })
    };
    (1..=weight).step_by(2).flat_map(ending).collect()
}
