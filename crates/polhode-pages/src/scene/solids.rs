//! The triangles of the solids that the library knows.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::inertia::Solid;

use super::{Shape, Tint};

/// Sides of what is round.
const SIDES: u32 = 48;
/// Sides between two changes of the tint.
const SECTOR: u32 = 6;
/// Points of half a circle.
const HALF: u32 = 24;

/// What has no thickness is drawn with this share of its size.
const THIN: f64 = 0.02;

impl Shape {
    /// Of a solid in its own axes. What is flat or a line is drawn thin; what turns about an axis has tinted sectors, and a box a
    /// tinted face +z, so that one sees how they are turned.
    pub fn of_solid(solid: &Solid) -> Self {
        match *solid {
            Solid::Box(edges) => cuboid(edges),
            Solid::Plate([x, y]) => cuboid([x, y, THIN * x.max(y)]),
            Solid::Ellipsoid(axes) => ball(1.0).mapped(|at| at.component_mul(&Vector3::from(axes))),
            Solid::Sphere { radius } | Solid::Shell { radius } => ball(radius),
            Solid::Cylinder { radius, height } => cylinder(radius, height),
            Solid::Disk { radius } => cylinder(radius, THIN * radius),
            Solid::Rod { length } => cylinder(THIN * length, length),
            Solid::Tube { inner, outer, height: h } => {
                let [low, high] = [-0.5 * h, 0.5 * h];
                lathe(&[[inner, low], [outer, low], [outer, high], [inner, high], [inner, low]])
            }
            Solid::Cone { radius, height } => lathe(&[[0.0, 0.0], [radius, 0.0], [0.0, height]]),
            Solid::Torus { ring, tube } => torus(ring, tube),
            Solid::Hoop { radius } => torus(radius, THIN * radius),
            Solid::Capsule { radius, height } => {
                let cap = |k: u32| arc(k, HALF / 2).map(|x| radius * x);
                let low = (0..=HALF / 2).map(cap).map(|[r, z]| [r, z - 0.5 * height]);
                let high = (HALF / 2..=HALF).map(cap).map(|[r, z]| [r, z + 0.5 * height]);
                lathe(&low.chain(high).collect::<Vec<_>>())
            }
        }
    }

    /// The box of uniform density with moments in these ratios, ascending, its edges along the axes that `frame` turns x, y, z
    /// to, with a longest edge of 2.
    pub fn equal_box(moments: [f64; 3], frame: UnitQuaternion<f64>) -> Self {
        cuboid(stretched(moments).map(|x| 2.0 * x)).turned(frame)
    }

    /// The ellipsoid of uniform density with moments in these ratios, with a longest semi-axis of 1.
    pub fn equal_ellipsoid(moments: [f64; 3], frame: UnitQuaternion<f64>) -> Self {
        ball(1.0).mapped(|at| at.component_mul(&Vector3::from(stretched(moments)))).turned(frame)
    }
}

/// Lengths along the principal axes of a box or an ellipsoid, the largest 1: a² ∝ I_b + I_c − I_a.
fn stretched([x, y, z]: [f64; 3]) -> [f64; 3] {
    let largest = x.max(y).max(z);
    let [x, y, z] = [x, y, z].map(|moment| moment / largest);
    let lengths = [y + z - x, z + x - y, x + y - z].map(|square| libm::sqrt(square.max(0.0)));
    let longest = lengths.into_iter().fold(0.0, f64::max);
    lengths.map(|length| (length / longest).max(THIN))
}

fn cuboid(edges: [f64; 3]) -> Shape {
    let half = Vector3::from(edges) / 2.0;
    let mut shape = Shape::default();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |j: f64, k: f64| {
                let mut at = Vector3::zeros();
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, j * side, k);
                at.component_mul(&half)
            };
            let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]
                .map(|at| shape.vertex(at));
            let tint = if axis == 2 && side > 0.0 { Tint::Mark } else { Tint::Plain };
            shape.triangle([a, b, c], tint);
            shape.triangle([a, c, d], tint);
        }
    }
    shape
}

fn ball(radius: f64) -> Shape {
    let profile: Vec<[f64; 2]> = (0..=HALF).map(|k| arc(k, HALF / 2).map(|x| radius * x)).collect();
    lathe(&profile)
}

fn cylinder(radius: f64, height: f64) -> Shape {
    let [low, high] = [-0.5 * height, 0.5 * height];
    lathe(&[[0.0, low], [radius, low], [radius, high], [0.0, high]])
}

