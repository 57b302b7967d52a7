//! `polhode plot`: what is drawn, where it stands, and what is refused.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use nalgebra::UnitQuaternion;
use polhode::FreeMotion;
use polhode::num::Dd;
use roxmltree::{Document, Node};

use crate::harness::{Scratch, golden, polhode, refused, run, words};
use crate::pages::Page;

const FREE: &str = "--moments 1,2,3 --omega 0.4,1,-0.3 --until 20";

/// The drawing of `flags`, made in a folder of its own; what is told on standard error.
fn drawn(scratch: &Scratch, flags: &str) -> (String, String) {
    let answer = polhode(&words(&format!("plot {flags} --out drawn.svg")), &scratch.0);
    assert_eq!((answer.code, answer.out.as_str()), (0, ""), "{flags}: {}", answer.err);
    (fs::read_to_string(scratch.0.join("drawn.svg")).unwrap(), answer.err)
}

fn silently(scratch: &Scratch, flags: &str) -> String {
    let (svg, err) = drawn(scratch, flags);
    assert_eq!(err, "", "{flags}");
    svg
}

fn count(svg: &str, class: &str) -> usize {
    let document = Document::parse(svg).unwrap();
    document.descendants().filter(|node| node.attribute("class") == Some(class)).count()
}

fn words_of(svg: &str) -> String {
    let document = Document::parse(svg).unwrap();
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts.filter_map(|node| node.text()).collect::<Vec<_>>().join(" ")
}

/// Left, top, right and bottom of an element. Letters are at least 0.4 of their size wide on average.
fn corners(node: &Node) -> Option<[f64; 4]> {
    let number = |name: &str| node.attribute(name).and_then(|text| text.parse::<f64>().ok());
    match node.tag_name().name() {
        "circle" => {
            let (x, y, r) = (number("cx")?, number("cy")?, number("r")?);
            Some([x - r, y - r, x + r, y + r])
        }
        "polyline" | "polygon" => {
            let points = node.attribute("points")?.split([' ', ',']).map(|x| x.parse::<f64>().unwrap());
            let points: Vec<f64> = points.collect();
            let fold = |first: usize, pick: fn(f64, f64) -> f64| {
                points.iter().skip(first).step_by(2).copied().reduce(pick).unwrap()
            };
            Some([fold(0, f64::min), fold(1, f64::min), fold(0, f64::max), fold(1, f64::max)])
        }
        "text" => {
            let (x, y, size) = (number("x")?, number("y")?, number("font-size")?);
            let width = 0.4 * size * node.text()?.chars().count() as f64;
            if node.attribute("transform").is_some() {
                return Some([x - size, y - 0.5 * width, x, y + 0.5 * width]);
            }
            let left = match node.attribute("text-anchor")? {
                "start" => x,
                "middle" => x - 0.5 * width,
                _ => x - width,
            };
            Some([left, y - 0.8 * size, left + width, y])
        }
        _ => None,
    }
}

#[test]
fn every_kind_draws_its_elements_within_the_page() {
    let scratch = Scratch::new("plot-kinds");
    let mut found = String::new();
    for (flags, size) in [
        (format!("polhode {FREE}"), [500.0, 400.0]),
        (format!("polhode {FREE} --size wide --method rk4 --step 0.01"), [860.0, 400.0]),
        (format!("polhode {FREE} --view 200,-30"), [500.0, 400.0]),
        (format!("herpolhode {FREE}"), [500.0, 400.0]),
        (format!("omega {FREE} --size slide"), [960.0, 540.0]),
        (format!("angles {FREE}"), [500.0, 600.0]),
        (format!("trace {FREE} --axis x --size 640x480"), [640.0, 480.0]),
        (format!("poinsot {FREE}"), [500.0, 400.0]),
        (format!("conserved {FREE} --method rk4 --step 0.01"), [500.0, 400.0]),
        ("angles --body gyroscope --until 1".into(), [500.0, 920.0]),
        ("trace --body gyroscope --until 1".into(), [500.0, 400.0]),
        ("polhode --body sphere --omega 1,2,3 --until 5".into(), [500.0, 400.0]),
        ("herpolhode --body prolate --omega 1,0.5,2 --until 5".into(), [500.0, 400.0]),
    ] {
        let svg = silently(&scratch, &flags);
        let document = Document::parse(&svg).unwrap();
        let root = document.root_element();
        let [width, height] =
            ["width", "height"].map(|name| root.attribute(name).unwrap().parse::<f64>().unwrap());
        // a square plot, or names beside curves, may need a higher page
        assert!(
            width == size[0] && height >= size[1] && height < 2.2 * size[1],
            "{flags}: {width} x {height}"
        );
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for node in document.descendants().filter(Node::is_element) {
            let name = match node.attribute("class") {
                Some(class) => class.to_owned(),
                None if node.has_tag_name("text") => "text".to_owned(),
                None => continue,
            };
            *counts.entry(name).or_default() += 1;
            let Some([left, top, right, bottom]) = corners(&node) else { continue };
            let inside = left >= -0.5 && top >= -0.5 && right <= width + 0.5 && bottom <= height + 0.5;
            assert!(inside, "{flags}: {left} {top} {right} {bottom} of {width} x {height}: {node:?}");
        }
        let counts: Vec<String> = counts.into_iter().map(|(name, count)| format!("{name} {count}")).collect();
        let _ = writeln!(found, "{flags}: {}", counts.join(", "));
    }
    golden("plot.txt", &found);
}

