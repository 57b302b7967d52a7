//! Paths on spheres and in a plane.

use nalgebra::Vector3;
use polhode::flow::Stability;
use polhode_files::error::{Error, warn};
use polhode_pages::figure::sphere::{View, circle};
use polhode_pages::figure::style::{BLACK, BLUE, Colour, GREY, ORANGE};
use polhode_pages::figure::{Canvas, Curve, Figure, Fill, Scale};

use super::looks::Looks;
use super::{BodyAxis, Plot};

type V = Vector3<f64>;

/// Of what context is drawn in.
const PALE: Colour = Colour(165, 165, 165);
/// Cosine of the angle between two arrows whose names would touch.
const BESIDE: f64 = 0.99;
/// A path that is shorter than this is a point.
const POINT: f64 = 1e-9;

impl Looks {
    /// What a degenerate motion is, as the end of a title.
    pub(crate) fn remark(&self) -> String {
        let Some(motion) = self.free() else { return String::new() };
        if motion.character().is_err() {
            return "; at rest".into();
        }
        let Some(spin) = motion.pure_spin() else { return String::new() };
        let [least, _, most] = self.body.inertia().principal_moments();
        match spin.stability {
            Stability::Neutral if least == most => "; a sphere turns steadily about any axis".into(),
            Stability::Neutral => "; a steady turn about an axis of the equator".into(),
            stability => {
                let axis = ["least", "middle", "largest"][spin.rank];
                format!("; a steady turn about the axis of the {axis} moment, {}", stability.name())
            }
        }
    }

    /// # Errors
    /// A body that is at rest, at some time or always.
    fn must_turn(&self, kind: &str) -> Result<(), Error> {
        let rests = |momentum: V| momentum.norm() == 0.0;
        if !self.momenta().any(rests) {
            return Ok(());
        }
        let when = if self.momenta().all(rests) { "" } else { " at some time" };
        Err(Error::Input(format!(
            "--omega: the body is at rest{when}, and a {kind} needs a direction; give another start, or plot omega"
        )))
    }
}

/// A page with its title, and a view of a sphere in the middle of what is left.
fn sphere(plot: &Plot, title: &str, path: &[V]) -> (Canvas, View) {
    let [width, height] = plot.size();
    let mut page = Canvas::new(width, height);
    let head = page.heading(title);
    let room = (height - head).max(160.0);
    let radius = 0.5 * room.min(width) / 1.48;
    let centre = [0.5 * width, head + 0.5 * room];
    let (azimuth, elevation) = match plot.view {
        Some([azimuth, elevation]) => (azimuth.to_radians(), elevation.to_radians()),
        None => facing(path),
    };
    let view = View::from_angles(centre, radius, azimuth, elevation);
    view.ball(&mut page);
    (page, view)
}

/// The direction of three from which the most of a path is in front; a later one only where it shows clearly more.
fn facing(path: &[V]) -> (f64, f64) {
    let seen = |(azimuth, elevation): (f64, f64)| {
        let view = View::from_angles([0.0; 2], 1.0, azimuth, elevation);
        path.iter().map(|v| v.dot(&view.towards())).sum::<f64>()
    };
    let margin = 0.05 * path.len() as f64;
    [(0.62 + core::f64::consts::PI, 0.42), (0.62, -0.42)]
        .into_iter()
        .fold((0.62, 0.42), |best, next| if seen(next) > seen(best) + margin { next } else { best })
}

/// A path on the sphere, its beginning and its sense; a point where it stays.
fn draw_path(page: &mut Canvas, view: &View, path: &[V], joined: bool) {
    let Some(&start) = path.first() else { return };
    let extent = path.iter().map(|v| (v - start).norm()).fold(0.0, f64::max);
    if extent < POINT {
        let hidden = start.dot(&view.towards()) < 0.0;
        page.as_class("point", |page| dot(page, view, start, 4.5, hidden));
        return;
    }
    if joined {
        page.as_class("path", |page| view.curve(page, path, BLUE, 2.0));
        view.sense(page, path, BLUE, 5.0);
    } else {
        page.as_class("path", |page| {
            for v in path.iter().filter(|v| v.dot(&view.towards()) >= 0.0) {
                page.circle(view.place(*v), 1.2, Some(Fill::Flat(BLUE, 0.7)), None);
            }
        });
    }
    let hidden = start.dot(&view.towards()) < 0.0;
    page.as_class("start", |page| dot(page, view, start, 3.6, hidden));
}

