//! Records of angular velocity: read from text, checked row by row, split where they have gaps.

mod columns;
mod error;

use nalgebra::Vector3;

use columns::{cells, find_columns, find_header, may_part_thousands, plain, uncommented, unit};
pub use error::RecordError;

/// Unit of a time column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeUnit {
    /// s
    Seconds,
    /// 1e-3 s
    Milliseconds,
    /// 1e-6 s
    Microseconds,
    /// 1e-9 s
    Nanoseconds,
}

/// Unit of a column of rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateUnit {
    /// rad/s
    RadiansPerSecond,
    /// deg/s
    DegreesPerSecond,
    /// Revolutions per minute.
    RevolutionsPerMinute,
}

impl core::fmt::Display for TimeUnit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Seconds => "s",
            Self::Milliseconds => "ms",
            Self::Microseconds => "us",
            Self::Nanoseconds => "ns",
        })
    }
}

impl core::fmt::Display for RateUnit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::RadiansPerSecond => "rad/s",
            Self::DegreesPerSecond => "deg/s",
            Self::RevolutionsPerMinute => "rpm",
        })
    }
}

impl TimeUnit {
    /// The unit of that name: s, ms, us (µs), ns.
    pub fn named(name: &str) -> Option<Self> {
        match plain(name).as_str() {
            "s" | "sec" | "second" | "seconds" => Some(Self::Seconds),
            "ms" | "msec" | "milliseconds" => Some(Self::Milliseconds),
            "us" | "µs" | "μs" | "microseconds" => Some(Self::Microseconds),
            "ns" | "nanoseconds" => Some(Self::Nanoseconds),
            _ => None,
        }
    }

    /// In seconds, by a division where the factor is not a binary number.
    fn seconds(self, value: f64) -> f64 {
        match self {
            Self::Seconds => value,
            Self::Milliseconds => value / 1e3,
            Self::Microseconds => value / 1e6,
            Self::Nanoseconds => value / 1e9,
        }
    }
}

impl RateUnit {
    /// The unit of that name: rad/s, deg/s (°/s, dps), rpm.
    pub fn named(name: &str) -> Option<Self> {
        match plain(name).as_str() {
            "rad/s" | "rads" | "rad/sec" | "rads-1" | "rps" | "radians/s" => Some(Self::RadiansPerSecond),
            "deg/s" | "°/s" | "dps" | "degs" | "deg/sec" | "degrees/s" => Some(Self::DegreesPerSecond),
            "rpm" | "1/min" | "rev/min" => Some(Self::RevolutionsPerMinute),
            _ => None,
        }
    }

    fn radians_per_second(self, value: f64) -> f64 {
        match self {
            Self::RadiansPerSecond => value,
            Self::DegreesPerSecond => value * (core::f64::consts::PI / 180.0),
            Self::RevolutionsPerMinute => value * (core::f64::consts::PI / 30.0),
        }
    }
}

/// How a text is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Unit of time where the header names none; seconds without it.
    pub time_unit: Option<TimeUnit>,
    /// Unit of the rates where the header names none; rad/s without it.
    pub rate_unit: Option<RateUnit>,
}

/// Samples without a gap between them: finite, at ascending times.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::fit::Segment;
/// let rates = vec![Vector3::new(0.1, 2.0, 0.3); 2];
/// let segment = Segment::new("toss 1", vec![0.0, 0.01], rates.clone())?;
/// assert_eq!((segment.source(), segment.times().len()), ("toss 1", 2));
///
/// let turned = Segment::new("toss 1", vec![0.01, 0.0], rates).unwrap_err();
/// assert!(turned.to_string().starts_with("toss 1, line 2: time 0 s comes after 0.01 s"));
/// # Ok::<(), polhode::fit::RecordError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    source: String,
    times: Vec<f64>,
    rates: Vec<Vector3<f64>>,
}

