//! Programs with one mistake each: the mistake is named.
//!
//! The wrong equations are integrated here, by RK4 in short steps, not by the library.

use nalgebra::{Matrix3, Vector3};
use polhode::audit::{Direction, Judgement, Question, audit};
use polhode::body::Body;
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};

use super::records::{Form, Seeded, Writing, Written, moments, number, reading, record};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mistake {
    KinematicsSign,
    OmegaFrame,
    Transposed,
    MomentsOrder,
    Degrees,
    GyroscopicTermMissing,
    GyroscopicSign,
}

use Mistake::{
    Degrees, GyroscopicSign, GyroscopicTermMissing, KinematicsSign, MomentsOrder, OmegaFrame, Transposed,
};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Rates of the attitude and of ω in body axes, or for `Transposed` of L.
fn rates(
    mistake: Mistake,
    axis: usize,
    i: Vector3<f64>,
    q: Quat<f64>,
    w: Vec3<f64>,
) -> (Quat<f64>, Vec3<f64>) {
    let half = |omega: Vec3<f64>| q * Quat::new(0.0, omega) * 0.5;
    if mistake == Transposed {
        // ω = I⁻¹ R L where Rᵀ L belongs; w is L
        let m = q.rotate(w);
        return (half(Vec3([m[0] / i[0], m[1] / i[1], m[2] / i[2]])), Vec3::zero());
    }
    let mut term = [(i[1] - i[2]) * w[1] * w[2], (i[2] - i[0]) * w[2] * w[0], (i[0] - i[1]) * w[0] * w[1]];
    match mistake {
        GyroscopicTermMissing => term = [0.0; 3],
        GyroscopicSign => term[axis] = -term[axis],
        _ => {}
    }
    let turning = match mistake {
        KinematicsSign => half(-w),
        OmegaFrame => Quat::new(0.0, w) * q * 0.5,
        Degrees => half(w * if axis == 0 { 1.0 / DEGREE } else { DEGREE }),
        _ => half(w),
    };
    (turning, Vec3([term[0] / i[0], term[1] / i[1], term[2] / i[2]]))
}

fn step(
    mistake: Mistake,
    axis: usize,
    i: Vector3<f64>,
    h: f64,
    x: (Quat<f64>, Vec3<f64>),
) -> (Quat<f64>, Vec3<f64>) {
    let at = |x: (Quat<f64>, Vec3<f64>)| rates(mistake, axis, i, x.0, x.1);
    let along = |k: (Quat<f64>, Vec3<f64>), h: f64| (x.0 + k.0 * h, x.1 + k.1 * h);
    let a = at(x);
    let b = at(along(a, 0.5 * h));
    let c = at(along(b, 0.5 * h));
    let d = at(along(c, h));
    let q = x.0 + (a.0 + (b.0 + c.0) * 2.0 + d.0) * (h / 6.0);
    (q.normalized(), x.1 + (a.1 + (b.1 + c.1) * 2.0 + d.1) * (h / 6.0))
}

/// How often `mistake` is named in `number` records.
fn named(mistake: Mistake, name: &str, number: u64) -> u64 {
    let mut count = 0;
    for seed in 0..number {
        let mut random = Seeded(77_000 + seed);
        let typed = moments(&mut random);
        let mut i = Vector3::from(typed);
        if mistake == MomentsOrder {
            let (a, b) = random.one_of(&[(0, 1), (1, 2), (0, 2)]);
            i.swap_rows(a, b);
        }
        let direction = loop {
            let direction = random.direction();
            if direction.amin() > 0.2 {
                break direction;
            }
        };
        let axis = random.below(3);
        let spin = if mistake == Degrees && axis == 0 { DEGREE } else { 1.0 };
        let attitude: Quat<f64> = random.attitude().into();
        let omega = Vec3::from(direction * spin);
        let start_momentum = attitude.rotate_back(Vec3([i[0] * omega[0], i[1] * omega[1], i[2] * omega[2]]));
        let mut x = (attitude, if mistake == Transposed { start_momentum } else { omega });
        let inverse = Matrix3::from_diagonal(&i.map(|i| 1.0 / i));
        // rates in rad/s of a program that turns by degrees: its rows are farther apart
        let dt = random.between(0.01, 0.2) * if mistake == Degrees && axis != 0 { 5.0 } else { 1.0 };
        let rows = 150 + random.below(200);
        let mut states: Vec<Written> = Vec::new();
        for k in 0..rows {
            let omega = match mistake {
                Transposed => Vec3::from(inverse * Vector3::from(x.0.rotate(x.1))),
                _ => x.1,
            };
            if omega.norm() > 30.0 * spin {
                break; // a wrong sign may spin it up without end
            }
            states.push((dt * k as f64, x.0, omega));
            for _ in 0..20 {
                x = step(mistake, axis, i, dt / 20.0, x);
            }
        }
        let form = random.one_of(&[Form::Quaternion, Form::Matrix, Form::Angles, Form::Rodrigues]);
        let mut written = reading(&mut random, form);
        written.attitude = Some(Direction::BodyToSpace);
        written.omega_frame = Some(polhode::audit::Frame::Body);
        let noise = random.one_of(&[0.0, 0.0, 1e-6, 1e-4]);
        let file = record(&mut random, &states, &written, form, Writing { noise, ..Writing::EXACT });
        let mut question = Question::new(Some(Body::free(Inertia::from_moments(typed).unwrap())));
        question.claims.rate_unit = written.rate_unit;
        let verdict = audit(&file, &question).unwrap();
        assert_ne!(verdict.judgement, Judgement::Right, "{mistake:?} {seed}");
        if verdict.suspect.to_string() == name {
            count += 1;
        } else {
            println!(
                "{mistake:?} {seed} {form:?} axis {axis} dt {dt:.3} noise {noise}: {} {}\n  {}\n  {:?}",
                verdict.judgement, verdict.suspect, verdict.reading, verdict.ranking[0],
            );
        }
    }
    count
}

#[test]
fn each_mistake_is_named() {
    let number = number(4);
    let counts = [
        (KinematicsSign, "kinematics-sign"),
        (OmegaFrame, "omega-frame"),
        (Transposed, "transposed"),
        (MomentsOrder, "moments-order"),
        (Degrees, "degrees"),
        (GyroscopicTermMissing, "gyroscopic-term-missing"),
        (GyroscopicSign, "gyroscopic-sign"),
    ]
    .map(|(mistake, name)| (name, named(mistake, name, number)));
    println!("{counts:?} of {number}");
    assert!(counts.iter().all(|(_, count)| *count == number), "{counts:?} of {number}");
}
