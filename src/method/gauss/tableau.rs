//! Coefficients of collocation at Gauss's nodes, worked out in double-double.

use crate::num::{Dd, Real};

/// The most stages that there are.
pub(super) const MOST_STAGES: usize = 4;

/// Nodes c_i and weights b_i on [0, 1] and `μ_ij = a_ij/b_j`; zeros behind the stages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tableau {
    pub(super) nodes: [Dd; MOST_STAGES],
    pub(super) weights: [Dd; MOST_STAGES],
    mu: [[Dd; MOST_STAGES]; MOST_STAGES],
}

/// The roots of Legendre's polynomial of a degree up to 4, ascending (Abramowitz and Stegun, table 25.4, in closed form).
fn roots(stages: usize) -> Vec<Dd> {
    let root = |square: Dd| square.sqrt();
    match stages {
        1 => vec![Dd::ZERO],
        2 => {
            let x = root(Dd::ONE / 3.0);
            vec![-x, x]
        }
        3 => {
            let x = root(Dd::of(3.0) / 5.0);
            vec![-x, Dd::ZERO, x]
        }
        _ => {
            let split = root(Dd::of(30.0)) * 2.0;
            let [inner, outer] = [-split, split].map(|part| root((part + 15.0) / 35.0));
            vec![-outer, -inner, inner, outer]
        }
    }
}

impl Tableau {
    /// Of `stages` stages, from 1 to 4.
    pub(super) fn of_stages(stages: usize) -> Self {
        let roots = roots(stages);
        let zero = [Dd::ZERO; MOST_STAGES];
        let mut tableau = Tableau { nodes: zero, weights: zero, mu: [zero; MOST_STAGES] };
        for j in 0..stages {
            let lagrange = lagrange(&roots, j);
            // half, as [−1, 1] is twice as long as [0, 1]
            let weight = integral(&lagrange, Dd::ONE) * 0.5;
            tableau.nodes[j] = (roots[j] + 1.0) * 0.5;
            tableau.weights[j] = weight;
            for (row, root) in tableau.mu.iter_mut().zip(&roots) {
                row[j] = integral(&lagrange, *root) * 0.5 / weight;
            }
        }
        tableau
    }

    /// The μ_ij, of which `μ_ij + μ_ji = 1` holds without rounding: those of i > j are at least ½.
    pub(super) fn rounded<S: Real>(&self) -> [[S; MOST_STAGES]; MOST_STAGES] {
        core::array::from_fn(|i| {
            core::array::from_fn(|j| match i.cmp(&j) {
                core::cmp::Ordering::Less => S::of(1.0) - S::from_dd(self.mu[j][i]),
                core::cmp::Ordering::Equal => S::of(0.5),
                core::cmp::Ordering::Greater => S::from_dd(self.mu[i][j]),
            })
        })
    }
}

/// The coefficients of the polynomial that is 1 at the root `j` and 0 at the others, the constant first.
fn lagrange(roots: &[Dd], j: usize) -> Vec<Dd> {
    let mut polynomial = vec![Dd::ONE];
    for (k, root) in roots.iter().enumerate().filter(|(k, _)| *k != j) {
        let scale = Dd::ONE / (roots[j] - roots[k]);
        let mut next = vec![Dd::ZERO; polynomial.len() + 1];
        for (n, c) in polynomial.iter().enumerate() {
            next[n] = next[n] - *c * *root * scale;
            next[n + 1] = next[n + 1] + *c * scale;
        }
        polynomial = next;
    }
    polynomial
}

/// ∫ of a polynomial from −1 to `end`.
fn integral(polynomial: &[Dd], end: Dd) -> Dd {
    let primitive = |x: Dd| {
        let terms = polynomial.iter().enumerate().rev();
        terms.fold(Dd::ZERO, |sum, (n, c)| (sum + *c / (n as f64 + 1.0)) * x)
    };
    primitive(end) - primitive(-Dd::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quadrature is exact to the degree 2s − 1, and each stage to the degree s: Butcher's conditions B(2s) and C(s), D(s) in the
    /// form μ_ij + μ_ji = 1.
    #[test]
    fn coefficients_satisfy_the_conditions_of_their_order() {
        for stages in 1..=MOST_STAGES {
            let Tableau { nodes, weights, mu } = Tableau::of_stages(stages);
            let power = |x: Dd, n: usize| (0..n).fold(Dd::ONE, |product, _| product * x);
            let sum = |term: &dyn Fn(usize) -> Dd| (0..stages).fold(Dd::ZERO, |sum, j| sum + term(j));
            for n in 1..=2 * stages {
                let moment = sum(&|j| weights[j] * power(nodes[j], n - 1)) * n as f64;
                assert!((moment - 1.0).magnitude() < 1e-30, "{stages} stages, degree {n}: {moment}");
            }
            assert!(
                (sum(&|j| weights[j] * power(nodes[j], 2 * stages)) * (2 * stages + 1) as f64 - 1.0)
                    .magnitude()
                    > 1e-4
            );
            let rounded = Tableau::of_stages(stages).rounded::<f64>();
            for i in 0..stages {
                for n in 1..=stages {
                    let stage = sum(&|j| mu[i][j] * weights[j] * power(nodes[j], n - 1)) * n as f64;
                    assert!(
                        (stage - power(nodes[i], n)).magnitude() < 1e-30,
                        "{stages} stages, {i}, degree {n}"
                    );
                }
                for j in 0..stages {
                    assert!((mu[i][j] + mu[j][i] - 1.0).magnitude() < 1e-30);
                    assert_eq!(rounded[i][j] + rounded[j][i], 1.0);
                    assert!((rounded[i][j] - mu[i][j].hi()).abs() < 3e-16);
                }
            }
        }
    }
}
