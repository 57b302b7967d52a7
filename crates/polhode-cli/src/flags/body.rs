//! The flags that name a body, for every command that takes them.

use std::sync::OnceLock;

use clap::Args;
use nalgebra::Matrix3;
use polhode::body::{Body, Orbit, WheelAtStart};
use polhode::catalogue::{self, Orientation};
use polhode::inertia::Inertia;
use polhode_files::bodies;
use polhode_files::error::{Error, tell};
use polhode_files::numbers::{list, numbers};
use polhode_files::text::visible;

/// A body: exactly one of three flags.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Body")]
#[group(required = true, multiple = false)]
pub(crate) struct BodyArguments {
    /// Principal moments in the order of the body axes, in any consistent unit
    #[arg(long, value_name = "I1,I2,I3", value_parser = numbers::<3>, allow_hyphen_values = true)]
    moments: Option<[f64; 3]>,
    /// Inertia tensor in body axes: six entries, I_xy = -sum m x y; or all nine, by rows
    #[arg(long, value_name = "Ixx,Iyy,Izz,Ixy,Ixz,Iyz", value_parser = tensor, allow_hyphen_values = true)]
    inertia: Option<Matrix3<f64>>,
    /// Body of the catalogue, see `polhode bodies`; or a file: JSON of `polhode inertia` or `polhode fit`, TOML of parts, URDF, MJCF or SDF, with :LINK if it has several; or a mesh (STL, OBJ, PLY), taken with 1 kg/m^3 and refused with wheels and torques in N m
    #[arg(long, value_name = "NAME|FILE[:LINK]")]
    body: Option<String>,
    /// What --body names.
    #[arg(skip)]
    read: ReadOnce,
}

/// A body of a flag, read once: its file may have remarks.
#[derive(Clone, Debug, Default)]
pub(crate) struct ReadOnce(OnceLock<Described>);

impl ReadOnce {
    /// What was read before, or what `read` reads now.
    pub(crate) fn or_read(
        &self,
        read: impl FnOnce() -> Result<Described, Error>,
    ) -> Result<&Described, Error> {
        if let Some(found) = self.0.get() {
            return Ok(found);
        }
        let found = read()?;
        Ok(self.0.get_or_init(|| found))
    }
}

/// Six entries of a tensor, or nine.
fn tensor(text: &str) -> Result<Matrix3<f64>, String> {
    match list(text)?[..] {
        [xx, yy, zz, xy, xz, yz] => Ok(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)),
        ref nine if nine.len() == 9 => Ok(Matrix3::from_row_slice(nine)),
        ref found => Err(format!(
            "{} given, 6 needed (Ixx,Iyy,Izz,Ixy,Ixz,Iyz) or 9 (by rows); separate them by commas",
            found.len()
        )),
    }
}

/// A body with what is published of it.
#[derive(Clone, Debug)]
pub(crate) struct Described {
    pub(crate) inertia: Inertia,
    /// N m, body axes; zero of a body without a fixed point.
    pub(crate) weight_moment: [f64; 3],
    pub(crate) wheels: Vec<WheelAtStart>,
    /// Whose gravity gradient turns it.
    pub(crate) orbit: Option<Orbit>,
}

impl Described {
    pub(crate) fn alone(inertia: Inertia) -> Self {
        Self { inertia, weight_moment: [0.0; 3], wheels: Vec::new(), orbit: None }
    }
}

/// [`bodies::check_size`] of what `--body` names.
pub(crate) fn check_size(name: &str) -> Result<(), Error> {
    bodies::check_size("--body", name)
}

/// Says which density the mesh of a `file` has.
pub(crate) fn note_density(file: &str) {
    let file = visible(file);
    tell("note", &format!("{file}: the density is taken as 1 kg/m^3, as a mesh file has no mass"));
}

/// The body that `--body` names: of the catalogue, or of a file.
pub(crate) fn described(text: &str) -> Result<Described, Error> {
    named("--body", text)
}

/// The same of another flag.
pub(crate) fn named(flag: &str, text: &str) -> Result<Described, Error> {
    if let Some(found) = catalogue::body(text).or_else(|| catalogue::top(text)) {
        return Ok(Described {
            weight_moment: found.weight_moment,
            orbit: found.orbit.map(|named| named.orbit),
            wheels: found.wheels,
            ..Described::alone(found.inertia)
        });
    }
    if let Some((inertia, wheels)) = bodies::inertia(flag, text)? {
        return Ok(Described { wheels, ..Described::alone(inertia) });
    }
    let known: Vec<&str> =
        catalogue::bodies().iter().chain(&catalogue::tops()).map(|body| body.name).collect();
    if text.contains(['.', '/']) {
        let rule = "no such file, and no such body in the catalogue";
        return Err(Error::input(flag, text, rule, "`polhode bodies` lists the catalogue"));
    }
    Err(Error::unknown_name(flag, "body", text, known.iter().copied()))
}

