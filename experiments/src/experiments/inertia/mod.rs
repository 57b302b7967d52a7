//! Inertia tensors: closed forms against quadrature, meshes against their solids, the lecture's statements, the doctor.

mod doctor;
mod lecture;
mod robots;
mod shapes;

use std::time::Instant;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use polhode::inertia::{Amount, MassProperties, Mesh, Solid, integrate_mass};
use polhode::num::Random;
use polhode_files::error::Error;
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};

/// Of the random bodies.
const SEED: u64 = 17;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut failures = Vec::new();
    let solids = solids(&mut failures)?;
    let (spheres, figure) = spheres(context.scale.pick(32, 64, 256), &mut failures)?;
    let boxes = boxes(context.scale.pick(4, 16, 64), &mut failures)?;
    let random = Random::new(SEED);
    let statements = lecture::statements(random.stream(0), &mut failures)?;
    let doctor = doctor::rates(context, &random.stream(1), &mut failures)?;
    let robots = robots::rates(context, &random.stream(2), &mut failures)?;
    let timing = timing(context.scale.pick(32, 128, 289))?;
    let checked = [&solids, &spheres, &boxes, &statements].map(|table| table.rows().len() as u64);
    let checks = checked.iter().sum::<u64>();
    Ok(Report {
        conclusion: format!(
            "{} solids agree with quadrature, {} statements of the lecture hold, mistakes in tensors are named",
            checked[0], checked[3]
        ),
        checks,
        tables: vec![solids, spheres, boxes, statements, doctor, robots],
        figures: vec![figure],
        timing: Some(timing),
        seed: Some(SEED),
        failures,
        ..Report::default()
    })
}

fn failed(error: &dyn std::fmt::Display) -> Error {
    Error::Failed(error.to_string())
}

/// Closed forms and their largest difference from quadrature.
fn solids(failures: &mut Vec<String>) -> Result<Table, Error> {
    let mut table = Table::new(
        "solids",
        "Moments over mass of homogeneous shapes, and how far the computed ones are from quadrature.",
        vec![
            Column::new("shape", "", "name on the command line"),
            Column::new("sizes", "m", "those of the measurement").hidden(),
            Column::new("center_z", "m", "centre of mass on the z axis").hidden(),
            Column::new("ixx_over_mass", "", "closed form about the centre of mass")
                .heading("I_xx / M")
                .latex("$I_{xx}/M$"),
            Column::new("iyy_over_mass", "", "closed form about the centre of mass")
                .heading("I_yy / M")
                .latex("$I_{yy}/M$"),
            Column::new("izz_over_mass", "", "closed form about the centre of mass")
                .heading("I_zz / M")
                .latex("$I_{zz}/M$"),
            Column::new("inertia_xx", "kg m^2", "for density 1").hidden(),
            Column::new("inertia_yy", "kg m^2", "for density 1").hidden(),
            Column::new("inertia_zz", "kg m^2", "for density 1").hidden(),
            Column::new("class", "", "what the principal moments say"),
            Column::new("difference", "", "largest relative difference of mass and moments from quadrature")
                .digits(2),
        ],
    );
    for (solid, [x, y, z]) in shapes::ALL {
        let body = solid.with(Amount::Density(1.0)).map_err(|error| failed(&error))?;
        let found =
            integrate_mass(|u| Ok(shapes::element(solid, u)), 1e-14).map_err(|error| failed(&error))?;
        let moments = body.tensor().diagonal();
        let mut difference = (found.mass() / body.mass() - 1.0).abs();
        for k in 0..3 {
            let (closed, summed) = (moments[k], found.tensor()[(k, k)]);
            let scale = if closed == 0.0 { moments.max() } else { closed };
            difference = difference.max((summed - closed).abs() / scale);
        }
        if difference > 1e-12 {
            failures.push(format!("{} differs from quadrature by {difference:e}", solid.name()));
        }
        let sizes: Vec<String> = solid.sizes().iter().map(f64::to_string).collect();
        table.push(row![
            solid.name(),
            sizes.join(" "),
            body.center_of_mass().z,
            x,
            y,
            z,
            moments.x,
            moments.y,
            moments.z,
            body.class().name(),
            difference,
        ]);
    }
    Ok(table)
}

