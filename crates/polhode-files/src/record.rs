//! Records of angular velocity from the logs of phones, loggers and flight controllers.

use std::path::Path;

use nalgebra::Vector3;
use polhode::audit::Frame;
use polhode::record::{RawRows, Record, RecordError};
use polhode::units::{MomentumUnit, RateUnit, TorqueUnit};

use crate::error::{Error, Rule, TableError};
pub use crate::table::ReadOptions;
use crate::table::Table;
use crate::text::visible;

/// Share of bad rows that is passed over.
const MOST_SKIPPED: f64 = 0.02;

/// A record, and what was not read of its file.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FoundRecord {
    /// The samples.
    pub record: Record,
    /// Why rows were left out, one by one.
    pub skipped: Vec<TableError>,
    /// What else a user should know.
    pub remarks: Vec<String>,
    /// Whether the columns are angles by their unit, which [`ReadOptions::increments`] allows: increments since the row before, rad.
    pub are_increments: bool,
}

/// A record from a text of rows, which messages call `file`.
///
/// Cells are separated by comma, semicolon or tab, or by blanks, with decimal commas where semicolons or tabs separate them,
/// or within quotes. Lines before the header and lines that begin with `#`, `%` or `//` may hold anything, and so may columns
/// that are not needed. Columns are found by the names that phones, loggers, flight controllers and ROS give them, or as
/// [`ReadOptions::columns`] says; four columns of numbers need no header. Of several times the one whose name has a unit is read;
/// dates, and counts since 1970, are taken from the first row on. Columns `hx, hy, hz` (N m s) are the momentum of wheels,
/// `tx, ty, tz` (N m) a torque.
///
/// Rows that cannot be read are [left out](FoundRecord::skipped), up to a [share](ReadOptions::most_skipped).
///
/// ```
/// use polhode_files::ColumnNames;
/// use polhode_files::record::{ReadOptions, read};
/// let text = "when;p_gyro;q_gyro;r_gyro\n22-Nov-2025 10:00:00.00;1;2;3\n22-Nov-2025 10:00:00.01;1;2;3\n";
/// let columns = ColumnNames::parse("t=when,x=p_gyro,y=q_gyro,z=r_gyro").unwrap();
/// let record = read(text, "flight.csv", &ReadOptions::default().with_columns(columns))?.record;
/// assert_eq!(record.segments[0].times(), [0.0, 0.01]);
///
/// let text = "t (ms), wx (deg/s), wy (deg/s), wz (deg/s)\n0, 0, 90, 180\n10, 1, 90, 180\n10, 3, 90, 180\n";
/// let record = read(text, "toss.csv", &ReadOptions::default())?.record;
/// assert_eq!((record.samples(), record.merged()), (2, 1)); // rows of the same time are averaged
/// assert_eq!(record.segments[0].rates()[1].z, core::f64::consts::PI);
///
/// let broken = read("t,wx,wy,wz\n0,1,2,3\n1,1,nan,3\n", "toss.csv", &ReadOptions::default());
/// assert!(broken.unwrap_err().to_string().starts_with("toss.csv, line 3, column 3 (wy): 'nan'"));
///
/// let text = "t,wx,wy,wz,temperature\n0,1,2,3,20\n0.1,1,2,3,20\n";
/// let record = read(text, "toss.csv", &ReadOptions::default())?.record;
/// assert_eq!(record.unused_columns(), [("toss.csv".to_string(), "temperature".to_string())]);
/// # Ok::<(), polhode_files::Error>(())
/// ```
///
/// # Errors
/// Missing columns, unknown units, more bad rows than may be left out: the first of them.
pub fn read(text: &str, file: &str, reading: &ReadOptions) -> Result<FoundRecord, Error> {
    Ok(found(Table::of_text(text, file, reading)?, reading, None)?)
}

/// The same of the file at `path`, or of standard input where that is `-`. `wheel`: the momentum, kg m², of a wheel per rad/s
/// of its speed, which is the column `wheel`, with its unit.
///
/// # Errors
/// As [`read`], and a column `wheel` that is missing or without unit.
pub fn open(path: &Path, reading: &ReadOptions, wheel: Option<Vector3<f64>>) -> Result<FoundRecord, Error> {
    Ok(found(Table::open(path, reading)?, reading, wheel)?)
}

/// Columns beside the rates, and their values at the rows.
struct Inputs {
    momenta: Option<[usize; 3]>,
    torques: Option<[usize; 3]>,
    /// Column of the speed of a wheel, and its momentum per unit of it.
    speed: Option<(usize, Vector3<f64>)>,
    /// Momentum of wheels and torque.
    rows: Vec<[Vector3<f64>; 2]>,
}