impl Segment {
    /// From ascending `times` (s) and as many angular velocities (rad/s, sensor axes); `source` names them in messages.
    ///
    /// # Errors
    /// Lists of different lengths, values that are not finite, times that do not ascend, no samples.
    pub fn new(source: &str, times: Vec<f64>, rates: Vec<Vector3<f64>>) -> Result<Self, RecordError> {
        if times.len() != rates.len() {
            return Err(RecordError::Lengths { times: times.len(), rates: rates.len() });
        }
        if times.is_empty() {
            return Err(RecordError::Empty { file: source.into(), window: None, span: (0.0, 0.0) });
        }
        for (line, (&t, w)) in times.iter().zip(&rates).enumerate() {
            let row = [t, w.x, w.y, w.z];
            if let Some(k) = row.iter().position(|v| !v.is_finite()) {
                return Err(RecordError::Value {
                    file: source.into(),
                    line: line + 1,
                    column: k + 1,
                    name: NAMES[k].into(),
                    value: row[k].to_string(),
                });
            }
        }
        if let Some(k) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
            let (before, time) = (times[k], times[k + 1]);
            return Err(RecordError::Order { file: source.into(), line: k + 2, time, before });
        }
        Ok(Segment { source: source.into(), times, rates })
    }

    /// Where it comes from.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Ascending times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Angular velocities in sensor axes, rad/s, one per time.
    pub fn rates(&self) -> &[Vector3<f64>] {
        &self.rates
    }
}

/// Columns of a record that is not read from a text.
const NAMES: [&str; 4] = ["t", "wx", "wy", "wz"];

/// Measured angular velocities of one body: segments that share one tensor, each with a motion of its own.
///
/// ```
/// use polhode::fit::{Reading, Record};
/// let text = "t (ms), wx (deg/s), wy (deg/s), wz (deg/s)\n0, 0, 90, 180\n10, 1, 90, 180\n10, 3, 90, 180\n";
/// let record = Record::read(text, "toss.csv", Reading::default())?;
/// assert_eq!((record.samples(), record.merged()), (2, 1)); // rows of the same time are averaged
/// assert_eq!(record.segments[0].times(), [0.0, 0.01]);
/// assert_eq!(record.segments[0].rates()[1].z, core::f64::consts::PI);
///
/// let broken = Record::read("t,wx,wy,wz\n0,1,2,3\n1,1,nan,3\n", "toss.csv", Reading::default());
/// assert!(broken.unwrap_err().to_string().starts_with("toss.csv, line 3, column 3 (wy): \"nan\""));
/// # Ok::<(), polhode::fit::RecordError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Its segments.
    pub segments: Vec<Segment>,
    /// What was found among the rows, and when, s.
    findings: Vec<(f64, Finding)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Finding {
    Merged,
    Saturated,
    Gap,
}

/// A gap is an interval longer than this many median intervals.
const GAP: f64 = 8.0;
/// Equal extreme samples in a row that count as the end of the range.
const FLAT_TOP: usize = 4;
/// Steps of the rounding that a column must span before its ends can be those of a sensor's range.
const QUIET: f64 = 16.0;

impl Record {
    /// From times (s) and angular velocities (rad/s, sensor axes).
    ///
    /// # Errors
    /// Lists of different lengths, values that are not finite, times that decrease, no samples.
    pub fn from_samples(times: &[f64], rates: &[Vector3<f64>]) -> Result<Record, RecordError> {
        if times.len() != rates.len() {
            return Err(RecordError::Lengths { times: times.len(), rates: rates.len() });
        }
        let rows =
            times.iter().zip(rates).enumerate().map(|(i, (t, w))| (i + 1, [*t, w.x, w.y, w.z])).collect();
        Record::from_rows("samples", rows, NAMES.map(String::from), [1, 2, 3, 4])
    }

