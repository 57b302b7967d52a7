//! What principal moments say about the shape of a body.

use super::checks::ROUNDING;

/// Which principal moments agree, up to rounding (1e-12 of the trace).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// All three differ.
    Asymmetric,
    /// The two larger moments agree: elongated, like a rod. The axes of the pair are arbitrary.
    Prolate,
    /// The two smaller moments agree: flattened, like a disk. The axes of the pair are arbitrary.
    Oblate,
    /// All three agree, as of a sphere or a cube. All axes are arbitrary.
    Spherical,
}

impl Symmetry {
    /// Of ascending moments.
    pub(super) fn of([low, middle, high]: [f64; 3]) -> Self {
        let rounding = ROUNDING * (low + middle + high);
        match (middle - low <= rounding, high - middle <= rounding) {
            (true, true) => Symmetry::Spherical,
            (true, false) => Symmetry::Oblate,
            (false, true) => Symmetry::Prolate,
            (false, false) => Symmetry::Asymmetric,
        }
    }

    /// In one lowercase word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Symmetry::Asymmetric => "asymmetric",
            Symmetry::Prolate => "prolate",
            Symmetry::Oblate => "oblate",
            Symmetry::Spherical => "spherical",
        }
    }
}

/// What the principal moments say about the shape of a body, up to rounding (1e-12 of the trace).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// All mass in one point: no moment.
    Point,
    /// All mass on a line: the moment about it is zero, the other two agree.
    Linear,
    /// All mass in a plane: I₃ = I₁ + I₂. A disk, whose two smaller moments agree as well, is planar here.
    Planar,
    /// A body with extent in all three directions.
    Solid(Symmetry),
}

impl Class {
    /// In one lowercase word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Class::Point => "point",
            Class::Linear => "linear",
            Class::Planar => "planar",
            Class::Solid(symmetry) => symmetry.name(),
        }
    }
}
