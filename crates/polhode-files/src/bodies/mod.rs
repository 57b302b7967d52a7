//! Bodies from files of every kind: JSON of `inertia` and `fit`, TOML lists of parts, robot models.

mod form;
mod json;
mod parts;

use std::path::Path;

use nalgebra::Matrix3;
use polhode::body::WheelAtStart;
use polhode::catalogue;
use polhode::inertia::Inertia;

use crate::error::{Error, warn};
use crate::examined::{Examined, Worth};
use crate::given::Given;
pub use crate::look::{Look, Piece};
use crate::read;
use crate::robots::{self, Language};
use crate::text::visible;
pub use form::{Form, form};
pub use parts::parts;

/// Name and tensor of a body in the axes of its frame, about its centre of mass, kg m², its wheels, and what its file remarks on it; the
/// name may be empty.
type Named = (String, Matrix3<f64>, Vec<WheelAtStart>, Vec<String>);

/// The body that a text names.
struct Chosen<'t> {
    path: &'t Path,
    name: String,
    tensor: Matrix3<f64>,
    wheels: Vec<WheelAtStart>,
    remarks: Vec<String>,
}

/// The inertia of the body that `text` names, as FILE or FILE:LINK, and the wheels that the file gives it; `None` where there is no such
/// file. Messages begin with `flag`; what a fit warned of is told again, as is why a tensor is suspicious. A mesh has a density of 1 kg/m³.
///
/// # Errors
/// A file that cannot be read, that has no such body or several to choose from, or whose tensor no body has.
pub fn inertia(flag: &str, text: &str) -> Result<Option<(Inertia, Vec<WheelAtStart>)>, Error> {
    let Some(Chosen { path, name, tensor, wheels, remarks }) = chosen(flag, text)? else { return Ok(None) };
    let of = if name.is_empty() { name } else { format!(" of '{}'", visible(&name)) };
    let inertia = Inertia::from_tensor(tensor);
    let inertia =
        inertia.map_err(|error| Error::Input(format!("{flag}: {}{of}: {error}", path.display())))?;
    remarks.iter().for_each(|remark| warn(&format!("{flag}: {}{of}: {remark}", path.display())));
    Ok(Some((inertia, wheels)))
}

/// Whether a text names a mesh, which has no mass.
#[must_use]
pub fn is_mesh(text: &str) -> bool {
    matches!(ending(Path::new(text)).as_str(), "stl" | "obj" | "ply") && Path::new(text).is_file()
}

/// Refuses a mesh, which has no mass, and warns of moments of which the catalogue has the ratios alone: where their size counts, as under a
/// torque, drag, a weight or a wheel. `name` is what `flag` names.
///
/// # Errors
/// A mesh.
pub fn check_size(flag: &str, name: &str) -> Result<(), Error> {
    if is_mesh(name) {
        let rule = "a mesh file has no mass, and here the inertia is needed in kg m^2";
        let remedy = "write a TOML file with the mesh as a [[part]] with its mass";
        return Err(Error::input(flag, name, rule, remedy));
    }
    if catalogue::body(name).is_some_and(|body| body.unit == "ratio") {
        warn(&format!(
            "{name}: the catalogue has only ratios of its moments; they are taken as kg m^2, and the result depends on it"
        ));
    }
    Ok(())
}

fn chosen<'t>(flag: &str, text: &'t str) -> Result<Option<Chosen<'t>>, Error> {
    let whole = Path::new(text);
    // the name of a link holds colons too where models stand in others
    let mut parts = text.rmatch_indices(':').map(|(at, _)| (Path::new(&text[..at]), &text[at + 1..]));
    let (path, link) = match parts.find(|(file, _)| file.is_file()) {
        _ if whole.is_file() => (whole, None),
        Some((file, link)) => (file, Some(link)),
        None => return Ok(None),
    };
    let mut bodies = tensors(flag, path, link)?;
    if let Some(link) = link {
        let namesakes = bodies.iter().filter(|(name, ..)| name == link).count();
        if namesakes > 1 {
            let rule = format!("{namesakes} bodies of the file have this name");
            return Err(Error::input(flag, text, &rule, "give each body a name of its own"));
        }
    }
    let chosen = match link {
        Some(link) => bodies.iter().position(|(name, ..)| name == link),
        None if bodies.len() == 1 => Some(0),
        None => None,
    };
    let Some(chosen) = chosen else {
        let names: Vec<&str> =
            bodies.iter().map(|(name, ..)| name.as_str()).filter(|name| !name.is_empty()).collect();
        return Err(match link {
            _ if bodies.is_empty() => {
                Error::input(flag, text, "no body in it states an inertia tensor", "name another file")
            }
            Some(_) if names.is_empty() => Error::input(
                flag,
                text,
                "the bodies of this file have no names",
                "leave out the colon and what follows",
            ),
            Some(link) => Error::unknown_name(&format!("{flag}: {}", path.display()), "link", link, names),
            None => Error::input(
                flag,
                text,
                &format!("has {} bodies: {}", bodies.len(), visible(&names.join(", "))),
                "give the name of one after a colon, as FILE:NAME",
            ),
        });
    };
    let (name, tensor, wheels, remarks) = bodies.swap_remove(chosen);
    Ok(Some(Chosen { path, name, tensor, wheels, remarks }))
}