    /// From a text with a header: cells apart by comma, semicolon or tab, or by two spaces or more, with decimal commas
    /// where semicolons or tabs part them, or within quotes; lines before the header and lines that begin with `#` may
    /// hold anything, and so may columns that are not needed. Of several times the one whose name has a unit is read.
    ///
    /// # Errors
    /// Missing columns, unknown units, rows that do not fit the header, cells that are not finite numbers, times that
    /// decrease.
    pub fn read(text: &str, file: &str, reading: Reading) -> Result<Record, RecordError> {
        let text = text.trim_start_matches('\u{feff}');
        // a carriage return alone ends a line too; a tab in front is an empty cell
        let lines = text.split('\n').flat_map(|l| l.strip_suffix('\r').unwrap_or(l).split('\r'));
        let lines = lines.map(|l| l.trim_end().trim_start_matches(|c: char| c.is_whitespace() && c != '\t'));
        let lines: Vec<(usize, &str)> =
            lines.enumerate().map(|(k, l)| (k + 1, l)).filter(|(_, l)| !l.is_empty()).collect();
        let (first, names) = find_header(&lines);
        let columns = find_columns(&names).map_err(|missing| RecordError::Column {
            file: file.into(),
            missing,
            found: names.clone(),
        })?;
        let time_unit =
            unit(&names[columns[0]], file, reading.time_unit, TimeUnit::named)?.unwrap_or(TimeUnit::Seconds);
        let mut rate_units = [RateUnit::RadiansPerSecond; 3];
        for (axis, rate_unit) in rate_units.iter_mut().enumerate() {
            *rate_unit = unit(&names[columns[axis + 1]], file, reading.rate_unit, RateUnit::named)?
                .unwrap_or(*rate_unit);
        }
        let mut rows = Vec::new();
        for &(line, content) in lines[first..].iter().filter(|(_, l)| uncommented(l).is_none()) {
            let mut row = cells(content);
            // a separator at the end of every row makes one empty cell more
            if row.len() == names.len() + 1 && row.last().is_some_and(String::is_empty) {
                row.pop();
            }
            if row.len() > names.len() || columns.iter().any(|&c| c >= row.len()) {
                return Err(RecordError::Cells {
                    file: file.into(),
                    line,
                    cells: row.len(),
                    columns: names.len(),
                });
            }
            let mut values = [0.0; 4];
            for (value, &column) in values.iter_mut().zip(&columns) {
                *value = row[column].parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(|| {
                    let (file, name, value) = (file.into(), names[column].clone(), row[column].clone());
                    let column = column + 1;
                    match may_part_thousands(&value) {
                        true => RecordError::Comma { file, line, column, name, value },
                        false => RecordError::Value { file, line, column, name, value },
                    }
                })?;
            }
            values[0] = time_unit.seconds(values[0]);
            for axis in 0..3 {
                values[axis + 1] = rate_units[axis].radians_per_second(values[axis + 1]);
            }
            rows.push((line, values));
        }
        let used = columns.map(|c| names[c].clone());
        Record::from_rows(file, rows, used, columns.map(|c| c + 1))
    }

