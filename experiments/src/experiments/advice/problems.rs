//! Random bodies, starts, forces and demands.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::advise::Demand;
use polhode::body::{Body, Force, State, Time, Torque};
use polhode::inertia::Inertia;
use polhode::num::{Random, Real};
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::{Error, unexpected};

/// What acts.
pub(super) const KINDS: [&str; 11] = [
    "constant torque in the body",
    "constant torque in space",
    "spin-up",
    "weight",
    "gravity gradient",
    "gravity gradient on an ellipse",
    "drag",
    "quadratic drag",
    "smooth late thruster",
    "switched thruster",
    "gravity gradient and drag",
];

/// The longest turns, rad, of tops, which are chaotic, and on ellipses, whose series are dear.
const LONGEST_TOP: f64 = 300.0;
const LONGEST_ELLIPSE: f64 = 3e3;

/// A body, its start and what is wanted of it.
pub(super) struct Problem {
    pub(super) kind: usize,
    pub(super) body: Body,
    pub(super) start: State,
    pub(super) demand: Demand,
    /// Laws that series take, each up to a time, s, one after the other.
    laws: Vec<(f64, Body)>,
}

impl Problem {
    /// The law that acts from `time` on, and until when.
    pub(super) fn law_at(&self, time: f64) -> (f64, &Body) {
        let law = self.laws.iter().find(|(end, _)| *end > time);
        law.map_or((f64::INFINITY, &self.body), |(end, body)| (*end, body))
    }
}

/// `each` problems of every kind.
pub(super) fn all(seed: u64, each: usize, longest: f64) -> Result<Vec<Problem>, Error> {
    let random = Random::new(seed);
    let mut all = Vec::new();
    for kind in 0..KINDS.len() {
        for n in 0..each {
            all.push(problem(kind, &mut random.stream((kind * 1000 + n) as u64), longest)?);
        }
    }
    Ok(all)
}

fn problem(kind: usize, random: &mut Random, longest: f64) -> Result<Problem, Error> {
    let mut log = |low: f64, high: f64| libm::exp(random.between(libm::log(low), libm::log(high)));
    let longest = match kind {
        3 => longest.min(LONGEST_TOP),
        5 => longest.min(LONGEST_ELLIPSE),
        _ => longest,
    };
    let (angle, error) = (log(10.0, longest), log(1e-9, 1e-3));
    let size = log(1e-2, 1e2);
    let rate = log(1e-3, 1e1);
    // what a weak torque adds to the rate is of the size of the rate
    let (gain, weak) = (log(3.0, 100.0), log(1e-2, 3.0) / angle);
    // three densities along the axes: moments of a body that exists
    let [a, b, c] = [(); 3].map(|()| random.between(0.1, 1.0));
    let moments = [b + c, a + c, a + b].map(|i| size * i);
    let free = Body::free(Inertia::from_moments(moments).map_err(unexpected)?);
    let direction = |random: &mut Random| random.normal_vector().normalize();
    let omega = direction(random) * rate;
    let attitude = UnitQuaternion::from_scaled_axis(random.normal_vector());
    let start = free.state(attitude, omega).map_err(unexpected)?;
    let unit = size * rate * rate;
    let along = direction(random);
    let mut until = angle / rate;
    let mut laws = Vec::new();
    let forces = match kind {
        0 => vec![Force::constant_torque_body(along * unit * weak)],
        1 => vec![Force::constant_torque_space(along * unit * weak)],
        2 => {
            until = angle / (0.5 * rate * (1.0 + gain));
            let torque = moments[2] * rate * (gain - 1.0) / until;
            vec![Force::constant_torque_body(Vector3::new(0.0, 0.0, torque))]
        }
        3 => vec![Force::gravity(along * unit * random.between(0.05, 1.0))],
        4 => vec![Force::gravity_gradient(rate * random.between(0.01, 0.3), 0.0)],
        5 => vec![Force::gravity_gradient(rate * random.between(0.01, 0.3), random.between(0.01, 0.5))],
        6 => vec![Force::drag(size * random.between(0.01, 3.0) / until, 0.0)],
        7 => vec![Force::drag(0.0, size * random.between(0.01, 3.0) / (until * rate))],
        8 => {
            let (middle, width) = (until * random.between(0.5, 0.95), random.between(1.0, 10.0) / rate);
            let torque = along * unit * random.between(0.01, 0.3);
            vec![Ok(Force::torque("thruster", Bump { middle, width, torque: torque.into() }))]
        }
        9 => {
            let (begin, length) = (until * random.between(0.5, 0.8), random.between(1.0, 10.0) / rate);
            let (end, torque) = ((begin + length).min(until), along * unit * random.between(0.01, 0.3));
            let pushed = Force::constant_torque_body(torque).map_err(unexpected)?;
            laws =
                vec![(begin, free.clone()), (end, free.clone().with(pushed)), (f64::INFINITY, free.clone())];
            let switched = move |t, _, _| if t >= begin && t < end { torque } else { Vector3::zeros() };
            vec![Ok(Force::torque_fn("thruster", switched))]
        }
        _ => vec![
            Force::gravity_gradient(rate * random.between(0.01, 0.3), 0.0),
            Force::drag(size * random.between(0.01, 1.0) / until, 0.0),
        ],
    };
    let mut body = free;
    for force in forces {
        body = body.with(force.map_err(unexpected)?);
    }
    if laws.is_empty() {
        laws.push((f64::INFINITY, body.clone()));
    }
    let mut demand = Demand::new(until, error);
    demand.excluded = vec!["exact".into(), "taylor".into()];
    Ok(Problem { kind, body, start, demand, laws })
}

/// A torque in body axes that comes and goes: τ / (1 + s²)², s = (t − middle) / width.
struct Bump {
    middle: f64,
    width: f64,
    torque: Vec3<f64>,
}

impl<S: Real> Torque<S> for Bump {
    fn torque(&self, at: Time, _: Quat<S>, _: Vec3<S>) -> Vec3<S> {
        let one = S::of(1.0);
        let s = (at.seconds::<S>() - S::of(self.middle)) * S::of(1.0 / self.width);
        let share = one / (one + s * s);
        Vec3::of(self.torque) * (share * share)
    }
}
