//! Trajectories from files of other programs: tables of rows, and dumps of LAMMPS.

use std::collections::HashMap;
use std::path::Path;

use polhode::audit::{Attitudes, Convention, Digits, Direction, Frame, QuaternionOrder, Trajectory};
use polhode::units::{AngleUnit, MomentumUnit, RateUnit, TimeUnit};

use crate::error::{Error, Rule, TableError};
use crate::read_as::ReadAs;
use crate::table::{Columns, Group, Quantity, ReadOptions, Table, digits};
use crate::text::visible;

/// What a file holds.
#[derive(Debug)]
#[non_exhaustive]
pub struct FoundTrajectory {
    /// Trajectories with the name of their body, where a column or the names of columns tell it.
    pub bodies: Vec<(Option<String>, Trajectory)>,
    /// What names and layout claim of the convention.
    pub claims: Convention,
    /// Whether the times are counts of steps, of a length that the file does not tell.
    pub counts_steps: bool,
    /// Lines before the header that begin with #, without that.
    pub comments: Vec<String>,
    /// Names of the columns that are not read.
    pub unread: Vec<String>,
    /// Those of them that hold the attitude of a body with a name of its own, as `box2_qw`.
    pub second_attitude: Vec<String>,
    /// What is to be known of a second column of times that contradicts the first.
    pub contradicted_time: Option<String>,
    /// In which units times and angular velocities are: the former were brought to s, the latter are as they stand.
    pub read_as: ReadAs,
}

/// Columns that are not read of which the names are told.
const NAMED: usize = 12;

impl FoundTrajectory {
    /// Which columns are not read, in words, and whether one of them is a time that contradicts the one that is; `None` where all are read.
    #[must_use]
    pub fn remark(&self) -> Option<String> {
        let shown = self.unread[..self.unread.len().min(NAMED)].join(", ");
        let unread = match self.unread.len() {
            0 => return None,
            count if count > NAMED => format!("not read: {shown} and {} more", count - NAMED),
            _ => format!("not read: {shown}"),
        };
        Some(match &self.contradicted_time {
            Some(contradiction) => format!("{unread}; {contradiction}"),
            None => unread,
        })
    }
}

/// Reads the trajectories at `path`, or of standard input where that is `-`.
///
/// Rows hold a time and an attitude (quaternion, matrix, Euler angles, modified Rodrigues parameters), an angular velocity or
/// an angular momentum, in columns of any common names; several bodies by a column `id`, by the `qpos` and `qvel` of MuJoCo, or
/// in a dump of LAMMPS. Times are in s; other numbers are as they stand, with what their names [claim](FoundTrajectory::claims),
/// and in a dump that names its units brought to s as its times are.
///
/// ```
/// use polhode::audit::QuaternionOrder;
/// use polhode_files::{ReadOptions, trajectory};
/// let file = std::env::temp_dir().join(format!("polhode-run-{}.csv", std::process::id()));
/// std::fs::write(&file, "time (ms),qw,qx,qy,qz\n0,1,0,0,0\n10,0.8,0,0,0.6\n")?;
/// let found = trajectory::read(&file, &ReadOptions::default())?;
/// assert_eq!(found.bodies[0].1.times, [0.0, 0.01]);
/// assert_eq!(found.claims.quaternion, Some(QuaternionOrder::ScalarFirst));
/// # std::fs::remove_file(file)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A file without the columns of a trajectory, and rows that cannot be read, by line and column.
pub fn read(path: &Path, reading: &ReadOptions) -> Result<FoundTrajectory, Error> {
    Ok(found(Table::open(path, reading)?)?)
}

/// Whether the file at `path` has columns of attitudes and of angular velocities, by its header alone.
///
/// # Errors
/// A file that cannot be read, or without a header.
pub fn columns(path: &Path, reading: &ReadOptions) -> Result<FoundColumns, Error> {
    let table = Table::open(path, reading)?;
    let has = |of: fn(&Columns) -> bool| table.header.bodies.iter().any(of);
    Ok(FoundColumns {
        attitudes: has(|body| body.attitude.is_some()),
        rates: has(|body| body.rates.is_some()),
    })
}

