//! No command replaces a file that it reads, through whichever flag, link or spelling.

use std::fs;
use std::os::unix::fs::symlink;

use super::ensemble::EXACT;
use crate::harness::{Scratch, polhode, words};

const BODY: &str = "--moments 1,2,3 --omega 0.4,1,-0.3";

/// A trajectory, times, a body, a mesh and a robot, each under four names.
fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let line = format!("propagate {BODY} --until 20 --every 0.1 --fields t,q,omega --out run.csv");
    polhode(&words(&line), &scratch.0).silent(&line);
    polhode(&words("inertia box 1,2,3 --mass 2 --out body.json"), &scratch.0).silent("inertia");
    scratch.file("times.csv", "t\n0\n1\n");
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    scratch.file("mesh.obj", corners);
    let link = "<link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1.5\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>";
    scratch.file("robot.urdf", format!("<robot name=\"r\">{link}</robot>"));
    fs::create_dir(scratch.0.join("sub")).unwrap();
    for name in ["run.csv", "times.csv", "body.json", "mesh.obj", "robot.urdf"] {
        fs::hard_link(scratch.0.join(name), scratch.0.join(format!("hard-{name}"))).unwrap();
        symlink(name, scratch.0.join(format!("soft-{name}"))).unwrap();
    }
    scratch
}

#[test]
fn no_flag_replaces_an_input_under_any_of_its_names() {
    let scratch = scratch("own-input");
    let drawing = fs::read(scratch.0.join("run.csv")).unwrap();
    fs::write(scratch.0.join("run.svg"), drawing).unwrap();
    fs::write(scratch.0.join("run.html"), fs::read(scratch.0.join("run.csv")).unwrap()).unwrap();
    let flags = [
        ("audit run.csv --moments 1,2,3 --out", "run.csv"),
        ("propagate --moments 1,2,3 --omega 0.4,1,-0.3 --times times.csv --out", "times.csv"),
        ("propagate --body body.json --omega 0.4,1,-0.3 --times 0,1 --out", "body.json"),
        ("simulate --body body.json --omega 0.4,1,-0.3 --until 1 --every 0.1 --out", "body.json"),
        ("motion --body body.json --omega 0.4,1,-0.3 --format json --out", "body.json"),
        ("inertia mesh mesh.obj --mass 1 --format csv --out", "mesh.obj"),
        ("inertia urdf robot.urdf --out", "robot.urdf"),
        (
            "compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 20 --methods rk4 --steps 0.1 --trajectory run.csv --out",
            "run.csv",
        ),
        ("fit run.csv --out", "run.csv"),
    ];
    for (line, input) in flags {
        let before = fs::read(scratch.0.join(input)).unwrap();
        let absolute = scratch.0.join(input).display().to_string();
        for name in [
            input.to_string(),
            format!("./sub/../{input}"),
            absolute,
            format!("hard-{input}"),
            format!("soft-{input}"),
        ] {
            let line = format!("{line} {name}");
            let answer = polhode(&words(&line), &scratch.0);
            assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{line}: {}", answer.err);
            assert!(
                answer.err.contains(&format!("it would replace the input '{input}'")),
                "{line}: {}",
                answer.err
            );
            assert_eq!(fs::read(scratch.0.join(input)).unwrap(), before, "{line}");
        }
    }
    for line in [
        "audit run.csv --moments 1,2,3 --figure run.csv",
        "audit run.svg --moments 1,2,3 --figure run.svg",
        "audit run.html --moments 1,2,3 --report run.html",
        "fit run.svg --figure run.svg",
        "fit run.html --report run.html",
        "inertia urdf robot.urdf --repair .",
        "inertia urdf soft-robot.urdf --repair sub/..",
    ] {
        let before: Vec<_> = scratch.names().iter().map(|name| fs::read(scratch.0.join(name)).ok()).collect();
        let answer = polhode(&words(line), &scratch.0);
        assert_eq!(answer.code, 2, "{line}: {}", answer.err);
        let after: Vec<_> = scratch.names().iter().map(|name| fs::read(scratch.0.join(name)).ok()).collect();
        assert!(before == after, "{line}");
    }
}

