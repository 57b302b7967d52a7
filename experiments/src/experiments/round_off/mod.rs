//! How rounding errors grow: as √n or as n, with compensated sums and without, in `f64` and in double-double.
//!
//! Brouwer's law (Astron. J. 46 (1937) 149): where roundings are random, energy and momentum walk, and their error grows as
//! √n; the attitude, which integrates them, is off by n^(3/2). Roundings with a bias make it n and n². Seen over an ensemble,
//! because one run is one walk. Where sums are compensated the attitude error begins as n: the constants of the method are
//! rounded once, and the clock with them.

mod statistics;

use polhode::body::{Body, Clock, Point, State, Time};
use polhode::inertia::Inertia;
use polhode::method::{Claimed, Energy, Kept, Step, method};
use polhode::num::{Dd, Precise, Random, Real};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, sheet};
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};
use statistics::Walks;

const SEED: u64 = 20_260;
const METHODS: [&str; 4] = ["rattle", "implicit-midpoint", "lie-poisson", "rk8"];
/// Radians per step at the start.
const ANGLE: f64 = 0.05;
/// Steps at which the runs are looked at, per decade.
const LOOKS_A_DECADE: u32 = 4;

/// How the sums of a run are rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// To a double: what rounding takes is dropped after each step.
    Plain,
    /// To a double, and what rounding takes is carried to the next sum: the form of the library.
    Compensated,
    /// To double-double.
    DoubleDouble,
}

impl Form {
    const ALL: [Form; 3] = [Form::Plain, Form::Compensated, Form::DoubleDouble];

    fn name(self) -> &'static str {
        match self {
            Form::Plain => "plain",
            Form::Compensated => "compensated",
            Form::DoubleDouble => "double-double",
        }
    }

    /// Below this an error is the rounding of the state itself.
    fn floor(self) -> f64 {
        match self {
            Form::DoubleDouble => 8.0 * Dd::ROUNDOFF,
            _ => 4.0 * f64::ROUNDOFF,
        }
    }
}

/// What the error is of, and the exponent of its growth by Brouwer's law.
const QUANTITIES: [(&str, &str, f64); 3] = [
    ("momentum", "error of |m|, relative", 0.5),
    ("energy", "error of energy, relative", 0.5),
    ("attitude", "error of attitude (rad)", 1.5),
];

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let count = context.scale.pick(8, 32, 32);
    let longest = context.scale.pick(10_000, 100_000, 10_000_000);
    let longest_dd = context.scale.pick(1_000, 3_000, 100_000);
    let looks = looks(longest);
    let parts: Vec<(&str, u64)> =
        METHODS.iter().flat_map(|name| (0..count).map(move |member| (*name, member))).collect();
    let found = context.in_parallel(parts, |(name, member)| walk(name, member, &looks, longest_dd));
    let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;

    let bodies = format!("{count} random bodies and starts, steps of {ANGLE} rad");
    let mut errors = Table::new(
        "errors",
        format!("Rounding errors of {bodies}: root mean square and mean over the bodies."),
        error_columns(),
    );
    let mut growth = Table::new(
        "growth",
        format!("Exponent of the growth of rounding errors with the number of steps, {bodies}."),
        growth_columns(),
    );
    let mut panels = QUANTITIES.map(|(name, y, _)| Figure::log_log(name, "", "steps", y));
    for (name, members) in METHODS.iter().zip(found.chunks(count as usize)) {
        for (k, form) in Form::ALL.into_iter().enumerate() {
            for (q, (quantity, _, law)) in QUANTITIES.into_iter().enumerate() {
                // of each body the errors at the looks that all bodies have
                let walks = Walks(members.iter().map(|member| member[k][q].clone()).collect());
                let rows = walks.statistics(&looks);
                for s in &rows {
                    let signed = q < 2;
                    errors.push(row![
                        *name,
                        form.name(),
                        quantity,
                        s.steps,
                        count,
                        s.rms,
                        s.rms_low,
                        s.rms_high,
                        signed.then_some(s.mean),
                        signed.then_some(s.mean / s.rms),
                    ]);
                }
                let Some(end) = rows.last() else { continue };
                let found = walks.growth(&looks, form.floor(), Random::new(SEED).stream(1 << 40));
                growth.push(row![
                    *name,
                    form.name(),
                    quantity,
                    found.as_ref().map(|growth| growth.from),
                    end.steps,
                    end.rms,
                    found.as_ref().map(|growth| growth.exponent),
                    found.as_ref().map(|growth| growth.low),
                    found.as_ref().map(|growth| growth.high),
                    law,
                    (q < 2).then_some(end.mean / end.rms),
                    1.0 / (count as f64).sqrt(),
                ]);
                // in double-double there is nothing to be seen but the last digit of the state
                if form == Form::DoubleDouble {
                    continue;
                }
                let points: Vec<_> = rows.iter().map(|s| (s.steps as f64, s.rms)).collect();
                let bars = rows.iter().map(|s| (s.rms_low, s.rms_high)).collect();
                panels[q]
                    .series
                    .push(Curve::new(format!("{name}, {}", form.name()), points).with_spread(bars));
            }
        }
    }
    for (panel, (_, _, law)) in panels.iter_mut().zip(QUANTITIES) {
        guides(panel, law);
    }
    let title = format!(
        "Rounding errors in f64 against steps, root mean square of {bodies}; bars: 95 %; compensated: what rounding takes is \
         carried to the next sum"
    );
    let drawing = sheet("round-off", &title, 1, &panels);
    let views = vec![growth.clone()];
    Ok(Report {
        tables: vec![errors, growth],
        views,
        drawings: vec![drawing],
        seed: Some(SEED),
        ..Report::default()
    })
}

