//! Bodies with wheels: spacecraft whose wheel takes up the momentum of the spin, the closed form between switchings of a motor, and methods
//! at equal cost beside it.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | a, J, Ω | axis of a wheel, its moment of inertia about it, its speed relative to the carrier |
//! | l | J (Ω + a·ω) |
//! | L | angular momentum of carrier and wheels |
//!
//! # The turn
//! A body spins about its axis of largest moment I_3, and a motor gives a wheel along another axis a all of |L|. The steady spin that the
//! body follows has `m_a = l I_3/(I_3 − I_a)`: at `l = |L| (1 − I_a/I_3)` it comes to the axis and meets the spin along it with a frequency of
//! zero, so that a motor of any torque leaves some nutation, about as the square root of the torque. On the
//! manoeuvre: Barba and Aubrun, AIAA J. 14 (1976) 1382; Gebman and Mingori, AIAA J. 14 (1976) 859; Hall and Rand, J. Guid. Control Dyn. 17
//! (1994) 30. The body here is our own.

use nalgebra::Vector3;
use polhode::body::{Body, Conserved, State, Wheel};
use polhode::flow::{GyrostatMotion, Stability};
use polhode::inertia::Inertia;
use polhode::method::{Claimed, Cost, method};
use polhode::num::{Dd, Random};
use polhode::rotation::{Quat, Vec3};
use polhode::run::{Run, Watch};
use polhode::truth::{AGREEMENT, Care, Ending, Judged, LOST, Truth, attitude_error, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, Scale};
use polhode_pages::table::{Column, Table, row};

use super::contestants::{affordable, weighed, weight};
use crate::experiment::{Context, Report};
use crate::statistics::largest;
use crate::timing::{best, discard};

const SEED: u64 = 1899;

/// Of body and wheels, kg m².
const MOMENTS: [f64; 3] = [70.0, 90.0, 120.0];

/// About the third axis at the start of a turn, rad/s.
const SPIN: f64 = 0.2;

/// Of the wheel that turns the body, kg m².
const WHEEL: f64 = 0.06;

/// Between looks at a turn, s.
const LOOK: f64 = 0.25;

/// In which the fastest motor gives the wheel all momentum, s; the others take two, four, … times as long.
const FASTEST: f64 = 150.0;

/// L is off by at most this after a turn, relative.
const KEPT: f64 = 1e-12;

/// The energy is off the work of the motor by at most this, relative.
const BALANCED: f64 = 1e-10;

/// The closed form is off a run in double-double by at most this between switchings, rad.
const AGREED: f64 = 1e-13;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut report = Report { seed: Some(SEED), ..Report::default() };
    let left = turns(context, &mut report)?;
    printed(&mut report)?;
    let apart = switched(context, &mut report)?;
    methods(context, &mut report)?;
    report.timing = Some(timing()?);
    report.conclusion = format!(
        "a wheel takes up a flat spin and leaves {left:.1} degrees of nutation at the slowest; between switchings of a motor the closed form is \
         within {apart:.0e} rad of a run in double-double"
    );
    Ok(report)
}

/// Notes whether a claim holds.
fn claim(report: &mut Report, holds: bool, failure: impl FnOnce() -> String) {
    report.checks += 1;
    if !holds {
        report.failures.push(format!("wheels: {}", failure()));
    }
}

/// The angle between two directions, rad.
fn angle(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    libm::atan2(a.cross(&b).norm(), a.dot(&b))
}

/// The momentum of body and wheels, body axes.
fn momentum(body: &Body, t: f64, state: &State) -> Vector3<f64> {
    state.momentum() + body.momentum_of_wheels_at(t)
}

/// The motion that follows if the motor stops.
struct Stopped {
    motion: GyrostatMotion,
    /// Of the stable steady spin next to it, along L.
    spin: Vector3<f64>,
}

