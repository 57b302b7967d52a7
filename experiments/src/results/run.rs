//! `polhode experiment run`: experiments, and the folders their results go to.

use std::path::Path;

use polhode_files::error::{Error, tell};
use polhode_pages::output::{MARK, Staging, emit};

use super::chosen;
use super::page::{Page, is_page};
use super::provenance::{self, Finished};
use crate::experiment::{Experiment, Report, Scale};

/// Runs the experiments called `names` (or `all`) and writes `out/<scale>/<experiment>/`, and the page `page` of all of them;
/// where it `resumes`, without those that are finished there.
pub(super) fn run(
    names: &[String],
    scale: Scale,
    out: &Path,
    page: Option<&Path>,
    resumes: bool,
) -> Result<(), Error> {
    let with_folder =
        |experiment: &'static Experiment| (experiment, out.join(scale.to_string()).join(experiment.name));
    let chosen: Vec<_> = chosen("experiment run", names)?.into_iter().map(with_folder).collect();
    // a place that cannot be written is found out before the work, not after it
    let mut page = page.map(|path| opened(path, scale, out)).transpose()?;
    for (_, folder) in &chosen {
        drop(Staging::new(folder)?);
    }
    let mut failures = Vec::new();
    for (experiment, folder) in chosen {
        if let Some(finished) = finished(experiment, scale, &folder).filter(|_| resumes) {
            failures
                .extend(finished.failures.iter().map(|failure| format!("{}: {failure}", experiment.name)));
            continue;
        }
        let report = experiment.report(scale)?;
        write(experiment, scale, &report, &folder)?;
        show(experiment, &report, &folder)?;
        if let Some(page) = &mut page {
            page.add(experiment, &report)?;
        }
        failures.extend(report.failures.iter().map(|failure| format!("{}: {failure}", experiment.name)));
    }
    if let Some(page) = page {
        page.finish()?;
    }
    if failures.is_empty() { Ok(()) } else { Err(Error::Failed(failures.join("\n"))) }
}

/// What this very program has finished in `folder`, said on standard error.
pub(super) fn finished(experiment: &Experiment, scale: Scale, folder: &Path) -> Option<Finished> {
    let finished = Finished::of(folder, scale)?;
    tell("note", &format!("{}: finished by this program in {}", experiment.name, folder.display()));
    Some(finished)
}

/// The page, which may stand in the folder of results.
fn opened(path: &Path, scale: Scale, out: &Path) -> Result<Page, Error> {
    is_page(path)?;
    if path.parent() == Some(out) {
        std::fs::create_dir_all(out)
            .map_err(|reason| Error::Input(format!("{}: cannot be made: {reason}", out.display())))?;
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
        staging.write(&format!("{}.svg", figure.name), figure.svg()?.as_bytes())?;
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
