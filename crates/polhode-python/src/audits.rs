//! Is a rotation right?

use polhode::audit::{
    self, Angles, Attitudes, Convention, Direction, Frame, Noise, QuaternionOrder, Question, Turns,
    step_length,
};
use polhode::rotation::EulerSequence;
use polhode::units::AngleUnit;
use polhode_files::text::short;
use polhode_pages::verdict::{Adviser, Outcome, json, object, panels, text};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;

use crate::arrays::{Numbers, array};
use crate::bodies::Body;
use crate::calm::aside;
use crate::error::{keywords, of, refused};
use crate::json::python;
use crate::scalars::number;
use crate::shown;
use crate::tables::Trajectory;
use crate::units::named_rate;

/// A verdict on a trajectory. Printed, it is the report of `polhode audit`; its attributes are the fields of the command's JSON:
///
/// `verdict` ("right", "wrong" or "undecided"), `suspect`, `reading` (the convention, a dict), `ties`, `ranking`, `rows`, `energy_error`,
/// `momentum_error` and `momentum_vector_error` (relative), `attitude_error` (rad), `flips`, `flips_exact`, `conservation`, `motion`,
/// `integrator`, `other_body`, `other_torque`, `other_wheel`, `advice`, `resolution`, `body`, `warnings`.
#[pyclass(frozen, module = "polhode", name = "Verdict")]
pub(crate) struct Verdict {
    name: String,
    outcome: Outcome,
    answer: Value,
}

#[pymethods]
impl Verdict {
    /// Whether the record is right.
    #[getter]
    fn is_right(&self) -> bool {
        self.outcome.is_right()
    }

    /// Errors at rows of the record, at most some 2000: arrays `t`, `energy`, `momentum_norm`, `momentum_direction`, `attitude`.
    #[getter]
    fn traces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let traces = &self.outcome.verdict.traces;
        let found = PyDict::new(py);
        for (name, values) in [
            ("t", &traces.times),
            ("energy", &traces.energy),
            ("momentum_norm", &traces.momentum_norm),
            ("momentum_direction", &traces.momentum_direction),
            ("attitude", &traces.attitude),
        ] {
            found.set_item(name, array(py, values.clone(), &[values.len()])?)?;
        }
        Ok(found)
    }

    /// All fields as a dict.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &self.answer)
    }

    /// All fields as the JSON that the command writes.
    fn to_json(&self) -> String {
        json(std::slice::from_ref(&self.outcome))
    }

    fn __getattr__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        match self.answer.get(name) {
            Some(value) => python(py, value),
            None => Err(PyAttributeError::new_err(format!("a verdict has no '{name}'"))),
        }
    }

    fn __dir__(&self) -> Vec<String> {
        let own = ["is_right", "traces", "to_dict", "to_json"].map(String::from);
        let names = self.answer.as_object().map(|all| all.keys().cloned().collect::<Vec<_>>());
        own.into_iter().chain(names.unwrap_or_default()).collect()
    }

    fn __repr__(&self) -> String {
        keywords(text(&self.name, std::slice::from_ref(&self.outcome)).trim_end())
    }

    /// The report with the figure of the errors.
    fn _repr_html_(&self) -> String {
        let drawing = panels(&self.name, std::slice::from_ref(&self.outcome));
        shown::page(&self.__repr__(), &drawing.svg)
    }
}

