//! `polhode inertia` as its users meet it: golden values, golden refusals, formats that read each other.

use std::fmt::Write as _;

use crate::harness::{self, Answer, Scratch, names, polhode, refused};
use crate::robots::ROBOT;

impl Scratch {
    /// Runs `polhode inertia` in this folder.
    pub(crate) fn run(&self, line: &str) -> Answer {
        let arguments: Vec<&str> = std::iter::once("inertia").chain(line.split_whitespace()).collect();
        polhode(&arguments, &self.0)
    }

    /// The output of a run that has nothing to complain of.
    pub(crate) fn output(&self, line: &str) -> String {
        self.run(line).silent(line)
    }

    pub(crate) fn json(&self, line: &str) -> serde_json::Value {
        serde_json::from_str(&self.output(&format!("{line} --format json"))).unwrap()
    }
}

pub(crate) fn golden(name: &str, found: &str) {
    harness::golden(&format!("inertia/{name}"), found);
}

/// All numbers of a JSON value, in order.
pub(crate) fn numbers(value: &serde_json::Value) -> Vec<f64> {
    match value {
        serde_json::Value::Number(number) => vec![number.as_f64().unwrap()],
        serde_json::Value::Array(items) => items.iter().flat_map(numbers).collect(),
        _ => Vec::new(),
    }
}

