//! How long a run next to the separatrix turns over when it should: the time until its first wrong flip.
//!
//! Next to the separatrix the body lingers about its middle axis and then turns over, at intervals that grow as ln (1/k'²).
//! A flip is wrong when their number differs from that of the exact motion half-way between two of its flips, or when the body
//! turns over the other way: its momentum leaves the side of the separatrix on which it began.
//!
//! The separatrix of the momentum is two planes through the origin, and the motion keeps each. A Runge–Kutta method keeps every
//! linear subspace that the motion keeps, so that it cannot cross, whatever its energy does; nor can a method that keeps energy
//! and |m|. A splitting has a separatrix of its own, off by the size of its error, and crosses this one next to it.

use polhode::body::{Body, Clock, Point};
use polhode::catalogue;
use polhode::flow::FreeMotion;
use polhode::method::{AnyMethod, Claimed, method};
use polhode::num::{Dd, Random, Real};
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Run, RunError};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, ten_to};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};
use crate::timing::StepTime;

/// Bodies of the catalogue: of three quite different moments, a needle, and a body that is nearly a ball.
const BODIES: [&str; 3] = ["textbook", "racket", "spacecraft"];
/// Rate of turning about the middle axis, rad/s.
const RATE: f64 = 2.0;
const SEED: u64 = 1850;
const METHODS: [&str; 10] = [
    "rk4",
    "rk8",
    "implicit-midpoint",
    "rattle",
    "dmv:10",
    "lie-poisson",
    "two-turn",
    "two-turn@blanes-moan-s6",
    "momentum-euler",
    "exact-step",
];
/// Steps, s.
const STEPS: [f64; 4] = [1.0 / 2.0, 1.0 / 4.0, 1.0 / 8.0, 1.0 / 16.0];
/// The step of rk4 whose cost the figure gives to every method.
const BUDGET: f64 = STEPS[2];

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let horizon = context.scale.pick(500.0, 5_000.0, 20_000.0);
    let members = context.scale.pick(4, 10, 24);
    let decades: &[i32] = context.scale.pick(&[-2, -6], &[-2, -4, -6, -8, -10], &[-2, -4, -6, -8, -10]);
    let steps = context.scale.pick(&STEPS[1..3], &STEPS[..], &STEPS[..]);
    let bodies = &BODIES[..context.scale.pick(1, 1, BODIES.len())];
    let mut parts = Vec::new();
    for body in bodies {
        for name in METHODS {
            for h in steps {
                for decade in decades {
                    parts.push((*body, name, *h, *decade));
                }
            }
        }
    }
    let found = context
        .in_parallel(parts.clone(), |(body, name, h, decade)| {
            let body = named(body)?;
            (0..members).map(|member| first_wrong(&body, name, h, decade, member, horizon)).collect()
        })
        .into_iter()
        .collect::<Result<Vec<Vec<Outcome>>, Error>>()?;

    let caption = format!(
        "Time until the first wrong flip next to the separatrix, at {RATE} rad/s about the middle axis, {members} random starts on \
         both sides for each distance, up to {horizon} s."
    );
    let mut table = Table::new("separatrix", caption, columns());
    let mut medians = Vec::new();
    for ((body, name, h, decade), mut outcomes) in parts.into_iter().zip(found) {
        outcomes.sort_by(|a, b| a.time.total_cmp(&b.time));
        let quantile = |share: f64| outcomes[(share * (members - 1) as f64 + 0.5) as usize];
        let right = outcomes.iter().filter(|outcome| outcome.right).count() as u64;
        let lost = outcomes.iter().filter(|outcome| outcome.other_way).count() as u64;
        let [low, median, high] = [0.1, 0.5, 0.9].map(quantile);
        let order =
            method(name).map_err(unexpected)?.claims(polhode::body::Problem::Free).and_then(|c| c.order);
        table.push(row![
            body,
            name,
            order.map(u64::from),
            h,
            ten(decade),
            members,
            right,
            lost,
            low.time,
            median.time,
            high.time,
            horizon,
            median.flips,
        ]);
        if body == BODIES[0] {
            medians.push((name, h, decade, low.time, median.time, high.time));
        }
    }
    let caption = format!("The same at k'² = {}.", ten_to(-6));
    let view = table.view("separatrix-1e-6", caption, &["k'2"], ("complement", "1e-6"));

    let costs = METHODS.map(|name| step_time(name).map(|ns| (name, ns)));
    let costs = costs.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let rk4 = costs.first().map_or(1.0, |cost| cost.1);
    let mut timing = Table::new(
        "timing",
        "Time of a step, and the step at which a method costs nearest to what rk4 costs at 1/8 s; textbook body.",
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("step_ns", "ns", "least time of a step over several bursts").heading("ns/step"),
            Column::new("ratio", "", "the same over that of rk4").heading("over rk4").digits(2),
            Column::new("h", "s", "step of equal cost, in the figure").digits(3),
        ],
    );
    let title = format!(
        "Time until the first wrong flip at nearly equal cost (of four steps the one nearest to rk4 with 1/8 s), {} body: medians of {members} \
         starts, bars from 10 to 90 %, runs of {horizon} s",
        BODIES[0]
    );
    let mut figure = Figure::log_log("separatrix", title, "distance to the separatrix, k'²", "time (s)");
    figure.level("end of the runs", horizon);
    for (name, ns) in costs {
        let apart = |h: f64| libm::log(ns / h / (rk4 / BUDGET)).abs();
        let Some(h) = steps.iter().copied().min_by(|a, b| apart(*a).total_cmp(&apart(*b))) else { continue };
        timing.push(row![name, ns, ns / rk4, h]);
        let mut rows: Vec<_> = medians.iter().filter(|row| row.0 == name && row.1 == h).collect();
        rows.sort_by_key(|row| row.2);
        let points = rows.iter().map(|row| (ten(row.2), row.4)).collect();
        let bars = rows.iter().map(|row| (row.3, row.5)).collect();
        figure.series.push(Curve::new(format!("{name}, 1/{} s", 1.0 / h), points).with_spread(bars));
    }
    Ok(Report {
        tables: vec![table],
        views: vec![view],
        figures: vec![figure],
        timing: Some(timing),
        seed: Some(SEED),
        ..Report::default()
    })
}

