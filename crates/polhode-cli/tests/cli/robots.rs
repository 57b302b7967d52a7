//! Robot models and meshes as `polhode inertia` reads them.

use std::fmt::Write as _;
use std::fs;

use crate::harness::{Answer, Scratch, names, run};
use crate::inertia::{OBJ_CUBE, golden, numbers};

/// A model of two links in the words of other programs, with axes turned by rpy.
pub(crate) const ROBOT: &str = "\
<robot name=\"r\">
  <link name=\"base\">
    <inertial>
      <origin xyz=\"0 0 1\" rpy=\"0 0 1.5707963267948966\"/>
      <mass value=\"200\"/>
      <inertia ixx=\"10\" ixy=\"-1\" ixz=\"0\" iyy=\"20\" iyz=\"0\" izz=\"25\"/>
    </inertial>
  </link>
  <link name=\"arm\">
    <inertial>
      <mass value=\"2\"/>
      <inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"1.5\"/>
    </inertial>
  </link>
</robot>
";

#[test]
fn models_are_examined_link_by_link() {
    let scratch = Scratch::new("models");
    scratch.file("robot.urdf", ROBOT);
    let answer = scratch.run("urdf robot.urdf --out rows.csv");
    assert_eq!((answer.code, answer.out.as_str()), (1, ""));
    golden("robot.err", &answer.err);
    golden("robot.csv", &fs::read_to_string(scratch.0.join("rows.csv")).unwrap());
    // a model must not take over what no body has: nothing is written
    let answer = scratch.run("urdf robot.urdf --format mjcf --out model.xml");
    assert_eq!((answer.code, answer.out.as_str()), (1, ""));
    assert!(!scratch.0.join("model.xml").exists());
    // several bodies are an array, which is read back as the same bodies
    let array = scratch.run("urdf robot.urdf --format json").out;
    scratch.file("robot.json", &array);
    assert_eq!(scratch.run("json robot.json --format json").out, array);
    // a quarter turn about z: x of the inertial frame is y of the link, and I_xy changes its sign
    scratch.file("base.urdf", ROBOT.split("  <link name=\"arm\">").next().unwrap().to_owned() + "</robot>");
    let inertia = numbers(&scratch.json("urdf base.urdf")["inertia"]);
    for (found, expected) in inertia.iter().zip([20.0, 1.0, 0.0, 1.0, 10.0, 0.0, 0.0, 0.0, 25.0]) {
        assert!((found - expected).abs() < 1e-14, "{inertia:?}");
    }
}

/// A link of every kind.
const LINKS: &str = r#"<?xml version="1.0"?>
<robot name="links" xmlns:xacro="http://ros.org/wiki/xacro">
  <!-- ü, so that bytes and letters differ -->
  <xacro:property name="unused" value="1"/>
  <drake:joint name="undeclared prefix"/>
  <link name="world"/>
  <link name="frame"><inertial><mass value="0"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
  <link name="good">
    <inertial><mass value="2"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial>
  </link>
  <link name="negative"><inertial><mass value="-2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="no tensor"><inertial><mass value="1"/></inertial></link>
  <link name="no entry"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" izz="1"/></inertial></link>
  <link name="comma"><inertial><mass value="1"/><inertia ixx="0,1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="zero"><inertial><mass value="1"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
  <link name="alike"><inertial><mass value="1e-6"/><inertia ixx="1e-6" ixy="1e-6" ixz="1e-6" iyy="1e-6" iyz="1e-6" izz="1e-6"/></inertial></link>
  <link name="ones"><inertial><mass value="5"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="unit box"><inertial><mass value="12"/><inertia ixx="2" ixy="0" ixz="0" iyy="2" iyz="0" izz="2"/></inertial></link>
  <link name="light"><inertial><mass value="0.01"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.03"/></inertial></link>
  <link name="dense"><inertial><mass value="1"/><inertia ixx="2e-7" ixy="0" ixz="0" iyy="2e-7" iyz="0" izz="3e-7"/></inertial></link>
  <link name="left"><inertial><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="1.5"/></inertial></link>
  <link name="right"><inertial><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="1.5"/></inertial></link>
</robot>
"#;

