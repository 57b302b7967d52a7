//! Section 17.6: the symmetric top under gravity.

use nalgebra::Vector3;
use polhode::body::{Body, Clock, State};
use polhode::catalogue;
use polhode::flow::LagrangeTop;
use polhode::inertia::Inertia;
use polhode::method::method;
use polhode::num::{Dd, Real};
use polhode::rotation::{EulerSequence, Vec3};
use polhode_files::error::Error;

use super::{Point, Statements, derivative, unexpected};
use crate::statistics::larger;

const HEAVY: &str = "17.6";

/// I, I3 and M g l of the examples.
const ACROSS: f64 = 1.25;
const ALONG: f64 = 0.75;
const WEIGHT: f64 = 2.0;

type V = Vector3<f64>;

pub(super) fn statements(s: &mut Statements) -> Result<(), Error> {
    constants(s)?;
    asleep(s)?;
    fast(s)?;
    bicycle_wheel(s)
}

fn body() -> Result<Body, Error> {
    let inertia = Inertia::from_moments([ACROSS, ACROSS, ALONG]).map_err(unexpected)?;
    Body::heavy(inertia, V::new(0.0, 0.0, WEIGHT)).map_err(unexpected)
}

/// A top tilted by `tilt`, in the plane of Y and Z.
fn top(tilt: f64, omega: V) -> Result<LagrangeTop, Error> {
    let zxz: EulerSequence = "zxz".parse().map_err(unexpected)?;
    LagrangeTop::from_omega(&body()?, zxz.attitude([0.0, tilt, 0.0]), omega).map_err(unexpected)
}

