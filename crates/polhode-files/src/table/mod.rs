//! Tables: lines of cells under a header, read one row at a time.

mod array;
mod axes;
mod cells;
mod clock;
mod flags;
mod header;
mod lammps;
mod lines;
mod look;
mod name;
mod ros;
mod source;
mod spellings;

use std::collections::VecDeque;
use std::ops::Range;
use std::path::Path;

use polhode::units::{AngleUnit, RateUnit, TimeUnit};

pub use axes::SignedAxes;
pub(crate) use cells::{Delimiter, digits, plain, uncommented, width_rule};
use clock::{Clock, Preamble};
pub use flags::ColumnNames;
pub(crate) use header::{Columns, Group, Header};
pub(crate) use lines::{Line, Lines};
pub(crate) use name::Name;
pub(crate) use source::Source;
pub(crate) use spellings::{Quantity, RATE_ENDINGS};

use crate::error::{Rule, TableError};
use crate::read_as::{NamedBy, ReadAs, sample_rate};

/// How a table is read, where its header leaves it open.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Columns that are named by a flag.
    pub columns: ColumnNames,
    /// Unit of time where the header names none; without it that of the layout, or s.
    pub time_unit: Option<TimeUnit>,
    /// Unit of the rates where the header names none; without it that of the layout, or what the view takes.
    pub rate_unit: Option<RateUnit>,
    /// Samples a second, where a column counts samples or rows have no time.
    pub sample_rate: Option<f64>,
    /// Share of the rows of a record that may be left out because they cannot be read, 0.02 without it.
    pub most_skipped: Option<f64>,
    /// Which columns are the rates of a record about x, y and z, and with which signs; without it as they are named.
    pub axes: Option<SignedAxes>,
    /// Whether the columns of a record may be angles, rad or deg: increments since the row before.
    pub increments: bool,
}

impl ReadOptions {
    /// With columns that are named by a flag.
    #[must_use]
    pub fn with_columns(self, columns: ColumnNames) -> Self {
        Self { columns, ..self }
    }

    /// With the unit of time where the header names none.
    #[must_use]
    pub fn with_time_unit(self, unit: impl Into<Option<TimeUnit>>) -> Self {
        Self { time_unit: unit.into(), ..self }
    }

    /// With the unit of the rates where the header names none.
    #[must_use]
    pub fn with_rate_unit(self, unit: impl Into<Option<RateUnit>>) -> Self {
        Self { rate_unit: unit.into(), ..self }
    }

    /// With the samples a second, where a column counts samples or rows have no time.
    #[must_use]
    pub fn with_sample_rate(self, rate: impl Into<Option<f64>>) -> Self {
        Self { sample_rate: rate.into(), ..self }
    }

    /// With the share of the rows of a record that may be left out because they cannot be read.
    #[must_use]
    pub fn with_most_skipped(self, share: impl Into<Option<f64>>) -> Self {
        Self { most_skipped: share.into(), ..self }
    }

    /// With the columns that are the rates of a record about x, y and z.
    #[must_use]
    pub fn with_axes(self, axes: impl Into<Option<SignedAxes>>) -> Self {
        Self { axes: axes.into(), ..self }
    }

    /// With columns of a record that may be increments since the row before, if `increments` is true.
    #[must_use]
    pub fn with_increments(self, increments: bool) -> Self {
        Self { increments, ..self }
    }
}

const TIME_UNITS: &str = "s, ms, us, ns, min, h";
const RATE_UNITS: &str = "rad/s, deg/s, rpm";

