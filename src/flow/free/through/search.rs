//! All places on the cone where a motion makes the turn about its momentum too.

use super::branch::{Miss, Place};
use super::cone::{Cone, Quarter};
use crate::num::exponential::exp_of_positive;
use crate::num::trig::sin_cos;
use crate::rotation::{Quat, Vec3};

/// Pieces into which the inner part of a stretch of the cone is cut at first, and each of its ends.
const PIECES: [u32; 2] = [20, 16];
/// Looks for changes of the kind in each half of a quarter: regular ones, and close to its corner.
const LOOKS: u32 = 96;
const CLOSE: u32 = 11;
/// Half angles that are followed within a piece, rad.
const FOLLOWED: f64 = 0.4;
/// Deviation of the half angle in the middle of a piece from a straight line, rad.
const STRAIGHT: f64 = 0.05;
/// Iterations for the place where a half angle turns round.
const EXTREMUM: u32 = 40;
/// Part of a period by which the ends of a piece may differ unseen.
const STEADY: f64 = 0.06;
/// How often a piece is halved.
const DEEPEST: u32 = 26;
/// Where the ends of a stretch begin, e^−5 of its length from its limits.
const END: f64 = 5.0;
/// They are as near as the digits of a direction tell: e^−34 of its length.
const NEAREST: f64 = 34.0;

/// What a search finds.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    /// Momenta for the time 1 that lead from the one attitude to the other.
    pub(super) momenta: Vec<Vec3<f64>>,
    /// Pieces that were halved as often as is allowed and still are not smooth.
    pub(super) unresolved: u32,
}

/// A stretch of the cone between two places where the motion changes its kind.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    quarter: Quarter,
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
type At = (f64, Place);

