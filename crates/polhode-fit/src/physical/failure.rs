//! Why the program for the nearest physical tensor has no certified answer.

use polhode::inertia::InertiaError;
use thiserror::Error;

use crate::physical::certificate::Certificate;

/// Why the program for the nearest physical tensor has no certified answer.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolverFailure {
    /// The covariance of the residuals has no Cholesky factor.
    #[error("the covariance of the residuals is not positive definite")]
    Covariance,
    /// The information matrix has no inverse.
    #[error("the information matrix is not positive definite")]
    Information,
    /// A coefficient of the program is infinite or NaN.
    #[error("a coefficient of the equations is not finite")]
    Coefficient,
    /// The solver did not accept the program.
    #[error("the solver refused its input: {0}")]
    Refused(&'static str),
    /// The solver found no point that obeys all constraints.
    #[error("no tensor obeys all constraints")]
    Infeasible,
    /// The solver found the objective unbounded below.
    #[error("the misfit has no lower bound")]
    Unbounded,
    /// The solver met a numerical error.
    #[error("a numerical error in the solver")]
    Numerical,
    /// The solver ended without an answer.
    #[error("the solver ended without an answer")]
    Unsolved,
    /// The limits could not be checked against the physical law.
    #[error("the limits could not be checked against I1 + I2 >= I3")]
    Limits,
    /// The physical law is not met after all rounds of cuts.
    #[error("I1 + I2 >= I3 is not satisfied after {rounds} rounds")]
    Cuts {
        /// Rounds that were made.
        rounds: usize,
    },
    /// The gradients of the active constraints are linearly dependent.
    #[error("the active constraints are linearly dependent")]
    Dependent,
    /// The answer does not satisfy the conditions of optimality.
    #[error(
        "the answer is not a minimum: stationarity {:.1e}, violation {:.1e}, multiplier {:.1e}",
        .0.stationarity, .0.violation, .0.dual_violation
    )]
    NotOptimal(Certificate),
    /// The answer is not a physically valid tensor.
    #[error("{0}")]
    Shape(InertiaError),
    /// The answer has no valid tensor of the given scale.
    #[error("no tensor in kg m^2: {0}")]
    Scale(InertiaError),
}