/// Slopes of random roundings and of biased ones, from below the first point of the first curve.
fn guides(panel: &mut Figure, law: f64) {
    let Some(points) = panel.series.first().map(|series| series.points.clone()) else { return };
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return };
    let slopes = if law < 1.0 { [("√n", 0.5), ("n", 1.0)] } else { [("n", 1.0), ("n√n", 1.5)] };
    for (name, slope) in slopes {
        panel.guide(name, slope, (first.0, 0.4 * first.1), [first.0, last.0]);
    }
}

fn error_columns() -> Vec<Column> {
    vec![
        Column::new("method", "", "name in the catalogue"),
        Column::new("form", "", "how sums are rounded: plain, compensated, double-double"),
        Column::new(
            "quantity",
            "",
            "momentum and energy relative to the start where the method keeps them, else to the same run in double-double; attitude \
             in rad, against that run",
        ),
        Column::new("steps", "", "steps taken"),
        Column::new("bodies", "", "bodies of the ensemble").hidden(),
        Column::new("rms", "", "root mean square over the bodies").digits(2),
        Column::new("rms_low", "", "lower end of its 95 % interval").digits(2).hidden(),
        Column::new("rms_high", "", "upper end of its 95 % interval").digits(2).hidden(),
        Column::new("mean", "", "mean over the bodies, with its sign").digits(2),
        Column::new(
            "mean_over_rms",
            "",
            "their ratio, which is near 0 for random roundings and ±1 for a bias",
        )
        .heading("mean/rms")
        .digits(2),
    ]
}

fn growth_columns() -> Vec<Column> {
    vec![
        Column::new("method", "", "name in the catalogue"),
        Column::new("form", "", "how sums are rounded: plain, compensated, double-double"),
        Column::new("quantity", "", "what the error is of"),
        Column::new("steps_from", "", "first number of steps of the fit").heading("from").hidden(),
        Column::new("steps", "", "steps at the end"),
        Column::new("rms", "", "root mean square of the errors at the end").digits(2),
        Column::new(
            "exponent",
            "",
            "p of the growth as steps^p, over the last two decades; empty where the error is the rounding of the state itself",
        )
        .digits(3),
        Column::new("exponent_low", "", "lower end of its 95 % interval").heading("from").digits(3),
        Column::new("exponent_high", "", "upper end of its 95 % interval").heading("to").digits(3),
        Column::new("law", "", "the exponent of Brouwer's law").digits(2),
        Column::new("mean_over_rms", "", "mean over root mean square of the errors at the end")
            .heading("mean/rms")
            .digits(2),
        Column::new("scatter", "", "standard deviation of that ratio for random roundings").digits(2),
    ]
}

fn looks(longest: u64) -> Vec<u64> {
    let at = |k: u32| libm::round(libm::exp10(2.0 + f64::from(k) / f64::from(LOOKS_A_DECADE))) as u64;
    (0..).map(at).take_while(|n| *n <= longest).collect()
}

/// Errors at the looks: of each form and quantity as many as there are.
type Errors = [[Vec<f64>; 3]; 3];

