//! Plots of a fit against time.

use polhode_fit::{Estimate, Method};
use polhode_pages::figure::{Curve, Figure, Scale};

/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Width of a plot against time, pixels.
pub(super) const WIDTH: f64 = 860.0;

/// A plot against time, without curves; `single` says that there are no gaps to leave out.
pub(super) fn over_time(title: impl Into<String>, y: &str, single: bool, height: f64) -> Figure {
    let x = if single { "time (s)" } else { "time without the gaps between segments (s)" };
    Figure::new("fit", title, (x, Scale::Linear), (y, Scale::Linear)).sized(WIDTH, height)
}

/// Times with the gaps between segments left out, so that short tosses fill the axis.
pub(super) fn without_gaps<'a>(segments: impl Iterator<Item = &'a [f64]>) -> Vec<Vec<f64>> {
    let mut end = 0.0;
    segments
        .map(|times| {
            let first = times.first().copied().unwrap_or(0.0);
            let shifted: Vec<f64> = times.iter().map(|t| t - first + end).collect();
            end = shifted.last().copied().unwrap_or(end);
            shifted
        })
        .collect()
}

/// What the residuals are of.
pub(super) fn what(estimate: &Estimate) -> &'static str {
    match estimate.method {
        Method::ExactMotion if estimate.attitudes.is_none() => "the rates",
        Method::ExactMotion | Method::Smoother => "the attitudes, rotation vectors in body axes,",
        _ => "the weak equations",
    }
}

/// Whitened residuals of each component over time; a band marks two standard deviations.
pub(super) fn residuals(estimate: &Estimate) -> Figure {
    let single = estimate.residuals.len() == 1;
    let times: Vec<Vec<f64>> = if single {
        estimate.residuals.iter().map(|r| r.times.clone()).collect()
    } else {
        without_gaps(estimate.residuals.iter().map(|r| r.times.as_slice()))
    };
    let values = || times.iter().flatten().zip(estimate.residuals.iter().flat_map(|r| &r.values));
    let title = match estimate.method {
        Method::ExactMotion if estimate.attitudes.is_none() => {
            "Residuals of the rates; grey: two standard deviations to each side"
        }
        Method::ExactMotion | Method::Smoother => {
            "Residuals of the attitudes; grey: two standard deviations to each side"
        }
        _ => "Whitened residuals of the weak equations; grey: two standard deviations to each side",
    };
    let mut figure = over_time(title, "residual (std. deviations)", single, 380.0);
    figure.band(2.0);
    figure.series = (0..3)
        .map(|axis| Curve::new(AXES[axis], values().map(|(t, v)| (*t, v[axis])).collect()).dots())
        .collect();
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_closed() {
        let joined = without_gaps([[5.0, 6.0].as_slice(), [100.0, 102.0].as_slice()].into_iter());
        assert_eq!(joined, [vec![0.0, 1.0], vec![1.0, 3.0]]);
    }
}