#[test]
fn a_defect_of_a_link_is_the_row_of_that_link() {
    let scratch = Scratch::new("links");
    scratch.file("links.urdf", LINKS);
    let table = scratch.run("urdf links.urdf --format table");
    assert_eq!(table.code, 1);
    assert!(table.out.lines().take(16).all(|line| line.chars().count() <= 80), "{}", table.out);
    golden("links.txt", &format!("{}{}", table.out, table.err));
    let rows = scratch.run("urdf links.urdf --format csv");
    assert_eq!(rows.code, 1);
    golden("links.csv", &rows.out);
    let json: Vec<serde_json::Value> =
        serde_json::from_str(&scratch.run("urdf links.urdf --format json").out).unwrap();
    let of = |name: &str| json.iter().find(|link| link["name"] == name).unwrap();
    assert_eq!(json.len(), 15);
    assert_eq!(
        (&of("world")["verdict"], &of("world")["inertia"]),
        (&"massless".into(), &serde_json::Value::Null)
    );
    assert_eq!((&of("good")["verdict"], &of("good")["mass"]), (&"valid".into(), &2.0.into()));
    assert!(of("no tensor")["mass"].is_null());
    // several files: a first column says which
    scratch.file("other.urdf", ROBOT);
    let rows = scratch.run("urdf links.urdf other.urdf --format csv").out;
    assert!(rows.starts_with("file,name,mass,") && rows.contains("\nother.urdf,base,200.0,"), "{rows}");
    let details = scratch.run("urdf other.urdf --details --format table");
    assert!(
        details.out.contains("center_of_mass_x") && details.err.contains("nearest valid tensor"),
        "{details:?}"
    );
    // a model without links is no mistake
    scratch.file("none.urdf", "<robot/>");
    let none = scratch.run("urdf none.urdf");
    assert_eq!(
        (none.code, none.err.as_str()),
        (0, "warning: none.urdf: no link in it; nothing to examine\n")
    );
}

#[test]
fn a_world_without_links_is_told_by_what_it_holds() {
    let scratch = Scratch::new("models-world");
    let world = |inside: &str| format!("<sdf version='1.9'><world name='w'>\n{inside}\n</world></sdf>");
    scratch.file("sun.sdf", world("<light name='sun' type='directional'><intensity>1</intensity></light>"));
    let sun = scratch.run("sdf sun.sdf");
    let says = "warning: sun.sdf: no link in it, but <world> 'w', <light> 'sun'; nothing to examine\n";
    assert_eq!((sun.code, sun.err.as_str()), (0, says));
    // what an include holds is not known
    scratch.file("include.sdf", world("<include><uri>model://sun</uri></include>"));
    let include = scratch.run("sdf include.sdf --format csv");
    let says = "include model://sun: include.sdf:2: <include>: the included model is not read; put its links \
                into this file, or leave the include out if it has none, as a light\n";
    assert!(include.code == 1 && include.err.contains(says), "{include:?}");
}

/// Links of several models are named with their models, here as by `polhode inertia`.
#[test]
fn a_link_of_one_of_several_models_is_named_with_its_model() {
    let scratch = Scratch::new("models-scoped");
    let link = |name: &str, last: &str| {
        let tensor = format!("<inertia><ixx>1</ixx><iyy>2</iyy><izz>{last}</izz></inertia>");
        format!(
            "<model name='{name}'><link name='base'><inertial><mass>1</mass>{tensor}</inertial></link></model>"
        )
    };
    let world =
        format!("<sdf version='1.4'><world name='w'>{}{}</world></sdf>", link("a", "2.5"), link("b", "3"));
    let file = scratch.file("world.sdf", world);
    let start = "--omega 0.1,2,0.1 --format json";
    let motion = |body: &str| run(&format!("motion {body} {start}"));
    for (name, moments) in [("a::base", "1,2,2.5"), ("b::base", "1,2,3")] {
        let (named, typed) =
            (motion(&format!("--body {file}:{name}")), motion(&format!("--inertia {moments},0,0,0")));
        assert_eq!((named.code, named.out), (0, typed.out), "{name}: {}", named.err);
    }
    let unknown = motion(&format!("--body {file}:a::bass"));
    assert!(unknown.code == 2 && unknown.err.contains("a::base"), "{}", unknown.err);
}