/// A table, row by row.
pub(crate) struct Table<'t> {
    source: Source<'t>,
    /// Lines that were looked at and not yet read.
    ahead: VecDeque<Line>,
    pub(crate) header: Header,
    /// The line of the header, where there is one.
    named_at: Option<u64>,
    /// Lines above the rows that are comments, without their mark.
    pub(crate) comments: Vec<String>,
    preamble: Preamble,
    delimiter: Delimiter,
    /// The unit of the times, where something names one.
    pub(crate) time_unit: Option<TimeUnit>,
    /// What named the units of times and rates.
    named_by: [NamedBy; 2],
    /// Whether the columns of the rates are angles by their unit.
    pub(crate) are_increments: bool,
    clock: Clock,
    /// The present row.
    line: Line,
    cells: Vec<Range<usize>>,
    rows: u64,
    /// Cells of the row before.
    width: usize,
}

impl Table<'static> {
    /// Of the file at `path`, or of standard input where that is `-`.
    pub(crate) fn open(path: &Path, reading: &ReadOptions) -> Result<Self, TableError> {
        Table::new(Source::new(Lines::open(path)?)?, reading)
    }
}

impl<'t> Table<'t> {
    /// Of a text in memory, which messages call `name`.
    pub(crate) fn of_text(text: &'t str, name: &str, reading: &ReadOptions) -> Result<Self, TableError> {
        Table::new(Source::new(Lines::of_text(text, name))?, reading)
    }

    pub(crate) fn new(mut source: Source<'t>, reading: &ReadOptions) -> Result<Self, TableError> {
        let looked = look::look(&mut source, reading)?;
        let preamble = Preamble::of(&looked.before);
        let comments =
            looked.before.iter().filter_map(|line| uncommented(&line.text)).map(String::from).collect();
        let mut header = looked.header;
        if header.time == Some(0) {
            header.time_unit = header.time_unit.or(source.time_unit());
        }
        let mut table = Table {
            source,
            ahead: looked.ahead,
            header,
            named_at: looked.named_at,
            comments,
            preamble,
            delimiter: looked.delimiter,
            time_unit: None,
            named_by: [NamedBy::Nothing; 2],
            are_increments: false,
            clock: Clock::new(None),
            line: Line::default(),
            cells: Vec::new(),
            rows: 0,
            width: 0,
        };
        let below = table.units_below()?;
        (table.time_unit, table.named_by[0]) = table.resolve_time(reading, below)?;
        table.clock = Clock::new(table.time_unit);
        table.resolve_rates(reading)?;
        Ok(table)
    }

    /// As messages name it.
    pub(crate) fn name(&self) -> &str {
        self.source.name()
    }

    /// Whether it is a dump of LAMMPS.
    pub(crate) fn is_dump(&self) -> bool {
        self.source.is_dump()
    }

    /// Whether its times are steps of a length that nothing tells.
    pub(crate) fn counts_steps(&self) -> bool {
        let steps = |place: usize| self.header.names[place].letters == "timestep";
        self.time_unit.is_none() && self.header.time.is_some_and(steps)
    }

    /// Reads the next line that is neither empty nor a comment; `false` behind the last.
    fn advance(&mut self) -> Result<bool, TableError> {
        loop {
            match self.ahead.pop_front() {
                Some(line) => self.line = line,
                None if self.source.advance(&mut self.line)? => {}
                None => return Ok(false),
            }
            if !self.line.text.is_empty() && uncommented(&self.line.text).is_none() {
                return Ok(true);
            }
        }
    }

    /// Reads the next row; `false` behind the last.
    pub(crate) fn next(&mut self) -> Result<bool, TableError> {
        self.width = self.cells.len();
        if !self.advance()? {
            return Ok(false);
        }
        self.split();
        self.rows += 1;
        Ok(true)
    }

    fn split(&mut self) {
        let columns = self.header.names.len();
        self.delimiter.split(&self.line.text, &mut self.cells);
        // blanks may align columns or separate words
        if !matches!(self.delimiter, Delimiter::Mark(_)) && self.cells.len() != columns {
            for other in [Delimiter::Wide, Delimiter::Blanks] {
                other.split(&self.line.text, &mut self.cells);
                if self.cells.len() == columns {
                    break;
                }
            }
        }
        // a separator at the end of every row makes one empty cell more
        if self.cells.len() == columns + 1 && self.cell(columns).is_empty() {
            self.cells.pop();
        }
    }

