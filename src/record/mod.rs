//! Records of measured angular velocity: checked row by row, split where they have gaps.

mod both;
mod bursts;
mod clean;
mod error;
mod held;
mod median;
mod polynomial;
mod quantum;
mod rows;
mod segment;
mod shared;
mod spikes;

use core::ops::Range;

use nalgebra::Vector3;

use crate::units::RateUnit;
#[doc(hidden)]
pub use both::both;
use bursts::bursts;
use clean::{Cleaned, Finding, cleaned};
pub use error::RecordError;
#[doc(hidden)]
pub use median::median;
#[doc(hidden)]
pub use rows::RawRows;
#[doc(hidden)]
pub use segment::Inputs;
use segment::NAMES;
pub use segment::Segment;
#[doc(hidden)]
pub use shared::shared;
pub use spikes::Spike;
use spikes::{places, spikes};

/// Measured angular velocities of one body: segments that share one tensor, each with a motion of its own.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::record::Record;
/// let rates = [Vector3::new(0.1, 2.0, 0.3), Vector3::new(0.3, 2.0, 0.3), Vector3::new(0.5, 2.0, 0.3)];
/// let record = Record::from_samples(&[0.0, 0.01, 0.01], &rates)?;
/// assert_eq!((record.samples(), record.merged()), (2, 1)); // rows of the same time are averaged
/// assert_eq!(record.segments[0].rates()[1].x, 0.4);
/// # Ok::<(), polhode::record::RecordError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Its segments.
    pub segments: Vec<Segment>,
    /// What was found among the rows, and when, s.
    findings: Vec<(f64, Finding)>,
    /// File and name of each column that was not read.
    unused: Vec<(String, String)>,
}

impl Record {
    /// From times (s) and angular velocities (rad/s, sensor axes).
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::record::Record;
    /// // a gap of more than eight intervals parts two segments
    /// let times = [0.0, 0.01, 0.02, 0.5, 0.51];
    /// let record = Record::from_samples(&times, &[Vector3::new(0.1, 2.0, 0.3); 5])?;
    /// assert_eq!((record.segments.len(), record.gaps(), record.samples()), (2, 1, 5));
    /// # Ok::<(), polhode::record::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// Lists of different lengths, values that are not finite, times that decrease, no samples.
    pub fn from_samples(times: &[f64], rates: &[Vector3<f64>]) -> Result<Record, RecordError> {
        if times.len() != rates.len() {
            return Err(RecordError::Lengths { times: times.len(), rates: rates.len() });
        }
        let rows =
            times.iter().zip(rates).enumerate().map(|(i, (t, w))| (i + 1, [*t, w.x, w.y, w.z])).collect();
        Record::cleaned(
            "samples",
            RawRows {
                rows,
                names: NAMES.map(String::from),
                columns: [1, 2, 3, 4],
                rate_unit: Some(RateUnit::default()),
                unused: Vec::new(),
            },
        )
    }

    /// From rows of a file, called `file` in messages.
    ///
    /// # Errors
    /// Values that are not finite, times that decrease, no rows.
    #[doc(hidden)]
    pub fn cleaned(file: &str, mut rows: RawRows) -> Result<Record, RecordError> {
        let unused = core::mem::take(&mut rows.unused).into_iter().map(|name| (file.into(), name)).collect();
        let Cleaned { segments, findings } = cleaned(file, rows)?;
        Ok(Record { segments, findings, unused })
    }

    /// File and name of each column of a text that was not read.
    pub fn unused_columns(&self) -> &[(String, String)] {
        &self.unused
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.segments.iter().map(|s| s.times.len()).sum()
    }

    /// What is known of its files, without samples.
    fn of_none(&self) -> Record {
        Record { unused: self.unused.clone(), ..Record::default() }
    }

    /// The spikes and bursts of all segments, and the record without them, where there are any; where eight samples and more in a row are left
    /// out, the segment has several [stretches](Segment::stretches).
    #[doc(hidden)]
    pub fn without_spikes(&self) -> Option<(Vec<Spike>, Record)> {
        let each: Vec<Vec<Outlier>> = self.segments.iter().map(outliers).collect();
        if each.iter().all(Vec::is_empty) {
            return None;
        }
        let mut all = Vec::new();
        let mut record = Record { findings: self.findings.clone(), ..self.of_none() };
        for (k, (segment, outliers)) in self.segments.iter().zip(each).enumerate() {
            let samples: Vec<usize> = outliers.iter().map(|(sample, _)| *sample).collect();
            record.segments.push(segment.without(&samples));
            all.extend(outliers.into_iter().map(|(sample, burst)| Spike {
                segment: k,
                sample,
                time: segment.times[sample],
                line: segment.lines()[sample],
                burst,
            }));
        }
        Some((all, record))
    }

