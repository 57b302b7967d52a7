//! The Runge–Kutta–Munthe-Kaas method of order 4, `rkmk4`.

use super::lie_group::{LieGroup, of, with_bracket};

impl LieGroup {
    /// The classical Runge–Kutta method in the algebra, with the brackets that its order needs.
    pub const RKMK_4: LieGroup = LieGroup {
        name: "rkmk4",
        order: 4,
        source: "Munthe-Kaas, Appl. Numer. Math. 29 (1999) 115",
        stages: &[
            &[],
            &[of(&[(1.0, 2.0)])],
            &[with_bracket(&[(0.0, 1.0), (1.0, 2.0)], 0, 1, (1.0, 8.0))],
            &[of(&[(0.0, 1.0), (0.0, 1.0), (1.0, 1.0)])],
        ],
        last: &[with_bracket(&[(1.0, 6.0), (1.0, 3.0), (1.0, 3.0), (1.0, 6.0)], 0, 3, (1.0, 12.0))],
    };
}
