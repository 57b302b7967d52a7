//! What of a recording is fitted: windows of the user's, the whole, or the flights in it.

use polhode_fit::{FitError, Flight, FlightLimit, Flights, Record, Settings, during, flights};
use polhode_pages::document::Block;
use serde_json::{Value, json};

/// The spans of a record that a fit uses, where no window was given.
#[derive(Clone, Debug, Default)]
pub(super) struct Spans {
    list: Vec<Flight>,
    /// The files of the flights, where there are several.
    sources: Vec<String>,
    /// Why it is these, where they are not the whole record.
    remark: Option<String>,
}

impl Spans {
    /// The flights of a record, and the record cut down to them where it is not free as a whole.
    pub(super) fn find(record: &mut Record, settings: &Settings) -> Result<Spans, FitError> {
        let found = flights(record, settings)?;
        let others = found.remark_on_others();
        let Flights { list, whole, .. } = found;
        if whole {
            return Ok(Spans { list, ..Spans::default() });
        }
        let of = |segment: usize| record.segments.get(segment);
        let several = record.segments.windows(2).any(|pair| pair[0].source() != pair[1].source());
        let sources = list.iter().filter(|_| several).filter_map(|f| of(f.segment));
        let sources = sources.map(|s| s.source().to_string()).collect();
        let span = |times: &[f64]| times.last().zip(times.first()).map_or(0.0, |(b, a)| b - a);
        let all: f64 = record.segments.iter().map(|s| span(s.times())).sum();
        let free: f64 = list.iter().map(|flight| flight.end - flight.start).sum();
        let count = match list.len() {
            1 => "1 flight".to_string(),
            count => format!("{count} flights"),
        };
        let remark = format!(
            "the record as a whole is not that of a free body: the fit uses {count} of free rotation, {free:.2} s of {all:.2} s; \
             --window selects others{}",
            others.map_or_else(String::new, |others| format!("; {others}"))
        );
        *record = during(record, &list);
        Ok(Spans { list, sources, remark: Some(remark) })
    }

    /// That not the whole record is used.
    pub(super) fn remark(&self) -> Option<&str> {
        self.remark.as_deref()
    }

    /// Start and end of each.
    pub(super) fn json(&self) -> Value {
        self.list.iter().map(|f| json!([f.start, f.end])).collect()
    }

    /// Why each begins and ends where it does.
    pub(super) fn limits(&self) -> Value {
        self.list.iter().map(|f| json!([f.before.to_string(), f.after.to_string()])).collect()
    }

    /// One row for each flight, where the record is not free as a whole.
    fn rows(&self) -> Vec<Vec<String>> {
        let flights = self.list.iter().enumerate().filter(|_| self.remark.is_some());
        let row = |(k, f): (usize, &Flight)| {
            let mut cells = vec![
                format!("{}", k + 1),
                format!("{:.3}", f.start),
                format!("{:.3}", f.end),
                f.samples.to_string(),
                format!("{:.1}", f.turned),
                word(f.before),
                word(f.after),
            ];
            cells.extend(self.sources.get(k).cloned());
            cells
        };
        flights.map(row).collect()
    }

    fn head(&self) -> Vec<String> {
        let mut head = ["flight", "from (s)", "to (s)", "samples", "angle (rad)", "before", "after"]
            .map(String::from)
            .to_vec();
        if !self.sources.is_empty() {
            head.push("file".into());
        }
        head
    }

    /// As lines of text.
    pub(super) fn lines(&self) -> Vec<String> {
        let rows = self.rows();
        if rows.is_empty() {
            return Vec::new();
        }
        let line = |cells: &[String]| {
            let numbers =
                cells.iter().take(5).zip([6, 9, 9, 7, 11]).map(|(cell, width)| format!("{cell:>width$}"));
            let words = cells.iter().skip(5).map(|cell| format!("{cell:<15}"));
            numbers.chain(words).collect::<Vec<_>>().join("  ").trim_end().to_string()
        };
        let mut lines = vec![String::new(), line(&self.head())];
        lines.extend(rows.iter().map(|row| line(row)));
        lines.push(EXPLAINED.into());
        lines
    }

    /// As part of a page.
    pub(super) fn parts(&self) -> Vec<Block> {
        let Some(remark) = &self.remark else { return Vec::new() };
        vec![
            Block::Heading("Flights".into()),
            Block::Paragraph(format!("Note: {remark}.")),
            Block::Table(self.head(), self.rows()),
            Block::Paragraph(EXPLAINED.into()),
        ]
    }
}

/// A limit in a table that names the unit of torques.
fn word(limit: FlightLimit) -> String {
    match limit {
        FlightLimit::Torque { share } => format!("torque {share:.2}"),
        other => other.to_string(),
    }
}

const EXPLAINED: &str = "before, after: what limits the flight; torques in units of tr(J) |w|^2";
