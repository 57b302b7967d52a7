//! `polhode compare`.

use std::fs;

use crate::harness::{Scratch, golden, output, polhode, refused, run, words};

const TEXTBOOK: &str = "compare --moments 1,2,3 --omega 0.4,1,-0.3";
/// Its motion, and a method beside it.
const MOTION: &str =
    "propagate --moments 1,2,3 --omega 0.4,1,-0.3 --until 20 --every 0.5 --fields t,q,omega --format csv";
const BESIDE: &str = "--until 20 --methods rk4 --steps 0.5 --trajectory";

/// Rows of a CSV by column, without the times of this machine.
fn rows(text: &str) -> Vec<Vec<(String, String)>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().unwrap().clone();
    let row = |record: csv::StringRecord| {
        let cells = header.iter().zip(record.iter()).map(|(name, cell)| (name.to_owned(), cell.to_owned()));
        cells.filter(|(name, _)| !["seconds", "rk4_steps"].contains(&name.as_str())).collect()
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

/// The cell of a row.
fn cell<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(column, _)| column == name).unwrap().1
}

fn number(row: &[(String, String)], name: &str) -> f64 {
    cell(row, name).parse().unwrap()
}

fn untimed(text: &str) -> String {
    let line = |row: Vec<(String, String)>| {
        row.into_iter().map(|(name, cell)| format!("{name}={cell}")).collect::<Vec<_>>().join(" ") + "\n"
    };
    rows(text).into_iter().map(line).collect()
}

#[test]
fn methods_at_steps_and_tolerances_are_rows() {
    let line = format!(
        "{TEXTBOOK} --until 64 --methods rk4,rattle,explicit-euler,dop853 --steps 0.125,0.0625 --tolerances 1e-6,1e-9"
    );
    let free = output(&line);
    let top = output(
        "compare --body gyroscope --omega 0,0,400 --attitude 0.9659258262890683,0.25881904510252074,0,0 --until 0.5 \
         --methods kick-drift@srkn-6b --steps 0.00048828125",
    );
    let asymmetric = output(
        "compare --moments 0.5,0.85,1 --weight-moment 0,0,1 --omega 0.4,1.1764705882352942,0.4 --attitude 0.4,0.2,0.4,0.8 \
         --until 32 --methods rk4 --steps 0.03125",
    );
    golden("compare.txt", &(untimed(&free) + &untimed(&top) + &untimed(&asymmetric)));
}

#[test]
fn errors_and_cost_are_those_of_the_run() {
    let found = rows(&output(&format!("{TEXTBOOK} --until 100 --methods rk4,rattle --steps 0.1,0.05")));
    // orders 4 and 2, four right sides and one solution a step
    let ratio = |k: usize| number(&found[k], "attitude_error") / number(&found[k + 1], "attitude_error");
    assert!((12.0..24.0).contains(&ratio(0)), "{}", ratio(0));
    assert!((3.5..4.5).contains(&ratio(2)), "{}", ratio(2));
    let evaluations: Vec<&str> = found.iter().map(|row| cell(row, "evaluations")).collect();
    assert_eq!(evaluations, ["4000", "8000", "1000", "2000"]);
    // the same errors as those of a single run
    let row = output("propagate --moments 1,2,3 --omega 0.4,1,-0.3 --times 100 --method rk4 --step 0.1");
    let single = &rows(&row)[0];
    for name in ["attitude_error", "energy_error", "momentum_error", "momentum_vector_error"] {
        assert_eq!(cell(&found[0], name), cell(single, name), "{name}");
    }
}

