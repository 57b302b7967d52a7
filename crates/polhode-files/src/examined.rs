//! Bodies as they were given, with what the examination of their tensors found.

use std::fmt::Write;

use crate::given::Given;
use crate::text::{rounded, visible};
use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Diagnosis, Evidence, InertiaError, MassError, MassProperties, Validity, diagnose};

/// A body with what the examination of its tensor found.
#[derive(Clone, Debug)]
pub struct Examined {
    /// As it was given.
    pub given: Given,
    /// Absent of a link that states no tensor.
    pub diagnosis: Option<Diagnosis>,
    /// In the axes of the frame; of unit mass if none is known, and absent if no body that turns has the tensor.
    pub body: Option<MassProperties>,
    /// A point and the tensor about it, if there is one.
    pub about: Option<(Vector3<f64>, Option<Matrix3<f64>>)>,
}

/// What a body is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Worth {
    /// No law is broken, and no likelier tensor is near.
    Valid,
    /// Physically valid, but a common mistake explains it better, or it is odd.
    Suspicious,
    /// No body has it.
    Invalid,
    /// A frame without a body.
    Massless,
}

impl Worth {
    /// All of them.
    pub const ALL: [Worth; 4] = [Worth::Valid, Worth::Suspicious, Worth::Invalid, Worth::Massless];

    /// In one lowercase word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Worth::Valid => Validity::Valid.name(),
            Worth::Suspicious => Validity::Suspicious.name(),
            Worth::Invalid => Validity::Invalid.name(),
            Worth::Massless => "massless",
        }
    }
}

impl Examined {
    /// Examines `given`.
    ///
    /// # Errors
    /// Numbers without a meaning: a mass that is not positive, a tensor that is not symmetric.
    pub fn of(given: Given, point: Option<Vector3<f64>>) -> Result<Self, MassError> {
        if given.defect.is_some() || given.massless {
            return Ok(Examined {
                given,
                diagnosis: None,
                body: None,
                about: point.map(|point| (point, None)),
            });
        }
        let evidence = Evidence::default()
            .with_mass(given.mass)
            .with_center_of_mass(given.turn.inverse() * given.center_of_mass)
            .with_extents(given.extents)
            .with_twin(given.twin);
        let mut diagnosis = diagnose(given.tensor, &evidence)?;
        if given.computed && diagnosis.verdict == Validity::Suspicious {
            diagnosis.verdict = Validity::Valid;
            diagnosis.causes.clear();
            diagnosis.oddity = None;
        }
        if let Some(law @ InertiaError::NotSymmetric { .. }) = &diagnosis.violation {
            return Err(MassError::Inertia(law.clone()));
        }
        let body = match &diagnosis.violation {
            Some(_) => None,
            None if is_zero(&given.tensor) => None,
            None => {
                let mass = given.mass.unwrap_or(1.0);
                let body = MassProperties::new(mass, Vector3::zeros(), given.tensor)?;
                let body = MassProperties::new(
                    mass,
                    Vector3::zeros(),
                    without_noise(body.turned(given.turn).tensor()),
                )?;
                Some(body.moved(given.center_of_mass)?)
            }
        };
        let about = point.map(|point| (point, body.and_then(|body| body.tensor_about(point).ok())));
        Ok(Examined { given, diagnosis: Some(diagnosis), body, about })
    }

    /// A link of a model, whose trouble is its own.
    #[must_use]
    pub fn link(given: Given, point: Option<Vector3<f64>>) -> Self {
        let fallback = given.clone();
        Self::of(given, point).unwrap_or_else(|error| {
            let place = fallback.place.clone().map_or(String::new(), |place| format!("{place}: "));
            let given = Given { defect: Some(format!("{place}{error}")), ..fallback };
            Examined { given, diagnosis: None, body: None, about: point.map(|point| (point, None)) }
        })
    }

    /// Its name, and where it stands if it has none.
    #[must_use]
    pub fn name(&self) -> String {
        let name = visible(&self.given.name);
        match &self.given.place {
            Some(place) if name.is_empty() => format!("(unnamed, {})", visible(place)),
            _ => name.into(),
        }
    }

    /// What the tensor is worth; a point, which has none, does not turn.
    #[must_use]
    pub fn worth(&self) -> Worth {
        match &self.diagnosis {
            None if self.given.massless => Worth::Massless,
            None => Worth::Invalid,
            Some(_) if is_zero(&self.given.tensor) => Worth::Invalid,
            Some(found) => match found.verdict {
                Validity::Valid => Worth::Valid,
                Validity::Suspicious => Worth::Suspicious,
                _ => Worth::Invalid,
            },
        }
    }

