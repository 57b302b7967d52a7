//! What an ensemble refuses: place, value, law and remedy.

use std::fs;

use sha2::Digest as _;

use super::{EXACT, contents, done};
use crate::harness::{Scratch, golden, polhode, words};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The refusal of a specification, without the name of the folder.
pub(super) fn refusal(scratch: &Scratch, line: &str) -> String {
    let answer = polhode(&words(line), &scratch.0);
    assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{line}: {}", answer.err);
    format!("$ polhode {line}\n{}\n", answer.err)
}

#[test]
fn specifications_are_refused_with_line_value_and_law() {
    let scratch = Scratch::new("ensemble-refusals");
    let mut told = String::new();
    let matrix = "[[1e-4, 2e-4, 0.0], [2e-4, 1e-4, 0.0], [0.0, 0.0, 1e-4]]";
    for (what, from, to) in [
        ("an unknown table", "[spread]", "[spred]"),
        ("an unknown key", "omega = [0.4", "omga = [0.4"),
        ("an unknown key of the spread", "attitude = 0.05", "atitude = 0.05"),
        ("not TOML", "members = 301", "members = "),
        ("a body that no mass distribution has", "[1.0, 2.0, 2.5]", "[1.0, 2.0, 3.5]"),
        ("a body twice", "[start]", "body = \"phone\"\n[start]"),
        ("an unknown body", "moments = [1.0, 2.0, 2.5]", "body = \"racked\""),
        ("two components", "[0.4, 1.0, -0.3]", "[0.4, 1.0]"),
        ("a text for a number", "[0.4, 1.0, -0.3]", "[\"fast\", 1.0, 0.0]"),
        ("a start that is missing", "omega = [0.4, 1.0, -0.3]", ""),
        ("a zero quaternion", "[spread]", "attitude = [0, 0, 0, 0]\n[spread]"),
        ("a unit of rates that is none", "[spread]", "rate_unit = \"deg\"\n[spread]"),
        ("a unit of angles that is none", "[spread]", "angle_unit = \"deg/s\"\n[spread]"),
        ("a negative deviation", "attitude = 0.05", "attitude = -0.05"),
        ("a spread twice", "[run]", "[spread.range]\nmoments = [[1, 2], [1, 2], [1, 2]]\n[run]"),
        (
            "a range the wrong way round",
            "[spread]\nattitude = 0.05\nomega = [0.01, 0.02, 0.03]\nmoments = 0.05",
            "[spread.range]\nomega = [[0, 1], [2, 1], [0, 1]]",
        ),
        (
            "an indefinite covariance",
            "omega = [0.01, 0.02, 0.03]\nmoments = 0.05",
            &format!("moments = 0.05\n[spread.covariance]\nomega = {matrix}"),
        ),
        (
            "a covariance of two rows",
            "omega = [0.01, 0.02, 0.03]\nmoments = 0.05",
            "[spread.covariance]\nomega = [[1, 0], [0, 1]]",
        ),
        (
            "no tensor that a body has",
            "[spread]\nattitude = 0.05\nomega = [0.01, 0.02, 0.03]\nmoments = 0.05",
            "[spread.range]\nmoments = [[1, 1], [1, 1], [3, 3]]",
        ),
        ("no members", "members = 301", "members = 0"),
        ("half a member", "members = 301", "members = 1.5"),
        ("members that are missing", "members = 301", ""),
        ("an unknown method", "seed = 7", "method = \"rk5\"\nstep = 0.1"),
        ("a step that is missing", "seed = 7", "method = \"rk4\""),
        ("a step that leads past a time", "seed = 7", "method = \"rk4\"\nstep = 0.3"),
        ("times that descend", "times = [0.0, 1.0, 100.0]", "method = \"rk4\"\nstep = 0.5\ntimes = [1, 0.5]"),
        ("a time out of reach", "times = [0.0, 1.0, 100.0]", "times = [1e30]"),
        ("times twice", "seed = 7", "until = 5\nevery = 1"),
        ("a list of times beside a file", "seed = 7", "times_file = \"epochs.csv\""),
        ("a file of times that is missing", "times = [0.0, 1.0, 100.0]", "times_file = \"epochs.csv\""),
        (
            "a file of times without such a column",
            "times = [0.0, 1.0, 100.0]",
            "times_file = \"spec.toml\"\ntimes_column = \"jd\"",
        ),
        ("a column of no file", "seed = 7", "times_column = \"t\""),
        ("a tolerance of a method without one", "seed = 7", "method = \"rk4\"\nstep = 0.5\ntolerance = 1e-9"),
        ("a tolerance twice", "seed = 7", "method = \"dop853:1e-9\"\nstep = 0.5\ntolerance = 1e-9"),
        ("a tolerance below rounding", "seed = 7", "method = \"dop853\"\nstep = 0.5\ntolerance = 1e-20"),
        ("a negative tolerance", "seed = 7", "method = \"dop853\"\nstep = 0.5\ntolerance = -1e-9"),
        ("a unit of time that is none", "times = [0.0, 1.0, 100.0]", "times = [\"5 fortnights\"]"),
        ("a time that is no double", "times = [0.0, 1.0, 100.0]", "times = [1, 9007199254740993]"),
        (
            "a method that is not for a force",
            "[run]",
            "[force]\ndrag = 0.1\n[run]\nmethod = \"two-turn\"\nstep = 0.5",
        ),
        ("no closed form", "[run]", "[force]\nweight_moment = [0, 0.1, 0]\n[run]"),
        (
            "a force that is none",
            "[run]",
            "[force]\ngravity_gradient = [0.1, 1.5]\n[run]\nmethod = \"rk4\"\nstep = 0.5",
        ),
        (
            "two orbits",
            "[run]",
            "[force]\ngravity_gradient = [0.1]\norbit = [2, 1.5, 4.25]\n[run]\nmethod = \"rk4\"\nstep = 0.5",
        ),
        (
            "a plane without an orbit",
            "[run]",
            "[force]\norbit_plane = \"0deg, 60deg, 0deg\"\n[run]\nmethod = \"rk4\"\nstep = 0.5",
        ),
        (
            "a plane without units",
            "[run]",
            "[force]\norbit = [2, 1.5, 4.25]\norbit_plane = \"0, 60, 0\"\n[run]\nmethod = \"rk4\"\nstep = 0.5",
        ),
        ("an unknown array", "[run]", "[output]\narrays = [\"attitude\"]\n[run]"),
        ("members from a file too", "attitude = 0.05", "members_file = \"members.csv\""),
    ] {
        assert!(EXACT.contains(from), "{what}");
        scratch.file("spec.toml", EXACT.replace(from, to));
        told += &format!("# {what}\n{}", refusal(&scratch, "ensemble spec.toml --out out"));
    }
    golden("ensemble/specifications.txt", &told);
    assert_eq!(scratch.names(), ["spec.toml"]);
}

