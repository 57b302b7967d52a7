//! What the body of a page looks like.

use std::path::Path;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::{Body, Problem};
use polhode::inertia::{Amount, FLOAT_WELD, Inertia, Solid, Surface};
use polhode_files::bodies::{self, Form, Look, Piece};
use polhode_files::error::{Error, unexpected};
use polhode_files::mesh::surface;
use polhode_files::text::visible;
use polhode_pages::scene::{MOST_TRIANGLES, Shape};

use super::catalogue;
use crate::flags::body::BodyArguments;
use crate::plot::looks::weight_moment;

/// A mesh has at most so many triangles: more is a mistake, or a scan that no page needs.
const MOST: usize = 3_000_000;
/// A point is drawn with this share of the size of the body.
const DOT: f64 = 0.05;

/// A shape and what is to be known of it.
pub(super) struct Drawn {
    pub(super) shape: Shape,
    pub(super) words: String,
}

/// The shape of the body that the flags name, or of the mesh that is to be drawn in its place.
pub(super) fn of(flags: &BodyArguments, body: &Body, mesh: Option<&Path>) -> Result<Drawn, Error> {
    if let Some(path) = mesh {
        let surface = surface(path)?;
        check_size(path, &surface)?;
        let center = if is_heavy(body) { Vector3::zeros() } else { middle(&surface) };
        let shape = Shape::of_surface(&surface).moved(-center);
        let name = visible(&path.display().to_string()).into_owned();
        return fewer(shape, format!("drawn: the mesh {name}; the inertia is that of the body"));
    }
    let Some(name) = flags.named() else { return Ok(of_inertia(body, "")) };
    if let Some((shape, words)) = catalogue::look(name) {
        return Ok(Drawn { shape, words: format!("drawn: {words}") });
    }
    let Some(form) = bodies::form("--body", name)? else { return Ok(of_inertia(body, "")) };
    if form.pieces.is_empty() {
        return Ok(of_inertia(body, &form.remark.map_or(String::new(), |remark| format!("{remark}; "))));
    }
    let shape = assembled(&form, name)?;
    let words = format!("drawn: {}", flags.label());
    fewer(shape, words)
}

fn fewer(shape: Shape, words: String) -> Result<Drawn, Error> {
    let whole = shape.triangles();
    if whole <= MOST_TRIANGLES {
        return Ok(Drawn { shape, words });
    }
    let shape = shape.decimated(MOST_TRIANGLES);
    let words = format!("{words}, with {} of its {whole} triangles", shape.triangles());
    Ok(Drawn { shape, words })
}

/// The parts of a file about the centre of mass of all.
fn assembled(form: &Form, name: &str) -> Result<Shape, Error> {
    let placed = |shape: Shape, piece: &Piece| shape.turned(piece.turn).moved(piece.at - form.center_of_mass);
    let mut shape = Shape::default();
    for piece in &form.pieces {
        let part = match &piece.look {
            Look::Solid(solid) => Shape::of_solid(solid),
            Look::Surface(surface) => {
                check_size(Path::new(name), surface)?;
                Shape::of_surface(surface)
            }
            Look::Tensor(mass, tensor) => {
                let inertia = Inertia::from_tensor(*tensor).map_err(unexpected)?;
                let moments = inertia.principal_moments();
                // the largest edge of the box of this mass
                let edge = libm::sqrt(6.0 * (moments[1] + moments[2] - moments[0]) / mass);
                Shape::equal_box(moments, inertia.principal_axes()).mapped(|at| at * (0.5 * edge))
            }
            _ => continue,
        };
        shape = shape.with(placed(part, piece));
    }
    let at = |piece: &Piece| (piece.at - form.center_of_mass).norm();
    let size = form.pieces.iter().map(at).fold(shape.radius(), f64::max);
    for piece in form.pieces.iter().filter(|piece| matches!(piece.look, Look::Point)) {
        shape = shape.with(placed(Shape::of_solid(&Solid::Sphere { radius: DOT * size }), piece));
    }
    Ok(shape)
}

/// A body of which only the inertia is known.
fn of_inertia(body: &Body, why: &str) -> Drawn {
    if let (true, Some(weight)) = (is_heavy(body), weight_moment(body)) {
        return Drawn {
            shape: catalogue::cone(weight),
            words: format!(
                "{why}drawn: a cone from the fixed point towards the centre of mass, not to scale"
            ),
        };
    }
    let inertia = body.inertia();
    let shape = Shape::equal_box(inertia.principal_moments(), inertia.principal_axes());
    Drawn {
        shape,
        words: format!(
            "{why}drawn: the box of uniform density with the same inertia, as the shape is not known"
        ),
    }
}

fn is_heavy(body: &Body) -> bool {
    body.problem() != Problem::Free && body.linear_potential::<f64>().is_some()
}

fn check_size(path: &Path, surface: &Surface) -> Result<(), Error> {
    let count = surface.triangles().count();
    if count <= MOST {
        return Ok(());
    }
    let rule = format!("has {count} triangles, and a page is made of at most {MOST}");
    Err(Error::input(&path.display().to_string(), "", &rule, "reduce it in the program that it comes from"))
}

/// The centre of what a mesh encloses, or of the box around it where it is open.
fn middle(surface: &Surface) -> Vector3<f64> {
    let enclosed = surface.mended(FLOAT_WELD).ok().and_then(|(mesh, _)| mesh.with(Amount::Density(1.0)).ok());
    if let Some(body) = enclosed {
        return body.center_of_mass();
    }
    let corners = || surface.triangles().flatten();
    let fold = |pick: fn(f64, f64) -> f64| corners().reduce(|a, b| a.zip_map(&b, pick)).unwrap_or_default();
    (fold(f64::min) + fold(f64::max)) / 2.0
}

/// The least turn of z to a direction.
pub(super) fn from_z(direction: Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&Vector3::z(), &direction)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), core::f64::consts::PI))
}
