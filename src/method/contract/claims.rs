//! What a method claims: data that tables print and laws execute.

use core::fmt;
use core::ops::{Add, Mul};

use super::{AnyMethod, ToleranceError};
use crate::body::Problem;

/// Name and claims of a method.
pub trait Claimed {
    /// Name in the catalogue, with argument and scheme.
    fn name(&self) -> String;

    /// What it keeps, its order, its cost and its source, for one kind of motion; `None` where it refuses it.
    fn claims(&self, problem: Problem) -> Option<Claims>;

    /// Whether it evaluates forces on power series, as closures in `f64` cannot be.
    fn needs_series(&self) -> bool {
        false
    }

    /// What the error of discretisation stays below in each step, relative to the state, of a method that chooses its steps; the
    /// rounding of a double also stands for that of any other scalar. `None` where the step is that of the run.
    fn tolerance(&self) -> Option<f64> {
        None
    }

    /// The same method with the tolerance `tolerance`.
    ///
    /// # Errors
    /// A method that does not choose its steps, or a tolerance that it does not take.
    ///
    /// ```
    /// use polhode::method;
    /// let found = method("dop853")?;
    /// assert_eq!(found.with_tolerance(1e-12)?.tolerance(), Some(1e-12));
    /// assert!(found.with_tolerance(0.1).is_err());
    /// assert!(method("rk4")?.with_tolerance(1e-12).is_err());
    /// # Ok::<(), polhode::Error>(())
    /// ```
    fn with_tolerance(&self, _tolerance: f64) -> Result<Box<dyn AnyMethod>, ToleranceError> {
        Err(ToleranceError::FixedSteps { method: self.name() })
    }
}

/// The claims of a method for one kind of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct Claims {
    /// Order of convergence of attitude and momentum; `None` where there is no error of discretisation but below the
    /// [tolerance](Claimed::tolerance).
    pub order: Option<u32>,
    /// The error of discretisation is taken back to the rounding of doubles, whatever the scalar.
    pub to_doubles: bool,
    /// Φ_{−h} ∘ Φ_h = 1.
    pub symmetric: bool,
    /// Without torque the map of momenta keeps the Lie–Poisson bracket.
    pub poisson: bool,
    /// The map of attitude and momentum is symplectic on T*SO(3): it keeps the form
    /// `ξ₁·δm₂ − ξ₂·δm₁ + m·(ξ₁ × ξ₂)` of two variations, ξ a turn of the body about its own axes.
    pub symplectic: bool,
    /// What is constant along the numerical solution.
    pub kept: Kept,
    /// What is kept is kept by an iteration at the end of each step, to a residual that adds up over the steps.
    pub to_residual: bool,
    /// Work per step.
    pub cost: Cost,
    /// Where it comes from.
    pub source: &'static str,
}

impl Claims {
    /// Of a method that is neither symmetric nor Poisson nor symplectic and projects nothing; where it is or does, set the field.
    pub const fn new(order: Option<u32>, kept: Kept, cost: Cost, source: &'static str) -> Claims {
        let [to_doubles, symmetric, poisson, symplectic, to_residual] = [false; 5];
        Claims { order, to_doubles, symmetric, poisson, symplectic, kept, to_residual, cost, source }
    }
}

/// What is constant along the numerical solution, in exact arithmetic, where the motion conserves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
#[non_exhaustive]
pub struct Kept {
    /// The energy.
    pub energy: Energy,
    /// |m|.
    pub momentum_norm: bool,
    /// L in space, as a vector.
    pub momentum_space: bool,
    /// The vertical component of L in space, p_φ of a top.
    pub momentum_z: bool,
    /// |q| = 1.
    pub norm: bool,
}

impl Kept {
    /// Nothing is constant, and the energy drifts.
    pub const NOTHING: Kept = Kept {
        energy: Energy::Drifts,
        momentum_norm: false,
        momentum_space: false,
        momentum_z: false,
        norm: false,
    };

