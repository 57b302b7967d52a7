//! What the readings of a record are: rates, increments or averages, in segments without gaps.

use std::path::Path;

use clap::{Args, ValueEnum};
use polhode::record::{Record, Segment, Spike};
use polhode::strapdown::{Kind, StrapdownError};
use polhode::units::RateUnit;
use polhode_files::error::{Error, tell, warn};
use polhode_files::record::{Part, Parts};
use polhode_files::text::{rounded, short};
use polhode_files::{NamedBy, ReadAs};

use crate::flags::record::{RecordArguments, of_a_row, tell_skipped};

/// What a reading is.
#[derive(Args, Clone, Debug)]
pub(super) struct KindArguments {
    /// What a reading is [default: told by the unit of the columns]
    #[arg(long, value_enum, help_heading = "Record")]
    kind: Option<KindName>,
    /// Where a gap or the end of the sensor's range parts the record, begin again with the start behind it
    #[arg(long, help_heading = "Record")]
    restart: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum KindName {
    /// Angular velocity at the time of the row
    Rate,
    /// Angle since the row before, rad; deg with --rate-unit deg/s
    Increment,
    /// Mean angular velocity since the row before
    Average,
}

impl From<KindName> for Kind {
    fn from(name: KindName) -> Kind {
        match name {
            KindName::Rate => Kind::Rate,
            KindName::Increment => Kind::Increment,
            KindName::Average => Kind::Average,
        }
    }
}

/// The readings of one record, part by part.
pub(super) struct Readings {
    parts: Parts,
    pub(super) kind: Kind,
    /// Whether averages are possible too.
    pub(super) is_assumed: bool,
    /// Whether nothing names the unit of the readings.
    is_unit_open: bool,
    restarts: bool,
    segments: usize,
    /// Time of the last sample, s.
    last: Option<f64>,
    found: Found,
}

/// What was found among the rows so far.
#[derive(Default)]
struct Found {
    samples: usize,
    merged: usize,
    /// s.
    first_merged: Option<f64>,
    repeated: usize,
    saturated: usize,
    new_readings_rate: Option<f64>,
    spikes: usize,
    in_bursts: usize,
    first_spike: Option<Spike>,
    /// Intervals in which a row may be missing, and the end of the first, s.
    long: usize,
    first_long: Option<f64>,
}

/// An interval in which a row may be missing, in median intervals.
const LONG: f64 = 1.5;

impl KindArguments {
    /// Those of a file that can be integrated; what is lost or doubtful in it is refused by name. `whole`: all in one part.
    pub(super) fn readings(
        &self,
        path: &Path,
        reading: &RecordArguments,
        whole: bool,
    ) -> Result<Readings, Error> {
        let parts = reading.parts(path)?;
        let name = parts.name();
        let kind = match (self.kind.map(Kind::from), parts.are_increments()) {
            (Some(kind @ (Kind::Rate | Kind::Average)), true) => {
                let rule = format!("the unit of the columns of {name} is that of an angle: increments");
                return Err(Error::input("--kind", kind.name(), &rule, "give --kind increment"));
            }
            (Some(kind), _) => kind,
            (None, true) => Kind::Increment,
            (None, false) if parts.rate_unit().is_some() => Kind::Rate,
            (None, false) => {
                let rule = format!(
                    "the kind of the readings of {name} cannot be told: the columns have no unit, and readings may be rates, \
                     increments or averages"
                );
                let remedy = "give --kind rate (rad/s at the time of the row), increment (rad since the row before) or average \
                              (rad/s, mean since the row before)";
                return Err(Error::input("--kind", "", &rule, remedy));
            }
        };
        if kind == Kind::Increment {
            check_unit(&parts)?;
        }
        let is_unit_open = parts.rate_unit().is_none() && !parts.are_increments();
        let parts = if whole { parts.whole() } else { parts };
        // an increment that stands out is none that may be left out, as its turn would be lost
        let parts = if kind == Kind::Rate { parts.without_spikes() } else { parts };
        Ok(Readings {
            parts,
            kind,
            is_assumed: self.kind.is_none() && kind == Kind::Rate,
            is_unit_open,
            restarts: self.restart,
            segments: 0,
            last: None,
            found: Found::default(),
        })
    }
}

/// Refuses a unit of rates for increments, which are angles; rad/s and deg/s of a flag stand for rad and deg.
fn check_unit(parts: &Parts) -> Result<(), Error> {
    let Some((unit, by)) = parts.read_as().rates.filter(|_| !parts.are_increments()) else { return Ok(()) };
    match by {
        NamedBy::Header | NamedBy::Layout => {
            let name = parts.name();
            let rule = format!("the unit of the columns of {name} is {unit} ({by}), that of a rate");
            let remedy = "give --kind rate or average, or name a unit of angles, rad or deg, in the header";
            Err(Error::input("--kind", Kind::Increment.name(), &rule, remedy))
        }
        NamedBy::Setting if unit == RateUnit::RevolutionsPerMinute => {
            let rule = "increments are angles, and this is the unit of a rate";
            let remedy = "convert them to rad, or to deg and give --rate-unit deg/s";
            Err(Error::input("--rate-unit", &unit.to_string(), rule, remedy))
        }
        _ => Ok(()),
    }
}

impl Readings {
    pub(super) fn name(&self) -> &str {
        self.parts.name()
    }

