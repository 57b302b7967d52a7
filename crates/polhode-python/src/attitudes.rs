//! Attitude from measured angular velocities.

use nalgebra::Vector3;
use polhode::num::Shown;
use polhode::record::{self, Segment};
use polhode::strapdown::{self, Estimate, Findings, Flight, Kind, Rule, Sensor};
use polhode_pages::figure::{Curve, Figure, Scale, sheet};
use polhode_pages::table::{Cell, Column, Table};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Numbers, Order, array, rotation, scipy_rotation};
use crate::calm::aside;
use crate::error::{of, refused, warn};
use crate::scalars::{maybe, number};
use crate::shown;
use crate::tables::Record;
use crate::through::free;

/// Attitudes at the times of a record, each with its error budget.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Attitudes {
    estimates: Vec<Estimate>,
    rule: String,
    noise: f64,
    order: Order,
}

/// Attitudes from the readings of a gyroscope, each with its error budget, as `polhode attitude` prints them.
///
/// - `t`, s, and `rates` (n, 3) in body axes; or a `Record` of `read` in place of both.
/// - `kind`: what a reading is: "rate" (rad/s at its time), "average" (mean rate since the reading before, rad/s) or "increment" (angle since
///   the reading before, rad).
/// - `start`: attitude at the first time, body to space, which counts as exact; by default the identity. `order` is that of quaternions,
///   given and returned.
/// - `rule`: "auto" (chosen from the record and its noise), "magnus:ORDER", "magnus:ORDER,SAMPLES", or a rule of other programs: "hold",
///   "trapezoid", "two-speed", "runge-kutta".
/// - `noise` of a reading (found in the record if it is not given), `bias`, rad/s, `scale_error`, a ratio, and `stamps`, s: standard
///   deviations of the sensor. Noise that is found in the record already contains that of the stamps.
/// - `body`: a free body. The attitudes are then those of its exact motion that fits all rates best, and a warning says where they contradict
///   the readings.
///
/// The result may have fewer times than the record, as some readings are left out: rates that jump off their neighbours, that repeat the
/// reading before, or that are at the end of the sensor's range. Rates of the same time are averaged. Warnings say so. Warnings also say if
/// an increment may be missing, if there are too few samples to estimate noise or truncation, if readings rest on so few values that their
/// step is not known, if rates jump between two rows, and if the attitude is lost. Gaps are refused.
///
/// >>> import numpy, polhode
/// >>> t = numpy.arange(2000) * 0.05
/// >>> exact, rates = polhode.FreeMotion([1, 2, 3], [0.4, 1, -0.3]).at(t)
/// >>> found = polhode.attitude(t, rates, kind="rate", noise=0)
/// >>> found.rule, found.attitude.shape, bool(found.truncation[-1] < 1e-8)
/// ('magnus:6,8', (2000, 4), True)
/// >>> polhode.attitude(t, 100 * rates, kind="rate")
/// Traceback (most recent call last):
///     ...
/// polhode.PolhodeError: rates: sample 1, at 0.05 s: a turn by ... rad since the sample before, more than half a turn (pi)...
#[pyfunction]
#[pyo3(signature = (t, rates = None, *, kind, start = None, rule = "auto", noise = None, bias = 0.0, scale_error = 0.0, stamps = 0.0,
                    body = None, order = "wxyz"))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn attitude(
    t: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
    kind: &str,
    start: Option<&Bound<'_, PyAny>>,
    rule: &str,
    #[pyo3(from_py_with = maybe::noise)] noise: Option<f64>,
    #[pyo3(from_py_with = number::bias)] bias: f64,
    #[pyo3(from_py_with = number::scale_error)] scale_error: f64,
    #[pyo3(from_py_with = number::stamps)] stamps: f64,
    body: Option<&Bound<'_, PyAny>>,
    order: &str,
) -> PyResult<Attitudes> {
    let (record, row) = recorded(t, rates)?;
    let kind: Kind = kind.parse().map_err(of("kind"))?;
    let order = Order::of(order)?;
    let start =
        start.map_or(Ok(nalgebra::UnitQuaternion::identity()), |start| rotation("start", start, order))?;
    let asked = asked(rule)?;
    let inertia = body.map(|body| free("body", body)).transpose()?;
    if inertia.is_some() && kind != Kind::Rate {
        return Err(refused(format!("body: a flight is fitted to rates, and the readings are {kind}s")));
    }
    let found = aside(t.py(), move |_| {
        let Cleaned { record, mut warnings } = Cleaned::of(record, kind, row)?;
        let segment = single(&record)?;
        let (times, rates) = (segment.times(), segment.rates());
        let (noise, is_found) = match noise {
            Some(noise) => (noise, false),
            None => {
                let (noise, is_enough) = Findings::noise(&record);
                if !is_enough {
                    warnings.push(Findings::without_noise("sigma", "noise"));
                } else if bias == 0.0 {
                    warnings.extend(Findings::resting(&record, "sigma", "bias"));
                }
                (noise, is_enough)
            }
        };
        // noise that is found in the record holds that of the stamps
        let stamps = if is_found && stamps.is_finite() { stamps.min(0.0) } else { stamps };
        let sensor =
            Sensor::default().with_noise(noise).with_bias(bias).with_scale(scale_error).with_stamps(stamps);
        let text = |error: &dyn std::fmt::Display| error.to_string();
        let rule = match asked {
            Asked::Rule(rule) => rule,
            Asked::Magnus(order, samples) => {
                strapdown::choose(times, rates, kind, order, samples, sensor).map_err(|error| text(&error))?
            }
        };
        warnings.extend(Findings::without_truncation(rule, times.len()));
        let integrated =
            strapdown::attitudes(times, rates, kind, rule, start, sensor).map_err(|error| text(&error))?;
        let Some(inertia) = inertia else { return Ok((integrated, rule.to_string(), noise, None, warnings)) };
        let flight = Flight::fit(&inertia, times, rates, start, sensor).map_err(|error| text(&error))?;
        let estimates = flight.at(times).map_err(|error| text(&error))?;
        let pairs = estimates.iter().zip(&integrated);
        let apart = pairs
            .map(|(one, other)| (one.deviations_from(other), one.time))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        Ok::<_, String>((estimates, "exact motion".to_string(), noise, apart, warnings))
    })?;
    let (estimates, rule, noise, apart, warnings) = found.map_err(of("rates"))?;
    warnings.iter().try_for_each(|warning| warn(t.py(), warning))?;
    if let Some(first) = estimates.iter().find(|estimate| estimate.budget.sigma() > Estimate::LOST) {
        let (time, most) = (first.time, Estimate::LOST);
        warn(
            t.py(),
            &format!("the attitude is lost: from t = {time} s on its standard deviation is above {most} rad"),
        )?;
    }
    if let Some((deviations, time)) = apart.filter(|(deviations, _)| *deviations > Estimate::CONTRADICTION) {
        warn(
            t.py(),
            &format!(
                "at t = {time} s the exact motion of the body and the integrated readings are {deviations:.1} standard deviations apart: a \
                 torque such as drag, a body that is not quite this one, or an error of the sensor that is not stated; sigma does not \
                 contain it"
            ),
        )?;
    }
    Ok(Attitudes { estimates, rule, noise, order })
}

