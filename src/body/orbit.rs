//! Kepler's orbits of any eccentricity, in any plane: where a body is at which time.

use core::any::{Any, TypeId};
use core::cell::Cell;
use core::cmp::Ordering;
use core::f64::consts::PI;
use std::sync::Arc;

use super::force::finite;
use super::orbit_table::Table;
use super::time::reduced_angle;
use super::{ForceError, Time};
use crate::num::stumpff::{halvings, stumpff};
use crate::num::trig::nearest;
use crate::num::{Dd, Precise as _, Real};
use crate::rotation::{Quat, Vec3};

const NAME: &str = "orbit";

/// Newton's iteration descends monotonically, and for eccentricities near 1 slowly until it doubles the digits: it is done
/// before.
const MOST_DESCENTS: u32 = 2048;

/// Powers of larger eccentricities leave the range of doubles.
const STRAIGHT: f64 = 1e60;

/// A place in `f64`, before the orbit is turned in space.
#[derive(Clone, Copy)]
struct Seen {
    of: Asked,
    /// Since the least distance, s.
    time: Dd,
    place: (f64, Vec3<f64>),
}

/// Which orbit a place is on, but for its plane.
#[derive(Clone, Copy, PartialEq)]
enum Asked {
    Mean {
        rate: f64,
        eccentricity: f64,
    },
    AtPassage {
        rate: Dd,
        eccentricity: f64,
    },
    /// By the number of the table.
    Table(u64),
}

thread_local! {
    /// The last one: stages of a step, and forces at one of them, often ask for the same.
    static LAST: Cell<Option<Seen>> = const { Cell::new(None) };
}

/// The orbit of a body about a point mass: a circle, an ellipse, a parabola, a hyperbola, or a table of places.
///
/// In the x–y plane of space it runs counter-clockwise about +z with the least distance, at t = 0, on +x;
/// [`passing_at`](Self::passing_at) and [`in_plane`](Self::in_plane) say otherwise.
///
/// ```
/// use polhode::body::{Body, Force, Orbit};
/// use polhode::inertia::Inertia;
/// // past the Earth, GM = 3.986e14 m³/s², 38 000 km from its centre after a day
/// let flyby = Orbit::conic(3.986e14, 3.8e7, 4.2)?.passing_at(86_400.0)?.in_plane([0.3, 0.8, 1.1])?;
/// let gradient = Force::gravity_gradient_on(flyby);
/// let body = Body::free(Inertia::from_moments([0.61, 0.96, 1.0])?).with(gradient);
/// assert!(body.conserved().is_empty());
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Orbit {
    speed: Speed,
    eccentricity: f64,
    /// The time of the least distance, s.
    passage: f64,
    /// From the axes of the orbit, to the least distance, along the velocity there and along the normal, to space.
    plane: Option<Quat<Dd>>,
}

#[derive(Clone, Debug, PartialEq)]
enum Speed {
    /// The mean motion on a circle or an ellipse, rad/s.
    Mean(f64),
    /// √(GM/q³) with the least distance q, rad/s, and of a circle or an ellipse the period, s.
    AtPassage { rate: Dd, period: Option<Dd> },
    /// Where it is at which time.
    Table(Arc<Table>),
}

/// 3 GM/r³ in 1/s², and the direction to the body in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<S> {
    pub(crate) strength: S,
    pub(crate) direction: Vec3<S>,
}

/// The true anomaly f on a conic with the semi-latus rectum p: `f' = k (p/r)²` and 3 GM/r³ = 3 k² (p/r)³.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrueAnomaly<S> {
    /// To the body, and along the normal of the orbit, in space.
    pub(crate) direction: Vec3<S>,
    pub(crate) normal: Vec3<S>,
    /// p/r = 1 + e cos f.
    pub(crate) near: S,
    /// e cos f and e sin f; `None` of a circle.
    pub(crate) eccentric: Option<[S; 2]>,
    /// k = √(GM/p³), 1/s, negative where the orbit is run through clockwise.
    pub(crate) rate: S,
}

/// A place on a conic in its plane, in semi-major axes or least distances.
struct Along<S> {
    place: [S; 2],
    /// Over the time in seconds; `None` of a circle in uniform motion.
    velocity: Option<[S; 2]>,
    /// The reciprocal of the distance.
    near: S,
}

impl<S: Real> Along<S> {
    /// The direction to the body.
    fn direction(&self) -> [S; 2] {
        self.place.map(|x| x * self.near)
    }

