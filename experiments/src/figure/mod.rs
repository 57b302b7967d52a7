//! Figures as SVG, for a column of an article: curves over common axes, readable in grey.
//!
//! Log axes span the data; what is zero there is drawn on a marked floor, never dropped. Up to five curves have a legend, more
//! have their names beside their ends; a scatter of points always has a legend.

mod axis;
mod draw;
mod labels;

use plotters::prelude::*;

pub(crate) use axis::{Scale, ten_to};

use crate::error::Error;
use crate::experiment::Drawing;

/// A named curve.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    /// Its name, in the legend or beside its end.
    pub(crate) name: String,
    /// Points, ascending in x.
    pub(crate) points: Vec<(f64, f64)>,
    /// Of each point the lowest and the highest value, drawn as a bar; none where it is empty.
    spread: Vec<(f64, f64)>,
    /// Whether it is drawn twice as wide, without marks.
    wide: bool,
}

/// A line that readers compare curves with.
#[derive(Clone, Debug)]
struct Guide {
    label: String,
    /// Of a log-log plot y ∝ x^slope.
    slope: f64,
    /// A point that it goes through.
    through: (f64, f64),
    /// The abscissas between which it is drawn.
    ends: Option<[f64; 2]>,
}

/// Curves over common axes.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// File name without ending.
    pub(crate) name: &'static str,
    /// Above the plot: what is seen, of which bodies, with which steps.
    pub(crate) title: String,
    /// Below the plot, with unit.
    pub(crate) x: &'static str,
    /// Beside the plot, with unit.
    pub(crate) y: &'static str,
    scales: [Scale; 2],
    /// Whether lines join the points of a series.
    joined: bool,
    /// The curves.
    pub(crate) series: Vec<Series>,
    guides: Vec<Guide>,
}

impl Series {
    pub(crate) fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, spread: Vec::new(), wide: false }
    }

    /// With a bar from the lowest to the highest value at each point.
    pub(crate) fn with_spread(self, spread: Vec<(f64, f64)>) -> Self {
        Self { spread, ..self }
    }

    /// Drawn twice as wide and without marks, as an envelope is.
    pub(crate) fn wide(self) -> Self {
        Self { wide: true, ..self }
    }
}

impl Figure {
    /// A figure without curves, with axes of the given scales: below, and beside.
    pub(crate) fn new(
        name: &'static str,
        title: impl Into<String>,
        (x, x_scale): (&'static str, Scale),
        (y, y_scale): (&'static str, Scale),
    ) -> Self {
        let scales = [x_scale, y_scale];
        Self { name, title: title.into(), x, y, scales, joined: true, series: Vec::new(), guides: Vec::new() }
    }

    /// A figure without curves, both axes logarithmic.
    pub(crate) fn log_log(
        name: &'static str,
        title: impl Into<String>,
        x: &'static str,
        y: &'static str,
    ) -> Self {
        Self::new(name, title, (x, Scale::Log), (y, Scale::Log))
    }

    /// The same, with points that are not joined by lines.
    pub(crate) fn scatter(self) -> Self {
        Self { joined: false, ..self }
    }

    /// A dotted line of the slope `slope` through a point, of a figure with two logarithmic axes; `ends` are the abscissas
    /// between which it is drawn.
    pub(crate) fn guide(
        &mut self,
        label: impl Into<String>,
        slope: f64,
        through: (f64, f64),
        ends: [f64; 2],
    ) {
        self.guides.push(Guide { label: label.into(), slope, through, ends: Some(ends) });
    }

    /// A dotted level line from side to side.
    pub(crate) fn level(&mut self, label: impl Into<String>, y: f64) {
        self.guides.push(Guide { label: label.into(), slope: 0.0, through: (1.0, y), ends: None });
    }

    /// The figure as SVG.
    pub(crate) fn svg(&self) -> Result<String, Error> {
        draw::svg(self.name, "", 1, &[self])
    }
}

/// Several figures as one, `columns` side by side, with `title` above them.
///
/// # Errors
/// A figure that cannot be drawn.
pub(crate) fn sheet(
    name: &'static str,
    title: &str,
    columns: usize,
    panels: &[Figure],
) -> Result<Drawing, Error> {
    let svg = draw::svg(name, title, columns, &panels.iter().collect::<Vec<_>>())?;
    Ok(Drawing { name, svg })
}

/// Distinct in colour, and next to each other also in grey.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(curves: usize) -> Figure {
        let mut figure = Figure::log_log("test", "Curves & more", "steps", "error (rad)");
        for k in 0..curves {
            let curve = (1..9).map(|n| (f64::from(n), f64::from(n) * libm::exp10(-(k as f64)))).collect();
            figure.series.push(Series::new(format!("curve-{k}"), curve));
        }
        figure
    }

    /// Lines of text of an SVG.
    fn texts(svg: &str) -> Vec<String> {
        let document = roxmltree::Document::parse(svg).unwrap();
        let texts = document.descendants().filter(|node| node.has_tag_name("text"));
        texts.map(|node| node.text().unwrap_or_default().trim().to_string()).collect()
    }

    #[test]
    fn each_curve_is_named_once_however_many_there_are() {
        for curves in [2, 5, 6, 24] {
            let texts = texts(&figure(curves).svg().unwrap());
            for k in 0..curves {
                let name = format!("curve-{k}");
                assert_eq!(texts.iter().filter(|text| **text == name).count(), 1, "{curves}: {texts:?}");
            }
        }
    }

    #[test]
    fn labels_beside_the_ends_of_curves_do_not_overlap() {
        let svg = figure(24).svg().unwrap();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let names = document.descendants().filter(|n| n.text().is_some_and(|t| t.contains("curve-")));
        let mut heights: Vec<f64> =
            names.filter(|n| n.has_tag_name("text")).filter_map(|n| n.attribute("y")?.parse().ok()).collect();
        heights.sort_by(f64::total_cmp);
        assert_eq!(heights.len(), 24);
        assert!(heights.windows(2).all(|pair| pair[1] - pair[0] >= 12.0), "{heights:?}");
    }

    #[test]
    fn guides_levels_and_panels_are_drawn_and_named() {
        let mut one = figure(2);
        one.guide("slope 1", 1.0, (2.0, 1.0), [1.0, 4.0]);
        one.level("lost beyond 1 rad", 1.0);
        one.series.push(Series::new("envelope", vec![(1.0, 2.0), (8.0, 3.0)]).wide());
        let drawing = sheet("sheet", "Two panels", 2, &[one, figure(7)]).unwrap();
        let texts = texts(&drawing.svg);
        for name in ["slope 1", "lost beyond 1 rad", "envelope", "Two panels", "curve-6"] {
            assert!(texts.iter().any(|text| text == name), "{name}: {texts:?}");
        }
    }
}