enum Asked {
    Rule(Rule),
    Magnus(Option<u32>, Option<usize>),
}

fn asked(text: &str) -> PyResult<Asked> {
    let rival = Rule::RIVALS.into_iter().find(|rule| rule.to_string() == text);
    if let Some(rule) = rival {
        return Ok(Asked::Rule(rule));
    }
    if text == "auto" {
        return Ok(Asked::Magnus(None, None));
    }
    let unknown = || {
        refused(format!(
            "rule: '{text}'; it must be auto, magnus:ORDER, magnus:ORDER,SAMPLES, hold, trapezoid, two-speed or runge-kutta"
        ))
    };
    let numbers = text.strip_prefix("magnus:").ok_or_else(unknown)?;
    let (order, samples) =
        numbers.split_once(',').map_or((numbers, None), |(order, samples)| (order, Some(samples)));
    let order = order.parse().map_err(|_| unknown())?;
    let samples = samples.map(|samples| samples.parse().map_err(|_| unknown())).transpose()?;
    Ok(Asked::Magnus(Some(order), samples))
}

/// A record, or one of times and readings, and what its rows are called.
fn recorded(
    t: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
) -> PyResult<(record::Record, &'static str)> {
    if let Ok(Record { record, .. }) = t.extract::<Record>() {
        return match rates {
            Some(_) => Err(refused("rates: the record has its own; leave them out")),
            None => Ok((record, "line")),
        };
    }
    let Some(rates) = rates else { return Err(refused("rates: missing; give times and rates, or a Record")) };
    let times = Numbers::of("t", t)?.list()?;
    let rates = Numbers::of("rates", rates)?.rows::<3>(Some(times.len()))?;
    let rates: Vec<Vector3<f64>> = rates.into_iter().map(Vector3::from).collect();
    record::Record::from_samples(&times, &rates).map(|record| (record, "row")).map_err(refused)
}

/// A record as the command integrates it, and what is to be said of that.
struct Cleaned {
    record: record::Record,
    warnings: Vec<String>,
}

impl Cleaned {
    fn of(record: record::Record, kind: Kind, row: &str) -> Result<Self, String> {
        // an increment that stands out is none that may be left out, as its turn would be lost
        let cleaned = if kind == Kind::Rate { record.without_spikes() } else { None };
        let (spikes, record) = cleaned.unwrap_or_else(|| (Vec::new(), record));
        let mut findings = Findings::default();
        findings.add(&record, &spikes);
        if let Some(rule) = findings.lost(kind, 0) {
            return Err(rule);
        }
        if kind != Kind::Rate {
            findings.add_intervals(&record, None);
        }
        let record = record.parted();
        if kind == Kind::Rate {
            findings.add_jumps(&record);
        }
        Ok(Cleaned { record, warnings: findings.warnings(row) })
    }
}

