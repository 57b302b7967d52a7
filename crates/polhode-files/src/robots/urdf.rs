//! The links of a URDF model.

use nalgebra::Matrix3;

use super::element::Element;
use super::pose::{beyond_a_turn, quarter_turns_exact, roll_pitch_yaw};
use super::{Given, is_massless, link, positive, remarks, unstated, writing};

/// Elements of xacro that make nothing by themselves.
const DEFINITIONS: [&str; 3] = ["property", "arg", "macro"];

/// Every link, or every `<inertial>` of a fragment; then a row for each element that xacro would replace.
pub(super) fn links(document: &Element) -> Vec<Given> {
    let all = document.all();
    let links: Vec<&&Element> =
        all.iter().filter(|element| element.tag == "link" && is_link(element)).collect();
    let unread = all.iter().filter(|element| {
        element.tag.strip_prefix("xacro:").is_some_and(|kind| !DEFINITIONS.contains(&kind))
    });
    let unread = unread.map(|element| {
        let file = element.attribute("filename").map_or(String::new(), |file| format!(" {file}"));
        let defect = element.error("xacro is not expanded; name the URDF file that xacro writes");
        link(&format!("{}{file}", element.tag), element, Err(defect))
    });
    let is_capital = |element: &&&Element| {
        element.tag != "link" && element.tag.eq_ignore_ascii_case("link") && is_link(element)
    };
    let capital: Vec<&&Element> = all.iter().filter(is_capital).collect();
    let refused = capital.iter().map(|element| {
        let defect = element.error("names of elements have small letters; write <link>");
        link(element.attribute("name").unwrap_or_default(), element, Err(defect))
    });
    let unread = unread.chain(refused);
    if links.is_empty() && capital.is_empty() {
        let fragments = all.iter().filter(|element| element.tag == "inertial");
        return fragments.map(|inertial| link("", inertial, stated(inertial))).chain(unread).collect();
    }
    let each = |element: &&&Element| {
        let name = element.attribute("name").unwrap_or_default();
        let own = element.single("inertial");
        let stated = own.and_then(|inertial| inertial.map_or_else(|| unstated(element), stated));
        link(name, element, stated)
    };
    links.iter().map(each).chain(unread).collect()
}

/// Transmissions and plugins name links by elements of the same name, which hold text or an attribute alone.
fn is_link(element: &Element) -> bool {
    let is_blank = element.text.as_ref().is_none_or(|text| text.text.trim().is_empty());
    is_blank && element.attribute("link").is_none() && element.attribute("name").is_some()
}

/// What `<inertial>` states; a mass of zero with a tensor of zeros is none.
fn stated(inertial: &Element) -> Result<Option<Given>, String> {
    let (xyz, rpy) = match inertial.single("origin")? {
        Some(origin) => {
            origin.only(&["xyz", "rpy"])?;
            (origin.optional::<3>("xyz")?, origin.optional::<3>("rpy")?)
        }
        None => (None, None),
    };
    let mass = inertial.single("mass")?.ok_or_else(|| inertial.error("<mass> is missing"))?;
    let [value] = mass.needed::<1>("value")?;
    let Some(inertia) = inertial.single("inertia")? else {
        return if value == 0.0 { Ok(None) } else { Err(inertial.error("<inertia> is missing")) };
    };
    let names = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
    let mut entries = [0.0; 6];
    for (entry, name) in entries.iter_mut().zip(names) {
        [*entry] = inertia.needed::<1>(name)?;
    }
    if is_massless(value, &entries) {
        return Ok(None);
    }
    let [xx, yy, zz, xy, xz, yz] = entries;
    Ok(Some(Given {
        mass: Some(positive(value).map_err(|error| mass.error(&error))?),
        center_of_mass: xyz.unwrap_or_default().into(),
        turn: quarter_turns_exact(roll_pitch_yaw(rpy.unwrap_or_default())),
        remark: remarks(
            beyond_a_turn(&rpy.unwrap_or_default()),
            inertial.unread(&["origin", "mass", "inertia"]),
        ),
        writing: Some(writing(inertia, names.map(|name| inertia.value(name)))),
        ..Given::of_tensor(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
    }))
}
