//! A body from a file that another command or another program wrote.

use std::path::Path;

use nalgebra::Matrix3;
use polhode::inertia::Inertia;
use polhode_files::error::{Error, warn};
use polhode_files::read;
use polhode_files::text::visible;
use serde_json::Value;

use crate::inertia;

/// The inertia of the body that `text` names, as FILE or FILE:LINK; `None` where there is no such file.
pub(crate) fn inertia(text: &str) -> Result<Option<Inertia>, Error> {
    let whole = Path::new(text);
    let (path, link) = match text.rsplit_once(':') {
        _ if whole.is_file() => (whole, None),
        Some((file, link)) if Path::new(file).is_file() => (Path::new(file), Some(link)),
        _ => return Ok(None),
    };
    let mut bodies = tensors(path)?;
    let chosen = match link {
        Some(link) => bodies.iter().position(|(name, _)| name == link),
        None if bodies.len() == 1 => Some(0),
        None => None,
    };
    let Some(chosen) = chosen else {
        let names: Vec<&str> =
            bodies.iter().map(|(name, _)| name.as_str()).filter(|name| !name.is_empty()).collect();
        return Err(match link {
            _ if bodies.is_empty() => {
                Error::input("--body", text, "no body in it states an inertia tensor", "name another file")
            }
            Some(_) if names.is_empty() => Error::input(
                "--body",
                text,
                "the bodies of this file have no names",
                "leave out the colon and what follows",
            ),
            Some(link) => Error::unknown_name(&format!("--body: {}", path.display()), "link", link, names),
            None => Error::input(
                "--body",
                text,
                &format!("has {} bodies: {}", bodies.len(), visible(&names.join(", "))),
                "name one of them behind a colon, as FILE:NAME",
            ),
        });
    };
    let (name, tensor) = bodies.swap_remove(chosen);
    let of = if name.is_empty() { name } else { format!(" of '{}'", visible(&name)) };
    let inertia = Inertia::from_tensor(tensor);
    inertia.map(Some).map_err(|error| Error::Input(format!("--body: {}{of}: {error}", path.display())))
}

/// Name and tensor of each body, in the axes of its frame, about its centre of mass.
fn tensors(path: &Path) -> Result<Vec<(String, Matrix3<f64>)>, Error> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("json") => json(path),
        Some(kind @ ("toml" | "urdf" | "mjcf" | "sdf" | "xml")) => inertia::tensors_of_file(path, kind),
        _ => Err(Error::input(
            "--body",
            &path.display().to_string(),
            "the ending names no kind of file with a body",
            "name a file .json, .toml, .urdf, .mjcf, .sdf or .xml",
        )),
    }
}

/// What `polhode inertia` and `polhode fit` write.
fn json(path: &Path) -> Result<Vec<(String, Matrix3<f64>)>, Error> {
    let text = read(path, "name a JSON file of polhode inertia or polhode fit")?;
    let refused =
        |error: &dyn std::fmt::Display| Error::Input(format!("--body: {}: {error}", path.display()));
    let value: Value = serde_json::from_str(&text).map_err(|error| refused(&error))?;
    let objects = match value {
        Value::Array(objects) => objects,
        object => vec![object],
    };
    let each = objects.into_iter().map(|object| {
        let name = object["name"].as_str().unwrap_or_default().to_string();
        let matrix = |key: &str| serde_json::from_value::<[[f64; 3]; 3]>(object[key].clone()).ok();
        let entries = match (matrix("inertia"), matrix("shape")) {
            (Some(entries), _) => entries,
            (None, Some(entries)) => {
                warn(&format!(
                    "--body: {}: the tensor is known up to a factor, and its trace is taken as 1",
                    path.display()
                ));
                entries
            }
            (None, None) => {
                return Err(refused(
                    &"no \"inertia\" and no \"shape\" of 3 x 3 numbers; give the JSON of polhode inertia or polhode fit",
                ));
            }
        };
        Ok((name, Matrix3::from_fn(|j, k| entries[j][k])))
    });
    each.collect()
}