pub(crate) const OBJ_CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// A tetrahedron with three edges along the axes.
fn binary_stl() -> Vec<u8> {
    let [o, x, y, z] = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes = vec![b' '; 80];
    bytes.extend(4_u32.to_le_bytes());
    for corners in [[o, y, x], [o, x, z], [o, z, y], [x, y, z]] {
        bytes.extend([0; 12]);
        corners.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const HAMMER: &str = "\
# lengths in m, masses in kg
name = \"hammer\"

[[part]]
name = \"handle\"
shape = \"cylinder\"
size = [0.015, 0.25]
density = 700
at = [0, 0, 0.125]

[[part]]
name = \"head\"
shape = \"box\"
size = [0.125, 0.03125, 0.03125]
mass = 1
at = [0, 0, 0.265625]
turn = [2, 0, 0, 1.0]

[[part]]
shape = \"point\"
mass = 0.0625
at = [0, 0.25, 0]

[[part]]
shape = \"tensor\"
mass = 0.5
inertia = [1e-3, 2e-3, 1.5e-3, -1e-4, 0, 2e-4]
at = [0.5, 0, 0]

[[part]]
shape = \"mesh\"
file = \"cube.obj\"
length_unit = 0.125
density = 256
";

fn workshop(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.file("cube.obj", OBJ_CUBE);
    scratch.file("corner.stl", binary_stl());
    scratch.file("hammer.toml", HAMMER);
    scratch
}

#[test]
fn every_shape_is_golden() {
    let scratch = Scratch::new("shapes");
    let shapes = [
        "box 1,2,3",
        "ellipsoid 1,2,3",
        "sphere 2",
        "shell 2",
        "cylinder 1,2",
        "tube 1,2,3",
        "cone 1,2",
        "torus 2,0.5",
        "rod 3",
        "disk 2",
        "plate 1,2",
        "hoop 2",
    ];
    let mut rows = String::new();
    for shape in shapes {
        for amount in ["--mass 120", "--density 3"] {
            let text = scratch.output(&format!("{shape} {amount}"));
            let (head, row) = text.split_once('\n').unwrap();
            if rows.is_empty() {
                writeln!(rows, "{head}").unwrap();
            }
            write!(rows, "{shape} {amount}: {row}").unwrap();
        }
    }
    golden("shapes.txt", &rows);
    // what a reader can check by heart
    let moments = |line: &str| numbers(&scratch.json(line)["principal_moments"]);
    assert_eq!(moments("box 1,2,3 --mass 12"), [5.0, 10.0, 13.0]);
    assert_eq!(moments("sphere 2 --mass 5"), [8.0, 8.0, 8.0]);
    assert_eq!(moments("cylinder 2,3 --mass 8"), [14.0, 14.0, 16.0]);
    assert_eq!(moments("rod 6 --mass 1"), [0.0, 3.0, 3.0]);
    assert_eq!(moments("hoop 2 --mass 1"), [2.0, 2.0, 4.0]);
}

#[test]
fn the_box_of_a_tiny_mass_has_edges_or_is_left_out() {
    let scratch = workshop("box");
    let said = |mass: &str| scratch.run(&format!("tensor 1.5,0.6,0.05,0,0,0 --mass {mass}")).err;
    let found = said("1e-310");
    assert!(found.contains("box of that inertia: ") && found.contains("e155 x "), "{found}");
    assert!(!found.contains("inf") && !said("5e-324").contains("inf"), "{found}");
}

#[test]
fn json_and_table_are_golden() {
    let scratch = workshop("golden");
    golden("box.json", &scratch.output("box 1,2,3 --mass 12 --format json"));
    let text = scratch.output("disk 1 --mass 2 --about 1,2,3 --format table");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    golden("disk.txt", &text);
    golden("corner.json", &scratch.output("mesh corner.stl --density 6 --format json"));
    golden("hammer.json", &scratch.output("parts hammer.toml --format json"));
    golden("tensor.json", &scratch.output("tensor 2,2,3,-0.25,0.125,0.5 --format json"));
    let answer = scratch
        .run("tensor 15,12,7,-2,-3,-6 --mass 1 --center-of-mass 1,2,3 --given-about 0,0,0 --format json");
    assert!(answer.code == 0 && answer.err.starts_with("warning: the tensor: implausible density"));
    golden("point.json", &answer.out);
}

#[test]
fn the_keys_of_the_conventions_are_there() {
    let scratch = Scratch::new("keys");
    let body = scratch.json("plate 1,2 --mass 3");
    assert_eq!(body["mass"], 3.0);
    let length = |key: &str| numbers(&body[key]).len();
    assert_eq!(
        ["center_of_mass", "inertia", "principal_moments", "axes", "triangle_margins"].map(length),
        [3, 9, 3, 4, 3]
    );
    assert_eq!(body["class"], "planar");
    assert_eq!(body["triangle_margins"][2], 0.0);
    assert_eq!(body["sign"], "I_xy = -int x y dm");
    assert!(scratch.json("tensor 1,2,2,0,0,0")["mass"].is_null());
}

/// A thousand times the length makes a body lighter than air by far, and a thousand times the mass one denser than osmium; flat bodies
/// and stated densities have nothing to tell.
#[test]
fn shapes_and_meshes_in_another_unit_are_told_by_their_density() {
    let scratch = workshop("weighed");
    for (line, says) in [
        ("box 0.1,0.2,0.3 --mass 2", None),
        ("box 100,200,300 --mass 2", Some("air has 1.2")),
        ("box 0.1,0.2,0.3 --mass 2000", Some("osmium has 22590")),
        ("sphere 0.05 --density 0.01", None),
        ("plate 100,200 --mass 2", None),
        ("rod 1000 --mass 2", None),
        ("mesh corner.stl --mass 2", None),
        ("mesh corner.stl --mass 0.002", Some("air has 1.2")),
        ("mesh corner.stl --mass 0.002 --length-unit cm", None),
        ("mesh corner.stl --mass 0.002 --length-unit mm", Some("osmium has 22590")),
    ] {
        let answer = scratch.run(line);
        assert_eq!(answer.code, 0, "{line}: {}", answer.err);
        let told = answer.err.contains("warning: ") && answer.err.contains("implausible density");
        assert_eq!(told, says.is_some(), "{line}: {}", answer.err);
        assert!(answer.err.contains(says.unwrap_or_default()), "{line}: {}", answer.err);
    }
}

#[test]
fn walls_thicker_than_the_body_are_refused() {
    let scratch = workshop("walls");
    let answer = scratch.run("mesh cube.obj --length-unit mm --density 3 --shell 1");
    assert_eq!(answer.code, 2, "{}", answer.err);
    for part in ["--shell: '1'", "walls of m", "0.001 m long", "0.001 for 1 mm"] {
        assert!(answer.err.contains(part), "{part}: {}", answer.err);
    }
    let thin = scratch.json("mesh cube.obj --length-unit mm --density 3 --shell 1e-5");
    assert!((numbers(&thin["mass"])[0] / (6e-6 * 3e-5) - 1.0).abs() < 1e-12);
}

#[test]
fn meshes_in_any_unit_are_the_solids() {
    let scratch = workshop("meshes");
    let millimetres = OBJ_CUBE.replace(" 1", " 1000").replace("f 1000", "f 1");
    let vertices: String =
        millimetres.lines().filter(|line| line.starts_with('v')).fold(String::new(), |a, l| a + l + "\n");
    let faces: String =
        OBJ_CUBE.lines().filter(|line| line.starts_with('f')).fold(String::new(), |a, l| a + l + "\n");
    scratch.file("mm.obj", vertices + &faces);
    let solid = scratch.json("box 1,1,1 --density 3");
    for line in
        ["mesh cube.obj --density 3", "mesh mm.obj --length-unit 0.001 --density 3", "mesh cube.obj --mass 3"]
    {
        let mesh = scratch.json(line);
        assert_eq!(numbers(&mesh["center_of_mass"]), [0.5; 3], "{line}");
        for key in ["mass", "inertia"] {
            for (a, b) in numbers(&mesh[key]).into_iter().zip(numbers(&solid[key])) {
                assert!((a - b).abs() < 1e-15, "{line}: {key} {a} {b}");
            }
        }
    }
}

#[test]
fn every_format_is_read_back_to_twelve_digits_and_names_its_sign() {
    let scratch = workshop("formats");
    let start = scratch.json("parts hammer.toml");
    for (form, ending, reader) in [
        ("urdf", "urdf", "urdf"),
        ("mjcf", "xml", "mjcf"),
        ("mjcf-diagonal", "xml", "mjcf"),
        ("toml", "toml", "parts"),
        ("json", "json", "json"),
    ] {
        let text = scratch.output(&format!("parts hammer.toml --format {form}"));
        assert!(text.contains("I_xy = -int x y dm"), "{text}");
        golden(&format!("hammer.{form}"), &text);
        let name = format!("{form}.{ending}");
        scratch.file(&name, &text);
        let back = scratch.json(&format!("{reader} {name}"));
        for key in ["mass", "center_of_mass", "inertia", "principal_moments"] {
            let (found, expected) = (numbers(&back[key]), numbers(&start[key]));
            let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-14 * largest, "{form} {key}: {a} {b}");
            }
            assert_eq!(found.len(), expected.len());
        }
    }
}