/// As of one body: a mesh file tells no mass.
#[test]
fn a_torque_or_a_wheel_on_a_mesh_is_refused() {
    let scratch = Scratch::new("ensemble-mesh");
    scratch.file("corner.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let mesh = EXACT.replace("moments = [1.0, 2.0, 2.5]", "body = \"corner.obj\"");
    for (from, to) in [
        ("[run]", "[force]\ntorque_body = [0, 0, 0.1]\n[run]\nmethod = \"rk4\"\nstep = 0.5"),
        ("[start]", "wheels = [{axis = [0, 0, 1], inertia = 1e-3, speed = \"100rpm\"}]\n[start]"),
    ] {
        scratch.file("spec.toml", mesh.replace(from, to));
        let told = refusal(&scratch, "ensemble spec.toml --out out");
        let says = "error: spec.toml:2: key 'body': 'corner.obj': a mesh file has no mass, and here";
        assert!(told.contains(says), "{told}");
    }
    scratch.file("spec.toml", mesh);
    let answer = polhode(&words("ensemble spec.toml --out out"), &scratch.0);
    let note = "note: corner.obj: the density is taken as 1 kg/m^3, as a mesh file has no mass\n";
    assert_eq!((answer.code, answer.err.as_str()), (0, note));
}

#[test]
fn files_of_members_are_refused_with_line_and_law() {
    let scratch = Scratch::new("ensemble-members");
    scratch.file("spec.toml", "[spread]\nmembers_file = \"members.csv\"\n[run]\ntimes = [1]\n");
    let head = "i1,i2,i3,omega_x,omega_y,omega_z";
    let mut told = String::new();
    for content in [
        format!("{head}\n1,2,2.5,0,1,0\n1,2,4,0,1,0\n"),
        format!("{head}\n1,2,2.5,0,1,x\n"),
        format!("{head}\n1,2,2.5,0,1,inf\n"),
        format!("{head}\n1,2,2.5,0,1\n"),
        format!("{head},q_w,q_x,q_y,q_z\n1,2,2.5,0,1,0,0,0,0,0\n"),
        "i1,i2,omega_x,omega_y,omega_z\n1,2,0,1,0\n".into(),
        "i1,i2,i3,omga_x,omega_y,omega_z\n1,2,2.5,0,1,0\n".into(),
        "omega_x,omega_y,omega_z\n0,1,0\n".into(),
        "i1,i2,i3\n1,2,2.5\n".into(),
        format!("{head}\n"),
    ] {
        scratch.file("members.csv", &content);
        told += &format!(
            "# {}\n{}",
            content.trim_end().replace('\n', " | "),
            refusal(&scratch, "ensemble spec.toml --out out")
        );
    }
    scratch.file("members.csv", format!("{head}\n1,2,2.5,0,1,0\n"));
    scratch.file("spec.toml", "[spread]\nmembers_file = \"members.csv\"\n[run]\nmembers = 2\ntimes = [1]\n");
    told += &refusal(&scratch, "ensemble spec.toml --out out");
    golden("ensemble/members.txt", &told);
    // of drawing
    for (key, more) in [("seed", "seed = 3\n"), ("solution", "[[solution]]\nweight = 1\n")] {
        let spec = format!("[spread]\nmembers_file = \"members.csv\"\n[run]\ntimes = [1]\n{more}");
        scratch.file("spec.toml", spec);
        let told = refusal(&scratch, "ensemble spec.toml --out out");
        assert!(told.contains(&format!("key '{key}': given beside members_file, so that")), "{told}");
    }
}

