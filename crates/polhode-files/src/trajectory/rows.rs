//! Rows of a file, gathered body by body.

use std::collections::HashMap;

use polhode::audit::{Attitudes, Digits, Trajectory};

use super::layout::{AttitudeKind, BodyColumns, Layout};
use super::lines::{Lines, digits};
use crate::error::Error;
use crate::text::{short, visible};

/// The rows of one body so far.
struct Gathered {
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
}

/// All rows of a file.
pub(super) struct Rows {
    bodies: Vec<Gathered>,
    /// Where the bodies of an id begin.
    ids: HashMap<String, usize>,
    layout: Layout,
    names: Vec<String>,
    unit: f64,
}

impl Rows {
    pub(super) fn new(layout: Layout, names: Vec<String>, unit: f64) -> Self {
        Self { bodies: Vec::new(), ids: HashMap::new(), layout, names, unit }
    }

    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Adds the present line; `time` is that of its block, where lines have none.
    pub(super) fn push(&mut self, lines: &Lines, time: Option<f64>) -> Result<(), Error> {
        let time = match (self.layout.time, time) {
            (_, Some(time)) => time,
            (Some(place), None) => lines.number_at(place, &self.names)? * self.unit,
            (None, None) => {
                return Err(lines.refused("", "without a time", "name its column by --columns t=NAME"));
            }
        };
        let first = match self.layout.id {
            None => self.of_id("", None),
            Some(place) => {
                let id = lines.cell(place);
                match self.ids.get(id) {
                    Some(first) => *first,
                    None => self.of_id(id, Some(visible(id).into_owned())),
                }
            }
        };
        for (k, columns) in self.layout.bodies.iter().enumerate() {
            let body = &mut self.bodies[first + k];
            if let Some(&before) = body.times.last()
                && before >= time
            {
                let rule = format!("does not come after the time before it, {} s", short(before));
                let place = self.layout.time.map_or_else(
                    || lines.place(),
                    |place| {
                        let name = self.names.get(place).map_or("", |name| name.as_str());
                        format!("{}, column {} ({})", lines.place(), place + 1, visible(name))
                    },
                );
                let remedy = if self.layout.id.is_some() {
                    "sort the rows of each body by time"
                } else {
                    "sort the rows by time; rows of several bodies need a column id"
                };
                return Err(Error::input(&place, &short(time), &rule, remedy));
            }
            body.times.push(time);
            if let Some((_, places)) = &columns.attitude {
                let written = &mut body.written[0];
                match &mut body.attitude {
                    Some(Attitudes::Quaternions(rows)) => {
                        rows.push(take(lines, places, &self.names, written)?)
                    }
                    Some(Attitudes::Matrices(rows)) => rows.push(take(lines, places, &self.names, written)?),
                    Some(Attitudes::Angles(rows) | Attitudes::Rodrigues(rows)) => {
                        rows.push(take(lines, places, &self.names, written)?);
                    }
                    _ => {}
                }
                let zeros = match &body.attitude {
                    Some(Attitudes::Quaternions(rows)) => rows.last() == Some(&[0.0; 4]),
                    Some(Attitudes::Matrices(rows)) => rows.last() == Some(&[0.0; 9]),
                    _ => false,
                };
                if zeros {
                    let rule = "every component of the attitude is zero, which is no rotation";
                    let place = format!("{}, column {}", lines.place(), places[0] + 1);
                    return Err(Error::input(&place, "", rule, "leave the row out"));
                }
            }
            if let (Some(places), Some(rows)) = (&columns.rates, &mut body.rates) {
                rows.push(take(lines, places, &self.names, &mut body.written[1])?);
            }
            if let (Some(places), Some(rows)) = (&columns.momentum, &mut body.momentum) {
                rows.push(take(lines, places, &self.names, &mut body.written[2])?);
            }
        }
        Ok(())
    }

    /// The place of the first body of an id, which is made if there is none.
    fn of_id(&mut self, id: &str, name: Option<String>) -> usize {
        if let Some(first) = self.ids.get(id) {
            return *first;
        }
        let first = self.bodies.len();
        self.ids.insert(id.to_string(), first);
        for columns in &self.layout.bodies {
            let name = match (&name, &columns.label) {
                (Some(id), Some(label)) => Some(format!("{id}, {label}")),
                (id, label) => id.clone().or_else(|| label.clone()),
            };
            self.bodies.push(Gathered::new(name, columns));
        }
        first
    }

    /// What was gathered, body by body, with what they are called.
    pub(super) fn finish(self) -> (Vec<(Option<String>, Trajectory)>, Layout) {
        let several = self.bodies.len() > 1;
        let bodies = self.bodies.into_iter().map(|body| {
            let name = body.name.clone().filter(|_| several);
            (name, body.trajectory())
        });
        (bodies.collect(), self.layout)
    }
}

impl Gathered {
    fn new(name: Option<String>, columns: &BodyColumns) -> Self {
        let attitude = columns.attitude.as_ref().map(|(kind, _)| match kind {
            AttitudeKind::Named | AttitudeKind::Numbered => Attitudes::Quaternions(Vec::new()),
            AttitudeKind::Matrix => Attitudes::Matrices(Vec::new()),
            AttitudeKind::Angles => Attitudes::Angles(Vec::new()),
            AttitudeKind::Rodrigues => Attitudes::Rodrigues(Vec::new()),
        });
        let rows = |places: &Option<Vec<usize>>| places.as_ref().map(|_| Vec::new());
        Self {
            name,
            times: Vec::new(),
            attitude,
            rates: rows(&columns.rates),
            momentum: rows(&columns.momentum),
            written: Default::default(),
        }
    }

    fn trajectory(self) -> Trajectory {
        let mut trajectory = Trajectory::new(self.times);
        trajectory.attitude = self.attitude;
        trajectory.rates = self.rates;
        trajectory.momentum = self.momentum;
        let [attitude, rates, momentum] = self.written.map(|written| (written.digits > 0).then_some(written.digits));
        trajectory.digits = Digits { attitude, rates, momentum };
        trajectory
    }
}

fn take<const N: usize>(
    lines: &Lines,
    places: &[usize],
    names: &[String],
    written: &mut Written,
) -> Result<[f64; N], Error> {
    let mut values = [0.0; N];
    for (value, place) in values.iter_mut().zip(places) {
        *value = lines.number_at(*place, names)?;
        written.note(lines.cell(*place));
    }
    Ok(values)
}
