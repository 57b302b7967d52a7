//! `polhode inertia`: builds, checks and converts inertia tensors.

mod links;
mod meshes;
mod model;
mod output;
mod repair;
mod summary;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Amount, Evidence, InertiaError, MassError, MassProperties, Oddity, Solid, diagnose};
use polhode_files::bodies;
use polhode_files::error::{Error, warn};
use polhode_files::examined::{Examined, Worth};
use polhode_files::given::{self, Given};
use polhode_files::numbers::{list, numbers, positive};
use polhode_files::read;
use polhode_files::robots::Language;
use polhode_files::text::{short, visible};
use polhode_pages::output::Output;
use polhode_pages::table::Format;

use meshes::MeshArguments;

const EXAMPLES: &str = "Examples:
  polhode inertia box 0.3,0.2,0.1 --mass 2
  polhode inertia tensor 1,2,2.5,0.1,0,0 --mass 3 --format urdf
  polhode inertia cylinder 0.05,0.2 --density 2700 --about 0,0,-0.1";

/// Build, check and convert inertia tensors
///
/// SHAPE and its ARGUMENT, lengths in m, symmetry axis z:
///   box LX,LY,LZ    ellipsoid A,B,C (semi-axes)    sphere R    shell R
///   cylinder R,H    tube R1,R2,H    cone R,H    torus R,r    rod L
///   disk R    plate LX,LY    hoop R    capsule R,H (H without the caps)
///   mesh FILE (.stl, .obj or .ply; volume where parts overlap counts twice: a
///     warning says how much, but may miss overlaps below 1/128 of the size)
///   tensor Ixx,Iyy,Izz,Ixy,Ixz,Iyz (or all nine entries, by rows)
///   parts FILE.toml    json FILE
///   urdf FILE...    mjcf FILE...    sdf FILE...
///
/// Tensor entries carry the minus sign, I_xy = -int x y dm, and are about the
/// centre of mass. The base of a cone is at z = 0. If a tensor is not physically
/// valid, the output states the violated law and by how much, the probable cause
/// and the nearest valid tensor; the exit code is then 1. Every link of a robot
/// model gets a row. So does what is not read, such as an include of SDF or an
/// element of xacro.
///
/// A file of parts lists bodies that are summed:
///   [[part]]
///   shape = "cylinder"    # a shape, or mesh (with file), tensor (with
///   size = [0.05, 0.2]    #   inertia = [6 entries]), point; size as ARGUMENT
///   mass = 2.0            # kg, or density
///   turn = [1, 0, 0, 0]   # quaternion w, x, y, z, part to whole; optional
///   at = [0.0, 0.0, 0.1]  # m, where the origin of the part goes; optional
#[derive(Args, Clone, Debug)]
#[command(verbatim_doc_comment, after_help = EXAMPLES)]
pub(crate) struct Inertia {
    /// box, ellipsoid, sphere, shell, cylinder, tube, cone, torus, rod, disk, plate, hoop, capsule, mesh, tensor, parts, json, urdf, mjcf or sdf
    shape: String,
    /// Sizes, m, of a shape; entries of a tensor; or a file
    #[arg(value_name = "ARGUMENT", allow_hyphen_values = true)]
    argument: String,
    /// Further robot models
    #[arg(value_name = "FILE")]
    more: Vec<String>,
    /// Mass, kg; a shape or a mesh needs this or --density, a tensor only for output that states a mass
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true)]
    mass: Option<f64>,
    /// Density in place of --mass, kg/m^3 (of a surface kg/m^2, of a line kg/m)
    #[arg(long, value_name = "D", value_parser = positive, allow_hyphen_values = true, conflicts_with = "mass")]
    density: Option<f64>,
    #[command(flatten)]
    mesh: MeshArguments,
    /// Centre of mass of a typed tensor, m [default: 0,0,0]
    #[arg(long, value_name = "x,y,z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    center_of_mass: Option<[f64; 3]>,
    /// Reference point of a typed tensor, m [default: its centre of mass]
    #[arg(long, value_name = "x,y,z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    given_about: Option<[f64; 3]>,
    /// Edges of the bounding box of the body, m: they help to find mistakes in a typed tensor
    #[arg(long, value_name = "LX,LY,LZ", value_parser = numbers::<3>, allow_hyphen_values = true)]
    extents: Option<[f64; 3]>,
    /// Print the tensor about this point too, m
    #[arg(long, value_name = "x,y,z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    about: Option<[f64; 3]>,
    /// Print all that is known of every link of a model, not one row
    #[arg(long)]
    details: bool,
    /// Write copies of the models with their invalid tensors repaired to this folder; another file of the same name in it is not replaced
    #[arg(long, value_name = "DIR")]
    repair: Option<PathBuf>,
    /// Folder within which the includes of an MJCF model must lie [default: its own]
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// What is written [default: what the ending of --out names, else table on a terminal, csv otherwise]
    #[arg(long, value_enum)]
    format: Option<Form>,
    /// Write to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// How bodies are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Rounded, for reading
    Table,
    /// One row per body
    Csv,
    /// An object, or an array of several bodies
    Json,
    /// <inertial> of a URDF link
    Urdf,
    /// <inertial> of an MJCF body with fullinertia
    Mjcf,
    /// <inertial> of an MJCF body with diaginertia and quat
    MjcfDiagonal,
    /// A list of parts, as `parts` reads it
    Toml,
}

