//! Which method is the quickest, by kind of problem: what `work-precision` measured, over all bodies of a kind.

mod curves;
mod spans;

use std::collections::BTreeMap;

use polhode_pages::table::{Column, Table, row, to_digits};
use serde::Deserialize;

use super::super::contestants::knows_the_motion;
use super::contest::CLOSED_FORM;

/// Accuracies of the table, rad.
const ACCURACIES: [f64; 3] = [1e-4, 1e-8, 1e-12];

/// The table has, of each kind, the longest horizon up to this one, units of time, and the longest beyond it.
const LONG: f64 = 1e4;

/// A row of `costs.csv`.
#[derive(Clone, Debug, Deserialize)]
struct Row {
    kind: String,
    case: String,
    turned: f64,
    accuracy: f64,
    method: String,
    general: String,
    rk4_steps: f64,
    rk4_steps_p10: f64,
    rk4_steps_p90: Option<f64>,
}

/// What one body asks: a horizon and an accuracy, and what it costs each method.
struct Contest<'a> {
    kind: &'a str,
    case: &'a str,
    turned: f64,
    accuracy: f64,
    /// Ascending in cost, without the closed form.
    costs: Vec<&'a Row>,
}

/// The costs that `work-precision` measured.
pub(crate) struct Which {
    rows: Vec<Row>,
}

/// The methods that reach an accuracy on every body of a kind: geometric means of their costs, ascending.
fn ranked<'a>(contests: &[&Contest<'a>]) -> Vec<(&'a str, f64)> {
    let mut logarithms: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for row in contests.iter().flat_map(|contest| &contest.costs) {
        let (count, sum) = logarithms.entry(&row.method).or_default();
        (*count, *sum) = (*count + 1, *sum + libm::log(row.rk4_steps));
    }
    let everywhere = logarithms.into_iter().filter(|(_, (count, _))| *count == contests.len());
    let mut found: Vec<(&str, f64)> =
        everywhere.map(|(method, (count, sum))| (method, libm::exp(sum / count as f64))).collect();
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    found
}

/// As far as the motions of a kind are known, up to a horizon.
fn longest(contests: &[Contest], kind: &str, until: f64) -> f64 {
    let known = contests.iter().filter(|contest| contest.kind == kind).map(|contest| contest.turned);
    known.filter(|turned| *turned <= until).fold(0.0, f64::max)
}

impl Which {
    /// Of the rows of `costs.csv`.
    ///
    /// # Errors
    /// Rows that are not such costs.
    pub(crate) fn of(csv: &str) -> Result<Self, String> {
        let rows =
            csv::Reader::from_reader(csv.as_bytes()).into_deserialize().collect::<Result<Vec<Row>, _>>();
        let rows = rows.map_err(|error| error.to_string())?;
        match rows.iter().find(|row| row.rk4_steps <= 0.0 || row.rk4_steps.is_nan()) {
            Some(row) => Err(format!("rk4_steps: '{}': is not positive", row.rk4_steps)),
            None => Ok(Which { rows }),
        }
    }

