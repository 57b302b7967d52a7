//! Schemes of composition and splitting: the lengths of the maps that make up one step, as data.
//!
//! ```text
//! composition    Φ_h = S_{γ₁h} ∘ S_{γ₂h} ∘ … ∘ S_{γ₂h} ∘ S_{γ₁h}            S a symmetric map of order 2
//! alternating    Φ_h = A_{a₁h} ∘ B_{b₁h} ∘ A_{a₂h} ∘ … ∘ B_{b₁h} ∘ A_{a₁h}   A, B flows; or B first and last
//! processed      Φ_h = P⁻¹ ∘ K_h ∘ P, so that Φ_hⁿ = P⁻¹ ∘ K_hⁿ ∘ P          K, P of the former two kinds
//! ```
//!
//! Compositions and alternating schemes read the same from both ends, so Φ_h is symmetric, Φ_{−h} Φ_h = 1, and its order is
//! even. The constants hold the first half. What closes it follows: 1 − 2Σ in the centre of an odd number of lengths, ½ − Σ on
//! either side of the middle of an even number. Coefficients are multiples of 2⁻¹⁰⁴: so their sums are exact in
//! [`Dd`], and the lengths of a step add up to 1 without rounding.

mod alternating;
mod checked;
mod composition;
mod force_gradient;
mod order;
mod processed;

pub use alternating::{
    ABA_8_4, ABA_8_6_4, ABA_10_6_4, BCE_22, BLANES_MOAN_S6, BLANES_MOAN_S10, MCLACHLAN_S5, SABA_2, SABA_3,
    SABA_4, SRKN_6B, SRKN_11B, SRKN_14A,
};
pub use composition::{
    KAHAN_LI_6, KAHAN_LI_8, MCLACHLAN_4, SOFRONIOU_SPALETTA_6, SOFRONIOU_SPALETTA_8, SOFRONIOU_SPALETTA_10,
    STRANG, SUZUKI_4, SUZUKI_UMENO_8, YOSHIDA_4, YOSHIDA_6,
};
pub use force_gradient::{CHIN_4A, CHIN_4B, CHIN_4C, OMELYAN_MRYGLOD_FOLK_4};
pub use processed::{
    BLANES_CASAS_MURUA_6_11, BLANES_CASAS_MURUA_6_13, BLANES_CASAS_MURUA_8_13, BLANES_CASAS_MURUA_10_23,
    PROCESSED_6_4,
};

use thiserror::Error;

use crate::num::{Dd, Real};

/// Coefficients of a composition or splitting method, which have the order that they claim: [`new`](Self::new) checks it.
///
/// ```
/// use polhode::method::schemes::{Part, STRANG, SUZUKI_4};
/// use polhode::num::{Dd, Real};
/// assert_eq!(SUZUKI_4.lengths().map(|lengths| lengths.len()), Some(5));
/// let half = Dd::of(0.5);
/// assert_eq!(STRANG.flows(), [(Part::B, half), (Part::A, Dd::ONE), (Part::B, half)]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    pub(crate) name: &'static str,
    pub(crate) order: u32,
    pub(crate) source: &'static str,
    pub(crate) stages: Stages,
}

