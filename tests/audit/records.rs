//! Records in random conventions, of motions that are known.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::audit::{
    AngleUnit, Angles, Attitudes, Direction, Frame, QuaternionOrder, RateUnit, Reading, Trajectory, Turns,
};
use polhode::body::{Body, State};
use polhode::inertia::Inertia;
use polhode::rotation::{EulerSequence, Quat, Vec3};

/// How many records to draw: `usual`, or the number in the environment variable POLHODE_AUDITS.
pub(crate) fn number(usual: u64) -> u64 {
    std::env::var("POLHODE_AUDITS").ok().and_then(|number| number.parse().ok()).unwrap_or(usual)
}

/// SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Seeded(pub(crate) u64);

impl Seeded {
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.uniform() * count as f64) as usize
    }
    pub(crate) fn one_of<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
    pub(crate) fn direction(&mut self) -> Vector3<f64> {
        Vector3::new(self.normal(), self.normal(), self.normal()).normalize()
    }
    pub(crate) fn attitude(&mut self) -> UnitQuaternion<f64> {
        UnitQuaternion::new_normalize(Quaternion::new(
            self.normal(),
            self.normal(),
            self.normal(),
            self.normal(),
        ))
    }
}

/// Moments that differ by some per cent at least, of a body with three different radii of gyration.
pub(crate) fn moments(random: &mut Seeded) -> [f64; 3] {
    loop {
        let [a, b, c] = [0; 3].map(|_| random.between(0.1, 1.0));
        let i = [b + c, a + c, a + b];
        let apart = |x: f64, y: f64| (x - y).abs() / (x + y);
        if apart(i[0], i[1]).min(apart(i[1], i[2])).min(apart(i[0], i[2])) > 0.04 {
            return i;
        }
    }
}

/// A free body that tumbles.
pub(crate) fn tumbling(random: &mut Seeded) -> (Body, State, f64) {
    let body = Body::free(Inertia::from_moments(moments(random)).unwrap());
    let spin = 10_f64.powf(random.between(-1.0, 1.0));
    let direction = loop {
        let direction = random.direction();
        if direction.amin() > 0.15 {
            break direction;
        }
    };
    let start = body.state(random.attitude(), direction * spin).unwrap();
    (body, start, spin)
}

/// The numbers of a state in the convention `reading`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Form {
    Quaternion,
    Matrix,
    Angles,
    Rodrigues,
}

pub(crate) fn reading(random: &mut Seeded, form: Form) -> Reading {
    let mut reading = Reading::default();
    reading.attitude = Some(random.one_of(&[Direction::BodyToSpace, Direction::SpaceToBody]));
    match form {
        Form::Quaternion => {
            let orders = [QuaternionOrder::ScalarFirst, QuaternionOrder::ScalarLast];
            reading.quaternion = Some(random.one_of(&orders));
        }
        Form::Angles => {
            let sequence = random.one_of(&EulerSequence::ALL);
            let turns = random.one_of(&[Turns::Intrinsic, Turns::Extrinsic]);
            let unit = random.one_of(&[AngleUnit::Radians, AngleUnit::Degrees]);
            reading.angles = Some(Angles { sequence, turns, unit });
        }
        Form::Matrix | Form::Rodrigues => {}
    }
    reading.omega_frame = Some(random.one_of(&[Frame::Body, Frame::Space]));
    reading.rate_unit = Some(random.one_of(&RateUnit::ALL));
    reading
}

/// How numbers are written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Writing {
    pub(crate) single: bool,
    pub(crate) digits: usize,
    /// Relative to the size of a column.
    pub(crate) noise: f64,
}

impl Writing {
    pub(crate) const EXACT: Writing = Writing { single: false, digits: 17, noise: 0.0 };