/// Which columns a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FoundColumns {
    /// Of attitudes.
    pub attitudes: bool,
    /// Of angular velocities.
    pub rates: bool,
}

/// The same of a text of rows, which messages call `file`.
///
/// # Errors
/// As [`read`].
pub fn of_text(text: &str, file: &str, reading: &ReadOptions) -> Result<FoundTrajectory, Error> {
    Ok(found(Table::of_text(text, file, reading)?)?)
}

fn found(mut table: Table) -> Result<FoundTrajectory, TableError> {
    let mut claims = claims(&table)?;
    let mut rows = Bodies::default();
    let mut second = table.header.second_time().map(SecondTime::new);
    while table.next()? {
        rows.push(&mut table)?;
        second = match second {
            Some(second) => second.with_row(&mut table)?,
            None => None,
        };
    }
    let contradicted_time = second.and_then(|second| second.contradiction(&table));
    if rows.bodies.is_empty() {
        return Err(TableError::of(table.name(), Rule::Rows));
    }
    let first = table.header.bodies.first().and_then(|columns| columns.attitude.as_ref());
    let lacks = |body: &Body| body.attitude.is_none();
    let lacking = first.filter(|_| rows.bodies.iter().all(lacks)).map_or(&[][..], |group| &group.places);
    if !lacking.is_empty() {
        (claims.quaternion, claims.attitude) = (None, None);
    }
    let times = rows.bodies.first().map_or(&[][..], |body| &body.times);
    let read_as = table.read_as(times.windows(2).map(|pair| pair[1] - pair[0]).collect());
    let bodies = rows.bodies.into_iter().map(|body| (body.name.clone(), body.trajectory()));
    let shown = |name: &str| visible(name).into_owned();
    let lacking = lacking.iter().map(|place| table.header.names[*place].text.trim());
    Ok(FoundTrajectory {
        bodies: bodies.collect(),
        claims,
        counts_steps: table.counts_steps(),
        unread: lacking.chain(table.header.unread()).map(shown).collect(),
        second_attitude: table.header.second_attitude().into_iter().map(shown).collect(),
        contradicted_time,
        comments: table.comments,
        read_as,
    })
}

/// A column that is a time by its name too, beside the times that are read.
struct SecondTime {
    place: usize,
    /// Line, time that is read, s, and number in this column.
    rows: Vec<(u64, f64, f64)>,
    /// Half of the last digit of both, as fine as any row has it: some programs leave out zeros at the end.
    fine: [f64; 2],
}

/// A second time may be off by this share of the time between two rows.
const SAME_TIME: f64 = 1e-3;

impl SecondTime {
    fn new(place: usize) -> Self {
        SecondTime { place, rows: Vec::new(), fine: [f64::INFINITY; 2] }
    }

    /// With the present row; `None` where the column has no number.
    fn with_row(mut self, table: &mut Table) -> Result<Option<Self>, TableError> {
        let time = table.time()?;
        let Ok(second) = table.number(self.place) else { return Ok(None) };
        let first = table.header.time.map_or(0.0, |place| half_digit(table.cell(place)));
        let first = table.time_unit.unwrap_or(TimeUnit::Seconds).seconds(first);
        self.fine = [self.fine[0].min(first), self.fine[1].min(half_digit(table.cell(self.place)))];
        self.rows.push((table.line(), time, second));
        Ok(Some(self))
    }

