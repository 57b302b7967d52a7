//! What each family of methods conserves: energy, |m| and the direction of L with their signs, against time.

use polhode::body::Body;
use polhode::catalogue;
use polhode::method::{Claimed, method};
use polhode::num::{Dd, Precise};
use polhode::rotation::Vec3;
use polhode::run::{Run, RunError, Sample, Schedule, Watch};
use polhode::truth::Ending;
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure, Scale, sheet, ten_to};
use polhode_pages::table::{Column, Table, row};

use super::followed::status;
use crate::experiment::{Context, Report};

const BODY: &str = "textbook";

/// A step of 1/32 s: n h is exact, and about 0.035 rad.
const STEP: f64 = 1.0 / 32.0;

/// One method of every family, in the order of the catalogue.
const METHODS: [(&str, &str); 15] = [
    ("explicit-euler", "Euler"),
    ("semi-implicit-euler", "Euler with the attitude after the momentum"),
    ("rk4", "Runge-Kutta"),
    ("rk8", "Runge-Kutta"),
    ("gauss:4", "collocation"),
    ("implicit-midpoint", "midpoint rule with the Cayley map"),
    ("rattle", "discrete Moser-Veselov"),
    ("dmv:10", "discrete Moser-Veselov with modified moments"),
    ("lie-poisson", "splitting by three turns"),
    ("two-turn", "splitting by two turns"),
    ("two-turn@blanes-moan-s6", "splitting by two turns of higher order"),
    ("rkmk4", "Runge-Kutta on the Lie group"),
    ("momentum-euler", "steps of game engines"),
    ("richardson", "steps of molecular dynamics"),
    ("exact-step", "exact motion"),
];

/// Intervals of the time, equal in their logarithms, and looks in each.
const INTERVALS_A_DECADE: u32 = 4;
const LOOKS: u64 = 24;

/// Beyond this change a run says no more.
const TENFOLD: f64 = 10.0;

/// What a look sees: the relative changes of energy and |m| with their signs, and the angle between L and L₀ in rad.
#[derive(Clone, Copy, Debug)]
struct Changes([f64; 3]);

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let power = context.scale.pick(4, 5, 6);
    let counted = ten_to(power as i32);
    let found = context.in_parallel(METHODS.to_vec(), |(name, _)| follow(name, power));
    let caption = format!(
        "Lowest and highest relative change of energy and |m|, and largest angle between L and its direction at the start, in \
         intervals of the time over {counted} steps of 1/32 s, {BODY} body (moments 1, 2, 3)."
    );
    let mut series = Table::new("series", caption, columns());
    let mut summary = series.clone();
    summary.name = "summary".into();
    summary.caption = format!(
        "The same in the last interval of {counted} steps, or in the last before energy or |m| had changed tenfold."
    );
    let mut panels = [
        ("energy", "(E − E₀) / E₀", Scale::Signed),
        ("norm", "(|m| − |m₀|) / |m₀|", Scale::Signed),
        ("direction", "angle of L (rad)", Scale::Log),
    ]
    .map(|(name, y, scale)| Figure::new(name, "", ("time (s)", Scale::Log), (y, scale)).sized(500.0, 280.0));
    for ((name, family), found) in METHODS.into_iter().zip(found) {
        let Followed { intervals, order, ending } = found?;
        for (k, panel) in panels.iter_mut().enumerate() {
            let furthest = |(low, high): (f64, f64)| if high.abs() >= low.abs() { high } else { low };
            let points = intervals.iter().map(|i| (i.time, furthest(i.range[k]))).collect();
            panel.series.push(Curve::new(label(name, order), points));
        }
        for (n, interval) in intervals.iter().enumerate() {
            let [energy, norm, direction] = interval.range;
            let row = row![
                name,
                family,
                order,
                interval.steps,
                interval.time,
                energy.0,
                energy.1,
                norm.0,
                norm.1,
                direction.1,
                ending.clone()
            ];
            if n + 1 == intervals.len() {
                summary.push(row.clone());
            }
            series.push(row);
        }
    }
    let title = format!(
        "What each family of methods conserves over {counted} steps of 1/32 s, {BODY} body (moments 1, 2, 3): of each interval \
         of the time the change that is furthest from zero; order in brackets"
    );
    let drawing = sheet("conservation", &title, 2, &panels);
    Ok(Report { tables: vec![series], views: vec![summary], drawings: vec![drawing], ..Report::default() })
}