/// The one segment of a record; between several the body turned nobody knows how.
fn single(record: &record::Record) -> Result<&Segment, String> {
    match record.segments.as_slice() {
        [segment] => Ok(segment),
        segments => {
            let first = segments.first().and_then(|segment| segment.times().last());
            let next = segments.get(1).and_then(|segment| segment.times().first());
            let gap = first.zip(next).map_or(String::new(), |(end, start)| {
                format!(", the first from {} s to {} s", Shown(*end), Shown(*start))
            });
            Err(format!(
                "{} segments with gaps between them, where rows are missing or left out{gap}: how the body turned in a gap is not known; give \
                 t and rates of one segment",
                segments.len()
            ))
        }
    }
}

impl Attitudes {
    fn column<'py>(&self, py: Python<'py>, of: impl Fn(&Estimate) -> f64) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.estimates.iter().map(of).collect(), &[self.estimates.len()])
    }

    fn curve(&self, name: &str, of: impl Fn(&Estimate) -> f64) -> Curve {
        let points = self.estimates.iter().map(|estimate| (estimate.time, of(estimate)));
        Curve::new(name.to_string(), points.filter(|(_, value)| *value > 0.0).collect()).plain()
    }
}

#[pymethods]
impl Attitudes {
    /// Times, s.
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.column(py, |estimate| estimate.time)
    }

    /// Quaternions, body to space, in the order that was asked for: shape (n, 4).
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows = self.estimates.iter().flat_map(|estimate| self.order.write(estimate.attitude.into()));
        array(py, rows.collect(), &[self.estimates.len(), 4])
    }

    /// The attitudes as a `scipy.spatial.transform.Rotation`.
    #[getter]
    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        scipy_rotation(&self.attitude(py)?, self.order)
    }

    /// Standard deviation of each component of the attitude error, from all causes, rad.
    #[getter]
    fn sigma<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.column(py, |estimate| estimate.budget.sigma())
    }

    /// Estimated error of the rule, rad; 0 for the exact motion of a body.
    #[getter]
    fn truncation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.column(py, |estimate| estimate.budget.truncation)
    }

    /// The errors by cause, rad: a dict of `truncation`, `random_walk`, `bias`, `scale`, `stamps`.
    #[getter]
    fn budget<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        found.set_item("truncation", self.truncation(py)?)?;
        found.set_item("random_walk", self.column(py, |estimate| estimate.budget.random_walk)?)?;
        found.set_item("bias", self.column(py, |estimate| estimate.budget.bias)?)?;
        found.set_item("scale", self.column(py, |estimate| estimate.budget.scale)?)?;
        found.set_item("stamps", self.column(py, |estimate| estimate.budget.stamps)?)?;
        Ok(found)
    }

    /// Covariance of the attitude error, a rotation vector in space axes, rad^2: shape (n, 3, 3).
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let entries =
            self.estimates.iter().flat_map(|estimate| estimate.budget.covariance.data.0.as_flattened());
        array(py, entries.copied().collect(), &[self.estimates.len(), 3, 3])
    }

    /// The rule that turned readings into attitudes, such as `magnus:6,8`: order 6 through 8 samples.
    #[getter]
    fn rule(&self) -> &str {
        &self.rule
    }

    /// White noise of a reading, as given or found in the record, rad/s; of increments rad.
    #[getter]
    fn noise(&self) -> f64 {
        self.noise
    }

    fn __len__(&self) -> usize {
        self.estimates.len()
    }

    fn __repr__(&self) -> String {
        let names = [
            ("t", "s"),
            ("q_w", ""),
            ("q_x", ""),
            ("q_y", ""),
            ("q_z", ""),
            ("sigma", "rad"),
            ("truncation", "rad"),
        ];
        let columns = names.map(|(name, unit)| Column::new(name, unit, "").digits(4)).to_vec();
        let mut table = Table::new("attitudes", "Attitudes from readings.", columns);
        for k in shown::places(self.estimates.len()) {
            let Estimate { time, attitude, budget, .. } = self.estimates[k];
            let [w, x, y, z] = Order::First.write(attitude.into());
            table.push([time, w, x, y, z, budget.sigma(), budget.truncation].map(Cell::from));
        }
        format!("Attitudes by {}\n{}", self.rule, shown::text(&table, self.estimates.len()))
    }

    /// The rows with a figure of the errors.
    fn _repr_html_(&self) -> String {
        let mut figure =
            Figure::new("attitudes", "Errors", ("time (s)", Scale::Linear), ("angle (rad)", Scale::Log));
        figure.series.push(self.curve("all causes", |estimate| estimate.budget.sigma()));
        figure.series.push(self.curve("truncation", |estimate| estimate.budget.truncation));
        figure.series.retain(|curve| !curve.points.is_empty());
        let svg = match figure.series.is_empty() {
            true => String::new(),
            false => sheet("attitudes", &format!("Attitudes by {}", self.rule), 1, &[figure]).svg,
        };
        shown::page(&self.__repr__(), &svg)
    }
}
