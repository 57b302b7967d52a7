//! The flags that name what acts on a body.

use std::path::{Path, PathBuf};

use clap::Args;
use polhode::body::{Body, Force, ForceError, Orbit};
use polhode_files::error::{Error, tell};
use polhode_files::numbers::{list, numbers, positive};
use polhode_files::text::visible;

use super::start::{angle_unit, with_unit};

/// Why a plane alone is refused.
pub(crate) const NO_ORBIT: &str = "there is no orbit";

/// What acts on the body; several forces add.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Forces")]
pub(crate) struct ForceArguments {
    /// Weight M g times the centre of mass, body axes, N m: the body turns about a fixed point, and gravity acts along -Z of space
    #[arg(long, value_name = "cx,cy,cz", value_parser = numbers::<3>, allow_hyphen_values = true)]
    pub(crate) weight_moment: Option<[f64; 3]>,
    /// Gravity gradient on an orbit in the space x-y plane: mean motion, rad/s, and eccentricity (default 0); perigee on +x at t = 0
    #[arg(long, value_name = "n[,e]", value_parser = one_or_two, allow_hyphen_values = true)]
    gravity_gradient: Option<OneOrTwo>,
    /// Gravity gradient on any conic, also a flyby: GM of the attracting mass, m^3/s^2; distance of the periapsis from its centre, m;
    /// eccentricity; time of the periapsis, s (default 0)
    #[arg(
        long,
        value_name = "GM,q,e[,t]",
        value_parser = three_or_four,
        allow_hyphen_values = true,
        conflicts_with = "gravity_gradient"
    )]
    orbit: Option<ThreeOrFour>,
    /// Plane of the orbit in space: longitude of the node, inclination and argument of the periapsis, each with its unit, as
    /// 17deg,46deg,63deg [default: the x-y plane, with the periapsis on +x]
    #[arg(
        long,
        value_name = "node,inclination,argument",
        value_parser = plane,
        allow_hyphen_values = true
    )]
    orbit_plane: Option<[f64; 3]>,
    /// Gravity gradient on an orbit given by a table of positions, interpolated by polynomials: a file with the columns t (s, or with a unit)
    /// and x, y, z (axes of space, in the unit of length of --gm) and at least eight rows
    #[arg(long, value_name = "FILE", requires = "gm", conflicts_with_all = ["gravity_gradient", "orbit", "orbit_plane"])]
    orbit_table: Option<PathBuf>,
    /// GM of the attracting mass of --orbit-table, m^3/s^2 or in the unit of length of the table
    #[arg(long, value_name = "GM", value_parser = positive, allow_hyphen_values = true, requires = "orbit_table")]
    gm: Option<f64>,
    /// Constant torque in body axes, N m
    #[arg(long, value_name = "x,y,z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    torque_body: Option<[f64; 3]>,
    /// Constant torque in the axes of space, N m
    #[arg(long, value_name = "x,y,z", value_parser = numbers::<3>, allow_hyphen_values = true)]
    torque_space: Option<[f64; 3]>,
    /// Drag torque -c1 w - c2 |w| w, the same about all axes: c1, N m s, and c2, N m s^2 (default 0)
    #[arg(long, value_name = "c1[,c2]", value_parser = one_or_two, allow_hyphen_values = true)]
    drag: Option<OneOrTwo>,
}

/// A number and a second one, 0 if it is left out.
#[derive(Clone, Copy, Debug)]
struct OneOrTwo([f64; 2]);

fn one_or_two(text: &str) -> Result<OneOrTwo, String> {
    match list(text)?[..] {
        [one] => Ok(OneOrTwo([one, 0.0])),
        [one, two] => Ok(OneOrTwo([one, two])),
        ref found => Err(format!("{} given, 1 or 2 needed; separate them by commas", found.len())),
    }
}

/// Three numbers and a fourth one, 0 if it is left out.
#[derive(Clone, Copy, Debug)]
struct ThreeOrFour([f64; 4]);

fn three_or_four(text: &str) -> Result<ThreeOrFour, String> {
    let found = conic(&list(text)?).map_err(|error| error + "; separate them by commas")?;
    Ok(ThreeOrFour(found))
}

/// GM, least distance, eccentricity, and the time of the least distance, 0 if it is left out.
pub(crate) fn conic(numbers: &[f64]) -> Result<[f64; 4], String> {
    match *numbers {
        [gm, periapsis, eccentricity] => Ok([gm, periapsis, eccentricity, 0.0]),
        [gm, periapsis, eccentricity, time] => Ok([gm, periapsis, eccentricity, time]),
        _ => Err(format!("{} given, 3 or 4 needed", numbers.len())),
    }
}

/// Three angles with their units, in rad.
pub(crate) fn plane(text: &str) -> Result<[f64; 3], String> {
    let angles = text.split(',').map(|angle| with_unit(angle.trim(), angle_unit, "17deg"));
    let angles: Vec<f64> = angles.collect::<Result<_, _>>()?;
    let count = angles.len();
    angles.try_into().map_err(|_| format!("{count} given, 3 needed; separate them by commas"))
}

