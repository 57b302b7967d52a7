//! One command reads what another wrote: bodies from files, formats by the ending of a file.

use std::fs;

use crate::harness::{Scratch, golden, output, polhode, refused, run, words};

const BRICK: &str = "inertia tensor 0.0217,0.0333,0.0433,0.0021,-0.0012,0.0007 --mass 1.3";

#[test]
fn a_body_of_inertia_goes_into_every_command() {
    let scratch = Scratch::new("compose");
    let file = |name: &str| scratch.0.join(name).display().to_string();
    let start = "--omega 0.3,1,0.4 --times 0,7 --fields q,omega";
    let typed = output(&format!("propagate --inertia 0.0217,0.0333,0.0433,0.0021,-0.0012,0.0007 {start}"));
    for name in ["brick.json", "brick.toml", "brick.urdf", "brick.mjcf"] {
        assert_eq!(output(&format!("{BRICK} --out {}", file(name))), "");
        assert_eq!(output(&format!("propagate --body {} {start}", file(name))), typed, "{name}");
    }
    let nine = "0.0217,0.0021,-0.0012,0.0021,0.0333,0.0007,-0.0012,0.0007,0.0433";
    assert_eq!(output(&format!("propagate --inertia {nine} {start}")), typed);
    let json = file("brick.json");
    assert!(output(&format!("motion --body {json} --omega 0.3,1,0.4")).contains("axis"));
    let record = file("record.csv");
    let simulated = format!(
        "simulate --body {json} --omega 0.3,5,0.4 --until 20 --every 0.01 --noise 1e-4 --out {record}"
    );
    assert_eq!(output(&simulated), "");
    // the trace of the body gives the size of what is fitted, and that is a body again
    let fitted = file("fitted.json");
    let answer = run(&format!("fit {record} --body {json} --out {fitted}"));
    assert_eq!(answer.code, 0, "{}", answer.err);
    // its warnings, if it has any, are told again
    let moved = run(&format!("propagate --body {fitted} --omega 0.3,1,0.4 --times 0 --fields energy"));
    assert_eq!(moved.code, 0, "{}", moved.err);
    let energy: f64 = moved.out.lines().nth(1).unwrap().parse().unwrap();
    let expected: f64 =
        output(&format!("propagate --body {json} --omega 0.3,1,0.4 --times 0 --fields energy"))
            .lines()
            .nth(1)
            .unwrap()
            .parse()
            .unwrap();
    assert!((energy / expected - 1.0).abs() < 1e-3, "{energy} {expected}");
    // without a size the ratios still move
    let shape = file("shape.json");
    assert_eq!(run(&format!("fit {record} --out {shape}")).code, 0);
    let moved = run(&format!("motion --body {shape} --omega 0.3,1,0.4"));
    assert!(moved.code == 0 && moved.err.contains("up to a factor"), "{}", moved.err);
}

#[test]
fn what_a_fit_warned_of_is_told_once_wherever_its_tensor_is_the_body() {
    let scratch = Scratch::new("compose-warnings");
    let start = "--omega 0.3,1,0.4";
    let tensor = "\"inertia\": [[1,0,0],[0,2,0],[0,0,2.5]]";
    let fit = scratch.file("fit.json", format!("{{{tensor}, \"warnings\": [\"one\", \"two\\nlines\"]}}"));
    let told = |body: &str, warnings: [&str; 2]| {
        let line = |warning: &str| format!("warning: --body: {body}: the fit warns: {warning}\n");
        warnings.map(line).concat()
    };
    let page = scratch.0.join("page.html").display().to_string();
    for line in [
        format!("propagate --body {fit} {start} --times 1"),
        format!("motion --body {fit} {start}"),
        format!("show --body {fit} {start} --until 1 --out {page}"),
    ] {
        let answer = run(&line);
        assert_eq!((answer.code, answer.err), (0, told(&fit, ["one", "two\\nlines"])), "{line}");
    }
    // also where the body gives the size of a fit, and where its tensor is read to be written again
    let record = scratch.file("record.csv", "");
    let spin = "--omega 0.3,5,0.4 --until 20 --every 0.01 --noise 1e-4";
    output(&format!("simulate --moments 1,2,2.5 {spin} --out {record}"));
    for line in [format!("fit {record} --body {fit}"), format!("inertia json {fit}")] {
        let answer = run(&line);
        assert_eq!(answer.err.matches("the fit warns: one\n").count(), 1, "{line}: {answer:?}");
    }
    // of a joint fit those of its records too, whichever body is taken
    let text = format!(
        "{{\"carrier\": {{{tensor}}}, \"object\": {{{tensor}}}, \"warnings\": [\"apart\"], \
         \"records\": [{{\"attached\": \"carrier\", \"warnings\": [\"noisy\"]}}]}}"
    );
    let joint = scratch.file("joint.json", text);
    let answer = run(&format!("motion --body {joint}:object {start}"));
    let expected = told(&format!("{joint} of 'object'"), ["carrier: noisy", "apart"]);
    assert_eq!((answer.code, answer.err), (0, expected));
    let other = scratch.file("other.json", format!("{{{tensor}, \"warnings\": [3]}}"));
    refused(&format!("motion --body {other} {start}"), &["other.json: \"warnings\" is not a list of texts"]);
}