    /// In which units it is read, as far as its rows tell.
    pub(super) fn read_as(&self) -> ReadAs {
        self.parts.read_as()
    }

    /// Whether there are further parts.
    pub(super) fn has_more(&self) -> bool {
        self.parts.has_more()
    }

    /// The next part; behind the last, what was left out is told.
    pub(super) fn next(&mut self) -> Result<Option<Part>, Error> {
        let Some(mut part) = self.parts.next().map_err(of_a_row)? else {
            self.tell();
            return Ok(None);
        };
        self.found.add(&part);
        self.check()?;
        if self.kind != Kind::Rate {
            self.found.add_long(&part.record, self.last.filter(|_| part.continues));
        }
        // a long burst that is left out parts a segment as a gap does
        let segments = part.record.segments.iter().enumerate();
        let spans: Vec<(usize, f64, f64)> = segments.flat_map(|(k, segment)| stretches(k, segment)).collect();
        if spans.len() > part.record.segments.len() {
            part.record = part.record.spans(spans);
        }
        for (k, segment) in part.record.segments.iter().enumerate() {
            if !(k == 0 && part.continues) {
                self.check_gap(segment, &part.spikes)?;
                self.segments += 1;
            }
            self.last = segment.times().last().copied().or(self.last);
        }
        Ok(Some(part))
    }

    /// Every increment and every average counts: none may be missing or merged.
    fn check(&self) -> Result<(), Error> {
        let refused = |count: usize, what: &str| {
            let rule = format!("{count} {what}; of {}s each one counts", self.kind);
            Err(Error::input(self.name(), "", &rule, "correct the record; rates alone may miss a row"))
        };
        match (self.parts.skipped().0, self.found.merged, self.found.repeated) {
            _ if self.kind == Kind::Rate => Ok(()),
            (0, 0, 0) => Ok(()),
            (0, 0, count) => refused(count, "rows repeat the reading before"),
            (0, count, _) => refused(count, "rows have the time of the row before"),
            (count, ..) => refused(count, "rows cannot be read"),
        }
    }

    /// Refuses a `segment` that does not go on where the samples before it end.
    fn check_gap(&self, segment: &Segment, spikes: &[Spike]) -> Result<(), Error> {
        let (Some(end), Some(start), false) = (self.last, segment.times().first(), self.restarts) else {
            return Ok(());
        };
        let is_burst = |spike: &Spike| spike.burst.is_some() && end < spike.time && spike.time < *start;
        let cause = match self.found.saturated {
            _ if spikes.iter().any(is_burst) => "a burst of readings that are left out".to_string(),
            0 => "a gap".to_string(),
            count => {
                format!("a part in which the sensor is at the end of its range ({count} samples in all)")
            }
        };
        let rule = format!(
            "{cause} from {} s to {} s: how the body turned in it is not known, and the attitude behind it neither",
            short(end),
            short(*start)
        );
        Err(Error::input(
            &self.place(segment, 0),
            "",
            &rule,
            "give --window t0,t1 for one part, or --restart to begin again behind each gap",
        ))
    }