impl Stopped {
    /// Of a body of [`MOMENTS`] with one wheel, at its speed in `state`.
    fn new(axis: Vector3<f64>, speed: f64, omega: Vector3<f64>, state: &State) -> Result<Self, Error> {
        let wheel = Wheel::new(axis, WHEEL, speed).map_err(unexpected)?.free(omega);
        let body = carrier(MOMENTS)?.with_wheel(wheel).map_err(unexpected)?;
        let motion = GyrostatMotion::new(&body, state).map_err(unexpected)?;
        let now = momentum(&body, 0.0, state);
        let spins = motion.steady_spins();
        let stable = spins.iter().filter(|spin| spin.stability == Stability::Stable);
        let along = stable.map(|spin| {
            let steady = body.state(Default::default(), spin.omega_body).map_err(unexpected)?;
            Ok(momentum(&body, 0.0, &steady))
        });
        let along = along.collect::<Result<Vec<_>, Error>>()?;
        let spin = along.into_iter().min_by(|a, b| angle(*a, now).total_cmp(&angle(*b, now)));
        let spin = spin.ok_or_else(|| unexpected("a body with a wheel has no stable steady spin"))?;
        Ok(Stopped { motion, spin })
    }

    /// The largest angle between L and `direction`, rad, and the largest |ω|, rad/s, over a period.
    fn extremes(&self, direction: Vector3<f64>) -> Result<(f64, f64), Error> {
        let period = self.motion.character().period.unwrap_or(0.0);
        let body = self.motion.body();
        let (mut lean, mut rate) = (0.0_f64, 0.0_f64);
        for t in evenly(period, 512) {
            let state = self.motion.at(t).map_err(unexpected)?;
            lean = largest([lean, angle(momentum(body, 0.0, &state), direction)]);
            rate = largest([rate, body.omega_body(&state).norm()]);
        }
        Ok((lean, rate))
    }
}

fn carrier(moments: [f64; 3]) -> Result<Body, Error> {
    Ok(Body::free(Inertia::from_moments(moments).map_err(unexpected)?))
}

/// One turn by a wheel along `axis`.
struct Turn {
    torque: f64,
    duration: f64,
    /// Largest error of L, relative.
    momentum: f64,
    /// Of the motor, J.
    work: f64,
    /// |ΔT − work|, over the work.
    imbalance: f64,
    /// Largest angle between L and the steady spin at an eighth of the time, and at the end between L and the axis, rad.
    early: f64,
    late: f64,
    /// Largest |ω| after the end, rad/s.
    rate: f64,
    /// l over |L|, with the angle between L and the axis of the run and of the steady spin, degrees.
    drawn: Vec<(f64, f64)>,
    predicted: Vec<(f64, f64)>,
}

fn turn(axis: Vector3<f64>, duration: f64) -> Result<Turn, Error> {
    let omega = Vector3::new(0.0, 0.0, SPIN);
    let total = MOMENTS[2] * SPIN;
    let torque = total / duration;
    let wheel = Wheel::new(axis, WHEEL, 0.0)
        .and_then(|wheel| wheel.driven(torque, [0.0, duration], omega))
        .map_err(unexpected)?;
    let body = carrier(MOMENTS)?.with_wheel(wheel).map_err(unexpected)?;
    let start = body.state(Default::default(), omega).map_err(unexpected)?;
    let taylor = method("taylor").map_err(unexpected)?;
    let mut run = Run::new(&taylor, &body, &start, LOOK).map_err(unexpected)?;
    let steps = (duration / LOOK) as u64;
    let kinetic = |t: f64, omega: Vector3<f64>, state: &State| {
        let l = WHEEL * (wheel.speed(t, omega) + axis.dot(&omega));
        body.energy_at(t, state) + 0.5 * l * l / WHEEL
    };
    let before = kinetic(0.0, omega, &start);
    let mut speeds = vec![wheel.speed(0.0, omega)];
    let (mut drawn, mut predicted, mut early) = (Vec::new(), Vec::new(), f64::NAN);
    let mut last = run.sample();
    for k in 1..=steps {
        last = run.advance_to(k).map_err(unexpected)?;
        let (t, omega) = (last.time.hi(), last.omega_body);
        speeds.push(wheel.speed(t, omega));
        if k * 100 / steps > (k - 1) * 100 / steps && k < steps {
            let share = torque * t / total;
            let m = momentum(&body, t, &last.state);
            drawn.push((share, angle(m, axis).to_degrees()));
            // all but on the separatrix where the spins meet
            if let Ok(stopped) = Stopped::new(axis, wheel.speed(t, omega), omega, &last.state) {
                predicted.push((share, angle(stopped.spin, axis).to_degrees()));
            }
        }
        if k == steps / 8 {
            let stopped = Stopped::new(axis, wheel.speed(t, omega), omega, &last.state)?;
            early = stopped.extremes(stopped.spin)?.0;
        }
    }
    let (t, omega) = (last.time.hi(), last.omega_body);
    let work = torque * integral(&speeds, LOOK);
    let imbalance = (kinetic(t, omega, &last.state) - before - work).abs() / work;
    let stopped = Stopped::new(axis, wheel.speed(t, omega), omega, &last.state)?;
    let (late, rate) = stopped.extremes(axis)?;
    let momentum = last.worst.of(Conserved::Momentum).unwrap_or(f64::NAN);
    Ok(Turn { torque, duration, momentum, work, imbalance, early, late, rate, drawn, predicted })
}

