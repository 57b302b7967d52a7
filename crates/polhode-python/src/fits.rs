//! Inertia from measured angular velocities or attitudes.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::audit::{Attitudes, Direction, QuaternionOrder, Reading, Trajectory};
use polhode::record::{self, Segment};
use polhode_files::ReadAs;
use polhode_fit::{
    self as fits, FitError, Flights, Known, Limit, Poses, Prior, SensorPriors, Settings, TorqueModel, during,
    flights,
};
use pyo3::prelude::*;

use crate::arrays::{Numbers, Order, quaternions};
use crate::bodies::inertia;
use crate::calm::aside;
use crate::error::{of, refused, warn};
use crate::estimates::Estimate;
use crate::scalars::maybe;
use crate::tables::{Record, Trajectory as Read};
use crate::units::positive;

/// The inertia tensor of a body that rotates freely, from measured angular velocities or attitudes.
///
/// Free rotation determines the tensor up to a factor: moments are then shares of the trace. Wheels, a known torque or one known number
/// give it in kg m^2.
///
/// What was measured:
///
/// - `t`: times, s. In place of `t` and `rates`: a `Record` of `read`, or a list of records of one body.
/// - `rates`: angular velocities (n, 3), rad/s, in sensor axes.
/// - `attitude`: attitudes, body to space: quaternions (n, 4) in the order `order`, or a scipy rotation. They are fitted by maximum
///   likelihood on the exact motion or, under larger torques, by a Kalman filter and smoother. With `rates` at the same times both are
///   fitted; the two may have axes of their own.
/// - `windows`: pairs of times, s, that are fitted. Without it the flights in a record of rates that is not free throughout are found.
/// - `wheel`: angular momenta of wheels (n, 3), N m s; `applied_torque`: known torques (n, 3), N m. Both go with `rates`.
///
/// What is known of the tensor:
///
/// - one of `trace`, kg m^2; `momentum` (|L|), kg m^2/s; `twice_energy`, kg m^2/s^2; and `moment`, as `[x, y, z, I]`: the moment I, kg m^2,
///   about the axis x, y, z.
/// - `at_least`, `at_most`: rows `[x, y, z, share]`, limits of the moment about an axis as a share of the trace.
/// - `prior`: a tensor known beforehand, for instance from CAD, with `prior_sigma`, the relative standard deviation of its entries. With
///   `prior_shape=True` only its ratios are used.
///
/// Torques, noise and errors of the sensor:
///
/// - `torque`: model of an unknown torque: "none", "drag", "drag3", "quadratic", "constant", or "auto", the simplest that the record does
///   not contradict.
/// - `noise`: standard deviation of the rates, rad/s; `attitude_noise`: that of each component of the rotation vector of an attitude, rad;
///   `quantum`: step of digital readings, rad/s. Each is found in the record if it is not given.
/// - `gyro_bias`, rad/s, `gyro_scale`, `gyro_axis_scales`, `gyro_misalignment`, rad, and `gyro_skew`, s: prior standard deviations of errors
///   of the sensor, which are then estimated with the tensor.
/// - `radius`: half width of the test functions of the weak form, s; rarely needed.
/// - `trust_units`: fit even if other units explain the record better.
///
/// >>> import numpy, polhode
/// >>> t = numpy.arange(4000) * 0.01
/// >>> rates = polhode.FreeMotion([1, 2, 2.5], [0.4, 1, -0.3]).at(t).omega + numpy.random.default_rng(1).normal(0, 0.01, (4000, 3))
/// >>> estimate = polhode.fit(t, rates)
/// >>> bool(numpy.all(abs(estimate.ratios - [0.4, 0.8]) < 5 * estimate.sigma_ratios))
/// True
/// >>> few = t[::10]
/// >>> estimate = polhode.fit(few, attitude=polhode.FreeMotion([1, 2, 2.5], [0.4, 1, -0.3]).at(few).attitude, attitude_noise=1e-3)
/// >>> bool(abs(estimate.ratios - [0.4, 0.8]).max() < 1e-6)
/// True
#[pyfunction(name = "fit")]
#[pyo3(signature = (t, rates = None, *, attitude = None, attitude_noise = None, order = "wxyz", windows = None, wheel = None, applied_torque = None, torque = "auto",
                    radius = None, noise = None, trace = None, momentum = None, twice_energy = None, moment = None, at_least = None,
                    at_most = None, gyro_bias = None, gyro_scale = None, gyro_axis_scales = None, gyro_misalignment = None, gyro_skew = None,
                    quantum = None, prior = None, prior_sigma = None, prior_shape = false, trust_units = false))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn fitted(
    py: Python<'_>,
    t: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
    attitude: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = maybe::attitude_noise)] attitude_noise: Option<f64>,
    order: &str,
    windows: Option<&Bound<'_, PyAny>>,
    wheel: Option<&Bound<'_, PyAny>>,
    applied_torque: Option<&Bound<'_, PyAny>>,
    torque: &str,
    #[pyo3(from_py_with = maybe::radius)] radius: Option<f64>,
    #[pyo3(from_py_with = maybe::noise)] noise: Option<f64>,
    #[pyo3(from_py_with = maybe::trace)] trace: Option<f64>,
    #[pyo3(from_py_with = maybe::momentum)] momentum: Option<f64>,
    #[pyo3(from_py_with = maybe::twice_energy)] twice_energy: Option<f64>,
    moment: Option<&Bound<'_, PyAny>>,
    at_least: Option<&Bound<'_, PyAny>>,
    at_most: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = maybe::gyro_bias)] gyro_bias: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_scale)] gyro_scale: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_axis_scales)] gyro_axis_scales: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_misalignment)] gyro_misalignment: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_skew)] gyro_skew: Option<f64>,
    #[pyo3(from_py_with = maybe::quantum)] quantum: Option<f64>,
    prior: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = maybe::prior_sigma)] prior_sigma: Option<f64>,
    prior_shape: bool,
    trust_units: bool,
) -> PyResult<Estimate> {
    let windows = Numbers::maybe("windows", windows)?
        .map(|windows| Ok::<_, PyErr>(windows.rows::<2>(None)?.into_iter().map(|[a, b]| (a, b)).collect()))
        .transpose()?;
    let order = Order::of(order)?;
    let mut read_as = Vec::new();
    let measured = match attitude {
        None if attitude_noise.is_some() => return Err(refused("attitude_noise: given without attitude")),
        None if order == Order::Last => {
            return Err(refused("order: 'xyzw'; it is of attitudes, and none are given; leave it out"));
        }
        None => {
            let (record, files) = recorded(t, rates, wheel, applied_torque)?;
            read_as = files;
            Measured::rates(record, windows)?
        }
        Some(_) if wheel.is_some() || applied_torque.is_some() => {
            return Err(refused(
                "wheel, applied_torque: a fit of attitudes does not include them; leave them out",
            ));
        }
        Some(attitude) => Measured::attitudes(t, attitude, order, rates, windows)?,
    };
    let sigma = |name, value: Option<f64>| value.map(|value| positive(name, value)).transpose();
    let moment = Numbers::maybe("moment", moment)?.map(Numbers::fixed::<4>).transpose()?;
    let moment = moment.map(|[x, y, z, value]| Known::Moment { axis: Vector3::new(x, y, z), value });
    let sizes = [
        trace.map(Known::Trace),
        momentum.map(Known::Momentum),
        twice_energy.map(Known::TwiceEnergy),
        moment,
    ];
    let mut sizes = sizes.into_iter().flatten();
    let (known, None) = (sizes.next(), sizes.next()) else {
        return Err(refused("trace, momentum, twice_energy, moment: give one of them"));
    };
    let rows = |name, value: Option<&Bound<'_, PyAny>>| -> PyResult<Vec<[f64; 4]>> {
        Ok(Numbers::maybe(name, value)?.map(|rows| rows.rows(None)).transpose()?.unwrap_or_default())
    };
    let about = |x, y, z| Limit { axis: Vector3::new(x, y, z), at_least: None, at_most: None };
    let least = rows("at_least", at_least)?.into_iter();
    let least = least.map(|[x, y, z, share]| Limit { at_least: Some(share), ..about(x, y, z) });
    let most = rows("at_most", at_most)?.into_iter();
    let most = most.map(|[x, y, z, share]| Limit { at_most: Some(share), ..about(x, y, z) });
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
        .with_attitude_noise(sigma("attitude_noise", attitude_noise)?)
        .with_prior(prior)
        .with_known(known)
        .with_limits(least.chain(most).collect())
        .with_check_units(!trust_units)
        .with_torque(model(torque)?)
        .with_quantum(sigma("quantum", quantum)?)
        .with_sensor(priors([gyro_bias, gyro_scale, gyro_axis_scales, gyro_misalignment, gyro_skew])?);
    let unused = measured.unused();
    let (found, flights) = aside(py, move |_| measured.fitted(&settings))?.map_err(refused)?;
    let mut warnings: Vec<String> = found.warnings.iter().map(ToString::to_string).collect();
    if let Some(flights) = flights.as_ref().filter(|flights| !flights.whole) {
        warnings.push(format!(
            "the record as a whole is not that of a free body: the fit uses the flights that were found in it, {} of them; windows \
             selects others",
            flights.list.len()
        ));
        warnings.extend(flights.remark_on_others());
    }
    let flights = flights.map_or_else(Vec::new, |flights| flights.list);
    warnings.iter().try_for_each(|warning| warn(py, warning))?;
    Ok(Estimate { found, flights, unused, read_as, warnings })
}