impl Search<'_> {
    pub(super) fn run(&self) -> Found {
        let mut found = Found::default();
        for quarter in Cone::quarters() {
            for stretch in self.stretches(quarter) {
                self.along(stretch, &mut found);
            }
        }
        found
    }

    fn direction(&self, quarter: Quarter, phi: f64) -> Vec3<f64> {
        let (sin, cos) = sin_cos(phi);
        self.cone.direction(quarter, sin, cos)
    }

    /// Which axis the momentum circulates about, in which direction; `None` where the two ends differ in that.
    fn kind(&self, quarter: Quarter, phi: f64) -> Option<(bool, bool)> {
        let m = self.direction(quarter, phi);
        let end = self.turn.rotate_back(m);
        let i = self.moments;
        let [l, mu, h] = i.ascending();
        let separation = m[h] * m[h] * i[l] * (i[h] - i[mu]) - m[l] * m[l] * i[h] * (i[mu] - i[l]);
        let about_smallest = separation <= 0.0;
        let a = if about_smallest { l } else { h };
        (m[a] * end[a] > 0.0).then_some((about_smallest, m[a] > 0.0))
    }

    /// The quarter, cut where the kind changes.
    fn stretches(&self, quarter: Quarter) -> Vec<Stretch> {
        let half = core::f64::consts::FRAC_PI_2;
        // next to the corners, where the cone turns sharply, by quarters of the distance
        let near = (0..CLOSE).map(|n| 1e-9 * libm::exp2(f64::from(2 * n)));
        let least = 1e-9 * libm::exp2(f64::from(2 * CLOSE));
        let regular = (0..=LOOKS).map(|n| least + (half - least) * f64::from(n) / f64::from(LOOKS));
        let distances: Vec<f64> = near.chain(regular).collect();
        let before_half = distances.iter().map(|distance| distance - half);
        let looks = before_half.chain(distances.iter().rev().skip(1).map(|distance| half - distance));
        let mut stretches = Vec::new();
        let (mut from, mut before, mut kind) = (-half, -half, self.kind(quarter, distances[0] - half));
        for phi in looks.skip(1) {
            let next = self.kind(quarter, phi);
            if next != kind {
                let (mut low, mut high) = (before, phi);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if self.kind(quarter, middle) == kind { low = middle } else { high = middle }
                }
                if kind.is_some() {
                    stretches.push(Stretch { quarter, from, to: low });
                }
                (from, kind) = (high, next);
            }
            before = phi;
        }
        if kind.is_some() {
            stretches.push(Stretch { quarter, from, to: half });
        }
        stretches
    }

    /// The place at z ∈ (−∞, ∞): the ends, where periods become infinite, are approached exponentially.
    fn place(&self, stretch: Stretch, z: f64) -> Option<Place> {
        let share = 1.0 / (1.0 + exp_of_positive(z.abs()));
        let length = stretch.to - stretch.from;
        let phi = if z < 0.0 { stretch.from + length * share } else { stretch.to - length * share };
        Place::of(self.moments, self.turn, self.turns, self.direction(stretch.quarter, phi))
    }

    fn along(&self, stretch: Stretch, found: &mut Found) {
        let [inner, outer] = PIECES.map(|pieces| pieces * self.finer);
        let ends = (1..=outer).map(|n| END + (NEAREST - END) * f64::from(n) / f64::from(outer));
        let middle = (0..=inner).map(|n| END * (2.0 * f64::from(n) / f64::from(inner) - 1.0));
        let before_end: Vec<f64> = ends.clone().map(|z| -z).rev().collect();
        let mut before: Option<At> = None;
        for z in before_end.into_iter().chain(middle).chain(ends) {
            let Some(mut place) = self.place(stretch, z) else {
                before = None;
                continue;
            };
            if let Some(before) = &before {
                place = place.near(before.1.part);
                self.piece(stretch, before, &(z, place.clone()), 0, found);
            }
            before = Some((z, place));
        }
    }

    /// All roots between two places, by halves until the half angle is almost a straight line.
    fn piece(&self, stretch: Stretch, low: &At, high: &At, depth: u32, found: &mut Found) {
        let counts = counts(low, high);
        let change = high.1.part - low.1.part;
        if counts.is_empty() && change.abs() < STEADY {
            return;
        }
        let z = 0.5 * (low.0 + high.0);
        let Some(middle) = self.place(stretch, z) else {
            found.unresolved += 1;
            return;
        };
        let middle = (z, middle.near(low.1.part));
        // a part that runs fast looks slow where whole periods are left out, but not in the middle too
        let bent = middle.1.part - 0.5 * (low.1.part + high.1.part);
        if (change.abs() > 0.25 || bent.abs() > STEADY) && depth < DEEPEST {
            return self.halves(stretch, low, &middle, high, depth, found);
        }
        for &n in &counts {
            let [a, b, c] = [low, &middle, high].map(|at| at.1.miss(self.turn, n));
            let (first, second) = (b.since(a), c.since(b));
            let smooth =
                first.abs() < FOLLOWED && second.abs() < FOLLOWED && (first - second).abs() < STRAIGHT;
            if !smooth && depth < DEEPEST {
                return self.halves(stretch, low, &middle, high, depth, found);
            }
            if !smooth {
                found.unresolved += 1;
            }
        }
        self.roots(stretch, low, &middle, high, counts, found);
    }

    fn halves(&self, stretch: Stretch, low: &At, middle: &At, high: &At, depth: u32, found: &mut Found) {
        self.piece(stretch, low, middle, depth + 1, found);
        let high = (high.0, high.1.clone().near(middle.1.part));
        self.piece(stretch, middle, &high, depth + 1, found);
    }

    /// The roots of the branches `counts` in a smooth piece.
    fn roots(&self, stretch: Stretch, low: &At, middle: &At, high: &At, counts: Vec<i64>, found: &mut Found) {
        for n in counts {
            let branch = Branch { search: self, stretch, part: low.1.part, n };
            let inner = [low, middle, high].map(|at| Point { z: at.0, miss: at.1.miss(self.turn, n) });
            let mut points = inner.to_vec();
            points.extend(branch.extremum(inner));
            points.extend(branch.beyond(inner[1], inner[0], inner[2]));
            points.extend(branch.beyond(inner[1], inner[2], inner[0]));
            points.sort_by(|a, b| a.z.total_cmp(&b.z));
            for pair in points.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                if a.miss.sin * b.miss.sin < 0.0 || a.miss.sin == 0.0 {
                    found.momenta.extend(branch.root(a, b));
                }
            }
        }
    }
}