#[test]
fn the_phase_error_is_predicted_and_taken_back() {
    let free = "compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 100 --steps 0.05 --phase --methods";
    let table = output(&format!("{free} rattle,two-turn,two-turn+phase,rk4,taylor"));
    let rows = rows(&table);
    // two turns oscillate as well
    for (row, share) in rows.iter().zip([1e-9, 0.05]) {
        let (measured, predicted) = (number(row, "attitude_error"), number(row, "predicted_error"));
        assert!((predicted / measured - 1.0).abs() < share, "{row:?}");
        assert!(cell(row, "prediction").starts_with("rates to "), "{row:?}");
    }
    assert!(number(&rows[2], "attitude_error") < 0.05 * number(&rows[1], "attitude_error"));
    assert_eq!(cell(&rows[2], "method"), "two-turn+phase");
    assert_eq!(cell(&rows[2], "prediction"), "taken back");
    assert_eq!(cell(&rows[3], "prediction"), "none: its energy drifts");
    assert_eq!(cell(&rows[4], "prediction"), "none: the method chooses its steps");
    let refused = |line: &str, words: &str| {
        let found = run(line);
        assert!(found.code != 0 && found.err.contains(words), "{line}: {} {}", found.code, found.err);
    };
    refused(&format!("{free} rk4+phase"), "its energy drifts");
    refused(&format!("{free} rattle+phase+phase"), "corrects its phase error");
    // under weak forces both are as those of the free body for a while
    let weak = "compare --moments 1,2,3 --omega 0.4,1,-0.3 --gravity-gradient 0.01 --steps 0.05 --phase --methods rattle,rattle+phase";
    let found = self::rows(&output(&format!("{weak} --until 20")));
    let (error, predicted) = (number(&found[0], "attitude_error"), number(&found[0], "predicted_error"));
    assert!((predicted / error - 1.0).abs() < 0.02, "{found:?}");
    assert!(number(&found[1], "attitude_error") < 0.02 * error && cell(&found[1], "evaluations").is_empty());
    refused(&format!("{weak} --until 20000"), "where its growth may differ by a hundredth");
    refused(
        "compare --moments 1,1,0.5 --omega 0,0.1,20 --weight-moment 0,0,1 --until 1 --steps 0.125 --methods rattle+phase",
        "rattle+phase",
    );
    refused(
        "compare --moments 1,2,3 --omega 0.4,1,-0.3 --until 100 --steps 2.5 --methods rattle@suzuki-4,two-turn+phase",
        "too few to tell",
    );
}

#[test]
fn runs_that_lose_the_attitude_say_when() {
    let found = rows(&output(&format!("{TEXTBOOK} --until 200 --methods explicit-euler,buss-2 --steps 0.5")));
    assert!(cell(&found[0], "status").starts_with("diverged at t = "), "{:?}", found[0]);
    assert!(cell(&found[1], "status").starts_with("lost at t = "), "{:?}", found[1]);
    for row in &found {
        assert_eq!((cell(row, "attitude_error"), cell(row, "attitude_time")), ("", ""));
    }
}