/// The maps of one step and the first half of their lengths, as shares of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stages {
    /// γ₁, γ₂, … before the centre of a palindromic composition of one symmetric map of order 2; the centre is
    /// 1 − 2Σγ.
    Composition(&'static [Dd]),
    /// Two flows in turn, palindromic: a₁, a₂, … and b₁, b₂, … of the first half, what closes each left out.
    ///
    /// The whole step has one flow more of the part that is first. Its number of flows is odd if its list is
    /// longer by one than the other, and even if the lists are of the same length.
    Alternating {
        /// The part with which the step begins and ends.
        first: Part,
        /// Shares of A.
        a: &'static [Dd],
        /// Shares of B.
        b: &'static [Dd],
        /// The flows for which the scheme has its order.
        pairs: Pairs,
    },
    /// Flows of A and kicks in turn, palindromic, as of an [`Alternating`](Self::Alternating) scheme; a kick with the share b and
    /// the gradient c is the flow of b V − c h² τᵀI⁻¹τ, V the potential and τ its torque.
    ForceGradient {
        /// The part with which the step begins and ends.
        first: Part,
        /// Shares of A.
        a: &'static [Dd],
        /// Shares of the kicks.
        b: &'static [Dd],
        /// Gradients of the kicks of the first half, the one in the middle included.
        c: &'static [Dd],
    },
    /// A palindromic composition of one symmetric map of order 2 between a processor and its inverse.
    ///
    /// The processor is taken once, before the first step. Its inverse is taken at each look at the motion, also by a run that is
    /// watched at every step: such runs took two to three times as long as [unwatched](crate::run::Watch) ones, those by
    /// [`PROCESSED_6_4`] four times, by compositions 1.3 times. The processors are even in h only up to some order higher than
    /// that of the scheme, so that the step is no longer exactly symmetric, as its kernel is.
    Processed {
        /// γ₁, γ₂, … of the kernel, as of a [`Composition`](Self::Composition).
        kernel: &'static [Dd],
        /// p₁, p₂, … p_n of the processor, first in time first; −p₁, −p₂, … −p_n follow.
        processor: &'static [Dd],
    },
    /// Two flows in turn between a processor and its inverse; the kernel begins with A and ends with B.
    ProcessedAlternating {
        /// Shares of A in the kernel but for the last, which is 1 − Σ.
        a: &'static [Dd],
        /// Shares of B in the kernel but for the last, which is 1 − Σ.
        b: &'static [Dd],
        /// Shares of A in the processor.
        processor_a: &'static [Dd],
        /// Shares of B in the processor, one more: it begins and ends with B.
        processor_b: &'static [Dd],
        /// The flows for which the scheme has its order.
        pairs: Pairs,
    },
}

/// One of the two flows of a splitting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The flow of A.
    A,
    /// The flow of B.
    B,
}

