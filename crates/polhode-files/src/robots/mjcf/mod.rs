//! The bodies of an MJCF model, with what MuJoCo would compute from their geoms.
//!
//! Rules: MuJoCo's XML reference, sections compiler, default, asset/mesh, body/inertial, body/geom.

mod compiler;
mod defaults;
mod geom;
mod include;
mod mesh;
mod orientation;

use std::path::Path;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::inertia::MassProperties;

use super::element::Element;
use super::pose::{Pose, beyond_a_turn, euler, quarter_turns_exact};
use super::{Given, is_massless, link, positive, writing};
use compiler::{Compiler, Source};
use defaults::Defaults;
use mesh::Meshes;
use orientation::ATTRIBUTES;

/// The attributes of a tensor.
const TENSORS: [&str; 2] = ["diaginertia", "fullinertia"];

/// Elements of bodies that one model may have, copies of `<replicate>` among them: copies of copies grow without bound.
const MOST_ELEMENTS: usize = 1_000_000;

/// Every body in the order of the file, depth first, as MuJoCo numbers them.
pub(super) fn bodies(document: Element, path: &Path, root: Option<&Path>) -> Vec<Given> {
    let (document, refused) = include::resolve(document, path, root);
    let all = document.all();
    let (compiler, unread) = Compiler::of(&all);
    let mut model = Model {
        compiler,
        defaults: Defaults::of(&document),
        meshes: Meshes::of(&all, path),
        found: Vec::new(),
        walked: 0,
    };
    model.walk(&document, Pose::identity(), "main", "", &mut None);
    let mut bodies = model.found;
    let unscaled = model.compiler.adjust(&mut bodies, refused.is_empty());
    bodies.extend(refused);
    bodies.extend(unread);
    bodies.extend(unscaled);
    bodies
}

struct Model<'e> {
    compiler: Compiler,
    defaults: Defaults<'e>,
    meshes: Meshes<'e>,
    found: Vec<Given>,
    /// Elements so far.
    walked: usize,
}

/// The geoms of a body.
#[derive(Default)]
struct Geoms<'e> {
    /// With their frames in it and the class of their defaults.
    found: Vec<(&'e Element, Pose, &'e str)>,
    /// Why some of them are not among these.
    defect: Option<String>,
}

impl<'e> Model<'e> {
    /// Adds the bodies below `element`, and its geoms to `geoms`; `suffix` ends the names in a copy.
    fn walk(
        &mut self,
        element: &'e Element,
        frame: Pose,
        class: &'e str,
        suffix: &str,
        geoms: &mut Option<Geoms<'e>>,
    ) {
        for child in &element.children {
            self.walked += 1;
            if self.walked >= MOST_ELEMENTS {
                let defect = child.error(&format!(
                    "more than {MOST_ELEMENTS} elements, copies among them; the rest is not examined"
                ));
                lack(geoms, &defect);
                if self.walked == MOST_ELEMENTS {
                    self.found.push(link(&name(child, suffix), child, Err(defect)));
                }
                return;
            }
            let class = child.attribute("childclass").unwrap_or(class);
            match child.tag.as_str() {
                "body" => self.body(child, class, suffix),
                "geom" => {
                    if let Some(geoms) = geoms {
                        geoms.found.push((child, frame, child.attribute("class").unwrap_or(class)));
                    }
                }
                "frame" => match self.compiler.pose(child) {
                    Ok(pose) => self.walk(child, frame.around(&pose), class, suffix, geoms),
                    Err(defect) => {
                        lack(geoms, &defect);
                        self.found.push(link(&name(child, suffix), child, Err(defect)));
                    }
                },
                "replicate" => self.replicate(child, frame, class, suffix, geoms),
                "attach" | "composite" | "flexcomp" => {
                    let defect = child.error("bodies that this element makes are not computed");
                    self.found.push(link(&name(child, suffix), child, Err(defect)));
                }
                "inertial" if geoms.is_none() && element.tag != "default" => {
                    let stated = self.stated(child);
                    self.found.push(link("", child, stated));
                }
                "default" | "asset" | "include" => {}
                _ => self.walk(child, frame, class, suffix, geoms),
            }
        }
    }

    fn body(&mut self, element: &'e Element, class: &'e str, suffix: &str) {
        let place = self.found.len();
        // its place is before those of the bodies in it
        self.found.push(Given::massless());
        let mut geoms = Some(Geoms::default());
        self.walk(element, Pose::identity(), class, suffix, &mut geoms);
        let own = element.single("inertial");
        let has_tensor = |part: &&Element| TENSORS.iter().any(|name| part.attribute(name).is_some());
        let other = element.children.iter().filter(|part| part.tag != "inertial").find(has_tensor);
        let stated = match (own, other) {
            (Err(error), _) => Err(error),
            (_, Some(other)) => Err(other.error("states a tensor, which is read only in <inertial>")),
            (Ok(Some(inertial)), _) if self.compiler.source != Source::Geoms => self.stated(inertial),
            (Ok(_), _) if self.compiler.source == Source::Inertial => Ok(None),
            (Ok(own), _) => match self.of_geoms(&geoms.unwrap_or_default()) {
                // without geoms of mass there is nothing to infer from
                Ok(None) => own.map_or(Ok(None), |inertial| self.stated(inertial)),
                other => other,
            },
        };
        self.found[place] = link(&name(element, suffix), element, stated);
    }