#[test]
fn as_many_flips_are_marked_as_the_library_counts() {
    let scratch = Scratch::new("plot-flips");
    let named = polhode::catalogue::body("t-handle").unwrap();
    let exact =
        FreeMotion::from_omega(&named.inertia, UnitQuaternion::identity(), named.omega_body.into()).unwrap();
    for until in [5.0, 60.0] {
        let flips = exact.flips(Dd::from(until));
        assert!(flips > 1);
        for method in ["exact", "rk4 --step 0.001", "taylor"] {
            let svg = silently(&scratch, &format!("omega --body t-handle --until {until} --method {method}"));
            assert_eq!(count(&svg, "flip") as u64, flips, "{method}, {until} s");
            assert!(words_of(&svg).contains(&format!("{flips} flips")), "{method}");
        }
    }
    // each mark stands where the momentum along the middle axis vanishes: half a polhode period apart
    let svg = silently(&scratch, "omega --body t-handle --until 60");
    let document = Document::parse(&svg).unwrap();
    let marks = document.descendants().filter(|node| node.attribute("class") == Some("flip"));
    let places: Vec<f64> =
        marks.map(|node| corners(&node).map(|[left, _, right, _]| 0.5 * (left + right)).unwrap()).collect();
    let steps: Vec<f64> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.iter().all(|step| (step - steps[0]).abs() < 0.02), "{steps:?}");
    // a symmetric body has no middle axis
    assert_eq!(count(&silently(&scratch, "omega --body prolate --omega 1,0.5,2 --until 20"), "flip"), 0);
}

#[test]
fn pictures_have_the_size_that_was_asked_for() {
    let scratch = Scratch::new("plot-png");
    let answer = polhode(&words(&format!("plot omega {FREE} --size 640x300 --out o.PNG")), &scratch.0);
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    let bytes = fs::read(scratch.0.join("o.PNG")).unwrap();
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let side = |from: usize| u32::from_be_bytes(bytes[from..from + 4].try_into().unwrap());
    assert_eq!([side(16), side(20)], [1280, 600]);
}

#[test]
fn the_animation_needs_no_network_and_holds_the_motion() {
    let scratch = Scratch::new("plot-html");
    let answer = polhode(&words(&format!("plot poinsot {FREE} --out roll.html")), &scratch.0);
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    let page = Page::read(&scratch.0.join("roll.html"));
    let (track, ellipsoid) = (page.body(), &page.scene["ellipsoid"]);
    assert!(track.times.len() > 200 && track.omegas.len() == track.times.len());
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let (distance, semi) = (number(&ellipsoid["distance"]), &ellipsoid["semi_axes"]);
    // the point of contact stays in the plane, and on the ellipsoid, to the 1/32767 that a page keeps
    for (turn, omega) in track.attitudes.iter().zip(&track.omegas) {
        assert!(((turn * omega).z + distance).abs() < 2e-4, "{turn}");
        let on: f64 = (0..3).map(|k| (omega[k] / number(&semi[k])) * (omega[k] / number(&semi[k]))).sum();
        assert!((on - 1.0).abs() < 4e-4, "{on}");
    }
    assert!(
        ["omega", "momentum", "polhode", "herpolhode"].iter().all(|name| page.scene["shown"][name] == true)
    );
    // the end is by the clock of the start
    let answer = polhode(&words(&format!("plot poinsot {FREE} --start-time 4 --out later.html")), &scratch.0);
    assert_eq!((answer.code, answer.err.as_str()), (0, ""));
    let times = Page::read(&scratch.0.join("later.html")).body().times;
    assert!(times[0] == 4.0 && (times[times.len() - 1] - 20.0).abs() < 1e-12, "{times:?}");
}

