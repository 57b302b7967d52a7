//! The body and the start about which members are spread, and what acts on them.

use std::path::Path;

use nalgebra::Matrix3;
use polhode::body::{Body, Orbit, WheelAtStart};
use polhode::catalogue;
use polhode::flow::TumblingElements;
use polhode::inertia::Inertia;
use polhode::rotation::{Quat, Vec3};
use polhode_files::bodies::is_mesh;
use polhode_files::error::{Error, tell};
use polhode_files::instant::{Epoch, date, time_scale};
use polhode_files::toml_file::Section;
use polhode_files::wheel;

use super::{Acting, elements};
use crate::flags::body::{Described, check_size, described, note_density};
use crate::flags::force::{Forces, NO_ORBIT, conic, plane, table};
use crate::flags::start::{Factor, angle_unit, rate_unit};

/// What `[body]`, `[start]` and `[force]` say.
#[derive(Debug)]
pub(super) struct Nominal {
    /// `None` where a file of members states it row by row.
    pub(super) inertia: Option<Inertia>,
    pub(super) attitude: Quat<f64>,
    /// `None` where a file of members states it row by row.
    pub(super) omega: Option<Vec3<f64>>,
    pub(super) acting: Acting,
    pub(super) units: Units,
    /// The elements that `[start]` gives in place of an angular velocity.
    pub(super) elements: Option<TumblingElements>,
    /// The date of t = 0.
    pub(super) epoch: Option<Epoch>,
}

/// In which units angles and rates are typed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    /// rad/s.
    pub(super) rate: f64,
    /// rad.
    pub(super) angle: f64,
}

impl Units {
    fn read(start: &Section<'_>) -> Result<Self, Error> {
        let unit = |key: &str, of: fn(&str) -> Result<Factor, String>| match start.text(key)? {
            None => Ok(1.0),
            Some(name) => of(name).map(|Factor(unit)| unit).map_err(|error| start.at(key, &error)),
        };
        Ok(Self { rate: unit("rate_unit", rate_unit)?, angle: unit("angle_unit", angle_unit)? })
    }
}

impl Nominal {
    /// `listed`: whether members come from a file, which may state what is missing here.
    pub(super) fn read(
        body: &Section<'_>,
        start: &Section<'_>,
        force: &Section<'_>,
        listed: bool,
    ) -> Result<Self, Error> {
        body.only("[body]", &["moments", "inertia", "body", "wheels"])?;
        let known = ["omega", "attitude", "rate_unit", "angle_unit", "epoch", "time_scale"];
        start.only("[start]", &[&known[..], &elements::START].concat())?;
        let units = Units::read(start)?;
        let epoch = epoch(start)?;
        let keys = body.keys.keys().map(|key| key.get_ref().as_ref());
        let given: Vec<&str> = keys.filter(|key| *key != "wheels").collect();
        let found = match given[..] {
            [] if listed => None,
            [] => return Err(body.at("moments", "missing in [body]; give moments, inertia or body")),
            [key] => Some(inertia(body, key)?),
            [first, second, ..] => {
                return Err(body.at(second, &format!("given beside {first}; leave one of them out")));
            }
        };
        let elements = elements::elements(start, units, None)?;
        if elements.is_some() {
            if let Some(key) = ["omega", "attitude"].into_iter().find(|key| start.value(key).is_some()) {
                return Err(start.at(key, "given beside periods; leave one of them out"));
            }
            if listed {
                return Err(start.at("periods", "given beside members_file, which lists the starts"));
            }
        }
        let published =
            body.text("body")?.and_then(|name| catalogue::body(name).or_else(|| catalogue::top(name)));
        let typed = start.numbers::<4>("attitude")?;
        if typed == Some([0.0; 4]) {
            return Err(
                start.at("attitude", "the zero quaternion is not a rotation; any other norm is accepted")
            );
        }
        let omega = start.numbers::<3>("omega")?.map(|omega| omega.map(|rate| rate * units.rate));
        if let (None, None, Some(published)) = (typed, &elements, &published) {
            tell("note", &format!("{}: {}", published.name, published.attitude_known()));
        }
        let attitude =
            typed.or(published.as_ref().map(|found| found.attitude)).unwrap_or([1.0, 0.0, 0.0, 0.0]);
        let omega = omega.or(published.map(|found| found.omega_body));
        let (attitude, omega) = match (&elements, &found) {
            (Some(elements), Some(found)) => {
                let body = Body::free(found.inertia.clone());
                let point = elements.point(body.inertia());
                let point = point.map_err(|error| start.at("periods", &error.to_string()))?;
                (body.leave(&point).attitude.components(), Some(body.omega_of(&point).into()))
            }
            _ => (attitude, omega),
        };
        if omega.is_none() && !listed {
            return Err(start.at(
                "omega",
                "missing in [start]; give [wx, wy, wz] in rad/s, or another rate_unit, or periods and mode",
            ));
        }
        let own = found.as_ref().map_or([0.0; 3], |found| found.weight_moment);
        let wheels = wheels(body, found.as_ref())?;
        if elements.is_some() && !wheels.is_empty() {
            return Err(
                start.at("periods", "elements are those of the motion of a body without wheels; give omega")
            );
        }
        let orbit = found.as_ref().and_then(|found| found.orbit.clone());
        let nominal = Self {
            inertia: found.map(|found| found.inertia),
            attitude: Quat::from_components(attitude),
            omega: omega.map(Vec3),
            acting: Acting { wheels, ..acting(force, own, orbit)? },
            units,
            elements,
            epoch,
        };
        if let Some(name) = body.text("body")? {
            let beside = beside(body, name);
            let file: &str = if is_mesh(&beside) { &beside } else { name };
            if nominal.acting.is_sized() {
                check_size(file).map_err(|error| of_body(body, &error))?;
            } else if is_mesh(file) {
                note_density(file);
            }
        }
        if let Some(inertia) = &nominal.inertia {
            nominal.check(body, force, start, inertia)?;
        }
        Ok(nominal)
    }

