//! What the record says of the fit: verdicts, computed once and matched.

pub(crate) mod axes;
pub(crate) mod driven;
pub(crate) mod judgement;
pub(crate) mod prior;
pub(crate) mod told;
pub(crate) mod units;