fn dot(page: &mut Canvas, view: &View, at: V, radius: f64, hidden: bool) {
    let opacity = if hidden { 0.45 } else { 1.0 };
    page.circle(view.place(at), radius, Some(Fill::Flat(BLACK, opacity)), None);
}

/// Directions of the angular momentum in the body.
pub(super) fn polhode(plot: &Plot, looks: &Looks) -> Result<Canvas, Error> {
    looks.must_turn("polhode")?;
    let path: Vec<V> = looks.momenta().map(|momentum| momentum.normalize()).collect();
    let mut title = plot.title("Polhode", looks) + &looks.remark();
    if looks.free().is_some_and(|motion| motion.pure_spin().is_some()) {
        title += "; the polhode is a point";
    }
    let inertia = looks.body.inertia();
    let frame = inertia.principal_axes();
    // with wheels the curves are others
    let is_bare = looks.body.wheels().is_empty();
    let context = if is_bare { context(inertia.principal_moments()) } else { Vec::new() };
    if context.iter().any(|curve| curve.separatrix) {
        title += "; orange: the separatrix";
    }
    if !context.is_empty() {
        title += "; grey: other polhodes";
    }
    let (mut page, view) = sphere(plot, &title, &path);
    for curve in context {
        let points: Vec<V> = curve.points.into_iter().map(|v| frame * v).collect();
        if curve.separatrix {
            page.as_class("separatrix", |page| view.curve(page, &points, ORANGE, 1.6));
        } else {
            view.curve(&mut page, &points, PALE, 1.0);
        }
    }
    draw_path(&mut page, &view, &path, looks.is_resolved());
    let moments = inertia.principal_moments();
    for rank in 0..3 {
        let axis = frame * V::ith(rank, 1.0);
        let typed = (0..3).find(|k| axis[*k].abs() > 1.0 - 1e-12);
        let axis = typed.map_or(axis, |k| V::ith(k, 1.0));
        let symbol = if moments[0] == moments[2] { "I" } else { ["I₁", "I₂", "I₃"][rank] };
        let name = typed.map_or(symbol.to_owned(), |k| format!("{} ({symbol})", ["x", "y", "z"][k]));
        view.axis(&mut page, axis, BLACK, &name);
    }
    Ok(page)
}

/// A polhode of other motions.
struct Neighbour {
    points: Vec<V>,
    separatrix: bool,
}

/// Polhodes around the axes of the smallest and of the largest moment, and the separatrix, in principal axes.
fn context(moments: [f64; 3]) -> Vec<Neighbour> {
    const STEPS: i32 = 240;
    let [a, b, c] = moments.map(f64::recip);
    // outwards from the axis `rank`, of the squares of the two other components `near` and `far`
    let around = |rank: usize, near: f64, far: f64, share: f64| {
        let (j, k) = ((rank + 1) % 3, (rank + 2) % 3);
        [1.0, -1.0].map(|side| {
            let points = (0..=STEPS).map(|n| {
                let (sin, cos) = libm::sincos(core::f64::consts::TAU * f64::from(n) / f64::from(STEPS));
                let mut v = V::zeros();
                (v[j], v[k]) = (share * near * cos, share * far * sin);
                v[rank] = side * libm::sqrt((1.0 - v[j] * v[j] - v[k] * v[k]).max(0.0));
                v
            });
            Neighbour { points: points.collect(), separatrix: false }
        })
    };
    let mut found = Vec::new();
    // where two moments agree the polhodes are circles around the third axis, and there is no separatrix
    let spread = (a - c) / a;
    if spread == 0.0 {
        return found;
    }
    let (lower, upper) = ((a - b) / (a - c), (b - c) / (a - c));
    for share in [0.3, 0.55, 0.8] {
        if lower > 0.0 {
            found.extend(around(0, 1.0, libm::sqrt(lower), share));
        }
        if upper > 0.0 {
            found.extend(around(2, libm::sqrt(upper), 1.0, share));
        }
    }
    if lower > 0.0 && upper > 0.0 {
        for side in [1.0, -1.0] {
            let normal = V::new(libm::sqrt(lower), 0.0, side * libm::sqrt(upper));
            found.push(Neighbour { points: circle(normal, V::y()), separatrix: true });
        }
    }
    found
}

/// An axis that moves by less, rad, stands still.
const STILL: f64 = 1e-9;