/// The verdict on a trajectory: whether it is right, in which convention it is written, and how large its error is.
///
/// - `t`: times, s; or, in place of `t`, `attitude`, `omega` and `momentum`, a `Trajectory` of `read`.
/// - `attitude`: quaternions (n, 4), matrices (n, 3, 3) or a scipy rotation. With `form` "euler" or "rodrigues": Euler angles or modified
///   Rodrigues parameters (n, 3).
/// - `omega`: angular velocities (n, 3); `momentum`: angular momenta (n, 3).
/// - `moments`, `inertia` or `body`: the principal moments in the order of the body axes, the tensor, or a body with its forces. Without any
///   of them the moments are fitted, up to a factor. `any_order`: the moments may belong to the axes in any order.
/// - `tolerance`: largest error of a record that is right, rad and relative.
/// - `noise`: standard deviation of the attitudes, rad, or a pair with that of the angular velocities, rad/s; 0 where the record has none.
/// - `order` ("wxyz", "xyzw"), `direction` ("body-to-space", "space-to-body"), `omega_frame` and `momentum_frame` ("body", "space"),
///   `rate_unit` ("rad/s", "deg/s", "rpm"), `euler` (as "zyx" or "zyx:extrinsic") and `angle_unit` ("rad", "deg") state a convention; what
///   is not stated is found from the rows. A record that contradicts a stated convention is wrong. A convention of columns that the record
///   does not have is refused. Columns that name the scalar of a quaternion are read by their names, whatever `order` is. Columns that
///   are called roll, pitch and yaw are the angles about x, y and z.
/// - `advice`: if the integrator is what is wrong, search for a method and a step that are accurate enough, for at most two seconds.
///
/// >>> import numpy, polhode
/// >>> t = numpy.arange(400) * 0.05
/// >>> run = polhode.run("rk4", [1, 2, 3], [0.4, 1, -0.3], times=t, step=0.05)
/// >>> polhode.audit(t, run.attitude, run.omega, moments=[1, 2, 3]).verdict
/// 'right'
/// >>> polhode.audit(t, run.attitude, run.omega, moments=[1, 3, 2]).suspect
/// 'moments-order'
#[pyfunction(name = "audit")]
#[pyo3(signature = (t, attitude = None, omega = None, *, momentum = None, moments = None, inertia = None, body = None,
                    tolerance = 1e-6, noise = None, order = None, direction = None, omega_frame = None, momentum_frame = None,
                    rate_unit = None, euler = None, angle_unit = None, form = None, any_order = false, advice = true))]
