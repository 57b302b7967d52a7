//! The attitudes of a reference.

use std::collections::VecDeque;
use std::path::Path;

use nalgebra::UnitQuaternion;
use polhode::audit::{Attitudes, Reading, Trajectory};
use polhode::strapdown::Estimate;
use polhode_files::error::{Error, tell, warn};
use polhode_files::text::{rounded, visible};
use polhode_files::trajectory::read;
use polhode_files::{ReadAs, ReadOptions};

use crate::reference::{attitudes, beside_attitudes, shift};

/// Times agree within this share of the mean interval of the reference.
const SAME_TIME: f64 = 1e-6;

/// Of so many standard deviations of a component is the ball that holds 95 % of errors without a direction, χ² of three degrees of
/// freedom.
const RADIUS: f64 = 2.795;

/// An error of so many times the 95 % of its budget is none of it, and of so many times the median error no noise of the reference.
const FAR: f64 = 10.0;

/// An attitude of the reference is off by so many of what its digits leave: of quaternions what they are off the norm 1.
const DIGITS: f64 = 10.0;

/// A trajectory to compare with, and what was found.
pub(super) struct Reference {
    pub(super) name: String,
    rows: Trajectory,
    reading: Reading,
    read_as: ReadAs,
    /// Whether a time of the record is one of its own.
    has_met: bool,
    /// What its digits leave open, rad.
    resolution: f64,
    /// Attitudes that were to be compared, those of them at a time of the reference, and of these the ones whose error is inside the 95 %
    /// of its budget, in its direction or by its size.
    asked: usize,
    compared: usize,
    inside: usize,
    /// Times of starts that were taken from it, which then have no error, until they are compared.
    pub(super) starts: VecDeque<f64>,
    /// The errors of the others, rad: how many are outside of their 95 % and beyond twice of it, and times and sizes of those far beyond.
    errors: Vec<f64>,
    outside: usize,
    beyond: usize,
    far: Vec<(f64, f64)>,
    largest: f64,
    at: f64,
}

impl Reference {
    pub(super) fn read(path: &Path) -> Result<Self, Error> {
        let found = read(path, &ReadOptions::default())?;
        let name = visible(&path.display().to_string()).into_owned();
        let refused = |rule: &str, remedy: &str| Error::input("--against", &name, rule, remedy);
        let (read_as, beside) = (found.read_as.clone(), beside_attitudes(&found));
        let (rows, reading) = attitudes(found, &name, refused)?;
        let off = |q: &[f64; 4]| (q.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs();
        let resolution = match &rows.attitude {
            Some(Attitudes::Quaternions(all)) => all.iter().map(off).fold(0.0, f64::max),
            _ => rows.rounding(&reading),
        };
        if let Some(beside) = beside {
            warn(&format!("{name}: {beside}"));
        }
        Ok(Self {
            name,
            rows,
            reading,
            read_as,
            has_met: false,
            resolution: DIGITS * resolution,
            asked: 0,
            compared: 0,
            inside: 0,
            starts: VecDeque::new(),
            errors: Vec::new(),
            outside: 0,
            beyond: 0,
            far: Vec::new(),
            largest: 0.0,
            at: 0.0,
        })
    }

    /// Brings its times to the clock of the `record`, where they count from a moment of their own.
    pub(super) fn align(&mut self, record: &ReadAs) -> Result<(), Error> {
        let refused = |rule: &str, remedy: &str| Error::input("--against", &self.name, rule, remedy);
        let shift = shift(&self.read_as, record, refused)?;
        // once: all parts of a record have one clock
        self.read_as.begins = None;
        self.rows.times.iter_mut().for_each(|t| *t += shift);
        Ok(())
    }

    /// Its attitude at the time `t`, s.
    pub(super) fn at(&self, t: f64) -> Option<UnitQuaternion<f64>> {
        let times = &self.rows.times;
        let (first, last) = (times.first()?, times.last()?);
        let near = SAME_TIME * (last - first) / (times.len() - 1).max(1) as f64;
        let row = times.partition_point(|known| *known < t - near);
        times.get(row).filter(|known| (**known - t).abs() <= near)?;
        self.reading.attitude(&self.rows, row).map(UnitQuaternion::from)
    }

    /// The angle between an estimate and its attitude at the same time, rad; `None` where it has none.
    pub(super) fn error(&mut self, estimate: &Estimate) -> Option<f64> {
        self.asked += 1;
        let truth = self.at(estimate.time)?;
        let angle = estimate.error(truth).norm();
        self.compared += 1;
        // of a budget that is little but truncation the ellipsoid is flat
        let within = RADIUS * estimate.budget.sigma();
        let is_inside = angle <= within || estimate.holds(truth);
        self.inside += usize::from(is_inside);
        if let Some(k) = self.starts.iter().position(|start| *start == estimate.time) {
            self.starts.drain(..=k);
        } else {
            let rounding = self.resolution + 8.0 * f64::EPSILON * self.asked as f64;
            self.errors.push(angle);
            self.outside += usize::from(!is_inside);
            self.beyond += usize::from(angle > 2.0 * within + rounding);
            if angle > FAR * within + rounding {
                self.far.push((estimate.time, angle));
            }
        }
        if angle > self.largest {
            (self.largest, self.at) = (angle, estimate.time);
        }
        Some(angle)
    }

    /// Refuses a reference that had no row at the times so far, `times` the last of them, where there are no more.
    pub(super) fn check<'a>(
        &mut self,
        mut times: impl Iterator<Item = &'a f64>,
        has_more: bool,
    ) -> Result<(), Error> {
        self.has_met |= times.any(|t| self.at(*t).is_some());
        if self.has_met || has_more {
            return Ok(());
        }
        let (rule, remedy) = ("no row at a time of the record", "name attitudes at the times of the record");
        Err(Error::input("--against", &self.name, rule, remedy))
    }