/// A file of [`MOTION`] with other rates, by the number of the row.
fn with_rates(text: &str, of: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> String {
    let row = |(k, line): (usize, &str)| {
        let cells: Vec<&str> = line.split(',').collect();
        let rates = [5, 6, 7].map(|column| cells[column].parse().ok());
        let [Some(x), Some(y), Some(z)] = rates else { return format!("{line}\n") };
        let [x, y, z] = of(k, [x, y, z]);
        format!("{},{x:e},{y:e},{z:e}\n", cells[..5].join(","))
    };
    text.lines().enumerate().map(row).collect()
}

#[test]
fn a_trajectory_of_another_program_is_a_row() {
    let scratch = Scratch::new("compare-trajectory");
    let exact = output(MOTION);
    let right = scratch.file("right.csv", &exact);
    let mistaken = scratch.file("mistaken.csv", exact.replace("q_w,q_x,q_y,q_z", "q_x,q_y,q_z,q_w"));
    let line = format!(
        "{TEXTBOOK} --until 20 --methods rk4 --steps 0.5 --trajectory {right} --trajectory {mistaken}"
    );
    let answer = run(&line);
    let elsewhere = "mistaken.csv: its first attitude differs by 3.14 rad from the true motion";
    assert!(answer.code == 0 && answer.err.contains(elsewhere), "{}", answer.err);
    let found = rows(&answer.out);
    assert_eq!(cell(&found[1], "method"), right);
    assert!(number(&found[1], "attitude_error") < 1e-14);
    assert_eq!(number(&found[1], "attitude_time"), 20.0);
    for name in ["energy_error", "momentum_error", "momentum_vector_error"] {
        assert!(number(&found[1], name) < 1e-14, "{name}");
    }
    let flips = |row| ["flips", "flips_exact", "flips_right"].map(|name| cell(row, name).to_owned());
    assert_eq!(flips(&found[0]), flips(&found[1]));
    assert!(cell(&found[2], "status").starts_with("lost at t = "));

    let flags = |file: &str| format!("{TEXTBOOK} --until 20 --methods rk4 --steps 0.5 --trajectory {file}");
    let bad = |name: &str, text: &str| scratch.file(name, text);
    // half the angular velocity is a quarter of the energy, and half of L in the right direction; of another sign it is twice L off:
    // both contradict the attitudes
    for (factor, [energy, momentum], told) in
        [(0.5, [0.75, 0.5], "by 0.50 of their size"), (-1.0, [0.0, 2.0], "by 2.00 of their size")]
    {
        let text = with_rates(&exact, |_, rates| rates.map(|rate| factor * rate));
        let answer = run(&flags(&bad("scaled.csv", &text)));
        let row = &rows(&answer.out)[1];
        assert!((number(row, "energy_error") - energy).abs() < 1e-12, "{row:?}");
        assert!((number(row, "momentum_vector_error") - momentum).abs() < 1e-12, "{row:?}");
        assert_eq!(cell(row, "status"), "rates contradict");
        for part in ["scaled.csv: its angular velocities differ", told, "contradict each other"] {
            assert!(answer.err.contains(part), "{part}: {}", answer.err);
        }
        // the table is printed, and its file is not promised to be right
        let failure = "error: rates and attitudes contradict each other: ";
        assert!(answer.code == 1 && answer.err.contains(failure), "{}", answer.err);
    }
    // without angular velocities there is the attitude alone
    let attitudes: Vec<String> =
        exact.lines().map(|line| line.split(',').take(5).collect::<Vec<_>>().join(",")).collect();
    let found = rows(&output(&flags(&bad("attitudes.csv", &attitudes.join("\n")))));
    assert!(number(&found[1], "attitude_error") < 1e-14);
    assert_eq!((cell(&found[1], "energy_error"), cell(&found[1], "flips")), ("", ""));
    refused(
        &flags(&bad("g.csv", "t,w,x,y,z,wx,wy\n1,1,0,0,0,0,0\n")),
        &["g.csv, line 1: no column for the rate about z", "'wx', 'wy'"],
    );
    refused(&flags("missing.csv"), &["missing.csv", "cannot be read", "name a text file"]);
    refused(
        &flags(&bad("a.csv", "t,q_w,q_x,q_y\n0,1,0,0\n")),
        &["a.csv, line 1: no column for the component of the attitude z"],
    );
    refused(
        &flags(&bad("b.csv", "t,w,x,y,z\n1,1,0,0,0\n1,1,0,0,0\n")),
        &["b.csv, line 3, column 1 (t): '1'", "two rows have the same time"],
    );
    refused(&flags(&bad("c.csv", "t,w,x,y,z\n21,1,0,0,0\n")), &["c.csv: '21'", "t from 0 to 20"]);
    refused(
        &flags(&bad("d.csv", "t,w,x,y,z\n2,0,0,0,0\n")),
        &["d.csv, line 2, column 2 (w): '0'", "is not a rotation"],
    );
    refused(
        &flags(&bad("e.csv", "t,w,x,y,z\n2,1,0,zero,0\n")),
        &["e.csv, line 2, column 4 (y): 'zero': is not a number"],
    );
    refused(&flags(&bad("f.csv", "t,w,x,y,z\n")), &["f.csv", "no rows"]);
}

#[test]
fn flips_of_a_trajectory_are_compared_with_those_of_the_true_motion_at_its_rows() {
    let scratch = Scratch::new("compare-flips");
    let coarse = MOTION.replace("--until 20 --every 0.5", "--until 64 --every 16");
    let coarse = scratch.file("coarse.csv", output(&coarse));
    let found =
        rows(&output(&format!("{TEXTBOOK} --until 64 --methods rk4 --steps 0.125 --trajectory {coarse}")));
    // eight flips, of which four intervals show four at most
    assert_eq!(cell(&found[0], "flips_exact"), "8");
    assert!(number(&found[1], "flips") <= 4.0, "{found:?}");
    assert_eq!(cell(&found[1], "flips"), cell(&found[1], "flips_exact"));
    assert_eq!(cell(&found[1], "flips_right"), "right");
}

/// About a steady spin the component along the middle axis is rounding, whose sign tells nothing.
#[test]
fn rounding_about_a_steady_spin_is_no_flip() {
    let scratch = Scratch::new("compare-steady");
    let spin = |text: &str| text.replace("0.4,1,-0.3", "1e-17,1e-17,1");
    let noisy =
        with_rates(&output(&spin(MOTION)), |k, [x, _, z]| [x, if k % 2 == 0 { 1e-16 } else { -1e-16 }, z]);
    let file = scratch.file("steady.csv", noisy);
    let found = rows(&output(&spin(&format!("{TEXTBOOK} {BESIDE} {file}"))));
    for row in &found {
        let flips = ["flips", "flips_exact", "flips_right", "status"].map(|name| cell(row, name));
        assert_eq!(flips, ["0", "0", "right", "ok"], "{row:?}");
    }
}

#[test]
fn what_a_trajectory_holds_and_is_not_compared_is_told() {
    let scratch = Scratch::new("compare-unread");
    let text = output(MOTION);
    let (header, motion) = text.split_once('\n').unwrap();
    let file = |name: &str, more: &str, of: &dyn Fn(&[f64]) -> String| {
        let row = |line: &str| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            format!("{line},{}\n", of(&cells))
        };
        scratch.file(name, format!("{header},{more}\n{}", motion.lines().map(row).collect::<String>()))
    };
    let told = |file: &str| {
        let answer = run(&format!("{TEXTBOOK} {BESIDE} {file}"));
        assert_eq!(answer.code, 0, "{}", answer.err);
        answer.err
    };
    // a time of a unit comes before one without
    let same = file("same.csv", "time_ms,lift", &|row| format!("{},7", 1000.0 * row[0]));
    assert_eq!(told(&same), format!("warning: {same}: not read: t, lift\n"));
    let late = |row: &[f64]| if row[0] > 10.0 { 400.0 } else { 0.0 };
    let jump = file("jump.csv", "time_ms", &|row| format!("{}", 1000.0 * row[0] - late(row)));
    let says = "not read: t; column 't' is also a time and contradicts the times that are read";
    assert!(told(&jump).contains(says), "{}", told(&jump));
    let momenta =
        file("momenta.csv", "lx,ly,lz", &|row| format!("{},{},{}", row[5], 2.0 * row[6], 3.0 * row[7]));
    assert_eq!(told(&momenta), format!("warning: {momenta}: its angular momenta are not compared\n"));
}

