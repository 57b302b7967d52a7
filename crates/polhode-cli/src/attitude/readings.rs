//! What the readings of a record are: rates, increments or averages, in segments without gaps.

use std::path::Path;

use clap::{Args, ValueEnum};
use polhode::record::{Segment, Spike};
use polhode::strapdown::{Findings, Kind, StrapdownError};
use polhode::units::RateUnit;
use polhode_files::error::{Error, tell, warn};
use polhode_files::record::{Part, Parts};
use polhode_files::text::{rounded, short};
use polhode_files::{NamedBy, ReadAs};

use crate::flags::record::{RecordArguments, of_a_row, tell_skipped};

/// What a reading is.
#[derive(Args, Clone, Debug)]
pub(super) struct KindArguments {
    /// What a reading is [default: found from the unit of the columns]
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
    /// Names of the columns that are not read.
    unused: Vec<String>,
    found: Findings,
}

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
            unused: Vec::new(),
            found: Findings::default(),
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
        self.found.add(&part.record, &part.spikes);
        self.check()?;
        for (_, name) in part.record.unused_columns() {
            if !self.unused.contains(name) {
                self.unused.push(name.clone());
            }
        }
        if self.kind != Kind::Rate {
            self.found.add_intervals(&part.record, self.last.filter(|_| part.continues));
        }
        part.record = part.record.parted();
        if self.kind == Kind::Rate {
            self.found.add_jumps(&part.record);
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
        let remedy = "correct the record; only rates may miss a row";
        let lost = self.found.lost(self.kind, self.parts.skipped().0);
        lost.map_or(Ok(()), |rule| Err(Error::input(self.name(), "", &rule, remedy)))
    }

    /// Refuses a `segment` that does not go on where the samples before it end.
    fn check_gap(&self, segment: &Segment, spikes: &[Spike]) -> Result<(), Error> {
        let (Some(end), Some(start), false) = (self.last, segment.times().first(), self.restarts) else {
            return Ok(());
        };
        let is_burst = |spike: &Spike| spike.burst.is_some() && end < spike.time && spike.time < *start;
        let cause = match self.found.saturated() {
            _ if spikes.iter().any(is_burst) => "a burst of readings that are left out".to_string(),
            0 => "a gap".to_string(),
            count => {
                format!("a part in which the sensor is at the end of its range ({count} samples in all)")
            }
        };
        let rule = format!(
            "{cause} from {} s to {} s: the turn in it is not known, and so neither is the attitude after it",
            short(end),
            short(*start)
        );
        Err(Error::input(
            &self.place(segment, 0),
            "",
            &rule,
            "give --window t0,t1 for one part, or --restart to begin again after each gap",
        ))
    }

    /// What was left out or changed.
    fn tell(&self) {
        tell_skipped(self.parts.skipped(), self.found.samples());
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
        if !self.unused.is_empty() {
            warn(&format!("{}: columns not used: {}", self.name(), self.unused.join(", ")));
        }
        self.found.warnings("line").iter().for_each(|warning| warn(warning));
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
                    "a turn by {} rad since the row before, more than half a turn (pi): between samples so far apart the motion \
                     is ambiguous (aliasing)",
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
