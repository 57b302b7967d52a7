//! The gyrostat: a rigid body with wheels at constant relative momentum h, its motion at any time (Volterra 1899).
//!
//! m = Iω + h is the total momentum in the body, `H = ½ (m − h)·I⁻¹(m − h)`, `m' = m × ω`, L = q m q* is constant. A wheel that
//! spins freely about the axis a with the axial momentum l is the same problem with I − I_w a aᵀ and h = l a.
//!
//! | file | what it works out |
//! |---|---|
//! | `level` | the curve H = E on the sphere \|m\| = G, in units of its own, with the start on it |
//! | `pencil` | the elliptic curve behind it, by the pencil of the two quadrics |
//! | `lattice`, `weierstrass` | its periods; the argument of a point on it |
//! | `spinor` | attitude and momentum by two theta functions of the second degree and one phase |
//! | `quick`, `dual`, `least` | both in `f64`, next to a separatrix, and m along the axis of a small moment |
//! | `orbit` | the motion from a start |
//! | `steady` | the two, four or six spins at which m stays in the body |

mod character;
mod dual;
mod error;
mod lattice;
mod least;
mod level;
mod motion;
mod orbit;
mod pencil;
mod quick;
mod spinor;
mod steady;
mod weierstrass;

pub use error::GyrostatError;
pub use motion::{GyrostatCharacter, GyrostatMotion, SteadySpin};
use orbit::GyrostatOrbit;
use steady::steady_spins;
