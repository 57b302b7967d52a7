//! The flags of `inertia mesh`.

use std::path::Path;

use clap::{Args, ValueEnum};
use polhode::inertia::{Amount, Closing, MassProperties};
use polhode_files::error::Error;
use polhode_files::mesh::{MeshOptions, length_unit};
use polhode_files::numbers::positive;

/// The flags of `mesh`.
#[derive(Args, Clone, Debug, Default)]
pub(super) struct MeshArguments {
    /// Unit of length of a mesh: mm, cm, m, in, or a number of metres [default: m]
    #[arg(long, value_name = "UNIT", value_parser = length_unit, allow_hyphen_values = true)]
    length_unit: Option<f64>,
    /// Vertices of a mesh that are nearer together than this fraction of its size are merged [default: 2^-17]
    #[arg(long, value_name = "FRACTION", value_parser = positive, allow_hyphen_values = true)]
    weld: Option<f64>,
    /// How the holes of an open mesh are closed [default: an open mesh is refused]
    #[arg(long, value_enum, conflicts_with = "shell")]
    close: Option<How>,
    /// The mesh is a shell: thin walls of this thickness, m, whatever --length-unit is. With --mass the thickness has no effect [default:
    /// the mesh is solid]
    #[arg(long, value_name = "THICKNESS", value_parser = positive, allow_hyphen_values = true)]
    shell: Option<f64>,
    /// Only this group of an OBJ file, or solid of an ASCII STL [default: the whole file]
    #[arg(long, value_name = "NAME")]
    group: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum How {
    /// The convex hull instead of the surface
    Hull,
    /// Triangles from the middle of each rim
    Fan,
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
        let close = self.close.map(|how| match how {
            How::Hull => Closing::Hull,
            How::Fan => Closing::Fan,
        });
        MeshOptions::default()
            .with_length_unit(self.length_unit)
            .with_weld(self.weld)
            .with_closing(close)
            .with_shell(self.shell)
            .with_group(self.group.clone())
            .body(path, amount)
    }
}
