//! A record part by part, in constant memory however long it is.

use std::path::Path;

use polhode::record::{Record, RecordError, Spike, joined};
use polhode::units::RateUnit;

use super::ReadOptions;
use super::rows::{Row, Rows};
use crate::error::{Error, TableError};
use crate::read_as::ReadAs;
use crate::table::Table;

/// Rows of a part.
const ROWS: usize = 1 << 16;

/// Rows beyond each end of a part that are looked at with it: more than any sample of it is judged by.
const MARGIN: usize = 256;

/// The samples of some rows next to each other.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Part {
    /// The samples, and what was found among them.
    pub record: Record,
    /// Whether the first segment goes on where the last one of the part before has ended.
    pub continues: bool,
    /// Samples that stand out of their neighbours, where they are [left out](Parts::without_spikes).
    pub spikes: Vec<Spike>,
}

/// A record that is read part by part.
///
/// What [`read`](super::read) makes of a record is made of each part with some rows more at both ends: a record of up to 65,536 rows is one
/// part. Columns beside the rates are not read.
///
/// ```
/// use polhode_files::record::{Parts, ReadOptions};
/// # let file = std::env::temp_dir().join(format!("polhode-parts-{}.csv", std::process::id()));
/// let rows: String = (0..100_000).map(|k| format!("{k},{},1,0\n", k % 9)).collect();
/// std::fs::write(&file, format!("t (ms),wx (rad/s),wy (rad/s),wz (rad/s)\n{rows}"))?;
/// let mut parts = Parts::open(&file, &ReadOptions::default(), &[])?;
/// let mut samples = Vec::new();
/// while let Some(part) = parts.next()? {
///     assert_eq!((part.record.segments.len(), part.continues), (1, !samples.is_empty()));
///     samples.push(part.record.samples());
/// }
/// assert_eq!(samples, [65_536, 34_464]);
/// # std::fs::remove_file(file)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Parts {
    rows: Rows<'static>,
    rows_of_a_part: usize,
    leaves_out_spikes: bool,
    /// Rows of the part before that belong to the margin, and those that were read beyond it.
    held: Vec<Row>,
    /// How many of them belong to the margin.
    before: usize,
    has_more: bool,
    /// Whether a segment goes on beyond the end of the part before.
    goes_on: bool,
    skipped: (usize, Option<TableError>),
    windows: Vec<Window>,
    /// First and last time of the samples, s.
    span: Option<(f64, f64)>,
}

struct Window {
    span: (f64, f64),
    is_empty: bool,
}

impl Parts {
    /// Of the file at `path`, or of standard input where that is `-`: the samples in `windows`, s, both ends included, or all
    /// where there are none. Windows of which one ends where the next begins are one.
    ///
    /// # Errors
    /// As [`open`](super::open); a window that is not ascending.
    pub fn open(path: &Path, reading: &ReadOptions, windows: &[(f64, f64)]) -> Result<Self, Error> {
        let mut spans: Vec<(f64, f64)> = Vec::new();
        let refused = |(start, end)| Error::Input(RecordError::Window { start, end }.to_string());
        for (start, end) in joined(windows).map_err(refused)? {
            match spans.last_mut() {
                Some(last) if start <= last.1 => last.1 = end,
                _ => spans.push((start, end)),
            }
        }
        Ok(Parts {
            rows: Rows::new(Table::open(path, reading)?, reading)?,
            rows_of_a_part: ROWS,
            leaves_out_spikes: false,
            held: Vec::new(),
            before: 0,
            has_more: true,
            goes_on: false,
            skipped: (0, None),
            windows: spans.into_iter().map(|span| Window { span, is_empty: true }).collect(),
            span: None,
        })
    }

    /// All of it as one part, in as much memory as that takes.
    #[must_use]
    pub fn whole(self) -> Self {
        Self { rows_of_a_part: usize::MAX, ..self }
    }

    /// Without samples that stand out of their neighbours.
    #[must_use]
    pub fn without_spikes(self) -> Self {
        Self { leaves_out_spikes: true, ..self }
    }

    /// As messages name it.
    #[must_use]
    pub fn name(&self) -> &str {
        self.rows.table.name()
    }

    /// Whether the columns are angles by their unit, which [`ReadOptions::increments`] allows.
    #[must_use]
    pub fn are_increments(&self) -> bool {
        self.rows.table.are_increments
    }

    /// The unit of the rates, where the text or a setting names one.
    #[must_use]
    pub fn rate_unit(&self) -> Option<RateUnit> {
        self.rows.rate_unit()
    }

