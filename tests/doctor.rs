//! The doctor: spoiled tensors whose true cause it must name first, and healthy ones that it must leave alone.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::inertia::{Amount, Evidence, Inertia, InertiaError, MassProperties, Solid, Validity, diagnose};

/// A body, and what a user may know of it.
struct Patient {
    body: MassProperties,
    evidence: Evidence,
}

/// A part of a body: shape, density, shift.
type Part = (Solid, f64, [f64; 3]);

fn patient(parts: &[Part], extents: [f64; 3]) -> Patient {
    let parts = parts.iter().map(|(solid, density, shift)| {
        solid.with(Amount::Density(*density)).unwrap().moved(Vector3::from(*shift)).unwrap()
    });
    let body = MassProperties::sum(parts).unwrap();
    let evidence = Evidence::default()
        .with_mass(body.mass())
        .with_center_of_mass(body.center_of_mass())
        .with_extents(extents);
    Patient { body, evidence }
}

/// A bracket of steel in the shape of an L, with large products.
fn bracket() -> Patient {
    let parts = [
        (Solid::Box([0.3, 0.04, 0.05]), 7800.0, [0.15, 0.0, 0.0]),
        (Solid::Box([0.04, 0.2, 0.05]), 7800.0, [0.28, 0.12, 0.01]),
        (Solid::Box([0.05, 0.05, 0.15]), 7800.0, [0.0, 0.01, 0.09]),
    ];
    patient(&parts, [0.325, 0.24, 0.19])
}

/// A forearm of a robot: an aluminium tube with a motor at its wrist, modelled from the elbow.
fn forearm() -> Patient {
    let parts = [
        (Solid::Tube { inner: 0.03, outer: 0.035, height: 0.4 }, 2700.0, [0.0, 0.0, 0.2]),
        (Solid::Cylinder { radius: 0.04, height: 0.08 }, 5000.0, [0.02, 0.01, 0.36]),
    ];
    patient(&parts, [0.1, 0.09, 0.4])
}

/// A phone.
fn phone() -> Patient {
    let battery = (Solid::Box([0.05, 0.09, 0.005]), 2300.0, [0.004, -0.02, 0.0]);
    patient(&[(Solid::Box([0.071, 0.147, 0.008]), 1800.0, [0.0; 3]), battery], [0.071, 0.147, 0.008])
}

/// A satellite with a boom.
fn satellite() -> Patient {
    let parts = [
        (Solid::Box([1.2, 1.0, 1.6]), 260.0, [0.0; 3]),
        (Solid::Box([0.4, 0.1, 0.1]), 2700.0, [0.75, 0.5, 0.8]),
        (Solid::Box([0.3, 0.3, 0.3]), 1500.0, [-0.4, -0.3, -0.6]),
    ];
    patient(&parts, [1.6, 1.05, 1.65])
}

fn entry(mut tensor: Matrix3<f64>, (j, k): (usize, usize), change: impl Fn(f64) -> f64) -> Matrix3<f64> {
    let value = change(tensor[(j, k)]);
    tensor[(j, k)] = value;
    tensor[(k, j)] = value;
    tensor
}

fn products_flipped(tensor: Matrix3<f64>) -> Matrix3<f64> {
    tensor.map_with_location(|j, k, value| if j == k { value } else { -value })
}

fn reordered(tensor: Matrix3<f64>, order: [(usize, usize); 6]) -> Matrix3<f64> {
    const OURS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    // a list written in `order` is read in ours
    OURS.iter().zip(order).fold(tensor, |result, (&ours, theirs)| entry(result, ours, |_| tensor[theirs]))
}

fn parallel_axis_term(patient: &Patient) -> Matrix3<f64> {
    let d = patient.body.center_of_mass();
    (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * patient.body.mass()
}

const BY_ROWS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
const VOIGT: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];

/// A name, the spoiled tensor, what is known of the body, the true cause, the true tensor.
type Case = (&'static str, Matrix3<f64>, Evidence, &'static str, Matrix3<f64>);

