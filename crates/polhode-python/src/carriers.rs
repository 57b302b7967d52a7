//! Carrier, proof body and object as one joint fit.

use nalgebra::{Matrix3, Vector3};
use polhode::{inertia as masses, record};
use polhode_files::ReadAs;
use polhode_fit::{
    self as fits, Attached, CarrierError, CarrierRecords, FitError, ProofBody, Settings, during, fit_carrier,
    flights,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::{Numbers, array, matrix};
use crate::bodies::inertia;
use crate::calm::aside;
use crate::error::{of, refused, warn};
use crate::estimates::{Estimate, named, six};
use crate::fits::{model, priors, recorded};
use crate::masses::MassProperties;
use crate::scalars::maybe;
use crate::units::positive;

/// A tensor in kg m^2, sensor axes, with its uncertainty.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct MeasuredBody(fits::MeasuredBody);

#[pymethods]
impl MeasuredBody {
    /// The tensor.
    #[getter]
    fn tensor<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        matrix(py, &self.0.tensor)
    }

    /// Covariance of its entries xx, yy, zz, xy, xz, yz, (kg m^2)^2.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        six(py, &self.0.covariance)
    }

    /// Principal moments, ascending.
    #[getter]
    fn principal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.principal.to_vec(), &[3])
    }

    /// Their standard deviations.
    #[getter]
    fn sigma_principal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.0.sigma_principal.to_vec(), &[3])
    }

    /// The rotation from principal axes to those of the sensor, w, x, y, z.
    #[getter]
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let q = self.0.axes.quaternion();
        array(py, vec![q.w, q.i, q.j, q.k], &[4])
    }

    fn __repr__(&self) -> String {
        let of = |k: usize| format!("{:.6e} +- {:.1e}", self.0.principal[k], self.0.sigma_principal[k]);
        format!("MeasuredBody(moments {}, {}, {} kg m^2)", of(0), of(1), of(2))
    }
}

/// The answer of `fit_carrier`.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct CarrierEstimate {
    found: fits::CarrierEstimate,
    /// How the files of each record were read.
    read_as: Vec<(Attached, Vec<ReadAs>)>,
    warnings: Vec<String>,
}

#[pymethods]
impl CarrierEstimate {
    /// The carrier, about its centre of mass.
    #[getter]
    fn carrier(&self) -> MeasuredBody {
        MeasuredBody(self.found.carrier.clone())
    }

    /// What the object adds to the carrier: its tensor with the parallel-axis term; `None` without an object.
    #[getter]
    fn object(&self) -> Option<MeasuredBody> {
        self.found.object.clone().map(MeasuredBody)
    }

    /// The object about its own centre of mass; `None` unless its mass and place were given.
    #[getter]
    fn object_itself(&self) -> Option<MeasuredBody> {
        self.found.object_itself.clone().map(MeasuredBody)
    }

    /// Moment of inertia of an unknown wheel about its axis, and its standard deviation, kg m^2.
    #[getter]
    fn wheel(&self) -> Option<(f64, f64)> {
        self.found.wheel.map(|wheel| (wheel.inertia, wheel.sigma))
    }

