//! Attitudes from measured rates: rules side by side, coning, error budgets, cost.

mod budgets;
mod coning;
mod cost;
mod motion;
mod rules;

use polhode_files::error::Error;

use crate::experiment::{Context, Report};

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut report = Report::default();
    rules::compare(context, &mut report)?;
    rules::orders(context, &mut report)?;
    coning::coning(context, &mut report)?;
    budgets::budgets(context, &mut report)?;
    cost::time(context, &mut report)?;
    let right = report.checks - report.failures.len() as u64;
    report.conclusion =
        format!("{right} of {} orders and shares of errors inside their 95 % are as claimed", report.checks);
    Ok(report)
}