fn cases() -> Vec<Case> {
    let nothing = Evidence::default();
    let mass_only = |p: &Patient| nothing.with_mass(p.evidence.mass);
    let without_extents = |p: &Patient| p.evidence.with_extents(None);
    let (bracket, forearm, phone, satellite) = (bracket(), forearm(), phone(), satellite());
    let [b, f, p, s] = [&bracket, &forearm, &phone, &satellite].map(|patient| patient.body.tensor());
    // a thin rod along (1, 1, 1) and a plate across it, whose products decide everything
    let rod = Matrix3::new(2.1, -1.0, -1.0, -1.0, 2.1, -1.0, -1.0, -1.0, 2.1);
    let slanted = UnitQuaternion::new_normalize(Quaternion::new(0.9, -0.3, 0.5, 0.2));
    let bar = Solid::Box([0.1, 0.2, 1.3]).with(Amount::Mass(3.0)).unwrap().turned(slanted).tensor();
    vec![
        ("signs, rod", products_flipped(rod), nothing, "product-signs", rod),
        ("signs, bar", products_flipped(bar), nothing, "product-signs", bar),
        ("signs, bar of known mass", products_flipped(bar), nothing.with_mass(3.0), "product-signs", bar),
        ("subtracted twice, forearm", f - parallel_axis_term(&forearm), forearm.evidence, "another-point", f),
        (
            "subtracted twice, bracket",
            b - parallel_axis_term(&bracket),
            without_extents(&bracket),
            "another-point",
            b,
        ),
        ("about the origin, forearm", f + parallel_axis_term(&forearm), forearm.evidence, "another-point", f),
        ("about the origin, bracket", b + parallel_axis_term(&bracket), bracket.evidence, "another-point", b),
        ("kg mm^2, bracket", b * 1e6, bracket.evidence, "unit", b),
        ("kg mm^2, phone by its mass", p * 1e6, mass_only(&phone), "unit", p),
        ("g mm^2, phone", p * 1e9, phone.evidence, "unit", p),
        ("g mm^2, forearm by its mass", f * 1e9, mass_only(&forearm), "unit", f),
        ("g cm^2, phone", p * 1e7, phone.evidence, "unit", p),
        ("converted twice, satellite", s * 1e-6, satellite.evidence, "unit", s),
        ("rows, bracket", reordered(b, BY_ROWS), nothing, "entry-order", b),
        ("rows, satellite", reordered(s, BY_ROWS), nothing, "entry-order", s),
        ("rows, phone", reordered(p, BY_ROWS), phone.evidence, "entry-order", p),
        ("Voigt, bar", reordered(bar, VOIGT), nothing, "entry-order", bar),
        (
            "xx and yy, phone",
            entry(entry(p, (0, 0), |_| p[(1, 1)]), (1, 1), |_| p[(0, 0)]),
            phone.evidence,
            "swapped-entries",
            p,
        ),
        (
            "xx and zz, forearm",
            entry(entry(f, (0, 0), |_| f[(2, 2)]), (2, 2), |_| f[(0, 0)]),
            forearm.evidence,
            "swapped-entries",
            f,
        ),
        ("slip of xx, satellite", entry(s, (0, 0), |x| 10.0 * x), nothing, "decimal-slip", s),
        ("slip of zz, satellite", entry(s, (2, 2), |x| 100.0 * x), satellite.evidence, "decimal-slip", s),
        ("slip of yy, bracket", entry(b, (1, 1), |x| 0.1 * x), bracket.evidence, "decimal-slip", b),
        ("slip of yy, phone", entry(p, (1, 1), |x| 10.0 * x), phone.evidence, "decimal-slip", p),
        ("slip of xy, bracket", entry(b, (0, 1), |x| 10.0 * x), bracket.evidence, "decimal-slip", b),
        ("minus on the diagonal, phone", entry(p, (1, 1), |x| -x), nothing, "negative-moments", p),
        (
            "covariance, forearm",
            Matrix3::identity() * (0.5 * f.trace()) - f,
            forearm.evidence,
            "second-moments",
            f,
        ),
        ("per mass, satellite", s / satellite.body.mass(), satellite.evidence, "per-mass", s),
    ]
}

