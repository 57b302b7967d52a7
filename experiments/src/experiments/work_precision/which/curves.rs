//! Cost against accuracy of the first body of each kind, as the article's figure reads it.

use std::collections::BTreeMap;

use polhode_pages::table::{Column, Table, row};

use super::{CLOSED_FORM, Contest, LONG, Row, Which, longest};

/// Methods that know nothing of rotation and are shown wherever they reach an accuracy.
const GENERAL: [&str; 5] = ["rk4", "dop853", "rk8", "taylor", "gauss:8"];

/// What stands for the method that knows of rotation, whatever its name.
const GEOMETRIC: &str = "geometric";

impl Which {
    /// By kind and method the cost at each accuracy, with the distances to 10 % and 90 % of the starts: of the general-purpose
    /// methods, of the closed form in equal steps, and of the one method that knows of rotation, has an error of its step and is the
    /// quickest of those at most accuracies.
    pub(crate) fn curves(&self) -> Table {
        let columns = vec![
            Column::new("kind", "", "what is asked"),
            Column::new("case", "", "body and starts"),
            Column::new("turned", "rad", "about how far the body turns"),
            Column::new("curve", "", "the method, or geometric for the one that knows of rotation"),
            Column::new("label", "", "its name, at its finest accuracy"),
            Column::new("accuracy", "rad", "largest attitude error"),
            Column::new("cost", "", "processor time per radian in steps of rk4, median over the starts"),
            Column::new("below", "", "how far 10 % of the starts lie below it"),
            Column::new(
                "above",
                "",
                "how far 90 % of the starts lie above it; 0 where these do not reach the accuracy",
            ),
        ];
        let mut table = Table::new("curves", "Cost against accuracy, the first body of each kind.", columns);
        let contests = self.contests();
        for kind in self.kinds() {
            let turned = longest(&contests, kind, LONG);
            let Some(first) = contests.iter().find(|contest| contest.kind == kind) else { continue };
            let of = |contest: &&Contest| contest.case == first.case && contest.turned == turned;
            let panel: Vec<&Contest> = contests.iter().filter(of).collect();
            let curves = GENERAL.into_iter().chain([CLOSED_FORM]).map(|name| (name, name));
            for (curve, method) in curves.chain(quickest(&panel).map(|name| (GEOMETRIC, name))) {
                let of = |row: &&Row| row.case == first.case && row.turned == turned && row.method == method;
                let rows: Vec<&Row> = self.rows.iter().filter(of).collect();
                let finest = rows.iter().map(|row| row.accuracy).fold(f64::INFINITY, f64::min);
                for row in rows {
                    table.push(row![
                        kind,
                        // a comma would end the field for a reader that knows of no quotes
                        first.case.replace(',', ""),
                        turned,
                        curve,
                        if row.accuracy == finest { method } else { "" },
                        row.accuracy,
                        row.rk4_steps,
                        row.rk4_steps - row.rk4_steps_p10,
                        row.rk4_steps_p90.map_or(0.0, |high| high - row.rk4_steps),
                    ]);
                }
            }
        }
        table
    }
}

/// The method that knows of rotation and is the quickest of those at most accuracies; of two, that of more rows.
fn quickest<'a>(panel: &[&Contest<'a>]) -> Option<&'a str> {
    let mut wins: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for contest in panel {
        let special = contest.costs.iter().filter(|row| row.general != "yes");
        for (place, row) in special.enumerate() {
            let (first, rows) = wins.entry(&row.method).or_default();
            (*first, *rows) = (*first + usize::from(place == 0), *rows + 1);
        }
    }
    wins.into_iter().max_by_key(|(_, score)| *score).map(|(method, _)| method)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_has_general_methods_and_the_quickest_other_with_their_spread() {
        let csv = "kind,case,turned,accuracy,method,general,rk4_steps,rk4_steps_p10,rk4_steps_p90\n\
                   free,\"a, b\",10000.0,0.01,slow,no,2.5,1.5,3.0\n\
                   free,\"a, b\",10000.0,0.01,split,no,2.0,1.5,3.0\n\
                   free,\"a, b\",10000.0,1e-4,split,no,3.0,1.5,3.0\n\
                   free,\"a, b\",10000.0,0.01,rk8,yes,4.0,3.0,\n\
                   free,\"a, b\",10000.0,0.01,exact-step,no,0.5,0.5,0.5\n\
                   free,\"a, b\",10000.0,0.01,tsit5,yes,8.0,7.0,9.0\n\
                   free,\"a, b\",1e6,0.01,late,no,1.0,1.0,1.0\n\
                   free,c,10000.0,0.01,other,no,1.0,1.0,1.0\n";
        let text = Which::of(csv).unwrap().curves().csv();
        let rows: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(
            rows,
            [
                "free,a b,10000.0,rk8,rk8,0.01,4.0,1.0,0.0",
                "free,a b,10000.0,exact-step,exact-step,0.01,0.5,0.0,0.0",
                "free,a b,10000.0,geometric,,0.01,2.0,0.5,1.0",
                "free,a b,10000.0,geometric,split,0.0001,3.0,1.5,0.0",
            ]
        );
    }
}