/// Errors of the sensor by their standard deviations: offset, rad/s, scale, scales of the axes, misalignment, rad, and skew, s.
pub(crate) fn priors(sigmas: [Option<f64>; 5]) -> PyResult<SensorPriors> {
    let names = ["gyro_bias", "gyro_scale", "gyro_axis_scales", "gyro_misalignment", "gyro_skew"];
    let mut checked = [None; 5];
    for (k, sigma) in sigmas.into_iter().enumerate() {
        checked[k] = sigma.map(|value| positive(names[k], value)).transpose()?;
    }
    let [bias, scale, axis_scales, misalignment, skew] = checked;
    Ok(SensorPriors::default()
        .with_offset(bias)
        .with_scale(scale)
        .with_axis_scales(axis_scales)
        .with_misalignment(misalignment)
        .with_skew(skew))
}

/// What was measured.
enum Measured {
    Rates {
        record: record::Record,
        /// Whether its flights are to be found.
        whole: bool,
    },
    Attitudes(Poses),
}

impl Measured {
    fn rates(record: record::Record, windows: Option<Vec<(f64, f64)>>) -> PyResult<Self> {
        let whole = windows.is_none();
        let record = match windows {
            Some(windows) => record.windows(&windows).map_err(of("windows"))?,
            None => record,
        };
        Ok(Measured::Rates { record, whole })
    }

