//! Who is the quickest from how many starts, and how far the others are behind.

use polhode::method::listing;
use polhode::num::Random;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Cell, Column, Table, row, to_digits};

use super::super::compared::Compared;
use super::super::contestants::knows_the_motion;
use super::super::work_precision::GENERAL;
use super::super::work_precision::contest::{CLOSED_FORM, Contestant, Currency};
use super::members::{Ensemble, Kind, SEED};
use crate::statistics::{Interval, Quantiles, median_interval, rounded};

/// Accuracies, rad.
const ACCURACIES: [f64; 6] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

/// Of these at the last horizon some methods are shown.
const SHOWN: [f64; 2] = [1e-4, 1e-8];

/// So many of the quickest methods.
const FRONT: usize = 2;

/// Costs that differ by less than this factor are ties, as two builds of a method differ by as much.
const TIE: f64 = 1.2;

/// Methods further behind the quickest in the median are left out, but the general-purpose ones.
const CLOSE: f64 = 4.0;

/// What Lie-group methods are compared with, and what stands beside them.
const YARDSTICK: &str = "rk4";
const BESIDE: &str = "two-turn@suzuki-4";

/// The bodies of a kind with all methods.
pub(super) struct Field<'a> {
    pub(super) ensemble: &'a Ensemble,
    pub(super) contestants: &'a [Contestant],
}

/// What is made of all fields in one currency.
pub(super) struct Ranking {
    pub(super) ranks: Table,
    pub(super) lie_groups: Table,
    pub(super) conclusion: String,
}

/// A method at one accuracy.
struct Rank<'a> {
    name: &'a str,
    /// Starts from which it gets there.
    reached: u64,
    quickest: Interval,
    /// The same with ties.
    near: Interval,
    /// Its cost over that of the quickest.
    ratios: Quantiles,
    /// 95 % interval of their median.
    interval: (f64, f64),
}

/// Those that reach `accuracy` from half of the starts from which anybody does, the nearest to the quickest first; the closed
/// form, which does not compete, wherever it stands by that.
fn ranked<'a>(
    contestants: &'a [Contestant],
    starts: &[usize],
    (accuracy, horizon): (f64, usize),
    currency: Currency,
) -> Vec<Rank<'a>> {
    let costs = |one: &Contestant| -> Vec<f64> {
        starts.iter().map(|&start| one.cost_from(start, accuracy, horizon, currency)).collect()
    };
    let all: Vec<(&'a str, Vec<f64>)> =
        contestants.iter().map(|one| (one.name.as_str(), costs(one))).collect();
    let least = |k: usize| {
        let rivals = all.iter().filter(|(name, _)| !knows_the_motion(name));
        rivals.map(|(_, costs)| costs[k]).fold(f64::INFINITY, f64::min)
    };
    let least: Vec<f64> = (0..starts.len()).map(least).collect();
    let count = least.iter().filter(|cost| cost.is_finite()).count();
    if 2 * count < starts.len().max(1) {
        return Vec::new();
    }
    let rank = |(name, costs): &(&'a str, Vec<f64>)| {
        let pairs = costs.iter().zip(&least).filter(|(_, least)| least.is_finite());
        let ratios: Vec<f64> = pairs.map(|(cost, least)| cost / least).collect();
        let within = |factor: f64| {
            let within = ratios.iter().filter(|ratio| **ratio <= factor).count();
            Interval::new(within as u64, count as u64)
        };
        Some(Rank {
            name,
            reached: ratios.iter().filter(|ratio| ratio.is_finite()).count() as u64,
            quickest: within(1.0)?,
            near: within(TIE)?,
            interval: median_interval(&ratios, Random::new(SEED).stream(1 << 40))?,
            ratios: Quantiles::of(ratios)?,
        })
    };
    let mut found: Vec<Rank<'a>> = all.iter().filter_map(rank).collect();
    found.retain(|rank| rank.ratios.median.is_finite());
    found.sort_by(|a, b| {
        b.near.share.total_cmp(&a.near.share).then(a.ratios.median.total_cmp(&b.ratios.median))
    });
    found
}

impl<'a> Field<'a> {
    /// Costs of the methods on Lie groups, and of one splitting, over those of the yardstick.
    fn beside(&self, accuracy: f64, horizon: usize, currency: Currency) -> Vec<(&'a str, Compared)> {
        let starts = self.ensemble.starts(self.ensemble.horizons[horizon]);
        let costs = |one: &Contestant| -> Vec<f64> {
            starts.iter().map(|&start| one.cost_from(start, accuracy, horizon, currency)).collect()
        };
        let Some(yardstick) = self.contestants.iter().find(|one| one.name == YARDSTICK).map(costs) else {
            return Vec::new();
        };
        let is_one = |one: &&Contestant| {
            one.name == BESIDE || listing(&one.name).is_some_and(|listing| listing.family == "Lie group")
        };
        let others = self.contestants.iter().filter(is_one);
        others
            .filter_map(|one| Some((one.name.as_str(), Compared::new(&costs(one), &yardstick, SEED)?)))
            .collect()
    }
}

