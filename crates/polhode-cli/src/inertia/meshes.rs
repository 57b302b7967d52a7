//! Mesh files, their unit of length, and what is done where they do not close.

use std::path::Path;

use clap::{Args, ValueEnum};
use polhode::inertia::{
    Amount, Closing, FLOAT_WELD, MassError, MassProperties, Mesh, MeshError, Repair, Surface,
};
use polhode_files::error::{Error, warn};
use polhode_files::mesh;
use polhode_files::numbers::positive;
use polhode_files::text::rounded;

/// A body longer than this, m, or heavier than that, kg, is asked about where no unit was named.
const LONG: f64 = 20.0;
const HEAVY: f64 = 1e5;

/// The flags of `mesh`.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct MeshArguments {
    /// Unit of length of a mesh: mm, cm, m, in, or a number of metres [default: m]
    #[arg(long, value_name = "UNIT", value_parser = unit, allow_hyphen_values = true)]
    pub(super) length_unit: Option<f64>,
    /// Vertices of a mesh within this fraction of its size are the same [default: 2^-17]
    #[arg(long, value_name = "FRACTION", value_parser = positive, allow_hyphen_values = true)]
    pub(super) weld: Option<f64>,
    /// How the holes of an open mesh are closed [default: an open mesh is refused]
    #[arg(long, value_enum, conflicts_with = "shell")]
    pub(super) close: Option<How>,
    /// Only the surface of a mesh has mass, as walls of this thickness, m [default: the mesh is solid]
    #[arg(long, value_name = "THICKNESS", value_parser = positive, allow_hyphen_values = true)]
    pub(super) shell: Option<f64>,
    /// Only this group of an OBJ file, or solid of an ASCII STL [default: the whole file]
    #[arg(long, value_name = "NAME")]
    pub(super) group: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum How {
    /// The convex hull instead of the surface
    Hull,
    /// Triangles from the middle of each rim
    Fan,
}

/// Metres of a unit of length.
pub(super) fn unit(text: &str) -> Result<f64, String> {
    match text.trim() {
        "mm" => Ok(1e-3),
        "cm" => Ok(1e-2),
        "m" => Ok(1.0),
        "in" => Ok(0.0254),
        other => positive(other).map_err(|error| format!("{error}; known units: mm, cm, m, in")),
    }
}

impl MeshArguments {
    pub(super) fn is_empty(&self) -> bool {
        self.length_unit.is_none()
            && self.weld.is_none()
            && self.close.is_none()
            && self.shell.is_none()
            && self.group.is_none()
    }

    /// The body of a mesh; what was mended is told on standard error.
    pub(super) fn body(&self, path: &Path, amount: Amount) -> Result<MassProperties, Error> {
        let refused = |error: MassError| Error::Input(format!("mesh {}: {error}", path.display()));
        let surface = self.surface(path)?;
        if let Some(thickness) = self.shell {
            let amount = match amount {
                Amount::Density(density) => Amount::Density(density * thickness),
                mass => mass,
            };
            let body = surface.sheet(amount).map_err(refused)?;
            self.ask_for_the_unit(path, &surface, &body);
            return Ok(body);
        }
        let mesh = self.mesh(path, &surface)?;
        let body = mesh.with(amount).map_err(refused)?;
        self.ask_for_the_unit(path, &surface, &body);
        Ok(body)
    }

    fn surface(&self, path: &Path) -> Result<Surface, Error> {
        let refused = |error: MeshError| Error::Input(format!("{}: {error}", path.display()));
        let surface = mesh::surface(path)?;
        let surface = match &self.group {
            None => surface,
            Some(name) => surface.group(name).ok_or_else(|| {
                let known: Vec<&str> = surface.groups().collect();
                if known.is_empty() {
                    return Error::input(
                        "--group",
                        name,
                        "this file has no groups of triangles",
                        "leave it out",
                    );
                }
                Error::unknown_name("--group", "group of triangles in this file", name, known)
            })?,
        };
        self.length_unit.map_or(Ok(surface.clone()), |unit| surface.scaled(unit)).map_err(refused)
    }

    fn mesh(&self, path: &Path, surface: &Surface) -> Result<Mesh, Error> {
        let weld = self.weld.unwrap_or(FLOAT_WELD);
        let how = self.close.map(|how| match how {
            How::Hull => Closing::Hull,
            How::Fan => Closing::Fan,
        });
        let found = match how {
            Some(how) => surface.closed(weld, how),
            None => surface.mended(weld),
        };
        let (mesh, repairs) = found.map_err(|error| Error::Input(refusal(path, surface, &error, how)))?;
        if !repairs.is_empty() {
            let list: Vec<String> = repairs.iter().map(Repair::to_string).collect();
            warn(&format!("{}: mended: {}", path.display(), list.join("; ")));
        }
        match surface.degenerate() {
            0 => {}
            1 => warn(&format!("{}: 1 facet without area left out", path.display())),
            many => warn(&format!("{}: {many} facets without area left out", path.display())),
        }
        Ok(mesh)
    }

    /// A mesh file has no unit.
    fn ask_for_the_unit(&self, path: &Path, surface: &Surface, body: &MassProperties) {
        let longest = surface.extents().into_iter().fold(0.0, f64::max);
        if self.length_unit.is_none() && (longest > LONG || body.mass() > HEAVY) {
            warn(&format!(
                "{}: a body of {} m and {} kg? mesh files have no unit; give --length-unit mm if it is in millimetres, or --length-unit m",
                path.display(),
                rounded(three_digits(longest)),
                rounded(three_digits(body.mass()))
            ));
        }
    }
}

fn three_digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

/// Why a surface encloses nothing, where it is open, and what helps.
fn refusal(path: &Path, surface: &Surface, error: &MeshError, how: Option<Closing>) -> String {
    let mut text = format!("{}: {error}", path.display());
    let rims = surface.boundaries();
    if let (Some(longest), None) = (rims.first(), how) {
        let [x, y, z] = [longest.center.x, longest.center.y, longest.center.z].map(three_digits).map(rounded);
        let extent = surface.extents().into_iter().fold(0.0, f64::max);
        text += &format!(
            "; rims: {}, the longest of {} edges, {:.3} times the size of the mesh, about ({x}, {y}, {z}); close them by --close fan, \
             take the convex hull by --close hull, or give walls a thickness by --shell",
            rims.len(),
            longest.edges,
            longest.length / extent
        );
    }
    text
}
