//! What a method claims: data that tables print and laws execute.

use core::fmt;

/// The claims of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claims {
    /// Order of convergence of attitude and momentum.
    pub order: u32,
    /// Φ_{−h} ∘ Φ_h = 1.
    pub symmetric: bool,
    /// The map of momenta keeps the Lie–Poisson bracket.
    pub poisson: bool,
    /// What it keeps of free motion.
    pub free: Kept,
    /// Work per step.
    pub cost: Cost,
    /// Where it comes from.
    pub source: &'static str,
}

/// What is constant along the numerical solution, in exact arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// The energy.
    pub energy: Energy,
    /// |m|.
    pub momentum: bool,
    /// L in space, as a vector.
    pub momentum_space: bool,
    /// |q| = 1.
    pub norm: bool,
}

/// What becomes of the energy of free motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Energy {
    /// Constant.
    Exact,
    /// Within a bound ∝ h^order for exponentially long times.
    Bounded,
    /// Moves away, linearly in time or faster.
    Drifts,
}

/// Work per step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Evaluations of the right-hand side.
    RightSides(u32),
    /// Turns about an axis, one sine and cosine each.
    Turns(u32),
    /// Solution of three nonlinear equations by iteration.
    Solve,
}

impl fmt::Display for Energy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Energy::Exact => "exact",
            Energy::Bounded => "bounded",
            Energy::Drifts => "drifts",
        })
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cost::RightSides(1) => f.write_str("1 right side"),
            Cost::RightSides(n) => write!(f, "{n} right sides"),
            Cost::Turns(n) => write!(f, "{n} turns"),
            Cost::Solve => f.write_str("3 equations solved"),
        }
    }
}
