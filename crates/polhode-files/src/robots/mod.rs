//! Robot models, link by link: URDF, MJCF and SDF.

mod depth;
mod element;
mod mjcf;
mod pose;
mod sdf;
mod urdf;
mod visuals;

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use crate::error::Error;
use crate::given::{Given, Writing};
use crate::text::visible;
use element::Element;
pub use element::Value;
pub(crate) use visuals::visuals;

/// The name of a row for a setting of a whole model that cannot be read; no body has it.
pub(crate) const SETTINGS: &str = "<compiler>";

/// A language of models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Unified Robot Description Format.
    Urdf,
    /// The format of MuJoCo.
    Mjcf,
    /// Simulation Description Format.
    Sdf,
}

impl Language {
    /// As flags spell them.
    pub const NAMES: [&str; 3] = ["urdf", "mjcf", "sdf"];

    /// The language that a flag spells so.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "urdf" => Some(Self::Urdf),
            "mjcf" => Some(Self::Mjcf),
            "sdf" => Some(Self::Sdf),
            _ => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Urdf => "URDF",
            Self::Mjcf => "MJCF",
            Self::Sdf => "SDF",
        }
    }

    /// The elements at whose head a file of this language may stand.
    fn roots(self) -> &'static [&'static str] {
        match self {
            Self::Urdf => &["robot", "link", "inertial"],
            Self::Mjcf => &["mujoco", "mujocoinclude", "worldbody", "body", "inertial"],
            Self::Sdf => &["sdf", "model", "world", "link", "inertial"],
        }
    }
}

/// Every link of the model in `text`; includes of an MJCF model may stand in `root` and below.
///
/// # Errors
/// Text that is no XML, and XML of another kind. A defect of one link is a defect of that link alone.
pub fn read(language: Language, path: &Path, text: &str, root: Option<&Path>) -> Result<Vec<Given>, Error> {
    let mut links = with_namesakes(language, path, text, root)?;
    let mut places: HashMap<String, String> = HashMap::new();
    let has_tensor = |link: &&mut Given| !link.name.is_empty() && !link.massless && link.defect.is_none();
    for link in links.iter_mut().filter(has_tensor) {
        let place = link.place.clone().unwrap_or_default();
        match places.get(&link.name) {
            Some(first) => {
                let defect = format!("{place}: the name is already used at {first}; give each link its own");
                link.defect = Some(visible(&defect).into());
            }
            None => {
                places.insert(link.name.clone(), place);
            }
        }
    }
    Ok(links)
}

/// The same, where several links may have one name.
pub(crate) fn with_namesakes(
    language: Language,
    path: &Path,
    text: &str,
    root: Option<&Path>,
) -> Result<Vec<Given>, Error> {
    let document = Element::parse(path, text)?;
    let roots = language.roots();
    if !document.children.iter().any(|root| roots.contains(&root.tag.as_str())) {
        let found = document.children.first().map_or(String::new(), |root| format!("<{}>", root.tag));
        let known: Vec<String> = roots.iter().map(|root| format!("<{root}>")).collect();
        let rule =
            format!("no {} model; such a file begins with one of {}", language.name(), known.join(", "));
        return Err(Error::input(&path.display().to_string(), &found, &rule, "name another file"));
    }
    Ok(match language {
        Language::Urdf => urdf::links(&document),
        Language::Mjcf => mjcf::bodies(document, path, root),
        Language::Sdf => sdf::links(&document),
    })
}

/// The elements of a model that have a name, as `<light> 'sun'`, in the order of the file.
///
/// # Errors
/// Text that is no XML.
pub fn named_elements(path: &Path, text: &str) -> Result<Vec<String>, Error> {
    let document = Element::parse(path, text)?;
    let all = document.all();
    let named = all.iter().filter_map(|element| {
        let name = element.attribute("name")?;
        Some(visible(&format!("<{}> '{name}'", element.tag)).into_owned())
    });
    Ok(named.collect())
}

/// What a link says of its inertia, before it is examined.
fn link(name: &str, element: &Element, stated: Result<Option<Given>, String>) -> Given {
    let place = Some(element.place());
    match stated {
        Ok(Some(given)) => Given { name: name.into(), place, ..given },
        Ok(None) => Given { name: name.into(), place, ..Given::massless() },
        Err(defect) => Given { name: name.into(), place, ..Given::defective(defect) },
    }
}