    /// Whether the present row has the cells that its header asks for.
    pub(crate) fn check(&self) -> Result<(), TableError> {
        let header = &self.header;
        if self.cells.len() == header.names.len() {
            return Ok(());
        }
        let last = header.columns().into_iter().chain(header.time).chain(header.nanoseconds).max();
        let (line, widths) =
            ((self.line.text.as_str(), self.line.is_ended), (self.cells.len(), header.names.len()));
        let broken = cells::width_rule(line, self.delimiter, widths, last.unwrap_or(0), self.width);
        broken.map_or(Ok(()), |rule| Err(self.refused(rule)))
    }

    /// The text of a cell; empty where the row has none.
    pub(crate) fn cell(&self, place: usize) -> &str {
        self.cells.get(place).map_or("", |cell| plain(&self.line.text[cell.clone()]))
    }

    /// The number in a cell.
    pub(crate) fn number(&self, place: usize) -> Result<f64, TableError> {
        let text = self.cell(place);
        match self.delimiter.number(text).parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(self.refused_cell(place, Rule::Finite)),
            Err(_) if text.is_empty() => Err(self.refused_cell(place, Rule::Missing)),
            Err(_) if cells::may_part_thousands(text) => Err(self.refused_cell(place, Rule::Comma)),
            Err(_) => Err(self.refused_cell(place, Rule::Number)),
        }
    }

    /// The numbers in several cells.
    pub(crate) fn numbers<const N: usize>(&self, places: &[usize]) -> Result<[f64; N], TableError> {
        let mut values = [0.0; N];
        for (value, place) in values.iter_mut().zip(places) {
            *value = self.number(*place)?;
        }
        Ok(values)
    }

    /// The time of the present row, s.
    pub(crate) fn time(&mut self) -> Result<f64, TableError> {
        let Some(place) = self.header.time else {
            return Ok(self.time_unit.unwrap_or(TimeUnit::Seconds).seconds((self.rows - 1) as f64));
        };
        let cell =
            |place: usize| self.cells.get(place).map_or("", |cell| plain(&self.line.text[cell.clone()]));
        let text = self.delimiter.number(cell(place));
        let found = self.clock.seconds(&text, self.header.nanoseconds.map(cell));
        found.ok_or_else(|| match self.number(place) {
            Err(error) => error,
            Ok(_) => self.refused_cell(place, Rule::Number),
        })
    }

    /// What a number of this column is in its unit; one of a dump that names its units is brought to seconds, with its times or without them.
    pub(crate) fn scale(&self, place: usize) -> f64 {
        let per_second = self.source.style_unit().map_or(1.0, |unit| 1.0 / unit.seconds(1.0));
        self.preamble.scale(&self.header.names[place].text) * per_second
    }

    /// The number of the present line.
    pub(crate) fn line(&self) -> u64 {
        self.line.number
    }

    /// A rule that the present row breaks.
    pub(crate) fn refused(&self, rule: Rule) -> TableError {
        TableError::of(self.name(), rule).at(self.line.number)
    }

    /// A rule that a cell of the present row breaks.
    pub(crate) fn refused_cell(&self, place: usize, rule: Rule) -> TableError {
        self.refused(rule).in_column(place, &self.header.names[place].text).value(self.cell(place))
    }

    /// A rule that the header of a column breaks.
    pub(crate) fn refused_column(&self, place: usize, rule: Rule) -> TableError {
        let error = TableError::of(self.name(), rule).in_column(place, &self.header.names[place].text);
        match self.named_at {
            Some(line) => error.at(line),
            None => error,
        }
    }

    /// Reads a row of units below the names, and passes over one that says what is calibrated; the unit of time that it names.
    fn units_below(&mut self) -> Result<Option<TimeUnit>, TableError> {
        while self.advance()? {
            self.split();
            let time = self.header.time.and_then(|place| TimeUnit::named(self.cell(place)));
            let named = |place: &usize| {
                RateUnit::named(self.cell(*place)).map(|_| Some(self.cell(*place).to_string()))
            };
            let body = self.header.bodies.first();
            let rates: Option<Option<Vec<Option<String>>>> = body
                .and_then(|body| body.rates.as_ref())
                .map(|rates| rates.places.iter().map(named).collect());
            let angle = |place: &usize| {
                AngleUnit::named(self.cell(*place)).map(|_| Some(self.cell(*place).to_string()))
            };
            let angles: Option<Vec<Option<String>>> = body
                .and_then(|body| body.attitude.as_ref())
                .filter(|attitude| attitude.quantity == Quantity::Angles)
                .and_then(|attitude| attitude.places.iter().map(angle).collect());
            let is_note =
                self.header.columns().iter().all(|place| self.cell(*place).eq_ignore_ascii_case("cal"));
            let is_text = !self.header.columns().iter().any(|place| cells::is_number(self.cell(*place)));
            let are_units = time.is_some() && (matches!(rates, Some(Some(_))) || rates.is_none() && is_text);
            if let (true, Some(units)) = (are_units, angles)
                && let Some(attitude) = self.header.bodies.first_mut().and_then(|body| body.attitude.as_mut())
            {
                attitude.units = units;
            }
            match (time, rates) {
                (Some(time), Some(Some(units))) => {
                    if let Some(rates) = self.header.bodies.first_mut().and_then(|body| body.rates.as_mut()) {
                        rates.units = units;
                    }
                    return Ok(Some(time));
                }
                (Some(time), None) if is_text => return Ok(Some(time)),
                _ if is_note => {}
                _ => {
                    self.ahead.push_front(std::mem::take(&mut self.line));
                    break;
                }
            }
        }
        self.cells.clear();
        Ok(None)
    }

    /// The unit of the times: that of the names, a setting, the layout, or the lines above; they must not contradict each other.
    fn resolve_time(
        &self,
        reading: &ReadOptions,
        below: Option<TimeUnit>,
    ) -> Result<(Option<TimeUnit>, NamedBy), TableError> {
        let counted = reading.sample_rate.map(|rate| TimeUnit::Multiple(1.0 / rate));
        let by = |unit: Option<TimeUnit>, by| unit.map_or(NamedBy::Nothing, |_| by);
        let Some(place) = self.header.time else { return Ok((counted, by(counted, NamedBy::Setting))) };
        let name = &self.header.names[place];
        let refused = |rule| self.refused_column(place, rule);
        let stated = match name.time_unit() {
            Some((text, None)) => return Err(refused(Rule::KnownUnit(TIME_UNITS)).value(text)),
            Some((_, unit)) => unit,
            None => below,
        };
        let clash = |unit: TimeUnit, flag: String| Err(refused(Rule::OneUnit(unit.to_string(), flag)));
        let of_style = self.source.time_unit().filter(|_| place == 0);
        match (stated.or(of_style), reading.time_unit, counted) {
            (Some(stated), Some(set), _) if set != stated => return clash(stated, set.to_string()),
            (Some(stated), _, Some(_)) => return clash(stated, "--sample-rate".into()),
            (None, Some(set), Some(_)) => return clash(set, "--sample-rate".into()),
            (None, None, Some(_)) if !name.is_counter() && !self.header.time_is_named => {
                let rule = "is a time, and the flag --sample-rate counts samples";
                return Err(refused(Rule::Other(rule.into()))
                    .with_remedy("drop --sample-rate, or name the counter by --columns t=NAME"));
            }
            _ => {}
        }
        let set = reading.time_unit.or(counted);
        let told = self.header.time_unit.or_else(|| self.preamble.time_unit(name));
        let unit = stated.or(set).or(told);
        if unit.is_none() && name.is_counter() {
            return Err(refused(Rule::Time));
        }
        let of_others = by(set, NamedBy::Setting).or(by(told, NamedBy::Layout));
        Ok((unit, by(stated, NamedBy::Header).or(of_others)))
    }

    /// The units of the angular velocity are known, and do not contradict a setting.
    fn resolve_rates(&mut self, reading: &ReadOptions) -> Result<(), TableError> {
        let implied = self.header.rate_unit.or(self.preamble.rate_unit());
        self.named_by[1] = match (reading.rate_unit, implied) {
            (Some(_), _) => NamedBy::Setting,
            (None, Some(_)) => NamedBy::Layout,
            (None, None) => NamedBy::Nothing,
        };
        let rates = self.header.bodies.first().and_then(|body| body.rates.as_ref());
        if rates.is_some_and(|rates| rates.units.first().is_some_and(Option::is_some)) {
            self.named_by[1] = NamedBy::Header;
        }
        let stated = self.header.bodies.iter().filter_map(|body| body.rates.as_ref());
        for (place, text) in stated.flat_map(|rates| rates.places.iter().zip(&rates.units)) {
            let Some(text) = text else { continue };
            let angle = AngleUnit::named(text).filter(|_| reading.increments);
            self.are_increments |= angle.is_some();
            let Some(unit) = angle.map(per_second).or(RateUnit::named(text)) else {
                return Err(self.refused_column(*place, Rule::KnownUnit(RATE_UNITS)).value(text));
            };
            if let Some(set) = reading.rate_unit.filter(|set| *set != unit) {
                return Err(self.refused_column(*place, Rule::OneUnit(unit.to_string(), set.to_string())));
            }
        }
        self.header.rate_unit = reading.rate_unit.or(implied);
        let bare = self.header.bodies.iter().filter_map(|body| body.rates.as_ref()).find_map(|rates| {
            let bare = rates.units.iter().position(Option::is_none)?;
            (self.header.rate_unit.is_none() && rates.units.iter().any(Option::is_some))
                .then(|| rates.places[bare])
        });
        bare.map_or(Ok(()), |place| {
            let rule = Rule::Other("names no unit, and another rate of the body does".into());
            Err(self.refused_column(place, rule).with_remedy("write the unit of each, or give --rate-unit"))
        })
    }

    /// In which units it was read; `steps` are the times between samples that were kept, s.
    pub(crate) fn read_as(&self, steps: Vec<f64>) -> ReadAs {
        let [of_times, of_rates] = self.named_by;
        let has_rates = self.header.bodies.first().is_some_and(|body| body.rates.is_some());
        let unit = self.rate_units(0)[0].unwrap_or_default();
        ReadAs {
            file: self.name().into(),
            rates: has_rates.then_some((unit, of_rates)),
            times: self.clock.words().unwrap_or_else(|| {
                let unit = self.time_unit.unwrap_or(TimeUnit::Seconds);
                let steps = if matches!(unit, TimeUnit::Multiple(_)) { "steps of " } else { "" };
                (format!("{steps}{unit}"), of_times)
            }),
            since: self.clock.since().map(String::from),
            begins: self.clock.begins(),
            sample_rate: sample_rate(steps),
            axes: None,
        }
    }

    /// The unit of each rate of a body, where something names one.
    pub(crate) fn rate_units(&self, body: usize) -> [Option<RateUnit>; 3] {
        let rates = self.header.bodies.get(body).and_then(|body| body.rates.as_ref());
        [0, 1, 2].map(|axis| {
            let stated = rates.and_then(|rates| rates.units.get(axis)?.as_deref());
            let angle = stated.filter(|_| self.are_increments).and_then(AngleUnit::named);
            angle.map(per_second).or(stated.and_then(RateUnit::named)).or(self.header.rate_unit)
        })
    }
}

/// The rate that is this angle in every second: the same factor.
fn per_second(unit: AngleUnit) -> RateUnit {
    match unit {
        AngleUnit::Radians => RateUnit::RadiansPerSecond,
        AngleUnit::Degrees => RateUnit::DegreesPerSecond,
    }
}