#[test]
fn the_doctor_is_golden() {
    let scratch = Scratch::new("doctor");
    let mut text = String::new();
    for line in [
        "tensor 1,1,3,0,0,0",
        "tensor 0.75,0.75,0.75,0.3125,0.3125,0.3125",
        "tensor 1250,4250,5000,0,0,0 --mass 1.25 --extents 0.2,0.1,0.05",
        "tensor 0.25,-0.5,0.5,0,0,0 --mass 3",
        "tensor 1,1,1,0,0,0 --mass 2 --center-of-mass 3,0,0 --given-about 0,0,0",
    ] {
        let answer = scratch.run(line);
        assert_eq!(answer.code, 1, "{line}");
        writeln!(text, "$ polhode inertia {line}\n{}", answer.err).unwrap();
    }
    golden("doctor.txt", &text);
    golden("doctor.json", &scratch.run("tensor 1,1,3,0,0,0 --format json").out);
    let answer = scratch.run("tensor 1250,4250,5000,0,0,0 --mass 1.25");
    assert_eq!(answer.code, 0, "valid, though hardly of 1.25 kg");
    let (head, rest) = answer.err.split_once('\n').unwrap();
    assert!(
        head.starts_with("warning: the tensor: implausible density: ") && head.ends_with("air has 1.2"),
        "{head}"
    );
    assert!(rest.starts_with("  cause 1: in kg mm^2"), "{rest}");
    // thin bodies are well
    for line in ["tensor 1,2,3,0,0,0", "tensor 0,1,1,0,0,0", "tensor 0.1,0.2,0.30000000000000004,0,0,0"] {
        assert!(scratch.output(line).contains(",valid,"), "{line}");
    }
}

