//! Robot models: every link a row, and what stands in the way told once.

use std::path::Path;

use nalgebra::Vector3;
use polhode_files::error::{Error, warn};
use polhode_files::examined::{Examined, Worth};
use polhode_files::robots::{self as models, Language};
use polhode_files::{read, twins};
use polhode_pages::output::Output;

use super::model::Model;
use super::{Form, Inertia, output, repair, summary};

/// Elements that are named of a model without links.
const SHOWN: usize = 5;

/// Examines the models that `command` names.
///
/// # Errors
/// A file that is no such model; links that are invalid, which come with exit code 1.
pub(super) fn run(command: &Inertia, language: Language) -> Result<(), Error> {
    let file = Output::new(command.out.as_deref())?;
    let point = command.about.map(Vector3::from);
    let mut found = Vec::new();
    for path in std::iter::once(&command.argument).chain(&command.more) {
        let text = read(Path::new(path), &format!("name a file for {}", command.shape))?;
        let links = models::read(language, Path::new(path), &text, command.root.as_deref())?;
        if links.is_empty() {
            let named = models::named_elements(Path::new(path), &text)?;
            let few = named.iter().take(SHOWN).map(String::as_str).collect::<Vec<_>>().join(", ");
            let more = if named.len() > SHOWN { ", ..." } else { "" };
            let held = if few.is_empty() { few } else { format!(", but {few}{more}") };
            warn(&format!("{path}: no link in it{held}; nothing to examine"));
        }
        let links = twins::paired(links);
        let links: Vec<Examined> = links.into_iter().map(|link| Examined::link(link, point)).collect();
        command.check_about(&links)?;
        found.push(Model { path: path.clone(), text, links });
    }
    let repaired = match &command.repair {
        Some(folder) => repair::write(&found, folder)?,
        None => String::new(),
    };
    let form = command.form()?;
    let invalid =
        found.iter().flat_map(|model| &model.links).filter(|link| link.worth() == Worth::Invalid).count();
    let failure = summary::count_of_invalid(&found);
    let one_line = form == Form::Table && !command.details;
    if !one_line {
        let told = if command.details { summary::reports(&found) } else { summary::troubles(&found) };
        if !told.is_empty() {
            warn(&told);
        }
    }
    if !repaired.is_empty() {
        warn(&repaired);
    }
    // a model must not contain an invalid tensor; a report shows it
    if invalid == 0 || form.is_report() {
        let text = if one_line { summary::table(&found) } else { rows(found, form) };
        file.write_whole(&text)?;
    }
    if invalid == 0 { Ok(()) } else { Err(Error::Failed(failure)) }
}

fn rows(models: Vec<Model>, form: Form) -> String {
    let several = models.len() > 1;
    let mut files = Vec::new();
    let mut links = Vec::new();
    for model in models {
        if several {
            files.extend(std::iter::repeat_n(model.path, model.links.len()));
        }
        links.extend(model.links);
    }
    output::write(&links, &files, form)
}
