//! A TOML list of parts: shapes, meshes, tensors and points, moved, turned and summed.

use std::path::Path;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::body::WheelAtStart;
use polhode::inertia::{Amount, MassError, MassProperties, Solid};
use toml::Spanned;
use toml::de::DeValue;

use crate::error::{Error, warn};
use crate::look::{Look, Piece};
use crate::mesh::{MeshOptions, length_unit, surface};
use crate::numbers::turn;
use crate::text::visible;
use crate::toml_file::{Section, TomlFile};
use crate::wheel;

const KEYS: [&str; 10] =
    ["name", "shape", "size", "mass", "density", "at", "turn", "file", "length_unit", "inertia"];

/// What a TOML file says of a body.
pub(super) struct Parts {
    /// Their sum.
    pub(super) body: MassProperties,
    /// What they look like.
    pub(super) pieces: Vec<Piece>,
    /// The wheels, which parts include.
    pub(super) wheels: Vec<WheelAtStart>,
}

/// The sum of the parts of a TOML file: its `[[part]]` tables.
///
/// # Errors
/// A file that cannot be read; a key that is unknown, missing, or has a value that cannot be used, with its line.
pub fn parts(path: &Path) -> Result<MassProperties, Error> {
    let Parts { body, wheels, .. } = read(path)?;
    if !wheels.is_empty() {
        warn(&format!(
            "{}: the [[wheels]] are left out here; --body of the commands that move a body takes them",
            visible(&path.display().to_string())
        ));
    }
    Ok(body)
}

/// The same with what the parts look like, and the `[[wheels]]`.
pub(super) fn read(path: &Path) -> Result<Parts, Error> {
    let text = crate::read(path, "name a TOML file with [[part]] tables")?;
    let file = TomlFile { path, text: &text };
    let document = file.parse()?;
    let (mut bodies, mut pieces, mut wheels) = (Vec::new(), Vec::new(), Vec::new());
    for (key, value) in document.get_ref() {
        match (key.get_ref().as_ref(), value.get_ref()) {
            ("part", DeValue::Array(parts)) => {
                for part in parts {
                    let Some(keys) = part.get_ref().as_table() else {
                        return Err(file.error(part.span().start, "key 'part': expected a table [[part]]"));
                    };
                    let section = Section { file: &file, place: part.span().start, keys };
                    let (body, piece) = Part(section).body()?;
                    bodies.push(body);
                    pieces.push(piece);
                }
            }
            ("wheels", _) => {
                let top = Section { file: &file, place: 0, keys: document.get_ref() };
                wheels = wheel::list_of_toml(&top)?;
            }
            ("name", DeValue::String(_)) => {}
            (other, _) => {
                let message = format!("key '{other}': unknown here; expected tables [[part]] and [[wheels]]");
                return Err(file.error(key.span().start, &message));
            }
        }
    }
    let sum = MassProperties::sum(bodies);
    let body = sum.map_err(|error| file.error(0, &format!("{error}; write [[part]] tables")))?;
    Ok(Parts { body, pieces, wheels })
}

struct Part<'t>(Section<'t>);