#[test]
fn standard_input_from_a_file_is_an_input() {
    let scratch = scratch("own-standard-input");
    let before = fs::read(scratch.0.join("run.csv")).unwrap();
    let answer = std::process::Command::new(env!("CARGO_BIN_EXE_polhode"))
        .args(words("audit - --moments 1,2,3 --out run.csv"))
        .current_dir(&scratch.0)
        .stdin(fs::File::open(scratch.0.join("run.csv")).unwrap())
        .output()
        .unwrap();
    let told = String::from_utf8(answer.stderr).unwrap();
    assert_eq!(answer.status.code(), Some(2), "{told}");
    assert!(told.contains("it would replace the input 'standard input'"), "{told}");
    assert_eq!(fs::read(scratch.0.join("run.csv")).unwrap(), before);
}

#[test]
fn a_folder_of_results_that_holds_an_input_is_not_replaced() {
    let scratch = Scratch::new("own-folder");
    scratch.file("spec.toml", EXACT);
    let line = "ensemble spec.toml --out out";
    polhode(&words(line), &scratch.0).silent(line);
    let members = scratch.file("out/members.csv", "i1,i2,i3\n1,2,2.5\n1,2,2.6\n");
    let listed =
        "[start]\nomega = [0.1, 0.2, 5]\n[spread]\nmembers_file = \"out/members.csv\"\n[run]\ntimes = [2]\n";
    scratch.file("listed.toml", listed);
    scratch.file("out/spec.toml", EXACT.replace("seed = 7", "seed = 8"));
    symlink("out", scratch.0.join("link")).unwrap();
    for (line, input) in [
        ("ensemble listed.toml --out out --replace", "out/members.csv"),
        ("ensemble listed.toml --out link --replace", "out/members.csv"),
        ("ensemble out/spec.toml --out out --replace", "out/spec.toml"),
    ] {
        let answer = polhode(&words(line), &scratch.0);
        assert_eq!(answer.code, 2, "{line}: {}", answer.err);
        assert!(answer.err.contains(&format!("it holds the input '{input}'")), "{line}: {}", answer.err);
    }
    assert!(fs::metadata(members).is_ok());
    // the record of results is the program's own
    let other = "ensemble spec.toml --out other";
    polhode(&words(other), &scratch.0).silent(other);
    scratch.file("spec.toml", EXACT.replace("seed = 7", "seed = 9"));
    let other = "ensemble spec.toml --out other --replace";
    polhode(&words(other), &scratch.0).silent(other);
}

#[test]
fn two_outputs_of_one_command_are_two_files() {
    let scratch = Scratch::new("own-outputs");
    let body = "--moments 1,2,3";
    let start = format!("{body} --omega 0.4,1,-0.3");
    let line = format!("propagate {start} --until 5 --every 0.1 --fields t,q,omega --out run.csv");
    polhode(&words(&line), &scratch.0).silent(&line);
    for (line, first, second) in [
        (format!("audit run.csv {body} --report a.md --format csv --out ./a.md"), "--out", "--report"),
        (format!("audit run.csv {body} --figure a.svg --format csv --out a.svg"), "--out", "--figure"),
        (
            format!("compare {start} --until 1 --methods rk4 --steps 0.5 --figure a.svg --out a.svg"),
            "--out",
            "--figure",
        ),
        ("fit run.csv --residuals a.csv --out a.csv".into(), "--residuals", "--out"),
    ] {
        let answer = polhode(&words(&line), &scratch.0);
        let rule = format!("it would replace {second}");
        assert_eq!(answer.code, 2, "{line}: {}", answer.err);
        assert!(answer.err.contains(first) && answer.err.contains(&rule), "{line}: {}", answer.err);
        assert_eq!(scratch.names(), ["run.csv"], "{line}");
    }
    let line = format!("audit run.csv {body} --figure /dev/null --out /dev/null --format csv");
    assert!(!polhode(&words(&line), &scratch.0).err.contains("it would replace"));
}
