//! Mass properties against references that share no code with them: quadrature in many digits, direct sums over
//! points, exact boxes.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::inertia::{
    Amount, Class, Inertia, InertiaError, InertiaShape, MassError, MassProperties, Region, Solid, Symmetry,
    integrate_mass,
};
use polhode::num::trig::sin_cos;

/// Largest entry of a − b over the largest of b.
fn apart(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    (a - b).amax() / b.amax()
}

/// An uneven handful of points, none of whose sums vanish.
fn points() -> Vec<(f64, Vector3<f64>)> {
    [
        (1.25, [0.3, -1.1, 2.7]),
        (0.4, [-2.2, 0.6, 0.1]),
        (3.0, [1.9, 1.4, -0.8]),
        (0.07, [-5.0, 3.3, 4.1]),
        (2.2, [0.05, -0.4, -1.7]),
    ]
    .map(|(mass, at)| (mass, Vector3::from(at)))
    .into()
}

/// Σ m (s² δ_jk − s_j s_k) about `q`, the definition of the lecture, entry by entry.
fn direct(points: &[(f64, Vector3<f64>)], q: Vector3<f64>) -> Matrix3<f64> {
    let mut tensor = Matrix3::zeros();
    for &(m, at) in points {
        let (x, y, z) = (at.x - q.x, at.y - q.y, at.z - q.z);
        tensor[(0, 0)] += m * (y * y + z * z);
        tensor[(1, 1)] += m * (x * x + z * z);
        tensor[(2, 2)] += m * (x * x + y * y);
        tensor[(0, 1)] -= m * x * y;
        tensor[(0, 2)] -= m * x * z;
        tensor[(1, 2)] -= m * y * z;
    }
    tensor[(1, 0)] = tensor[(0, 1)];
    tensor[(2, 0)] = tensor[(0, 2)];
    tensor[(2, 1)] = tensor[(1, 2)];
    tensor
}

fn center(points: &[(f64, Vector3<f64>)]) -> Vector3<f64> {
    let mass: f64 = points.iter().map(|(m, _)| m).sum();
    points.iter().map(|(m, at)| at * *m).sum::<Vector3<f64>>() / mass
}

/// A turn by no special angle.
fn turn() -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(0.7, -0.3, 0.5, 0.2))
}

#[test]
fn solids_agree_with_quadrature_in_forty_digits() {
    let text = include_str!("data/inertia/solids.csv");
    let mut shapes = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')).skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let sizes: Vec<f64> = fields[1].split(' ').map(|size| size.parse().unwrap()).collect();
        let numbers: Vec<f64> = fields[2..].iter().map(|number| number.parse().unwrap()).collect();
        let solid = Solid::named(fields[0], &sizes).unwrap();
        let body = solid.with(Amount::Density(7.25)).unwrap();
        let [m, x, y, z, xx, yy, zz, xy, xz, yz] = numbers.try_into().unwrap();
        let expected = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        assert!((body.mass() / m - 1.0).abs() < 1e-15, "{line}: mass {}", body.mass());
        assert!((body.center_of_mass() - Vector3::new(x, y, z)).amax() < 1e-15, "{line}");
        for k in 0..3 {
            // every moment by itself, so that a thin body's small one is right too
            let (found, expected) = (body.tensor()[(k, k)], expected[(k, k)]);
            assert!((found - expected).abs() <= 1e-15 * expected, "{line}: {found} for {expected}");
        }
        assert_eq!(body.tensor().upper_triangle(), Matrix3::from_diagonal(&body.tensor().diagonal()));
        assert_eq!((solid.name(), solid.sizes()), (fields[0], sizes));
        let same = solid.with(Amount::Mass(body.mass())).unwrap();
        assert!(apart(&same.tensor(), &body.tensor()) == 0.0);
        shapes.push(fields[0]);
    }
    assert!(Solid::names().all(|name| shapes.contains(&name)), "{shapes:?}");
}

