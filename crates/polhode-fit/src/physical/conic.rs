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

#[cfg(test)]
mod tests {
    use super::*;

    /// min ½ (x² + 2 y²) − 2 y with x ≥ 1 is at (1, 1), where the condition pulls as x does.
    #[test]
    fn a_linear_condition_holds_with_its_multiplier() {
        let mut conditions = Conditions::new(2);
        conditions.nonnegative(&[-1.0, 0.0], -1.0);
        conditions.nonnegative(&[0.0, 1.0], 5.0);
        let (x, duals) = conditions.solve_with_duals(&[1.0, 2.0], &[0.0, -2.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-6 && (x[1] - 1.0).abs() < 1e-6, "{x:?}");
        assert!((duals[0] - 1.0).abs() < 1e-6 && duals[1].abs() < 1e-6, "{duals:?}");
        assert_eq!(conditions.solve(&[1.0, 2.0], &[0.0, -2.0]), Ok(x));
    }

    /// 1 + x ≥ |(3 + y, 4)| with the least x² + y² where y costs a million times as much: x = 4.
    #[test]
    fn a_cone_is_as_wide_as_its_height() {
        let mut conditions = Conditions::new(2);
        conditions.nonnegative(&[1.0, 0.0], 100.0);
        let of = |x: f64, y: f64, base: f64| (DVector::from_vec(vec![x, y]), base);
        conditions.second_order([of(1.0, 0.0, 1.0), of(0.0, 1.0, 3.0), of(0.0, 0.0, 4.0)]);
        let x = conditions.solve(&[1.0, 1e6], &[0.0, 0.0]).unwrap();
        assert!((x[0] - 4.0).abs() < 1e-4 && x[1].abs() < 1e-4, "{x:?}");
    }

    /// What cannot be met, what has no least, and what is no number are told apart.
    #[test]
    fn programs_without_an_answer_say_why() {
        let solved = |rows: &[(f64, f64)], diagonal: f64, linear: f64| {
            let mut conditions = Conditions::new(1);
            rows.iter().for_each(|(a, b)| conditions.nonnegative(&[*a], *b));
            conditions.solve(&[diagonal], &[linear])
        };
        assert_eq!(solved(&[(1.0, 0.0), (-1.0, -1.0)], 1.0, 0.0), Err(SolverFailure::Infeasible));
        assert_eq!(solved(&[(1.0, 1.0)], 0.0, 1.0), Err(SolverFailure::Unbounded));
        assert_eq!(solved(&[(f64::NAN, 1.0)], 1.0, 0.0), Err(SolverFailure::Coefficient));
        assert_eq!(solved(&[(1.0, f64::INFINITY)], 1.0, 0.0), Err(SolverFailure::Coefficient));
    }
}
