//! An asymmetric top under gravity, on a regular and on a chaotic orbit: what methods keep, the Lyapunov exponent that they see, and how long
//! the attitude holds.
//!
//! # Lyapunov exponent
//! Two neighbouring runs are brought back to the distance d₀ after every interval τ; the largest exponent is the mean of
//! `ln(d/d₀)/τ` (Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9). The distance is that of the turn between the
//! attitudes and of the momenta over |m₀|. Its interval is from the means of sixteen parts of the run.

use polhode::body::{Body, Clock, Point};
use polhode::inertia::Inertia;
use polhode::method::{AdaptiveTaylor, AnyMethod as _, Step, method};
use polhode::num::{Dd, Precise};
use polhode::rotation::{Quat, Vec3};
use polhode::truth::{AGREEMENT, Care, Ending, Truth, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, Scale, sheet};
use polhode_pages::table::{Cell, Column, Table, row};

use crate::experiment::{Context, Report};

/// A start of the top with the moments 0.5, 0.85, 1 kg m² and the weight moment 1 N m along the axis of the largest.
struct Orbit {
    name: &'static str,
    what: &'static str,
    attitude: [f64; 4],
    momentum_body: [f64; 3],
}

const MOMENTS: [f64; 3] = [0.5, 0.85, 1.0];

const ORBITS: [Orbit; 2] = [
    Orbit {
        name: "tilted",
        what: "start of figure VII.5.3 of Hairer, Lubich and Wanner, a regular orbit",
        attitude: [0.4, 0.2, 0.4, 0.8],
        momentum_body: [0.2, 1.0, 0.4],
    },
    Orbit {
        name: "upright",
        what: "start next to upright, a chaotic orbit",
        attitude: [1.0, 0.05, 0.02, 0.0],
        momentum_body: [0.1, 0.2, 0.5],
    },
];

const METHODS: [&str; 11] = [
    "rk4",
    "rk8",
    "implicit-midpoint",
    "rattle",
    "lie-poisson",
    "lie-poisson@suzuki-4",
    "kick-drift",
    "kick-drift@srkn-6b",
    "kick-drift@srkn-11b",
    "gauss:8",
    "lie-newmark",
];

/// Distance of neighbouring runs, relative; in double-double it can be smaller.
const APART: f64 = 1e-7;
const APART_DD: f64 = 1e-14;

/// Time between two resets of the distance, s.
const INTERVAL: f64 = 4.0;