/// Over equal distances `h`, six to a panel: the rule of Newton and Cotes with seven values, of order 8.
fn integral(values: &[f64], h: f64) -> f64 {
    const WEIGHTS: [f64; 7] = [41.0, 216.0, 27.0, 272.0, 27.0, 216.0, 41.0];
    let panels = (0..values.len() / 6).map(|k| &values[6 * k..=6 * k + 6]);
    let of = |panel: &[f64]| panel.iter().zip(WEIGHTS).map(|(value, weight)| value * weight).sum::<f64>();
    panels.map(of).sum::<f64>() * h / 140.0
}

/// The turns, by torque; gives the least nutation of a flat spin that is left, in degrees.
fn turns(context: &Context, report: &mut Report) -> Result<f64, Error> {
    let mut table = Table::new(
        "turns",
        format!(
            "A spacecraft with the moments {MOMENTS:?} kg m^2 that spins at {SPIN} rad/s about its axis of largest moment; the motor of a wheel \
             of {WHEEL} kg m^2 gives it all of |L|. Flat spin: the wheel is along the axis of least moment, dual-spin turn: along the middle \
             one."
        ),
        vec![
            Column::new("manoeuvre", "", "by the axis of the wheel"),
            Column::new("torque", "N m", "of the motor").digits(2),
            Column::new("duration", "s", "in which the motor works"),
            Column::new("momentum", "", "largest error of L in space, relative").heading("L").digits(2),
            Column::new("work", "J", "of the motor, by quadrature of torque and speed of the wheel")
                .digits(5),
            Column::new("imbalance", "", "|change of kinetic energy - work| / work").digits(2),
            Column::new(
                "early",
                "deg",
                "largest angle between L and the steady spin if the motor stops after an eighth of the time",
            )
            .digits(3),
            Column::new("nutation", "deg", "largest angle between L and the axis of the wheel after the end")
                .digits(3),
            Column::new("rate", "deg/s", "largest angular velocity of the body after the end").digits(3),
            Column::new("exponent", "", "of the nutation against the torque, by this row and the one before")
                .digits(2),
        ],
    );
    let mut figure = Figure::new(
        "wheels",
        "Flat spin recovery: angle between L and the axis of the wheel while a motor spins it up, and that of the stable steady spin",
        ("momentum of the wheel / |L|", Scale::Linear),
        ("nutation angle (degrees)", Scale::Linear),
    );
    let doublings = context.scale.pick(2, 4, 7);
    let manoeuvres = [("flat spin", Vector3::x()), ("dual-spin turn", Vector3::y())];
    let mut parts = Vec::new();
    for (name, axis) in manoeuvres {
        for k in 0..doublings {
            parts.push((name, axis, FASTEST * f64::from(1_u32 << k)));
        }
    }
    let found = context.in_parallel(parts.clone(), |(_, axis, duration)| turn(axis, duration));
    let mut before: Option<(&str, f64)> = None;
    let (mut left, mut third) = (f64::NAN, f64::NAN);
    for ((name, _, _), turn) in parts.into_iter().zip(found) {
        let turn = turn?;
        let slower = before.filter(|before| before.0 == name).map(|before| before.1);
        let exponent = slower.map(|faster| libm::log2(faster / turn.late));
        before = Some((name, turn.late));
        let degrees = f64::to_degrees;
        table.push(row![
            name,
            turn.torque,
            turn.duration,
            turn.momentum,
            turn.work,
            turn.imbalance,
            degrees(turn.early),
            degrees(turn.late),
            degrees(turn.rate),
            exponent,
        ]);
        let what = format!("{name} by {} N m", turn.torque);
        claim(report, turn.momentum < KEPT, || format!("{what}: L is off by {:e}", turn.momentum));
        claim(report, turn.imbalance < BALANCED, || {
            format!("{what}: the energy is off the work by {:e}", turn.imbalance)
        });
        if let Some(faster) = slower {
            claim(report, turn.late < faster, || format!("{what}: more nutation than by twice the torque"));
        }
        match libm::round(libm::log2(turn.duration / FASTEST)) as u32 {
            2 => third = turn.late,
            last if last > 4 && last + 1 == doublings => {
                let slope = libm::log2(third / turn.late) / f64::from(last - 2);
                claim(report, (slope - 0.5).abs() < 0.15, || {
                    format!("{what}: the nutation falls by the power {slope} of the torque")
                });
            }
            _ => {}
        }
        if name == manoeuvres[0].0 {
            left = turn.late.to_degrees();
            let is_last = turn.duration == FASTEST * f64::from(1_u32 << (doublings - 1));
            if turn.duration == FASTEST || is_last {
                figure.series.push(Curve::new(format!("{} N m", turn.torque), turn.drawn).plain());
            }
            if is_last {
                figure.series.push(Curve::new("steady spin", turn.predicted).dots());
            }
        }
    }
    report.tables.push(table);
    report.figures.push(figure);
    Ok(left)
}

