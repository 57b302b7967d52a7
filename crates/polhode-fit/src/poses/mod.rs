//! Measured attitudes: a record of them, and the fit of a tensor to it.

pub(crate) mod clean;
pub(crate) mod error;
pub(crate) mod fault;
pub(crate) mod fit;
pub(crate) mod free;
pub(crate) mod misread;
pub(crate) mod moving;
pub(crate) mod record;
