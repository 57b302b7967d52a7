//! Golden trajectories: files that other programs compare theirs with, and programs that do so.

use std::fmt::Write as _;
use std::path::Path;

use nalgebra::Vector3;
use polhode::body::Body;
use polhode::inertia::Inertia;
use polhode::num::Dd;
use polhode::rotation::{Quat, Vec3};
use polhode::truth::{AGREEMENT, Truth, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::output::Output;

/// A body from a start.
struct Case {
    name: &'static str,
    what: &'static str,
    moments: [f64; 3],
    /// N m, body axes; zero of a free body.
    weight_moment: [f64; 3],
    attitude: [f64; 4],
    /// rad/s, body axes.
    omega: [f64; 3],
    every: f64,
    rows: u32,
}

const FREE: Case = Case {
    name: "",
    what: "",
    moments: [1.0, 2.0, 3.0],
    weight_moment: [0.0; 3],
    attitude: [1.0, 0.0, 0.0, 0.0],
    omega: [0.0; 3],
    every: 0.125,
    rows: 160,
};

/// Free bodies of every kind, and tops.
const CASES: [Case; 7] = [
    Case { name: "free-generic", what: "free body, generic motion", omega: [0.4, 1.0, -0.3], ..FREE },
    Case {
        name: "free-flipping",
        what: "free body that turns over, near its middle axis",
        moments: [1.5, 4.0, 5.0],
        omega: [0.01, 3.0, 0.02],
        ..FREE
    },
    Case {
        name: "free-prolate",
        what: "free symmetric body, prolate",
        moments: [1.0, 3.0, 3.0],
        attitude: [0.8, 0.0, 0.6, 0.0],
        omega: [4.0, 1.0, 0.5],
        ..FREE
    },
    Case {
        name: "free-oblate",
        what: "free symmetric body, oblate, from a tilted attitude",
        moments: [2.0, 2.0, 3.5],
        attitude: [0.5, -0.5, 0.5, 0.5],
        omega: [0.7, -0.2, 2.5],
        ..FREE
    },
    Case {
        name: "top-lagrange",
        what: "symmetric top that precesses and nods",
        moments: [2.0, 2.0, 1.0],
        weight_moment: [0.0, 0.0, 3.0],
        attitude: [0.9, 0.4, 0.1, 0.0],
        omega: [0.3, -0.2, 9.0],
        ..FREE
    },
    Case {
        name: "top-pendulum",
        what: "symmetric top without spin: a spherical pendulum",
        moments: [2.0, 2.0, 1.0],
        weight_moment: [0.0, 0.0, -3.0],
        attitude: [0.8, 0.6, 0.0, 0.0],
        omega: [0.2, 0.9, 0.0],
        ..FREE
    },
    Case {
        name: "top-asymmetric",
        what: "top with three moments, weight off every axis",
        moments: [1.0, 2.0, 2.5],
        weight_moment: [0.2, 0.1, 1.0],
        attitude: [0.7, 0.5, 0.1, -0.2],
        omega: [0.5, 1.0, 2.0],
        every: 0.0625,
        rows: 96,
    },
];

/// Files that stand beside the trajectories; the first tells the folder from others.
const FILES: [(&str, &str); 3] = [
    ("README.md", include_str!("../../golden/README.md")),
    ("check.py", include_str!("../../golden/check.py")),
    ("check.c", include_str!("../../golden/check.c")),
];

/// Writes all of it into `folder`, which is made if need be.
///
/// # Errors
/// A place that cannot be written; a folder of another kind with a file of one of these names.
pub(super) fn write(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|reason| {
        let rule = format!("cannot be made: {reason}");
        Error::input("--golden", &folder.display().to_string(), &rule, "name another folder")
    })?;
    let [(readme, ours), ..] = FILES;
    let found = polhode_files::read_own(&folder.join(readme), "").unwrap_or_default();
    if ours.lines().next().is_none_or(|title| !found.starts_with(title)) {
        let trajectories = CASES.iter().map(|case| format!("{}.csv", case.name));
        let mut names = FILES.iter().map(|(name, _)| (*name).to_owned()).chain(trajectories);
        if let Some(other) = names.find(|name| folder.join(name).exists()) {
            let rule = format!("has a {other} of another kind");
            return Err(Error::input(
                "--golden",
                &folder.display().to_string(),
                &rule,
                "name an empty folder",
            ));
        }
    }
    let put = |name: &str, text: &str| Output::to_file("--golden", &folder.join(name))?.write_whole(text);
    FILES.into_iter().try_for_each(|(name, text)| put(name, text))?;
    CASES.iter().try_for_each(|case| put(&format!("{}.csv", case.name), &trajectory(case)?))
}

fn trajectory(case: &Case) -> Result<String, Error> {
    let inertia = Inertia::from_moments(case.moments).map_err(unexpected)?;
    let body = if case.weight_moment == [0.0; 3] {
        Body::free(inertia)
    } else {
        Body::heavy(inertia, Vector3::from(case.weight_moment)).map_err(unexpected)?
    };
    let attitude = Quat::from_components(case.attitude);
    let start = body.enter_omega(attitude, Vec3(case.omega)).map_err(unexpected)?;
    let times = evenly(case.every * f64::from(case.rows), case.rows);
    let truth = Truth::from_point(&body, start.to_f64(), 0.0, &times, AGREEMENT).map_err(unexpected)?;
    if truth.times().count() != times.len() {
        return Err(Error::Failed(format!("{}: the motion is not known to its end", case.name)));
    }
    let listed = |values: [f64; 3]| values.map(|x| format!("{x:?}")).join(",");
    let mut text = format!(
        "# golden trajectory of polhode: {}\n# moments: {}\n# weight-moment: {}\n\
         # attitude: quaternion, scalar first, Hamilton, body to space; omega: body axes, rad/s; start: the first row\n\
         t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z\n",
        case.what,
        listed(case.moments),
        listed(case.weight_moment)
    );
    let mut before: Option<Quat<f64>> = None;
    for row in 0..=case.rows {
        let t = case.every * f64::from(row);
        let state = body.leave(&truth.point_at(Dd::from(t)).map_err(unexpected)?);
        let q = state.attitude;
        // q and -q are one attitude; programs that interpolate want neighbours of one sign
        let turned = before.is_some_and(|b| {
            q.components().iter().zip(b.components()).map(|(x, y)| x * y).sum::<f64>() < 0.0
        });
        let q = if turned { q * -1.0 } else { q };
        before = Some(q);
        let omega: [f64; 3] = body.omega_body(&state).into();
        let cells = [t].into_iter().chain(q.components()).chain(omega);
        let cells: Vec<String> = cells.map(|x| format!("{x:?}")).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    Ok(text)
}
