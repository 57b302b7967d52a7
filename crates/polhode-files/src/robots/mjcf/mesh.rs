//! Meshes of a model, and what MuJoCo makes of their matter.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::inertia::{Amount, MassProperties, Surface};

use super::super::element::{Element, list};
use super::super::remarks;
use super::defaults::Defaults;
use crate::mesh;
use crate::numbers::turn;
use crate::text::rounded;

/// Volumes closer than this are the same mesh seen through rounding.
const SAME: f64 = 1e-3;

/// Meshes by name, each computed when it is first asked for.
pub(super) struct Meshes<'e> {
    assets: HashMap<String, &'e Element>,
    folder: PathBuf,
    strips: bool,
    /// What counts as the matter of a mesh that does not say it; before MuJoCo 3.2.5 the compiler did.
    inertia: &'static str,
    done: HashMap<String, Result<Body, String>>,
}

/// The matter of a mesh filled with density one, or of its surface.
#[derive(Clone)]
pub(super) struct Body {
    /// Volume or area.
    pub(super) measure: f64,
    pub(super) body: MassProperties,
    pub(super) remark: Option<String>,
}

impl<'e> Meshes<'e> {
    pub(super) fn of(all: &[&'e Element], path: &Path) -> Self {
        let setting = |name: &str| {
            let compilers = all.iter().filter(|element| element.tag == "compiler");
            compilers.rev().find_map(|element| element.attribute(name))
        };
        let folder = setting("meshdir").or(setting("assetdir")).unwrap_or_default();
        let of_model = path.parent().unwrap_or(Path::new(""));
        let mut assets = HashMap::new();
        for mesh in all.iter().filter(|element| element.tag == "asset").flat_map(|asset| asset.named("mesh"))
        {
            let stem = || Path::new(mesh.attribute("file")?).file_stem()?.to_str();
            if let Some(name) = mesh.attribute("name").or_else(stem) {
                assets.insert(name.to_owned(), mesh);
            }
        }
        let strips = setting("strippath") == Some("true");
        let inertia = if setting("exactmeshinertia") == Some("true") { "exact" } else { "legacy" };
        Meshes { assets, folder: of_model.join(folder), strips, inertia, done: HashMap::new() }
    }

    /// The matter of the mesh called `name`.
    pub(super) fn body(&mut self, name: &str, defaults: &Defaults<'e>) -> Result<Body, String> {
        if let Some(done) = self.done.get(name) {
            return done.clone();
        }
        let found = match self.assets.get(name) {
            Some(asset) => self.computed(asset, defaults).map_err(|error| asset.error(&error)),
            None => Err(format!("mesh '{name}' is not among the assets")),
        };
        self.done.insert(name.to_owned(), found.clone());
        found
    }

    fn computed(&self, asset: &'e Element, defaults: &Defaults<'e>) -> Result<Body, String> {
        let class = asset.attribute("class").unwrap_or("main");
        if !defaults.has(class) {
            return Err(format!("no default class '{class}'"));
        }
        let text = |attribute| defaults.value(asset, class, attribute).map(|(_, value)| value.text.as_str());
        let scaled = defaults.value(asset, class, "scale").map(|(level, _)| level.needed::<3>("scale"));
        let scaled = scaled.transpose()?;
        let scale = scaled.unwrap_or([1.0; 3]);
        let at = Vector3::from(asset.optional::<3>("refpos")?.unwrap_or_default());
        let back = match asset.optional::<4>("refquat")? {
            Some(q) => turn(q).ok_or("refquat is zero; 1 0 0 0 is the identity")?.inverse(),
            None => UnitQuaternion::identity(),
        };
        let map = |v: Vector3<f64>| (back * (v - at)).component_mul(&Vector3::from(scale));
        let surface = self.surface(asset)?.mapped(map).map_err(|error| error.to_string())?;
        let surface = if scale.iter().product::<f64>() < 0.0 { surface.reversed() } else { surface };
        let long = mesh::beyond_metres(&surface).filter(|_| scaled.is_none()).map(|longest| {
            format!("{} m long; if it is in millimetres, write scale=\"0.001 0.001 0.001\"", rounded(longest))
        });
        let found = match text("inertia").unwrap_or(self.inertia) {
            "legacy" => legacy(&surface),
            "convex" => enclosed(&surface.hull().map_err(|error| error.to_string())?),
            "exact" => enclosed(&surface),
            "shell" => {
                let body = surface.sheet(Amount::Density(1.0)).map_err(|error| error.to_string())?;
                Ok(Body { measure: body.mass(), body, remark: None })
            }
            other => Err(format!("inertia '{other}' is unknown; known: convex, exact, legacy, shell")),
        }?;
        Ok(Body { remark: remarks(found.remark, long), ..found })
    }

    /// The triangles of the asset, the hull of its vertices if it has no faces.
    fn surface(&self, asset: &Element) -> Result<Surface, String> {
        if let Some(file) = asset.attribute("file") {
            let file = Path::new(file);
            let file = if self.strips { file.file_name().map_or(file, Path::new) } else { file };
            return mesh::surface(&self.folder.join(file)).map_err(|error| error.to_string());
        }
        let text = asset.attribute("vertex").ok_or("file or vertex is missing")?;
        let numbers = list(text).map_err(|error| format!("vertex: {error}"))?;
        let (points, []) = numbers.as_chunks::<3>() else {
            return Err(format!("vertex: {} numbers given, three needed for every vertex", numbers.len()));
        };
        // MuJoCo keeps vertices in single precision
        let points: Vec<Vector3<f64>> =
            points.iter().map(|at| Vector3::from(at.map(|x| f64::from(x as f32)))).collect();
        let Some(faces) = asset.attribute("face") else {
            return Surface::hull_of(&points).map_err(|error| error.to_string());
        };
        let numbers = list(faces).map_err(|error| format!("face: {error}"))?;
        let corner = |k: f64| {
            let found = (k >= 0.0 && k.fract() == 0.0).then(|| points.get(k as usize)).flatten();
            found.copied().ok_or_else(|| format!("face: no vertex {k}, {} are given", points.len()))
        };
        let (triangles, []) = numbers.as_chunks::<3>() else {
            return Err(format!("face: {} numbers given, three needed for every face", numbers.len()));
        };
        let triangles: Result<Vec<_>, String> =
            triangles.iter().map(|[a, b, c]| Ok([corner(*a)?, corner(*b)?, corner(*c)?])).collect();
        Surface::new(triangles?).map_err(|error| error.to_string())
    }
}

fn enclosed(surface: &Surface) -> Result<Body, String> {
    let mesh = surface.mesh().map_err(|error| error.to_string())?;
    let body = mesh.with(Amount::Density(1.0)).map_err(|error| error.to_string())?;
    Ok(Body { measure: mesh.volume(), body, remark: None })
}

/// What MuJoCo computes where nothing else is asked for: pyramids over all triangles, with the centre of their areas as apex for the
/// centre of mass and that as apex for volume and inertia, all of them counted as positive. Of a star-shaped mesh this is the
/// enclosed volume, of others more.
fn legacy(surface: &Surface) -> Result<Body, String> {
    let triangles: Vec<[Vector3<f64>; 3]> = surface.triangles().collect();
    let (mut area, mut middle) = (0.0, Vector3::zeros());
    for [a, b, c] in &triangles {
        let twice = (b - a).cross(&(c - a)).norm();
        area += twice;
        middle += (a + b + c) * (twice / 3.0);
    }
    if area <= 0.0 {
        return Err("the mesh has no area".into());
    }
    let (_, center, _) = pyramids(&triangles, middle / area);
    let (volume, _, second) = pyramids(&triangles, center);
    let tensor = Matrix3::identity() * second.trace() - second;
    let body = MassProperties::new(volume, center, tensor).map_err(|error| error.to_string())?;
    let remark = match enclosed(surface) {
        Ok(exact) if (volume / exact.measure - 1.0).abs() > SAME => Some(format!(
            "MuJoCo counts {:.1} % more volume than it encloses; inertia=\"exact\" counts it once",
            100.0 * (volume / exact.measure - 1.0)
        )),
        Ok(_) => None,
        Err(_) => Some("not closed; its volume is MuJoCo's estimate".into()),
    };
    Ok(Body { measure: volume, body, remark })
}

/// Volume, centre, and ∫ x xᵀ about the apex, of the pyramids over all triangles.
fn pyramids(triangles: &[[Vector3<f64>; 3]], apex: Vector3<f64>) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| corner - apex);
        let v = a.dot(&b.cross(&c)).abs() / 6.0;
        let s = a + b + c;
        volume += v;
        first += s * (v / 4.0);
        second +=
            (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose()) * (v / 20.0);
    }
    (volume, apex + first / volume, second)
}