/// The orbit in a file, with how well places between its rows are known.
pub(crate) fn table(file: &Path, gm: f64) -> Result<Orbit, Error> {
    let (times, places) = polhode_files::orbit::read(file)?;
    let name = file.display().to_string();
    let name = visible(&name);
    let orbit =
        Orbit::table(gm, &times, &places).map_err(|error| Error::Input(format!("{name}: {error}")))?;
    if let (Some(error), Some([first, last])) = (orbit.interpolation_error(), orbit.span()) {
        tell(
            "note",
            &format!(
                "{name}: from {first:?} s to {last:?} s; positions between rows have errors of some {error:.0e} of the distance, from two interpolations"
            ),
        );
    }
    Ok(orbit)
}

/// Forces besides weight.
#[derive(Clone, Debug, Default)]
pub(crate) struct Forces {
    /// Mean motion, rad/s, and eccentricity.
    pub(crate) gravity_gradient: Option<[f64; 2]>,
    /// GM, m^3/s^2, least distance, m, eccentricity, and the time of the least distance, s.
    pub(crate) orbit: Option<[f64; 4]>,
    /// By a table of places, or that of the catalogue's body.
    pub(crate) placed: Option<Orbit>,
    /// Of either orbit: node, inclination and argument of the periapsis, rad.
    pub(crate) orbit_plane: Option<[f64; 3]>,
    /// N m, body axes.
    pub(crate) torque_body: Option<[f64; 3]>,
    /// N m, axes of space.
    pub(crate) torque_space: Option<[f64; 3]>,
    /// N m s and N m s^2.
    pub(crate) drag: Option<[f64; 2]>,
}

impl Forces {
    /// `body` with these forces.
    ///
    /// # Errors
    /// What is wrong with one of them, and its name.
    pub(crate) fn act_on(&self, mut body: Body) -> Result<Body, (&'static str, ForceError)> {
        let ellipse = self.gravity_gradient.map(|[mean_motion, eccentricity]| {
            Orbit::ellipse(mean_motion, eccentricity).map_err(|error| ("gravity-gradient", error))
        });
        let conic = self.orbit.map(|[gm, periapsis, eccentricity, time]| {
            let orbit = Orbit::conic(gm, periapsis, eccentricity).and_then(|orbit| orbit.passing_at(time));
            orbit.map_err(|error| ("orbit", error))
        });
        if let Some(orbit) = ellipse.or(conic).or(self.placed.clone().map(Ok)).transpose()? {
            let turned = match self.orbit_plane {
                None => Ok(orbit),
                Some(angles) => orbit.in_plane(angles),
            };
            body = body.with(Force::gravity_gradient_on(turned.map_err(|error| ("orbit-plane", error))?));
        }
        if let Some(torque) = self.torque_body {
            let force = Force::constant_torque_body(torque.into());
            body = body.with(force.map_err(|error| ("torque-body", error))?);
        }
        if let Some(torque) = self.torque_space {
            let force = Force::constant_torque_space(torque.into());
            body = body.with(force.map_err(|error| ("torque-space", error))?);
        }
        if let Some([linear, quadratic]) = self.drag {
            body = body.with(Force::drag(linear, quadratic).map_err(|error| ("drag", error))?);
        }
        Ok(body)
    }
}

impl ForceArguments {
    /// Whether a flag names a force.
    pub(crate) fn is_any(&self) -> bool {
        self.weight_moment.is_some()
            || self.gravity_gradient.is_some()
            || self.orbit.is_some()
            || self.orbit_plane.is_some()
            || self.orbit_table.is_some()
            || self.torque_body.is_some()
            || self.torque_space.is_some()
            || self.drag.is_some()
    }

    /// Whether a flag names a torque in N m or what makes one.
    pub(crate) fn is_sized(&self) -> bool {
        self.weight_moment.is_some()
            || self.torque_body.is_some()
            || self.torque_space.is_some()
            || self.drag.is_some()
    }

    /// Whether a flag names an orbit.
    pub(crate) fn has_orbit(&self) -> bool {
        self.gravity_gradient.is_some() || self.orbit.is_some() || self.orbit_table.is_some()
    }

    /// `body` with the forces besides its weight; `own` is the orbit that it has where no flag names one.
    pub(crate) fn act_on(&self, body: Body, own: Option<Orbit>) -> Result<Body, Error> {
        if self.orbit_plane.is_some() && self.gravity_gradient.is_none() && self.orbit.is_none() {
            return Err(Error::Input(format!(
                "--orbit-plane: {NO_ORBIT}; add --orbit or --gravity-gradient"
            )));
        }
        let table = match (&self.orbit_table, self.gm) {
            (Some(file), Some(gm)) => Some(table(file, gm)?),
            _ => own.filter(|_| !self.has_orbit()),
        };
        let pair = |typed: Option<OneOrTwo>| typed.map(|OneOrTwo(pair)| pair);
        let forces = Forces {
            gravity_gradient: pair(self.gravity_gradient),
            orbit: self.orbit.map(|ThreeOrFour(numbers)| numbers),
            placed: table,
            orbit_plane: self.orbit_plane,
            torque_body: self.torque_body,
            torque_space: self.torque_space,
            drag: pair(self.drag),
        };
        forces.act_on(body).map_err(|(name, error)| Error::Input(format!("--{name}: {error}")))
    }
}
