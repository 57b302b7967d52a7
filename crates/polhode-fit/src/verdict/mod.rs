//! What the record says of the fit.

pub(crate) mod mistaken_unit;
