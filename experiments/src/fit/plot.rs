//! Residuals against time.

use plotters::prelude::*;
use polhode::fit::Estimate;

use crate::error::Error;

const SIZE: (u32, u32) = (900, 420);
const COLOURS: [RGBColor; 3] = [RGBColor(0, 0, 0), RGBColor(213, 94, 0), RGBColor(0, 114, 178)];

/// Whitened residuals of each component over time; a band marks two standard deviations.
pub(super) fn residuals(estimate: &Estimate) -> Result<String, Error> {
    let mut svg = String::new();
    draw(estimate, &SVGBackend::with_string(&mut svg, SIZE).into_drawing_area())
        .map_err(|error| Error::Failed(format!("residuals: {error}")))?;
    Ok(svg)
}

fn draw<B: DrawingBackend>(
    estimate: &Estimate,
    area: &DrawingArea<B, plotters::coord::Shift>,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let points = || estimate.residuals.iter().flat_map(|r| r.times.iter().zip(&r.values));
    let (first, last) =
        points().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (t, _)| (a.min(*t), b.max(*t)));
    let highest = points().flat_map(|(_, v)| v.map(f64::abs)).fold(4.0, f64::max);
    let margin = 0.02 * (last - first).max(f64::MIN_POSITIVE);
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(area)
        .caption("Whitened residuals of the weak equations", ("sans-serif", 17))
        .margin(10)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(first - margin..last + margin, -1.05 * highest..1.05 * highest)?;
    chart
        .configure_mesh()
        .x_desc("time (s)")
        .y_desc("residual (standard deviations)")
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    chart.draw_series([Rectangle::new([(first, -2.0), (last, 2.0)], BLACK.mix(0.07).filled())])?;
    for (axis, (colour, name)) in COLOURS.into_iter().zip(["x", "y", "z"]).enumerate() {
        chart
            .draw_series(points().map(|(t, v)| Circle::new((*t, v[axis]), 2, colour.filled())))?
            .label(name)
            .legend(move |at| Circle::new(at, 3, colour.filled()));
    }
    chart.configure_series_labels().background_style(WHITE).border_style(BLACK.mix(0.3)).draw()?;
    area.present()
}
