//! Line figures as SVG. Log axes span the data; what is zero there is drawn on a marked floor, never dropped.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;

use crate::error::Error;

/// A named curve.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    /// Entry of the legend.
    pub(crate) name: String,
    /// Points, ascending in x.
    pub(crate) points: Vec<(f64, f64)>,
}

/// Curves over common axes.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// File name without ending.
    pub(crate) name: &'static str,
    /// Above the plot.
    pub(crate) title: String,
    /// Below the plot, with unit.
    pub(crate) x: &'static str,
    /// Beside the plot, with unit.
    pub(crate) y: &'static str,
    /// The curves.
    pub(crate) series: Vec<Series>,
}

const SIZE: (u32, u32) = (760, 520);
/// Distinct in colour and, by their marks, in grey.
const COLOURS: [RGBColor; 9] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(150, 110, 0),
    RGBColor(86, 180, 233),
    RGBColor(120, 120, 120),
    RGBColor(170, 30, 60),
];

/// A logarithmic axis over whole decades, labelled at them.
#[derive(Clone)]
struct Decades {
    first: i32,
    last: i32,
    /// What the lowest decade stands for when it is the floor of zeros.
    floor: bool,
}

impl Decades {
    fn over(values: impl Iterator<Item = f64> + Clone) -> Self {
        let positive = values.clone().filter(|v| *v > 0.0);
        let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
        let floor = values.into_iter().any(|v| v == 0.0);
        if !low.is_finite() {
            return Decades { first: -1, last: 1, floor };
        }
        let first = libm::floor(libm::log10(low) + 1e-9) as i32 - i32::from(floor);
        let last = (libm::ceil(libm::log10(high) - 1e-9) as i32).max(first + 1);
        Decades { first, last, floor }
    }

    /// Where `value` stands: its decimal logarithm, or the floor.
    fn place(&self, value: f64) -> f64 {
        if value > 0.0 { libm::log10(value) } else { f64::from(self.first) }
    }
}

impl Ranged for Decades {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - f64::from(self.first)) / f64::from(self.last - self.first);
        limit.0 + libm::round(share * f64::from(limit.1 - limit.0)) as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let room = hint.max_num_points().clamp(2, 12) as i32;
        let every = ((self.last - self.first) / room + 1).max(1);
        let marks = (self.first..=self.last)
            .filter(|k| (k - self.last) % every == 0 || (self.floor && *k == self.first));
        marks.map(f64::from).collect()
    }

    fn range(&self) -> std::ops::Range<f64> {
        f64::from(self.first)..f64::from(self.last)
    }
}

impl ValueFormatter<f64> for Decades {
    fn format_ext(&self, value: &f64) -> String {
        let power = libm::round(*value) as i32;
        if self.floor && power == self.first { "0".into() } else { format!("1e{power}") }
    }
}

impl Series {
    pub(crate) fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points }
    }
}

impl Figure {
    /// A figure without curves, both axes logarithmic.
    pub(crate) fn log_log(
        name: &'static str,
        title: impl Into<String>,
        x: &'static str,
        y: &'static str,
    ) -> Self {
        Self { name, title: title.into(), x, y, series: Vec::new() }
    }

    /// The figure as SVG, both axes logarithmic.
    pub(crate) fn svg(&self) -> Result<String, Error> {
        let mut svg = String::new();
        self.draw(&SVGBackend::with_string(&mut svg, SIZE).into_drawing_area())
            .map_err(|error| Error::Failed(format!("figure {}: {error}", self.name)))?;
        Ok(svg)
    }

    fn draw<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let points = || self.series.iter().flat_map(|s| s.points.iter());
        let (x, y) = (Decades::over(points().map(|p| p.0)), Decades::over(points().map(|p| p.1)));
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(area)
            .caption(&self.title, ("sans-serif", 17))
            .margin(10)
            .margin_right(16)
            .x_label_area_size(44)
            .y_label_area_size(62)
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .x_desc(self.x)
            .y_desc(self.y)
            .axis_desc_style(("sans-serif", 15))
            .label_style(("sans-serif", 13))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .draw()?;
        for (k, series) in self.series.iter().enumerate() {
            let colour = COLOURS[k % COLOURS.len()];
            let places: Vec<_> = series.points.iter().map(|p| (x.place(p.0), y.place(p.1))).collect();
            chart
                .draw_series(LineSeries::new(places.iter().copied(), colour.stroke_width(2)))?
                .label(&series.name)
                .legend(move |at| {
                    EmptyElement::at(at)
                        + PathElement::new([(0, 0), (22, 0)], colour.stroke_width(2))
                        + mark(k, (11, 0), colour)
                });
            let drawn: Vec<_> =
                places.iter().map(|&at| EmptyElement::at(at) + mark(k, (0, 0), colour)).collect();
            chart.draw_series(drawn)?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .label_font(("sans-serif", 13))
            .draw()?;
        area.present()
    }
}

/// The mark of the k-th series: a shape of its own.
fn mark<B: DrawingBackend>(
    k: usize,
    (x, y): (i32, i32),
    colour: RGBColor,
) -> DynElement<'static, B, (i32, i32)> {
    match k % 5 {
        0 => Circle::new((x, y), 3, colour.filled()).into_dyn(),
        1 => Rectangle::new([(x - 3, y - 3), (x + 3, y + 3)], colour.filled()).into_dyn(),
        2 => TriangleMarker::new((x, y), 4, colour.filled()).into_dyn(),
        3 => Cross::new((x, y), 3, colour.stroke_width(2)).into_dyn(),
        _ => Circle::new((x, y), 4, colour.stroke_width(1)).into_dyn(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_stand_on_a_floor_below_the_smallest_value() {
        let decades = Decades::over([0.0, 3e-12, 2e-3].into_iter());
        assert_eq!((decades.first, decades.last), (-13, -2));
        assert_eq!(decades.place(0.0), -13.0);
        assert_eq!(decades.format_ext(&-13.0), "0");
        assert_eq!(decades.format_ext(&-12.0), "1e-12");
    }

    #[test]
    fn every_value_lies_on_the_axis() {
        for values in [[1e-16, 1.0], [2e-300, 9e-1], [10.0, 10.0]] {
            let decades = Decades::over(values.into_iter());
            for value in values {
                assert!(
                    decades.range().start <= decades.place(value)
                        && decades.place(value) <= decades.range().end
                );
            }
        }
    }
}