#[test]
fn refusals_are_golden() {
    let scratch = workshop("refusals");
    let stl = binary_stl();
    scratch.file("short.stl", &stl[..200]);
    scratch.file("header.stl", &stl[..50]);
    scratch.file("long.stl", [&stl[..], b"\n"].concat());
    scratch.file("ascii.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n");
    scratch.file("words.stl", "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n");
    scratch.file("open.obj", OBJ_CUBE.replace("f 5 6 7 8\n", ""));
    scratch.file("index.obj", OBJ_CUBE.replace("f 5 6 7 8", "f 5 6 7 9"));
    scratch.file("cube.ply", "ply");
    let toml = |name: &str, from: &str, to: &str| scratch.file(name, HAMMER.replacen(from, to, 1));
    toml("syntax.toml", "size = [0.015, 0.25]", "size = [0.015, 0.25");
    toml("key.toml", "density = 700", "densty = 700");
    toml("shape.toml", "\"cylinder\"", "\"cylindre\"");
    toml("missing.toml", "density = 700\n", "");
    toml("both.toml", "density = 700", "density = 700\nmass = 1");
    toml("negative.toml", "mass = 1\n", "mass = -1\n");
    toml("zero.toml", "[0.015, 0.25]", "[0.015, 0]");
    toml("count.toml", "[0.015, 0.25]", "[0.015, 0.25, 1]");
    toml("type.toml", "at = [0, 0, 0.125]", "at = [0, 0, \"up\"]");
    toml("point.toml", "mass = 0.0625", "mass = 0.0625\nsize = 1");
    toml("law.toml", "[1e-3, 2e-3, 1.5e-3", "[1e-3, 2e-3, 1.5e-2");
    toml("mesh.toml", "cube.obj", "open.obj");
    toml("turn.toml", "[2, 0, 0, 1.0]", "[0, 0, 0, 0]");
    scratch.file("empty.toml", "name = \"nothing\"\n");
    scratch.file("broken.urdf", ROBOT.replace("</robot>", ""));
    scratch.file("page.urdf", "<html><body/></html>");
    scratch.file("entity.urdf", format!("<!DOCTYPE robot [<!ENTITY m \"1\">]>\n{ROBOT}"));
    scratch.file("other.sdf", ROBOT);
    scratch.file("skew.json", "{\"mass\": 1, \"inertia\": [[2, 0.5, 0], [0.25, 2, 0], [0, 0, 3]]}");
    scratch.file("keys.json", "{\"mass\": 1}");
    scratch.file(
        "massless.json",
        "{\"name\": \"arm\", \"mass\": null, \"inertia\": [[2, 0, 0], [0, 2, 0], [0, 0, 3]]}",
    );
    let before: Vec<_> = names(&scratch.0);
    let lines = [
        "bax 1,2,3 --mass 1",
        "dodecahedron 1 --mass 1",
        "box 1,2 --mass 1",
        "box 1,2,x --mass 1",
        "box 1,0,3 --mass 1",
        "box 1,-2,3 --mass 1",
        "box 1,2,3 --mass -1",
        "box 1,2,3 --mass 0",
        "box 1,2,3 --density nan",
        "box 1,2,3",
        "box 1,2,3 --mass 1 --density 1",
        "box 1,2,3 --mass 1 --extents 1,2,3",
        "sphere 1e200 --mass 1",
        "tube 2,1,3 --mass 1",
        "torus 1,2 --mass 1",
        "tensor 1,2,3",
        "tensor 2,0.5,0,0.25,2,0,0,0,3",
        "tensor 1,2,inf,0,0,0",
        "tensor 1,2,3,0,0,0 --mass -1",
        "tensor 1,2,3,0,0,0 --density 1",
        "tensor 1,2,3,0,0,0 --about 1,0,0",
        "tensor 1,2,3,0,0,0 --given-about 1,0,0",
        "tensor 1,2,3,0,0,0 --format urdf",
        "tensor 1,2,3,0,0,0 --format mjcf-diagonal",
        "tensor 1,2,3,0,0,0 --mass 1 --about 1e155,0,0",
        "tensor 1,2,3,0,0,0 --mass 1 --given-about 1e155,0,0",
        "json massless.json --format toml",
        "tensor 1,2,3,0,0,0 --extents 1,0,1",
        "mesh nowhere.stl --mass 1",
        "mesh cube.ply --mass 1",
        "mesh cube.obj",
        "mesh short.stl --mass 1",
        "mesh header.stl --mass 1",
        "mesh long.stl --mass 1",
        "mesh ascii.stl --mass 1",
        "mesh words.stl --mass 1",
        "mesh open.obj --mass 1",
        "mesh index.obj --mass 1",
        "parts nowhere.toml",
        "parts hammer.toml --mass 1",
        "parts syntax.toml",
        "parts key.toml",
        "parts shape.toml",
        "parts missing.toml",
        "parts both.toml",
        "parts negative.toml",
        "parts zero.toml",
        "parts count.toml",
        "parts type.toml",
        "parts point.toml",
        "parts law.toml",
        "parts mesh.toml",
        "parts turn.toml",
        "parts empty.toml",
        "urdf broken.urdf",
        "urdf page.urdf",
        "urdf entity.urdf",
        "urdf nowhere.urdf",
        "urdf page.urdf --density 1",
        "urdf page.urdf --length-unit mm",
        "urdf page.urdf --root .",
        "sdf other.sdf",
        "box 1,2,3 4 --mass 1",
        "box 1,2,3 --mass 1 --details",
        "box 1,2,3 --mass 1 --repair copies",
        "mesh cube.obj --mass 1 --length-unit furlong",
        "mesh cube.obj --mass 1 --group lid",
        "json skew.json",
        "json keys.json",
    ];
    let mut text = String::new();
    for line in lines {
        for out in ["", " --out result.json"] {
            let answer = scratch.run(&format!("{line}{out}"));
            assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{line}: {}", answer.err);
            assert!(answer.err.starts_with("error: "), "{line}: {}", answer.err);
            if out.is_empty() {
                writeln!(text, "$ polhode inertia {line}\n{}", answer.err).unwrap();
            }
        }
    }
    golden("refusals.txt", &text);
    assert_eq!(names(&scratch.0), before, "something was written");
}

