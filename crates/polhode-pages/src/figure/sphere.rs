//! A view of things in space around a sphere, seen from far away: what lies behind is dashed.

use nalgebra::Vector3;

use super::canvas::{Anchor, Canvas, Fill, Stroke};
use super::style::{Colour, GREY, HIDDEN};

type V = Vector3<f64>;

/// A view with the unit of length in pixels.
pub struct View {
    /// Where the origin stands on the page, pixels.
    pub centre: [f64; 2],
    /// Pixels of the unit of length.
    pub unit: f64,
    right: V,
    up: V,
    towards: V,
}

impl View {
    /// Seen from `azimuth` and `elevation`, rad, above the plane of the first two axes.
    pub fn from_angles(centre: [f64; 2], unit: f64, azimuth: f64, elevation: f64) -> Self {
        let (sin_a, cos_a) = libm::sincos(azimuth);
        let (sin_e, cos_e) = libm::sincos(elevation);
        Self {
            centre,
            unit,
            right: V::new(-sin_a, cos_a, 0.0),
            up: V::new(-sin_e * cos_a, -sin_e * sin_a, cos_e),
            towards: V::new(cos_e * cos_a, cos_e * sin_a, sin_e),
        }
    }

    /// The unit vector to the eye.
    pub fn towards(&self) -> V {
        self.towards
    }

    /// Where a point is seen, pixels.
    pub fn place(&self, v: V) -> [f64; 2] {
        [self.centre[0] + self.unit * v.dot(&self.right), self.centre[1] - self.unit * v.dot(&self.up)]
    }

    /// The angle under which a direction is seen, counter-clockwise from the right.
    fn angle(&self, v: V) -> f64 {
        libm::atan2(v.dot(&self.up), v.dot(&self.right))
    }

    fn behind(&self, v: V) -> bool {
        v.dot(&self.towards) < 0.0
    }

    /// A shaded ball of radius 1.
    pub fn ball(&self, page: &mut Canvas) {
        page.circle(self.centre, self.unit, Some(Fill::Shaded), Some(Stroke::new(GREY, 1.2)));
    }

    /// A run of points, solid or dashed.
    pub fn line(&self, page: &mut Canvas, points: &[V], colour: Colour, width: f64, hidden: bool) {
        let places = points.iter().map(|v| self.place(*v)).collect();
        let stroke = Stroke::new(colour, width);
        page.line(
            places,
            if hidden {
                Stroke { width: 0.75 * width, ..stroke }.dashed(Some(HIDDEN)).opacity(0.6)
            } else {
                stroke
            },
        );
    }

    /// A curve on a surface whose outward normal at a point is `normal`: solid in front, dashed behind.
    pub fn curve_on(
        &self,
        page: &mut Canvas,
        points: &[V],
        normal: impl Fn(V) -> V,
        colour: Colour,
        width: f64,
    ) {
        let depth = |v: V| normal(v).dot(&self.towards);
        let mut run: Vec<V> = Vec::new();
        let mut runs = Vec::new();
        for (k, &now) in points.iter().enumerate() {
            if let Some(&before) = k.checked_sub(1).and_then(|k| points.get(k)) {
                let (from, to) = (depth(before), depth(now));
                if (from < 0.0) != (to < 0.0) {
                    let edge = before + (now - before) * (from / (from - to));
                    run.push(edge);
                    runs.push((std::mem::take(&mut run), from < 0.0));
                    run.push(edge);
                }
            }
            run.push(now);
        }
        let behind = points.last().is_some_and(|last| depth(*last) < 0.0);
        runs.push((run, behind));
        // what is behind first, so that the front covers it
        for hidden in [true, false] {
            for (run, behind) in &runs {
                if *behind == hidden {
                    self.line(page, run, colour, width, hidden);
                }
            }
        }
    }

    /// A curve on the sphere: solid in front, dashed behind.
    pub fn curve(&self, page: &mut Canvas, points: &[V], colour: Colour, width: f64) {
        self.curve_on(page, points, |v| v, colour, width);
    }

