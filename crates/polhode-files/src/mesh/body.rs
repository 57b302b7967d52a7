//! Bodies of meshes: their unit of length, and what is done where they do not close.

use std::path::Path;

use polhode::inertia::{
    Amount, Closing, FLOAT_WELD, MassError, MassProperties, Mesh, MeshError, Repair, Surface,
};

use super::surface;
use crate::error::{Error, warn};
use crate::numbers::positive;
use crate::text::rounded;

/// A body longer than this, m, or heavier than that, kg, is asked about where no unit was named.
const LONG: f64 = 20.0;
const HEAVY: f64 = 1e5;

/// Share of the volume that counts twice from which on this is told: less is what rounded corners of parts that touch have in common.
const OVERLAP: f64 = 1e-4;

/// How a mesh is made a body, where its file leaves that open.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct MeshOptions {
    /// Unit of length, m; without it metres, and a body that is large then is asked about.
    pub length_unit: Option<f64>,
    /// Vertices within this fraction of its size are the same; without it 2^-17.
    pub weld: Option<f64>,
    /// How holes are closed; without it an open mesh is refused.
    pub closing: Option<Closing>,
    /// Only the surface has mass, as walls of this thickness, m; without it the mesh is solid.
    pub shell: Option<f64>,
    /// Only this group of an OBJ file, or solid of an ASCII STL; without it the whole file.
    pub group: Option<String>,
}

/// How long, m, a mesh is that hardly is in metres.
pub(crate) fn beyond_metres(surface: &Surface) -> Option<f64> {
    let longest = surface.extents().into_iter().fold(0.0, f64::max);
    (longest > LONG).then(|| three_digits(longest))
}

/// Metres of a unit of length, by name or as a number.
///
/// # Errors
/// A name that is unknown, a number that is not positive.
pub fn length_unit(text: &str) -> Result<f64, String> {
    match text.trim() {
        "mm" => Ok(1e-3),
        "cm" => Ok(1e-2),
        "m" => Ok(1.0),
        "in" => Ok(0.0254),
        other => positive(other).map_err(|error| format!("{error}; known units: mm, cm, m, in")),
    }
}

impl MeshOptions {
    /// With a unit of length, m.
    #[must_use]
    pub fn with_length_unit(self, length_unit: Option<f64>) -> Self {
        Self { length_unit, ..self }
    }

    /// With the fraction of its size within which vertices are the same.
    #[must_use]
    pub fn with_weld(self, weld: Option<f64>) -> Self {
        Self { weld, ..self }
    }

    /// With a way of closing holes.
    #[must_use]
    pub fn with_closing(self, closing: Option<Closing>) -> Self {
        Self { closing, ..self }
    }

    /// With walls of this thickness, m.
    #[must_use]
    pub fn with_shell(self, shell: Option<f64>) -> Self {
        Self { shell, ..self }
    }

    /// With a group of triangles of the file alone.
    #[must_use]
    pub fn with_group(self, group: Option<String>) -> Self {
        Self { group, ..self }
    }

    /// The body of a mesh; what was mended is told on standard error.
    ///
    /// # Errors
    /// A file that cannot be read, a surface that encloses nothing, an amount of matter that no body has.
    pub fn body(&self, path: &Path, amount: Amount) -> Result<MassProperties, Error> {
        let refused = |error: MassError| Error::Input(format!("mesh {}: {error}", path.display()));
        let surface = self.surface(path)?;
        let body = if let Some(thickness) = self.shell {
            let half = 0.5 * surface.extents().into_iter().fold(0.0, f64::max);
            if thickness > half {
                let rule =
                    format!("walls of m, of a body that is {} m long", rounded(three_digits(2.0 * half)));
                return Err(Error::input(
                    "--shell",
                    &rounded(thickness),
                    &rule,
                    "give the thickness in m, as 0.001 for 1 mm",
                ));
            }
            let amount = match amount {
                Amount::Density(density) => Amount::Density(density * thickness),
                mass => mass,
            };
            surface.sheet(amount)
        } else {
            self.mesh(path, &surface)?.with(amount)
        };
        let body = body.map_err(refused)?;
        self.ask_for_the_unit(path, &surface, &body);
        Ok(body)
    }

    fn surface(&self, path: &Path) -> Result<Surface, Error> {
        let refused = |error: MeshError| Error::Input(format!("{}: {error}", path.display()));
        let surface = surface(path)?;
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
        let found = match self.closing {
            Some(how) => surface.closed(weld, how),
            None => surface.mended(weld),
        };
        let (mesh, repairs) =
            found.map_err(|error| Error::Input(refusal(path, surface, &error, self.closing)))?;
        let said = findings(surface, &mesh, &repairs);
        said.iter().for_each(|said| warn(&format!("{}: {said}", path.display())));
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

/// What is to be said of a mesh beside its numbers: what was mended and left out, and how much of it counts twice.
#[must_use]
pub fn findings(surface: &Surface, mesh: &Mesh, repairs: &[Repair]) -> Vec<String> {
    let mut found = Vec::new();
    if !repairs.is_empty() {
        let list: Vec<String> = repairs.iter().map(Repair::to_string).collect();
        found.push(format!("mended: {}", list.join("; ")));
    }
    match surface.degenerate() {
        0 => {}
        1 => found.push("1 facet without area left out".into()),
        many => found.push(format!("{many} facets without area left out")),
    }
    if mesh.doubled() > OVERLAP {
        found.push(format!(
            "parts overlap, and {} % of the volume counts twice; make them one solid, or give each a mass of its own in a file of parts",
            rounded(two_digits(100.0 * mesh.doubled()))
        ));
    }
    found
}

fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
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
            "; rims: {}, the longest of {} edges, {:.3} times the size of the mesh, about ({x}, {y}, {z}); close them by \
             --close fan, use the convex hull by --close hull, or give walls a thickness by --shell",
            rims.len(),
            longest.edges,
            longest.length / extent
        );
    }
    text
}
