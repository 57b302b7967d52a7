//! Triangles from STL, OBJ and PLY files, and the bodies that they enclose.

mod body;
mod error;
mod obj;
mod ply;
mod stl;
mod text;

use std::io::BufReader;
use std::path::Path;

use polhode::inertia::Surface;

use crate::error::Error;
use crate::inputs;
use crate::text::visible;
pub(crate) use body::beyond_metres;
pub use body::{MeshOptions, findings, length_unit};
pub use error::MeshFileError;
pub use obj::read as obj;
pub use ply::read as ply;
pub use stl::read as stl;

/// The triangles of a file, whose ending tells its format.
pub fn surface(path: &Path) -> Result<Surface, Error> {
    let refused =
        |error: MeshFileError| Error::Input(visible(&format!("{}: {error}", path.display())).into());
    let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    let open = || inputs::open(path).map(BufReader::new).map_err(|error| refused(error.into()));
    match ending.as_deref() {
        Some("stl") => stl::read(open()?).map_err(refused),
        Some("obj") => obj::read(open()?).map_err(refused),
        Some("ply") => {
            // a pipe has no size
            let size = path.metadata().ok().filter(|found| found.is_file()).map(|found| found.len());
            ply::sized(open()?, size).map_err(refused)
        }
        _ => Err(Error::input(
            "mesh",
            &path.display().to_string(),
            "the format is told by the ending, and this one is unknown",
            "name a file that ends in .stl, .obj or .ply",
        )),
    }
}
