//! `polhode experiment`: the results of experiments, run, written, compared and published.

mod check;
mod committed;
mod methods;
mod overview;
mod page;
mod provenance;
mod publish;
mod run;

use std::path::PathBuf;

use clap::Subcommand;
use polhode_files::error::Error;
use polhode_pages::output::emit;
use polhode_pages::table::{Column, Format, Table, row};

use self::check::Committed;
use self::run::Asked;
use crate::experiment::{Experiment, Scale};
use crate::experiments;

/// Results of paper scale, as they are committed.
const RESULTS: &str = "experiments/results";

const LIST_EXAMPLES: &str = "Examples:
  polhode experiment list
  polhode experiment list --format json";

const CHECK_EXAMPLES: &str = "Examples:
  polhode experiment check order
  polhode experiment check order --scale paper";

const PUBLISH_EXAMPLES: &str = "Examples:
  polhode experiment publish
  polhode experiment run order --scale paper --out new
  polhode experiment publish --from new/paper";

const EXAMPLES: &str = "Examples:
  polhode experiment run --scale smoke
  polhode experiment run order exact --scale smoke
  polhode experiment run order exact --scale smoke --report results.html";

/// The subcommands of `polhode experiment`; what is said of each is its help on the command line.
#[allow(rustdoc::invalid_html_tags)]
#[derive(Subcommand)]
pub enum ExperimentCommand {
    /// List the experiments and the question of each
    #[command(after_help = LIST_EXAMPLES)]
    List {
        /// How rows are printed: table on a terminal, csv otherwise
        #[arg(long, value_enum)]
        format: Option<Format>,
    },
    /// Run experiments and write their results to OUT/<scale>/<experiment>/
    ///
    /// Without a name the main experiments run. They tell which methods stay near the exact motion, how much work an accuracy costs,
    /// and how close a fitted tensor comes to the Cramer-Rao bound. What they found is printed on one screen, and OUT/<scale>/index.html has all tables. With names the full
    /// tables of these experiments are printed.
    #[command(after_help = EXAMPLES)]
    Run {
        /// Names of experiments, or all [default: the main ones]
        names: Vec<String>,
        /// Size of the runs
        #[arg(long, value_enum, default_value = "standard")]
        scale: Scale,
        /// Folder for results
        #[arg(long, default_value = "results")]
        out: PathBuf,
        /// Write all results as one page to this .html file, which needs no network [default without names: OUT/<scale>/index.html]
        #[arg(long, value_name = "FILE")]
        report: Option<PathBuf>,
        /// Print full tables also where no experiment is named
        #[arg(long)]
        tables: bool,
        /// Leave out experiments whose results are in the folder already, if this program, built from the same commit, has made them
        #[arg(long, conflicts_with = "report")]
        resume: bool,
    },
    /// Run experiments and compare every number with the committed ones
    ///
    /// Run it in the root of the repository. The committed numbers of smoke scale are in experiments/tests/golden/smoke, those of paper scale in experiments/results. Times are
    /// not compared. Exit code 1 if a cell differs or a claim fails; the first differences are listed with file, row, column and
    /// both values.
    #[command(hide = true, after_help = CHECK_EXAMPLES)]
    Check {
        /// Names of experiments, or all
        #[arg(default_value = "all")]
        names: Vec<String>,
        /// Size of the runs
        #[arg(long, value_enum, default_value = "smoke")]
        scale: Committed,
        /// Root of the repository, where the command runs elsewhere
        #[arg(long, default_value = ".")]
        root: PathBuf,
        /// Replace the committed numbers of smoke scale by the new ones (for paper scale use `polhode experiment publish --from`)
        #[arg(long)]
        accept: bool,
        /// Keep the runs of paper scale in this folder; results that are there already, made by this program from the same commit, are compared without a new run
        #[arg(long, value_name = "DIR", conflicts_with = "accept")]
        resume: Option<PathBuf>,
    },
    /// Write tables of the committed results of paper scale into README.md,
    /// the pages of docs and paper/generated
    ///
    /// Run it in the root of the repository, whose results are in experiments/results.
    #[command(hide = true, after_help = PUBLISH_EXAMPLES)]
    Publish {
        /// Root of the repository, where the command runs elsewhere
        #[arg(long, default_value = ".")]
        root: PathBuf,
        /// Folder of new results that replace the committed ones first, such as results/paper
        #[arg(long, value_name = "DIR")]
        from: Option<PathBuf>,
    },
}

impl ExperimentCommand {
    /// Does it.
    ///
    /// # Errors
    /// A name that is no experiment, a place that cannot be read or written, an experiment or a comparison that fails.
    pub fn run(self) -> Result<(), Error> {
        match self {
            Self::List { format } => list(format),
            Self::Run { names, scale, out, report, tables, resume } => {
                Asked { names, scale, out, page: report, tables, resumes: resume }.run()
            }
            Self::Check { names, scale, root, accept, resume } => match resume {
                Some(folder) => check::resumed(&names, scale, &root, &folder),
                None => check::run(&names, scale, &root, accept),
            },
            Self::Publish { root, from } => publish::run(&root, from.as_deref()),
        }
    }
}

fn list(format: Option<Format>) -> Result<(), Error> {
    let columns =
        vec![Column::new("name", "", "on the command line"), Column::new("question", "", "what it answers")];
    let mut table = Table::new("experiments", "The experiments.", columns);
    for experiment in experiments::ALL {
        table.push(row![experiment.name, experiment.question]);
    }
    emit(&Format::of(format, None)?.write(&table), None)
}

/// The main experiments.
fn main() -> Vec<&'static Experiment> {
    let named = |name: &&str| experiments::ALL.iter().find(|experiment| experiment.name == *name);
    experiments::MAIN.iter().filter_map(named).collect()
}

/// The experiments called `names` (or `all`), each once, however often it is named.
fn chosen(command: &str, names: &[String]) -> Result<Vec<&'static Experiment>, Error> {
    let known = experiments::ALL.iter().map(|experiment| experiment.name).chain(["all"]);
    if let Some(name) = names.iter().find(|name| known.clone().all(|known| known != *name)) {
        return Err(Error::unknown_name(command, "experiment", name, known));
    }
    let asked = |name: &str| names.iter().any(|asked| asked == name || asked == "all");
    Ok(experiments::ALL.iter().filter(|experiment| asked(experiment.name)).collect())
}

#[cfg(test)]
mod tests {
    use super::main;
    use crate::experiments::MAIN;

    #[test]
    fn what_runs_without_a_name_are_experiments() {
        assert!(main().iter().map(|experiment| experiment.name).eq(MAIN));
    }
}
