//! (99942) Apophis past the Earth on 13 April 2029, as a rigid body: what the gravity gradient does to its spin, from the published
//! spin states with their deviations.
//!
//! Left out: the Moon and the Sun, the oblateness of the Earth, what loose material does, and torques of sunlight from the epoch of
//! the elements on. The orbit is the hyperbola that osculates next to the perigee.

mod balance;
mod clone;
mod inputs;

use std::time::Instant;

use polhode::body::Member;
use polhode::flow::{FreeMotion, Mode, TumblingElements};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, Scale};
use polhode_pages::table::{Cell, Column, Table, row};

use self::balance::balance;
use self::clone::{Approach, Spin};
use self::inputs::Published;
use crate::experiment::{Context, Report};
use crate::statistics::largest;
use crate::timing::discard;

const SEED: u64 = 2029;
const HOUR: f64 = 3600.0;
const DAY: f64 = 86_400.0;

/// Followed from so long before the perigee to as long after, s.
const WINDOW: f64 = 2.0 * DAY;

/// Of the clones.
const METHOD: &str = "dop853:1e-11";

/// What is taken for true of its errors.
const FINEST: &str = "dop853:1e-14";

/// The largest residual of energy and angular momentum, relative.
const BALANCE: f64 = 1e-10;

/// Points of a figure.
const DRAWN: usize = 1500;

/// A clone before and after.
#[derive(Clone, Copy)]
struct Passed {
    before: Spin,
    after: Spin,
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let members = context.scale.pick(60, 2_000, 50_000);
    let until = inputs::until_perigee()?;
    let mut report = Report { seed: Some(SEED), ..Report::default() };
    let mut table = quantiles_table(members);
    let mut modes = modes_table(members);
    let mut shares = Vec::new();
    let mut shifts = shift_figure();
    for (k, published) in inputs::published()?.iter().enumerate() {
        let passed = clones(context, published, until, members)?;
        for (quantity, unit, of) in QUANTITIES {
            let mut values: Vec<f64> = passed.iter().filter_map(of).collect();
            values.sort_by(f64::total_cmp);
            let at =
                |p: f64| values.get((p * values.len().saturating_sub(1) as f64).round() as usize).copied();
            let numbers = [0.0, 0.05, 0.5, 0.95, 1.0].map(|p| Cell::from(at(p)));
            table.push(row![published.name, quantity, unit, values.len() as u64].into_iter().chain(numbers));
        }
        for (mode, name) in
            [(Some(Mode::ShortAxis), "short-axis"), (Some(Mode::LongAxis), "long-axis"), (None, "neither")]
        {
            let count = passed.iter().filter(|one| one.after.mode() == mode).count() as u64;
            modes.push(row![published.name, name, count, count as f64 / members as f64]);
            if mode == Some(Mode::ShortAxis) {
                shares.push(count as f64 / members as f64);
            }
        }
        shifts.series.push(cumulative(published.name, &passed));
        if k == 0 {
            report.figures.extend(scatter(&passed));
        }
    }
    report.figures.push(shifts);
    report.conclusion = conclusion(&table, &shares);
    let statements = statements(&table, &shares);
    report.tables.extend([table, modes, statements]);
    accuracy(context, &mut report, until)?;
    windows(context, &mut report, until)?;
    // the grid of phases is for programs
    report.views = report.tables.clone();
    report.tables.push(phases(context)?);
    Ok(report)
}

/// Clones of a spin state through the encounter.
fn clones(context: &Context, published: &Published, until: f64, members: u64) -> Result<Vec<Passed>, Error> {
    let parts: Vec<u64> = (0..members).collect();
    let found = context.in_parallel(parts, |k| {
        let member = member(published, k)?;
        let approach = Approach::of(&member, until, WINDOW)?;
        let after = Spin::of(&approach.free(approach.passed(METHOD)?))?;
        Ok(Passed { before: approach.spin()?, after })
    });
    found.into_iter().collect()
}

fn member(published: &Published, k: u64) -> Result<Member, Error> {
    published.population.member(SEED, k).map_err(unexpected)
}

type Quantity = (&'static str, &'static str, fn(&Passed) -> Option<f64>);

fn period(elements: Option<TumblingElements>, of: fn(TumblingElements) -> f64) -> Option<f64> {
    elements.map(|elements| of(elements) / HOUR)
}

/// Of the periods those in short-axis mode: those of another mode are of another axis.
fn short_axis(spin: &Spin) -> Option<TumblingElements> {
    spin.elements.filter(|elements| elements.mode == Mode::ShortAxis)
}

const SHIFT: &str = "shift of the pole";
const LATITUDE: &str = "change of the pole's latitude";
const SPIN: &str = "effective spin, after over before";

