//! How fast shift and twist will grow, in two further ways: from closed leading terms, and from the errors of single steps.

use polhode::body::{Clock, Point};
use polhode::flow::FreeMotion;
use polhode::method::{AnyMethod, AxisOrder, TwoAxes};
use polhode::num::{Dd, Real};
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::{Error, unexpected};

use super::Rates;

/// Nodes and weights of Gauss and Legendre on (−1, 1).
const NODES: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Rates from the mean error of one step over one period of the momentum.
///
/// The error of a step from the exact point of the time s is carried back to the start by the exact motion. In this way the
/// start moves with every step, and the run is the exact motion of the start that has moved (variation of constants). What
/// moves it along the orbit is a shift in time, what turns it about L is the twist; a change of the energy averages to zero
/// over a period where the method keeps the energy within bounds, and what it does to the period is in what is carried back.
/// To first order in the errors of a step, of any method and order.
pub(super) fn from_steps(
    motion: &FreeMotion,
    start: &Point<Dd>,
    method: &dyn AnyMethod,
    h: f64,
    panels: u32,
) -> Result<Rates, Error> {
    let body = motion.body();
    let period = motion.character().map_err(unexpected)?.polhode_period.unwrap_or(0.0);
    let mut step = method.prepare_dd(Clock::new(h), body).map_err(unexpected)?;
    let width = period / f64::from(panels);
    let (mut momentum, mut turn) = (Vec3::<Dd>::zero(), Vec3::<Dd>::zero());
    let mut add = |s: f64, weight: f64| {
        let exact = motion.point_at_dd(Dd::of(s));
        let mut after = Point::new(exact.attitude, exact.momentum_body);
        step.steps(&mut after, 1);
        let back = -(Dd::of(s) + Dd::of(h));
        let moved = FreeMotion::from_point(body.inertia(), after).point_at_dd(back);
        momentum = momentum + (moved.momentum_body - start.momentum_body) * Dd::of(weight);
        turn = turn + turn_in_space(start.attitude, moved.attitude) * Dd::of(weight);
    };
    for panel in 0..panels {
        for (node, weight) in NODES {
            let s = width * (f64::from(panel) + 0.5 + 0.5 * node);
            add(s, 0.5 * weight / f64::from(panels) / h);
        }
    }
    // the integral stands for a sum over steps (Euler and Maclaurin): what a change of the energy does later grows with time,
    // so that the ends of the period differ
    add(0.0, 0.5 / period);
    add(period, -0.5 / period);
    let inverse: Vec3<Dd> = body.rotor().inverse_moments();
    let omega = start.momentum_body.times(inverse);
    let speed = start.momentum_body.cross(omega);
    let shift = momentum.dot(speed) / speed.norm_squared();
    let axis = start.momentum_space();
    let twist = (turn - start.attitude.rotate(omega) * shift).dot(axis) / axis.norm();
    Ok(Rates { shift: shift.hi(), twist: twist.hi() })
}

/// The vector of the turn in space that takes the attitude `from` to `to`: its axis times twice the sine of half its angle.
fn turn_in_space(from: Quat<Dd>, to: Quat<Dd>) -> Vec3<Dd> {
    let turn = to * from.conjugate();
    turn.v * Dd::of(if turn.w.hi() < 0.0 { -2.0 } else { 2.0 })
}

/// Rates from the leading term in closed form, where there is one.
///
/// A splitting: the averaged h² term of the modified energy. The discrete Moser–Veselov map with the moments J moves a body
/// exactly whose moments are `1/J = s/I + d`: the clock runs by 1/s, and the rest is a turn about L at the rate −(d/s)|m|. In
/// `rattle` J = I, so that the leading terms of s and d stand for the error themselves; `dmv:4` lacks the next ones (Hairer
/// and Vilmart, J. Phys. A 39 (2006) 13225).
pub(super) fn in_closed_form(name: &str, start: &Point<Dd>, moments: Vec3<f64>, h: f64) -> Option<Rates> {
    let m = start.momentum_body.map(Dd::hi);
    let split = match name.split_once(':') {
        Some(("two-turn", axes)) => axes.parse::<TwoAxes>().ok()?.phase_error_rates(m, moments),
        Some(("lie-poisson", order)) => order.parse::<AxisOrder>().ok()?.phase_error_rates(m, moments),
        _ => None,
    };
    if let Some(rates) = split {
        return Some(Rates { shift: rates.shift * h * h, twist: rates.twist * h * h });
    }
    let [a, b, c] = moments.0;
    let (delta, s1) = (a * b * c, a + b + c);
    let s2 = a * a + b * b + c * c;
    let (x1, x2) = (1.0 / a + 1.0 / b + 1.0 / c, 1.0 / (a * a) + 1.0 / (b * b) + 1.0 / (c * c));
    let m11 = (a + b) / c + (b + c) / a + (c + a) / b;
    let (x, y) =
        (0.5 * h * h * m.norm_squared(), 0.5 * h * h * (m[0] * m[0] / a + m[1] * m[1] / b + m[2] * m[2] / c));
    let (s, d) = match name {
        "rattle" => (s1 / (6.0 * delta) * x - x1 / 3.0 * y, -x / (3.0 * delta) + s1 / (6.0 * delta) * y),
        "dmv:4" => (
            (s2 / delta - x1) / (30.0 * delta) * x * x
                + (1.0 - m11) / (30.0 * delta) * x * y
                + (3.0 * s1 / delta + 2.0 * x2) / 60.0 * y * y,
            -s1 / (60.0 * delta * delta) * x * x
                + (x1 / (10.0 * delta) - s2 / (60.0 * delta * delta)) * x * y
                - (9.0 + m11) / (60.0 * delta) * y * y,
        ),
        _ => return None,
    };
    Some(Rates { shift: -s, twist: -d * m.norm() })
}
