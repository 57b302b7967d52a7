//! The command line of polhode.

mod arguments;
mod body_arguments;
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
mod parallel;
mod propagate;
mod results;
mod simulate;
mod table;
mod text;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use error::Error;

/// Accurate long-time rotation of rigid bodies
///
/// Exit code 0: success; 1: a claim, fit or check failed; 2: unusable input.
#[derive(Parser)]
#[command(name = "polhode", version, max_term_width = 80)]
struct CommandLine {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List, run, check and publish the experiments
    #[command(subcommand)]
    Experiment(results::ExperimentCommand),
    Propagate(Box<propagate::Propagate>),
    Motion(motion::Motion),
    Fit(Box<fit::Fit>),
    Simulate(Box<simulate::Simulate>),
    Methods(methods::Methods),
    Inertia(Box<inertia::Inertia>),
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
        Command::Experiment(command) => command.run(),
        Command::Propagate(propagate) => propagate.run(),
        Command::Motion(motion) => motion.run(),
        Command::Fit(fit) => fit.run(),
        Command::Simulate(simulate) => simulate.run(),
        Command::Methods(methods) => methods.run(),
        Command::Inertia(inertia) => inertia.run(),
    }
}
