//! Families of records whose truth is known: exact ones, faulty ones, spheres, methods that keep L, and long ones.

use polhode::method::{AnyMethod, Claimed as _, catalogue};
use polhode::num::Random;
use polhode_files::error::Error;
use polhode_pages::table::{self, Column, Table, row};

use super::faulty::{FAULTS, bad_rows, faulty};
use super::specimen::{Kind, Specimen, keeps_momentum};
use super::truth::{Columns, Judged, Style, judged};
use super::writing::{Form, Writing, one_of};
use crate::experiment::{Context, Scale};
use crate::statistics::Interval;

/// A family, and which of its records.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Family {
    /// An exact motion, with its digits and with noise that is declared.
    Exact,
    /// An exact motion with a fault, by its number.
    Fault(usize),
    /// The same of a body with three equal moments.
    Sphere(usize),
    /// What a method computes that keeps L in space.
    Method(String),
    /// A long record with bad rows.
    Long { rows: u64, bad: usize },
}

/// What has been judged.
pub(super) struct Families {
    all: Vec<(Family, Judged)>,
}

/// How many records of each family.
struct Counts {
    exact: u64,
    fault: u64,
    sphere: u64,
    method: u64,
    /// Rows, and how many records with each number of bad rows.
    long: &'static [(u64, u64)],
    /// Of faults and methods each is taken, or one in so many.
    every: usize,
}

/// Whether a family belongs to a group.
type Chosen = fn(&Family) -> bool;

impl Counts {
    fn of(scale: Scale) -> Self {
        scale.pick(
            Counts { exact: 8, fault: 1, sphere: 1, method: 1, long: &[(3_000, 1)], every: 6 },
            Counts { exact: 60, fault: 1, sphere: 1, method: 1, long: &[(30_000, 1)], every: 2 },
            Counts {
                exact: 1000,
                fault: 100,
                sphere: 5,
                method: 50,
                long: &[(100_000, 20), (1_000_000, 3)],
                every: 1,
            },
        )
    }
}

/// Numbers of bad rows of long records.
const BAD: [usize; 4] = [0, 1, 10, 1000];

impl Families {
    pub(super) fn run(context: &Context, seeds: &Random) -> Result<Self, Error> {
        let counts = Counts::of(context.scale);
        let mut parts = Vec::new();
        let mut put = |family: Family, trials: u64| (0..trials).for_each(|_| parts.push(family.clone()));
        put(Family::Exact, counts.exact);
        for fault in (0..FAULTS.len()).step_by(counts.every) {
            put(Family::Fault(fault), counts.fault);
            put(Family::Sphere(fault), counts.sphere);
        }
        for method in keepers().iter().step_by(counts.every) {
            put(Family::Method(method.name()), counts.method);
        }
        for &(rows, trials) in counts.long {
            for bad in BAD.into_iter().filter(|bad| (*bad as u64) < rows / 2) {
                put(Family::Long { rows, bad }, trials);
            }
        }
        // long records stand last and take longest: first, so that no core waits at the end
        let numbered = parts.into_iter().enumerate().rev().collect();
        let all = context.in_parallel(numbered, |(k, family): (usize, Family)| {
            let mut random = seeds.stream((2 << 32) + k as u64);
            one(&family, &mut random).map(|judged| (family, judged))
        });
        Ok(Families { all: all.into_iter().rev().collect::<Result<_, Error>>()? })
    }

