//! Section 17.4: the free top.

use nalgebra::Vector3;
use polhode::body::Time;
use polhode::catalogue;
use polhode::flow::FreeMotion;
use polhode::num::elliptic::Modulus;
use polhode::num::{Dd, Real};
use polhode_files::error::Error;

use super::{Point, Statements, free_motion, second_derivative, unexpected};
use crate::statistics::larger;

const FREE: &str = "17.4";
const MOMENTS: [f64; 3] = [1.0, 2.0, 3.0];

type V = Vector3<f64>;

pub(super) fn statements(s: &mut Statements) -> Result<(), Error> {
    conserved(s)?;
    constant(s)?;
    for axis in 0..3 {
        next_to_axis(s, axis)?;
    }
    flips(s)
}

/// The largest relative error of energy and of L in space, over a thousand radians of every body of the catalogue without wheels.
fn conserved(s: &mut Statements) -> Result<(), Error> {
    let (mut energy_error, mut momentum_error) = (0.0_f64, 0.0_f64);
    for named in catalogue::bodies().into_iter().filter(|named| named.wheels.is_empty()) {
        let omega = V::from(named.omega_body);
        let free = FreeMotion::from_omega(&named.inertia, Default::default(), omega).map_err(unexpected)?;
        let body = free.body();
        let (start, at) = (free.point_at(0.0), Time::from_seconds(0.0));
        let (energy, momentum) = (body.energy_of(at, &start).hi(), V::from(start.momentum_space()));
        for k in 1..=1000 {
            let now = free.point_at(f64::from(k) / omega.norm());
            energy_error = larger(energy_error, (body.energy_of(at, &now).hi() / energy - 1.0).abs());
            let off = V::from(now.momentum_space()) - momentum;
            momentum_error = larger(momentum_error, off.norm() / momentum.norm());
        }
    }
    s.constant(FREE, "E of a free body is constant", energy_error, 1e-14);
    s.constant(FREE, "L of a free body is constant in space", momentum_error, 1e-14);
    Ok(())
}

/// Bodies whose angular velocity stays.
fn constant(s: &mut Statements) -> Result<(), Error> {
    let mut stays = |text: String, moments: [f64; 3], omega: V| -> Result<(), Error> {
        let free = free_motion(moments, omega)?;
        let mut worst = 0.0_f64;
        for k in 1..=200 {
            let now = free.omega_at(5.0 * f64::from(k)).map_err(unexpected)?;
            worst = larger(worst, (now - omega).norm() / omega.norm());
        }
        s.constant(FREE, text, worst, 1e-15);
        Ok(())
    };
    stays("a spherical top keeps w, whatever its direction".into(), [2.0; 3], V::new(0.4, 1.0, -0.3))?;
    for axis in 0..3 {
        let text = format!("a spin about the principal axis {} stays for ever", axis + 1);
        stays(text, MOMENTS, V::ith(axis, 1.0))?;
    }
    Ok(())
}

/// What becomes of a spin about a principal axis when it is a little off.
fn next_to_axis(s: &mut Statements, axis: usize) -> Result<(), Error> {
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let [a, b, c] = [axis, j, k].map(|i| MOMENTS[i]);
    let squared = (a - c) * (a - b) / (b * c);
    let stable = squared > 0.0;
    let about = ["smallest", "middle", "largest"][axis];
    let perturbed = |small: f64| {
        let mut omega = V::ith(axis, 1.0);
        omega[j] = small;
        free_motion(MOMENTS, omega)
    };
    let smalls = || (6..12).map(|n| libm::exp2(-f64::from(n)));

    // q'' = -Omega^2 q, at a time when neither component is zero
    for i in [j, k] {
        let mut points = Vec::new();
        for small in smalls() {
            let free = perturbed(small)?;
            let t = 0.75;
            let momentum = |t: Dd| free.point_at_dd(t).momentum_body;
            let ratio = second_derivative(t, momentum)[i] / momentum(Dd::of(t))[i].hi();
            points.push(Point { small, formula: squared, computed: -ratio });
        }
        let text = format!("next to the axis of the {about} moment w{}'' = -Omega^2 w{}", i + 1, i + 1);
        s.limit(FREE, text, 2.0, points);
    }

    let rate = libm::sqrt(squared.abs());
    let mut points = Vec::new();
    for small in smalls() {
        let free = perturbed(small)?;
        let computed = if stable {
            let period = free.character().map_err(unexpected)?.polhode_period;
            core::f64::consts::TAU / period.ok_or_else(|| unexpected("no period"))?
        } else {
            // from rest in the other component, w_j grows as cosh
            let t = 2.0;
            let grown =
                free.point_at_dd(Dd::of(t)).momentum_body[j] / free.point_at_dd(Dd::ZERO).momentum_body[j];
            libm::acosh(grown.hi()) / t
        };
        points.push(Point { small, formula: rate, computed });
    }
    let what = if stable {
        "it swings with the frequency Omega: stable"
    } else {
        "it grows at the rate |Omega|: unstable"
    };
    s.limit(FREE, format!("next to the axis of the {about} moment {what}"), 2.0, points);
    Ok(())
}

