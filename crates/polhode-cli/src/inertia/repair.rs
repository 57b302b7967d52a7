//! Copies of models in which invalid tensors are replaced, and nothing else.

use std::fmt::Write;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use nalgebra::Matrix3;
use polhode::inertia::Diagnosis;
use polhode_files::error::Error;
use polhode_files::examined::{Examined, Worth, six};
use polhode_files::given::Writing;
use polhode_files::inputs;
use polhode_files::text::{rounded, visible};
use polhode_pages::output::Output;

use super::model::Model;

/// By how much the moments of a nearest tensor are raised, relative to its trace, so that programs that judge without a tolerance
/// accept it.
const MARGIN: f64 = 1e-6;

/// Writes a copy of every model to `folder`, and says what was changed.
///
/// # Errors
/// A folder that holds one of the models, or another file of its name; two models of one name; a place that cannot be written.
pub(super) fn write(models: &[Model], folder: &Path) -> Result<String, Error> {
    let mut outputs: Vec<(PathBuf, String)> = Vec::new();
    let mut told = String::new();
    for model in models {
        let path = Path::new(&model.path);
        let name = path.file_name().unwrap_or_default();
        let target = folder.join(name);
        let refuse = |rule: &str| {
            Err(Error::input("--repair", &folder.display().to_string(), rule, "name another folder"))
        };
        if is_same(&target, path) {
            return refuse("holds the model itself, which is not overwritten");
        }
        if outputs.iter().any(|(other, _)| *other == target) {
            return refuse(&format!("two of the models are called '{}'", name.display()));
        }
        let (text, changes) = repaired(model);
        if is_other(&target, &text) {
            return refuse(&format!("holds another '{}', which is not overwritten", name.display()));
        }
        let _ = writeln!(told, "{} -> {}", visible(&model.path), visible(&target.display().to_string()));
        told += &changes;
        outputs.push((target, text));
    }
    std::fs::create_dir_all(folder).map_err(|reason| {
        Error::input(
            "--repair",
            &folder.display().to_string(),
            &reason.to_string(),
            "name a folder that can be made",
        )
    })?;
    // every place is known to be writable, and no input, before the first is written
    let opened = |(target, text): (PathBuf, String)| Ok((Output::to_file("--repair", &target)?, text));
    for (output, text) in outputs.into_iter().map(opened).collect::<Result<Vec<_>, Error>>()? {
        output.write_whole(&text)?;
    }
    Ok(told.trim_end().to_owned())
}

/// Whether both names lead to one file that is there.
fn is_same(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Whether a file stands there that differs from the text; nobody has typed its name.
fn is_other(target: &Path, text: &str) -> bool {
    let Ok(mut file) = inputs::open_own(target) else { return false };
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).is_err() || bytes != text.as_bytes()
}

/// The text with its invalid tensors replaced, and a line for every invalid link.
fn repaired(model: &Model) -> (String, String) {
    let mut changes: Vec<(Range<usize>, String)> = Vec::new();
    let mut told = String::new();
    for link in model.links.iter().filter(|link| link.worth() == Worth::Invalid) {
        let done = replacement(link, &model.path);
        let line = match done {
            Ok((found, tensor, why)) => {
                changes.extend(found);
                format!("{}; {why}", six(&tensor).map(rounded).join(","))
            }
            Err(why) => format!("not repaired: {why}"),
        };
        let _ = writeln!(told, "  {}: {line}", link.name());
    }
    if told.is_empty() {
        told = "  nothing to repair\n".into();
    }
    changes.sort_by_key(|(range, _)| range.start);
    // copies of a <replicate> have one tensor, which stands there once
    changes.dedup_by(|one, other| one.0 == other.0);
    let mut text = String::with_capacity(model.text.len());
    let mut end = 0;
    for (range, value) in changes {
        text += &model.text[end..range.start];
        text += &value;
        end = range.end;
    }
    text += &model.text[end..];
    (text, told)
}

/// New values with their places, the tensor that they state, and where it comes from.
type Replacement = (Vec<(Range<usize>, String)>, Matrix3<f64>, String);

fn replacement(link: &Examined, path: &str) -> Result<Replacement, String> {
    let found = link.diagnosis.as_ref().ok_or("no tensor is stated that could be corrected")?;
    let writing = link.given.writing.as_ref().ok_or("the tensor is not written in the file")?;
    if *writing.file != *Path::new(path) {
        return Err(format!(
            "it is written in '{}'; repair that file",
            visible(&writing.file.display().to_string())
        ));
    }
    let candidates = candidates(found);
    if candidates.is_empty() {
        return Err("no corrected tensor is known".into());
    }
    candidates
        .into_iter()
        .find_map(|(tensor, why)| Some((written(&tensor, writing, link.given.diagonal)?, tensor, why)))
        .ok_or_else(|| "the correction needs a product that the file leaves out".into())
}

/// The tensor without its likely mistake, where one is likelier than all others, then the nearest valid one.
fn candidates(found: &Diagnosis) -> Vec<(Matrix3<f64>, String)> {
    let mut list = Vec::new();
    match found.causes.as_slice() {
        [first, second, ..] if first.is_tied_with(second) => {}
        [first, ..] => list.push((first.corrected, format!("because {}", first.cause))),
        [] => {}
    }
    let trace = found.nearest.trace();
    if trace > 0.0 {
        let inside = found.nearest + Matrix3::identity() * (MARGIN * trace);
        list.push((
            inside,
            format!("the nearest valid tensor, its moments raised by {MARGIN:e} of their sum"),
        ));
    }
    list
}

/// The values of a tensor at their places; `None` if an entry that is not zero has no place.
fn written(tensor: &Matrix3<f64>, writing: &Writing, diagonal: bool) -> Option<Vec<(Range<usize>, String)>> {
    let entries = six(tensor);
    let digits = |values: &[f64]| values.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>();
    if let Some(list) = &writing.list {
        let shown = if diagonal { &entries[..3] } else { &entries[..] };
        let is_whole = entries[shown.len()..].iter().all(|entry| *entry == 0.0);
        return is_whole.then(|| vec![(list.clone(), digits(shown).join(" "))]);
    }
    let mut changes = Vec::new();
    for (value, place) in
        digits(&entries).into_iter().zip(&writing.entries).zip(entries).map(|((a, b), c)| ((a, c), b))
    {
        match place {
            Some(place) => changes.push((place.clone(), value.0)),
            None if value.1 == 0.0 => {}
            None => return None,
        }
    }
    Some(changes)
}
