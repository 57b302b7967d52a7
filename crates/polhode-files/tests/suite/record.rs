//! Records as phones and loggers write them: read, cleaned, split, or refused by line and column.

use nalgebra::Vector3;
use polhode::record::{Record, RecordError, Segment};
use polhode::units::{RateUnit, TimeUnit};
use polhode_files::Error;
use polhode_files::record::{self, ReadOptions};

fn read(text: &str) -> Result<Record, Error> {
    record::read(text, "a.csv", &ReadOptions::default()).map(|found| found.record)
}

#[test]
fn spellings_of_phones_and_loggers_are_understood() {
    for header in [
        "t,wx,wy,wz",
        "\"Time (s)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\",\"Gyroscope z (rad/s)\",\"Absolute (rad/s)\"",
        "# made by a logger\n#time      ωₓ (rad/s)      ωᵧ (rad/s)      ωᶻ (rad/s)      ω_total (rad/s)",
        "seconds_elapsed;gyro_x;gyro_y;gyro_z",
        "Timestamp\tGyrX [rad/s]\tGyrY [rad/s]\tGyrZ [rad/s]",
        "time,omega_body_x,omega_body_y,omega_body_z",
    ] {
        let separator = [",", ";", "\t", "      "].into_iter().find(|s| header.contains(s)).unwrap();
        let columns = header.lines().last().unwrap().split(separator).count();
        let row = |t: &str| {
            ["1", "2", "3", "9"][..columns - 1]
                .iter()
                .fold(t.to_string(), |r, c| format!("{r}{separator}{c}"))
        };
        let record = read(&format!("{header}\n{}\n{}\n", row("0.5"), row("0.75"))).unwrap();
        assert_eq!(record.segments[0].times(), [0.5, 0.75], "{header}");
        assert_eq!(record.segments[0].rates()[1], Vector3::new(1.0, 2.0, 3.0), "{header}");
    }
}

#[test]
fn broken_rows_are_named_by_line_and_column() {
    for (text, expected) in [
        ("t,wx,wy\n0,1,2\n", "a.csv, line 1: no column for the rate about z; the header has 't', 'wx', 'wy'"),
        ("t,wx,wy,wz\n0,1,2\n", "a.csv, line 2: the row has 3 of 4 columns"),
        ("t,wx,wy,wz\n0,1,2,3\n1,1,x,3\n", "a.csv, line 3, column 3 (wy): 'x': is not a number"),
        ("t,wx,wy,wz\n0,1,2,3\n\n1,1,2,inf\n", "a.csv, line 4, column 4 (wz): 'inf': is not a finite number"),
        (
            "t,wx,wy,wz\n1,1,2,3\n0.5,1,2,3\n",
            "a.csv, line 3, column 1 (t): '0.5': comes before the time above it, 1 s",
        ),
        (
            "t,wx (mph),wy,wz\n1,1,2,3\n",
            "a.csv, line 1, column 2 (wx (mph)): 'mph': unknown unit; known: rad/s, deg/s, rpm",
        ),
        ("t,wx,wy,wz\n", "a.csv: no rows"),
    ] {
        let message = read(text).unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message}");
    }
    let setting = ReadOptions::default().with_rate_unit(RateUnit::DegreesPerSecond);
    let clash = record::read("t,wx (rad/s),wy,wz\n1,1,2,3\n", "a.csv", &setting).unwrap_err().to_string();
    assert!(clash.contains("says rad/s") && clash.contains("says deg/s"), "{clash}");
}

