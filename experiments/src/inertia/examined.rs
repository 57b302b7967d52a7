//! A body with what the examination of its tensor found.

use std::fmt::Write;

use nalgebra::{Matrix3, Vector3};
use polhode::inertia::{Diagnosis, Evidence, InertiaError, MassError, MassProperties, Verdict, diagnose};

use super::given::Given;
use crate::text::{short, visible};

pub(super) struct Examined {
    pub(super) given: Given,
    pub(super) diagnosis: Diagnosis,
    /// In the axes of the frame; of unit mass if none is known, and absent if no body that turns has the tensor.
    pub(super) body: Option<MassProperties>,
    /// A point and the tensor about it, if there is one.
    pub(super) about: Option<(Vector3<f64>, Option<Matrix3<f64>>)>,
}

impl Examined {
    /// Examines `given`.
    ///
    /// # Errors
    /// Numbers without a meaning: a mass that is not positive, a tensor that is not symmetric.
    pub(super) fn of(given: Given, point: Option<Vector3<f64>>) -> Result<Self, MassError> {
        let evidence = Evidence {
            mass: given.mass,
            center_of_mass: Some(given.turn.inverse() * given.center_of_mass),
            extents: given.extents,
        };
        let mut diagnosis = diagnose(given.tensor, &evidence)?;
        if given.computed && diagnosis.verdict == Verdict::Suspicious {
            diagnosis.verdict = Verdict::Valid;
            diagnosis.causes.clear();
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
                Some(body.turned(given.turn).moved(given.center_of_mass)?)
            }
        };
        let about = point.map(|point| (point, body.and_then(|body| body.tensor_about(point).ok())));
        Ok(Examined { given, diagnosis, body, about })
    }

    /// What the tensor is worth; a point, which has none, does not turn.
    pub(super) fn verdict(&self) -> Verdict {
        if is_zero(&self.given.tensor) { Verdict::Invalid } else { self.diagnosis.verdict }
    }

    pub(super) fn verdict_name(&self) -> &'static str {
        self.verdict().name()
    }

    /// Which law is broken and by how much, in one sentence.
    pub(super) fn trouble(&self) -> Option<String> {
        let found = &self.diagnosis;
        if is_zero(&self.given.tensor) {
            return Some(ZERO.into());
        }
        if let Some(law) = &found.violation {
            return Some(law.to_string());
        }
        found.misfit.map(|misfit| {
            format!(
                "the second moment along {} is {:.4e} times the greatest that this mass and these extents allow",
                misfit.axis, misfit.ratio
            )
        })
    }

    /// Everything that is to be said about a tensor that is not simply valid.
    pub(super) fn report(&self) -> String {
        let found = &self.diagnosis;
        let name = if self.given.name.is_empty() { "the tensor".into() } else { visible(&self.given.name) };
        let trouble = self.trouble().unwrap_or_else(|| "valid, but hardly of the body described".into());
        let mut text = format!("{name}: {trouble}");
        if is_zero(&self.given.tensor) {
            return text;
        }
        for (place, explanation) in found.causes.iter().take(3).enumerate() {
            let entries = six(&explanation.corrected).map(short).join(",");
            let _ = write!(text, "\n  cause {}: {}\n    then it is {entries}", place + 1, explanation.cause);
        }
        if found.causes.is_empty() {
            text += "\n  no single mistake of the kinds that are tested explains it";
        }
        if found.distance > 0.0 {
            let nearest = six(&found.nearest).map(short).join(",");
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

const ZERO: &str = "every entry of the tensor is zero, as of a point, which does not turn; give the sizes of a body, \
                    or its entries in a smaller unit";

fn is_zero(tensor: &Matrix3<f64>) -> bool {
    tensor.iter().all(|entry| *entry == 0.0)
}

/// `distance` over the norm of `tensor`, whose squares may be no doubles.
fn share_of_norm(distance: f64, tensor: &Matrix3<f64>) -> f64 {
    let largest = tensor.amax();
    distance / largest / tensor.map(|entry| entry / largest).norm()
}

/// Ixx, Iyy, Izz, Ixy, Ixz, Iyz, without signed zeros.
pub(super) fn six(tensor: &Matrix3<f64>) -> [f64; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|place| tensor[place] + 0.0)
}
