//! What others do with the same records, each with the same physical law and, where it has something to choose, with the
//! choice that serves it best.

mod coordinates;
mod euler;
mod kalman;
mod momentum;
mod output_error;
mod record;
mod strong;
mod unscented;
mod wendy;

use std::cell::OnceCell;

use nalgebra::{DMatrix, Matrix3, Matrix5, UnitQuaternion, Vector5};
use polhode_fit::Record;

use coordinates::{basis, nearest, tensor};
use record::{Stretch, normalised};

/// A way to the tensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rival {
    /// J ω' + ω × J ω = 0 at every sample, ω' by central differences.
    CentralDifferences,
    /// The same with local cubics, the window being the best of several at each noise.
    SavitzkyGolay,
    /// R(t) J ω(t) = L with R by integration of the same rates.
    Momentum,
    /// The same with R from a second instrument, which no other row has.
    MomentumWithAttitude,
    /// Weak form with errors in variables, as published; the smallest radius being the best of several at each noise.
    Wendy,
    /// The largest likelihood of the same equations, the radius being the best of several at each noise.
    WendyLikelihood,
    /// Extended Kalman filter of rate and tensor, three runs, its prior being the best of several at each noise.
    Kalman,
    /// Unscented Kalman filter of the same, with the same priors to choose from.
    Unscented,
    /// Iterated smoother of the same.
    Smoother,
    /// Maximum likelihood by multiple shooting.
    OutputError,
    /// The same with a drag −d J ω as one more unknown.
    OutputErrorWithDrag,
}

/// All of them, maximum likelihood last.
pub const RIVALS: [Rival; 11] = [
    Rival::CentralDifferences,
    Rival::SavitzkyGolay,
    Rival::Momentum,
    Rival::MomentumWithAttitude,
    Rival::Wendy,
    Rival::WendyLikelihood,
    Rival::Kalman,
    Rival::Unscented,
    Rival::Smoother,
    Rival::OutputError,
    Rival::OutputErrorWithDrag,
];

/// Samples of a Savitzky–Golay window.
const WINDOWS: [usize; 7] = [51, 101, 151, 201, 301, 401, 601];
/// Smallest half widths of the test functions of WENDy, in radians of the motion.
const RADII: [f64; 5] = [0.35, 0.7, 1.4, 2.8, 5.6];
/// Half widths of the likelihood, which has but one and costs ten times as much.
const OF_LIKELIHOOD: [f64; 6] = [0.375, 0.75, 1.5, 3.0, 6.0, 12.0];
/// Standard deviations of a coordinate of the tensor before a filter runs, shares of the trace.
const PRIORS: [f64; 4] = [0.003, 0.01, 0.03, WIDE];
/// That of the smoother: the widest, which adds least to the record.
const WIDE: f64 = 0.1;
/// Window of the start of those that need one.
const START: usize = 101;

/// Error of the attitudes that one rival is given, rad.
pub const ATTITUDE_NOISE: f64 = 1e-3;

/// A record as all rivals are given it.
pub struct Given<'a> {
    stretches: Vec<Stretch>,
    /// Noise over the root mean square rate.
    sigma: f64,
    attitudes: &'a [UnitQuaternion<f64>],
    /// The coordinates from which those begin that need a start, worked out for the first of them.
    start: OnceCell<Option<Vector5<f64>>>,
}

impl<'a> Given<'a> {
    /// A record with noise `sigma` (rad/s), which rivals are told, and attitudes that one rival is given.
    pub fn new(record: &Record, sigma: f64, attitudes: &'a [UnitQuaternion<f64>]) -> Self {
        let (stretches, rms) = normalised(record);
        Given { stretches, sigma: sigma / rms, attitudes, start: OnceCell::new() }
    }

    fn start(&self) -> Option<Vector5<f64>> {
        let of = || Some(least_squares(&self.stretches, |s| strong::savitzky_golay(s, START))?.coordinates);
        *self.start.get_or_init(of)
    }
}

/// What a rival says.
pub struct Answer {
    /// The tensor with trace 1.
    pub shape: Matrix3<f64>,
    /// Its coordinates, and their information before the physical law, where the rival states its uncertainty.
    coordinates: Vector5<f64>,
    information: Option<Matrix5<f64>>,
}

impl Answer {
    fn constrained(centre: Vector5<f64>, information: Matrix5<f64>) -> Option<Self> {
        let answer = Self::unweighted(centre, &information)?;
        Some(Answer { information: Some(information), ..answer })
    }

    /// Without a statement of uncertainty, in the metric of `information`.
    fn unweighted(centre: Vector5<f64>, information: &Matrix5<f64>) -> Option<Self> {
        let usable = centre.iter().chain(information).all(|v| v.is_finite());
        usable.then(|| {
            let coordinates = nearest(centre, information);
            Answer { shape: tensor(&coordinates), coordinates, information: None }
        })
    }