/// The pairs of flows for which a splitting has its order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pairs {
    /// Any two flows.
    Any,
    /// Runge-Kutta-Nyström: A quadratic in the momenta, B a function of the attitude, so that `[B,[B,[B,A]]] = 0`.
    Nystrom,
    /// H = A + εB with p₁, p₂, …: the error is of size ε h^p₁ + ε² h^p₂ + …, the last p standing for all further
    /// powers of ε. The order is the last p, the smallest.
    NearIntegrable(&'static [u32]),
    /// The same where besides `[B,[B,[B,A]]] = 0`, as for [`Nystrom`](Self::Nystrom).
    NearIntegrableNystrom(&'static [u32]),
}

impl Scheme {
    /// Name: of those in [`ALL`] the one by which [`scheme`] finds it.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// Order of Φ_h.
    #[must_use]
    pub const fn order(&self) -> u32 {
        self.order
    }

    /// Where the coefficients come from.
    #[must_use]
    pub const fn source(&self) -> &'static str {
        self.source
    }

    /// What they are coefficients of.
    #[must_use]
    pub const fn stages(&self) -> Stages {
        self.stages
    }

    /// Lengths of the steps of one symmetric map, all of them, palindromic; none for two flows in turn. Of a processed
    /// composition those of the kernel.
    #[must_use]
    pub fn lengths(&self) -> Option<Vec<Dd>> {
        match self.stages {
            Stages::Composition(gamma) | Stages::Processed { kernel: gamma, .. } => Some(closed(gamma, true)),
            Stages::Alternating { .. }
            | Stages::ForceGradient { .. }
            | Stages::ProcessedAlternating { .. } => None,
        }
    }

    /// Lengths of the steps of the processor, likewise; none without processor.
    #[must_use]
    pub fn processor_lengths(&self) -> Vec<Dd> {
        match self.stages {
            Stages::Processed { processor, .. } => {
                processor.iter().copied().chain(processor.iter().map(|&p| -p)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Whether there is a processor.
    #[must_use]
    pub fn is_processed(&self) -> bool {
        matches!(self.stages, Stages::Processed { .. } | Stages::ProcessedAlternating { .. })
    }

    /// The flows of the processor in order, each with its share of the step, as [`flows`](Self::flows); none without.
    ///
    /// ```
    /// use polhode::method::schemes::{BLANES_CASAS_MURUA_8_13, Part, SUZUKI_4};
    /// let of_a = |flows: &[(Part, _)]| flows.iter().filter(|flow| flow.0 == Part::A).count();
    /// let scheme = BLANES_CASAS_MURUA_8_13;
    /// assert_eq!((of_a(&scheme.flows()), of_a(&scheme.processor())), (13, 20));
    /// assert!(SUZUKI_4.processor().is_empty());
    /// ```
    #[must_use]
    pub fn processor(&self) -> Vec<(Part, Dd)> {
        match self.stages {
            Stages::Processed { .. } => flows_of_strang(&self.processor_lengths()),
            Stages::ProcessedAlternating { processor_a, processor_b, .. } => {
                in_turn(Part::B, processor_b, processor_a)
            }
            _ => Vec::new(),
        }
    }

    /// The gradients of the kicks of one step in order; none without.
    #[must_use]
    pub fn gradients(&self) -> Vec<Dd> {
        match self.stages {
            Stages::ForceGradient { c, .. } => {
                let kicks = self.flows().iter().filter(|flow| flow.0 == Part::B).count();
                c.iter().chain(c.iter().rev().skip(kicks % 2)).copied().collect()
            }
            _ => Vec::new(),
        }
    }

    /// The flows of one step in order, each with its share of the step; of a processed scheme those of the kernel.
    ///
    /// A composition stands for that of Strang's map B(½) A(1) B(½), neighbouring flows of B merged into one.
    #[must_use]
    pub fn flows(&self) -> Vec<(Part, Dd)> {
        match self.stages {
            Stages::Composition(gamma) | Stages::Processed { kernel: gamma, .. } => {
                flows_of_strang(&closed(gamma, true))
            }
            Stages::ProcessedAlternating { a, b, .. } => {
                let whole = |shares: &[Dd]| {
                    let last = shares.iter().fold(Dd::ONE, |left, &share| left - share);
                    shares.iter().copied().chain([last]).collect::<Vec<_>>()
                };
                in_turn(Part::A, &whole(a), &whole(b))
            }
            Stages::Alternating { first, a, b, .. } | Stages::ForceGradient { first, a, b, .. } => {
                let (outer, inner) = if first == Part::A { (a, b) } else { (b, a) };
                let odd = outer.len() > inner.len();
                in_turn(first, &closed(outer, odd), &closed(inner, !odd))
            }
        }
    }
}

/// The whole palindrome of a first half.
fn closed(half: &[Dd], odd: bool) -> Vec<Dd> {
    let sum = half.iter().fold(Dd::ZERO, |sum, &share| sum + share);
    let mut all: Vec<Dd> = Vec::with_capacity(2 * half.len() + 2);
    all.extend(half);
    if odd {
        all.push(Dd::ONE - sum * 2.0);
    } else {
        all.extend([Dd::of(0.5) - sum; 2]);
    }
    all.extend(half.iter().rev());
    all
}

/// The flows of Strang's map in steps of these lengths.
fn flows_of_strang(a: &[Dd]) -> Vec<(Part, Dd)> {
    let mut flows: Vec<(Part, Dd)> = Vec::with_capacity(2 * a.len() + 1);
    let mut before: Option<Dd> = None;
    for &length in a {
        let both = before.map_or(length, |before| before + length);
        flows.extend([(Part::B, both * 0.5), (Part::A, length)]);
        before = Some(length);
    }
    flows.extend(before.map(|last| (Part::B, last * 0.5)));
    flows
}

/// `outer` and `inner` alternating, from the first of `outer` to its last.
fn in_turn(first: Part, outer: &[Dd], inner: &[Dd]) -> Vec<(Part, Dd)> {
    let second = if first == Part::A { Part::B } else { Part::A };
    let mut flows = Vec::with_capacity(outer.len() + inner.len());
    for (n, &share) in outer.iter().enumerate() {
        flows.push((first, share));
        flows.extend(inner.get(n).map(|&share| (second, share)));
    }
    flows
}

/// The scheme called `name`.
///
/// # Errors
/// A name that is not in [`ALL`].
///
/// ```
/// use polhode::method::schemes::scheme;
/// assert_eq!(scheme("kahan-li-8")?.order(), 8);
/// assert_eq!(scheme("kahan-li8").map_err(|error| error.nearest), Err(Some("kahan-li-8")));
/// # Ok::<(), polhode::method::schemes::UnknownScheme>(())
/// ```
pub fn scheme(name: &str) -> Result<&'static Scheme, UnknownScheme> {
    ALL.iter()
        .find(|scheme| scheme.name == name)
        .ok_or_else(|| UnknownScheme { name: name.into(), nearest: nearest(name) })
}

/// A name that no scheme has.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("there is no scheme {name:?}{}; there are {}", suggestion(*nearest), names())]
#[non_exhaustive]
pub struct UnknownScheme {
    /// What was asked for.
    pub name: String,
    /// The name that differs in the fewest letters, if that is a third of them at most.
    pub nearest: Option<&'static str>,
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |nearest| format!(", the nearest is {nearest}"))
}

fn names() -> String {
    ALL.iter().map(|scheme| scheme.name).collect::<Vec<_>>().join(", ")
}

fn nearest(name: &str) -> Option<&'static str> {
    let wanted = letters(name);
    ALL.iter()
        .map(|scheme| (letters(scheme.name), scheme.name))
        .map(|(known, name)| (distance(&wanted, &known), known.len(), name))
        .filter(|(distance, length, _)| 3 * distance <= *length)
        .min_by_key(|(distance, ..)| *distance)
        .map(|(.., name)| name)
}

/// Letters and digits in lower case: hyphens and capitals are no difference between names.
fn letters(name: &str) -> Vec<char> {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// How many letters must be changed, added or left out to turn `from` into `to` (Levenshtein).
fn distance(from: &[char], to: &[char]) -> usize {
    // row[n]: from what has been read of `from` to the first n letters of `to`
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for letter in from {
        let mut diagonal = row[0];
        row[0] += 1;
        for (n, wanted) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != wanted);
            diagonal = row[n + 1];
            row[n + 1] = replaced.min(row[n] + 1).min(diagonal + 1);
        }
    }
    row[to.len()]
}

/// Every scheme: compositions first, each family by order, those with force gradients and processed ones last.
pub const ALL: &[Scheme] = &[
    STRANG,
    YOSHIDA_4,
    SUZUKI_4,
    MCLACHLAN_4,
    YOSHIDA_6,
    KAHAN_LI_6,
    SOFRONIOU_SPALETTA_6,
    SUZUKI_UMENO_8,
    KAHAN_LI_8,
    SOFRONIOU_SPALETTA_8,
    SOFRONIOU_SPALETTA_10,
    MCLACHLAN_S5,
    BLANES_MOAN_S6,
    BLANES_MOAN_S10,
    SRKN_6B,
    SRKN_11B,
    SRKN_14A,
    BCE_22,
    SABA_2,
    SABA_3,
    SABA_4,
    ABA_8_4,
    ABA_8_6_4,
    ABA_10_6_4,
    CHIN_4A,
    CHIN_4B,
    CHIN_4C,
    OMELYAN_MRYGLOD_FOLK_4,
    BLANES_CASAS_MURUA_6_11,
    BLANES_CASAS_MURUA_6_13,
    BLANES_CASAS_MURUA_8_13,
    BLANES_CASAS_MURUA_10_23,
    PROCESSED_6_4,
];
