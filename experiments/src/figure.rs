//! Line figures as SVG. Log axes span the data; what is zero there is drawn on a marked floor, never dropped.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

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
    /// Whether lines join the points of a series.
    joined: bool,
    /// The curves.
    pub(crate) series: Vec<Series>,
}

const SIZE: (u32, u32) = (860, 520);
const LEGEND: u32 = 170;

/// Distinct in colour; in grey, marks and dashes tell the curves apart.
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

/// A logarithmic axis around the data, labelled at whole decades.
#[derive(Clone)]
struct Decades {
    first: f64,
    last: f64,
    /// The decade that stands for zero, if zeros are to be drawn.
    floor: Option<i32>,
}

impl Decades {
    fn over(values: impl Iterator<Item = f64> + Clone) -> Self {
        let positive = values.clone().filter(|v| *v > 0.0);
        let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
        let (low, high) = if low.is_finite() { (low, high) } else { (1.0, 1.0) };
        let (mut first, mut last) = (libm::log10(low), libm::log10(high));
        let zeros = values.into_iter().any(|v| v == 0.0);
        let floor = zeros.then(|| libm::floor(first + 1e-9) as i32 - 1);
        first = floor.map_or(first, f64::from);
        if libm::floor(last) - libm::ceil(first) < 1.0 {
            // two labels at least
            (first, last) = (libm::floor(first), libm::floor(last) + 1.0);
        }
        let margin = 0.03 * (last - first);
        Decades { first: first - margin, last: last + margin, floor }
    }

    /// Where `value` stands: its decimal logarithm, or the floor.
    fn place(&self, value: f64) -> f64 {
        match self.floor {
            Some(floor) if value == 0.0 => f64::from(floor),
            _ => libm::log10(value),
        }
    }
}

impl Ranged for Decades {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value - self.first) / (self.last - self.first);
        limit.0 + libm::round(share * f64::from(limit.1 - limit.0)) as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let (first, last) = (libm::ceil(self.first) as i32, libm::floor(self.last) as i32);
        let room = hint.max_num_points().clamp(2, 12) as i32;
        let every = ((last - first) / room + 1).max(1);
        // the floor is always labelled, and nothing that would touch its label
        let marks = (first..=last).filter(|k| match self.floor {
            Some(floor) => *k == floor || (k - last) % every == 0 && k - floor >= every,
            None => (k - last) % every == 0,
        });
        marks.map(f64::from).collect()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.first..self.last
    }
}

impl ValueFormatter<f64> for Decades {
    fn format_ext(&self, value: &f64) -> String {
        let power = libm::round(*value) as i32;
        if self.floor == Some(power) {
            return "0".into();
        }
        ten_to(power)
    }
}

/// A power of ten as it is printed, 10⁻³.
pub(crate) fn ten_to(power: i32) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    format!("10{}", power.to_string().chars().map(raised).collect::<String>())
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
        Self { name, title: title.into(), x, y, joined: true, series: Vec::new() }
    }

    /// The same, with points that are not joined by lines.
    pub(crate) fn scatter(self) -> Self {
        Self { joined: false, ..self }
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
        let (plot, legend) = area.split_horizontally(SIZE.0 - LEGEND);
        let mut chart = ChartBuilder::on(&plot)
            .caption(&self.title, ("sans-serif", 17))
            .margin(10)
            .margin_right(14)
            .x_label_area_size(48)
            .y_label_area_size(66)
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .x_desc(self.x)
            .y_desc(self.y)
            .axis_desc_style(("sans-serif", 15))
            .label_style(("sans-serif", 14))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .draw()?;
        for (k, series) in self.series.iter().enumerate() {
            let colour = COLOURS[k % COLOURS.len()];
            let places: Vec<_> = series.points.iter().map(|p| (x.place(p.0), y.place(p.1))).collect();
            if self.joined {
                let line = colour.stroke_width(2);
                if dashed(k) {
                    chart.draw_series(DashedLineSeries::new(places.iter().copied(), 7, 5, line))?;
                } else {
                    chart.draw_series(LineSeries::new(places.iter().copied(), line))?;
                }
            }
            let marks: Vec<_> =
                places.iter().map(|&at| EmptyElement::at(at) + mark(k, (0, 0), colour)).collect();
            chart.draw_series(marks)?;
            let at = (4, 52 + 24 * k as i32);
            if self.joined {
                let ends: &[[i32; 2]] = if dashed(k) { &[[0, 9], [21, 30]] } else { &[[0, 30]] };
                for [from, to] in ends {
                    let ends = [(at.0 + from, at.1), (at.0 + to, at.1)];
                    legend.draw(&PathElement::new(ends, colour.stroke_width(2)))?;
                }
            }
            legend.draw(&mark(k, (at.0 + 15, at.1), colour))?;
            let text = ("sans-serif", 14).into_text_style(&legend).pos(Pos::new(HPos::Left, VPos::Center));
            legend.draw(&Text::new(series.name.as_str(), (at.0 + 38, at.1), text))?;
        }
        area.present()
    }
}

/// Every second curve, so that two that coincide are both seen.
fn dashed(k: usize) -> bool {
    k % 2 == 1
}

/// The mark of the k-th series: filled ones are small and the others hollow, so that one is seen within the other.
fn mark<B: DrawingBackend>(
    k: usize,
    (x, y): (i32, i32),
    colour: RGBColor,
) -> DynElement<'static, B, (i32, i32)> {
    let thin = colour.stroke_width(1);
    match k % 8 {
        0 => Circle::new((x, y), 3, colour.filled()).into_dyn(),
        1 => Rectangle::new([(x - 5, y - 5), (x + 5, y + 5)], thin).into_dyn(),
        2 => TriangleMarker::new((x, y), 4, colour.filled()).into_dyn(),
        3 => Circle::new((x, y), 6, thin).into_dyn(),
        4 => Rectangle::new([(x - 3, y - 3), (x + 3, y + 3)], colour.filled()).into_dyn(),
        5 => Cross::new((x, y), 5, thin).into_dyn(),
        6 => Polygon::new([(x, y - 4), (x + 4, y), (x, y + 4), (x - 4, y)], colour.filled()).into_dyn(),
        _ => PathElement::new([(x, y - 7), (x + 7, y), (x, y + 7), (x - 7, y), (x, y - 7)], thin).into_dyn(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_stand_on_a_floor_below_the_smallest_value() {
        let decades = Decades::over([0.0, 3e-12, 2e-3].into_iter());
        assert_eq!(decades.floor, Some(-13));
        assert_eq!(decades.place(0.0), -13.0);
        assert_eq!(decades.format_ext(&-13.0), "0");
        assert_eq!(decades.format_ext(&-12.0), "10⁻¹²");
        assert_eq!(decades.format_ext(&30.0), "10³⁰");
    }

    #[test]
    fn every_value_lies_on_the_axis_and_two_decades_are_labelled() {
        for values in [[1e-16, 1.0], [2e-300, 9e-1], [10.0, 10.0], [0.0, 0.0], [0.0, 7.0], [2.0, 9.0]] {
            let decades = Decades::over(values.into_iter());
            for value in values {
                assert!(decades.range().contains(&decades.place(value)), "{values:?}");
            }
            assert!(decades.key_points(10).len() >= 2, "{values:?}");
        }
    }
}