    /// Whether body, weight, forces and start go together.
    fn check(
        &self,
        body: &Section<'_>,
        force: &Section<'_>,
        start: &Section<'_>,
        inertia: &Inertia,
    ) -> Result<(), Error> {
        let free = Body::free(inertia.clone());
        let carried = free.with_wheels_at_start(&self.acting.wheels, 0.0, Default::default());
        let _ = carried.map_err(|error| body.at("wheels", &error.to_string()))?;
        let heavy = Body::heavy(inertia.clone(), self.acting.weight_moment.into());
        let heavy = heavy.map_err(|error| force.at("weight_moment", &error.to_string()))?;
        let body = self.acting.forces.act_on(heavy);
        let body = body.map_err(|(name, error)| force.at(&name.replace('-', "_"), &error.to_string()))?;
        match self.omega.map(|omega| body.enter_omega(self.attitude, omega)) {
            Some(Err(error)) => Err(start.at("omega", &error.to_string())),
            _ => Ok(()),
        }
    }
}

/// The date of t = 0, and the scale of dates without one.
fn epoch(start: &Section<'_>) -> Result<Option<Epoch>, Error> {
    let read = |key: &str, error: String| start.at(key, &error);
    let scale = start.text("time_scale")?.map(time_scale).transpose();
    let scale = scale.map_err(|error| read("time_scale", error))?;
    let found = start.text("epoch")?.map(date).transpose().map_err(|error| read("epoch", error))?;
    if let (None, Some(_)) = (found, scale) {
        return Err(start.at("time_scale", "belongs to dates; give epoch, the date of t = 0, too"));
    }
    Ok(found.map(|date| Epoch::new(date, scale)))
}

fn inertia(body: &Section<'_>, key: &str) -> Result<Described, Error> {
    let refused = |error: &dyn std::fmt::Display| body.at(key, &error.to_string());
    if let Some(moments) = body.numbers::<3>("moments")? {
        return Inertia::from_moments(moments).map(Described::alone).map_err(|error| refused(&error));
    }
    if let Some([xx, yy, zz, xy, xz, yz]) = body.numbers::<6>("inertia")? {
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        return Inertia::from_tensor(tensor).map(Described::alone).map_err(|error| refused(&error));
    }
    let name = body.text("body")?.unwrap_or_default();
    let beside = beside(body, name);
    let is_known = catalogue::body(name).or_else(|| catalogue::top(name)).is_some();
    let found = if is_known { described(name) } else { described(&beside) };
    let is_here = is_known || Path::new(&beside).exists();
    let found = found.or_else(|error| if is_here { Err(error) } else { described(name) });
    found.map_err(|error| of_body(body, &error))
}