    /// Refuses attitudes of the record `name` most of which are beyond twice the 95 % of their budget, or any of which is [far](Self::far)
    /// beyond: it is not their error. Starts that were taken from the reference say nothing of the others.
    pub(super) fn judge(&self, name: &str) -> Result<(), Error> {
        let (reference, errors) = (&self.name, self.errors.len());
        let failure = if errors == 0 {
            format!("{name}: nothing is compared, as no attitude after the start is at a time of {reference}")
        } else if 2 * self.beyond > errors {
            let beyond = self.beyond;
            format!(
                "{name}: {reference} contradicts the attitudes: {beyond} of {errors} errors exceed twice their 95 % bound"
            )
        } else if let Some((far, at)) = self.far() {
            let at = rounded(at);
            format!(
                "{name}: {reference} contradicts the attitudes: {far} of {errors} errors exceed ten times their 95 % bound and ten times \
                 the median error, the first at t = {at} s"
            )
        } else {
            return Ok(());
        };
        Err(Error::Failed(failure))
    }

    /// How many errors are far beyond, and when the first is.
    fn far(&self) -> Option<(usize, f64)> {
        let mut errors = self.errors.clone();
        let middle = errors.len().checked_sub(1)? / 2;
        let (_, median, _) = errors.select_nth_unstable_by(middle, f64::total_cmp);
        let mut far = self.far.iter().filter(|(_, angle)| *angle > FAR * *median);
        let (first, _) = far.next()?;
        Some((1 + far.count(), *first))
    }

    /// What the comparison found.
    pub(super) fn tell(&self) {
        let errors = self.errors.len();
        let verdict = if errors == 0 {
            "none is after a start"
        } else if 2 * self.beyond > errors {
            "the 95 % bounds are contradicted"
        } else if self.far().is_some() {
            "the 95 % bounds do not hold everywhere"
        } else if 2 * self.outside > errors {
            "the 95 % bounds are too small"
        } else {
            "the 95 % bounds hold"
        };
        tell(
            "note",
            &format!(
                "{}: {} {} compared, read as {}; largest error {:.1e} rad at t = {} s, {} within their 95 % bound: {verdict}",
                self.name,
                self.compared,
                if self.compared == 1 { "row" } else { "rows" },
                self.reading
                    .attitude
                    .map_or(String::new(), |direction| direction.to_string().replace('-', " ")),
                self.largest,
                rounded(self.at),
                self.inside
            ),
        );
        let rows = self.asked.min(self.rows.times.len());
        if 2 * self.compared < rows {
            warn(&format!(
                "{}: only {} of {rows} rows are at a time of both; check the unit of its times",
                self.name, self.compared
            ));
        }
        if 2 * self.outside > errors {
            warn(&format!(
                "{}: most errors exceed their 95 % bound; check the units of the readings, the convention of the reference and the given standard deviations",
                self.name
            ));
        }
    }
}