/// Parts of a run, for the interval of the exponent, and 97.5 % of Student's distribution with 15 degrees of freedom.
const PARTS: usize = 16;
const STUDENT: f64 = 2.131;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let span = context.scale.pick(64.0, 512.0, 16_384.0);
    let held = context.scale.pick(64.0, 128.0, 1024.0);
    let finest = context.scale.pick(4, 5, 7);
    let inertia = Inertia::from_moments(MOMENTS).map_err(unexpected)?;
    let body = Body::heavy(inertia, Vec3([0.0, 0.0, 1.0]).into()).map_err(unexpected)?;
    let mut table = Table::new("chaos", caption(span), columns());
    let mut report = Report::default();
    let start = |orbit: &Orbit| {
        let omega = Vec3([0, 1, 2].map(|k| orbit.momentum_body[k] / MOMENTS[k]));
        body.enter_omega(Quat::from_components(orbit.attitude), omega).map_err(unexpected)
    };
    let starts = ORBITS.iter().map(start).collect::<Result<Vec<_>, Error>>()?;
    // the exponents take longest, one on each core
    let exponents = context.in_parallel(starts.clone(), |start| true_exponent(&body, start, span));
    let times = evenly(held, held as u32);
    let motions = context.in_parallel(starts.clone(), |start| {
        Truth::from_point(&body, start.to_f64(), 0.0, &times, AGREEMENT).map_err(unexpected)
    });
    for (orbit, ((start, truth), motion)) in ORBITS.iter().zip(starts.into_iter().zip(exponents).zip(motions))
    {
        let (truth, motion) = (truth?, motion?);
        let mut parts = Vec::new();
        for name in METHODS {
            for power in 3..=finest {
                parts.push((name, libm::exp2(-f64::from(power))));
            }
        }
        let rows = context.in_parallel(parts, |(name, h)| of_run(&body, start, &motion, (name, h), span));
        let known = motion.known_until();
        let top = [Cell::Empty, Cell::Empty, truth.mean.into(), truth.half_width.into(), known.into()];
        let name: [Cell; 3] = row![orbit.name, "double-double", None::<f64>];
        table.push(name.into_iter().chain(top).chain([Cell::Empty]));
        let mut panels = panels(truth.mean);
        for row in rows {
            let (name, h, row) = row?;
            let [energy, exponent, lost] = &mut panels;
            for (figure, value) in [(energy, row.energy), (exponent, row.exponent.mean), (lost, row.until)] {
                let drawn = figure.series.iter_mut().find(|series| series.name == name);
                match drawn {
                    Some(series) => series.points.insert(0, (h, value)),
                    None => figure.series.push(Curve::new(name, vec![(h, value)])),
                }
            }
            table.push(row.cells(orbit.name, name, h));
        }
        let title = format!(
            "Moments 0.5, 0.85, 1 kg m², weight moment 1 N m along the third axis, {}; over {span} s",
            orbit.what
        );
        let name = if orbit.name == "tilted" { "chaos-tilted" } else { "chaos-upright" };
        report.drawings.push(sheet(name, &title, 2, &panels));
        let caption = format!("{}: {}.", orbit.name, orbit.what);
        report.views.push(table.view(
            format!("chaos-{}", orbit.name),
            caption,
            &["orbit"],
            ("orbit", orbit.name),
        ));
    }
    report.tables.push(table);
    Ok(report)
}

fn caption(span: f64) -> String {
    format!(
        "Asymmetric top under gravity over {span} s: largest errors of energy and L_z, largest Lyapunov exponent with the half \
         width of its 95 % interval, and the time at which the attitude is 1 rad off the run in double-double."
    )
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("orbit", "", "start"),
        Column::new("method", "", "name in the catalogue, or the reference"),
        Column::new("h", "s", "step").latex("$h$"),
        Column::new("energy_error", "", "max |E - E0| over (max U - min U), every step")
            .heading("energy")
            .digits(2),
        Column::new("momentum_z_error", "", "max |L_Z - L_Z0| over its largest possible value, every step")
            .heading("L_Z")
            .latex("$p_\\varphi$")
            .digits(2),
        Column::new("exponent", "1/s", "largest Lyapunov exponent").digits(3),
        Column::new("exponent_half_width", "1/s", "half width of its 95 % interval").heading("±").digits(2),
        Column::new(
            "held_until",
            "s",
            "when the attitude is first 1 rad off; of the reference, how far it is known",
        )
        .heading("held until")
        .digits(3),
        Column::new("status", "", "ok, or what became of the run"),
    ]
}

fn panels(truth: f64) -> [Figure; 3] {
    let step = ("step h (s)", Scale::Log);
    let energy = ("largest energy error over the exchanged energy", Scale::Log);
    let mut exponent = Figure::new(
        "exponent",
        "Largest Lyapunov exponent",
        step,
        ("largest Lyapunov exponent (1/s)", Scale::Linear),
    );
    exponent.level("double-double", truth);
    [
        Figure::new("energy", "Energy", step, energy),
        exponent,
        Figure::new("held", "Attitude", step, ("attitude within 1 rad until (s)", Scale::Linear)),
    ]
}

/// An exponent with the half width of its interval, 1/s.
#[derive(Clone, Copy)]
struct Exponent {
    mean: f64,
    half_width: f64,
}

/// What one method finds at one step.
struct Found {
    energy: f64,
    momentum_z: Option<f64>,
    exponent: Exponent,
    until: f64,
    ending: Ending,
}

impl Found {
    fn cells(self, orbit: &str, name: &str, h: f64) -> Vec<Cell> {
        row![
            orbit,
            name,
            h,
            self.energy,
            self.momentum_z,
            self.exponent.mean,
            self.exponent.half_width,
            self.until,
            self.ending.to_string(),
        ]
        .to_vec()
    }
}

