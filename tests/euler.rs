//! Euler angles: all twelve sequences against products of elementary turns, in and out of gimbal lock.

use core::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::rotation::{EulerSequence, rotation_angle};
use proptest::prelude::*;

/// What a round trip may lose: three rounded angles of at most π and a rounded quaternion.
const ROUND_TRIP: f64 = 1e-15;

fn apart(a: UnitQuaternion<f64>, b: UnitQuaternion<f64>) -> f64 {
    rotation_angle(a.into(), b.into())
}

/// The product of turns about the named axes, formed by other code.
fn product(name: &str, angles: [f64; 3]) -> UnitQuaternion<f64> {
    let axis = |letter| match letter {
        'x' => Vector3::x_axis(),
        'y' => Vector3::y_axis(),
        _ => Vector3::z_axis(),
    };
    name.chars()
        .zip(angles)
        .map(|(letter, angle)| UnitQuaternion::from_axis_angle(&axis(letter), angle))
        .fold(UnitQuaternion::identity(), |q, turn| q * turn)
}

fn is_proper(sequence: EulerSequence) -> bool {
    sequence.axes()[0] == sequence.axes()[2]
}

proptest! {
    #![proptest_config(crate::cases::usual(256))]
    #[test]
    fn a_random_attitude_returns(w in -1.0..1.0, x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0_f64) {
        prop_assume!(w * w + x * x + y * y + z * z > 1e-6);
        let q = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        for sequence in EulerSequence::ALL {
            let found = sequence.angles(q);
            prop_assert!(!found.locked);
            let error = apart(sequence.attitude(found.angles), q);
            prop_assert!(error < ROUND_TRIP, "{sequence}: {error:.1e}");
        }
    }

    #[test]
    fn angles_return_as_they_were(a in -3.1..3.1, b in 0.05..1.5, c in -3.1..3.1_f64) {
        for sequence in EulerSequence::ALL {
            let q = sequence.attitude([a, b, c]);
            prop_assert!(apart(q, product(&sequence.to_string(), [a, b, c])) < 3e-15);
            let found = sequence.angles(q).angles;
            for (found, angle) in found.into_iter().zip([a, b, c]) {
                prop_assert!((found - angle).abs() < 2e-14, "{sequence}: {found} for {angle}"); // 1/sin 0.05 = 20
            }
        }
    }

    #[test]
    fn rates_and_angular_velocity_are_inverse(
        a in -3.1..3.1, b in 0.1..1.4, c in -3.1..3.1, u in -2.0..2.0, v in -2.0..2.0, w in -2.0..2.0_f64
    ) {
        for sequence in EulerSequence::ALL {
            let omega = sequence.omega_body([a, b, c], [u, v, w]);
            let rates = sequence.rates([a, b, c], omega).unwrap();
            for (rate, expected) in rates.into_iter().zip([u, v, w]) {
                prop_assert!((rate - expected).abs() < 2e-14, "{sequence}");
            }
        }
    }
}

#[test]
fn every_gimbal_lock_is_flagged_and_right() {
    for sequence in EulerSequence::ALL {
        let locks = if is_proper(sequence) { [0.0, PI] } else { [FRAC_PI_2, -FRAC_PI_2] };
        for lock in locks {
            for (first, third) in [(0.0, 0.0), (0.3, 0.0), (0.0, 2.9), (1.25, -0.7), (-3.0, -2.0), (PI, 1.0)]
            {
                let q = sequence.attitude([first, lock, third]);
                let found = sequence.angles(q);
                assert!(found.locked, "{sequence} at {lock}");
                assert_eq!(found.angles[2], 0.0, "the third angle is the free one");
                let error = apart(sequence.attitude(found.angles), q);
                assert!(error < ROUND_TRIP, "{sequence} at {lock}: {error:.1e}");
            }
        }
    }
}

