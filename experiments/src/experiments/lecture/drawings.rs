//! Figures on the sphere as SVG: seen from far away, what lies behind is dashed.

use std::fmt::Write as _;

use nalgebra::Vector3;
use polhode::body::Body;
use polhode::flow::{FreeMotion, LagrangeTop};
use polhode::inertia::Inertia;
use polhode::rotation::EulerSequence;

use crate::error::{Error, unexpected};
use crate::experiment::Drawing;

type V = Vector3<f64>;

const BLACK: &str = "#000000";
const BLUE: &str = "#0072b2";
const GREEN: &str = "#009e73";
const ORANGE: &str = "#d55e00";
const GREY: &str = "#8a8a8a";

/// Pixels of the radius, and of a panel.
const RADIUS: f64 = 150.0;
const PANEL: f64 = 430.0;

/// A panel of a figure: the sphere of unit radius around `centre`, seen from a direction.
struct Panel {
    centre: [f64; 2],
    right: V,
    up: V,
    towards: V,
    svg: String,
}

impl Panel {
    /// The panel number `column`, seen from `azimuth` and `elevation`, rad.
    fn new(column: usize, azimuth: f64, elevation: f64, title: &str) -> Self {
        let (sin_a, cos_a) = libm::sincos(azimuth);
        let (sin_e, cos_e) = libm::sincos(elevation);
        let left = PANEL * column as f64;
        let mut panel = Panel {
            centre: [left + 0.5 * PANEL, 0.5 * PANEL + 25.0],
            right: V::new(-sin_a, cos_a, 0.0),
            up: V::new(-sin_e * cos_a, -sin_e * sin_a, cos_e),
            towards: V::new(cos_e * cos_a, cos_e * sin_a, sin_e),
            svg: String::new(),
        };
        let x = panel.centre[0];
        panel.text([x, 26.0], "middle", 17, title);
        panel
    }

    fn place(&self, v: V) -> [f64; 2] {
        [self.centre[0] + RADIUS * v.dot(&self.right), self.centre[1] - RADIUS * v.dot(&self.up)]
    }

    fn text(&mut self, [x, y]: [f64; 2], anchor: &str, size: u32, text: &str) {
        let _ = writeln!(
            self.svg,
            r#"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}" font-size="{size}">{text}</text>"#
        );
    }

    fn ball(&mut self) {
        let [x, y] = self.centre;
        let _ = writeln!(
            self.svg,
            r##"<circle cx="{x:.1}" cy="{y:.1}" r="{RADIUS}" fill="url(#ball)" stroke="#555555" stroke-width="1.2"/>"##
        );
    }

