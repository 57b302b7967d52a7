//! A record part by part is the record.

use std::fmt::Write;

use polhode::record::{Record, Segment};
use polhode_files::record::{Part, Parts, ReadOptions, open};

/// Rows of a part.
const ROWS: usize = 1 << 16;

/// A file of `count` rows: a spike, a gap, an unreadable row and a row of the same time near the end of the first part, and a gap
/// exactly there if `at_the_end`.
fn file(name: &str, count: usize, at_the_end: bool) -> std::path::PathBuf {
    let mut text = "t (s),wx (rad/s),wy (rad/s),wz (rad/s)\n".to_string();
    for k in 0..count {
        let late = [k >= ROWS - 100, at_the_end && k >= ROWS].map(f64::from).iter().sum::<f64>();
        // the row before is repeated in time
        let t = 0.01 * (if k == ROWS - 7 { k - 1 } else { k }) as f64 + late;
        let (sin, cos) = libm::sincos(0.01 * k as f64);
        let spike = if [5, ROWS - 3, ROWS + 2].contains(&k) { 9.0 } else { 0.0 };
        // noise that a spike stands out of
        let noise = 1e-3 * ((k * 7919) % 101) as f64;
        let z = if k == ROWS - 20 { "x".into() } else { format!("{:?}", sin * cos + noise) };
        writeln!(text, "{t:?},{:?},{cos:?},{z}", sin + spike + noise).unwrap();
    }
    let path = std::env::temp_dir().join(format!("polhode-{name}-{}.csv", std::process::id()));
    std::fs::write(&path, text).unwrap();
    path
}

/// Times and lines of a segment.
type Samples = (Vec<f64>, Vec<usize>);

/// The segments of all parts, put together, and how many parts there are.
fn together(mut parts: Parts) -> (Vec<Samples>, Vec<Part>) {
    let (mut all, mut each): (Vec<Samples>, Vec<Part>) = (Vec::new(), Vec::new());
    while let Some(part) = parts.next().unwrap() {
        for (k, segment) in part.record.segments.iter().enumerate() {
            match all.last_mut() {
                Some((times, lines)) if k == 0 && part.continues => {
                    times.extend(segment.times());
                    lines.extend(segment.lines());
                }
                _ => all.push((segment.times().to_vec(), segment.lines().to_vec())),
            }
        }
        each.push(part);
    }
    (all, each)
}

fn segments(record: &Record) -> Vec<Samples> {
    record.segments.iter().map(|s: &Segment| (s.times().to_vec(), s.lines().to_vec())).collect()
}

#[test]
fn parts_are_the_record_with_its_gaps_spikes_and_windows() {
    for (count, at_the_end) in [(ROWS + 30_000, true), (ROWS + 256, false), (ROWS + 1500, false)] {
        let path = file(&format!("parts-{count}-{at_the_end}"), count, at_the_end);
        let reading = ReadOptions::default();
        let found = open(&path, &reading, None).unwrap();
        let (whole, parts) = together(Parts::open(&path, &reading, &[]).unwrap());
        assert_eq!(whole, segments(&found.record), "{count} {at_the_end}");
        assert_eq!(whole.len(), if at_the_end { 3 } else { 2 });
        let sum = |of: &dyn Fn(&Record) -> usize| parts.iter().map(|part| of(&part.record)).sum::<usize>();
        let (gaps, merged) = (sum(&Record::gaps), sum(&Record::merged));
        assert_eq!((gaps, merged), (found.record.gaps(), found.record.merged()));
        assert_eq!((merged, found.skipped.len()), (1, 1));
        // windows across the end of the first part, and within the second
        let edge = 0.01 * ROWS as f64;
        let windows = [(edge - 50.0, edge + 5.0), (edge + 6.0, edge + 8.0), (1.0, 2.0)];
        if count > ROWS + 1000 {
            let (cut, _) = together(Parts::open(&path, &reading, &windows).unwrap());
            assert_eq!(cut, segments(&found.record.windows(&windows).unwrap()), "{count} {at_the_end}");
        }
        let (clean, parts) = together(Parts::open(&path, &reading, &[]).unwrap().without_spikes());
        let (spikes, record) = found.record.without_spikes().unwrap();
        assert_eq!(clean, segments(&record));
        let lines =
            |spikes: &[polhode::record::Spike]| spikes.iter().map(|spike| spike.line).collect::<Vec<_>>();
        assert_eq!(parts.iter().flat_map(|part| lines(&part.spikes)).collect::<Vec<_>>(), lines(&spikes));
        assert_eq!(spikes.len(), 3);
        let (once, parts) = together(Parts::open(&path, &reading, &[]).unwrap().whole());
        assert_eq!((once, parts.len()), (whole, 1));
        std::fs::remove_file(path).unwrap();
    }
}

#[test]
fn a_window_without_samples_and_too_many_bad_rows_are_refused() {
    let path = file("parts-refused", ROWS + 1000, false);
    let last = |parts: Result<Parts, _>| {
        let mut parts = parts?;
        while parts.next()?.is_some() {}
        Ok::<_, polhode_files::Error>(())
    };
    let empty = last(Parts::open(&path, &ReadOptions::default(), &[(0.0, 1.0), (1e6, 2e6)])).unwrap_err();
    assert!(empty.to_string().contains("no samples between"), "{empty}");
    let turned = Parts::open(&path, &ReadOptions::default(), &[(2.0, 1.0)]).err().unwrap();
    assert!(turned.to_string().contains("a start and a later end"), "{turned}");
    let bad = last(Parts::open(&path, &ReadOptions::default().with_most_skipped(0.0), &[])).unwrap_err();
    assert!(bad.to_string().contains(&format!("line {}", ROWS - 20 + 2)), "{bad}");
    std::fs::remove_file(path).unwrap();
}