/// Path of an axis of the body in space.
pub(super) fn trace(plot: &Plot, looks: &Looks) -> Result<Canvas, Error> {
    let weight = looks.top().and(looks.weight());
    let (axis, name) = match (plot.axis, weight) {
        (Some(BodyAxis::X), _) => (V::x(), "x axis"),
        (Some(BodyAxis::Y), _) => (V::y(), "y axis"),
        (Some(BodyAxis::Z), _) => (V::z(), "z axis"),
        (None, Some(weight)) => (weight, "axis of the weight"),
        (None, None) => (V::z(), "z axis"),
    };
    let path: Vec<V> = looks.states.iter().map(|state| state.rotation() * axis).collect();
    if path.iter().all(|point| (point - path[0]).norm() < STILL) {
        warn(&format!("nothing moves in this picture: the {name} stands still in space"));
    }
    let mut title = plot.title(&format!("Trace of the body's {name} in space"), looks) + &looks.remark();
    let circles = looks.top().filter(|_| plot.axis.is_none()).map(|top| top.turning_points());
    if circles.is_some() {
        title += "; grey: its turning points";
    }
    let (mut page, view) = sphere(plot, &title, &path);
    for limit in circles.into_iter().flatten().filter(|limit| libm::sin(*limit) > 1e-6) {
        let (sin, cos) = libm::sincos(limit);
        page.as_class("turning-point", |page| {
            view.curve(page, &circle(V::z(), V::new(sin, 0.0, cos)), GREY, 1.0)
        });
    }
    draw_path(&mut page, &view, &path, looks.is_resolved());
    let momentum = looks.momentum_at_start().try_normalize(0.0).filter(|_| looks.keeps_momentum());
    // next to an axis the two share one name
    let beside = |axis: &V| momentum.is_some_and(|momentum| momentum.dot(axis) > BESIDE);
    for (axis, name) in [(V::x(), "X"), (V::y(), "Y"), (V::z(), "Z")] {
        let name = if beside(&axis) { format!("{name}, L") } else { name.to_owned() };
        view.axis(&mut page, axis, BLACK, &name);
    }
    if let Some(momentum) = momentum.filter(|momentum| momentum.max() <= BESIDE) {
        view.axis(&mut page, momentum, ORANGE, "L");
    }
    Ok(page)
}

/// ω in the plane across the angular momentum; under forces, across the Z axis.
pub(super) fn herpolhode(plot: &Plot, looks: &Looks) -> Result<Canvas, Error> {
    looks.must_turn("herpolhode")?;
    let momentum = looks.momentum_at_start();
    let (normal, plane) = if looks.keeps_momentum() {
        (momentum.normalize(), "L")
    } else {
        (V::z(), "the Z axis, as L is not constant")
    };
    let least = normal.iamin();
    let right = normal.cross(&V::ith(least, 1.0)).normalize();
    let up = normal.cross(&right);
    let points: Vec<(f64, f64)> = looks
        .states
        .iter()
        .zip(&looks.omegas)
        .map(|(state, omega)| {
            let omega = state.rotation() * omega;
            (omega.dot(&right), omega.dot(&up))
        })
        .collect();
    let size = looks.omegas.iter().map(|omega| omega.norm()).fold(0.0, f64::max);
    let radii = points.iter().map(|(x, y)| libm::hypot(*x, *y));
    let [inner, outer] = [radii.clone().fold(f64::INFINITY, f64::min), radii.fold(0.0, f64::max)];
    let mut title = plot.title(&format!("Herpolhode in the plane across {plane}"), looks) + &looks.remark();
    let [width, height] = plot.size();
    let mut figure =
        Figure::new("herpolhode", "", ("ω (rad/s)", Scale::Linear), ("ω (rad/s)", Scale::Linear))
            .equal()
            .sized(width, height);
    if outer <= POINT * size {
        title += "; the herpolhode is a point: ω lies along L";
        figure.series.push(Curve::new("", vec![(0.0, 0.0)]));
    } else {
        figure.series.push(Curve::new("", points.first().copied().into_iter().collect()));
        if looks.keeps_momentum() {
            let round = (outer - inner) <= 1e-6 * outer;
            title += if round { "; a circle" } else { "; grey: the circles that it touches" };
            for radius in if round { vec![] } else { vec![inner, outer] } {
                let ring = circle(V::z(), V::new(radius, 0.0, 0.0));
                let ring = ring.into_iter().map(|v| (v.x, v.y)).collect();
                figure.series.push(Curve::new("", ring).plain().coloured(7));
            }
        }
        title += "; dot: the start";
        let path = Curve::new("", points).coloured(2);
        figure.series.push(if looks.is_resolved() { path.plain() } else { path.dots() });
    }
    figure.title = title;
    Ok(figure.page())
}
