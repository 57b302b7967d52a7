//! `polhode show`: what the page holds, what it says of it, and what is refused.

use std::fs;
use std::path::Path;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::FreeMotion;
use polhode::num::Dd;

use crate::harness::{Answer, Scratch, golden, output, polhode, refused, words};
use crate::pages::Page;

const FREE: &str = "--moments 1,2,3 --omega 0.4,1,-0.3 --until 20";

fn shown(scratch: &Scratch, flags: &str) -> (Page, Answer) {
    let answer = polhode(&words(&format!("show {flags} --out page.html")), &scratch.0);
    assert_eq!((answer.code, answer.out.as_str()), (0, ""), "{flags}: {}", answer.err);
    (Page::read(&scratch.0.join("page.html")), answer)
}

fn silently(scratch: &Scratch, flags: &str) -> Page {
    let (page, answer) = shown(scratch, flags);
    assert_eq!(answer.err, "", "{flags}");
    page
}

fn free(moments: [f64; 3], omega: [f64; 3]) -> FreeMotion {
    let inertia = polhode::Inertia::from_moments(moments).unwrap();
    FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), omega.into()).unwrap()
}

#[test]
fn the_page_turns_the_body_as_the_library_does() {
    let scratch = Scratch::new("show-motion");
    let page = silently(&scratch, FREE);
    let (track, exact) = (page.body(), free([1.0, 2.0, 3.0], [0.4, 1.0, -0.3]));
    // axes of the page: the same turn of space for all times
    let of = |t: f64| exact.at(t).unwrap().rotation();
    let upright = track.attitudes[0] * of(0.0).inverse();
    let mut largest = 0.0_f64;
    for pair in track.times.iter().zip(&track.attitudes).collect::<Vec<_>>().windows(2) {
        let [(t0, p), (t1, q)] = [pair[0], pair[1]];
        assert!(p.angle_to(&(upright * of(*t0))) < 2e-4, "t = {t0}");
        largest = largest.max(p.slerp(q, 0.5).angle_to(&(upright * of(0.5 * (t0 + t1)))));
    }
    // between two attitudes, with the rounding of a page, which is below 1e-4 rad
    let said = page.notes().split_once("at most about ").unwrap().1.split_once(" rad").unwrap().0;
    let said: f64 = said.parse().unwrap();
    assert!(said < 1e-3 && largest < 1.1 * said + 2e-4, "{said} {largest}");
    assert_eq!(track.times[0], 0.0);
    assert!((track.times.last().unwrap() - 20.0).abs() < 1e-12);
    assert_eq!(track.flips(), Some(exact.flips(Dd::from(20.0))));
    let again = fs::read(scratch.0.join("page.html")).unwrap();
    silently(&scratch, FREE);
    assert_eq!(fs::read(scratch.0.join("page.html")).unwrap(), again);
}

#[test]
fn a_method_falls_out_of_phase_and_loses_its_energy_beside_the_body() {
    let scratch = Scratch::new("show-method");
    let page =
        silently(&scratch, &format!("{FREE} --against rk4:0.5 --against rattle:0.25 --against taylor"));
    let (exact, notes) = (free([1.0, 2.0, 3.0], [0.4, 1.0, -0.3]), page.notes());
    // `polhode compare` judges the same runs
    let csv = output(&format!("compare {FREE} --methods rk4,rattle --steps 0.5,0.25 --format csv"));
    let row = |method: &str, step: &str| {
        let line = csv.lines().find(|line| line.starts_with(&format!("{method},{step},"))).unwrap();
        line.split(',').map(str::to_owned).collect::<Vec<_>>()
    };
    for (k, method, step, name) in
        [(0, "rk4", "0.5", "rk4, h = 0.5 s"), (1, "rattle", "0.25", "rattle, h = 0.25 s")]
    {
        let (track, row) = (page.rival(k), row(method, step));
        assert_eq!(track.name, name);
        assert!(notes.contains(name), "{notes}");
        let judged: f64 = row[3].parse().unwrap();
        assert!((track.angles.last().unwrap() / judged - 1.0).abs() < 1e-5, "{method}: {judged}");
        let worst: f64 = row[6].parse().unwrap();
        let largest = track.energy_changes.iter().fold(0.0_f64, |worst, change| worst.max(change.abs()));
        assert!((largest / worst - 1.0).abs() < 1e-5, "{method}: {worst} {largest}");
        assert!(track.angles[0] < 1e-7);
    }
    assert!(page.rival(0).energy_changes.last().unwrap() < &0.0);
    let taylor = page.rival(2);
    assert!(taylor.angles.iter().all(|angle| *angle < 1e-9));
    assert_eq!(taylor.flips(), Some(exact.flips(Dd::from(20.0))));
}

