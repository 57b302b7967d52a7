//! Command lines and files that were spoilt at random: an answer or a refusal within seconds, no panic, nothing but numbers.
//!
//! `POLHODE_HOSTILE` asks for another number of command lines; a few hundred, as the tests run, do not see what happens once in
//! a thousand. `POLHODE_HOSTILE_SEED` asks for others.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use polhode::num::Random;

use crate::ensemble::EXACT;
use crate::harness::{Scratch, words};

/// No answer takes longer, unless the command has said what its run costs.
const LONGEST: Duration = Duration::from_secs(10);

/// Good command lines, of which each word may be spoilt.
const LINES: &[&str] = &[
    "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --times 0,10,1e3",
    "propagate --body toutatis --until 30d --every 6h --fields t,q,omega",
    "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 10 --every 1 --method rk4 --step 0.1",
    "propagate --body phone --omega 0,10,1 --until 1 --every 0.5 --drag 1e-5 --method dop853 --tolerance 1e-9",
    "propagate --inertia 2,3,4,0.1,0.2,0.3 --momentum-space 1,2,3 --times t.csv --euler zyx --format json",
    "propagate --body gyroscope --until 1 --every 0.1 --weight-moment 0,0,0.04 --method exact",
    "motion --moments 0.61,0.965,1 --periods 27.38h,263h --mode sam --pole 250,-75 --phases 152,14 --angle-unit deg",
    "motion --body box.toml --omega 0.3,5,0.2 --format json",
    "compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 5 --methods rk4,lie-poisson --steps 0.1",
    "compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 5 --methods rk4 --steps 0.5 --trajectory run.csv",
    "audit run.csv --moments 1,2,3 --tolerance 1e-6 --format json",
    "audit run.csv --moments 1,2,3 --noise 1e-3,1e-3 --quaternion wxyz --attitude body-to-space",
    "audit bare.csv --columns t=1,qw=2,qx=3,qy=4,qz=5,wx=6,wy=7,wz=8 --sample-rate 20",
    "audit dump.txt --moments 0.05,0.068,0.082 --id 1 --time-unit 0.01",
    "fit rates.csv --torque none --format json",
    "fit rates.csv --rate-unit deg/s --prior-shape 0.05 --columns t=t,wx=wx,wy=wy,wz=wz",
    "attitude rates.csv --kind rate --order auto --bias 1e-4 --format json",
    "attitude rates.csv --kind increment --rule two-speed --start 1,0.1,0,0 --euler zyx",
    "attitude rates.csv --kind rate --samples 6 --body box.toml --against run.csv --noise 1e-3",
    "simulate --moments 1,2,3 --omega 0.4,1,-0.3 --until 10 --every 0.1 --noise 1e-3 --seed 7",
    "inertia box 0.3,0.2,0.1 --mass 2",
    "inertia mesh part.obj --density 1000",
    "inertia mesh part.stl --mass 1",
    "inertia check robot.urdf --format json",
    "inertia check robot.xml",
    "ensemble spec.toml --out ensemble",
    "plot polhode --moments 1,2,3 --omega 0.4,1,-0.3 --out picture.svg",
    "plot omega --body t-handle --until 5 --out picture.png",
    "show --moments 1,2,3 --omega 0.4,1,-0.3 --until 5 --against rk4:0.1 --against run.csv --out page.html",
    "advise --moments 1,2,3 --omega 0.4,1,-0.3 --until 10 --attitude-error 1e-3",
    "methods --schemes",
    "bodies toutatis",
];

/// Words that stand where a number or a name was.
const WORDS: &[&str] = &[
    "",
    "-",
    "--",
    "0",
    "-0",
    "-1",
    "1e999",
    "-1e308",
    "1e308",
    "1e154",
    "1e-308",
    "5e-324",
    "1e-160",
    "nan",
    "inf",
    "-inf",
    "0x10",
    "1e",
    "1,",
    ",1",
    "1,2",
    "1,2,3,4",
    "1,1,1",
    "0,0,0",
    "1,2,3",
    "1e300,1,1",
    "1e-300,1,1",
    "1,1,1e9",
    "1,2,4",
    "99999999999999999999",
    "1h",
    "-5d",
    "1e9d",
    "2448936",
    "1992-13-45",
    "1992-11-09T17:49:47",
    "exact",
    "rk4",
    "lie-poisson:321@kahan-li-6",
    "taylor",
    "gauss:99",
    "rk4:1e-9",
    "@",
    ":",
    "dmv:10",
    "json",
    "zxz",
    "xyz:extrinsic",
    "deg",
    "rpm",
    "µs",
    "🙂",
    "a\u{0}b",
    "..",
    "/",
    "/dev/null",
    "run.csv",
    "missing.csv",
    "spec.toml",
    "robot.urdf:a",
    "t=1,wx=1,wy=1,wz=1",
    "--help",
    "--omega",
    "--until",
    "--step",
    "--seed",
];

