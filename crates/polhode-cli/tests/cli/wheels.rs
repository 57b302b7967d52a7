//! Bodies with wheels, in every command that takes a body.

use serde_json::Value;

use crate::harness::{Scratch, output, polhode, words};

const MOTION: &str = "--omega 0.1,0.02,0.3 --attitude 0.5,0.1,-0.7,0.3";
const MOMENTS: &str = "--moments 10,12,15";
const WHEELS: &str = "--wheel 0,1,1,0.05@600rpm --wheel 1,0,0,0.1@-20,free";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// By flags, by TOML and by JSON: the same rows; the closed form is what is taken where no method is named.
#[test]
fn wheels_by_flag_and_by_file_are_the_same() {
    let scratch = Scratch::new("wheels-files");
    let times = "--times 0,10,1e6 --format csv";
    let by_flag = output(&format!("propagate {MOMENTS} {WHEELS} {MOTION} {times}"));
    assert_eq!(by_flag.lines().count(), 4);
    let toml = scratch.file(
        "craft.toml",
        "wheels = [{axis = [0, 1, 1], inertia = 0.05, speed = \"600rpm\"}]\n\
         [[part]]\nshape = \"tensor\"\nmass = 1\ninertia = [10, 12, 15, 0, 0, 0]\n",
    );
    let json = scratch.file(
        "craft.json",
        r#"{"inertia": [[10,0,0],[0,12,0],[0,0,15]], "wheels": [
            {"axis": [0,1,1], "inertia": 0.05, "speed": 600, "speed_unit": "rpm"},
            {"axis": [1,0,0], "inertia": 0.1, "speed": "-20rad/s", "free": true}]}"#,
    );
    for body in [format!("--body {toml} --wheel 1,0,0,0.1@-20,free"), format!("--body {json}")] {
        let rows = output(&format!("propagate {body} {MOTION} {times}"));
        for (here, there) in rows.lines().zip(by_flag.lines()).skip(1) {
            let numbers =
                |line: &str| line.split(',').take(8).map(|x| x.parse().unwrap()).collect::<Vec<f64>>();
            let off = numbers(here)
                .iter()
                .zip(numbers(there))
                .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            // the axes of a tensor are worked out, those of typed moments are not
            assert!(off < 1e-9, "{body}: {off:e}");
        }
    }
}

#[test]
fn an_audit_knows_the_wheels_and_misses_them_where_they_are_not_told() {
    let scratch = Scratch::new("wheels-audit");
    let wheel = "--wheel 0,1,1,0.05@600rpm";
    let run = output(&format!(
        "propagate {MOMENTS} {wheel} {MOTION} --until 100 --every 0.5 --fields t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z"
    ));
    let file = scratch.file("run.csv", run);
    let verdict = |body: &str| {
        let answer = polhode(&words(&format!("audit {file} {body} --format json")), &scratch.0);
        let found = json(&answer.out);
        let error = found["momentum_vector_error"].as_f64();
        (answer.code, found["verdict"].as_str().unwrap_or_default().to_owned(), error)
    };
    let (code, said, error) = verdict(&format!("{MOMENTS} {wheel}"));
    assert_eq!((code, said.as_str()), (0, "right"));
    assert!(error.is_some_and(|error| error < 1e-14));
    for wrong in [
        MOMENTS.to_owned(),
        format!("{MOMENTS} --wheel 0,1,1,0.05@630rpm"),
        format!("{MOMENTS} --wheel 0,1,-1,0.05@600rpm"),
    ] {
        let (code, said, _) = verdict(&wrong);
        assert_eq!((code, said.as_str()), (1, "wrong"), "{wrong}");
    }
}

/// The spacecraft of the catalogue is the same as by flags, in motion and on its sheet.
#[test]
fn a_body_of_the_catalogue_carries_its_wheels() {
    let named = polhode::catalogue::body("bsk-sat").unwrap();
    let flags: String = named.wheels.iter().map(|wheel| format!(" --wheel {wheel}")).collect();
    let sheet = output("bodies bsk-sat --format table");
    assert!(named.wheels.iter().all(|wheel| sheet.contains(&format!("--wheel {wheel}"))), "{sheet}");
    let motion = "--omega 0.001,-0.01,0.03 --times 0,600 --fields t,q,omega --format csv";
    let by_flags = output(&format!("propagate --moments 900,800,600{flags} {motion}"));
    let attitude = "--attitude 1,0,0,0";
    assert_eq!(output(&format!("propagate --body bsk-sat {attitude} {motion}")), by_flags);
    assert_ne!(output(&format!("propagate --moments 900,800,600 {motion}")), by_flags);
}

