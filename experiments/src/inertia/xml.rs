//! The `<inertial>` elements of URDF and MJCF models.

use std::path::Path;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::num::trig::sin_cos;
use roxmltree::{Document, Node};

use super::given::Given;
use crate::arguments::{number, turn};
use crate::error::Error;
use crate::text::visible;

/// Every link of a URDF model.
pub(super) fn urdf(path: &Path, text: &str) -> Result<Vec<Given>, Error> {
    inertials(path, text, |element| {
        let child = |name: &'static str| {
            let found = element.node.children().find(|node| node.has_tag_name(name));
            found.map(|node| Element { node, ..*element })
        };
        let needed = |name| child(name).ok_or_else(|| element.missing(&format!("<{name}>")));
        let (xyz, rpy) = match child("origin") {
            Some(origin) => (origin.optional::<3>("xyz")?, origin.optional::<3>("rpy")?),
            None => (None, None),
        };
        let [mass] = needed("mass")?.needed::<1>("value")?;
        let inertia = needed("inertia")?;
        let entry = |name| inertia.needed::<1>(name).map(|[value]| value);
        let [xx, xy, xz] = [entry("ixx")?, entry("ixy")?, entry("ixz")?];
        let [yy, yz, zz] = [entry("iyy")?, entry("iyz")?, entry("izz")?];
        Ok(Given {
            mass: Some(mass),
            center_of_mass: xyz.unwrap_or_default().into(),
            turn: roll_pitch_yaw(rpy.unwrap_or_default()),
            ..Given::of_tensor(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
        })
    })
}

/// Every body of an MJCF model that states its inertia.
pub(super) fn mjcf(path: &Path, text: &str) -> Result<Vec<Given>, Error> {
    inertials(path, text, |element| {
        for foreign in ["axisangle", "xyaxes", "zaxis", "euler"] {
            if element.node.has_attribute(foreign) {
                return Err(element.error(&format!("orientation by {foreign} is not read; write it as quat")));
            }
        }
        let [mass] = element.needed::<1>("mass")?;
        let tensor = match (element.optional::<6>("fullinertia")?, element.optional::<3>("diaginertia")?) {
            (Some([xx, yy, zz, xy, xz, yz]), None) => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
            (None, Some(moments)) => Matrix3::from_diagonal(&moments.into()),
            (None, None) => return Err(element.missing("fullinertia or diaginertia")),
            (Some(_), Some(_)) => {
                return Err(element.error("has both fullinertia and diaginertia; leave one out"));
            }
        };
        let turn = match element.optional::<4>("quat")? {
            Some(q) => turn(q).ok_or_else(|| element.error("quat is zero; 1 0 0 0 is no turn"))?,
            None => UnitQuaternion::identity(),
        };
        let center_of_mass = Vector3::from(element.optional::<3>("pos")?.unwrap_or_default());
        Ok(Given { mass: Some(mass), center_of_mass, turn, ..Given::of_tensor(tensor) })
    })
}

fn inertials(
    path: &Path,
    text: &str,
    read: impl Fn(&Element<'_, '_>) -> Result<Given, Error>,
) -> Result<Vec<Given>, Error> {
    let parsed = Document::parse(text);
    // several fragments side by side are no document
    let wrapped = parsed.is_err().then(|| format!("<fragments>{text}</fragments>"));
    let parsed = match &wrapped {
        Some(wrapped) => Document::parse(wrapped).or(parsed),
        None => parsed,
    };
    let document = parsed.map_err(|error| Error::Input(format!("{}: {error}", path.display())))?;
    let mut found = Vec::new();
    for node in document.descendants().filter(|node| node.has_tag_name("inertial")) {
        let name = node.parent().and_then(|parent| parent.attribute("name")).unwrap_or_default();
        let element = Element { node, path, name };
        found.push(Given { name: name.into(), ..read(&element)? });
    }
    if found.is_empty() {
        return Err(Error::Input(format!("{}: no <inertial> element; nothing to examine", path.display())));
    }
    Ok(found)
}

#[derive(Clone, Copy)]
struct Element<'a, 'i> {
    node: Node<'a, 'i>,
    path: &'a Path,
    /// Of the link or body.
    name: &'a str,
}

impl Element<'_, '_> {
    /// The numbers of an attribute, if it is there.
    fn optional<const N: usize>(&self, attribute: &str) -> Result<Option<[f64; N]>, Error> {
        let Some(text) = self.node.attribute(attribute) else { return Ok(None) };
        let numbers: Result<Vec<f64>, String> = text.split_whitespace().map(number).collect();
        let numbers = numbers.map_err(|error| self.error(&format!("{attribute}: {error}")))?;
        let found = numbers.len();
        numbers
            .try_into()
            .map(Some)
            .map_err(|_| self.error(&format!("{attribute}: {found} given, {N} needed, separated by blanks")))
    }

    fn needed<const N: usize>(&self, attribute: &str) -> Result<[f64; N], Error> {
        self.optional(attribute)?.ok_or_else(|| self.missing(attribute))
    }

    fn missing(&self, what: &str) -> Error {
        self.error(&format!("{what} is missing"))
    }

    fn error(&self, message: &str) -> Error {
        let line = self.node.document().text_pos_at(self.node.range().start).row;
        let tag = self.node.tag_name().name();
        let of = if self.name.is_empty() { String::new() } else { format!(" of '{}'", self.name) };
        let message = format!("<{tag}>{of}: {message}");
        Error::Input(format!("{}:{line}: {}", self.path.display(), visible(&message)))
    }
}

/// The turn by `roll` about x, then `pitch` about y, then `yaw` about z, all fixed axes.
fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> UnitQuaternion<f64> {
    let about = |axis: usize, angle: f64| {
        let (sin, cos) = sin_cos(0.5 * angle);
        let mut q = Quaternion::new(cos, 0.0, 0.0, 0.0);
        q.coords[axis] = sin; // nalgebra keeps x, y, z, w
        q
    };
    UnitQuaternion::new_normalize(about(2, yaw) * about(1, pitch) * about(0, roll))
}
