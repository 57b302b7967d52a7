//! The method of Crouch and Grossman of order 3, `crouch-grossman-3`.

use super::lie_group::{LieGroup, of};

impl LieGroup {
    /// One exponential for each stage.
    pub const CROUCH_GROSSMAN_3: LieGroup = LieGroup {
        name: "crouch-grossman-3",
        order: 3,
        source: "Crouch and Grossman, J. Nonlinear Sci. 3 (1993) 1; Hairer, Lubich and Wanner, Geometric Numerical Integration, IV.8.1",
        stages: &[&[], &[of(&[(3.0, 4.0)])], &[of(&[(119.0, 216.0)]), of(&[(0.0, 1.0), (17.0, 108.0)])]],
        last: &[
            of(&[(13.0, 51.0)]),
            of(&[(0.0, 1.0), (-2.0, 3.0)]),
            of(&[(0.0, 1.0), (0.0, 1.0), (24.0, 17.0)]),
        ],
    };
}
