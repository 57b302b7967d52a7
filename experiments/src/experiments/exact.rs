//! How exact the exact motion is: against fixtures of 36 digits by regime, and over random bodies close to every
//! degenerate case; with golden trajectories for other projects.

use std::collections::BTreeMap;

use polhode::body::{Body, Point, State, Time};
use polhode::catalogue;
use polhode::flow::{Flow, FreeBody, FreeMotion};
use polhode::inertia::Inertia;
use polhode::num::{Dd, Precise, Random};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::truth::LOST;
use polhode_files::error::Error;
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::table::{Column, Table, row, to_digits};

use crate::experiment::{Context, Report};
use crate::statistics::larger;
use crate::timing::{best, discard};

const FIXTURES: &str = include_str!("../../data/free_body.csv");

/// What is promised: attitude in rad, angular velocity relative.
const PROMISE: f64 = 1e-14;
/// The same over random bodies.
const RANDOM_PROMISE: f64 = 1e-13;

const SEED: u64 = 20_261_121;

/// Bodies of the golden trajectories.
const GOLDEN: [&str; 10] = [
    "dyadic",
    "textbook",
    "toutatis",
    "racket",
    "t-handle",
    "phone",
    "water",
    "spacecraft",
    "prolate",
    "oblate",
];

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut report = Report { seed: Some(SEED), ..Report::default() };
    fixtures(&mut report)?;
    random(context, &mut report);
    for name in GOLDEN {
        report.data.push(golden(name)?);
    }
    report.timing = Some(timing()?);
    Ok(report)
}

/// Largest errors over some cases.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    cases: u64,
    attitude: f64,
    omega: f64,
    plain_attitude: f64,
}

impl Worst {
    fn include(&mut self, other: Worst) {
        self.cases += other.cases;
        self.attitude = larger(self.attitude, other.attitude);
        self.omega = larger(self.omega, other.omega);
        self.plain_attitude = larger(self.plain_attitude, other.plain_attitude);
    }

    /// The error of plain arithmetic unless the attitude is lost.
    fn held_plain(&self) -> Option<f64> {
        Some(self.plain_attitude).filter(|error| *error <= LOST)
    }
}

