//! Polynomials through samples by least squares, one degree after the other, and what other samples differ by from them.
//!
//! Source: Forsythe 1957, Journal of the Society for Industrial and Applied Mathematics 5, 74: polynomials orthogonal on the samples.

use nalgebra::Vector3;

/// A polynomial through the first samples of a list, and what all of the list differ by from it.
pub(super) struct Polynomial {
    nodes: usize,
    /// Places of the samples, in units of the farthest from the first of the list.
    places: Vec<f64>,
    /// The polynomials of each degree so far at the samples, orthonormal on the nodes.
    basis: Vec<Vec<f64>>,
    /// What is left of each sample.
    pub(super) rest: Vec<Vector3<f64>>,
    /// Variance of the noise of what is left of a sample that is no node, in units of that of a sample.
    pub(super) noise: Vec<f64>,
}

impl Polynomial {
    /// None yet, of samples of a record at `places`: those of `nodes`, and behind them `others`.
    pub(super) fn new(places: &[f64], rates: &[Vector3<f64>], nodes: &[usize], others: &[usize]) -> Self {
        let all = || nodes.iter().chain(others).copied();
        let origin = all().next().map_or(0.0, |k| places[k]);
        let farthest = all().map(|k| (places[k] - origin).abs()).fold(1.0, f64::max);
        Polynomial {
            nodes: nodes.len(),
            places: all().map(|k| (places[k] - origin) / farthest).collect(),
            basis: Vec::new(),
            rest: all().map(|k| rates[k]).collect(),
            noise: vec![1.0; nodes.len() + others.len()],
        }
    }

    /// With one degree more, the first time with that of a constant; there must be more nodes than degrees.
    pub(super) fn raise(&mut self) {
        let mut next: Vec<f64> = match self.basis.last() {
            None => vec![1.0; self.places.len()],
            Some(last) => last.iter().zip(&self.places).map(|(p, x)| p * x).collect(),
        };
        // twice is enough
        for _ in 0..2 {
            for one in &self.basis {
                let along: f64 = (0..self.nodes).map(|k| one[k] * next[k]).sum();
                next.iter_mut().zip(one).for_each(|(next, one)| *next -= along * one);
            }
        }
        let norm = next[..self.nodes].iter().map(|p| p * p).sum::<f64>().sqrt();
        next.iter_mut().for_each(|p| *p /= norm);
        let along: Vector3<f64> = (0..self.nodes).map(|k| self.rest[k] * next[k]).sum();
        for (k, p) in next.iter().enumerate() {
            self.rest[k] -= along * *p;
            self.noise[k] += p * p;
        }
        self.basis.push(next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_left_without_a_rest_and_its_noise_is_that_of_the_weights() {
        let cubic = |x: f64| Vector3::new(1.0, x * x * x - 2.0 * x, 3.0 - x * x);
        let places: Vec<f64> = [0, 1, 2, 3, 5, 6, 7, 8, 9, 12, 13, 14].map(f64::from).to_vec();
        let rates: Vec<_> = places.iter().map(|x| cubic(*x)).collect();
        let mut through = Polynomial::new(&places, &rates, &[2, 3, 8, 9, 11], &[5, 0]);
        (0..3).for_each(|_| through.raise());
        assert!(through.rest[5].norm() > 1.0);
        through.raise();
        assert!(through.rest.iter().all(|rest| rest.norm() < 1e-11), "{:?}", through.rest);
        // two samples foresee a third by the weights 2 and -1
        let mut line = Polynomial::new(&places, &rates, &[4, 5], &[6]);
        (0..2).for_each(|_| line.raise());
        assert!(
            (line.noise[2] - 6.0).abs() < 1e-13
                && (line.rest[2] - (rates[6] - rates[5] * 2.0 + rates[4])).norm() < 1e-12
        );
    }
}