#[test]
fn the_true_cause_comes_first() {
    let mut failures = Vec::new();
    for (name, spoiled, evidence, cause, truth) in cases() {
        let found = diagnose(spoiled, &evidence).unwrap();
        let Some(first) = found.causes.first() else {
            failures.push(format!("{name}: no cause found, {:?}", found.verdict));
            continue;
        };
        assert_ne!(found.verdict, Validity::Valid);
        let back = (first.corrected - truth).amax() / truth.amax();
        if first.cause.name() != cause || back > 1e-9 {
            let listed: Vec<String> =
                found.causes.iter().take(4).map(|c| format!("{:.2} {}", c.cost, c.cause)).collect();
            failures.push(format!("{name}: {listed:#?}, off by {back:.1e}"));
        }
    }
    assert!(cases().len() >= 20);
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn the_healthy_are_left_alone() {
    for patient in [bracket(), forearm(), phone(), satellite()] {
        for evidence in [Evidence::default(), patient.evidence.with_extents(None), patient.evidence] {
            let found = diagnose(patient.body.tensor(), &evidence).unwrap();
            assert_eq!(
                found.verdict,
                Validity::Valid,
                "{:?}",
                found.causes.first().map(|c| c.cause.to_string())
            );
            assert_eq!((found.distance, found.nearest), (0.0, patient.body.tensor()));
            assert!(found.causes.is_empty() && found.violation.is_none());
        }
    }
    // thin bodies in any attitude lie on the border of the law, and rounding must not push them over it
    let thin = [
        Solid::Plate([1.0, 2.0]),
        Solid::Disk { radius: 0.3 },
        Solid::Hoop { radius: 5.0 },
        Solid::Rod { length: 2.0 },
        Solid::Plate([1e-3, 4.0]),
    ];
    for solid in thin {
        for k in 0..100 {
            let q = Quaternion::new(1.0, 0.1 * f64::from(k), 3.0 - 0.2 * f64::from(k), 0.7);
            let body = solid.with(Amount::Mass(1.5)).unwrap().turned(UnitQuaternion::new_normalize(q));
            let found = diagnose(body.tensor(), &Evidence::default().with_mass(1.5)).unwrap();
            assert_eq!(found.verdict, Validity::Valid, "{solid:?} {k}");
            assert!(found.distance < 1e-15 * body.tensor().amax());
        }
    }
}

#[test]
fn the_nearest_tensor_is_accepted_and_no_valid_one_is_nearer() {
    for (name, spoiled, evidence, ..) in cases() {
        let found = diagnose(spoiled, &evidence).unwrap();
        let scale = spoiled.amax();
        let from_nearest = (found.nearest - spoiled).norm();
        assert!((from_nearest - found.distance).abs() < 1e-14 * scale, "{name}");
        assert!(MassProperties::new(1.0, Vector3::zeros(), found.nearest).is_ok(), "{name}");
        // optimality of a projection onto a convex cone: ⟨spoiled − nearest, v⟩ ≤ 0 for every valid v, = 0 for nearest
        let gap = spoiled - found.nearest;
        assert!(gap.dot(&found.nearest).abs() < 1e-13 * scale * scale, "{name}");
        for k in 0..200 {
            let (a, b) = (f64::from(k) * 0.73, f64::from(k) * 1.31);
            let v = Vector3::new(a % 2.0 - 1.0, b % 2.0 - 1.0, (a * b) % 2.0 - 1.0);
            // the rods span the cone
            let rod = Matrix3::identity() * v.norm_squared() - v * v.transpose();
            assert!(gap.dot(&rod) <= 1e-13 * scale, "{name}");
        }
    }
    let flat = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 4.5));
    let found = diagnose(flat, &Evidence::default()).unwrap();
    assert_eq!(found.nearest, Matrix3::from_diagonal(&Vector3::new(1.5, 2.5, 4.0)));
    assert_eq!(found.distance, 0.75_f64.sqrt());
    assert!(Inertia::from_tensor(found.nearest).is_ok());
}

#[test]
fn the_equivalent_box_is_the_box() {
    let body = Solid::Box([0.3, 1.7, 0.9]).with(Amount::Mass(2.5)).unwrap();
    let tilted = body.turned(UnitQuaternion::new_normalize(Quaternion::new(0.7, -0.3, 0.5, 0.2))).tensor();
    let known = diagnose(tilted, &Evidence::default().with_mass(2.5)).unwrap();
    for (edge, expected) in known.equivalent_box.into_iter().zip([1.7, 0.9, 0.3]) {
        assert!((edge - expected).abs() < 1e-14, "{:?}", known.equivalent_box);
    }
    let unknown = diagnose(tilted, &Evidence::default()).unwrap();
    assert!((unknown.equivalent_box[1] - 0.9 / 1.7).abs() < 1e-15 && unknown.equivalent_box[0] == 1.0);
}