    /// Joint covariance, (kg m^2)^2: the entries xx, yy, zz, xy, xz, yz of the carrier, those of what the object adds, then the wheel.
    #[getter]
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let m = &self.found.covariance;
        array(py, m.transpose().as_slice().to_vec(), &[m.nrows(), m.ncols()])
    }

    /// What gives the size of the carrier: for each source the relative standard deviation of the trace from that source alone.
    #[getter]
    fn sizes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for size in &self.found.sizes {
            found.set_item(size.source.to_string(), size.relative)?;
        }
        Ok(found)
    }

    /// Agreement of the records: chi squared about the answer, and its degrees of freedom.
    #[getter]
    fn agreement(&self) -> (f64, usize) {
        (self.found.agreement.chi2, self.found.agreement.dof)
    }

    /// By how many standard deviations the triangle inequalities moved the answer.
    #[getter]
    fn pull(&self) -> f64 {
        self.found.pull
    }

    /// Errors of the sensor, estimated from all records: a dict by name, each with `value`, `sigma`, `unit`, `prior`.
    #[getter]
    fn nuisances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        named(py, &self.found.nuisances)
    }

    /// The fit of each record by itself: a dict by what tumbled.
    #[getter]
    fn records<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (attached, found) in &self.found.records {
            let warnings = found.warnings.iter().map(ToString::to_string).collect();
            let of_file = self.read_as.iter().filter(|(of, _)| of == attached);
            let read_as = of_file.flat_map(|(_, files)| files.clone()).collect();
            let (found, flights, unused) = (found.clone(), Vec::new(), Vec::new());
            let one = Estimate { found, flights, unused, read_as, warnings };
            all.set_item(attached.to_string(), Bound::new(py, one)?)?;
        }
        Ok(all)
    }

    /// What limits the use of the estimate: sentences, which are also Python warnings.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn __repr__(&self) -> String {
        let bodies = [
            ("carrier", Some(&self.found.carrier)),
            ("object", self.found.object.as_ref()),
            ("object_itself", self.found.object_itself.as_ref()),
        ];
        let line = |(name, body): (&str, Option<&fits::MeasuredBody>)| {
            Some(format!("{name}: {}", MeasuredBody(body?.clone()).__repr__()))
        };
        let (chi2, dof) = self.agreement();
        let lines: Vec<String> = bodies.into_iter().filter_map(line).collect();
        format!("{}\nagreement: chi^2 {chi2:.1} of {dof} degrees of freedom", lines.join("\n"))
    }
}

