//! The rows of a table that is a record.

use polhode::audit::Frame;
use polhode::record::{RawRows, Record, RecordError};
use polhode::units::RateUnit;

use super::inputs::Inputs;
use crate::error::{Rule, TableError};
use crate::table::{ReadOptions, SignedAxes, Table};
use crate::text::visible;

/// Share of bad rows that is passed over.
const MOST_SKIPPED: f64 = 0.02;

/// Line, and time and rates: s and rad/s.
pub(super) type Row = (usize, [f64; 4]);

/// Rows on their way from a table to a record.
pub(super) struct Rows<'t> {
    pub(super) table: Table<'t>,
    rates: [usize; 3],
    units: [RateUnit; 3],
    scale: f64,
    axes: Option<SignedAxes>,
    most_skipped: f64,
    /// Columns beside the rates.
    pub(super) inputs: Inputs,
    owner: Owner,
    /// Time of the row before, s.
    before: Option<f64>,
    /// Rows that were read.
    count: usize,
}

impl<'t> Rows<'t> {
    pub(super) fn new(table: Table<'t>, reading: &ReadOptions) -> Result<Self, TableError> {
        let rates = rates(&table)?;
        Ok(Rows {
            rates,
            units: table.rate_units(0).map(Option::unwrap_or_default),
            scale: table.scale(rates[0]),
            axes: reading.axes,
            most_skipped: reading.most_skipped.unwrap_or(MOST_SKIPPED),
            inputs: Inputs::default(),
            owner: Owner::default(),
            before: None,
            count: 0,
            table,
        })
    }

    /// Reads on until there are `most` rows or the table ends; whether it has not ended. Rows that cannot be read are `skipped`.
    pub(super) fn read(
        &mut self,
        most: usize,
        rows: &mut Vec<Row>,
        skipped: &mut Vec<TableError>,
    ) -> Result<bool, TableError> {
        while rows.len() < most {
            if !self.table.next()? {
                return Ok(false);
            }
            let row = row(&mut self.table, self.rates, self.units, self.scale, self.before);
            match row.and_then(|row| self.inputs.push(&self.table).map(|()| row)) {
                Ok(row) => {
                    self.owner.check(&self.table)?;
                    let [time, x, y, z] = row;
                    let [x, y, z] = self.axes.map_or([x, y, z], |axes| axes.apply([x, y, z]));
                    self.before = Some(time);
                    self.count += 1;
                    rows.push((usize::try_from(self.table.line()).unwrap_or(usize::MAX), [time, x, y, z]));
                }
                // a first row that is text is no row of numbers
                Err(error) if self.count == 0 && matches!(error.rule, Rule::Number | Rule::Comma) => {
                    return Err(error);
                }
                Err(error) => skipped.push(error),
            }
        }
        Ok(true)
    }

    /// Whether so many rows may have been left out of those that were read so far.
    pub(super) fn may_skip(&self, skipped: usize) -> bool {
        skipped as f64 <= (self.most_skipped * (self.count + skipped) as f64).floor()
    }

    /// The unit of the rates, where something names one.
    pub(super) fn rate_unit(&self) -> Option<RateUnit> {
        self.table.rate_units(0)[0]
    }

    /// The record of these rows.
    pub(super) fn record(&self, rows: Vec<Row>) -> Result<Record, TableError> {
        let (table, header) = (&self.table, &self.table.header);
        let time = header.time.unwrap_or(0);
        let columns = [time, self.rates[0], self.rates[1], self.rates[2]];
        let is_read = |place: usize| {
            columns[1..].contains(&place)
                || [header.time, header.nanoseconds].contains(&Some(place))
                || self.inputs.reads(place, &header.names[place].letters)
        };
        let others = header.names.iter().enumerate().filter(|(place, _)| !is_read(*place));
        let unused = others.map(|(place, name)| match &*name.text {
            "" => format!("column {}", place + 1),
            text => text.into(),
        });
        let unused = unused.collect();
        let names = columns.map(|column| header.names[column].text.clone());
        let of_rows = || rows.iter().map(|(line, _)| *line).collect::<Vec<usize>>();
        let lines = self.inputs.are_given().then(of_rows);
        let (columns, rate_unit) = (columns.map(|column| column + 1), self.rate_unit());
        let rows = RawRows { rows, names, columns, rate_unit, unused };
        let record = Record::cleaned(table.name(), rows).map_err(|error| self.refused(error))?;
        match lines {
            Some(lines) => self.inputs.complete(record, &lines).map_err(|error| self.refused(error)),
            None => Ok(record),
        }
    }

