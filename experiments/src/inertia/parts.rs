//! A TOML list of parts: shapes, meshes, tensors and points, moved, turned and summed.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Amount, MassError, MassProperties, Solid};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::meshes::{MeshArguments, unit};
use crate::arguments::{number, turn};
use crate::error::Error;
use crate::files::read;
use crate::text::visible;

const KEYS: [&str; 10] =
    ["name", "shape", "size", "mass", "density", "at", "turn", "file", "length_unit", "inertia"];

/// The sum of the parts of a file.
pub(super) fn read_parts(path: &Path) -> Result<MassProperties, Error> {
    let text = read(path, "name a TOML file with [[part]] tables")?;
    let file = File { path, text: &text };
    let document = DeTable::parse(&text).map_err(|error| {
        let place = error.span().map_or(0, |span| span.start);
        file.error(place, error.message())
    })?;
    let mut bodies = Vec::new();
    for (key, value) in document.get_ref() {
        match (key.get_ref().as_ref(), value.get_ref()) {
            ("part", DeValue::Array(parts)) => {
                for part in parts {
                    let Some(keys) = part.get_ref().as_table() else {
                        return Err(file.error(part.span().start, "key 'part': needed is a table [[part]]"));
                    };
                    bodies.push(Part { file: &file, place: part.span().start, keys }.body()?);
                }
            }
            ("name", DeValue::String(_)) => {}
            (other, _) => {
                let message = format!("key '{other}': unknown here; needed are [[part]] tables");
                return Err(file.error(key.span().start, &message));
            }
        }
    }
    MassProperties::sum(bodies).map_err(|error| file.error(0, &format!("{error}; write [[part]] tables")))
}

struct File<'t> {
    path: &'t Path,
    text: &'t str,
}

impl File<'_> {
    /// A message with file and line.
    fn error(&self, place: usize, message: &str) -> Error {
        let line =
            self.text.as_bytes()[..place.min(self.text.len())].iter().filter(|&&b| b == b'\n').count() + 1;
        Error::Input(format!("{}:{line}: {}", self.path.display(), visible(message)))
    }
}

struct Part<'t> {
    file: &'t File<'t>,
    place: usize,
    keys: &'t DeTable<'t>,
}