#[test]
fn gaps_split_and_windows_cut() {
    let mut text = String::from("t,wx,wy,wz\n");
    for i in (0..50).chain(80..120) {
        text += &format!("{},{i},1,2\n", f64::from(i) / 100.0);
    }
    let record = read(&text).unwrap();
    assert_eq!((record.segments.len(), record.gaps(), record.samples()), (2, 1, 90));
    let cut = record.windows(&[(0.1, 0.2), (0.4, 0.9)]).unwrap();
    let lengths: Vec<usize> = cut.segments.iter().map(|s| s.times().len()).collect();
    assert_eq!(lengths, [11, 10, 11]);
    assert_eq!((cut.gaps(), record.windows(&[(0.1, 0.4)]).unwrap().gaps()), (1, 0));
    assert!(record.windows(&[(0.55, 0.7)]).unwrap_err().to_string().contains("from 0 s to 1.19 s"));
    assert!(record.windows(&[(2.0, 1.0)]).is_err());
}

#[test]
fn flat_tops_are_left_out_and_quiet_axes_are_not() {
    let clipped = |i: i32| (f64::from(i) / 20.0 - 2.0).clamp(-1.0, 1.5);
    let times: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.01).collect();
    let rates: Vec<_> = (0..100).map(|i| Vector3::new(clipped(i), 7.0, f64::from(i))).collect();
    let record = Record::from_samples(&times, &rates).unwrap();
    // −1 up to i = 20, 1.5 from i = 70
    assert_eq!(record.saturated(), 21 + 30);
    assert_eq!(record.samples(), 49);
    assert_eq!(record.windows(&[(0.0, 0.5)]).unwrap().saturated(), 21);
}

#[test]
fn repeated_readings_are_left_out_and_rounded_or_resting_ones_are_not() {
    let wave = |t: f64| Vector3::new(libm::sin(0.7 * t), libm::cos(t), libm::sin(1.3 * t));
    let record = |rate: u32, reading: &dyn Fn(u32) -> Vector3<f64>| {
        let times: Vec<f64> = (0..20 * rate).map(|i| f64::from(i) / f64::from(rate)).collect();
        let rates: Vec<_> = (0..20 * rate).map(reading).collect();
        Record::from_samples(&times, &rates).unwrap()
    };
    let rounded = |w: Vector3<f64>, step: f64| w.map(|c| libm::round(c / step) * step);
    for log in [130, 150, 200, 400, 1000] {
        for step in [1e-3, f64::EPSILON] {
            // a sensor of 100 Hz in a log of another rate; a clipped one stays clipped
            let read = |k: u32| rounded(wave(f64::from(k) / 100.0), step);
            let held = |i: u32| read(i * 100 / log);
            // at their peaks rounded readings may agree
            let new = 1 + (1..2000).filter(|k| read(*k) != read(k - 1)).count();
            let found = record(log, &held);
            assert_eq!((found.samples(), found.saturated()), (new, 0), "{log} Hz, step {step}");
            assert_eq!(found.repeated(), (20 * log) as usize - new, "{log} Hz, step {step}");
            let clipped = record(log, &|i| held(i).map(|c| c.clamp(-0.8, 0.8)));
            assert!(clipped.saturated() > 500, "{log} Hz, step {step}");
        }
    }
    // slow rates, rounded: equal for a while, then another step
    let slow = record(100, &|i| rounded(wave(f64::from(i) / 100.0), 0.1));
    assert_eq!((slow.repeated(), slow.samples() + slow.saturated()), (0, 2000));
    assert_eq!(slow.new_readings_rate(), None);
    // at rest for half of the time
    let resting = record(100, &|i| wave(f64::from(i.max(1000)) / 100.0));
    assert_eq!(resting.repeated(), 0);
}

#[test]
fn decimal_commas_are_read_between_semicolons() {
    let record = read("t;wx;wy;wz\n0,5;0,1;-1e-1;3\n0,75;1;2,25;-3,5\n").unwrap();
    assert_eq!(record.segments[0].times(), [0.5, 0.75]);
    assert_eq!(record.segments[0].rates()[1], Vector3::new(1.0, 2.25, -3.5));
    let broken = read("t;wx;wy;wz\n0,5;1,000,5;0;3\n").unwrap_err().to_string();
    assert!(broken.contains("line 2, column 2 (wx): '1,000,5'"), "{broken}");
}