#[test]
fn shards_that_do_not_belong_together_are_refused_by_name() {
    let scratch = Scratch::new("ensemble-gather");
    scratch.file("spec.toml", EXACT);
    scratch.file("other.toml", EXACT.replace("seed = 7", "seed = 8"));
    let mut told = refusal(&scratch, "gather nowhere");
    for k in [1, 3] {
        done(&format!("ensemble spec.toml --out out --shard {k}/4"), &scratch);
    }
    told += &refusal(&scratch, "gather out");
    told += &refusal(&scratch, "ensemble other.toml --out out --shard 2/4");
    told += &refusal(&scratch, "ensemble spec.toml --out out --shard 2/3");
    told += &refusal(&scratch, "ensemble spec.toml --out out");
    told += &refusal(&scratch, "ensemble spec.toml --out out --shard 5/4");
    told += &refusal(&scratch, "ensemble spec.toml --out many --shard 1/302");
    // a shard of another run among them
    for k in [2, 4] {
        done(&format!("ensemble other.toml --out other --shard {k}/4"), &scratch);
    }
    done("ensemble spec.toml --out out --shard 2/4", &scratch);
    fs::rename(scratch.0.join("other/shards/4-of-4"), scratch.0.join("out/shards/4-of-4")).unwrap();
    told += &refusal(&scratch, "gather out");
    // a version that is another
    let shard = scratch.0.join("out/shards/4-of-4");
    fs::remove_dir_all(&shard).unwrap();
    done("ensemble spec.toml --out out --shard 4/4", &scratch);
    let mark = shard.join("run.toml");
    let record = fs::read_to_string(&mark).unwrap();
    fs::write(&mark, record.replace(&format!("version = \"{VERSION}\""), "version = \"0.0.0\"")).unwrap();
    told += &refusal(&scratch, "gather out");
    fs::write(&mark, &record).unwrap();
    // a damaged one
    let attitudes = shard.join("attitudes.npy");
    let bytes = fs::read(&attitudes).unwrap();
    fs::write(&attitudes, &bytes[..bytes.len() - 8]).unwrap();
    told += &refusal(&scratch, "gather out");
    // shards of two numbers
    fs::write(&attitudes, &bytes).unwrap();
    done("ensemble spec.toml --out thirds --shard 1/3", &scratch);
    fs::rename(scratch.0.join("thirds/shards/1-of-3"), scratch.0.join("out/shards/1-of-3")).unwrap();
    told += &refusal(&scratch, "gather out");
    fs::remove_dir_all(scratch.0.join("out/shards/1-of-3")).unwrap();
    fs::create_dir(scratch.0.join("out/shards/mine")).unwrap();
    told += &refusal(&scratch, "gather out");
    fs::remove_dir(scratch.0.join("out/shards/mine")).unwrap();
    // the digests depend on how a version writes numbers down, which is not what is tested
    let words = told.split_inclusive([' ', ';', '\n']);
    let is_digest =
        |word: &str| word.trim_end_matches([' ', ';', '\n', ',']).len() == 64 && !word.contains('/');
    let told: String =
        words
            .map(|word| {
                if is_digest(word) { word.replace(|c: char| c.is_ascii_hexdigit(), "0") } else { word.into() }
            })
            .collect();
    golden("ensemble/gather.txt", &told.replace(VERSION, "VERSION"));
    done("gather out", &scratch);
}

