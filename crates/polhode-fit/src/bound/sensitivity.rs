//! How a free motion depends on its tensor and its start, by the variational equations.

use crate::thresholds::bound::{PARTS, STEP};
use crate::thresholds::radius::LONG;
use core::ops::Range;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use polhode::record::both;

use crate::physical::coordinates::{Form, basis};
use crate::signal::terms::cross_derivative;

/// ∂ω/∂(x, ω₀), or ∂ω/∂ω₀ alone where N is 3.
pub(super) type Sensitivity<const N: usize> = SMatrix<f64, 3, N>;

pub(super) struct Euler {
    j: Matrix3<f64>,
    inverse: Matrix3<f64>,
    bases: [Matrix3<f64>; 5],
}

impl Euler {
    pub(super) fn new(j: Matrix3<f64>) -> Option<Euler> {
        Some(Euler { j, inverse: j.try_inverse()?, bases: core::array::from_fn(basis) })
    }

    /// ω' and S'.
    fn derivative<const N: usize>(
        &self,
        w: &Vector3<f64>,
        s: &Sensitivity<N>,
    ) -> (Vector3<f64>, Sensitivity<N>) {
        let rate = -self.inverse * w.cross(&(self.j * w));
        let mut ds = (self.inverse * -cross_derivative(&self.j, w)) * s;
        for (k, b) in self.bases.iter().enumerate().take(N - 3) {
            let own = self.inverse * (w.cross(&(b * w)) + b * rate);
            ds.set_column(k, &(ds.column(k) - own));
        }
        (rate, ds)
    }

    /// The classical Runge–Kutta step, in as many parts as the rate asks for.
    fn advance<const N: usize>(&self, w: &mut Vector3<f64>, s: &mut Sensitivity<N>, time: f64) {
        let speed = (self.inverse * cross_derivative(&self.j, w)).norm();
        let parts = (speed * time.abs() / STEP).ceil().clamp(1.0, PARTS);
        let h = time / parts;
        for _ in 0..parts as usize {
            let (w1, s1) = self.derivative(w, s);
            let (w2, s2) = self.derivative(&(*w + w1 * (0.5 * h)), &(*s + s1 * (0.5 * h)));
            let (w3, s3) = self.derivative(&(*w + w2 * (0.5 * h)), &(*s + s2 * (0.5 * h)));
            let (w4, s4) = self.derivative(&(*w + w3 * h), &(*s + s3 * h));
            *w += (w1 + (w2 + w3) * 2.0 + w4) * (h / 6.0);
            *s += (s1 + (s2 + s3) * 2.0 + s4) * (h / 6.0);
        }
    }

    /// The motion through `start`, with its sensitivities: `visit` sees it at each of `times`.
    pub(super) fn sweep<const N: usize>(
        &self,
        times: &[f64],
        start: &Start,
        mut visit: impl FnMut(usize, &Vector3<f64>, &Sensitivity<N>),
    ) {
        let identity = Sensitivity::from_fn(|i, k| if k + 3 == i + N { 1.0 } else { 0.0 });
        let split = times.partition_point(|&t| t < start.time);
        let mut go = |i: usize, last: &mut f64, w: &mut Vector3<f64>, s: &mut Sensitivity<N>| {
            self.advance(w, s, times[i] - *last);
            *last = times[i];
            visit(i, w, s);
        };
        let (mut last, mut w, mut s) = (start.time, start.rate, identity);
        (split..times.len()).for_each(|i| go(i, &mut last, &mut w, &mut s));
        let (mut last, mut w, mut s) = (start.time, start.rate, identity);
        (0..split).rev().for_each(|i| go(i, &mut last, &mut w, &mut s));
    }

