//! Rates that are too sparse for the weak form.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::{inertia::Inertia, num::Random};
use polhode_fit::{Method, Record, Settings, fit, simulate};

/// Half a sample a second of a body that turns by two radians in between, as of a satellite's beacon: the likelihood on the exact motion.
#[test]
fn sparse_telemetry_goes_to_the_likelihood() {
    let mut squares = 0.0;
    for stream in 0..6 {
        let mut random = Random::new(31).stream(stream);
        let turn = UnitQuaternion::from_scaled_axis(random.normal_vector()).to_rotation_matrix();
        let j =
            turn.matrix() * Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6)) * turn.matrix().transpose()
                / 5.6;
        let body = Inertia::from_tensor((j + j.transpose()) * 0.5).unwrap();
        // well off every axis
        let omega =
            if stream < 3 { turn * Vector3::new(0.6, 0.6, -0.5) } else { random.normal_vector().normalize() };
        let times: Vec<f64> = (0..600).map(|i| 2.0 * f64::from(i)).collect();
        let rates = simulate(&body, omega, &times, 0.01, &mut random).unwrap();
        let e = match fit(&Record::from_samples(&times, &rates).unwrap(), &Settings::default()) {
            Ok(e) => e,
            Err(error) => {
                println!("{error}");
                continue;
            }
        };
        assert_eq!(e.method, Method::ExactMotion);
        assert!((e.noise_sigma / 0.01 - 1.0).abs() < 0.15 && e.mirror.is_some() && e.attitudes.is_none());
        for (k, moment) in [1.0, 2.0, 2.6].into_iter().enumerate() {
            let off = (e.principal[k] - moment / 5.6) / e.sigma_principal[k];
            squares += off * off;
            assert!(e.sigma_principal[k] < 1e-3);
        }
    }
    assert!((0.3..2.5).contains(&(squares / 18.0)), "{squares}");
}
