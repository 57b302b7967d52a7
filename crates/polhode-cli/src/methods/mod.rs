//! `polhode methods`: the catalogue, and the laws of a method.

mod check;

use std::path::PathBuf;

use clap::Args;
use polhode::method::schemes::{STRANG, scheme};
use polhode::method::{
    AnyMethod, Claimed, Dissipating, LinearlyImplicitEuler, Splitting, ToleranceError, UnknownMethod,
    catalogue, method,
};
use polhode_experiments::methods::{listed, schemes};
use polhode_files::error::Error;
use polhode_files::numbers::number;
use polhode_pages::output::emit;
use polhode_pages::table::Format;

const EXAMPLES: &str = "Examples:
  polhode methods
  polhode methods --schemes --format json
  polhode methods --check rk4 --motion free --format table";

/// List the methods: order, what each conserves, cost per step, source
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Methods {
    /// List the schemes instead: what may follow the @ in a name, as in kick-drift@srkn-6b
    #[arg(long)]
    schemes: bool,
    #[command(flatten)]
    check: check::Check,
    /// How rows are printed [default: table on a terminal, csv otherwise]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Write to this file instead of standard output; its ending names the format: .csv, .json or .txt
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Methods {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let format = Format::of(self.format, self.out.as_deref())?;
        if let Some(report) = self.check.report()? {
            emit(&check::written(&report, format), self.out.as_deref())?;
            return check::judged(&report);
        }
        let table = if self.schemes { schemes() } else { listed() };
        emit(&format.write(&table), self.out.as_deref())
    }
}

/// The method that `flag` names.
pub(crate) fn named(flag: &str, name: &str) -> Result<Box<dyn AnyMethod>, Error> {
    method(name).map_err(|error| unknown(flag, error))
}

/// The same, or `dissipating:LOSS[@SCHEME]`, which moves another body than a rigid one and is no method of the catalogue.
pub(crate) fn moving(flag: &str, name: &str) -> Result<Box<dyn AnyMethod>, Error> {
    let Some(argument) = name.strip_prefix("dissipating:") else { return named(flag, name) };
    let refused = |error: &dyn std::fmt::Display| Error::Input(format!("{flag}: {name}: {error}"));
    let (loss, scheme) = match argument.split_once('@') {
        None => (argument, STRANG),
        Some((loss, name)) => (loss, *scheme(name).map_err(|error| refused(&error))?),
    };
    let loss = number(loss).map_err(|error| refused(&error))?;
    let parts = Dissipating::new(loss).map_err(|error| refused(&error))?;
    Ok(Box::new(Splitting::of_flows(parts, scheme).map_err(|error| refused(&error))?))
}

/// Why what `flag` names is no method.
pub(crate) fn unknown(flag: &str, error: UnknownMethod) -> Error {
    match error {
        // where it is one of the answers, the caller has taken it
        UnknownMethod::Name { name } if name == "exact" => {
            Error::input(flag, &name, "the exact motion takes no steps", "name a method of `polhode methods`")
        }
        UnknownMethod::Name { name } if name == "dissipating" => {
            Error::input(flag, &name, "has no loss", "write it after the name, as in dissipating:1e-3")
        }
        UnknownMethod::Name { name } if name.starts_with("dissipating:") => {
            let rule = "is for a body with inner friction, and here the body is rigid";
            Error::input(flag, &name, rule, "`polhode propagate --method` takes it")
        }
        UnknownMethod::Name { name } => {
            let mut known: Vec<String> = catalogue().iter().map(|method| method.name()).collect();
            known.insert(0, "exact".into());
            known.push(LinearlyImplicitEuler.name());
            Error::unknown_name(flag, "method", &name, known.iter().map(String::as_str))
        }
        UnknownMethod::Argument { name, rule } => {
            Error::input(flag, &name, "cannot take this argument", &format!("allowed: {rule}"))
        }
        error => Error::Input(format!("{flag}: {error}")),
    }
}

/// Names of the methods that choose their steps, the most accurate first.
pub(crate) fn adaptive() -> String {
    let mut names: Vec<String> = catalogue()
        .iter()
        .filter(|method| method.tolerance().is_some())
        .map(|method| method.name())
        .collect();
    names.reverse();
    names.join(", ")
}

/// Why a tolerance that stands beside the name of a method cannot be used.
pub(crate) enum Unusable {
    Unknown(UnknownMethod),
    FixedSteps,
    /// The name has one already.
    Twice,
    /// Which tolerances the method takes.
    OutOfRange(String),
}

/// The method `name` at a tolerance that stands beside its name.
pub(crate) fn at_tolerance(name: &str, tolerance: f64) -> Result<Box<dyn AnyMethod>, Unusable> {
    if name.starts_with("dissipating:") {
        return Err(Unusable::FixedSteps);
    }
    let found = method(name).map_err(Unusable::Unknown)?;
    match found.with_tolerance(tolerance) {
        Err(ToleranceError::FixedSteps { .. }) => Err(Unusable::FixedSteps),
        _ if name.contains(':') => Err(Unusable::Twice),
        Err(ToleranceError::OutOfRange { method, range, .. }) => {
            Err(Unusable::OutOfRange(allowed(method, range)))
        }
        Err(error) => Err(Unusable::OutOfRange(error.to_string())),
        Ok(found) => Ok(found),
    }
}

/// Which tolerances a method takes.
pub(crate) fn allowed(method: &str, range: &str) -> String {
    format!("a tolerance {range}, such as {method}:1e-12")
}

/// Why the method `name` cannot take what `flag` gives.
pub(crate) fn not_taken(flag: &str, tolerance: f64, name: &str, allowed: &str) -> Error {
    let rule = format!("--method {name} cannot take it");
    Error::input(flag, &format!("{tolerance:e}"), &rule, &format!("allowed: {allowed}"))
}
