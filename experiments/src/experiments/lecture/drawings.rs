//! Figures on the sphere.

use nalgebra::Vector3;
use polhode::body::Body;
use polhode::flow::{FreeMotion, LagrangeTop};
use polhode::inertia::Inertia;
use polhode::rotation::EulerSequence;
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::sphere::{View, circle};
use polhode_pages::figure::style::{BLACK, BLUE, GREEN, GREY, NAME, ORANGE, TITLE};
use polhode_pages::figure::{Anchor, Canvas, Drawing};

type V = Vector3<f64>;

/// Pixels of the radius, and of a panel.
const RADIUS: f64 = 150.0;
const PANEL: f64 = 430.0;
/// Height of a panel of cones.
const CONES: f64 = 330.0;
/// Room for the title above, and for each line below.
const ABOVE: f64 = 30.0;
const FOOT: f64 = 20.0;

/// A page of panels beside each other.
struct Panels {
    page: Canvas,
}

impl Panels {
    /// Panels of the height `high`, with lines of text below.
    fn new(columns: usize, high: f64, foot: &[&str]) -> Self {
        let (width, height) = (PANEL * columns as f64, high + ABOVE + FOOT * foot.len() as f64);
        let mut page = Canvas::new(width, height);
        for (line, text) in foot.iter().enumerate() {
            let at = [0.5 * width, high + 22.0 + FOOT * line as f64];
            page.text(at, text, NAME, Anchor::Middle, BLACK);
        }
        Self { page }
    }

    /// The view in the panel number `column`, seen from `azimuth` and `elevation`, rad.
    fn view(&mut self, column: usize, azimuth: f64, elevation: f64, title: &str) -> View {
        let x = PANEL * (column as f64 + 0.5);
        self.page.text([x, 24.0], title, TITLE, Anchor::Middle, BLACK);
        View::from_angles([x, 0.5 * PANEL + 25.0], RADIUS, azimuth, elevation)
    }

    fn drawing(self, name: &'static str) -> Drawing {
        Drawing { name, svg: self.page.svg() }
    }
}

/// The paths of the angular momentum in the body, on the sphere of its length.
pub(super) fn polhodes() -> Result<Drawing, Error> {
    let moments = V::new(1.0, 2.0, 3.0);
    let inertia = Inertia::from_moments(moments.into()).map_err(unexpected)?;
    let foot = [
        "blue: around L₁, the axis of the smallest moment;",
        "green: around L₃; orange: the separatrix through L₂",
    ];
    let mut panels = Panels::new(1, PANEL, &foot);
    let view = panels.view(0, 0.62, 0.42, "Polhodes of a body with moments 1 : 2 : 3");
    let page = &mut panels.page;
    view.ball(page);
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
            view.curve(page, &points, colour, 1.5);
            view.sense(page, &points, colour, 3.6);
        }
    }
    let (sin, cos) = libm::sincos(separatrix);
    for side in [1.0, -1.0] {
        let normal = V::new(sin, 0.0, -cos * side);
        view.curve(page, &circle(normal, V::y()), ORANGE, 2.2);
    }
    for (axis, name) in [(V::x(), "L₁"), (V::y(), "L₂"), (V::z(), "L₃")] {
        view.axis(page, axis, BLACK, name);
    }
    Ok(panels.drawing("polhodes"))
}

/// Body cone and space cone of free symmetric bodies.
pub(super) fn cones() -> Result<Drawing, Error> {
    let foot = "space cone around L, fixed; body cone around e₃, which rolls on it; they touch along ω";
    let mut panels = Panels::new(2, CONES, &[foot]);
    for (column, (title, ratio, theta)) in [
        ("prolate, I₃ = 0.4 I₁: the cones touch outside", 0.4, 0.75),
        ("oblate, I₃ = 1.8 I₁: one cone is inside the other", 1.8, 0.55),
    ]
    .into_iter()
    .enumerate()
    {
        let mut view = panels.view(column, 0.35, 0.27, title);
        view.centre[1] += 75.0;
        let page = &mut panels.page;
        // L upwards, axis and w in one plane: tan(axis to w) = I3/I tan(axis to L)
        let (sin, cos) = libm::sincos(theta);
        let axis = V::new(0.0, sin, cos);
        let from_axis = libm::atan(ratio * sin / cos);
        let (sin, cos) = libm::sincos(theta - from_axis);
        let omega = V::new(0.0, sin, cos) * 1.5;
        let size = 1.15;
        view.cone(page, axis, omega.normalize() * size, BLUE, false);
        view.cone(page, V::z(), omega.normalize() * size, ORANGE, ratio > 1.0);
        view.arrow(page, V::zeros(), V::z() * 1.75, ORANGE, "L");
        view.arrow(page, V::zeros(), axis * 1.75, BLUE, "e₃");
        view.arrow(page, V::zeros(), omega, BLACK, "ω");
    }
    Ok(panels.drawing("cones"))
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
    let foot = "path of the axis of a heavy top with I = 1, M g l = 1; φ′ is its azimuthal rate at the upper circle, θ₁; 7 nods a turn";
    let mut panels = Panels::new(3, PANEL, &[foot]);
    for (column, (title, share)) in
        [("waves: φ′ forwards", 0.6), ("cusps: φ′ = 0", 0.0), ("loops: φ′ backwards", -0.9)]
            .into_iter()
            .enumerate()
    {
        let view = panels.view(column, -0.9, 0.5, title);
        let page = &mut panels.page;
        view.ball(page);
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
        let limits = top.turning_points();
        for limit in limits {
            let (sin, cos) = libm::sincos(limit);
            view.curve(page, &circle(V::z(), V::new(sin, 0.0, cos)), GREY, 1.0);
        }
        let period = top.nutation_period().ok_or_else(|| unexpected("the top does not nod"))?;
        let at = |k: i32| -> Result<V, Error> {
            let state = top.at(period * nutations * f64::from(k) / 1800.0).map_err(unexpected)?;
            Ok(state.rotation() * V::z())
        };
        let points = (0..=1800).map(at).collect::<Result<Vec<V>, Error>>()?;
        view.curve(page, &points, BLUE, 2.0);
        view.sense(page, &points, BLUE, 5.0);
        view.axis(page, V::z(), BLACK, "Z");
        let [upper, lower] = limits.map(|limit| limit.to_degrees());
        let reading =
            format!("θ₁ = {upper:.0}°, θ₂ = {lower:.0}°, spin {fast:.2} rad/s, a nod in {period:.2} s");
        page.text([view.centre[0], PANEL - 6.0], &reading, NAME, Anchor::Middle, BLACK);
    }
    Ok(panels.drawing("axis"))
}
