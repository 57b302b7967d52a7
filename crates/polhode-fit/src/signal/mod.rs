//! Samples, test functions and their sums, and the covariance of the noise in them.

pub(crate) mod banded;
pub(crate) mod covariance;
pub(crate) mod filtered;
pub(crate) mod moments;
pub(crate) mod noise;
pub(crate) mod normalised;
pub(crate) mod quadrature;
pub(crate) mod stretch;
pub(crate) mod terms;
pub(crate) mod test_functions;
pub(crate) mod zeros;

#[cfg(test)]
mod tests;
