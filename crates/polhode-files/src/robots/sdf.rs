//! The links of an SDF model.

use nalgebra::Matrix3;

use super::element::Element;
use super::pose::{beyond_a_turn, quarter_turns_exact, roll_pitch_yaw};
use super::{Given, is_massless, link, positive, remarks, unstated, writing};

/// Every link, with the names of the models around it where there are several.
pub(super) fn links(document: &Element) -> Vec<Given> {
    let mut found = Vec::new();
    collect(document, "", models(document) > 1, &mut found);
    found
}

/// Elements in which links are named that stand elsewhere.
const NAMING: [&str; 2] = ["state", "plugin"];

/// Models in which there is anything.
fn models(element: &Element) -> usize {
    let is_model = element.tag == "model" && !element.children.is_empty();
    let inside = element.children.iter().filter(|child| !NAMING.contains(&child.tag.as_str()));
    usize::from(is_model) + inside.map(models).sum::<usize>()
}

fn collect(element: &Element, scope: &str, scoped: bool, found: &mut Vec<Given>) {
    for child in &element.children {
        let name = child.attribute("name").unwrap_or_default();
        match child.tag.as_str() {
            "model" if scoped => collect(child, &format!("{scope}{name}::"), scoped, found),
            "link" => {
                let inertial = child.single("inertial");
                let is_silent = matches!(inertial, Ok(None));
                let given = inertial.and_then(|own| own.map_or_else(|| unstated(child), stated));
                let mut given = link(&format!("{scope}{name}"), child, given);
                if is_silent && given.defect.is_none() {
                    given.add_remark("states no <inertial>, for which the format has 1 kg and 1 kg m^2");
                }
                found.push(given);
            }
            "state" => {
                let all = child.all();
                let added = all.iter().filter(|part| part.tag == "insertions" && !part.children.is_empty());
                found.extend(added.map(|part| {
                    let rule = "the models that a state adds are not read; put them into the world";
                    link(&format!("{scope}insertions"), part, Err(part.error(rule)))
                }));
            }
            naming if NAMING.contains(&naming) => {}
            "inertial" => found.push(link(scope, child, stated(child))),
            "include" if matches!(element.tag.as_str(), "sdf" | "world" | "model") => {
                let uri = child.child("uri").and_then(|uri| uri.text.as_ref());
                let uri = uri.map_or("", |uri| uri.text.trim());
                let defect = child.error(
                    "the included model is not read; put its links into this file, or leave the include \
                     out if it has none, as a light",
                );
                found.push(link(&format!("{scope}include {uri}"), child, Err(defect)));
            }
            _ => collect(child, scope, scoped, found),
        }
    }
}

/// What `<inertial>` states. Products that are left out are zero; a mass or a moment that is left out is not made up.
fn stated(inertial: &Element) -> Result<Option<Given>, String> {
    if inertial.attribute("auto").is_some_and(|auto| auto == "true" || auto == "1") {
        return Err(
            inertial.error("auto: inertia from the collision shapes is not computed; state <inertia>")
        );
    }
    let ([x, y, z, roll, pitch, yaw], beyond) = match inertial.single("pose")? {
        Some(pose) => {
            // which is called frame before 1.7
            let named = |name: &&str| pose.attribute(name).is_some_and(|frame| !frame.is_empty());
            if let Some(name) = ["relative_to", "frame"].into_iter().find(named) {
                let rule = format!("{name}: poses in other frames are not read; give it in the link's");
                return Err(pose.error(&rule));
            }
            angles_in_radians(pose)?
        }
        None => ([0.0; 6], None),
    };
    let mass = inertial.single("mass")?.ok_or_else(|| inertial.error("<mass> is missing"))?;
    let [value] = mass.content::<1>()?;
    let Some(inertia) = inertial.single("inertia")? else {
        return if value == 0.0 { Ok(None) } else { Err(inertial.error("<inertia> is missing")) };
    };
    let names = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
    let mut children = [None; 6];
    for (child, name) in children.iter_mut().zip(names) {
        *child = inertia.single(name)?;
    }
    let mut entries = [0.0; 6];
    for (k, child) in children.iter().enumerate() {
        match child {
            Some(child) => [entries[k]] = child.content::<1>()?,
            None if k < 3 => return Err(inertia.error(&format!("<{}> is missing", names[k]))),
            None => {}
        }
    }
    if is_massless(value, &entries) {
        return Ok(None);
    }
    let [xx, yy, zz, xy, xz, yz] = entries;
    Ok(Some(Given {
        mass: Some(positive(value).map_err(|error| mass.error(&error))?),
        center_of_mass: [x, y, z].into(),
        turn: quarter_turns_exact(roll_pitch_yaw([roll, pitch, yaw])),
        remark: remarks(beyond, inertial.unread(&INERTIAL).or_else(|| inertia.unread(&names))),
        writing: Some(writing(inertia, children.map(|child| child.and_then(|child| child.text.as_ref())))),
        ..Given::of_tensor(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
    }))
}

/// What may stand in `<inertial>`.
const INERTIAL: [&str; 6] = ["pose", "mass", "inertia", "density", "auto_inertia_params", "fluid_added_mass"];

/// Place and angles, and what is to be known of these.
fn angles_in_radians(pose: &Element) -> Result<([f64; 6], Option<String>), String> {
    let blank = pose.text.as_ref().is_none_or(|text| text.text.trim().is_empty());
    let mut values = if blank { [0.0; 6] } else { pose.content::<6>()? };
    if pose.attribute("degrees").is_some_and(|degrees| degrees == "true" || degrees == "1") {
        for angle in &mut values[3..] {
            *angle = angle.to_radians();
        }
        return Ok((values, None));
    }
    Ok((values, beyond_a_turn(&values[3..])))
}
