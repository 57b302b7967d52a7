//! Numerics that methods share: iterations, turns, modified energies.

pub(super) mod cayley;
pub(super) mod impulse;
pub(super) mod length;
pub(super) mod modified_energy;
pub(super) mod quadratic;
pub(super) mod stagnation;
pub(super) mod turns;
