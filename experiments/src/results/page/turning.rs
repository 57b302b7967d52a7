//! The polhode and the herpolhode of one body, as curves to turn with the mouse.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::catalogue;
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Real;
use polhode_files::error::{Error, unexpected};
use serde::Serialize;

const BODY: &str = "textbook";
const POINTS: u32 = 240;
/// Polhodes on each side of each stable axis.
const FAMILY: u32 = 4;
/// Periods of the momentum in the herpolhode.
const PERIODS: f64 = 9.0;

/// A curve in space, with its colours on a light and on a dark page.
#[derive(Serialize)]
pub(super) struct Curve {
    name: &'static str,
    light: &'static str,
    dark: &'static str,
    width: f64,
    /// Whether it lies on a sphere, whose far side is drawn faintly.
    sphere: bool,
    points: Vec<[f64; 3]>,
}

/// What the page shows of the body.
pub(super) struct Turning {
    pub(super) name: &'static str,
    pub(super) moments: [f64; 3],
    pub(super) omega_body: [f64; 3],
    pub(super) polhode: Vec<Curve>,
    pub(super) herpolhode: Vec<Curve>,
}

/// The catalogue's body that many publications use.
pub(super) fn turning() -> Result<Turning, Error> {
    let named = catalogue::body(BODY).ok_or_else(|| unexpected(format!("no body is called {BODY}")))?;
    let [i1, i2, i3] = named.inertia.principal_moments();
    let motion = from_momentum(&named.inertia, named.inertia.momentum(named.omega_body.into()))?;
    Ok(Turning {
        name: named.name,
        moments: [i1, i2, i3],
        omega_body: named.omega_body,
        polhode: polhodes(&named.inertia, &motion)?,
        herpolhode: herpolhode(&motion)?,
    })
}

fn from_momentum(inertia: &Inertia, momentum: Vector3<f64>) -> Result<FreeMotion, Error> {
    let omega = momentum.component_div(&Vector3::from(inertia.principal_moments()));
    FreeMotion::from_omega(inertia, UnitQuaternion::identity(), omega).map_err(unexpected)
}

/// Directions of the momentum in the body: the motion among its neighbours of the same |m|, and the separatrix.
fn polhodes(inertia: &Inertia, motion: &FreeMotion) -> Result<Vec<Curve>, Error> {
    let quiet = ("#8b93a1", "#798291");
    let mut curves = Vec::new();
    for stable in [0, 2] {
        for side in [1.0, -1.0] {
            for k in 1..=FAMILY {
                // between the stable axis and the middle one, on the great circle through both
                let angle = 0.5 * core::f64::consts::PI * f64::from(k) / f64::from(FAMILY + 1);
                let mut momentum = Vector3::zeros();
                let (sin, cos) = Real::sin_cos(angle);
                momentum[stable] = side * cos;
                momentum[1] = sin;
                let points = round(&from_momentum(inertia, momentum)?)?;
                curves.push(Curve::new("", quiet, 1.0, points));
            }
        }
    }
    let [i1, i2, i3] = inertia.principal_moments().map(f64::recip);
    let tilt = ((i1 - i2) / (i2 - i3)).sqrt(); // m₃/m₁ on the separatrix
    for sign in [1.0, -1.0] {
        let across = Vector3::new(1.0, 0.0, sign * tilt).normalize();
        let points = (0..=POINTS).map(|k| {
            let angle = core::f64::consts::TAU * f64::from(k) / f64::from(POINTS);
            let (sin, cos) = Real::sin_cos(angle);
            (across * cos + Vector3::y() * sin).into()
        });
        curves.push(Curve::new(
            if sign > 0.0 { "separatrix" } else { "" },
            ("#b34700", "#ffab66"),
            1.6,
            points.collect(),
        ));
    }
    curves.push(Curve::new("this motion", ("#0b5cad", "#7db6f0"), 3.5, round(motion)?));
    for (axis, name) in ["axis 1", "axis 2", "axis 3"].into_iter().enumerate() {
        let mut end = [0.0; 3];
        end[axis] = 1.25;
        curves.push(Curve {
            sphere: false,
            ..Curve::new(name, ("#16181d", "#e8eaee"), 1.2, vec![[0.0; 3], end])
        });
    }
    Ok(curves)
}

/// The direction of the momentum in the body over one period.
fn round(motion: &FreeMotion) -> Result<Vec<[f64; 3]>, Error> {
    let period = motion.character().map_err(unexpected)?.polhode_period.unwrap_or(0.0);
    (0..=POINTS)
        .map(|k| {
            let state = motion.at(period * f64::from(k) / f64::from(POINTS)).map_err(unexpected)?;
            Ok(state.momentum().normalize().into())
        })
        .collect()
}

/// The tip of the angular velocity in space, over its length at the start; L is along z.
fn herpolhode(motion: &FreeMotion) -> Result<Vec<Curve>, Error> {
    let start = motion.at(0.0).map_err(unexpected)?;
    let upright = UnitQuaternion::rotation_between(&start.momentum_space(), &Vector3::z())
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), core::f64::consts::PI));
    let size = motion.omega_at(0.0).map_err(unexpected)?.norm();
    let period = motion.character().map_err(unexpected)?.polhode_period.unwrap_or(0.0);
    let count = 8 * POINTS;
    let tip = |k: u32| {
        let t = PERIODS * period * f64::from(k) / f64::from(count);
        let rotation = upright * motion.at(t).map_err(unexpected)?.rotation();
        Ok((rotation * motion.omega_at(t).map_err(unexpected)? / size).into())
    };
    let points = (0..=count).map(tip).collect::<Result<Vec<[f64; 3]>, Error>>()?;
    // the middle of the axis of L is the centre of the view
    let height = points[0][2];
    let centred =
        |points: Vec<[f64; 3]>| points.into_iter().map(|[x, y, z]| [x, y, z - 0.65 * height]).collect();
    let axis = vec![[0.0; 3], [0.0, 0.0, 1.3 * height]];
    Ok(vec![
        Curve { sphere: false, ..Curve::new("herpolhode", ("#0b5cad", "#7db6f0"), 1.6, centred(points)) },
        Curve { sphere: false, ..Curve::new("L", ("#16181d", "#e8eaee"), 2.0, centred(axis)) },
    ])
}

impl Curve {
    fn new(
        name: &'static str,
        (light, dark): (&'static str, &'static str),
        width: f64,
        points: Vec<[f64; 3]>,
    ) -> Self {
        // what a screen shows
        let points = points.into_iter().map(|point| point.map(|x| (x * 1e4).round() / 1e4)).collect();
        Self { name, light, dark, width, sphere: true, points }
    }
}
