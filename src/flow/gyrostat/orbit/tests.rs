//! The closed form against fixtures of 40 digits (tests/data/gyrostat, Taylor series) and against itself in double-double.

use super::*;
use crate::rotation::rotation_angle;

struct Case {
    scenario: String,
    moments: Vec3<Dd>,
    wheel: Vec3<Dd>,
    start: Point<Dd>,
    t: Dd,
    after: Point<Dd>,
}

fn cases() -> Vec<Case> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/gyrostat/reference.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let case = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        // those of the start are doubles
        let double = |at: usize| Dd::of(fields[at].parse().unwrap());
        let start = |at: usize| Vec3([0, 1, 2].map(|k| double(at + k)));
        let vector = |at: usize| Vec3([0, 1, 2].map(|k| fields[at + k].parse::<Dd>().unwrap()));
        let quat =
            |at: usize| Quat::from_components([0, 1, 2, 3].map(|k| fields[at + k].parse::<Dd>().unwrap()));
        Case {
            scenario: fields[0].into(),
            moments: start(2),
            wheel: start(5),
            start: Point::new(quat(11), start(8)),
            t: double(15),
            after: Point::new(quat(19), vector(16)),
        }
    };
    text.lines().skip(1).map(case).collect()
}

/// Errors of attitude (rad) and momentum (of |m|).
fn off(found: &Point<Dd>, truth: &Point<Dd>) -> [f64; 2] {
    let norm = truth.momentum_body.norm_of_any_size().hi();
    let momentum = (found.momentum_body - truth.momentum_body).norm_of_any_size().hi();
    let sign = (found.attitude - truth.attitude).magnitude() < 1.0;
    assert!(sign, "the other lift");
    [
        rotation_angle(found.attitude.normalized(), truth.attitude).hi(),
        if norm == 0.0 { momentum } else { momentum / norm },
    ]
}

#[test]
fn fixtures_of_all_regimes() {
    let mut worst: Vec<(String, [f64; 4])> = Vec::new();
    for case in cases() {
        let orbit = match GyrostatOrbit::new(case.moments, case.wheel, case.start) {
            Ok(orbit) => orbit,
            Err(reason) => {
                println!("{}: {reason}", case.scenario);
                continue;
            }
        };
        let [q, m] = off(&orbit.point_after(case.t).to_dd(), &case.after);
        let [q_dd, m_dd] = off(&orbit.point_at_dd(case.t), &case.after);
        if worst.last().is_none_or(|last| last.0 != case.scenario) {
            worst.push((case.scenario.clone(), [0.0; 4]));
        }
        if let Some(last) = worst.last_mut() {
            for (x, new) in last.1.iter_mut().zip([q, m, q_dd, m_dd]) {
                *x = x.max(new);
            }
        }
    }
    for (scenario, [q, m, q_dd, m_dd]) in worst {
        println!("{scenario:40} {q:.1e} {m:.1e}   {q_dd:.1e} {m_dd:.1e}");
    }
}