/// From −180 to 180.
fn longitude_change(one: &Passed) -> f64 {
    let change = one.after.pole()[0] - one.before.pole()[0];
    (change + 180.0).rem_euclid(360.0) - 180.0
}

const QUANTITIES: [Quantity; 12] = [
    (SHIFT, "deg", |one| Some(one.before.angle(&one.after))),
    ("change of the pole's longitude", "deg", |one| Some(longitude_change(one))),
    (LATITUDE, "deg", |one| Some(one.after.pole()[1] - one.before.pole()[1])),
    ("latitude of the pole, after", "deg", |one| Some(one.after.pole()[1])),
    (SPIN, "", |one| Some(one.after.effective / one.before.effective)),
    ("|L|, after over before", "", |one| Some(one.after.momentum.norm() / one.before.momentum.norm())),
    ("E/E_0, before", "", |one| Some(one.before.energy_ratio)),
    ("E/E_0, after", "", |one| Some(one.after.energy_ratio)),
    ("P_phi, before", "h", |one| period(short_axis(&one.before), |found| found.precession_period)),
    ("P_phi, after", "h", |one| period(short_axis(&one.after), |found| found.precession_period)),
    ("P_psi, before", "h", |one| period(short_axis(&one.before), |found| found.rotation_period)),
    ("P_psi, after", "h", |one| period(short_axis(&one.after), |found| found.rotation_period)),
];

fn quantiles_table(members: u64) -> Table {
    let caption = format!(
        "Apophis after 13 April 2029 as a rigid body, {members} clones of each state: that of Pravec et al. (2014), and the periods of \
         Durech et al. (2026) with the other elements of 2014; after the encounter periods of those in short-axis mode."
    );
    Table::new(
        "flyby",
        caption,
        vec![
            Column::new("state", "", "spin state that the clones are drawn from"),
            Column::new("quantity", "", "what is counted"),
            Column::new("unit", "", "of the numbers"),
            Column::new("clones", "", "that have it"),
            Column::new("least", "", "of all clones").digits(4),
            Column::new("p05", "", "5 % are below").digits(4).heading("5 %"),
            Column::new("p50", "", "median").digits(4).heading("50 %"),
            Column::new("p95", "", "5 % are above").digits(4).heading("95 %"),
            Column::new("most", "", "of all clones").digits(4),
        ],
    )
}

fn modes_table(members: u64) -> Table {
    Table::new(
        "modes",
        format!("Modes after the encounter of {members} clones."),
        vec![
            Column::new("state", "", "spin state that the clones are drawn from"),
            Column::new("mode", "", "of the free motion after the encounter"),
            Column::new("clones", "", "in this mode"),
            Column::new("share", "", "of all").digits(3),
        ],
    )
}

/// The numbers of a row: least, 5 %, 50 %, 95 %, most.
fn numbers(table: &Table, state: &str, quantity: &str) -> [f64; 5] {
    let is = |cell: &Cell, text: &str| matches!(cell, Cell::Text(found) if **found == *text);
    let found = table.rows().iter().find(|cells| is(&cells[0], state) && is(&cells[1], quantity));
    core::array::from_fn(|k| match found.map(|cells| &cells[4 + k]) {
        Some(Cell::Number(number)) => *number,
        _ => f64::NAN,
    })
}

fn conclusion(table: &Table, shares: &[f64]) -> String {
    let [_, low, middle, high, _] = numbers(table, "Pravec 2014", SHIFT);
    let [_, slow, _, fast, _] = numbers(table, "Pravec 2014", SPIN);
    let share = shares.first().copied().unwrap_or(f64::NAN);
    format!(
        "the pole of Apophis moves by {middle:.1} deg in the median ({low:.1} to {high:.1} of 90 %), its effective spin by a factor of \
         {slow:.2} to {fast:.2}, and {:.1} % of the clones keep to short-axis mode",
        100.0 * share
    )
}

