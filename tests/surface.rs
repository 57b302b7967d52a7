//! Surfaces as files hold them: welded, closed, hulls, walls.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Amount, Closing, FLOAT_WELD, Mesh, MeshError, Repair, Solid, Surface};

use crate::mesh::{Triangle, cube};

/// Numbers without a pattern in [0, 1).
fn scattered(count: usize) -> impl Iterator<Item = f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    (0..count).map(move |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 9_007_199_254_740_992.0
    })
}

fn points(count: usize) -> Vec<Vector3<f64>> {
    let numbers: Vec<f64> = scattered(3 * count).collect();
    numbers.as_chunks::<3>().0.iter().map(|at| Vector3::from(*at)).collect()
}

#[test]
fn a_hull_holds_every_point_and_its_volume_is_that_of_the_solid() {
    // corners of a cube, many points of its faces and edges, and inside
    let mut all: Vec<Vector3<f64>> = cube(4).into_iter().flatten().collect();
    all.extend(points(200));
    let hull = Surface::hull_of(&all).unwrap();
    let mesh = hull.mesh().unwrap();
    assert!((mesh.volume() - 1.0).abs() < 1e-15, "{}", mesh.volume());
    assert!(hull.triangles().flatten().all(|at| at.iter().any(|x| *x == 0.0 || *x == 1.0)));
    // points of no plane: a closed convex surface, Euler's formula, nothing outside
    let cloud = points(2000);
    let hull = Surface::hull_of(&cloud).unwrap();
    let mesh = hull.mesh().unwrap();
    assert_eq!(mesh.triangles(), 2 * mesh.vertices() - 4);
    for [a, b, c] in hull.triangles() {
        let normal = (b - a).cross(&(c - a));
        assert!(cloud.iter().all(|p| normal.dot(&(p - a)) < 1e-15), "{a} {b} {c}");
    }
    // ball: n points on a sphere are all corners
    let ball: Vec<Vector3<f64>> =
        points(500).iter().map(|p| (p - Vector3::repeat(0.5)).normalize()).collect();
    assert_eq!(Surface::hull_of(&ball).unwrap().mesh().unwrap().vertices(), 500);
    // a hull of a hull, and of a mirrored one
    let again = hull.hull().unwrap().mesh().unwrap();
    assert!((again.volume() / mesh.volume() - 1.0).abs() < 1e-14);
    let flat: Vec<Vector3<f64>> = cloud.iter().map(|p| Vector3::new(p.x, p.y, 0.5)).collect();
    assert!(matches!(Surface::hull_of(&flat), Err(MeshError::Flat)));
    assert!(matches!(Surface::hull_of(&[]), Err(MeshError::Flat)));
}

#[test]
fn a_hull_out_of_range_is_refused_for_its_size() {
    for size in [1e-130, 1e130] {
        let corners = [[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]].map(Vector3::from);
        let [o, x, y, z] = corners;
        let surface = Surface::new([[o, y, x], [o, x, z], [o, z, y]]).unwrap();
        let closed = surface.closed(FLOAT_WELD, Closing::Hull).map(|(mesh, _)| mesh.volume());
        let volume = |hull: Result<Surface, MeshError>| hull?.mesh().map(|mesh| mesh.volume());
        let hulls = [Surface::hull_of(&corners), surface.hull()].map(volume);
        for found in hulls.into_iter().chain([closed]) {
            assert!(matches!(found, Err(MeshError::OutOfRange { .. })), "{size}: {found:?}");
        }
    }
    // points that are one span nothing, wherever they are
    assert!(matches!(Surface::hull_of(&[Vector3::repeat(1e130); 4]), Err(MeshError::Flat)));
}

#[test]
fn what_export_tears_is_mended_and_said() {
    // every facet with corners of its own, rounded to single precision in another place
    let torn: Vec<Triangle> = cube(3)
        .into_iter()
        .zip(scattered(108))
        .map(|(corners, noise)| corners.map(|v| v * 3.0 + Vector3::repeat(1e-6 * noise)))
        .collect();
    let surface = Surface::new(torn.clone()).unwrap();
    assert!(surface.mesh().is_err() && surface.mended(1e-9).is_err());
    let (mesh, repairs) = surface.mended(FLOAT_WELD).unwrap();
    assert!((mesh.volume() / 27.0 - 1.0).abs() < 2e-6, "{}", mesh.volume());
    assert!(matches!(repairs[..], [Repair::Welded { vertices: 268, .. }]), "{repairs:?}");
    // turned, doubled and inside out; a cavity stays one
    let mut spoiled = cube(2);
    spoiled[5].swap(0, 1);
    spoiled.push(spoiled[7]);
    let (mesh, repairs) = Surface::new(spoiled).unwrap().mended(FLOAT_WELD).unwrap();
    assert_eq!(mesh.volume(), 1.0);
    assert!(matches!(repairs[..], [Repair::Doubled { triangles: 1 }, Repair::Turned { triangles: 1 }]));
    let hole: Vec<Triangle> = cube(1)
        .iter()
        .map(|t| t.map(|v| v * 0.5 + Vector3::repeat(0.25)))
        .map(|[a, b, c]| [a, c, b])
        .collect();
    let hollow = Surface::new([cube(1), hole].concat()).unwrap();
    assert_eq!(hollow.mended(FLOAT_WELD).unwrap().0.volume(), 0.875);
    let (mesh, repairs) = Surface::new(cube(2)).unwrap().reversed().mended(FLOAT_WELD).unwrap();
    assert_eq!((mesh.volume(), repairs), (1.0, vec![Repair::TurnedOut { parts: 1 }]));
    // what is closed is left alone
    assert_eq!(Surface::new(cube(2)).unwrap().mended(FLOAT_WELD).unwrap().1, []);
}