    fn of(&self, which: impl Fn(&Family) -> bool) -> Cell<'_> {
        Cell(self.all.iter().filter(|(family, _)| which(family)).map(|(_, judged)| judged).collect())
    }

    pub(super) fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.exact(), self.faults(), self.methods(), self.long()]
    }

    /// What has to hold, and does not.
    pub(super) fn demands(&self) -> Vec<String> {
        let mut failures = Vec::new();
        let all = self.of(|_| true);
        if all.false_right() > 0 {
            failures.push(format!(
                "{} of {} records are called right and are not",
                all.false_right(),
                all.count()
            ));
        }
        let named = self.of(|family| !is_method(family)).named();
        let otherwise = self.otherwise(is_method);
        if named + otherwise > 0 {
            failures.push(format!(
                "an integrator is named of {named} records that none made, and another of {otherwise}"
            ));
        }
        let exact = self.of(is_exact);
        if (exact.right() as f64) < 0.99 * exact.count() as f64 {
            failures.push(format!("{} of {} exact records are called right", exact.right(), exact.count()));
        }
        failures
    }

    /// Records of methods in `family` of which another integrator is named.
    fn otherwise(&self, which: impl Fn(&Family) -> bool) -> u64 {
        let is_other = |(family, judged): &&(Family, Judged)| {
            let named = judged.integrator.as_ref();
            which(family)
                && matches!(family, Family::Method(name) if named.is_some_and(|named| named != name))
        };
        self.all.iter().filter(is_other).count() as u64
    }

    fn summary(&self) -> Table {
        let share = |name, meaning| Column::new(name, "", meaning);
        let mut table = Table::new(
            "shares",
            "False and true verdicts on records whose truth is known.",
            vec![
                Column::new("records", "", "which records"),
                Column::new("trials", "", "how many"),
                Column::new("undecided", "", "not decided"),
                Column::new("verdict", "", "what is counted"),
                Column::new("count", "", "how many are judged so"),
                share("share", "share of the records"),
                share("low", "lower end of its 95 % interval (Wilson)").heading("from"),
                share("high", "upper end of its 95 % interval (Wilson)").heading("to"),
            ],
        );
        let mut add = |name: &str, cell: &Cell<'_>, verdict: &str, count: u64| {
            let interval = Interval::new(count, cell.count());
            table.push(row![
                name,
                cell.count(),
                cell.undecided(),
                verdict,
                count,
                interval.map(|x| x.share),
                interval.map(|x| x.low),
                interval.map(|x| x.high),
            ]);
        };
        let exact = self.of(is_exact);
        add("exact", &exact, "right", exact.right());
        let methods = self.of(is_method);
        add("of methods", &methods, "integrator named", methods.named() - self.otherwise(is_method));
        add("of methods", &methods, "another integrator named", self.otherwise(is_method));
        let others = self.of(|family| !is_method(family));
        add("of no method", &others, "integrator named", others.named());
        let groups: [(&str, Chosen); 5] = [
            ("one fault", |family| matches!(family, Family::Fault(_))),
            ("one fault of a sphere", |family| matches!(family, Family::Sphere(_))),
            ("methods that keep L", is_method),
            ("long with bad rows", |family| matches!(family, Family::Long { bad: 1.., .. })),
            ("all that are not exact", |family| !is_exact(family)),
        ];
        for (name, which) in groups {
            let mut cell = self.of(which);
            cell.0.retain(|judged| judged.excess > 1.0);
            add(name, &cell, "false right", cell.false_right());
        }
        table
    }

    fn exact(&self) -> Table {
        let mut table = counted(
            "exact",
            "Exact motions: by columns and by what limits their numbers.",
            &["columns", "written"],
        );
        for columns in [Columns::Both, Columns::Momentum, Columns::Attitude, Columns::Rates] {
            for written in ["12 to 17 digits", "6 to 11 digits", "float32", "declared noise"] {
                let mut cell = self.of(is_exact);
                cell.0.retain(|x| x.style.columns == columns && x.style.limit() == written);
                table.push(row![columns.name(), written].into_iter().chain(cell.verdicts()));
            }
        }
        table
    }

    fn faults(&self) -> Table {
        let mut table = counted("faults", "Exact motions with one fault each.", &["body", "fault"]);
        for (number, (name, _)) in FAULTS.iter().enumerate() {
            for (body, family) in [("distinct", Family::Fault(number)), ("sphere", Family::Sphere(number))] {
                let cell = self.of(|found| *found == family);
                if cell.count() > 0 {
                    table.push(row![body, *name].into_iter().chain(cell.verdicts()));
                }
            }
        }
        table
    }

    fn methods(&self) -> Table {
        let mut table = counted("keepers", "Motions by methods that keep L in space.", &["method"]);
        table.columns.push(
            Column::new("otherwise", "", "of which another integrator is named").heading("named otherwise"),
        );
        for method in keepers() {
            let family = Family::Method(method.name());
            let cell = self.of(|found| *found == family);
            if cell.count() > 0 {
                let otherwise = self.otherwise(|found| *found == family);
                let cells = row![method.name()].into_iter().chain(cell.verdicts());
                table.push(cells.chain(row![otherwise]));
            }
        }
        table
    }

    fn long(&self) -> Table {
        let mut table = counted("long", "Long records with bad rows.", &["rows", "bad"]);
        let mut seen: Vec<&Family> = Vec::new();
        for (family, _) in &self.all {
            let Family::Long { rows, bad } = family else { continue };
            if seen.contains(&family) {
                continue;
            }
            seen.push(family);
            let cell = self.of(|found| found == family);
            table.push(row![*rows, *bad as u64].into_iter().chain(cell.verdicts()));
        }
        table
    }
}

