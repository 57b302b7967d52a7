//! Every file that the command reads: models, bodies, meshes, trajectories, records and times.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use polhode::inertia;
use polhode_files::error::hearing;
use polhode_files::examined::Examined;
use polhode_files::given::Given;
use polhode_files::instant::{self, Epoch};
use polhode_files::mesh::MeshOptions;
use polhode_files::robots::{self, Language};
use polhode_files::times::{Asked, Source, TimesColumn};
use polhode_files::{ColumnNames, Error, ReadOptions, SignedAxes, bodies, given, trajectory, twins};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::arrays::array;
use crate::calm::aside;
use crate::columns;
use crate::error::{of, refused, warn};
use crate::links::{Link, Links};
use crate::masses::{MassProperties, amount, closing};
use crate::scalars::maybe;
use crate::tables::{Rows, record_of, trajectories};
use crate::units::{named_length, named_rate, named_time, positive, share};

/// What `work` finds while Ctrl-C is listened for; its remarks are Python warnings.
pub(crate) fn heard<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let (found, remarks) = aside(py, move |_| hearing(work))?;
    remarks.iter().try_for_each(|remark| warn(py, remark))?;
    found.map_err(refused)
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

/// Reads a file, by its ending or as the `kind` that is given; or a table in memory: a data frame, a structured array or a dict of columns,
/// whose columns are found by their names, as in a file.
///
/// | file | result |
/// |---|---|
/// | `.urdf`, `.mjcf`, `.sdf`, `.xml`: a robot model | `Links`, each examined; `read("robot.urdf")["forearm"]` |
/// | `.json` that `polhode inertia` wrote | `Links` |
/// | `.toml`: a list of parts | `MassProperties` |
/// | `.stl`, `.obj`, `.ply`: a mesh, with `mass` or `density` | `MassProperties` |
/// | a table (CSV, npy, LAMMPS dump, messages of ROS, ...) with attitudes or angular momenta, `kind="trajectory"` | `Trajectory`, or a dict of them by the name of the body |
/// | a table of angular velocities, `kind="record"` | `Record` |
/// | `kind="times"` | array of times, s; dates are counted from the date `epoch` |
///
/// - Tables: `columns` names columns, as `"t=clock,wx=gx,wy=gy,wz=gz"`. `time_unit` ("s", "ms", "us", "ns", or a number of seconds) and
///   `rate_unit` ("rad/s", "deg/s", "rpm") are used where the header names none. `sample_rate`, Hz, is for tables that count samples.
/// - Records: `axes`, as "x,-y,z", renames and reverses columns of rates; `skip_rows` is the share of rows that may be left out as unreadable.
/// - Meshes: `length_unit` ("mm", "cm", "m", "in", or metres); `close`, "fan" or "hull", closes holes; `shell`, the thickness of walls, m, is
///   for a hollow body; `weld` merges vertices that are nearer than this share of the size; `group` takes one group of an OBJ file.
/// - MJCF: `root`, the folder within which its includes must lie.
///
/// An argument that is not for this kind of file is refused.
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
                    group = None, root = None, epoch = None))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn read<'py>(
    py: Python<'py>,
    path: &Bound<'py, PyAny>,
    kind: Option<&str>,
    columns: Option<&str>,
    time_unit: Option<&Bound<'py, PyAny>>,
    rate_unit: Option<&str>,
    #[pyo3(from_py_with = maybe::sample_rate)] sample_rate: Option<f64>,
    axes: Option<&str>,
    #[pyo3(from_py_with = maybe::skip_rows)] skip_rows: Option<f64>,
    #[pyo3(from_py_with = maybe::mass)] mass: Option<f64>,
    #[pyo3(from_py_with = maybe::density)] density: Option<f64>,
    length_unit: Option<&Bound<'py, PyAny>>,
    close: Option<&str>,
    #[pyo3(from_py_with = maybe::shell)] shell: Option<f64>,
    #[pyo3(from_py_with = maybe::weld)] weld: Option<f64>,
    group: Option<String>,
    root: Option<PathBuf>,
    epoch: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    let (rows, kind) = match columns::text(path)? {
        Some(text) => (Rows::Text(text), Kind::of(kind, Path::new(""))?),
        None => {
            let kind_of = path.get_type().name()?;
            let path: PathBuf = path.extract().map_err(|error: PyErr| match error.is_instance_of::<PyTypeError>(py) {
                true => refused(format!(
                    "path: a {kind_of}; it must be a path, a data frame, a structured array or a dict of columns"
                )),
                false => error,
            })?;
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
    let rows = Arc::new(rows);
    let about_meshes = [
        mass.is_some(),
        density.is_some(),
        length_unit.is_some(),
        close.is_some(),
        shell.is_some(),
        weld.is_some(),
        group.is_some(),
    ];
    if kind != Kind::Mesh && about_meshes.contains(&true) {
        return Err(refused(
            "mass, density, length_unit, close, shell, weld, group: they are for meshes; leave them out",
        ));
    }
    if close.is_some() && shell.is_some() {
        return Err(refused("close, shell: walls need no closed surface; give one of the two"));
    }
    if root.is_some() && !matches!(kind, Kind::Model(_)) {
        return Err(refused("root: it is the folder of the includes of a model; leave it out"));
    }
    if epoch.is_some() && kind != Kind::Times {
        return Err(refused("epoch: it is the date of t = 0 of times; leave it out, or give kind=\"times\""));
    }
    let epoch = epoch.map(|text| instant::date(text).map(|date| Epoch::new(date, None))).transpose();
    let epoch = epoch.map_err(of("epoch"))?;
    let is_table = matches!(kind, Kind::Trajectory | Kind::Record | Kind::Table);
    let about_tables = [
        columns.is_some() && kind != Kind::Times,
        time_unit.is_some(),
        rate_unit.is_some(),
        sample_rate.is_some(),
        axes.is_some(),
        skip_rows.is_some(),
    ];
    if !is_table && about_tables.contains(&true) {
        return Err(refused(
            "columns, time_unit, rate_unit, sample_rate, axes, skip_rows: they are for trajectories and records; leave them out",
        ));
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
            let found = heard(py, move || {
                let text = polhode_files::read(&path, "name a URDF, MJCF or SDF file")?;
                let language = language.unwrap_or_else(|| bodies::language("xml", &text));
                robots::read(language, &path, &text, root.as_deref())
            })?;
            links(py, twins::paired(found))
        }
        Kind::Json => {
            let found =
                heard(py, move || given::from_json(&path, &polhode_files::read(&path, "name a JSON file")?))?;
            links(py, found)
        }
        Kind::Parts => {
            let found = heard(py, move || bodies::parts(&path))?;
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
            let found = heard(py, move || options.body(&path, amount))?;
            mass_properties(py, found)
        }
        Kind::Record => record_of(py, &rows, &table()?),
        Kind::Trajectory => {
            let options = table()?;
            let (own, asked) = (Arc::clone(&rows), options.clone());
            let found = heard(py, move || own.trajectory(&asked))?;
            trajectories(py, &rows, &options, found)
        }
        Kind::Times => {
            let source = TimesColumn {
                source: Source::File(path),
                wanted: columns.map(String::from),
                epoch,
                asked: Asked { file: "path".into(), column: "columns" },
            };
            let found = heard(py, move || source.read()?.collect::<Result<Vec<f64>, Error>>())?;
            let n = found.len();
            array(py, found, &[n])
        }
        Kind::Table => {
            let options = table()?;
            let (own, asked) = (Arc::clone(&rows), options.clone());
            let found = aside(py, move |_| hearing(|| own.trajectory(&asked)))?;
            let is_trajectory = |found: &trajectory::FoundTrajectory| {
                found.bodies.iter().any(|(_, rows)| rows.attitude.is_some() || rows.momentum.is_some())
            };
            match found {
                (Ok(found), remarks) if is_trajectory(&found) => {
                    remarks.iter().try_for_each(|remark| warn(py, remark))?;
                    trajectories(py, &rows, &options, found)
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