/// A file is looked for beside the specification.
fn beside(body: &Section<'_>, name: &str) -> String {
    body.file.path.parent().unwrap_or(Path::new("")).join(name).display().to_string()
}

/// What is wrong with the body that the key `body` names.
fn of_body(body: &Section<'_>, error: &Error) -> Error {
    let message = error.to_string();
    body.at("body", message.strip_prefix("--body: ").unwrap_or(&message))
}

/// The wheels of every member: those of the body's file and of `wheels` in `[body]`.
fn wheels(body: &Section<'_>, found: Option<&Described>) -> Result<Vec<WheelAtStart>, Error> {
    let mut given = found.map_or(Vec::new(), |found| found.wheels.clone());
    given.extend(wheel::list_of_toml(body)?);
    Ok(given)
}

/// What acts, by `[force]` or, of the weight and the orbit, by the catalogue.
fn acting(force: &Section<'_>, own: [f64; 3], own_orbit: Option<Orbit>) -> Result<Acting, Error> {
    force.only(
        "[force]",
        &[
            "weight_moment",
            "gravity_gradient",
            "orbit",
            "orbit_plane",
            "orbit_table",
            "gm",
            "torque_body",
            "torque_space",
            "drag",
        ],
    )?;
    let one_or_two = |key: &str| -> Result<Option<[f64; 2]>, Error> {
        match force.list(key)?.as_deref() {
            None => Ok(None),
            Some([one]) => Ok(Some([*one, 0.0])),
            Some([one, two]) => Ok(Some([*one, *two])),
            Some(found) => Err(force.at(key, &format!("{} given, 1 or 2 needed", found.len()))),
        }
    };
    let mut forces = Forces {
        gravity_gradient: one_or_two("gravity_gradient")?,
        orbit: match force.list("orbit")? {
            None => None,
            Some(numbers) => Some(conic(&numbers).map_err(|error| force.at("orbit", &error))?),
        },
        orbit_plane: match force.text("orbit_plane")? {
            None => None,
            Some(angles) => Some(plane(angles).map_err(|error| force.at("orbit_plane", &error))?),
        },
        placed: match (force.text("orbit_table")?, force.positive("gm")?) {
            (None, None) => None,
            (Some(name), Some(gm)) => {
                Some(table(&force.file.path.parent().unwrap_or(Path::new("")).join(name), gm)?)
            }
            (Some(_), None) => return Err(force.at("orbit_table", "needs gm, that of the attracting mass")),
            (None, Some(_)) => return Err(force.at("gm", "belongs to an orbit_table; give one")),
        },
        torque_body: force.numbers("torque_body")?,
        torque_space: force.numbers("torque_space")?,
        drag: one_or_two("drag")?,
    };
    if forces.placed.is_some()
        && let Some(key) =
            ["gravity_gradient", "orbit", "orbit_plane"].into_iter().find(|key| force.value(key).is_some())
    {
        return Err(force.at(key, "given beside orbit_table; leave one of them out"));
    }
    match (&forces.gravity_gradient, &forces.orbit, &forces.orbit_plane) {
        (Some(_), Some(_), _) => {
            return Err(force.at("orbit", "a body has one orbit, and gravity_gradient gives another"));
        }
        (None, None, Some(_)) => {
            return Err(force.at("orbit_plane", &format!("{NO_ORBIT}; add orbit or gravity_gradient")));
        }
        (None, None, None) if forces.placed.is_none() => forces.placed = own_orbit,
        _ => {}
    }
    Ok(Acting { weight_moment: force.numbers("weight_moment")?.unwrap_or(own), forces, wheels: Vec::new() })
}