/// The ending of a file in small letters.
fn ending(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
}

/// Every body of a file, whose ending tells its kind; the one that is meant is named by `link`.
fn tensors(flag: &str, path: &Path, link: Option<&str>) -> Result<Vec<Named>, Error> {
    match ending(path).as_str() {
        "json" => json::tensors(flag, path),
        "toml" => {
            let parts = parts::read(path)?;
            Ok(vec![(String::new(), parts.body.tensor(), parts.wheels, Vec::new())])
        }
        "stl" | "obj" | "ply" => {
            Ok(vec![(String::new(), form::of_mesh(path)?.tensor(), Vec::new(), Vec::new())])
        }
        kind @ ("urdf" | "mjcf" | "sdf" | "xml") => links(path, kind, link),
        _ => Err(Error::input(
            flag,
            &path.display().to_string(),
            "no bodies are read from files with this ending",
            "name a file .json, .toml, .stl, .obj, .ply, .urdf, .mjcf, .sdf or .xml",
        )),
    }
}

/// The links of a robot model that state a tensor; a defect of the one that is meant, or beside the only one that can be read, is an error.
fn links(path: &Path, kind: &str, meant: Option<&str>) -> Result<Vec<Named>, Error> {
    let text = model(path)?;
    let language = language(kind, &text);
    let tensor = |body: &Given| {
        let turn = body.turn.to_rotation_matrix();
        turn * body.tensor * turn.transpose()
    };
    let links = robots::with_namesakes(language, path, &text, None)?;
    // which could change every tensor: settings and defaults may stand in an included file too
    let is_common = |link: &&Given| {
        link.name == robots::SETTINGS || language == Language::Mjcf && link.name.starts_with("include ")
    };
    if let Some(defect) = links.iter().filter(is_common).find_map(|link| link.defect.clone()) {
        return Err(Error::Input(defect));
    }
    // a frame without a body, and a link that states no tensor, have none to give
    let bodies = links.iter().filter(|link| !link.massless && link.defect.is_none());
    let remarks = |body: &Given| -> Vec<String> {
        let examined = Examined::link(body.clone(), None);
        let trouble = examined.trouble().filter(|_| examined.worth() == Worth::Suspicious);
        let doubt = trouble.map(|trouble| doubt(&trouble, examined.cause().as_deref()));
        body.remark.clone().into_iter().chain(doubt).collect()
    };
    let bodies: Vec<Named> =
        bodies.map(|body| (body.name.clone(), tensor(body), Vec::new(), remarks(body))).collect();
    let is_in_question = |link: &&Given| meant.map_or(bodies.len() == 1, |name| link.name == name);
    let defect = links.iter().filter(is_in_question).find_map(|link| link.defect.as_ref());
    match (defect, meant) {
        (Some(defect), Some(_)) => Err(Error::Input(defect.clone())),
        (Some(defect), None) => {
            let remedy = "mend it, or give the name of the body after a colon, as FILE:NAME";
            Err(Error::Input(format!("{defect}; {remedy}")))
        }
        (None, _) => Ok(bodies),
    }
}

/// What is to be known of a tensor that is valid, but suspicious.
fn doubt(trouble: &str, cause: Option<&str>) -> String {
    let cause = cause.filter(|cause| *cause != trouble);
    let cause = cause.map_or(String::new(), |cause| format!("; probable cause: {}", visible(cause)));
    format!("its tensor is suspicious: {}{cause}", visible(trouble))
}

fn model(path: &Path) -> Result<String, Error> {
    read(path, "name a URDF, MJCF or SDF file")
}

/// The language of a model by the ending of its file, or else by its text.
#[must_use]
pub fn language(kind: &str, text: &str) -> Language {
    Language::named(kind).unwrap_or(if text.contains("<robot") {
        Language::Urdf
    } else if text.contains("<sdf") {
        Language::Sdf
    } else {
        Language::Mjcf
    })
}
