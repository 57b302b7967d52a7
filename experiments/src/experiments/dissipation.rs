//! A tumbling body with inner friction relaxes to a steady spin: what the splitting keeps, its order, and the energy over time beside the
//! averaged law.
//!
//! # Averaged law
//! The energy of free motion, averaged over a period of the momentum, falls at the rate dE/dt = −δ ⟨|m × I⁻¹m|²⟩/|m|. The
//! mean is taken along the exact motion, by the trapezoidal rule over a whole period, which converges faster than any power; E then follows by
//! classical Runge–Kutta steps. Within a period the energy falls now faster, now slower than its mean, so that the law is followed to the
//! share of a period in the damping time.

use polhode::body::{Body, Clock, Point};
use polhode::catalogue;
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::schemes::{STRANG, SUZUKI_4, Scheme};
use polhode::method::{Dissipating, Splitting};
use polhode::num::{Dd, Precise, Real};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::run::Run;
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, Scale};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};
use crate::statistics::larger;

const BODIES: [&str; 3] = ["apophis", "toutatis", "textbook"];

/// Losses δ.
const LOSSES: [f64; 2] = [1e-2, 1e-3];

/// Steps of a radian that |m|/I of the largest moment turns.
const PER_RADIAN: f64 = 8.0;

/// Values of a mean over a period.
const VALUES: u32 = 64;

/// L is off by at most this after a run.
const KEPT: f64 = 1e-12;

/// A rise of the energy above its least value so far by more than this share is one.
const RISE: f64 = 1e-14;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut report = Report::default();
    orders(context, &mut report)?;
    kept(context, &mut report)?;
    averaged(context, &mut report)?;
    Ok(report)
}

/// A body with |m| = 1 whose momentum leans from the axis of the largest moment by `lean` rad, midway between the other two axes.
fn start(name: &str, lean: f64) -> Result<(Body, Point<Dd>), Error> {
    let named = catalogue::body(name).ok_or_else(|| unexpected("a body of the catalogue is missing"))?;
    let moments = named.inertia.principal_moments();
    let inertia = Inertia::from_moments(moments.map(|moment| moment / moments[2])).map_err(unexpected)?;
    let body = Body::free(inertia);
    let (sin, cos) = libm::sincos(lean);
    let across = libm::sqrt(0.5) * sin;
    let momentum = Vec3([across, across, cos]).map(Dd::of) * (Dd::ONE / body.scale());
    Ok((body, Point::new(Quat::identity(), momentum)))
}

type Method = Splitting<polhode::method::Palindrome<Dissipating>, polhode::method::Kicks>;

fn method(loss: f64, scheme: Scheme) -> Result<Method, Error> {
    let parts = Dissipating::new(loss).map_err(unexpected)?;
    Splitting::of_flows(parts, scheme).map_err(unexpected)
}

/// Attitude errors against much shorter steps of the scheme of order 4.
fn orders(context: &Context, report: &mut Report) -> Result<(), Error> {
    let mut table = Table::new(
        "orders",
        "Attitude errors of the splitting after 20 s, |m|/I = 1 rad/s of the largest moment, loss 0.05, against the scheme of order 4 with \
         steps of 1/1024 s.",
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("scheme", "", "of the splitting"),
            Column::new("h", "s", "step"),
            Column::new("attitude_error", "rad", "after 20 s").digits(3),
            Column::new("order", "", "by this step and the one before").digits(3),
        ],
    );
    let (loss, span) = (0.05, 20.0);
    for name in &BODIES[..context.scale.pick(1, 3, 3)] {
        let (body, point) = start(name, 1.2)?;
        let end = |scheme: Scheme, h: f64| -> Result<Point<Dd>, Error> {
            let method = method(loss, scheme)?;
            let run = Run::from_point(&method, &body, point.to_f64(), Clock::new(h));
            let sample = run.map_err(unexpected)?.advance_to((span / h) as u64).map_err(unexpected)?;
            Ok(sample.point.to_dd())
        };
        let exact = end(SUZUKI_4, 1.0 / 1024.0)?;
        for (scheme, name_of_scheme, claimed) in [(STRANG, "strang", 2.0), (SUZUKI_4, "suzuki-4", 4.0)] {
            let mut before: Option<f64> = None;
            for h in [0.5, 0.25, 0.125] {
                let error = rotation_angle(end(scheme, h)?.attitude, exact.attitude).to_f64();
                let order = before.map(|before| libm::log2(before / error));
                before = Some(error);
                table.push(row![*name, name_of_scheme, h, error, order]);
                if h == 0.125 {
                    report.checks += 1;
                    if order.is_none_or(|order| order.is_nan() || order < claimed - 0.3) {
                        let message =
                            format!("dissipation: {name}, {name_of_scheme}: order {order:?}, not {claimed}");
                        report.failures.push(message);
                    }
                }
            }
        }
    }
    report.tables.push(table);
    Ok(())
}