/// The axes of the least, the middle and the largest moment.
pub(super) fn ascending(moments: Vec3<f64>) -> [usize; 3] {
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
    axes
}

pub(super) fn ten(power: i32) -> f64 {
    // the nearest double, as a reader writes it
    format!("1e{power}").parse().unwrap_or(0.0)
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("body", "", "name in the catalogue of bodies"),
        Column::new("method", "", "name in the catalogue"),
        Column::new("order", "", "order of convergence; empty where the steps are exact"),
        Column::new("h", "s", "step").latex("$h$").digits(3),
        Column::new("complement", "", "k'² of the start: its distance to the separatrix")
            .heading("k'²")
            .latex("$k'^2$"),
        Column::new("starts", "", "random starts").hidden(),
        Column::new("right", "", "starts of which no flip was wrong to the end"),
        Column::new(
            "other_way",
            "",
            "starts that turned over the other way: they had crossed the separatrix",
        )
        .heading("crossed"),
        Column::new(
            "time_p10",
            "s",
            "time of the first wrong flip, or of the end: 10 % of the starts are below",
        )
        .heading("10 %")
        .digits(3),
        Column::new("time_median", "s", "the same: half of the starts").heading("median").digits(3),
        Column::new("time_p90", "s", "the same: 90 % of the starts").heading("90 %").digits(3),
        Column::new("end", "s", "time at which the runs end").hidden(),
        Column::new("flips_median", "", "exact flips until the median time").heading("flips"),
    ]
}

/// The body called `name`, free.
fn named(name: &str) -> Result<Body, Error> {
    let named = catalogue::body(name).ok_or_else(|| unexpected("no such body in the catalogue"))?;
    Ok(Body::free(named.inertia))
}

/// What became of one start.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    /// Of the first wrong flip, or of the end, s.
    time: f64,
    /// Exact flips until then.
    flips: u64,
    right: bool,
    other_way: bool,
}

/// A start at a random time of the motion at the distance k'² = 10^`decade`, long-axis mode or short-axis mode in turn, and how
/// long after half a flip it begins.
fn start(body: &Body, decade: i32, member: u64) -> Result<(Point<f64>, f64), Error> {
    near(body, decade, member, RATE, Random::new(SEED).stream(member))
}

/// The same of a body that turns about its middle axis at `rate` rad/s, with random numbers of the caller's.
pub(super) fn near(
    body: &Body,
    decade: i32,
    member: u64,
    rate: f64,
    mut random: Random,
) -> Result<(Point<f64>, f64), Error> {
    let moments: Vec3<f64> = body.rotor().moments();
    let [least, b, largest] = ascending(moments);
    let [a, c] = if member.is_multiple_of(2) { [largest, least] } else { [least, largest] };
    let (ia, ib, ic) = (moments[a], moments[b], moments[c]);
    // where m_c = 0 the momentum is next to the middle axis, and dn = k'; worked out for |m| = 1
    let complement = ten(decade);
    let square = (1.0 - complement) * (ib - ia);
    let twice_energy = (square + (ic - ib)) / (square * ic + ia * (ic - ib));
    let along = (complement * ia * (1.0 - twice_energy * ic) / (ia - ic)).sqrt();
    let norm = rate * ib;
    let sign = |x: f64| if x < 0.5 { -norm } else { norm };
    let mut m = Vec3::zero();
    (m[a], m[b]) = (sign(random.uniform()) * along, sign(random.uniform()) * (1.0 - along * along).sqrt());
    let saddle = Point::new(Quat::identity(), m);
    let motion = FreeMotion::from_point(body.inertia(), saddle.to_dd());
    let period = motion.character().map_err(unexpected)?.polhode_period.unwrap_or(1.0);
    let begun = random.uniform() * 0.5 * period;
    Ok((motion.point_at_dd(Dd::of(begun)).to_f64(), begun))
}

