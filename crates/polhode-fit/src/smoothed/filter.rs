//! The Kalman filter along a path, and the smoother.
//!
//! The path has an attitude and a rate at each sample, which need not follow each other. Off it by the rotation vector θ and by the rate
//! δω, δ = (θ, δω), the motion obeys δ' = Φ δ + Θ p + d + w to first order: p are changes of what all stretches share, d is what the path
//! itself leaves, and w is torque noise. An attitude that is measured is off the path by θ and its noise, of variance 1. The filter
//! carries δ = a + B p, p with δ at the first sample, and the covariance C of what is random in it.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::likelihood::motion::Start;
use crate::likelihood::track::Track;
use crate::signal::covariance::Shape;
use crate::smoothed::dynamics::{ALL, Derivative, Law, SHARED, Square};

pub(super) type State = SVector<f64, 6>;

/// The covariance of torque noise per that of the attitudes, along which axes it acts: an index of [`Carried::noise`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Level {
    pub(crate) torque: f64,
    pub(crate) shape: usize,
}

impl Level {
    /// Along which axes the torque noise acts.
    pub(crate) fn axes(self) -> Shape {
        if self.shape == 0 { Shape::Moments } else { Shape::Alike }
    }
}

/// From one sample of a path to the next.
pub(super) struct Link {
    by: Derivative,
    noise: [Square; 2],
    /// d.
    left: State,
}

impl Link {
    /// By how much the path's rate falls short of what the law makes of the one before.
    pub(super) fn left_of_rate(&self) -> Vector3<f64> {
        self.left.fixed_rows::<3>(3).into_owned()
    }
}

/// The links of a path; `None` where a motion cannot be followed.
pub(super) fn links(track: &Track, path: &[Start], law: &Law) -> Option<Vec<Link>> {
    let pairs = path.windows(2).zip(track.times.windows(2));
    let each = pairs.map(|(path, times)| {
        let carried = law.carry(&path[0], times[1] - times[0])?;
        let turn: Vector3<f64> = (path[1].attitude.conjugate() * carried.attitude).logarithm().into();
        let mut left = State::zeros();
        left.fixed_rows_mut::<3>(0).copy_from(&turn);
        left.fixed_rows_mut::<3>(3).copy_from(&(carried.rate - path[1].rate));
        Some(Link { by: carried.by, noise: carried.noise, left })
    });
    each.collect()
}

/// What one stretch says of start and shared unknowns, the start first.
#[derive(Clone)]
pub(super) struct Sums {
    pub(super) matrix: SMatrix<f64, ALL, ALL>,
    pub(super) right: SVector<f64, ALL>,
    /// Sum of squares of the innovations over their deviations.
    pub(super) squares: f64,
    /// log |S| of all innovations.
    pub(super) log_determinant: f64,
    pub(super) count: f64,
}

/// The filter at one sample.
pub(super) struct Kept {
    a: State,
    b: Derivative,
    c: Square,
    /// Of a sample that is used.
    seen: Option<Seen>,
}

struct Seen {
    /// S⁻¹, and of S = L Lᵀ the inverse of L.
    inverse: Matrix3<f64>,
    root: Matrix3<f64>,
    /// What is seen of the sample less a.
    innovation: Vector3<f64>,
}

impl Kept {
    /// The innovation over its deviations, of a sample that is used.
    pub(super) fn whitened(&self, p: &SVector<f64, ALL>) -> Option<Vector3<f64>> {
        self.seen.as_ref().map(|seen| seen.root * self.left(seen, p))
    }

    fn left(&self, seen: &Seen, p: &SVector<f64, ALL>) -> Vector3<f64> {
        seen.innovation - self.b.fixed_rows::<3>(0) * p
    }
}