/// L and energy over very many steps.
fn kept(context: &Context, report: &mut Report) -> Result<(), Error> {
    let steps: u64 = context.scale.pick(20_000, 50_000, 10_000_000);
    let mut table = Table::new(
        "kept",
        format!("What is kept over {steps} steps of Strang's scheme."),
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("loss", "", "delta"),
            Column::new("momentum", "", "largest error of L in space, relative, looked at 1000 times")
                .digits(2),
            Column::new("rises", "", "looks at which the energy stands above its least so far"),
            Column::new("lean", "rad", "of the momentum from the axis of the largest moment, at the end")
                .digits(2),
        ],
    );
    let mut parts = Vec::new();
    for name in BODIES {
        for loss in LOSSES {
            parts.push((name, loss));
        }
    }
    let found = context.in_parallel(parts.clone(), |(name, loss)| -> Result<(f64, u64, f64), Error> {
        let (body, point) = start(name, 1.2)?;
        let method = method(loss, STRANG)?;
        let run = Run::from_point(&method, &body, point.to_f64(), Clock::new(1.0 / PER_RADIAN));
        let mut run = run.map_err(unexpected)?;
        let space = point.momentum_space();
        let (mut momentum, mut least, mut rises) = (0.0_f64, f64::INFINITY, 0_u64);
        for look in 1..=1000 {
            let sample = run.advance_to(steps / 1000 * look).map_err(unexpected)?;
            let far = (sample.point.to_dd().momentum_space() - space).norm() / space.norm();
            momentum = larger(momentum, far.to_f64());
            let energy = body.energy(&sample.state);
            rises += u64::from(energy.is_nan() || energy > least * (1.0 + RISE));
            least = least.min(energy);
        }
        let end = run.advance_to(steps / 1000 * 1000).map_err(unexpected)?;
        let m = end.point.momentum_body;
        Ok((momentum, rises, libm::atan2(libm::hypot(m[0], m[1]), m[2].abs())))
    });
    for ((name, loss), found) in parts.into_iter().zip(found) {
        let (momentum, rises, lean) = found?;
        table.push(row![name, loss, momentum, rises, lean]);
        report.checks += 2;
        if momentum.is_nan() || momentum > KEPT {
            report.failures.push(format!("dissipation: {name}: L is off by {momentum:e}"));
        }
        if rises > 0 {
            report.failures.push(format!("dissipation: {name}: the energy rose at {rises} looks"));
        }
    }
    report.tables.push(table);
    Ok(())
}

/// The mean of |m × I⁻¹m|² over a period, for |m| = 1 and this energy over that of the steady spin.
fn loss_of(body: &Body, ratio: f64) -> Result<f64, Error> {
    let [small, middle, large] = body.inertia().principal_moments();
    // short-axis mode: in the plane of the largest and the smallest axis
    let share = (ratio / large - 1.0 / large) / (1.0 / small - 1.0 / large);
    let (sin, cos) = (libm::sqrt(share), libm::sqrt(1.0 - share));
    let momentum = Vec3([sin, 0.0, cos]).map(Dd::of) * (Dd::ONE / body.scale());
    let motion = FreeMotion::from_point(body.inertia(), Point::new(Quat::identity(), momentum));
    let period = motion.character().map_err(unexpected)?.polhode_period;
    let period = period.ok_or_else(|| unexpected("the motion has no period"))?;
    let mut sum = 0.0;
    for k in 0..VALUES {
        let state = motion.at(period * f64::from(k) / f64::from(VALUES)).map_err(unexpected)?;
        let m = state.momentum_body.0;
        let omega = [m[0] / small, m[1] / middle, m[2] / large];
        sum += Vec3(m).cross(Vec3(omega)).norm_squared();
    }
    Ok(sum / f64::from(VALUES))
}

