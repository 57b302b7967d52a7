//! What was checked of an answer.

/// What the solver's answer was checked against: largest residuals of the optimality conditions, in whitened units.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// |y + Σ multiplier · gradient| over 1 + |y|.
    pub stationarity: f64,
    /// Largest violation of a constraint, and |Z (½ − J)| over 1 + the largest multiplier, as shares of the trace.
    pub violation: f64,
    /// Most negative multiplier, over 1 + the largest.
    pub dual_violation: f64,
    /// Rounds of cuts until the physical law held.
    pub rounds: usize,
}