/// The whole periods after which a motion may be within, somewhere between two places.
fn counts(low: &At, high: &At) -> Vec<i64> {
    let (first, last) = (low.1.periods(), high.1.periods());
    let all = (*first.start()).min(*last.start())..=(*first.end()).max(*last.end());
    all.filter(|&n| low.1.may_be_within(&high.1, n)).collect()
}

/// The motions of one number of periods, along a stretch.
struct Branch<'a> {
    search: &'a Search<'a>,
    stretch: Stretch,
    part: f64,
    n: i64,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    z: f64,
    miss: Miss,
}

impl Branch<'_> {
    fn place(&self, z: f64) -> Option<Place> {
        self.search.place(self.stretch, z).map(|place| place.near(self.part))
    }

    fn at(&self, z: f64) -> Option<Point> {
        Some(Point { z, miss: self.place(z)?.miss(self.search.turn, self.n) })
    }

    /// The point between where the half angle turns round, if it does: two roots may be nearer to each other than the points.
    ///
    /// By parabolas, until it is clear that there is no root or until the sign there differs.
    fn extremum(&self, [mut a, mut b, mut c]: [Point; 3]) -> Option<Point> {
        let up = b.miss.since(a.miss);
        if up * c.miss.since(b.miss) >= 0.0 {
            return None;
        }
        let sign = b.miss.sin;
        for _ in 0..EXTREMUM {
            let (first, second) = (b.miss.since(a.miss), c.miss.since(b.miss));
            let (left, right) = (b.z - a.z, c.z - b.z);
            let (slope, other) = (first / left, second / right);
            let vertex = b.z + (slope * right + other * left) / (2.0 * (slope - other));
            // not where it is known already
            let least = 1e-3 * (c.z - a.z);
            let z = if (vertex - b.z).abs() >= least && vertex > a.z && vertex < c.z {
                vertex
            } else if left > right {
                b.z - least
            } else {
                b.z + least
            };
            let next = self.at(z)?;
            if next.miss.sin * sign <= 0.0 {
                return Some(next);
            }
            let gained = next.miss.since(b.miss);
            if gained * up > 0.0 {
                if z < b.z {
                    c = b
                } else {
                    a = b
                }
                b = next;
            } else if z < b.z {
                a = next;
            } else {
                c = next;
            }
            if b.miss.sin.abs() > 10.0 * gained.abs() + 1e-12 && (b.z - z).abs() <= 2.0 * least
                || c.z - a.z <= 1e-8 * b.z.abs().max(1.0)
            {
                break;
            }
        }
        Some(b)
    }

    /// The same where the half angle seems to turn round at or beyond the end `end` of the piece: the piece beside it sees no more of it.
    fn beyond(&self, middle: Point, end: Point, other: Point) -> Option<Point> {
        let (near, far) = (end.miss.since(middle.miss), middle.miss.since(other.miss));
        // by a parabola through the three the slope at the end, and how much more there is to come
        let slope = 1.5 * near - 0.5 * far;
        let straight = slope.abs() > 0.7 * near.abs() && slope * near > 0.0;
        if straight || end.miss.sin.abs() > near.abs() + far.abs() {
            return None;
        }
        let next = self.at(end.z + (end.z - middle.z))?;
        let triple = if end.z > middle.z { [middle, end, next] } else { [next, end, middle] };
        self.extremum(triple)
    }

    /// The momentum at the root between two points; regula falsi with halved weights (Illinois), whose bracket never is lost.
    fn root(&self, mut a: Point, mut b: Point) -> Option<Vec3<f64>> {
        let (mut f, mut g) = (a.miss.sin, b.miss.sin);
        let mut best = if f.abs() < g.abs() { a } else { b };
        for _ in 0..60 {
            if f == 0.0 || g == 0.0 || (b.z - a.z).abs() <= 4e-16 * a.z.abs().max(1.0) {
                break;
            }
            let next = self.at((a.z * g - b.z * f) / (g - f))?;
            let h = next.miss.sin;
            if h.abs() < best.miss.sin.abs() {
                best = next;
            }
            if h.abs() < 1e-14 {
                break;
            }
            if h * g < 0.0 {
                (a, f) = (b, g);
            } else {
                f *= 0.5;
            }
            (b, g) = (next, h);
        }
        let place = self.place(best.z)?;
        place.is_within(self.n).then(|| place.momentum(self.n))
    }
}