    /// Which law is broken and by how much, in one sentence.
    #[must_use]
    pub fn trouble(&self) -> Option<String> {
        let Some(found) = &self.diagnosis else { return self.given.defect.clone() };
        if is_zero(&self.given.tensor) {
            return Some(ZERO.into());
        }
        if let Some(law) = &found.violation {
            return Some(law.to_string());
        }
        if let Some(misfit) = found.misfit {
            return Some(format!(
                "the second moment along {} is {:.4e} times the greatest that this mass and these extents allow",
                misfit.axis, misfit.ratio
            ));
        }
        match &found.oddity {
            Some(oddity) => Some(oddity.to_string()),
            None if found.verdict == Validity::Suspicious => {
                Some("valid, but implausible for the body described".into())
            }
            None => None,
        }
    }

    /// The probable cause, or the two between which nothing decides.
    #[must_use]
    pub fn cause(&self) -> Option<String> {
        let found = self.diagnosis.as_ref()?;
        match found.causes.as_slice() {
            [] => found.oddity.filter(|oddity| oddity.is_placeholder()).map(|oddity| oddity.to_string()),
            [first, second, ..] if first.is_tied_with(second) => {
                Some(format!("undecided: {}; or {}", first.cause, second.cause))
            }
            [first, ..] => Some(first.cause.to_string()),
        }
    }

    /// Everything that is to be said about a tensor that is not simply valid.
    #[must_use]
    pub fn report(&self) -> String {
        let name = match self.name() {
            name if name.is_empty() => "the tensor".into(),
            name => name,
        };
        let mut text = format!("{name}: {}", self.trouble().unwrap_or_default());
        let Some(found) = self.diagnosis.as_ref().filter(|_| !is_zero(&self.given.tensor)) else {
            return text;
        };
        let tied = matches!(found.causes.as_slice(), [first, second, ..] if first.is_tied_with(second));
        if tied {
            text += "\n  two causes explain it equally well; the mass and the extents of the body may decide";
        }
        for (place, explanation) in found.causes.iter().take(3).enumerate() {
            let entries = six(&explanation.corrected).map(rounded).join(",");
            let _ = write!(text, "\n  cause {}: {}\n    then it is {entries}", place + 1, explanation.cause);
        }
        if found.causes.is_empty() && found.oddity.is_none() {
            text += "\n  no single mistake of the kinds that are tested explains it";
        }
        if found.distance > 0.0 {
            let nearest = six(&found.nearest).map(rounded).join(",");
            let _ = write!(
                text,
                "\n  nearest valid tensor: {nearest}\n    Frobenius distance {:.6e}, {:.3} % of its norm",
                found.distance,
                100.0 * share_of_norm(found.distance, &self.given.tensor)
            );
        }
        let edges = found.equivalent_box;
        if edges.iter().all(|edge| edge.is_finite()) {
            // written out where that is short
            let short = edges[0] == 0.0 || (1e-3..1e6).contains(&edges[0]);
            let [a, b, c] =
                edges.map(|edge| if short { format!("{edge:.6}") } else { format!("{edge:.6e}") });
            let unit = if self.given.mass.is_some() { "m" } else { "(relative)" };
            let _ = write!(text, "\n  box of that inertia: {a} x {b} x {c} {unit}, along the principal axes");
        }
        text
    }
}

const ZERO: &str = "every entry of the tensor is zero, as of a point mass; give the sizes of a body, or its entries in a \
                    smaller unit";

fn is_zero(tensor: &Matrix3<f64>) -> bool {
    tensor.iter().all(|entry| *entry == 0.0)
}

/// Zero where a turn leaves no more than rounding.
fn without_noise(tensor: Matrix3<f64>) -> Matrix3<f64> {
    let rounding = f64::EPSILON * tensor.trace();
    tensor.map(|entry| if entry.abs() < rounding { 0.0 } else { entry })
}

/// `distance` over the norm of `tensor`, whose squares may be no doubles.
fn share_of_norm(distance: f64, tensor: &Matrix3<f64>) -> f64 {
    let largest = tensor.amax();
    distance / largest / tensor.map(|entry| entry / largest).norm()
}

/// Ixx, Iyy, Izz, Ixy, Ixz, Iyz, without signed zeros.
#[must_use]
pub fn six(tensor: &Matrix3<f64>) -> [f64; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|place| tensor[place] + 0.0)
}