    /// L as far as `problem` conserves it, and |q|: what a map keeps that turns the body alone and adds impulses in space; of wheels,
    /// which push it like torques, nothing.
    pub const fn momentum_alone(problem: Problem) -> Kept {
        let free = matches!(problem, Problem::Free);
        Kept {
            momentum_norm: free,
            momentum_space: free,
            momentum_z: matches!(problem, Problem::Free | Problem::Linear | Problem::Potential),
            norm: true,
            ..Kept::NOTHING
        }
    }

    /// Everything that free motion conserves, the energy as `energy` says.
    pub const fn all_of_free_motion(energy: Energy) -> Kept {
        Kept { energy, momentum_norm: true, momentum_space: true, momentum_z: true, norm: true }
    }
}

/// Long-time behaviour of the energy error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Energy {
    /// Zero.
    Exact,
    /// Within a bound ∝ h^order for exponentially long times.
    Bounded,
    /// Moves away, linearly in time or faster.
    Drifts,
}

/// Work per step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[must_use]
#[non_exhaustive]
pub struct Cost {
    /// Evaluations of the right-hand side.
    pub right_sides: u32,
    /// Turns about an axis, one sine and cosine each.
    pub turns: u32,
    /// Additions of Jacobi's functions by their theorem.
    pub additions: u32,
    /// Exact flows of the free body.
    pub free_flows: u32,
    /// Solutions of three nonlinear equations by iteration.
    pub solves: u32,
    /// Kicks, one evaluation of the torque each.
    pub kicks: u32,
}

impl Cost {
    /// `n` evaluations of the right-hand side.
    pub const fn right_sides(n: u32) -> Cost {
        Cost { right_sides: n, ..Cost::NOTHING }
    }

    /// `n` turns.
    pub const fn turns(n: u32) -> Cost {
        Cost { turns: n, ..Cost::NOTHING }
    }

    /// `n` additions of Jacobi's functions.
    pub const fn additions(n: u32) -> Cost {
        Cost { additions: n, ..Cost::NOTHING }
    }

    /// `n` exact flows of the free body.
    pub const fn free_flows(n: u32) -> Cost {
        Cost { free_flows: n, ..Cost::NOTHING }
    }

    /// `n` solutions of three equations.
    pub const fn solves(n: u32) -> Cost {
        Cost { solves: n, ..Cost::NOTHING }
    }

    /// `n` kicks.
    pub const fn kicks(n: u32) -> Cost {
        Cost { kicks: n, ..Cost::NOTHING }
    }

    /// Evaluations of all kinds together.
    #[must_use]
    pub const fn evaluations(self) -> u32 {
        self.right_sides + self.turns + self.additions + self.free_flows + self.solves + self.kicks
    }

    const NOTHING: Cost = Cost { right_sides: 0, turns: 0, additions: 0, free_flows: 0, solves: 0, kicks: 0 };
}

impl Add for Cost {
    type Output = Cost;
    fn add(self, b: Cost) -> Cost {
        Cost {
            right_sides: self.right_sides + b.right_sides,
            turns: self.turns + b.turns,
            additions: self.additions + b.additions,
            free_flows: self.free_flows + b.free_flows,
            solves: self.solves + b.solves,
            kicks: self.kicks + b.kicks,
        }
    }
}

impl Mul<u32> for Cost {
    type Output = Cost;
    fn mul(self, n: u32) -> Cost {
        Cost {
            right_sides: self.right_sides * n,
            turns: self.turns * n,
            additions: self.additions * n,
            free_flows: self.free_flows * n,
            solves: self.solves * n,
            kicks: self.kicks * n,
        }
    }
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
        let counted = |n: u32, one: &str| format!("{n} {one}{}", if n == 1 { "" } else { "s" });
        let mut parts = Vec::new();
        for (n, one) in [
            (self.right_sides, "right side"),
            (self.turns, "turn"),
            (self.additions, "elliptic addition"),
            (self.free_flows, "free flow"),
            (self.kicks, "kick"),
        ] {
            if n > 0 {
                parts.push(counted(n, one));
            }
        }
        match self.solves {
            0 => {}
            1 => parts.insert(0, "3 equations solved".into()),
            n => parts.insert(0, format!("3 equations solved {n} times")),
        }
        f.write_str(&parts.join(", "))
    }
}