/// What has been printed about the encounter as numbers, and what is found here.
fn statements(table: &Table, shares: &[f64]) -> Table {
    let mut statements = Table::new(
        "statements",
        "What abstracts say of the spin of Apophis after the encounter (Benson et al., arXiv:2210.13365; Durech et al., \
         arXiv:2604.24566), and the clones of both states.",
        vec![
            Column::new("source", "", "of the statement"),
            Column::new("statement", "", "of its abstract"),
            Column::new("pravec_2014", "", "found of the clones of this state").heading("Pravec 2014"),
            Column::new("durech_2026", "", "found of the clones with these periods").heading("Durech 2026"),
        ],
    );
    let states = ["Pravec 2014", "Durech 2026"];
    let [shifts, latitudes, spins] =
        [SHIFT, LATITUDE, SPIN].map(|quantity| states.map(|state| numbers(table, state, quantity)));
    let shift = shifts.map(|[_, _, middle, _, most]| format!("median {middle:.1}, most {most:.1}"));
    let latitude =
        latitudes.map(|[_, low, middle, high, _]| format!("{middle:+.1}, {low:+.1} to {high:+.1}"));
    let spin = spins.map(|[least, .., most]| format!("{least:.2} to {most:.2}"));
    let kept = [0, 1].map(|k| shares.get(k).map_or(String::new(), |share| format!("{:.1} %", 100.0 * share)));
    for (source, statement, [first, second]) in [
        ("Benson 2023", "pole shifts by 10 deg or more", shift),
        ("Benson 2023", "pole comes nearer to the ecliptic", latitude),
        ("Benson 2023", "spin could halve or double", spin),
        ("Durech 2026", "short-axis mode is likely kept", kept),
    ] {
        statements.push(row![source, statement, first, second]);
    }
    statements
}

fn shift_figure() -> Figure {
    Figure::new(
        "flyby-shift",
        "Apophis on 13 April 2029: how far its pole moves, from two published spin states",
        ("shift of the pole (deg)", Scale::Linear),
        ("share of the clones that move less", Scale::Linear),
    )
}

fn cumulative(name: &str, passed: &[Passed]) -> Curve {
    let mut shifts: Vec<f64> = passed.iter().map(|one| one.before.angle(&one.after)).collect();
    shifts.sort_by(f64::total_cmp);
    let last = shifts.len().saturating_sub(1).max(1);
    let points = (0..=200).filter_map(|k| {
        let share = f64::from(k) / 200.0;
        Some((*shifts.get((share * last as f64) as usize)?, share))
    });
    Curve::new(name, points.collect()).plain()
}

/// Poles and periods before and after.
fn scatter(passed: &[Passed]) -> [Figure; 2] {
    let some = &passed[..passed.len().min(DRAWN)];
    let mut poles = Figure::new(
        "flyby-poles",
        "Pole of Apophis' angular momentum before and after 13 April 2029, ecliptic J2000",
        ("longitude (deg)", Scale::Linear),
        ("latitude (deg)", Scale::Linear),
    )
    .scatter();
    let mut periods = Figure::new(
        "flyby-periods",
        "Periods of Apophis before and after 13 April 2029, clones in short-axis mode",
        ("P_phi (h)", Scale::Linear),
        ("P_psi (h)", Scale::Log),
    )
    .scatter();
    type When = fn(&Passed) -> &Spin;
    let times: [(&str, When); 2] = [("after", |one| &one.after), ("before", |one| &one.before)];
    for (name, when) in times {
        // the poles lie about 250 degrees, and are not cut in two at 360
        let pole = |one: &Passed| {
            let [longitude, latitude] = when(one).pole();
            ((longitude - 70.0).rem_euclid(360.0) + 70.0, latitude)
        };
        poles.series.push(Curve::new(name, some.iter().map(pole).collect()).dots());
        let both = |one: &Passed| {
            let found = short_axis(when(one))?;
            Some((found.precession_period / HOUR, found.rotation_period / HOUR))
        };
        periods.series.push(Curve::new(name, some.iter().filter_map(both).collect()).dots());
    }
    [poles, periods]
}

/// The nominal body with its phases at the perigee on a grid.
fn phases(context: &Context) -> Result<Table, Error> {
    let count = context.scale.pick(4, 12, 36);
    let inertia = inputs::inertia()?;
    let published = &inputs::published()?[0];
    let solution = published.population.solutions().next().ok_or_else(|| unexpected("no solution"))?;
    let mut parts = Vec::new();
    for phi in 0..count {
        for psi in 0..count {
            parts.push([phi, psi].map(|k| 360.0 * f64::from(k) / f64::from(count)));
        }
    }
    let found = context.in_parallel(parts, |angles| {
        let elements = solution.elements.with_angles(angles.map(f64::to_radians));
        let start = elements.point(&inertia).map_err(unexpected)?;
        // phases at the perigee: the free motion is followed back from there
        let approach = Approach::along(&FreeMotion::from_point(&inertia, start), 0.0, WINDOW);
        let (before, after) = (approach.spin()?, Spin::of(&approach.free(approach.passed(METHOD)?))?);
        Ok::<_, Error>((angles, before, after))
    });
    let mut table = Table::new(
        "phases",
        "The nominal state of 2014 with other phases at the perigee, those without the torque of the Earth.",
        vec![
            Column::new("phi", "deg", "of the short axis about L at the perigee"),
            Column::new("psi", "deg", "of the body about its short axis at the perigee"),
            Column::new("shift", "deg", "of the pole").digits(3),
            Column::new("spin", "", "effective spin, after over before").digits(3),
            Column::new("energy_ratio", "", "E/E_0, after").digits(4),
        ],
    );
    for one in found {
        let (angles, before, after) = one?;
        let spin = after.effective / before.effective;
        table.push(row![angles[0], angles[1], before.angle(&after), spin, after.energy_ratio]);
    }
    Ok(table)
}