    /// A run of points, solid or dashed.
    fn line(&mut self, points: &[V], colour: &str, width: f64, dashed: bool) {
        if points.len() < 2 {
            return;
        }
        let path: Vec<String> = points
            .iter()
            .map(|v| {
                let [x, y] = self.place(*v);
                format!("{x:.2},{y:.2}")
            })
            .collect();
        let dash = if dashed { r#" stroke-dasharray="4 4" stroke-opacity="0.6""# } else { "" };
        let width = if dashed { 0.75 * width } else { width };
        let _ = writeln!(
            self.svg,
            r#"<polyline points="{}" fill="none" stroke="{colour}" stroke-width="{width:.2}" stroke-linejoin="round" stroke-linecap="round"{dash}/>"#,
            path.join(" ")
        );
    }

    /// A curve on the sphere: solid in front, dashed behind.
    fn curve(&mut self, points: &[V], colour: &str, width: f64) {
        let mut run: Vec<V> = Vec::new();
        let mut runs = Vec::new();
        for (k, &now) in points.iter().enumerate() {
            if let Some(&before) = k.checked_sub(1).and_then(|k| points.get(k)) {
                let (from, to) = (before.dot(&self.towards), now.dot(&self.towards));
                if (from < 0.0) != (to < 0.0) {
                    let edge = before + (now - before) * (from / (from - to));
                    run.push(edge);
                    runs.push((std::mem::take(&mut run), from < 0.0));
                    run.push(edge);
                }
            }
            run.push(now);
        }
        let behind = points.last().is_some_and(|last| last.dot(&self.towards) < 0.0);
        runs.push((run, behind));
        // what is behind first, so that the front covers it
        for hidden in [true, false] {
            for (run, behind) in &runs {
                if *behind == hidden {
                    self.line(run, colour, width, hidden);
                }
            }
        }
    }

    /// An arrowhead at `tip`, pointing along `direction` as it is seen.
    fn head(&mut self, tip: V, direction: V, colour: &str, size: f64) {
        let [x, y] = self.place(tip);
        let (u, v) = (direction.dot(&self.right), -direction.dot(&self.up));
        let length = libm::hypot(u, v);
        if length == 0.0 {
            return;
        }
        let (u, v) = (size * u / length, size * v / length);
        let (back_x, back_y) = (x - 2.0 * u, y - 2.0 * v);
        let _ = writeln!(
            self.svg,
            r#"<polygon points="{:.2},{:.2} {:.2},{:.2} {:.2},{:.2}" fill="{colour}"/>"#,
            x + 0.5 * u,
            y + 0.5 * v,
            back_x - 0.8 * v,
            back_y + 0.8 * u,
            back_x + 0.8 * v,
            back_y - 0.8 * u
        );
    }

    /// An arrow from `from` to `to` with a name beyond its tip.
    fn arrow(&mut self, from: V, to: V, colour: &str, name: &str) {
        self.line(&[from, to], colour, 2.0, false);
        self.head(to, to - from, colour, 5.0);
        // the name stands beyond the tip, as far however the arrow is foreshortened
        let ([x, y], [u, v]) = (self.place(to), self.place(from));
        let share = 15.0 / libm::hypot(x - u, y - v);
        let [x, y] = [x + share * (x - u), y + share * (y - v)];
        self.text([x, y + 5.0], "middle", 16, name);
    }

    /// A coordinate axis of a ball: seen where it is outside, dashed behind.
    fn axis(&mut self, direction: V, name: &str) {
        let behind = direction.dot(&self.towards) < 0.0;
        if behind {
            // it comes out from behind the outline
            let across = direction - self.towards * direction.dot(&self.towards);
            let seen = 1.0 / across.norm();
            if seen < 1.3 {
                self.arrow(direction * seen.max(1.0), direction * 1.35, BLACK, name);
            }
        } else {
            self.arrow(direction, direction * 1.35, BLACK, name);
        }
    }

    /// The direction in which a closed curve is run through, marked where it is nearest.
    fn sense(&mut self, points: &[V], colour: &str) {
        let depth = |k: &usize| points[*k].dot(&self.towards);
        let Some(nearest) = (1..points.len()).max_by(|a, b| depth(a).total_cmp(&depth(b))) else {
            return;
        };
        if depth(&nearest) > 0.1 {
            let (tip, direction) = (points[nearest], points[nearest] - points[nearest - 1]);
            self.head(tip, direction, colour, 3.6);
        }
    }

    /// A cone from the centre around `axis`, one side of which is `side`: rim, outline and a light filling.
    fn cone(&mut self, axis: V, side: V, colour: &str, outline_dashed: bool) {
        let rim = circle(axis, side);
        // as it is seen, the outline touches the rim where the angle around the centre is largest
        let centre = {
            let middle = axis * axis.dot(&side);
            libm::atan2(middle.dot(&self.up), middle.dot(&self.right))
        };
        let turn = |v: &V| {
            let angle = libm::atan2(v.dot(&self.up), v.dot(&self.right)) - centre;
            angle - core::f64::consts::TAU * libm::round(angle / core::f64::consts::TAU)
        };
        let ends = [
            rim.iter().copied().max_by(|a, b| turn(a).total_cmp(&turn(b))),
            rim.iter().copied().min_by(|a, b| turn(a).total_cmp(&turn(b))),
        ];
        if let [Some(left), Some(right)] = ends {
            let [apex, left_at, right_at] = [V::zeros(), left, right].map(|v| self.place(v));
            let _ = writeln!(
                self.svg,
                r#"<polygon points="{:.2},{:.2} {:.2},{:.2} {:.2},{:.2}" fill="{colour}" fill-opacity="0.12"/>"#,
                apex[0], apex[1], left_at[0], left_at[1], right_at[0], right_at[1]
            );
            self.line(&[V::zeros(), left], colour, 1.6, outline_dashed);
            self.line(&[V::zeros(), right], colour, 1.6, outline_dashed);
        }
        let points: Vec<String> = rim
            .iter()
            .map(|v| {
                let [x, y] = self.place(*v);
                format!("{x:.2},{y:.2}")
            })
            .collect();
        let _ = writeln!(
            self.svg,
            r#"<polygon points="{}" fill="{colour}" fill-opacity="0.12" stroke="{colour}" stroke-width="1.8"/>"#,
            points.join(" ")
        );
    }
}

/// The circle that `v` describes around `axis` (a unit vector), counter-clockwise.
fn circle(axis: V, v: V) -> Vec<V> {
    let along = axis * axis.dot(&v);
    let (a, b) = (v - along, axis.cross(&v));
    let at = |k: i32| {
        let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::TAU / 180.0);
        along + a * cos + b * sin
    };
    (0..=180).map(at).collect()
}

