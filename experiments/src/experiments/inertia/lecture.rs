//! What the lecture says of inertia tensors (17.1) and of rotation about any point (17.2), tried on random points.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Amount, MassProperties, Solid};
use polhode::num::Random;
use polhode_files::error::Error;
use polhode_pages::table::{Column, Table, row};

use super::failed;

/// A point: mass and place.
type Point = (f64, Vector3<f64>);

/// Relative discrepancy of sums of a thousand rounded terms.
const ROUNDING: f64 = 1e-13;

pub(super) fn statements(mut random: Random, failures: &mut Vec<String>) -> Result<Table, Error> {
    let mut table = Table::new(
        "statements",
        "Statements of the lecture on a thousand random points: relative discrepancy of both sides.",
        vec![
            Column::new("section", "", "of the lecture"),
            Column::new("statement", "", "what it says"),
            Column::new("discrepancy", "", "largest difference of both sides over the largest entry")
                .digits(2),
        ],
    );
    let mut vector = |size: f64| Vector3::from([(); 3].map(|()| random.between(-size, size)));
    let places: Vec<Vector3<f64>> = (0..1000).map(|_| vector(1.0) + Vector3::new(0.3, -0.2, 0.5)).collect();
    let points: Vec<Point> = places.iter().map(|&at| (1.0 + 0.5 * at.x, at)).collect();
    let (q, omega) = (vector(5.0), vector(2.0));
    let body = MassProperties::of_points(points.clone()).map_err(|error| failed(&error))?;
    let (mass, center) = (body.mass(), body.center_of_mass());

    let mut say = |section: &'static str, statement: &'static str, discrepancy: f64| {
        if discrepancy > ROUNDING || discrepancy.is_nan() {
            failures.push(format!("{section}, {statement}: {discrepancy:e}"));
        }
        table.push(row![section, statement, discrepancy]);
    };

    say("17.1", "I_jk = sum m (delta_jk s^2 - s_j s_k)", apart(&body.tensor(), &direct(&points, center)));
    let part = |range: std::ops::Range<usize>| MassProperties::of_points(points[range].to_vec());
    let sum = [part(0..300), part(300..310), part(310..1000)].into_iter().collect::<Result<Vec<_>, _>>();
    let sum = sum.and_then(MassProperties::sum).map_err(|error| failed(&error))?;
    say("17.1", "the tensor is additive for the parts of a body", apart(&sum.tensor(), &body.tensor()));

    let o = *body.principal_axes().to_rotation_matrix().matrix();
    let diagonal = Matrix3::from_diagonal(&body.principal_moments().into());
    say("17.1", "O^t I O is diagonal", apart(&(o.transpose() * body.tensor() * o), &diagonal));
    say("17.1", "I O_j = I_j O_j", apart(&(body.tensor() * o), &(o * diagonal)));

    let flat: Vec<Point> = points.iter().map(|&(m, at)| (m, Vector3::new(at.x, at.y, 0.0))).collect();
    let flat = MassProperties::of_points(flat).map_err(|error| failed(&error))?;
    let [a, b, c] = flat.principal_moments();
    say("17.1", "planar body: I_3 = I_1 + I_2", (a + b - c).abs() / c);
    let normal = flat.principal_axes() * Vector3::z();
    say("17.1", "planar body: a principal axis is normal to the plane", normal.xy().norm());

    let cube = Solid::Box([0.7; 3]).with(Amount::Mass(2.0)).map_err(|error| failed(&error))?;
    let [a, _, c] = cube.principal_moments();
    say("17.1", "the cube is a spherical top", (c - a) / c);

    let about = direct(&points, q);
    let moved = body.tensor_about(q).map_err(|error| failed(&error))?;
    say("17.2", "I_Q = I + M (R_Q^2 - R_Q R_Q^t)", apart(&moved, &about));
    let back = MassProperties::from_tensor_about(q, mass, center, about).map_err(|error| failed(&error))?;
    say("17.2", "and back from Q to the centre of mass", apart(&back.tensor(), &body.tensor()));
    // a turn about Q: every point has the velocity omega x s
    let velocity = |at: Vector3<f64>| omega.cross(&(at - q));
    let momentum: Vector3<f64> = points.iter().map(|(m, at)| (at - q).cross(&velocity(*at)) * *m).sum();
    say("17.2", "L = I_Q omega", (moved * omega - momentum).amax() / momentum.amax());
    let energy: f64 = points.iter().map(|(m, at)| 0.5 * m * velocity(*at).norm_squared()).sum();
    let rotation = 0.5 * omega.dot(&(moved * omega));
    say("17.2", "T = omega^t I_Q omega / 2", (rotation - energy).abs() / energy);
    let split = 0.5 * mass * velocity(center).norm_squared() + 0.5 * omega.dot(&(body.tensor() * omega));
    say("17.2", "T is that of M at the centre and that about it", (split - energy).abs() / energy);
    let own = (center - q).cross(&velocity(center)) * mass + body.tensor() * omega;
    say("17.2", "L is that of M at the centre and that about it", (own - momentum).amax() / momentum.amax());
    Ok(table)
}

fn apart(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    (a - b).amax() / b.amax()
}

/// The definition, entry by entry.
fn direct(points: &[Point], q: Vector3<f64>) -> Matrix3<f64> {
    points
        .iter()
        .map(|&(m, at)| {
            let s = at - q;
            (Matrix3::identity() * s.norm_squared() - s * s.transpose()) * m
        })
        .sum()
}
