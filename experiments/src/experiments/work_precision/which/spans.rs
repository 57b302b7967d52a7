//! Whether methods that know of rotation overtake the general-purpose ones as the time grows, where no closed form is known.

use polhode_pages::table::{Cell, Column, Table, row};

use super::{Contest, Which};

/// Kinds of which the true motion has no closed form.
const KINDS: [&str; 2] = ["asymmetric top", "body in orbit"];

/// rad, each with its column.
const ACCURACIES: [(f64, &str, &str); 3] =
    [(1e-2, "coarse", "1e-2"), (1e-4, "middle", "1e-4"), (1e-6, "fine", "1e-6")];

impl Which {
    /// Of each body and time, by accuracy: the cost of the quickest method that knows of rotation over that of the quickest
    /// general-purpose one, at the medians over the starts; empty where one of the two does not reach the accuracy.
    pub(crate) fn spans(&self) -> Table {
        let meaning = "cost of the quickest method that knows of rotation over that of the quickest general-purpose one, at this attitude error in rad";
        let ratios =
            ACCURACIES.map(|(_, name, heading)| Column::new(name, "", meaning).heading(heading).digits(2));
        let mut columns = vec![
            Column::new("case", "", "body").heading("body"),
            Column::new("turned", "rad", "about how far the body turns").heading("turned").digits(1),
        ];
        columns.extend(ratios);
        let caption = "Processor time of the quickest method that knows of rotation over that of the quickest general-purpose one, by \
                       body, time and attitude error.";
        let mut table = Table::new("spans", caption, columns);
        let contests = self.contests();
        let mut seen: Vec<(&str, f64)> = Vec::new();
        for contest in contests.iter().filter(|contest| KINDS.contains(&contest.kind)) {
            if !seen.contains(&(contest.case, contest.turned)) {
                seen.push((contest.case, contest.turned));
            }
        }
        for (case, turned) in seen {
            let mut cells = row![case, turned].to_vec();
            cells.extend(ACCURACIES.map(|(accuracy, ..)| {
                let of = |contest: &&Contest| {
                    (contest.case, contest.turned, contest.accuracy) == (case, turned, accuracy)
                };
                Cell::from(contests.iter().find(of).and_then(special_over_general))
            }));
            if cells[2..].iter().any(|cell| *cell != Cell::from(None::<f64>)) {
                table.push(cells);
            }
        }
        table
    }
}

/// The costs of a contest ascend.
fn special_over_general(contest: &Contest) -> Option<f64> {
    let least = |general: bool| {
        let of = contest.costs.iter().find(|row| (row.general == "yes") == general);
        of.map(|row| row.rk4_steps)
    };
    Some(least(false)? / least(true)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quickest_of_either_sort_are_compared_where_both_arrive() {
        let rows = [
            "asymmetric top,a,100.0,0.01,split,no,3.0",
            "asymmetric top,a,100.0,0.01,other,no,2.0",
            "asymmetric top,a,100.0,0.01,rk8,yes,4.0",
            "asymmetric top,a,100.0,0.0001,rk8,yes,8.0",
            "asymmetric top,a,1000.0,0.01,rk8,yes,9.0",
            "free body,b,100.0,0.01,split,no,1.0",
            "free body,b,100.0,0.01,rk8,yes,2.0",
        ];
        let head = "kind,case,turned,accuracy,method,general,rk4_steps,rk4_steps_p10,rk4_steps_p90\n";
        let text = rows.iter().fold(head.to_owned(), |all, row| all + row + ",1.0,\n");
        let found = Which::of(&text).unwrap().spans().csv();
        assert!(found.ends_with("\na,100.0,0.5,,\n"), "{found}");
        assert_eq!(found.lines().filter(|line| line.starts_with('a')).count(), 1, "{found}");
    }
}
