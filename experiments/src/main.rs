//! The command line of polhode.

mod arguments;
mod body_arguments;
mod check;
mod error;
mod experiment;
mod experiments;
mod figure;
mod files;
mod fit;
mod force_arguments;
mod inertia;
mod methods;
mod motion;
mod propagate;
mod provenance;
mod publish;
mod simulate;
mod sphere;
mod table;
mod text;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use error::Error;
use experiment::Scale;
use table::{Column, Format, Table, row};

/// Accurate long-time rotation of rigid bodies
///
/// Exit code 0: success; 1: a claim, fit or check failed; 2: input that cannot be used.
#[derive(Parser)]
#[command(name = "polhode", version, max_term_width = 80)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// The experiments: what they ask, running them, publishing their results
    #[command(subcommand)]
    Experiment(ExperimentCommand),
    Propagate(Box<propagate::Propagate>),
    Motion(motion::Motion),
    Fit(Box<fit::Fit>),
    Simulate(simulate::Simulate),
    Methods(methods::Methods),
    Inertia(Box<inertia::Inertia>),
}

#[derive(Subcommand)]
enum ExperimentCommand {
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

fn main() -> ExitCode {
    match run(CommandLine::parse().command) {
        Ok(()) | Err(Error::Unread) => ExitCode::SUCCESS,
        Err(error) => {
            error::tell("error", &error.to_string());
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(command: Command) -> Result<(), Error> {
    match command {
        Command::Experiment(ExperimentCommand::List { format }) => list(format),
        Command::Experiment(ExperimentCommand::Run { names, scale, out }) => {
            experiment::run(&names, scale, &out)
        }
        Command::Experiment(ExperimentCommand::Check { names, root, accept }) => {
            check::run(&names, &root, accept)
        }
        Command::Experiment(ExperimentCommand::Publish { root, from }) => {
            publish::run(&root, from.as_deref())
        }
        Command::Propagate(propagate) => propagate.run(),
        Command::Motion(motion) => motion.run(),
        Command::Fit(fit) => fit.run(),
        Command::Simulate(simulate) => simulate.run(),
        Command::Methods(methods) => methods.run(),
        Command::Inertia(inertia) => inertia.run(),
    }
}

fn list(format: Option<Format>) -> Result<(), Error> {
    let columns =
        vec![Column::new("name", "", "on the command line"), Column::new("question", "", "what it asks")];
    let mut table = Table::new("experiments", "The experiments.", columns);
    for experiment in experiments::ALL {
        table.push(row![experiment.name, experiment.question]);
    }
    files::emit(&Format::or_default(format, false).write(&table), None)
}
