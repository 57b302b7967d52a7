//! The motion of one free body from one start, in the solver frame.

use std::sync::OnceLock;

use super::addition::{Addition, Curve};
use super::character::{AtRest, Character};
use super::circulation::Circulation;
use super::derivative::Variation;
use super::phase::{Spin, pair, steady};
use super::polhode::Polhode;
use super::theta::{Points, Theta};
use crate::body::{Phase, Point};
use crate::num::{Dd, Instructions, LANES, Lane, Precise};
use crate::rotation::{Quat, Vec3};

/// Constants of one motion, worked out once; then any time in O(1).
#[derive(Clone, Debug)]
pub(crate) struct FreeOrbit {
    moments: Vec3<Dd>,
    start: Point<Dd>,
    /// |m|.
    norm: Dd,
    kind: Kind,
}

/// What becomes of the momentum in the body.
#[derive(Clone, Debug)]
enum Kind {
    /// There is none: the attitude stays.
    Rest,
    /// It is fixed, and the body turns about it: a sphere, a pure spin.
    Steady(Box<Spin>),
    /// It moves along its polhode.
    Circulating(Box<Circulating>),
}

/// A polhode with both its forms: theta functions in `f64`, Carlson's integrals in double-double when asked for.
#[derive(Clone, Debug)]
struct Circulating {
    polhode: Polhode<Dd>,
    momentum: Vec3<Dd>,
    quick: Theta,
    /// Large, and seldom asked for.
    precise: OnceLock<Box<Circulation<Dd>>>,
}

impl Circulating {
    fn precise(&self) -> &Circulation<Dd> {
        self.precise
            .get_or_init(|| Box::new(Circulation::of(self.polhode.clone(), self.momentum).with_period()))
    }
}

/// What is known of an orbit before its theta functions.
struct Path {
    moments: Vec3<Dd>,
    start: Point<Dd>,
    norm: Dd,
    /// Where the momentum moves in the body.
    polhode: Option<Polhode<Dd>>,
}

impl Path {
    /// With the theta functions of its polhode.
    fn orbit(self, quick: Option<Theta>) -> FreeOrbit {
        let Path { moments, start, norm, polhode } = self;
        let momentum = start.momentum_body;
        let kind = if norm == Dd::ZERO {
            Kind::Rest
        } else if let Some((polhode, quick)) = polhode.zip(quick) {
            Kind::Circulating(Box::new(Circulating { polhode, momentum, quick, precise: OnceLock::new() }))
        } else {
            let (axis, rate) = steady(moments, momentum, norm);
            Kind::Steady(Box::new(Spin::new(axis, rate)))
        };
        FreeOrbit { moments, start, norm, kind }
    }
}

/// Fewer times than these are taken one by one.
const FEW: usize = 8;

impl FreeOrbit {
    /// Of a body with the principal `moments`, from `start` at t = 0.
    pub(crate) fn new(moments: Vec3<Dd>, start: Point<Dd>) -> Self {
        let (norm, polhode) = Polhode::of_momentum(moments, start.momentum_body);
        let path = Path { moments, start, norm, polhode };
        let quick =
            path.polhode.as_ref().map(|polhode| Theta::of(polhode, start.attitude, start.momentum_body));
        path.orbit(quick)
    }

    /// The same of each of `bodies`, with the bits that it has alone.
    pub(crate) fn of_each(bodies: &[(Vec3<Dd>, Point<Dd>)]) -> Vec<Self> {
        let momenta: Vec<_> = bodies.iter().map(|(moments, start)| (*moments, start.momentum_body)).collect();
        let path = |(&(moments, start), (norm, polhode))| Path { moments, start, norm, polhode };
        let paths: Vec<Path> = bodies.iter().zip(Polhode::of_each(&momenta)).map(path).collect();
        let circulating = paths.iter().filter_map(|path| Some((path, path.polhode.as_ref()?)));
        let motions: Vec<_> = circulating
            .map(|(path, polhode)| (polhode, path.start.attitude, path.start.momentum_body))
            .collect();
        let mut quick = Theta::of_each(&motions).into_iter();
        let orbit = |path: Path| {
            let quick = path.polhode.as_ref().and_then(|_| quick.next());
            path.orbit(quick)
        };
        paths.into_iter().map(orbit).collect()
    }