fn fixtures(report: &mut Report) -> Result<(), Error> {
    let (mut by_regime, mut by_time): (BTreeMap<&str, Worst>, BTreeMap<i32, Worst>) = Default::default();
    for (number, line) in FIXTURES.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).skip(1) {
        let broken = || Error::Failed(format!("free_body.csv:{}: not a case", number + 1));
        let fields: Vec<&str> = line.split(',').collect();
        let double = |k: usize| fields.get(k).and_then(|f| f.parse::<f64>().ok()).ok_or_else(broken);
        let digits = |k: usize| fields.get(k).and_then(|f| f.parse::<Dd>().ok()).ok_or_else(broken);
        let moments = [double(2)?, double(3)?, double(4)?];
        let start = Vec3([double(6)?, double(7)?, double(8)?]);
        let attitude = Quat::from_components([double(9)?, double(10)?, double(11)?, double(12)?]);
        let t = double(13)?;
        let momentum = Vec3([digits(14)?, digits(15)?, digits(16)?]);
        let result = Quat::from_components([digits(17)?, digits(18)?, digits(19)?, digits(20)?]);

        let body = Body::free(Inertia::from_positive_moments(moments).map_err(|_| broken())?);
        let inside = if fields[5] == "omega" {
            body.enter_omega(attitude, start)
        } else {
            body.enter(&State { attitude, momentum_body: start })
        };
        let inside = inside.map_err(|_| broken())?;
        let motion = FreeMotion::from_point(body.inertia(), inside);
        let x = motion.point_at(t);
        let mut plain = inside.to_f64();
        FreeBody::<f64>::new(&body.rotor()).flow(Time::from_seconds(0.0), t, &mut plain);
        let scale = Dd::from(body.scale());
        let exact = Point::new(result, momentum * (Dd::ONE / scale));
        let found = Worst { plain_attitude: attitude_error(&plain, &exact), ..errors(&body, &x, &exact) };
        by_regime.entry(fields[1]).or_default().include(found);
        let turned = motion.character().map_or(0.0, |c| c.spin * t.abs());
        by_time.entry(decade(turned)).or_default().include(found);
    }
    let columns = |first: Column| {
        vec![
            first,
            Column::new("cases", "", "states compared"),
            Column::new("attitude_error", "rad", "largest angle to the fixture")
                .heading("attitude")
                .digits(2),
            Column::new("omega_error", "", "largest |omega - exact| / |exact|").heading("omega").digits(2),
            Column::new(
                "plain_attitude_error",
                "rad",
                "the same angle with all constants and phases in f64; empty where it exceeds 1 rad",
            )
            .heading("f64 only")
            .digits(2),
        ]
    };
    let mut regimes = Table::new(
        "regimes",
        "Exact motion against fixtures of 36 digits, |omega| t up to 1e11 and beyond, by regime.",
        columns(Column::new("regime", "", "kind of body and start")),
    );
    for (regime, worst) in &by_regime {
        regimes.push(row![*regime, worst.cases, worst.attitude, worst.omega, worst.held_plain()]);
    }
    let mut times = Table::new(
        "times",
        "The same by how far the body has turned.",
        columns(Column::new("turned", "rad", "|omega| t at most")),
    );
    for (power, worst) in &by_time {
        times.push(row![
            libm::exp10(f64::from(*power)),
            worst.cases,
            worst.attitude,
            worst.omega,
            worst.held_plain()
        ]);
    }
    let mut all = Worst::default();
    by_regime.values().for_each(|worst| all.include(*worst));
    if !(all.attitude <= PROMISE && all.omega <= PROMISE) {
        report.failures.push(format!("errors {:e} rad and {:e} exceed {PROMISE:e}", all.attitude, all.omega));
    }
    report.checks += all.cases;
    report.conclusion = format!(
        "the closed form is within {} rad of {} states of 36 digits, in every regime, up to 1e12 rad turned",
        to_digits(all.attitude, 2),
        all.cases
    );
    report.tables.extend([regimes, times]);
    let mut figure = Figure::log_log(
        "times",
        "Largest attitude error of the closed form over all regimes, by the arithmetic of its constants",
        "turned (rad)",
        "attitude error (rad)",
    );
    let curve = |name: &str, error: fn(&Worst) -> Option<f64>| {
        let point = |(power, worst): (&i32, &Worst)| Some((libm::exp10(f64::from(*power)), error(worst)?));
        Curve::new(name, by_time.iter().filter_map(point).collect())
    };
    figure.series =
        vec![curve("double-double", |worst| Some(worst.attitude)), curve("f64 only", Worst::held_plain)];
    figure.level("lost beyond 1 rad", LOST);
    report.figures.push(figure);
    Ok(())
}

/// Decade of an angle from above, in three steps.
fn decade(turned: f64) -> i32 {
    [0, 3, 6, 9].into_iter().find(|power| turned <= libm::exp10(f64::from(*power))).unwrap_or(12)
}

fn attitude_error(x: &Point<f64>, exact: &Point<Dd>) -> f64 {
    rotation_angle(x.to_dd().attitude, exact.attitude).to_f64()
}

fn errors(body: &Body, x: &Point<f64>, exact: &Point<Dd>) -> Worst {
    let inverse: Vec3<Dd> = body.rotor().inverse_moments();
    let omega = exact.momentum_body.times(inverse);
    let difference = x.to_dd().momentum_body.times(inverse) - omega;
    let size = omega.norm();
    let omega = if size == Dd::ZERO { difference.norm() } else { difference.norm() / size };
    Worst { cases: 1, attitude: attitude_error(x, exact), omega: omega.to_f64(), plain_attitude: 0.0 }
}

