//! Why the program for the nearest physical tensor has no certified answer.

use polhode::inertia::InertiaError;
use thiserror::Error;

use crate::physical::certificate::Certificate;

/// Why the program for the nearest physical tensor has no certified answer.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolverFailure {
    /// The covariance of the residuals has no Cholesky factor.
    #[error("the residuals have no positive covariance")]
    Covariance,
    /// The information matrix has no inverse.
    #[error("the information is not positive")]
    Information,
    /// A coefficient of the program is infinite or NaN.
    #[error("a coefficient of the program is not finite")]
    Coefficient,
    /// The solver did not accept the program.
    #[error("Bad input data: {0}")]
    Refused(&'static str),
    /// The solver found no point that obeys all constraints.
    #[error("PrimalInfeasible")]
    Infeasible,
    /// The solver found the objective unbounded below.
    #[error("DualInfeasible")]
    Unbounded,
    /// The solver met a numerical error.
    #[error("NumericalError")]
    Numerical,
    /// The solver ended without an answer.
    #[error("the solver ended without an answer")]
    Unsolved,
    /// The limits could not be checked against the physical law.
    #[error("the limits could not be checked against the physical law")]
    Limits,
    /// The physical law is not met after all rounds of cuts.
    #[error("the physical law is not met after {rounds} rounds of cuts")]
    Cuts {
        /// Rounds that were made.
        rounds: usize,
    },
    /// The gradients of the active constraints are linearly dependent.
    #[error("the active constraints depend on each other")]
    Dependent,
    /// The answer does not satisfy the conditions of optimality.
    #[error(
        "the answer is not optimal: stationarity {:.1e}, violation {:.1e}, multiplier {:.1e}",
        .0.stationarity, .0.violation, .0.dual_violation
    )]
    NotOptimal(Certificate),
    /// The answer is not a physically valid tensor.
    #[error("{0}")]
    Shape(InertiaError),
    /// The answer has no valid tensor of the given scale.
    #[error("no absolute tensor: {0}")]
    Scale(InertiaError),
}