    fn from_rows(
        file: &str,
        rows: Vec<(usize, [f64; 4])>,
        names: [String; 4],
        columns: [usize; 4],
    ) -> Result<Record, RecordError> {
        let mut record = Record::default();
        let mut merged: Vec<([f64; 4], f64)> = Vec::with_capacity(rows.len());
        for (line, row) in rows {
            if let Some(k) = row.iter().position(|v| !v.is_finite()) {
                return Err(RecordError::Value {
                    file: file.into(),
                    line,
                    column: columns[k],
                    name: names[k].clone(),
                    value: row[k].to_string(),
                });
            }
            match merged.last_mut() {
                Some((last, _)) if row[0] < last[0] => {
                    return Err(RecordError::Order {
                        file: file.into(),
                        line,
                        time: row[0],
                        before: last[0],
                    });
                }
                Some((last, count)) if row[0] == last[0] => {
                    *count += 1.0;
                    for k in 1..4 {
                        last[k] += (row[k] - last[k]) / *count;
                    }
                    record.findings.push((row[0], Finding::Merged));
                }
                _ => merged.push((row, 1.0)),
            }
        }
        if merged.is_empty() {
            return Err(RecordError::Empty { file: file.into(), window: None, span: (0.0, 0.0) });
        }
        let samples: Vec<[f64; 4]> = merged.into_iter().map(|(row, _)| row).collect();
        let flat = flat_tops(&samples);
        let mut intervals: Vec<f64> = samples.windows(2).map(|w| w[1][0] - w[0][0]).collect();
        intervals.sort_by(f64::total_cmp);
        let median = intervals.get(intervals.len() / 2).copied().unwrap_or(0.0);
        let mut last: Option<f64> = None;
        for (row, flat) in samples.iter().zip(flat) {
            if flat {
                record.findings.push((row[0], Finding::Saturated));
                last = None;
                continue;
            }
            let gap = last.is_some_and(|t| row[0] - t > GAP * median);
            if gap {
                record.findings.push((row[0], Finding::Gap));
            }
            if gap || last.is_none() {
                record.segments.push(Segment { source: file.into(), times: Vec::new(), rates: Vec::new() });
            }
            if let Some(segment) = record.segments.last_mut() {
                segment.times.push(row[0]);
                segment.rates.push(Vector3::new(row[1], row[2], row[3]));
            }
            last = Some(row[0]);
        }
        Ok(record)
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.segments.iter().map(|s| s.times.len()).sum()
    }

    /// Number of samples that were merged into one of the same time.
    pub fn merged(&self) -> usize {
        self.count(Finding::Merged)
    }

    /// Number of samples left out because a component stood at the end of the sensor's range.
    pub fn saturated(&self) -> usize {
        self.count(Finding::Saturated)
    }

    /// Number of places where the record was split because of a gap.
    pub fn gaps(&self) -> usize {
        self.count(Finding::Gap)
    }

    fn count(&self, what: Finding) -> usize {
        self.findings.iter().filter(|(_, finding)| *finding == what).count()
    }

    /// The parts that lie in the windows (start, end), s, both ends included. Windows that overlap count as one, so that no
    /// sample serves twice.
    ///
    /// # Errors
    /// A window that is not ascending, or without samples.
    pub fn windows(&self, windows: &[(f64, f64)]) -> Result<Record, RecordError> {
        if let Some(&(start, end)) =
            windows.iter().find(|(start, end)| !(start.is_finite() && end.is_finite() && start < end))
        {
            return Err(RecordError::Window { start, end });
        }
        let mut cut = Record::default();
        for (start, end) in joined(windows) {
            cut.findings.extend(self.findings.iter().filter(|(t, _)| (start..=end).contains(t)));
            let before = cut.segments.len();
            for s in &self.segments {
                let (a, b) =
                    (s.times.partition_point(|&t| t < start), s.times.partition_point(|&t| t <= end));
                if a < b {
                    cut.segments.push(Segment {
                        source: s.source.clone(),
                        times: s.times[a..b].to_vec(),
                        rates: s.rates[a..b].to_vec(),
                    });
                }
            }
            if cut.segments.len() == before {
                let first = self.segments.first().and_then(|s| s.times.first()).copied().unwrap_or(0.0);
                let last = self.segments.last().and_then(|s| s.times.last()).copied().unwrap_or(0.0);
                let file = self.segments.first().map_or(String::new(), |s| s.source.clone());
                return Err(RecordError::Empty { file, window: Some((start, end)), span: (first, last) });
            }
        }
        Ok(cut)
    }

    /// This record and another of the same body.
    pub fn join(mut self, other: Record) -> Record {
        self.segments.extend(other.segments);
        self.findings.extend(other.findings);
        self
    }
}