    /// The step of each component of the readings, rad/s; 0 where they have none.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::record::Record;
    /// let times: Vec<f64> = (0..100).map(f64::from).collect();
    /// let rates: Vec<_> = (0..100).map(|i| Vector3::new(0.25 * f64::from(i % 9), 1.0, 0.0)).collect();
    /// assert_eq!(Record::from_samples(&times, &rates)?.quanta(), Vector3::new(0.25, 0.0, 0.0));
    /// # Ok::<(), polhode::record::RecordError>(())
    /// ```
    pub fn quanta(&self) -> Vector3<f64> {
        quantum::quanta(self.segments.iter().flat_map(|s| &s.rates))
    }

    /// Whether readings rest on too few values to tell their step: on two or three of a component, or on one of each.
    #[doc(hidden)]
    pub fn rests(&self) -> bool {
        quantum::rests(self.segments.iter().flat_map(|s| &s.rates))
    }

    /// Variance of the rounding of a component of the readings to steps of `quanta`, (rad/s)².
    #[doc(hidden)]
    pub fn rounding(&self, quanta: &Vector3<f64>) -> f64 {
        quantum::rounding(&self.segments, quanta)
    }

    /// Number of samples that were merged into one of the same time.
    pub fn merged(&self) -> usize {
        self.count(|finding| *finding == Finding::Merged)
    }

    /// Time of the first of them, s.
    #[doc(hidden)]
    pub fn first_merged(&self) -> Option<f64> {
        self.findings.iter().find(|(_, finding)| *finding == Finding::Merged).map(|(time, _)| *time)
    }

    /// Number of samples left out because they repeat the reading before: a log that is written faster than its sensor reads.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::record::Record;
    /// // 400 rows a second of a sensor that reads 100 times
    /// let times: Vec<f64> = (0..400).map(|i| f64::from(i) / 400.0).collect();
    /// let rates: Vec<_> = (0..400).map(|i| Vector3::new(f64::from((i / 4) * (i / 4)), 1.0, 0.0)).collect();
    /// let record = Record::from_samples(&times, &rates)?;
    /// assert_eq!((record.samples(), record.repeated()), (100, 300));
    /// assert!((record.new_readings_rate().unwrap() - 100.0).abs() < 1e-9);
    /// # Ok::<(), polhode::record::RecordError>(())
    /// ```
    pub fn repeated(&self) -> usize {
        self.count(|finding| matches!(finding, Finding::Repeated { .. }))
    }

    /// The rate at which new readings come, 1/s, where samples were left out that repeat the one before; of several files the lowest.
    pub fn new_readings_rate(&self) -> Option<f64> {
        let intervals = self.findings.iter().filter_map(|(_, finding)| match finding {
            Finding::Repeated { interval } => Some(*interval),
            _ => None,
        });
        intervals.max_by(f64::total_cmp).map(|interval| 1.0 / interval)
    }

    /// Number of samples left out because they repeat the reading before, in all three components, more often than chance brings: the sensor
    /// stood still, or the log repeated what it had.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use polhode::record::Record;
    /// let times: Vec<f64> = (0..400).map(|i| f64::from(i) / 100.0).collect();
    /// let reading = |i: u32| Vector3::new(f64::from(i * i), 1.0, 0.0);
    /// // eight rows in which nothing new was read
    /// let rates: Vec<_> = (0..400).map(|i| reading(if (200..209).contains(&i) { 200 } else { i })).collect();
    /// let record = Record::from_samples(&times, &rates)?;
    /// assert_eq!((record.samples(), record.stale(), record.repeated()), (392, 8, 0));
    /// # Ok::<(), polhode::record::RecordError>(())
    /// ```
    pub fn stale(&self) -> usize {
        self.count(|finding| *finding == Finding::Stale)
    }

    /// Number of samples left out because a component stood at the end of the sensor's range.
    pub fn saturated(&self) -> usize {
        self.count(|finding| *finding == Finding::Saturated)
    }

    /// Number of places where the record was split because of a gap.
    pub fn gaps(&self) -> usize {
        self.count(|finding| *finding == Finding::Gap)
    }

    fn count(&self, what: impl Fn(&Finding) -> bool) -> usize {
        self.findings.iter().filter(|(_, finding)| what(finding)).count()
    }

    /// The parts that lie in the windows (start, end), s, both ends included. Windows that overlap count as one, and where one ends
    /// and the next begins the sample is of the first, so that none serves twice.
    ///
    /// # Errors
    /// A window that is not ascending, or without samples.
    pub fn windows(&self, windows: &[(f64, f64)]) -> Result<Record, RecordError> {
        let mut cut = self.of_none();
        let mut before = f64::NEG_INFINITY;
        for window in joined(windows).map_err(|(start, end)| RecordError::Window { start, end })? {
            let start = if window.0 == before { before.next_up() } else { window.0 };
            before = window.1;
            let part = self.span((start, window.1));
            if part.segments.is_empty() {
                let first = self.segments.first().and_then(|s| s.times.first()).copied().unwrap_or(0.0);
                let last = self.segments.last().and_then(|s| s.times.last()).copied().unwrap_or(0.0);
                let file = self.segments.first().map_or(String::new(), |s| s.source.clone());
                return Err(RecordError::Empty { file, window: Some(window), span: (first, last) });
            }
            cut.add(part);
        }
        Ok(cut)
    }

