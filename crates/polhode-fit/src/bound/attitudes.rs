//! The Cramér–Rao bound of a planned record of attitudes.

use nalgebra::{SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::rotation::Quat;

use crate::bound::of_entries;
use crate::likelihood::descent::{Levels, Problem};
use crate::likelihood::motion::Start;
use crate::likelihood::sums::Reduced;
use crate::likelihood::track::{Model, Track};
use crate::physical::coordinates::coordinates;

/// The Cramér–Rao bound on the tensor with trace 1 of a body that is known, from attitudes of its free motion: covariance of the entries
/// xx, yy, zz, xy, xz, yz in body axes.
///
/// `omega_body` (rad/s, body axes) is the angular velocity in the middle between the first and the last of `times` (s, ascending);
/// `sigma` is the standard deviation of the noise of one component of the rotation vector, rad.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::inertia::Inertia;
/// use polhode_fit::foreseen_attitude_bound;
/// let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// let times: Vec<f64> = (0..600).map(|i| f64::from(i) / 20.0).collect();
/// let omega = Vector3::new(0.3, 1.0, 0.4);
/// let bound = foreseen_attitude_bound(&body, omega, &times, 0.01).ok_or("tumbles")?;
/// assert!(bound[(0, 0)].sqrt() < 0.01); // one deviation, of a trace of 1
/// let twice = foreseen_attitude_bound(&body, omega, &times, 0.02).ok_or("tumbles")?;
/// assert!((twice.trace() / bound.trace() - 4.0).abs() < 1e-9); // twice the noise
/// assert!(foreseen_attitude_bound(&body, Vector3::z(), &times, 0.01).is_none()); // a pure spin
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// `None` where the motion does not determine the tensor, or an argument is not finite.
#[must_use]
pub fn foreseen_attitude_bound(
    inertia: &Inertia,
    omega_body: Vector3<f64>,
    times: &[f64],
    sigma: f64,
) -> Option<SMatrix<f64, 6, 6>> {
    let rate = omega_body.norm();
    let middle = 0.5 * (times.first()? + times.last()?);
    let track = Track {
        times: times.iter().map(|t| (t - middle) * rate).collect(),
        attitudes: vec![Quat::identity(); times.len()],
        rates: Vec::new(),
        used: vec![true; times.len()],
    };
    let start = Start { attitude: Quat::identity(), rate: omega_body / rate };
    let shape = inertia.shape().tensor();
    let model = Model {
        x: coordinates(&shape),
        alignment: Quat::identity(),
        is_aligned: false,
        drag: None,
        starts: vec![start],
    };
    // what is left of the attitudes has no part in the information of small deviations
    let levels = Levels { attitude: 1e3, rate: 1.0 };
    let problem = Problem { tracks: &[track], levels, radius: f64::INFINITY, pull: None };
    let information = Reduced::new(&problem.sums(&model)?.0)?.of_tensor()?;
    let deviation = sigma / levels.attitude;
    of_entries(information, |own| Some(own.cholesky()?.inverse() * (deviation * deviation)))
}