/// Polyhedra with corners on a sphere: their errors fall with the square of the edge.
fn spheres(finest: usize, failures: &mut Vec<String>) -> Result<(Table, Figure), Error> {
    let mut table = Table::new(
        "spheres",
        "Meshes with corners on a sphere of radius 1: relative errors against the ball, by length of edge.",
        vec![
            Column::new("triangles", "", "of the mesh"),
            Column::new("h", "m", "edge of the squares of the cube before they are cut and blown up")
                .latex("$h$"),
            Column::new("volume_error", "", "relative").heading("volume"),
            Column::new("volume_order", "", "log2 of the ratio to the error at twice h")
                .heading("order")
                .digits(5),
            Column::new("moment_error", "", "of the trace of the tensor at density 1, relative")
                .heading("moments"),
            Column::new("moment_order", "", "log2 of the ratio to the error at twice h")
                .heading("order")
                .digits(5),
        ],
    );
    let ball = Solid::Sphere { radius: 1.0 }.with(Amount::Density(1.0)).map_err(|error| failed(&error))?;
    let (mut volumes, mut moments) = (Vec::new(), Vec::new());
    let mut n = 8;
    while n <= finest {
        let mesh = mesh(shapes::cube(n).map(|t| t.map(|v| v.normalize())))?;
        let body = mesh.with(Amount::Density(1.0)).map_err(|error| failed(&error))?;
        let h = 2.0 / n as f64;
        let trace = ball.tensor().trace();
        volumes.push((h, (ball.mass() - body.mass()) / ball.mass()));
        moments.push((h, (trace - body.tensor().trace()) / trace));
        let order = |errors: &[(f64, f64)]| match errors {
            [.., before, now] => Some(libm::log2(before.1 / now.1)),
            _ => None,
        };
        let last = |errors: &[(f64, f64)]| errors.last().map(|(_, error)| *error);
        let orders = (order(&volumes), order(&moments));
        if orders.0.into_iter().chain(orders.1).any(|order| (order - 2.0).abs() > 0.05) {
            failures
                .push(format!("the mesh of {n} squares along an edge converges with the orders {orders:?}"));
        }
        table.push(row![mesh.triangles() as u64, h, last(&volumes), orders.0, last(&moments), orders.1]);
        n *= 2;
    }
    let mut figure = Figure::log_log(
        "spheres",
        "Mass properties of a ball by its mesh, relative to the closed form",
        "length of an edge over the radius",
        "relative error",
    );
    if let Some(&(h, error)) = volumes.last() {
        figure.guide("slope 2", 2.0, (h, 0.5 * error), [h, 4.0 * h]);
    }
    figure.series = vec![Curve::new("volume", volumes), Curve::new("moments", moments)];
    Ok((table, figure))
}

/// Meshed boxes are the boxes.
fn boxes(finest: usize, failures: &mut Vec<String>) -> Result<Table, Error> {
    let mut table = Table::new(
        "boxes",
        "Meshes of a box 0.3 m x 1.7 m x 2.9 m: largest relative error of mass, centre (in radii of gyration) and tensor.",
        vec![
            Column::new("triangles", "", "of the mesh"),
            Column::new("corner", "", "one corner at the origin, edges along the axes"),
            Column::new("turned", "", "turned about the origin by no special angle"),
            Column::new("far", "", "shifted by a million edges, where the vertices are exact"),
        ],
    );
    let edges = Vector3::new(0.3, 1.7, 2.9);
    let turn = UnitQuaternion::new_normalize(Quaternion::new(0.7, -0.3, 0.5, 0.2));
    let body = |edges: Vector3<f64>| {
        let solid = Solid::Box(edges.into()).with(Amount::Density(7.5));
        solid.and_then(|body| body.moved(edges * 0.5)).map_err(|error| failed(&error))
    };
    let mut n = 1;
    while n <= finest {
        let corner = |edges: Vector3<f64>| {
            shapes::cube(n).map(move |t| t.map(|v| (v + Vector3::repeat(1.0)).component_mul(&edges) * 0.5))
        };
        let error = |mesh: Mesh, expected: MassProperties| {
            mesh.with(Amount::Density(7.5))
                .map(|found| error(&found, &expected))
                .map_err(|error| failed(&error))
        };
        let expected = body(edges)?;
        let plain = mesh(corner(edges))?;
        let triangles = plain.triangles() as u64;
        let plain = error(plain, expected)?;
        let turned = error(mesh(corner(edges).map(|t| t.map(|v| turn * v)))?, expected.turned(turn))?;
        let (far, dyadic) = (Vector3::new(3145728.0, -2097152.0, 1048576.0), Vector3::new(1.0, 2.0, 0.5));
        let distant = body(dyadic)?.moved(far).map_err(|error| failed(&error))?;
        let far = error(mesh(corner(dyadic).map(|t| t.map(|v| v + far)))?, distant)?;
        for (place, error) in [("corner", plain), ("turned", turned), ("far", far)] {
            if error > 1e-14 {
                failures.push(format!("a box of {triangles} triangles, {place}, is wrong by {error:e}"));
            }
        }
        table.push(row![triangles, plain, turned, far]);
        n *= 4;
    }
    Ok(table)
}

fn error(found: &MassProperties, expected: &MassProperties) -> f64 {
    let scale = expected.tensor().amax();
    let center = (found.center_of_mass() - expected.center_of_mass()).amax();
    let mass = (found.mass() / expected.mass() - 1.0).abs();
    let tensor = (found.tensor() - expected.tensor()).amax() / scale;
    mass.max(tensor).max(center / (scale / expected.mass()).sqrt())
}

fn mesh(triangles: impl Iterator<Item = [Vector3<f64>; 3]>) -> Result<Mesh, Error> {
    Mesh::new(triangles).map_err(|error| failed(&error))
}

/// Time to read a binary STL from memory.
fn timing(n: usize) -> Result<Table, Error> {
    let mut table = Table::new(
        "timing",
        "Time to read a binary STL from memory, check it and integrate over it. Depends on the machine.",
        vec![
            Column::new("triangles", "", "of the file"),
            Column::new("megabytes", "MB", "of the file").heading("size"),
            Column::new("seconds", "s", "best of three").heading("time"),
        ],
    );
    let bytes = shapes::stl(shapes::cube(n).map(|t| t.map(|v| v.normalize())));
    let mut best = f64::INFINITY;
    let mut triangles = 0;
    for _ in 0..3 {
        let start = Instant::now();
        let mesh = polhode_files::mesh::stl(bytes.as_slice())
            .map_err(|error| failed(&error))?
            .mesh()
            .map_err(|error| failed(&error))?;
        best = best.min(start.elapsed().as_secs_f64());
        triangles = mesh.triangles() as u64;
    }
    table.push(row![triangles, bytes.len() as f64 / 1e6, best]);
    Ok(table)
}