/// The speeds of a wheel beyond which a spin about its axis is stable, beside those that the notes of a public program print: N. R.,
/// Spacecraft-Wheel-Spin (github.com/NicolasR-github), Pert_after_WheelSpeedMax.py. There the body turns at π/50 rad/s about its middle axis
/// before the wheel along it is spun up.
fn printed(report: &mut Report) -> Result<(), Error> {
    let moments = [630_000.0, 1_365_000.0, 1_665_000.0];
    let (wheel, spin) = (96.0, std::f64::consts::PI / 50.0);
    let total = moments[1] * spin;
    let is_stable = |speed: f64| -> Result<bool, Error> {
        let held = Wheel::new(Vector3::y(), wheel, speed).map_err(unexpected)?;
        let body = carrier(moments)?.with_wheel(held).map_err(unexpected)?;
        // any start of the same |L|
        let mut motions = [0.3, 0.7].into_iter().filter_map(|lean| {
            let (sin, cos) = libm::sincos(lean);
            let m = Vector3::new(0.6 * sin, cos, 0.8 * sin) * total;
            let omega = (m - Vector3::y() * (wheel * speed)).component_div(&Vector3::from(moments));
            let start = body.state(Default::default(), omega).ok()?;
            GyrostatMotion::new(&body, &start).ok()
        });
        let motion = motions.next().ok_or_else(|| unexpected("a gyrostat has no closed form"))?;
        let spins = motion.steady_spins();
        // of all steady spins the one whose momentum is along the wheel
        let along = |omega: Vector3<f64>| moments[1] * omega.y + wheel * speed;
        let upright = spins.iter().max_by(|a, b| along(a.omega_body).total_cmp(&along(b.omega_body)));
        Ok(upright.is_some_and(|spin| spin.stability == Stability::Stable))
    };
    let mut table = Table::new(
        "threshold",
        "Speeds of a wheel of 96 kg m^2 along the middle axis beyond which the spin about it is stable, after the wheel has been spun up in \
         a body of 630000, 1365000, 1665000 kg m^2 that turned at pi/50 rad/s: where steady spins change their stability, and as N. R., \
         Spacecraft-Wheel-Spin, prints them.",
        vec![
            Column::new("side", "", "along the spin or against it"),
            Column::new("threshold", "rad/s", "where the stability of the steady spin changes").digits(7),
            Column::new("formula", "rad/s", "(I_2/I_k) (I_k - I_2) spin/J, k = 3 along, 1 against").digits(7),
            Column::new("printed", "rad/s", "in the notes of the program").digits(4),
        ],
    );
    for (side, k, printed, far) in [("along", 2, 160.0, 400.0), ("against", 0, -1043.0, -2000.0)] {
        let (mut near, mut beyond) = (0.0, far);
        claim(report, !is_stable(near)? && is_stable(beyond)?, || {
            format!("the spin is not unstable at rest and stable at {far} rad/s")
        });
        for _ in 0..44 {
            let middle = 0.5 * (near + beyond);
            if is_stable(middle)? { beyond = middle } else { near = middle }
        }
        let formula = moments[1] / moments[k] * (moments[k] - moments[1]) * spin / wheel;
        table.push(row![side, beyond, formula, printed]);
        claim(report, (beyond / formula - 1.0).abs() < 1e-9, || {
            format!("the threshold {beyond} is not that of the formula, {formula}")
        });
        claim(report, (beyond - printed).abs() < 1.0, || {
            format!("the threshold {beyond} is not the printed {printed}")
        });
    }
    report.tables.push(table);
    Ok(())
}

