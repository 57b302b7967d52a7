//! The commutator-free method of order 4, `commutator-free-4`.

use super::lie_group::{LieGroup, of};

impl LieGroup {
    /// Two exponentials in place of the brackets.
    pub const COMMUTATOR_FREE_4: LieGroup = LieGroup {
        name: "commutator-free-4",
        order: 4,
        source: "Celledoni, Marthinsen and Owren, Future Gener. Comput. Syst. 19 (2003) 341",
        stages: &[
            &[],
            &[of(&[(1.0, 2.0)])],
            &[of(&[(0.0, 1.0), (1.0, 2.0)])],
            &[of(&[(1.0, 2.0)]), of(&[(-1.0, 2.0), (0.0, 1.0), (1.0, 1.0)])],
        ],
        last: &[
            of(&[(1.0, 4.0), (1.0, 6.0), (1.0, 6.0), (-1.0, 12.0)]),
            of(&[(-1.0, 12.0), (1.0, 6.0), (1.0, 6.0), (1.0, 4.0)]),
        ],
    };
}