#[test]
fn messages_say_law_margin_and_remedy() {
    let evidence = Evidence::default().with_mass(1.2).with_extents([0.2, 0.1, 0.05]);
    let found = diagnose(Matrix3::from_diagonal(&Vector3::new(1250.0, 4250.0, 5000.0)), &evidence).unwrap();
    assert_eq!(found.violation, None);
    // a homogeneous box fills a third of what the extents allow
    assert!((found.misfit.unwrap().ratio - 1e6 / 3.0).abs() < 1e-9 * 1e6);
    assert_eq!(found.causes[0].cause.to_string(), "in kg mm^2, not in kg m^2: multiply by 1e-6");
    let skew = Matrix3::new(2.0, 0.5, 0.0, -0.5, 2.0, 0.0, 0.0, 0.0, 3.0);
    let found = diagnose(skew, &Evidence::default()).unwrap();
    assert!(
        matches!(found.violation, Some(InertiaError::NotSymmetric { relative, .. }) if relative == 1.0 / 7.0)
    );
    assert_eq!(
        found.causes[0].cause.to_string(),
        "the two entries I_xy differ: the one below the diagonal is wrong, the one above it is right"
    );
    assert_eq!(found.distance, 0.5_f64.sqrt());
    let error = |tensor: Matrix3<f64>, evidence| diagnose(tensor, &evidence).unwrap_err().to_string();
    let negative = Evidence::default().with_mass(-1.0);
    assert_eq!(error(skew, negative), "mass is -1; it must be a finite number above zero");
    assert!(error(skew * f64::NAN, Evidence::default()).contains("every entry must be a finite number"));
}

#[test]
fn a_unit_of_mass_that_is_a_power_of_two_changes_no_bit_of_the_nearest() {
    let tiny = 1.0 / f64::from(1_u32 << 20) / f64::from(1_u32 << 20);
    for (name, spoiled, ..) in cases() {
        let (a, b) =
            (diagnose(spoiled, &Evidence::default()), diagnose(spoiled * tiny, &Evidence::default()));
        let (a, b) = (a.unwrap(), b.unwrap());
        assert_eq!(a.nearest * tiny, b.nearest, "{name}");
        assert_eq!(a.distance * tiny, b.distance, "{name}");
        assert_eq!(a.equivalent_box, b.equivalent_box, "{name}");
        let causes = |found: &[polhode::inertia::Explanation]| {
            found.iter().map(|c| c.cause.clone()).collect::<Vec<_>>()
        };
        assert_eq!(causes(&a.causes), causes(&b.causes), "{name}");
    }
}

#[test]
fn extremes_of_size_and_zeros_are_refused_in_words() {
    let out_of_range = |tensor: Matrix3<f64>, evidence: Evidence| {
        let error = diagnose(tensor, &evidence).unwrap_err().to_string();
        assert_eq!(
            error,
            "masses and lengths put a moment of inertia outside the range of a double; change the units"
        );
    };
    let one = Matrix3::identity();
    let max = f64::MAX;
    let spoiled = Matrix3::new(max, 3.4e-74, 1e-200, 3.4e-74, max, -max, 1e-200, -max, 1e-200);
    out_of_range(spoiled, Evidence::default().with_mass(0.798));
    out_of_range(one * 1e300, Evidence::default());
    out_of_range(one * 1e-300, Evidence::default());
    out_of_range(one, Evidence::default().with_extents([1.0, 1e-200, 1.0]));
    out_of_range(one, Evidence::default().with_mass(1e-250).with_extents([1e-50; 3]));
    out_of_range(one, Evidence::default().with_center_of_mass(Vector3::new(1e200, 0.0, 0.0)));
    // a mass without extents has a box, however large
    let light = diagnose(one, &Evidence::default().with_mass(1e-310)).unwrap();
    assert!(light.equivalent_box.iter().all(|edge| (1e155..1e156).contains(edge)), "{light:?}");

    let evidence = Evidence::default().with_mass(1.0).with_center_of_mass(Vector3::new(1.0, 0.0, 0.0));
    let nothing = diagnose(Matrix3::zeros(), &evidence).unwrap();
    assert_eq!(nothing.verdict, Validity::Invalid);
    assert_eq!(nothing.violation, Some(InertiaError::NotPositive { moments: [0.0; 3] }));
    assert!(nothing.causes.is_empty());
}
