//! What an experiment is, what it is told, and what it reports.

use std::fmt;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use polhode_files::error::Error;
use polhode_pages::figure::{Drawing, Figure};
use polhode_pages::table::Table;

use crate::parallel;

/// How large an experiment is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Scale {
    /// A few seconds in all, for tests
    Smoke,
    /// A few minutes in all
    Standard,
    /// Full size, as in the articles: some hours in all
    Paper,
}

impl Scale {
    /// The value of the three that belongs to this scale.
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
    /// On the command line.
    pub(crate) name: &'static str,
    /// What it asks.
    pub(crate) question: &'static str,
    /// The work.
    pub(crate) run: fn(&Context) -> Result<Report, Error>,
}

/// What an experiment found.
#[derive(Default)]
pub(crate) struct Report {
    /// What was found, in one line.
    pub(crate) conclusion: String,
    /// What a reader sees of it on a screen of 80 columns, where that is more than its tables.
    pub(crate) screen: Option<String>,
    /// Deterministic rows, in full precision.
    pub(crate) tables: Vec<Table>,
    /// Rows that only programs read, the same at every scale: CSV alone.
    pub(crate) data: Vec<Table>,
    /// Parts of them for readers; where there are none, the tables themselves are shown.
    pub(crate) views: Vec<Table>,
    /// Figures that are plots.
    pub(crate) figures: Vec<Figure>,
    /// Figures that are not plots.
    pub(crate) drawings: Vec<Drawing>,
    /// Times, which depend on the machine.
    pub(crate) timing: Option<Table>,
    /// Rows of times that only programs read.
    pub(crate) times: Vec<Table>,
    /// Of the random numbers, if there were any.
    pub(crate) seed: Option<u64>,
    /// How many claims were checked.
    pub(crate) checks: u64,
    /// Claims that did not hold: the results are written all the same, and the command fails.
    pub(crate) failures: Vec<String>,
    /// Wall time of the run.
    pub(crate) took: Duration,
}

/// What an experiment is told.
pub(crate) struct Context {
    /// How large it is.
    pub(crate) scale: Scale,
    bar: ProgressBar,
}

/// Draws it by `template` from here on.
fn style(bar: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
}

impl Context {
    fn new(title: String, scale: Scale) -> Self {
        let bar =
            if std::io::stderr().is_terminal() { ProgressBar::no_length() } else { ProgressBar::hidden() };
        style(&bar, "{prefix}");
        bar.set_prefix(title);
        Self { scale, bar }
    }

    /// `work` on each of `parts`, on as many threads as there are cores; results in the order of the parts.
    pub(crate) fn in_parallel<T: Send, R: Send>(
        &self,
        parts: Vec<T>,
        work: impl Fn(T) -> R + Sync,
    ) -> Vec<R> {
        // what was done before is done
        self.bar.set_length(self.bar.position() + parts.len() as u64);
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        parallel::map(parts, cores, |part| {
            let result = work(part);
            // nothing is drawn for work that is over within a second, of which no end can be foreseen either
            self.bar.update(|state| state.set_pos(state.pos() + 1));
            if self.bar.elapsed() > Duration::from_secs(1) {
                style(&self.bar, "{prefix} {bar:24} {pos} of {len}, about {eta} left");
                self.bar.tick();
            }
            result
        })
    }
}

impl Experiment {
    /// Does the work, under a bar with this title.
    pub(crate) fn report(&self, scale: Scale, title: String) -> Result<Report, Error> {
        let context = Context::new(title, scale);
        let start = Instant::now();
        let mut report = (self.run)(&context)?;
        report.took = start.elapsed();
        context.bar.finish_and_clear();
        Ok(report)
    }
}
