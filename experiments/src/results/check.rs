//! `polhode experiment check`: the committed numbers are those that the program finds.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use polhode_files::error::Error;
use polhode_files::read_own;
use polhode_pages::output::emit;
use polhode_pages::table::Table;

use super::run::{finished, write as write_run};
use super::{RESULTS, chosen};
use crate::experiment::{Experiment, Report, Scale};

/// The CSVs of smoke scale.
const GOLDEN: &str = "experiments/tests/golden/smoke";
/// Differences that are told one by one.
const TOLD: usize = 8;

/// The scales whose numbers are committed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Committed {
    /// Some seconds for each experiment at most
    Smoke,
    /// Full size: some hours in all; run.toml beside the committed numbers states the seconds of each experiment
    Paper,
}

impl Committed {
    fn scale(self) -> Scale {
        match self {
            Self::Smoke => Scale::Smoke,
            Self::Paper => Scale::Paper,
        }
    }

    /// Where the numbers of this scale are.
    fn folder(self) -> &'static str {
        match self {
            Self::Smoke => GOLDEN,
            Self::Paper => RESULTS,
        }
    }

    fn remedy(self) -> &'static str {
        match self {
            Self::Smoke => "if that is intended, `polhode experiment check --accept` writes it",
            Self::Paper => {
                "if that is intended, `polhode experiment run NAME --scale paper` and \
                 `polhode experiment publish --from results/paper` write it"
            }
        }
    }
}

/// Runs the experiments called `names` (or `all`) and compares them with the files below `root`.
pub(super) fn run(names: &[String], scale: Committed, root: &Path, accept: bool) -> Result<(), Error> {
    if accept && scale == Committed::Paper {
        let remedy = "run `polhode experiment run all --scale paper` and `polhode experiment publish --from \
                      results/paper`, or leave out one of the two flags";
        let rule = "the tables of README.md and paper/generated have to follow these numbers";
        return Err(Error::input("--accept with --scale", "paper", rule, remedy));
    }
    check_root(root, scale)?;
    let mut differences = Vec::new();
    for experiment in chosen("experiment check", names)? {
        let report = experiment.report(scale.scale(), experiment.name.to_owned())?;
        differences.extend(report.failures.iter().map(|failure| format!("{}: {failure}", experiment.name)));
        if accept {
            write(root, scale, experiment, &report)?;
        } else {
            differences.extend(compare(root, scale, experiment, &report)?);
        }
    }
    told(differences, if accept { None } else { Some(scale.remedy()) })
}

/// The same with runs of paper scale that are kept in `folder`.
pub(super) fn resumed(names: &[String], scale: Committed, root: &Path, folder: &Path) -> Result<(), Error> {
    if scale != Committed::Paper {
        let value = folder.display().to_string();
        let rule = "runs of smoke scale take seconds and are not kept";
        return Err(Error::input("--resume", &value, rule, "leave it out, or add --scale paper"));
    }
    check_root(root, scale)?;
    let mut differences = Vec::new();
    for experiment in chosen("experiment check", names)? {
        let place = folder.join(scale.scale().to_string()).join(experiment.name);
        let failures = match finished(experiment, scale.scale(), &place) {
            Some(finished) => {
                differences.extend(compare_files(root, experiment, &place, &finished.timing)?);
                finished.failures
            }
            None => {
                let report = experiment.report(scale.scale(), experiment.name.to_owned())?;
                write_run(experiment, scale.scale(), &report, &place)?;
                differences.extend(compare(root, scale, experiment, &report)?);
                report.failures
            }
        };
        differences.extend(failures.iter().map(|failure| format!("{}: {failure}", experiment.name)));
    }
    told(differences, Some(scale.remedy()))
}

fn check_root(root: &Path, scale: Committed) -> Result<(), Error> {
    if root.join(scale.folder()).is_dir() {
        return Ok(());
    }
    let value = root.display().to_string();
    let rule = format!("holds no {}", scale.folder());
    Err(Error::input("--root", &value, &rule, "name the project's root"))
}

/// The tables of paper scale in two folders, but for those of times.
fn compare_files(
    root: &Path,
    experiment: &Experiment,
    folder: &Path,
    timing: &[String],
) -> Result<Vec<String>, Error> {
    let committed = Path::new(RESULTS).join(experiment.name);
    let tables = |folder: &Path| -> Vec<OsString> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
        let names = entries.map(|entry| entry.file_name());
        names
            .filter(|name| is_table(Path::new(name)) && timing.iter().all(|other| name != other.as_str()))
            .collect()
    };
    let names: BTreeSet<OsString> =
        tables(folder).into_iter().chain(tables(&root.join(&committed))).collect();
    let mut found = Vec::new();
    for name in names {
        let (path, run) = (committed.join(&name), folder.join(&name));
        match (root.join(&path).is_file(), run.is_file()) {
            (true, true) => {
                let remedy = Committed::Paper.remedy();
                let (old, new) = (read_own(&root.join(&path), remedy)?, read_own(&run, remedy)?);
                let told = differences(&path, &old, &new);
                found.extend(told.map_err(|reason| Error::Failed(format!("{reason}; {remedy}")))?);
            }
            (false, _) => found.push(format!("{}: is not there", path.display())),
            (true, false) => found.push(format!("{}: no table is called so", path.display())),
        }
    }
    Ok(found)
}

/// The first differences, if there are any.
fn told(mut differences: Vec<String>, remedy: Option<&str>) -> Result<(), Error> {
    if differences.is_empty() {
        return Ok(());
    }
    let more = differences.len().saturating_sub(TOLD);
    differences.truncate(TOLD);
    if more > 0 {
        differences.push(format!("and {more} more"));
    }
    differences.extend(remedy.map(String::from));
    Err(Error::Failed(differences.join("\n")))
}