    /// The point at the time `t` (s).
    ///
    /// The quaternion is the continuous lift from the start: it does not jump from `q` to `−q`.
    #[inline]
    pub(crate) fn at(&self, t: Dd) -> Point<f64> {
        if t == Dd::ZERO {
            return self.start.to_f64();
        }
        let quick = match &self.kind {
            Kind::Circulating(orbit) => orbit.quick.at(pair(t)),
            Kind::Steady(spin) => spin.quick(pair(t)).map(|turn| {
                let start = self.start.to_f64();
                (start.attitude * turn, start.momentum_body)
            }),
            Kind::Rest => None,
        };
        match quick {
            Some((attitude, momentum_body)) => Point::new(attitude, momentum_body),
            None => self.at_dd(t).to_f64(),
        }
    }

    /// Gives `each` attitude and momentum at the `times` (s), with their numbers.
    pub(crate) fn at_many(&self, times: &[f64], by: Instructions, mut each: impl FnMut(usize, Phase<f64>)) {
        let mut lanes = (times.len() >= FEW).then(Points::new);
        for (block, times) in times.chunks(LANES).enumerate() {
            let together = match (&self.kind, &mut lanes) {
                // what a block takes is as long as a dozen single times
                (Kind::Circulating(orbit), Some(lanes)) if times.len() >= FEW => {
                    let mut t = Lane::ZERO;
                    t[..times.len()].copy_from_slice(times);
                    orbit.quick.at_all(&t, lanes, by)
                }
                _ => false,
            };
            // one call of `each`, so that it is inlined and no point waits to be read from memory
            let point = lanes.as_ref().filter(|_| together).map(|lanes| lanes.by_lane());
            for (n, &t) in times.iter().enumerate() {
                let x = match &point {
                    Some(_) if t == 0.0 => self.start.to_f64().phase(),
                    Some(point) => point(n),
                    None => self.at(Dd::from(t)).phase(),
                };
                each(block * LANES + n, x);
            }
        }
    }

    /// The same in double-double, by an independent form of the solution.
    pub(crate) fn at_dd(&self, t: Dd) -> Point<Dd> {
        if t == Dd::ZERO {
            return self.start;
        }
        let (turn, momentum_body) = self.turned(t);
        Point::new(self.start.attitude * turn, momentum_body)
    }

    /// The turn since the start, and the momentum at the time `t`.
    fn turned(&self, t: Dd) -> (Quat<Dd>, Vec3<Dd>) {
        match &self.kind {
            Kind::Circulating(orbit) => orbit.precise().at(t),
            Kind::Steady(spin) => (spin.precise(t), self.start.momentum_body),
            Kind::Rest => (Quat::identity(), Vec3::zero()),
        }
    }

    /// The curve of the momentum by its invariants; `None` where the momentum is fixed, and next to the separatrix.
    pub(crate) fn curve<S: Precise>(&self) -> Option<Curve<S>> {
        match &self.kind {
            Kind::Circulating(orbit) => Curve::of(&orbit.polhode),
            Kind::Rest | Kind::Steady(_) => None,
        }
    }

    /// The map of this motion for the time `h`, without functions of a phase; `None` where it has no such
    /// [curve](Self::curve), and where h is too long a time.
    pub(crate) fn addition<S: Precise>(&self, h: Dd) -> Option<Addition<S>> {
        let Kind::Circulating(orbit) = &self.kind else { return None };
        Addition::of(&orbit.polhode, self.moments, h, self.start.momentum_body, || self.turned(h))
    }

    /// The constants of the derivative by the start and the moments.
    pub(super) fn variation(&self) -> Variation {
        let polhode = match &self.kind {
            Kind::Circulating(orbit) => Some(&orbit.polhode),
            Kind::Rest | Kind::Steady(_) => None,
        };
        Variation::new(self.moments, self.start.momentum_body, polhode)
    }

    /// |m|, which stays.
    pub(super) fn momentum_norm(&self) -> Dd {
        self.norm
    }

    /// The point at the start.
    pub(super) fn start(&self) -> Point<Dd> {
        self.start
    }