/// Tensors in kg m^2 of a carrier and of an object on it, from records of one sensor that is fixed to the carrier.
///
/// - `carrier`, `proof`, `object`, `object_proof`: records of the carrier alone, with a proof body whose mass properties are known, with the
///   object, and with both. Each is a `Record` of `read`, a list of them, or a tuple of times, s, and rates (n, 3), rad/s. If a wheel turns,
///   the tuple has its angular momenta (n, 3), N m s, as a third member. Flights in a record that is not free throughout are found.
/// - `proof_body`: the tensor that the proof body adds to that of the carrier, kg m^2, as three moments or (3, 3); or its mass properties,
///   with the centre of mass relative to that of the carrier, and `carrier_mass`, kg. `proof_sigma`: relative standard deviation of what it
///   adds; without it the proof body counts as exact.
/// - `object_mass`, kg, and `object_at`, its centre of mass relative to that of the carrier, m, together with `carrier_mass`: the answer then
///   also has the tensor of the object about its own centre of mass.
/// - `unknown_wheel`: the third member of a tuple is the axis of a wheel times its speed, rad/s, and the moment of inertia of the wheel is
///   estimated.
///
/// All other arguments are those of `fit`.
///
/// >>> import numpy, polhode
/// >>> t, random = numpy.arange(1000) * 0.01, numpy.random.default_rng(1)
/// >>> carrier, proof = numpy.array([0.02, 0.03, 0.04]), numpy.array([0.015, 0.004, 0.016])
/// >>> def tumble(moments):
/// ...     return t, polhode.FreeMotion(moments, [1, 3, 2]).at(t).omega + random.normal(0, 1e-3, (1000, 3))
/// >>> found = polhode.fit_carrier(tumble(carrier), proof=tumble(carrier + proof), proof_body=proof)
/// >>> bool(numpy.all(abs(found.carrier.principal - carrier) < 5 * found.carrier.sigma_principal))
/// True
#[pyfunction(name = "fit_carrier")]
#[pyo3(signature = (carrier, *, proof = None, object = None, object_proof = None, proof_body = None, proof_sigma = None,
                    carrier_mass = None, object_mass = None, object_at = None, unknown_wheel = false, torque = "auto", radius = None,
                    noise = None, gyro_bias = None, gyro_scale = None, gyro_axis_scales = None, gyro_misalignment = None,
                    gyro_skew = None, quantum = None, trust_units = false))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn fitted_carrier(
    py: Python<'_>,
    carrier: &Bound<'_, PyAny>,
    proof: Option<&Bound<'_, PyAny>>,
    object: Option<&Bound<'_, PyAny>>,
    object_proof: Option<&Bound<'_, PyAny>>,
    proof_body: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = maybe::proof_sigma)] proof_sigma: Option<f64>,
    #[pyo3(from_py_with = maybe::carrier_mass)] carrier_mass: Option<f64>,
    #[pyo3(from_py_with = maybe::object_mass)] object_mass: Option<f64>,
    object_at: Option<&Bound<'_, PyAny>>,
    unknown_wheel: bool,
    torque: &str,
    #[pyo3(from_py_with = maybe::radius)] radius: Option<f64>,
    #[pyo3(from_py_with = maybe::noise)] noise: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_bias)] gyro_bias: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_scale)] gyro_scale: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_axis_scales)] gyro_axis_scales: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_misalignment)] gyro_misalignment: Option<f64>,
    #[pyo3(from_py_with = maybe::gyro_skew)] gyro_skew: Option<f64>,
    #[pyo3(from_py_with = maybe::quantum)] quantum: Option<f64>,
    trust_units: bool,
) -> PyResult<CarrierEstimate> {
    let place = Numbers::maybe("object_at", object_at)?.map(Numbers::vector).transpose()?;
    let placed = match (object_mass, place, carrier_mass) {
        (Some(mass), Some(place), Some(carrier)) => Some((mass, place, carrier)),
        (None, None, _) => None,
        _ => return Err(refused("object_mass, object_at, carrier_mass: give all three")),
    };
    let known = match (proof_body, proof.or(object_proof)) {
        (None, Some(_)) => return Err(refused("proof_body: missing; proof and object_proof need it")),
        (Some(_), None) => {
            return Err(refused("proof, object_proof: missing; give a record with the proof body"));
        }
        (known, _) => known.map(|body| Known::of(body, carrier_mass)).transpose()?,
    };
    if placed.is_some() && object.is_none() && object_proof.is_none() {
        return Err(refused(
            "object_at: no record has the object on the carrier; give object or object_proof",
        ));
    }
    if let (Some(sigma), None) = (proof_sigma, &known) {
        return Err(refused(format!("proof_sigma: {sigma:?}; it is of proof_body, and none is given")));
    }
    if let (Some(mass), None, None | Some(Known::Adding(_))) = (carrier_mass, placed, &known) {
        return Err(refused(format!(
            "carrier_mass: {mass:?}; it goes with the mass properties of a proof body, or with object_at, and neither is given"
        )));
    }
    let body = |found: Result<ProofBody, CarrierError>| {
        found.map(|body| body.with_deviation(proof_sigma)).map_err(of("proof_body"))
    };
    let on_carrier = match (proof, &known) {
        (Some(proof), Some(known)) => Some((tumble("proof", proof)?, body(known.on_carrier())?)),
        _ => None,
    };
    let beside = match (object_proof, &known) {
        (Some(both), Some(known)) => {
            let beside = known.beside(placed.map(|(mass, place, _)| (mass, place)))?;
            Some((tumble("object_proof", both)?, body(beside)?))
        }
        _ => None,
    };
    let settings = Settings::default()
        .with_radius(radius)
        .with_noise(noise)
        .with_check_units(!trust_units)
        .with_torque(model(torque)?)
        .with_quantum(quantum.map(|value| positive("quantum", value)).transpose()?)
        .with_sensor(priors([gyro_bias, gyro_scale, gyro_axis_scales, gyro_misalignment, gyro_skew])?);
    let mut read_as = Vec::new();
    let mut known = |attached: Attached, (record, files): (record::Record, Vec<ReadAs>)| {
        read_as.push((attached, files));
        record
    };
    let tumbles = Tumbles {
        carrier: known(Attached::Nothing, tumble("carrier", carrier)?),
        proof: on_carrier.map(|(found, body)| (known(Attached::Proof, found), body)),
        object: match object {
            Some(object) => Some(known(Attached::Object, tumble("object", object)?)),
            None => None,
        },
        both: beside.map(|(found, body)| (known(Attached::ObjectAndProof, found), body)),
        placed,
        unknown_wheel,
    };
    let (found, mut warnings) = aside(py, move |_| tumbles.fitted(&settings))?.map_err(refused)?;
    warnings.extend(found.all_warnings());
    warnings.iter().try_for_each(|warning| warn(py, warning))?;
    Ok(CarrierEstimate { found, read_as, warnings })
}