fn constants(s: &mut Statements) -> Result<(), Error> {
    let moments = V::new(ACROSS, ACROSS, ALONG);
    let top = top(0.8, V::new(0.7, -0.4, 5.0))?;
    let state = |t: f64| top.at(t).map_err(unexpected);
    let start = state(0.0)?;
    let energy = |x: &State| {
        let m = x.momentum();
        0.5 * m.dot(&m.component_div(&moments)) + WEIGHT * (x.rotation() * V::z()).z
    };
    let vertical = |x: &State| (x.rotation() * x.momentum()).z;
    let [energy_0, vertical_0, along_0] = [energy(&start), vertical(&start), start.momentum().z];
    let size = start.momentum().norm();
    let (mut energy_error, mut vertical_error, mut along_error, mut shape_error) =
        (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for k in 1..=1000 {
        let now = state(0.37 * f64::from(k))?;
        energy_error = larger(energy_error, (energy(&now) - energy_0).abs() / energy_0);
        vertical_error = larger(vertical_error, (vertical(&now) - vertical_0).abs() / size);
        along_error = larger(along_error, (now.momentum().z - along_0).abs() / size);
        // theta' from w about the line of nodes
        let up = now.rotation().inverse() * V::z();
        let sin = libm::hypot(up.x, up.y);
        let omega = now.momentum().component_div(&moments);
        let theta_rate = (up.y * omega.x - up.x * omega.y) / sin;
        let shape = 0.5 * ACROSS * theta_rate * theta_rate + top.effective_potential(libm::atan2(sin, up.z));
        shape_error = larger(shape_error, (shape - energy_0).abs() / energy_0);
    }
    s.constant(HEAVY, "p_phi = L_Z is constant", vertical_error, 1e-14);
    s.constant(HEAVY, "p_psi = I3 w3 is constant", along_error, 1e-14);
    s.constant(HEAVY, "E is constant", energy_error, 1e-14);
    let text = "theta moves alone in an effective potential: I theta'^2/2 + V(theta) = E";
    s.constant(HEAVY, text, shape_error, 1e-13);
    let [upper, lower] = top.turning_points();
    for (tilt, which) in [(upper, "upper"), (lower, "lower")] {
        let (sin, cos) = libm::sincos(tilt);
        let off = vertical_0 - along_0 * cos;
        let potential =
            off * off / (2.0 * ACROSS * sin * sin) + along_0 * along_0 / (2.0 * ALONG) + WEIGHT * cos;
        let text = format!("the axis turns back where V(theta) = E: {which} tilt");
        s.number(HEAVY, text, [energy_0, potential], energy_0, 1e-14);
    }
    let rate = derivative(1.3, |t| top.point_at_dd(t).momentum_space());
    let now = top.point_at_dd(Dd::of(1.3));
    let axis = V::from(now.attitude.rotate(Vec3::unit(2)).0.map(Dd::hi));
    let torque = axis.cross(&V::new(0.0, 0.0, -WEIGHT));
    s.vector(HEAVY, "dL/dt = M R x g", [torque, rate * top.body().scale()], 1e-13);
    Ok(())
}

/// Largest 1 − cos θ on a stepped motion that starts at rest beside its spin, tilted by `tilt`.
fn largest_fall(spin: f64, tilt: f64) -> Result<f64, Error> {
    let body = body()?;
    let zxz: EulerSequence = "zxz".parse().map_err(unexpected)?;
    let start = body
        .enter_omega(zxz.attitude([0.0, tilt, 0.0]).into(), Vec3([0.0, 0.0, spin]))
        .map_err(unexpected)?;
    let h = 1.0 / 64.0;
    let mut x = start.to_f64();
    let method = method("kick-drift@suzuki-4").map_err(unexpected)?;
    let mut step = method.prepare_f64(Clock::new(h), &body).map_err(unexpected)?;
    // 1 - cos theta without cancellation
    let fall = |x: &polhode::body::Point<f64>| {
        let [_, a, b, _] = x.attitude.components();
        2.0 * (a * a + b * b)
    };
    let (mut before, mut now) = (fall(&x), fall(&x));
    for _ in 0..100_000 {
        step.steps(&mut x, 1);
        let next = fall(&x);
        if now > before && next <= now {
            // the parabola through three steps has its vertex at the turning point
            let bend = before - 2.0 * now + next;
            let slope = next - before;
            return Ok(now - slope * slope / (8.0 * bend));
        }
        (before, now) = (now, next);
    }
    Err(unexpected("the top does not turn back"))
}

/// The sleeping top, by stepping from a tilt that gets smaller and smaller.
fn asleep(s: &mut Statements) -> Result<(), Error> {
    let threshold = 4.0 * ACROSS * WEIGHT / (ALONG * ALONG);
    let smalls = || (4..10).map(|n| libm::exp2(-f64::from(n)));
    // 1 - cos of the start
    let raised = |tilt: f64| 2.0 * libm::sin(0.5 * tilt) * libm::sin(0.5 * tilt);

    let share = 0.75;
    let mut points = Vec::new();
    for small in smalls() {
        let computed = largest_fall(libm::sqrt(share * threshold), small)?;
        points.push(Point { small, formula: 2.0 * (1.0 - share), computed });
    }
    let text = "below the threshold an upright top falls over: 1 - cos theta reaches 2(1 - w3^2 I3^2/4IMgl)";
    s.limit(HEAVY, text, 2.0, points);

    let share = 1.25;
    let mut points = Vec::new();
    for small in smalls() {
        let computed = largest_fall(libm::sqrt(share * threshold), small)? / raised(small);
        points.push(Point { small, formula: share / (share - 1.0), computed });
    }
    let text = "above it stays upright: the largest 1 - cos theta is in proportion to that at the start";
    s.limit(HEAVY, text, 2.0, points);

    // between staying and falling: halving on w3^2
    let mut points = Vec::new();
    for small in smalls() {
        let limit = libm::sqrt(raised(small));
        let (mut falls, mut stays) = (0.5 * threshold, 2.0 * threshold);
        for _ in 0..24 {
            let half = 0.5 * (falls + stays);
            if largest_fall(libm::sqrt(half), small)? > limit { falls = half } else { stays = half }
        }
        points.push(Point { small, formula: threshold, computed: 0.5 * (falls + stays) });
    }
    let text = "the threshold between both, found from both sides: w3^2 = 4 I M g l / I3^2";
    s.limit(HEAVY, text, 1.0, points);
    Ok(())
}

/// Spins that double.
fn fast(s: &mut Statements) -> Result<(), Error> {
    let (tilt, alpha) = (1.1, 0.35);
    let (sin, cos) = libm::sincos(alpha);
    let (mut nutation, mut precession, mut released) = (Vec::new(), Vec::new(), Vec::new());
    for k in 3..9 {
        let size = 4.0 * libm::exp2(f64::from(k));
        let small = libm::exp2(-f64::from(k));
        // L in the plane of the axis and the vertical, off the axis by alpha
        let motion = top(tilt, V::new(0.0, size * sin / ACROSS, size * cos / ALONG))?;
        let (period, advance) = cycle(&motion)?;
        nutation.push(Point { small, formula: size / ACROSS, computed: core::f64::consts::TAU / period });
        precession.push(Point { small, formula: WEIGHT * cos / size, computed: advance / period });
        let motion = top(tilt, V::new(0.0, 0.0, size / ALONG))?;
        let (period, advance) = cycle(&motion)?;
        released.push(Point { small, formula: WEIGHT / size, computed: advance / period });
    }
    s.limit(HEAVY, "fast top: the axis goes round L at L/I (nutation)", 2.0, nutation);
    let text = "fast top: L goes round the vertical at M g l cos(alpha)/L, upwards for l > 0 (precession)";
    s.limit(HEAVY, text, 2.0, precession);
    let text = "fast top let go from rest: M g l/L (precession)";
    s.limit(HEAVY, text, 2.0, released);
    Ok(())
}

/// Period of nutation and the advance of the azimuth in it.
fn cycle(top: &LagrangeTop) -> Result<(f64, f64), Error> {
    let both = top.nutation_period().zip(top.precession_per_nutation());
    both.ok_or_else(|| unexpected("the top does not nod"))
}

/// The wheel of the catalogue, hung by one end of its axle, at its own spin and faster.
fn bicycle_wheel(s: &mut Statements) -> Result<(), Error> {
    let wheel =
        catalogue::top("bicycle-wheel").ok_or_else(|| unexpected("no bicycle wheel in the catalogue"))?;
    let body = wheel.body().map_err(unexpected)?;
    let [w, x, y, z] = wheel.attitude;
    let attitude = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(w, x, y, z));
    let along = wheel.inertia.principal_moments()[2];
    let mut points = Vec::new();
    for k in 0..6 {
        let spin = wheel.omega_body[2] * libm::exp2(f64::from(k));
        let motion = LagrangeTop::from_omega(&body, attitude, V::new(0.0, 0.0, spin)).map_err(unexpected)?;
        let (period, advance) = cycle(&motion)?;
        let formula = wheel.weight_moment[2] / (along * spin);
        points.push(Point { small: libm::exp2(-f64::from(k)), formula, computed: advance / period });
    }
    // of relative order (1/w3)^2 is cos(theta) I M g l/L^2, and the axle is level
    let text = "bicycle wheel hung by its level axle: goes round at M g l/L, the better the faster it spins";
    s.limit(HEAVY, text, 4.0, points);
    Ok(())
}
