//! Predicted and measured growth over random bodies: how well they agree, and where the prediction ends.

use polhode::flow::FreeMotion;
use polhode::method::{PhaseError, method};
use polhode::num::Random;
use polhode::run::{Run, Watch};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::measured::{looks, smooth_rates};
use super::{Rates, drawn};
use crate::experiment::{Context, Report};

const SEED: u64 = 2026;

const METHODS: [&str; 8] = [
    "rattle",
    "implicit-midpoint",
    "two-turn",
    "lie-poisson",
    "variational-cayley",
    "gauss:4",
    "two-turn@suzuki-4",
    "dmv:6",
];

/// Turn of the body in a step, rad.
const STEPS: [f64; 4] = [0.02, 0.06, 0.2, 0.6];

/// Turn of the body in a run, rad.
const TURN: f64 = 2000.0;

/// Fewest periods of the momentum in it.
const PERIODS: f64 = 40.0;

/// Looks at a run.
const LOOKS: u64 = 512;

/// Classes of |(|L|²/2E − I₂)/I₂|: below these.
const DISTANCES: [f64; 3] = [0.01, 0.1, f64::INFINITY];

/// What became of one body.
struct Found {
    distance: f64,
    outcome: Outcome,
}

enum Outcome {
    /// Difference of predicted and measured growth over the measured one.
    Apart(f64),
    /// What rounding adds is no smaller than a hundredth of what was predicted.
    Rounding,
    /// No prediction.
    Refused,
}

pub(super) fn add(context: &Context, report: &mut Report) -> Result<(), Error> {
    let bodies: u64 = context.scale.pick(64, 64, 5_120);
    let members: Vec<u64> = (0..bodies).collect();
    let found = context.in_parallel(members, |member| examine(member).map(|found| (member, found)));
    let found = found.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let caption = format!(
        "|measured/predicted - 1| of the growth of shift and twist, as angles of the attitude, over {TURN} rad or {PERIODS} periods of the \
         momentum, whichever is more: {bodies} random bodies, each with one method and one step. Near: |(|L|²/2E - I2)/I2|, zero on the separatrix."
    );
    let mut table = Table::new("bodies", caption, columns());
    for (name, by_step) in (0..METHODS.len()).flat_map(|m| [(m, true), (m, false)]) {
        let classes = if by_step { STEPS.len() } else { DISTANCES.len() };
        for class in 0..classes {
            let is_of = |&&(member, ref found): &&(u64, Found)| {
                let (method, step) = draw_of(member);
                let distance = DISTANCES.iter().position(|most| found.distance < *most);
                method == name && if by_step { step == class } else { distance == Some(class) }
            };
            let of: Vec<&(u64, Found)> = found.iter().filter(is_of).collect();
            let count = |wanted: fn(&Outcome) -> bool| {
                of.iter().filter(|(_, found)| wanted(&found.outcome)).count() as u64
            };
            let mut apart: Vec<f64> = of
                .iter()
                .filter_map(|(_, found)| match found.outcome {
                    Outcome::Apart(apart) => Some(apart),
                    _ => None,
                })
                .collect();
            apart.sort_by(f64::total_cmp);
            let quantile = |share: f64| {
                apart.get((share * apart.len().saturating_sub(1) as f64 + 0.5) as usize).copied()
            };
            table.push(row![
                METHODS[name],
                by_step.then(|| STEPS[class]),
                (!by_step).then(|| if class == 0 { 0.0 } else { DISTANCES[class - 1] }),
                of.len() as u64,
                apart.len() as u64,
                quantile(0.5),
                quantile(0.9),
                quantile(1.0),
                count(|outcome| matches!(outcome, Outcome::Rounding)),
                count(|outcome| matches!(outcome, Outcome::Refused)),
                TURN,
                PERIODS,
            ]);
        }
    }
    report.tables.push(table);
    Ok(())
}

/// Method and step of a body: every pair the same number of times.
fn draw_of(member: u64) -> (usize, usize) {
    let member = member as usize;
    (member % METHODS.len(), member / METHODS.len() % STEPS.len())
}

fn examine(member: u64) -> Result<Found, Error> {
    let (name, step) = draw_of(member);
    let (body, start) = drawn(Random::new(SEED).stream(member))?;
    let method = method(METHODS[name]).map_err(unexpected)?;
    let h = STEPS[step];
    let point = body.enter(&start).map_err(unexpected)?.to_f64();
    let motion = FreeMotion::from_point(body.inertia(), point.to_dd());
    let character = motion.character().map_err(unexpected)?;
    let distance = character.separatrix_distance.abs();
    let drift = match method.phase(&body, &start, h) {
        Ok(drift) => drift,
        Err(
            PhaseError::Coarse { .. }
            | PhaseError::Unsettled { .. }
            | PhaseError::Separatrix
            | PhaseError::Long { .. },
        ) => {
            return Ok(Found { distance, outcome: Outcome::Refused });
        }
        Err(error) => return Err(unexpected(error)),
    };
    if drift.attitude_error(TURN).map_err(unexpected)? < 100.0 * drift.rounding(TURN) {
        return Ok(Found { distance, outcome: Outcome::Rounding });
    }
    let mut run = Run::new(&method, &body, &start, h).map_err(unexpected)?.watching(Watch::Never);
    let time = character.polhode_period.map_or(TURN, |period| TURN.max(PERIODS * period));
    let steps: Vec<u64> = (1..=LOOKS).map(|k| ((time / h) as u64 * k) / LOOKS).collect();
    let predicted = Rates::of(&drift);
    let measured = smooth_rates(&looks(&mut run, &motion, &steps, &drift)?);
    let apart = measured.apart(predicted, character.spin);
    Ok(Found { distance, outcome: Outcome::Apart(apart) })
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("method", "", "name in the catalogue"),
        Column::new("step", "rad", "turn of the body in a step; empty where all steps are taken together").digits(2),
        Column::new("near", "", "least distance from the separatrix, up to the next of 0, 0.01, 0.1; empty where all are taken together").digits(2),
        Column::new("bodies", "", "random bodies"),
        Column::new("predicted", "", "of these with a prediction that stands out of rounding"),
        Column::new("median", "", "median of |measured/predicted - 1|").digits(2),
        Column::new("q90", "", "its 90 % quantile").heading("90 %").digits(2),
        Column::new("largest", "", "its largest value").digits(2),
        Column::new("rounding", "", "bodies whose prediction is less than 100 times what rounding adds"),
        Column::new("refused", "", "bodies without a prediction, by the function itself"),
        Column::new("turn", "rad", "turn of the body over which the growth is measured, at least").hidden(),
        Column::new("periods", "", "periods of the momentum over which it is measured, at least").hidden(),
    ]
}