/// Energies over time beside the averaged law.
fn averaged(context: &Context, report: &mut Report) -> Result<(), Error> {
    let mut table = Table::new(
        "averaged",
        "Energy above that of the steady spin, simulated and by the averaged law, and the time in which it falls by a factor of e.",
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("loss", "", "delta"),
            Column::new("times", "", "compared"),
            Column::new("deviation", "", "largest |simulated/averaged - 1|").digits(2),
            Column::new("period", "", "of the momentum at the start, over the damping time").digits(2),
            Column::new(
                "damping",
                "s",
                "simulated, over the last third; |m|/I = 1 rad/s of the largest moment",
            )
            .digits(4),
            Column::new("expected", "s", "1/(delta |m| (1/I_1 + 1/I_2 - 2/I_3))").digits(4),
        ],
    );
    let mut figure = Figure::new(
        "dissipation",
        "Energy of tumbling bodies with inner friction above that of the steady spin: points simulated, lines by the averaged law",
        ("time times loss (s)", Scale::Linear),
        ("E/E_0 - 1", Scale::Log),
    );
    let count = context.scale.pick(12, 30, 60);
    let mut worst = 0.0_f64;
    for (number, name) in BODIES[..context.scale.pick(1, 3, 3)].iter().enumerate() {
        for loss in LOSSES {
            let (body, point) = start(name, 0.35)?;
            let [small, middle, large] = body.inertia().principal_moments();
            let expected = 1.0 / (loss * (1.0 / small + 1.0 / middle - 2.0 / large));
            let h = 1.0 / PER_RADIAN;
            let every = (4.0 * expected / f64::from(count) / h) as u64;
            let method = method(loss, STRANG)?;
            let run = Run::from_point(&method, &body, point.to_f64(), Clock::new(h));
            let mut run = run.map_err(unexpected)?;
            let steady = 0.5 / large;
            let above = |energy: f64| energy / steady - 1.0;
            let free = FreeMotion::from_point(body.inertia(), point);
            let period = free.character().map_err(unexpected)?.polhode_period.unwrap_or(f64::NAN);
            let mut ratio = above(body.energy(&body.leave(&point)));
            let (mut drawn, mut line, mut deviation) = (Vec::new(), Vec::new(), 0.0_f64);
            for k in 1..=count {
                let sample = run.advance_to(every * u64::from(k as u32)).map_err(unexpected)?;
                let found = above(body.energy(&sample.state));
                let rate =
                    |ratio: f64| -> Result<f64, Error> { Ok(-loss * loss_of(&body, 1.0 + ratio)? / steady) };
                let interval = every as f64 * h;
                let a = rate(ratio)?;
                let b = rate(ratio + 0.5 * interval * a)?;
                let c = rate(ratio + 0.5 * interval * b)?;
                let d = rate(ratio + interval * c)?;
                ratio += interval / 6.0 * (a + 2.0 * (b + c) + d);
                let off = (found / ratio - 1.0).abs();
                deviation = larger(deviation, off);
                let t = loss * interval * f64::from(k as u32);
                drawn.push((t, found));
                line.push((t, ratio));
            }
            let (first, last) = (drawn[2 * drawn.len() / 3], drawn[drawn.len() - 1]);
            let damping = (last.0 - first.0) / loss / libm::log(first.1 / last.1);
            table.push(row![*name, loss, count as u64, deviation, period / expected, damping, expected]);
            report.checks += 1;
            // NaN included
            if deviation.partial_cmp(&(period / expected)).is_none_or(|order| order.is_gt()) {
                report
                    .failures
                    .push(format!("dissipation: {name}, loss {loss}: off the averaged law by {deviation:e}"));
            }
            if loss == LOSSES[LOSSES.len() - 1] {
                worst = worst.max(deviation);
            }
            if loss == LOSSES[0] {
                figure.series.push(Curve::new(format!("{name}, averaged"), line).plain().coloured(number));
                figure.series.push(Curve::new(format!("{name}, loss {loss}"), drawn).dots().coloured(number));
            }
        }
    }
    report.conclusion = format!(
        "a body with inner friction keeps L to rounding and its energy never rises; with a loss of {} its energy follows the averaged law \
         to {worst:.1e}",
        LOSSES[LOSSES.len() - 1]
    );
    report.figures.push(figure);
    report.tables.push(table);
    Ok(())
}
