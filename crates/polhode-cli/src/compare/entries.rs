//! The methods of a comparison, at every step or tolerance.

use polhode::body::{Body, Clock, Point};
use polhode::method::{AnyMethod, Claimed, ToleranceError};
use polhode::num::Dd;
use polhode::run::{Schedule, ScheduleError};
use polhode_files::error::Error;
use polhode_files::numbers::{list, positive};
use polhode_files::text::short;

use super::Compare;
use crate::cost;
use crate::methods::{adaptive, allowed, named, not_taken};

/// Numbers above zero, a value of its own because clap reads `Vec` as a repeated flag.
#[derive(Clone, Debug)]
pub(super) struct Positives(Vec<f64>);

pub(super) fn positives(text: &str) -> Result<Positives, String> {
    let _ = list(text)?;
    let items = text.split(',').enumerate();
    let item = |(k, item)| positive(item).map_err(|error| format!("item {}: {error}", k + 1));
    items.map(item).collect::<Result<_, _>>().map(Positives)
}

/// A method with the step or the tolerance that it is run with.
pub(super) struct Entry {
    pub(super) method: Box<dyn AnyMethod>,
    /// Its name as it was typed, the same at every step and tolerance.
    pub(super) family: String,
    pub(super) step: Option<f64>,
    pub(super) tolerance: Option<f64>,
}

impl Compare {
    /// Every method at every step or tolerance that it takes.
    pub(super) fn entries(&self, span: f64) -> Result<Vec<Entry>, Error> {
        let (mut entries, mut is_taken) = (Vec::new(), false);
        for name in &self.methods {
            let name = name.trim();
            if name == "exact" {
                let rule = "is the reference of the comparison";
                return Err(Error::input("--methods", name, rule, "leave it out; exact-step takes steps"));
            }
            if name.starts_with("dissipating:") {
                let rule =
                    "is for a body with inner friction, and the true motion here is that of a rigid body";
                let remedy = "leave it out; `polhode propagate --method` takes it";
                return Err(Error::input("--methods", name, rule, remedy));
            }
            let method = named("--methods", name)?;
            if method.tolerance().is_none() {
                let Some(Positives(steps)) = &self.steps else {
                    let rule = format!("missing: {name} needs steps in seconds");
                    return Err(Error::input("--steps", "", &rule, "give --steps h1,h2,..."));
                };
                for &step in steps {
                    self.check_step(step, span)?;
                    let (method, family) = (named("--methods", name)?, name.to_owned());
                    entries.push(Entry { method, family, step: Some(step), tolerance: None });
                }
                continue;
            }
            let given = method.tolerance().filter(|_| name.contains(':'));
            match (&self.tolerances, given) {
                (Some(Positives(tolerances)), None) => {
                    is_taken = true;
                    for &tolerance in tolerances {
                        let method = method.with_tolerance(tolerance).map_err(|error| match error {
                            ToleranceError::OutOfRange { method, range, .. } => {
                                not_taken("--tolerances", tolerance, name, &allowed(method, range))
                            }
                            error => Error::Input(format!("--tolerances: {error}")),
                        })?;
                        let (family, tolerance) = (name.to_owned(), Some(tolerance));
                        entries.push(Entry { method, family, step: None, tolerance });
                    }
                }
                (_, tolerance) => {
                    let family = name.split(':').next().unwrap_or(name).to_owned();
                    entries.push(Entry { method, family, step: None, tolerance });
                }
            }
        }
        if let (Some(Positives(steps)), true) =
            (&self.steps, entries.iter().all(|entry| entry.step.is_none()))
        {
            let value: Vec<String> = steps.iter().map(|step| short(*step)).collect();
            let rule = "each of the methods chooses its steps";
            return Err(Error::input(
                "--steps",
                &value.join(","),
                rule,
                "leave it out, or add a method that takes steps",
            ));
        }
        if let (Some(Positives(tolerances)), false) = (&self.tolerances, is_taken) {
            let (rule, remedy) = match entries.iter().all(|entry| entry.step.is_some()) {
                true => (
                    "none of the methods chooses its steps",
                    format!("leave it out, or use one of {}", adaptive()),
                ),
                false => (
                    "each method that chooses its steps has a tolerance in its name",
                    "leave it out, or name a method without one".to_string(),
                ),
            };
            let value: Vec<String> = tolerances.iter().map(|tolerance| format!("{tolerance:e}")).collect();
            return Err(Error::input("--tolerances", &value.join(","), rule, &remedy));
        }
        Ok(entries)
    }

    fn check_step(&self, step: f64, span: f64) -> Result<(), Error> {
        let clock = Clock { start: self.start_time, step };
        let Err(error) = Schedule::at_times(clock, &[self.until]) else { return Ok(()) };
        let (value, until) = (short(step), short(self.until));
        let divided = short(span / (span / step).round().max(1.0));
        Err(match error {
            ScheduleError::NotReached { nearest, .. } => Error::input(
                "--steps",
                &value,
                &format!(
                    "no whole number of these steps leads to --until {until}; the nearest time is {}",
                    short(nearest)
                ),
                &format!("use {divided}, or --until {}", short(nearest)),
            ),
            error => Error::Input(format!("--steps: '{value}': {error}")),
        })
    }

    /// Refuses a method that would take forever, and says on a terminal of one that takes long.
    pub(super) fn check_cost(
        &self,
        entry: &Entry,
        body: &Body,
        start: &Point<Dd>,
        speed: f64,
        span: f64,
    ) -> Result<(), Error> {
        let step = match entry.step {
            Some(step) => {
                cost::check("--steps", step, span / step, "use larger steps or an earlier end")?;
                step
            }
            None => {
                cost::check_turn("--until", self.until, speed * span)?;
                span.min(1.0 / speed)
            }
        };
        let clock = Clock { start: self.start_time, step };
        cost::announce(entry.method.as_ref(), body, start.to_f64(), clock, libm::ceil(span / step) as u64);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_steps_are_positive_numbers() {
        assert_eq!(positives("0.1, 2e-3").map(|p| p.0), Ok(vec![0.1, 2e-3]));
        assert!(positives("0.1,0").unwrap_err().starts_with("item 2: 0.0 is not positive"));
        assert!(positives("").is_err() && positives("1,x").is_err());
    }
}