#[test]
fn a_link_of_a_model_is_named_behind_a_colon() {
    let scratch = Scratch::new("compose-links");
    let link = |name: &str, xx: f64| {
        format!(
            "<link name='{name}'><inertial><origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/><mass value='10'/>\
             <inertia ixx='{xx}' iyy='2' izz='2.5' ixy='0' ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let robot = scratch
        .file("arm.urdf", format!("<robot name='r'>{}{}</robot>", link("upper", 1.0), link("lower", 1.5)));
    let start = "--omega 0.3,1,0.4 --times 0 --fields energy";
    // the frame of the tensor is turned about z: its x is the y of the link
    let text = output(&format!("propagate --body {robot}:upper {start}"));
    let energy: f64 = text.lines().nth(1).unwrap().parse().unwrap();
    assert!((energy - 0.5 * (2.0 * 0.09 + 1.0 + 2.5 * 0.16)).abs() < 1e-12, "{text}");
    // what its link remarks on it is told
    let degrees =
        format!("<robot name='r'>{}</robot>", link("upper", 1.0).replace("1.5707963267948966", "90"));
    let degrees = scratch.file("degrees.urdf", degrees);
    let told = run(&format!("propagate --body {degrees} {start}"));
    assert!(
        told.code == 0 && told.err.contains("of 'upper': its axes turn by an angle of 90 rad"),
        "{told:?}"
    );
    refused(&format!("propagate --body {robot} {start}"), &["has 2 bodies: upper, lower", "FILE:NAME"]);
    refused(&format!("propagate --body {robot}:uper {start}"), &["'uper': no such link", "'upper'"]);
    // a name that several have names none of them
    let twice = scratch
        .file("twice.urdf", format!("<robot name='r'>{}{}</robot>", link("upper", 1.0), link("upper", 1.5)));
    let of_json = |xx: u8| format!("{{\"name\":\"upper\",\"inertia\":[[{xx},0,0],[0,6,0],[0,0,7]]}}");
    let array = scratch.file("twice.json", format!("[{},{}]", of_json(5), of_json(6)));
    for file in [&twice, &array] {
        refused(&format!("propagate --body {file}:upper {start}"), &["2 bodies of the file have this name"]);
    }
    let answer = run(&format!("inertia urdf {twice}"));
    assert!(answer.code == 1 && answer.err.contains("the name is already used at"), "{answer:?}");
    let model = scratch.file(
        "model.xml",
        "<mujoco><compiler angle='Radian'/><body name='a'><geom size='1' mass='1'/></body></mujoco>",
    );
    refused(&format!("propagate --body {model}:a {start}"), &["model.xml:1: <compiler>: angle: 'Radian'"]);
    let model = scratch.file(
        "parted.xml",
        "<mujoco><include file='absent.xml'/><body name='a'><geom size='1' mass='1'/></body></mujoco>",
    );
    refused(
        &format!("propagate --body {model}:a {start}"),
        &["parted.xml:1: <include>: file 'absent.xml' is not"],
    );
    let nameless = scratch.file("box.json", output("inertia box 3,2,1 --mass 1 --format json"));
    refused(&format!("propagate --body {nameless}:lid {start}"), &["have no names", "leave out the colon"]);
    let empty = scratch.file("frames.urdf", "<robot name='r'><link name='base'/></robot>");
    for body in [&empty, &format!("{empty}:base")] {
        refused(&format!("propagate --body {body} {start}"), &["no body in it states an inertia tensor"]);
    }
}

#[test]
fn a_model_with_one_body_that_can_be_read_and_one_that_cannot_is_refused_unless_one_is_named() {
    let scratch = Scratch::new("one-of-two");
    let start = "--omega 0.3,1,0.4 --times 0";
    let inertial = |xx: &str| {
        let rest = "ixy='0' ixz='0' iyy='2' iyz='0' izz='2.5'";
        format!("<inertial><mass value='10'/><inertia ixx='{xx}' {rest}/></inertial>")
    };
    let link = |name: &str, xx: &str| format!("<link name='{name}'>{}</link>", inertial(xx));
    let text = format!("<robot name='r'>{}\n{}</robot>", link("base", "1"), link("arm", "0,02"));
    let model = scratch.file("arm.urdf", text);
    let defect = "arm.urdf:2: <inertia>: ixx: '0,02' is not a number";
    refused(&format!("propagate --body {model} {start}"), &[defect, "FILE:NAME"]);
    refused(&format!("propagate --body {model}:arm {start}"), &[defect]);
    assert!(!output(&format!("propagate --body {model}:base {start}")).is_empty());
}

#[test]
fn files_without_a_body_are_refused() {
    let scratch = Scratch::new("no-body");
    let start = "--omega 0.3,1,0.4 --times 0";
    let of = |name: &str, text: &str| format!("propagate --body {} {start}", scratch.file(name, text));
    refused(&of("a.json", "{\"mass\": 1}"), &["a.json", "no \"inertia\"", "polhode inertia"]);
    refused(&of("b.json", "{"), &["b.json", "line 1"]);
    let both = "{\"inertia\": [1,2,3,0,0,0], \"shape\": [[0.2,0,0],[0,0.3,0],[0,0,0.5]]}";
    refused(&of("both.json", both), &["both.json", "\"inertia\" is not an array of 3 x 3 numbers"]);
    refused(&of("c.json", "{\"inertia\": [[1,0,0],[0,1,0],[0,0,3]]}"), &["c.json", "I1 + I2 >= I3"]);
    refused(&of("d.txt", "1,2,3"), &["d.txt", ".json, .toml, .stl, .obj, .ply, .urdf, .mjcf, .sdf or .xml"]);
    refused(&of("e.toml", "[[part]]\nshape = \"cube\"\n"), &["e.toml:2", "no such shape 'cube'"]);
    refused(
        &format!("propagate --body absent.json {start}"),
        &["'absent.json'", "no such file", "polhode bodies"],
    );
}

#[test]
fn the_ending_of_a_file_names_its_format() {
    let scratch = Scratch::new("endings");
    let file = |name: &str| scratch.0.join(name).display().to_string();
    let line = "propagate --body dyadic --times 0,1";
    for (name, format) in [("a.csv", "csv"), ("a.json", "json"), ("a.txt", "table"), ("a", "csv")] {
        assert_eq!(output(&format!("{line} --out {}", file(name))), "");
        let printed = output(&format!("{line} --format {format}"));
        assert_eq!(fs::read_to_string(file(name)).unwrap(), printed, "{name}");
    }
    refused(&format!("{line} --out {}", file("a.png")), &["--out", "a.png", ".csv, .json or .txt"]);
    refused(&format!("{line} --format csv --out {}", file("a.json")), &["--out", "different formats"]);
    assert_eq!(output(&format!("{line} --format csv --out {}", file("a.dat"))), "");
    assert_eq!(output(&format!("{BRICK} --format mjcf-diagonal --out {}", file("b.xml"))), "");
    refused(&format!("{BRICK} --format urdf --out {}", file("b.json")), &["--out", "different formats"]);
    refused(&format!("{BRICK} --format json --out {}", file("b.urdf")), &["--out", "different formats"]);
    let record = scratch.file("r.csv", "t,wx,wy,wz\n0,1,2,3\n");
    refused(&format!("fit {record} --residuals {}", file("r.jpg")), &["--residuals", "r.jpg", "SVG", ".svg"]);
}

#[test]
fn the_catalogue_is_shown_with_its_sources() {
    golden("bodies.csv", &output("bodies"));
    golden("toutatis.txt", &output("bodies toutatis --format table"));
    let list = output("bodies --format table");
    assert!(list.lines().all(|line| line.chars().count() <= 80), "{list}");
    refused("bodies toutati", &["'toutati': no such body", "'toutatis'"]);
}

/// A box of 40 g whose tensor is in g mm²: no matter is so light.
#[test]
fn a_suspicious_tensor_of_a_file_is_told_where_it_is_the_body() {
    let scratch = Scratch::new("compose-suspicious");
    let start = "--omega 0.3,1,0.4 --times 0 --fields energy";
    let link = "<link name='a'><inertial><mass value='0.04'/>\
                <inertia ixx='4333' iyy='3333' izz='1667' ixy='0' ixz='0' iyz='0'/></inertial></link>";
    let robot = scratch.file("a.urdf", format!("<robot name='r'>{link}</robot>"));
    let json = scratch.0.join("a.json").display().to_string();
    let written = run(&format!("inertia tensor 4333,3333,1667,0,0,0 --mass 0.04 --out {json}"));
    assert!(written.code == 0 && written.err.contains("g mm^2"), "{}", written.err);
    for (body, of) in [(&robot, " of 'a'"), (&json, "")] {
        let answer = run(&format!("propagate --body {body} {start}"));
        let says = format!("warning: --body: {body}{of}: its tensor is suspicious: implausible density: ");
        assert!(answer.code == 0 && answer.err.starts_with(&says), "{}", answer.err);
        assert!(answer.err.contains("; probable cause: in g mm^2, not in kg m^2"), "{}", answer.err);
    }
}

/// The file of parts in the help of `inertia` is one.
#[test]
fn the_parts_of_the_help_are_read() {
    let scratch = Scratch::new("parts");
    let help = output("inertia --help");
    let (_, rest) = help.split_once("  [[part]]\n").unwrap();
    let lines: Vec<&str> = rest.lines().take_while(|line| !line.trim().is_empty()).collect();
    scratch.file("parts.toml", format!("[[part]]\n{}\n", lines.join("\n")));
    let answer = polhode(&words("inertia parts parts.toml --format json"), &scratch.0);
    assert!(answer.code == 0 && answer.out.contains("\"mass\": 2.0"), "{}", answer.err);
}