#[test]
fn motion_names_period_separatrices_and_steady_spins() {
    let line = format!("motion {MOMENTS} --wheel 1,0.3,-0.2,0.05@8rad/s --omega 0.3,-0.2,0.5");
    let found = json(&output(&format!("{line} --format json")));
    let found = &found[0];
    assert_eq!((found["mode"].as_str(), found["steady_spins"].as_u64()), (Some("tumbling"), Some(6)));
    assert!(found["period"].as_f64().is_some_and(|period| period > 1.0));
    let spins = json(&output(&format!("{line} --steady --format json")));
    let spins = spins.as_array().unwrap();
    let unstable: Vec<f64> = spins
        .iter()
        .filter(|spin| spin["stability"] == "unstable")
        .map(|spin| spin["energy"].as_f64().unwrap())
        .collect();
    let separatrices =
        ["separatrix_energy_1", "separatrix_energy_2"].map(|name| found[name].as_f64().unwrap());
    assert_eq!((spins.len(), unstable), (6, separatrices.to_vec()));
}

/// Free and driven wheels have the momentum that the first row gives them.
#[test]
fn an_audit_knows_wheels_that_are_free_or_driven_and_names_those_that_are_not_as_they_were_told() {
    let scratch = Scratch::new("wheels-audit-free");
    let fields = "--fields t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z";
    let held = "--wheel 0,1,1,0.05@600rpm";
    let free = "--wheel 1,0,0,0.1@-20,free";
    let driven = "--wheel 1,0,0,0.1@-20,torque=0.05,from=3.3,until=12.6";
    for (name, wheel, motion) in [
        ("free", free, "--until 20 --every 0.5"),
        // a motor that has begun before the start: the speed is that of the start
        ("driven", driven, "--start-time 5 --until 25 --every 0.5 --method taylor --step 0.1"),
    ] {
        let rows = output(&format!("propagate {MOMENTS} {held} {wheel} {MOTION} {motion} {fields}"));
        let file = scratch.file(&format!("{name}.csv"), rows);
        let verdict = |wheels: &str| {
            let line = format!("audit {file} {MOMENTS} {held} {wheels} --format json");
            let answer = polhode(&words(&line), &scratch.0);
            (answer.code, json(&answer.out))
        };
        let (code, found) = verdict(wheel);
        assert_eq!((code, found["verdict"].as_str()), (0, Some("right")), "{name}: {found:#}");
        let (code, found) = verdict(&wheel.replace("@-20", "@-20.4"));
        assert_eq!((code, found["suspect"].as_str()), (1, Some("other-wheel")), "{name}: {found:#}");
        assert_eq!(found["other_wheel"]["number"], 2);
        assert!((found["other_wheel"]["speed"].as_f64().unwrap() + 20.0).abs() < 1e-6, "{found:#}");
    }
}

/// Relative momenta of wheels are written beside the rates, and `fit` makes the tensor of body and wheels absolute by them.
#[test]
fn a_simulated_record_tells_the_momentum_of_its_wheels() {
    let scratch = Scratch::new("wheels-fit");
    let record = scratch.file("record.csv", "");
    let body = "--moments 1,2,2.6 --omega 1,2,0.5";
    for drive in ["", ",free", ",torque=0.02,from=4.03,until=20"] {
        let wheel = format!("--wheel 2,-3,4,0.1@5rad/s{drive}");
        output(&format!("simulate {body} {wheel} --until 30 --every 0.02 --noise 1e-3 --out {record}"));
        let answer = json(&output(&format!("fit {record} --format json")));
        for (k, moment) in [1.0, 2.0, 2.6].into_iter().enumerate() {
            // the wheel makes a difference of 0.014 to 0.055
            let found = answer["inertia"][k][k].as_f64().unwrap();
            assert!((found - moment).abs() < 5e-3, "{drive} {k}: {found}");
        }
        let numbers = |text: &str| -> Vec<Vec<f64>> {
            let rows = text.lines().skip(1);
            rows.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect()
        };
        let simulated =
            numbers(&output(&format!("simulate {body} {wheel} --until 30 --every 0.5 --format csv")));
        let fields = "--fields t,omega_body_x,omega_body_y,omega_body_z --format csv";
        let line =
            format!("propagate {body} {wheel} --until 30 --every 0.5 --method taylor --step 0.1 {fields}");
        let exact = numbers(&output(&line));
        assert_eq!(simulated.len(), exact.len());
        for (row, right) in simulated.iter().zip(&exact) {
            let off = row.iter().zip(right).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            assert!(off < 1e-11, "{drive} at {}: {off:e}", right[0]);
        }
    }
}