/// The parts of the file that state a tensor.
fn writing(element: &Element, values: [Option<&Value>; 6]) -> Writing {
    let entries = values.map(|value| value.map(|found| found.range.clone()));
    Writing { file: Arc::clone(&element.file), entries, list: None }
}

/// A mass of zero with a tensor of zeros is the idiom for a frame without a body.
fn is_massless(mass: f64, entries: &[f64]) -> bool {
    mass == 0.0 && entries.iter().all(|entry| *entry == 0.0)
}

/// Elements in a link that hold numbers of their own.
const APART: [&str; 2] = ["plugin", "sensor"];

/// A link without `<inertial>` states nothing, unless its mass or its tensor stand in an element of another name, as `<intertial>`.
fn unstated(link: &Element) -> Result<Option<Given>, String> {
    let is_stated =
        |part: &&Element| ["mass", "inertia"].iter().any(|name| part.tag.eq_ignore_ascii_case(name));
    let inside = link.children.iter().filter(|child| !APART.contains(&child.tag.as_str()));
    match link.children.iter().chain(inside.flat_map(|child| &child.children)).find(is_stated) {
        Some(part) => Err(part.error("is outside of the <inertial> of the link, where it is not read")),
        None => Ok(None),
    }
}

/// Two remarks as one.
fn remarks(one: Option<String>, other: Option<String>) -> Option<String> {
    let all: Vec<String> = one.into_iter().chain(other).collect();
    (!all.is_empty()).then(|| all.join("; "))
}

