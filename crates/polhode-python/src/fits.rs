//! Inertia from measured angular velocities.

use nalgebra::{SMatrix, Vector3};
use polhode::record::{self, Segment};
use polhode_fit::{
    self as fits, FitError, Flights, Known, Nuisance, Prior, SensorPriors, Settings, TorqueModel,
    TorqueScope, during, flights,
};
use polhode_pages::figure::{Curve, Figure, Scale};
use polhode_pages::table::{Column, Table, row};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Numbers, array, matrix};
use crate::bodies::inertia;
use crate::calm::aside;
use crate::error::{of, refused, warn};
use crate::files::{Record, positive};
use crate::shown;

/// A fitted tensor and how far to trust it. Moments are shares of the trace, as free motion tells no size.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Estimate {
    found: fits::Estimate,
    flights: Vec<(f64, f64)>,
    warnings: Vec<String>,
}

fn six<'py>(py: Python<'py>, m: &SMatrix<f64, 6, 6>) -> PyResult<Bound<'py, PyAny>> {
    array(py, m.transpose().as_slice().to_vec(), &[6, 6])
}

fn named<'py>(py: Python<'py>, all: &[Nuisance]) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    for one in all {
        let entry = PyDict::new(py);
        entry.set_item("value", one.value)?;
        entry.set_item("sigma", one.sigma)?;
        entry.set_item("unit", one.unit)?;
        entry.set_item("prior", one.prior)?;
        let name = one.segment.map_or(one.name.into(), |k| format!("segment_{}_{}", k + 1, one.name));
        found.set_item(name, entry)?;
    }
    Ok(found)
}