    fn attitudes(
        t: &Bound<'_, PyAny>,
        attitude: &Bound<'_, PyAny>,
        order: Order,
        rates: Option<&Bound<'_, PyAny>>,
        windows: Option<Vec<(f64, f64)>>,
    ) -> PyResult<Self> {
        if t.is_instance_of::<Record>() || t.is_instance_of::<Read>() {
            return Err(refused("t: beside attitudes it must be times; give the t of what was read"));
        }
        let times = Numbers::of("t", t)?.list()?;
        let n = Some(times.len());
        let (rows, order) = quaternions("attitude", attitude, order)?;
        let mut reading = Reading::default();
        reading.attitude = Some(Direction::BodyToSpace);
        reading.quaternion = Some(match order {
            Order::First => QuaternionOrder::ScalarFirst,
            Order::Last => QuaternionOrder::ScalarLast,
        });
        // normalised as those of a file are
        let table = Trajectory::new(times.clone()).with_attitude(Attitudes::Quaternions(rows.rows(n)?));
        let attitudes =
            (0..times.len()).filter_map(|row| reading.attitude(&table, row).map(UnitQuaternion::from));
        let attitudes: Vec<_> = attitudes.collect();
        let poses = match Numbers::maybe("rates", rates)? {
            Some(rates) => {
                let rates: Vec<_> = rates.rows::<3>(n)?.into_iter().map(Vector3::from).collect();
                Poses::with_rates("record", &times, &attitudes, &rates)
            }
            None => Poses::new("record", &times, &attitudes),
        };
        let poses = poses.map_err(refused)?;
        Ok(Measured::Attitudes(match windows {
            Some(windows) => poses.windows(&windows).map_err(of("windows"))?,
            None => poses,
        }))
    }