impl Part<'_> {
    fn body(&self) -> Result<MassProperties, Error> {
        if let Some(unknown) = self.keys.keys().find(|key| !KEYS.contains(&key.get_ref().as_ref())) {
            let message =
                format!("key '{}': unknown in a part; known: {}", unknown.get_ref(), KEYS.join(", "));
            return Err(self.file.error(unknown.span().start, &message));
        }
        let shape = self
            .text("shape")?
            .ok_or_else(|| self.missing("shape", "name a shape, mesh, tensor or point"))?;
        let body = match shape {
            "mesh" => {
                self.only(&["mass", "density", "file", "length_unit"], shape)?;
                let file =
                    self.text("file")?.ok_or_else(|| self.missing("file", "name an STL or OBJ file"))?;
                let folder = self.file.path.parent().unwrap_or(Path::new("."));
                let length_unit = self.length_unit()?;
                let mesh = MeshArguments { length_unit, ..MeshArguments::default() };
                mesh.body(&folder.join(file), self.amount()?)
                    .map_err(|error| self.at("file", &error.to_string()))?
            }
            "tensor" => {
                self.only(&["mass", "inertia"], shape)?;
                let mass = self.positive("mass")?.ok_or_else(|| self.missing("mass", "give it in kg"))?;
                let [xx, yy, zz, xy, xz, yz] = self
                    .numbers::<6>("inertia")?
                    .ok_or_else(|| self.missing("inertia", "give [Ixx, Iyy, Izz, Ixy, Ixz, Iyz]"))?;
                let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                self.check(MassProperties::new(mass, Vector3::zeros(), tensor), "inertia")?
            }
            "point" => {
                self.only(&["mass"], shape)?;
                let mass = self.positive("mass")?.ok_or_else(|| self.missing("mass", "give it in kg"))?;
                self.check(MassProperties::point(mass, Vector3::zeros()), "mass")?
            }
            name => {
                let size = self.list("size")?.unwrap_or_default();
                let solid = match Solid::named(name, &size) {
                    Err(MassError::UnknownShape { name, known }) => {
                        let message = format!("no such shape '{name}'; known: {known}, mesh, tensor, point");
                        return Err(self.at("shape", &message));
                    }
                    other => self.check(other, "size")?,
                };
                self.only(&["mass", "density", "size"], name)?;
                self.check(solid.with(self.amount()?), "size")?
            }
        };
        let turned = match self.numbers::<4>("turn")? {
            Some(q) => body.turned(turn(q).ok_or_else(|| {
                self.at("turn", "the zero quaternion is no turn; [1, 0, 0, 0] leaves a part as it is")
            })?),
            None => body,
        };
        let by = Vector3::from(self.numbers::<3>("at")?.unwrap_or_default());
        self.check(turned.moved(by), "at")
    }

    /// Metres of the unit of a mesh, by name or as a number.
    fn length_unit(&self) -> Result<Option<f64>, Error> {
        match self.value("length_unit").map(Spanned::get_ref) {
            Some(DeValue::String(text)) => {
                unit(text).map(Some).map_err(|error| self.at("length_unit", &error))
            }
            _ => self.positive("length_unit"),
        }
    }

    fn amount(&self) -> Result<Amount, Error> {
        match (self.positive("mass")?, self.positive("density")?) {
            (Some(mass), None) => Ok(Amount::Mass(mass)),
            (None, Some(density)) => Ok(Amount::Density(density)),
            (None, None) => Err(self.missing("mass", "give it in kg, or density in kg/m^3")),
            (Some(_), Some(_)) => Err(self.at("density", "given beside mass; leave one of them out")),
        }
    }

    /// Refuses keys that say nothing about this shape.
    fn only(&self, own: &[&str], shape: &str) -> Result<(), Error> {
        let common = ["name", "shape", "at", "turn"];
        let foreign = self.keys.keys().find(|key| {
            let key = key.get_ref().as_ref();
            !common.contains(&key) && !own.contains(&key)
        });
        match foreign {
            Some(key) => {
                Err(self.at(key.get_ref(), &format!("does not belong to shape '{shape}'; leave it out")))
            }
            None => Ok(()),
        }
    }

    fn value(&self, key: &str) -> Option<&Spanned<DeValue<'_>>> {
        self.keys.get(key)
    }

    fn text(&self, key: &str) -> Result<Option<&str>, Error> {
        match self.value(key).map(Spanned::get_ref) {
            None => Ok(None),
            Some(DeValue::String(text)) => Ok(Some(text)),
            Some(other) => Err(self.at(key, &format!("{} given, a text in quotes needed", other.type_str()))),
        }
    }

    fn positive(&self, key: &str) -> Result<Option<f64>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        match self.number(key, value)? {
            number if number > 0.0 => Ok(Some(number)),
            number => Err(self.at(key, &format!("{number:?} is not positive; give a number above zero"))),
        }
    }

    fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>, Error> {
        let Some(list) = self.list(key)? else { return Ok(None) };
        let found = list.len();
        list.try_into().map(Some).map_err(|_| self.at(key, &format!("{found} given, {N} needed")))
    }

    /// Several numbers in brackets, or one without.
    fn list(&self, key: &str) -> Result<Option<Vec<f64>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::Array(items) => {
                items.iter().map(|item| self.number(key, item)).collect::<Result<_, _>>().map(Some)
            }
            _ => Ok(Some(vec![self.number(key, value)?])),
        }
    }

    fn number(&self, key: &str, value: &Spanned<DeValue<'_>>) -> Result<f64, Error> {
        let text = match value.get_ref() {
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
            DeValue::Float(float) => float.as_str(),
            other => return Err(self.at(key, &format!("{} given, a number needed", other.type_str()))),
        };
        number(text).map_err(|error| self.at(key, &error))
    }

    fn check<T>(&self, result: Result<T, MassError>, key: &str) -> Result<T, Error> {
        result.map_err(|error| self.at(key, &error.to_string()))
    }

    fn at(&self, key: &str, message: &str) -> Error {
        let place =
            self.keys.iter().find(|(found, _)| found.get_ref() == key).map(|(found, _)| found.span().start);
        self.file.error(place.unwrap_or(self.place), &format!("key '{key}': {message}"))
    }

    fn missing(&self, key: &str, remedy: &str) -> Error {
        self.file.error(self.place, &format!("key '{key}': missing in this part; {remedy}"))
    }
}
