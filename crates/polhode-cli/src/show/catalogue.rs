//! What the bodies of the catalogue look like. Sizes are those of their summaries, m, where they have some.

use nalgebra::Vector3;
use polhode::catalogue;
use polhode::inertia::Solid;
use polhode_pages::scene::{Shape, Tint};

use super::look::from_z;

type V = Vector3<f64>;

/// The shape of a body of the catalogue, and what it is; `None` of one whose shape is not known.
pub(super) fn look(name: &str) -> Option<(Shape, String)> {
    let words = |text: &str| text.to_owned();
    Some(match name {
        "t-handle" => (t_handle(), words("bar of 80 mm and stem of 40 mm, 10 mm thick")),
        "phone" => {
            (Shape::of_solid(&Solid::Box([0.1467, 0.0715, 0.0077])), words("a box of 146.7 x 71.5 x 7.7 mm"))
        }
        "racket" => (racket(), words("a racket, not to scale: its moments are measured")),
        "water" => (water(), words("the three atoms and their bonds, the atoms not to scale")),
        "gyroscope" => (gyroscope(), words("the disk above the tip with its axle")),
        "bicycle-wheel" => {
            (wheel(), words("the wheel at its distance from the end of the axle, which hangs"))
        }
        "toutatis" | "prolate" | "oblate" | "sphere" => {
            let inertia = catalogue::body(name)?.inertia;
            let shape = Shape::equal_ellipsoid(inertia.principal_moments(), inertia.principal_axes());
            (shape, words("the ellipsoid of uniform density with the same inertia"))
        }
        _ => return None,
    })
}

/// A cone that stands on its tip, which is the origin, with its base in a direction.
pub(super) fn cone(towards: V) -> Shape {
    let cone = Shape::of_solid(&Solid::Cone { radius: 0.4, height: 1.0 });
    cone.mapped(|at| V::new(at.x, -at.y, 1.0 - at.z)).turned(from_z(towards))
}

fn rod(radius: f64, from: V, to: V) -> Shape {
    let along = to - from;
    Shape::of_solid(&Solid::Cylinder { radius, height: along.norm() })
        .turned(from_z(along))
        .moved((from + to) / 2.0)
}

/// Bar along y, stem along x; the origin is the centre of mass.
fn t_handle() -> Shape {
    let (radius, bar, stem) = (0.005, 0.08, 0.04);
    // lengths are as masses, and the middle of the stem lies at its radius and half its length
    let center = V::x() * ((radius + stem / 2.0) * stem / (bar + stem));
    let bar = rod(radius, V::y() * (-bar / 2.0), V::y() * (bar / 2.0));
    let stem = rod(radius, V::x() * radius, V::x() * (radius + stem));
    bar.with(stem).moved(-center)
}

/// Handle along x, face in the plane of x and y.
fn racket() -> Shape {
    let (ring, handle) = (0.13, -0.38);
    let head = Shape::of_solid(&Solid::Torus { ring, tube: 0.011 });
    let strings = Shape::of_solid(&Solid::Cylinder { radius: ring, height: 0.003 }).tinted(Tint::Quiet);
    let oval = |shape: Shape| shape.mapped(|at| V::new(1.3 * at.x + 0.17, at.y, at.z));
    let grip = rod(0.016, V::x() * handle, V::x() * (handle + 0.18)).tinted(Tint::Mark);
    let throat = rod(0.012, V::x() * (handle + 0.18), V::x() * (0.17 - 1.3 * ring)).tinted(Tint::Plain);
    oval(head).tinted(Tint::Plain).with(oval(strings)).with(grip).with(throat)
}

/// In units of 1e-10 m: axis x joins the hydrogen atoms, y is the symmetry axis; about the centre of mass.
fn water() -> Shape {
    let (sin, cos) = libm::sincos(104.52_f64.to_radians() / 2.0);
    let hydrogens = [-1.0, 1.0].map(|side| V::new(side * sin, cos, 0.0) * 0.9572);
    let ball = |radius, at: V| Shape::of_solid(&Solid::Sphere { radius }).moved(at);
    let mut shape = ball(0.38, V::zeros()).tinted(Tint::Mark);
    for at in hydrogens {
        shape = shape
            .with(ball(0.26, at).tinted(Tint::Plain))
            .with(rod(0.09, V::zeros(), at).tinted(Tint::Quiet));
    }
    // of hydrogen 1.008 and oxygen 15.995
    shape.moved(-V::y() * (2.0 * 1.008 * 0.9572 * cos / (2.0 * 1.008 + 15.995)))
}

/// The tip is the origin, the axle is z.
fn gyroscope() -> Shape {
    let disk = Shape::of_solid(&Solid::Cylinder { radius: 0.030, height: 0.008 }).moved(V::z() * 0.040);
    disk.with(rod(0.0012, V::zeros(), V::z() * 0.062).tinted(Tint::Quiet))
}

/// The end of the axle is the origin, the axle is z.
fn wheel() -> Shape {
    let (radius, hub) = (0.310, V::z() * 0.120);
    let mut shape = Shape::of_solid(&Solid::Torus { ring: radius, tube: 0.016 }).moved(hub);
    for k in 0..6 {
        let (sin, cos) = libm::sincos(core::f64::consts::PI * f64::from(k) / 6.0);
        let end = V::new(cos, sin, 0.0) * radius;
        shape = shape.with(rod(0.003, hub - end, hub + end).tinted(Tint::Quiet));
    }
    shape.with(rod(0.008, V::zeros(), V::z() * 0.16).tinted(Tint::Quiet))
}