/// The windows with those that overlap made one, in the order of their starts.
fn joined(windows: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted = windows.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut joined: Vec<(f64, f64)> = Vec::new();
    for (start, end) in sorted {
        match joined.last_mut() {
            Some(last) if start < last.1 => last.1 = last.1.max(end),
            _ => joined.push((start, end)),
        }
    }
    joined
}

/// Samples where a component stays at its largest or smallest value, and longer than a rounded peak would.
///
/// In rounded readings a peak is flat too: as long as it takes to fall by a few steps of the rounding. A clipped one is
/// flat for longer than that.
fn flat_tops(samples: &[[f64; 4]]) -> Vec<bool> {
    let mut flat = vec![false; samples.len()];
    for k in 1..4 {
        let column = || samples.iter().map(|row| row[k]);
        let (low, high) =
            (column().fold(f64::INFINITY, f64::min), column().fold(f64::NEG_INFINITY, f64::max));
        let steps = samples.windows(2).map(|w| (w[1][k] - w[0][k]).abs()).filter(|step| *step > 0.0);
        let step = steps.fold(f64::INFINITY, f64::min);
        // a column of a few values, or of one, is a quiet axis
        if high - low < QUIET * step {
            continue;
        }
        for end in [low, high] {
            let away = |row: &[f64; 4]| (row[k] - end).abs() >= 2.5 * step;
            let mut i = 0;
            while i < samples.len() {
                let run = samples[i..].iter().take_while(|row| row[k] == end).count();
                if run >= FLAT_TOP {
                    // how long the fall lasts is asked no further than the answer matters; an edge tells nothing
                    let most = run / 3;
                    let before = samples[..i].iter().rev().take(most).position(away);
                    let after = samples[i + run..].iter().take(most).position(away);
                    let edge = (i < most, samples.len() - (i + run) < most);
                    if (before.is_some() || edge.0) && (after.is_some() || edge.1) {
                        flat[i..i + run].iter_mut().for_each(|f| *f = true);
                    }
                }
                i += run.max(1);
            }
        }
    }
    flat
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Record, RecordError> {
        Record::read(text, "a.csv", Reading::default())
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
            assert_eq!(record.segments[0].times, [0.5, 0.75], "{header}");
            assert_eq!(record.segments[0].rates[1], Vector3::new(1.0, 2.0, 3.0), "{header}");
        }
    }

    #[test]
    fn broken_rows_are_named_by_line_and_column() {
        for (text, expected) in [
            (
                "t,wx,wy\n0,1,2\n",
                "a.csv: no column for the rate about z; the header has [\"t\", \"wx\", \"wy\"]",
            ),
            ("t,wx,wy,wz\n0,1,2\n", "a.csv, line 2: 3 cells where the header has 4"),
            ("t,wx,wy,wz\n0,1,2,3\n1,1,x,3\n", "a.csv, line 3, column 3 (wy): \"x\" is not a finite number"),
            (
                "t,wx,wy,wz\n0,1,2,3\n\n1,1,2,inf\n",
                "a.csv, line 4, column 4 (wz): \"inf\" is not a finite number",
            ),
            ("t,wx,wy,wz\n1,1,2,3\n0.5,1,2,3\n", "a.csv, line 3: time 0.5 s comes after 1 s"),
            ("t,wx (mph),wy,wz\n1,1,2,3\n", "a.csv: column \"wx (mph)\" is in \"mph\""),
            ("t,wx,wy,wz\n", "a.csv: no samples"),
        ] {
            let message = read(text).unwrap_err().to_string();
            assert!(message.starts_with(expected), "{message}");
        }
        let setting = Reading { rate_unit: Some(RateUnit::DegreesPerSecond), ..Reading::default() };
        let clash = Record::read("t,wx (rad/s),wy,wz\n1,1,2,3\n", "a.csv", setting).unwrap_err().to_string();
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
        let lengths: Vec<usize> = cut.segments.iter().map(|s| s.times.len()).collect();
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
    fn decimal_commas_are_read_between_semicolons() {
        let record = read("t;wx;wy;wz\n0,5;0,1;-1e-1;3\n0,75;1;2,25;-3,5\n").unwrap();
        assert_eq!(record.segments[0].times, [0.5, 0.75]);
        assert_eq!(record.segments[0].rates[1], Vector3::new(1.0, 2.25, -3.5));
        let broken = read("t;wx;wy;wz\n0,5;1,000,5;0;3\n").unwrap_err().to_string();
        assert!(broken.contains("line 2, column 2 (wx): \"1,000,5\""), "{broken}");
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
        assert_eq!(record.segments[0].times[99], 0.99);
        let twice = record.windows(&[(0.3, 0.6), (0.0, 0.4), (0.6, 0.9), (0.0, 0.4)]).unwrap();
        assert_eq!((twice.segments.len(), twice.samples()), (2, 61 + 31));
        assert_eq!(read(&text.replace("time_ms", "timestampNs")).unwrap().segments[0].times[99], 990e-9);
        assert!(
            Record::read(&text, "a", Reading { time_unit: Some(TimeUnit::Seconds), ..Reading::default() })
                .is_err()
        );
    }

    fn only(text: &str) -> (Vec<f64>, Vec<[f64; 3]>) {
        let record = read(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(record.segments.len(), 1, "{text}");
        let segment = &record.segments[0];
        (segment.times.clone(), segment.rates.iter().map(|w| [w.x, w.y, w.z]).collect())
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
            let expected = RecordError::Cells { file: "a.csv".into(), line: 3, cells, columns };
            assert_eq!(read(text), Err(expected), "{text}");
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
                format!("a.csv, line 2, column 2 (wx): \"{value}\" has a comma that may part thousands");
            assert!(message.starts_with(&start), "{message}");
        }
        let half = refusal("t,wx,wy,wz\n0,\"1,2,3\n");
        assert!(half.starts_with("a.csv, line 2: 2 cells where the header has 4"), "{half}");
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
            let setting = Reading { time_unit: Some(TimeUnit::Nanoseconds), ..Reading::default() };
            let text = format!("time,{name},z,y,x\n1,0.25,3,2,1\n");
            let clash = Record::read(&text, "a.csv", setting).unwrap_err().to_string();
            assert!(clash.contains(&format!("\"{name}\" says s, the setting says ns")), "{clash}");
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
                "a.csv: no column for the rate about z; the header has [\"run\", \"t\", \"wx\", \"wy\"]",
            ),
            (
                "made by hand on Monday\nday,hour,wx\nMay,ten,a\nMay,ten,b\n",
                "a.csv: no column for time; the header has [\"day\", \"hour\", \"wx\"]",
            ),
            ("0,1,2,3\nt,wx,wy,wz\n0,1,2,3\n", "a.csv: no column for time; the header has []"),
            // no row between header and numbers is passed over
            ("t,wx,wy,wz\ns,deg/s,deg/s,deg/s\n0,1,2,3\n", "a.csv, line 2, column 1 (t): \"s\""),
            ("time,wx,wy,wz\n2024-05-01,1,2,3\n", "a.csv, line 2, column 1 (time): \"2024-05-01\""),
        ] {
            let message = refusal(text);
            assert!(message.starts_with(start), "{message}");
        }
    }

    #[test]
    fn any_line_end_is_one_and_messages_stay_short() {
        let expected = only("t,wx,wy,wz\n0,1,2,3\n1,4,5,6\n");
        for end in ["\r", "\r\n", "\r\r\n"] {
            assert_eq!(only(&["t,wx,wy,wz", "0,1,2,3", "1,4,5,6", ""].join(end)), expected, "{end:?}");
        }
        assert!(refusal("t,wx,wy,wz\r0,1,2,3\r1,a,5,6").starts_with("a.csv, line 3, column 2 (wx): \"a\""));
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
}
