//! The best method of each family at equal cost on real bodies: energy, |m|, L, and the attitude beside the exact one.

use std::fmt::Write as _;

use polhode::body::Body;
use polhode::catalogue;
use polhode::method::{AnyMethod, Claimed, Cost, listing, method, without_projections};
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};
use polhode::run::{RunError, Watch};
use polhode::truth::{AGREEMENT, Care, Ending, Judged, LOST, Truth, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::screen::{WIDTH, bar, wrapped};
use polhode_pages::table::{self, Column, Table, row, to_digits};

use super::contestants::{SCHEMES, TAKEN_BACK, affordable, knows_the_motion, weighed, weight};
use crate::experiment::{Context, Report};
use crate::statistics::largest;

const SEED: u64 = 1852;

const BODIES: [&str; 4] = ["toutatis", "racket", "phone", "spacecraft"];

/// Evaluations for each radian that a body turns: what a step costs sets its length.
const EVALUATIONS: f64 = 40.0;

/// Shown whether or not they are the best of their families.
const NAMED: [&str; 3] = ["rk4", "rattle", "lie-poisson"];

/// So many are in the shortest table.
const FRONT: usize = 8;

/// Tolerances of methods that choose their steps, 10^(-k/2).
const TOLERANCES: std::ops::RangeInclusive<i32> = 4..=30;

/// Over so many radians the cost of a tolerance is measured.
const TRIED: f64 = 100.0;

const LOOKS: u32 = 64;

/// Digits that the longest bar stands for.
const DIGITS: f64 = 16.0;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let turned = context.scale.pick(300.0, 1e4, 1e5);
    let starts = context.scale.pick(1, 5, 6);
    let fields = BODIES.iter().map(|name| field(name, turned, starts)).collect::<Result<Vec<_>, _>>()?;
    let mut names: Vec<String> = without_projections().iter().map(|method| method.name()).collect();
    names.extend(SCHEMES.into_iter().chain(TAKEN_BACK).map(String::from));
    // without torque kick-drift is exact-step, whatever its scheme
    names.retain(|name| !name.contains("kick-drift") && !name.contains("@srkn"));
    let parts = names.iter().flat_map(|name| fields.iter().map(move |field| (name, field))).collect();
    let runs = context.in_parallel(parts, |(name, field): (&String, &Field)| field.run(name));
    let runs = runs.into_iter().collect::<Result<Vec<_>, _>>()?;
    let all: Vec<Score> = names
        .iter()
        .zip(runs.chunks(fields.len()))
        .filter_map(|(name, of_bodies)| Score::of(name, &of_bodies.concat()))
        .collect();
    let mut shown: Vec<&Score> = all.iter().filter(|score| score.is_shown(&all)).collect();
    shown.sort_by(|a, b| a.attitude.total_cmp(&b.attitude).then(b.held.total_cmp(&a.held)));
    let count = BODIES.len() * starts as usize;
    let caption = format!(
        "Largest errors over {turned} rad at {EVALUATIONS} evaluations a radian: medians of {count} runs ({}, {starts} starts each). \
         An implicit solution counts as six evaluations.",
        BODIES.join(", ")
    );
    let others = shown.iter().filter(|score| !score.is_named()).take(FRONT - NAMED.len());
    let front: Vec<&str> = others.map(|score| score.name.as_str()).chain(NAMED).collect();
    let table = |name, caption: String, scores: &mut dyn Iterator<Item = &Score>| {
        let mut table = Table::new(name, caption, columns());
        scores.for_each(|score| table.push(score.row(&front)));
        table
    };
    let best = table("scoreboard", caption.clone(), &mut shown.iter().copied());
    let every = table("methods", caption, &mut all.iter());
    Ok(Report {
        conclusion: conclusion(&shown, turned),
        screen: Some(screen(&shown, turned, count)),
        views: vec![
            best.clone(),
            best.view("front", best.caption.clone(), &["family", "front"], ("front", "yes")),
        ],
        tables: vec![best, every],
        seed: Some(SEED),
        ..Report::default()
    })
}

/// A body with its true motions from each start.
struct Field {
    body: Body,
    /// rad/s.
    speed: f64,
    turned: f64,
    motions: Vec<Truth>,
}

/// The body called `name` from its own start, and from others of the same speed in random directions.
fn field(name: &str, turned: f64, starts: u64) -> Result<Field, Error> {
    let named = catalogue::body(name).ok_or_else(|| unexpected("a body of the catalogue is missing"))?;
    let body = Body::free(named.inertia);
    let own = Vec3(named.omega_body);
    let speed = own.norm();
    let random = Random::new(SEED);
    let omega = |k: u64| match k {
        0 => own,
        k => Vec3((random.stream(k).normal_vector().normalize() * speed).into()),
    };
    let motion = |k| {
        let start = body.enter_omega(Quat::identity(), omega(k)).map_err(unexpected)?;
        Truth::from_point(&body, start.to_f64(), 0.0, &evenly(turned / speed, LOOKS), AGREEMENT)
            .map_err(unexpected)
    };
    let motions = (0..starts).map(motion).collect::<Result<_, _>>()?;
    Ok(Field { body, speed, turned, motions })
}

