//! Quadratic programs with linear and second-order conditions: the one place that knows the solver.

use crate::thresholds::program::SOLVER;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverError, SolverStatus,
    SupportedConeT,
};
use nalgebra::DVector;

use crate::physical::failure::SolverFailure;

/// Conditions a·x ≤ b and second-order cones, gathered for the solver.
pub(crate) struct Conditions {
    variables: usize,
    nonnegative: Vec<(Vec<f64>, f64)>,
    second_order: Vec<(Vec<f64>, f64)>,
}

impl Conditions {
    pub(crate) fn new(variables: usize) -> Self {
        Conditions { variables, nonnegative: Vec::new(), second_order: Vec::new() }
    }

    pub(crate) fn nonnegative(&mut self, a: &[f64], b: f64) {
        self.nonnegative.push((a.to_vec(), b));
    }

    /// base₀ + g₀·x ≥ |(base₁ + g₁·x, base₂ + g₂·x)|.
    pub(crate) fn second_order(&mut self, cone: [(DVector<f64>, f64); 3]) {
        self.second_order.extend(cone.map(|(g, base)| ((-g).as_slice().to_vec(), base)));
    }

    pub(crate) fn solve(&self, diagonal: &[f64], linear: &[f64]) -> Result<Vec<f64>, SolverFailure> {
        self.solve_with_duals(diagonal, linear).map(|(x, _)| x)
    }

    /// min ½ Σ diagonal x² + linear·x. Every status is looked at; an answer of less than full accuracy is passed on,
    /// since what follows certifies it.
    pub(crate) fn solve_with_duals(
        &self,
        diagonal: &[f64],
        linear: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), SolverFailure> {
        let rows: Vec<&(Vec<f64>, f64)> = self.nonnegative.iter().chain(&self.second_order).collect();
        let (m, n) = (rows.len(), self.variables);
        let colptr = (0..=n).map(|k| k * m).collect();
        let rowval = (0..n).flat_map(|_| 0..m).collect();
        let nzval = (0..n).flat_map(|k| rows.iter().map(move |(a, _)| a[k])).collect();
        let a = CscMatrix::new(m, n, colptr, rowval, nzval);
        let p = CscMatrix::new(n, n, (0..=n).collect(), (0..n).collect(), diagonal.to_vec());
        let b: Vec<f64> = rows.iter().map(|(_, b)| *b).collect();
        if b.iter().chain(&a.nzval).any(|value| !value.is_finite()) {
            return Err(SolverFailure::Coefficient);
        }
        let mut cones: Vec<SupportedConeT<f64>> = vec![NonnegativeConeT(self.nonnegative.len())];
        cones.extend((0..self.second_order.len() / 3).map(|_| SecondOrderConeT(3)));
        let settings = DefaultSettings {
            verbose: false,
            tol_gap_abs: SOLVER,
            tol_gap_rel: SOLVER,
            tol_feas: SOLVER,
            ..DefaultSettings::default()
        };
        let mut solver =
            DefaultSolver::new(&p, linear, &a, &b, &cones, settings).map_err(|error| match error {
                SolverError::BadInputData(what) => SolverFailure::Refused(what),
                _ => SolverFailure::Refused("settings"),
            })?;
        solver.solve();
        let solution = &solver.solution;
        match solution.status {
            SolverStatus::Solved
            | SolverStatus::AlmostSolved
            | SolverStatus::InsufficientProgress
            | SolverStatus::MaxIterations
                if solution.x.iter().all(|x| x.is_finite()) =>
            {
                Ok((solution.x.clone(), solution.z.clone()))
            }
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
                Err(SolverFailure::Infeasible)
            }
            SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => {
                Err(SolverFailure::Unbounded)
            }
            SolverStatus::NumericalError => Err(SolverFailure::Numerical),
            _ => Err(SolverFailure::Unsolved),
        }
    }
}
