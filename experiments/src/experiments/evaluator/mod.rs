//! What one evaluation of the exact motion loses to rounding, what the rounding of its input costs, and what other forms of the
//! solution and maps of equal steps lose beside it.

mod bound;
mod conditioning;
mod forms;
mod grid;
mod maps;
mod reference;
#[cfg(test)]
mod tests;

use polhode_files::error::Error;

use crate::experiment::{Context, Report};

const SEED: u64 = 20_261_127;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut report = Report { seed: Some(SEED), ..Report::default() };
    bound::run(context, &mut report)?;
    conditioning::run(&mut report)?;
    forms::run(context, &mut report)?;
    maps::run(context, &mut report)?;
    Ok(report)
}
