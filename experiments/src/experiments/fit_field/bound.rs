//! The Cramér–Rao bound on a tensor beside unknown torques, sensor errors and torque noise.
//!
//! To first order the readings are linear in the unknowns and in the torque's noise, so the bound is the covariance of a
//! Kalman filter that runs along the true motion, or, under torque noise, along the motion without it. Its state is (entries
//! of J, drag, constant torque, offset, scale, ω), of which those that are known start with no variance.

use nalgebra::{Matrix3, SMatrix, Vector3};

/// Entries xx, yy, zz, xy, xz, yz; drag; torque; offset; scale.
const PARAMETERS: usize = 14;
const STATE: usize = PARAMETERS + 3;
const DRAG: usize = 6;
const TORQUE: usize = 7;
const OFFSET: usize = 10;
const SCALE: usize = 13;
/// Standard deviation beforehand of what is unknown, in rad/s, 1/s and shares of the trace: far above what a record leaves.
const UNKNOWN: f64 = 0.5;

type Sensitivity = SMatrix<f64, 3, STATE>;
type Covariance = SMatrix<f64, STATE, STATE>;

/// A motion, and what is unknown of it. Tensors have trace 1.
pub(super) struct Problem {
    pub(super) tensor: Matrix3<f64>,
    pub(super) omega: Vector3<f64>,
    /// Drag k in −k J ω, 1/s.
    pub(super) drag: f64,
    /// Constant torque, rad/s².
    pub(super) torque: Vector3<f64>,
    /// Momentum of a wheel, rad/s.
    pub(super) wheel: Vector3<f64>,
    /// Scale error of the sensor.
    pub(super) scale: f64,
    /// Root of the power spectral density of each component of the torque, rad/s² √s.
    pub(super) torque_noise: f64,
    /// Noise of the readings, rad/s.
    pub(super) noise: f64,
    pub(super) unknown: Unknown,
}

/// What is unknown beside the shape of the tensor.
#[derive(Clone, Copy, Default)]
pub(super) struct Unknown {
    /// Its trace, too.
    pub(super) trace: bool,
    pub(super) drag: bool,
    pub(super) torque: bool,
    /// Standard deviations beforehand, rad/s and a share.
    pub(super) offset: f64,
    pub(super) scale: f64,
}

/// The symmetric matrix with one entry.
fn unit(k: usize) -> Matrix3<f64> {
    let (i, j) = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)][k];
    let mut e = Matrix3::zeros();
    e[(i, j)] = 1.0;
    e[(j, i)] = 1.0;
    e
}

impl Problem {
    /// ω' and S'.
    fn derivative(
        &self,
        inverse: &Matrix3<f64>,
        w: &Vector3<f64>,
        s: &Sensitivity,
    ) -> (Vector3<f64>, Sensitivity) {
        let j = self.tensor;
        let momentum = j * w + self.wheel;
        let slope = inverse * (self.torque - w.cross(&momentum)) - w * self.drag;
        let linear =
            inverse * (momentum.cross_matrix() - w.cross_matrix() * j) - Matrix3::identity() * self.drag;
        let mut ds = linear * s;
        for k in 0..6 {
            let e = unit(k);
            let own = inverse * (e * slope + w.cross(&(e * w)) + e * w * self.drag);
            ds.set_column(k, &(ds.column(k) - own));
        }
        ds.set_column(DRAG, &(ds.column(DRAG) - w));
        for k in 0..3 {
            ds.set_column(TORQUE + k, &(ds.column(TORQUE + k) + inverse.column(k)));
        }
        (slope, ds)
    }

    /// Covariance of the entries xx, yy, zz, xy, xz, yz that readings at `times` leave at best.
    pub(super) fn bound(&self, times: &[f64]) -> Option<SMatrix<f64, 6, 6>> {
        let inverse = self.tensor.try_inverse()?;
        let mut covariance = self.prior();
        let mut rate = self.omega;
        for (i, time) in times.iter().enumerate() {
            if i > 0 {
                covariance = self.advance(&inverse, &mut rate, &covariance, time - times[i - 1]);
            }
            covariance = self.read(&rate, &covariance)?;
        }
        Some(covariance.fixed_view::<6, 6>(0, 0).into_owned())
    }

    fn prior(&self) -> Covariance {
        let mut covariance = Covariance::zeros();
        let wide = UNKNOWN * UNKNOWN;
        for i in 0..6 {
            covariance[(i, i)] = wide;
        }
        if !self.unknown.trace {
            (0..3).for_each(|i| (0..3).for_each(|k| covariance[(i, k)] -= wide / 3.0));
        }
        let square = |known: bool| if known { wide } else { 0.0 };
        covariance[(DRAG, DRAG)] = square(self.unknown.drag);
        for k in 0..3 {
            covariance[(TORQUE + k, TORQUE + k)] = square(self.unknown.torque);
            covariance[(OFFSET + k, OFFSET + k)] = self.unknown.offset * self.unknown.offset;
            covariance[(PARAMETERS + k, PARAMETERS + k)] = wide;
        }
        covariance[(SCALE, SCALE)] = self.unknown.scale * self.unknown.scale;
        covariance
    }