fn of_run<'a>(
    body: &Body,
    start: Point<Dd>,
    motion: &Truth,
    (name, h): (&'a str, f64),
    span: f64,
) -> Result<(&'a str, f64, Found), Error> {
    let of_name = method(name).map_err(unexpected)?;
    let mut care = Care::default();
    care.until_lost = true;
    let held = motion.judge(of_name.as_ref(), h, care).map_err(unexpected)?;
    let until = held.ending.time().unwrap_or(motion.known_until());
    let long = polhode::run::Run::from_point(of_name.as_ref(), body, start.to_f64(), Clock::new(h));
    let long = long.map_err(unexpected)?.advance_to((span / h) as u64).map_err(unexpected)?;
    let exponent = exponent::<f64>(
        || of_name.prepare_f64(Clock::new(h), body).map_err(unexpected),
        start.to_f64(),
        (span, h),
        APART,
    )?;
    let energy = motion.exchanged_energy_error(&long.worst).unwrap_or_default();
    let momentum_z = long.worst.momentum_z;
    Ok((name, h, Found { energy, momentum_z, exponent, until, ending: held.ending }))
}

fn true_exponent(body: &Body, start: Point<Dd>, span: f64) -> Result<Exponent, Error> {
    let taylor = AdaptiveTaylor::to_rounding();
    let prepare = || taylor.prepare_dd(Clock::new(INTERVAL), body).map_err(unexpected);
    exponent::<Dd>(prepare, start, (span, INTERVAL), APART_DD)
}

/// Of the motion by the steps that `prepare` makes, each of `h` s, over `span` s.
fn exponent<S: Precise>(
    prepare: impl Fn() -> Result<Box<dyn Step<S>>, Error>,
    start: Point<S>,
    (span, h): (f64, f64),
    apart: f64,
) -> Result<Exponent, Error> {
    let mut steps = [prepare()?, prepare()?];
    let scale = start.momentum_body.norm().to_f64();
    let along = S::of(apart / libm::sqrt(6.0));
    let mut a = start;
    let mut b = neighbour(&a, Vec3([along; 3]), Vec3([along; 3]), scale);
    let count = (span / INTERVAL) as usize;
    let mut growth = Vec::with_capacity(count);
    for _ in 0..count {
        for (step, x) in steps.iter_mut().zip([&mut a, &mut b]) {
            *x = Point::new(x.attitude, x.momentum_body);
            step.steps(x, (INTERVAL / h) as u64);
        }
        let turn = a.attitude.conjugate() * b.attitude;
        let half = if turn.w < S::of(0.0) { -turn.v } else { turn.v };
        let turn = half + half;
        let kicked = (b.momentum_body - a.momentum_body) * S::of(1.0 / scale);
        let distance = libm::sqrt((turn.norm_squared() + kicked.norm_squared()).to_f64());
        growth.push(libm::log(distance / apart) / INTERVAL);
        let back = S::of(apart / distance);
        b = neighbour(&a, turn * back, kicked * back, scale);
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    let means: Vec<f64> = growth.chunks(count.div_ceil(PARTS).max(1)).map(mean).collect();
    let centre = mean(&means);
    let squares: Vec<f64> = means.iter().map(|part| (part - centre) * (part - centre)).collect();
    let parts = means.len().max(2) as f64;
    let deviation = libm::sqrt(mean(&squares) * parts / (parts - 1.0));
    Ok(Exponent { mean: mean(&growth), half_width: STUDENT * deviation / libm::sqrt(parts) })
}

/// The point turned from `x` by `turn` (small, rad, in the axes of the body), its momentum changed by `kicked` times `scale`.
fn neighbour<S: Precise>(x: &Point<S>, turn: Vec3<S>, kicked: Vec3<S>, scale: f64) -> Point<S> {
    // the norm of the attitude, which not every method keeps, is that of x
    let turned = x.attitude * Quat::new(S::of(1.0), turn * S::of(0.5)).normalized();
    Point::new(turned, x.momentum_body + kicked * S::of(scale))
}