/// The tables of all fields.
pub(super) fn ranking(fields: &[Field], currency: Currency) -> Result<Ranking, Error> {
    let (name, beside, what) = match currency {
        Currency::Evaluations => ("evaluations", "lie-groups", "evaluations"),
        Currency::Time => ("timing", "timing-lie-groups", "processor time"),
    };
    let caption = format!(
        "From which share of random bodies and starts a method takes the least {what} for an attitude error, with 95 % intervals, and its \
         {what} over the least; exact-step, which is exact for free bodies at any step, does not count among the others."
    );
    let mut ranks = Table::new(name, caption, rank_columns());
    let caption = format!(
        "Methods on Lie groups and {BESIDE} beside {YARDSTICK}: {what} for an attitude error, free bodies."
    );
    let mut lie_groups = Table::new(beside, caption, lie_group_columns());
    let mut conclusion = String::new();
    for field in fields {
        let last = field.ensemble.horizons.len() - 1;
        for (horizon, &end) in field.ensemble.horizons.iter().enumerate() {
            let starts = field.ensemble.starts(end);
            for accuracy in ACCURACIES {
                let found = ranked(field.contestants, &starts, (accuracy, horizon), currency);
                let rivals = || found.iter().filter(|rank| rank.name != CLOSED_FORM);
                let front: Vec<&str> = rivals().take(FRONT).map(|rank| rank.name).collect();
                let general = rivals()
                    .filter(|rank| GENERAL.contains(&rank.name))
                    .min_by(|a, b| a.ratios.median.total_cmp(&b.ratios.median));
                let is_shown = |rank: &Rank| {
                    let named = front.contains(&rank.name)
                        || rank.name == CLOSED_FORM
                        || general.is_some_and(|general| general.name == rank.name);
                    named && horizon == last && SHOWN.contains(&accuracy)
                };
                for rank in &found {
                    let is_general = GENERAL.contains(&rank.name);
                    let kept = is_general || rank.ratios.median <= CLOSE || is_shown(rank);
                    if kept {
                        ranks.push(rank.row(
                            field.ensemble.kind,
                            (end, accuracy),
                            starts.len(),
                            is_shown(rank),
                        ));
                    }
                }
                if field.ensemble.kind == Kind::Free && horizon == last && accuracy == SHOWN[1] {
                    conclusion =
                        rivals().next().map_or(String::new(), |first| first.conclusion(end, starts.len()));
                }
                if field.ensemble.kind == Kind::Free && horizon == last {
                    for (name, compared) in field.beside(accuracy, horizon, currency) {
                        let cells = row![end, accuracy, name, compared.count()];
                        lie_groups.push(cells.into_iter().chain(compared.cells()));
                    }
                }
            }
        }
    }
    if ranks.rows().is_empty() {
        return Err(unexpected("no accuracy is reached from half of the starts"));
    }
    Ok(Ranking { ranks, lie_groups, conclusion })
}

impl Rank<'_> {
    fn row(&self, kind: Kind, (end, accuracy): (f64, f64), starts: usize, is_shown: bool) -> [Cell; 19] {
        let held = |ratio: f64| Some(rounded(ratio)).filter(|ratio| ratio.is_finite());
        row![
            kind.name(),
            kind.complement(),
            end,
            accuracy,
            self.name,
            if GENERAL.contains(&self.name) { "yes" } else { "no" },
            starts as u64,
            self.reached,
            self.quickest.share,
            self.quickest.low,
            self.quickest.high,
            self.near.share,
            self.near.low,
            self.near.high,
            held(self.ratios.median),
            held(self.interval.0),
            held(self.interval.1),
            held(self.ratios.high),
            if is_shown { "yes" } else { "no" },
        ]
    }

    fn conclusion(&self, end: f64, starts: usize) -> String {
        format!(
            "{} takes the fewest evaluations, or at most a fifth more, from {} % of {starts} random free bodies ({} to {} %) for {:e} rad over {end} rad",
            self.name,
            to_digits(100.0 * self.near.share, 2),
            to_digits(100.0 * self.near.low, 2),
            to_digits(100.0 * self.near.high, 2),
            SHOWN[1],
        )
    }
}