#[test]
fn a_method_that_diverges_says_when() {
    let scratch = Scratch::new("show-diverged");
    let (page, answer) =
        shown(&scratch, "--moments 1,2,3 --omega 0.4,1,-0.3 --until 2000 --against explicit-euler:0.5");
    let told: Vec<&str> = answer.err.lines().filter(|line| line.contains("diverged at t = ")).collect();
    assert_eq!(told.len(), 1, "{}", answer.err);
    let ending = &page.rival(0).written["ending"];
    assert_eq!(ending[1], "diverged");
    assert!(ending[0].as_f64().unwrap() < 2000.0);
    assert!(page.notes().contains("It diverged at t = "), "{}", page.notes());
}

#[test]
fn a_file_is_shown_at_its_own_times() {
    let scratch = Scratch::new("show-file");
    let run = |flags: &str| {
        let answer =
            polhode(&words(&format!("propagate --moments 1,2,3 --omega 0.4,1,-0.3 {flags}")), &scratch.0);
        assert_eq!(answer.code, 0, "{}", answer.err);
    };
    run("--until 20 --every 0.25 --method rk4 --step 0.25 --fields t,q,omega --out run.csv");
    let page = silently(&scratch, &format!("{FREE} --against run.csv --against rk4:0.25"));
    let (file, method) = (page.rival(0), page.rival(1));
    assert_eq!(file.name, "run.csv");
    assert_eq!(file.times.len(), method.times.len());
    for k in 0..file.times.len() {
        assert!((file.angles[k] - method.angles[k]).abs() < 1e-6, "{k}");
        assert!((file.energy_changes[k] - method.energy_changes[k]).abs() < 1e-9, "{k}");
    }
    assert_eq!(file.flips(), method.flips());
    // without an end that of the file is taken; without angular velocities flips are counted all the same
    run("--times 0,0.5,1.5,3,7,19 --fields t,q --out few.csv");
    let page = silently(&scratch, "--moments 1,2,3 --omega 0.4,1,-0.3 --against few.csv");
    let file = page.rival(0);
    assert_eq!(file.times, [0.0, 0.5, 1.5, 3.0, 7.0, 19.0]);
    assert_eq!(page.body().times.last(), Some(&19.0));
    assert!(file.angles.iter().all(|angle| *angle < 1e-7) && file.energy_changes.is_empty());
    // what ends earlier says so
    let page = silently(&scratch, "--moments 1,2,3 --omega 0.4,1,-0.3 --until 30 --against few.csv");
    assert_eq!(page.rival(0).written["ending"], serde_json::json!([19.0, "ends"]));

    let refuses = |flags: &str, says: &[&str]| {
        let answer = polhode(&words(&format!("show {flags} --out refused.html")), &scratch.0);
        assert_eq!(answer.code, 2, "{flags}: {}", answer.err);
        says.iter().for_each(|part| assert!(answer.err.contains(part), "{flags}: {}", answer.err));
    };
    run("--until 20 --every 0.25 --out exact.csv");
    let other = "--moments 1,2,2.2 --omega 0.4,1,-0.3";
    refuses(&format!("{other} --until 20 --against exact.csv"), &["exact.csv", "body with other moments"]);
    let elsewhere = "--moments 1,2,3 --omega 0.4,1,-0.3 --attitude 0,1,0,0";
    refuses(&format!("{elsewhere} --against run.csv"), &["differs by 3.14 rad", "another start"]);
    refuses(
        "--moments 1,2,3 --omega 0.4,1,-0.3 --until 10 --against run.csv",
        &["run.csv: '10.25': lies outside of the run"],
    );
    refuses(&format!("{FREE} --against few.html"), &["'few.html'", "no such file"]);
    scratch.file("one.csv", "t,q_w,q_x,q_y,q_z\n0,1,0,0,0\n");
    refuses(&format!("{FREE} --against one.csv"), &["one.csv: '0'", "only time, and nothing would move"]);
    assert!(!scratch.names().contains(&"refused.html".to_owned()));
    // an output does not replace an input
    let answer = polhode(&words(&format!("show {FREE} --against page.html --out page.html")), &scratch.0);
    assert_eq!(answer.code, 2, "{}", answer.err);
}