#[pymethods]
impl Estimate {
    /// The tensor with trace 1, sensor axes.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        matrix(py, &self.found.shape.tensor())
    }

    /// Principal moments, ascending, as shares of the trace.
    #[getter]
    fn principal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.principal.to_vec(), &[3])
    }

    /// Their standard deviations by the noise.
    #[getter]
    fn sigma_principal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.sigma_principal.to_vec(), &[3])
    }

    /// The rotation from principal axes to those of the sensor, w, x, y, z.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let q = self.found.axes.quaternion();
        array(py, vec![q.w, q.i, q.j, q.k], &[4])
    }

    /// Standard deviations of the turn about each principal axis, rad; infinite where two moments agree.
    #[getter]
    fn sigma_axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.sigma_axes.to_vec(), &[3])
    }

    /// I1/I3 and I2/I3.
    #[getter]
    fn ratios<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.ratios.to_vec(), &[2])
    }

    /// Their standard deviations.
    #[getter]
    fn sigma_ratios<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.found.sigma_ratios.to_vec(), &[2])
    }

    /// Covariance of the entries xx, yy, zz, xy, xz, yz of the shape.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        six(py, &self.found.covariance)
    }

    /// The Cramer-Rao bound on it; `None` where there is none.
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.bound.as_ref().map(|bound| six(py, bound)).transpose()
    }

    /// Absolute tensor, kg m^2, sensor axes; `None` where nothing gives its size.
    #[getter]
    fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.inertia.as_ref().map(|inertia| matrix(py, &inertia.tensor())).transpose()
    }

    /// Covariance of its entries, (kg m^2)^2.
    #[getter]
    fn inertia_covariance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.inertia_covariance.as_ref().map(|covariance| six(py, covariance)).transpose()
    }

    /// Noise of one component of the rates, rad/s.
    #[getter]
    fn noise_sigma(&self) -> f64 {
        self.found.noise_sigma
    }

    /// Mean square of the residuals over the noise.
    #[getter]
    fn chi2_per_dof(&self) -> f64 {
        self.found.chi2_per_dof
    }

    /// I1 + I2 - I3 as a share of the trace.
    #[getter]
    fn triangle_slack(&self) -> f64 {
        self.found.triangle_slack
    }

    /// Number of samples of the segments that were long enough.
    #[getter]
    fn samples(&self) -> usize {
        self.found.samples
    }

    /// Number of those segments.
    #[getter]
    fn segments(&self) -> usize {
        self.found.segments
    }

    /// Half width of the test functions, s; `None` of a likelihood on the exact motion.
    #[getter]
    fn radius(&self) -> Option<f64> {
        self.found.radius
    }

    /// Whether everything but the scale is determined.
    #[getter]
    fn identifiable(&self) -> bool {
        self.found.identifiability.complete()
    }

    /// What the record leaves undetermined, in words.
    #[getter]
    fn null_directions(&self) -> Vec<String> {
        self.found.identifiability.null_directions.iter().map(ToString::to_string).collect()
    }

    /// Share of |dw/dt|^2 that the free motion of the answer leaves unexplained.
    #[getter]
    fn unexplained(&self) -> Option<f64> {
        self.found.unexplained
    }

    /// The shape that explains the record as well if its axes are left-handed.
    #[getter]
    fn mirror<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.found.mirror.as_ref().map(|mirror| matrix(py, &mirror.tensor())).transpose()
    }

    /// The torque that the fit reckons with: a dict by coefficient of `value`, `sigma`, `unit`, `prior`.
    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named(py, &self.found.torque.coefficients)
    }

    /// What was estimated of the sensor: a dict of the same kind.
    #[getter]
    fn nuisances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named(py, &self.found.nuisances)
    }

    /// What errors of an uncalibrated sensor would do to the moments: a dict by error of `size`, `unit`, `principal`, `ratios`.
    #[getter]
    fn systematic<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for line in &self.found.systematic {
            let entry = PyDict::new(py);
            entry.set_item("size", line.size)?;
            entry.set_item("unit", line.unit)?;
            entry.set_item("principal", array(py, line.principal.to_vec(), &[3])?)?;
            entry.set_item("ratios", array(py, line.ratios.to_vec(), &[2])?)?;
            found.set_item(line.name, entry)?;
        }
        Ok(found)
    }

    /// Start and end of each flight that was fitted, s; empty where windows were given.
    #[getter]
    fn flights(&self) -> Vec<(f64, f64)> {
        self.flights.clone()
    }

    /// What limits the use of the estimate, a sentence each; Python warnings say the same.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn __repr__(&self) -> String {
        let columns = vec![
            Column::new("quantity", "", ""),
            Column::new("value", "", "").digits(7),
            Column::new("sigma", "", "").digits(2),
        ];
        let mut table = Table::new("fit", "Inertia from measured angular velocity.", columns);
        for (k, name) in ["I1 / trace", "I2 / trace", "I3 / trace"].into_iter().enumerate() {
            table.push(row![name, self.found.principal[k], self.found.sigma_principal[k]]);
        }
        table.push(row!["I1 / I3", self.found.ratios[0], self.found.sigma_ratios[0]]);
        table.push(row!["I2 / I3", self.found.ratios[1], self.found.sigma_ratios[1]]);
        for one in self.found.torque.coefficients.iter().chain(&self.found.nuisances) {
            table.push(row![one.name, one.value, one.sigma]);
        }
        let mut text = table.terminal();
        for warning in &self.warnings {
            text += &format!("warning: {warning}\n");
        }
        text.trim_end().into()
    }

    /// The numbers with a figure of the residuals.
    fn _repr_html_(&self) -> PyResult<String> {
        let title = "Residuals of the fit";
        let axes = (("time (s)", Scale::Linear), ("standard deviations", Scale::Linear));
        let mut figure = Figure::new("residuals", title, axes.0, axes.1).scatter();
        for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
            let of = |segment: &fits::Residuals| {
                segment
                    .times
                    .iter()
                    .copied()
                    .zip(segment.values.iter().map(move |values| values[k]))
                    .collect::<Vec<_>>()
            };
            figure.series.push(Curve::new(name, self.found.residuals.iter().flat_map(of).collect()).dots());
        }
        Ok(shown::page(&self.__repr__(), &figure.svg().map_err(refused)?))
    }
}

