//! Mass properties of meshes: exact boxes, the rate at which polyhedra approach a sphere, and what is refused.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::inertia::{Amount, MassProperties, Mesh, Solid};

pub(crate) type Triangle = [Vector3<f64>; 3];

/// The surface of the box [0, 1]³, each face cut into 2 n² triangles, corners counterclockwise from outside.
pub(crate) fn cube(n: usize) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            let at = |i: usize, j: usize| {
                let mut v = Vector3::zeros();
                v[axis] = side;
                v[(axis + 1) % 3] = i as f64 / n as f64;
                v[(axis + 2) % 3] = j as f64 / n as f64;
                v
            };
            for i in 0..n {
                for j in 0..n {
                    let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                    for [p, q, r] in [[a, b, c], [a, c, d]] {
                        triangles.push(if side == 1.0 { [p, q, r] } else { [p, r, q] });
                    }
                }
            }
        }
    }
    triangles
}

fn mapped(triangles: &[Triangle], map: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Vec<Triangle> {
    triangles.iter().map(|t| t.map(&map)).collect()
}

fn largest_error(found: &MassProperties, expected: &MassProperties) -> f64 {
    let mass = (found.mass() / expected.mass() - 1.0).abs();
    let scale = expected.tensor().amax();
    let radius = (scale / expected.mass()).sqrt();
    let center = (found.center_of_mass() - expected.center_of_mass()).amax() / radius;
    mass.max(center).max((found.tensor() - expected.tensor()).amax() / scale)
}

#[test]
fn a_meshed_box_is_the_box() {
    let edges = Vector3::new(0.3, 1.7, 2.9);
    let solid = Solid::Box(edges.into()).with(Amount::Density(7.5)).unwrap();
    let q = UnitQuaternion::new_normalize(Quaternion::new(0.7, -0.3, 0.5, 0.2));
    for n in [1, 3, 10] {
        let corner = mapped(&cube(n), |v| v.component_mul(&edges));
        let found = Mesh::new(corner.clone()).unwrap().with(Amount::Density(7.5)).unwrap();
        let expected = solid.moved(edges * 0.5).unwrap();
        assert!(largest_error(&found, &expected) < 1e-15, "{n}: {}", largest_error(&found, &expected));
        let by_mass = Mesh::new(corner.clone()).unwrap().with(Amount::Mass(expected.mass())).unwrap();
        assert!(largest_error(&by_mass, &expected) < 1e-15);

        let turned = Mesh::new(mapped(&corner, |v| q * v)).unwrap().with(Amount::Density(7.5)).unwrap();
        assert!(largest_error(&turned, &expected.turned(q)) < 1e-14);
        // a million edges from the origin the vertices themselves are rounded to 1e-10
        let far = Vector3::new(3e6, -2e6, 1e6);
        let distant = Mesh::new(mapped(&corner, |v| v + far)).unwrap().with(Amount::Density(7.5)).unwrap();
        assert!(largest_error(&distant, &expected.moved(far).unwrap()) < 1e-8);
    }
    // where the far vertices are exact, nothing at all is lost
    let far = Vector3::new(3e6, -2e6, 1e6);
    let distant = Mesh::new(mapped(&cube(4), |v| v + far)).unwrap().with(Amount::Mass(6.0)).unwrap();
    assert_eq!(distant.tensor(), Matrix3::identity());
    assert_eq!(distant.center_of_mass(), far + Vector3::new(0.5, 0.5, 0.5));
}

#[test]
fn lengths_scaled_by_a_power_of_two_change_no_bit() {
    let tiny = 1.0 / f64::from(1_u32 << 20) / f64::from(1_u32 << 20);
    let q = UnitQuaternion::new_normalize(Quaternion::new(0.7, -0.3, 0.5, 0.2));
    let base = mapped(&cube(2), |v| q * v.component_mul(&Vector3::new(0.3, 1.7, 2.9)));
    let mesh = Mesh::new(base.clone()).unwrap();
    let scaled = Mesh::new(mapped(&base, |v| v * tiny)).unwrap();
    assert_eq!(scaled.volume(), mesh.volume() * tiny * tiny * tiny);
    let (a, b) = (mesh.with(Amount::Mass(2.0)).unwrap(), scaled.with(Amount::Mass(2.0)).unwrap());
    assert_eq!(b.center_of_mass(), a.center_of_mass() * tiny);
    assert_eq!(b.tensor(), a.tensor() * (tiny * tiny));
}

/// The cube's grid blown up to the unit sphere.
fn sphere(n: usize) -> Vec<Triangle> {
    mapped(&cube(n), |v| (v * 2.0 - Vector3::new(1.0, 1.0, 1.0)).normalize())
}

#[test]
fn a_meshed_sphere_converges_with_the_square_of_the_edge() {
    let ball = Solid::Sphere { radius: 1.0 }.with(Amount::Density(1.0)).unwrap();
    let error = |n| {
        let found = Mesh::new(sphere(n)).unwrap().with(Amount::Density(1.0)).unwrap();
        let trace = ball.tensor().trace();
        ((ball.mass() - found.mass()) / ball.mass(), (trace - found.tensor().trace()) / trace)
    };
    let mut before = error(8);
    for n in [16, 32, 64] {
        let now = error(n);
        for (rate, what) in [(before.0 / now.0, "volume"), (before.1 / now.1, "trace")] {
            // an inscribed polyhedron is too small, by a multiple of h² that halving divides by four
            assert!(rate > 3.9 && rate < 4.1, "{what} at {n}: {rate}");
        }
        before = now;
    }
    assert!(before.1 > 0.0 && before.1 < 1e-3);
}

#[test]
fn cavities_count_negative_and_parts_add() {
    let inner = mapped(&cube(2), |v| v * 0.5 + Vector3::new(0.25, 0.25, 0.125));
    let inwards: Vec<Triangle> = inner.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let hollow = Mesh::new([cube(1), inwards.clone()].concat()).unwrap();
    assert_eq!(hollow.volume(), 0.875);
    let body = hollow.with(Amount::Density(1.0)).unwrap();
    let expected_z = (0.5 - 0.125 * 0.375) / 0.875;
    assert!((body.center_of_mass().z - expected_z).abs() < 1e-15);
    let apart = mapped(&cube(1), |v| v + Vector3::new(5.0, 0.0, 0.0));
    assert_eq!(Mesh::new([cube(1), apart].concat()).unwrap().volume(), 2.0);
    // the same hole outside of every part is a part turned inside out
    let lost = mapped(&inwards, |v| v + Vector3::new(5.0, 0.0, 0.0));
    let message = Mesh::new([cube(1), lost].concat()).unwrap_err().to_string();
    assert_eq!(
        message,
        "the mesh is inside out: the part with edge (5.25, 0.25, 0.125)-(5.25, 0.5, 0.125) of triangle 13 encloses \
         the volume -0.125; list the corners of its triangles counterclockwise as seen from outside"
    );
}

/// Grains with a pore each, too many to look at every grain for every pore.
#[test]
fn many_cavities_are_found_in_their_parts() {
    let n = 24;
    let at = |k: usize| Vector3::new((k % n) as f64, (k / n % n) as f64, (k / n / n) as f64) * 2.0;
    let mut triangles = Vec::new();
    for k in 0..n * n * n {
        let pore = mapped(&cube(1), |v| v * 0.5 + at(k) + Vector3::repeat(0.25));
        triangles.extend(pore.iter().map(|[a, b, c]| [*a, *c, *b]));
        triangles.extend(mapped(&cube(1), |v| v + at(k)));
    }
    let mesh = Mesh::new(triangles.clone()).unwrap();
    assert!((mesh.volume() / (0.875 * (n * n * n) as f64) - 1.0).abs() < 1e-13);
    // one pore moved out of its grain
    triangles[..12].iter_mut().flatten().for_each(|v| v.x += 1.0);
    let error = Mesh::new(triangles).unwrap_err().to_string();
    assert!(error.contains("inside out") && error.contains("of triangle 1 "), "{error}");
}

#[test]
fn tiny_numbers_are_short_in_messages() {
    let edge = Mesh::new(mapped(&cube(1)[..11], |v| v * 1e-40)).unwrap_err().to_string();
    assert!(edge.contains("(0, 1e-40, 1e-40)") && edge.len() < 200, "{edge}");
}

#[test]
fn triangles_without_area_are_left_out() {
    let mut triangles = cube(1);
    let [a, b, _] = triangles[0];
    triangles.insert(0, [a, b, a]);
    let mesh = Mesh::new(triangles.clone()).unwrap();
    assert_eq!((mesh.triangles(), mesh.volume()), (12, 1.0));
    triangles.truncate(12); // and messages still count the triangles of the input
    let message = Mesh::new(triangles).unwrap_err().to_string();
    assert!(
        message.contains("edges with one triangle only: 3")
            && message.ends_with("(0, 0, 1)-(0, 1, 1) of triangle 3"),
        "{message}"
    );
    // −0 and 0 are one coordinate
    let signed = mapped(&cube(1), |v| v.map(|x| if x == 0.0 { -x } else { x }));
    let mixed: Vec<Triangle> = cube(1)[..6].iter().chain(&signed[6..]).copied().collect();
    assert_eq!(Mesh::new(mixed).unwrap().vertices(), 8);
}

#[test]
fn broken_meshes_name_an_edge() {
    let message = |triangles: Vec<Triangle>| Mesh::new(triangles).unwrap_err().to_string();
    let mut turned = cube(1);
    turned[4].swap(0, 1);
    assert_eq!(
        message(turned),
        "the triangles are not consistently oriented; edges run through twice in one direction: 3, the first is \
         edge (0, 0, 0)-(0, 0, 1) of triangle 2; one of its two triangles is turned over"
    );
    let mut fin = cube(1);
    fin.push([Vector3::zeros(), Vector3::new(0.0, 0.0, 1.0), Vector3::new(-1.0, -1.0, 0.5)]);
    assert_eq!(
        message(fin),
        "the mesh is not manifold; edges with more than two triangles that do not cancel: 1, the first is edge (0, 0, 0)-(0, 0, 1) of \
         triangle 2, with 3"
    );
    assert_eq!(
        message(cube(1)[1..].to_vec()),
        "the mesh is open; edges with one triangle only: 3, the first is edge (0, 1, 1)-(0, 0, 0) of triangle 1"
    );
    let inside_out = cube(1).iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(
        message(inside_out).starts_with("the mesh is inside out: the part with edge (0, 0, 0)-(0, 1, 0) of")
    );
    let [a, b, c] = cube(1)[0];
    assert_eq!(message(vec![[a, b, c], [a, c, b]]), "the mesh encloses no volume");
    assert_eq!(message(vec![]), "the mesh has no triangle with three distinct corners");
    assert_eq!(
        message(vec![[a, b, Vector3::new(0.0, f64::INFINITY, 0.0)]]),
        "triangle 1 has the coordinate inf; every coordinate must be a finite number"
    );
}

#[test]
fn meshes_out_of_range_are_refused_and_others_scale() {
    let unit = cube(2);
    for exponent in [-180, 180] {
        let size = libm::scalbn(1.0, exponent);
        let mesh = Mesh::new(mapped(&unit, |v| v * size)).unwrap();
        assert_eq!(mesh.volume(), libm::scalbn(1.0, 3 * exponent));
        let moment = mesh.with(Amount::Density(1.0)).unwrap().principal_moments()[0];
        assert!((libm::scalbn(moment, -5 * exponent) - 1.0 / 6.0).abs() < 1e-15, "{moment}");
    }
    for (size, extent) in [(1e308, "1e308"), (1e100, "1e100"), (1e-100, "1e-100"), (5e-324, "5e-324")] {
        let error = Mesh::new(mapped(&unit, |v| v * size)).unwrap_err().to_string();
        let start = format!("the mesh measures {extent} and reaches out to {extent}: its second moments are");
        assert!(error.starts_with(&start) || size < 1e-300, "{error}");
    }
    let across = Mesh::new(mapped(&unit, |v| (v * 2.0 - Vector3::repeat(1.0)) * f64::MAX));
    assert!(across.unwrap_err().to_string().starts_with("the mesh measures 1.797"));
    // two triangles back to back in one plane with the origin enclose rounding errors
    let [a, b, c] = [[0.3, 0.1, 0.7], [-0.3, -0.1, -0.7], [1.1, 0.9, -0.4]].map(Vector3::from);
    for turned in [[a, c, b], [c, b, a], [b, a, c]] {
        assert_eq!(Mesh::new([[a, b, c], turned]).unwrap_err().to_string(), "the mesh encloses no volume");
    }
}
