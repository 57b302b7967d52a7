//! Programs with one mistake each, by RK4 in short steps.

use polhode::audit::{Convention, Direction, Frame};
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};

use super::motion::{Row, attitude, distinct, generic};
use super::writing::one_of;

/// A mistake, by the name of the suspect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mistake {
    KinematicsSign,
    OmegaFrame,
    Transposed,
    MomentsOrder,
    Degrees,
    GyroscopicTermMissing,
    GyroscopicSign,
}

impl Mistake {
    pub(super) const ALL: [Mistake; 7] = [
        Mistake::KinematicsSign,
        Mistake::OmegaFrame,
        Mistake::Transposed,
        Mistake::MomentsOrder,
        Mistake::Degrees,
        Mistake::GyroscopicTermMissing,
        Mistake::GyroscopicSign,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::KinematicsSign => "kinematics-sign",
            Self::OmegaFrame => "omega-frame",
            Self::Transposed => "transposed",
            Self::MomentsOrder => "moments-order",
            Self::Degrees => "degrees",
            Self::GyroscopicTermMissing => "gyroscopic-term-missing",
            Self::GyroscopicSign => "gyroscopic-sign",
        }
    }

    pub(super) fn meaning(self) -> &'static str {
        match self {
            Self::KinematicsSign => "dq/dt = -q w/2",
            Self::OmegaFrame => "w of the body used as if in space",
            Self::Transposed => "L turned into the body by R where R^T belongs",
            Self::MomentsOrder => "two moments exchanged",
            Self::Degrees => "deg/s used as rad/s in the attitude",
            Self::GyroscopicTermMissing => "no w x Iw",
            Self::GyroscopicSign => "one component of w x Iw with the wrong sign",
        }
    }
}

/// What a program with a mistake writes, and the moments that it is told to have.
pub(super) struct Wrong {
    pub(super) rows: Vec<Row>,
    pub(super) moments: [f64; 3],
}

const DEGREE: f64 = core::f64::consts::PI / 180.0;

/// Steps of RK4 between two rows.
const STEPS: u32 = 16;

/// A motion is written until it is so many times as fast as at its start, or as its momentum there.
const GROWTH: f64 = 8.0;

/// Rows of a motion at least.
const FEWEST: usize = 75;

/// What is moved: the attitude, and ω in body axes, or for [`Mistake::Transposed`] L.
type Moved = (Quat<f64>, Vec3<f64>);

/// A random motion with the mistake.
pub(super) fn wrong(mistake: Mistake, random: &mut Random) -> Wrong {
    let told = distinct(random);
    let mut moments = told;
    if mistake == Mistake::MomentsOrder {
        let (a, b) = one_of(random, [(0, 1), (1, 2), (0, 2)]);
        moments.swap(a, b);
    }
    let axis = random.below(3) as usize;
    let start: Quat<f64> = attitude(random).into();
    let omega = Vec3::from(generic(random));
    let momentum = start.rotate_back(omega.times(Vec3(moments)));
    let mut interval = random.between(0.02, 0.2);
    let count = 150 + random.below(150);
    let begin = (start, if mistake == Mistake::Transposed { momentum } else { omega });
    let written = |(attitude, moved): Moved| match mistake {
        Mistake::Transposed => over(attitude.rotate(moved), moments),
        _ => moved,
    };
    let rows = loop {
        let mut x = begin;
        let mut rows = Vec::new();
        for k in 0..count {
            let omega = written(x);
            // without |m| kept, some of these motions grow beyond all bounds
            if omega.norm().is_nan() || omega.norm() > GROWTH * begin.1.norm() {
                break;
            }
            rows.push(Row { t: k as f64 * interval, attitude: x.0, omega });
            for _ in 0..STEPS {
                x = step(mistake, axis, moments, interval / f64::from(STEPS), x);
            }
        }
        if rows.len() >= FEWEST {
            break rows;
        }
        interval *= 0.5;
    };
    Wrong { rows, moments: told }
}

/// What the program says of its convention: its attitude is from body to space, its angular velocity in body axes.
pub(super) fn claims(mistake: Mistake) -> Convention {
    let mut claims = Convention::default();
    if mistake == Mistake::MomentsOrder {
        claims.attitude = Some(Direction::BodyToSpace);
        claims.omega_frame = Some(Frame::Body);
    }
    claims
}

fn over(v: Vec3<f64>, moments: [f64; 3]) -> Vec3<f64> {
    Vec3([v[0] / moments[0], v[1] / moments[1], v[2] / moments[2]])
}

fn step(mistake: Mistake, axis: usize, moments: [f64; 3], h: f64, x: Moved) -> Moved {
    let rate = |x: Moved| rate(mistake, axis, moments, x);
    let on = |k: Moved, h: f64| (x.0 + k.0 * h, x.1 + k.1 * h);
    let a = rate(x);
    let b = rate(on(a, 0.5 * h));
    let c = rate(on(b, 0.5 * h));
    let d = rate(on(c, h));
    let attitude = x.0 + (a.0 + (b.0 + c.0) * 2.0 + d.0) * (h / 6.0);
    (attitude.normalized(), x.1 + (a.1 + (b.1 + c.1) * 2.0 + d.1) * (h / 6.0))
}

fn rate(mistake: Mistake, axis: usize, moments: [f64; 3], (q, moved): Moved) -> Moved {
    if mistake == Mistake::Transposed {
        return (q.rate(over(q.rotate(moved), moments)), Vec3::zero());
    }
    let omega = moved;
    let mut gyroscopic = omega.times(Vec3(moments)).cross(omega);
    match mistake {
        Mistake::GyroscopicTermMissing => gyroscopic = Vec3::zero(),
        Mistake::GyroscopicSign => gyroscopic.0[axis] = -gyroscopic.0[axis],
        _ => {}
    }
    let turned = match mistake {
        Mistake::KinematicsSign => q.rate(-omega),
        Mistake::OmegaFrame => Quat::new(0.0, omega) * q * 0.5,
        Mistake::Degrees => q.rate(omega * DEGREE),
        _ => q.rate(omega),
    };
    (turned, over(gyroscopic, moments))
}