#[test]
fn solids_agree_with_our_own_quadrature_of_their_regions() {
    let cases = [
        (Solid::Box([0.3, 1.7, 2.9]), Region::Box([0.3, 1.7, 2.9])),
        (Solid::Ellipsoid([0.4, 1.1, 2.3]), Region::Ellipsoid([0.4, 1.1, 2.3])),
        (Solid::Sphere { radius: 0.7 }, Region::Layer { inner: 0.0, outer: 0.7 }),
        (Solid::Cylinder { radius: 0.2, height: 3.1 }, Region::Cylinder { radius: 0.2, height: 3.1 }),
    ];
    for (solid, region) in cases {
        let expected = solid.with(Amount::Density(2.5)).unwrap();
        let found = region.filled(|_| 2.5, 1e-13).unwrap();
        assert!((found.mass() / expected.mass() - 1.0).abs() < 1e-13);
        assert!(apart(&found.tensor(), &expected.tensor()) < 1e-13, "{solid:?}");
    }
    let half_cone = |[u, v, w]: [f64; 3]| {
        let here = 0.9 * (1.0 - w);
        let (sin, cos) = sin_cos(2.0 * PI * v);
        Ok((Vector3::new(here * u * cos, here * u * sin, 0.35 * w), 2.0 * PI * here * here * u * 0.35))
    };
    let cone = Solid::Cone { radius: 0.9, height: 0.35 }.with(Amount::Density(1.0)).unwrap();
    let found = integrate_mass(half_cone, 1e-13).unwrap();
    assert!((found.center_of_mass() - cone.center_of_mass()).amax() < 1e-14);
    assert!(apart(&found.tensor(), &cone.tensor()) < 1e-13);
}

#[test]
fn a_density_that_varies_agrees_with_its_integrals() {
    // rho = 2 + x + 3 x y in a box: mass 2V; ∫x = V a²/12, ∫xy = 3 V a²b²/144
    let [a, b, c] = [1.5, 0.8, 2.0];
    let body = Region::Box([a, b, c]).filled(|s| 2.0 + s.x + 3.0 * s.x * s.y, 1e-13).unwrap();
    let volume = a * b * c;
    assert!((body.mass() - 2.0 * volume).abs() < 1e-14);
    let x = volume * a * a / 12.0 / (2.0 * volume);
    assert!((body.center_of_mass() - Vector3::new(x, 0.0, 0.0)).amax() < 1e-15);
    assert!((body.tensor()[(0, 1)] + 3.0 * volume * a * a * b * b / 144.0).abs() < 1e-14);
    let zz = 2.0 * volume * (a * a + b * b) / 12.0 - 2.0 * volume * x * x;
    assert!((body.tensor()[(2, 2)] - zz).abs() < 1e-14);

    // an atmosphere: no polynomial, mass 4π (2 − 5/e) for rho = exp(−r), r < 1
    let ball = Region::Layer { inner: 0.0, outer: 1.0 };
    let mass = ball.filled(|s| libm::exp(-s.norm()), 1e-13).unwrap().mass();
    assert!((mass - 4.0 * PI * (2.0 - 5.0 * libm::exp(-1.0))).abs() < 1e-13, "{mass}");

    let message = |density: fn(Vector3<f64>) -> f64| ball.filled(density, 1e-13).unwrap_err().to_string();
    assert!(message(|s| s.x).contains("it must be finite and not negative"), "{}", message(|s| s.x));
    assert!(message(|_| 0.0).contains("mass of the distribution is 0"));
    let jump = message(|s| if s.x > 0.1 { 1.0 } else { 0.0 });
    assert!(jump.starts_with("with 128 nodes an axis the result still changes by"), "{jump}");
}