#[test]
fn a_repaired_copy_differs_by_its_tensors_alone() {
    let scratch = Scratch::new("repair");
    scratch.file("links.urdf", LINKS);
    let answer = scratch.run("urdf links.urdf --repair copies --format json");
    golden("repair.err", &answer.err);
    assert_eq!(
        fs::read_to_string(scratch.0.join("links.urdf")).unwrap(),
        LINKS,
        "the model itself was written"
    );
    let copy = fs::read_to_string(scratch.0.join("copies/links.urdf")).unwrap();
    let changed: Vec<(&str, &str)> =
        LINKS.lines().zip(copy.lines()).filter(|(before, after)| before != after).collect();
    assert_eq!((LINKS.lines().count(), changed.len()), (copy.lines().count(), 3), "{changed:?}");
    for (before, after) in changed {
        let head = before.find("<inertia ").unwrap();
        assert_eq!(before[..head], after[..head]);
        assert_eq!(before[before.find("/>").unwrap()..].rsplit("/>").next(), after.rsplit("/>").next());
    }
    let after: Vec<serde_json::Value> =
        serde_json::from_str(&scratch.run("urdf copies/links.urdf --format json").out).unwrap();
    let twin = after.iter().find(|link| link["name"] == "left").unwrap();
    assert_ne!(twin["verdict"], "invalid");
    // never over the model itself
    let answer = scratch.run("urdf links.urdf --repair .");
    assert_eq!(answer.code, 2, "{answer:?}");
    assert!(answer.err.contains("holds the model itself"), "{answer:?}");
    // a list of entries, three moments, and the text of elements
    scratch.file(
        "list.xml",
        "<mujoco><worldbody><body name='a'><inertial pos='0 0 0' mass='1' fullinertia='1 1 3 0 0 0'/></body>\
         <body name='b'><inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/></body></worldbody></mujoco>\n",
    );
    scratch.file(
        "text.sdf",
        "<sdf version='1.6'><model name='m'><link name='a'><inertial><mass>1</mass><inertia>\
         <ixx>1</ixx><iyy>1</iyy><izz> 3 </izz></inertia></inertial></link></model></sdf>\n",
    );
    scratch.file(
        "replicated.xml",
        "<mujoco><replicate count='2'><body name='a'><inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/></body>\
         </replicate></mujoco>\n",
    );
    for (line, copy) in [
        ("mjcf list.xml", "copies/list.xml"),
        ("sdf text.sdf", "copies/text.sdf"),
        ("mjcf replicated.xml", "copies/replicated.xml"),
    ] {
        assert_eq!(scratch.run(&format!("{line} --repair copies")).code, 1);
        let (kind, _) = line.split_once(' ').unwrap();
        let again = scratch.run(&format!("{kind} {copy}"));
        assert_ne!(again.code, 2, "{again:?}");
        assert!(!again.out.contains("invalid"), "{again:?}");
    }
    // the same copy again, but never over another file of its name
    assert_eq!(scratch.run("urdf links.urdf --repair copies").code, 1);
    scratch.file("copies/links.urdf", "mine");
    let answer = scratch.run("urdf links.urdf --repair copies");
    assert_eq!(answer.code, 2, "{answer:?}");
    assert!(answer.err.contains("holds another 'links.urdf', which is not overwritten"), "{answer:?}");
    assert_eq!(fs::read(scratch.0.join("copies/links.urdf")).unwrap(), b"mine");
}

/// Geoms of every kind, defaults, frames, copies and an included file.
const GEOMS: &str = r#"<mujoco>
  <compiler angle="radian" inertiagrouprange="0 2"/>
  <default>
    <geom density="500"/>
    <default class="arm"><geom type="capsule" size="0.05 0.2"/></default>
  </default>
  <asset>
    <mesh name="cube" vertex="0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1" scale="0.5 0.5 0.5"/>
  </asset>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="box"><geom type="box" size="0.1 0.2 0.3" mass="12" euler="1.5707963267948966 0 0"/></body>
    <body name="arm" childclass="arm"><geom/><geom size="0.1" group="3"/></body>
    <body name="fromto"><geom type="cylinder" size="0.1" fromto="0 0 0 0 2 0" density="1000"/></body>
    <body name="frame"><frame pos="1 0 0" axisangle="0 0 1 1.5707963267948966"><geom type="ellipsoid" size="0.1 0.2 0.3" pos="1 0 0"/></frame></body>
    <body name="copies"><replicate count="3" offset="1 0 0"><geom size="0.1" mass="1"/></replicate></body>
    <body name="mesh"><geom type="mesh" mesh="cube" density="1000"/></body>
    <body name="shell"><geom type="box" size="0.1 0.1 0.1" shellinertia="true" density="10"/></body>
    <body name="site"><site pos="0 0 0"/></body>
    <include file="parts/more.xml"/>
    <include file="../outside.xml"/>
  </worldbody>