#[test]
fn rounded_peaks_and_quiet_axes_are_not_flat_tops() {
    let times: Vec<f64> = (0..2000).map(|i| f64::from(i) * 0.01).collect();
    let rounded = |x: f64, step: f64| libm::round(x / step) * step;
    let wave = |t: f64| libm::sin(0.7 * t);
    let at = |step: f64| -> Vec<Vector3<f64>> {
        // the last one flickers by one step
        let third = |i: usize| 1.0 + step * f64::from(u8::from(i % 7 > 3));
        times
            .iter()
            .enumerate()
            .map(|(i, t)| Vector3::new(rounded(wave(*t), step), wave(*t), third(i)))
            .collect()
    };
    for step in [0.05, 0.01, 1e-3, f64::EPSILON] {
        let record = Record::from_samples(&times, &at(step)).unwrap();
        assert_eq!(record.saturated(), 0, "step {step}");
    }
    // the same wave beyond a sensor's range
    for step in [0.01, 1e-3] {
        let clipped: Vec<_> = at(step).iter().map(|w| w.map(|c| c.clamp(-0.8, 0.8))).collect();
        let record = Record::from_samples(&times, &clipped).unwrap();
        let beyond = clipped.iter().filter(|w| w.x.abs() == 0.8 || w.y.abs() == 0.8).count();
        assert_eq!(record.saturated(), beyond, "step {step}");
    }
}

#[test]
fn overlapping_windows_are_one_and_units_end_names() {
    let mut text = String::from("time_ms,wx,wy,wz\n");
    (0..100).for_each(|i| text += &format!("{},{i},1,2\n", 10 * i));
    let record = read(&text).unwrap();
    assert_eq!(record.segments[0].times()[99], 0.99);
    let twice = record.windows(&[(0.3, 0.6), (0.0, 0.4), (0.6, 0.9), (0.0, 0.4)]).unwrap();
    assert_eq!((twice.segments.len(), twice.samples()), (2, 61 + 30));
    assert_eq!(read(&text.replace("time_ms", "timestampNs")).unwrap().segments[0].times()[99], 990e-9);
    assert!(record::read(&text, "a", &ReadOptions::default().with_time_unit(TimeUnit::Seconds)).is_err());
}