#[test]
fn the_end_is_by_the_clock_of_the_start() {
    let scratch = Scratch::new("show-clock");
    let start = "--moments 1,2,3 --omega 0.4,1,-0.3 --start-time 5";
    let line = format!("propagate {start} --until 15 --every 0.25 --fields t,q --out run.csv");
    assert_eq!(polhode(&words(&line), &scratch.0).code, 0);
    for until in ["", "--until 15"] {
        let page = silently(&scratch, &format!("{start} {until} --against run.csv --against rk4:0.25"));
        for track in [page.body(), page.rival(0), page.rival(1)] {
            let ends = [track.times[0] - 5.0, track.times[track.times.len() - 1] - 15.0];
            assert!(ends.iter().all(|off| off.abs() < 1e-12), "{until} {}: {ends:?}", track.name);
        }
        assert!(page.rival(0).angles.iter().all(|angle| *angle < 1e-7), "{until}");
    }
    refused(
        &format!("show {start} --until 5 --out a.html"),
        &["--until: '5'", "must come after the start, t = 5"],
    );
}

#[test]
fn every_body_of_the_catalogue_has_a_page() {
    let scratch = Scratch::new("show-catalogue");
    let mut found = String::new();
    for named in polhode::catalogue::bodies().iter().chain(&polhode::catalogue::tops()) {
        let page = silently(&scratch, &format!("--body {}", named.name));
        let (vertices, triangles) = page.shape();
        let radius = vertices.iter().map(Vector3::norm).fold(0.0, f64::max);
        assert!((radius - 1.0).abs() < 1e-4, "{}: {radius}", named.name);
        let notes = page.notes();
        let drawn = notes.split_once("rawn: ").unwrap().1.split_once(".</p>").unwrap().0;
        let track = page.body();
        let until = track.times.last().unwrap();
        found += &format!(
            "{}: {drawn}; {triangles} triangles, {} attitudes, {until:e} s, pace {}\n",
            named.name,
            track.times.len(),
            page.scene["pace"]
        );
        assert!(page.text.len() < 400_000, "{}: {}", named.name, page.text.len());
    }
    golden("show.txt", &found);
}

/// Inner friction takes energy and leaves L: ω lies on the ellipsoid whose axes have shrunk by √(T/T₀), and in the plane at the
/// distance 2T/|L| from its centre. The page draws both of the time that it shows, and all of the polhode, which is not closed.
#[test]
fn the_ellipsoid_shrinks_with_the_energy() {
    let scratch = Scratch::new("show-friction");
    let flags = "--moments 1,2,3 --omega 1,0.05,0.3 --method dissipating:0.01 --step 0.05 --until 60";
    let page = silently(&scratch, flags);
    let (track, ellipsoid) = (page.body(), &page.scene["ellipsoid"]);
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let shares: Vec<f64> = track.energy_changes.iter().map(|change| 1.0 + change).collect();
    assert!(shares.len() == track.times.len() && shares.windows(2).all(|pair| pair[1] <= pair[0]));
    assert!(shares.last().unwrap() < &0.9, "{:?}", shares.last());
    for ((omega, turn), share) in track.omegas.iter().zip(&track.attitudes).zip(&shares) {
        let along = |k: usize| omega[k] / number(&ellipsoid["semi_axes"][k]);
        let on: f64 = (0..3).map(|k| along(k) * along(k)).sum();
        assert!((on / share - 1.0).abs() < 1e-3, "{on} {share}");
        assert!(((turn * omega).z + number(&ellipsoid["distance"]) * share).abs() < 1e-3, "{share}");
    }
    assert!((number(&ellipsoid["round"]) - 60.0).abs() < 1e-9);
    let note = "ellipsoid and the plane are those of the energy at the time that is shown";
    assert!(page.notes().contains(note), "{}", page.notes());
    let free = silently(&scratch, FREE);
    assert!(number(&free.scene["ellipsoid"]["round"]) < 20.0 && !free.notes().contains(note));
}