fn found(
    mut table: Table,
    reading: &ReadOptions,
    wheel: Option<Vector3<f64>>,
) -> Result<FoundRecord, TableError> {
    let rates = rates(&table)?;
    let mut remarks = Vec::new();
    let mut inputs = Inputs::of(&table, wheel, &mut remarks)?;
    let named = table.rate_units(0);
    let units = named.map(Option::unwrap_or_default);
    let scale = table.scale(rates[0]);
    let (mut rows, mut skipped): (Vec<(usize, [f64; 4])>, Vec<TableError>) = (Vec::new(), Vec::new());
    let mut owner = Owner::default();
    while table.next()? {
        let before = rows.last().map(|(_, row)| row[0]);
        let row = row(&mut table, rates, units, scale, before);
        match row.and_then(|row| inputs.push(&table).map(|()| row)) {
            Ok(row) => {
                owner.check(&table, before == Some(row[0]))?;
                let [time, x, y, z] = row;
                let [x, y, z] = reading.axes.map_or([x, y, z], |axes| axes.apply([x, y, z]));
                rows.push((usize::try_from(table.line()).unwrap_or(usize::MAX), [time, x, y, z]));
            }
            // a first row that is text is no row of numbers
            Err(error) if rows.is_empty() && matches!(error.rule, Rule::Number | Rule::Comma) => {
                return Err(error);
            }
            Err(error) => skipped.push(error),
        }
    }
    let most = (reading.most_skipped.unwrap_or(MOST_SKIPPED) * (rows.len() + skipped.len()) as f64).floor();
    if skipped.len() as f64 > most {
        return Err(skipped.swap_remove(0));
    }
    let header = &table.header;
    let time = header.time.map_or(0, |place| place);
    let columns = [time, rates[0], rates[1], rates[2]];
    let is_read = |place: usize| {
        columns[1..].contains(&place)
            || [header.time, header.nanoseconds].contains(&Some(place))
            || inputs.reads(place, &header.names[place].letters)
    };
    let others = header.names.iter().enumerate().filter(|(place, _)| !is_read(*place));
    let called = |(place, text): (usize, &str)| {
        if text.is_empty() { format!("column {}", place + 1) } else { text.into() }
    };
    let unused = others.map(|(place, name)| called((place, name.text.as_str()))).collect();
    let names = columns.map(|column| header.names[column].text.clone());
    let lines: Vec<usize> = rows.iter().map(|(line, _)| *line).collect();
    let rows =
        RawRows { rows, names, columns: columns.map(|column| column + 1), rate_unit: named[0], unused };
    let refused = |error: RecordError| match error {
        RecordError::Empty { .. } => TableError::of(table.name(), Rule::Rows),
        other => TableError::of(table.name(), Rule::Other(other.to_string())),
    };
    let record = Record::cleaned(table.name(), rows).map_err(refused)?;
    let record = inputs.complete(record, &lines).map_err(refused)?;
    Ok(FoundRecord { record, skipped, remarks, are_increments: table.are_increments })
}

/// The body of the row before, where rows have names.
#[derive(Default)]
struct Owner {
    name: String,
    /// The first name that shared its time with another.
    partner: Option<String>,
}