fn drawing(name: &'static str, panels: Vec<Panel>, foot: &[&str]) -> Drawing {
    let (width, height) = (PANEL * panels.len() as f64, PANEL + 30.0 + 20.0 * foot.len() as f64);
    let mut svg = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="sans-serif">
<defs><radialGradient id="ball" cx="0.38" cy="0.32" r="0.75"><stop offset="0" stop-color="#ffffff"/><stop offset="1" stop-color="#e4e4e4"/></radialGradient></defs>
<rect width="{width}" height="{height}" fill="#ffffff"/>
"##
    );
    for panel in &panels {
        svg += &panel.svg;
    }
    for (line, text) in foot.iter().enumerate() {
        let _ = writeln!(
            svg,
            r#"<text x="{:.1}" y="{:.1}" text-anchor="middle" font-size="14">{text}</text>"#,
            0.5 * width,
            PANEL + 22.0 + 20.0 * line as f64
        );
    }
    svg += "</svg>\n";
    Drawing { name, svg }
}

/// The paths of the angular momentum in the body, on the sphere of its length.
pub(super) fn polhodes() -> Result<Drawing, Error> {
    let moments = V::new(1.0, 2.0, 3.0);
    let inertia = Inertia::from_moments(moments.into()).map_err(unexpected)?;
    let mut panel = Panel::new(0, 0.62, 0.42, "Polhodes of a body with moments 1 : 2 : 3");
    panel.ball();
    // in the plane of the outer axes the separatrix stands at tan^2 = (1/I1 - 1/I2)/(1/I2 - 1/I3)
    let separatrix = libm::atan(libm::sqrt(3.0));
    let mut starts = Vec::new();
    for share in [0.2, 0.4, 0.6, 0.8, 0.93] {
        starts.push((separatrix * share, BLUE));
        let right_angle = core::f64::consts::FRAC_PI_2;
        starts.push((right_angle - (right_angle - separatrix) * share, GREEN));
    }
    for (angle, colour) in starts {
        let (sin, cos) = libm::sincos(angle);
        for side in [1.0, -1.0] {
            let momentum = V::new(cos, 0.0, sin) * side;
            let omega = momentum.component_div(&moments);
            let free = FreeMotion::from_omega(&inertia, Default::default(), omega).map_err(unexpected)?;
            let period = free.character().map_err(unexpected)?.polhode_period;
            let period = period.ok_or_else(|| unexpected("a polhode without period"))?;
            let points: Vec<V> = (0..=360)
                .map(|k| free.point_at(period * f64::from(k) / 360.0).momentum_body.into())
                .collect();
            let points: Vec<V> = points.into_iter().map(|m: V| m.normalize()).collect();
            panel.curve(&points, colour, 1.5);
            panel.sense(&points, colour);
        }
    }
    let (sin, cos) = libm::sincos(separatrix);
    for side in [1.0, -1.0] {
        let normal = V::new(sin, 0.0, -cos * side);
        panel.curve(&circle(normal, V::y()), ORANGE, 2.2);
    }
    for (axis, name) in [(V::x(), "L₁"), (V::y(), "L₂"), (V::z(), "L₃")] {
        panel.axis(axis, name);
    }
    Ok(drawing(
        "polhodes",
        vec![panel],
        &[
            "blue: around the axis of the smallest moment; green: of the",
            "largest; orange: separatrix through that of the middle one",
        ],
    ))
}

