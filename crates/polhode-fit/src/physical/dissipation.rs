//! Drag takes energy: its coefficients are not negative.

use nalgebra::DVector;

use crate::physical::constraint::Constraint;

/// A coefficient of drag that is not negative, by its place among the unknowns of the program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dissipation {
    pub(crate) place: usize,
    pub(crate) name: &'static str,
}

impl Dissipation {
    pub(crate) fn constraint(self) -> Constraint {
        Constraint::Drag { name: self.name }
    }

    /// Whether unknowns obey it.
    pub(crate) fn allows(self, z: &DVector<f64>) -> bool {
        z[self.place] >= 0.0
    }

    /// Takes off what rounding leaves below zero.
    pub(crate) fn clip(self, z: &mut DVector<f64>) {
        z[self.place] = z[self.place].max(0.0);
    }
}