impl Owner {
    /// Refuses rows of several bodies; a counter, which may go on within one tick of a clock, shows no name again.
    fn check(&mut self, table: &Table, at_the_same_time: bool) -> Result<(), TableError> {
        let Some(id) = table.header.id else { return Ok(()) };
        let name = table.cell(id);
        if at_the_same_time && name != self.name {
            if self.partner.as_deref() == Some(name) {
                let before = visible(&self.name);
                let rule = format!("of another body than the row before, '{before}', at the same time");
                return Err(table.refused_cell(id, Rule::Other(rule)).with_remedy("name a file of one body"));
            }
            self.partner.get_or_insert_with(|| name.into());
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
                format!("{} bodies, and a record is of one", bodies.len()),
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

impl Inputs {
    fn of(table: &Table, wheel: Option<Vector3<f64>>, remarks: &mut Vec<String>) -> Result<Self, TableError> {
        let momenta = triple(table, 'h', "N m s", |unit| MomentumUnit::named(unit?).map(|_| ()))?;
        let torques = triple(table, 't', "N m", |unit| {
            unit.is_none_or(|unit| TorqueUnit::named(unit).is_some()).then_some(())
        })?;
        let column = speed_column(table);
        let speed = match (wheel, column) {
            (None, Some(place)) => {
                let unused = Rule::Other("the column is not used".into());
                let remedy = "--wheel nx,ny,nz,I says which momentum the speed stands for";
                remarks.push(table.refused_column(place, unused).with_remedy(remedy).to_string());
                None
            }
            (Some(wheel), Some(place)) => {
                let unit = table.header.names[place].unit_behind("wheel", crate::table::RATE_ENDINGS);
                let Some(known) = unit.as_deref().and_then(RateUnit::named) else {
                    let rule = match unit {
                        None => Rule::Unit("rad/s, deg/s or rpm"),
                        Some(_) => Rule::KnownUnit("rad/s, deg/s, rpm"),
                    };
                    return Err(table.refused_column(place, rule).value(unit.as_deref().unwrap_or_default()));
                };
                Some((place, wheel * known.radians_per_second(1.0)))
            }
            (Some(_), None) => {
                let names = table.header.names.iter().map(|name| name.text.clone()).collect();
                let error =
                    TableError::of(table.name(), Rule::Column("the speed of the wheel".into(), names));
                return Err(error.with_remedy("name the column wheel, with its unit"));
            }
            (None, None) => None,
        };
        if let (Some(_), Some([x, ..])) = (speed, momenta) {
            let rule = Rule::Other("the momentum of the wheels is given twice".into());
            return Err(table.refused_column(x, rule).with_remedy("leave out --wheel, or these columns"));
        }
        Ok(Self { momenta, torques, speed, rows: Vec::new() })
    }

    /// Reads those of the present row.
    fn push(&mut self, table: &Table) -> Result<(), TableError> {
        if self.momenta.is_none() && self.torques.is_none() && self.speed.is_none() {
            return Ok(());
        }
        let vector = |places: Option<[usize; 3]>| match places {
            Some(places) => table.numbers::<3>(&places).map(Vector3::from),
            None => Ok(Vector3::zeros()),
        };
        let momentum = match self.speed {
            Some((place, per_speed)) => per_speed * table.number(place)?,
            None => vector(self.momenta)?,
        };
        self.rows.push([momentum, vector(self.torques)?]);
        Ok(())
    }

    /// Whether a column is one of these; a wheel whose speed is not used is told by a remark.
    fn reads(&self, place: usize, letters: &str) -> bool {
        [self.momenta, self.torques].iter().flatten().any(|places| places.contains(&place))
            || letters.starts_with("wheel")
    }

    /// The record with them; `lines` are those of the rows.
    fn complete(&self, mut record: Record, lines: &[usize]) -> Result<Record, RecordError> {
        for segment in &mut record.segments {
            let own = |which: usize| -> Vec<Vector3<f64>> {
                let rows = segment.lines().iter().filter_map(|line| lines.binary_search(line).ok());
                rows.map(|row| self.rows[row][which]).collect()
            };
            let mut complete = segment.clone();
            if self.momenta.is_some() || self.speed.is_some() {
                complete = complete.with_wheel(own(0))?;
            }
            if self.torques.is_some() {
                complete = complete.with_torque(own(1))?;
            }
            *segment = complete;
        }
        Ok(record)
    }
}

/// The column of the speed of a wheel.
fn speed_column(table: &Table) -> Option<usize> {
    table.header.names.iter().position(|name| name.is("wheel", crate::table::RATE_ENDINGS))
}

/// The columns of a vector, `letter` and an axis, or none; two of them are a mistake, and so is a unit that is not `known`.
fn triple(
    table: &Table,
    letter: char,
    unit: &'static str,
    known: impl Fn(Option<&str>) -> Option<()>,
) -> Result<Option<[usize; 3]>, TableError> {
    let names = &table.header.names;
    let place = |axis: char| names.iter().position(|name| name.letters == format!("{letter}{axis}"));
    let all = ['x', 'y', 'z'].map(place);
    let [Some(x), Some(y), Some(z)] = all else {
        return all.iter().flatten().next().map_or(Ok(None), |&one| {
            let rule = Rule::Other("it needs two columns more, one for each axis".into());
            Err(table.refused_column(one, rule).with_remedy("add them, or rename this one"))
        });
    };
    for place in [x, y, z] {
        let named = names[place].unit.as_deref();
        if known(named).is_none() {
            let rule = if named.is_some() { Rule::KnownUnit(unit) } else { Rule::Unit(unit) };
            return Err(table.refused_column(place, rule).value(named.unwrap_or_default()));
        }
    }
    Ok(Some([x, y, z]))
}