    /// 3 GM/r³ and the direction to the body, `rate` the square root of GM.
    fn pull(&self, rate: S) -> (S, [S; 2]) {
        let [x, y] = self.place;
        if let Some(found) = self.velocity.and_then(|[u, v]| pulled(rate * rate, [x, y, u, v])) {
            return found;
        }
        let near = self.near;
        (S::of(3.0) * rate * rate * (near * near * near), self.direction())
    }
}

impl Orbit {
    /// An ellipse with the mean motion `mean_motion` (rad/s) and the eccentricity `eccentricity`, 0 for a circle.
    ///
    /// # Errors
    /// A mean motion that is not finite, an eccentricity outside [0, 1).
    pub fn ellipse(mean_motion: f64, eccentricity: f64) -> Result<Self, ForceError> {
        let mean_motion = finite(NAME, "the mean motion", mean_motion)?;
        if !(0.0..1.0).contains(&eccentricity) {
            return Err(ForceError::Eccentricity { eccentricity });
        }
        Ok(Orbit { speed: Speed::Mean(mean_motion), eccentricity, passage: 0.0, plane: None })
    }

    /// An orbit about a mass with the gravitational parameter `gm` = G M (m³/s²) whose least distance from its centre is
    /// `periapsis` (m), of any eccentricity: below 1 an ellipse, 1 a parabola, above 1 a hyperbola.
    ///
    /// From e = 1 to the nearest numbers on either side the motion changes by as much as they do: it is worked out by the
    /// universal variable (Battin, An Introduction to the Mathematics and Methods of Astrodynamics, 1999, §4.5).
    ///
    /// # Errors
    /// A parameter or a distance that is not positive and finite, or both together out of range; an eccentricity below 0.
    pub fn conic(gm: f64, periapsis: f64, eccentricity: f64) -> Result<Self, ForceError> {
        let positive = |quantity: &'static str, value: f64| match finite(NAME, quantity, value)? {
            value if value > 0.0 => Ok(Dd::of(value)),
            value => Err(ForceError::NotPositive { force: NAME, quantity, value }),
        };
        let (gm, q) =
            (positive("the gravitational parameter", gm)?, positive("the periapsis distance", periapsis)?);
        let eccentricity = finite(NAME, "the eccentricity", eccentricity)?;
        if eccentricity < 0.0 {
            return Err(ForceError::NoConic { eccentricity });
        }
        let rate = (gm / q).sqrt() / q;
        // so that the torque, and the period of an ellipse next to the parabola, are numbers
        if !(rate.hi() * rate.hi()).is_normal() {
            return Err(ForceError::RateOutOfRange { rate: rate.hi() });
        }
        let alpha = one_less(eccentricity);
        let period = (alpha.hi() > 0.0).then(|| Dd::TAU / (rate * alpha * alpha.sqrt()));
        Ok(Orbit { speed: Speed::AtPassage { rate, period }, eccentricity, passage: 0.0, plane: None })
    }

    /// An orbit about a mass with the gravitational parameter `gm` (m³/s²) by its places (m, axes of space) at ascending times (s), such as an
    /// ephemeris tells: at least eight rows, between which a polynomial through the eight nearest is taken. The gravity gradient ends with the
    /// table: a run that goes further is refused.
    ///
    /// # Errors
    /// A parameter that is not positive, fewer rows than eight, times that do not ascend, places that are not finite or at distance
    /// zero; and gaps, between whose rows the places through eight and through six rows differ by more than a thousandth of the distance.
    ///
    /// ```
    /// use polhode::body::Orbit;
    /// let times: Vec<f64> = (0..20).map(|k| 300.0 * f64::from(k)).collect();
    /// let places: Vec<[f64; 3]> = times.iter().map(|t| [7e6, 7.5e3 * t, 0.0]).collect();
    /// let straight = Orbit::table(3.986e14, &times, &places)?;
    /// assert!(straight.interpolation_error().is_some_and(|error| error < 1e-13));
    /// # Ok::<(), polhode::body::ForceError>(())
    /// ```
    pub fn table(gm: f64, times: &[f64], places: &[[f64; 3]]) -> Result<Self, ForceError> {
        let table = Arc::new(Table::new(gm, times, places)?);
        Ok(Orbit { speed: Speed::Table(table), eccentricity: 0.0, passage: 0.0, plane: None })
    }

    /// Of a [table](Self::table), the largest difference between the places through eight rows and through six, over the distance: the error
    /// of the latter, and as a rule more than that of the places that are taken. What the rows themselves are off is not in it.
    #[must_use]
    pub fn interpolation_error(&self) -> Option<f64> {
        match &self.speed {
            Speed::Table(table) => Some(table.error()),
            _ => None,
        }
    }

    /// Of a [table](Self::table), its first and its last time, s.
    #[must_use]
    pub fn span(&self) -> Option<[f64; 2]> {
        match &self.speed {
            Speed::Table(table) => Some(table.span().map(|time| time + self.passage)),
            _ => None,
        }
    }

    /// The same orbit with the least distance at the time `time`, s; of a table that much later.
    ///
    /// # Errors
    /// A time that is not finite.
    pub fn passing_at(self, time: f64) -> Result<Self, ForceError> {
        Ok(Orbit { passage: finite(NAME, "the time of the periapsis", time)?, ..self })
    }

    /// The same orbit turned in space: the longitude of the ascending node, the inclination and the argument of the periapsis,
    /// rad, from the axis x and about the axis z of space.
    ///
    /// # Errors
    /// Angles that are not finite.
    pub fn in_plane(self, angles: [f64; 3]) -> Result<Self, ForceError> {
        let turn = |axis: usize, name: &'static str, angle: f64| {
            let (sin, cos) = (Dd::of(finite(NAME, name, angle)?) * 0.5).sin_cos();
            let mut v = Vec3::zero();
            v[axis] = sin;
            Ok::<_, ForceError>(Quat::new(cos, v))
        };
        let node = turn(2, "the longitude of the node", angles[0])?;
        let inclination = turn(0, "the inclination", angles[1])?;
        let argument = turn(2, "the argument of the periapsis", angles[2])?;
        Ok(Orbit { plane: Some(node * inclination * argument), ..self })
    }

    /// Of a circle in the x–y plane of space, the rate at which it is run through, rad/s.
    pub(super) fn steady_rate(&self) -> Option<f64> {
        let rate = match &self.speed {
            Speed::Mean(rate) => *rate,
            Speed::AtPassage { rate, .. } => rate.hi(),
            Speed::Table(_) => return None,
        };
        (self.eccentricity == 0.0 && self.plane.is_none()).then_some(rate)
    }

    #[inline(always)]
    pub(crate) fn at<S: Real>(&self, at: Time) -> Place<S> {
        self.after(self.since_passage(at))
    }

    /// `time` (s) since the least distance; apart from what makes that time, which stages of a step share.
    #[inline(never)]
    fn after<S: Real>(&self, time: Dd) -> Place<S> {
        let (strength, direction) = self.seen(time);
        let direction = match self.plane {
            None => direction,
            Some(plane) => plane.map(S::from_dd).rotate(direction),
        };
        Place { strength, direction }
    }

    /// The time since the least distance, s.
    #[inline(always)]
    fn since_passage(&self, at: Time) -> Dd {
        // the bits of a time from which nothing is taken stay
        let at = if self.passage == 0.0 { at } else { at.later(Dd::of(-self.passage)) };
        at.dd()
    }

    /// As [`before_turning`](Self::before_turning), in `f64` once for each time.
    fn seen<S: Real>(&self, time: Dd) -> (S, Vec3<S>) {
        let eccentricity = self.eccentricity;
        let of = match &self.speed {
            Speed::Mean(rate) => Asked::Mean { rate: *rate, eccentricity },
            Speed::AtPassage { rate, .. } => Asked::AtPassage { rate: *rate, eccentricity },
            Speed::Table(table) => Asked::Table(table.number()),
        };
        let is_f64 = TypeId::of::<S>() == TypeId::of::<f64>();
        if let Some(seen) = LAST.get().filter(|seen| is_f64 && seen.of == of && seen.time == time) {
            let (strength, direction) = seen.place;
            return (S::of(strength), Vec3::of(direction));
        }
        let found = self.before_turning(time);
        if let Some(place) = (&found as &dyn Any).downcast_ref() {
            LAST.set(Some(Seen { of, time, place: *place }));
        }
        found
    }

    /// 3 GM/r³ and r̂ in the plane of the orbit, of a table in space, `time` (s) since the least distance.
    fn before_turning<S: Real>(&self, time: Dd) -> (S, Vec3<S>) {
        let (rate, along) = match &self.speed {
            Speed::Mean(rate) => (S::of(*rate), self.by_mean_motion(*rate, time)),
            Speed::AtPassage { rate, period } => {
                (S::from_dd(*rate), self.by_universal_variable(*rate, *period, time))
            }
            Speed::Table(table) => return table.at(time),
        };
        let (strength, [x, y]) = along.pull(rate);
        (strength, Vec3([x, y, S::of(0.0)]))
    }

    /// Whether it has a [true anomaly](Self::true_anomaly) whose constants are doubles.
    pub(super) fn is_conic(&self) -> bool {
        !matches!(self.speed, Speed::Table(_)) && self.eccentricity < STRAIGHT
    }

    /// The true anomaly at the time `at`; `None` of a table.
    pub(crate) fn true_anomaly<S: Real>(&self, at: Time) -> Option<TrueAnomaly<S>> {
        let time = self.since_passage(at);
        let (e, beyond) = (self.eccentricity, S::of(1.0) + S::of(self.eccentricity));
        let (rate, along, latus_rectum) = match &self.speed {
            Speed::Mean(rate) => {
                let latus_rectum = S::from_dd(one_less(e)) * beyond;
                (S::of(*rate), self.by_mean_motion::<S>(*rate, time), latus_rectum)
            }
            Speed::AtPassage { rate, period } => {
                (S::from_dd(*rate), self.by_universal_variable::<S>(*rate, *period, time), beyond)
            }
            Speed::Table(_) => return None,
        };
        let [x, y] = along.direction();
        let turned = |v: Vec3<S>| self.plane.map_or(v, |plane| plane.map(S::from_dd).rotate(v));
        Some(TrueAnomaly {
            direction: turned(Vec3([x, y, S::of(0.0)])),
            normal: turned(Vec3::unit(2)),
            near: latus_rectum * along.near,
            eccentric: (e != 0.0).then(|| [S::of(e) * x, S::of(e) * y]),
            rate: rate / (latus_rectum * latus_rectum.sqrt()),
        })
    }

    /// Of a circle or an ellipse, in semi-major axes.
    fn by_mean_motion<S: Real>(&self, rate: f64, now: Dd) -> Along<S> {
        let one = S::of(1.0);
        if self.eccentricity == 0.0 {
            let (sin, cos) = S::linear(reduced_angle(now, rate), rate).sin_cos();
            return Along { place: [cos, sin], velocity: None, near: one };
        }
        let e = S::of(self.eccentricity);
        let (sin, cos) = self.eccentric_anomaly::<S>(reduced_angle(now, rate)).sin_cos();
        let near = one / (one - e * cos);
        let (n, minor) = (S::of(rate) * near, (one - e * e).sqrt());
        Along { place: [cos - e, minor * sin], velocity: Some([-(n * sin), n * minor * cos]), near }
    }

    /// The solution of Kepler's equation `E − e sin E = M`, M in [−π, π].
    fn eccentric_anomaly<S: Real>(&self, anomaly: Dd) -> S {
        let mean = anomaly.hi();
        let (e, m) = (self.eccentricity, mean.abs());
        // M + e and π are upper bounds, and E − e sin E is convex up to π
        let x = descend((m + e).min(PI), |x| {
            let (sin, cos) = Real::sin_cos(x);
            [x - e * sin - m, 1.0 - e * cos]
        });
        let (e, m) = (S::of(e), S::from_dd(anomaly));
        let mut x = S::of(if mean < 0.0 { -x } else { x });
        // each step doubles the digits: one polishes doubles, two give double-double
        for _ in 0..S::NEWTON_STEPS {
            let (sin, cos) = x.sin_cos();
            x = x - (x - e * sin - m) / (S::of(1.0) - e * cos);
        }
        x
    }

    /// Of any conic, in least distances, without a singularity at the parabola.
    ///
    /// With lengths in least distances q, times in √(q³/GM), α = 1 − e and Stumpff's functions cₖ of αχ²:
    /// `s = χ + e χ³ c₃`, `r = 1 + e χ² c₂`, `x = 1 − χ² c₂`, `y = √(1 + e) χ c₁`.
    fn by_universal_variable<S: Real>(&self, rate: Dd, period: Option<Dd>, since: Dd) -> Along<S> {
        let (e, alpha) = (self.eccentricity, one_less(self.eccentricity));
        let since = period.map_or(since, |period| since - period * revolutions(since, period));
        let scaled = (rate * since).hi();
        let x = universal_variable(scaled.abs(), e, alpha.hi());
        let halvings = halvings(alpha.hi() * x * x);
        let s = S::from_dd(since) * S::from_dd(rate);
        let (e, alpha) = (S::of(e), S::from_dd(alpha));
        let mut x = S::of(if scaled < 0.0 { -x } else { x });
        for _ in 0..S::NEWTON_STEPS {
            let [_, _, c2, c3] = stumpff(alpha * x * x, halvings);
            x = x - (x + e * x * x * x * c3 - s) / (S::of(1.0) + e * x * x * c2);
        }
        let [c0, c1, c2, _] = stumpff(alpha * x * x, halvings);
        let (one, across) = (S::of(1.0), x * x * c2);
        let near = one / (one + e * across);
        let (speed, wide) = (S::from_dd(rate) * near, (one + e).sqrt());
        Along {
            place: [one - across, wide * x * c1],
            velocity: Some([-(speed * x * c1), speed * wide * c0]),
            near,
        }
    }
}

