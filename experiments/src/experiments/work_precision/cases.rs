//! The bodies, starts and forces of the comparison.

use polhode::body::{Body, Force, Point};
use polhode::catalogue;
use polhode::inertia::Inertia;
use polhode::num::{Dd, Random};
use polhode::rotation::{Quat, Vec3};
use polhode::truth::{AGREEMENT, Truth};
use polhode_files::error::{Error, unexpected};
use polhode_files::text::short;

use super::super::separatrix::ascending;
use crate::experiment::Scale;
use crate::statistics::rounded;

pub(super) const SEED: u64 = 1967;

/// A body with an ensemble of starts: one panel of the figure.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Moments, forces and starts, for readers.
    pub(super) what: String,
    pub(super) body: Body,
    pub(super) starts: Vec<Point<Dd>>,
    /// About the time of one radian, s, a power of two.
    pub(super) unit: f64,
    /// Times of comparison, in units.
    pub(super) horizons: &'static [f64],
}

/// What is asked of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Free,
    Separatrix,
    FastTop,
    Upright,
    AsymmetricTop,
    Orbit,
}

impl Kind {
    pub(super) fn name(self) -> &'static str {
        match self {
            Kind::Free => "free body",
            Kind::Separatrix => "free body near the separatrix",
            Kind::FastTop => "fast symmetric top",
            Kind::Upright => "symmetric top near upright",
            Kind::AsymmetricTop => "asymmetric top",
            Kind::Orbit => "body in orbit",
        }
    }
}

/// Angular velocity in the body, rad/s, and attitude of a start.
type Start = ([f64; 3], [f64; 4]);

const FREE: [(&str, [f64; 3]); 5] = [
    ("textbook", [1.0, 2.0, 3.0]),
    ("dyadic", [0.625, 0.75, 1.0]),
    ("toutatis", [1.0, 3.0836, 3.235]),
    ("racket", [0.0389, 0.4619, 0.4993]),
    ("spacecraft", [0.0241, 0.0234, 0.0201]),
];

/// Figure VII.5.3 of Hairer, Lubich and Wanner, and Kovalevskaya's top: moments, weight moment, rad/s.
const HEAVY: [(&str, [f64; 3], [f64; 3], f64); 2] = [
    ("asymmetric top", [0.5, 0.85, 1.0], [0.0, 0.0, 1.0], 1.3),
    ("Kovalevskaya top", [2.0, 2.0, 1.0], [1.3, 0.0, 0.0], 1.0),
];

/// Beyond this horizon, in units, runs go only from the first `FEW` starts.
pub(super) const LONG: f64 = 1e4;
pub(super) const FEW: usize = 5;

/// Up to this angle, rad, motions without closed form are known beyond it.
const FAR: f64 = 1e-7;

/// Share of the angular velocity across the middle axis of a start next to the separatrix; and the tilt in rad of a top that
/// is nearly upright.
const NEAR: f64 = 1e-3;

/// Across its axis a fast top turns at about this share of its spin.
const ACROSS: f64 = 0.03;

/// Spin of the nearly upright top over the least that holds it upright.
const SPIN: f64 = 0.9;

/// Mean motion of the bodies in orbit, rad/s.
const MEAN_MOTION: f64 = 0.125;