    /// A refusal of the library, in the words of tables.
    fn refused(&self, error: RecordError) -> TableError {
        let rule = match error {
            RecordError::Empty { window: None, .. } => Rule::Rows,
            other => Rule::Other(other.to_string()),
        };
        TableError::of(self.table.name(), rule)
    }
}

/// The body of the row before, where rows have names.
#[derive(Default)]
struct Owner {
    name: String,
    /// The first names that came before it.
    earlier: Vec<String>,
    /// Whether the first name has had more than one row, as that of a counter has not.
    is_first_of_several: bool,
}

/// Names that are kept: of more bodies in turn the first would come again.
const KEPT: usize = 64;

impl Owner {
    /// Refuses rows of several bodies, whose names stand in several rows; those of a counter do not.
    fn check(&mut self, table: &Table) -> Result<(), TableError> {
        let Some(id) = table.header.id else { return Ok(()) };
        let name = table.cell(id);
        if name == self.name {
            // no name comes before the first
            self.is_first_of_several |= self.earlier.len() == 1;
            return Ok(());
        }
        if !name.is_empty() && self.earlier.iter().any(|earlier| earlier == name) {
            let rule = format!("rows of '{}' lie between rows of this body", visible(&self.name));
            return Err(table.refused_cell(id, Rule::Other(rule)).with_remedy("name a file of one body"));
        }
        if !name.is_empty() && self.is_first_of_several {
            let first = self.earlier.get(1).unwrap_or(&self.name);
            let rule = format!("rows of '{}' come before rows of this body", visible(first));
            let remedy = "name a file of one body, or rename the column if it names no bodies";
            return Err(table.refused_cell(id, Rule::Other(rule)).with_remedy(remedy));
        }
        if self.earlier.len() < KEPT {
            self.earlier.push(self.name.clone());
        }
        self.name.clear();
        self.name.push_str(name);
        Ok(())
    }
}

/// The columns of the rates, which must be those of one body in its own axes.
fn rates(table: &Table) -> Result<[usize; 3], TableError> {
    let header = &table.header;
    if table.counts_steps()
        && let Some(time) = header.time
    {
        return Err(table.refused_column(time, Rule::Time));
    }
    let other =
        |rule: String, remedy: &str| Err(TableError::of(table.name(), Rule::Other(rule)).with_remedy(remedy));
    let rates = match &header.bodies[..] {
        [body] => body.rates.as_ref(),
        bodies => {
            return other(
                format!("{} bodies, and a record must have one", bodies.len()),
                "name its columns by --columns",
            );
        }
    };
    let Some(rates) = rates else {
        let names = header.names.iter().map(|name| name.text.clone()).collect();
        return Err(TableError::of(table.name(), Rule::Column("the rate about x".into(), names)));
    };
    if table.is_dump() || rates.frame == Some(Frame::Space) {
        let remedy = "turn it into the axes of the body first";
        return other(
            "the angular velocity is in space axes, and a record needs it in those of the sensor".into(),
            remedy,
        );
    }
    Ok([rates.places[0], rates.places[1], rates.places[2]])
}

/// Time and rates of the present row, s and rad/s.
fn row(
    table: &mut Table,
    rates: [usize; 3],
    units: [RateUnit; 3],
    scale: f64,
    before: Option<f64>,
) -> Result<[f64; 4], TableError> {
    table.check()?;
    let mut row = [table.time()?, 0.0, 0.0, 0.0];
    for axis in 0..3 {
        row[axis + 1] = units[axis].radians_per_second(table.number(rates[axis])? * scale);
    }
    match (before, table.header.time) {
        (Some(before), Some(time)) if row[0] < before => {
            Err(table.refused_cell(time, Rule::Order(before, false)))
        }
        _ => Ok(row),
    }
}