/// One run.
#[derive(Clone, Copy)]
struct Seen {
    /// Evaluations for each radian.
    cost: f64,
    energy: Option<f64>,
    momentum: Option<f64>,
    momentum_vector: Option<f64>,
    /// Infinite where lost.
    attitude: f64,
    /// Angle turned until the attitude was lost or the run ended, rad.
    held: f64,
}

impl Seen {
    /// Of a start from which nothing is known to take back.
    const NOT_PREDICTED: Seen = Seen {
        cost: EVALUATIONS,
        energy: None,
        momentum: None,
        momentum_vector: None,
        attitude: f64::INFINITY,
        held: 0.0,
    };
}

impl Field {
    fn run(&self, name: &str) -> Result<Vec<Seen>, Error> {
        let named = method(name).map_err(unexpected)?;
        let (method, step) = match named.tolerance() {
            Some(_) => (self.affordable(named.as_ref())?, self.turned / self.speed / f64::from(LOOKS)),
            None => {
                let step = weighed(self.cost_of_step(named.as_ref())) / EVALUATIONS / self.speed;
                (named, step)
            }
        };
        let judged =
            self.motions.iter().map(|motion| match motion.judge(method.as_ref(), step, Care::default()) {
                Ok(seen) => Ok(self.seen(method.as_ref(), &seen)),
                Err(RunError::Phase(_)) => Ok(Seen::NOT_PREDICTED),
                Err(error) => Err(unexpected(error)),
            });
        judged.collect()
    }

    fn seen(&self, method: &dyn AnyMethod, run: &Judged) -> Seen {
        let worst = run.last.worst;
        let is_whole = matches!(run.ending, Ending::Held | Ending::Lost(_));
        let of_whole = |error: Option<f64>| error.filter(|_| is_whole);
        let largest = largest(run.looks.iter().map(|look| look.attitude_error));
        Seen {
            cost: self.cost(method, run),
            energy: of_whole(worst.energy),
            momentum: of_whole(worst.momentum_norm),
            momentum_vector: of_whole(worst.momentum_vector),
            attitude: if run.ending == Ending::Held && largest <= LOST { largest } else { f64::INFINITY },
            held: run.ending.time().map_or(self.turned, |time| time * self.speed),
        }
    }

    /// Evaluations for each radian, an implicit solution weighed.
    fn cost(&self, method: &dyn AnyMethod, run: &Judged) -> f64 {
        run.evaluations as f64 * weight(self.cost_of_step(method)) / (run.last.elapsed.hi() * self.speed)
    }

    fn cost_of_step(&self, method: &dyn AnyMethod) -> Cost {
        method.claims(self.body.problem()).map(|claims| claims.cost).unwrap_or_default()
    }

    /// At the tightest tolerance whose cost is at most that of the others; at the loosest where each costs more.
    fn affordable(&self, method: &dyn AnyMethod) -> Result<Box<dyn AnyMethod>, Error> {
        let step = TRIED / self.speed / 8.0;
        let motion = self.motions.first().ok_or_else(|| unexpected("a body has no start"))?;
        let mut care = Care::default();
        (care.watch, care.until) = (Watch::AtSamples, self.turned.min(TRIED) / self.speed);
        affordable(method, TOLERANCES, |tried| {
            let run = motion.judge(tried, step, care).map_err(unexpected)?;
            Ok(self.cost(tried, &run) > EVALUATIONS)
        })
    }
}

/// A method over all runs; medians.
struct Score {
    name: String,
    family: &'static str,
    cost: f64,
    energy: Option<f64>,
    momentum: Option<f64>,
    momentum_vector: Option<f64>,
    attitude: f64,
    held: f64,
    /// Of the runs those that held the attitude.
    kept: (u64, u64),
}