/// Half-edges of the box around the vertices, the largest 1.
fn extents(page: &Page) -> [f64; 3] {
    let (vertices, _) = page.shape();
    let size = [0, 1, 2].map(|k| vertices.iter().map(|at| at[k].abs()).fold(0.0, f64::max));
    size.map(|x| x / size.iter().fold(0.0_f64, |a, b| a.max(*b)))
}

const BOX_OBJ: &str = "v 10 10 10\nv 14 10 10\nv 14 12 10\nv 10 12 10\nv 10 10 11\nv 14 10 11\nv 14 12 11\nv 10 12 11\n\
    f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

#[test]
fn shapes_come_from_meshes_parts_links_and_else_from_the_inertia() {
    let scratch = Scratch::new("show-shapes");
    let spin = "--omega 0.3,2,0.1 --until 5";
    scratch.file("box.obj", BOX_OBJ);
    let near = |found: [f64; 3], expected: [f64; 3], what: &str| {
        assert!((0..3).all(|k| (found[k] - expected[k]).abs() < 1e-3), "{what}: {found:?}");
    };
    // about its centre, wherever the mesh lies, with the moments of a box of 4 x 2 x 1
    let (page, answer) = shown(&scratch, &format!("--body box.obj {spin}"));
    assert_eq!(answer.err, "note: box.obj: the density is taken as 1 kg/m^3, as a mesh file has no mass\n");
    near(extents(&page), [1.0, 0.5, 0.25], "mesh");
    assert!(page.notes().contains("Drawn: box.obj"));
    let semi: Vec<f64> = page.scene["ellipsoid"]["semi_axes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    let ratio = |k: usize| (semi[0] / semi[k]) * (semi[0] / semi[k]);
    assert!((ratio(1) - 17.0 / 5.0).abs() < 1e-12 && (ratio(2) - 20.0 / 5.0).abs() < 1e-12, "{semi:?}");
    near(extents(&silently(&scratch, &format!("--moments 5,17,20 {spin}"))), [1.0, 0.5, 0.25], "inertia");
    near(
        extents(&silently(&scratch, &format!("--moments 5,17,20 --mesh box.obj {spin}"))),
        [1.0, 0.5, 0.25],
        "--mesh",
    );

    scratch.file(
        "parts.toml",
        "[[part]]\nshape = \"box\"\nsize = [4, 2, 1]\nmass = 1\nat = [7, 0, 0]\n[[part]]\nshape = \"point\"\nmass = 1e-9\nat = [7, 0, 0]\n",
    );
    near(extents(&silently(&scratch, &format!("--body parts.toml {spin}"))), [1.0, 0.5, 0.25], "parts");

    scratch.file(
        "tensor.toml",
        "[[part]]\nshape = \"tensor\"\nmass = 1\ninertia = [20, 5, 17, 0, 0, 0]\n\
         [[part]]\nshape = \"sphere\"\nsize = [1e-9]\nmass = 1e-9\n",
    );
    near(extents(&silently(&scratch, &format!("--body tensor.toml {spin}"))), [0.25, 1.0, 0.5], "tensor");

    let link = |name: &str, visual: &str| {
        format!(
            "<link name=\"{name}\"><inertial><origin xyz=\"1 0 0\"/><mass value=\"12\"/>\
             <inertia ixx=\"5\" iyy=\"17\" izz=\"20\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>{visual}</link>"
        )
    };
    let visual = |geometry: &str| {
        format!(
            "<visual><origin xyz=\"1 0 0\" rpy=\"0 0 1.5707963267948966\"/><geometry>{geometry}</geometry></visual>"
        )
    };
    fs::create_dir_all(scratch.0.join("arm/urdf")).unwrap();
    fs::create_dir_all(scratch.0.join("arm/meshes")).unwrap();
    // about its middle, so that the origin of the visual is that of the box
    let middle =
        "v -2 -1 -.5\nv 2 -1 -.5\nv 2 1 -.5\nv -2 1 -.5\nv -2 -1 .5\nv 2 -1 .5\nv 2 1 .5\nv -2 1 .5\n";
    let faces = BOX_OBJ.split_once("\nf ").unwrap().1;
    scratch.file("arm/meshes/box.obj", format!("{middle}f {faces}"));
    let urdf = [
        link("boxed", &visual("<box size=\"2 4 1\"/>")),
        link("meshed", &visual("<mesh filename=\"package://arm/meshes/box.obj\" scale=\"0.1 0.1 0.1\"/>")),
        link("lost", &visual("<mesh filename=\"package://arm/meshes/absent.obj\"/>")),
        link("bare", ""),
    ];
    scratch.file("arm/urdf/arm.urdf", format!("<robot name=\"arm\">{}</robot>", urdf.concat()));
    let of = |name: &str| silently(&scratch, &format!("--body arm/urdf/arm.urdf:{name} {spin}"));
    near(extents(&of("boxed")), [1.0, 0.5, 0.25], "box of a link");
    // turned by a right angle about z
    near(extents(&of("meshed")), [0.5, 1.0, 0.25], "mesh of a link");
    for (name, why) in [("lost", "absent.obj' is not there"), ("bare", "he link states no shape")] {
        let page = of(name);
        near(extents(&page), [1.0, 0.5, 0.25], name);
        assert!(page.notes().contains(why) && page.notes().contains("the same inertia"), "{}", page.notes());
    }
}

/// A sphere of 2 n² squares of two triangles.
fn sphere(n: usize) -> String {
    let mut text = String::new();
    for j in 0..=n {
        for k in 0..2 * n {
            let (s, c) = (core::f64::consts::PI * j as f64 / n as f64).sin_cos();
            let (sk, ck) = (core::f64::consts::PI * k as f64 / n as f64).sin_cos();
            text += &format!("v {} {} {}\n", s * ck, 0.8 * s * sk, 0.6 * c);
        }
    }
    for j in 0..n {
        for k in 0..2 * n {
            let at = |j: usize, k: usize| 1 + j * 2 * n + k % (2 * n);
            text += &format!("f {} {} {} {}\n", at(j, k), at(j + 1, k), at(j + 1, k + 1), at(j, k + 1));
        }
    }
    text
}

#[test]
fn a_fine_mesh_is_drawn_with_fewer_triangles_and_an_empty_one_is_refused() {
    let scratch = Scratch::new("show-mesh");
    scratch.file("sphere.obj", sphere(80));
    let page = silently(&scratch, "--body textbook --mesh sphere.obj --until 5");
    let (vertices, triangles) = page.shape();
    assert!((10_000..=20_000).contains(&triangles), "{triangles}");
    assert!(page.notes().contains(&format!("with {triangles} of its 25440 triangles")), "{}", page.notes());
    assert!(vertices.iter().all(|at| at.norm() > 0.55));
    scratch.file("empty.obj", "v 0 0 0\n");
    scratch.file("empty.stl", "solid a\nendsolid a\n");
    for file in ["empty.obj", "empty.stl"] {
        for flags in [format!("--body {file} --omega 1,2,3"), format!("--body textbook --mesh {file}")] {
            let answer = polhode(&words(&format!("show {flags} --out page2.html")), &scratch.0);
            assert_eq!(answer.code, 2, "{flags}: {}", answer.err);
            assert!(answer.err.contains(file) && answer.err.contains("triangle"), "{flags}: {}", answer.err);
        }
    }
    assert!(!scratch.names().contains(&"page2.html".to_owned()));
}

#[test]
fn a_body_that_does_not_move_says_so() {
    let scratch = Scratch::new("show-rest");
    let (page, answer) = shown(&scratch, "--moments 1,2,3 --omega 0,0,0");
    assert!(page.notes().contains("The body is at rest: nothing moves."), "{}", page.notes());
    assert!(answer.err.contains("nothing moves"), "{}", answer.err);
    assert!(page.scene["ellipsoid"].is_null());
    assert!(page.text.contains("; at rest</h1>"));
}

#[test]
fn forces_are_shown_by_the_method_that_takes_them() {
    let scratch = Scratch::new("show-forces");
    let page = silently(&scratch, "--body phone --drag 1e-5 --until 4 --against dop853 --against rk4:0.01");
    assert!(page.text.contains("under drag") && page.text.contains(", taylor</h1>"));
    assert!(page.scene["ellipsoid"].is_null());
    let rival = page.rival(0);
    assert!(rival.angles.iter().all(|angle| *angle < 1e-3), "{:?}", rival.angles.last());
    // drag takes energy, so that its change is no error
    assert!(rival.energy_changes.is_empty());
    let page = silently(&scratch, "--body phone --method rk4 --step 0.01 --until 4");
    assert_eq!(page.body().times.len(), 401);
    let page = silently(
        &scratch,
        "--moments 1,2,3 --weight-moment 0,0,1 --omega 0,0,0 --attitude 3,1,0,0 --method taylor",
    );
    assert!(page.notes().contains("a cone from the fixed point"), "{}", page.notes());
}

#[test]
fn what_cannot_be_shown_is_refused_with_what_can() {
    let with = |flags: &str| format!("show --moments 1,2,3 --omega 0.4,1,-0.3 {flags}");
    refused(&with("--until 5 --out a.svg"), &["--out: 'a.svg'", ".html"]);
    refused(&with("--until 5 --out absent/a.html"), &["the folder does not exist"]);
    refused(&with("--until 5"), &["--out"]);
    refused(&with("--until 5 --against rk4 --out a.html"), &["--against: 'rk4'", "rk4:0.1"]);
    refused(&with("--until 5 --against ratle:0.1 --out a.html"), &["--against: 'ratle'", "'rattle'"]);
    refused(
        &with("--until 5 --against rk4:9 --out a.html"),
        &["--against: 'rk4:9'", "longer than the motion"],
    );
    refused(&with("--until 5 --against rk4:-1 --out a.html"), &["--against: 'rk4:-1'"]);
    refused(&with("--until 5 --against exact:1 --out a.html"), &["'exact:1'", "the reference"]);
    refused(&with("--until 1 --against rk4:1e-13 --out a.html"), &["--against: '1e-13'", "1e13 steps"]);
    let four = "--against rk4:1 --against rk4:0.5 --against rk4:0.2 --against rk4:0.1";
    refused(&with(&format!("--until 5 {four} --out a.html")), &["--against: given 4 times", "at most 3"]);
    refused(
        &with("--until 1e7 --out a.html"),
        &["--until: '10000000'", "a page has at most so many", "earlier end"],
    );
    refused(&with("--until 5 --time-unit ms --out a.html"), &["--time-unit", "give --against FILE"]);
    let order = "--until 5 --quaternion xyzw --out a.html";
    refused(&with(order), &["--quaternion: 'xyzw'", "and none is read"]);
    refused(&with("--until 5 --step 0.1 --out a.html"), &["--method"]);
    refused(&with("--until 5 --mesh absent.stl --out a.html"), &["absent.stl"]);
    refused("show --body t-handle --mesh nothing.txt --out a.html", &["nothing.txt", ".stl, .obj or .ply"]);
    refused("show --moments 1,2,3 --omega 0,0,0 --torque-body 1,0,0 --out a.html", &["--until: missing"]);
    assert!(!Path::new("a.html").exists());
    let scratch = Scratch::new("show-weightless");
    scratch.file("box.obj", BOX_OBJ);
    let line = "show --body box.obj --omega 1,2,3 --drag 1 --out a.html";
    let answer = polhode(&words(line), &scratch.0);
    assert!(answer.code == 2 && answer.err.contains("a mesh file has no mass"), "{}", answer.err);
}

#[test]
fn help_is_short_on_h_and_teaches_on_help() {
    let [short, long] = ["show -h", "show --help"].map(output);
    assert!(short.lines().count() <= 50, "{}", short.lines().count());
    for part in ["--against", "METHOD:STEP", "arrow keys", "#t=3.5"] {
        assert!(long.contains(part), "{part}");
    }
    assert!(long.contains("--gravity-gradient") && !short.contains("--gravity-gradient"));
}