    /// eᵀ C⁻¹ e with the rival's own covariance.
    pub fn own_square(&self, truth: &Matrix3<f64>) -> Option<f64> {
        let e = self.coordinates - Vector5::from_fn(|k, _| basis(k).dot(truth));
        self.information.map(|information| e.dot(&(information * e)))
    }
}

impl Rival {
    /// Its name, as tables print it.
    pub fn name(self) -> &'static str {
        match self {
            Self::CentralDifferences => "central differences",
            Self::SavitzkyGolay => "Savitzky-Golay, tuned",
            Self::Momentum => "momentum",
            Self::MomentumWithAttitude => "momentum with attitude",
            Self::Wendy => "WENDy, tuned",
            Self::WendyLikelihood => "WENDy-MLE, tuned",
            Self::Kalman => "extended Kalman filter, tuned",
            Self::Unscented => "unscented Kalman filter, tuned",
            Self::Smoother => "iterated Kalman smoother",
            Self::OutputError => "maximum likelihood",
            Self::OutputErrorWithDrag => "maximum likelihood with drag",
        }
    }

    /// How many choices it has.
    pub fn choices(self) -> usize {
        match self {
            Self::SavitzkyGolay => WINDOWS.len(),
            Self::Wendy => RADII.len(),
            Self::WendyLikelihood => OF_LIKELIHOOD.len(),
            Self::Kalman | Self::Unscented => PRIORS.len(),
            _ => 1,
        }
    }

    /// A choice in words.
    pub fn choice(self, k: usize) -> String {
        match self {
            Self::SavitzkyGolay => format!("window {}", WINDOWS[k]),
            Self::Wendy => format!("radii from {} rad", RADII[k]),
            Self::WendyLikelihood => format!("radius {} rad", OF_LIKELIHOOD[k]),
            Self::Kalman | Self::Unscented => format!("prior {}", PRIORS[k]),
            _ => String::new(),
        }
    }

    /// The answer with its k-th choice; `None` where there is none.
    pub fn answer(self, k: usize, given: &Given) -> Option<Answer> {
        let Given { stretches, sigma, attitudes, .. } = given;
        let sigma = *sigma;
        let start = || given.start();
        match self {
            Self::CentralDifferences => least_squares(stretches, strong::central_differences),
            Self::SavitzkyGolay => least_squares(stretches, |s| strong::savitzky_golay(s, WINDOWS[k])),
            Self::Momentum => least_squares(stretches, momentum::integrated),
            Self::MomentumWithAttitude => {
                momentum::measured(stretches.first()?, attitudes, start()?, sigma, ATTITUDE_NOISE)
            }
            Self::Wendy => wendy::answer(stretches, RADII[k], sigma),
            Self::WendyLikelihood => wendy::likeliest(stretches, OF_LIKELIHOOD[k], sigma),
            Self::Kalman => kalman::filtered(stretches, start()?, PRIORS[k], sigma),
            Self::Unscented => unscented::filtered(stretches, start()?, PRIORS[k], sigma),
            Self::Smoother => kalman::smoothed(stretches, start()?, WIDE, sigma),
            Self::OutputError => output_error::answer(stretches, start()?, false, sigma),
            Self::OutputErrorWithDrag => output_error::answer(stretches, start()?, true, sigma),
        }
    }
}

