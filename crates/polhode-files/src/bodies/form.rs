//! What the body of a file looks like.

use std::path::Path;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::inertia::{Amount, MassProperties};

use super::{Chosen, chosen, language, parts};
use crate::error::Error;
use crate::look::{Look, Piece};
use crate::mesh::{MeshOptions, surface};
use crate::robots;

/// What a body from a file looks like, in the axes of its frame.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Form {
    /// What is to be drawn; nothing where the file does not tell.
    pub pieces: Vec<Piece>,
    /// m.
    pub center_of_mass: Vector3<f64>,
    /// What is to be known of it.
    pub remark: Option<String>,
}

/// What the body that `text` names as FILE or FILE:LINK looks like; `None` where there is no such file. Messages begin with `flag`.
///
/// Of a JSON file, and of a link whose meshes cannot be read, there are no pieces, and a remark that says so.
///
/// # Errors
/// As [`inertia`](super::inertia).
pub fn form(flag: &str, text: &str) -> Result<Option<Form>, Error> {
    let Some(Chosen { path, name, .. }) = chosen(flag, text)? else { return Ok(None) };
    let ending = super::ending(path);
    let nothing = |center_of_mass, remark| Form { pieces: Vec::new(), center_of_mass, remark };
    Ok(Some(match ending.as_str() {
        "toml" => {
            let parts::Parts { body, pieces, .. } = parts::read(path)?;
            Form { pieces, center_of_mass: body.center_of_mass(), remark: None }
        }
        "stl" | "obj" | "ply" => {
            let center_of_mass = of_mesh(path)?.center_of_mass();
            let look = Look::Surface(surface(path)?);
            let piece = Piece { look, turn: UnitQuaternion::identity(), at: Vector3::zeros() };
            Form { pieces: vec![piece], center_of_mass, remark: None }
        }
        "json" => nothing(Vector3::zeros(), Some("the file has no shape".into())),
        kind => {
            let text = super::model(path)?;
            let language = language(kind, &text);
            let links = robots::read(language, path, &text, None)?;
            let link = links.iter().find(|link| link.name == name && !link.massless);
            let center = link.map_or(Vector3::zeros(), |link| link.center_of_mass);
            match robots::visuals(language, path, &text, &name)? {
                Ok(pieces) => Form { pieces, center_of_mass: center, remark: None },
                Err(remark) => nothing(center, Some(remark)),
            }
        }
    }))
}

/// The body that a mesh encloses, of a density of 1 kg/m³: a mesh file has neither a unit nor a mass, and a free motion depends on
/// neither.
pub(super) fn of_mesh(path: &Path) -> Result<MassProperties, Error> {
    MeshOptions::default().with_length_unit(Some(1.0)).body(path, Amount::Density(1.0))
}
