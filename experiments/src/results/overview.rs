//! What was found by all experiments: a line for each as it ends, and one screen at the end.

use std::path::Path;

use polhode_files::error::Error;
use polhode_pages::output::emit;
use polhode_pages::screen::{width, wrapped};

use crate::experiment::Report;

/// Blanks before the second line of a sentence.
const INDENT: usize = 2;

/// What was found so far.
#[derive(Default)]
pub(super) struct Overview {
    screens: Vec<String>,
    conclusions: Vec<String>,
    checks: u64,
}

impl Overview {
    /// Takes the report of the experiment called `name`, and says in a line what it found; `place` is its number among all.
    ///
    /// # Errors
    /// An output that cannot be written.
    pub(super) fn add(&mut self, name: &str, place: &str, report: &Report) -> Result<(), Error> {
        let rows: usize = report.tables.iter().map(|table| table.rows().len()).sum();
        let found = match (report.failures.len(), report.conclusion.as_str()) {
            (0, "") => format!("{rows} rows"),
            (0, conclusion) => conclusion.to_owned(),
            (failed, _) => format!("failed, {failed} claims do not hold"),
        };
        let first = found.split(". ").next().unwrap_or(&found).trim_end_matches(['.', '\n']);
        let line = format!("{place} · {name}: {first} · {:.0} s", report.took.as_secs_f64());
        emit(&format!("{}\n", wrapped(&line, width(), INDENT)), None)?;
        self.screens.extend(report.screen.clone());
        // one that has a screen of its own says it there
        if report.screen.is_none() && !report.conclusion.is_empty() {
            self.conclusions.push(format!("{name}: {}", report.conclusion));
        }
        self.checks += report.checks;
        Ok(())
    }

    /// All of it; results stand in `folder`, the page at `page`, and `failures` of the claims do not hold.
    pub(super) fn screen(&self, folder: &Path, page: Option<&Path>, failures: usize) -> String {
        let mut text = String::new();
        for screen in &self.screens {
            text += &format!("\n{screen}");
        }
        text.push('\n');
        let said = self.conclusions.iter().map(|conclusion| wrapped(conclusion, width(), INDENT));
        text += &said.map(|line| line + "\n").collect::<String>();
        let hold = self.checks.saturating_sub(failures as u64);
        text += &format!("\n{hold} of {} claims that were checked hold.\n", self.checks.max(failures as u64));
        text += &format!("Tables: {}\n", folder.display());
        if let Some(page) = page {
            text += &format!("Page:   {}\n", page.display());
        }
        text
    }
}