#[test]
fn more_memory_or_disk_than_there_is_is_refused_before_the_work() {
    let scratch = Scratch::new("ensemble-memory");
    scratch.file("spec.toml", EXACT.replace("members = 301", "members = 1000000000000"));
    let told = refusal(&scratch, "ensemble spec.toml --out out");
    for part in ["spec.toml:10: 1000000000000 members take about ", "TB of memory, and ", "--shard K/N"] {
        assert!(told.contains(part), "{told}");
    }
    // little memory, and an array larger than any disk
    scratch.file(
        "spec.toml",
        EXACT
            .replace("times = [0.0, 1.0, 100.0]", "until = 1e9\nevery = 1e3")
            .replace("members = 301", "members = 100000000"),
    );
    let told = refusal(&scratch, "ensemble spec.toml --out out --shard 1/10000");
    assert!(told.contains("on the disk of --out") || told.contains("of memory"), "{told}");
    assert_eq!(scratch.names(), ["spec.toml"]);
}

/// Two shards of an ensemble of which a test changes something.
fn shards(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.file("spec.toml", EXACT);
    for k in [1, 2] {
        done(&format!("ensemble spec.toml --out out --shard {k}/2"), &scratch);
    }
    scratch
}

/// Its members would count twice.
#[test]
fn a_copy_of_a_shard_beside_it_is_refused() {
    let scratch = shards("ensemble-copy");
    let folder = scratch.0.join("out/shards");
    let copy = folder.join("1-of-2-copy");
    fs::create_dir(&copy).unwrap();
    for (name, bytes) in contents(&folder.join("1-of-2")) {
        fs::write(copy.join(name), bytes).unwrap();
    }
    let told = refusal(&scratch, "gather out");
    let says = "holds shard 1/2 twice, as out/shards/1-of-2 and as out/shards/1-of-2-copy; remove one of";
    assert!(told.contains(says), "{told}");
    assert_eq!(crate::harness::names(&scratch.0.join("out")), ["shards"]);
}

/// The record with `sum` in place of the checksum of a file, and sealed again.
fn resealed(record: &str, name: &str, sum: &str) -> String {
    let is_of =
        |line: &str, name: &str| line.split_once(" = ").is_some_and(|(key, _)| key.trim_matches('"') == name);
    let bare: String = record
        .lines()
        .filter(|line| !is_of(line, "run.toml"))
        .map(|line| if is_of(line, name) { format!("\"{name}\" = \"{sum}\"\n") } else { format!("{line}\n") })
        .collect();
    let seal = sha256(bare.as_bytes());
    bare + &format!("\"run.toml\" = \"{seal}\"\n")
}