/// A random body close to some degenerate case, a start close to some special one, and a time.
fn random_case(random: &mut Random) -> ([f64; 3], [f64; 3], f64) {
    let mut decades = |from: f64, to: f64| libm::exp10(random.between(from, to));
    // second moments of mass along three axes: any positive numbers are a body
    let mass = [decades(-4.0, 0.0), decades(-4.0, 0.0), decades(-4.0, 0.0)];
    let mut moments = [mass[1] + mass[2], mass[0] + mass[2], mass[0] + mass[1]];
    let mut split = || 1.0 + decades(-15.0, -1.0);
    let splits = [split(), split()];
    let near = [decades(-15.0, 0.0), decades(-15.0, 0.0), decades(-16.0, -1.0)];
    let t = decades(-2.0, 9.0);
    match random.below(4) {
        0 => moments[1] = moments[0] * splits[0],
        1 => moments = [moments[0], moments[0] * splits[0], moments[0] * splits[1]],
        _ => {}
    }
    let mut omega = [random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
    let axis = random.below(3) as usize;
    match random.below(3) {
        0 => {
            omega[axis] *= near[0];
            omega[(axis + 1) % 3] *= near[1];
        }
        1 => {
            // beside the separatrix: I_h ω_h² (I_h − I_μ) = I_l ω_l² (I_μ − I_l), but for a small part
            let mut order = [0, 1, 2];
            order.sort_by(|&j, &k| moments[j].total_cmp(&moments[k]));
            let [l, mu, h] = order.map(|k| moments[k]);
            let ratio = l * (mu - l) / (h * (h - mu));
            if ratio.is_finite() {
                omega[order[2]] = omega[order[0]] * ratio.sqrt() * (1.0 + near[2]);
            }
        }
        _ => {}
    }
    let size = Vec3(omega).norm();
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    (moments, omega, if size > 0.0 { sign * t / size } else { t })
}

fn random(context: &Context, report: &mut Report) {
    let bodies = context.scale.pick(2_000, 100_000, 1_000_000_u64);
    const BATCH: u64 = 1_000;
    let batch = |number: u64| {
        let mut random = Random::new(SEED).stream(number);
        let mut worst = (Worst::default(), None, None);
        while worst.0.cases < BATCH {
            let (moments, omega, t) = random_case(&mut random);
            // splitting two moments may break a triangle inequality: that is no body
            let Ok(inertia) = Inertia::from_moments(moments) else { continue };
            let body = Body::free(inertia);
            let Ok(start) = body.enter_omega(Quat::identity(), Vec3(omega)) else { continue };
            let motion = FreeMotion::from_point(body.inertia(), start);
            let found = errors(&body, &motion.point_at(t), &motion.point_at_dd(Dd::from(t)));
            if larger(worst.0.attitude, found.attitude) != worst.0.attitude {
                worst.1 = Some((moments, omega, t));
            }
            if larger(worst.0.omega, found.omega) != worst.0.omega {
                worst.2 = Some((moments, omega, t));
            }
            worst.0.include(found);
        }
        worst
    };
    let mut worst = (Worst::default(), None, None);
    for found in context.in_parallel((0..bodies / BATCH).collect(), batch) {
        if found.0.attitude > worst.0.attitude {
            worst.1 = found.1;
        }
        if found.0.omega > worst.0.omega {
            worst.2 = found.2;
        }
        worst.0.include(found.0);
    }
    report.checks += worst.0.cases;
    let mut table = Table::new(
        "random",
        format!(
            "The quick form against double-double over {} random bodies and starts near every degenerate case.",
            worst.0.cases
        ),
        vec![
            Column::new("quantity", "", "attitude in rad, angular velocity relative"),
            Column::new("error", "", "largest over all bodies").digits(2),
            Column::new("bodies", "", "random bodies, one start of each").hidden(),
            Column::new("I1", "", "moment of the worst case").hidden(),
            Column::new("I2", "", "moment of the worst case").hidden(),
            Column::new("I3", "", "moment of the worst case").hidden(),
            Column::new("omega_x", "rad/s", "start of the worst case").hidden(),
            Column::new("omega_y", "rad/s", "start of the worst case").hidden(),
            Column::new("omega_z", "rad/s", "start of the worst case").hidden(),
            Column::new("t", "s", "time of the worst case").digits(2),
        ],
    );
    for (quantity, error, case) in
        [("attitude", worst.0.attitude, worst.1), ("omega", worst.0.omega, worst.2)]
    {
        let Some((i, w, t)) = case else { continue };
        table.push(row![quantity, error, worst.0.cases, i[0], i[1], i[2], w[0], w[1], w[2], t]);
        if error.is_nan() || error > RANDOM_PROMISE {
            report
                .failures
                .push(format!("random bodies: {quantity} error {error:e} exceeds {RANDOM_PROMISE:e}"));
        }
    }
    report.tables.push(table);
}

/// States of a catalogue body near and far, every digit right.
fn golden(name: &'static str) -> Result<Table, Error> {
    let failed = |error: &dyn std::fmt::Display| Error::Failed(format!("{name}: {error}"));
    let named = catalogue::body(name).ok_or_else(|| failed(&"not in the catalogue"))?;
    let motion = FreeMotion::from_omega(&named.inertia, Default::default(), named.omega_body.into())
        .map_err(|error| failed(&error))?;
    let mut table = Table::new(
        format!("golden-{name}"),
        format!(
            "{}. Start: attitude 1, 0, 0, 0; moments {:?} {} about body x, y, z; omega_body {:?} rad/s; no torque. \
             Attitude: unit quaternion, scalar first, active, body to space. Rounded from double-double.",
            named.summary,
            named.inertia.tensor().diagonal().as_slice(),
            named.unit,
            named.omega_body
        ),
        vec![
            Column::new("t", "s", "time"),
            Column::new("q_w", "", "attitude, scalar part"),
            Column::new("q_x", "", "attitude"),
            Column::new("q_y", "", "attitude"),
            Column::new("q_z", "", "attitude"),
            Column::new("omega_body_x", "rad/s", "angular velocity, body axes"),
            Column::new("omega_body_y", "rad/s", "angular velocity, body axes"),
            Column::new("omega_body_z", "rad/s", "angular velocity, body axes"),
        ],
    );
    // a power of two near a tenth of a radian, so that the times are exact in any program
    let speed = Vec3(named.omega_body).norm();
    let unit = libm::exp2(libm::round(libm::log2(0.1 / speed)));
    let near = (0..=100).map(|n| f64::from(n) * unit);
    let far = (10..=30).map(|power| libm::exp2(f64::from(power)) * unit);
    for t in near.chain(far) {
        let inside = motion.point_at_dd(Dd::from(t));
        let [w, x, y, z] = motion.body().leave(&inside).attitude.components();
        let omega = motion.body().omega_of(&inside);
        table.push(row![t, w, x, y, z, omega.x, omega.y, omega.z]);
    }
    Ok(table)
}

fn timing() -> Result<Table, Error> {
    let mut table = Table::new(
        "timing",
        "Cost of the exact motion, least of many bursts on this machine; the nome is below 0.2 away from the separatrix.",
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("complement", "", "k'^2, small near the separatrix").digits(2),
            Column::new("set_up_ns", "ns", "constants of a motion").heading("set-up"),
            Column::new("at_ns", "ns", "one state at any time").heading("at(t)"),
            Column::new("at_many_ms", "ms", "1e5 states").heading("1e5 states"),
        ],
    );
    for name in ["spacecraft", "textbook", "racket", "oblate", "sphere"] {
        let failed = |error: &dyn std::fmt::Display| Error::Failed(format!("{name}: {error}"));
        let named = catalogue::body(name).ok_or_else(|| failed(&"not in the catalogue"))?;
        let set_up = || FreeMotion::from_omega(&named.inertia, Default::default(), named.omega_body.into());
        let motion = set_up().map_err(|error| failed(&error))?;
        let complement = motion.character().map_err(|error| failed(&error))?.complement;
        let times: Vec<f64> = (0..100_000).map(|n| 12.345 * f64::from(n)).collect();
        let set_up_time = best(200, &|| (0..10).for_each(|_| discard(set_up()))) / 10.0;
        let burst = &times[..256];
        let one_by_one = || burst.iter().for_each(|&t| discard(motion.at(t)));
        let at_time = best(500, &one_by_one) / burst.len() as f64;
        let many = best(5, &|| discard(motion.at_many(&times)));
        table.push(row![name, complement, set_up_time * 1e9, at_time * 1e9, many * 1e3]);
    }
    Ok(table)
}
