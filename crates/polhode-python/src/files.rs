//! Every file that the command reads: models, bodies, meshes, trajectories, records and times.

use std::path::{Path, PathBuf};

use polhode::audit::{self, Attitudes, Convention};
use polhode::units::TimeUnit;
use polhode::{inertia, record};
use polhode_files::error::hearing;
use polhode_files::examined::Examined;
use polhode_files::given::Given;
use polhode_files::mesh::{MeshOptions, length_unit};
use polhode_files::robots::{self, Language};
use polhode_files::times::{Asked, Source, TimesColumn};
use polhode_files::{ColumnNames, Error, ReadOptions, SignedAxes, bodies, given, trajectory, twins};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::arrays::array;
use crate::columns;
use crate::error::{refused, warn};
use crate::masses::{Link, Links, MassProperties, amount, closing};

/// What `work` finds without the interpreter; its remarks are Python warnings.
pub(crate) fn heard<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T, Error> + Send) -> PyResult<T> {
    let (found, remarks) = py.detach(|| hearing(work));
    remarks.iter().try_for_each(|remark| warn(py, remark))?;
    found.map_err(refused)
}

/// Where the rows of a table come from.
enum Rows {
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

    fn trajectory(&self, options: &ReadOptions) -> Result<trajectory::FoundTrajectory, Error> {
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

/// A trajectory of a file, with what its names claim of the convention: for `audit`.
#[pyclass(frozen, module = "polhode")]
pub(crate) struct Trajectory {
    pub(crate) file: String,
    pub(crate) id: Option<String>,
    pub(crate) rows: audit::Trajectory,
    pub(crate) claims: Convention,
    pub(crate) counts_steps: bool,
    /// Of the file, with its first body.
    pub(crate) remark: Option<String>,
    comments: Vec<String>,
}

#[pymethods]
impl Trajectory {
    /// Name of the body, where the file has several.
    #[getter]
    fn id(&self) -> Option<&str> {
        self.id.as_deref()
    }

    /// Times, s, or counts of steps where the file tells no step.
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

    /// Lines above the header that begin with #, without that.
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

/// A record of measured angular velocities, in segments without gaps: for `fit`.
#[pyclass(frozen, module = "polhode", from_py_object)]
#[derive(Clone)]
pub(crate) struct Record(pub(crate) record::Record);

#[pymethods]
impl Record {
    /// Number of segments without gaps.
    #[getter]
    fn segments(&self) -> usize {
        self.0.segments.len()
    }

    /// Times of all segments, s.
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let times: Vec<f64> = self.0.segments.iter().flat_map(|segment| segment.times()).copied().collect();
        let n = times.len();
        array(py, times, &[n])
    }

    /// Angular velocities of all segments in sensor axes, rad/s: (n, 3).
    #[getter]
    fn rates<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rates = self.0.segments.iter().flat_map(|segment| segment.rates());
        let rates: Vec<f64> = rates.flat_map(|rate| rate.iter().copied().collect::<Vec<_>>()).collect();
        let n = rates.len() / 3;
        array(py, rates, &[n, 3])
    }

    fn __len__(&self) -> usize {
        self.0.samples()
    }

    fn __repr__(&self) -> String {
        let segments = self.0.segments.len();
        format!(
            "Record({} samples in {segments} segment{})",
            self.0.samples(),
            if segments == 1 { "" } else { "s" }
        )
    }
}

/// What is read of a file, which its ending tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Model(Option<Language>),
    Parts,
    Json,
    Mesh,
    Trajectory,
    Record,
    Times,
    /// A trajectory, where the file has attitudes or momenta, else a record.
    Table,
}

impl Kind {
    fn of(kind: Option<&str>, path: &Path) -> PyResult<Self> {
        let ending =
            path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        Ok(match (kind, ending.as_str()) {
            (Some("trajectory"), _) => Kind::Trajectory,
            (Some("record"), _) => Kind::Record,
            (Some("times"), _) => Kind::Times,
            (Some(kind @ ("urdf" | "mjcf" | "sdf")), _) | (None, kind @ ("urdf" | "mjcf" | "sdf")) => {
                Kind::Model(Language::named(kind))
            }
            (Some("parts"), _) | (None, "toml") => Kind::Parts,
            (Some("json"), _) | (None, "json") => Kind::Json,
            (Some("mesh"), _) | (None, "stl" | "obj" | "ply") => Kind::Mesh,
            (None, "xml") => Kind::Model(None),
            (None, _) => Kind::Table,
            (Some(other), _) => {
                return Err(refused(format!(
                    "kind: '{other}'; it must be trajectory, record, times, urdf, mjcf, sdf, parts, json or mesh"
                )));
            }
        })
    }
}