fn only(text: &str) -> (Vec<f64>, Vec<[f64; 3]>) {
    let record = read(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(record.segments.len(), 1, "{text}");
    let segment = &record.segments[0];
    (segment.times().to_vec(), segment.rates().iter().map(|w| [w.x, w.y, w.z]).collect())
}

fn refusal(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

#[test]
fn rows_longer_than_their_header_are_refused() {
    for (text, cells, columns) in [
        ("t,wx,wy,wz\n0,1,2,3\n0,5,1,2,3\n", 5, 4),
        ("t,wx,wy,wz\n0,1,2,3\n0,5,1,0,2,0,3,0\n", 8, 4),
        ("t,wx,wy,wz\n0,1,2,3\n1,1,2,3,,\n", 6, 4),
        ("t,wx,wy,wz,\n0,1,2,3,\n1,1,2,3,,7\n", 6, 5),
        ("t;wx;wy;wz\n0;1;2;3\n1;1;2;3;4\n", 5, 4),
        ("t\twx\twy\twz\n0\t1\t2\t3\n\t1\t1\t2\t3\n", 5, 4),
        ("t wx wy wz\n0 1 2 3\n1 1 2 3 4\n", 5, 4),
    ] {
        let expected = format!("a.csv, line 3: {cells} cells where the header has {columns}; ");
        let message = refusal(text);
        assert!(message.starts_with(&expected), "{text}: {message}");
    }
    // a separator at the end of each row, or of the header alone
    for text in [
        "t,wx,wy,wz\n0,1,2,3,\n1,4,5,6, \n",
        "t;wx;wy;wz\n0;1;2;3;\n1;4;5;6;\n",
        "t\twx\twy\twz\n0\t1\t2\t3\t\n1\t4\t5\t6\t\n",
        "t,wx,wy,wz,\n0,1,2,3,\n1,4,5,6\n",
        // a column of row numbers without a name
        "\tt\twx\twy\twz\n7\t0\t1\t2\t3\n8\t1\t4\t5\t6\n",
    ] {
        assert_eq!(only(text), (vec![0.0, 1.0], vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), "{text}");
    }
}

#[test]
fn quoted_cells_stay_whole() {
    let text = "\"t\",wx,note,wy,wz\n\
                \"0,5\",\"-0,125\",\"a, b; \"\"c\"\", d\",\"1000,125\",\"+1,25\"\n";
    assert_eq!(only(text), (vec![0.5], vec![[-0.125, 1000.125, 1.25]]));
    assert_eq!(only("t wx wy wz\n\"0,5\" 1 2 3\n"), (vec![0.5], vec![[1.0, 2.0, 3.0]]));
    // a mark of inches opens no quote
    assert_eq!(only("t,wx,tube,wy,wz\n0,1,5\",2,3\n"), (vec![0.0], vec![[1.0, 2.0, 3.0]]));
    for value in ["1,000", "-12,345", "123,456", "1,234.5", "1,000,000", "1,000e1"] {
        let message = refusal(&format!("t,wx,wy,wz\n0.5,\"{value}\",0,0\n"));
        let start =
            format!("a.csv, line 2, column 2 (wx): '{value}': has a comma that may separate thousands");
        assert!(message.starts_with(&start), "{message}");
    }
    let half = refusal("t,wx,wy,wz\n0,\"1,2,3\n");
    assert!(half.starts_with("a.csv, line 2: the row has 2 of 4 columns"), "{half}");
}

#[test]
fn a_time_with_a_unit_wins_over_a_bare_one() {
    for (header, times) in [
        ("time,seconds_elapsed,z,y,x", [0.25, 0.5]),
        ("time,time_s,z,y,x", [0.25, 0.5]),
        ("t,Elapsed (ms),z,y,x", [0.25e-3, 0.5e-3]),
        ("timestamp_ns,seconds_elapsed,z,y,x", [0.25, 0.5]),
        // no unit is in these names
        ("frame,time,z,y,x", [0.25, 0.5]),
        ("ts,t,z,y,x", [0.25, 0.5]),
    ] {
        let text = format!("{header}\n1727600000250000000,0.25,3,2,1\n1727600000500000000,0.5,6,5,4\n");
        assert_eq!(only(&text), (times.to_vec(), vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), "{header}");
    }
    // the unit of the name is not overruled
    for name in ["seconds_elapsed", "time_s"] {
        let setting = ReadOptions::default().with_time_unit(TimeUnit::Nanoseconds);
        let text = format!("time,{name},z,y,x\n1,0.25,3,2,1\n");
        let clash = record::read(&text, "a.csv", &setting).unwrap_err().to_string();
        assert!(clash.contains(&format!("({name}): the header says s, the flag says ns")), "{clash}");
    }
}

#[test]
fn columns_of_text_may_stand_anywhere() {
    let expected = (vec![0.0, 0.5], vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    for text in [
        "run,t,wx,wy,wz\nr1,0,1,2,3\nr1,0.5,4,5,6\n",
        "date,seconds_elapsed,x,y,z\n2024-05-01T10:00:00Z,0,1,2,3\n2024-05-01T10:00:00.5Z,0.5,4,5,6\n",
        "date;t;wx;wy;wz;note\n01.05.2024 10:00;0,0;1;2;3;begin, rest\n01.05.2024 10:00;0,5;4;5;6;\n",
        "run  t  wx  wy  wz\nr 1  0  1  2  3\nr 1  0.5  4  5  6\n",
        // numbers, and the names of axes, in a preamble
        "Range,-2000,2000\n# axes: t x y z\nSerial 12\n\n#run,t,wx,wy,wz\nr1,0,1,2,3\n# pause\nr1,0.5,4,5,6\n",
        "run,t,wx,wy,wz\n# columns t x y z\nr1,0,1,2,3\nr1,0.5,4,5,6\n",
        "t x y z\nwz,wy,wx,t\n3,2,1,0\n6,5,4,0.5\n",
    ] {
        assert_eq!(only(text), expected, "{text}");
    }
    for (text, start) in [
        (
            "made by hand\nrun,t,wx,wy\n#\nr1,0,1,2\nr2,1,1,2\n",
            "a.csv, line 2: no column for the rate about z; the header has 'run', 't', 'wx', 'wy'",
        ),
        (
            "made by hand on Monday\nday,hour,wx\nMay,ten,a\nMay,ten,b\n",
            "a.csv, line 2: no column for time; the header has 'day', 'hour', 'wx'",
        ),
        ("0,1,2,3\nt,wx,wy,wz\n0,1,2,3\n", "a.csv: no column for time; the header has none"),
        // no row between header and numbers is passed over, and a row of units is read
        ("t,wx,wy,wz\nsec,deg,deg,deg\n0,1,2,3\n", "a.csv, line 2, column 1 (t): 'sec'"),
        ("time,wx,wy,wz\n2024-05-32,1,2,3\n", "a.csv, line 2, column 1 (time): '2024-05-32'"),
    ] {
        let message = refusal(text);
        assert!(message.starts_with(start), "{message}");
    }
}

#[test]
fn a_comment_that_names_every_column_is_a_header() {
    for (mark, header) in [
        (" ", "time ax ay az"),
        (" ", "elapsed u v w"),
        (" ", "seconds ax ay az"),
        (",", "t_ms,gx_mdps,gy_mdps,gz_mdps"),
        (",", "clock,u,v,w"),
    ] {
        let rows = ["0 1 2 3", "1 4 5 6", ""].join("\n").replace(' ', mark);
        let message = refusal(&format!("# made by hand\n#{header}\n{rows}"));
        assert_eq!(message, refusal(&format!("# made by hand\n{header}\n{rows}")), "{header}");
        assert!(message.starts_with("a.csv, line 2: n"), "{message}");
    }
    // prose of as many words
    for prose in ["made by a script", "time and angular velocity", "Start time: at noon", "run 7 of 9"] {
        let found = only(&format!("# {prose}\n0 1 2 3\n1 4 5 6\n"));
        assert_eq!(found, (vec![0.0, 1.0], vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), "{prose}");
    }
}

#[test]
fn any_line_end_is_one_and_messages_stay_short() {
    let expected = only("t,wx,wy,wz\n0,1,2,3\n1,4,5,6\n");
    for end in ["\r", "\r\n", "\r\r\n"] {
        assert_eq!(only(&["t,wx,wy,wz", "0,1,2,3", "1,4,5,6", ""].join(end)), expected, "{end:?}");
    }
    assert!(refusal("t,wx,wy,wz\r0,1,2,3\r1,a,5,6").starts_with("a.csv, line 3, column 2 (wx): 'a'"));
    let long = "\u{0}PNG é,".repeat(5000);
    for text in [
        long.clone(),
        long.replace(',', ""),
        format!("t,wx,wy,wz\n0,{},2,3", long.replace(',', "")),
        format!("t,wx,wy,wz\n0,\"1,000{long}\",2,3"),
        format!("t,wx ({}),wy,wz\n0,1,2,3", long.replace(',', "")),
    ] {
        let message = refusal(&text);
        assert!(message.chars().count() < 300 && message.contains('…'), "{message}");
    }
}

#[test]
fn values_that_are_not_finite_make_no_record() {
    let times = [0.0, 0.1, 0.2];
    let mut rates = [Vector3::new(0.1, 0.2, 0.3); 3];
    rates[1].y = f64::NAN;
    let message = Record::from_samples(&times, &rates).unwrap_err().to_string();
    assert!(message.contains("line 2") && message.contains("(wy)"), "{message}");
}

#[test]
fn a_segment_is_consistent_or_refused() {
    let rates = |n: usize| vec![Vector3::new(0.5, 1.0, -2.0); n];
    let good = Segment::new("a", vec![-1.0, 0.0, 5e-324], rates(3)).unwrap();
    assert_eq!((good.source(), good.times(), good.rates()), ("a", &[-1.0, 0.0, 5e-324][..], &rates(3)[..]));
    let refused = |times: Vec<f64>, rates: Vec<Vector3<f64>>| Segment::new("a", times, rates).unwrap_err();
    let times: Vec<f64> = (0..40).map(f64::from).collect();
    assert_eq!(refused(times, rates(3)), RecordError::Lengths { times: 40, rates: 3 });
    let file = String::from("a");
    assert_eq!(
        refused(vec![0.0, 2.0, 1.0], rates(3)),
        RecordError::Order { file: file.clone(), line: 3, time: 1.0, before: 2.0 }
    );
    assert!(matches!(refused(vec![0.0, 0.0], rates(2)), RecordError::Order { line: 2, .. }));
    assert_eq!(refused(vec![], vec![]), RecordError::Empty { file, window: None, span: (0.0, 0.0) });
    let mut broken = rates(3);
    broken[1].y = f64::NAN;
    assert_eq!(
        refused(vec![0.0, 1.0, 2.0], broken).to_string(),
        "a, line 2, column 3 (wy): \"NaN\" is not a finite number; remove the row, or leave a gap"
    );
    assert!(matches!(
        refused(vec![0.0, f64::INFINITY], rates(2)),
        RecordError::Value { line: 2, column: 1, .. }
    ));
}

/// A run of twelve equal readings is clipped where the four beside it on each side leave it by more than the rounding, or
/// where the record ends within four.
#[test]
fn a_flat_top_next_to_an_end_of_the_record_needs_no_fall_there() {
    let saturated = |before: &[f64], after: &[f64]| {
        let column: Vec<f64> = [before, &[20.0; 12], after].concat();
        let times: Vec<f64> = (0..column.len()).map(|i| 0.01 * i as f64).collect();
        let rates: Vec<_> = column.iter().map(|&x| Vector3::new(x, 7.0, -3.0)).collect();
        Record::from_samples(&times, &rates).unwrap().saturated()
    };
    let (near, falls) = ([19.0; 4], [10.0, 0.0, 5.0, 6.0, 3.0]);
    assert_eq!(saturated(&falls, &falls), 12);
    for count in 0..4 {
        assert_eq!(saturated(&near[..count], &falls), 12, "{count} before");
        assert_eq!(saturated(&falls, &near[..count]), 12, "{count} after");
    }
    assert_eq!(saturated(&near, &falls), 0);
    assert_eq!(saturated(&falls, &near), 0);
}

#[test]
fn rows_of_several_bodies_are_no_record_and_a_counter_is_no_body() {
    let told = |ids: [u32; 6]| {
        let row = |(k, id): (usize, u32)| format!("{},{id},{k},2,3\n", 0.1 * (k / 2) as f64);
        let text = "t,id,wx,wy,wz\n".to_string() + &ids.into_iter().enumerate().map(row).collect::<String>();
        record::read(&text, "a", &ReadOptions::default())
            .map_or_else(|error| error.to_string(), |_| String::new())
    };
    let bodies = told([7, 8, 7, 8, 7, 8]);
    let rule = "a, line 4, column 2 (id): '7': rows of '8' lie between rows of this body";
    assert_eq!(bodies, format!("{rule}; name a file of one body"));
    assert!(told([1, 2, 3, 4, 2, 3]).contains("line 6, column 2 (id): '2': rows of '4' lie between"));
    assert!(!told([1, 2, 3, 4, 5, 6]).contains("of this body"));
    let rule = "a, line 5, column 2 (id): '2': rows of '1' come before rows of this body";
    let later = told([1, 1, 1, 2, 2, 2]);
    assert!(later.starts_with(rule) && later.contains("rename the column"), "{later}");
}