#[test]
fn members_of_an_ensemble_carry_wheels() {
    let scratch = Scratch::new("wheels-ensemble");
    let spec = |wheel: &str, method: &str| {
        format!(
            "[body]\nmoments = [10, 12, 15]\nwheels = [{{axis = [0, 1, 1], inertia = 0.05, {wheel}}}]\n[start]\nomega = [0.1, 0.02, 0.3]\n\
             [spread]\nomega = [0.01]\n[run]\nmembers = 20\nseed = 3\n{method}\ntimes = [40]\n"
        )
    };
    let summary = |name: &str, wheel: &str, method: &str| {
        let file = scratch.file(&format!("{name}.toml"), spec(wheel, method));
        let folder = scratch.0.join(name).display().to_string();
        output(&format!("ensemble {file} --out {folder}"));
        let read =
            |folder: &str| std::fs::read_to_string(scratch.0.join(folder).join("summary.csv")).unwrap();
        let text = read(name);
        // parts that are worked out elsewhere are checked and put together to the same bits
        for k in [2, 1] {
            output(&format!("ensemble {file} --out {folder}-parts --shard {k}/2"));
        }
        output(&format!("gather {folder}-parts"));
        assert_eq!(read(&format!("{name}-parts")), text, "{name}");
        text.lines().last().unwrap().split(',').map(|x| x.parse().unwrap_or(0.0)).collect::<Vec<f64>>()
    };
    let drives = ["", ", free = true", ", torque = 0.03, from = 7.5, until = 31"]
        .map(|drive| format!("speed = \"600rpm\"{drive}"));
    let mut seen: Vec<Vec<f64>> = Vec::new();
    for (name, wheel) in ["held", "free", "driven"].into_iter().zip(&drives) {
        let exact = if name == "driven" { "method = \"taylor\"\nstep = 0.5" } else { "method = \"exact\"" };
        let exact = summary(&format!("{name}-exact"), wheel, exact);
        let steps = summary(&format!("{name}-steps"), wheel, "method = \"two-turn@suzuki-4\"\nstep = 0.02");
        let near = |other: &[f64]| exact.iter().zip(other).skip(1).take(6).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(near(&steps), "{name}: {exact:?} {steps:?}");
        assert!(!seen.iter().any(|other| near(other)), "{name}: {exact:?}");
        seen.push(exact);
    }
    let driven = scratch.file("driven.toml", spec(&drives[2], "method = \"exact\""));
    let answer = polhode(&words(&format!("ensemble {driven} --out none")), &scratch.0);
    assert_eq!(answer.code, 2);
    assert!(answer.err.contains("while no motor acts"), "{}", answer.err);
    let tumbling = spec("speed = \"600rpm\"", "method = \"exact\"");
    let elements = "periods = [27.38, 263]\nmode = \"sam\"";
    let tumbling = tumbling
        .replace("omega = [0.1, 0.02, 0.3]", elements)
        .replace("omega = [0.01]", "periods = [0.1, 1]");
    let tumbling = scratch.file("tumbling.toml", tumbling);
    let answer = polhode(&words(&format!("ensemble {tumbling} --out none")), &scratch.0);
    assert_eq!(answer.code, 2);
    assert!(answer.err.contains("a body without wheels"), "{}", answer.err);
}

#[test]
fn wheels_that_are_wrong_are_refused_with_the_rule() {
    let scratch = Scratch::new("wheels-refused");
    let number = scratch.file(
        "number.toml",
        "wheels = [{axis = [0, 1, 1], inertia = 0.05, speed = 600}]\n[[part]]\nshape = \"sphere\"\nsize = [1]\nmass = 3\n",
    );
    for (line, said) in [
        (format!("propagate {MOMENTS} --wheel 0,0,0,0.1@3 {MOTION} --times 1"), "no direction"),
        (
            format!("propagate {MOMENTS} --wheel 1,0,0,8@3 {MOTION} --times 1"),
            "is too large for that of body and wheels",
        ),
        (
            format!("propagate {MOMENTS} --wheel 1,0,0,0.1@3Hz {MOTION} --times 1"),
            "unknown unit of rates 'Hz'",
        ),
        (format!("propagate --body {number} --omega 1,0,0 --times 1"), "600.0 has no unit"),
        (
            format!("propagate {MOMENTS} --wheel 1,0,0,0.1@3,torque=0.1 {MOTION} --times 1"),
            "the closed form holds only while no motor acts",
        ),
        (
            format!("propagate {MOMENTS} --wheel 1,0,0,0.1@3 {MOTION} --method dmv:10 --step 0.1 --times 1"),
            "cannot take wheels",
        ),
        (
            format!("propagate {MOMENTS} --wheel 1,0,0,0.1@3 --periods 2h,3h --mode lam --times 1"),
            "body without wheels",
        ),
        (format!("audit {number} --wheel 1,0,0,0.1@3"), "a wheel needs a body"),
        (format!("motion {MOMENTS} --omega 1,0,0 --steady"), "body with wheels"),
        (format!("motion {MOMENTS} --omega 1,0,0 --wheel 0,0,1,0.1@1e300"), "outside the range of a double"),
        (
            format!("simulate {MOMENTS} --wheel 1,0,0,12@3,free --omega 1,0,0 --until 1 --every 0.1"),
            "is too large for that of body and wheels",
        ),
    ] {
        let answer = polhode(&words(&line), &scratch.0);
        assert_eq!(answer.code, 2, "{line}: {}", answer.err);
        assert!(answer.err.contains(said), "{line}: {}", answer.err);
    }
}
