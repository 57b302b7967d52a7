//! What `<compiler>` says of masses and angles.

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Inertia, InertiaError, MassError, MassProperties};

use super::super::element::Element;
use super::super::pose::Pose;
use super::super::{SETTINGS, link};
use super::Given;
use super::orientation::orientation;

/// Where the inertia of a body comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// The element `<inertial>`, and the geoms of bodies without one.
    Either,
    /// `<inertial>` alone.
    Inertial,
    /// The geoms, whatever `<inertial>` says.
    Geoms,
}

#[derive(Debug)]
pub(super) struct Compiler {
    pub(super) source: Source,
    /// Radians of one unit of the angles.
    pub(super) angle: f64,
    pub(super) sequence: String,
    /// Groups whose geoms have mass.
    pub(super) groups: [f64; 2],
    least_mass: f64,
    least_moment: f64,
    /// Whether moments that violate the triangle inequality are set to their mean.
    balances: bool,
    total_mass: Option<f64>,
    /// The row that says why that is not obeyed.
    unscaled: Option<Given>,
}

impl Compiler {
    /// Of all elements of a model; of an attribute that is given twice the last counts. A row for each that cannot be read.
    pub(super) fn of(all: &[&Element]) -> (Self, Vec<Given>) {
        let mut settings = Compiler {
            source: Source::Either,
            angle: core::f64::consts::PI / 180.0,
            sequence: "xyz".into(),
            groups: [0.0, 5.0],
            least_mass: 0.0,
            least_moment: 0.0,
            balances: false,
            total_mass: None,
            unscaled: None,
        };
        let mut unread = Vec::new();
        for element in all.iter().filter(|element| element.tag == "compiler") {
            let mut defect = |defect: String| unread.push(link(SETTINGS, element, Err(defect)));
            let unknown = |attribute: &str, value: &str, known: &str| {
                element.error(&format!("{attribute}: '{value}' is unknown; known: {known}"))
            };
            match element.attribute("inertiafromgeom") {
                Some("true") => settings.source = Source::Geoms,
                Some("false") => settings.source = Source::Inertial,
                Some("auto") => settings.source = Source::Either,
                Some(other) => defect(unknown("inertiafromgeom", other, "auto, false, true")),
                None => {}
            }
            match element.attribute("angle") {
                Some("radian") => settings.angle = 1.0,
                Some("degree") => settings.angle = core::f64::consts::PI / 180.0,
                Some(other) => defect(unknown("angle", other, "degree, radian")),
                None => {}
            }
            match element.attribute("balanceinertia") {
                Some("true") => settings.balances = true,
                Some("false") => settings.balances = false,
                Some(other) => defect(unknown("balanceinertia", other, "false, true")),
                None => {}
            }
            if let Some(other) = element.attribute("coordinate").filter(|frame| *frame != "local") {
                let rule = format!("coordinate: '{other}' is not read; write the model in local coordinates");
                defect(element.error(&rule));
            }
            if let Some(sequence) = element.attribute("eulerseq") {
                settings.sequence = sequence.into();
            }
            match element.optional::<2>("inertiagrouprange") {
                Ok(groups) => settings.groups = groups.unwrap_or(settings.groups),
                Err(error) => defect(error),
            }
            let mut number = |attribute| match element.optional::<1>(attribute) {
                Ok(found) => found.map(|[value]| value),
                Err(error) => {
                    defect(error);
                    None
                }
            };
            settings.least_mass = number("boundmass").unwrap_or(settings.least_mass);
            settings.least_moment = number("boundinertia").unwrap_or(settings.least_moment);
            if let Some(total) = number("settotalmass") {
                let rule = "settotalmass: not every body can be read, so that masses stay as they are";
                settings.total_mass = Some(total);
                settings.unscaled = Some(link(SETTINGS, element, Err(element.error(rule))));
            }
        }
        (settings, unread)
    }

    /// The place and orientation of an element.
    pub(super) fn pose(&self, element: &Element) -> Result<Pose, String> {
        let at = Vector3::from(element.optional::<3>("pos")?.unwrap_or_default());
        Ok(Pose { at, turn: orientation(element, self)? })
    }

    /// Least masses and moments, the mean of moments that no body has, then the total mass. That needs every body: where one is missing, a row
    /// says so.
    pub(super) fn adjust(&self, bodies: &mut [Given], is_whole: bool) -> Option<Given> {
        for body in bodies.iter_mut().filter(|body| body.defect.is_none()) {
            self.raise(body);
            self.balance(body);
        }
        let total = self.total_mass.filter(|total| *total > 0.0)?;
        if !is_whole || bodies.iter().any(|body| body.defect.is_some()) {
            return self.unscaled.clone();
        }
        let sum: f64 = bodies.iter().filter_map(|body| body.mass).sum();
        if sum <= 0.0 {
            return None;
        }
        for body in bodies.iter_mut() {
            let factor = total / sum;
            body.mass = body.mass.map(|mass| mass * factor);
            body.tensor *= factor;
            if !body.massless && body.defect.is_none() {
                body.writing = None; // what stands in the file is another tensor
                body.add_remark(&format!("scaled so that all bodies have {total} kg (settotalmass)"));
            }
        }
        None
    }

    fn raise(&self, body: &mut Given) {
        if self.least_mass > 0.0 && body.mass.is_none_or(|mass| mass < self.least_mass) {
            body.mass = Some(self.least_mass);
            body.massless = false;
            body.add_remark(&format!("raised to the least mass of {} kg (boundmass)", self.least_mass));
        }
        let Some(mass) = body.mass.filter(|_| self.least_moment > 0.0) else { return };
        let least = self.least_moment;
        if body.tensor == Matrix3::zeros() {
            body.tensor = Matrix3::identity() * least;
        } else {
            let (moments, axes) = match MassProperties::new(mass, Vector3::zeros(), body.tensor) {
                Ok(known) => {
                    let axes = known.principal_axes().to_rotation_matrix();
                    (Vector3::from(known.principal_moments()), *axes.matrix())
                }
                // raised moments may be those of a body
                Err(MassError::Inertia(InertiaError::Triangle { .. })) => {
                    let found = body.tensor.symmetric_eigen();
                    (found.eigenvalues, found.eigenvectors)
                }
                Err(_) => return,
            };
            if moments.min() >= least {
                return;
            }
            let raised = moments.map(|moment| (least - moment).max(0.0));
            let more = axes * Matrix3::from_diagonal(&raised) * axes.transpose();
            body.tensor += (more + more.transpose()) * 0.5;
        }
        body.writing = None;
        body.add_remark(&format!("moments raised to at least {least} kg m^2 (boundinertia)"));
    }

    fn balance(&self, body: &mut Given) {
        let law = match Inertia::from_tensor(body.tensor) {
            Err(law @ InertiaError::Triangle { .. }) if self.balances => law,
            _ => return,
        };
        body.tensor = Matrix3::identity() * (body.tensor.trace() / 3.0);
        body.writing = None;
        body.add_remark(&format!("all moments are set to their mean (balanceinertia), since {law}"));
    }
}