/// The body that turns over: intervals between flips in closed form, evaluated without cancellation.
fn flips(s: &mut Statements) -> Result<(), Error> {
    for (omega, mode) in [(V::new(0.01, 1.0, 0.02), "short-axis"), (V::new(0.02, 1.0, 0.01), "long-axis")] {
        let free = free_motion(MOMENTS, omega)?;
        let [i1, i2, i3] = MOMENTS;
        let [w1, w2, w3] = [omega.x, omega.y, omega.z].map(|w| w * w);
        // |L|^2 - 2 E I_1, 2 E I_3 - |L|^2 and |L|^2 - 2 E I_2
        let above = i2 * (i2 - i1) * w2 + i3 * (i3 - i1) * w3;
        let below = i1 * (i3 - i1) * w1 + i2 * (i3 - i2) * w2;
        let apart = i1 * (i1 - i2) * w1 + i3 * (i3 - i2) * w3;
        let fast = if apart > 0.0 { (i3 - i2) * above } else { (i2 - i1) * below };
        let complement = (i3 - i1) * apart.abs() / fast;
        let rate = libm::sqrt(fast / (i1 * i2 * i3));
        let quarter = Modulus::new(complement).quarter_period();
        let zeros = zeros(&free, 4.0 * quarter / rate)?;
        let formula = 2.0 * quarter / rate;
        let text = format!("{mode} mode: the body flips every 2K/nu");
        s.number(FREE, text, [formula, zeros[1] - zeros[0]], formula, 1e-14);
        let text = format!("{mode} mode: and is back on its polhode after 4K/nu");
        let (start, back) = (free.point_at_dd(Dd::ZERO), free.point_at_dd(Dd::of(2.0 * formula)));
        let off = V::from((back.momentum_body - start.momentum_body).0.map(Dd::hi));
        let period = 2.0 * (zeros[1] - zeros[0]);
        s.exact(
            FREE,
            text,
            [2.0 * formula, period, off.norm() / V::from(start.momentum_body.0.map(Dd::hi)).norm()],
            1e-14,
        );
    }
    Ok(())
}

/// The first two times at which the momentum along the middle axis changes sign, within `span`.
fn zeros(free: &FreeMotion, span: f64) -> Result<[f64; 2], Error> {
    let middle = |t: Dd| free.point_at_dd(t).momentum_body[1].hi();
    let mut found = Vec::new();
    let steps = 64;
    for k in 0..steps {
        let at = |k: i32| Dd::of(span) * (f64::from(k) / f64::from(steps));
        let (mut low, mut high) = (at(k), at(k + 1));
        let sign = middle(low).is_sign_negative();
        if middle(high).is_sign_negative() == sign {
            continue;
        }
        for _ in 0..64 {
            let half = (low + high) * 0.5;
            if middle(half).is_sign_negative() == sign { low = half } else { high = half }
        }
        found.push(low.hi());
    }
    match found.as_slice() {
        [first, second, ..] => Ok([*first, *second]),
        _ => Err(unexpected("the body does not flip")),
    }
}
