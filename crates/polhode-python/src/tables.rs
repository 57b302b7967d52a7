//! Trajectories and records from tables.

use std::path::PathBuf;
use std::sync::Arc;

use polhode::audit::{self, Attitudes, Convention};
use polhode::record;
use polhode_files::{Error, NamedBy, ReadAs, ReadOptions, trajectory};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::array;
use crate::error::{refused, warn};
use crate::files::heard;
use crate::parts;

/// Where the rows of a table come from.
pub(crate) enum Rows {
    File(PathBuf),
    Text(String),
}

impl Rows {
    fn name(&self) -> String {
        match self {
            Rows::File(path) => polhode_files::text::visible(&path.display().to_string()).into_owned(),
            Rows::Text(_) => "columns".into(),
        }
    }

    pub(crate) fn trajectory(&self, options: &ReadOptions) -> Result<trajectory::FoundTrajectory, Error> {
        match self {
            Rows::File(path) => trajectory::read(path, options),
            Rows::Text(text) => trajectory::of_text(text, &self.name(), options),
        }
    }

    fn record(&self, options: &ReadOptions) -> Result<polhode_files::record::FoundRecord, Error> {
        match self {
            Rows::File(path) => polhode_files::record::open(path, options, None),
            Rows::Text(text) => polhode_files::record::read(text, &self.name(), options),
        }
    }
}

/// A trajectory from a file, with the convention that the names of its columns state, for `audit`.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Trajectory {
    pub(crate) file: String,
    pub(crate) id: Option<String>,
    pub(crate) rows: audit::Trajectory,
    pub(crate) claims: Convention,
    pub(crate) counts_steps: bool,
    /// Of the file, with its first body.
    pub(crate) remark: Option<String>,
    /// Columns of another attitude, where none are named.
    pub(crate) second_attitude: Vec<String>,
    comments: Vec<String>,
}

#[pymethods]
impl Trajectory {
    /// Name of the body, if the file has several.
    #[getter]
    fn id(&self) -> Option<&str> {
        self.id.as_deref()
    }

    /// Times, s; or counts of steps, if the file does not state the length of a step.
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, self.rows.times.clone(), &[self.rows.times.len()])
    }

    /// Attitudes as they stand in the columns: quaternions (n, 4), matrices (n, 3, 3), Euler angles or Rodrigues parameters (n, 3).
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(attitude) = &self.rows.attitude else { return Ok(None) };
        let n = attitude.len();
        match attitude {
            Attitudes::Quaternions(rows) => array(py, rows.as_flattened().to_vec(), &[n, 4]),
            Attitudes::Matrices(rows) => array(py, rows.as_flattened().to_vec(), &[n, 3, 3]),
            Attitudes::Angles(rows) | Attitudes::Rodrigues(rows) => {
                array(py, rows.as_flattened().to_vec(), &[n, 3])
            }
            _ => return Ok(None),
        }
        .map(Some)
    }

    /// Angular velocities as they stand in the columns: (n, 3).
    #[getter]
    fn omega<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        vectors(py, self.rows.rates.as_deref())
    }

    /// Angular momenta as they stand in the columns: (n, 3).
    #[getter]
    fn momentum<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        vectors(py, self.rows.momentum.as_deref())
    }

    /// The lines above the header that begin with #, without the #.
    #[getter]
    fn comments(&self) -> Vec<String> {
        self.comments.clone()
    }

    fn __len__(&self) -> usize {
        self.rows.times.len()
    }

    fn __repr__(&self) -> String {
        let of = self.id.as_ref().map_or(String::new(), |id| format!(", body {id}"));
        let attitude = self.rows.attitude.as_ref().map(Attitudes::name);
        let rates = self.rows.rates.as_ref().map(|_| "angular velocity");
        let momentum = self.rows.momentum.as_ref().map(|_| "angular momentum");
        let columns: Vec<&str> = [attitude, rates, momentum].into_iter().flatten().collect();
        format!("Trajectory({}{of}: {} rows of {})", self.file, self.rows.times.len(), columns.join(", "))
    }
}

fn vectors<'py>(py: Python<'py>, rows: Option<&[[f64; 3]]>) -> PyResult<Option<Bound<'py, PyAny>>> {
    rows.map(|rows| array(py, rows.as_flattened().to_vec(), &[rows.len(), 3])).transpose()
}

/// A record of measured angular velocities, in segments without gaps, for `fit` and `attitude`.
#[pyclass(frozen, module = "polhode", from_py_object)]
#[derive(Clone)]
pub(crate) struct Record {
    pub(crate) record: record::Record,
    pub(crate) read_as: Vec<ReadAs>,
}

#[pymethods]
impl Record {
    /// Number of segments without gaps.
    #[getter]
    fn segments(&self) -> usize {
        self.record.segments.len()
    }