#[test]
fn degenerate_motions_say_what_they_are() {
    let scratch = Scratch::new("plot-degenerate");
    let says = |flags: &str, text: &str| {
        let svg = silently(&scratch, flags);
        let words = words_of(&svg);
        assert!(words.contains(text), "{flags}: {words}");
        svg
    };
    let middle = "--moments 1,2,3 --omega 0,1,0 --until 5";
    let svg = says(&format!("polhode {middle}"), "the axis of the middle moment, unstable");
    assert_eq!((count(&svg, "point"), count(&svg, "path")), (1, 0));
    assert!(words_of(&svg).contains("the polhode is a point"));
    says(&format!("herpolhode {middle}"), "the herpolhode is a point");
    says(&format!("poinsot {middle}"), "polhode and herpolhode are points");
    says("polhode --body sphere --omega 1,2,3 --until 5", "a sphere turns steadily");
    says("herpolhode --moments 1,1,2 --omega 0.3,0,1 --until 9", "a circle");
    says("polhode --moments 1,1,2 --omega 1,0,0 --until 9", "an axis of the equator");
    says("omega --moments 1,2,3 --omega 0,0,0 --until 1", "at rest");
    // points too far apart are not joined
    let (svg, err) = drawn(&scratch, "omega --moments 1,2,3 --omega 0.4,1,-0.3 --until 1e12");
    assert!(err.starts_with("warning: --until: '1000000000000'") && err.contains("not joined"), "{err}");
    assert_eq!(count(&svg, "curve"), 0);
    assert!(words_of(&svg).contains("flips, too close to mark"));
}

#[test]
fn a_title_names_the_tolerance_of_a_method_that_chooses_its_steps() {
    let scratch = Scratch::new("plot-title");
    let title = |method: &str| words_of(&silently(&scratch, &format!("omega {FREE} --method {method}")));
    assert!(title("rk4 --step 0.5").contains("rk4, h = 0.5 s"));
    let title = title("dop853 --tolerance 1e-9 --step 0.5");
    assert!(title.contains("dop853, tolerance 1e-9") && !title.contains("h = "), "{title}");
}

/// Of a steady turn by h ω a step Euler's method stretches the quaternion by √(1 + (h ω/2)²), here by more than a half in 14 of 20
/// steps: what follows is no attitude.
#[test]
fn what_is_no_rotation_is_not_drawn() {
    let scratch = Scratch::new("plot-stretched");
    let euler =
        "--moments 1,2,3 --omega 0.001,1,0 --until 10 --method explicit-euler --step 0.5 --out p.html";
    for (command, told) in
        [("plot poinsot", "what came before is drawn"), ("show", "what came before is shown")]
    {
        let answer = polhode(&words(&format!("{command} {euler}")), &scratch.0);
        assert_eq!(answer.code, 1, "{command}: {}", answer.err);
        for part in
            ["error: --method explicit-euler: at 7.0 s the quaternion of the attitude has the norm", told]
        {
            assert!(answer.err.contains(part), "{command}: {}", answer.err);
        }
        let times = Page::read(&scratch.0.join("p.html")).body().times;
        assert_eq!((times.len(), times.last()), (14, Some(&6.5)), "{command}");
    }
    // a picture too
    let svg =
        "trace --moments 1,2,3 --omega 0.001,1,0 --until 10 --method explicit-euler --step 0.5 --out p.svg";
    assert_eq!(polhode(&words(&format!("plot {svg}")), &scratch.0).code, 1);
    // and a body beside another
    let beside =
        "show --moments 1,2,3 --omega 0.001,1,0 --until 10 --against explicit-euler:0.5 --out p.html";
    let answer = polhode(&words(beside), &scratch.0);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let page = Page::read(&scratch.0.join("p.html"));
    assert_eq!(page.rival(0).written["ending"], serde_json::json!([7.0, "diverged"]));
    assert_eq!(page.rival(0).times.last(), Some(&6.5));
}