/// A motor that works for an interval; gives the largest angle between the closed form and the run outside it, rad.
fn switched(context: &Context, report: &mut Report) -> Result<f64, Error> {
    let span = context.scale.pick(200.0, 2_000.0, 20_000.0);
    // multiples of powers of two, so that momenta of wheels at the switchings are exact
    let (from, to) = (0.5 * span, 0.5 * span + 40.0);
    let (inertia, speed, torque) = (0.0625, 80.0, 0.125);
    let omega = Vector3::new(0.25, -0.125, 0.375);
    let still = Wheel::new(Vector3::new(1.0, 2.0, -2.0), 0.05, 60.0).map_err(unexpected)?;
    let along = |speed: f64| Wheel::new(Vector3::z(), inertia, speed).map_err(unexpected);
    let with = |wheel: Wheel| {
        carrier([10.0, 12.0, 15.0])?
            .with_wheel(wheel)
            .and_then(|body| body.with_wheel(still))
            .map_err(unexpected)
    };
    let driven = with(along(speed)?.driven(torque, [from, to], omega).map_err(unexpected)?)?;
    // free, of the momentum that it then has
    let before = inertia * (speed + omega.z);
    let after = before + torque * (to - from);
    let stopped = |momentum: f64| with(along(momentum / inertia)?.free(Vector3::zeros()));
    let start = driven.state(Default::default(), omega).map_err(unexpected)?;
    let looks: Vec<f64> =
        evenly(from, 20).into_iter().chain(evenly(from, 20).iter().map(|t| to + t)).collect();
    let times: Vec<f64> =
        looks[..20].iter().copied().chain([to]).chain(looks[20..].iter().copied()).collect();
    let truth = Truth::new(&driven, &start, &times).map_err(unexpected)?;
    let mut table = Table::new(
        "switched",
        format!(
            "A body with a wheel whose motor works from {from} to {to} s: the closed form from the state at each switching beside a run in \
             double-double, looked at 20 times."
        ),
        vec![
            Column::new("interval", "", "before the motor works or after it"),
            Column::new("from", "s", "beginning of the interval"),
            Column::new("to", "s", "end of the interval"),
            Column::new("attitude", "rad", "largest angle between the attitudes").digits(2),
            Column::new("omega", "rad/s", "largest difference of the angular velocities").digits(2),
        ],
    );
    let mut worst = 0.0_f64;
    for (name, begins, l, looks) in
        [("before", 0.0, before, &looks[..20]), ("after", to, after, &looks[20..])]
    {
        let body = stopped(l)?;
        let there = truth.point_at(Dd::from(begins)).map_err(unexpected)?;
        let motion = GyrostatMotion::from_point(&body, there).map_err(unexpected)?;
        let (mut attitude, mut omega) = (0.0, 0.0);
        for &t in looks {
            let exact = truth.point_at(Dd::from(t)).map_err(unexpected)?;
            let state = motion.at(t - begins).map_err(unexpected)?;
            attitude = largest([attitude, attitude_error(state.attitude, exact.attitude)]);
            omega = largest([omega, (body.omega_body(&state) - driven.omega_of(&exact)).norm()]);
        }
        table.push(row![name, begins, looks[looks.len() - 1], attitude, omega]);
        claim(report, attitude < AGREED, || {
            format!("{name} the motor: the closed form is off by {attitude:e} rad")
        });
        worst = largest([worst, attitude]);
    }
    claim(report, truth.known_until() >= times[times.len() - 1], || {
        format!("the run in double-double is known until {} s only", truth.known_until())
    });
    report.tables.push(table);
    Ok(worst)
}

