//! Motions under torques by a classical Runge–Kutta step, and the Cramér–Rao bound by differences of them.

use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};

/// Torque on a body of trace 1 at a time and an angular velocity.
pub(crate) type Torque<'a> = dyn Fn(f64, &Vector3<f64>) -> Vector3<f64> + 'a;

/// Readings at a tensor, further unknowns, and a start.
pub(crate) type Readings<'a> = dyn Fn(&Matrix3<f64>, &[f64], Vector3<f64>) -> Vec<Vector3<f64>> + 'a;

/// Angular velocities at `times`, which begin at the start.
pub(crate) fn motion(
    j: &Matrix3<f64>,
    omega: Vector3<f64>,
    times: &[f64],
    torque: &Torque<'_>,
) -> Vec<Vector3<f64>> {
    let inverse = j.try_inverse().unwrap();
    let slope = |t: f64, w: &Vector3<f64>| inverse * (torque(t, w) - w.cross(&(j * w)));
    let (mut t, mut w) = (times[0], omega);
    let mut rates = Vec::with_capacity(times.len());
    for &end in times {
        let parts = ((end - t) * omega.norm().max(1.0) / 0.02).ceil().max(1.0);
        let h = (end - t) / parts;
        for _ in 0..parts as usize {
            let a = slope(t, &w);
            let b = slope(t + 0.5 * h, &(w + a * (0.5 * h)));
            let c = slope(t + 0.5 * h, &(w + b * (0.5 * h)));
            let d = slope(t + h, &(w + c * h));
            w += (a + (b + c) * 2.0 + d) * (h / 6.0);
            t += h;
        }
        t = end;
        rates.push(w);
    }
    rates
}

/// The bound on the entries xx, yy, zz, xy, xz, yz of a tensor of trace 1, with `others` further unknowns of the motion
/// and three that are its start. `rates` gives the readings at the tensor, the further unknowns and the start.
pub(crate) fn bound(
    j: &Matrix3<f64>,
    omega: Vector3<f64>,
    others: &[f64],
    priors: &[Option<f64>],
    sigma: f64,
    rates: &Readings<'_>,
) -> SMatrix<f64, 6, 6> {
    let bases: Vec<Matrix3<f64>> = [(0, 0), (1, 1), (0, 1), (0, 2), (1, 2)]
        .into_iter()
        .map(|(a, b)| {
            let mut m = Matrix3::zeros();
            m[(a, b)] = 1.0;
            m[(b, a)] = 1.0;
            if a == b {
                m[(2, 2)] = -1.0;
            }
            m
        })
        .collect();
    let h = 1e-5;
    let (size, n) = (8 + others.len(), rates(j, others, omega).len());
    let mut s = DMatrix::zeros(3 * n, size);
    for k in 0..size {
        let at = |step: f64| {
            let (mut j, mut others, mut omega) = (*j, others.to_vec(), omega);
            match k {
                0..5 => j += bases[k] * step,
                5..8 => omega[k - 5] += step,
                _ => others[k - 8] += step,
            }
            rates(&j, &others, omega)
        };
        for (i, (a, b)) in at(h).iter().zip(at(-h)).enumerate() {
            for p in 0..3 {
                s[(3 * i + p, k)] = (a[p] - b[p]) / (2.0 * h * sigma);
            }
        }
    }
    let mut information = s.transpose() * &s;
    for (k, prior) in priors.iter().enumerate() {
        if let Some(prior) = prior {
            information[(8 + k, 8 + k)] += 1.0 / (prior * prior);
        }
    }
    let inverse = information.cholesky().unwrap().inverse();
    let map = SMatrix::<f64, 6, 5>::from_fn(|row, k| {
        bases[k][[(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)][row]]
    });
    let own: SMatrix<f64, 5, 5> = inverse.fixed_view::<5, 5>(0, 0).into_owned();
    map * own * map.transpose()
}