    /// The row in which it is farthest from going with the times that are read, in words, where that is more than digits tell.
    fn contradiction(&self, table: &Table) -> Option<String> {
        let (&(_, from, start), &(_, to, end)) = (self.rows.first()?, self.rows.last()?);
        let rate = (end - start) / (to - from);
        let off = |row: &(u64, f64, f64)| (row.2 - start - rate * (row.1 - from)).abs();
        let farthest = self.rows.iter().max_by(|a, b| off(a).total_cmp(&off(b)))?;
        let step = (end - start).abs() / (self.rows.len() - 1).max(1) as f64;
        let allowed = 2.0 * (rate.abs() * self.fine[0] + self.fine[1]) + SAME_TIME * step;
        let name = visible(table.header.names[self.place].text.trim());
        (off(farthest) > allowed).then(|| {
            format!(
                "column '{name}' is also a time and contradicts the times that are read: at line {} it differs by {:.1e}",
                farthest.0,
                off(farthest)
            )
        })
    }
}

/// Half a unit of the last digit of a number as it is written.
fn half_digit(text: &str) -> f64 {
    let (number, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = number.split_once(['.', ',']).map_or(0, |(_, behind)| behind.len());
    let last = exponent.parse::<i64>().unwrap_or(0) - decimals as i64;
    format!("5e{}", last - 1).parse().unwrap_or(0.0)
}

/// What names and layout claim of the convention.
fn claims(table: &Table) -> Result<Convention, TableError> {
    let mut claims = Convention::default();
    let Some(body) = table.header.bodies.first() else { return Ok(claims) };
    if let Some(attitude) = &body.attitude {
        match attitude.quantity {
            Quantity::Quaternion => claims.quaternion = Some(QuaternionOrder::ScalarFirst),
            Quantity::Rodrigues => claims.attitude = Some(Direction::BodyToSpace),
            Quantity::Angles => {
                claims.angle_axes = attitude.angle_axes;
                let unit = |k: usize| attitude.units[k].as_deref().and_then(AngleUnit::named);
                if let Some(other) = (1..attitude.units.len()).find(|k| unit(*k) != unit(0)) {
                    let rule = Rule::Other("its unit is not that of the first angle".into());
                    let error = table.refused_column(attitude.places[other], rule);
                    return Err(error.with_remedy("write the three in one unit, and name it in each"));
                }
                if let Some(text) = &attitude.units[0] {
                    claims.angle_unit = AngleUnit::named(text);
                    if claims.angle_unit.is_none() {
                        let rule = Rule::KnownUnit("rad, deg");
                        return Err(table.refused_column(attitude.places[0], rule).value(text));
                    }
                }
            }
            _ => {}
        }
        claims.attitude = claims.attitude.or(attitude.direction);
    }
    check_alike(table)?;
    check_units(table)?;
    let bodies = &table.header.bodies;
    if let Some(with_rates) = bodies.iter().position(|body| body.rates.is_some()) {
        claims.omega_frame = bodies[with_rates].rates.as_ref().and_then(|rates| rates.frame);
        claims.rate_unit = table.rate_units(with_rates)[0];
    }
    claims.momentum_frame = bodies.iter().find_map(|body| body.momentum.as_ref()?.frame);
    if table.is_dump() {
        // momenta and rates of atoms are in the axes of space
        (claims.omega_frame, claims.momentum_frame) = (Some(Frame::Space), Some(Frame::Space));
    }
    if table.is_dump() || table.header.is_generalized {
        claims.attitude = Some(Direction::BodyToSpace);
    }
    Ok(claims)
}

/// The names of all bodies claim one convention.
fn check_alike(table: &Table) -> Result<(), TableError> {
    let groups: [fn(&Columns) -> Option<&Group>; 3] =
        [|body| body.attitude.as_ref(), |body| body.rates.as_ref(), |body| body.momentum.as_ref()];
    // those of rates are looked at apart
    let units = |group: &Group| (group.quantity == Quantity::Angles).then(|| group.units.clone());
    let claimed =
        |group: &Group| (group.quantity, group.direction, group.frame, group.angle_axes, units(group));
    for of in groups {
        let mut all = table.header.bodies.iter().filter_map(of);
        let Some(first) = all.next().map(claimed) else { continue };
        if let Some(other) = all.find(|&group| claimed(group) != first) {
            let rule = Rule::Other("its name claims another convention than that of the first body".into());
            let error = table.refused_column(other.places[0], rule);
            return Err(error.with_remedy("write all bodies in one convention, or each in a file of its own"));
        }
    }
    Ok(())
}

/// The angular velocities of all bodies are in one unit, as their numbers are taken as they stand, and momenta in none or in one that is
/// known.
fn check_units(table: &Table) -> Result<(), TableError> {
    let mut first: Option<Option<RateUnit>> = None;
    for (k, body) in table.header.bodies.iter().enumerate() {
        if let Some(rates) = &body.rates {
            let units = table.rate_units(k);
            let first = *first.get_or_insert(units[0]);
            if let Some(other) = (0..3).find(|axis| units[*axis] != first) {
                let rule = Rule::Other("its unit is not that of the first angular velocity".into());
                let error = table.refused_column(rates.places[other], rule);
                return Err(error.with_remedy("write all of them in one unit"));
            }
        }
        let Some(momentum) = &body.momentum else { continue };
        for (place, unit) in momentum.places.iter().zip(&momentum.units) {
            if let Some(unit) = unit.as_deref().filter(|unit| MomentumUnit::named(unit).is_none()) {
                let error = table.refused_column(*place, Rule::KnownUnit("N m s, kg m^2/s")).value(unit);
                let remedy = "convert the column; if its unit is consistent with the moments, leave the unit out of the header";
                return Err(error.with_remedy(remedy));
            }
        }
    }
    Ok(())
}

/// The rows of one body so far.
struct Body {
    name: Option<String>,
    times: Vec<f64>,
    attitude: Option<Attitudes>,
    rates: Option<Vec<[f64; 3]>>,
    momentum: Option<Vec<[f64; 3]>>,
    /// Of attitude, rates and momentum: most significant digits.
    written: [Written; 3],
}

#[derive(Clone, Copy, Default)]
struct Written {
    digits: u32,
}

impl Written {
    fn note(&mut self, text: &str) {
        // more than 17 digits are those of no double
        if self.digits < 17 {
            self.digits = self.digits.max(digits(text)).min(17);
        }
    }

    /// The numbers in some columns of the present row.
    fn take<const N: usize>(&mut self, table: &Table, group: &Group) -> Result<[f64; N], TableError> {
        let values = table.numbers::<N>(&group.places)?;
        for place in &group.places {
            self.note(table.cell(*place));
        }
        Ok(values)
    }
}

/// All rows of a file.
#[derive(Default)]
struct Bodies {
    bodies: Vec<Body>,
    /// Where the bodies of an id begin.
    ids: HashMap<String, usize>,
}

impl Bodies {
    /// Adds the present row.
    fn push(&mut self, table: &mut Table) -> Result<(), TableError> {
        table.check()?;
        let time = table.time()?;
        let id = table.header.id.map_or("", |place| table.cell(place));
        let first = match self.ids.get(id) {
            Some(first) => *first,
            None => self.begin(id, table.header.id.is_some(), &table.header.bodies),
        };
        for (k, columns) in table.header.bodies.iter().enumerate() {
            let body = &mut self.bodies[first + k];
            if let Some(&before) = body.times.last()
                && before >= time
            {
                let error = match table.header.time {
                    Some(place) => table.refused_cell(place, Rule::Order(before, true)),
                    None => table.refused(Rule::Order(before, true)),
                };
                return Err(match (before == time, table.header.id.is_some()) {
                    (true, true) => error.with_remedy("two rows of this body have the same time; leave one out"),
                    (true, false) => error.with_remedy(
                        "two rows have the same time; leave one out, or name the bodies in a column id if there are several",
                    ),
                    (false, true) => error.with_remedy("sort the rows of each body by time"),
                    (false, false) => error,
                });
            }
            body.times.push(time);
            body.push(table, columns)?;
        }
        Ok(())
    }

    /// The place of the first body of a new id.
    fn begin(&mut self, id: &str, is_named: bool, columns: &[Columns]) -> usize {
        let first = self.bodies.len();
        self.ids.insert(id.to_string(), first);
        for columns in columns {
            let name = match (is_named.then(|| visible(id).into_owned()), &columns.label) {
                (Some(id), Some(label)) => Some(format!("{id}, {label}")),
                (id, label) => id.or_else(|| label.clone()),
            };
            self.bodies.push(Body::new(name, columns));
        }
        first
    }
}

impl Body {
    fn new(name: Option<String>, columns: &Columns) -> Self {
        let attitude = columns.attitude.as_ref().map(|group| match group.quantity {
            Quantity::Matrix => Attitudes::Matrices(Vec::new()),
            Quantity::Angles => Attitudes::Angles(Vec::new()),
            Quantity::Rodrigues => Attitudes::Rodrigues(Vec::new()),
            _ => Attitudes::Quaternions(Vec::new()),
        });
        let rows = |group: &Option<Group>| group.as_ref().map(|_| Vec::new());
        let (rates, momentum) = (rows(&columns.rates), rows(&columns.momentum));
        Self { name, times: Vec::new(), attitude, rates, momentum, written: Default::default() }
    }

    /// Adds what the columns of the present row hold.
    fn push(&mut self, table: &Table, columns: &Columns) -> Result<(), TableError> {
        let [attitudes, rates, momenta] = &mut self.written;
        if let (Some(group), Some(attitude)) = (&columns.attitude, &mut self.attitude) {
            let is_zero = match attitude {
                Attitudes::Quaternions(rows) => {
                    rows.push(attitudes.take(table, group)?);
                    rows.last() == Some(&[0.0; 4])
                }
                Attitudes::Matrices(rows) => {
                    rows.push(attitudes.take(table, group)?);
                    rows.last() == Some(&[0.0; 9])
                }
                Attitudes::Angles(rows) | Attitudes::Rodrigues(rows) => {
                    rows.push(attitudes.take(table, group)?);
                    false
                }
                _ => false,
            };
            // a sensor that knows no attitude writes zeros beside its rates (sensor_msgs/Imu of ROS)
            let is_without =
                is_zero && self.times.len() == 1 && columns.rates.is_some() && group.places.len() == 4;
            if is_without {
                self.attitude = None;
            } else if is_zero {
                return Err(table.refused_cell(group.places[0], Rule::Turn));
            }
        } else if let Some(group) = &columns.attitude
            && table.numbers::<4>(&group.places)? != [0.0; 4]
        {
            let rule =
                Rule::Other("an attitude, and the first row has none: all its components are zero".into());
            let error = table.refused_cell(group.places[0], rule);
            return Err(error.with_remedy("leave out the rows without an attitude"));
        }
        if let (Some(group), Some(rows)) = (&columns.rates, &mut self.rates) {
            let scale = table.scale(group.places[0]);
            rows.push(rates.take::<3>(table, group)?.map(|rate| rate * scale));
        }
        if let (Some(group), Some(rows)) = (&columns.momentum, &mut self.momentum) {
            let scale = table.scale(group.places[0]);
            rows.push(momenta.take::<3>(table, group)?.map(|momentum| momentum * scale));
        }
        Ok(())
    }

    fn trajectory(self) -> Trajectory {
        let mut trajectory = Trajectory::new(self.times);
        trajectory.attitude = self.attitude;
        trajectory.rates = self.rates;
        trajectory.momentum = self.momentum;
        let [attitude, rates, momentum] =
            self.written.map(|written| (written.digits > 0).then_some(written.digits));
        trajectory.digits = Digits { attitude, rates, momentum };
        trajectory
    }
}