/// Filters a stretch, and gives each sample to `keep`. `None` where a covariance is not positive.
pub(super) fn filter(
    track: &Track,
    path: &[Start],
    links: &[Link],
    level: Level,
    mut keep: impl FnMut(Kept),
) -> Option<Sums> {
    let mut sums = Sums {
        matrix: SMatrix::zeros(),
        right: SVector::zeros(),
        squares: 0.0,
        log_determinant: 0.0,
        count: 0.0,
    };
    let (mut a, mut b, mut c) = (State::zeros(), Derivative::identity(), Square::zeros());
    for (k, start) in path.iter().enumerate() {
        if let Some(link) = k.checked_sub(1).and_then(|k| links.get(k)) {
            let flow = link.by.fixed_view::<6, 6>(0, 0).into_owned();
            a = flow * a + link.left;
            b = flow * b;
            let mut shared = b.fixed_view_mut::<6, SHARED>(0, 6);
            shared += link.by.fixed_view::<6, SHARED>(0, 6);
            c = flow * c * flow.transpose() + link.noise[level.shape] * level.torque;
            c = (c + c.transpose()) * 0.5;
        }
        let seen = match track.used[k] {
            false => None,
            true => {
                let cholesky = (c.fixed_view::<3, 3>(0, 0) + Matrix3::identity()).cholesky()?;
                let off: Vector3<f64> = (start.attitude.conjugate() * track.attitudes[k]).logarithm().into();
                let innovation = off - a.fixed_rows::<3>(0);
                let root = cholesky.l().try_inverse()?;
                Some(Seen { inverse: cholesky.inverse(), root, innovation })
            }
        };
        let kept = Kept { a, b, c, seen };
        if let Some(Seen { inverse, root, innovation }) = &kept.seen {
            let rows = root * b.fixed_rows::<3>(0);
            let left = root * innovation;
            sums.matrix += rows.tr_mul(&rows);
            sums.right += rows.tr_mul(&left);
            sums.squares += left.norm_squared();
            sums.log_determinant -= 2.0 * root.diagonal().map(libm::log).sum();
            sums.count += 3.0;
            let gain = c.fixed_columns::<3>(0) * inverse;
            let seen = b.fixed_rows::<3>(0).into_owned();
            a += gain * innovation;
            b -= gain * seen;
            c -= gain * c.fixed_rows::<3>(0);
        }
        keep(kept);
    }
    Some(sums)
}