#[test]
fn a_tensor_of_zeros_is_no_body() {
    let scratch = Scratch::new("zero");
    scratch.file("point.toml", "[[part]]\nshape = \"point\"\nmass = 1\n");
    for line in ["tensor 0,0,0,0,-0,0 --mass 1", "parts point.toml"] {
        let answer = scratch.run(&format!("{line} --format json"));
        assert_eq!(answer.code, 1, "{line}");
        assert!(answer.err.starts_with("error: the tensor: every entry of the tensor is zero"), "{answer:?}");
        let body: serde_json::Value = serde_json::from_str(&answer.out).unwrap();
        assert_eq!((&body["verdict"], &body["class"]), (&"invalid".into(), &"none".into()), "{line}");
        for model in ["urdf", "mjcf", "mjcf-diagonal", "toml"] {
            let answer = scratch.run(&format!("{line} --format {model}"));
            assert_eq!((answer.code, answer.out.as_str()), (1, ""), "{line}");
        }
    }
}

#[test]
fn a_quaternion_of_any_norm_is_a_turn() {
    let scratch = Scratch::new("norms");
    let inertia = |line: &str| numbers(&scratch.json(line)["inertia"]);
    let mut found = Vec::new();
    for scale in ["1", "1e-200", "1e200", "5e-324"] {
        let turn = format!("quat=\"{scale} 0 0 {scale}\"");
        let model = format!("<inertial pos=\"0 0 0\" {turn} mass=\"100\" diaginertia=\"1 1.5 2\"/>");
        scratch.file("model.xml", model);
        let part = format!(
            "[[part]]\nshape = \"tensor\"\nmass = 1\ninertia = [1, 1.5, 2, 0, 0, 0]\nturn = [{scale}, 0, 0, {scale}]\n"
        );
        scratch.file("part.toml", part);
        found.push(inertia("mjcf model.xml"));
        found.push(inertia("parts part.toml"));
    }
    for (k, expected) in [1.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0].into_iter().enumerate() {
        assert!((found[0][k] - expected).abs() < 1e-15, "{found:?}");
    }
    assert!(found.iter().all(|tensor| *tensor == found[0]), "{found:?}");
}

