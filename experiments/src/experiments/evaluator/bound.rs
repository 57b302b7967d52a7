//! Errors of one evaluation of the exact motion over the grid, in units of the last place.

use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::{Dd, Precise, Random};
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::SEED;
use super::grid::{self, Shape, Start};
use super::reference::{Form, Reference};
use crate::experiment::{Context, Report};
use crate::statistics::larger;

/// 2⁻⁵³: errors are counted in it, of the attitude in rad and of ω relative to its length.
pub(super) const UNIT: f64 = f64::EPSILON / 2.0;

/// What is promised of one evaluation, and how well the two references have to agree.
const PROMISE: f64 = 16.0;
const AGREEMENT: f64 = 0.01;

/// Decades of the angle turned, from 1 rad.
const DECADES: f64 = 12.0;

/// Of the distribution of errors: bins a unit, and bins.
const FINE: f64 = 32.0;
const BINS: usize = 1024;

/// Attitude and angular velocity, rad/s.
pub(super) type Found = (Quat<f64>, Vec3<f64>);

/// How far it is from the reference, in units of the last place.
pub(super) fn errors((attitude, omega): Found, exact: (Quat<Dd>, Vec3<Dd>)) -> [f64; 2] {
    let turn = (exact.0.conjugate() * Quat::of(attitude)).map(Dd::hi);
    let angle = 2.0 * libm::atan2(turn.v.norm(), turn.w.abs());
    let off = (Vec3::of(omega) - exact.1).map(Dd::hi).norm() / exact.1.map(Dd::hi).norm();
    [angle / UNIT, off / UNIT]
}

/// The distribution of one error.
#[derive(Clone, Debug)]
struct Spread {
    counts: Vec<u64>,
    largest: f64,
    worst: Option<(Start, f64)>,
}

impl Spread {
    fn new() -> Self {
        Spread { counts: vec![0; BINS], largest: 0.0, worst: None }
    }

    fn push(&mut self, error: f64, start: &Start, t: f64) {
        // a NaN is larger than any number, and in the last bin
        let bin = if error.is_nan() { BINS } else { (error * FINE) as usize };
        self.counts[bin.min(BINS - 1)] += 1;
        self.reach(error, Some((*start, t)));
    }

    fn reach(&mut self, error: f64, at: Option<(Start, f64)>) {
        if !self.largest.is_nan() && (error.is_nan() || error > self.largest) {
            (self.largest, self.worst) = (error, at);
        }
    }

    fn include(&mut self, other: &Spread) {
        self.counts.iter_mut().zip(&other.counts).for_each(|(count, more)| *count += more);
        self.reach(other.largest, other.worst);
    }

    /// What no more than a share `beyond` of the errors exceed, to the width of a bin.
    fn quantile(&self, beyond: f64) -> f64 {
        let left = (beyond * self.counts.iter().sum::<u64>() as f64) as u64;
        let mut above = 0;
        for (bin, count) in self.counts.iter().enumerate().rev() {
            above += count;
            if above > left {
                return ((bin + 1) as f64 / FINE).min(self.largest);
            }
        }
        0.0
    }
}

/// What was found in one regime.
#[derive(Clone, Debug)]
struct Tally {
    motions: u64,
    points: u64,
    /// Of attitude and angular velocity.
    spreads: [Spread; 2],
    /// Points at which the reference was compared with Carlson's form, and the largest differences.
    compared: u64,
    apart: [f64; 2],
}

impl Tally {
    fn new() -> Self {
        let spreads = [Spread::new(), Spread::new()];
        Tally { motions: 0, points: 0, spreads, compared: 0, apart: [0.0; 2] }
    }

    fn push(&mut self, errors: [f64; 2], start: &Start, t: f64) {
        self.points += 1;
        self.spreads.iter_mut().zip(errors).for_each(|(spread, error)| spread.push(error, start, t));
    }

    fn include(&mut self, other: &Tally) {
        self.motions += other.motions;
        self.points += other.points;
        self.spreads.iter_mut().zip(&other.spreads).for_each(|(spread, more)| spread.include(more));
        self.compared += other.compared;
        self.compare(other.apart);
    }

    fn compare(&mut self, apart: [f64; 2]) {
        for (largest, apart) in self.apart.iter_mut().zip(apart) {
            *largest = larger(*largest, apart);
        }
    }
}

/// Bands of the angle turned: up to 1e3, 1e6, 1e9 and 1e12 rad.
const BANDS: usize = 4;

/// All of it.
#[derive(Clone, Debug)]
pub(super) struct Tallies {
    /// By shape and form.
    regimes: Vec<Tally>,
    bands: Vec<Tally>,
}

impl Tallies {
    fn new() -> Self {
        let regimes = vec![Tally::new(); Shape::ALL.len() * Form::ALL.len()];
        Tallies { regimes, bands: vec![Tally::new(); BANDS] }
    }

    fn include(&mut self, other: &Tallies) {
        for (all, more) in [(&mut self.regimes, &other.regimes), (&mut self.bands, &other.bands)] {
            all.iter_mut().zip(more).for_each(|(tally, more)| tally.include(more));
        }
    }

