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

#[cfg(test)]
mod tests {
    use super::*;

    /// Zero is no gain of energy; what is below it is, and is taken off alone.
    #[test]
    fn a_coefficient_of_drag_is_zero_or_more() {
        let mut z = DVector::from_vec(vec![-1e-3, 0.0, -2.0]);
        let of = |place| Dissipation { place, name: "drag_yy" };
        assert!(!of(0).allows(&z) && of(1).allows(&z) && !of(2).allows(&z));
        of(0).clip(&mut z);
        of(1).clip(&mut z);
        assert_eq!(z, DVector::from_vec(vec![0.0, 0.0, -2.0]));
        assert!(of(0).allows(&z));
        z[0] = 0.5;
        of(0).clip(&mut z);
        assert_eq!(z[0], 0.5);
        assert_eq!(of(0).constraint(), Constraint::Drag { name: "drag_yy" });
    }
}