#[test]
fn parallel_axis_agrees_with_direct_sums_of_points_both_ways() {
    let points = points();
    let body = MassProperties::of_points(points.clone()).unwrap();
    let c = center(&points);
    assert!((body.center_of_mass() - c).amax() < 1e-15);
    assert!(apart(&body.tensor(), &direct(&points, c)) < 1e-15);
    // unequal offsets in all axes and of both signs: a wrong sign or index of the term shows in the first digit
    for q in [[0.7, -2.1, 3.9], [-11.0, 0.3, 5.5], [0.0, 0.0, 0.0], [1e3, -2e3, 3e3]].map(Vector3::from) {
        let about = direct(&points, q);
        assert!(apart(&body.tensor_about(q).unwrap(), &about) < 1e-15, "{q:?}");
        let back = MassProperties::from_tensor_about(q, body.mass(), c, about).unwrap();
        // the digits that the larger tensor does not hold cannot come back
        let lost = about.amax() / body.tensor().amax();
        assert!(apart(&back.tensor(), &body.tensor()) < 1e-15 * lost, "{q:?}");
        let both = body.inertia_about(q).unwrap().tensor();
        assert_eq!(both, body.tensor_about(q).unwrap());
    }
}

#[test]
fn a_body_is_the_sum_of_its_parts() {
    let points = points();
    let whole = MassProperties::of_points(points.clone()).unwrap();
    let part = |range: std::ops::Range<usize>| MassProperties::of_points(points[range].to_vec()).unwrap();
    for split in 1..points.len() {
        let sum = MassProperties::sum([part(0..split), part(split..points.len())]).unwrap();
        assert!((sum.mass() / whole.mass() - 1.0).abs() < 1e-15);
        assert!((sum.center_of_mass() - whole.center_of_mass()).amax() < 2e-15);
        assert!(apart(&sum.tensor(), &whole.tensor()) < 1e-15, "{split}");
    }
    // eight cubes are a cube, and a box without a corner is a box minus a corner, far from the origin
    let corner = Solid::Box([0.5, 0.5, 0.5]).with(Amount::Density(3.0)).unwrap();
    let far = Vector3::new(4096.0, -2048.0, 1024.0);
    let at = |k: usize| Vector3::new(k as f64 % 2.0, (k / 2) as f64 % 2.0, (k / 4) as f64) * 0.5 + far;
    let cube = MassProperties::sum((0..8).map(|k| corner.moved(at(k)).unwrap())).unwrap();
    let expected = Solid::Box([1.0, 1.0, 1.0]).with(Amount::Density(3.0)).unwrap();
    assert_eq!(cube.center_of_mass(), far + Vector3::new(0.25, 0.25, 0.25));
    assert!(apart(&cube.tensor(), &expected.tensor()) < 1e-15);
    assert_eq!(cube.class(), Class::Solid(Symmetry::Spherical));
}

#[test]
fn turning_the_body_turns_the_tensor() {
    let points = points();
    let (q, r) = (turn(), turn().to_rotation_matrix());
    let turned = MassProperties::of_points(points.clone()).unwrap().turned(q);
    let moved: Vec<_> = points.iter().map(|&(m, at)| (m, q * at)).collect();
    assert!((turned.center_of_mass() - center(&moved)).amax() < 1e-15);
    assert!(apart(&turned.tensor(), &direct(&moved, center(&moved))) < 2e-15);
    let body = MassProperties::of_points(points).unwrap();
    assert!(apart(&turned.tensor(), &(r.matrix() * body.tensor() * r.matrix().transpose())) < 2e-15);
    for (a, b) in turned.principal_moments().into_iter().zip(body.principal_moments()) {
        assert!((a / b - 1.0).abs() < 2e-15);
    }
    let axes = turned.principal_axes().to_rotation_matrix();
    let diagonal = axes.matrix().transpose() * turned.tensor() * axes.matrix();
    assert!(apart(&diagonal, &Matrix3::from_diagonal(&turned.principal_moments().into())) < 2e-15);
}

