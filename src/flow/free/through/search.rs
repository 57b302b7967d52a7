//! All places on the cone where a motion makes the turn about its momentum too.

use core::f64::consts::FRAC_PI_2;

use super::branch::Place;
use super::cone::{Cone, HALVES, Half};
use super::cubic::Cubic;
use crate::num::exponential::exp_of_positive;
use crate::num::trig::sin_cos;
use crate::rotation::{Quat, Vec3};

/// Pieces into which the inner part of a stretch of the cone is cut at first, and each of its ends.
const PIECES: [u32; 2] = [10, 7];
/// Where the ends of a stretch begin, e^−5 of its length from its limits.
const END: f64 = 5.0;
/// They are as near as the digits of a direction tell, rad: the complementary parameter has two digits left there.
const NEAREST: f64 = 4e-14;
/// Part of a period by which the ends of a piece may differ where no motion between them makes few enough turns.
const STEADY: f64 = 0.06;
/// The same where one does: more, and whole periods might be left out.
const FOLLOWED: f64 = 0.3;
/// How often a piece is halved.
const DEEPEST: u32 = 26;
/// Evaluations for a root or an extremum in a bracket: halving alone leaves 2⁻⁵² of it.
const EVALUATIONS: u32 = 60;
/// Half angle that is rounding, rad.
const ROUNDING: f64 = 1e-13;
/// Half angle of a root at the corner of two stretches, and of one that is double to within rounding, rad: Newton's iteration after the
/// search tells whether there is one.
const CANDIDATE: f64 = 1e-11;

/// What a search finds.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    /// Momenta for the time 1 that lead from the one attitude to the other.
    pub(super) momenta: Vec<Vec3<f64>>,
    /// Momenta of which only Newton's iteration tells whether they do.
    pub(super) candidates: Vec<Vec3<f64>>,
    /// Pieces that were halved as often as is allowed and still are not smooth.
    pub(super) unresolved: u32,
}

/// A stretch of the cone between two places where the motion changes its kind.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    half: Half,
    from: f64,
    to: f64,
}

pub(super) struct Search<'a> {
    pub(super) moments: Vec3<f64>,
    pub(super) turn: Quat<f64>,
    pub(super) turns: f64,
    pub(super) cone: &'a Cone,
    /// Times as many pieces as usual.
    pub(super) finer: u32,
}

/// Coordinate in a stretch and the place there.
#[derive(Clone, Copy, Debug)]
struct At {
    z: f64,
    place: Place,
}

impl Search<'_> {
    /// One side of the cone is enough: from the opposite directions the same motions go back in time.
    pub(super) fn run(&self) -> Found {
        let mut found = Found::default();
        for half in HALVES {
            let mut cuts = self.cone.cuts(half, self.moments);
            cuts.extend([-FRAC_PI_2, FRAC_PI_2]);
            cuts.sort_by(f64::total_cmp);
            for pair in cuts.windows(2) {
                self.along(Stretch { half, from: pair[0], to: pair[1] }, &mut found);
            }
        }
        for phi in [-FRAC_PI_2, FRAC_PI_2] {
            self.corner(phi, &mut found);
        }
        found
    }

    /// Motions that start at the corner of both halves, which no piece of either contains.
    fn corner(&self, phi: f64, found: &mut Found) {
        let [start, change] = self.cone.direction(HALVES[0], sin_cos(phi));
        let Some(place) = Place::of(self.moments, self.turn, self.turns, start, change) else { return };
        let [first, last] = place.periods();
        let near = (first..=last).filter(|&n| place.miss(n).value.abs() < CANDIDATE);
        found.candidates.extend(near.filter_map(|n| place.momentum(n)));
    }

    /// The place at z ∈ (−∞, ∞): the ends, where periods become infinite, are approached exponentially.
    fn place(&self, stretch: Stretch, z: f64) -> Option<Place> {
        let share = 1.0 / (1.0 + exp_of_positive(z.abs()));
        let length = stretch.to - stretch.from;
        let phi = if z < 0.0 { stretch.from + length * share } else { stretch.to - length * share };
        let [start, change] = self.cone.direction(stretch.half, sin_cos(phi));
        let change = change * (length * share * (1.0 - share));
        Place::of(self.moments, self.turn, self.turns, start, change)
    }

    fn along(&self, stretch: Stretch, found: &mut Found) {
        let limit = libm::log((stretch.to - stretch.from) / NEAREST);
        if limit.is_nan() || limit <= 1.0 {
            return; // two cuts that are one
        }
        let end = END.min(0.5 * limit);
        let [inner, outer] = PIECES.map(|pieces| pieces * self.finer);
        let ends = (1..=outer).map(|n| end + (limit - end) * f64::from(n) / f64::from(outer));
        let middle = (0..=inner).map(|n| end * (2.0 * f64::from(n) / f64::from(inner) - 1.0));
        let before_end = ends.clone().rev().map(|z| -z);
        let mut before: Option<At> = None;
        for z in before_end.chain(middle).chain(ends) {
            let Some(mut place) = self.place(stretch, z) else { continue };
            if let Some(before) = &before {
                place = place.near(before.place.part().value);
                self.piece(stretch, before, &At { z, place }, 0, found);
            }
            before = Some(At { z, place });
        }
    }

    /// All roots between two places, by halves until half angles and phases agree with what their derivatives at both ends say.
    fn piece(&self, stretch: Stretch, low: &At, high: &At, depth: u32, found: &mut Found) {
        let width = high.z - low.z;
        let (from, to) = (low.place.part(), high.place.part());
        let change = to.value - from.value;
        let bent = (change - 0.5 * width * (from.slope + to.slope)).abs();
        let counts = counts(&low.place, &high.place);
        if counts.is_empty() && change.abs().max(bent) < STEADY {
            return;
        }
        let cubic = |n| Cubic::between(low.place.miss(n), high.place.miss(n), width);
        let smooth = change.abs() < FOLLOWED && bent < STEADY && counts.iter().all(|&n| cubic(n).is_smooth());
        if !smooth && depth < DEEPEST {
            let z = 0.5 * (low.z + high.z);
            let Some(middle) = self.place(stretch, z) else {
                found.unresolved += 1;
                return;
            };
            let middle = At { z, place: middle.near(from.value) };
            self.piece(stretch, low, &middle, depth + 1, found);
            let high = At { z: high.z, place: high.place.near(middle.place.part().value) };
            return self.piece(stretch, &middle, &high, depth + 1, found);
        }
        if !smooth {
            found.unresolved += 1;
        }
        for n in counts {
            self.roots(stretch, low, high, n, found);
        }
    }

    /// The roots after `n` further periods in a smooth piece: one where the signs at its ends differ, else two or none where the half
    /// angle turns round.
    fn roots(&self, stretch: Stretch, low: &At, high: &At, n: i64, found: &mut Found) {
        let origin = low.place.miss(n).value;
        let point = |at: &At| Point::of(at, n, origin);
        let branch = Branch { search: self, stretch, part: low.place.part().value, n, origin };
        let (a, b) = (point(low), point(high));
        if a.miss == 0.0 || a.miss * b.miss < 0.0 {
            return found.momenta.extend(branch.root(a, b));
        }
        let toward = a.miss * a.slope < 0.0 && b.miss * b.slope > 0.0;
        let reach = a.slope.abs().max(b.slope.abs()) * (b.z - a.z);
        if !toward || a.miss.abs().min(b.miss.abs()) > reach {
            return;
        }
        let Some(turning) = branch.turning(a, b) else { return };
        if turning.miss * a.miss <= 0.0 {
            found.momenta.extend(branch.root(a, turning));
            found.momenta.extend(branch.root(turning, b));
        } else if turning.miss.abs() < CANDIDATE {
            found.candidates.extend(branch.momentum(turning.z));
        }
    }
}