/// Rates in deg/s whose names say no unit are read as such, and not in silence.
#[test]
fn a_convention_that_rows_show_and_names_do_not_say_is_told() {
    let scratch = Scratch::new("compare-shown");
    let text = output(&MOTION.replace("--every 0.5", "--every 0.25"));
    let right = scratch.file("right.csv", &text);
    assert_eq!(run(&format!("{TEXTBOOK} {BESIDE} {right}")).err, "");
    let degrees = with_rates(&text, |_, rates| rates.map(f64::to_degrees));
    let degrees = scratch.file("degrees.csv", degrees);
    let answer = run(&format!("{TEXTBOOK} {BESIDE} {degrees}"));
    let row = &rows(&answer.out)[1];
    assert!(answer.code == 0 && number(row, "energy_error") < 1e-14, "{row:?}");
    let says =
        format!("note: {degrees}: its rows show how it is read: quaternion w,x,y,z; attitude body to space");
    assert!(
        answer.err.starts_with(&says) && answer.err.contains("omega in body axes, deg/s"),
        "{}",
        answer.err
    );
}

#[test]
fn flags_that_no_trajectory_has_a_use_for_are_refused() {
    let scratch = Scratch::new("compare-flags");
    let poses = "t,q_w,q_x,q_y,q_z\n0,1,0,0,0\n1,1,0,0,0\n";
    let dated = poses.replace("\n0,", "\n2026-01-01T00:00:00Z,").replace("\n1,", "\n2026-01-01T00:00:01Z,");
    let dates = scratch.file("dates.csv", dated);
    let line = format!("{TEXTBOOK} {BESIDE}");
    for (flags, says) in [
        ("--time-unit ms", "--time-unit: 'ms': the times of"),
        ("--columns t=t --sample-rate 20", "--sample-rate: '20': the times of"),
    ] {
        refused(&format!("{line} {dates} {flags}"), &[says, "are dates already; leave it out"]);
    }
    let both = format!("{line} {dates} --time-unit ms --sample-rate 20");
    refused(&both, &["--sample-rate", "cannot be used with"]);
    let parameters = scratch.file("mrp.csv", "t,sigma_1,sigma_2,sigma_3\n0,0,0,0\n1,0,0,0\n");
    let order = "--quaternion xyzw";
    refused(
        &format!("{line} {parameters} {order}"),
        &["--quaternion: 'xyzw': is for a quaternion, and none is read"],
    );
    // one of several has a use for it
    let numbered = scratch.file("numbered.csv", poses.replace("q_w,q_x,q_y,q_z", "q0,q1,q2,q3"));
    assert_eq!(run(&format!("{line} {parameters} --trajectory {numbered} {order}")).code, 0);
}

