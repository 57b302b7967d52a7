//! Vectors and quaternions against closed forms.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};

#[test]
fn cayleys_transform_turns_by_twice_the_arc_tangent() {
    for (c, angle) in [
        ([0.75, 0.0, 0.0], 1.287_002_217_586_569_3), // 2 atan 3/4
        ([0.0, 2.0, 0.0], 2.214_297_435_588_181),    // 2 atan 2
        ([0.0, 0.0, -1e-3], -1.999_999_333_333_733e-3),
    ] {
        let axis = Vector3::from(c).map(|x: f64| if x == 0.0 { 0.0 } else { 1.0 });
        let expected = UnitQuaternion::from_scaled_axis(axis * angle);
        let turn = Quat::cayley(Vec3(c));
        assert!((turn.norm_squared() - 1.0).abs() < 1e-15);
        let found = UnitQuaternion::from(turn);
        assert!(found.angle_to(&expected) < 1e-15, "{c:?}: {found} {expected}");
    }
    let turn = Quat::cayley(Vec3([0.75, 0.0, 0.0]));
    assert_eq!(turn.components(), [0.8, 0.6000000000000001, 0.0, 0.0]);
}

#[test]
fn the_largest_component_is_undefined_if_one_is() {
    let nan = f64::NAN;
    assert_eq!(Vec3([1.0, -3.0, 2.0]).magnitude(), 3.0);
    assert_eq!(Vec3([0.5, 0.25, -1.0]).magnitude(), 1.0);
    assert_eq!(Quat::from_components([-4.0, 1.0, 2.0, 3.0]).magnitude(), 4.0);
    assert_eq!(Quat::from_components([1.0, 1.0, 5.0, 3.0]).magnitude(), 5.0);
    for place in 0..4 {
        let mut parts = [1.0; 4];
        parts[place] = nan;
        assert!(Quat::from_components(parts).magnitude().is_nan(), "{place}");
        if place < 3 {
            assert!(Vec3([parts[0], parts[1], parts[2]]).magnitude().is_nan(), "{place}");
        }
        assert!(Quat::from_components(parts.map(Dd::of)).magnitude().is_nan(), "{place}");
    }
}