#[test]
fn units_that_are_powers_of_two_change_no_bit() {
    let tiny = 1.0 / f64::from(1_u32 << 20) / f64::from(1_u32 << 20);
    let build = |mass: f64, length: f64| {
        let cylinder = Solid::Cylinder { radius: 0.3 * length, height: 1.1 * length };
        let cone = Solid::Cone { radius: 0.7 * length, height: 0.9 * length };
        let torus = Solid::Torus { ring: 1.3 * length, tube: 0.2 * length };
        let parts = [
            cylinder.with(Amount::Mass(0.9 * mass)).unwrap().turned(turn()),
            cone.with(Amount::Mass(1.7 * mass))
                .unwrap()
                .moved(Vector3::new(0.3, 0.4, -0.9) * length)
                .unwrap(),
            torus.with(Amount::Density(0.6 * mass / (length * length * length))).unwrap(),
        ];
        MassProperties::sum(parts).unwrap()
    };
    let body = build(1.0, 1.0);
    for (mass, length) in [(tiny, 1.0), (1.0, tiny), (tiny, tiny), (1.0 / tiny, 1.0 / tiny)] {
        let scaled = build(mass, length);
        assert_eq!(scaled.mass(), body.mass() * mass);
        assert_eq!(scaled.center_of_mass(), body.center_of_mass() * length);
        assert_eq!(scaled.tensor(), body.tensor() * (mass * length * length));
        let moments = body.principal_moments().map(|i| i * (mass * length * length));
        assert_eq!(scaled.principal_moments(), moments);
        assert_eq!(scaled.principal_axes(), body.principal_axes());
    }
    let layer = |mass: f64| {
        let region = Region::Layer { inner: 0.5, outer: 1.5 };
        region.filled(|s| mass * (1.0 + s.x * s.x), 1e-12).unwrap()
    };
    assert_eq!(layer(tiny).tensor(), layer(1.0).tensor() * tiny);
}

#[test]
fn classes_name_points_lines_planes_and_tops() {
    let mass = Amount::Mass(2.0);
    let class = |solid: Solid| solid.with(mass).unwrap().turned(turn()).class().name();
    assert_eq!(class(Solid::Rod { length: 3.0 }), "linear");
    assert_eq!(class(Solid::Plate([1.0, 2.0])), "planar");
    assert_eq!(class(Solid::Disk { radius: 0.1 }), "planar");
    assert_eq!(class(Solid::Hoop { radius: 0.1 }), "planar");
    assert_eq!(class(Solid::Cylinder { radius: 0.1, height: 4.0 }), "prolate");
    assert_eq!(class(Solid::Cylinder { radius: 4.0, height: 0.1 }), "oblate");
    assert_eq!(class(Solid::Box([3.0, 3.0, 3.0])), "spherical");
    assert_eq!(class(Solid::Box([1.0, 2.0, 3.0])), "asymmetric");
    assert_eq!(MassProperties::point(1.0, Vector3::new(1.0, 2.0, 3.0)).unwrap().class(), Class::Point);
}

/// Thin bodies in any attitude are bodies: none of them is turned away because of rounding.
#[test]
fn thin_bodies_are_not_rejected_for_rounding() {
    let thin = [
        Solid::Plate([1.0, 1e-3]),
        Solid::Plate([1e5, 0.3]),
        Solid::Disk { radius: 7.0 },
        Solid::Hoop { radius: 1e-9 },
        Solid::Rod { length: 0.17 },
        Solid::Box([1.0, 1.0, 1e-9]),
        Solid::Box([1e-6, 1e-6, 1.0]),
    ];
    for solid in thin {
        let body = solid.with(Amount::Mass(0.3)).unwrap();
        for k in 0..200 {
            let (a, b) = (0.1 * f64::from(k), 0.37 * f64::from(k));
            let q = UnitQuaternion::new_normalize(Quaternion::new(1.0, a - 7.0, b - 40.0, 3.0 - a * b));
            let turned = body.turned(q).moved(Vector3::new(0.1 * a, 2.0, -b)).unwrap();
            let about = turned.tensor_about(Vector3::zeros()).unwrap();
            let again =
                MassProperties::from_tensor_about(Vector3::zeros(), 0.3, turned.center_of_mass(), about);
            // far from its centre a nanometre hoop drowns in the rounding of the larger tensor: not a thin body's fault
            assert!(again.is_ok() || body.tensor().amax() <= 1e-3 * about.amax(), "{solid:?} {k}");
            assert!(MassProperties::new(0.3, turned.center_of_mass(), turned.tensor()).is_ok());
            match solid {
                Solid::Rod { .. } => {
                    let message = turned.inertia().unwrap_err().to_string();
                    assert!(message.starts_with("principal moments 0, "), "{message}");
                }
                _ => assert!(turned.inertia().is_ok(), "{solid:?} {k}"),
            }
        }
    }
}

