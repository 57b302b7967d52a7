//! Covariances to first order, beside ensembles of exact motions.

use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, UnitQuaternion};

use polhode::flow::{CovarianceError, FreeMotion, StartCovariance, TurnAxes};
use polhode::inertia::Inertia;
use polhode::num::Covariance;

fn motion() -> FreeMotion {
    let inertia = Inertia::from_moments([1.0, 2.0, 2.5]).unwrap();
    let start = UnitQuaternion::from_euler_angles(0.4, -1.1, 2.0);
    FreeMotion::from_omega(&inertia, start, [0.5, 0.4, -0.8].into()).unwrap()
}

/// With independent components of these standard deviations: of the angle, of the rate, of the tensor.
fn independent(sigma: [f64; 3]) -> StartCovariance {
    let deviation = |k: usize| sigma[(k / 3).min(2)];
    StartCovariance::new(Covariance::independent(core::array::from_fn(deviation)).unwrap(), TurnAxes::Space)
}

#[cfg(feature = "random")]
mod beside_ensembles {
    use super::*;
    use polhode::num::Random;

    /// Covariance of rotation vector in space and angular velocity of members at `t`.
    fn spread(motion: &FreeMotion, sigma: [f64; 3], t: f64, members: u64) -> Matrix6<f64> {
        let (zero, now) = (motion.at(0.0).unwrap(), motion.at(t).unwrap().rotation());
        let (omega, omega_now) = (motion.omega_at(0.0).unwrap(), motion.omega_at(t).unwrap());
        let tensor = motion.body().inertia().tensor();
        let mut random = Random::new(7);
        let mut sum = Matrix6::zeros();
        for _ in 0..members {
            let turn = UnitQuaternion::from_scaled_axis(random.normal_vector() * sigma[0]);
            let rate = omega + random.normal_vector() * sigma[1];
            let (d, o) = (random.normal_vector() * sigma[2], random.normal_vector() * sigma[2]);
            let change = Matrix3::new(d.x, o.x, o.y, o.x, d.y, o.z, o.y, o.z, d.z);
            let inertia = Inertia::from_tensor(tensor + change).unwrap();
            let member = FreeMotion::from_omega(&inertia, turn * zero.rotation(), rate).unwrap();
            let away = (member.at(t).unwrap().rotation() * now.inverse()).scaled_axis();
            let faster = member.omega_at(t).unwrap() - omega_now;
            let x = SVector::<f64, 6>::from_iterator(away.iter().chain(faster.iter()).copied());
            sum += x * x.transpose();
        }
        sum / members as f64
    }

    fn agree(members: u64) {
        let motion = motion();
        let allowed = 4.0 * (2.0 / members as f64).sqrt() + 0.02;
        for (sigma, t) in [([1e-3, 1e-3, 1e-3], 3.0), ([1e-3, 1e-5, 1e-5], 300.0), ([0.05, 1e-4, 0.0], -50.0)]
        {
            let start = independent(sigma);
            let found = motion.covariance(t, &start).unwrap();
            assert!(found.nonlinearity < 0.1, "{}", found.nonlinearity);
            let members = spread(&motion, sigma, t, members);
            // in units of the standard deviations, which are known to one over the root of twice the members
            let unit = |k: usize| 1.0 / found.state[(k, k)].sqrt();
            for row in 0..6 {
                for column in 0..6 {
                    let gap = (members - found.state)[(row, column)] * unit(row) * unit(column);
                    assert!(gap.abs() < allowed, "{row}, {column} at {t} s: {gap:.3}");
                }
            }
        }
        // where the phase is lost, first order is far off, and says so
        let start = independent([1e-3, 3e-3, 0.0]);
        let late = motion.covariance(1e5, &start).unwrap();
        let members = spread(&motion, [1e-3, 3e-3, 0.0], 1e5, members);
        let angle = |p: &Matrix6<f64>| p.fixed_view::<3, 3>(0, 0).trace().sqrt();
        assert!(late.nonlinearity > 0.5 && angle(&late.state) > 10.0 * angle(&members), "{late:?}");
    }