    /// The part from `start` to `end`, s, both included; without segments where there are no samples.
    #[doc(hidden)]
    #[must_use]
    pub fn span(&self, (start, end): (f64, f64)) -> Record {
        let mut cut = self.of_none();
        cut.findings.extend(self.findings.iter().filter(|(t, _)| (start..=end).contains(t)));
        cut.segments.extend(self.segments.iter().filter_map(|s| s.between(start, end)));
        cut
    }

    /// The samples and findings of another part of the same files.
    fn add(&mut self, other: Record) {
        self.segments.extend(other.segments);
        self.findings.extend(other.findings);
    }

    /// The parts from `start` to `end` (s, both included) of the segment of each span, a segment each.
    #[doc(hidden)]
    #[must_use]
    pub fn spans(&self, spans: impl IntoIterator<Item = (usize, f64, f64)>) -> Record {
        let mut cut = self.of_none();
        for (segment, start, end) in spans {
            let Some(s) = self.segments.get(segment) else { continue };
            cut.segments.extend(s.between(start, end));
            cut.findings.extend(self.findings.iter().filter(|(t, _)| (start..=end).contains(t)));
        }
        cut
    }

    /// With each [stretch](Segment::stretches) as a segment: a long run of samples that are left out parts as a gap does.
    #[doc(hidden)]
    #[must_use]
    pub fn parted(self) -> Record {
        let stretches = |(k, segment): (usize, &Segment)| {
            let own = |range: Range<usize>| segment.times.get(range);
            let ends = |own: &[f64]| Some((k, *own.first()?, *own.last()?));
            segment.stretches().filter_map(own).filter_map(ends).collect::<Vec<_>>()
        };
        let spans: Vec<_> = self.segments.iter().enumerate().flat_map(stretches).collect();
        if spans.len() > self.segments.len() { self.spans(spans) } else { self }
    }

    /// How many samples of `other` it has too, by their rates alone: each file may count its times from its own first row.
    #[doc(hidden)]
    #[must_use]
    pub fn shared(&self, other: &Record) -> usize {
        fn rates(record: &Record) -> Vec<&[Vector3<f64>]> {
            record.segments.iter().map(|s| &s.rates[..]).collect()
        }
        shared(&rates(self), &rates(other), |w| [w.x.to_bits(), w.y.to_bits(), w.z.to_bits()])
    }

    /// This record and another of the same body.
    #[must_use]
    pub fn join(mut self, other: Record) -> Record {
        self.unused.extend_from_slice(&other.unused);
        self.add(other);
        self
    }
}

/// Spikes in a row that are a burst, at least.
const IN_A_ROW: usize = 3;

/// A sample that stands out of its neighbours, and the number of the burst that it lies in.
type Outlier = (usize, Option<usize>);

/// The samples of a segment that stand out of their neighbours, ascending.
fn outliers(segment: &Segment) -> Vec<Outlier> {
    let places = places(segment.times());
    let spikes = spikes(&places, segment.rates());
    let bursts = bursts(&places, segment.rates(), &spikes);
    let rows = spikes.chunk_by(|a, b| a + 1 == *b).filter(|row| row.len() >= IN_A_ROW);
    let mut runs: Vec<(usize, usize)> = rows.map(|row| (row[0], row[row.len() - 1])).collect();
    runs.extend(bursts.iter().map(|burst| (burst.run.start, burst.run.end - 1)));
    // what touches is one
    runs.sort_unstable();
    runs.dedup_by(|next, last| {
        let touches = next.0 <= last.1 + 1;
        last.1 = if touches { last.1.max(next.1) } else { last.1 };
        touches
    });
    let mut found: Vec<usize> = bursts.into_iter().flat_map(|burst| burst.off).chain(spikes).collect();
    found.sort_unstable();
    let burst = |sample: usize| {
        let k = runs.partition_point(|run| run.1 < sample);
        runs.get(k).filter(|run| run.0 <= sample).map(|_| k)
    };
    found.into_iter().map(|sample| (sample, burst(sample))).collect()
}

/// The windows with those that overlap made one, in the order of their starts.
///
/// # Errors
/// The window that is not ascending.
#[doc(hidden)]
pub fn joined(windows: &[(f64, f64)]) -> Result<Vec<(f64, f64)>, (f64, f64)> {
    let is_window = |(start, end): &(f64, f64)| start.is_finite() && end.is_finite() && start < end;
    if let Some(wrong) = windows.iter().find(|window| !is_window(window)) {
        return Err(*wrong);
    }
    let mut sorted = windows.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut joined: Vec<(f64, f64)> = Vec::new();
    for (start, end) in sorted {
        match joined.last_mut() {
            Some(last) if start < last.1 => last.1 = last.1.max(end),
            _ => joined.push((start, end)),
        }
    }
    Ok(joined)
}