/// All cases of a scale.
pub(super) fn all(scale: Scale) -> Result<Vec<Case>, Error> {
    // a closed form is known at any time, a run in double-double costs its time
    let closed: &[f64] = scale.pick(&[1e2], &[1e2, 1e3], &[1e2, 1e4, 1e6]);
    let followed: &[f64] = scale.pick(&[1e2], &[1e2, 1e3], &[1e2, 1e3, 1e4, 1e5]);
    let members = scale.pick(2, 3, 11);
    let mut cases: Vec<Case> = Vec::new();
    for (name, moments) in &FREE[..scale.pick(1, 2, FREE.len())] {
        let body = Body::free(Inertia::from_moments(*moments).map_err(unexpected)?);
        let starts = drawn(cases.len(), members, |random| (anywhere(random, 1.0), UPRIGHT));
        let how = "ω = 1 rad/s in all directions";
        let name_here = format!("{name}, generic");
        cases.push(Case::new(name_here, Kind::Free, body.clone(), (starts, how.into()), closed)?);
        let [least, middle, largest] = ascending(Vec3(*moments));
        let starts = drawn(cases.len(), members, |random| {
            let (sin, cos) = libm::sincos(random.between(0.0, TURN));
            let mut near = [0.0; 3];
            (near[least], near[middle], near[largest]) = (NEAR * cos, 1.0, NEAR * sin);
            (near, UPRIGHT)
        });
        let how = format!("ω = 1 rad/s within {NEAR} rad of the middle axis");
        cases.push(Case::new(format!("{name}, separatrix"), Kind::Separatrix, body, (starts, how), closed)?);
    }
    for name in &["simo-wong", "bruls-cardona"][..scale.pick(1, 2, 2)] {
        let top = catalogue::top(name).ok_or_else(|| unexpected("a top of the catalogue is missing"))?;
        let body = top.body().map_err(unexpected)?;
        let speed = Vec3(top.omega_body).norm();
        let starts = drawn(cases.len(), members, |random| {
            let off = random.normal_vector() * (ACROSS * speed);
            ([0, 1, 2].map(|k| top.omega_body[k] + off[k]), any_attitude(random))
        });
        let how = format!("ω about {} rad/s along the axis, every tilt", short(rounded(speed)));
        cases.push(Case::new(format!("{name} top"), Kind::FastTop, body, (starts, how), closed)?);
    }
    cases.push(nearly_upright(cases.len(), members, closed)?);
    for (name, moments, weight, speed) in HEAVY.into_iter().take(scale.pick(1, 2, 2)) {
        let inertia = Inertia::from_moments(moments).map_err(unexpected)?;
        let body = Body::heavy(inertia, weight.into()).map_err(unexpected)?;
        let starts = drawn(cases.len(), members, |random| (anywhere(random, speed), any_attitude(random)));
        let how = format!("ω = {speed} rad/s in all directions, every attitude");
        cases.push(Case::new(name.into(), Kind::AsymmetricTop, body, (starts, how), followed)?);
    }
    let orbiting: &[f64] = scale.pick(&[], &[1e2], &[1e2, 1e3, 1e5]);
    let in_orbit = [FREE[4], FREE[2]];
    for (name, moments) in &in_orbit[..scale.pick(0, 1, 2)] {
        let inertia = Inertia::from_moments(*moments).map_err(unexpected)?;
        let force = Force::gravity_gradient(MEAN_MOTION, 0.0).map_err(unexpected)?;
        let body = Body::free(inertia).with(force);
        let starts = drawn(cases.len(), members, |random| (anywhere(random, 1.0), any_attitude(random)));
        let how = format!("circular orbit at {MEAN_MOTION} rad/s, ω = 1 rad/s in all directions");
        cases.push(Case::new(format!("{name} in orbit"), Kind::Orbit, body, (starts, how), orbiting)?);
    }
    Ok(cases)
}

/// A symmetric top that spins too slowly to stay upright, and begins next to the motion that leaves the vertical and comes
/// back to it in infinite time.
fn nearly_upright(case: usize, members: u64, horizons: &'static [f64]) -> Result<Case, Error> {
    let (across, along, weight) = (1.0, 0.5, 1.0);
    let inertia = Inertia::from_moments([across, across, along]).map_err(unexpected)?;
    let body = Body::heavy(inertia, [0.0, 0.0, weight].into()).map_err(unexpected)?;
    // Klein and Sommerfeld: it stays upright where (C ω)² ≥ 4 A M g l
    let spin = SPIN * 2.0 * libm::sqrt(across * weight) / along;
    let starts = drawn(case, members, |random| {
        let (sin, cos) = libm::sincos(random.between(0.0, TURN));
        ([0.0, 0.0, spin], [1.0, 0.5 * NEAR * cos, 0.5 * NEAR * sin, 0.0])
    });
    let how = format!("{SPIN} of the spin that holds it upright, tilted by {NEAR} rad");
    Case::new("upright top".into(), Kind::Upright, body, (starts, how), horizons)
}