impl Form {
    /// The form that is asked for, or that the ending of the file of `--out` names, or that suits standard output.
    fn of(asked: Option<Self>, out: Option<&Path>) -> Result<Self, Error> {
        let ending = out.and_then(Path::extension).map(|ending| ending.to_string_lossy().to_lowercase());
        let told: &[Self] = match ending.as_deref() {
            Some("urdf") => &[Self::Urdf],
            Some("mjcf") => &[Self::Mjcf, Self::MjcfDiagonal],
            Some("xml") if asked.is_some() => &[Self::Urdf, Self::Mjcf, Self::MjcfDiagonal],
            Some("toml") => &[Self::Toml],
            _ => {
                let common = match asked {
                    None => None,
                    Some(Self::Table) => Some(Format::Table),
                    Some(Self::Csv) => Some(Format::Csv),
                    Some(Self::Json) => Some(Format::Json),
                    Some(model) if !matches!(ending.as_deref(), Some("csv" | "json" | "txt")) => {
                        return Ok(model);
                    }
                    // a model in a file of rows
                    Some(_) => return Err(Self::contradicted(out)),
                };
                return Format::of(common, out).map(|format| match format {
                    Format::Table => Self::Table,
                    Format::Csv => Self::Csv,
                    Format::Json => Self::Json,
                });
            }
        };
        match asked {
            Some(asked) if !told.contains(&asked) => Err(Self::contradicted(out)),
            Some(asked) => Ok(asked),
            None => Ok(told[0]),
        }
    }

    fn contradicted(out: Option<&Path>) -> Error {
        let value = out.map(|path| path.display().to_string()).unwrap_or_default();
        let rule = "the ending and --format name different formats";
        Error::input("--out", &value, rule, "drop --format, or change the ending")
    }

    /// Whether it says what is known of a tensor, also of an invalid one; the others are models to be used.
    fn is_report(self) -> bool {
        matches!(self, Self::Table | Self::Csv | Self::Json)
    }
}

impl Inertia {
    pub(crate) fn run(&self) -> Result<(), Error> {
        if let Some(language) = Language::named(&self.shape) {
            self.check_flags()?;
            return links::run(self, language);
        }
        let file = Output::new(self.out.as_deref())?;
        let given = self.given()?;
        if self.about.is_some() && given.iter().any(|body| body.mass.is_none()) {
            let rule = "missing: --about moves a tensor by M (R^2 1 - R R^T)";
            return Err(Error::input("--mass", "", rule, "give --mass M"));
        }
        let form = self.form()?;
        if !form.is_report() {
            self.check_masses(&given, form)?;
        }
        let point = self.about.map(Vector3::from);
        let mut bodies = Vec::new();
        for body in given {
            let name =
                if body.name.is_empty() { String::new() } else { format!(" of '{}'", visible(&body.name)) };
            let refused = |error| Error::Input(format!("{} {}{name}: {error}", self.shape, self.argument));
            bodies.push(Examined::of(body, point).map_err(refused)?);
        }
        self.check_about(&bodies)?;
        let invalid: Vec<String> =
            bodies.iter().filter(|body| body.worth() == Worth::Invalid).map(Examined::report).collect();
        for body in bodies.iter().filter(|body| body.worth() == Worth::Suspicious) {
            warn(&body.report());
        }
        // a model must not contain an invalid tensor; a report shows it
        if invalid.is_empty() || form.is_report() {
            file.write_whole(&output::write(&bodies, &[], form))?;
        }
        if invalid.is_empty() { Ok(()) } else { Err(Error::Failed(invalid.join("\n"))) }
    }