/// What a file holds, by its ending or by `kind`; or a table in memory: a data frame, a structured array or a dict of columns, read by the
/// names of its columns as a file is.
///
/// | file | result |
/// |---|---|
/// | `.urdf`, `.mjcf`, `.sdf`, `.xml`: a robot model | `Links`, each examined; `read("robot.urdf")["forearm"]` |
/// | `.json` that `polhode inertia` wrote | `Links` |
/// | `.toml`: a list of parts | `MassProperties` |
/// | `.stl`, `.obj`, `.ply`: a mesh, with `mass` or `density` | `MassProperties` |
/// | a table (CSV, npy, LAMMPS dump, messages of ROS, ...) with attitudes or angular momenta, `kind="trajectory"` | `Trajectory`, or a dict of them by the name of the body |
/// | a table of angular velocities, `kind="record"` | `Record` |
/// | `kind="times"` | array of times, s |
///
/// Of tables: `columns` names columns as `"t=clock,wx=gx,wy=gy,wz=gz"`; `time_unit` (`s`, `ms`, `us`, `ns`, or seconds) and `rate_unit`
/// (`rad/s`, `deg/s`, `rpm`) hold where the header names none; `sample_rate`, Hz, where a column counts samples; `axes` as `"x,-y,z"` and
/// `skip_rows`, the share of rows of a record that may be left out. Of meshes: `length_unit` (`mm`, `m`, ...), `close` (`fan`, `hull`),
/// `shell` (thickness of walls, m), `weld`, `group`. Of MJCF: `root`, the folder of its includes.
///
/// >>> import os, polhode, tempfile
/// >>> path = os.path.join(tempfile.mkdtemp(), "record.csv")
/// >>> with open(path, "w") as file:
/// ...     _ = file.write("t,wx,wy,wz\n0,0.4,1,-0.3\n0.1,0.41,0.99,-0.28\n")
/// >>> polhode.read(path)
/// Record(2 samples in 1 segment)
#[pyfunction]
#[pyo3(signature = (path, *, kind = None, columns = None, time_unit = None, rate_unit = None, sample_rate = None, axes = None,
                    skip_rows = None, mass = None, density = None, length_unit = None, close = None, shell = None, weld = None,
                    group = None, root = None))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn read<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    kind: Option<&str>,
    columns: Option<&str>,
    time_unit: Option<&Bound<'py, PyAny>>,
    rate_unit: Option<&str>,
    sample_rate: Option<f64>,
    axes: Option<&str>,
    skip_rows: Option<f64>,
    mass: Option<f64>,
    density: Option<f64>,
    length_unit: Option<&Bound<'py, PyAny>>,
    close: Option<&str>,
    shell: Option<f64>,
    weld: Option<f64>,
    group: Option<String>,
    root: Option<PathBuf>,
) -> PyResult<Bound<'py, PyAny>> {
    let (rows, kind) = match columns::text(path)? {
        Some(text) => (Rows::Text(text), Kind::of(kind, Path::new(""))?),
        None => {
            let path: PathBuf = path.extract()?;
            // a file of that name, not standard input
            let path = if path.as_os_str() == "-" { PathBuf::from("./-") } else { path };
            let kind = Kind::of(kind, &path)?;
            (Rows::File(path), kind)
        }
    };
    let path = match &rows {
        Rows::File(path) => path.clone(),
        Rows::Text(_) if matches!(kind, Kind::Trajectory | Kind::Record | Kind::Table) => PathBuf::new(),
        Rows::Text(_) => return Err(refused("kind: columns in memory are a trajectory or a record")),
    };
    let about_meshes =
        [mass.is_some(), density.is_some(), length_unit.is_some(), close.is_some(), shell.is_some()];
    if kind != Kind::Mesh && about_meshes.contains(&true) {
        return Err(refused("mass, density, length_unit, close, shell: they are for meshes; leave them out"));
    }
    let table = || -> PyResult<ReadOptions> {
        Ok(ReadOptions::default()
            .with_columns(columns.map_or(Ok(ColumnNames::default()), |text| {
                ColumnNames::parse(text).map_err(|error| refused(format!("columns: {error}")))
            })?)
            .with_time_unit(time_unit.map(named_time).transpose()?)
            .with_rate_unit(rate_unit.map(named_rate).transpose()?)
            .with_sample_rate(sample_rate.map(|rate| positive("sample_rate", rate)).transpose()?)
            .with_most_skipped(skip_rows.map(share).transpose()?)
            .with_axes(
                axes.map(SignedAxes::parse).transpose().map_err(|error| refused(format!("axes: {error}")))?,
            ))
    };
    match kind {
        Kind::Model(language) => {
            let found = heard(py, || {
                let text = polhode_files::read(&path, "name a URDF, MJCF or SDF file")?;
                let language = language.unwrap_or_else(|| bodies::language("xml", &text));
                robots::read(language, &path, &text, root.as_deref())
            })?;
            links(py, twins::paired(found))
        }
        Kind::Json => {
            let found =
                heard(py, || given::from_json(&path, &polhode_files::read(&path, "name a JSON file")?))?;
            links(py, found)
        }
        Kind::Parts => {
            let found = heard(py, || bodies::parts(&path))?;
            mass_properties(py, found)
        }
        Kind::Mesh => {
            let (amount, close) = (amount(mass, density)?, closing(close)?);
            let unit = length_unit.map(named_length).transpose()?;
            let options = MeshOptions::default()
                .with_length_unit(unit)
                .with_closing(close)
                .with_shell(shell.map(|shell| positive("shell", shell)).transpose()?)
                .with_weld(weld.map(|weld| positive("weld", weld)).transpose()?)
                .with_group(group);
            let found = heard(py, || options.body(&path, amount))?;
            mass_properties(py, found)
        }
        Kind::Record => record_of(py, &rows, &table()?),
        Kind::Trajectory => {
            let options = table()?;
            let found = heard(py, || rows.trajectory(&options))?;
            trajectories(py, &rows, found)
        }
        Kind::Times => {
            let source = TimesColumn {
                source: Source::File(path),
                wanted: columns.map(String::from),
                epoch: None,
                asked: Asked { file: "path".into(), column: "columns" },
            };
            let found = heard(py, || source.read()?.collect::<Result<Vec<f64>, Error>>())?;
            let n = found.len();
            array(py, found, &[n])
        }
        Kind::Table => {
            let options = table()?;
            let found = py.detach(|| hearing(|| rows.trajectory(&options)));
            let is_trajectory = |found: &trajectory::FoundTrajectory| {
                found.bodies.iter().any(|(_, rows)| rows.attitude.is_some() || rows.momentum.is_some())
            };
            match found {
                (Ok(found), remarks) if is_trajectory(&found) => {
                    remarks.iter().try_for_each(|remark| warn(py, remark))?;
                    trajectories(py, &rows, found)
                }
                _ => record_of(py, &rows, &options),
            }
        }
    }
}