/// Body cone and space cone of free symmetric bodies.
pub(super) fn cones() -> Result<Drawing, Error> {
    let mut panels = Vec::new();
    for (column, (title, ratio, theta)) in [
        ("prolate: the body cone rolls outside", 0.4, 0.75),
        ("oblate: it rolls around the space cone", 1.8, 0.55),
    ]
    .into_iter()
    .enumerate()
    {
        let mut panel = Panel::new(column, 0.35, 0.27, title);
        panel.centre[1] += 125.0;
        // L upwards, axis and w in one plane: tan(axis to w) = I3/I tan(axis to L)
        let (sin, cos) = libm::sincos(theta);
        let axis = V::new(0.0, sin, cos);
        let from_axis = libm::atan(ratio * sin / cos);
        let (sin, cos) = libm::sincos(theta - from_axis);
        let omega = V::new(0.0, sin, cos) * 1.5;
        let size = 1.15;
        panel.cone(axis, omega.normalize() * size, BLUE, false);
        panel.cone(V::z(), omega.normalize() * size, ORANGE, ratio > 1.0);
        panel.arrow(V::zeros(), V::z() * 1.75, ORANGE, "L");
        panel.arrow(V::zeros(), axis * 1.75, BLUE, "e₃");
        panel.arrow(V::zeros(), omega, BLACK, "ω");
        panels.push(panel);
    }
    Ok(drawing(
        "cones",
        panels,
        &["orange: space cone, fixed; blue: body cone, which rolls on it; they touch along ω"],
    ))
}

/// The path of a heavy top's axis: three ways of nodding.
pub(super) fn axis_paths() -> Result<Drawing, Error> {
    let (weight, tilt, nutations) = (1.0, 0.95, 7.0);
    let inertia = Inertia::from_moments([1.0; 3]).map_err(unexpected)?;
    let body = Body::heavy(inertia, V::new(0.0, 0.0, weight)).map_err(unexpected)?;
    let zxz: EulerSequence = "zxz".parse().map_err(unexpected)?;
    // of moments 1; φ′ at the start as a share of the steady precession
    let spun = |spin: f64, share: f64| {
        let omega = V::new(0.0, share * weight / spin * libm::sin(tilt), spin);
        LagrangeTop::from_omega(&body, zxz.attitude([0.0, tilt, 0.0]), omega).map_err(unexpected)
    };
    let advance =
        |top: &LagrangeTop| top.precession_per_nutation().ok_or_else(|| unexpected("the top does not nod"));
    let mut panels = Vec::new();
    for (column, (title, share)) in
        [("waves: φ′ forwards", 0.6), ("cusps: φ′ = 0", 0.0), ("loops: φ′ backwards", -0.9)]
            .into_iter()
            .enumerate()
    {
        let mut panel = Panel::new(column, -0.9, 0.5, title);
        panel.ball();
        // the spin at which the path closes after one turn
        let (mut slow, mut fast) = (2.0, 6.0);
        for _ in 0..50 {
            let spin = 0.5 * (slow + fast);
            if advance(&spun(spin, share)?)? * nutations > core::f64::consts::TAU {
                slow = spin
            } else {
                fast = spin
            }
        }
        let top = spun(fast, share)?;
        for limit in top.turning_points() {
            let (sin, cos) = libm::sincos(limit);
            panel.curve(&circle(V::z(), V::new(sin, 0.0, cos)), GREY, 1.0);
        }
        let period = top.nutation_period().ok_or_else(|| unexpected("the top does not nod"))?;
        let at = |k: i32| -> Result<V, Error> {
            let state = top.at(period * nutations * f64::from(k) / 1800.0).map_err(unexpected)?;
            Ok(state.rotation() * V::z())
        };
        let points = (0..=1800).map(at).collect::<Result<Vec<V>, Error>>()?;
        panel.curve(&points, BLUE, 2.0);
        panel.sense(&points, BLUE);
        panel.axis(V::z(), "Z");
        panels.push(panel);
    }
    Ok(drawing(
        "axis",
        panels,
        &["path of the axis of a heavy top; φ′ is its azimuthal rate at the upper circle"],
    ))
}