</mujoco>
"#;

#[test]
fn bodies_without_inertial_are_computed_from_their_geoms() {
    let scratch = Scratch::new("geoms");
    fs::create_dir_all(scratch.0.join("model/parts")).unwrap();
    scratch.file("model/geoms.xml", GEOMS);
    scratch.file("outside.xml", "<mujoco><body name='outside'><geom size='1'/></body></mujoco>");
    scratch.file(
        "model/parts/more.xml",
        "<mujoco><body name='included'><geom type='sphere' size='0.1' mass='5'/></body></mujoco>",
    );
    let answer = scratch.run("mjcf model/geoms.xml --format json");
    assert_eq!(answer.code, 1);
    let links: Vec<serde_json::Value> = serde_json::from_str(&answer.out).unwrap();
    let names: Vec<&str> = links.iter().map(|link| link["name"].as_str().unwrap()).collect();
    assert_eq!(
        names,
        [
            "box",
            "arm",
            "fromto",
            "frame",
            "copies",
            "mesh",
            "shell",
            "site",
            "included",
            "include ../outside.xml"
        ]
    );
    let of = |name: &str| links.iter().find(|link| link["name"] == name).unwrap();
    let close = |name: &str, mass: f64, center: [f64; 3], diagonal: [f64; 3]| {
        let link = of(name);
        assert!((link["mass"].as_f64().unwrap() / mass - 1.0).abs() < 1e-14, "{name}: {link}");
        for (found, expected) in numbers(&link["center_of_mass"]).into_iter().zip(center) {
            assert!((found - expected).abs() < 1e-14, "{name}: {link}");
        }
        let tensor = numbers(&link["inertia"]);
        for (k, expected) in diagonal.into_iter().enumerate() {
            assert!((tensor[4 * k] / expected - 1.0).abs() < 1e-13, "{name}: {link}");
        }
    };
    // a box of edges 0.2, 0.6, 0.4 after the quarter turn: m (y^2 + z^2)/12
    close("box", 12.0, [0.0; 3], [0.52, 0.20, 0.40]);
    let pi = std::f64::consts::PI;
    // a capsule of radius r and cylinder h: its mass is rho pi r^2 (h + 4 r/3)
    let (r, h) = (0.05, 0.4);
    let (rod, caps) = (500.0 * pi * r * r * h, 500.0 * pi * r * r * 4.0 * r / 3.0);
    let across = rod * (3.0 * r * r + h * h) / 12.0 + caps * (0.4 * r * r + h * h / 4.0 + 0.375 * h * r);
    let along = rod * r * r / 2.0 + caps * 0.4 * r * r;
    close("arm", rod + caps, [0.0; 3], [across, across, along]);
    let mass = 1000.0 * pi * 0.01 * 2.0;
    let side = mass * (3.0 * 0.01 + 4.0) / 12.0;
    close("fromto", mass, [0.0, 1.0, 0.0], [side, mass * 0.005, side]);
    let mass = 500.0 * 4.0 / 3.0 * pi * 0.006;
    close("frame", mass, [1.0, 1.0, 0.0], [mass * 0.02, mass * 0.026, mass * 0.01]);
    close("copies", 3.0, [1.0, 0.0, 0.0], [0.012, 2.012, 2.012]);
    close("mesh", 125.0, [0.25; 3], [125.0 * 0.25 / 6.0; 3]);
    // six plates of 0.4 kg each, half of them at a distance of 0.1
    close("shell", 2.4, [0.0; 3], [2.4 * 0.01 * 10.0 / 9.0; 3]);
    assert_eq!(of("site")["verdict"], "massless");
    close("included", 5.0, [0.0; 3], [0.02; 3]);
    assert!(
        of("include ../outside.xml")["trouble"]
            .as_str()
            .unwrap()
            .contains("outside of the folder of the model")
    );
    // a folder around both is named
    let answer = scratch.run("mjcf model/geoms.xml --root . --format json");
    assert_eq!(answer.code, 0, "{answer:?}");
    assert!(answer.out.contains("\"outside\""));
}