#[test]
fn the_motion_of_another_body_is_not_compared() {
    let scratch = Scratch::new("compare-other");
    let file = scratch.file("exact.csv", output(&MOTION.replace("--every 0.5", "--every 0.25")));
    assert_eq!(run(&format!("{TEXTBOOK} {BESIDE} {file}")).code, 0);
    for moments in ["1,2,2.2", "2,1,3"] {
        let line = format!("compare --moments {moments} --omega 0.4,1,-0.3 {BESIDE} {file}");
        refused(&line, &["exact.csv: its rows are those of a body with other moments", "name its body"]);
    }
}

#[test]
fn rows_beside_the_known_motion_are_not_judged() {
    let scratch = Scratch::new("compare-beside");
    let early = scratch.file("early.csv", "t,q_w,q_x,q_y,q_z\n2,1,0,0,0\n");
    let says = "early.csv: '2': lies outside of the run, t from 5 to 20";
    refused(&format!("{TEXTBOOK} --start-time 5 {BESIDE} {early}"), &[says]);
    // two runs of a chaotic top part long before
    let start = "0.99855035,0.049975836,0.019990334,0";
    let top = format!(
        "compare --moments 0.5,0.85,1 --weight-moment 0,0,1 --omega 0.2,0.235,0.5 --attitude {start} \
         --until 600 --methods rk4 --steps 0.5 --trajectory"
    );
    let late = "599,1,0,0,0\n600,1,0,0,0\n";
    let file = scratch.file("late.csv", format!("t,q_w,q_x,q_y,q_z\n{late}"));
    let answer = run(&format!("{top} {file}"));
    assert_eq!((answer.code, answer.out.as_str()), (2, ""), "{}", answer.err);
    let says = "late.csv: '599': the true motion is known until t = ";
    assert!(answer.err.contains(says), "{}", answer.err);
    let file = scratch.file("start.csv", format!("t,q_w,q_x,q_y,q_z\n0,{start}\n{late}"));
    let answer = run(&format!("{top} {file}"));
    let row = &rows(&answer.out)[1];
    assert_eq!((cell(row, "status"), number(row, "attitude_time")), ("ok", 0.0));
    assert!(
        answer.err.contains("its last row is at t = 0 s: its errors are those at that time"),
        "{}",
        answer.err
    );
    let failure = format!("error: no row after the start is compared: {file}");
    assert!(answer.code == 1 && answer.err.contains(&failure), "{}", answer.err);
    // one row, which is the start
    let alone = scratch.file("alone.csv", "t,q_w,q_x,q_y,q_z\n0,1,0,0,0\n");
    let answer = run(&format!("{TEXTBOOK} {BESIDE} {alone}"));
    assert_eq!(answer.code, 1, "{}", answer.err);
    assert!(answer.err.contains("no row after the start is compared: "), "{}", answer.err);
}

