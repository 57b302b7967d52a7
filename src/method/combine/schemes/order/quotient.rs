//! What vanishes if A is quadratic in the momenta and B a function of the attitude.
//!
//! A word of d letters stands at the index that its letters spell in binary, A = 0, B = 1, among the 2ᵈ of its degree.

use super::words::{Factor, coefficient};
use crate::num::{Dd, Real};

/// Coefficients of all words, by degree.
pub(super) type Series = Vec<Vec<Dd>>;

/// The product of the exponentials of `factors`, up to words of `degree` letters.
pub(super) fn product(factors: &[Factor], degree: usize) -> Series {
    let letters = |d: usize, word: usize| (0..d).rev().map(move |n| (word >> n & 1) as u8);
    let word = |d, word| coefficient(factors, &letters(d, word).collect::<Vec<_>>());
    (0..=degree).map(|d| (0..1 << d).map(|index| word(d, index)).collect()).collect()
}

/// The logarithm of a series that begins with 1.
pub(super) fn logarithm(series: &Series) -> Series {
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

pub(super) fn bracket(x: &[Dd], y: &[Dd]) -> Vec<Dd> {
    let mut words = concatenated(x, y);
    add(&mut words, &concatenated(y, x), -Dd::ONE);
    words
}

/// A and B as series of one letter.
pub(super) const LETTERS: [[Dd; 2]; 2] = [[Dd::ONE, Dd::ZERO], [Dd::ZERO, Dd::ONE]];

/// Brackets of degree `d` that vanish: orthogonal unit vectors that span them.
///
/// A bracket of n A's and k B's is of degree n + 1 − k in the momenta. Those with k = n + 1 are functions of the
/// attitude and commute: [B,[B,[B,A]]] = 0 is the first case. What follows from it is found by brackets with A and B.
pub(super) fn vanishing(d: usize) -> Vec<Vec<Dd>> {
    if d < 4 {
        return Vec::new();
    }
    let shorter = vanishing(d - 1);
    let mut all: Vec<Vec<Dd>> =
        LETTERS.iter().flat_map(|letter| shorter.iter().map(move |words| bracket(letter, words))).collect();
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
pub(super) fn nested(word: usize, d: usize) -> Vec<Dd> {
    let at = |n: usize| LETTERS[word >> n & 1];
    (1..d).fold(at(0).to_vec(), |inner, n| bracket(&at(n), &inner))
}

fn dot(x: &[Dd], y: &[Dd]) -> Dd {
    x.iter().zip(y).fold(Dd::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// What `basis`, of orthogonal unit vectors, cannot make of `words`; twice, so that rounding does not leave a part.
pub(super) fn residual(words: &[Dd], basis: &[Vec<Dd>]) -> Vec<Dd> {
    let mut rest = words.to_vec();
    for unit in basis.iter().chain(basis) {
        let share = dot(&rest, unit);
        add(&mut rest, unit, -share);
    }
    rest
}

/// Orthogonal unit vectors that span the same space. The vectors are combinations of a few words with small
/// integers, so what is left of one that depends on the others is rounding alone.
pub(super) fn orthonormal(vectors: Vec<Vec<Dd>>) -> Vec<Vec<Dd>> {
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