    /// Names of the columns that were not read, each once.
    fn unused(&self) -> Vec<String> {
        let Measured::Rates { record, .. } = self else { return Vec::new() };
        let mut names: Vec<String> = Vec::new();
        for (_, name) in record.unused_columns() {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    }

    /// The estimate, and the flights of a record that was not cut.
    fn fitted(self, settings: &Settings) -> Result<(fits::Estimate, Option<Flights>), FitError> {
        let (mut record, is_whole) = match self {
            Measured::Attitudes(poses) => return Ok((fits::fit_poses(&poses, settings)?, None)),
            Measured::Rates { record, whole } => (record, whole),
        };
        let found = is_whole.then(|| flights(&record, settings)).transpose()?;
        if let Some(found) = found.as_ref().filter(|found| !found.whole) {
            record = during(&record, &found.list);
        }
        Ok((fits::fit(&record, settings)?, found))
    }
}

pub(crate) fn model(torque: &str) -> PyResult<TorqueModel> {
    Ok(match torque {
        "none" => TorqueModel::None,
        "drag" => TorqueModel::Drag,
        "drag3" => TorqueModel::Drag3,
        "quadratic" => TorqueModel::Quadratic,
        "constant" => TorqueModel::Constant,
        "auto" => TorqueModel::Auto,
        other => {
            return Err(refused(format!(
                "torque: '{other}'; it must be none, drag, drag3, quadratic, constant or auto"
            )));
        }
    })
}

/// Times and rates, a record, or several of one body, and how files among them were read.
pub(crate) fn recorded(
    t: &Bound<'_, PyAny>,
    rates: Option<&Bound<'_, PyAny>>,
    wheel: Option<&Bound<'_, PyAny>>,
    torque: Option<&Bound<'_, PyAny>>,
) -> PyResult<(record::Record, Vec<ReadAs>)> {
    if let Ok(Record { record, read_as }) = t.extract::<Record>() {
        return match (rates, wheel, torque) {
            (None, None, None) => Ok((record, read_as)),
            _ => Err(refused("rates, wheel, applied_torque: the record has its own; leave them out")),
        };
    }
    if t.is_instance_of::<Read>() {
        return Err(refused(
            "t: a Trajectory; read the file as kind=\"record\", or give t, omega and attitude of it",
        ));
    }
    if rates.is_none() {
        let records: Vec<Record> = t
            .extract()
            .map_err(|_| refused("rates: missing; give times and rates, a Record, or a list of records"))?;
        if wheel.is_some() || torque.is_some() {
            return Err(refused("wheel, applied_torque: the records have their own; leave them out"));
        }
        if records.is_empty() {
            return Err(refused("t: a list without records"));
        }
        let (mut all, mut files) = (record::Record::default(), Vec::new());
        for (k, Record { record, read_as }) in records.into_iter().enumerate() {
            let shared = all.shared(&record);
            if shared > 0 {
                let samples = record.samples();
                warn(
                    t.py(),
                    &format!(
                        "record {k} of the list: {shared} of its {samples} samples are those of records before it; readings that count \
                         twice make the standard deviations too small"
                    ),
                )?;
            }
            all = all.join(record);
            files.extend(read_as);
        }
        return Ok((all, files));
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
        return record::Record::from_samples(&times, &rates)
            .map(|record| (record, Vec::new()))
            .map_err(refused);
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
    Ok((record, Vec::new()))
}
