//! The shapes as maps of the unit cube, and a cube of triangles.

use std::f64::consts::PI;

use nalgebra::Vector3;
use polhode::inertia::Solid;
use polhode::num::trig::sin_cos;

/// Every shape, of sizes without a special ratio, with its moments over its mass.
pub(super) const ALL: [(Solid, [&str; 3]); 13] = [
    (Solid::Box([0.3, 1.7, 2.9]), ["(y^2 + z^2)/12", "(x^2 + z^2)/12", "(x^2 + y^2)/12"]),
    (Solid::Ellipsoid([0.4, 1.1, 2.3]), ["(b^2 + c^2)/5", "(a^2 + c^2)/5", "(a^2 + b^2)/5"]),
    (Solid::Sphere { radius: 0.7 }, ["2 r^2/5", "2 r^2/5", "2 r^2/5"]),
    (Solid::Shell { radius: 0.7 }, ["2 r^2/3", "2 r^2/3", "2 r^2/3"]),
    (Solid::Cylinder { radius: 0.2, height: 3.1 }, ["(3 r^2 + h^2)/12", "(3 r^2 + h^2)/12", "r^2/2"]),
    (
        Solid::Tube { inner: 0.15, outer: 0.2, height: 3.1 },
        ["(3 (r1^2 + r2^2) + h^2)/12", "(3 (r1^2 + r2^2) + h^2)/12", "(r1^2 + r2^2)/2"],
    ),
    (Solid::Cone { radius: 0.9, height: 0.35 }, ["3 (4 r^2 + h^2)/80", "3 (4 r^2 + h^2)/80", "3 r^2/10"]),
    (Solid::Torus { ring: 2.5, tube: 0.4 }, ["(4 R^2 + 5 r^2)/8", "(4 R^2 + 5 r^2)/8", "(4 R^2 + 3 r^2)/4"]),
    (Solid::Rod { length: 1.3 }, ["l^2/12", "l^2/12", "0"]),
    (Solid::Disk { radius: 0.45 }, ["r^2/4", "r^2/4", "r^2/2"]),
    (Solid::Plate([0.2, 1.9]), ["y^2/12", "x^2/12", "(x^2 + y^2)/12"]),
    (Solid::Hoop { radius: 0.33 }, ["r^2/2", "r^2/2", "r^2"]),
    // shares of the mass: c of the cylinder, s of the caps, c : s = 3 h : 4 r
    (
        Solid::Capsule { radius: 0.2, height: 0.9 },
        [
            "c (3 r^2 + h^2)/12 + s (2 r^2/5 + h^2/4 + 3 h r/8)",
            "c (3 r^2 + h^2)/12 + s (2 r^2/5 + h^2/4 + 3 h r/8)",
            "c r^2/2 + 2 s r^2/5",
        ],
    ),
];

/// The point of `solid` at a place of the unit cube, and the volume, area or length per volume of the cube there.
pub(super) fn element(solid: Solid, [u, v, w]: [f64; 3]) -> (Vector3<f64>, f64) {
    let ring = |r: f64, turn: f64, z: f64| {
        let (sin, cos) = sin_cos(2.0 * PI * turn);
        Vector3::new(r * cos, r * sin, z)
    };
    let ball = |r: f64| ring(r * (4.0 * v * (1.0 - v)).sqrt(), w, r * (2.0 * v - 1.0));
    let tube = |inner: f64, outer: f64, height: f64| {
        let r = inner + (outer - inner) * u;
        (ring(r, v, height * (w - 0.5)), 2.0 * PI * r * (outer - inner) * height)
    };
    match solid {
        Solid::Box([x, y, z]) => (Vector3::new(x * (u - 0.5), y * (v - 0.5), z * (w - 0.5)), x * y * z),
        Solid::Ellipsoid([a, b, c]) => {
            (ball(u).component_mul(&Vector3::new(a, b, c)), a * b * c * 4.0 * PI * u * u)
        }
        Solid::Sphere { radius: r } => (ball(r * u), 4.0 * PI * r * r * r * u * u),
        Solid::Shell { radius: r } => (ball(r), 4.0 * PI * r * r),
        Solid::Cylinder { radius, height } => tube(0.0, radius, height),
        Solid::Tube { inner, outer, height } => tube(inner, outer, height),
        Solid::Cone { radius, height } => {
            let here = radius * (1.0 - w);
            (ring(here * u, v, height * w), 2.0 * PI * here * here * u * height)
        }
        Solid::Torus { ring: r1, tube: r2 } => {
            let (sin, cos) = sin_cos(2.0 * PI * v);
            let r = r1 + r2 * u * cos;
            (ring(r, w, r2 * u * sin), 4.0 * PI * PI * r2 * r2 * u * r)
        }
        Solid::Rod { length } => (Vector3::new(0.0, 0.0, length * (w - 0.5)), length),
        Solid::Disk { radius } => (ring(radius * u, v, 0.0), 2.0 * PI * radius * radius * u),
        Solid::Plate([x, y]) => (Vector3::new(x * (u - 0.5), y * (v - 0.5), 0.0), x * y),
        Solid::Hoop { radius } => (ring(radius, v, 0.0), 2.0 * PI * radius),
        Solid::Capsule { radius, height } => {
            // columns below the caps, which rise radius u above the cylinder
            let column = height + 2.0 * radius * u;
            let rho = radius * (1.0 - u * u).sqrt();
            (ring(rho, v, column * (w - 0.5)), 2.0 * PI * radius * radius * u * column)
        }
    }
}

/// The surface of [−1, 1]³, each face cut into 2 n² triangles, corners counterclockwise from outside.
pub(super) fn cube(n: usize) -> impl Iterator<Item = [Vector3<f64>; 3]> {
    let faces = (0..6).map(|face| (face / 2, if face % 2 == 0 { -1.0 } else { 1.0 }));
    let squares = faces.flat_map(move |face| (0..n * n).map(move |k| (face, k / n, k % n)));
    squares.flat_map(move |((axis, side), i, j)| {
        let at = |i: usize, j: usize| {
            let mut v = Vector3::repeat(side);
            v[(axis + 1) % 3] = 2.0 * i as f64 / n as f64 - 1.0;
            v[(axis + 2) % 3] = 2.0 * j as f64 / n as f64 - 1.0;
            v
        };
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        if side > 0.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] }
    })
}

/// The bytes of a binary STL file.
pub(super) fn stl(triangles: impl Iterator<Item = [Vector3<f64>; 3]>) -> Vec<u8> {
    let mut bytes = vec![0; 84];
    let mut count = 0_u32;
    for corners in triangles {
        bytes.extend([0; 12]);
        for x in corners.iter().flat_map(|v| v.iter()) {
            bytes.extend((*x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
        count += 1;
    }
    bytes[80..84].copy_from_slice(&count.to_le_bytes());
    bytes
}