fn torus(ring: f64, tube: f64) -> Shape {
    let profile: Vec<[f64; 2]> = (0..=HALF)
        .map(|k| {
            // the last point is the first, bit for bit
            let [x, z] = arc(k % HALF, HALF / 4);
            [ring + tube * x, tube * z]
        })
        .collect();
    lathe(&profile)
}

/// Point k of a circle of radius 1 from its lowest point on, with `quarter` points to a right angle.
fn arc(k: u32, quarter: u32) -> [f64; 2] {
    if k == 2 * quarter {
        return [0.0, 1.0];
    }
    let (sin, cos) = libm::sincos(core::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(quarter));
    [sin, -cos]
}

/// The surface that a line of points (distance from the axis, height) sweeps about z.
fn lathe(profile: &[[f64; 2]]) -> Shape {
    let mut shape = Shape::default();
    let rings: Vec<Vec<u32>> = profile
        .iter()
        .map(|&[radius, height]| {
            if radius == 0.0 {
                return vec![shape.vertex(Vector3::new(0.0, 0.0, height)); SIDES as usize];
            }
            let around = |k: u32| {
                let (sin, cos) = libm::sincos(core::f64::consts::TAU * f64::from(k) / f64::from(SIDES));
                Vector3::new(radius * cos, radius * sin, height)
            };
            (0..SIDES).map(|k| shape.vertex(around(k))).collect()
        })
        .collect();
    for pair in rings.windows(2) {
        let (low, high) = (&pair[0], &pair[1]);
        for k in 0..SIDES as usize {
            let next = (k + 1) % SIDES as usize;
            let tint = if (k as u32 / SECTOR).is_multiple_of(2) { Tint::Plain } else { Tint::Mark };
            if low[k] != low[next] {
                shape.triangle([low[k], low[next], high[next]], tint);
            }
            if high[k] != high[next] {
                shape.triangle([low[k], high[next], high[k]], tint);
            }
        }
    }
    shape
}

#[cfg(test)]
mod tests {
    use polhode::inertia::{Amount, FLOAT_WELD, Surface};

    use super::*;

    /// Chords cut off less than 2 % of what is round.
    #[test]
    fn solids_enclose_the_volume_and_have_the_moments_of_what_they_draw() {
        for (name, sizes) in [
            ("box", vec![1.0, 2.0, 3.0]),
            ("ellipsoid", vec![1.0, 2.0, 3.0]),
            ("sphere", vec![2.0]),
            ("cylinder", vec![1.0, 3.0]),
            ("tube", vec![1.0, 2.0, 3.0]),
            ("cone", vec![1.0, 3.0]),
            ("torus", vec![3.0, 1.0]),
            ("capsule", vec![1.0, 2.0]),
        ] {
            let solid = Solid::named(name, &sizes).unwrap();
            let shape = Shape::of_solid(&solid);
            let corners = shape.triangles.iter().map(|k| k.map(|k| shape.vertices[k as usize]));
            let (mesh, _) = Surface::new(corners).unwrap().mended(FLOAT_WELD).unwrap();
            assert!((mesh.volume() / solid.measure() - 1.0).abs() < 0.02, "{name}: {}", mesh.volume());
            let [drawn, meant] =
                [mesh.with(Amount::Mass(1.0)), solid.with(Amount::Mass(1.0))].map(|found| found.unwrap());
            let apart = (drawn.tensor() - meant.tensor()).amax() / meant.tensor().amax();
            assert!(apart < 0.02, "{name}: {apart}");
            assert!((drawn.center_of_mass() - meant.center_of_mass()).amax() < 0.01, "{name}");
        }
    }

    #[test]
    fn a_box_and_an_ellipsoid_of_equal_inertia_have_the_moments_asked_for() {
        let moments = [1.0, 2.5, 3.0];
        let [x, y, z] = stretched(moments);
        for solid in [Solid::Box([x, y, z]), Solid::Ellipsoid([x, y, z])] {
            let found = solid.with(Amount::Mass(1.0)).unwrap().tensor().diagonal();
            assert!((found / found.x - Vector3::from(moments)).amax() < 1e-14, "{found}");
        }
        // a plate is drawn with a thickness
        assert_eq!(stretched([1.0, 2.0, 3.0])[2], THIN);
    }
}