fn label(name: &str, order: Option<u64>) -> String {
    order.map_or_else(|| name.to_string(), |order| format!("{name} ({order})"))
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("method", "", "name in the catalogue"),
        Column::new("family", "", "what kind of method it is").hidden(),
        Column::new("order", "", "order of convergence; empty where the steps are exact"),
        Column::new("steps", "", "steps at the end of the interval").hidden(),
        Column::new("time", "s", "time at the end of the interval").hidden(),
        Column::new("energy_low", "", "lowest (E - E0)/E0 of the looks in the interval")
            .heading("energy, lowest")
            .digits(2),
        Column::new("energy_high", "", "highest (E - E0)/E0").heading("highest").digits(2),
        Column::new("momentum_low", "", "lowest (|m| - |m0|)/|m0|").heading("|m|, lowest").digits(2),
        Column::new("momentum_high", "", "highest (|m| - |m0|)/|m0|").heading("highest").digits(2),
        Column::new("direction", "rad", "largest angle between L and L0, in space")
            .heading("angle of L")
            .digits(2),
        Column::new("status", "", "ok, or when energy or |m| had changed tenfold"),
    ]
}

struct Interval {
    steps: u64,
    time: f64,
    /// Lowest and highest value of each change.
    range: [(f64, f64); 3],
}

struct Followed {
    intervals: Vec<Interval>,
    order: Option<u64>,
    ending: String,
}

fn follow(name: &str, power: u32) -> Result<Followed, Error> {
    let named = catalogue::body(BODY).ok_or_else(|| unexpected("no such body in the catalogue"))?;
    let body = Body::free(named.inertia);
    let start = body.state(Default::default(), named.omega_body.into()).map_err(unexpected)?;
    let method = method(name).map_err(unexpected)?;
    let order = method.claims(body.problem()).and_then(|claims| claims.order).map(u64::from);
    let run = Run::new(method.as_ref(), &body, &start, STEP).map_err(unexpected)?;
    let mut run = run.watching(Watch::Never);
    let first = run.sample();
    let (mut intervals, mut ending) = (Vec::new(), Ending::Held);
    let mut begun = 0_u64;
    for end in ends(power) {
        let looks = (1..=LOOKS).map(|k| begun + (end - begun) * k / LOOKS).collect::<Vec<_>>();
        let (mut range, mut reached) = ([(f64::INFINITY, f64::NEG_INFINITY); 3], None);
        for sample in run.samples(Schedule::at(looks)) {
            let sample = match sample {
                Ok(sample) => sample,
                Err(RunError::Diverged { last } | RunError::Unsolved { last, .. }) => {
                    ending = Ending::Diverged(last.elapsed.hi());
                    break;
                }
                Err(error) => return Err(unexpected(error)),
            };
            let changes = changes(&sample, &first);
            if changes.0.iter().any(|change| change.is_nan() || change.abs() > TENFOLD) {
                ending = Ending::Lost(sample.elapsed.hi());
                break;
            }
            for (range, change) in range.iter_mut().zip(changes.0) {
                *range = (range.0.min(change), range.1.max(change));
            }
            reached = Some(sample);
        }
        if let Some(sample) = reached {
            intervals.push(Interval { steps: sample.steps, time: sample.elapsed.hi(), range });
        }
        if ending != Ending::Held {
            break;
        }
        begun = end;
    }
    Ok(Followed { intervals, order, ending: status(ending) })
}

/// Steps at the ends of the intervals.
fn ends(power: u32) -> Vec<u64> {
    let count = INTERVALS_A_DECADE * (power - 1);
    let at = |k: u32| libm::round(libm::exp10(1.0 + f64::from(k) / f64::from(INTERVALS_A_DECADE))) as u64;
    (1..=count).map(at).collect()
}

/// In double-double, so that what is seen is the rounding of the run alone.
fn changes(now: &Sample, first: &Sample) -> Changes {
    let [here, there] = [now, first].map(|sample| sample.point.to_dd());
    let norm = here.momentum_body.norm() / there.momentum_body.norm() - Dd::ONE;
    let (l, l0): (Vec3<Dd>, Vec3<Dd>) = (here.momentum_space(), there.momentum_space());
    let angle = l.cross(l0).norm().atan2(l.dot(l0));
    Changes([now.energy_change, norm.hi(), angle.hi()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_claimed_as_kept_stays_and_what_is_not_leaves() {
        let of = |name: &str| follow(name, 4).unwrap().intervals.pop().unwrap().range;
        let rattle = of("rattle");
        assert!(rattle.iter().all(|range| range.0.abs().max(range.1.abs()) < 1e-13), "{rattle:?}");
        let split = of("lie-poisson");
        assert!(split[0].1 - split[0].0 > 1e-7 && split[0].0.abs() < 1e-4, "{split:?}");
        assert!(split[1].1.abs() < 1e-13 && split[2].1 < 1e-13, "{split:?}");
        let rk4 = of("rk4");
        assert!(rk4[0].1 < -1e-9 && rk4[1].1 < -1e-10 && rk4[2].1 > 1e-9, "{rk4:?}");
        assert!(follow("explicit-euler", 6).unwrap().ending.starts_with("lost at t = "));
    }
}
