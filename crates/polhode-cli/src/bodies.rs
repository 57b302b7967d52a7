//! `polhode bodies`: the catalogue of bodies.

use std::path::PathBuf;

use clap::Args;
use polhode::catalogue::{self, NamedBody};
use polhode_files::error::Error;
use polhode_pages::output::emit;
use polhode_pages::table::{Cell, Column, Format, Table, row};

const EXAMPLES: &str = "Examples:
  polhode bodies
  polhode bodies toutatis
  polhode bodies hyperion
  polhode bodies --format json";

/// List the catalogue of bodies: moments, spin at the start, source
///
/// Other commands take these as --body NAME. Free bodies come first, then tops with a fixed point and a weight. Moments are in
/// kg m^2, or ratios where only these are known.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Bodies {
    /// Show all that is known of this body
    name: Option<String>,
    /// How rows are printed [default: table on a terminal, csv otherwise]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Write to this file instead of standard output; its ending names the format: .csv, .json or .txt
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Bodies {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let all: Vec<NamedBody> = catalogue::bodies().into_iter().chain(catalogue::tops()).collect();
        let chosen: Vec<NamedBody> = match &self.name {
            Some(name) => all.iter().filter(|body| body.name == name).cloned().collect(),
            None => all.clone(),
        };
        if let Some(name) = self.name.as_ref().filter(|_| chosen.is_empty()) {
            return Err(Error::unknown_name("NAME", "body", name, all.iter().map(|body| body.name)));
        }
        let format = Format::of(self.format, self.out.as_deref())?;
        let text = match (&chosen[..], format) {
            ([body], Format::Table) => sheet(body),
            _ => format.write(&table(&chosen)),
        };
        emit(&text, self.out.as_deref())
    }
}

/// Name, unit and value of all that is known; the moments in the order of the body axes.
fn quantities(body: &NamedBody) -> Vec<(&'static str, &'static str, Cell)> {
    let moments = body.inertia.tensor().diagonal();
    let vector = |names: [&'static str; 3], unit: &'static str, values: [f64; 3]| {
        names.into_iter().zip(values).map(move |(name, value)| (name, unit, Cell::from(value)))
    };
    let mut all = vec![("name", "", Cell::from(body.name)), ("unit", "", body.unit.into())];
    all.extend(vector(["moment_x", "moment_y", "moment_z"], "", moments.into()));
    all.extend(vector(["omega_body_x", "omega_body_y", "omega_body_z"], "rad/s", body.omega_body));
    all.extend(["q_w", "q_x", "q_y", "q_z"].into_iter().zip(body.attitude).map(|(n, x)| (n, "", x.into())));
    all.extend(vector(["weight_moment_x", "weight_moment_y", "weight_moment_z"], "N m", body.weight_moment));
    let (orientation, orbit) = (body.orientation, body.orbit.as_ref());
    all.extend([
        ("frame", "", orientation.map_or("unknown", |found| found.frame).into()),
        ("epoch", "", orientation.and_then(|found| found.epoch).into()),
        ("summary", "", body.summary.into()),
        ("source", "", body.source.into()),
        ("attitude_source", "", orientation.map(|found| found.source).into()),
        ("primary", "", orbit.map(|found| found.primary).into()),
        ("mean_motion", "rad/s", orbit.map(|found| found.mean_motion).into()),
        ("eccentricity", "", orbit.map(|found| found.eccentricity).into()),
        ("mean_anomaly", "rad", orbit.map(|found| found.mean_anomaly).into()),
        ("orbit_source", "", orbit.map(|found| found.source).into()),
        ("wheels", "", (!body.wheels.is_empty()).then(|| wheels(body).join(" ")).as_deref().into()),
    ]);
    all
}

/// The wheels as the flag `--wheel` has them.
fn wheels(body: &NamedBody) -> Vec<String> {
    body.wheels.iter().map(ToString::to_string).collect()
}

/// A row a body; a terminal shows what tells them apart.
fn table(bodies: &[NamedBody]) -> Table {
    let all: Vec<_> = bodies.iter().map(quantities).collect();
    let shown = ["name", "unit", "moment_x", "moment_y", "moment_z", "summary"];
    let columns = all.first().map_or(&[][..], Vec::as_slice).iter().map(|(name, unit, _)| {
        let column = Column::new(name, unit, "");
        if shown.contains(name) { column } else { column.hidden() }
    });
    let mut table = Table::new("bodies", "The catalogue of bodies.", columns.collect());
    for quantities in all {
        table.push(quantities.into_iter().map(|(_, _, value)| value));
    }
    table
}

/// A line a quantity; texts stand below, as they are longer than a line.
fn sheet(body: &NamedBody) -> String {
    let columns = vec![
        Column::new("quantity", "", ""),
        Column::new("value", "", "").digits(9),
        Column::new("unit", "", ""),
    ];
    let mut table = Table::new("body", "A body of the catalogue.", columns);
    for (name, unit, value) in quantities(body) {
        let told_below = name.ends_with("source") || matches!(name, "summary" | "frame" | "epoch" | "wheels");
        if !told_below && value != Cell::Empty {
            let unit = if name.starts_with("moment") { body.unit } else { unit };
            table.push(row![name, value, unit]);
        }
    }
    let of_attitude = body.orientation.map_or(String::new(), |found| format!(" ({})", found.source));
    let attitude = body.attitude_known();
    let orbit = body.orbit.as_ref().map_or(String::new(), |found| {
        format!("turned by the gravity gradient of {} ({})\n", found.primary, found.source)
    });
    let wheels: String = wheels(body).iter().map(|wheel| format!("carries --wheel {wheel}\n")).collect();
    format!(
        "{}\n{}\nsource: {}\n{attitude}{of_attitude}\n{orbit}{wheels}",
        table.terminal(),
        body.summary,
        body.source
    )
}
