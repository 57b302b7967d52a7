//! Conditions that hold a tensor, or that no tensor satisfies.

use core::fmt;

use nalgebra::Vector3;

/// A condition on the tensor, or on the drag.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    /// I₁ + I₂ ≥ I₃: no moment exceeds half the trace.
    Triangle,
    /// I₁ + I₂ ≥ I₃ and I₁ + I₃ ≥ I₂ at once: two moments of half the trace.
    Rod,
    /// A lower limit that the user set.
    AtLeast {
        /// Which of the limits, from 1.
        limit: usize,
        /// Its axis as given, sensor axes.
        axis: Vector3<f64>,
        /// The least moment about it, as a share of the trace.
        share: f64,
    },
    /// An upper limit that the user set.
    AtMost {
        /// Which of the limits, from 1.
        limit: usize,
        /// Its axis as given, sensor axes.
        axis: Vector3<f64>,
        /// The largest moment about it, as a share of the trace.
        share: f64,
    },
    /// A coefficient of drag is not negative: drag takes energy.
    Drag {
        /// Its name, as `drag`.
        name: &'static str,
    },
}

impl fmt::Display for Constraint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (limit, n, relation, share) = match self {
            Self::Triangle => return f.write_str("I1 + I2 >= I3"),
            Self::Rod => return f.write_str("I1 + I2 >= I3 and I1 + I3 >= I2 (a rod)"),
            Self::Drag { name } => return write!(f, "{name} >= 0 (drag takes energy)"),
            Self::AtLeast { limit, axis, share } => (limit, axis, ">=", share),
            Self::AtMost { limit, axis, share } => (limit, axis, "<=", share),
        };
        write!(f, "limit {limit}: moment about ({}, {}, {}) {relation} {share} of the trace", n.x, n.y, n.z)
    }
}

/// A constraint that holds the answer.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct ActiveConstraint {
    /// The constraint.
    pub constraint: Constraint,
    /// Its multiplier: the decrease of χ²/2 per unit of its relaxation, ≥ 0.
    pub multiplier: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A constraint is said with its number, its axis, its side and its share.
    #[test]
    fn constraints_say_which_they_are() {
        let (axis, share) = (Vector3::new(1.0, 0.0, -0.5), 0.25);
        let says = |constraint: Constraint| constraint.to_string();
        assert_eq!(says(Constraint::Triangle), "I1 + I2 >= I3");
        assert_eq!(says(Constraint::Rod), "I1 + I2 >= I3 and I1 + I3 >= I2 (a rod)");
        assert_eq!(says(Constraint::Drag { name: "drag_xx" }), "drag_xx >= 0 (drag takes energy)");
        assert_eq!(
            says(Constraint::AtLeast { limit: 2, axis, share }),
            "limit 2: moment about (1, 0, -0.5) >= 0.25 of the trace"
        );
        assert_eq!(
            says(Constraint::AtMost { limit: 3, axis, share }),
            "limit 3: moment about (1, 0, -0.5) <= 0.25 of the trace"
        );
    }
}