/// Each deterministic table with the committed file that holds it, as a path below the root. Data are the same at every
/// scale, and are committed with the results of paper scale.
fn committed<'a>(
    scale: Committed,
    experiment: &Experiment,
    report: &'a Report,
) -> impl Iterator<Item = (PathBuf, &'a Table)> + use<'a> {
    let [numbers, results] = [scale.folder(), RESULTS].map(|folder| Path::new(folder).join(experiment.name));
    let file = |folder: &Path, table: &Table| folder.join(format!("{}.csv", table.name));
    let tables = report.tables.iter().map(move |table| (file(&numbers, table), table));
    tables.chain(report.data.iter().map(move |table| (file(&results, table), table)))
}

fn write(root: &Path, scale: Committed, experiment: &Experiment, report: &Report) -> Result<(), Error> {
    for (path, table) in committed(scale, experiment, report) {
        let path = root.join(path);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|reason| Error::Input(format!("{}: cannot be made: {reason}", folder.display())))?;
        }
        emit(&table.csv(), Some(&path))?;
    }
    Ok(())
}

fn compare(
    root: &Path,
    scale: Committed,
    experiment: &Experiment,
    report: &Report,
) -> Result<Vec<String>, Error> {
    let mut found = Vec::new();
    let folder = Path::new(scale.folder()).join(experiment.name);
    let mut known: Vec<PathBuf> = committed(scale, experiment, report).map(|(path, _)| path).collect();
    for (path, table) in committed(scale, experiment, report) {
        match root.join(&path).is_file() {
            true => {
                let text = read_own(&root.join(&path), scale.remedy())?;
                let told = differences(&path, &text, &table.csv());
                found.extend(told.map_err(|reason| Error::Failed(format!("{reason}; {}", scale.remedy())))?);
            }
            false => found.push(format!("{}: is not there", path.display())),
        }
    }
    // times stand beside the numbers of paper scale; they are another machine's
    let times = report.timing.iter().chain(&report.times);
    known.extend(times.map(|table| folder.join(format!("{}.csv", table.name))));
    // a file that no table makes would never be compared
    let entries = std::fs::read_dir(root.join(&folder)).into_iter().flatten().filter_map(Result::ok);
    let names = entries.map(|entry| folder.join(entry.file_name()));
    let mut strangers: Vec<PathBuf> = names.filter(|path| is_table(path) && !known.contains(path)).collect();
    strangers.sort();
    found.extend(strangers.iter().map(|path| format!("{}: no table is called so", path.display())));
    Ok(found)
}

fn is_table(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "csv")
}

/// Each cell of the rows that is not the committed one, bit for bit.
fn differences(path: &Path, committed: &str, found: &str) -> Result<Vec<String>, String> {
    if committed == found {
        return Ok(Vec::new());
    }
    let place = path.display();
    let (committed, found) = (cells(path, committed)?, cells(path, found)?);
    let name = |k: usize| found.first().and_then(|header| header.get(k)).map_or("", String::as_str);
    if committed.first() != found.first() {
        let columns = |rows: &[Vec<String>]| rows.first().map_or(String::new(), |header| header.join(","));
        return Ok(vec![format!(
            "{place}: committed columns {}, found {}",
            columns(&committed),
            columns(&found)
        )]);
    }
    let mut told = Vec::new();
    for (number, (old, new)) in committed.iter().zip(&found).enumerate().skip(1) {
        let differing = old.iter().zip(new).enumerate().filter(|(_, (old, new))| old != new);
        told.extend(differing.map(|(k, (old, new))| {
            format!(
                "{place}: row {number}, column {}: committed {}, found {}",
                name(k),
                shown(old),
                shown(new)
            )
        }));
    }
    if committed.len() != found.len() {
        let rows = |rows: &[Vec<String>]| rows.len().saturating_sub(1);
        told.push(format!("{place}: committed rows {}, found {}", rows(&committed), rows(&found)));
    }
    if told.is_empty() {
        told.push(format!("{place}: the same cells, written differently"));
    }
    Ok(told)
}

fn shown(cell: &str) -> &str {
    if cell.is_empty() { "nothing" } else { cell }
}

fn cells(path: &Path, text: &str) -> Result<Vec<Vec<String>>, String> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    let rows = reader.records().map(|row| row.map(|row| row.iter().map(String::from).collect()));
    rows.collect::<Result<_, _>>().map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_and_both_values_are_told() {
        let told = |committed: &str| {
            let found = "method,error\nrk4,0.1\n\"a,b\",\n";
            differences(Path::new("x.csv"), committed, found)
        };
        let none: [&str; 0] = [];
        assert_eq!(told("method,error\nrk4,0.1\n\"a,b\",\n").unwrap(), none);
        assert_eq!(
            told("method,error\nrk4,0.10000000000000002\n\"a,b\",1.0\n").unwrap(),
            [
                "x.csv: row 1, column error: committed 0.10000000000000002, found 0.1",
                "x.csv: row 2, column error: committed 1.0, found nothing"
            ]
        );
        assert_eq!(told("method,error\nrk4,0.1\n").unwrap(), ["x.csv: committed rows 1, found 2"]);
        assert_eq!(told("method\nrk4\n").unwrap(), ["x.csv: committed columns method, found method,error"]);
        assert_eq!(
            told("method,error\n\"rk4\",0.1\n\"a,b\",\n").unwrap(),
            ["x.csv: the same cells, written differently"]
        );
        assert!(told("method,error\nrk4\n").unwrap_err().starts_with("x.csv: CSV error"));
    }
}