/// Balances of energy and angular momentum, convergence in the tolerance, and time.
fn accuracy(context: &Context, report: &mut Report, until: f64) -> Result<(), Error> {
    let clones = context.scale.pick(2, 8, 40);
    let published = &inputs::published()?[0];
    let approaches = (0..clones).map(|k| Approach::of(&member(published, k)?, until, WINDOW));
    let approaches = approaches.collect::<Result<Vec<_>, Error>>()?;
    let names = ["dop853:1e-8", "dop853:1e-9", "dop853:1e-10", METHOD, "dop853:1e-12", FINEST];
    let exact = context.in_parallel(approaches.iter().collect(), |one| one.passed(FINEST));
    let exact = exact.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let mut table = Table::new(
        "accuracy",
        format!(
            "What is left of energy and angular momentum after the work of a torque that is worked out separately, and how far \
             states after the encounter are from those of {FINEST}, of {clones} clones."
        ),
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("energy", "", "largest residual, relative").digits(2),
            Column::new("momentum", "", "largest residual of L, relative").digits(2),
            Column::new("exchanged", "", "largest share of the energy that was exchanged").digits(2),
            Column::new("attitude", "rad", "largest distance after the encounter").digits(2),
        ],
    );
    let mut timing = Table::new(
        "timing",
        "Processor time of one clone through the encounter, two days before to two days after, on one core.",
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("milliseconds", "ms", "least of five passes over the clones").digits(3),
        ],
    );
    for name in names {
        let found = context.in_parallel(approaches.iter().zip(&exact).collect(), |(one, exact)| {
            let kept = balance(one, name)?;
            let far = polhode::rotation::rotation_angle(one.passed(name)?.attitude, exact.attitude);
            Ok((kept, far))
        });
        let found = found.into_iter().collect::<Result<Vec<_>, Error>>()?;
        let most = |of: &dyn Fn(&(balance::Balance, f64)) -> f64| largest(found.iter().map(of));
        let (energy, momentum) = (most(&|one| one.0.energy), most(&|one| one.0.momentum));
        table.push(row![name, energy, momentum, most(&|one| one.0.exchanged), most(&|one| one.1)]);
        if name == METHOD {
            report.checks += 2;
            for (what, value) in [("energy", energy), ("angular momentum", momentum)] {
                if value.is_nan() || value > BALANCE {
                    report.failures.push(format!("flyby: {what} is off by {value:e}, above {BALANCE:e}"));
                }
            }
        }
        let mut least = f64::INFINITY;
        for _ in 0..5 {
            let clock = Instant::now();
            for one in &approaches {
                discard(one.passed(name)?);
            }
            least = least.min(clock.elapsed().as_secs_f64() / clones as f64);
        }
        timing.push(row![name, 1e3 * least]);
    }
    report.tables.push(table);
    report.timing = Some(timing);
    Ok(())
}

/// How much is outside of the window.
fn windows(context: &Context, report: &mut Report, until: f64) -> Result<(), Error> {
    let clones = context.scale.pick(2, 8, 40);
    let published = &inputs::published()?[0];
    let mut table = Table::new(
        "windows",
        format!(
            "How far the pole after the encounter moves where clones are followed longer, {clones} clones."
        ),
        vec![
            Column::new("days", "d", "followed before the perigee, and as long after"),
            Column::new("pole", "deg", "largest distance from the pole of twice as long").digits(2),
            Column::new("spin", "", "largest difference of the effective spin from that, relative").digits(2),
        ],
    );
    for days in [1.0, 2.0, 4.0, 8.0] {
        let found = context.in_parallel((0..clones).collect(), |k| {
            let member = member(published, k)?;
            let after = |days: f64| {
                let approach = Approach::of(&member, until, days * DAY)?;
                Spin::of(&approach.free(approach.passed(FINEST)?))
            };
            let (one, longer) = (after(days)?, after(2.0 * days)?);
            Ok([one.angle(&longer), (one.effective / longer.effective - 1.0).abs()])
        });
        let found = found.into_iter().collect::<Result<Vec<[f64; 2]>, Error>>()?;
        let most = |k: usize| largest(found.iter().map(|one| one[k]));
        table.push(row![days, most(0), most(1)]);
    }
    report.tables.push(table);
    Ok(())
}