const METHODS: [&str; 7] = [
    "rk4",
    "lie-poisson@suzuki-4",
    "two-turn@suzuki-4",
    "kick-drift@suzuki-4",
    "gauss:4",
    "taylor",
    "dop853",
];

/// Evaluations for each radian at the rate |L|/I_2.
const EVALUATIONS: f64 = 40.0;

/// Tolerances of methods that choose their steps, 10^(-k/2).
const TOLERANCES: std::ops::RangeInclusive<i32> = 4..=31;

/// Over this part of a run the cost of a tolerance is measured.
const TRIED: f64 = 0.25;

const LOOKS: u32 = 32;

/// A spacecraft with four wheels on a pyramid.
fn pyramid() -> Result<Body, Error> {
    let wheels = [([1.0, 0.0], 300.0), ([0.0, 1.0], -200.0), ([-1.0, 0.0], 150.0), ([0.0, -1.0], 250.0)];
    wheels.iter().try_fold(carrier(MOMENTS)?, |body, &([x, y], speed)| {
        let wheel = Wheel::new(Vector3::new(x, y, 0.75), 0.01, speed).map_err(unexpected)?;
        body.with_wheel(wheel).map_err(unexpected)
    })
}

struct Start {
    truth: Truth,
    /// |L|/I_2, rad/s.
    rate: f64,
}

fn methods(context: &Context, report: &mut Report) -> Result<(), Error> {
    let body = pyramid()?;
    let turned = context.scale.pick(60.0, 500.0, 1_000.0);
    let count = context.scale.pick(2, 16, 128);
    let random = Random::new(SEED);
    let start = |k: u64| {
        let mut random = random.stream(k);
        let attitude = random.normal_vector().push(random.normal()).normalize();
        let attitude = Quat::new(attitude.w, Vec3([attitude.x, attitude.y, attitude.z]));
        let omega = random.normal_vector().normalize() * random.between(0.02, 0.1);
        let point = body.enter_omega(attitude, Vec3(omega.into())).map_err(unexpected)?.to_f64();
        let l = momentum(&body, 0.0, &body.leave(&point.to_dd())).norm();
        let rate = l / MOMENTS[1];
        let times = evenly(turned / rate, LOOKS);
        let truth = Truth::from_point(&body, point, 0.0, &times, AGREEMENT).map_err(unexpected)?;
        Ok(Start { truth, rate })
    };
    let starts = context.in_parallel((0..count).collect(), start);
    let starts = starts.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let closed = starts.iter().filter(|start| start.truth.closed_form().is_some()).count();
    claim(report, closed == starts.len(), || format!("{closed} of {count} starts have a closed form"));
    let mut table = Table::new(
        "methods",
        format!(
            "A spacecraft with the moments {MOMENTS:?} kg m^2 and four wheels on a pyramid, {count} random starts, while it turns by {turned} \
             rad at the rate |L|/I_2, {EVALUATIONS} evaluations for each radian; errors against the closed form, looked at {LOOKS} times. An \
             implicit solution counts as six evaluations."
        ),
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("evaluations", "1/rad", "evaluations for each radian turned, median")
                .heading("evals")
                .digits(2),
            Column::new("energy", "", "largest error of the energy, relative, median").digits(2),
            Column::new("momentum", "", "largest error of L in space, relative, median")
                .heading("L")
                .digits(2),
            Column::new("attitude", "rad", "largest attitude error, median").digits(2),
            Column::new("worst", "rad", "largest attitude error, of all starts").digits(2),
            Column::new("held", "", "starts from which the attitude is held to 1 rad"),
        ],
    );
    let runs = context.in_parallel(METHODS.to_vec(), |name| of_method(name, &body, &starts, turned));
    let mut best = f64::INFINITY;
    let mut of_rk4 = f64::NAN;
    for (name, runs) in METHODS.into_iter().zip(runs) {
        let runs = runs?;
        let median = |pick: fn(&Figures) -> f64| {
            let mut values: Vec<f64> = runs.iter().map(pick).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let (energy, l, attitude) =
            (median(|run| run.energy), median(|run| run.momentum), median(|run| run.attitude));
        let worst = largest(runs.iter().map(|run| run.attitude));
        let held = runs.iter().filter(|run| run.attitude <= LOST).count() as u64;
        table.push(row![
            name,
            median(|run| run.cost),
            energy,
            l,
            attitude,
            Some(worst).filter(|worst| worst.is_finite()),
            held,
        ]);
        match name {
            "rk4" => of_rk4 = attitude,
            "lie-poisson@suzuki-4" | "two-turn@suzuki-4" | "kick-drift@suzuki-4" => {
                best = best.min(attitude);
                let l = largest(runs.iter().map(|run| run.momentum));
                claim(report, l < 1e-13, || format!("{name} lets L go by {l:e}"));
            }
            _ => {}
        }
    }
    claim(report, best < of_rk4, || {
        format!("the best splitting is {best:e} rad off, the classical Runge-Kutta method {of_rk4:e}")
    });
    report.tables.push(table);
    Ok(())
}