/// As the command has them: without what rounding leaves of a zero.
fn mass_properties(py: Python<'_>, found: inertia::MassProperties) -> PyResult<Bound<'_, PyAny>> {
    let examined = Examined::of(Given::body(found), None).map_err(refused)?;
    Ok(Bound::new(py, MassProperties(examined.body.unwrap_or(found)))?.into_any())
}

fn links(py: Python<'_>, found: Vec<Given>) -> PyResult<Bound<'_, PyAny>> {
    let found = found.into_iter().map(|given| Py::new(py, Link(Examined::link(given, None))));
    Ok(Bound::new(py, Links(found.collect::<PyResult<_>>()?))?.into_any())
}

fn record_of<'py>(py: Python<'py>, rows: &Rows, options: &ReadOptions) -> PyResult<Bound<'py, PyAny>> {
    let found = heard(py, || rows.record(options))?;
    if let Some(first) = found.skipped.first() {
        let (count, samples) = (found.skipped.len(), found.record.samples());
        warn(py, &format!("rows left out: {count}, beside {samples} that are read; the first: {first}"))?;
    }
    found.remarks.iter().try_for_each(|remark| warn(py, remark))?;
    Ok(Bound::new(py, Record(found.record))?.into_any())
}

fn trajectories<'py>(
    py: Python<'py>,
    rows: &Rows,
    found: trajectory::FoundTrajectory,
) -> PyResult<Bound<'py, PyAny>> {
    let mut remark = found.remark();
    let trajectory::FoundTrajectory { bodies, claims, counts_steps, comments, .. } = found;
    let file = rows.name();
    let one = |(id, rows)| {
        let comments = comments.clone();
        let remark = remark.take();
        Bound::new(py, Trajectory { file: file.clone(), id, rows, claims, counts_steps, remark, comments })
    };
    let several = bodies.len() > 1;
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

pub(crate) fn positive(name: &'static str, value: f64) -> PyResult<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(refused(format!("{name}: {value:?}; it must be a finite number above 0")))
    }
}

fn share(value: f64) -> PyResult<f64> {
    if (0.0..1.0).contains(&value) {
        Ok(value)
    } else {
        Err(refused(format!("skip_rows: {value:?} is no share of the rows; give a number from 0 to below 1")))
    }
}

pub(crate) fn named_rate(text: &str) -> PyResult<polhode::units::RateUnit> {
    let unknown = || refused(format!("rate_unit: '{text}'; known: rad/s, deg/s, rpm"));
    polhode::units::RateUnit::named(text).ok_or_else(unknown)
}

fn named_time(unit: &Bound<'_, PyAny>) -> PyResult<TimeUnit> {
    match unit.cast::<PyString>() {
        Ok(text) => {
            let text = text.to_string_lossy();
            let unknown = || {
                refused(format!(
                    "time_unit: '{text}'; known: s, ms, us, ns, min, h, d, or a number of seconds"
                ))
            };
            TimeUnit::named(&text).ok_or_else(unknown)
        }
        Err(_) => positive("time_unit", unit.extract()?).map(TimeUnit::Multiple),
    }
}

fn named_length(unit: &Bound<'_, PyAny>) -> PyResult<f64> {
    match unit.cast::<PyString>() {
        Ok(text) => {
            length_unit(&text.to_string_lossy()).map_err(|error| refused(format!("length_unit: {error}")))
        }
        Err(_) => positive("length_unit", unit.extract()?),
    }
}