    /// An arrowhead at `tip`, pointing along `direction` as it is seen.
    pub fn head(&self, page: &mut Canvas, tip: V, direction: V, colour: Colour, size: f64) {
        let [x, y] = self.place(tip);
        let (u, v) = (direction.dot(&self.right), -direction.dot(&self.up));
        let length = libm::hypot(u, v);
        if length == 0.0 {
            return;
        }
        let (u, v) = (size * u / length, size * v / length);
        let (back_x, back_y) = (x - 2.0 * u, y - 2.0 * v);
        let points = vec![
            [x + 0.5 * u, y + 0.5 * v],
            [back_x - 0.8 * v, back_y + 0.8 * u],
            [back_x + 0.8 * v, back_y - 0.8 * u],
        ];
        page.area(points, Some(Fill::Flat(colour, 1.0)), None);
    }

    /// An arrow from `from` to `to` with a name beyond its tip.
    pub fn arrow(&self, page: &mut Canvas, from: V, to: V, colour: Colour, name: &str) {
        self.line(page, &[from, to], colour, 2.0, false);
        self.head(page, to, to - from, colour, 5.0);
        // the name stands beyond the tip, as far however the arrow is foreshortened
        let ([x, y], [u, v]) = (self.place(to), self.place(from));
        let length = libm::hypot(x - u, y - v);
        let share = if length > 0.0 { 15.0 / length } else { 0.0 };
        let (dx, dy) = (share * (x - u), share * (y - v));
        // a long name begins or ends there
        let (anchor, back) = match dx {
            dx if name.chars().count() < 3 || dx.abs() < 6.0 => (Anchor::Middle, 0.0),
            dx if dx > 0.0 => (Anchor::Start, -6.0),
            _ => (Anchor::End, 6.0),
        };
        page.text([x + dx + back, y + dy + 5.0], name, 16.0, anchor, colour);
    }

    /// An axis of a ball: seen where it is outside.
    pub fn axis(&self, page: &mut Canvas, direction: V, colour: Colour, name: &str) {
        if !self.behind(direction) {
            self.arrow(page, direction, direction * 1.35, colour, name);
            return;
        }
        // it comes out from behind the outline
        let across = direction - self.towards * direction.dot(&self.towards);
        let seen = 1.0 / across.norm();
        if seen < 1.3 {
            self.arrow(page, direction * seen.max(1.0), direction * 1.35, colour, name);
        }
    }

    /// The direction in which a curve on the sphere is run through, marked where it is nearest.
    pub fn sense(&self, page: &mut Canvas, points: &[V], colour: Colour, size: f64) {
        let depth = |k: &usize| points[*k].dot(&self.towards);
        let Some(nearest) = (1..points.len()).max_by(|a, b| depth(a).total_cmp(&depth(b))) else {
            return;
        };
        if depth(&nearest) > 0.1 {
            let (tip, direction) = (points[nearest], points[nearest] - points[nearest - 1]);
            self.head(page, tip, direction, colour, size);
        }
    }

    /// A cone from the centre around `axis`, one side of which is `side`: rim, outline and a light filling.
    pub fn cone(&self, page: &mut Canvas, axis: V, side: V, colour: Colour, outline_hidden: bool) {
        let rim = circle(axis, side);
        // as it is seen, the outline touches the rim where the angle around the centre is largest
        let centre = self.angle(axis * axis.dot(&side));
        let turn = |v: &V| {
            let angle = self.angle(*v) - centre;
            angle - core::f64::consts::TAU * libm::round(angle / core::f64::consts::TAU)
        };
        let ends = [
            rim.iter().copied().max_by(|a, b| turn(a).total_cmp(&turn(b))),
            rim.iter().copied().min_by(|a, b| turn(a).total_cmp(&turn(b))),
        ];
        let light = Some(Fill::Flat(colour, 0.12));
        if let [Some(left), Some(right)] = ends {
            page.area([V::zeros(), left, right].map(|v| self.place(v)).to_vec(), light, None);
            self.line(page, &[V::zeros(), left], colour, 1.6, outline_hidden);
            self.line(page, &[V::zeros(), right], colour, 1.6, outline_hidden);
        }
        let points = rim.iter().map(|v| self.place(*v)).collect();
        page.area(points, light, Some(Stroke::new(colour, 1.8)));
    }
}

/// The circle that `v` describes around `axis` (a unit vector), counter-clockwise.
pub fn circle(axis: V, v: V) -> Vec<V> {
    let along = axis * axis.dot(&v);
    let (a, b) = (v - along, axis.cross(&v));
    let at = |k: i32| {
        let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::TAU / 180.0);
        along + a * cos + b * sin
    };
    (0..=180).map(at).collect()
}
