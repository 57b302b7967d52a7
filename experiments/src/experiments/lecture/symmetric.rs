//! Section 17.5: the free symmetric top.

use nalgebra::{Unit, UnitQuaternion, Vector3};
use polhode::body::State;
use polhode::num::{Dd, Real};
use polhode_files::error::Error;

use super::{Point, Statements, free_motion, second_derivative, unexpected};
use crate::statistics::larger;

const SYMMETRIC: &str = "17.5";

/// A phase of a hundred radians, in `f64`.
const PHASE: f64 = 1e-13;

type V = Vector3<f64>;

pub(super) fn statements(s: &mut Statements) -> Result<(), Error> {
    body_cone(s, "prolate", 2.0, 0.5)?;
    body_cone(s, "oblate", 1.0, 1.75)?;
    wobbling_plate(s)
}

/// Largest value over a hundred seconds.
fn worst(of: impl Fn(f64) -> Result<f64, Error>) -> Result<f64, Error> {
    (1..=400).try_fold(0.0_f64, |worst, k| Ok(larger(worst, of(0.25 * f64::from(k))?)))
}

fn body_cone(s: &mut Statements, kind: &str, across: f64, along: f64) -> Result<(), Error> {
    let (omega, spin) = (0.6, 1.25);
    let free = free_motion([across, across, along], V::new(omega, 0.0, spin))?;
    let now = |t: f64| free.omega_at(t).map_err(unexpected);
    let off = worst(|t| Ok((now(t)?.z / spin - 1.0).abs()))?;
    s.constant(SYMMETRIC, format!("{kind}: w3 is constant"), off, 1e-15);

    // where neither component is zero
    let t = 0.8;
    let momentum = |t: Dd| free.point_at_dd(t).momentum_body;
    let accelerations = second_derivative(t, momentum);
    let squared = (across - along) / across * ((across - along) / across) * spin * spin;
    for axis in 0..2 {
        let computed = -accelerations[axis] / momentum(Dd::of(t))[axis].hi();
        let text = format!("{kind}: w{0}'' = -(I - I3)^2/I^2 w3^2 w{0}", axis + 1);
        s.number(SYMMETRIC, text, [squared, computed], squared, PHASE)
            .note("printed with w3 where w3^2 stands here");
    }

    let rate = (across - along).abs() / across * spin;
    let sense = if across > along { -1.0 } else { 1.0 };
    let traced = worst(|t| {
        let (sin, cos) = libm::sincos(rate * t);
        let off = now(t)? - V::new(omega * cos, sense * omega * sin, spin);
        Ok(off.norm() / omega)
    })?;
    let way = if sense < 0.0 { "clockwise" } else { "counter-clockwise" };
    let text = format!("{kind}: w goes round the body cone {way} at Omega = |I - I3|/I w3");
    let quarter = core::f64::consts::FRAC_PI_2 / rate;
    let after = now(quarter)?;
    let computed = libm::atan2(sense * after.y, after.x) / quarter;
    s.exact(SYMMETRIC, text, [rate, computed, traced], PHASE);

    // in space: the axis goes round L
    let state = |t: f64| free.at(t).map_err(unexpected);
    let start = state(0.0)?;
    let momentum = start.rotation() * start.momentum();
    let axis = |x: State| x.rotation() * V::z();
    let tilt = |t: f64| -> Result<f64, Error> {
        let axis = axis(state(t)?);
        Ok(libm::atan2(axis.cross(&momentum).norm(), axis.dot(&momentum)))
    };
    let theta = tilt(0.0)?;
    let nods = worst(|t| Ok((tilt(t)? - theta).abs()))?;
    let formula = libm::atan2(across * omega, along * spin);
    let text = format!("{kind}: theta' = 0, the axis keeps its angle to L");
    s.exact(SYMMETRIC, text, [formula, theta, larger(nods, (theta - formula).abs())], 1e-14);
    let precession = momentum.norm() / across;
    let about = Unit::new_normalize(momentum);
    let off = worst(|t| {
        let turned = UnitQuaternion::from_axis_angle(&about, precession * t) * axis(start);
        Ok((axis(state(t)?) - turned).norm())
    })?;
    // what the library reads off the motion
    let computed = free.character().map_err(unexpected)?.precession_rate;
    let computed = computed.ok_or_else(|| unexpected("no precession"))?;
    let text = format!("{kind}: phi' = L/I, the axis goes round L");
    s.exact(SYMMETRIC, text, [precession, computed, larger(off, (computed / precession - 1.0).abs())], PHASE);
    let (sin, cos) = libm::sincos(theta);
    let text = format!("{kind}: w across the axis is phi' sin theta = L sin theta / I");
    s.number(SYMMETRIC, text, [precession * sin, omega], omega, 1e-15);
    let text = format!("{kind}: w3 = L cos theta / I3");
    s.number(SYMMETRIC, text, [momentum.norm() * cos / along, spin], spin, 1e-15);
    Ok(())
}

/// A plate thrown with a little wobble.
fn wobbling_plate(s: &mut Statements) -> Result<(), Error> {
    let mut points = Vec::new();
    for k in 2..10 {
        let small = libm::exp2(-f64::from(k));
        let (sin, cos) = libm::sincos(small);
        // I = 1, I3 = 2 and |L| = 2
        let free = free_motion([1.0, 1.0, 2.0], V::new(2.0 * sin, 0.0, cos))?;
        let (t, axis) = (0.5, |x: State| x.rotation() * V::z());
        let (start, later) = (free.at(0.0).map_err(unexpected)?, free.at(t).map_err(unexpected)?);
        let momentum = (start.rotation() * start.momentum()).normalize();
        // the azimuths about L of the axis then and now
        let [from, to] = [axis(start), axis(later)].map(|a| a - momentum * a.dot(&momentum));
        let turned = libm::atan2(momentum.dot(&from.cross(&to)), from.dot(&to));
        points.push(Point {
            small,
            formula: 2.0,
            computed: turned / t / free.omega_at(t).map_err(unexpected)?.z,
        });
    }
    s.limit(SYMMETRIC, "a plate wobbles twice as fast as it spins: phi'/w3 -> 2 as theta -> 0", 2.0, points);
    Ok(())
}