/// The errors of one member of the ensemble; it runs in double-double for `longest_dd` steps.
fn walk(name: &str, member: u64, looks: &[u64], longest_dd: u64) -> Result<Errors, Error> {
    let (body, start) = draw(member)?;
    let start = body.enter(&start).map_err(unexpected)?;
    let method = method(name).map_err(unexpected)?;
    let kept = method.claims(body.problem()).map_or(Kept::NOTHING, |claims| claims.kept);
    let speed = body.omega_of(&start).norm();
    let clock = Clock::new(ANGLE / speed);
    let precise = looks.iter().copied().filter(|n| *n <= longest_dd);
    let reference = points(method.prepare_dd(clock, &body).map_err(unexpected)?, start, precise, false);
    let mut errors = Errors::default();
    for (form, errors) in Form::ALL.into_iter().zip(&mut errors) {
        let points: Vec<Point<Dd>> = match form {
            Form::DoubleDouble => reference.clone(),
            _ => {
                let step = method.prepare_f64(clock, &body).map_err(unexpected)?;
                let plain = form == Form::Plain;
                points(step, start.to_f64(), looks.iter().copied(), plain).iter().map(Point::to_dd).collect()
            }
        };
        let begun = Quantities::of(&body, &start);
        for (n, point) in points.iter().enumerate() {
            let now = Quantities::of(&body, point);
            let precise = reference.get(n).filter(|_| form != Form::DoubleDouble);
            // what the method itself changes is told from its rounding by the same run in more digits
            let same = precise.map(|x| Quantities::of(&body, x));
            let norm =
                if kept.momentum_norm { Some(begun.norm) } else { same.as_ref().map(|same| same.norm) };
            let exact = kept.energy == Energy::Exact;
            let energy = if exact { Some(begun.energy) } else { same.map(|same| same.energy) };
            errors[0].extend(norm.map(|norm| (now.norm / norm - Dd::ONE).hi()));
            errors[1].extend(energy.map(|energy| (now.energy / energy - Dd::ONE).hi()));
            errors[2].extend(precise.map(|x| rotation_angle(point.attitude, x.attitude).hi()));
        }
    }
    Ok(errors)
}

/// Energy and |m|, in the solver frame.
struct Quantities {
    energy: Dd,
    norm: Dd,
}

impl Quantities {
    fn of(body: &Body, x: &Point<Dd>) -> Self {
        let energy = body.energy_of(Time::from_seconds(0.0), x);
        Quantities { energy, norm: x.momentum_body.norm() }
    }
}

/// The states after the steps `looks`, which ascend. Without compensation what rounding carries is dropped after each step.
fn points<S: Precise>(
    mut step: Box<dyn Step<S>>,
    start: Point<S>,
    looks: impl Iterator<Item = u64>,
    drop_carried: bool,
) -> Vec<Point<S>> {
    /// Steps between renormalisations of the attitude, as in the library.
    const RENORMALIZE_EVERY: u64 = 8;
    let (mut x, mut taken, mut found) = (start, 0, Vec::new());
    step.open(&mut x);
    for n in looks {
        if drop_carried {
            for k in taken..n {
                step.advance(&mut x, 1);
                if k % RENORMALIZE_EVERY == RENORMALIZE_EVERY - 1 {
                    x.renormalize();
                }
                x = Point::new(x.attitude, x.momentum_body);
            }
        } else {
            step.advance(&mut x, n - taken);
        }
        taken = n;
        found.push(step.reading(&x));
    }
    found
}

/// A random body, and a start with |m| = 1 in a random direction.
fn draw(member: u64) -> Result<(Body, State), Error> {
    let mut random = Random::new(SEED).stream(member);
    // any body: each moment is the sum of two of three positive numbers
    let [x, y, z] = [(); 3].map(|()| random.between(0.1, 1.0));
    let inertia = Inertia::from_moments([y + z, x + z, x + y]).map_err(unexpected)?;
    let m = random.normal_vector().normalize();
    Ok((Body::free(inertia), State { attitude: Quat::identity(), momentum_body: Vec3(m.into()) }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_carried_makes_the_difference() {
        // over a thousand steps the carried form stays within some units of rounding, the plain one walks
        let errors = (0..8).map(|member| walk("rattle", member, &[1000, 10_000], 0).unwrap());
        let rms = errors.fold([0.0; 2], |sum, errors| {
            [0, 1].map(|form| sum[form] + errors[form][0][1] * errors[form][0][1] / 8.0)
        });
        let [plain, carried] = rms.map(f64::sqrt);
        assert!(carried < 4.0 * f64::EPSILON, "{carried:e}");
        assert!(plain > 5.0 * carried, "{plain:e} {carried:e}");
    }
}