/// 1 − e, exactly.
fn one_less(eccentricity: f64) -> Dd {
    Dd::sum(1.0, -eccentricity)
}

/// The whole number nearest to `since / period`.
fn revolutions(since: Dd, period: Dd) -> Dd {
    let turns = since.hi() / period.hi();
    let whole = nearest(turns);
    // less than 2⁻⁵¹ of this quotient is wrong: more digits decide only next to half a revolution, and beyond 2⁴⁹ of them
    if (turns - whole).abs() < 0.5 - turns.abs() * (4.0 * f64::EPSILON) {
        Dd::of(whole)
    } else {
        (since / period).round()
    }
}

/// 3 GM/r³ and r̂ on the motion through place and velocity, as series in the time, by the equations of motion themselves, which take the fewest
/// operations; `None` of other scalars.
fn pulled<S: Real>(gm: S, state: [S; 4]) -> Option<(S, [S; 2])> {
    let mut nearness = [S::of(0.0); 2];
    let [x, y, ..] = S::solution(state, |[x, y, u, v]| {
        let near = S::of(1.0) / (x * x + y * y).sqrt();
        let cubed = near * near * near;
        nearness = [near, cubed];
        let pull = gm * cubed;
        [u, v, -(x * pull), -(y * pull)]
    })?;
    let [near, cubed] = nearness;
    Some((S::of(3.0) * gm * cubed, [x * near, y * near]))
}

