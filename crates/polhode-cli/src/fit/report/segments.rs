//! The segments of a record as cells of a table.

use polhode_fit::{Estimate, SegmentSummary};

use super::concise;

/// What a table says of each segment, where there are several.
pub(in crate::fit) struct Segments {
    pub(in crate::fit) heads: Vec<&'static str>,
    /// Units of the columns and what they mean.
    pub(in crate::fit) legend: &'static str,
    /// Index of the segment in the record, and its cells.
    pub(in crate::fit) rows: Vec<(usize, Vec<String>)>,
}

const OF_RATES: &str = "noise: rad/s; torque: power spectral density of the angular acceleration by torque noise, (rad/s^2)^2 s; I1/I3, \
                        I2/I3: of the other segments, with standard deviations in brackets; shift: how far the tensor moves without the \
                        segment, in standard deviations";

const OF_ATTITUDES: &str = "left: rms of the residuals of a component of the rotation vector, rad; torque: power spectral density of the \
                            angular acceleration by torque noise, (rad/s^2)^2 s; I1/I3, I2/I3: of the other segments, with standard \
                            deviations in brackets; shift: how far the tensor moves without the segment, in standard deviations";

impl Segments {
    pub(in crate::fit) fn of(e: &Estimate) -> Self {
        let noise = e.attitudes.as_ref().map(|attitudes| attitudes.noise_sigma);
        let (second, legend) = if noise.is_some() { ("left", OF_ATTITUDES) } else { ("noise", OF_RATES) };
        let row = |s: &SegmentSummary| {
            let left =
                e.residuals.iter().find(|of| of.segment == s.segment).map_or(0.0, |of| of.mean_square.sqrt());
            let ratio = |k: usize| s.without.map_or("-".into(), |w| concise(w.ratios[k], w.sigma_ratios[k]));
            let cells = vec![
                s.samples.to_string(),
                format!("{:.2e}", noise.map_or(s.noise_sigma, |noise| noise * left)),
                if s.torque_noise > 0.0 { format!("{:.1e}", s.torque_noise) } else { "0".into() },
                format!("{:.3}", s.weight),
                ratio(0),
                ratio(1),
                s.without.map_or("-".into(), |w| format!("{:.2}", w.shift)),
            ];
            (s.segment, cells)
        };
        Segments {
            heads: vec!["samples", second, "torque", "weight", "I1/I3", "I2/I3", "shift"],
            legend,
            rows: e.per_segment.iter().map(row).collect(),
        }
    }
}