/// Text that stands where a piece of a file was.
const PIECES: &[&str] = &[
    "",
    ",",
    ";",
    "\t",
    "\n",
    "\r",
    "\n\n\n",
    "\"",
    "'",
    "nan",
    "inf",
    "-1",
    "0",
    "1e999",
    "1e308",
    "1e-320",
    "<",
    "</link>",
    "<!--",
    "&amp;",
    "&#0;",
    "]]>",
    "{",
    "[[",
    "}",
    "=",
    "ITEM: ATOMS id",
    "ITEM: TIMESTEP",
    "ITEM: NUMBER OF ATOMS\n99999999999",
    "18446744073709551616",
    "\u{feff}",
    "é",
    "#",
    "facet normal",
    "f 1 2 3",
    "f 1 1 999999999",
    "v 1e300 0 0",
    "members = 1e18",
    "element face 99999999999",
];

struct Draw(Random);

impl Draw {
    fn below(&mut self, count: usize) -> usize {
        self.0.below(count as u64) as usize
    }

    fn of<'a>(&mut self, choices: &[&'a str]) -> &'a str {
        choices[self.below(choices.len())]
    }
}

/// Files that the lines name.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let output = |line: &str| crate::harness::run(line).out;
    let run = output(
        "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 5 --every 0.05 --fields t,q,omega --format csv",
    );
    let rates =
        output("simulate --moments 1,2,3 --omega 0.4,1,-0.3 --until 20 --every 0.1 --noise 1e-3 --seed 7");
    let rows: Vec<&str> = run.lines().skip(1).collect();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/programs/lammps-digits.dump");
    let link = |name: &str| {
        format!(
            "<link name=\"{name}\"><inertial><origin xyz=\"0 0 0.1\" rpy=\"0 0.1 0\"/><mass value=\"2\"/>\
             <inertia ixx=\"1\" iyy=\"2\" izz=\"2.5\" ixy=\"0.1\" ixz=\"0\" iyz=\"0\"/></inertial></link>"
        )
    };
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let facet = |v: [[u8; 3]; 3]| {
        let corners = v.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let (o, x, y, z) = ([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]);
    let facets = [facet([o, y, x]), facet([o, x, z]), facet([o, z, y]), facet([x, y, z])].concat();
    vec![
        ("bare.csv", rows.join("\n").into()),
        ("box.toml", "[[part]]\nshape = \"box\"\nsize = [0.3, 0.2, 0.1]\nmass = 2.0\n".into()),
        ("dump.txt", fs::read(data).unwrap()[..8000].to_vec()),
        ("part.obj", tetrahedron.into()),
        ("part.stl", format!("solid a\n{facets}endsolid a\n").into()),
        ("rates.csv", rates.into()),
        ("robot.urdf", format!("<robot name=\"a\">{}{}</robot>", link("a"), link("b")).into()),
        (
            "robot.xml",
            "<mujoco><worldbody><body name=\"a\"><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 2 2.5\"/>\
             <geom type=\"box\" size=\"1 2 3\"/></body></worldbody></mujoco>"
                .into(),
        ),
        ("run.csv", run.into()),
        (
            "spec.toml",
EXACT.replace("members = 301", "members = 20")
                .into(),
        ),
        ("t.csv", "t\n0\n1\n2.5\n".into()),
    ]
}

/// A line with one to three words changed, left out, doubled or exchanged.
fn spoilt_line(draw: &mut Draw) -> Vec<String> {
    let mut line: Vec<String> = words(draw.of(LINES)).into_iter().map(String::from).collect();
    for _ in 0..draw.below(4) {
        let (k, other) = (draw.below(line.len()), draw.below(line.len()));
        match draw.below(8) {
            0 => drop(line.remove(k)),
            1 => line.insert(other, line[k].clone()),
            2 => line.swap(k, other),
            3 => line.insert(k, draw.of(WORDS).to_string()),
            4 if line[k].contains(',') => {
                let mut parts: Vec<&str> = line[k].split(',').collect();
                let n = draw.below(parts.len());
                parts[n] = draw.of(WORDS);
                line[k] = parts.join(",");
            }
            _ if k > 0 => line[k] = draw.of(WORDS).to_string(),
            _ => {}
        }
        if line.is_empty() {
            break;
        }
    }
    // no shell and no system can hand over such a word
    line.iter_mut().for_each(|word| word.retain(|c| c != '\0'));
    line
}

