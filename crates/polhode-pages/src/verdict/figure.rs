//! The errors of a record against time, in four panels.

use crate::figure::{Curve, Drawing, Figure, Scale, sheet};
use polhode::audit::Traces;

use super::outcome::Outcome;

/// The errors of one panel.
type Values = fn(&Traces) -> &[f64];

/// Energy, |m|, direction of L and attitude, on logarithmic axes for both signs; what the record does not tell is left out.
pub fn panels(name: &str, outcomes: &[Outcome]) -> Drawing {
    let panels: [(&str, &str, Values); 4] = [
        ("Energy", "relative change", |traces| &traces.energy),
        ("|m|", "relative change", |traces| &traces.momentum_norm),
        ("Direction of L in space", "angle (rad)", |traces| &traces.momentum_direction),
        ("Attitude", "angle from the motion (rad)", |traces| &traces.attitude),
    ];
    let told = |values: Values| outcomes.iter().any(|outcome| !values(&outcome.verdict.traces).is_empty());
    let drawn = panels.into_iter().filter(|(_, _, values)| told(*values)).map(|(title, unit, values)| {
        let mut figure = Figure::new("audit", title, ("time (s)", Scale::Linear), (unit, Scale::Signed));
        for outcome in outcomes.iter().take(MOST_BODIES) {
            let traces = &outcome.verdict.traces;
            let points: Vec<(f64, f64)> =
                traces.times.iter().copied().zip(values(traces).iter().copied()).collect();
            if !points.is_empty() {
                let name = outcome.body.clone().unwrap_or_else(|| "record".into());
                figure.series.push(Curve::new(name, points));
            }
        }
        figure
    });
    let title = match outcomes {
        [one] => format!("{name}: {}", one.judgement()),
        several => format!("{name}: {} bodies", several.len()),
    };
    sheet("audit", &title, 2, &drawn.collect::<Vec<_>>())
}

/// Bodies whose curves are drawn.
const MOST_BODIES: usize = 5;