    fn all(&self) -> Tally {
        let mut all = Tally::new();
        self.regimes.iter().for_each(|tally| all.include(tally));
        all
    }

    /// The largest error of the attitude, and the median.
    #[cfg(test)]
    pub(super) fn largest_and_median(&self) -> [f64; 2] {
        let [spread, _] = &self.all().spreads;
        [spread.largest, spread.quantile(0.5)]
    }
}

/// What the library gives at many times, the bits of `FreeMotion::at` and `FreeMotion::omega_at`.
pub(super) fn library(motion: &FreeMotion, times: &[f64]) -> Result<Vec<Found>, Error> {
    let mut found = Vec::with_capacity(times.len());
    let push = |state: polhode::body::State, omega: nalgebra::Vector3<f64>| {
        found.push((state.attitude, omega.into()));
    };
    motion.each_at(times, push).map_err(unexpected)?;
    Ok(found)
}

/// The motion from a start.
pub(super) fn motion_of(start: &Start) -> Result<FreeMotion, Error> {
    let inertia = Inertia::from_moments(start.moments).map_err(unexpected)?;
    FreeMotion::from_omega(&inertia, Default::default(), start.omega.into()).map_err(unexpected)
}

/// Carlson's form in double-double at time `t`.
fn carlson(motion: &FreeMotion, start: &Start, t: f64) -> (Quat<Dd>, Vec3<Dd>) {
    let point = motion.point_at_dd(Dd::from(t));
    let inverse = Vec3(start.moments.map(|i| Dd::from(motion.body().scale()) / i));
    (point.attitude, point.momentum_body.times(inverse))
}

/// The errors of `evaluate` at `times` times of each of the motions with these numbers.
pub(super) fn measure(
    motions: impl Iterator<Item = u64>,
    times: u64,
    evaluate: impl Fn(&FreeMotion, &[f64]) -> Result<Vec<Found>, Error>,
) -> Result<Tallies, Error> {
    let mut tallies = Tallies::new();
    for number in motions {
        let mut random = Random::new(SEED).stream(number);
        let Some((shape, start)) = grid::start(number % grid::CELLS, &mut random) else { continue };
        let motion = motion_of(&start)?;
        let reference = Reference::new(&start);
        let speed = Vec3(start.omega).norm();
        let turned = |k: u64, random: &mut Random| {
            let angle = libm::exp10(DECADES * (k as f64 + random.uniform()) / times as f64);
            if random.below(2) == 0 { angle } else { -angle }
        };
        let instants: Vec<f64> = (0..times).map(|k| turned(k, &mut random) / speed).collect();
        let tally = &mut tallies.regimes[shape as usize * Form::ALL.len() + reference.form as usize];
        tally.motions += 1;
        let compared = instants[random.below(times) as usize];
        let exact = carlson(&motion, &start, compared);
        let here = reference.at(compared);
        tally.compared += 1;
        tally.compare(apart(here, exact));
        for (k, (found, &t)) in evaluate(&motion, &instants)?.into_iter().zip(&instants).enumerate() {
            let errors = errors(found, reference.at(t));
            tally.push(errors, &start, t);
            tallies.bands[k * BANDS / times as usize].push(errors, &start, t);
        }
    }
    Ok(tallies)
}

/// How far two references are apart, in the same units.
fn apart(a: (Quat<Dd>, Vec3<Dd>), b: (Quat<Dd>, Vec3<Dd>)) -> [f64; 2] {
    let turn = a.0.conjugate() * b.0;
    let angle = turn.v.norm().hi() * 2.0;
    [angle / UNIT, ((a.1 - b.1).norm() / b.1.norm()).to_f64() / UNIT]
}

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Error> {
    // every so many cells, that many motions in each, and times of a motion
    let (stride, rounds, times) = context.scale.pick((13, 1, 20), (1, 1, 150), (1, 16, 1000));
    const BATCHES: u64 = 64;
    let motions = grid::CELLS * rounds / stride;
    let batch = |batch: u64| {
        let numbers = (batch * motions / BATCHES)..((batch + 1) * motions / BATCHES);
        measure(numbers.map(|n| n * stride), times, library)
    };
    let mut tallies = Tallies::new();
    for found in context.in_parallel((0..BATCHES).collect(), batch) {
        tallies.include(&found?);
    }
    let all = tallies.all();
    report.checks += all.points;
    for (quantity, spread) in ["attitude", "omega"].iter().zip(&all.spreads) {
        if spread.largest.is_nan() || spread.largest > PROMISE {
            report.failures.push(format!("{quantity}: an error of {} u exceeds {PROMISE} u", spread.largest));
        }
    }
    if all.apart.iter().any(|apart| apart.is_nan() || *apart > AGREEMENT) {
        report.failures.push(format!("the references differ by {:?} u", all.apart));
    }
    report.conclusion = format!(
        "one evaluation is within {:.1} u of the exact attitude and {:.1} u of the angular velocity at {} points, u = 2^-53",
        all.spreads[0].largest, all.spreads[1].largest, all.points
    );
    report.tables.push(table_of_regimes(&tallies, &all));
    report.tables.push(table_of_bands(&tallies));
    report.tables.push(table_of_worst(&tallies));
    Ok(())
}