pub(super) fn sha256(bytes: &[u8]) -> String {
    sha2::Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Results that stand already are those of their run: a run that finds others says so, and one that misses a file writes all again.
#[test]
fn a_byte_that_was_changed_in_results_is_found() {
    let scratch = Scratch::new("ensemble-results");
    scratch.file("spec.toml", EXACT);
    let line = "ensemble spec.toml --out out";
    done(line, &scratch);
    let out = scratch.0.join("out");
    let before = contents(&out);
    for name in ["attitudes.npy", "summary.csv", "dispersion.svg", "run.toml"] {
        let path = out.join(name);
        let bytes = fs::read(&path).unwrap();
        let mut changed = bytes.clone();
        let place = match name {
            "attitudes.npy" => 128 + 8 * 1000,
            // of its checksum of another file
            "run.toml" => {
                let (head, key) = (String::from_utf8(bytes.clone()).unwrap(), "\"summary.csv\" = \"");
                head.find(key).unwrap() + key.len()
            }
            _ => bytes.len() - 3,
        };
        changed[place] ^= 1;
        fs::write(&path, changed).unwrap();
        let told = refusal(&scratch, line);
        for part in [&format!("{name}: it has changed since its run wrote it"), "run the ensemble again"] {
            assert!(told.contains(part), "'{part}' is not in {told}");
        }
        fs::write(&path, bytes).unwrap();
    }
    let again = polhode(&words(line), &scratch.0);
    assert!(again.code == 0 && again.err.contains("holds the results of this run already"), "{}", again.err);
    fs::remove_file(out.join("dispersion.svg")).unwrap();
    done(line, &scratch);
    assert!(contents(&out) == before);
}

/// Hours of work, and notes beside them, are replaced only where that is asked for.
#[test]
fn results_of_another_run_are_replaced_only_on_demand() {
    let scratch = Scratch::new("ensemble-replace");
    scratch.file("spec.toml", EXACT);
    scratch.file("other.toml", EXACT.replace("seed = 7", "seed = 8"));
    done("ensemble spec.toml --out out", &scratch);
    let out = scratch.0.join("out");
    let before = contents(&out);
    let expect = |line: &str, says: &[&str]| {
        let told = refusal(&scratch, line);
        for part in says {
            assert!(told.contains(part), "'{part}' is not in {told}");
        }
    };
    let another = "'out': holds results of another run: of the specification with hash ";
    expect("ensemble other.toml --out out", &[another, "or give --replace"]);
    assert!(contents(&out) == before);
    // beside results that have lost a file and would be written again
    fs::remove_file(out.join("summary.csv")).unwrap();
    scratch.file("out/notes.txt", "mine");
    expect("ensemble spec.toml --out out", &["holds 'notes.txt', which is not of the results there"]);
    assert_eq!(fs::read(out.join("notes.txt")).unwrap(), b"mine");
    done("ensemble other.toml --out out --replace", &scratch);
    done("ensemble other.toml --out fresh", &scratch);
    assert!(contents(&out) == contents(&scratch.0.join("fresh")));
    fs::write(out.join("run.toml"), "mine = true\n").unwrap();
    expect("ensemble other.toml --out out", &["holds a run.toml that is not of results of an ensemble"]);
    let part = "ensemble other.toml --out out --replace --shard 1/2";
    expect(part, &["--replace: given with shard 1/2, which replaces nothing"]);
}

/// A file of no record is replaced on demand, and silently only by the same bytes, as after a gathering that was killed.
#[test]
fn gathering_replaces_a_file_of_nobody_only_on_demand() {
    let scratch = shards("ensemble-gather-replace");
    let out = scratch.0.join("out");
    for name in ["summary.csv", "run.toml"] {
        scratch.file(&format!("out/{name}"), "mine = true\n");
        let told = refusal(&scratch, "gather out");
        assert!(told.contains(&format!("holds a {name} ")) && told.contains("--replace"), "{told}");
        assert_eq!(
            crate::harness::names(&out),
            if name < "shards" { [name, "shards"] } else { ["shards", name] }
        );
        assert_eq!(fs::read(out.join(name)).unwrap(), b"mine = true\n");
        fs::remove_file(out.join(name)).unwrap();
    }
    scratch.file("out/summary.csv", "mine = true\n");
    done("gather out --replace", &scratch);
    done("ensemble spec.toml --out whole", &scratch);
    assert!(contents(&out) == contents(&scratch.0.join("whole")));
    for name in ["run.toml", "summary.csv"] {
        fs::remove_file(out.join(name)).unwrap();
        done("gather out", &scratch);
        assert!(contents(&out) == contents(&scratch.0.join("whole")));
    }
}

#[test]
fn a_byte_that_was_changed_in_a_shard_is_found_and_nothing_is_written() {
    let scratch = shards("ensemble-bytes");
    let [one, two] = ["1-of-2", "2-of-2"].map(|name| scratch.0.join("out/shards").join(name));
    let expect = |says: &[&str]| {
        let told = refusal(&scratch, "gather out");
        for part in says {
            assert!(told.contains(part), "'{part}' is not in {told}");
        }
        assert_eq!(crate::harness::names(&scratch.0.join("out")), ["shards"]);
    };
    for name in ["attitudes.npy", "omegas.npy", "errors.csv", "failures.csv", "run.toml"] {
        let path = two.join(name);
        let bytes = fs::read(&path).unwrap();
        let mut changed = bytes.clone();
        // the last digit of a number, or the last bit of a mantissa
        let place = if name.ends_with("npy") { 128 + 8 * 1000 } else { bytes.len() - 3 };
        changed[place] ^= 1;
        fs::write(&path, changed).unwrap();
        expect(&[
            &format!("shards/2-of-2/{name}: it has changed since its run wrote it"),
            "run shard 2/2 again",
        ]);
        fs::write(&path, bytes).unwrap();
    }
    // arrays of two shards exchanged: 150 and 151 members
    let even = Scratch::new("ensemble-exchanged");
    even.file("spec.toml", EXACT.replace("members = 301", "members = 300"));
    for k in [1, 2] {
        done(&format!("ensemble spec.toml --out out --shard {k}/2"), &even);
    }
    let arrays = ["1-of-2", "2-of-2"].map(|name| even.0.join("out/shards").join(name).join("attitudes.npy"));
    let bytes = arrays.clone().map(|path| fs::read(path).unwrap());
    fs::write(&arrays[0], &bytes[1]).unwrap();
    fs::write(&arrays[1], &bytes[0]).unwrap();
    let told = refusal(&even, "gather out");
    assert!(
        told.contains("shards/1-of-2/attitudes.npy: it has changed since its run wrote it: SHA-256 "),
        "{told}"
    );
    // a seed that is another
    let mark = one.join("run.toml");
    let record = fs::read_to_string(&mark).unwrap();
    fs::write(&mark, record.replace("seed = 7", "seed = 2")).unwrap();
    expect(&["1/2 is of method exact and seed 2, and 2/2 is of method exact and seed 7"]);
    // a record without checksums, as of an older version
    let bare = record.split_once("[sha256]").unwrap().0;
    fs::write(&mark, bare).unwrap();
    expect(&["shards/1-of-2/run.toml: it has changed since its run wrote it"]);
    fs::write(&mark, record).unwrap();
    done("gather out", &scratch);
}

#[test]
fn numbers_of_a_shard_that_cannot_be_are_named() {
    let scratch = shards("ensemble-numbers");
    let shard = scratch.0.join("out/shards/2-of-2");
    let mark = shard.join("run.toml");
    let record = fs::read_to_string(&mark).unwrap();
    let expect = |name: &str, bytes: &[u8], says: &str| {
        let kept = fs::read(shard.join(name)).unwrap();
        fs::write(shard.join(name), bytes).unwrap();
        fs::write(&mark, resealed(&record, name, &sha256(bytes))).unwrap();
        let told = refusal(&scratch, "gather out");
        assert!(told.contains(says), "'{says}' is not in {told}");
        assert_eq!(crate::harness::names(&scratch.0.join("out")), ["shards"]);
        fs::write(shard.join(name), kept).unwrap();
        fs::write(&mark, &record).unwrap();
    };
    let with = |name: &str, entry: usize, value: f64| {
        let mut bytes = fs::read(shard.join(name)).unwrap();
        bytes[128 + 8 * entry..][..8].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    // members 151 to 301; the second row begins behind 151 of four numbers
    let second = 4 * (151 + 2);
    for (value, says) in [
        (f64::NAN, "attitudes.npy: row 2 of member 153 is not finite"),
        (2.0, "attitudes.npy: row 2 of member 153 has the norm 2"),
    ] {
        expect("attitudes.npy", &with("attitudes.npy", second, value), says);
    }
    let mut gone = fs::read(shard.join("attitudes.npy")).unwrap();
    gone[128..128 + 32].fill(0);
    expect(
        "attitudes.npy",
        &gone,
        "row 1 of member 151 is zero, although failures.csv does not name the member",
    );
    expect(
        "omegas.npy",
        &with("omegas.npy", 0, f64::INFINITY),
        "omegas.npy: row 1 of member 151 is not finite",
    );
    // failures that do not add up
    expect("failures.csv", b"member,t,reason\n151,0.0,lost\n", "it names 1 members, and run.toml 0");
    // a row of a member that has none
    let lost = b"member,t,reason\n151,1.0,lost\n";
    let kept = fs::read(shard.join("failures.csv")).unwrap();
    fs::write(shard.join("failures.csv"), lost).unwrap();
    let failed = record.replace("\nfailed = 0\n", "\nfailed = 1\n");
    fs::write(&mark, resealed(&failed, "failures.csv", &sha256(lost))).unwrap();
    let told = refusal(&scratch, "gather out");
    let says = "attitudes.npy: row 2 of member 151 is not zero, although failures.csv names the member";
    assert!(told.contains(says), "{told}");
    fs::write(shard.join("failures.csv"), kept).unwrap();
    fs::write(&mark, &record).unwrap();
    // times of other rows
    let errors = fs::read_to_string(shard.join("errors.csv")).unwrap().replace("\n100.0,", "\n101.0,");
    expect("errors.csv", errors.as_bytes(), "row 3 is of t = 101, and that of shard 1 of t = 100");
    done("gather out", &scratch);
}
