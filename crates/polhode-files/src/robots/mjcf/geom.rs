//! Mass properties of geoms.

use core::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Amount, MassProperties, Solid};

use super::super::element::{Element, list};
use super::super::pose::{Pose, z_to};
use super::compiler::Compiler;
use super::defaults::Defaults;
use super::mesh::Meshes;
use super::orientation::orientation;

/// kg/m³ where a geom states neither mass nor density.
const WATER: f64 = 1000.0;

/// A geom with what its class says of it.
pub(super) struct Geom<'e, 'm> {
    pub(super) element: &'e Element,
    pub(super) defaults: &'m Defaults<'e>,
    pub(super) class: &'m str,
    pub(super) compiler: &'m Compiler,
}

impl<'e> Geom<'e, '_> {
    /// The matter of the geom in the frame of its body; planes, terrain and geoms without mass have none.
    pub(super) fn body(
        &self,
        frame: &Pose,
        meshes: &mut Meshes<'e>,
        remarks: &mut Vec<String>,
    ) -> Result<Option<MassProperties>, String> {
        if !self.defaults.has(self.class) {
            return Err(self.element.error(&format!("no default class '{}'", self.class)));
        }
        let kind = self.text("type").unwrap_or("sphere");
        let [group] = self.numbers::<1>("group")?.unwrap_or_default();
        let [low, high] = self.compiler.groups;
        let mass = self.numbers::<1>("mass")?.map(|[mass]| mass);
        let density = self.numbers::<1>("density")?.map_or(WATER, |[density]| density);
        let amount = mass.unwrap_or(density);
        if amount < 0.0 {
            return Err(self.element.error(&format!("mass or density is {amount}; it must not be negative")));
        }
        if matches!(kind, "plane" | "hfield") || !(low..=high).contains(&group) || amount == 0.0 {
            return Ok(None);
        }
        let amount = mass.map_or(Amount::Density(density), Amount::Mass);
        let body = match (kind, self.text("mesh")) {
            ("mesh", Some(_)) if self.text("fromto").is_some() => {
                return Err(self.element.error("fromto does not belong to the type mesh"));
            }
            ("mesh", Some(_)) if self.is_shell()? => {
                let rule = "shellinertia is for primitives only; write inertia=\"shell\" at the <mesh>";
                return Err(self.element.error(rule));
            }
            ("mesh", Some(mesh)) => {
                let found = meshes.body(mesh, self.defaults).map_err(|error| self.element.error(&error))?;
                remarks.extend(found.remark.clone().map(|remark| format!("mesh '{mesh}': {remark}")));
                self.filled(found.measure, &found.body, amount)?
            }
            ("mesh", None) => return Err(self.element.error("mesh is missing")),
            (_, Some(_)) => {
                return Err(self.element.error("a primitive that is fitted to a mesh is not computed"));
            }
            _ => self.primitive(kind, amount)?,
        };
        let pose = frame.around(&self.pose()?);
        body.turned(pose.turn)
            .moved(pose.at)
            .map(Some)
            .map_err(|error| self.element.error(&error.to_string()))
    }

    fn value(&self, attribute: &str) -> Option<&'e Element> {
        self.defaults.value(self.element, self.class, attribute).map(|(level, _)| level)
    }

    fn text(&self, attribute: &str) -> Option<&'e str> {
        self.defaults.value(self.element, self.class, attribute).map(|(_, value)| value.text.as_str())
    }

    fn numbers<const N: usize>(&self, attribute: &str) -> Result<Option<[f64; N]>, String> {
        self.value(attribute).map_or(Ok(None), |level| level.optional(attribute))
    }

    /// Whether only the surface has matter.
    fn is_shell(&self) -> Result<bool, String> {
        match self.text("shellinertia") {
            None | Some("false") => Ok(false),
            Some("true") => Ok(true),
            Some(other) => {
                let rule = format!("shellinertia: '{other}' is unknown; known: false, true");
                Err(self.element.error(&rule))
            }
        }
    }

    /// Half sizes; a class fills up what the geom leaves out.
    fn sizes(&self) -> Result<[f64; 3], String> {
        let mut sizes = [0.0; 3];
        let levels: Vec<&Element> = self.defaults.levels(self.element, self.class).collect();
        for level in levels.into_iter().rev() {
            let Some(text) = level.attribute("size") else { continue };
            let found = list(text).map_err(|error| level.error(&format!("size: {error}")))?;
            if found.len() > 3 {
                return Err(level.error(&format!("size: {} given, 3 at most", found.len())));
            }
            sizes[..found.len()].copy_from_slice(&found);
        }
        Ok(sizes)
    }

    fn ends(&self) -> Result<Option<[Vector3<f64>; 2]>, String> {
        let ends = self.numbers::<6>("fromto")?;
        Ok(ends.map(|[a, b, c, d, e, f]| [Vector3::new(a, b, c), Vector3::new(d, e, f)]))
    }

    fn pose(&self) -> Result<Pose, String> {
        if let Some([from, to]) = self.ends()? {
            if self.numbers::<3>("pos")?.is_some_and(|pos| pos != [0.0; 3]) {
                return Err(self.element.error("has both pos and fromto; leave one out"));
            }
            let turn =
                z_to(to - from).ok_or_else(|| self.element.error("fromto: both ends are the same point"))?;
            return Ok(Pose { at: (from + to) * 0.5, turn });
        }
        let at = Vector3::from(self.numbers::<3>("pos")?.unwrap_or_default());
        let turn = match self.defaults.turned(self.element, self.class) {
            Some(level) => orientation(level, self.compiler)?,
            None => Pose::identity().turn,
        };
        Ok(Pose { at, turn })
    }

    fn primitive(&self, kind: &str, amount: Amount) -> Result<MassProperties, String> {
        let [a, mut b, mut c] = self.sizes()?;
        if let Some([from, to]) = self.ends()? {
            let half = 0.5 * (to - from).norm();
            match kind {
                "capsule" | "cylinder" => b = half,
                "box" | "ellipsoid" => (b, c) = (a, half),
                _ => return Err(self.element.error(&format!("fromto does not belong to the type {kind}"))),
            }
        }
        let solid = match kind {
            "sphere" => Solid::Sphere { radius: a },
            "capsule" => Solid::Capsule { radius: a, height: 2.0 * b },
            "cylinder" => Solid::Cylinder { radius: a, height: 2.0 * b },
            "ellipsoid" => Solid::Ellipsoid([a, b, c]),
            "box" => Solid::Box([2.0 * a, 2.0 * b, 2.0 * c]),
            _ => {
                return Err(self.element.error(&format!(
                    "the mass of type '{kind}' is not computed; known: sphere, capsule, cylinder, ellipsoid, box, mesh"
                )));
            }
        };
        // which refuses sizes that no solid has, and no shell either
        let whole = solid.with(amount).map_err(|error| self.element.error(&error.to_string()))?;
        if !self.is_shell()? {
            return Ok(whole);
        }
        let (area, [x, y, z]) = surface(kind, [a, b, c]);
        let tensor = Matrix3::from_diagonal(&Vector3::new(y + z, x + z, x + y));
        let sheet = MassProperties::new(area, Vector3::zeros(), tensor);
        self.filled(area, &sheet.map_err(|error| self.element.error(&error.to_string()))?, amount)
    }

    /// The body `unit`, of which `measure` is the volume or area, with so much matter in it.
    fn filled(&self, measure: f64, unit: &MassProperties, amount: Amount) -> Result<MassProperties, String> {
        let mass = match amount {
            Amount::Mass(mass) => mass,
            Amount::Density(density) => density * measure,
        };
        let body = MassProperties::new(mass, unit.center_of_mass(), unit.tensor() * (mass / unit.mass()));
        body.map_err(|error| self.element.error(&error.to_string()))
    }
}

