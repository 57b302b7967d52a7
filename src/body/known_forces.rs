//! Forces whose laws are known, for steps of many bodies side by side.

use nalgebra::Matrix3;

use super::drag::Drag;
use super::{Body, LinearPotential, Orbit};
use crate::rotation::Quat;

/// All that acts on a body, in the form in which [`Forces`](super::Forces) sums it up.
#[derive(Debug)]
pub(crate) struct KnownForces {
    /// Uniform gravity, in the solver frame.
    pub(crate) linear: Option<LinearPotential<f64>>,
    /// Besides it, in SI units and body axes.
    pub(crate) gradient: Option<(Matrix3<f64>, Orbit)>,
    pub(crate) drag: Option<Drag>,
    /// Takes coordinates along principal axes to body coordinates; `None` where they are the same.
    pub(crate) frame: Option<Quat<f64>>,
    /// What divides the torque.
    pub(crate) scale: f64,
}

impl Body {
    /// What acts on it, where that is no more than uniform gravity, a gravity gradient and a drag, always.
    pub(crate) fn known_forces(&self) -> Option<KnownForces> {
        let frame =
            (!self.inertia().is_along_principal_axes()).then(|| self.inertia().frame().map(|x| x.hi()));
        let (linear, scale) = (self.linear_potential(), self.scale());
        let mut known = KnownForces { linear, gradient: None, drag: None, frame, scale };
        for force in self.remainder() {
            if force.switched.is_some() {
                return None;
            }
            match (&force.orbit, force.drag) {
                (Some(orbit), None) if known.gradient.is_none() => {
                    known.gradient = Some((self.inertia().tensor(), orbit.clone()));
                }
                (None, Some(drag)) if known.drag.is_none() => known.drag = Some(drag),
                _ => return None,
            }
        }
        self.wheels().is_empty().then_some(known)
    }
}