    /// By the classical Runge–Kutta step, whose error at the sampling of these experiments is below 1e-8.
    fn advance(
        &self,
        inverse: &Matrix3<f64>,
        w: &mut Vector3<f64>,
        covariance: &Covariance,
        h: f64,
    ) -> Covariance {
        let s = Sensitivity::from_fn(|i, k| if k == PARAMETERS + i { 1.0 } else { 0.0 });
        let (w1, s1) = self.derivative(inverse, w, &s);
        let (w2, s2) = self.derivative(inverse, &(*w + w1 * (0.5 * h)), &(s + s1 * (0.5 * h)));
        let (w3, s3) = self.derivative(inverse, &(*w + w2 * (0.5 * h)), &(s + s2 * (0.5 * h)));
        let (w4, s4) = self.derivative(inverse, &(*w + w3 * h), &(s + s3 * h));
        *w += (w1 + (w2 + w3) * 2.0 + w4) * (h / 6.0);
        let s = s + (s1 + (s2 + s3) * 2.0 + s4) * (h / 6.0);
        // the parameters stay: only the last rows and columns change
        let moved = s * covariance;
        let mut next = *covariance;
        next.fixed_view_mut::<3, STATE>(PARAMETERS, 0).copy_from(&moved);
        next.fixed_view_mut::<STATE, 3>(0, PARAMETERS).copy_from(&moved.transpose());
        let impulse = inverse * inverse.transpose() * (self.torque_noise * self.torque_noise * h);
        let own = moved * s.transpose() + impulse;
        next.fixed_view_mut::<3, 3>(PARAMETERS, PARAMETERS).copy_from(&((own + own.transpose()) * 0.5));
        next
    }

    /// After a reading (1 + s) ω + b.
    fn read(&self, w: &Vector3<f64>, covariance: &Covariance) -> Option<Covariance> {
        let mut seen = Sensitivity::zeros();
        for k in 0..3 {
            seen[(k, OFFSET + k)] = 1.0;
            seen[(k, PARAMETERS + k)] = 1.0 + self.scale;
            seen[(k, SCALE)] = w[k];
        }
        let cross = covariance * seen.transpose();
        let innovation = seen * cross + Matrix3::identity() * (self.noise * self.noise);
        let next = covariance - cross * innovation.try_inverse()? * cross.transpose();
        Some((next + next.transpose()) * 0.5)
    }
}

#[cfg(test)]
mod tests {
    use polhode::inertia::Inertia;
    use polhode_fit::foreseen_bound;

    use super::*;

    fn problem() -> Problem {
        let j = Matrix3::new(2.0, 0.3, -0.1, 0.3, 1.7, 0.2, -0.1, 0.2, 1.1) / 4.8;
        Problem {
            tensor: j,
            omega: Vector3::new(0.3, -0.8, 0.6),
            drag: 0.0,
            torque: Vector3::zeros(),
            wheel: Vector3::zeros(),
            scale: 0.0,
            torque_noise: 0.0,
            noise: 1e-3,
            unknown: Unknown::default(),
        }
    }

    fn times() -> Vec<f64> {
        (0..1000).map(|i| 0.02 * f64::from(i)).collect()
    }

    #[test]
    fn without_nuisances_it_is_the_bound_of_the_library() {
        let problem = problem();
        let body = Inertia::from_tensor(problem.tensor).unwrap();
        let expected = foreseen_bound(&body, problem.omega, &times(), problem.noise).unwrap();
        let found = problem.bound(&times()).unwrap();
        assert!((found - expected).norm() < 1e-4 * expected.norm(), "{found} {expected}");
    }

    #[test]
    fn what_is_unknown_widens_it_and_what_is_known_gives_the_trace() {
        let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
        let free = problem().bound(&times).unwrap().trace();
        let with = |change: &dyn Fn(&mut Problem)| {
            let mut problem = problem();
            change(&mut problem);
            problem.bound(&times).unwrap().trace()
        };
        let drag = with(&|p| p.unknown.drag = true);
        let torque = with(&|p| p.unknown.torque = true);
        let offset = with(&|p| p.unknown.offset = 0.02);
        let no_offset = with(&|p| p.unknown.offset = 1e-9);
        let noisy = with(&|p| p.torque_noise = 1e-3);
        assert!(free < drag && drag < 2.0 * free, "{free:e} {drag:e}");
        assert!(free < torque && free < offset && free < noisy);
        assert!((no_offset / free - 1.0).abs() < 1e-4);
        // a wheel fixes the scale, the better the faster it turns
        let wheel = |h: f64| {
            with(&|p| {
                p.unknown.trace = true;
                p.wheel = Vector3::new(0.0, h, 0.0);
            })
        };
        assert!(wheel(0.2) < wheel(0.02) && wheel(0.02) < 1.0);
    }
}