#[test]
fn orientations_and_settings_of_mjcf_are_obeyed() {
    let scratch = Scratch::new("orientations");
    let body = |setting: &str, attributes: &str| {
        scratch.file(
            "model.xml",
            format!(
                "<mujoco><compiler {setting}/><worldbody><body name='b'>\
                 <inertial pos='0 0 0' mass='100' diaginertia='1 2 2.5' {attributes}/><geom size='1' mass='3'/>\
                 </body></worldbody></mujoco>"
            ),
        );
        scratch.run("mjcf model.xml --format json")
    };
    let tensor = |answer: &Answer| {
        let link: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
        let t = numbers(&link["inertia"]);
        [t[0], t[4], t[8], t[1]]
    };
    // a quarter turn about z exchanges x and y, however it is written
    for (setting, attributes) in [
        ("", "quat='1 0 0 1'"),
        ("", "euler='0 0 90'"),
        ("angle='radian'", "euler='0 0 1.5707963267948966'"),
        ("eulerseq='zyx'", "euler='90 0 0'"),
        ("eulerseq='XYZ'", "euler='0 0 -90'"),
        ("", "axisangle='0 0 2 90'"),
        ("", "xyaxes='0 2 0 -1 0 0'"),
    ] {
        assert_eq!(tensor(&body(setting, attributes)), [2.0, 1.0, 2.5, 0.0], "{setting} {attributes}");
    }
    // z along y: x stays, and y and z are exchanged
    assert_eq!(tensor(&body("", "zaxis='0 1 0'")), [1.0, 2.5, 2.0, 0.0]);
    // geoms instead of the stated tensor; the total; the least
    assert_eq!(tensor(&body("inertiafromgeom='true'", "")), [3.0 * 0.4, 3.0 * 0.4, 3.0 * 0.4, 0.0]);
    assert_eq!(tensor(&body("settotalmass='50'", "")), [0.5, 1.0, 1.25, 0.0]);
    assert_eq!(tensor(&body("boundinertia='1.5'", "")), [1.5, 2.0, 2.5, 0.0]);
    for (attributes, said) in [
        ("quat='0 0 0 0'", "quat is zero"),
        ("xyaxes='1 0 0 2 0 0'", "spans no plane"),
        ("zaxis='0 0 0'", "has a zero axis"),
        ("euler='0 0 0' quat='1 0 0 0'", "has both quat and euler"),
        ("fullinertia='1 1 1 0 0 0'", "has both fullinertia and diaginertia"),
    ] {
        let answer = body("", attributes);
        assert_eq!(answer.code, 1, "{attributes}");
        assert!(answer.err.contains(said) && answer.err.contains("model.xml:1"), "{answer:?}");
    }
    let answer = body("eulerseq='xyq'", "euler='1 2 3'");
    assert!(answer.err.contains("eulerseq is not three of the letters"), "{answer:?}");
}

/// Which of two tensors counts, a format may say and nobody reads: programs take the first, the last, or none.
#[test]
fn a_link_of_two_tensors_is_invalid() {
    let scratch = Scratch::new("twice");
    let one = "<mass value='1'/><inertia ixx='1' iyy='2' izz='2.5' ixy='0' ixz='0' iyz='0'/>";
    let link = |inertials: &str| format!("<robot name='r'><link name='a'>{inertials}</link></robot>");
    scratch.file("links.urdf", link(&format!("<inertial>{one}</inertial>").repeat(2)));
    scratch.file("tensors.urdf", link(&format!("<inertial>{one}{one}</inertial>")));
    let inertial = "<inertial pos='0 0 0' mass='1' diaginertia='1 2 2.5'/>".repeat(2);
    scratch.file(
        "bodies.xml",
        format!("<mujoco><worldbody><body name='a'>{inertial}</body></worldbody></mujoco>"),
    );
    for line in ["urdf links.urdf", "urdf tensors.urdf", "mjcf bodies.xml"] {
        let answer = scratch.run(line);
        assert_eq!(answer.code, 1, "{line}");
        assert!(answer.err.contains("is given twice; leave one out"), "{line}: {answer:?}");
    }
}

