//! `polhode experiment run`: experiments, and the folders their results go to.

use std::path::{Path, PathBuf};

use polhode_files::error::{Error, tell};
use polhode_pages::output::{MARK, Staging, emit};

use super::overview::Overview;
use super::page::{Page, is_page};
use super::provenance::{self, Finished};
use super::{chosen, main};
use crate::experiment::{Experiment, Report, Scale};

/// What is run, and what is shown of it.
pub(super) struct Asked {
    /// Names of experiments, or all; where there are none, the main ones.
    pub(super) names: Vec<String>,
    pub(super) scale: Scale,
    /// Results go to `out/<scale>/<experiment>/`.
    pub(super) out: PathBuf,
    /// All results on one page.
    pub(super) page: Option<PathBuf>,
    /// Whether experiments that are finished in `out` are left out.
    pub(super) resumes: bool,
    /// Whether all tables are shown.
    pub(super) tables: bool,
}

impl Asked {
    /// Whether the question is what was found in all rather than the tables of one experiment.
    fn is_overview(&self) -> bool {
        self.names.is_empty() || self.names.iter().any(|name| name == "all")
    }

    fn experiments(&self) -> Result<Vec<&'static Experiment>, Error> {
        if self.names.is_empty() { Ok(main()) } else { chosen("experiment run", &self.names) }
    }

    /// Runs them and writes their results.
    ///
    /// # Errors
    /// A name that is no experiment, a place that cannot be written, claims that failed.
    pub(super) fn run(&self) -> Result<(), Error> {
        let (scale, of_scale) = (self.scale, self.out.join(self.scale.to_string()));
        let experiments = self.experiments()?;
        let path = self
            .page
            .clone()
            .or_else(|| (self.is_overview() && !self.resumes).then(|| of_scale.join("index.html")));
        // a place that cannot be written is found out before the work, not after it
        let mut page = path.as_deref().map(|path| opened(path, scale, &self.out)).transpose()?;
        for experiment in &experiments {
            drop(Staging::new(&of_scale.join(experiment.name))?);
        }
        let mut overview = Overview::default();
        let mut failures = Vec::new();
        for (k, experiment) in experiments.iter().enumerate() {
            let name = experiment.name;
            let folder = of_scale.join(name);
            if let Some(finished) = finished(experiment, scale, &folder).filter(|_| self.resumes) {
                failures.extend(finished.failures.iter().map(|failure| format!("{name}: {failure}")));
                continue;
            }
            let place = format!("{} of {}", k + 1, experiments.len());
            let report = experiment.report(scale, format!("{place} · {name}"))?;
            write(experiment, scale, &report, &folder)?;
            if self.is_overview() {
                overview.add(name, &place, &report)?;
            }
            if self.tables || !self.is_overview() {
                show(experiment, &report, &folder)?;
            }
            if let Some(page) = &mut page {
                page.add(experiment, &report)?;
            }
            failures.extend(report.failures.iter().map(|failure| format!("{name}: {failure}")));
        }
        if let Some(page) = page {
            page.finish()?;
        }
        if self.is_overview() {
            emit(&overview.screen(&of_scale, path.as_deref(), failures.len()), None)?;
        }
        if failures.is_empty() { Ok(()) } else { Err(Error::Failed(failures.join("\n"))) }
    }
}

/// What this very program has finished in `folder`, said on standard error.
pub(super) fn finished(experiment: &Experiment, scale: Scale, folder: &Path) -> Option<Finished> {
    let finished = Finished::of(folder, scale)?;
    tell("note", &format!("{}: finished by this program in {}", experiment.name, folder.display()));
    Some(finished)
}

/// The page, which may stand in the folder `out` of results.
fn opened(path: &Path, scale: Scale, out: &Path) -> Result<Page, Error> {
    is_page(path)?;
    if let Some(folder) = path.parent().filter(|folder| folder.starts_with(out)) {
        std::fs::create_dir_all(folder)
            .map_err(|reason| Error::Input(format!("{}: cannot be made: {reason}", folder.display())))?;
    }
    Page::new(path, scale)
}

/// Replaces the results in `folder`.
pub(super) fn write(
    experiment: &Experiment,
    scale: Scale,
    report: &Report,
    folder: &Path,
) -> Result<(), Error> {
    let staging = Staging::new(folder)?;
    for table in report.tables.iter().chain(&report.data).chain(&report.timing).chain(&report.times) {
        staging.write(&format!("{}.csv", table.name), table.csv().as_bytes())?;
    }
    // a view may be one of the tables, shown alone
    let also = report.views.iter().filter(|view| report.tables.iter().all(|table| table.name != view.name));
    for table in report.tables.iter().chain(also) {
        staging.write(&format!("{}.md", table.name), table.markdown().as_bytes())?;
        staging.write(&format!("{}.tex", table.name), table.latex().as_bytes())?;
    }
    for figure in &report.figures {
        staging.write(&format!("{}.svg", figure.name), figure.svg().as_bytes())?;
    }
    for drawing in &report.drawings {
        staging.write(&format!("{}.svg", drawing.name), drawing.svg.as_bytes())?;
    }
    staging.write(MARK, provenance::describe(experiment.name, scale, report).as_bytes())?;
    staging.commit()
}

fn show(experiment: &Experiment, report: &Report, folder: &Path) -> Result<(), Error> {
    let shown = if report.views.is_empty() { &report.tables } else { &report.views };
    let mut text = String::new();
    for table in shown.iter().chain(&report.timing) {
        text += &format!("\n{}: {}\n\n{}", experiment.name, table.caption, table.terminal());
    }
    emit(&format!("{text}\nWritten to {}\n", folder.display()), None)
}
