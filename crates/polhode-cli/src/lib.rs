//! The command line of polhode. A library, so that it is compiled while what it calls is still being optimised.

mod advise;
mod attitude;
mod audit;
mod bodies;
mod compare;
mod cost;
mod ensemble;
mod fit;
mod flags;
mod inertia;
mod memory;
mod methods;
mod motion;
mod plot;
mod propagate;
mod reference;
mod short_help;
mod show;
mod simulate;

use std::process::ExitCode;

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use polhode_experiments::results;
use polhode_files::error::{self, Error};

const EXAMPLES: &str = "Examples:
  polhode show --body t-handle --out flips.html
  polhode propagate --body t-handle --until 60 --every 10
  polhode motion --body toutatis";

const EXPERIMENT_EXAMPLES: &str = "Examples:
  polhode experiment run --scale smoke
  polhode experiment list";

/// Accurate long-time rotation of rigid bodies
///
/// Exit code 0: success; 1: a claim, fit or check failed; 2: unusable input. `polhode COMMAND --help` explains a command with all its
/// options, and `polhode COMMAND -h` those that a first use needs.
#[derive(Parser)]
#[command(name = "polhode", version, max_term_width = 80, after_help = EXAMPLES)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Show(Box<show::Show>),
    Propagate(Box<propagate::Propagate>),
    Motion(Box<motion::Motion>),
    Audit(Box<audit::Audit>),
    Compare(Box<compare::Compare>),
    Advise(Box<advise::Advise>),
    Inertia(Box<inertia::Inertia>),
    Fit(Box<fit::Fit>),
    Attitude(Box<attitude::Attitude>),
    Simulate(Box<simulate::Simulate>),
    Ensemble(Box<ensemble::Ensemble>),
    Gather(Box<ensemble::Gather>),
    Plot(Box<plot::Plot>),
    Bodies(bodies::Bodies),
    Methods(methods::Methods),
    /// Run the experiments that compare methods, or list them
    #[command(subcommand, after_help = EXPERIMENT_EXAMPLES)]
    Experiment(results::ExperimentCommand),
}

/// Reads the arguments of the program and does what they ask for; messages go to standard error.
#[must_use]
pub fn command() -> ExitCode {
    let matches = short_help::shortened(CommandLine::command()).get_matches();
    let line = CommandLine::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    match run(line.command) {
        Ok(()) | Err(Error::Unread) => ExitCode::SUCCESS,
        Err(error) => {
            error::tell("error", &error.to_string());
            ExitCode::from(error.exit_code())
        }
    }
}

fn run(command: Command) -> Result<(), Error> {
    match command {
        Command::Experiment(command) => command.run(),
        Command::Propagate(propagate) => propagate.run().inspect(|()| propagate.note()),
        Command::Show(show) => show.run().inspect(|()| show.motion.note()),
        Command::Motion(motion) => motion.run().inspect(|()| motion.start.note(&motion.body)),
        Command::Advise(advise) => advise.run().inspect(|()| advise.motion.note()),
        Command::Compare(compare) => compare.run().inspect(|()| compare.motion.note()),
        Command::Plot(plot) => plot.run().inspect(|()| plot.motion.note()),
        Command::Audit(audit) => audit.run(),
        Command::Ensemble(ensemble) => ensemble.run(),
        Command::Gather(gather) => gather.run(),
        Command::Fit(fit) => fit.run(),
        Command::Attitude(attitude) => attitude.run(),
        Command::Simulate(simulate) => simulate.run(),
        Command::Methods(methods) => methods.run(),
        Command::Bodies(bodies) => bodies.run(),
        Command::Inertia(inertia) => inertia.run(),
    }
}