#[test]
fn copies_of_copies_and_circles_of_includes_end() {
    let scratch = Scratch::new("bombs");
    let copies = "<replicate count='100000'>".repeat(6) + "<geom size='1'/>" + &"</replicate>".repeat(6);
    scratch.file(
        "copies.xml",
        format!("<mujoco><worldbody><body name='b'>{copies}</body></worldbody></mujoco>"),
    );
    let answer = scratch.run("mjcf copies.xml");
    assert_eq!(answer.code, 1, "{answer:?}");
    assert!(answer.err.contains("more than 1000000 elements"), "{answer:?}");
    scratch.file("circle.xml", "<mujoco><include file='circle.xml'/></mujoco>");
    let answer = scratch.run("mjcf circle.xml");
    assert_eq!(answer.code, 1, "{answer:?}");
    assert!(answer.err.contains("includes itself"), "{answer:?}");
    scratch.file("there.xml", "<mujoco><include file='back.xml'/></mujoco>");
    scratch.file("back.xml", "<mujoco><include file='there.xml'/></mujoco>");
    assert!(scratch.run("mjcf there.xml").err.contains("includes itself"));
    let missing = "<mujoco><include file='nowhere.xml'/><worldbody><body name='b'/></worldbody></mujoco>";
    scratch.file("missing.xml", missing);
    let answer = scratch.run("mjcf missing.xml");
    assert!(
        answer.code == 1 && answer.out.contains("\nb,0.0,") && answer.err.contains("is not there"),
        "{answer:?}"
    );
}

#[test]
fn meshes_are_mended_closed_or_asked_about() {
    let scratch = Scratch::new("mend");
    let open = OBJ_CUBE.replace("f 5 6 7 8\n", "");
    scratch.file("open.obj", &open);
    scratch.file("inside-out.obj", reversed(OBJ_CUBE));
    scratch.file("turned.obj", OBJ_CUBE.replace("f 5 6 7 8", "f 8 7 6 5"));
    scratch.file("doubled.obj", format!("{OBJ_CUBE}f 5 6 7 8\n"));
    // the lid in single precision, beside the rest
    scratch.file(
        "apart.obj",
        format!("{open}v 0 0 1.0000001\nv 1 0 1\nv 1.0000001 1 1\nv 0 1 1\nf 9 10 11 12\n"),
    );
    scratch.file("flat.obj", format!("{OBJ_CUBE}f 1 1 2\n"));
    scratch.file("long.obj", OBJ_CUBE.replace("v 1", "v 30"));
    scratch.file("overlapping.obj", OBJ_CUBE.to_owned() + &shifted(OBJ_CUBE, 0.5));
    scratch.file("touching.obj", OBJ_CUBE.to_owned() + &shifted(OBJ_CUBE, 1.0));
    scratch.file("groups.obj", format!("g cube\n{OBJ_CUBE}g sheet\nf 1 2 3\n"));
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               element face 4\nproperty list uchar int vertex_indices\nend_header\n\
               0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    scratch.file("corner.ply", ply);
    let mut text = String::new();
    for (line, code) in [
        ("inside-out.obj", 0),
        ("turned.obj", 0),
        ("doubled.obj", 0),
        ("apart.obj", 0),
        ("apart.obj --weld 1e-9", 2),
        ("flat.obj", 0),
        ("open.obj", 2),
        ("open.obj --close fan", 0),
        ("open.obj --close hull", 0),
        ("open.obj --shell 0.01", 0),
        ("long.obj", 0),
        ("long.obj --length-unit mm", 0),
        ("long.obj --length-unit in", 0),
        ("groups.obj --group cube", 0),
        ("groups.obj --group sheet", 2),
        ("corner.ply", 0),
        ("overlapping.obj", 0),
        ("touching.obj", 0),
    ] {
        let answer = scratch.run(&format!("mesh {line} --density 6"));
        assert_eq!(answer.code, code, "{line}: {answer:?}");
        let mass = answer.out.lines().nth(1).and_then(|row| row.split(',').nth(1));
        writeln!(
            text,
            "$ polhode inertia mesh {line} --density 6\nmass {}\n{}",
            mass.unwrap_or("none"),
            answer.err
        )
        .unwrap();
    }
    golden("meshes.txt", &text);
    assert!(!names(&scratch.0).is_empty());
}

/// A second cube, beside the first along x, whose eight corners stand before its own.
fn shifted(obj: &str, by: f64) -> String {
    let number = |text: &str| text.parse::<f64>().unwrap();
    let line = |line: &str| match line.split(' ').collect::<Vec<_>>()[..] {
        ["v", x, y, z] => format!("v {} {y} {z}\n", number(x) + by),
        ref face => {
            "f".to_owned()
                + &face[1..].iter().map(|n| format!(" {}", number(n) + 8.0)).collect::<String>()
                + "\n"
        }
    };
    obj.lines().map(line).collect()
}