#[test]
fn what_cannot_be_drawn_is_refused_with_what_can() {
    let with =
        |kind: &str, flags: &str| format!("plot {kind} --moments 1,2,3 --omega 0.4,1,-0.3 --until 5 {flags}");
    refused(&with("omega", "--out a.pdf"), &["--out: 'a.pdf'", "known here: .svg, .png"]);
    refused(&with("omega", "--out a"), &["--out: 'a'", ".svg"]);
    refused(&with("omega", "--out a.html"), &["only poinsot is a page that moves"]);
    refused(&with("omega", "--out absent/a.svg"), &["--out: 'absent/a.svg'", "the folder does not exist"]);
    refused(
        &with("flip", "--out a.svg"),
        &["'flip'", "polhode, herpolhode, omega, angles, trace, poinsot, conserved"],
    );
    refused(&with("omega", "--size huge --out a.svg"), &["--size", "known: column, wide, slide"]);
    refused(&with("omega", "--size 9x9 --out a.svg"), &["between 400 and 4000"]);
    refused(&with("omega", "--axis x --out a.svg"), &["--axis: only trace"]);
    refused(&with("omega", "--view 30,20 --out a.svg"), &["--view: only polhode, trace and"]);
    refused(&with("poinsot", "--view 30,20 --out a.html"), &["--view: only polhode, trace and"]);
    refused(&with("poinsot", "--size wide --out a.html"), &["--size: only .svg and .png"]);
    refused(
        &with("omega", "--start-time 5 --out a.svg"),
        &["--until: '5'", "must come after the start, t = 5"],
    );
    refused(&with("omega", "--step 0.1 --out a.svg"), &["--step", "exact takes no step"]);
    refused(&with("omega", "--tolerance 1e-9 --out a.svg"), &["--tolerance", "takes no --tolerance"]);
    refused(&with("omega", "--method rk4 --out a.svg"), &["--step: missing: rk4 needs a step"]);
    refused(
        &with("omega", "--method rk4 --step 0.3 --out a.svg"),
        &["no whole number of steps", "--until 5.1"],
    );
    refused(&with("omega", "--method ratle --step 0.1 --out a.svg"), &["'rattle'"]);
    refused(&with("omega", "--drag 0.1 --out a.svg"), &["--method exact", "rk4"]);
    let drag = "--drag 0.1 --method rk4 --step 0.01 --out a.svg";
    refused(&with("conserved", drag), &["conserves neither energy nor angular momentum"]);
    refused(&with("poinsot", drag), &["free bodies"]);
    let friction = "--method dissipating:0.01 --step 0.05 --out a.svg";
    refused(&with("poinsot", friction), &["constant energy", "inner friction", "plot polhode"]);
    let rest = "--moments 1,2,3 --omega 0,0,0 --until 5 --out a.svg";
    for kind in ["polhode", "herpolhode", "poinsot"] {
        refused(&format!("plot {kind} {rest}"), &["--omega: the body is at rest"]);
    }
    refused("plot omega --body t-handle --out a.svg", &["--until"]);
    refused("plot omega --body t-handle --until 5", &["--out"]);
    assert!(!std::path::Path::new("a.svg").exists());
    // a run that ends early is drawn as far as it came
    let scratch = Scratch::new("plot-diverged");
    let flags = "omega --moments 1,2,3 --omega 0.4,1,-0.3 --until 2000 --method explicit-euler --step 0.5";
    let answer = polhode(&words(&format!("plot {flags} --out drawn.svg")), &scratch.0);
    assert_eq!(answer.code, 1, "{}", answer.err);
    assert!(answer.err.contains("what came before is drawn"), "{}", answer.err);
    Document::parse(&fs::read_to_string(scratch.0.join("drawn.svg")).unwrap()).unwrap();
    assert_eq!(run("plot --help").code, 0);
}