    fn form(&self) -> Result<Form, Error> {
        let form = Form::of(self.format, self.out.as_deref())?;
        if self.about.is_some() && !form.is_report() {
            let rule = "this format has the tensor only about the centre of mass";
            return Err(Error::input("--about", "", rule, "leave it out, or write a table, csv or json"));
        }
        Ok(form)
    }

    fn check_about(&self, bodies: &[Examined]) -> Result<(), Error> {
        if bodies.iter().any(|body| body.body.is_some() && matches!(body.about, Some((_, None)))) {
            let value = self.about.unwrap_or_default().map(short).join(",");
            let rule = "the tensor about this point is outside the range of a double";
            return Err(Error::input("--about", &value, rule, "name a nearer one"));
        }
        Ok(())
    }

    /// Refuses flags that say nothing about this shape.
    fn check_flags(&self) -> Result<(), Error> {
        let shape = self.shape.as_str();
        let language = Language::named(shape);
        if !matches!(shape, "tensor") {
            self.only_for("tensor", "--center-of-mass", self.center_of_mass.is_some())?;
            self.only_for("tensor", "--given-about", self.given_about.is_some())?;
            self.only_for("tensor", "--extents", self.extents.is_some())?;
        }
        if shape != "mesh" && !self.mesh.is_empty() {
            let flags = "--length-unit, --weld, --close, --shell and --group";
            let rule = format!("belong to mesh, not to {shape}");
            return Err(Error::input(flags, "", &rule, "leave them out"));
        }
        let is_file = matches!(shape, "parts" | "json") || language.is_some();
        if is_file || shape == "tensor" {
            self.only_for("shapes and mesh", "--density", self.density.is_some())?;
        }
        if is_file {
            self.only_for("shapes, mesh and tensor", "--mass", self.mass.is_some())?;
        }
        if language.is_none() {
            self.only_for("robot models", "--details", self.details)?;
            self.only_for("robot models", "--repair", self.repair.is_some())?;
            if let Some(second) = self.more.first() {
                let rule = format!("is one argument too many for {shape}");
                return Err(Error::input(
                    "ARGUMENT",
                    second,
                    &rule,
                    "separate numbers by commas, without blanks",
                ));
            }
        }
        if language != Some(Language::Mjcf) {
            self.only_for("mjcf", "--root", self.root.is_some())?;
        }
        Ok(())
    }

    /// A model states masses, and none is made up.
    fn check_masses(&self, given: &[Given], form: Form) -> Result<(), Error> {
        let Some(body) = given.iter().find(|body| body.mass.is_none()) else { return Ok(()) };
        let form = form.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
        let rule = format!("missing: --format {form} states a mass");
        if self.shape == "tensor" {
            return Err(Error::input("--mass", "", &rule, "give --mass M"));
        }
        let place = format!("{}: \"mass\" of '{}'", self.argument, visible(&body.name));
        Err(Error::input(&place, "", &rule, "write it into the file"))
    }

