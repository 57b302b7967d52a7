//! What the readings of a record are: rates, increments or averages, in segments without gaps.

use std::path::Path;

use clap::{Args, ValueEnum};
use polhode::record::{Record, Segment};
use polhode::strapdown::{Kind, StrapdownError};
use polhode_files::error::{Error, warn};
use polhode_files::text::{rounded, short, visible};

use crate::flags::record::RecordArguments;

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

/// The readings of one record.
pub(super) struct Readings {
    pub(super) name: String,
    pub(super) record: Record,
    pub(super) kind: Kind,
    /// Whether averages are possible too.
    pub(super) is_assumed: bool,
}

impl KindArguments {
    /// Those of a file that can be integrated; what is lost or doubtful in it is refused by name.
    pub(super) fn readings(&self, path: &Path, reading: &RecordArguments) -> Result<Readings, Error> {
        let (record, are_increments, skipped) = reading.readings(path)?;
        let name = record.segments.first().map_or(String::new(), |segment| segment.source().to_string());
        let named = record.segments.first().is_some_and(|segment| segment.rate_unit().is_some());
        let kind = match (self.kind.map(Kind::from), are_increments) {
            (Some(kind @ (Kind::Rate | Kind::Average)), true) => {
                let rule = format!("the unit of the columns of {name} is that of an angle: increments");
                return Err(Error::input("--kind", kind.name(), &rule, "give --kind increment"));
            }
            (Some(kind), _) => kind,
            (None, true) => Kind::Increment,
            (None, false) if named => Kind::Rate,
            (None, false) => {
                let rule = "cannot be told: the columns have no unit, and readings may be rates, increments or averages";
                let remedy = "give --kind rate (rad/s at the time of the row), increment (rad since the row before) or average \
                              (rad/s, mean since the row before)";
                return Err(Error::input(
                    "--kind",
                    "",
                    &format!("the kind of the readings of {name} {rule}"),
                    remedy,
                ));
            }
        };
        let is_assumed = self.kind.is_none() && kind == Kind::Rate;
        let readings = Readings { name, record, kind, is_assumed };
        readings.check(skipped)?;
        let readings = readings.without_spikes();
        readings.check_gaps(self.restart)?;
        Ok(readings)
    }
}

impl Readings {
    pub(super) fn segments(&self) -> &[Segment] {
        &self.record.segments
    }

    pub(super) fn samples(&self) -> usize {
        self.record.samples()
    }

    /// Every increment and every average counts: none may be missing or merged.
    fn check(&self, skipped: usize) -> Result<(), Error> {
        let (merged, repeated) = (self.record.merged(), self.record.repeated());
        let refused = |count: usize, what: &str| {
            let rule = format!("{count} {what}; of {}s each one counts", self.kind);
            Err(Error::input(&self.name, "", &rule, "correct the record; rates alone may miss a row"))
        };
        if self.kind != Kind::Rate {
            return match (skipped, merged, repeated) {
                (0, 0, 0) => Ok(()),
                (0, 0, count) => refused(count, "rows repeat the reading before"),
                (0, count, _) => refused(count, "rows have the time of the row before"),
                (count, ..) => refused(count, "rows cannot be read"),
            };
        }
        if merged > 0 {
            warn(&format!("{merged} rows have the time of the row before: their rates are averaged"));
        }
        if repeated > 0 {
            let rate = self
                .record
                .new_readings_rate()
                .map_or(String::new(), |hz| format!(", {hz:.4} new ones a second"));
            warn(&format!("{repeated} rows repeat the reading before and are left out{rate}"));
        }
        Ok(())
    }

    /// Rates that stand out of their neighbours are left out; an increment is not, as its turn would be lost.
    fn without_spikes(self) -> Self {
        let cleaned = (self.kind == Kind::Rate).then(|| self.record.without_spikes()).flatten();
        let Some((spikes, record)) = cleaned else { return self };
        if let Some(first) = spikes.first() {
            let count = spikes.len();
            warn(&format!(
                "{count} spikes are left out, the first at line {} ({} s)",
                first.line,
                short(first.time)
            ));
        }
        Readings { record, ..self }
    }

    fn check_gaps(&self, restart: bool) -> Result<(), Error> {
        let saturated = self.record.saturated();
        let [first, second, ..] = self.segments() else {
            if saturated > 0 {
                warn(&format!(
                    "{saturated} samples at the end of the sensor's range are left out, at an end of the record"
                ));
            }
            return Ok(());
        };
        if restart {
            return Ok(());
        }
        let (Some(end), Some(start)) = (first.times().last(), second.times().first()) else { return Ok(()) };
        let line = second.lines().first().copied().unwrap_or(0);
        let cause = match saturated {
            0 => "a gap".to_string(),
            count => {
                format!("a part in which the sensor is at the end of its range ({count} samples in all)")
            }
        };
        let rule = format!(
            "{cause} from {} s to {} s: how the body turned in it is not known, and the attitude behind it neither",
            short(*end),
            short(*start)
        );
        let place = format!("{}, line {line}", visible(&self.name));
        Err(Error::input(
            &place,
            "",
            &rule,
            "give --window t0,t1 for one part, or --restart to begin again behind each gap",
        ))
    }

    /// A refusal of the library, at its line.
    pub(super) fn refused(&self, segment: &Segment, error: &StrapdownError) -> Error {
        let at = |sample: &usize| segment.lines().get(*sample).copied().unwrap_or(0);
        let place = |sample| format!("{}, line {}", visible(&self.name), at(sample));
        match error {
            StrapdownError::HalfTurn { sample, angle, .. } => {
                let rule = format!(
                    "a turn by {} rad since the row before, more than half a turn (pi): samples so far apart cannot be told \
                     from those of another motion (aliasing)",
                    rounded(*angle)
                );
                Error::input(
                    &place(sample),
                    "",
                    &rule,
                    "check --rate-unit and --time-unit, or sample more often",
                )
            }
            StrapdownError::NotFinite { sample, .. } | StrapdownError::Order { sample, .. } => {
                Error::Input(format!("{}: {error}", place(sample)))
            }
            _ => Error::Input(format!("{}: {error}", visible(&self.name))),
        }
    }
}