/// Bytes with pieces changed, left out or doubled.
fn spoilt(draw: &mut Draw, mut bytes: Vec<u8>) -> Vec<u8> {
    for _ in 0..1 + draw.below(3) {
        let at = draw.below(bytes.len().max(1)).min(bytes.len());
        let length = draw.below(40).min(bytes.len() - at);
        match draw.below(7) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..at + length)),
            2 => {
                let piece = bytes[at..at + length].to_vec();
                let count = 1 + draw.below(200);
                bytes.splice(at..at, piece.repeat(count));
            }
            3 if at < bytes.len() => bytes[at] = draw.below(256) as u8,
            _ => drop(bytes.splice(at..at + length.min(6), draw.of(PIECES).bytes())),
        }
    }
    bytes
}

/// How a command ended, or why it must not have.
fn ending(mut child: Child, folder: &Path, line: &[String]) -> Result<&'static str, String> {
    let start = Instant::now();
    let status = loop {
        match child.try_wait().unwrap() {
            Some(status) => break Some(status),
            None if start.elapsed() > LONGEST => break None,
            None => std::thread::sleep(Duration::from_millis(2)),
        }
    };
    let read = |name: &str| String::from_utf8(fs::read(folder.join(name)).unwrap());
    let Some(status) = status else {
        let _ = child.kill();
        let _ = child.wait();
        let told = read("err").unwrap_or_default();
        let written = fs::metadata(folder.join("out")).unwrap().len();
        let announced = told.contains("take about") || written > 1 << 20;
        return if announced {
            Ok("long, as said, or many rows")
        } else {
            Err(format!("no answer within {LONGEST:?}: {told}"))
        };
    };
    let (out, told) = match (read("out"), read("err")) {
        (Ok(out), Ok(told)) => (out, told),
        // a picture
        (Err(_), Ok(told)) => (String::new(), told),
        _ => return Err("what it says is no text".into()),
    };
    if told.contains("panicked") || told.contains("overflow its stack") {
        return Err(told);
    }
    // names that were given are said again
    let out = line
        .iter()
        .filter(|word| word.contains("inf") || word.contains("nan"))
        .fold(out, |out, word| out.replace(word, ""));
    let mut cells = out.split(|c: char| !c.is_ascii_alphanumeric());
    if let Some(cell) = cells.find(|word| ["NaN", "nan", "inf"].contains(word)) {
        return Err(format!("it prints {cell}: {}", out.chars().take(2000).collect::<String>()));
    }
    match status.code() {
        Some(0) => Ok("answered"),
        Some(1) if !told.is_empty() => Ok("failed with a verdict"),
        Some(2) if told.contains("error") => Ok("refused"),
        code => Err(format!("exit code {code:?}: {told}")),
    }
}

#[test]
fn spoilt_command_lines_and_files_are_answered_or_refused() {
    let number =
        |name: &str, otherwise: u64| std::env::var(name).map_or(otherwise, |text| text.parse().unwrap());
    let random = Random::new(number("POLHODE_HOSTILE_SEED", 1));
    let scratch = Scratch::new("hostile");
    let good = files();
    let mut counts: BTreeMap<(String, &str), u64> = BTreeMap::new();
    let mut faults = Vec::new();
    for n in 0..number("POLHODE_HOSTILE", 250) {
        let mut draw = Draw(random.stream(n));
        let line = spoilt_line(&mut draw);
        let spoils_files = draw.below(2) == 0;
        for (name, bytes) in &good {
            let is_named = line.iter().any(|word| word.contains(name));
            let bytes =
                if spoils_files && is_named { spoilt(&mut draw, bytes.clone()) } else { bytes.clone() };
            fs::write(scratch.0.join(name), bytes).unwrap();
        }
        let file = |name: &str| Stdio::from(File::create(scratch.0.join(name)).unwrap());
        let child = Command::new(env!("CARGO_BIN_EXE_polhode"))
            .args(&line)
            .current_dir(&scratch.0)
            .stdin(Stdio::null())
            .stdout(file("out"))
            .stderr(file("err"))
            .spawn()
            .unwrap();
        match ending(child, &scratch.0, &line) {
            Ok(what) => *counts.entry((line.first().cloned().unwrap_or_default(), what)).or_default() += 1,
            Err(what) => faults.push(format!("{n}: {line:?} (spoilt files: {spoils_files}): {what}")),
        }
    }
    let shown: Vec<String> =
        counts.iter().map(|((command, what), count)| format!("{command} {what}: {count}")).collect();
    println!("{}", shown.join("\n"));
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}