impl Part<'_> {
    fn body(&self) -> Result<(MassProperties, Piece), Error> {
        if let Some(unknown) = self.0.keys.keys().find(|key| !KEYS.contains(&key.get_ref().as_ref())) {
            let message =
                format!("key '{}': unknown in a part; known: {}", unknown.get_ref(), KEYS.join(", "));
            return Err(self.0.file.error(unknown.span().start, &message));
        }
        let shape = self
            .0
            .text("shape")?
            .ok_or_else(|| self.missing("shape", "name a shape, mesh, tensor or point"))?;
        let (body, look) = match shape {
            "mesh" => {
                self.only(&["mass", "density", "file", "length_unit"], shape)?;
                let file =
                    self.0.text("file")?.ok_or_else(|| self.missing("file", "name an STL or OBJ file"))?;
                let folder = self.0.file.path.parent().unwrap_or(Path::new("."));
                let options = MeshOptions::default().with_length_unit(self.length_unit()?);
                let path = folder.join(file);
                let refused = |error: Error| self.0.at("file", &error.to_string());
                let body = options.body(&path, self.amount()?).map_err(refused)?;
                let surface = surface(&path).map_err(refused)?;
                let scaled = surface.scaled(options.length_unit.unwrap_or(1.0));
                let scaled = scaled.map_err(|error| self.0.at("file", &error.to_string()))?;
                (body, Look::Surface(scaled))
            }
            "tensor" => {
                self.only(&["mass", "inertia"], shape)?;
                let mass = self.0.positive("mass")?.ok_or_else(|| self.missing("mass", "give it in kg"))?;
                let [xx, yy, zz, xy, xz, yz] = self
                    .0
                    .numbers::<6>("inertia")?
                    .ok_or_else(|| self.missing("inertia", "give [Ixx, Iyy, Izz, Ixy, Ixz, Iyz]"))?;
                let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                let body = self.check(MassProperties::new(mass, Vector3::zeros(), tensor), "inertia")?;
                (body, Look::Tensor(mass, tensor))
            }
            "point" => {
                self.only(&["mass"], shape)?;
                let mass = self.0.positive("mass")?.ok_or_else(|| self.missing("mass", "give it in kg"))?;
                (self.check(MassProperties::point(mass, Vector3::zeros()), "mass")?, Look::Point)
            }
            name => {
                let size = self.0.list("size")?.unwrap_or_default();
                let solid = match Solid::named(name, &size) {
                    Err(MassError::UnknownShape { name, known }) => {
                        let message = format!("no such shape '{name}'; known: {known}, mesh, tensor, point");
                        return Err(self.0.at("shape", &message));
                    }
                    other => self.check(other, "size")?,
                };
                self.only(&["mass", "density", "size"], name)?;
                (self.check(solid.with(self.amount()?), "size")?, Look::Solid(solid))
            }
        };
        let turn = match self.0.numbers::<4>("turn")? {
            Some(q) => Some(turn(q).ok_or_else(|| {
                self.0
                    .at("turn", "the zero quaternion is not a rotation; [1, 0, 0, 0] leaves a part as it is")
            })?),
            None => None,
        };
        let turned = turn.map_or(body, |turn| body.turned(turn));
        let at = Vector3::from(self.0.numbers::<3>("at")?.unwrap_or_default());
        let moved = self.check(turned.moved(at), "at")?;
        Ok((moved, Piece { look, turn: turn.unwrap_or_else(UnitQuaternion::identity), at }))
    }

    /// Metres of the unit of a mesh, by name or as a number.
    fn length_unit(&self) -> Result<Option<f64>, Error> {
        match self.0.value("length_unit").map(Spanned::get_ref) {
            Some(DeValue::String(text)) => {
                length_unit(text).map(Some).map_err(|error| self.0.at("length_unit", &error))
            }
            _ => self.0.positive("length_unit"),
        }
    }

    fn amount(&self) -> Result<Amount, Error> {
        match (self.0.positive("mass")?, self.0.positive("density")?) {
            (Some(mass), None) => Ok(Amount::Mass(mass)),
            (None, Some(density)) => Ok(Amount::Density(density)),
            (None, None) => Err(self.missing("mass", "give it in kg, or density in kg/m^3")),
            (Some(_), Some(_)) => Err(self.0.at("density", "given beside mass; leave one of them out")),
        }
    }

    /// Refuses keys that say nothing about this shape.
    fn only(&self, own: &[&str], shape: &str) -> Result<(), Error> {
        let common = ["name", "shape", "at", "turn"];
        let foreign = self.0.keys.keys().find(|key| {
            let key = key.get_ref().as_ref();
            !common.contains(&key) && !own.contains(&key)
        });
        match foreign {
            Some(key) => {
                Err(self.0.at(key.get_ref(), &format!("does not belong to shape '{shape}'; leave it out")))
            }
            None => Ok(()),
        }
    }

    fn check<T>(&self, result: Result<T, MassError>, key: &str) -> Result<T, Error> {
        result.map_err(|error| self.0.at(key, &error.to_string()))
    }

    fn missing(&self, key: &str, remedy: &str) -> Error {
        self.0.file.error(self.0.place, &format!("key '{key}': missing in this part; {remedy}"))
    }
}