/// The inertia tensor, up to its size, of a body that rotates freely: from measured angular velocities in sensor axes.
///
/// `t`: times, s, and `rates` (n, 3), rad/s; or in place of `t` a `Record` of `read`, or a list of records of one body. Without `windows`,
/// pairs of times, the flights of a record that is not free as a whole are found. `wheel` (n, 3), N m s, and `applied_torque` (n, 3),
/// N m: angular momentum of wheels and torque at the times, which give the tensor its size, as does one of `trace`, kg m^2,
/// `momentum`, kg m^2/s, and `twice_energy`, kg m^2/s^2. `torque`: what acts besides: `none`, `drag`, `drag3`, `drag6`, `quadratic`,
/// `constant`, or `auto`, the simplest that the record does not contradict; `torque_per`: `record` or `segment`. `noise`, rad/s, and
/// `radius`, s, are found where they are not given. `gyro_bias`, rad/s, `gyro_scale`, `gyro_axis_scales`, `gyro_misalignment`, rad,
/// `gyro_skew`, s: standard deviations of errors of the sensor, estimated with these priors; `gyro_walk`, rad/s after 1 s; `quantum`,
/// rad/s, step of the readings. `prior`: a tensor that is known beforehand, or its moments, with `prior_sigma`, the relative standard
/// deviation of its entries; `prior_shape`: only its shape is known. `trust_units`: fit even if other units explain the record
/// better.
///
/// >>> import numpy, polhode
/// >>> t = numpy.arange(4000) * 0.01
/// >>> rates = polhode.FreeMotion([1, 2, 2.5], [0.4, 1, -0.3]).at(t).omega + numpy.random.default_rng(1).normal(0, 0.01, (4000, 3))
/// >>> estimate = polhode.fit(t, rates)
/// >>> bool(numpy.all(abs(estimate.ratios - [0.4, 0.8]) < 5 * estimate.sigma_ratios))
/// True
#[pyfunction(name = "fit")]
#[pyo3(signature = (t, rates = None, *, windows = None, wheel = None, applied_torque = None, torque = "auto", torque_per = "record",
                    radius = None, noise = None, trace = None, momentum = None, twice_energy = None, gyro_bias = None,
                    gyro_scale = None, gyro_axis_scales = None, gyro_misalignment = None, gyro_skew = None, gyro_walk = None,
                    quantum = None, prior = None, prior_sigma = None, prior_shape = false, trust_units = false))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn fitted(
    py: Python<'_>,
    t: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
    windows: Option<&Bound<'_, PyAny>>,
    wheel: Option<&Bound<'_, PyAny>>,
    applied_torque: Option<&Bound<'_, PyAny>>,
    torque: &str,
    torque_per: &str,
    radius: Option<f64>,
    noise: Option<f64>,
    trace: Option<f64>,
    momentum: Option<f64>,
    twice_energy: Option<f64>,
    gyro_bias: Option<f64>,
    gyro_scale: Option<f64>,
    gyro_axis_scales: Option<f64>,
    gyro_misalignment: Option<f64>,
    gyro_skew: Option<f64>,
    gyro_walk: Option<f64>,
    quantum: Option<f64>,
    prior: Option<&Bound<'_, PyAny>>,
    prior_sigma: Option<f64>,
    prior_shape: bool,
    trust_units: bool,
) -> PyResult<Estimate> {
    let mut record = recorded(t, rates, wheel, applied_torque)?;
    let whole = windows.is_none();
    if let Some(windows) = Numbers::maybe("windows", windows)? {
        let windows: Vec<(f64, f64)> = windows.rows::<2>(None)?.into_iter().map(|[a, b]| (a, b)).collect();
        record = record.windows(&windows).map_err(of("windows"))?;
    }
    let sigma = |name, value: Option<f64>| value.map(|value| positive(name, value)).transpose();
    let known = match (trace, momentum, twice_energy) {
        (None, None, None) => None,
        (Some(trace), None, None) => Some(Known::Trace(trace)),
        (None, Some(momentum), None) => Some(Known::Momentum(momentum)),
        (None, None, Some(energy)) => Some(Known::TwiceEnergy(energy)),
        _ => return Err(refused("trace, momentum, twice_energy: give one of them")),
    };
    let prior = match (prior, prior_sigma) {
        (None, None) if !prior_shape => None,
        (Some(prior), Some(sigma)) => {
            let prior = Prior::relative(inertia("prior", prior)?.tensor(), positive("prior_sigma", sigma)?);
            Some(if prior_shape { prior.shape_only() } else { prior })
        }
        _ => return Err(refused("prior, prior_sigma: give both")),
    };
    let settings = Settings::default()
        .with_radius(radius)
        .with_noise(noise)
        .with_prior(prior)
        .with_known(known)
        .with_check_units(!trust_units)
        .with_torque(model(torque)?)
        .with_torque_scope(match torque_per {
            "record" => TorqueScope::Record,
            "segment" => TorqueScope::Segment,
            _ => {
                return Err(refused(format!("torque_per: '{torque_per}'; it must be 'record' or 'segment'")));
            }
        })
        .with_quantum(sigma("quantum", quantum)?)
        .with_offset_walk(sigma("gyro_walk", gyro_walk)?)
        .with_sensor(
            SensorPriors::default()
                .with_offset(sigma("gyro_bias", gyro_bias)?)
                .with_scale(sigma("gyro_scale", gyro_scale)?)
                .with_axis_scales(sigma("gyro_axis_scales", gyro_axis_scales)?)
                .with_misalignment(sigma("gyro_misalignment", gyro_misalignment)?)
                .with_skew(sigma("gyro_skew", gyro_skew)?),
        );
    let (found, spans, is_part) = aside(py, move |_| {
        let (mut spans, mut is_part) = (Vec::new(), false);
        if whole {
            let Flights { list, whole, .. } = flights(&record, &settings)?;
            spans.extend(list.iter().map(|flight| (flight.start, flight.end)));
            is_part = !whole;
            if is_part {
                record = during(&record, &list);
            }
        }
        Ok::<_, FitError>((fits::fit(&record, &settings)?, spans, is_part))
    })?
    .map_err(refused)?;
    let mut warnings: Vec<String> = found.warnings.iter().map(ToString::to_string).collect();
    if is_part {
        warnings.push(format!(
            "the record as a whole is not that of a free body: the fit uses the flights that were found in it, {} of them; windows \
             names others",
            spans.len()
        ));
    }
    warnings.iter().try_for_each(|warning| warn(py, warning))?;
    Ok(Estimate { found, flights: spans, warnings })
}