/// A mass that a body may have.
fn positive(mass: f64) -> Result<f64, String> {
    if mass > 0.0 {
        Ok(mass)
    } else {
        Err(format!(
            "mass is {}; it must be above zero, or zero together with every entry of the tensor",
            mass + 0.0
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INERTIAL: &str =
        "<inertial><mass>2</mass><inertia><ixx>1</ixx><iyy>2</iyy><izz>2.5</izz></inertia></inertial>";
    const TENSOR: &str = "<mass value='2'/><inertia ixx='1' iyy='2' izz='2.5' ixy='0' ixz='0' iyz='0'/>";

    /// The name and the defect of every link of a model.
    fn defects(language: Language, text: &str) -> Vec<(String, String)> {
        let links = read(language, Path::new("model"), text, None).unwrap();
        links.into_iter().map(|link| (link.name, link.defect.unwrap_or_default())).collect()
    }

    #[test]
    fn what_another_file_or_macro_would_add_is_a_defect() {
        let text = format!(
            "<sdf version='1.9'><model name='m'><include><uri> model://arm </uri></include>\n\
             <link name='base'>{INERTIAL}</link><plugin name='p'><include/></plugin></model></sdf>"
        );
        let found = defects(Language::Sdf, &text);
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!(found[0].0, "include model://arm");
        assert!(found[0].1.starts_with("model:1: <include>: the included model is not read"), "{found:?}");
        assert_eq!(found[1], ("base".to_string(), String::new()));

        let text = format!(
            "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\
             <xacro:property name='a' value='1'/><xacro:arg name='b' default='1'/><xacro:macro name='arm'/>\n\
             <xacro:include filename='arm.xacro'/>\n<xacro:arm prefix='left'/>\n\
             <link name='base'><inertial>{TENSOR}</inertial></link></robot>"
        );
        let found = defects(Language::Urdf, &text);
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["base", "xacro:include arm.xacro", "xacro:arm"]);
        assert_eq!(found[0].1, "");
        assert!(found[1].1.starts_with("model:2: <xacro:include>: xacro is not expanded"), "{found:?}");
        assert!(found[2].1.starts_with("model:3: <xacro:arm>: xacro is not expanded"), "{found:?}");
        // a file of nothing else is not empty
        assert_eq!(defects(Language::Urdf, "<robot><xacro:include filename='a'/></robot>").len(), 1);
    }

    /// A mass in an element of another name, and an attribute that would turn or move the tensor and is not read, are no frames without a body.
    #[test]
    fn what_would_be_lost_by_its_name_is_a_defect() {
        let urdf = |inside: &str| format!("<robot><link name='a'>{inside}</link></robot>");
        let sdf = |inside: &str| {
            format!("<sdf version='1.7'><model name='m'><link name='a'>{inside}</link></model></sdf>")
        };
        let mjcf =
            |inside: &str| format!("<mujoco><worldbody><body name='a'>{inside}</body></worldbody></mujoco>");
        let other = |text: &str| text.replace("inertial>", "intertial>");
        let stated = format!("<inertial>{TENSOR}</inertial>");
        let turned = format!("<inertial><origin xyz='0 0 1' quat_xyzw='0 0 1 0'/>{TENSOR}</inertial>");
        let plain = "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
        let outside = "<mass>: is outside of the <inertial>";
        for (language, text, says) in [
            (Language::Urdf, urdf(&stated), ""),
            (Language::Urdf, urdf(&other(&stated)), outside),
            (Language::Urdf, urdf(TENSOR), outside),
            (Language::Urdf, urdf(&turned), "<origin>: quat_xyzw is not read here; known: xyz, rpy"),
            (
                Language::Urdf,
                urdf(&stated).replace("link", "Link"),
                "<Link>: names of elements have small letters",
            ),
            // as a plugin names a link
            (Language::Urdf, urdf(&stated).replace("<link", "<plugin><Link>a</Link></plugin><link"), ""),
            (Language::Sdf, sdf(INERTIAL), ""),
            (Language::Sdf, sdf(&other(INERTIAL)), outside),
            (Language::Sdf, sdf("<plugin name='p'><mass>1</mass></plugin>"), ""),
            (Language::Mjcf, mjcf(plain), ""),
            (Language::Mjcf, mjcf(&plain.replace("inertial", "intertial")), "<intertial>: states a tensor"),
            (
                Language::Mjcf,
                mjcf(&plain.replace("pos=", "eular='1 2 3' pos=")),
                "<inertial>: eular is not read here",
            ),
        ] {
            let found = defects(language, &text);
            let [(_, defect)] = &found[..] else { panic!("{text}: {found:?}") };
            assert!(defect.contains(says) && defect.is_empty() == says.is_empty(), "{text}: {defect}");
        }
    }

    /// Angles of more than a full turn may be in degrees, where the file says radians, and an element that is not read is named.
    #[test]
    fn angles_beyond_a_turn_and_elements_that_are_not_read_are_told() {
        let urdf = |origin: &str| {
            format!("<robot><link name='a'><inertial>{origin}{TENSOR}</inertial></link></robot>")
        };
        let sdf = |pose: &str| INERTIAL.replace("<inertial>", &format!("<inertial>{pose}"));
        let sdf = |pose: &str| {
            format!("<sdf version='1.7'><model name='m'><link name='a'>{}</link></model></sdf>", sdf(pose))
        };
        let mjcf = |angle: &str, turn: &str| {
            format!(
                "<mujoco><compiler angle='{angle}'/><worldbody><body name='a'>\
                 <inertial pos='0 0 0' {turn} mass='1' diaginertia='1 1 1'/></body></worldbody></mujoco>"
            )
        };
        let turn = "is it in degrees? the file says radians";
        for (language, text, says) in [
            (Language::Urdf, urdf("<origin rpy='0 0 6.3'/>"), None),
            (Language::Urdf, urdf("<origin rpy='0 -90 0'/>"), Some(turn)),
            (Language::Urdf, urdf("<Origin xyz='0 0 1'/>"), Some("<Origin>: is not read here")),
            (Language::Sdf, sdf("<pose>0 0 100 0 0 1.5</pose>"), None),
            (Language::Sdf, sdf("<pose>0 0 0 0 0 90</pose>"), Some(turn)),
            (Language::Sdf, sdf("<pose degrees='true'>0 0 0 0 0 90</pose>"), None),
            (Language::Sdf, sdf("<Pose>0 0 1 0 0 0</Pose>"), Some("<Pose>: is not read here")),
            (Language::Mjcf, mjcf("degree", "euler='0 0 90'"), None),
            (Language::Mjcf, mjcf("radian", "euler='0 0 90'"), Some(turn)),
            (Language::Mjcf, mjcf("radian", "axisangle='0 0 90 1'"), None),
            (Language::Mjcf, mjcf("radian", "axisangle='0 0 1 90'"), Some(turn)),
        ] {
            let found = read(language, Path::new("model"), &text, None).unwrap();
            let [Given { defect: None, remark, .. }] = &found[..] else { panic!("{text}: {found:?}") };
            let is_told = match says {
                Some(says) => remark.as_ref().is_some_and(|remark| remark.contains(says)),
                None => remark.is_none(),
            };
            assert!(is_told, "{text}: {remark:?}");
        }
    }

    /// A mesh of MJCF without a scale is in metres, and one of a hundred metres is asked about.
    #[test]
    fn a_mesh_of_mjcf_that_is_long_for_metres_is_told() {
        let told = |scale: &str| {
            let text = format!(
                "<mujoco><asset><mesh name='t' vertex='0 0 0 100 0 0 0 100 0 0 0 100' {scale}/></asset>\
                 <worldbody><body name='a'><geom type='mesh' mesh='t'/></body></worldbody></mujoco>"
            );
            let found = read(Language::Mjcf, Path::new("model"), &text, None).unwrap();
            let [Given { defect: None, remark, .. }] = &found[..] else { panic!("{found:?}") };
            remark.clone()
        };
        assert!(
            told("").is_some_and(|remark| remark.contains("mesh 't': 100 m long; if it is in millimetres"))
        );
        assert_eq!(told("scale='0.001 0.001 0.001'"), None);
        // a scale that was written was meant
        assert_eq!(told("scale='1 1 1'"), None);
    }

    #[test]
    fn a_link_of_urdf_with_nothing_but_a_line_break_in_it_is_a_link() {
        let frames = "<link name='a'>\n</link><link name='b'/><transmission><link>b</link></transmission>";
        let names: Vec<String> = defects(Language::Urdf, &format!("<robot>{frames}</robot>"))
            .into_iter()
            .map(|(name, _)| name)
            .collect();
        assert_eq!(names, ["a", "b"]);
    }

    #[test]
    fn what_the_format_has_for_a_link_of_sdf_that_states_nothing_is_said() {
        let text = format!(
            "<world name='w'><model name='m'><link name='a'/><link name='b'>{INERTIAL}</link></model>\
             <state><model name='m'><link name='a'><pose>0 0 1 0 0 0</pose></link></model></state></world>"
        );
        let found = read(Language::Sdf, Path::new("model"), &text, None).unwrap();
        let said: Vec<(bool, bool)> =
            found.iter().map(|link| (link.massless, link.remark.is_some())).collect();
        assert_eq!(said, [(true, true), (false, false)], "{found:?}");
    }

    /// A saved world names its links again, also with their models before them; the bodies are those of the models.
    #[test]
    fn the_state_of_a_world_of_sdf_names_no_further_links() {
        let model = |name: &str, links: &str| format!("<model name='{name}'>{links}</model>");
        let body = |name: &str| format!("<link name='{name}'>{INERTIAL}</link>");
        let pose = |name: &str| format!("<link name='{name}'><pose>0 0 1 0 0 0</pose></link>");
        let names = |models: &str, state: &str| -> Vec<String> {
            let plugin = "<plugin name='p'><link>arm</link><model><link name='arm'/></model></plugin>";
            let text = format!(
                "<sdf version='1.4'><world name='w'>{models}{plugin}<state world_name='w'>{state}</state></world></sdf>"
            );
            let found = defects(Language::Sdf, &text);
            assert!(found.iter().all(|(_, defect)| defect.is_empty()), "{found:?}");
            found.into_iter().map(|(name, _)| name).collect()
        };
        // one model needs no scope, whatever its state repeats
        let one = model("robot", &(body("base") + &body("arm::hand")));
        let state = model("robot", &(pose("base") + &pose("robot::arm::hand")));
        assert_eq!(names(&one, &state), ["base", "arm::hand"]);
        let two = one.clone() + &model("box", &body("base"));
        assert_eq!(names(&two, &state), ["robot::base", "robot::arm::hand", "box::base"]);
        // what only the state holds is said
        let added = format!("<state><insertions>{}</insertions></state>", model("cup", &body("base")));
        let text = format!("<world name='w'>{one}{added}</world>");
        let found = defects(Language::Sdf, &text);
        assert_eq!(found.len(), 3, "{found:?}");
        assert!(found[2].1.contains("the models that a state adds are not read"), "{found:?}");
    }

    #[test]
    fn a_pose_of_sdf_in_another_frame_is_a_defect_in_every_version() {
        let of = |attribute: &str| {
            let pose = format!("<inertial><pose {attribute}>0 0 1 0 0 0</pose>");
            let text = format!("<link name='a'>{}</link>", INERTIAL.replace("<inertial>", &pose));
            defects(Language::Sdf, &text).remove(0).1
        };
        for name in ["relative_to", "frame"] {
            let says = format!("model:1: <pose>: {name}: poses in other frames are not read");
            assert!(of(&format!("{name}='hand'")).starts_with(&says), "{name}");
            // the default
            assert_eq!(of(&format!("{name}=''")), "", "{name}");
        }
    }

    #[test]
    fn settings_that_cannot_be_read_are_defects() {
        let model = |settings: &str| {
            let body = "<body name='b'><geom type='box' size='1 2 3' mass='1'/></body>";
            let text = format!("<mujoco><compiler {settings}/><worldbody>{body}</worldbody></mujoco>");
            defects(Language::Mjcf, &text)
        };
        for (settings, says) in [
            ("boundmass='0,5'", "boundmass: '0,5' is not a number"),
            ("boundinertia='tiny'", "boundinertia: 'tiny' is not a number"),
            ("settotalmass='10kg'", "settotalmass: '10kg' is not a number"),
            ("inertiagrouprange='0-1'", "inertiagrouprange: '0-1' is not a number"),
            ("inertiagrouprange='0'", "inertiagrouprange: 1 given, 2 needed"),
            ("angle='Radian'", "angle: 'Radian' is unknown; known: degree, radian"),
            ("inertiafromgeom='yes'", "inertiafromgeom: 'yes' is unknown; known: auto, false, true"),
            ("coordinate='global'", "coordinate: 'global' is not read"),
            ("balanceinertia='yes'", "balanceinertia: 'yes' is unknown; known: false, true"),
        ] {
            let found = model(settings);
            assert_eq!(found.len(), 2, "{settings}: {found:?}");
            assert_eq!(found[0], ("b".to_string(), String::new()), "{settings}");
            assert_eq!(found[1].0, SETTINGS);
            assert!(found[1].1.starts_with(&format!("model:1: <compiler>: {says}")), "{settings}: {found:?}");
        }
        assert_eq!(model("boundmass='0,5' angle='Radian' settotalmass='10kg'").len(), 4);
        for known in ["boundmass='0.5' inertiagrouprange='0 1'", "angle='degree'", "coordinate='local'"] {
            let found = model(&format!("{known} inertiafromgeom='auto'"));
            assert_eq!(found, [("b".to_string(), String::new())], "{known}");
        }
    }

    /// As MuJoCo does it: least moments first, then the mean where one moment is still larger than the others together.
    #[test]
    fn moments_that_no_body_has_are_balanced_where_that_is_asked_for() {
        let found = |settings: &str, tensor: &str| {
            let text = format!(
                "<mujoco><compiler {settings}/><body name='b'><inertial pos='0 0 0' mass='1' {tensor}/></body></mujoco>"
            );
            read(Language::Mjcf, Path::new("model"), &text, None).unwrap().remove(0)
        };
        let balanced = "balanceinertia='true'";
        let slender = "diaginertia='1 3 8'";
        for (settings, tensor, expected) in [
            (balanced, slender, [4.0, 4.0, 4.0]),
            ("balanceinertia='false'", slender, [1.0, 3.0, 8.0]),
            ("", slender, [1.0, 3.0, 8.0]),
            (balanced, "diaginertia='1 2 2.5'", [1.0, 2.0, 2.5]),
            // no moment is negative
            (balanced, "diaginertia='-1 3 8'", [-1.0, 3.0, 8.0]),
            ("balanceinertia='true' boundinertia='2.5'", slender, [4.5, 4.5, 4.5]),
            ("balanceinertia='true' boundinertia='4'", slender, [4.0, 4.0, 8.0]),
            ("boundinertia='4'", slender, [4.0, 4.0, 8.0]),
        ] {
            let given = found(settings, tensor);
            let diagonal = [0, 1, 2].map(|k| given.tensor[(k, k)]);
            assert_eq!(diagonal, expected, "{settings} {tensor}");
            let is_told = given.remark.unwrap_or_default().contains("(balanceinertia)");
            assert_eq!(is_told, diagonal[0] == diagonal[2], "{settings} {tensor}");
        }
        // principal moments 1, 1 and 4
        let full = found(balanced, "fullinertia='2 2 2 1 1 1'").tensor;
        assert_eq!((full[(0, 0)], full[(0, 1)]), (2.0, 0.0));
    }

    /// Two corners of a cube, of 1/6 m³ each, ten metres apart.
    const CORNERS: &str = "vertex='0 0 0 1 0 0 0 1 0 0 0 1 10 0 0 11 0 0 10 1 0 10 0 1' \
                           face='0 2 1 0 1 3 0 3 2 1 2 3 4 6 5 4 5 7 4 7 6 5 6 7'";

    fn with_mesh(settings: &str, mesh: &str, geom: &str) -> Given {
        let text = format!(
            "<mujoco><compiler {settings}/><asset><mesh name='m' {CORNERS} {mesh}/></asset>\
             <body name='b'><geom {geom}/></body></mujoco>"
        );
        read(Language::Mjcf, Path::new("model"), &text, None).unwrap().remove(0)
    }

    /// About the middle of both the triangle x = 0 alone has a pyramid of some 5/6 m³, which it does not enclose.
    #[test]
    fn the_compiler_of_old_models_says_that_meshes_are_counted_once() {
        let mass = |settings: &str| with_mesh(settings, "", "type='mesh' mesh='m' density='3'").mass.unwrap();
        assert!((mass("exactmeshinertia='true'") - 1.0).abs() < 1e-12);
        assert!(mass("") > 2.0 && mass("exactmeshinertia='false'") > 2.0);
    }

    #[test]
    fn what_mujoco_refuses_of_meshes_and_shells_is_a_defect() {
        for (mesh, geom, says) in [
            ("", "type='mesh' mesh='m' shellinertia='true'", "<geom>: shellinertia is for primitives only"),
            ("", "type='mesh' mesh='m' fromto='0 0 0 0 0 1'", "<geom>: fromto does not belong to the type"),
            ("", "size='1' shellinertia='True'", "<geom>: shellinertia: 'True' is unknown; known:"),
            ("class='none'", "type='mesh' mesh='m'", "<mesh>: no default class 'none'"),
            ("", "type='cylinder' size='0.1' shellinertia='true'", "it must be a finite number above zero"),
        ] {
            let defect = with_mesh("", mesh, geom).defect.unwrap_or_default();
            assert!(defect.contains(says), "{mesh} {geom}: {defect}");
        }
    }

    #[test]
    fn a_total_mass_is_shared_out_among_bodies_that_are_all_read() {
        let model = |more: &str| {
            let body = "<body name='b'><geom size='1' mass='3'/></body>";
            let text = format!("<mujoco><compiler settotalmass='6'/>{body}{more}</mujoco>");
            read(Language::Mjcf, Path::new("model"), &text, None).unwrap()
        };
        // 6 kg of 3 kg and 1 kg, and of 3 kg and what nobody knows
        assert_eq!(model("<body name='c'><geom size='1' mass='1'/></body>")[0].mass, Some(4.5));
        for more in ["<body name='c'><geom size='1' mass='x'/></body>", "<include file='nowhere.xml'/>"] {
            let found = model(more);
            assert_eq!((found.len(), found[0].mass), (3, Some(3.0)), "{more}: {found:?}");
            assert_eq!(found[2].name, SETTINGS, "{more}");
            let says = "model:1: <compiler>: settotalmass: not every body can be read";
            assert!(found[2].defect.as_ref().is_some_and(|defect| defect.starts_with(says)), "{found:?}");
        }
    }

    #[test]
    fn a_body_is_not_computed_from_some_of_its_geoms() {
        let geom = "<geom size='1' mass='1'/>";
        let body = |more: &str| {
            let text = format!("<mujoco><body name='b'>{geom}{more}</body></mujoco>");
            defects(Language::Mjcf, &text)
        };
        for (more, says) in [
            ("<frame name='f' euler='0 0'><geom size='1'/></frame>", "<frame>: euler: 2 given, 3 needed"),
            ("<replicate name='f'><geom size='1'/></replicate>", "<replicate>: count is missing"),
            ("<replicate name='f' count='2.5'><geom size='1'/></replicate>", "<replicate>: count: 2.5 is no"),
            ("<replicate name='f' count='-1'><geom size='1'/></replicate>", "<replicate>: count: -1 is no"),
        ] {
            let found = body(more);
            assert_eq!(found.len(), 2, "{more}: {found:?}");
            for ((name, defect), expected) in found.iter().zip(["b", "f"]) {
                assert_eq!(name, expected, "{more}");
                assert!(defect.starts_with(&format!("model:1: {says}")), "{more}: {found:?}");
            }
        }
        // of a body that states its inertia geoms do not matter
        let found = body("<frame euler='0 0'/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>");
        assert_eq!(found[0], ("b".to_string(), String::new()));
    }

    /// Turns of k times (90°, 90°) about x and then the turned y take x to x, y and −x; their places are 0, 2 x and 2 x + 2 y.
    #[test]
    fn the_angles_of_copies_are_multiplied() {
        let text = "<body name='b'><replicate count='3' offset='2 0 0' euler='90 90 0'>\
                    <geom size='0.1' mass='1' pos='1 0 0'/></replicate></body>";
        let body = read(Language::Mjcf, Path::new("model"), text, None).unwrap().remove(0);
        let expected = nalgebra::Vector3::new(4.0 / 3.0, 1.0, 0.0);
        assert!((body.center_of_mass - expected).norm() < 1e-14, "{}", body.center_of_mass);
        let found = defects(Language::Mjcf, "<body name='b'><replicate count='2' quat='0 1 0 0'/></body>");
        assert_eq!(found[0].1, "model:1: <replicate>: quat does not belong here; write euler");
    }

    #[test]
    fn a_full_tensor_of_mjcf_is_not_turned() {
        let of = |attributes: &str| {
            let text = format!("<inertial pos='0 0 0' mass='2' {attributes}/>");
            defects(Language::Mjcf, &text).remove(0).1
        };
        let says = "model:1: <inertial>: has both fullinertia and euler; leave one out";
        assert_eq!(of("fullinertia='1 2 2.5 0 0 0' euler='0 0 90'"), says);
        assert_eq!(of("fullinertia='1 2 2.5 0 0 0'"), "");
        assert_eq!(of("diaginertia='1 2 2.5' euler='0 0 90'"), "");
    }

    #[test]
    fn a_place_that_mjcf_leaves_out_or_states_in_two_ways_is_a_defect() {
        let of = |element: &str| {
            let class = "<default><default class='raised'><geom pos='0 0 1'/></default></default>";
            let text = format!("<mujoco>{class}<body name='b'>{element}</body></mujoco>");
            defects(Language::Mjcf, &text).remove(0).1
        };
        let says = "model:1: <inertial>: pos is missing";
        assert_eq!(of("<inertial mass='2' diaginertia='1 2 2.5'/>"), says);
        let says = "model:1: <geom>: has both pos and fromto; leave one out";
        for (place, expected) in [("pos='0 0 1'", says), ("class='raised'", says), ("pos='0 0 0'", "")] {
            let geom = format!("<geom type='capsule' size='0.1' fromto='0 0 0 0 0 1' {place}/>");
            assert_eq!(of(&geom), expected, "{place}");
        }
    }

    #[test]
    fn a_place_or_a_moment_that_stands_twice_is_a_defect() {
        let origins = "<origin xyz='1 0 0'/><origin xyz='0 0 0' rpy='0 0 0.5'/>";
        let urdf = format!("<link name='a'><inertial>{origins}{TENSOR}</inertial></link>");
        let sdf = |inertial: &str| format!("<link name='a'>{inertial}</link>");
        let poses = INERTIAL.replace("<mass>", "<pose>1 0 0 0 0 0</pose><pose>0 0 0 0 0 0</pose><mass>");
        let moments = INERTIAL.replace("<izz>", "<iyy>2.1</iyy><izz>");
        for (language, text, tag) in [
            (Language::Urdf, urdf, "origin"),
            (Language::Sdf, sdf(&poses), "pose"),
            (Language::Sdf, sdf(&moments), "iyy"),
        ] {
            let found = defects(language, &text);
            assert_eq!(found.len(), 1, "{tag}");
            assert_eq!(found[0].1, format!("model:1: <{tag}>: is given twice; leave one out"));
        }
    }

    #[test]
    fn a_name_that_stands_twice_is_a_defect() {
        let link = |name: &str| format!("<link name='{name}'><inertial>{TENSOR}</inertial></link>\n");
        // where a link is only named, it has no tensor
        let [arm, leg] = ["arm", "leg"].map(link);
        let text = format!("<robot>\n{arm}{leg}<link name='leg'/>{arm}</robot>");
        let found = defects(Language::Urdf, &text);
        assert_eq!(found.iter().filter(|(_, defect)| !defect.is_empty()).count(), 1, "{found:?}");
        let (name, defect) = &found[3];
        assert_eq!(name, "arm");
        assert_eq!(defect, "model:4: the name is already used at model:2; give each link its own");
    }
}
