//! The Cramér–Rao bound of measured motions, and of a planned one.

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;

use crate::bound::nearest_motion::nearest_motion;
use crate::bound::of_entries;
use crate::bound::sensitivity::{Euler, Sensitivity, Start, of_tensor};
use crate::physical::coordinates::{Coordinates, Form, tensor};
use crate::signal::stretch::Stretch;

/// The motions of a given tensor that explain a record.
pub(crate) struct Motions<'a> {
    euler: Euler,
    each: Vec<(&'a Stretch, Start)>,
    /// Mean square of a component that they leave of the samples, over the variance of the noise, and the number of components.
    pub(crate) left: (f64, f64),
}

impl<'a> Motions<'a> {
    /// `None` where the tensor has no inverse, or a stretch is not explained: what is said of another motion is false.
    pub(crate) fn nearest(stretches: &'a [Stretch], x: &Coordinates, variance: f64) -> Option<Self> {
        let euler = Euler::new(tensor(x))?;
        let long = stretches.iter().filter(|s| s.times.len() >= 5);
        let (mut sum, mut components, mut each) = (0.0, 0.0, Vec::new());
        for s in long {
            let (start, left) = nearest_motion(&euler, s, variance)?;
            sum += left;
            // three numbers of each start follow the noise
            components += 3.0 * (s.times.len() - 1) as f64;
            each.push((s, start));
        }
        Some(Motions { euler, each, left: (sum / components / variance, components) })
    }

    /// The bound on the covariance of the coordinates; `None` where the motions do not determine them.
    pub(crate) fn bound(&self, variance: f64) -> Option<Form> {
        let mut sum = Form::zeros();
        for (s, start) in &self.each {
            sum += of_tensor(&self.euler.information(&s.times, start))?;
        }
        Some((sum / variance).cholesky()?.inverse())
    }

    /// Σ Sᵀ ∂f/∂ω with f = ω·M ω, each ω₀ taken out: what the noise in the sum of f shares with that in the coordinates,
    /// which is the covariance of an efficient estimate times this.
    pub(crate) fn shared(&self, m: &Matrix3<f64>) -> Option<Coordinates> {
        let mut shared = Coordinates::zeros();
        for (s, start) in &self.each {
            let (mut information, mut sum) = (SMatrix::<f64, 8, 8>::zeros(), SMatrix::<f64, 8, 1>::zeros());
            self.euler.sweep(&s.times, start, |_, w, s: &Sensitivity<8>| {
                information += s.transpose() * s;
                sum += s.transpose() * (m * w) * 2.0;
            });
            let own = information.fixed_view::<3, 3>(5, 5).into_owned().cholesky()?;
            let mixed = information.fixed_view::<3, 5>(5, 0).into_owned();
            let start = sum.fixed_rows::<3>(5).into_owned();
            shared += sum.fixed_rows::<5>(0) - mixed.transpose() * own.solve(&start);
        }
        Some(shared)
    }
}

/// The Cramér–Rao bound on the tensor with trace 1 of a body that is known: what a record of its free motion can tell
/// at best, before it is made. Covariance of the entries xx, yy, zz, xy, xz, yz in body axes.
///
/// `omega_body` (rad/s, body axes) is the angular velocity at the first of `times` (s, ascending); `sigma` is the
/// standard deviation of the noise of one component, rad/s.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::inertia::Inertia;
/// use polhode_fit::foreseen_bound;
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// let tumble = foreseen_bound(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3).ok_or("tumbles")?;
/// let wobble = foreseen_bound(&body, Vector3::new(0.03, 0.03, 1.0), &times, 1e-3).ok_or("wobbles")?;
/// assert!(wobble.trace() > 100.0 * tumble.trace());
/// assert!(foreseen_bound(&body, Vector3::new(0.0, 0.0, 1.0), &times, 1e-3).is_none()); // a pure spin
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// `None` where the motion does not determine the tensor, or an argument is not finite.
#[must_use]
pub fn foreseen_bound(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    sigma: f64,
) -> Option<SMatrix<f64, 6, 6>> {
    let shape = inertia.tensor() / inertia.tensor().trace();
    let euler = Euler::new(shape)?;
    // in units of the rate, as in a fit
    let rate = omega_body.norm();
    let times: Vec<f64> = times.iter().map(|t| t * rate).collect();
    let start = Start { time: times.first().copied()?, rate: omega_body / rate };
    let deviation = sigma / rate;
    let information = of_tensor(&euler.information(&times, &start))?;
    of_entries(information, |own| Some((own / (deviation * deviation)).cholesky()?.inverse()))
}