/// The statements of the lecture's sections 17.1 and 17.2.
#[test]
fn statements_of_the_lecture() {
    // a planar system: one principal axis is normal to the plane, and I₃ = I₁ + I₂
    let planar: Vec<_> = points().into_iter().map(|(m, at)| (m, Vector3::new(at.x, at.y, 0.0))).collect();
    let body = MassProperties::of_points(planar).unwrap();
    let [a, b, c] = body.principal_moments();
    assert!((a + b - c).abs() < 1e-15 * c);
    let normal = body.principal_axes() * Vector3::z();
    assert!(normal.z.abs() > 1.0 - 1e-15);
    // a wheel about its contact point, and a pendulum about its pivot
    let wheel = Solid::Hoop { radius: 0.5 }.with(Amount::Mass(3.0)).unwrap();
    assert_eq!(wheel.tensor_about(Vector3::new(0.0, -0.5, 0.0)).unwrap()[(2, 2)], 2.0 * 3.0 * 0.25);
    let pendulum = Solid::Rod { length: 1.5 }.with(Amount::Mass(2.0)).unwrap();
    let about_pivot = pendulum.tensor_about(Vector3::new(0.0, 0.0, 0.75)).unwrap()[(0, 0)];
    assert!((about_pivot - 2.0 * 1.5 * 1.5 / 3.0).abs() < 1e-15);
    // so far away that squares overflow
    for point in [Vector3::new(1e155, 0.0, 0.0), Vector3::new(0.0, f64::MAX, f64::MAX)] {
        assert!(matches!(pendulum.tensor_about(point), Err(MassError::OutOfRange)), "{point:?}");
        assert!(matches!(pendulum.inertia_about(point), Err(MassError::OutOfRange)), "{point:?}");
    }
    let nowhere = pendulum.tensor_about(Vector3::new(0.0, f64::NAN, 0.0));
    assert!(matches!(nowhere, Err(MassError::NotFinite { quantity: "point", .. })));
}

#[test]
fn bad_input_is_named() {
    let message = |result: Result<MassProperties, MassError>| result.unwrap_err().to_string();
    let origin = Vector3::zeros();
    let ball = Solid::Sphere { radius: 1.0 };
    assert_eq!(message(ball.with(Amount::Mass(-2.0))), "mass is -2; it must be a finite number above zero");
    assert_eq!(
        message(ball.with(Amount::Density(0.0))),
        "density is 0; it must be a finite number above zero"
    );
    assert_eq!(
        message(Solid::Box([1.0, 0.0, 2.0]).with(Amount::Mass(1.0))),
        "length y is 0; it must be a finite number above zero"
    );
    assert_eq!(
        message(Solid::Tube { inner: 2.0, outer: 1.5, height: 1.0 }.with(Amount::Mass(1.0))),
        "tube: inner radius 2 must be below outer radius 1.5"
    );
    assert_eq!(
        message(Solid::Torus { ring: 1.0, tube: 1.0 }.with(Amount::Mass(1.0))),
        "torus: tube radius 1 must be below ring radius 1"
    );
    let layer = |inner: f64| {
        let refused = Region::Layer { inner, outer: 2.0 }.filled(|_| 1.0, 1e-6).unwrap_err();
        refused.to_string()
    };
    assert_eq!(layer(-1.0), "inner radius is -1; it must be zero or a finite number above zero");
    assert_eq!(layer(f64::NAN), "inner radius is NaN; it must be zero or a finite number above zero");
    assert_eq!(layer(2.0), "layer: inner radius 2 must be below outer radius 2");
    let named = |name: &str, sizes: &[f64]| Solid::named(name, sizes).unwrap_err().to_string();
    assert_eq!(
        named("cube", &[1.0]),
        "no such shape 'cube'; known: box, ellipsoid, sphere, shell, cylinder, tube, cone, torus, rod, disk, plate, hoop, capsule"
    );
    assert_eq!(named("cylinder", &[1.0]), "cylinder takes 2 (radius, height), but 1 given");
    assert_eq!(message(MassProperties::sum([])), "a body needs at least one part");
    assert_eq!(
        message(MassProperties::point(1.0, Vector3::new(0.0, f64::NAN, 0.0))),
        "centre of mass has the component NaN; every component must be a finite number"
    );
    assert_eq!(
        message(Solid::Sphere { radius: 1e200 }.with(Amount::Mass(1.0))),
        "masses and lengths put a moment of inertia outside the range of a double; change the units"
    );
    let tensor =
        |diagonal: [f64; 3]| MassProperties::new(1.0, origin, Matrix3::from_diagonal(&diagonal.into()));
    assert_eq!(
        message(tensor([1.0, 2.0, 4.0])),
        "about the centre of mass: principal moments 1, 2, 4 violate I1 + I2 >= I3 by 1 (25.000 % of the largest); \
         no mass distribution has them"
    );
    assert_eq!(
        message(tensor([1.0, -0.5, 1.0])),
        "about the centre of mass: principal moments -0.5, 1, 1: each must be positive \
         (a moment is a sum of mass times distance squared)"
    );
    let skew = Matrix3::new(2.0, 0.5, 0.0, 0.25, 2.0, 0.0, 0.0, 0.0, 3.0);
    assert_eq!(
        message(MassProperties::new(1.0, origin, skew)),
        "about the centre of mass: inertia tensor is not symmetric: I_xy = 0.5 but I_yx = 0.25, apart by 3.571e-2 of \
         the trace; I_jk = -sum m x_j x_k is the same both ways"
    );
    // a tensor about a far point that is too small for the distance
    let near = Matrix3::identity();
    let error = message(MassProperties::from_tensor_about(origin, 2.0, Vector3::new(1.0, 2.0, 3.0), near));
    assert!(error.contains("each must be positive"), "{error}");
    assert!(Inertia::from_tensor(Matrix3::zeros()).is_err());
}