/// Least squares over all rows, unweighted.
fn least_squares(stretches: &[Stretch], rows: impl Fn(&Stretch) -> strong::Rows) -> Option<Answer> {
    let rows: strong::Rows = stretches.iter().flat_map(rows).collect();
    if rows.len() < 6 {
        return None;
    }
    let r = DMatrix::from_row_iterator(rows.len(), 6, rows.iter().flatten().copied()).qr().r();
    let root = r.fixed_view::<5, 5>(0, 0).into_owned();
    let centre = root.solve_upper_triangular(&-r.fixed_view::<5, 1>(0, 5))?;
    Answer::unweighted(centre, &(root.transpose() * root))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Quaternion, Vector3};
    use polhode::flow::FreeMotion;
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode_fit::{Disturbances, Gyroscope, Settings, fit, simulate, simulate_with};

    use super::*;

    struct Example {
        j: Matrix3<f64>,
        record: Record,
        attitudes: Vec<UnitQuaternion<f64>>,
    }

    fn example(sigma: f64) -> Example {
        let mut random = Random::new(99);
        let (w, v) = (random.normal(), random.normal_vector());
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, v.x, v.y, v.z)).to_rotation_matrix();
        let moments = Vector3::new(1.0, 2.0, 2.6) / 5.6;
        let j = turn.matrix() * Matrix3::from_diagonal(&moments) * turn.matrix().transpose();
        let j = (j + j.transpose()) * 0.5;
        let times: Vec<f64> = (0..3000).map(|i| 0.01 * f64::from(i)).collect();
        let body = Inertia::from_tensor(j).unwrap();
        let omega = Vector3::new(0.3, -0.8, 0.6);
        let rates = simulate(&body, omega, &times, sigma, &mut random).unwrap();
        let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).unwrap();
        let attitudes = times.iter().map(|&t| motion.at(t).unwrap().rotation()).collect();
        Example { j, record: Record::from_samples(&times, &rates).unwrap(), attitudes }
    }

    fn best(rival: Rival, example: &Example, sigma: f64) -> (f64, Option<f64>) {
        let given = Given::new(&example.record, sigma, &example.attitudes);
        let answers = (0..rival.choices())
            .filter_map(|k| rival.answer(k, &given))
            .map(|a| ((a.shape - example.j).norm(), a.own_square(&example.j)));
        answers.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
    }

    #[test]
    fn rivals_are_right_without_noise() {
        let example = example(0.0);
        for rival in RIVALS {
            let error = best(rival, &example, 1e-9).0;
            let limit = if rival == Rival::Momentum { 1e-4 } else { 1e-5 };
            assert!(error < limit, "{}: {error:e}", rival.name());
        }
    }

    #[test]
    fn rivals_that_weigh_are_near_the_bound_and_the_others_are_not() {
        let sigma = 1e-2;
        let example = example(sigma);
        let own = fit(&example.record, &Settings::default()).unwrap();
        let own = (own.shape.tensor() - example.j).norm();
        let likelihood = best(Rival::OutputError, &example, sigma).0;
        assert!(own < 2.0 * likelihood && likelihood < 2.0 * own, "{own:e} {likelihood:e}");
        assert!(best(Rival::CentralDifferences, &example, sigma).0 > 30.0 * likelihood);
        let squares = RIVALS.map(|rival| best(rival, &example, sigma).1);
        assert!(squares.iter().flatten().count() > 1);
        for (rival, square) in RIVALS.iter().zip(squares) {
            // the 99.9 % point of χ² with five degrees of freedom
            assert!(square.is_none_or(|square| square < 20.5), "{}: {square:?}", rival.name());
        }
    }

    #[test]
    fn a_drag_is_an_unknown_of_one_rival() {
        let (free, sigma) = (example(0.0), 1e-3);
        let (body, omega) = (Inertia::from_tensor(free.j).unwrap(), Vector3::new(0.3, -0.8, 0.6));
        let times: Vec<f64> = (0..3000).map(|i| 0.01 * f64::from(i)).collect();
        let (acting, sensor) =
            (Disturbances::default().with_relative_drag(0.02), Gyroscope::default().with_noise(sigma));
        let rates = simulate_with(&body, omega, &times, &acting, &sensor, &mut Random::new(1)).unwrap();
        let example = Example { record: Record::from_samples(&times, &rates).unwrap(), ..free };
        let [knows, not] =
            [Rival::OutputErrorWithDrag, Rival::OutputError].map(|rival| best(rival, &example, sigma));
        assert!(knows.0 * 10.0 < not.0 && knows.1.unwrap() < 20.5, "{knows:?} {not:?}");
    }

    /// In the metric of entries the nearest physical tensor is the clipped spectrum; in any metric no step towards another
    /// physical tensor leads nearer.
    #[test]
    fn the_nearest_physical_tensor_is_nearest() {
        let coordinates = |d: [f64; 3]| {
            let j = Matrix3::from_diagonal(&Vector3::from(d));
            Vector5::from_fn(|k, _| basis(k).dot(&j))
        };
        for (far, near) in [([0.05, 0.25, 0.7], [0.15, 0.35, 0.5]), ([-0.4, 0.65, 0.75], [0.0, 0.5, 0.5])] {
            let found = nearest(coordinates(far), &Matrix5::identity());
            assert!((found - coordinates(near)).norm() < 1e-14, "{found}");
        }
        let mut random = Random::new(4);
        for _ in 0..20 {
            let root = Matrix5::from_fn(|i, k| if i == k { 3.0 } else { random.normal() });
            let information = root.transpose() * root;
            let centre = Vector5::from_fn(|_, _| 0.3 * random.normal());
            let found = nearest(centre, &information);
            for _ in 0..20 {
                let other = coordinates::physical(&Vector5::from_fn(|_, _| random.normal()));
                let slope = (information * (found - centre)).dot(&(other - found));
                assert!(slope > -1e-10, "{slope:e}");
            }
        }
    }
}
