//! Laws, quantities and verdicts, each with its word in reports.

use core::fmt;
use core::str::FromStr;

use crate::body::Problem;

/// An enum whose variants are words of reports.
macro_rules! words {
    ($(#[$about:meta])* $name:ident { $($(#[$doc:meta])* $variant:ident = $word:literal,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $name {
            $($(#[$doc])* $variant,)*
        }

        impl $name {
            /// Every one, in the order of reports.
            pub const ALL: &[$name] = &[$($name::$variant),*];

            /// Its word in reports.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self {
                    $($name::$variant => $word,)*
                }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.word())
            }
        }

        impl FromStr for $name {
            type Err = UnknownWord;
            fn from_str(text: &str) -> Result<Self, UnknownWord> {
                let found = $name::ALL.iter().find(|known| known.word() == text);
                found.copied().ok_or_else(|| UnknownWord { word: text.into(), what: stringify!($name) })
            }
        }
    };
}

/// A word that reports do not use.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{word:?} is not a word for {what} in a report")]
#[non_exhaustive]
pub struct UnknownWord {
    /// The word.
    pub word: String,
    /// What it should be.
    pub what: &'static str,
}

words! {
    /// What is measured.
    Law {
        /// The method takes the motion that it has claims for, and no other.
        Takes = "takes",
        /// Errors fall with the claimed power of the step.
        Order = "order",
        /// Φ_{−h} ∘ Φ_h = 1.
        Symmetry = "symmetry",
        /// ρ ∘ Φ_h ∘ ρ ∘ Φ_h = 1, ρ the reversal of the momentum; of motions that are reversible. It is claimed with the
        /// symmetry.
        Reversibility = "reversibility",
        /// The map of momenta keeps the Lie–Poisson bracket.
        Poisson = "Poisson",
        /// The map of attitude and momentum keeps the symplectic form.
        Symplectic = "symplectic",
        /// A quantity is constant along the numerical solution.
        Conserved = "conserved",
        /// The energy error over a long time: bounded by a power of the step, or growing.
        Drift = "drift",
        /// Evaluations a step.
        Cost = "cost",
        /// In double precision, what is kept does not move in one direction.
        Rounding = "rounding",
        /// Processor time of a step; on request only, as it depends on the machine.
        Time = "time",
        /// A torque is the gradient of its potential.
        Gradient = "gradient",
        /// Energies and torques are finite numbers.
        Finite = "finite",
    }
}

words! {
    /// Of what a law is measured.
    Quantity {
        /// The method as a whole.
        Method = "method",
        /// Attitude and momentum.
        State = "state",
        /// The attitude.
        Attitude = "attitude",
        /// The momentum in body axes.
        Momentum = "momentum",
        /// The energy.
        Energy = "energy",
        /// The amplitude of the energy error.
        Amplitude = "amplitude",
        /// |m|.
        MomentumNorm = "|m|",
        /// L in space, as a vector.
        MomentumSpace = "L",
        /// The vertical component of L.
        MomentumZ = "L_z",
        /// |q|.
        Norm = "|q|",
        /// Jacobi's constant.
        Jacobi = "E - n L_z",
        /// The Lie–Poisson bracket.
        Bracket = "bracket",
        /// The symplectic form.
        Form = "form",
        /// Evaluations of the torque: right sides and kicks.
        Torques = "torques",
        /// Turns about an axis.
        Turns = "turns",
        /// Exact flows of the free body.
        FreeFlows = "flows",
        /// Additions of Jacobi's functions.
        Additions = "additions",
        /// Solutions of three equations.
        Solves = "solves",
        /// One step.
        Step = "step",
        /// A torque.
        Torque = "torque",
    }
}

words! {
    /// What the measurement says of the claim, also of the claim that something does not hold.
    Verdict {
        /// It is as claimed.
        Holds = "holds",
        /// It is claimed and does not hold.
        False = "false",
        /// It holds though it is not claimed.
        Unclaimed = "unclaimed",
        /// The measurement does not decide; the finding says why.
        Undecided = "undecided",
        /// A number without a claim.
        Measured = "measured",
    }
}

/// The word of a kind of motion.
pub(super) fn word_of(problem: Problem) -> &'static str {
    match problem {
        Problem::Free => "free",
        Problem::Linear => "gravity",
        Problem::Potential => "potential",
        Problem::Torque => "torque",
        Problem::Gyrostat => "wheels",
        Problem::GyrostatPotential => "wheels+U",
    }
}

/// The kind of motion of a word.
pub(super) fn problem_of(word: &str) -> Result<Problem, UnknownWord> {
    let found = Problem::ALL.iter().copied().find(|problem| word_of(*problem) == word);
    found.ok_or_else(|| UnknownWord { word: word.into(), what: "kind of motion" })
}