#[test]
fn nearly_singular_tensors_have_finite_axes() {
    for tiny in [1e-30, 1e-160, 1e-200, 1e-300, 5e-324] {
        let tensor = Matrix3::new(1.0, 0.0, tiny, 0.0, 1.0, 0.0, tiny, 0.0, 0.0);
        let body = MassProperties::new(1.0, Vector3::zeros(), tensor).unwrap();
        assert!(body.principal_moments().iter().all(|i| i.is_finite()), "{tiny}");
        assert!(body.principal_axes().coords.iter().all(|q| q.is_finite()), "{tiny}");
        assert_eq!(body.class(), Class::Linear);
    }
}

#[test]
fn products_are_typed_with_the_sign_of_cad() {
    // a body in the first octant: designers print +sum m x y > 0, the entries of the tensor are negative
    let points = [[1.0, 2.0, 0.5], [2.0, 0.5, 1.0], [0.5, 1.0, 3.0]].map(|at| (2.0, Vector3::from(at)));
    let tensor = direct(&points, Vector3::zeros());
    let product = |j: usize, k: usize| points.iter().map(|(m, at)| m * at[j] * at[k]).sum::<f64>();
    let products = [product(0, 1), product(0, 2), product(1, 2)];
    assert_eq!(products, [7.0, 8.0, 9.0]);
    let diagonal = [0, 1, 2].map(|k| tensor[(k, k)]);
    let inertia = Inertia::from_products(diagonal, products).unwrap();
    assert_eq!(inertia.tensor(), tensor);
    assert_eq!([(0, 1), (0, 2), (1, 2)].map(|at| inertia.tensor()[at]), [-7.0, -8.0, -9.0]);
    // and of these each has its place
    assert_ne!(Inertia::from_products(diagonal, [8.0, 7.0, 9.0]).unwrap().tensor(), tensor);
    let moments = [2.0, 3.0, 4.0];
    let plain = Inertia::from_products(moments, [0.0; 3]).unwrap();
    assert_eq!(plain.principal_moments(), moments);
    assert!(Inertia::from_products([1.0; 3], [f64::NAN, 0.0, 0.0]).is_err());
}

