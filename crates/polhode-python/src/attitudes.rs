//! Attitude from measured angular velocities.

use nalgebra::Vector3;
use polhode::record;
use polhode::strapdown::{self, Estimate, Flight, Kind, Rule, Sensor};
use polhode_pages::figure::{Curve, Figure, Scale, sheet};
use polhode_pages::table::{Cell, Column, Table};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Numbers, Order, array, rotation, scipy_rotation};
use crate::calm::aside;
use crate::error::{of, refused, warn};
use crate::shown;
use crate::tables::Record;
use crate::through::free;

/// Attitudes at the times of a record, and what each is worth.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Attitudes {
    estimates: Vec<Estimate>,
    rule: String,
    noise: f64,
    order: Order,
}

/// Attitudes from the readings of a gyroscope, each with its error budget; what `polhode attitude` prints.
///
/// `t`, s, and `rates` (n, 3) in body axes, or one `Record`. `kind` says what a reading is: `rate` (rad/s at its time), `average` (rad/s, mean
/// since the one before) or `increment` (rad since the one before). `start` is the attitude at the first time, which counts as exact.
/// `rule` is `auto` (order and samples chosen with the noise), `magnus:ORDER`, `magnus:ORDER,SAMPLES`, or what others run: `hold`,
/// `trapezoid`, `two-speed`, `runge-kutta`. Standard deviations of the sensor: `noise` of a reading (found in the record where it
/// is not given), `bias`, rad/s, `scale_error`, a ratio, `stamps`, s, of which noise that is found is a part. With a free `body` the
/// attitudes are those of its exact motion that fits all rates best; a warning says where they contradict those of the readings alone.
/// Other warnings are of samples that stand far out of their neighbours, which the command leaves out, and of attitudes that are lost.
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
    noise: Option<f64>,
    bias: f64,
    scale_error: f64,
    stamps: f64,
    body: Option<&Bound<'_, PyAny>>,
    order: &str,
) -> PyResult<Attitudes> {
    let (times, rates) = samples(t, rates)?;
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
        // noise that is found in the record holds that of the stamps
        let stamps = if noise.is_none() && stamps.is_finite() { stamps.min(0.0) } else { stamps };
        let record = record::Record::from_samples(&times, &rates).ok();
        // rates that stand far out of their neighbours
        let spikes = record.as_ref().filter(|_| kind == Kind::Rate).and_then(record::Record::without_spikes);
        let noise = noise.unwrap_or_else(|| {
            // steps of digital readings count as noise
            let rounding = record.map_or(0.0, |record| record.rounding(&record.quanta()).sqrt());
            strapdown::noise(&times, &rates).max(rounding)
        });
        let sensor =
            Sensor::default().with_noise(noise).with_bias(bias).with_scale(scale_error).with_stamps(stamps);
        let text = |error: &dyn std::fmt::Display| error.to_string();
        let rule = match asked {
            Asked::Rule(rule) => rule,
            Asked::Magnus(order, samples) => strapdown::choose(&times, &rates, kind, order, samples, sensor)
                .map_err(|error| text(&error))?,
        };
        let integrated =
            strapdown::attitudes(&times, &rates, kind, rule, start, sensor).map_err(|error| text(&error))?;
        let Some(inertia) = inertia else { return Ok((integrated, rule.to_string(), noise, None, spikes)) };
        let flight = Flight::fit(&inertia, &times, &rates, start, sensor).map_err(|error| text(&error))?;
        let estimates = flight.at(&times).map_err(|error| text(&error))?;
        let pairs = estimates.iter().zip(&integrated);
        let apart = pairs
            .map(|(one, other)| (one.deviations_from(other), one.time))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        Ok::<_, String>((estimates, "exact motion".to_string(), noise, apart, spikes))
    })?;
    let (estimates, rule, noise, apart, spikes) = found.map_err(of("rates"))?;
    if let Some((count, time)) = spikes.and_then(|(spikes, _)| Some((spikes.len(), spikes.first()?.time))) {
        let samples =
            if count == 1 { "1 sample stands".to_string() } else { format!("{count} samples stand") };
        warn(
            t.py(),
            &format!(
                "{samples} far out of the neighbours, the first at t = {time} s, and sigma does not contain what that does to the attitude; \
                 the command leaves such samples out"
            ),
        )?;
    }
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

/// Times and readings, of arrays or of the one segment of a record.
fn samples(
    t: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Vec<f64>, Vec<Vector3<f64>>)> {
    if let Ok(Record { record, .. }) = t.extract::<Record>() {
        return match (rates, record.segments.as_slice()) {
            (Some(_), _) => Err(refused("rates: the record has its own; leave them out")),
            (None, [segment]) => Ok((segment.times().to_vec(), segment.rates().to_vec())),
            (None, segments) => Err(refused(format!(
                "t: a record of {} segments with gaps between them, in which the body turned nobody knows how; give t and rates of one",
                segments.len()
            ))),
        };
    }
    let Some(rates) = rates else { return Err(refused("rates: missing; give times and rates, or a Record")) };
    let times = Numbers::of("t", t)?.list()?;
    let rates = Numbers::of("rates", rates)?.rows::<3>(Some(times.len()))?;
    Ok((times, rates.into_iter().map(Vector3::from).collect()))
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

    /// Standard deviation of each component of the attitude error by all causes, rad.
    #[getter]
    fn sigma<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.column(py, |estimate| estimate.budget.sigma())
    }

    /// Estimated error of the rule, rad; 0 of an exact motion.
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

    /// The rule by which readings became turns, as `magnus:6,8`: order 6 through 8 samples.
    #[getter]
    fn rule(&self) -> &str {
        &self.rule
    }

    /// White noise of a reading that was given, or found in the record, rad/s; of increments rad.
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
    fn _repr_html_(&self) -> PyResult<String> {
        let mut figure =
            Figure::new("attitudes", "Errors", ("time (s)", Scale::Linear), ("angle (rad)", Scale::Log));
        figure.series.push(self.curve("all causes", |estimate| estimate.budget.sigma()));
        figure.series.push(self.curve("truncation", |estimate| estimate.budget.truncation));
        figure.series.retain(|curve| !curve.points.is_empty());
        let svg = match figure.series.is_empty() {
            true => String::new(),
            false => {
                sheet("attitudes", &format!("Attitudes by {}", self.rule), 1, &[figure]).map_err(refused)?.svg
            }
        };
        Ok(shown::page(&self.__repr__(), &svg))
    }
}