/// δ at each sample by all of them, where start and shared unknowns change by `p`.
///
/// Source: G. J. Bierman, Automatica 9 (1973) 503: no covariance is inverted, and one that vanishes does no harm.
pub(super) fn smoothed(kept: &[Kept], links: &[Link], p: &SVector<f64, ALL>) -> Vec<State> {
    let mut moved = vec![State::zeros(); kept.len()];
    let mut later = State::zeros();
    for (k, at) in kept.iter().enumerate().rev() {
        if let Some(seen) = &at.seen {
            // (1 − K H)ᵀ λ − Hᵀ S⁻¹ (what is seen)
            let by_gain = seen.inverse * (at.c.fixed_rows::<3>(0) * later);
            let pulled = seen.inverse * at.left(seen, p);
            let mut here = later.fixed_rows_mut::<3>(0);
            here -= by_gain + pulled;
        }
        moved[k] = at.a + at.b * p - at.c * later;
        if let Some(link) = k.checked_sub(1).and_then(|k| links.get(k)) {
            later = link.by.fixed_view::<6, 6>(0, 0).tr_mul(&later);
        }
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use polhode::num::Random;
    use polhode::rotation::{Quat, Vec3};

    use crate::columns::column::Unknowns;
    use crate::columns::sets::torque_columns;
    use crate::physical::coordinates::Coordinates;
    use crate::settings::torque::TorqueModel;

    /// Filter and smoother against the normal distribution of all samples at once: attitudes off a path that is no motion, one of them not
    /// used, under a constant torque and torque noise of both shapes.
    #[test]
    fn filter_and_smoother_are_the_normal_distribution_of_all_samples() {
        let mut random = Random::new(12);
        let columns = torque_columns(TorqueModel::Constant);
        let mut at = Unknowns::at(Coordinates::new(0.05, 0.02, 0.01, -0.03, 0.02), &columns);
        at.c.iter_mut().for_each(|c| *c = 0.02);
        let law = Law::new(&at, &columns).unwrap();
        let times: Vec<f64> = vec![-1.0, -0.6, -0.1, 0.3, 0.4, 1.0];
        let count = times.len();
        let mut start = |t: &f64| {
            let turn = Vec3::from(Vector3::new(0.3, 0.8, -0.2) * *t + random.normal_vector() * 0.05);
            Start {
                attitude: Quat::exponential(turn),
                rate: Vector3::new(0.3, 0.8, -0.2) + random.normal_vector() * 0.05,
            }
        };
        let path: Vec<Start> = times.iter().map(&mut start).collect();
        let attitudes: Vec<Quat<f64>> = path
            .iter()
            .map(|at| at.attitude * Quat::exponential(Vec3::from(random.normal_vector() * 0.1)))
            .collect();
        let mut used = vec![true; count];
        used[2] = false;
        let track = Track { times, attitudes, rates: Vec::new(), used };
        let links = links(&track, &path, &law).unwrap();
        for level in [
            Level { torque: 0.7, shape: 0 },
            Level { torque: 0.4, shape: 1 },
            Level { torque: 0.0, shape: 0 },
        ] {
            // δ at each sample: a mean, its derivative by (δ₀, p), and the covariance of all of them
            let (size, mut mean, mut by) =
                (6 * count, DVector::zeros(6 * count), DMatrix::zeros(6 * count, ALL));
            by.view_mut((0, 0), (6, 6)).fill_with_identity();
            let mut flows = DMatrix::identity(size, size);
            let mut acting = DMatrix::zeros(size, size);
            for (k, link) in links.iter().enumerate() {
                let (from, to) = (6 * k, 6 * (k + 1));
                let flow = link.by.fixed_view::<6, 6>(0, 0).into_owned();
                let moved = flow * mean.fixed_rows::<6>(from) + link.left;
                mean.fixed_rows_mut::<6>(to).copy_from(&moved);
                let mut slope = flow * by.fixed_view::<6, ALL>(from, 0);
                let mut shared = slope.fixed_view_mut::<6, SHARED>(0, 6);
                shared += link.by.fixed_view::<6, SHARED>(0, 6);
                by.view_mut((to, 0), (6, ALL)).copy_from(&slope);
                let carried = flow * flows.view((from, 0), (6, size));
                let mut own = flows.view_mut((to, 0), (6, size));
                own.copy_from(&carried);
                own.view_mut((0, to), (6, 6)).fill_with_identity();
                acting.view_mut((to, to), (6, 6)).copy_from(&(link.noise[level.shape] * level.torque));
            }
            let covariance = &flows * acting * flows.transpose();
            let seen: Vec<usize> =
                (0..count).filter(|k| track.used[*k]).flat_map(|k| 6 * k..6 * k + 3).collect();
            let off: Vec<f64> = (0..count)
                .filter(|k| track.used[*k])
                .flat_map(|k| (path[k].attitude.conjugate() * track.attitudes[k]).logarithm().0)
                .collect();
            let of = |i: usize, k: usize| covariance[(seen[i], seen[k])] + if i == k { 1.0 } else { 0.0 };
            let s = DMatrix::from_fn(seen.len(), seen.len(), of).cholesky().unwrap();
            let h = DMatrix::from_fn(seen.len(), ALL, |i, k| by[(seen[i], k)]);
            let y = DVector::from_fn(seen.len(), |i, _| off[i] - mean[seen[i]]);

            let mut kept = Vec::new();
            let sums = filter(&track, &path, &links, level, |at| kept.push(at)).unwrap();
            assert!((sums.matrix - h.tr_mul(&s.solve(&h))).amax() < 1e-11, "{level:?}");
            assert!((sums.right - h.tr_mul(&s.solve(&y))).amax() < 1e-11, "{level:?}");
            assert!((sums.squares - y.dot(&s.solve(&y))).abs() < 1e-11, "{level:?}");
            let determinant: f64 = 2.0 * s.l().diagonal().map(libm::log).sum();
            assert!((sums.log_determinant - determinant).abs() < 1e-11, "{level:?}");
            assert_eq!((sums.count, kept.len()), (15.0, count));

            let p = SVector::<f64, ALL>::from_fn(|k, _| {
                0.02 * (1.0 + k as f64) * if k % 2 == 0 { 1.0 } else { -1.0 }
            });
            let left = &y - &h * p;
            let across = DMatrix::from_fn(size, seen.len(), |i, k| covariance[(i, seen[k])]);
            let expected = &mean + &by * p + across * s.solve(&left);
            for (k, moved) in smoothed(&kept, &links, &p).iter().enumerate() {
                assert!((moved - expected.fixed_rows::<6>(6 * k)).amax() < 1e-11, "{level:?} {k}");
            }
            let whitened: Vec<Vector3<f64>> = kept.iter().filter_map(|at| at.whitened(&p)).collect();
            let squares: f64 = whitened.iter().map(Vector3::norm_squared).sum();
            assert!(whitened.len() == 5 && (squares - left.dot(&s.solve(&left))).abs() < 1e-11, "{level:?}");
            assert_eq!(links[1].left_of_rate(), links[1].left.fixed_rows::<3>(3).into_owned());
        }
    }
}