#[test]
fn a_shape_takes_any_trace_that_is_one() {
    let tensor = Matrix3::new(2.0, -0.25, 0.125, -0.25, 3.0, 0.5, 0.125, 0.5, 3.0);
    let shape = InertiaShape::from_tensor(tensor * 7.0).unwrap();
    assert!(apart(&shape.tensor(), &(tensor / 8.0)) < 1e-15);
    for trace in [8.0, 1e-47, 1e33, 1e-240, 1e308] {
        let inertia = shape.with_trace(trace).unwrap();
        assert!(apart(&inertia.tensor(), &(tensor * (trace / 8.0))) < 1e-15, "{trace}");
    }
    let message = |trace: f64| shape.with_trace(trace).unwrap_err().to_string();
    for trace in [0.0, 1e-250, 5e-324] {
        assert!(message(trace).ends_with("outside the range of a double; change the units"), "{trace}");
    }
    assert_eq!(message(f64::NAN), "inertia has the entry NaN; every entry must be a finite number");
    assert_eq!(message(f64::INFINITY), "inertia has the entry inf; every entry must be a finite number");
    assert!(matches!(shape.with_trace(-1.0), Err(InertiaError::NotPositive { moments }) if moments[0] < 0.0));
    assert!(InertiaShape::from_tensor(tensor * -1.0).is_err());
}

#[test]
fn extremes_of_size_are_right_or_refused() {
    // beyond half of the largest double the sum with the transpose overflows
    let max = f64::MAX;
    let top =
        Inertia::from_tensor(Matrix3::from_diagonal(&Vector3::new(max, 0.75 * max, 0.5 * max))).unwrap();
    assert_eq!(top.tensor()[(0, 0)], max);
    assert_eq!(top.principal_moments(), [0.5 * max, 0.75 * max, max]);
    let skew = Matrix3::new(max, -0.5 * max, 0.0, -0.5 * max, max, 0.0, 0.0, 0.0, max);
    assert_eq!(Inertia::from_tensor(skew), Err(InertiaError::OutOfRange { value: max }));
    assert_eq!(
        Inertia::from_tensor(skew).unwrap_err().to_string(),
        "inertia of the size 1.7976931348623157e308 puts a moment outside the range of a double; change the units"
    );
    let bottom = Inertia::from_moments([5e-324, 1e-323, 1e-323]).unwrap();
    assert_eq!(bottom.principal_moments(), [5e-324, 1e-323, 1e-323]);
    for moments in [[1e154, 1e154, 3.1e-213], [1e200, 1e-154, 1e-162], [1e-70, 1.0, 1.0]] {
        let error = Inertia::from_positive_moments(moments).unwrap_err();
        assert_eq!(error, InertiaError::Slender { moments });
        assert!(error.to_string().contains("the smallest is less than 2^-200 (6e-61) of the largest"));
        assert!(Inertia::from_tensor(Matrix3::from_diagonal(&moments.into())).is_err());
    }
    assert!(Inertia::from_moments([1e-60, 1.0, 1.0]).is_ok());
    let out_of_range = |result: Result<MassProperties, MassError>| {
        assert_eq!(result, Err(MassError::OutOfRange));
    };
    out_of_range(Solid::Sphere { radius: 1e-170 }.with(Amount::Mass(1.0)));
    out_of_range(Solid::Sphere { radius: 1e-130 }.with(Amount::Mass(1e-100)));
    out_of_range(Solid::Box([1e-160, 1.0, 1.0]).with(Amount::Mass(1.0)));
    out_of_range(Solid::Rod { length: 1e100 }.with(Amount::Density(1e200)));
    let at = |z: f64| (1.0, Vector3::new(0.0, 0.0, z));
    out_of_range(MassProperties::of_points([at(0.0), at(1e-170)]));
    out_of_range(MassProperties::of_points([at(0.0), at(1e170)]));
    out_of_range(MassProperties::point(1e-300, Vector3::zeros()));
    assert_eq!(MassProperties::of_points([at(1.0), at(1.0)]).unwrap().class(), Class::Point);
}