    pub(crate) fn write(self, random: &mut Seeded, x: f64, size: f64) -> f64 {
        let noisy = if self.noise > 0.0 { x + self.noise * size * random.normal() } else { x };
        let rounded = if self.single { f64::from(noisy as f32) } else { noisy };
        format!("{rounded:.*e}", self.digits - 1).parse().unwrap()
    }
}

/// A state to be written: attitude, body → space, and ω in body axes.
pub(crate) type Written = (f64, Quat<f64>, Vec3<f64>);

/// The record of `states` in this library's convention.
pub(crate) fn plain(states: &[Written]) -> Trajectory {
    plain_in(states, Writing::EXACT)
}

/// The same in another writing.
pub(crate) fn plain_in(states: &[Written], writing: Writing) -> Trajectory {
    let mut convention = Reading::default();
    convention.rate_unit = Some(RateUnit::RadiansPerSecond);
    record(&mut Seeded(3), states, &convention, Form::Quaternion, writing)
}

/// The record of `states` in the convention `reading`.
pub(crate) fn record(
    random: &mut Seeded,
    states: &[Written],
    reading: &Reading,
    form: Form,
    writing: Writing,
) -> Trajectory {
    let size = states.iter().map(|(_, _, w)| w.norm_squared()).sum::<f64>() / states.len() as f64;
    let unit = reading.rate_unit.unwrap().radians_per_second(1.0);
    let size = size.sqrt() / unit;
    let (mut quaternions, mut matrices, mut triples, mut rates) = (vec![], vec![], vec![], vec![]);
    for (_, q, omega) in states {
        let rotation: UnitQuaternion<f64> = (*q).into();
        let written =
            if reading.attitude == Some(Direction::SpaceToBody) { rotation.inverse() } else { rotation };
        match form {
            Form::Quaternion => {
                let [w, x, y, z] = [written.w, written.i, written.j, written.k];
                let ordered = match reading.quaternion {
                    Some(QuaternionOrder::ScalarLast) => [x, y, z, w],
                    _ => [w, x, y, z],
                };
                quaternions.push(ordered.map(|x| writing.write(random, x, 1.0)));
            }
            Form::Matrix => {
                let m = written.to_rotation_matrix();
                let rows: [f64; 9] = std::array::from_fn(|n| m[(n / 3, n % 3)]);
                matrices.push(rows.map(|x| writing.write(random, x, 1.0)));
            }
            Form::Rodrigues => {
                let written = if written.w < 0.0 { -written.into_inner() } else { written.into_inner() };
                let sigma = [written.i, written.j, written.k].map(|v| v / (1.0 + written.w));
                triples.push(sigma.map(|x| writing.write(random, x, 1.0)));
            }
            Form::Angles => {
                let Angles { sequence, turns, unit } = reading.angles.unwrap();
                let [i, j, k] = sequence.axes();
                let name = |axes: [usize; 3]| axes.map(|axis| ["x", "y", "z"][axis]).concat();
                let angles = match turns {
                    Turns::Intrinsic => sequence.angles(written).angles,
                    Turns::Extrinsic => {
                        let reversed: EulerSequence = name([k, j, i]).parse().unwrap();
                        let [a, b, c] = reversed.angles(written).angles;
                        [c, b, a]
                    }
                };
                triples.push(angles.map(|x| writing.write(random, x / unit.radians(), 1.0 / unit.radians())));
            }
        }
        let shown =
            if reading.omega_frame == Some(Frame::Space) { q.normalized().rotate(*omega) } else { *omega };
        rates.push(shown.0.map(|x| writing.write(random, x / unit, size)));
    }
    let attitude = match form {
        Form::Quaternion => Attitudes::Quaternions(quaternions),
        Form::Matrix => Attitudes::Matrices(matrices),
        Form::Angles => Attitudes::Angles(triples),
        Form::Rodrigues => Attitudes::Rodrigues(triples),
    };
    let times = states.iter().map(|(t, _, _)| *t).collect();
    Trajectory::new(times).with_attitude(attitude).with_rates(rates)
}
