//! The report: an estimate with its deviations, its scale, what the record leaves open, and what it contradicts.

pub(crate) mod answer;
pub(crate) mod attitudes;
pub(crate) mod averages;
pub(crate) mod deviations;
pub(crate) mod differing;
pub(crate) mod estimate;
pub(crate) mod exact;
pub(crate) mod facts;
pub(crate) mod identifiability;
pub(crate) mod likelihood;
pub(crate) mod mirror;
pub(crate) mod model;
pub(crate) mod motion;
pub(crate) mod next_step;
pub(crate) mod nuisance;
pub(crate) mod parts;
pub(crate) mod scale;
pub(crate) mod segments;
pub(crate) mod smoothed;
pub(crate) mod suspect;
pub(crate) mod systematic;
pub(crate) mod torque_free;
pub(crate) mod warning;
pub(crate) mod warnings;

#[cfg(test)]
mod tests;
