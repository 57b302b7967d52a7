//! The inertia of a wheel, from records of a body that is known.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode_files::error::{Error, warn};
use polhode_fit::{FitError, Record, Settings, WheelCalibration, calibrate_wheel};
use polhode_pages::table::{Format, Table, row};
use serde_json::{Value, json};

use super::as_read::AsRead;
use super::report::{SURE, estimates, nuisances, scaled, with_error, wrapped_lines};

/// The answer as text, rows or JSON; `names` are those of the files.
pub(super) fn report(
    record: &Record,
    body: &Inertia,
    axis: &Vector3<f64>,
    settings: &Settings,
    names: &str,
    (format, as_read): (Format, &AsRead),
) -> Result<String, Error> {
    let wheel = calibrate_wheel(record, body, settings).map_err(|error| {
        let message = format!("{names}: {error}");
        match error {
            FitError::NoRotation { .. } | FitError::StatedNoise { .. } | FitError::Solver(_) => {
                Error::Failed(message)
            }
            _ => Error::Input(message),
        }
    })?;
    // the JSON holds them too
    wheel.warnings.iter().for_each(|warning| warn(&warning.to_string()));
    Ok(match format {
        Format::Table => text(&wheel, axis, as_read),
        Format::Csv => rows(&wheel).csv(),
        Format::Json => format!("{:#}\n", object(&wheel, axis, (record, as_read))),
    })
}

fn text(wheel: &WheelCalibration, axis: &Vector3<f64>, as_read: &AsRead) -> String {
    let mut lines = vec![
        format!("wheel inertia: {} kg m^2 (95 %)", scaled(wheel.inertia, SURE * wheel.sigma)),
        format!("axis: ({}, {}, {})", axis.x, axis.y, axis.z),
    ];
    for n in &wheel.nuisances {
        lines.push(format!("  {:<16} {} {}", n.name, with_error(n.value, n.sigma), n.unit).trim_end().into());
    }
    lines.push(format!(
        "{} samples, segments: {}, noise {:.3e} rad/s",
        wheel.samples, wheel.segments, wheel.noise_sigma
    ));
    lines.extend(wrapped_lines(&as_read.sentences()));
    lines.push(format!("half width of the test functions: {:.4} s", wheel.radius));
    lines.push(format!("chi^2 per degree of freedom: {:.3} ({} degrees)", wheel.chi2_per_dof, wheel.dof));
    lines.join("\n") + "\n"
}

fn rows(wheel: &WheelCalibration) -> Table {
    let mut table = estimates("wheel", "Inertia of a wheel.");
    table.push(row!["wheel_inertia", wheel.inertia, wheel.sigma, "kg m^2"]);
    wheel.nuisances.iter().for_each(|n| table.push(row![n.name, n.value, n.sigma, n.unit]));
    table.push(row!["noise_sigma", wheel.noise_sigma, None::<f64>, "rad/s"]);
    table.push(row!["chi2_per_dof", wheel.chi2_per_dof, (2.0 / wheel.dof.max(1) as f64).sqrt(), ""]);
    table
}

fn object(wheel: &WheelCalibration, axis: &Vector3<f64>, (record, as_read): (&Record, &AsRead)) -> Value {
    json!({
        "wheel_inertia": wheel.inertia,
        "sigma": wheel.sigma,
        "axis": [axis.x, axis.y, axis.z],
        "nuisances": nuisances(&wheel.nuisances),
        "noise_sigma": wheel.noise_sigma,
        "samples": wheel.samples,
        "segments": wheel.segments,
        "radius": wheel.radius,
        "chi2_per_dof": wheel.chi2_per_dof,
        "dof": wheel.dof,
        "warnings": wheel.warnings.iter().map(ToString::to_string).collect::<Value>(),
        "read_as": as_read.json(),
        "unused_columns": super::report::unused(record),
    })
}
