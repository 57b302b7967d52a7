//! What the links of a URDF model look like.

use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use polhode::inertia::Solid;

use super::Language;
use super::element::{Element, list};
use super::pose::{quarter_turns_exact, roll_pitch_yaw};
use crate::error::Error;
use crate::look::{Look, Piece};
use crate::mesh;
use crate::text::visible;

/// What the link called `name` looks like: its `<visual>` elements, or else its `<collision>` elements; `Err` says why it cannot
/// be drawn.
///
/// # Errors
/// Text that is no XML.
pub(crate) fn visuals(
    language: Language,
    path: &Path,
    text: &str,
    name: &str,
) -> Result<Result<Vec<Piece>, String>, Error> {
    if language != Language::Urdf {
        return Ok(Err(format!("shapes of {} models are not read", language.name())));
    }
    let document = Element::parse(path, text)?;
    let all = document.all();
    let link = all.iter().find(|element| element.tag == "link" && element.attribute("name") == Some(name));
    let Some(link) = link else { return Ok(Err("the link states no shape".into())) };
    let mut why = "the link states no shape".to_owned();
    for tag in ["visual", "collision"] {
        let pieces: Result<Vec<Piece>, String> = link.named(tag).map(|shown| piece(shown, path)).collect();
        match pieces {
            Ok(pieces) if pieces.is_empty() => {}
            Ok(pieces) => return Ok(Ok(pieces)),
            Err(reason) => why = reason,
        }
    }
    Ok(Err(visible(&why).into()))
}

fn piece(shown: &Element, path: &Path) -> Result<Piece, String> {
    let (xyz, rpy) = match shown.child("origin") {
        Some(origin) => (origin.optional::<3>("xyz")?, origin.optional::<3>("rpy")?),
        None => (None, None),
    };
    let geometry = shown.child("geometry").and_then(|geometry| geometry.children.first());
    let shape = geometry.ok_or_else(|| shown.error("<geometry> is missing"))?;
    let look = match shape.tag.as_str() {
        "box" => Look::Solid(Solid::Box(shape.needed("size")?)),
        "sphere" => {
            let [radius] = shape.needed("radius")?;
            Look::Solid(Solid::Sphere { radius })
        }
        "cylinder" | "capsule" => {
            let ([radius], [height]) = (shape.needed("radius")?, shape.needed("length")?);
            let is_capsule = shape.tag == "capsule";
            Look::Solid(if is_capsule {
                Solid::Capsule { radius, height }
            } else {
                Solid::Cylinder { radius, height }
            })
        }
        "mesh" => {
            let name = shape.attribute("filename").ok_or_else(|| shape.error("filename is missing"))?;
            let file = found(name, path).ok_or_else(|| format!("its mesh '{name}' is not there"))?;
            let surface = mesh::surface(&file).map_err(|error| error.to_string())?;
            let scale = match shape.attribute("scale").map(list).transpose()?.as_deref() {
                None => Vector3::repeat(1.0),
                Some([all]) => Vector3::repeat(*all),
                Some(&[x, y, z]) => Vector3::new(x, y, z),
                Some(_) => return Err(shape.error("scale: 1 or 3 numbers are needed")),
            };
            let scaled = surface.mapped(|at| at.component_mul(&scale));
            Look::Surface(scaled.map_err(|error| format!("its mesh '{name}': {error}"))?)
        }
        other => return Err(shown.error(&format!("unknown shape <{other}>"))),
    };
    if let Look::Solid(solid) = &look
        && !solid.sizes().iter().all(|size| *size > 0.0 && size.is_finite())
    {
        return Err(shape.error("its sizes must be finite and above zero"));
    }
    let turn = quarter_turns_exact(roll_pitch_yaw(rpy.unwrap_or_default()));
    Ok(Piece { look, turn, at: xyz.unwrap_or_default().into() })
}

/// The file of a mesh: beside the model, or in a package whose folder stands around it.
fn found(name: &str, model: &Path) -> Option<PathBuf> {
    let name = name.strip_prefix("file://").unwrap_or(name);
    let folder = model.parent().unwrap_or(Path::new("."));
    let packaged = name.strip_prefix("package://").or_else(|| name.strip_prefix("model://"));
    let Some(packaged) = packaged else {
        return Some(folder.join(name)).filter(|file| file.is_file());
    };
    let inside = packaged.split_once('/').map_or(packaged, |(_, inside)| inside);
    let around = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    around
        .ancestors()
        .flat_map(|folder| [folder.join(inside), folder.join(packaged)])
        .find(|file| file.is_file())
}
