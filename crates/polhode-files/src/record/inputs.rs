//! Columns beside the rates: momenta of wheels and torques.

use nalgebra::Vector3;
use polhode::record::{Record, RecordError};
use polhode::units::{MomentumUnit, RateUnit, TorqueUnit};

use crate::error::{Rule, TableError};
use crate::table::{RATE_ENDINGS, Table};

/// Columns beside the rates, and their values at the rows.
#[derive(Default)]
pub(super) struct Inputs {
    momenta: Option<[usize; 3]>,
    torques: Option<[usize; 3]>,
    /// Column of the speed of a wheel, and its momentum per unit of it.
    speed: Option<(usize, Vector3<f64>)>,
    /// Momentum of wheels and torque.
    rows: Vec<[Vector3<f64>; 2]>,
}

impl Inputs {
    pub(super) fn of(
        table: &Table,
        wheel: Option<Vector3<f64>>,
        remarks: &mut Vec<String>,
    ) -> Result<Self, TableError> {
        let momenta = triple(table, 'h', "N m s", |unit| MomentumUnit::named(unit?).map(|_| ()))?;
        // without a unit they may as well be a translation
        let torques = triple(table, 't', "N m", |unit| TorqueUnit::named(unit?).map(|_| ()))?;
        let column = table.header.names.iter().position(|name| name.is("wheel", RATE_ENDINGS));
        let speed = match (wheel, column) {
            (None, Some(place)) => {
                let unused = Rule::Other("the column is not used".into());
                let remedy = "give --wheel nx,ny,nz,I to turn the speed into a momentum";
                remarks.push(table.refused_column(place, unused).with_remedy(remedy).to_string());
                None
            }
            (Some(wheel), Some(place)) => {
                let unit = table.header.names[place].unit_behind("wheel", RATE_ENDINGS);
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
    pub(super) fn push(&mut self, table: &Table) -> Result<(), TableError> {
        if !self.are_given() {
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
    pub(super) fn reads(&self, place: usize, letters: &str) -> bool {
        [self.momenta, self.torques].iter().flatten().any(|places| places.contains(&place))
            || letters.starts_with("wheel")
    }

    /// Whether there are such columns.
    pub(super) fn are_given(&self) -> bool {
        self.momenta.is_some() || self.torques.is_some() || self.speed.is_some()
    }

    /// The record with them; `lines` are those of the rows.
    pub(super) fn complete(&self, mut record: Record, lines: &[usize]) -> Result<Record, RecordError> {
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