    /// The bodies that the arguments describe.
    fn given(&self) -> Result<Vec<Given>, Error> {
        let path = Path::new(&self.argument);
        let single = |given: Given| Ok(vec![given]);
        let shape = self.shape.as_str();
        self.check_flags()?;
        match shape {
            "tensor" => single(self.tensor()?),
            "mesh" => single(self.weighed(self.mesh.body(path, self.amount()?)?)),
            "parts" => single(Given::body(bodies::parts(path)?)),
            "json" => given::from_json(path, &read(path, "name a JSON file of this command")?),
            _ => {
                if !Solid::names().any(|name| name == shape) {
                    let others = ["mesh", "tensor", "parts", "json"].into_iter().chain(Language::NAMES);
                    return Err(Error::unknown_name("SHAPE", "shape", shape, Solid::names().chain(others)));
                }
                let sizes = list(&self.argument)
                    .map_err(|error| Error::Input(format!("{shape}: '{}': {error}", self.argument)))?;
                let solid = Solid::named(shape, &sizes).map_err(|error| self.refused(error))?;
                single(self.weighed(solid.with(self.amount()?).map_err(|error| self.refused(error))?))
            }
        }
    }

    /// A shape or a mesh; where its mass is stated, a unit of another length or mass than is read shows in its density.
    fn weighed(&self, body: MassProperties) -> Given {
        let found =
            self.mass.and_then(|mass| diagnose(body.tensor(), &Evidence::default().with_mass(mass)).ok());
        if let Some(density @ (Oddity::Dense { .. } | Oddity::Light { .. })) =
            found.and_then(|found| found.oddity)
        {
            warn(&format!(
                "{} {}: {density}; lengths are read in m (of a mesh in --length-unit) and masses in kg",
                self.shape, self.argument
            ));
        }
        Given::body(body)
    }

    fn only_for(&self, shapes: &str, flag: &str, given: bool) -> Result<(), Error> {
        if given {
            Err(Error::input(
                flag,
                "",
                &format!("belongs to {shapes}, not to {}", self.shape),
                "leave it out",
            ))
        } else {
            Ok(())
        }
    }

    fn amount(&self) -> Result<Amount, Error> {
        match (self.mass, self.density) {
            (Some(mass), _) => Ok(Amount::Mass(mass)),
            (None, Some(density)) => Ok(Amount::Density(density)),
            (None, None) => Err(Error::input(
                "--mass",
                "",
                &format!("missing: {} needs a mass or a density", self.shape),
                "give --mass M (kg) or --density D (kg/m^3)",
            )),
        }
    }

    fn refused(&self, error: MassError) -> Error {
        Error::Input(format!("{} {}: {error}", self.shape, self.argument))
    }

    /// The typed entries: six, or nine by rows.
    fn tensor(&self) -> Result<Given, Error> {
        let place = format!("tensor: '{}'", self.argument);
        let entries = list(&self.argument).map_err(|error| Error::Input(format!("{place}: {error}")))?;
        let tensor = match entries.as_slice() {
            &[xx, yy, zz, xy, xz, yz] => Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
            nine if nine.len() == 9 => Matrix3::from_row_slice(nine),
            other => {
                return Err(Error::Input(format!(
                    "{place}: {} given, 6 needed (Ixx,Iyy,Izz,Ixy,Ixz,Iyz) or 9 (by rows)",
                    other.len()
                )));
            }
        };
        let center_of_mass = Vector3::from(self.center_of_mass.unwrap_or_default());
        let mut given =
            Given { mass: self.mass, center_of_mass, extents: self.extents, ..Given::of_tensor(tensor) };
        if let Some(point) = self.given_about {
            let Some(mass) = self.mass else {
                let rule = "missing: --given-about moves a tensor by M (R^2 1 - R R^T)";
                return Err(Error::input("--mass", "", rule, "give --mass M"));
            };
            given = match MassProperties::from_tensor_about(point.into(), mass, center_of_mass, tensor) {
                Ok(body) => Given { extents: self.extents, computed: false, ..Given::body(body) },
                Err(MassError::Inertia(law @ InertiaError::NotSymmetric { .. })) => {
                    return Err(Error::Input(format!("{place}: {law}")));
                }
                Err(MassError::Inertia(InertiaError::NotFinite { .. })) => {
                    let rule = "moves the tensor outside the range of a double";
                    return Err(Error::input(
                        "--given-about",
                        &point.map(short).join(","),
                        rule,
                        "name a nearer one",
                    ));
                }
                Err(error) => {
                    let rule = format!("too small for a tensor about --given-about: {error}");
                    return Err(Error::Failed(format!("{place}: {rule}")));
                }
            };
        }
        Ok(given)
    }
}