#[allow(clippy::too_many_arguments, reason = "they are keywords")]
pub(crate) fn verdict_on(
    py: Python<'_>,
    t: &Bound<'_, PyAny>,
    attitude: Option<&Bound<'_, PyAny>>,
    omega: Option<&Bound<'_, PyAny>>,
    momentum: Option<&Bound<'_, PyAny>>,
    moments: Option<&Bound<'_, PyAny>>,
    inertia: Option<&Bound<'_, PyAny>>,
    body: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = number::tolerance)] tolerance: f64,
    noise: Option<&Bound<'_, PyAny>>,
    order: Option<&str>,
    direction: Option<&str>,
    omega_frame: Option<&str>,
    momentum_frame: Option<&str>,
    rate_unit: Option<&str>,
    euler: Option<&str>,
    angle_unit: Option<&str>,
    form: Option<&str>,
    any_order: bool,
    advice: bool,
) -> PyResult<Verdict> {
    let body = match (moments, inertia, body) {
        (None, None, None) => None,
        (Some(moments), None, None) => {
            let moments = Numbers::of("moments", moments)?.fixed()?;
            let inertia = polhode::Inertia::from_moments(moments).map_err(of("moments"))?;
            Some(Body::from(inertia))
        }
        (None, Some(inertia), None) => Some(Body::of("inertia", inertia)?),
        (None, None, Some(body)) => Some(Body::of("body", body)?),
        _ => return Err(refused("moments, inertia, body: give one of them")),
    };
    let mut record = Given::of(t, attitude, omega, momentum, form)?;
    let rows = &record.rows;
    let has_quaternions = matches!(rows.attitude, Some(Attitudes::Quaternions(_)));
    let has_angles = matches!(rows.attitude, Some(Attitudes::Angles(_)));
    for (name, found, is_used, what) in [
        ("order", order, has_quaternions, "a quaternion"),
        ("direction", direction, rows.attitude.is_some(), "an attitude"),
        ("euler", euler, has_angles, "a triple of Euler angles"),
        ("angle_unit", angle_unit, has_angles, "a triple of Euler angles"),
        ("momentum_frame", momentum_frame, rows.momentum.is_some(), "an angular momentum"),
        ("omega_frame", omega_frame, rows.rates.is_some(), "an angular velocity"),
        ("rate_unit", rate_unit, rows.rates.is_some(), "an angular velocity"),
    ] {
        if let Some(found) = found.filter(|_| !is_used) {
            return Err(refused(format!(
                "{name}: '{found}'; it is for {what}, and the record has none; leave it out"
            )));
        }
    }
    let claims = &mut record.claims;
    let one_of =
        |name: &str, found: &str, known: &str| refused(format!("{name}: '{found}'; it must be {known}"));
    if let Some(order) = order {
        let found = match order {
            "wxyz" => QuaternionOrder::ScalarFirst,
            "xyzw" => QuaternionOrder::ScalarLast,
            _ => return Err(one_of("order", order, "'wxyz' or 'xyzw'")),
        };
        // columns that are named w, x, y and z are read by their names, and scipy's rotations are scalar last
        claims.quaternion = claims.quaternion.or(Some(found));
    }
    if let Some(direction) = direction {
        claims.attitude = Some(match direction {
            "body-to-space" => Direction::BodyToSpace,
            "space-to-body" => Direction::SpaceToBody,
            _ => return Err(one_of("direction", direction, "'body-to-space' or 'space-to-body'")),
        });
    }
    let frame = |name: &str, text: &str| match text {
        "body" => Ok(Frame::Body),
        "space" => Ok(Frame::Space),
        _ => Err(one_of(name, text, "'body' or 'space'")),
    };
    if let Some(text) = omega_frame {
        claims.omega_frame = Some(frame("omega_frame", text)?);
    }
    if let Some(text) = momentum_frame {
        claims.momentum_frame = Some(frame("momentum_frame", text)?);
    }
    if let Some(unit) = rate_unit {
        claims.rate_unit = Some(named_rate(unit)?);
    }
    if let Some(unit) = angle_unit {
        let found = AngleUnit::named(unit).ok_or_else(|| one_of("angle_unit", unit, "'rad' or 'deg'"))?;
        if let Some(named) = claims.angle_unit.filter(|named| *named != found) {
            return Err(refused(format!(
                "angle_unit: '{unit}'; the header says {named}; drop one of the two"
            )));
        }
        claims.angle_unit = Some(found);
    }
    if let Some(text) = euler {
        let (sequence, turns) = match text.split_once(':') {
            None | Some((_, "intrinsic")) => (text.split(':').next().unwrap_or(text), Turns::Intrinsic),
            Some((sequence, "extrinsic")) => (sequence, Turns::Extrinsic),
            Some(_) => return Err(one_of("euler", text, "a sequence, as 'zyx' or 'zyx:extrinsic'")),
        };
        let sequence: EulerSequence = sequence.parse().map_err(of("euler"))?;
        if claims.angle_axes.is_some() {
            let axes = sequence.axes();
            if axes[0] == axes[2] {
                return Err(refused(format!(
                    "euler: '{text}'; it turns about one axis twice, while roll, pitch and yaw are angles about x, y and z; \
                     state a sequence of the three, as zyx, or name the columns by columns of read"
                )));
            }
            if let Some(Attitudes::Angles(angles)) = &mut record.rows.attitude {
                angles.iter_mut().for_each(|row| *row = axes.map(|axis| row[axis]));
            }
            claims.angle_axes = Some(axes);
        }
        claims.angles =
            Some(Angles { sequence, turns, unit: claims.angle_unit.unwrap_or(AngleUnit::Radians) });
    }
    if any_order {
        if body.as_ref().is_none_or(|body| !body.body.wheels().is_empty()) {
            return Err(refused("any_order: needs the moments of a body without wheels"));
        }
        claims.moments = None;
    }
    let noise = match Numbers::maybe("noise", noise)? {
        None => Noise::default(),
        Some(noise) => match (noise.shape.as_slice(), noise.values.as_slice()) {
            ([] | [1], &[attitude]) => Noise { attitude, rates: 0.0 },
            ([2], &[attitude, rates]) => Noise { attitude, rates },
            _ => return Err(noise.unexpected("() or (2,)")),
        },
    };
    let mut notes = Vec::new();
    if record.counts_steps {
        let Some(step) = step_length(&record.rows, body.as_ref().map(|body| &body.body)) else {
            return Err(refused(format!(
                "{}: counts steps of unknown length; give the length of a step, s, as time_unit of read",
                record.name
            )));
        };
        record.rows.times.iter_mut().for_each(|t| *t *= step);
        notes.push(format!(
            "the record counts steps; from the turning of the body they are taken to be {} s long; give their length by time_unit of read",
            short(step)
        ));
    }
    notes.extend(record.remark.take());
    let mut question = Question::new(body.as_ref().map(|body| body.body.clone()));
    (question.tolerance, question.claims, question.noise) = (tolerance, record.claims, noise);
    let Given { name, id, rows, .. } = record;
    let found = aside(py, move |_| {
        let adviser = Adviser::new();
        let verdict = audit::audit(&rows, &question)?;
        Ok::<_, audit::AuditError>(Outcome {
            body: id,
            rows: rows.times.len(),
            form: rows.attitude.as_ref().map(Attitudes::name),
            advice: if advice { adviser.advice(&rows, &verdict, tolerance) } else { None },
            verdict,
            against: None,
            notes,
        })
    })?;
    let found = found.map_err(refused);
    let outcome = match &body {
        Some(body) => body.settle(found)?,
        None => found?,
    };
    Ok(Verdict { answer: object(&outcome), name, outcome })
}