/// The whole periods after which a motion may make few enough turns, somewhere between two places.
fn counts(low: &Place, high: &Place) -> Vec<i64> {
    let ([a, b], [c, d]) = (low.periods(), high.periods());
    (a.min(c)..=b.max(d)).filter(|&n| low.may_be_within(high, n)).collect()
}

/// The motions of one number of periods, along a piece of a stretch.
struct Branch<'a> {
    search: &'a Search<'a>,
    stretch: Stretch,
    part: f64,
    n: i64,
    /// Half angle within π/2 of all others.
    origin: f64,
}

/// Half angle by which the end is missed, rad, and its derivative by z.
#[derive(Clone, Copy, Debug)]
struct Point {
    z: f64,
    miss: f64,
    slope: f64,
}

impl Point {
    fn of(at: &At, n: i64, origin: f64) -> Point {
        let miss = at.place.miss(n);
        Point { z: at.z, miss: origin + super::branch::folded(miss.value - origin), slope: miss.slope }
    }
}

impl Branch<'_> {
    fn place(&self, z: f64) -> Option<Place> {
        self.search.place(self.stretch, z).map(|place| place.near(self.part))
    }

    fn at(&self, z: f64) -> Option<Point> {
        Some(Point::of(&At { z, place: self.place(z)? }, self.n, self.origin))
    }

    fn momentum(&self, z: f64) -> Option<Vec3<f64>> {
        self.place(z)?.momentum(self.n)
    }

    /// The point between `a` and `b`, where the slopes differ in sign, at which the half angle turns round, or one before at which its
    /// sign differs or from which it cannot reach zero.
    fn turning(&self, mut a: Point, mut b: Point) -> Option<Point> {
        let (mut f, mut g) = (a.slope, b.slope);
        let mut last = if a.miss.abs() < b.miss.abs() { a } else { b };
        for _ in 0..EVALUATIONS {
            let width = b.z - a.z;
            if a.miss.abs().min(b.miss.abs()) > a.slope.abs().max(b.slope.abs()) * width
                || width.abs() <= 4.0 * f64::EPSILON * a.z.abs().max(1.0)
            {
                break;
            }
            // regula falsi with halved weights (Illinois), whose bracket never is lost
            let next = self.at((a.z * g - b.z * f) / (g - f))?;
            last = next;
            if next.miss * a.miss <= 0.0 || next.slope == 0.0 {
                break;
            }
            if next.slope * a.slope > 0.0 {
                (a, f) = (next, next.slope);
                g *= 0.5;
            } else {
                (b, g) = (next, next.slope);
                f *= 0.5;
            }
        }
        Some(last)
    }

    /// The momentum at the root between two points, by Newton's iteration within a bracket.
    fn root(&self, mut a: Point, mut b: Point) -> Option<Vec3<f64>> {
        let mut next = if a.miss.abs() < b.miss.abs() { a } else { b };
        for _ in 0..EVALUATIONS {
            if next.miss.abs() < ROUNDING || (b.z - a.z).abs() <= f64::EPSILON * a.z.abs().max(1.0) {
                break;
            }
            let newton = next.z - next.miss / next.slope;
            let inside = newton > a.z.min(b.z) && newton < a.z.max(b.z);
            next = self.at(if inside { newton } else { 0.5 * (a.z + b.z) })?;
            if next.miss * a.miss > 0.0 {
                a = next;
            } else {
                b = next;
            }
        }
        self.momentum(next.z)
    }
}