/// Area and second moments ∫ x² dA of the surface of a primitive of half sizes a, b, c.
///
/// Of the ellipsoid as MuJoCo has them: the area by Thomsen's formula, the moments of a layer that grows by the same length on
/// every semi-axis.
fn surface(kind: &str, [a, b, c]: [f64; 3]) -> (f64, [f64; 3]) {
    match kind {
        "sphere" => {
            let area = 4.0 * PI * a * a;
            (area, [area * a * a / 3.0; 3])
        }
        "capsule" => {
            let (side, caps) = (4.0 * PI * a * b, 4.0 * PI * a * a);
            let across = side * a * a / 2.0 + caps * a * a / 3.0;
            let along = side * b * b / 3.0 + caps * (b * b + a * b + a * a / 3.0);
            (side + caps, [across, across, along])
        }
        "cylinder" => {
            let (side, lids) = (4.0 * PI * a * b, 2.0 * PI * a * a);
            let across = side * a * a / 2.0 + lids * a * a / 4.0;
            (side + lids, [across, across, side * b * b / 3.0 + lids * b * b])
        }
        "box" => {
            let faces = [8.0 * b * c, 8.0 * a * c, 8.0 * a * b];
            let area = faces[0] + faces[1] + faces[2];
            let halves = [a, b, c];
            (area, [0, 1, 2].map(|k| halves[k] * halves[k] * (faces[k] + (area - faces[k]) / 3.0)))
        }
        _ => {
            const P: f64 = 1.6075;
            let power = |x: f64| libm::pow(x, P);
            let mean = (power(a * b) + power(a * c) + power(b * c)) / 3.0;
            let area = 4.0 * PI * libm::pow(mean, 1.0 / P);
            let grown = 2.0 * a * b * c / (a * b + a * c + b * c);
            (area, [a, b, c].map(|s| area * (s * s + s * grown) / 5.0))
        }
    }
}
