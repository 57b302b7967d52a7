//! What the record says of the fit: verdicts, computed once and matched.

pub(crate) mod judgement;
pub(crate) mod mistaken_unit;
pub(crate) mod prior;