impl Score {
    fn of(name: &str, runs: &[Seen]) -> Option<Self> {
        let median = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied()
        };
        let each = |pick: fn(&Seen) -> Option<f64>| {
            // more than half must have one
            let seen: Vec<f64> = runs.iter().filter_map(pick).collect();
            (2 * seen.len() > runs.len()).then(|| median(seen)).flatten()
        };
        let base = name.split(':').next().unwrap_or(name);
        let adaptive = method(name).ok()?.tolerance().is_some();
        Some(Score {
            name: if adaptive { base } else { name }.to_owned(),
            family: listing(name)?.family,
            cost: median(runs.iter().map(|run| run.cost).collect())?,
            energy: each(|run| run.energy),
            momentum: each(|run| run.momentum),
            momentum_vector: each(|run| run.momentum_vector),
            attitude: median(runs.iter().map(|run| run.attitude).collect())?,
            held: median(runs.iter().map(|run| run.held).collect())?,
            kept: (runs.iter().filter(|run| run.attitude.is_finite()).count() as u64, runs.len() as u64),
        })
    }

    /// Nearest to the exact attitude; where both lose it, later.
    fn is_better_than(&self, other: &Score) -> bool {
        match self.attitude.total_cmp(&other.attitude) {
            std::cmp::Ordering::Equal => self.held > other.held,
            order => order.is_lt(),
        }
    }

    /// Whether it is the best of its family, or one of those that are always shown.
    fn is_shown(&self, all: &[Score]) -> bool {
        let rivals = all.iter().filter(|other| other.family == self.family && !other.is_named());
        // of two that are equal the first
        let best = rivals.reduce(|best, other| if other.is_better_than(best) { other } else { best });
        self.is_named() || best.is_some_and(|best| std::ptr::eq(best, self))
    }

    fn is_named(&self) -> bool {
        NAMED.contains(&self.name.as_str())
    }

    fn row(&self, front: &[&str]) -> Vec<table::Cell> {
        row![
            self.name.as_str(),
            self.family,
            self.cost,
            self.energy,
            self.momentum,
            self.momentum_vector,
            Some(self.attitude).filter(|error| error.is_finite()),
            self.held,
            format!("{} of {}", self.kept.0, self.kept.1),
            if front.contains(&self.name.as_str()) { "yes" } else { "no" },
        ]
        .to_vec()
    }
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("method", "", "name in the catalogue, or a scheme of it"),
        Column::new("family", "", "family of methods"),
        Column::new("evaluations", "1/rad", "evaluations for each radian turned").heading("evals").digits(2),
        Column::new("energy_error", "", "max |E - E0| / |E0| over every step, median")
            .heading("energy")
            .digits(2),
        Column::new("momentum_error", "", "max ||m| - |m0|| / |m0| over every step, median")
            .heading("|m|")
            .latex("$|m|$")
            .digits(2),
        Column::new("momentum_vector_error", "", "max |L - L0| / |L0| over every step, in space, median")
            .heading("L")
            .latex("$L$")
            .digits(2),
        Column::new(
            "attitude_error",
            "rad",
            "largest angle between computed and exact attitude, median; empty where lost",
        )
        .heading("attitude")
        .digits(2),
        Column::new(
            "held_until",
            "rad",
            "angle turned until the attitude is lost, more than 1 rad off, median",
        )
        .heading("held until")
        .digits(2),
        Column::new("held", "", "runs that hold the attitude to the end"),
        Column::new(
            "front",
            "",
            "whether it is in the shortest table: those always shown, and the best of the others",
        )
        .hidden(),
    ]
}

fn conclusion(shown: &[&Score], turned: f64) -> String {
    let stepping = || shown.iter().filter(|score| !knows_the_motion(&score.name));
    let Some(best) = stepping().next().filter(|best| best.attitude.is_finite()) else {
        return format!("no method holds the attitude over {} rad", grouped(turned));
    };
    let lost = stepping().filter(|score| score.attitude.is_infinite()).count();
    format!(
        "{} ends nearest, {} rad off after {} rad; {lost} of {} methods lose the attitude",
        best.name,
        to_digits(best.attitude, 2),
        grouped(turned),
        stepping().count()
    )
}

/// The table as bars: a cell for each digit of the attitude that is right.
fn screen(shown: &[&Score], turned: f64, count: usize) -> String {
    let head = format!(
        "The best method of each family at {EVALUATIONS} evaluations a radian: largest relative errors of energy and |m| and \
         largest attitude error in rad while the body turns by {} rad, medians of {count} runs ({}). Bars: right digits of the \
         attitude. exact-step and methods with +phase use the exact motion of a free body, the others do not.",
        grouped(turned),
        BODIES.join(", ")
    );
    let mut text = wrapped(&head, WIDTH, 0) + "\n\n";
    let _ = writeln!(text, "{:<25} {:>8} {:>8} {:>8}", "", "energy", "|m|", "attitude");
    for score in shown {
        let number = |value: Option<f64>| value.map_or("-".into(), |x| to_digits(x, 2));
        let (attitude, right) = if score.attitude.is_finite() {
            let digits = -libm::log10(score.attitude.max(1e-300));
            (to_digits(score.attitude, 2), bar(digits / DIGITS, DIGITS as usize))
        } else {
            ("lost".into(), format!("after {} rad", grouped(score.held)))
        };
        let line = format!(
            "{:<25} {:>8} {:>8} {attitude:>8}  {right}",
            score.name,
            number(score.energy),
            number(score.momentum)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// To two digits, thousands apart.
fn grouped(x: f64) -> String {
    let digits = format!("{:.0}", format!("{x:.1e}").parse().unwrap_or(x));
    let first = digits.len() % 3;
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && k % 3 == first {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
