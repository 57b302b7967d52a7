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
    /// Whether free motion is followed without any error of discretisation; the order then speaks of heavy bodies.
    pub exact_when_free: bool,
    /// What it keeps of the motion in a potential; `None` refuses bodies with a weight moment.
    pub potential: Option<KeptHeavy>,
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

/// What is constant along the numerical solution in the potential of gravity, in exact arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeptHeavy {
    /// The energy.
    pub energy: Energy,
    /// The vertical component of L in space, p_φ of a top.
    pub momentum_z: bool,
    /// |q| = 1.
    pub norm: bool,
}

/// What becomes of the energy.
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
    /// Exact motions of the free body.
    Drifts(u32),
    /// Solutions of three nonlinear equations by iteration.
    Solves(u32),
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
            Cost::Drifts(1) => f.write_str("1 exact drift"),
            Cost::Drifts(n) => write!(f, "{n} exact drifts"),
            Cost::Solves(1) => f.write_str("3 equations solved"),
            Cost::Solves(n) => write!(f, "3 equations solved {n} times"),
        }
    }
}