    /// What was left out or changed.
    fn tell(&self) {
        let Found {
            samples,
            merged,
            first_merged,
            repeated,
            saturated,
            new_readings_rate,
            spikes,
            in_bursts,
            long,
            first_long,
            ..
        } = self.found;
        tell_skipped(self.parts.skipped(), samples);
        self.tell_times();
        if self.is_unit_open {
            let (read, other) = match self.kind {
                Kind::Increment => ("rad", "name the unit of an angle in the header"),
                _ => ("rad/s", "name it in the header or by --rate-unit"),
            };
            let name = self.name();
            tell(
                "note",
                &format!(
                    "{name}: no unit of the readings is named, they are read as {read}; if it is another, {other}"
                ),
            );
        }
        if merged > 0 {
            let first = first_merged.map_or(String::new(), |t| format!(", the first at {} s", short(t)));
            warn(&format!("{merged} rows have the time of the row before{first}: their rates are averaged"));
        }
        if repeated > 0 {
            let rate = new_readings_rate.map_or(String::new(), |hz| format!(", {hz:.4} new ones a second"));
            warn(&format!("{repeated} rows repeat the reading before and are left out{rate}"));
        }
        if let Some(first) = self.found.first_spike {
            let (line, time) = (first.line, short(first.time));
            let bursts =
                if in_bursts > 0 { format!(", {in_bursts} of them in bursts") } else { String::new() };
            warn(&format!("{spikes} spikes are left out{bursts}, the first at line {line} ({time} s)"));
        }
        if let Some(first) = first_long {
            let first = short(first);
            warn(&format!(
                "{long} intervals are longer than {LONG} usual ones, the first ends at {first} s: the turn of a row that is missing there is \
                 not in the attitude"
            ));
        }
        if saturated > 0 {
            warn(&format!("{saturated} samples at the end of the sensor's range are left out"));
        }
        if self.segments > 1 {
            let (name, parts) = (self.name(), self.segments);
            let rule = "each has a start of its own, as the turn between them is not known";
            tell("note", &format!("{name}: {parts} parts without a gap; {rule}"));
        }
    }

    /// The unit of the times; where it is guessed from large numbers, a warning.
    fn tell_times(&self) {
        let mut read_as = self.read_as();
        read_as.rates = None;
        let (name, units) = (self.name(), read_as.units());
        let (times, by) = &read_as.times;
        if *by == NamedBy::Values && times.ends_with("since 1970") {
            warn(&format!(
                "{name}: {units}; if they count from another time, as from the start of the device, give their unit by --time-unit"
            ));
        } else {
            tell("note", &format!("{name}: {units}"));
        }
    }

    /// Name and line of a sample.
    fn place(&self, segment: &Segment, sample: usize) -> String {
        format!("{}, line {}", self.name(), segment.lines().get(sample).copied().unwrap_or(0))
    }

    /// A refusal of the library, at the line of the `sample` of a segment that it is of.
    pub(super) fn refused(&self, segment: &Segment, sample: usize, error: &StrapdownError) -> Error {
        let place = self.place(segment, sample);
        match error {
            StrapdownError::HalfTurn { angle, .. } => {
                let rule = format!(
                    "a turn by {} rad since the row before, more than half a turn (pi): samples so far apart cannot be told \
                     from those of another motion (aliasing)",
                    rounded(*angle)
                );
                Error::input(&place, "", &rule, "check --rate-unit and --time-unit, or sample more often")
            }
            StrapdownError::NotFinite { .. } | StrapdownError::Order { .. } => {
                Error::Input(format!("{place}: {error}"))
            }
            _ => Error::Input(format!("{}: {error}", self.name())),
        }
    }
}

/// The segment with number `k`, and from when to when it has samples without a long burst between them, s.
fn stretches(k: usize, segment: &Segment) -> impl Iterator<Item = (usize, f64, f64)> {
    segment.stretches().filter_map(move |range| {
        let own = segment.times().get(range)?;
        Some((k, *own.first()?, *own.last()?))
    })
}

impl Found {
    fn add(&mut self, part: &Part) {
        let record = &part.record;
        self.samples += record.samples();
        self.merged += record.merged();
        self.first_merged = self.first_merged.or(record.first_merged());
        self.repeated += record.repeated() + record.stale();
        self.saturated += record.saturated();
        self.new_readings_rate = self.new_readings_rate.or(record.new_readings_rate());
        self.spikes += part.spikes.len();
        self.in_bursts += Spike::bursts(&part.spikes).0;
        self.first_spike = self.first_spike.or(part.spikes.first().copied());
    }

    /// Counts long intervals, also that which begins `before` the record, s.
    fn add_long(&mut self, record: &Record, before: Option<f64>) {
        let pairs = record.segments.iter().flat_map(|segment| segment.times().windows(2));
        let mut intervals: Vec<(f64, f64)> = pairs.map(|pair| (pair[1] - pair[0], pair[1])).collect();
        let first = record.segments.first().and_then(|segment| segment.times().first());
        intervals.extend(before.zip(first).map(|(before, first)| (first - before, *first)));
        let mut lengths: Vec<f64> = intervals.iter().map(|(length, _)| *length).collect();
        if lengths.is_empty() {
            return;
        }
        let middle = lengths.len() / 2;
        let usual = *lengths.select_nth_unstable_by(middle, f64::total_cmp).1;
        let long = || intervals.iter().filter(|(length, _)| *length > LONG * usual);
        self.long += long().count();
        let first = long().map(|(_, end)| *end).reduce(f64::min);
        self.first_long = self.first_long.or(first);
    }
}