/// Of one run.
struct Figures {
    cost: f64,
    energy: f64,
    momentum: f64,
    /// Infinite where the run failed.
    attitude: f64,
}

fn of_method(name: &str, body: &Body, starts: &[Start], turned: f64) -> Result<Vec<Figures>, Error> {
    let named = method(name).map_err(unexpected)?;
    let of_step = named.claims(body.problem()).map(|claims| claims.cost).unwrap_or_default();
    let chosen = match (named.tolerance(), starts.first()) {
        (Some(_), Some(start)) => {
            let step = turned / start.rate / f64::from(LOOKS);
            let mut care = Care::default();
            (care.watch, care.until) = (Watch::AtSamples, TRIED * turned / start.rate);
            affordable(named.as_ref(), TOLERANCES, |tried| {
                let run = start.truth.judge(tried, step, care).map_err(unexpected)?;
                Ok(cost(&run, of_step, start.rate) > EVALUATIONS)
            })?
        }
        _ => named,
    };
    let each = starts.iter().map(|start| {
        let step = match chosen.tolerance() {
            Some(_) => turned / start.rate / f64::from(LOOKS),
            None => weighed(of_step) / EVALUATIONS / start.rate,
        };
        let mut care = Care::default();
        care.watch = Watch::AtSamples;
        let run = start.truth.judge(chosen.as_ref(), step, care).map_err(unexpected)?;
        let of = |quantity| run.last.worst.of(quantity).unwrap_or(f64::NAN);
        let is_whole = matches!(run.ending, Ending::Held | Ending::Lost(_));
        let attitude = largest(run.looks.iter().map(|look| look.attitude_error));
        Ok(Figures {
            cost: cost(&run, of_step, start.rate),
            energy: of(Conserved::Energy),
            momentum: of(Conserved::Momentum),
            attitude: if is_whole { attitude } else { f64::INFINITY },
        })
    });
    each.collect()
}

/// Evaluations for each radian, an implicit solution weighed.
fn cost(run: &Judged, of_step: Cost, rate: f64) -> f64 {
    run.evaluations as f64 * weight(of_step) / (run.last.elapsed.hi() * rate)
}

fn timing() -> Result<Table, Error> {
    let body = pyramid()?;
    let start = body.state(Default::default(), Vector3::new(0.05, -0.02, 0.08)).map_err(unexpected)?;
    let set_up = || GyrostatMotion::new(&body, &start);
    let motion = set_up().map_err(unexpected)?;
    let times: Vec<f64> = (0..64).map(|n| 12.345 * f64::from(n)).collect();
    let made = best(50, &|| discard(set_up()));
    let at = best(50, &|| times.iter().for_each(|&t| discard(motion.at(t)))) / times.len() as f64;
    let mut table = Table::new(
        "timing",
        "Cost of the closed form of a body with four wheels, least of many bursts on this machine.",
        vec![
            Column::new("set_up", "us", "GyrostatMotion::new").digits(3),
            Column::new("at", "us", "one state at any time").digits(3),
        ],
    );
    table.push(row![made * 1e6, at * 1e6]);
    Ok(table)
}