    /// Σ Sᵀ S.
    ///
    /// Among samples within a step of the integrator, S is the cubic through the first and the last of them with their
    /// slopes, which is as near to it as the integrator is.
    pub(super) fn information(&self, times: &[f64], start: &Start) -> SMatrix<f64, 8, 8> {
        let speed = (self.inverse * cross_derivative(&self.j, &start.rate)).norm();
        let nodes = nodes(times, STEP / speed);
        let at: Vec<f64> = nodes.iter().map(|&node| times[node]).collect();
        let of = |own: Range<usize>, counted: Range<usize>| {
            let (mut sum, mut last): (SMatrix<f64, 8, 8>, Option<Node>) = (SMatrix::zeros(), None);
            let first = own.start;
            self.sweep(&at[own], start, |place, w, s: &Sensitivity<8>| {
                let i = first + place;
                if counted.contains(&i) {
                    sum += s.transpose() * s;
                }
                let slope = self.derivative(w, s).1;
                if let Some((k, from, from_slope)) = last.replace((i, *s, slope)) {
                    let (low, high) = (nodes[i.min(k)], nodes[i.max(k)]);
                    let length = at[i] - at[k];
                    let parts = [from, from_slope * length, *s, slope * length];
                    let weights = times[low + 1..high].iter().map(|t| hermite((t - at[k]) / length));
                    let mut squares = SMatrix::<f64, 4, 4>::zeros();
                    weights.for_each(|h| squares += h * h.transpose());
                    for (a, first) in parts.iter().enumerate() {
                        let own = (0..4).map(|b| parts[b] * squares[(a, b)]).sum::<Sensitivity<8>>();
                        sum += first.transpose() * own;
                    }
                }
            });
            sum
        };
        // what comes before and after the start side by side, whatever the machine is; both ways begin at the first node after it
        let (split, end) = (at.partition_point(|&t| t < start.time), at.len());
        let (after, before) =
            both(end > LONG / 10, || of(split..end, split..end), || of(0..end.min(split + 1), 0..split));
        after + before
    }
}

/// Index of a node, S there, and its slope.
type Node = (usize, Sensitivity<8>, Sensitivity<8>);

/// Samples of which the first and the last are two, each at most `width` from the one before, or the next sample.
fn nodes(times: &[f64], width: f64) -> Vec<usize> {
    let mut nodes = Vec::new();
    let mut node = 0;
    while node < times.len() {
        nodes.push(node);
        let within = times[node + 1..].iter().take_while(|t| **t <= times[node] + width).count();
        node += within.max(1);
    }
    nodes
}

/// Weights of the first value, its slope, the last value and its slope, in the cubic through both.
fn hermite(u: f64) -> SVector<f64, 4> {
    let v = 1.0 - u;
    SVector::from([(1.0 + 2.0 * u) * v * v, u * v * v, u * u * (3.0 - 2.0 * u), -u * u * v])
}

/// Where a motion is at one time.
#[derive(Clone, Copy)]
pub(super) struct Start {
    pub(super) time: f64,
    pub(super) rate: Vector3<f64>,
}

/// Information about x alone.
pub(super) fn of_tensor(information: &SMatrix<f64, 8, 8>) -> Option<Form> {
    let own = information.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?;
    let mixed = information.fixed_view::<3, 5>(5, 0).into_owned();
    Some(information.fixed_view::<5, 5>(0, 0) - mixed.transpose() * own.solve(&mixed))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cubic through two values and their slopes is that of a cubic: 1 − 2 u + 3 u² − 4 u³.
    #[test]
    fn a_cubic_follows_from_its_ends() {
        let ends = SVector::<f64, 4>::new(1.0, -2.0, -2.0, -8.0);
        for u in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let expected = 1.0 - 2.0 * u + 3.0 * u * u - 4.0 * u * u * u;
            assert!((hermite(u).dot(&ends) - expected).abs() < 1e-14, "{u}");
        }
    }

    /// From a node the next is the last sample within the width, or the next sample.
    #[test]
    fn nodes_are_a_width_apart_or_neighbours() {
        assert_eq!(nodes(&[0.0, 0.125, 0.25, 0.375, 1.0, 1.125], 0.25), [0, 2, 3, 4, 5]);
        assert_eq!(nodes(&[0.0, 1.0, 2.0], 0.5), [0, 1, 2]);
        assert_eq!(nodes(&[3.0], 0.5), [0]);
        assert!(nodes(&[], 0.5).is_empty());
    }
}