fn first_wrong(
    body: &Body,
    name: &str,
    h: f64,
    decade: i32,
    member: u64,
    horizon: f64,
) -> Result<Outcome, Error> {
    let (point, begun) = start(body, decade, member)?;
    let motion = FreeMotion::from_point(body.inertia(), point.to_dd());
    let half = motion.character().map_err(unexpected)?.nutation_period.unwrap_or(horizon);
    let method = method(name).map_err(unexpected)?;
    let mut run = Run::from_point(method.as_ref(), body, point, Clock::new(h)).map_err(unexpected)?;
    // the axis that the momentum circulates about, which it never leaves
    let moments: Vec3<f64> = body.rotor().moments();
    let [least, _, largest] = ascending(moments);
    let axis = if member.is_multiple_of(2) { largest } else { least };
    for k in 1_u64.. {
        // every flip, and half-way between two
        let t = 0.5 * half * k as f64 - begun;
        if t > horizon {
            break;
        }
        if t < h {
            continue;
        }
        let steps = libm::round(t / h) as u64;
        let sample = match run.advance_to(steps) {
            Ok(sample) => sample,
            Err(RunError::Diverged { .. } | RunError::Unsolved { .. }) => {
                return Ok(Outcome {
                    time: t,
                    flips: motion.flips(Dd::of(t)),
                    right: false,
                    other_way: false,
                });
            }
            Err(error) => return Err(unexpected(error)),
        };
        let exact = motion.flips(Dd::of(t));
        let other_way = sample.point.momentum_body[axis] * point.momentum_body[axis] < 0.0;
        let miscounted = k.is_multiple_of(2) && sample.flips != Some(motion.flips(sample.elapsed));
        if other_way || miscounted {
            return Ok(Outcome { time: t, flips: exact, right: false, other_way });
        }
    }
    Ok(Outcome { time: horizon, flips: motion.flips(Dd::of(horizon)), right: true, other_way: false })
}

/// Nanoseconds of a step.
fn step_time(name: &str) -> Result<f64, Error> {
    let body = named(BODIES[0])?;
    let (start, _) = start(&body, -2, 0)?;
    let method: Box<dyn AnyMethod> = method(name).map_err(unexpected)?;
    Ok(StepTime::measure(method.as_ref(), &body, start, Clock::new(BUDGET))?.seconds * 1e9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn starts_have_the_distance_that_was_asked_for_and_lie_on_both_sides() {
        for (name, decade) in BODIES.iter().flat_map(|name| [-1, -4, -8].map(|decade| (*name, decade))) {
            let body = named(name).unwrap();
            let moments: Vec3<f64> = body.rotor().moments();
            let norm = RATE * moments[ascending(moments)[1]];
            for member in 0..4 {
                let (point, begun) = start(&body, decade, member).unwrap();
                let character = FreeMotion::from_point(body.inertia(), point.to_dd()).character().unwrap();
                let ratio = character.complement.unwrap() / ten(decade);
                assert!((ratio - 1.0).abs() < 1e-6, "{name} {decade} {member}: {ratio}");
                assert_eq!(character.separatrix_distance > 0.0, member % 2 == 0);
                assert!((point.momentum_body.norm() / norm - 1.0).abs() < 1e-12 && begun > 0.0);
            }
        }
    }

    #[test]
    fn a_splitting_crosses_a_runge_kutta_method_is_late_and_the_exact_step_is_right() {
        let body = named(BODIES[0]).unwrap();
        let first = |name, h, member| first_wrong(&body, name, h, -6, member, 2000.0).unwrap();
        assert!(first("exact-step", 0.5, 0).right);
        assert!((0..4).any(|member| first("two-turn", 0.5, member).other_way));
        let late = first_wrong(&body, "rk4", 0.5, -6, 0, 4000.0).unwrap();
        assert!(!late.right && !late.other_way && (2000.0..4000.0).contains(&late.time), "{late:?}");
    }

    #[test]
    fn a_runge_kutta_method_keeps_the_plane_of_the_separatrix() {
        // I_l (I_h − I_μ) m_h² = I_h (I_μ − I_l) m_l²: of the moments 1, 2, 3 the planes m_3 = ±√3 m_1
        let body = named(BODIES[0]).unwrap();
        let root = Dd::of(3.0).sqrt();
        for (name, keeps) in [("rk4", true), ("rk8", true), ("two-turn", false), ("lie-poisson", false)] {
            let mut x = Point::new(Quat::identity(), Vec3([Dd::of(0.3), Dd::of(1.0), root * 0.3]));
            let mut step = method(name).unwrap().prepare_dd(Clock::new(0.5), &body).unwrap();
            step.steps(&mut x, 40);
            let off = (x.momentum_body[2] - root * x.momentum_body[0]).magnitude();
            assert_eq!(off < 1e-25, keeps, "{name}: {off:e}");
        }
    }
}