#[test]
fn the_momentum_of_a_driven_wheel_is_not_taken_for_that_of_the_start() {
    let scratch = Scratch::new("compare-motor");
    let body = "--moments 70,90,120 --omega 0.01,0,0.2 --wheel 0,1,0,0.06@2000rpm,torque=0.01 --until 60";
    let line = format!("propagate {body} --every 1 --method rk4 --step 0.1 --fields t,q,omega --format csv");
    let file = scratch.file("run.csv", run(&line).out);
    let answer = run(&format!("compare {body} --methods rk4 --steps 0.5 --trajectory {file}"));
    assert_eq!(answer.code, 0, "{}", answer.err);
    let found = rows(&answer.out);
    assert!(number(&found[1], "attitude_error") < 1e-6, "{found:?}");
    // both conserve the momentum of body and wheel
    assert!(number(&found[0], "momentum_vector_error") < 1e-3, "{found:?}");
    assert_eq!((cell(&found[1], "momentum_error"), cell(&found[1], "momentum_vector_error")), ("", ""));
}

#[test]
fn the_figure_is_written_whole() {
    let scratch = Scratch::new("compare-figure");
    let line = format!("{TEXTBOOK} --until 16 --methods rk4,rattle --steps 0.25,0.125 --figure work.svg");
    assert_eq!(polhode(&words(&line), &scratch.0).code, 0);
    let svg = fs::read_to_string(scratch.0.join("work.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("rattle") && svg.trim_end().ends_with("</svg>"));
    // nothing is left to draw
    let lost =
        polhode(&words(&line.replace("rk4,rattle", "explicit-euler").replace("16", "512")), &scratch.0);
    assert_eq!(lost.code, 1);
    assert!(lost.err.contains("every attitude is lost"), "{}", lost.err);
}

#[test]
fn what_cannot_be_compared_is_refused_with_a_remedy() {
    let line = |flags: &str| format!("{TEXTBOOK} --until 100 {flags}");
    refused(
        &line("--methods rk4 --steps 0.3"),
        &["--steps: '0.3'", "no whole number of these steps leads to --until 100", "use 0.3003003003003003"],
    );
    refused(&line("--methods rk4"), &["--steps: missing: rk4 needs steps", "--steps h1,h2"]);
    refused(&line("--methods rk4,rkk4 --steps 1"), &["--methods: 'rkk4'", "did you mean 'rk4'?"]);
    refused(&line("--methods exact,rk4 --steps 1"), &["--methods: 'exact'", "the reference", "exact-step"]);
    refused(&line("--methods kick-drift --steps 1 --drag 0.1"), &["--methods:", "cannot take drag", "rk4"]);
    refused(&line("--methods rk4 --steps 1 --tolerances 1e-3"), &["--tolerances: '1e-3'", "dop853"]);
    refused(&line("--methods dop853 --tolerances 1"), &["--tolerances:", "1e-15", "1e-3"]);
    let twice = line("--methods dop853:1e-8 --tolerances 1e-6");
    refused(&twice, &["--tolerances: '1e-6'", "a tolerance in its name"]);
    refused(&line("--methods dop853,tsit5 --steps 1,2"), &["--steps: '1,2'", "chooses its steps"]);
    refused(&line("--methods rk4 --steps 1 --time-unit ms"), &["--time-unit", "give --trajectory"]);
    refused(&line("--methods rk4 --steps 0"), &["--steps", "item 1", "not positive"]);
    refused(
        &format!("{TEXTBOOK} --until -1 --methods rk4 --steps 1"),
        &["--until: '-1'", "must come after the start", "later"],
    );
    refused(&format!("{TEXTBOOK} --until 1e40 --methods rk4 --steps 1e39"), &["--until", "1e40"]);
    let answer = run(&line("--steps 1"));
    assert_eq!(answer.code, 2);
}