    /// Periods, mode and distance to the separatrix.
    pub(super) fn character(&self) -> Result<Character, AtRest> {
        match &self.kind {
            Kind::Rest => Err(AtRest),
            Kind::Steady(spin) => {
                let moment = self.norm / spin.rate();
                Ok(Character::steady(spin.rate(), moment, self.moments[self.moments.ascending()[1]]))
            }
            Kind::Circulating(orbit) => Ok(Character::circulating(&orbit.polhode, orbit.precise())),
        }
    }

    /// How often the momentum along the axis of the middle moment changes sign between the start and time `t` (s).
    pub(super) fn flips(&self, t: Dd) -> u64 {
        match &self.kind {
            Kind::Circulating(orbit) => orbit.precise().flips(t),
            Kind::Rest | Kind::Steady(_) => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Real as _;

    /// Orbits of every kind, most of them in the form that is worked out side by side, of both modes.
    fn bodies() -> Vec<(Vec3<Dd>, Point<Dd>)> {
        let mut bodies = Vec::new();
        for k in 0..120_u32 {
            let part = |ratio: f64| (f64::from(k) * ratio).fract();
            let (a, b, c) =
                (part(0.618_033_988_749_895), part(0.754_877_666_246_693), part(0.569_840_290_998_053));
            let moments = match k % 11 {
                3 => [1.0, 1.0, 1.4 + a],
                5 => [1.0; 3],
                7 => [1.0, 1.0 + 1e-15 * (1.0 + a), 1.5],
                _ => [1.0, 1.2 + 0.7 * a, 1.9 + 0.2 * b],
            };
            let momentum = match k % 13 {
                2 => [0.0, 0.0, 2.0 * a - 1.0],
                4 => [1e-9 * a, 1.0, -1e-7 * b],
                6 => [1e-280 * a, 1.0, 1e-270],
                8 => [0.1 * b, 1.0, 0.002 * c],
                10 => [0.002 * a, -1.0, 0.1 * c],
                9 => [0.0; 3],
                11 => [a * 1e90, c * 1e90, -b * 1e90],
                _ => [2.0 * a - 1.0, 1.2 * b - 0.6, 2.0 * c - 1.0],
            };
            let attitude = Quat::new(Dd::of(b), Vec3([a, -b, c].map(Dd::of))).normalized();
            let attitude = if k == 0 { Quat::identity() } else { attitude };
            bodies.push((Vec3(moments.map(Dd::of)), Point::new(attitude, Vec3(momentum.map(Dd::of)))));
        }
        // on the separatrix
        let momentum = Vec3([1.0, 0.5, 1.0].map(Dd::of));
        bodies.insert(20, (Vec3([0.75, 1.0, 1.5].map(Dd::of)), Point::new(Quat::identity(), momentum)));
        bodies
    }

    /// Every number of an orbit is the same alone and among others, however many these are.
    #[test]
    fn an_orbit_among_others_has_the_bits_of_one_alone() {
        let bodies = bodies();
        let alone: Vec<String> =
            bodies.iter().map(|&(moments, start)| format!("{:?}", FreeOrbit::new(moments, start))).collect();
        for together in [1, 2, 4, 15, 16, 17, 64, bodies.len()] {
            let orbits = bodies.chunks(together).flat_map(FreeOrbit::of_each);
            for (n, (orbit, alone)) in orbits.zip(&alone).enumerate() {
                assert_eq!(&format!("{orbit:?}"), alone, "body {n} of {together} together");
            }
        }
        // there are some of every kind
        let kinds = ["Direct", "Dual", "Limit", "Separatrix", "Steady", "Rest"];
        for (kind, least) in kinds.into_iter().zip([40, 16, 1, 1, 10, 5]) {
            let of_kind: Vec<_> = alone.iter().filter(|orbit| orbit.contains(kind)).collect();
            assert!(of_kind.len() >= least, "{kind}: {}", of_kind.len());
            // those that are worked out side by side in both modes
            for mode in ["about_smallest: true", "about_smallest: false"] {
                let count = of_kind.iter().filter(|orbit| orbit.contains(mode)).count();
                assert!(least < 16 || count >= 4, "{kind}, {mode}: {count}");
            }
        }
    }
}