    /// Times of all segments, s.
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let times: Vec<f64> =
            self.record.segments.iter().flat_map(|segment| segment.times()).copied().collect();
        let n = times.len();
        array(py, times, &[n])
    }

    /// Angular velocities of all segments in sensor axes, rad/s: (n, 3).
    #[getter]
    fn rates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rates = self.record.segments.iter().flat_map(|segment| segment.rates());
        let rates: Vec<f64> = rates.flat_map(|rate| rate.iter().copied().collect::<Vec<_>>()).collect();
        let n = rates.len() / 3;
        array(py, rates, &[n, 3])
    }

    /// In which units its files were read: a dict for each file.
    ///
    /// It has `file`, `rate_unit` and `time_unit`, and in `rate_unit_by` and `time_unit_by` what named them: `header`, `setting`, `layout` of the
    /// file, `values`, or `none` (rad/s and s were assumed). It also has `sample_rate`, Hz, `axes` as they were set, and
    /// `taken_as_right_handed`.
    #[getter]
    fn read_as<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        parts::read_as(py, &self.read_as)
    }

    fn __len__(&self) -> usize {
        self.record.samples()
    }

    fn __repr__(&self) -> String {
        let segments = self.record.segments.len();
        format!(
            "Record({} samples in {segments} segment{})",
            self.record.samples(),
            if segments == 1 { "" } else { "s" }
        )
    }
}

/// Refuses a unit of times that have theirs, and says where it is guessed from large numbers.
fn check_times(py: Python<'_>, options: &ReadOptions, read_as: &ReadAs) -> PyResult<()> {
    let (times, by) = &read_as.times;
    if *by == NamedBy::Values && times.ends_with("since 1970") {
        warn(
            py,
            &format!(
                "{}: the times are taken as {times}; if they count from another time, as from the start of the device, give their unit as \
                 time_unit",
                read_as.file
            ),
        )?;
    }
    let is_set = options.time_unit.is_some() || options.sample_rate.is_some();
    if is_set && (times == "dates" || times == "s and ns") {
        return Err(refused(format!(
            "time_unit, sample_rate: the times of {} are {times} already; leave them out",
            read_as.file
        )));
    }
    Ok(())
}

pub(crate) fn record_of<'py>(
    py: Python<'py>,
    rows: &Arc<Rows>,
    options: &ReadOptions,
) -> PyResult<Bound<'py, PyAny>> {
    let (own, asked) = (Arc::clone(rows), options.clone());
    let found = heard(py, move || own.record(&asked))?;
    check_times(py, options, &found.read_as)?;
    if let Some(first) = found.skipped.first() {
        let (count, samples) = (found.skipped.len(), found.record.samples());
        warn(py, &format!("rows left out: {count}, beside {samples} that are read; the first: {first}"))?;
    }
    found.remarks.iter().try_for_each(|remark| warn(py, remark))?;
    Ok(Bound::new(py, Record { record: found.record, read_as: vec![found.read_as] })?.into_any())
}

pub(crate) fn trajectories<'py>(
    py: Python<'py>,
    rows: &Rows,
    options: &ReadOptions,
    found: trajectory::FoundTrajectory,
) -> PyResult<Bound<'py, PyAny>> {
    check_times(py, options, &found.read_as)?;
    if options.axes.is_some() || options.most_skipped.is_some() {
        return Err(refused(
            "axes, skip_rows: they are for records, and this is a trajectory; leave them out, or give kind=\"record\"",
        ));
    }
    let has_rates = found.bodies.iter().any(|(_, rows)| rows.rates.is_some());
    if let Some(unit) = options.rate_unit.filter(|_| !has_rates) {
        return Err(refused(format!(
            "rate_unit: '{unit}'; it is for an angular velocity, and none is read; leave it out"
        )));
    }
    let mut remark = found.remark();
    let trajectory::FoundTrajectory { bodies, claims, counts_steps, comments, second_attitude, .. } = found;
    let second_attitude = if options.columns.name_quantities() { Vec::new() } else { second_attitude };
    let file = rows.name();
    let several = bodies.len() > 1;
    let one = |(id, rows): (Option<String>, audit::Trajectory)| {
        let trajectory = Trajectory {
            file: file.clone(),
            id: id.filter(|_| several),
            rows,
            claims,
            counts_steps,
            remark: remark.take(),
            second_attitude: second_attitude.clone(),
            comments: comments.clone(),
        };
        Bound::new(py, trajectory)
    };
    let mut all: Vec<Bound<'py, Trajectory>> = bodies.into_iter().map(one).collect::<PyResult<_>>()?;
    match all.pop() {
        Some(only) if !several => Ok(only.into_any()),
        last => {
            let named = PyDict::new(py);
            for trajectory in all.into_iter().chain(last) {
                let id = trajectory.get().id.clone();
                named.set_item(id, trajectory)?;
            }
            Ok(named.into_any())
        }
    }
}