fn rank_columns() -> Vec<Column> {
    vec![
        Column::new("kind", "", "what is asked; every kind has the same bodies").heading("problem"),
        Column::new("complement", "", "k'2 of starts next to the separatrix: their distance to it")
            .heading("k'²")
            .latex("$k'^2$"),
        Column::new("turned", "", "units of time, about as many rad").digits(2),
        Column::new("accuracy", "rad", "largest attitude error up to then").digits(2),
        Column::new("method", "", "name in the catalogue, with its scheme"),
        Column::new("general", "", "whether the method knows nothing of rotation").hidden(),
        Column::new("starts", "", "bodies and starts that are judged").hidden(),
        Column::new("reached", "", "of these, those from which the method is so accurate at a step that is tried").hidden(),
        Column::new("quickest", "", "share of the starts from which it costs the least; ties count for each").digits(2),
        Column::new("quickest_low", "", "lower end of its 95 % interval (Wilson)").hidden(),
        Column::new("quickest_high", "", "upper end of it").hidden(),
        Column::new("near", "", "share of the starts from which it costs at most a fifth more than the least")
            .heading("within a fifth")
            .digits(2),
        Column::new("near_low", "", "lower end of its 95 % interval (Wilson)").heading("from").digits(2),
        Column::new("near_high", "", "upper end of it").heading("to").digits(2),
        Column::new("ratio", "", "its cost over the least of the others, median over the starts").heading("cost").digits(3),
        Column::new("ratio_low", "", "lower end of the 95 % interval of the median, by ensembles drawn from the starts")
            .heading("from")
            .digits(3),
        Column::new("ratio_high", "", "upper end of it").heading("to").digits(3),
        Column::new("ratio_p90", "", "the same ratio, which nine starts of ten do not exceed; empty where these do not get there")
            .heading("90 %")
            .digits(2),
        Column::new("shown", "", "whether it is in the shortest table: the two of the largest shares, the general-purpose method of the least cost, and exact-step")
            .hidden(),
    ]
}

fn lie_group_columns() -> Vec<Column> {
    vec![
        Column::new("turned", "", "units of time, about as many rad").hidden(),
        Column::new("accuracy", "rad", "largest attitude error up to then").digits(2),
        Column::new("method", "", "name in the catalogue, with its scheme"),
        Column::new("starts", "", "starts from which it or rk4 is so accurate"),
        Column::new("ratio_p10", "", "10 % of its cost over that of rk4").hidden(),
        Column::new("ratio", "", "their median; empty where it is not so accurate from most starts")
            .heading("cost")
            .digits(2),
        Column::new(
            "ratio_low",
            "",
            "lower end of the 95 % interval of the median, by ensembles drawn from the starts",
        )
        .heading("from")
        .digits(2),
        Column::new("ratio_high", "", "upper end of it").heading("to").digits(2),
        Column::new("ratio_p90", "", "90 % of the ratios").heading("90 %").digits(2),
        Column::new("cheaper", "", "share of the starts from which it costs less than rk4").digits(2),
        Column::new("cheaper_low", "", "lower end of its 95 % interval (Wilson)").heading("from").digits(2),
        Column::new("cheaper_high", "", "upper end of it").heading("to").digits(2),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::super::work_precision::contest::Run;
    use super::*;

    /// One run at `cost` from as many starts as there are errors.
    fn contestant(name: &str, points: &[(f64, &[f64])]) -> Contestant {
        let run = |&(cost, errors): &(f64, &[f64])| Run {
            evaluations: vec![cost; errors.len()],
            time: vec![cost; errors.len()],
            errors: vec![errors.iter().map(|error| Some(*error)).collect()],
        };
        Contestant { name: name.into(), runs: points.iter().map(run).collect() }
    }

    #[test]
    fn shares_and_ratios_are_over_the_starts_that_anybody_answers() {
        let lost = f64::INFINITY;
        let all = [
            contestant("exact-step", &[(1.0, &[0.0, 0.0, 0.0, 0.0])]),
            contestant("rk8", &[(10.0, &[1e-9, lost, lost, lost])]),
            contestant("two-turn", &[(11.0, &[1e-9, 1e-9, 1e-9, lost])]),
            contestant("dmv:10", &[(22.0, &[1e-9, 1e-9, 1e-9, lost])]),
        ];
        let ranks = ranked(&all, &[0, 1, 2, 3], (1e-8, 0), Currency::Time);
        let names: Vec<&str> = ranks.iter().map(|rank| rank.name).collect();
        // rk8 is the quickest from one start of three, but does not get there from most
        assert_eq!(names, ["exact-step", "two-turn", "dmv:10"]);
        let [exact, first, second] = &ranks[..] else { panic!("{names:?}") };
        assert_eq!((first.quickest.share, first.near.share, first.reached), (2.0 / 3.0, 1.0, 3));
        assert_eq!((first.ratios.median, second.ratios.median), (1.0, 2.0));
        assert_eq!((second.near.share, exact.ratios.high), (0.0, 0.1));
        assert!(ranked(&all, &[3], (1e-8, 0), Currency::Time).is_empty());
    }
}