    fn of_geoms(&mut self, geoms: &Geoms<'e>) -> Result<Option<Given>, String> {
        if let Some(defect) = &geoms.defect {
            return Err(defect.clone());
        }
        let mut parts = Vec::new();
        let mut remarks = Vec::new();
        for (element, frame, class) in &geoms.found {
            let geom = geom::Geom { element, defaults: &self.defaults, class, compiler: &self.compiler };
            if let Some(part) = geom.body(frame, &mut self.meshes, &mut remarks)? {
                parts.push(part);
            }
        }
        if parts.is_empty() {
            return Ok(None);
        }
        let body = MassProperties::sum(parts).map_err(|error| error.to_string())?;
        let remark = (!remarks.is_empty()).then(|| remarks.join("; "));
        Ok(Some(Given { remark, ..Given::body(body) }))
    }

    /// What `<inertial>` states.
    fn stated(&self, inertial: &Element) -> Result<Option<Given>, String> {
        inertial.only(&[&ATTRIBUTES[..], &TENSORS[..], &["pos", "mass"][..]].concat())?;
        let [mass] = inertial.needed::<1>("mass")?;
        let full = inertial.optional::<6>("fullinertia")?;
        let diagonal = inertial.optional::<3>("diaginertia")?;
        let (attribute, entries) = match (full, diagonal) {
            (Some(entries), None) => ("fullinertia", entries),
            (None, Some([x, y, z])) => ("diaginertia", [x, y, z, 0.0, 0.0, 0.0]),
            (None, None) if mass == 0.0 => return Ok(None),
            (None, None) => return Err(inertial.error("fullinertia or diaginertia is missing")),
            (Some(_), Some(_)) => {
                return Err(inertial.error("has both fullinertia and diaginertia; leave one out"));
            }
        };
        if is_massless(mass, &entries) {
            return Ok(None);
        }
        // the axes of a full tensor are those of the body
        let turn = ATTRIBUTES.iter().find(|turn| inertial.attribute(turn).is_some());
        if let (Some(turn), Some(_)) = (turn, full) {
            return Err(inertial.error(&format!("has both fullinertia and {turn}; leave one out")));
        }
        // MuJoCo takes no centre of mass for granted
        inertial.needed::<3>("pos")?;
        let pose = self.compiler.pose(inertial)?;
        let [xx, yy, zz, xy, xz, yz] = entries;
        Ok(Some(Given {
            mass: Some(positive(mass).map_err(|error| inertial.error(&error))?),
            center_of_mass: pose.at,
            turn: pose.turn,
            remark: self.beyond_a_turn(inertial)?,
            writing: Some(super::Writing {
                list: inertial.value(attribute).map(|value| value.range.clone()),
                ..writing(inertial, [None; 6])
            }),
            diagonal: diagonal.is_some(),
            ..Given::of_tensor(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
        }))
    }

    /// What is to be known of angles in radians.
    fn beyond_a_turn(&self, inertial: &Element) -> Result<Option<String>, String> {
        let [a, b, c] = inertial.optional::<3>("euler")?.unwrap_or_default();
        let [_, _, _, d] = inertial.optional::<4>("axisangle")?.unwrap_or_default();
        let in_radians = self.compiler.angle == 1.0;
        Ok(if in_radians { beyond_a_turn(&[a, b, c, d]) } else { None })
    }

    /// Copies, each moved and turned once more than the one before.
    fn replicate(
        &mut self,
        element: &'e Element,
        frame: Pose,
        class: &'e str,
        suffix: &str,
        geoms: &mut Option<Geoms<'e>>,
    ) {
        let read = || -> Result<(usize, Vector3<f64>, [f64; 3]), String> {
            let [count] = element.needed::<1>("count")?;
            if count < 0.0 || count.fract() != 0.0 {
                return Err(element.error(&format!("count: {count} is not a number of copies")));
            }
            let offset = Vector3::from(element.optional::<3>("offset")?.unwrap_or_default());
            let known = |turn: &&&str| **turn != "euler" && element.attribute(turn).is_some();
            if let Some(other) = ATTRIBUTES.iter().find(known) {
                return Err(element.error(&format!("{other} does not belong here; write euler")));
            }
            self.compiler.pose(element)?;
            let angles = element.optional::<3>("euler")?.unwrap_or_default();
            Ok((count as usize, offset, angles.map(|angle| angle * self.compiler.angle)))
        };
        match read() {
            Ok((count, offset, angles)) => {
                let digits = count.saturating_sub(1).to_string().len();
                let separator = element.attribute("sep").unwrap_or_default();
                let mut at = Vector3::zeros();
                for k in 0..count {
                    if self.walked >= MOST_ELEMENTS {
                        lack(geoms, &element.error("not all of its copies are examined"));
                        return;
                    }
                    // the angles are multiplied, which about several axes is no power of one turn
                    let turned = euler(angles.map(|angle| angle * k as f64), &self.compiler.sequence);
                    let turn = turned.map_or_else(UnitQuaternion::identity, quarter_turns_exact);
                    let copy = frame.around(&Pose { at, turn });
                    self.walk(element, copy, class, &format!("{suffix}{separator}{k:0digits$}"), geoms);
                    at += turn * offset;
                }
            }
            Err(defect) => {
                lack(geoms, &defect);
                self.found.push(link(&name(element, suffix), element, Err(defect)));
            }
        }
    }
}

/// A body of which some geoms are not known has no inertia that could be computed.
fn lack(geoms: &mut Option<Geoms<'_>>, defect: &str) {
    if let Some(geoms) = geoms {
        geoms.defect.get_or_insert_with(|| defect.into());
    }
}

fn name(element: &Element, suffix: &str) -> String {
    match element.attribute("name") {
        Some(name) => format!("{name}{suffix}"),
        None => String::new(),
    }
}
