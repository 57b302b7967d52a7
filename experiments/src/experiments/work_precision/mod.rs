//! Work against precision: every method on free and forced bodies, from an ensemble of starts, at many steps, to several
//! horizons.

mod cases;
pub(super) mod contest;
pub(super) mod entry;
mod panel;
mod tables;
mod which;

use polhode::truth::Truth;
use polhode_files::error::Error;
use polhode_pages::figure::{Figure, sheet};

use self::cases::{Case, FEW};
use self::contest::{Currency, Run};
use self::entry::{Budget, Found, contestant, families};
use self::tables::{Contest, costs, error_row, is_free, winners};
use crate::experiment::{Context, Report};

pub(super) use tables::GENERAL;
pub(crate) use which::Which;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let cases = cases::all(context.scale)?;
    let motions = motions(context, &cases)?;
    let budget = Budget {
        evaluations: context.scale.pick(10.0, 60.0, 160.0),
        tolerances: context.scale.pick(3, 2, 1),
    };
    let mut parts = Vec::new();
    for (k, case) in cases.iter().enumerate() {
        for family in families(&case.body, case.unit, budget)? {
            parts.push((k, family));
        }
    }
    let found: Vec<Result<_, Error>> = context.in_parallel(parts, |(k, family)| {
        let (mut time, mut runs): (_, Vec<Found>) = (None, Vec::new());
        for entry in &family {
            runs.push(entry.measure(&cases[k], &motions[k], &mut time)?);
            // the next ones would cost more for no more
            let known: Vec<&Run> = runs.iter().map(|found| &found.run).collect();
            if entry::is_settled(cases[k].common(), &known) {
                break;
            }
        }
        Ok((k, family, runs))
    });
    let mut errors = tables::errors();
    let mut contests: Vec<Contest> = cases
        .iter()
        .zip(&motions)
        .map(|(case, motions)| Contest { case, motions, contestants: Vec::new() })
        .collect();
    for part in found {
        let (k, family, runs) = part?;
        family.iter().zip(&runs).for_each(|(entry, run)| errors.push(error_row(&cases[k], entry, run)));
        let runs = runs.into_iter().map(|found| found.run).collect();
        contests[k].contestants.extend(contestant(&family, runs));
    }
    let fewest = winners("winners", &contests, Currency::Evaluations);
    let mut report = Report::default();
    for (accuracy, name) in [("0.0001", "winners-4"), ("1e-8", "winners-8"), ("1e-12", "winners-12")] {
        let caption = format!("Who holds the attitude to {accuracy} rad with the fewest evaluations.");
        let hidden = ["accuracy", "evaluations_next"];
        report.views.push(fewest.view(name, caption, &hidden, ("accuracy", accuracy)));
    }
    let sheets = [
        (true, "Free bodies", ["free-time", "free-evaluations"]),
        (false, "Tops, and bodies in orbit", ["forced-time", "forced-evaluations"]),
    ];
    for (free, what, names) in sheets {
        for (currency, name) in [Currency::Time, Currency::Evaluations].into_iter().zip(names) {
            let shown = contests.iter().filter(|contest| is_free(contest.case.kind) == free);
            let panels: Vec<Figure> = shown.map(|contest| panel::panel(contest, currency)).collect();
            let title = format!(
                "{what}: largest attitude error up to the end against cost, medians over the starts, bars from 10 to 90 %; wide: \
                 the least of all but exact-step"
            );
            report.drawings.push(sheet(name, &title, 2, &panels));
        }
    }
    let costs = costs(&contests);
    report.conclusion = Which::of(&costs.csv()).map_err(Error::Failed)?.claim();
    report.timing = Some(winners("timing", &contests, Currency::Time));
    report.times = vec![costs];
    report.tables = vec![errors, fewest];
    report.seed = Some(cases::SEED);
    Ok(report)
}

/// The true motions of a case.
struct Motions {
    /// From every start.
    all: Vec<Truth>,
    /// Beyond `LONG` from the first `FEW` starts, where those end before.
    far: Vec<Truth>,
}

impl Motions {
    /// Those that go on to the last horizon of a case, from the first `FEW` starts.
    fn far(&self) -> &[Truth] {
        if self.far.is_empty() { &self.all[..FEW.min(self.all.len())] } else { &self.far }
    }
}

/// The true motions of every case.
fn motions(context: &Context, cases: &[Case]) -> Result<Vec<Motions>, Error> {
    let starts = cases.iter().flat_map(|case| (0..case.starts.len()).map(move |start| (case, start)));
    // those without a closed form stand last and take longest: first, so that no core waits at the end
    let parts: Vec<_> = starts.rev().collect();
    let found = context.in_parallel(parts, |(case, start)| {
        let far = if start < FEW { case.far_motion(start)? } else { None };
        Ok((case.motion(start)?, far))
    });
    let mut found = found.into_iter().rev();
    let of_case = |case: &Case| {
        let found: Vec<_> = found.by_ref().take(case.starts.len()).collect::<Result<_, Error>>()?;
        let (all, far): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        Ok(Motions { all, far: far.into_iter().flatten().collect() })
    };
    cases.iter().map(of_case).collect()
}