/// A record as it was given.
struct Given {
    name: String,
    id: Option<String>,
    rows: audit::Trajectory,
    claims: Convention,
    counts_steps: bool,
    remark: Option<String>,
}

impl Given {
    fn of(
        t: &Bound<'_, PyAny>,
        attitude: Option<&Bound<'_, PyAny>>,
        omega: Option<&Bound<'_, PyAny>>,
        momentum: Option<&Bound<'_, PyAny>>,
        form: Option<&str>,
    ) -> PyResult<Self> {
        if let Ok(read) = t.cast::<Trajectory>() {
            if attitude.is_some() || omega.is_some() || momentum.is_some() || form.is_some() {
                return Err(refused(
                    "attitude, omega, momentum, form: the trajectory has its own; leave them out",
                ));
            }
            let Trajectory { file, id, rows, claims, counts_steps, remark, second_attitude, .. } = read.get();
            if !second_attitude.is_empty() {
                return Err(refused(format!(
                    "{file}: the columns {} hold another attitude, which is not read; name those of one body by columns of read",
                    second_attitude.join(", ")
                )));
            }
            let (name, id, rows) = (file.clone(), id.clone(), rows.clone());
            return Ok(Given {
                name,
                id,
                rows,
                claims: *claims,
                counts_steps: *counts_steps,
                remark: remark.clone(),
            });
        }
        let is_rotation = attitude.map(|attitude| attitude.hasattr("as_quat")).transpose()?;
        if let (Some(form), None | Some(true)) = (form, is_rotation) {
            return Err(refused(format!(
                "form: '{form}'; it is the form of attitudes, and there are none; leave it out"
            )));
        }
        let mut claims = Convention::default();
        let mut rows = audit::Trajectory::new(Numbers::of("t", t)?.list()?);
        let n = Some(rows.times.len());
        if let Some(attitude) = attitude {
            rows = rows.with_attitude(attitudes(attitude, n, form, &mut claims)?);
        }
        if let Some(omega) = omega {
            rows = rows.with_rates(Numbers::of("omega", omega)?.rows(n)?);
        }
        if let Some(momentum) = momentum {
            rows = rows.with_momentum(Numbers::of("momentum", momentum)?.rows(n)?);
        }
        Ok(Given { name: "record".into(), id: None, rows, claims, counts_steps: false, remark: None })
    }
}

fn attitudes(
    value: &Bound<'_, PyAny>,
    n: Option<usize>,
    form: Option<&str>,
    claims: &mut Convention,
) -> PyResult<Attitudes> {
    if value.hasattr("as_quat")? {
        claims.quaternion = Some(QuaternionOrder::ScalarLast);
        let written = value.call_method0("as_quat")?;
        return Numbers::of("attitude", &written)?.rows(n).map(Attitudes::Quaternions);
    }
    let mut numbers = Numbers::of("attitude", value)?;
    if let &[rows, 3, 3] = numbers.shape.as_slice() {
        numbers.shape = vec![rows, 9];
    }
    match (form, numbers.shape.as_slice()) {
        (None | Some("matrix"), [_, 9]) => numbers.rows(n).map(Attitudes::Matrices),
        (None | Some("quaternion"), [_, 4]) => numbers.rows(n).map(Attitudes::Quaternions),
        (Some("euler"), _) => numbers.rows(n).map(Attitudes::Angles),
        (Some("rodrigues"), _) => numbers.rows(n).map(Attitudes::Rodrigues),
        (None, [_, 3]) => {
            Err(refused("form: missing; three numbers a row are 'euler' angles or 'rodrigues' parameters"))
        }
        (None, _) => Err(numbers.unexpected("(n, 4), (n, 3, 3), or (n, 3) with form")),
        (Some("matrix"), _) => Err(numbers.unexpected("(n, 3, 3)")),
        (Some("quaternion"), _) => Err(numbers.unexpected("(n, 4)")),
        (Some(other), _) => Err(refused(format!(
            "form: '{other}'; it must be 'quaternion', 'matrix', 'euler' or 'rodrigues'"
        ))),
    }
}
