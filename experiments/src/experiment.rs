//! Experiments: what each is, how it is run, and where its results go.

use std::fmt;
use std::io::IsTerminal;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::error::Error;
use crate::experiments;
use crate::figure::Figure;
use crate::files::{MARK, Staging, emit};
use crate::provenance;
use crate::table::Table;

/// How large an experiment is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Scale {
    /// Seconds in all: does it run
    Smoke,
    /// Minutes in all
    Standard,
    /// The full size, for the figures of the paper
    Paper,
}

impl Scale {
    /// One of three values.
    pub(crate) fn pick<T>(self, smoke: T, standard: T, paper: T) -> T {
        match self {
            Self::Smoke => smoke,
            Self::Standard => standard,
            Self::Paper => paper,
        }
    }
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.pick("smoke", "standard", "paper"))
    }
}

/// An experiment by name.
pub(crate) struct Experiment {
    pub(crate) name: &'static str,
    /// What it asks.
    pub(crate) question: &'static str,
    pub(crate) run: fn(&Context) -> Result<Report, Error>,
}

/// What an experiment found.
#[derive(Default)]
pub(crate) struct Report {
    /// Deterministic rows, in full precision.
    pub(crate) tables: Vec<Table>,
    /// Rows that only programs read, the same at every scale: CSV alone.
    pub(crate) data: Vec<Table>,
    /// Parts of them for readers; where there are none, the tables themselves are shown.
    pub(crate) views: Vec<Table>,
    pub(crate) figures: Vec<Figure>,
    /// Figures that are not plots.
    pub(crate) drawings: Vec<Drawing>,
    /// Times, which depend on the machine.
    pub(crate) timing: Option<Table>,
    /// Of the random numbers, if there were any.
    pub(crate) seed: Option<u64>,
    /// Claims that did not hold: the results are written all the same, and the command fails.
    pub(crate) failures: Vec<String>,
}

/// A finished SVG.
pub(crate) struct Drawing {
    /// File name without ending.
    pub(crate) name: &'static str,
    pub(crate) svg: String,
}

/// What an experiment is told.
pub(crate) struct Context {
    pub(crate) scale: Scale,
    bar: ProgressBar,
}

impl Context {
    fn new(name: &'static str, scale: Scale) -> Self {
        let bar =
            if std::io::stderr().is_terminal() { ProgressBar::no_length() } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{prefix:12} {bar:40} {pos}/{len} {elapsed}") {
            bar.set_style(style);
        }
        bar.set_prefix(name);
        Self { scale, bar }
    }

    /// `work` on each of `parts`, on as many threads as there are cores, or as many of them as the system grants, this
    /// one at least. Results stand in the order of the parts, so that they do not depend on the threads.
    pub(crate) fn in_parallel<T: Send, R: Send>(
        &self,
        parts: Vec<T>,
        work: impl Fn(T) -> R + Sync,
    ) -> Vec<R> {
        self.bar.set_length(parts.len() as u64);
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let helpers = cores.min(parts.len()).saturating_sub(1);
        let results = Mutex::new(Vec::with_capacity(parts.len()));
        let queue = Mutex::new(parts.into_iter().enumerate());
        let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
        let work_through = || {
            while let Some((place, part)) = next() {
                let result = work(part);
                results.lock().unwrap_or_else(PoisonError::into_inner).push((place, result));
                // nothing is drawn for work that is over within a second
                if self.bar.elapsed() > Duration::from_secs(1) {
                    self.bar.inc(1);
                } else {
                    self.bar.update(|state| state.set_pos(state.pos() + 1));
                }
            }
        };
        std::thread::scope(|scope| {
            let start = || std::thread::Builder::new().spawn_scoped(scope, work_through);
            let _helpers: Vec<_> = (0..helpers).map_while(|_| start().ok()).collect();
            work_through();
        });
        let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
        results.sort_by_key(|(place, _)| *place);
        results.into_iter().map(|(_, result)| result).collect()
    }
}

impl Experiment {
    /// Does the work.
    pub(crate) fn report(&self, scale: Scale) -> Result<Report, Error> {
        let context = Context::new(self.name, scale);
        let report = (self.run)(&context)?;
        context.bar.finish_and_clear();
        Ok(report)
    }
}

/// The experiments called `names` (or `all`), each once, however often it is named.
pub(crate) fn chosen(command: &str, names: &[String]) -> Result<Vec<&'static Experiment>, Error> {
    let known = experiments::ALL.iter().map(|experiment| experiment.name).chain(["all"]);
    if let Some(name) = names.iter().find(|name| known.clone().all(|known| known != *name)) {
        return Err(Error::unknown_name(command, "experiment", name, known));
    }
    let asked = |name: &str| names.iter().any(|asked| asked == name || asked == "all");
    Ok(experiments::ALL.iter().filter(|experiment| asked(experiment.name)).collect())
}

/// Runs the experiments called `names` (or `all`) and writes `out/<scale>/<experiment>/`.
pub(crate) fn run(names: &[String], scale: Scale, out: &Path) -> Result<(), Error> {
    let with_folder =
        |experiment: &'static Experiment| (experiment, out.join(scale.to_string()).join(experiment.name));
    let chosen: Vec<_> = chosen("experiment run", names)?.into_iter().map(with_folder).collect();
    // a place that cannot be written is found out before the work, not after it
    for (_, folder) in &chosen {
        drop(Staging::new(folder)?);
    }
    let mut failures = Vec::new();
    for (experiment, folder) in chosen {
        let report = experiment.report(scale)?;
        write(experiment, scale, &report, &folder)?;
        show(experiment, &report, &folder)?;
        failures.extend(report.failures.iter().map(|failure| format!("{}: {failure}", experiment.name)));
    }
    if failures.is_empty() { Ok(()) } else { Err(Error::Failed(failures.join("\n"))) }
}

fn write(experiment: &Experiment, scale: Scale, report: &Report, folder: &Path) -> Result<(), Error> {
    let staging = Staging::new(folder)?;
    for table in report.tables.iter().chain(&report.data).chain(&report.timing) {
        staging.write(&format!("{}.csv", table.name), table.csv().as_bytes())?;
    }
    // a view may be one of the tables, shown alone
    let also = report.views.iter().filter(|view| report.tables.iter().all(|table| table.name != view.name));
    for table in report.tables.iter().chain(also) {
        staging.write(&format!("{}.md", table.name), table.markdown().as_bytes())?;
        staging.write(&format!("{}.tex", table.name), table.latex().as_bytes())?;
    }
    for figure in &report.figures {
        staging.write(&format!("{}.svg", figure.name), figure.svg()?.as_bytes())?;
    }
    for drawing in &report.drawings {
        staging.write(&format!("{}.svg", drawing.name), drawing.svg.as_bytes())?;
    }
    staging.write(MARK, provenance::describe(experiment.name, scale, report).as_bytes())?;
    staging.commit()
}

fn show(experiment: &Experiment, report: &Report, folder: &Path) -> Result<(), Error> {
    let shown = if report.views.is_empty() { &report.tables } else { &report.views };
    let mut text = String::new();
    for table in shown.iter().chain(&report.timing) {
        text += &format!("\n{}: {}\n\n{}", experiment.name, table.caption, table.terminal());
    }
    emit(&format!("{text}\nWritten to {}\n", folder.display()), None)
}