    fn contests(&self) -> Vec<Contest<'_>> {
        let mut contests: Vec<Contest> = Vec::new();
        for row in self.rows.iter().filter(|row| !knows_the_motion(&row.method)) {
            let same = |contest: &&mut Contest| {
                contest.case == row.case && contest.turned == row.turned && contest.accuracy == row.accuracy
            };
            match contests.iter_mut().find(same) {
                Some(contest) => contest.costs.push(row),
                None => contests.push(Contest {
                    kind: &row.kind,
                    case: &row.case,
                    turned: row.turned,
                    accuracy: row.accuracy,
                    costs: vec![row],
                }),
            }
        }
        for contest in &mut contests {
            contest.costs.sort_by(|a, b| a.rk4_steps.total_cmp(&b.rk4_steps));
        }
        contests
    }

    /// Kinds in the order of the rows.
    fn kinds(&self) -> Vec<&str> {
        let mut kinds: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !kinds.contains(&row.kind.as_str()) {
                kinds.push(&row.kind);
            }
        }
        kinds
    }

    fn is_general(&self, method: &str) -> bool {
        self.rows.iter().any(|row| row.method == method && row.general == "yes")
    }

    /// The quickest by kind, horizon and accuracy, the next and the quickest general-purpose method with their costs over its.
    pub(crate) fn table(&self) -> Table {
        let columns = vec![
            Column::new("kind", "", "what is asked").heading("problem"),
            Column::new("turned", "rad", "about how far the body turns").digits(1),
            Column::new("accuracy", "rad", "largest attitude error").digits(1),
            Column::new("method", "", "the quickest method").heading("quickest"),
            Column::new("next", "", "the next one"),
            Column::new("next_ratio", "", "its cost over that of the quickest").heading("cost").digits(2),
            Column::new("general", "", "the quickest general-purpose method").heading("general-purpose"),
            Column::new("general_ratio", "", "its cost over that of the quickest")
                .heading("its cost")
                .digits(2),
            Column::new(
                "exact_step_ratio",
                "",
                "the cost of exact-step over that of the quickest of the others",
            )
            .heading(CLOSED_FORM)
            .digits(2),
        ];
        let caption = "The quickest method with an error of its step, by problem, horizon and accuracy, the next, and the quickest \
                       general-purpose one; their processor times, and that of exact-step, which is exact for free bodies at any \
                       step, over that of the quickest. Times that differ by less than a fifth are ties.";
        let mut table = Table::new("which", caption, columns);
        let contests = self.contests();
        for kind in self.kinds() {
            let mut horizons = [LONG, f64::INFINITY].map(|until| longest(&contests, kind, until)).to_vec();
            horizons.dedup();
            for turned in horizons {
                for accuracy in ACCURACIES {
                    let of = |contest: &&Contest| {
                        contest.kind == kind && contest.turned == turned && contest.accuracy == accuracy
                    };
                    let of: Vec<&Contest> = contests.iter().filter(of).collect();
                    let ranked = ranked(&of);
                    let Some(&(best, cost)) = ranked.first() else { continue };
                    let next = ranked.get(1);
                    let general = ranked.iter().find(|(method, _)| self.is_general(method));
                    table.push(row![
                        kind,
                        turned,
                        accuracy,
                        best,
                        next.map(|next| next.0),
                        next.map(|next| next.1 / cost),
                        general.map(|general| general.0),
                        general.map(|general| general.1 / cost),
                        self.closed_form_in_the_mean(&of).map(|closed| closed / cost),
                    ]);
                }
            }
        }
        table
    }

    /// Whether some method is quicker than the general-purpose methods at every accuracy, in sentences.
    pub(crate) fn claim(&self) -> String {
        let contests = self.contests();
        let mut problems: Vec<(&str, &str, f64)> = Vec::new();
        for contest in &contests {
            let problem = (contest.kind, contest.case, contest.turned);
            if !problems.contains(&problem) {
                problems.push(problem);
            }
        }
        let mut beaten: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        let mut best: BTreeMap<&str, usize> = BTreeMap::new();
        for (kind, case, turned) in &problems {
            let of = contests.iter().filter(|contest| contest.case == *case && contest.turned == *turned);
            let methods = self.quicker_everywhere(&of.collect::<Vec<_>>());
            let (all, with) = beaten.entry(kind).or_default();
            (*all, *with) = (*all + 1, *with + usize::from(!methods.is_empty()));
            for method in methods {
                *best.entry(method).or_default() += 1;
            }
        }
        let count = problems.len();
        let (with, most) =
            (beaten.values().map(|(_, with)| with).sum::<usize>(), best.iter().max_by_key(|b| b.1));
        let by_kind: Vec<String> = self
            .kinds()
            .into_iter()
            .filter_map(|kind| beaten.get(kind).map(|(all, with)| format!("{kind} {with} of {all}")))
            .collect();
        let everywhere = most.filter(|(_, n)| **n == count);
        let first = match (everywhere, most) {
            (Some((method, _)), _) => format!(
                "{method} is quicker than every general-purpose method at every accuracy of all {count} problems"
            ),
            (None, Some((method, n))) => format!(
                "Of the methods with a step error, none is quicker than the general-purpose ones at every accuracy of every problem. In {with} of the {count} problems \
                 (a body and a horizon) some method is so at every accuracy from half of the starts ({}); most often it is {method}, in {n}",
                by_kind.join(", ")
            ),
            (None, None) => format!(
                "Of the methods with a step error, none is quicker than the general-purpose ones at every accuracy in any of the {count} problems (a body and a horizon)"
            ),
        };
        let general: Vec<&str> = contests
            .iter()
            .filter_map(|contest| contest.costs.iter().find(|row| row.general == "yes"))
            .map(|row| row.method.as_str())
            .collect();
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for method in &general {
            *counts.entry(method).or_default() += 1;
        }
        let mut counts: Vec<(&str, usize)> = counts.into_iter().collect();
        counts.sort_by_key(|(method, n)| (std::cmp::Reverse(*n), *method));
        let counts: Vec<String> = counts.iter().map(|(method, n)| format!("{method} {n}")).collect();
        format!(
            "{first}. The quickest general-purpose method, counted over problems and accuracies: {} of {}.{}\n",
            counts.join(", "),
            general.len(),
            self.closed_form(&contests)
        )
    }

    /// The cost of the closed form in equal steps where a contest has it.
    fn closed_form_in(&self, contest: &Contest) -> Option<f64> {
        let same = |row: &&Row| {
            (&*row.case, row.turned, row.accuracy) == (contest.case, contest.turned, contest.accuracy)
        };
        self.rows.iter().filter(same).find(|row| row.method == CLOSED_FORM).map(|row| row.rk4_steps)
    }

    /// The geometric mean of its costs, where all contests have it.
    fn closed_form_in_the_mean(&self, contests: &[&Contest]) -> Option<f64> {
        let logarithms = contests.iter().map(|contest| Some(libm::log(self.closed_form_in(contest)?)));
        Some(libm::exp(logarithms.sum::<Option<f64>>()? / contests.len() as f64))
    }

    /// What the closed form in equal steps costs beside the quickest of the other methods; nothing where no row has it.
    fn closed_form(&self, contests: &[Contest]) -> String {
        let ratio =
            |contest: &Contest| Some(contest.costs.first()?.rk4_steps / self.closed_form_in(contest)?);
        let mut ratios: Vec<f64> = contests.iter().filter_map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let Some(median) = ratios.get(ratios.len() / 2) else { return String::new() };
        let cheaper = ratios.iter().filter(|ratio| **ratio > 1.0).count();
        format!(
            " {CLOSED_FORM}, the closed form in equal steps, takes less time than the quickest of these methods in {cheaper} of the {} \
             problems and accuracies of free bodies; in the median theirs is {} times its time.",
            ratios.len(),
            to_digits(*median, 2)
        )
    }

    /// The methods that are quicker than every general-purpose one at every accuracy that anybody reaches.
    fn quicker_everywhere<'a>(&self, contests: &[&Contest<'a>]) -> Vec<&'a str> {
        let quicker = |contest: &&Contest<'a>| -> Vec<&'a str> {
            let special = contest.costs.iter().take_while(|row| row.general != "yes");
            special.map(|row| row.method.as_str()).collect()
        };
        let mut all = contests.iter().map(quicker);
        let first = all.next().unwrap_or_default();
        all.fold(first, |kept, more| kept.into_iter().filter(|method| more.contains(method)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "kind,case,turned,accuracy,method,general,rk4_steps,rk4_steps_p10,rk4_steps_p90\n";

    fn which(rows: &[&str]) -> Which {
        let rows = rows.iter().map(|row| format!("{row},1.0,\n")).collect::<String>();
        Which::of(&(HEAD.to_owned() + &rows)).unwrap()
    }

    #[test]
    fn the_quickest_is_the_least_in_the_mean_of_those_that_reach_every_body() {
        let which = which(&[
            "free,a,10000.0,0.0001,dmv:10,no,2.0",
            "free,a,10000.0,0.0001,exact-step,no,0.1",
            "free,a,10000.0,0.0001,rk8,yes,4.0",
            "free,a,10000.0,0.0001,two-turn,no,1.0",
            "free,b,10000.0,0.0001,rk8,yes,1.0",
            "free,b,10000.0,0.0001,dmv:10,no,8.0",
            "free,a,10000.0,1e-8,dmv:10,no,2.0",
            "free,a,10000.0,1e-8,exact-step,no,0.5",
            "free,b,1e6,1e-8,dmv:10,no,3.0",
        ]);
        let text = which.table().csv();
        assert!(text.contains("free,10000.0,0.0001,rk8,dmv:10,2.0,rk8,1.0,\n"), "{text}");
        assert!(text.contains("free,10000.0,1e-8,dmv:10,,,,,0.25\n"), "{text}");
        assert!(text.ends_with("free,1000000.0,1e-8,dmv:10,,,,,\n"), "{text}");
    }

    #[test]
    fn the_claim_says_what_the_rows_say() {
        let both = [
            "top,a,100.0,0.01,split,no,1.0",
            "top,a,100.0,0.01,rk4,yes,2.0",
            "top,a,100.0,1e-6,split,no,1.0",
        ];
        assert!(which(&both).claim().starts_with("split is quicker than every general-purpose method"));
        let beaten = [&both[..], &["top,b,100.0,0.01,rk8,yes,1.0", "top,b,100.0,0.01,split,no,1.5"]].concat();
        let claim = which(&beaten).claim();
        assert!(
            claim.starts_with("Of the methods with a step error, none is quicker")
                && claim.contains("In 1 of the 2 problems"),
            "{claim}"
        );
        assert!(claim.ends_with("rk4 1, rk8 1 of 2.\n"), "{claim}");
        let with =
            [&beaten[..], &["top,a,100.0,0.01,exact-step,no,0.4", "top,b,100.0,0.01,exact-step,no,2.0"]]
                .concat();
        let claim = which(&with).claim();
        assert!(claim.contains("in 1 of the 2 problems") && claim.contains("theirs is 2.5 times"), "{claim}");
        assert!(which(&beaten[3..]).claim().contains("in any of the 1 problems"));
    }

    #[test]
    fn rows_that_are_no_costs_are_refused() {
        assert!(Which::of("kind,case\nx,y\n").is_err());
        let zero = format!("{HEAD}x,y,100.0,0.01,rk4,yes,0.0,0.0,\n");
        assert!(Which::of(&zero).is_err_and(|reason| reason.contains("not positive")));
    }
}
