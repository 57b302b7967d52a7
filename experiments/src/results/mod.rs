//! `polhode experiment`: the results of experiments, run, written, compared and published.

mod check;
mod provenance;
mod publish;
mod run;

use std::path::PathBuf;

use clap::Subcommand;

use crate::error::Error;
use crate::experiment::{Experiment, Scale};
use crate::experiments;
use crate::files::emit;
use crate::table::{Column, Format, Table, row};

/// Results of paper scale, as they are committed.
const RESULTS: &str = "experiments/results";

#[derive(Subcommand)]
pub(crate) enum ExperimentCommand {
    /// The experiments and what each asks
    List {
        /// How rows are printed: table on a terminal, csv otherwise
        #[arg(long, value_enum)]
        format: Option<Format>,
    },
    /// Run experiments and write OUT/<scale>/<experiment>/
    Run {
        /// Names of experiments, or all
        #[arg(required = true)]
        names: Vec<String>,
        /// How large
        #[arg(long, value_enum, default_value = "standard")]
        scale: Scale,
        /// Folder for results
        #[arg(long, default_value = "results")]
        out: PathBuf,
    },
    /// Run experiments at smoke scale and compare every number with the
    /// committed ones
    ///
    /// Times are left out. Exit code 1 where a cell differs or a claim fails; the first differences are named by file, row,
    /// column and both values.
    Check {
        /// Names of experiments, or all
        #[arg(default_value = "all")]
        names: Vec<String>,
        /// Root of the project
        #[arg(long, default_value = ".")]
        root: PathBuf,
        /// Put what was found in the place of what is committed
        #[arg(long)]
        accept: bool,
    },
    /// Put committed results of paper scale into README.md and the files that
    /// the article names in paper/generated
    Publish {
        /// Root of the project
        #[arg(long, default_value = ".")]
        root: PathBuf,
        /// Folder of new results to be taken over first, such as results/paper
        #[arg(long, value_name = "DIR")]
        from: Option<PathBuf>,
    },
}

impl ExperimentCommand {
    pub(crate) fn run(self) -> Result<(), Error> {
        match self {
            Self::List { format } => list(format),
            Self::Run { names, scale, out } => run::run(&names, scale, &out),
            Self::Check { names, root, accept } => check::run(&names, &root, accept),
            Self::Publish { root, from } => publish::run(&root, from.as_deref()),
        }
    }
}

fn list(format: Option<Format>) -> Result<(), Error> {
    let columns =
        vec![Column::new("name", "", "on the command line"), Column::new("question", "", "what it asks")];
    let mut table = Table::new("experiments", "The experiments.", columns);
    for experiment in experiments::ALL {
        table.push(row![experiment.name, experiment.question]);
    }
    emit(&Format::or_default(format, false).write(&table), None)
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