#[test]
fn edges_that_cancel_bound_a_body() {
    // two cubes that share an edge: four facets meet there, two each way
    let other = cube(1).into_iter().map(|t| t.map(|v| v + Vector3::new(1.0, 1.0, 0.0)));
    let pair: Vec<Triangle> = cube(1).into_iter().chain(other).collect();
    let mesh = Mesh::new(pair).unwrap();
    assert_eq!(mesh.volume(), 2.0);
    let body = mesh.with(Amount::Density(1.0)).unwrap();
    assert_eq!(body.center_of_mass(), Vector3::new(1.0, 1.0, 0.5));
}

#[test]
fn holes_are_closed_and_their_share_is_stated() {
    let open: Vec<Triangle> = cube(4).into_iter().filter(|t| t.iter().any(|v| v.z < 1.0)).collect();
    let surface = Surface::new(open).unwrap();
    let rims = surface.boundaries();
    assert_eq!((rims.len(), rims[0].edges, rims[0].length), (1, 16, 4.0));
    assert_eq!(rims[0].center, Vector3::new(0.5, 0.5, 1.0));
    let (mesh, repairs) = surface.closed(FLOAT_WELD, Closing::Fan).unwrap();
    assert!((mesh.volume() - 1.0).abs() < 1e-15);
    let [Repair::Closed { holes: 1, rim, area, volume }] = repairs[..] else { panic!("{repairs:?}") };
    assert!(
        (rim - 4.0).abs() < 1e-15 && (area - 1.0 / 6.0).abs() < 1e-15 && (volume - 1.0 / 6.0).abs() < 1e-15
    );
    let (mesh, repairs) = surface.closed(FLOAT_WELD, Closing::Hull).unwrap();
    assert_eq!(mesh.volume(), 1.0);
    assert!(matches!(repairs[..], [Repair::Hull { volume }] if (volume - 1.0 / 6.0).abs() < 1e-14));
    // inside out and open
    let (mesh, _) = surface.reversed().closed(FLOAT_WELD, Closing::Fan).unwrap();
    assert!((mesh.volume() - 1.0).abs() < 1e-15);
    assert!(Surface::new(cube(1)).unwrap().closed(0.0, Closing::Fan).is_err());
}

#[test]
fn thin_walls_are_the_difference_of_two_solids() {
    let surface = Surface::new(cube(3)).unwrap();
    let walls = surface.sheet(Amount::Density(2.0)).unwrap();
    assert!((walls.mass() - 12.0).abs() < 1e-14);
    // six plates: m (1/12 + 1/4) + ... = 5/18 of the mass and the square of the edge
    assert!((walls.tensor() - Matrix3::identity() * (12.0 * 5.0 / 18.0)).amax() < 1e-14);
    assert!((walls.center_of_mass() - Vector3::repeat(0.5)).amax() < 1e-15);
    let (outer, inner) = (1.0, 1.0 - 2e-6);
    let solid = |edge: f64| Solid::Box([edge; 3]).with(Amount::Density(1.0)).unwrap();
    let between =
        (solid(outer).tensor() - solid(inner).tensor()) / (solid(outer).mass() - solid(inner).mass());
    assert!((between - walls.tensor() / walls.mass()).amax() < 1e-5);
}

#[test]
fn a_unit_of_length_scales_the_vertices() {
    let millimetres = Surface::new(cube(2).into_iter().map(|t| t.map(|v| v * 40.0))).unwrap();
    let metres = millimetres.scaled(1e-3).unwrap();
    assert_eq!(metres.extents(), [0.04; 3]);
    let body = metres.mesh().unwrap().with(Amount::Density(2700.0)).unwrap();
    let solid = Solid::Box([0.04; 3]).with(Amount::Density(2700.0)).unwrap();
    assert!((body.mass() / solid.mass() - 1.0).abs() < 1e-15);
    assert!((body.tensor() - solid.tensor()).amax() < 1e-15 * solid.tensor().amax());
    assert_eq!(
        millimetres.scaled(-1.0).unwrap_err().to_string(),
        "unit of length is -1; it must be a finite number above zero"
    );
}