/// The table `name` with `keys` and the counts of verdicts.
fn counted(name: &'static str, caption: &str, keys: &[&'static str]) -> Table {
    let meaning = |key: &str| match key {
        "columns" => "columns that are written",
        "written" => "what limits the numbers",
        "body" => "moments that are distinct, or a sphere",
        "fault" => "what is done to the record",
        "method" => "name in the catalogue",
        "rows" => "rows of the record",
        _ => "rows that are bad",
    };
    let count = |name, meaning| Column::new(name, "", meaning);
    let keys = keys.iter().map(|key| Column::new(key, "", meaning(key)));
    let counts = [
        count("trials", "records"),
        count("beyond", "with a row further off than is allowed"),
        count("right", "judged right"),
        count("wrong", "judged wrong"),
        count("undecided", "not decided"),
        count("false_right", "judged right although a row is further off than is allowed")
            .heading("false right"),
        count("most", "upper end of the 95 % interval (Wilson) of its share of those beyond")
            .heading("at most"),
        count("named", "of which an integrator is named"),
    ];
    Table::new(name, caption, keys.chain(counts).collect())
}

/// Some of the judged.
struct Cell<'a>(Vec<&'a Judged>);

impl Cell<'_> {
    fn number(&self, which: impl Fn(&Judged) -> bool) -> u64 {
        self.0.iter().filter(|judged| which(judged)).count() as u64
    }

    fn count(&self) -> u64 {
        self.0.len() as u64
    }

    fn beyond(&self) -> u64 {
        self.number(|judged| judged.excess > 1.0)
    }

    fn right(&self) -> u64 {
        self.number(|judged| judged.judgement == polhode::audit::Judgement::Right)
    }

    fn wrong(&self) -> u64 {
        self.number(|judged| judged.judgement == polhode::audit::Judgement::Wrong)
    }

    fn undecided(&self) -> u64 {
        self.number(|judged| judged.judgement == polhode::audit::Judgement::Undecided)
    }

    fn false_right(&self) -> u64 {
        self.number(Judged::is_false_right)
    }

    /// The columns behind the keys of `counted`.
    fn verdicts(&self) -> [table::Cell; 8] {
        row![
            self.count(),
            self.beyond(),
            self.right(),
            self.wrong(),
            self.undecided(),
            self.false_right(),
            Interval::new(self.false_right(), self.beyond()).map(|x| x.high),
            self.named(),
        ]
    }

    /// Of how many an integrator is named.
    fn named(&self) -> u64 {
        self.number(|judged| judged.integrator.is_some())
    }
}

fn is_method(family: &Family) -> bool {
    matches!(family, Family::Method(_))
}

fn is_exact(family: &Family) -> bool {
    matches!(family, Family::Exact | Family::Long { bad: 0, .. })
}

/// The methods of the catalogue that keep L in space.
fn keepers() -> Vec<Box<dyn AnyMethod>> {
    catalogue().into_iter().filter(|method| keeps_momentum(method)).collect()
}

/// One record of the family, judged.
fn one(family: &Family, random: &mut Random) -> Result<Judged, Error> {
    let style = Style::random(random);
    match family {
        Family::Exact => {
            let kinds = [Kind::Distinct, Kind::Distinct, Kind::Distinct, Kind::Symmetric, Kind::Sphere];
            let kind = one_of(random, kinds);
            judged(&Specimen::random(kind, None, random)?, style, random)
        }
        Family::Fault(number) => {
            let right = Specimen::random(Kind::Distinct, None, random)?;
            judged(&faulty(right, &FAULTS[*number], random)?, style, random)
        }
        Family::Sphere(number) => {
            let right = Specimen::random(Kind::Sphere, None, random)?;
            judged(&faulty(right, &FAULTS[*number], random)?, style, random)
        }
        Family::Method(name) => {
            let columns =
                one_of(random, [Columns::Both, Columns::Momentum, Columns::Momentum, Columns::Attitude]);
            let kind = one_of(random, [Kind::Distinct, Kind::Distinct, Kind::Symmetric]);
            let right = Specimen::random(kind, None, random)?;
            let method = polhode::method(name).map_err(polhode_files::error::unexpected)?;
            judged(&right.by(&method, random)?, Style { columns, ..style }, random)
        }
        Family::Long { rows, bad } => {
            let right = Specimen::random(Kind::Distinct, Some(*rows), random)?;
            let long = bad_rows(right, *bad, random)?;
            // what takes time is to write digits
            let digits = if random.below(3) == 0 { 9 } else { 17 };
            let writing = Writing { digits, ..Writing::WHOLE };
            let noise = if random.below(3) == 0 { 1e-5 } else { 0.0 };
            let form = one_of(random, [Form::Quaternion, Form::Quaternion, Form::Matrix, Form::Rodrigues]);
            let columns = one_of(random, [Columns::Both, Columns::Both, Columns::Momentum]);
            judged(&long, Style { columns, form, writing, noise }, random)
        }
    }
}
