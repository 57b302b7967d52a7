//! Plots against time: linear axes, the legend beside the data.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use polhode::fit::Estimate;

use crate::error::Error;

const COLOURS: [RGBColor; 3] = [RGBColor(0, 0, 0), RGBColor(213, 94, 0), RGBColor(0, 114, 178)];
/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];
const LEGEND: u32 = 110;
/// Points of a curve beyond which every so many-th is drawn.
const MOST_POINTS: usize = 1500;

/// How the points of a curve are drawn.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Style {
    Line,
    Dots,
}

/// A named curve.
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) colour: usize,
    pub(super) style: Style,
    pub(super) points: Vec<(f64, f64)>,
}

/// A plot with linear axes.
pub(super) struct Plot<'a> {
    pub(super) title: &'a str,
    pub(super) x: &'a str,
    pub(super) y: &'a str,
    /// Half width of a grey band about zero.
    pub(super) band: Option<f64>,
    pub(super) size: (u32, u32),
    pub(super) curves: Vec<Curve>,
}

impl Plot<'_> {
    pub(super) fn svg(&self) -> Result<String, Error> {
        let mut svg = String::new();
        self.draw(&SVGBackend::with_string(&mut svg, self.size).into_drawing_area())
            .map_err(|error| Error::Failed(format!("{}: {error}", self.title)))?;
        Ok(svg)
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let points = || self.curves.iter().flat_map(|curve| curve.points.iter());
        let x = span(points().map(|p| p.0), 0.01);
        let band = self.band.into_iter().flat_map(|b| [-b, b]);
        let y = span(points().map(|p| p.1).chain(band), 0.05);
        let (wide, high) = (x.end - x.start, y.end - y.start);
        area.fill(&WHITE)?;
        let (plot, legend) = area.split_horizontally(self.size.0 - LEGEND);
        let mut chart = ChartBuilder::on(&plot)
            .caption(self.title, ("sans-serif", 15))
            .margin(8)
            .margin_right(14)
            .x_label_area_size(40)
            .y_label_area_size(70)
            .build_cartesian_2d(x.clone(), y)?;
        chart
            .configure_mesh()
            .x_desc(self.x)
            .y_desc(self.y)
            .axis_desc_style(("sans-serif", 13))
            .label_style(("sans-serif", 12))
            .x_label_formatter(&|v| tick(*v, wide))
            .y_label_formatter(&|v| tick(*v, high))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .draw()?;
        if let Some(band) = self.band {
            chart
                .draw_series([Rectangle::new([(x.start, -band), (x.end, band)], BLACK.mix(0.07).filled())])?;
        }
        for (k, curve) in self.curves.iter().enumerate() {
            let colour = COLOURS[curve.colour % COLOURS.len()];
            let every = curve.points.len().div_ceil(MOST_POINTS).max(1);
            let points = curve.points.iter().step_by(every).copied();
            let at = (8, 44 + 20 * k as i32);
            if curve.style == Style::Line {
                chart.draw_series(LineSeries::new(points, colour.stroke_width(2)))?;
                legend.draw(&PathElement::new([at, (at.0 + 20, at.1)], colour.stroke_width(2)))?;
                // in grey the letter tells the curves apart
                if let (Some(end), Some(letter)) = (curve.points.last(), curve.name.get(..1)) {
                    let style =
                        ("sans-serif", 13).into_text_style(&plot).pos(Pos::new(HPos::Left, VPos::Center));
                    let text = EmptyElement::at(*end) + Text::new(letter.to_string(), (4, 0), style);
                    chart.draw_series([text])?;
                }
            } else {
                let marks = points.map(|p| EmptyElement::at(p) + mark(curve.colour, (0, 0), colour));
                chart.draw_series(marks.collect::<Vec<_>>())?;
                legend.draw(&mark(curve.colour, (at.0 + 10, at.1), colour))?;
            }
            let text = ("sans-serif", 12).into_text_style(&legend).pos(Pos::new(HPos::Left, VPos::Center));
            legend.draw(&Text::new(curve.name.as_str(), (at.0 + 26, at.1), text))?;
        }
        area.present()
    }
}

/// The mark of a colour, so that grey tells them apart too.
fn mark<B: DrawingBackend>(
    k: usize,
    at: (i32, i32),
    colour: RGBColor,
) -> plotters::element::DynElement<'static, B, (i32, i32)> {
    let faint = colour.mix(0.4);
    match k % COLOURS.len() {
        0 => Circle::new(at, 2, faint.filled()).into_dyn(),
        1 => Cross::new(at, 2, faint.stroke_width(1)).into_dyn(),
        _ => TriangleMarker::new(at, 3, faint.filled()).into_dyn(),
    }
}

/// The values with a margin, a share of their span.
fn span(values: impl Iterator<Item = f64>, margin: f64) -> std::ops::Range<f64> {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
    let width = if high > low { high - low } else { f64::max(low.abs(), 1.0) };
    low - margin * width..high + margin * width
}

/// A label of an axis of length `width`: no needless zeros, a true minus.
fn tick(value: f64, width: f64) -> String {
    let value = if value.abs() < 1e-9 * width { 0.0 } else { value };
    let fixed = format!("{value:.9}");
    let short = fixed.trim_end_matches('0').trim_end_matches('.');
    let short = if value != 0.0 && value.abs() < 1e-4 { format!("{value:e}") } else { short.to_string() };
    if short == "-0" { "0".into() } else { short.replace('-', "\u{2212}") }
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

/// Whitened residuals of each component over time; a band marks two standard deviations.
pub(super) fn residuals(estimate: &Estimate) -> Result<String, Error> {
    let single = estimate.residuals.len() == 1;
    let times: Vec<Vec<f64>> = if single {
        estimate.residuals.iter().map(|r| r.times.clone()).collect()
    } else {
        without_gaps(estimate.residuals.iter().map(|r| r.times.as_slice()))
    };
    let values = || times.iter().flatten().zip(estimate.residuals.iter().flat_map(|r| &r.values));
    let curves = (0..3).map(|axis| Curve {
        name: AXES[axis].into(),
        colour: axis,
        style: Style::Dots,
        points: values().map(|(t, v)| (*t, v[axis])).collect(),
    });
    let plot = Plot {
        title: "Whitened residuals of the weak equations",
        x: if single { "time (s)" } else { "time without the gaps between segments (s)" },
        y: "residual (standard deviations)",
        band: Some(2.0),
        size: (900, 380),
        curves: curves.collect(),
    };
    plot.svg()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_short_and_gaps_are_closed() {
        for (value, label) in [(0.0, "0"), (-0.5, "\u{2212}0.5"), (1500.0, "1500"), (2e-5, "2e\u{2212}5")] {
            assert_eq!(tick(value, 1.0), label);
        }
        assert_eq!(tick(-9e-16, 1.0), "0");
        let joined = without_gaps([[5.0, 6.0].as_slice(), [100.0, 102.0].as_slice()].into_iter());
        assert_eq!(joined, [vec![0.0, 1.0], vec![1.0, 3.0]]);
        assert_eq!(span([2.0, 2.0].into_iter(), 0.5), 1.0..3.0);
    }
}
