//! One segment of a record on its way to attitudes.

use std::vec::IntoIter;

use nalgebra::UnitQuaternion;
use polhode::record::{Record, Segment};
use polhode::strapdown::{Budgeted, Estimate, Findings, Kind, Rule, Sensor, Strapdown, StrapdownError};
use polhode_files::error::{Error, tell, warn};
use polhode_files::text::rounded;

use super::readings::Readings;
use super::rule;
use super::sensor::NoiseBy;

/// A later part of a record with so many times the noise of the first is told.
const NOISIER: f64 = 3.0;

/// How readings become attitudes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) rule: Rule,
    pub(super) sensor: Sensor,
    pub(super) noise_by: NoiseBy,
}

impl Course {
    /// That the noise of a later part of the record is not that which was found in the first, in words; `None` where it is.
    pub(super) fn noisier(&self, record: &Record) -> Option<String> {
        let first = self.sensor.noise;
        let (noise, is_enough) = Findings::noise(record);
        let start = record.segments.first()?.times().first()?;
        (self.noise_by == NoiseBy::Record && is_enough && noise > NOISIER * first).then(|| {
            format!(
                "from t = {} s on the readings are noisier ({noise:.1e}) than those before, whose noise attitude_sigma has ({first:.1e}); \
                 give --noise",
                rounded(*start)
            )
        })
    }
}

/// An attitude by the readings alone, and that of a known body, where there is one.
pub(super) struct Found {
    pub(super) integrated: Estimate,
    pub(super) smoothed: Option<Estimate>,
}

/// The attitudes of one segment, with what others would have said of it.
pub(super) struct Integration {
    course: Course,
    budgeted: Budgeted,
    smoothed: IntoIter<Estimate>,
    /// By the trapezoid with coning, where that is not the rule.
    trapezoid: Option<Strapdown<f64>>,
    /// With readings that are averages, where they are only taken for rates.
    averages: Option<Strapdown<f64>>,
    last: Option<Estimate>,
    samples: usize,
}

impl Integration {
    /// From the attitude `start` at the first sample; `smoothed` are the attitudes of a known body.
    pub(super) fn new(
        readings: &Readings,
        course: Course,
        start: UnitQuaternion<f64>,
        smoothed: Vec<Estimate>,
    ) -> Result<Self, StrapdownError> {
        let Course { rule, sensor, .. } = course;
        let kind = readings.kind;
        let other = |kind: Kind, rule: Rule, wanted: bool| {
            wanted.then(|| Strapdown::new(kind, rule, start.into()).ok()).flatten()
        };
        Ok(Integration {
            course,
            budgeted: Budgeted::new(kind, rule, start, sensor)?,
            smoothed: smoothed.into_iter(),
            trapezoid: other(kind, Rule::Trapezoid, rule != Rule::Trapezoid),
            averages: other(Kind::Average, rule, readings.is_assumed),
            last: None,
            samples: 0,
        })
    }

    /// Adds the samples of a segment, and to `found` the attitudes that they make known.
    pub(super) fn push(
        &mut self,
        readings: &Readings,
        segment: &Segment,
        found: &mut Vec<Found>,
    ) -> Result<(), Error> {
        for (k, (t, reading)) in segment.times().iter().zip(segment.rates()).enumerate() {
            let ready = self.budgeted.push(*t, *reading);
            for integrated in ready.map_err(|error| readings.refused(segment, k, &error))? {
                found.push(Found { integrated: *integrated, smoothed: self.smoothed.next() });
            }
            for other in [&mut self.trapezoid, &mut self.averages] {
                if other.as_mut().is_some_and(|other| other.push(*t, (*reading).into()).is_err()) {
                    *other = None;
                }
            }
        }
        self.samples += segment.times().len();
        self.last = found.last().map(|found| found.integrated).or(self.last);
        Ok(())
    }

    /// Adds the last attitudes, and says what was done and what it is worth.
    pub(super) fn finish(mut self, found: &mut Vec<Found>) {
        for integrated in self.budgeted.finish() {
            found.push(Found { integrated: *integrated, smoothed: self.smoothed.next() });
        }
        let Some(last) = found.last().map(|found| found.integrated).or(self.last) else { return };
        let budget = &last.budget;
        let mut parts = vec![format!("truncation {:.1e} rad", budget.truncation)];
        let by_record = self.course.noise_by == NoiseBy::Record;
        let source = if by_record { " (noise found in the record)" } else { "" };
        parts.push(format!("random walk {:.1e} rad{source}", budget.random_walk));
        let others = [("bias", budget.bias), ("scale", budget.scale), ("stamps", budget.stamps)];
        parts.extend(others.iter().filter(|(_, x)| *x > 0.0).map(|(name, x)| format!("{name} {x:.1e} rad")));
        let apart = |other: Option<Strapdown<f64>>| {
            let mut other = other?;
            other.finish();
            Some(last.error(other.attitude().into()).norm())
        };
        let line = apart(self.trapezoid).map_or(String::new(), |angle| {
            format!("; the trapezoid with coning would differ by {angle:.1e} rad")
        });
        let (rule, time) = (rule::words(self.course.rule), rounded(last.time));
        tell("note", &format!("{rule}; at t = {time} s: {}{line}", parts.join(", ")));
        if let Some(warning) = Findings::without_truncation(self.course.rule, self.samples) {
            warn(&warning);
        }
        if let Some(angle) = apart(self.averages) {
            let message = format!(
                "the readings are taken as rates at the times of their rows; if they are averages since the row before, the \
                 attitude at the end differs by {angle:.1e} rad; state which by --kind"
            );
            if angle > 2.0 * budget.sigma() { warn(&message) } else { tell("note", &message) }
        }
    }
}