/// The records, and what is known of what tumbled in them.
struct Tumbles {
    carrier: record::Record,
    proof: Option<(record::Record, ProofBody)>,
    object: Option<record::Record>,
    both: Option<(record::Record, ProofBody)>,
    /// Mass, kg, and place, m, of the object, and the mass of the carrier.
    placed: Option<(f64, Vector3<f64>, f64)>,
    unknown_wheel: bool,
}

impl Tumbles {
    /// The estimate, and what is to be said of records that are free in part.
    fn fitted(self, settings: &Settings) -> Result<(fits::CarrierEstimate, Vec<String>), CarrierError> {
        let mut warnings = Vec::new();
        let mut free = |attached: Attached, record: record::Record| -> Result<record::Record, CarrierError> {
            let of_record = |error: FitError| CarrierError::Record { attached, error: Box::new(error) };
            let found = flights(&record, settings).map_err(of_record)?;
            if found.whole {
                return Ok(record);
            }
            let remark = "the record as a whole is not that of a free body: the fit uses the flights that were found in it";
            warnings.push(format!("{attached}: {remark}, {} of them", found.list.len()));
            warnings.extend(found.remark_on_others().map(|remark| format!("{attached}: {remark}")));
            Ok(during(&record, &found.list))
        };
        let mut records = CarrierRecords::new(free(Attached::Nothing, self.carrier)?);
        if let Some((record, body)) = self.proof {
            records = records.with_proof(free(Attached::Proof, record)?, body);
        }
        if let Some(record) = self.object {
            records = records.with_object(free(Attached::Object, record)?);
        }
        if let Some((record, body)) = self.both {
            records = records.with_object_and_proof(free(Attached::ObjectAndProof, record)?, body);
        }
        if let Some((mass, place, carrier)) = self.placed {
            records = records.with_object_at(mass, place, carrier)?;
        }
        if self.unknown_wheel {
            records = records.with_unknown_wheel();
        }
        Ok((fit_carrier(&records, settings)?, warnings))
    }
}

/// A proof body as it is given.
enum Known {
    /// By what it adds to the carrier.
    Adding(Matrix3<f64>),
    /// By its mass properties, and the mass of the carrier, kg.
    Attached(masses::MassProperties, f64),
}

impl Known {
    fn of(value: &Bound<'_, PyAny>, carrier_mass: Option<f64>) -> PyResult<Self> {
        match (value.extract::<MassProperties>(), carrier_mass) {
            (Ok(body), Some(carrier)) => Ok(Known::Attached(body.0, carrier)),
            (Ok(_), None) => {
                Err(refused("carrier_mass: missing; the proof body is given by its mass properties"))
            }
            (Err(_), _) => Ok(Known::Adding(inertia("proof_body", value)?.tensor())),
        }
    }

    fn on_carrier(&self) -> Result<ProofBody, CarrierError> {
        match self {
            Known::Adding(tensor) => ProofBody::adding(*tensor),
            Known::Attached(body, carrier) => ProofBody::attached(body, *carrier),
        }
    }

    /// On carrier and object.
    fn beside(&self, object: Option<(f64, Vector3<f64>)>) -> PyResult<Result<ProofBody, CarrierError>> {
        match (self, object) {
            (Known::Adding(_), _) => Ok(self.on_carrier()),
            (Known::Attached(body, carrier), Some(object)) => {
                Ok(ProofBody::attached_beside(body, *carrier, object))
            }
            (Known::Attached(..), None) => Err(refused(
                "object_mass, object_at: missing; the position of the proof body counts from the common centre of mass of carrier and object",
            )),
        }
    }
}

/// A record: one of a file, several, or times and rates.
fn tumble(name: &'static str, value: &Bound<'_, PyAny>) -> PyResult<(record::Record, Vec<ReadAs>)> {
    let of_record = |error: PyErr| refused(format!("{name}: {}", error.value(value.py())));
    let Ok(parts) = value.cast::<PyTuple>() else {
        return recorded(value, None, None, None).map_err(of_record);
    };
    let part = |k: usize| parts.get_item(k);
    let found = match parts.len() {
        2 => recorded(&part(0)?, Some(&part(1)?), None, None),
        3 => recorded(&part(0)?, Some(&part(1)?), Some(&part(2)?), None),
        count => {
            return Err(refused(format!(
                "{name}: a tuple of {count}; give times, rates and, of a wheel, momenta"
            )));
        }
    };
    found.map_err(of_record)
}