const UPRIGHT: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
const TURN: f64 = 2.0 * std::f64::consts::PI;

/// `members` starts, each from random numbers of its own.
fn drawn(case: usize, members: u64, mut draw: impl FnMut(&mut Random) -> Start) -> Vec<Start> {
    let random = Random::new(SEED);
    (0..members).map(|member| draw(&mut random.stream(((case as u64) << 32) | member))).collect()
}

fn anywhere(random: &mut Random, speed: f64) -> [f64; 3] {
    (random.normal_vector().normalize() * speed).into()
}

fn any_attitude(random: &mut Random) -> [f64; 4] {
    [(); 4].map(|()| random.normal())
}

impl Case {
    fn new(
        name: String,
        kind: Kind,
        body: Body,
        (starts, how): (Vec<Start>, String),
        horizons: &'static [f64],
    ) -> Result<Case, Error> {
        let speed = starts.first().map_or(0.0, |start| Vec3(start.0).norm());
        let point = |(omega, attitude): Start| {
            body.enter_omega(Quat::from_components(attitude), Vec3(omega)).map_err(unexpected)
        };
        let starts = starts.into_iter().map(point).collect::<Result<_, _>>()?;
        let moments = body.rotor().moments::<f64>();
        let least = moments.0.into_iter().fold(f64::INFINITY, f64::min);
        let weight = body.linear_potential::<f64>().map_or(0.0, |linear| linear.moment.norm());
        // a top at rest moves at the rate of a pendulum
        let rate = speed + libm::sqrt(weight / least);
        let unit = libm::exp2(libm::round(-libm::log2(rate)));
        let list = moments.0.map(|moment| short(rounded(moment * body.scale()))).join(", ");
        let heavy = if weight > 0.0 { ", heavy" } else { "" };
        let what = format!("moments {list} kg m²{heavy}; {how}");
        Ok(Case { name, kind, what, body, starts, unit, horizons })
    }

    /// How many of the horizons every run goes to.
    pub(super) fn common(&self) -> usize {
        self.horizons.iter().filter(|horizon| **horizon <= LONG).count()
    }

    /// Whether its motion has a closed form.
    fn is_closed(&self) -> bool {
        !matches!(self.kind, Kind::AsymmetricTop | Kind::Orbit)
    }

    /// The true motion from a start, as far as runs go from there; of a motion without closed form up to `LONG`.
    pub(super) fn motion(&self, start: usize) -> Result<Truth, Error> {
        let times = self.looks(|horizon| self.is_closed() || horizon <= LONG);
        Truth::from_point(&self.body, self.starts[start].to_f64(), 0.0, &times, AGREEMENT).map_err(unexpected)
    }

    /// The same up to the horizon beyond, from one of the first `FEW` starts, to `FAR` rad; `None` where [`motion`](Self::motion)
    /// goes so far.
    pub(super) fn far_motion(&self, start: usize) -> Result<Option<Truth>, Error> {
        let times = self.looks(|horizon| horizon > LONG);
        if self.is_closed() || times.is_empty() {
            return Ok(None);
        }
        let truth = Truth::to_accuracy(&self.body, self.starts[start].to_f64(), 0.0, &times, FAR);
        truth.map(Some).map_err(unexpected)
    }

    /// The finest accuracy that is judged up to a horizon, rad.
    pub(super) fn finest(&self, horizon: f64) -> f64 {
        if horizon > LONG && !self.is_closed() { 10.0 * FAR } else { 0.0 }
    }

    /// Times of the looks, s: 32 up to each of the horizons that are taken.
    fn looks(&self, taken: impl Fn(f64) -> bool) -> Vec<f64> {
        let looks = |horizon: &f64| {
            let every = horizon * self.unit / 32.0;
            (1..=32).map(move |k| every * f64::from(k))
        };
        let taken = self.horizons.iter().filter(|horizon| taken(**horizon));
        let mut times: Vec<f64> = taken.flat_map(looks).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }
}