    /// In which units it is read: of times as far as the rows that were read tell, and without the samples a second.
    #[must_use]
    pub fn read_as(&self) -> ReadAs {
        self.rows.table.read_as(Vec::new())
    }

    /// Whether there are further parts.
    #[must_use]
    pub fn has_more(&self) -> bool {
        self.has_more
    }

    /// How many rows were left out so far because they cannot be read, and why the first of them.
    #[must_use]
    pub fn skipped(&self) -> (usize, Option<&TableError>) {
        (self.skipped.0, self.skipped.1.as_ref())
    }

    /// The next part; `None` behind the last.
    ///
    /// # Errors
    /// As [`open`](super::open); a window without samples.
    #[allow(clippy::should_implement_trait, reason = "parts are read, which may fail")]
    pub fn next(&mut self) -> Result<Option<Part>, Error> {
        if !self.has_more {
            return Ok(None);
        }
        let end = self.read()?;
        let is_all = self.before == 0 && !self.has_more;
        let time = |row: usize| self.held.get(row).map_or(f64::NAN, |(_, row)| row[0]);
        let core = (time(self.before), time(end.saturating_sub(1)));
        let margin = end.min(MARGIN);
        let rest = self.held[end - margin..].to_vec();
        let record = self.rows.record(core::mem::replace(&mut self.held, rest))?;
        self.before = margin;
        self.note(&record);
        let (mut record, mut spikes) = (self.cut(record)?, Vec::new());
        let crosses = |at: f64, beyond: bool| {
            record.segments.iter().filter_map(|s| Some((s.times().first()?, s.times().last()?))).any(
                |(first, last)| if beyond { *first <= at && at < *last } else { *first < at && at <= *last },
            )
        };
        let continues = self.goes_on && crosses(core.0, false);
        self.goes_on = crosses(core.1, true);
        if self.leaves_out_spikes
            && let Some((found, cleaned)) = record.without_spikes()
        {
            spikes = found.into_iter().filter(|spike| (core.0..=core.1).contains(&spike.time)).collect();
            record = cleaned;
        }
        if !is_all {
            record = record.span(core);
        }
        Ok(Some(Part { record, continues, spikes }))
    }

    /// Reads the rows of the next part and of the margin behind it; where the part ends.
    fn read(&mut self) -> Result<usize, Error> {
        let mut end = self.before.saturating_add(self.rows_of_a_part);
        let mut skipped = Vec::new();
        loop {
            let most = end.saturating_add(MARGIN);
            self.has_more = self.rows.read(most, &mut self.held, &mut skipped)?;
            // rows of one time stay together
            let time = |row: usize| self.held.get(row).map(|(_, row)| row[0]);
            while self.has_more && end < self.held.len() && time(end) == time(end - 1) {
                end += 1;
            }
            if !self.has_more || end.saturating_add(MARGIN) <= self.held.len() {
                break;
            }
        }
        self.skipped.0 += skipped.len();
        self.skipped.1 = self.skipped.1.take().or(skipped.into_iter().next());
        match self.skipped.1.take_if(|_| !self.rows.may_skip(self.skipped.0)) {
            Some(first) => Err(first.into()),
            None => Ok(if self.has_more { end } else { self.held.len() }),
        }
    }

    fn note(&mut self, record: &Record) {
        let mut times = record.segments.iter().flat_map(|segment| segment.times());
        if let (Some(first), last) = (times.next(), record.segments.last().and_then(|s| s.times().last())) {
            let start = self.span.map_or(*first, |(start, _)| start);
            self.span = Some((start, *last.unwrap_or(first)));
        }
    }

    /// What is in the windows; those without samples are told behind the last part.
    fn cut(&mut self, record: Record) -> Result<Record, Error> {
        if self.windows.is_empty() {
            return Ok(record);
        }
        let mut all: Option<Record> = None;
        for window in &mut self.windows {
            let cut = record.span(window.span);
            window.is_empty &= cut.segments.is_empty();
            all = Some(match all {
                Some(all) => all.join(cut),
                None => cut,
            });
        }
        match self.windows.iter().find(|window| window.is_empty && !self.has_more) {
            Some(empty) => {
                let (file, span) = (self.name().to_string(), self.span.unwrap_or_default());
                let error = RecordError::Empty { file, window: Some(empty.span), span };
                Err(Error::Input(error.to_string()))
            }
            None => Ok(all.unwrap_or(record)),
        }
    }
}