/// The same faces seen from the other side.
fn reversed(obj: &str) -> String {
    let turn = |line: &str| match line.strip_prefix("f ") {
        Some(face) => "f ".to_owned() + &face.split(' ').rev().collect::<Vec<_>>().join(" "),
        None => line.to_owned(),
    };
    obj.lines().map(|line| turn(line) + "\n").collect()
}

/// A model in another coding is refused by the name of that.
#[test]
fn a_model_that_is_compressed_is_said_to_be_so() {
    let scratch = Scratch::new("robots-coding");
    for (mark, says) in
        [(&b"\x1f\x8b\x08"[..], "compressed by gzip"), (&b"\xff\xfe<\0"[..], "the text is UTF-16")]
    {
        let path = scratch.file("model.urdf", mark);
        let answer = run(&format!("inertia urdf {path}"));
        assert!(answer.code == 2 && answer.err.contains(says), "{answer:?}");
    }
}

#[test]
fn models_nested_without_end_are_refused_with_line_and_depth() {
    let scratch = Scratch::new("robots-nested");
    for (language, root, element) in
        [("urdf", "robot", "link"), ("mjcf", "mujoco", "body"), ("sdf", "sdf", "model")]
    {
        for depth in [600, 5000, 200_000] {
            let text = format!(
                "<{root}>\n{}{}</{root}>",
                format!("<{element}>\n").repeat(depth),
                format!("</{element}>").repeat(depth)
            );
            let path = scratch.file("nested.xml", text);
            let answer = run(&format!("inertia {language} {path}"));
            let says = format!("{path}:501: elements are nested 501 deep, and at most 500 are read");
            assert_eq!(answer.code, 2, "{language}, {depth}: {}", answer.err);
            assert!(answer.err.contains(&says), "{language}, {depth}: {}", answer.err);
        }
        let depth = 490;
        let text = format!(
            "<{root}>{}{}</{root}>",
            format!("<{element}>").repeat(depth),
            format!("</{element}>").repeat(depth)
        );
        let path = scratch.file("deep.xml", text);
        let answer = run(&format!("inertia {language} {path}"));
        assert!(!answer.err.contains("are nested"), "{language}: {}", answer.err);
    }
}

#[test]
fn a_chain_of_included_files_is_as_deep_as_one_file_at_most() {
    let scratch = Scratch::new("robots-chain");
    let nested = |inside: &str| format!("{}{inside}{}", "<body>".repeat(300), "</body>".repeat(300));
    for k in 0..20 {
        let inside = nested(&format!("<include file=\"{}.xml\"/>", k + 1));
        scratch.file(&format!("{k}.xml"), format!("<mujoco><worldbody>{inside}</worldbody></mujoco>"));
    }
    scratch.file("20.xml", "<mujoco/>");
    let answer = run(&format!("inertia mjcf {}", scratch.0.join("0.xml").display()));
    assert!((0..=2).contains(&answer.code), "{}", answer.err);
    let all = answer.err + &answer.out;
    assert!(all.contains("would be nested more than 500 deep"), "{all}");
}

#[test]
fn names_that_a_spreadsheet_would_run_are_quoted_in_csv_alone() {
    let scratch = Scratch::new("robots-formula");
    let link = |name: &str| {
        format!(
            "<link name=\"{name}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
        )
    };
    let names = ["=1+1|cmd", "+1", "-1", "@SUM(A1)", "a=1", "arm-left"];
    let links: String = names.iter().map(|name| link(name)).collect();
    let path = scratch.file("robot.urdf", format!("<robot name=\"r\">{links}</robot>"));
    let answer = run(&format!("inertia urdf {path} --format csv"));
    let found: Vec<&str> = answer.out.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(found, ["'=1+1|cmd", "'+1", "'-1", "'@SUM(A1)", "a=1", "arm-left"]);
    assert!(answer.err.contains("'=1+1|cmd': a spreadsheet would run it as a formula"), "{}", answer.err);
    let json = run(&format!("inertia urdf {path} --format json"));
    assert!(json.out.contains("\"name\": \"=1+1|cmd\"") && !json.err.contains("spreadsheet"), "{}", json.err);
}