fn model(torque: &str) -> PyResult<TorqueModel> {
    Ok(match torque {
        "none" => TorqueModel::None,
        "drag" => TorqueModel::Drag,
        "drag3" => TorqueModel::Drag3,
        "drag6" => TorqueModel::Drag6,
        "quadratic" => TorqueModel::Quadratic,
        "constant" => TorqueModel::Constant,
        "auto" => TorqueModel::Auto,
        other => {
            return Err(refused(format!(
                "torque: '{other}'; it must be none, drag, drag3, drag6, quadratic, constant or auto"
            )));
        }
    })
}

/// Times and rates, a record, or several of one body.
fn recorded(
    t: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
    wheel: Option<&Bound<'_, PyAny>>,
    torque: Option<&Bound<'_, PyAny>>,
) -> PyResult<record::Record> {
    if let Ok(Record(record)) = t.extract::<Record>() {
        return match (rates, wheel, torque) {
            (None, None, None) => Ok(record),
            _ => Err(refused("rates, wheel, applied_torque: the record has its own; leave them out")),
        };
    }
    if rates.is_none() {
        let records: Vec<Record> = t
            .extract()
            .map_err(|_| refused("rates: missing; give times and rates, a Record, or a list of records"))?;
        let joined = records.into_iter().map(|Record(record)| record).reduce(record::Record::join);
        return joined.ok_or_else(|| refused("t: a list without records"));
    }
    let times = Numbers::of("t", t)?.list()?;
    let n = Some(times.len());
    let vectors = |name, value: Option<&Bound<'_, PyAny>>| -> PyResult<Option<Vec<Vector3<f64>>>> {
        let Some(numbers) = Numbers::maybe(name, value)? else { return Ok(None) };
        Ok(Some(numbers.rows::<3>(n)?.into_iter().map(Vector3::from).collect()))
    };
    let rates = vectors("rates", rates)?.unwrap_or_default();
    let (wheel, torque) = (vectors("wheel", wheel)?, vectors("applied_torque", torque)?);
    if wheel.is_none() && torque.is_none() {
        return record::Record::from_samples(&times, &rates).map_err(refused);
    }
    let mut segment = Segment::new("record", times, rates).map_err(refused)?;
    if let Some(wheel) = wheel {
        segment = segment.with_wheel(wheel).map_err(of("wheel"))?;
    }
    if let Some(torque) = torque {
        segment = segment.with_torque(torque).map_err(of("applied_torque"))?;
    }
    let mut record = record::Record::default();
    record.segments.push(segment);
    Ok(record)
}