#[test]
fn no_number_is_written_out_to_hundreds_of_digits() {
    let scratch = Scratch::new("digits");
    for (line, expected) in [
        ("tensor 1e-320,1e-320,1e-319,0,0,0", 2),
        ("tensor 5e-324,5e-324,1e-322,0,0,0", 2),
        ("tensor 1e300,1e300,3e300,0,0,0 --mass 1", 2),
        ("tensor 1e100,1e100,3e100,0,0,0 --mass 1", 1),
        ("sphere 1e-170 --mass 1", 2),
    ] {
        let Answer { code, out, err, .. } = scratch.run(line);
        assert_eq!(code, expected, "{line}: {err}");
        let mut runs = [&out, &err].into_iter().flat_map(|text| text.split(|c: char| !c.is_ascii_digit()));
        assert!(!runs.any(|digits| digits.len() > 25), "{line}: {out} {err}");
        assert!(!err.contains("inf %") && !err.contains("NaN"), "{line}: {err}");
    }
}

#[test]
fn what_a_terminal_would_obey_is_written_out() {
    let scratch = Scratch::new("terminal");
    let name = "\u{1b}]0;arm\u{7}\u{9b}2J\u{202e}gpj\n";
    let body = |inertia: &str| {
        let name = serde_json::to_string(name).unwrap();
        format!("{{\"name\": {name}, \"mass\": 10, \"inertia\": {inertia}}}")
    };
    scratch.file("valid.json", body("[[1, 0, 0], [0, 1, 0], [0, 0, 1.5]]"));
    scratch.file("invalid.json", body("[[1, 0, 0], [0, 1, 0], [0, 0, 3]]"));
    scratch.file("skew.json", body("[[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]"));
    scratch.file("title.stl", "solid s\n\u{1b}]0;title\u{7}\n");
    scratch.file("key.toml", "[[part]]\n\"\\u001b[2J\" = 1\n");
    scratch.file("shape.toml", "[[part]]\nshape = \"\\u202e\"\n");
    scratch.file("name.urdf", ROBOT.replace("\"arm\"", "\"\u{202e}\u{9b}\""));
    let obeyed = |c: char| c != '\n' && (c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c));
    for line in [
        "json valid.json --format table",
        "json valid.json --format csv",
        "json valid.json --format json",
        "json valid.json --format urdf",
        "json valid.json --format mjcf",
        "json valid.json --format toml",
        "json invalid.json",
        "json skew.json",
        "mesh title.stl --mass 1",
        "parts key.toml",
        "parts shape.toml",
        "urdf name.urdf",
    ] {
        let Answer { code, out, err, .. } = scratch.run(line);
        assert!(!out.contains(obeyed) && !err.contains(obeyed), "{line}: {out:?} {err:?}");
        assert!((code == 0) == line.contains("valid.json --format"), "{line}: {err}");
        assert!(format!("{out}{err}").contains("\\u"), "{line}: {out:?} {err:?}");
    }
    // a line of its own would look like one of ours
    assert_eq!(scratch.run("json skew.json").err.lines().count(), 1);
    let read_back: serde_json::Value =
        serde_json::from_str(&scratch.output("json valid.json --format json")).unwrap();
    assert_eq!(read_back["name"], name);
    scratch.file("back.toml", scratch.output("json valid.json --format toml"));
    assert!(scratch.output("parts back.toml").contains(",valid,"));
}

#[test]
fn elements_of_a_ply_that_cannot_be_there_are_refused_at_once() {
    let scratch = Scratch::new("inertia-ply");
    let head = |encoding: &str, elements: &str| format!("ply\nformat {encoding} 1.0\n{elements}end_header\n");
    let vertex = "property float x\nproperty float y\nproperty float z\n";
    for (name, text, says) in [
        (
            "junk",
            head("ascii", "element junk 18446744073709551615\n"),
            "PLY announces 18446744073709551615 of element junk, which has no properties",
        ),
        (
            "many",
            head("ascii", &"element a 4000000000\n".repeat(100)),
            "4000000000 of element a, which has no",
        ),
        (
            "vertices",
            head("binary_little_endian", &format!("element vertex 4000000000\n{vertex}")),
            "take 48000000000 bytes or more, and 0 follow the header",
        ),
        (
            "text",
            head("ascii", &format!("element vertex 1000\n{vertex}")) + "0 0 0\n",
            "take 6000 bytes or more, and 6 follow the header",
        ),
        (
            "overflow",
            head("binary_big_endian", &format!("element vertex {}\n{vertex}", u64::MAX)),
            "take 18446744073709551615 bytes or more",
        ),
    ] {
        let path = scratch.file(&format!("{name}.ply"), text);
        refused(&format!("inertia mesh {path} --mass 1"), &[says]);
    }
}