/// The solution of `χ + e χ³ c₃(αχ²) = s`, s at least 0 and of an ellipse at most half a revolution.
fn universal_variable(s: f64, e: f64, alpha: f64) -> f64 {
    // c₃ is positive, at most a sixth on an ellipse and at least that on the others, where r grows with χ
    let bound = if alpha > 0.0 {
        PI / alpha.sqrt()
    } else {
        let root = (-alpha).sqrt();
        let flat = libm::cbrt(6.0 * (s / e));
        if alpha < 0.0 { flat.min(libm::asinh(s * root) / root) } else { flat }
    };
    descend(s.min(bound), |x| {
        let z = alpha * x * x;
        let [_, _, c2, c3] = stumpff(z, halvings(z));
        [x + e * x * x * x * c3 - s, 1.0 + e * x * x * c2]
    })
}

/// The root of a convex function below `x`, where it is not negative; `value` gives the function and its slope.
fn descend(mut x: f64, value: impl Fn(f64) -> [f64; 2]) -> f64 {
    for _ in 0..MOST_DESCENTS {
        let [f, slope] = value(x);
        let next = x - f / slope;
        if next.partial_cmp(&x) != Some(Ordering::Less) {
            break;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against Kepler's and Barker's equations in 90 digits, from circles through both neighbours of the parabola to straight lines.
    #[test]
    fn places_are_those_of_the_classical_equations() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/forces/conics.csv");
        let text = std::fs::read_to_string(path).unwrap();
        let mut count = 0;
        for line in text.lines().filter(|line| !line.starts_with('#')).skip(1) {
            let fields: Vec<&str> = line.split(',').collect();
            let [e, s] = [0, 1].map(|k| fields[k].parse::<f64>().unwrap());
            let [x, y] = [2, 3].map(|k| fields[k].parse::<Dd>().unwrap());
            let orbit = Orbit::conic(1.0, 1.0, e).unwrap();
            let r = (x * x + y * y).sqrt();
            let strength = Dd::of(3.0) / (r * r * r);
            let (quick, precise) =
                (orbit.at::<f64>(Time::from_seconds(s)), orbit.at::<Dd>(Time::from_seconds(s)));
            let error = |place: Place<Dd>| {
                let across = Vec3([x / r, y / r, Dd::ZERO]) - place.direction;
                (across.norm() + (place.strength / strength - 1.0).abs()).hi()
            };
            let quick = Place { strength: Dd::of(quick.strength), direction: quick.direction.map(Dd::of) };
            let (quick, precise) = (error(quick), error(precise));
            // over many revolutions double-double keeps as many digits fewer as the time has
            let most = 1e-29 * (1.0 + 0.01 * s.abs());
            assert!(quick < 1e-14 && precise < most, "e = {e}, s = {s}: {quick:.1e}, {precise:.1e}");
            count += 1;
        }
        assert_eq!(count, 88);
    }

    /// Whole revolutions are those of double-double, next to half a revolution and far out too.
    #[test]
    fn revolutions_are_those_of_double_double() {
        for period in [Dd::TAU, Dd::ONE / 3.0, Dd::of(5400.0), Dd::TAU * 1e-9] {
            for n in [0.0, 1.0, 2.0, 77.0, 1e6, 3e9, 2e14, 7e14, 4e15, 1e20] {
                for part in [0.0, 0.25, 0.5, 0.75] {
                    for off in [0.0, 1e-31, 1e-25, 1e-17, 3e-16, 1e-12, 1e-3] {
                        for sign in [1.0, -1.0] {
                            let turns = (Dd::sum(n, part) * (1.0 + sign * off) + off * sign) * sign;
                            let since = period * turns;
                            assert_eq!(revolutions(since, period), (since / period).round(), "{turns}");
                        }
                    }
                }
            }
        }
    }

    /// The last place is kept: what is asked next, of which orbit ever, has the bits that it has where nothing is kept.
    #[test]
    fn places_do_not_depend_on_what_was_asked_before() {
        let rows = |speed: f64| {
            let times: [f64; 12] = core::array::from_fn(|k| 10.0 * k as f64 - 30.0);
            let places = times.map(|t| [7.0 + 0.01 * t, speed * t, 0.003 * t * t]);
            Orbit::table(3.0, &times, &places).unwrap()
        };
        let mut orbits: Vec<Orbit> =
            [0.0, 0.3, 0.99, 1.0, 1.7].map(|e| Orbit::conic(2.0, 1.5, e).unwrap()).into();
        orbits.extend([0.0, 0.3].map(|e| Orbit::ellipse((Dd::of(2.0 / 1.5).sqrt() / 1.5).hi(), e).unwrap()));
        orbits.push(Orbit::conic(2.1, 1.5, 0.3).unwrap());
        orbits.push(Orbit::conic(2.0, 1.5, 0.3).unwrap().passing_at(0.5).unwrap());
        orbits.push(Orbit::conic(2.0, 1.5, 0.3).unwrap().in_plane([0.3, 0.8, 1.1]).unwrap());
        let bits = |orbit: &Orbit, time: f64| {
            let place = orbit.at::<f64>(Time::from_seconds(time));
            [place.strength, place.direction[0], place.direction[1], place.direction[2]].map(f64::to_bits)
        };
        let mut asked = Vec::new();
        for n in 0..300_usize {
            // tables come and go, so that one may stand where another stood
            let table = rows(0.4 + 0.1 * (n % 3) as f64);
            let orbit = orbits.get(n % 11).unwrap_or(&table).clone();
            let time = [0.5, 0.5, 1.0, -3.25, 40.0, 0.0, 0.5][n * 5 % 7];
            asked.push((orbit.clone(), time, bits(&orbit, time)));
            asked.push((orbit.clone(), time, bits(&orbit, time)));
        }
        for (orbit, time, found) in asked {
            let fresh =
                orbit.before_turning::<f64>(Time::from_seconds(time).later(Dd::of(-orbit.passage)).dd());
            LAST.set(None);
            assert_eq!(bits(&orbit, time), found, "{orbit:?} at {time}");
            if orbit.plane.is_none() {
                let (strength, Vec3([x, y, z])) = fresh;
                assert_eq!([strength, x, y, z].map(f64::to_bits), found);
            }
        }
    }
}
