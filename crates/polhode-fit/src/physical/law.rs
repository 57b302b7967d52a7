//! The one law of a tensor of trace 1: no moment exceeds half the trace.

/// The largest share of the trace that a moment can have: the other two together are not less.
pub(crate) const LARGEST_SHARE: f64 = 0.5;