fn columns_of_spreads() -> [Column; 6] {
    [
        Column::new("attitude_largest", "u", "largest angle to the exact attitude, rad over 2^-53")
            .heading("attitude, largest"),
        Column::new("attitude_9999", "u", "what one in 10000 exceeds").heading("99.99 %"),
        Column::new("attitude_median", "u", "what half of them exceed").heading("median"),
        Column::new("omega_largest", "u", "largest |omega - exact| / |exact| over 2^-53")
            .heading("omega, largest"),
        Column::new("omega_9999", "u", "what one in 10000 exceeds").heading("99.99 %"),
        Column::new("omega_median", "u", "what half of them exceed").heading("median"),
    ]
}

fn numbers(tally: &Tally) -> [f64; 6] {
    let [attitude, omega] = &tally.spreads;
    let of = |spread: &Spread| [spread.largest, spread.quantile(1e-4), spread.quantile(0.5)];
    let ([a, b, c], [d, e, f]) = (of(attitude), of(omega));
    [a, b, c, d, e, f]
}

fn table_of_regimes(tallies: &Tallies, all: &Tally) -> Table {
    let mut columns = vec![
        Column::new("body", "", "shape: two or three moments nearly equal, or one far smaller, down to 1e-8"),
        Column::new("form", "", "which sums are evaluated, by k and k': limit for k'^2 < 2^-500"),
        Column::new("motions", "", "bodies with starts").hidden(),
        Column::new("points", "", "states compared"),
    ];
    columns.extend(columns_of_spreads());
    columns.extend([
        Column::new(
            "compared",
            "",
            "points at which the reference, the theta form in double-double, is compared with Carlson's",
        )
        .hidden(),
        Column::new("reference_attitude", "u", "largest angle between the two").hidden(),
        Column::new("reference_omega", "u", "the same of the angular velocity").hidden(),
    ]);
    let mut table = Table::new(
        "bound",
        "Errors of one evaluation of the exact motion in doubles, in units u = 2^-53, over a grid of bodies, energies, phases and angles turned from 1 to 1e12 rad; the input is taken as exact.",
        columns,
    );
    let named = tallies.regimes.iter().enumerate().map(|(k, tally)| {
        let [shape, form] = [k / Form::ALL.len(), k % Form::ALL.len()];
        (Shape::ALL[shape].name(), Form::ALL[form].name(), tally)
    });
    for (shape, form, tally) in named.chain([("all", "all", all)]).filter(|(.., tally)| tally.points > 0) {
        let [a, b, c, d, e, f] = numbers(tally);
        let [attitude, omega] = tally.apart;
        table.push(row![
            shape,
            form,
            tally.motions,
            tally.points,
            a,
            b,
            c,
            d,
            e,
            f,
            tally.compared,
            attitude,
            omega
        ]);
    }
    table
}

fn table_of_bands(tallies: &Tallies) -> Table {
    let mut columns =
        vec![Column::new("turned", "rad", "|omega| t at most"), Column::new("points", "", "states compared")];
    columns.extend(columns_of_spreads());
    let mut table = Table::new("turned", "The same by how far the body has turned.", columns);
    for (k, tally) in tallies.bands.iter().enumerate() {
        let [a, b, c, d, e, f] = numbers(tally);
        let turned = libm::exp10((k + 1) as f64 * DECADES / BANDS as f64);
        table.push(row![turned, tally.points, a, b, c, d, e, f]);
    }
    table
}

fn table_of_worst(tallies: &Tallies) -> Table {
    let mut table = Table::new(
        "worst",
        "The inputs of the largest errors: moments about x, y, z, angular velocity at the start, whose attitude is 1, and time.",
        vec![
            Column::new("body", "", "shape"),
            Column::new("form", "", "which sums are evaluated"),
            Column::new("quantity", "", "whose error it is"),
            Column::new("error", "u", "in units of 2^-53"),
            Column::new("I_x", "", "moment").digits(17),
            Column::new("I_y", "", "moment").digits(17),
            Column::new("I_z", "", "moment").digits(17),
            Column::new("omega_x", "rad/s", "at the start").digits(17),
            Column::new("omega_y", "rad/s", "at the start").digits(17),
            Column::new("omega_z", "rad/s", "at the start").digits(17),
            Column::new("t", "s", "time").digits(17),
        ],
    );
    for (k, tally) in tallies.regimes.iter().enumerate() {
        for (quantity, spread) in ["attitude", "omega"].iter().zip(&tally.spreads) {
            let Some((Start { moments: i, omega: w }, t)) = spread.worst else { continue };
            let [shape, form] =
                [Shape::ALL[k / Form::ALL.len()].name(), Form::ALL[k % Form::ALL.len()].name()];
            table.push(row![shape, form, *quantity, spread.largest, i[0], i[1], i[2], w[0], w[1], w[2], t]);
        }
    }
    table
}