#[test]
fn close_to_gimbal_lock_the_attitude_is_right() {
    for sequence in EulerSequence::ALL {
        let locks = if is_proper(sequence) { [0.0, PI] } else { [FRAC_PI_2, -FRAC_PI_2] };
        for lock in locks {
            let mut off = 0.3;
            while off > 1e-20 {
                for side in [off, -off] {
                    let q = product(&sequence.to_string(), [0.7, lock + side, -1.9]);
                    let error = apart(sequence.attitude(sequence.angles(q).angles), q);
                    assert!(error < ROUND_TRIP, "{sequence} {off:.1e} off {lock}: {error:.1e}");
                }
                off *= 0.316_227_766;
            }
        }
    }
}

#[test]
fn zxz_rates_are_those_of_the_lecture() {
    let zxz: EulerSequence = "zxz".parse().unwrap();
    let [phi, theta, psi] = [0.4, 1.1, -2.3_f64];
    let [phi_rate, theta_rate, psi_rate] = [0.7, -0.2, 1.9];
    let omega = zxz.omega_body([phi, theta, psi], [phi_rate, theta_rate, psi_rate]);
    let ((sin_theta, cos_theta), (sin_psi, cos_psi)) = (libm::sincos(theta), libm::sincos(psi));
    let expected = [
        phi_rate * sin_theta * sin_psi + theta_rate * cos_psi,
        phi_rate * sin_theta * cos_psi - theta_rate * sin_psi,
        psi_rate + phi_rate * cos_theta,
    ];
    for (omega, expected) in omega.iter().zip(expected) {
        assert!((omega - expected).abs() < 4e-16);
    }
    // the vertical in the body is (sin θ sin ψ, sin θ cos ψ, cos θ)
    let up = zxz.attitude([phi, theta, psi]).inverse() * Vector3::z();
    for (up, expected) in up.iter().zip([sin_theta * sin_psi, sin_theta * cos_psi, cos_theta]) {
        assert!((up - expected).abs() < 4e-16);
    }
}

#[test]
fn omega_is_the_derivative_of_the_attitude() {
    let (angles, rates, h) = ([0.4, 0.9, -2.3], [0.7, -0.2, 1.9], 1e-5);
    for sequence in EulerSequence::ALL {
        let moved = |sign: f64| sequence.attitude([0, 1, 2].map(|n| angles[n] + sign * h * rates[n]));
        let turn = (moved(-1.0).inverse() * moved(1.0)).scaled_axis() / (2.0 * h);
        assert!((turn - sequence.omega_body(angles, rates)).norm() < 1e-9, "{sequence}");
    }
}

#[test]
fn an_angle_of_any_size_has_an_attitude() {
    for sequence in EulerSequence::ALL {
        let attitude = sequence.attitude([f64::MAX, 1e31, -1e300]);
        assert!((attitude.norm() - 1.0).abs() < 1e-15, "{sequence}: {attitude}");
    }
}

#[test]
fn in_lock_a_reachable_velocity_has_rates_and_others_have_none() {
    for sequence in EulerSequence::ALL {
        let lock = if is_proper(sequence) { 0.0 } else { FRAC_PI_2 };
        let angles = [0.0, lock, 0.8];
        let omega = sequence.omega_body(angles, [0.3, 0.5, -0.2]);
        let rates = sequence.rates(angles, omega).unwrap();
        assert_eq!(rates[0], 0.0);
        assert!((sequence.omega_body(angles, rates) - omega).norm() < 1e-15);
        // what neither the middle nor the last axis gives
        let [_, j, k] = sequence.axes();
        let unit = |axis: usize| Vector3::from_fn(|n, _| if n == axis { 1.0 } else { 0.0 });
        let lost = product(&sequence.to_string()[2..], [0.8, 0.0, 0.0]).inverse() * unit(j).cross(&unit(k));
        assert_eq!(sequence.rates(angles, lost), None, "{sequence}");
    }
}

#[test]
fn unknown_sequences_are_refused_by_name() {
    for text in ["zzx", "xyw", "ZXZ", "zx", ""] {
        assert!(text.parse::<EulerSequence>().is_err());
    }
    let error = "zzx".parse::<EulerSequence>().unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no Euler sequence \"zzx\"; name three axes, no axis twice in a row, such as zxz or zyx"
    );
    for sequence in EulerSequence::ALL {
        assert_eq!(sequence.to_string().parse(), Ok(sequence));
    }
}