    #[test]
    fn first_order_agrees_with_members_where_it_says_so() {
        agree(2_000);
    }

    #[test]
    #[ignore = "a hundred thousand members take minutes"]
    fn first_order_agrees_with_many_members_where_it_says_so() {
        agree(100_000);
    }
}

#[test]
fn the_measure_grows_with_what_is_unknown() {
    let motion = motion();
    let measure = |rate: f64| {
        let start = independent([rate, rate, 0.0]);
        motion.covariance(100.0, &start).unwrap().nonlinearity
    };
    let [small, larger] = [1e-5, 1e-4].map(measure);
    assert!(small > 0.0 && (larger / small - 10.0).abs() < 1.0, "{small:e} {larger:e}");
}

#[test]
fn white_torque_on_a_sphere_spreads_as_its_integral() {
    let inertia = Inertia::from_moments([2.0; 3]).unwrap();
    let motion =
        FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), [0.0, 0.0, 0.0].into()).unwrap();
    let start =
        StartCovariance { torque: Covariance::independent([0.1; 3]).unwrap(), ..independent([0.0; 3]) };
    let found = motion.covariance(3.0, &start).unwrap().state;
    // rate: q t/I²; angle: q t³/3I²; both: q t²/2I²
    let exact = [0.01 * 9.0 / 4.0, 0.01 * 4.5 / 4.0, 0.01 * 3.0 / 4.0];
    let mut whole = Matrix6::zeros();
    for k in 0..3 {
        whole[(k, k)] = exact[0];
        (whole[(k, k + 3)], whole[(k + 3, k)]) = (exact[1], exact[1]);
        whole[(k + 3, k + 3)] = exact[2];
    }
    assert!((found - whole).amax() < 1e-12, "{found}");
}

#[test]
fn white_torque_adds_up_over_two_times() {
    let motion = motion();
    let torque = Covariance::independent([0.1, 0.15, 0.0]).unwrap();
    let start = StartCovariance { torque, ..independent([0.0; 3]) };
    let half = motion.covariance(7.0, &start).unwrap().state;
    let second = FreeMotion::from_point(motion.body().inertia(), motion.point_at_dd(7.0.into()));
    let entry = |i: usize, j: usize| if i < 6 && j < 6 { half[(i, j)] } else { 0.0 };
    let half = Covariance::new(core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)))).unwrap();
    let both = second.covariance(7.0, &StartCovariance { matrix: half, ..start.clone() }).unwrap().state;
    let whole = motion.covariance(14.0, &start).unwrap().state;
    assert!((both - whole).amax() < 1e-9 * whole.amax(), "{both} {whole}");
}

#[test]
fn what_has_no_covariance_is_refused() {
    let motion = motion();
    let mut negative = [[0.0; 12]; 12];
    negative[4][4] = -1e-6;
    assert!(Covariance::new(negative).is_err());
    assert_eq!(motion.covariance(1.0, &independent([0.0, 0.0, 10.0])), Err(CovarianceError::NoBody));
    let noisy =
        StartCovariance { torque: Covariance::independent([1.0; 3]).unwrap(), ..independent([0.0; 3]) };
    assert!(matches!(motion.covariance(1e9, &noisy), Err(CovarianceError::TooLong { .. })));
    assert!(matches!(
        motion.covariance(f64::NAN, &independent([0.0; 3])),
        Err(CovarianceError::Derivative(_))
    ));
}

#[test]
fn in_body_axes_the_covariance_of_the_rotation_is_turned() {
    let motion = motion();
    let start = independent([1e-3, 2e-3, 0.0]);
    let space = motion.covariance(9.0, &start).unwrap().state;
    let body = motion.covariance(9.0, &StartCovariance { axes: TurnAxes::Body, ..start }).unwrap().state;
    let mut turn = SMatrix::<f64, 6, 6>::identity();
    let attitude = motion.at(9.0).unwrap().rotation().to_rotation_matrix();
    turn.fixed_view_mut::<3, 3>(0, 0).copy_from(attitude.matrix());
    assert!((turn * body * turn.transpose() - space).amax() < 1e-13);
}