impl BodyArguments {
    /// The body that the flags describe, with the catalogue's weight moment or `weight_moment` in its place, and its wheels in the catalogue
    /// or its file.
    pub(crate) fn heavy(&self, weight_moment: Option<[f64; 3]>) -> Result<(Body, Vec<WheelAtStart>), Error> {
        let Described { inertia, weight_moment: own, wheels, .. } = self.described()?;
        let moment = weight_moment.unwrap_or(own);
        if moment == [0.0; 3] {
            return Ok((Body::free(inertia), wheels));
        }
        let body = Body::heavy(inertia, moment.into());
        Ok((body.map_err(|error| Error::Input(format!("--weight-moment: {error}")))?, wheels))
    }

    /// The same for what only free bodies do.
    pub(crate) fn free(&self) -> Result<(Body, Vec<WheelAtStart>), Error> {
        let Described { inertia, weight_moment, wheels, .. } = self.described()?;
        if weight_moment != [0.0; 3] {
            let name = self.body.as_deref().unwrap_or_default();
            return Err(Error::input(
                "--body",
                name,
                "is a top under gravity, and this command is for free bodies",
                "name a free body, or give its --moments to leave the weight out",
            ));
        }
        if let Some((_, primary)) = self.own_orbit() {
            tell("note", &format!("free motion: the gravity gradient of {primary} is left out"));
        }
        Ok((Body::free(inertia), wheels))
    }

    /// The orbit that the catalogue has with its body, and what it goes round.
    pub(crate) fn own_orbit(&self) -> Option<(Orbit, &'static str)> {
        let named = catalogue::body(self.body.as_deref()?)?.orbit?;
        Some((named.orbit, named.primary))
    }

    /// The catalogue's name or the file that `--body` names.
    pub(crate) fn named(&self) -> Option<&str> {
        self.body.as_deref()
    }

    /// The mesh file that `--body` names, if it does.
    pub(crate) fn mesh(&self) -> Option<&str> {
        self.named().filter(|text| bodies::is_mesh(text))
    }

    /// [`check_size`] of what `--body` names, where what acts `is_sized`, as in N m; the gravity gradient acts in proportion to the inertia.
    pub(crate) fn check_size(&self, is_sized: bool) -> Result<(), Error> {
        self.named().filter(|_| is_sized).map_or(Ok(()), check_size)
    }

    /// What a title calls the body.
    pub(crate) fn label(&self) -> String {
        match (self.moments, &self.body) {
            (Some(moments), _) => {
                format!("moments {}", moments.map(polhode_files::text::rounded).join(", "))
            }
            (None, Some(name)) => {
                let file = std::path::Path::new(name).file_name();
                visible(&file.map_or(name.clone(), |file| file.to_string_lossy().into_owned())).into_owned()
            }
            (None, None) => "a typed tensor".into(),
        }
    }

    /// The spin and attitude that the catalogue has with its body.
    pub(crate) fn published_start(&self) -> Option<PublishedStart> {
        let name = self.body.as_deref()?;
        let found = catalogue::body(name).or_else(|| catalogue::top(name))?;
        Some(PublishedStart {
            omega: found.omega_body,
            attitude: found.attitude,
            known: format!("{}: {}", found.name, found.attitude_known()),
            orientation: found.orientation,
        })
    }

    fn described(&self) -> Result<Described, Error> {
        let refused =
            |flag: &str, error: polhode::inertia::InertiaError| Error::Input(format!("{flag}: {error}"));
        if let Some(moments) = self.moments {
            let inertia = Inertia::from_moments(moments).map_err(|error| refused("--moments", error))?;
            return Ok(Described::alone(inertia));
        }
        if let Some(tensor) = self.inertia {
            let inertia = Inertia::from_tensor(tensor).map_err(|error| refused("--inertia", error))?;
            return Ok(Described::alone(inertia));
        }
        self.read.or_read(|| described(self.body.as_deref().unwrap_or_default())).cloned()
    }
}

/// The start that a body is published with.
#[derive(Clone, Debug)]
pub(crate) struct PublishedStart {
    /// Body axes, rad/s.
    pub(crate) omega: [f64; 3],
    pub(crate) attitude: [f64; 4],
    /// What is known of the attitude, in words.
    pub(crate) known: String,
    pub(crate) orientation: Option<Orientation>,
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;

    use super::*;

    #[test]
    fn a_body_is_read_until_it_was_and_then_no_more() {
        let (once, count) = (ReadOnce::default(), Cell::new(0));
        let read = || {
            count.set(count.get() + 1);
            described("textbook")
        };
        assert!(once.or_read(|| described("nobody")).is_err());
        for _ in 0..3 {
            assert_eq!(once.or_read(read).unwrap().inertia.principal_moments(), [1.0, 2.0, 3.0]);
        }
        assert_eq!(count.get(), 1);
    }
}
