//! Figures for a column of an article, readable in grey, as SVG and PNG: one style, a page, plots and views of the sphere.
//!
//! Log axes span the data; what is zero there is drawn on a marked floor, never dropped. Curves have their names beside their
//! ends; a scatter of points has a legend above the plot.

mod axis;
mod canvas;
mod font;
mod labels;
mod latex;
mod marks;
mod names;
mod plot;
mod png;
mod rows;
pub mod sphere;
pub mod style;
mod svg;

pub use axis::{Scale, ten_to};
pub use canvas::{Anchor, Canvas, Fill, Stroke};
pub use latex::latex;
pub use rows::{Group, RowPlot, Values};

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
    /// A line with marks.
    Marked,
    /// A line.
    Plain,
    /// A line twice as wide.
    Wide,
    /// A dot for each point.
    Dots,
}

/// A finished SVG.
pub struct Drawing {
    /// File name without ending.
    pub name: &'static str,
    /// Its text.
    pub svg: String,
}

/// A named curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name, in the legend or beside its end; nothing for a curve that another one names.
    pub name: String,
    /// Points, ascending in x.
    pub points: Vec<(f64, f64)>,
    /// Of each point the lowest and the highest value, drawn as a bar; none where it is empty.
    spread: Vec<(f64, f64)>,
    look: Look,
    /// Its number among the colours, where it is not its place in the figure.
    colour: Option<usize>,
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

/// Moments that are marked above the plot.
#[derive(Clone, Debug)]
struct Events {
    label: String,
    /// What they are, for those who read the SVG.
    class: &'static str,
    at: Vec<f64>,
}

/// Curves over common axes.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without ending.
    pub name: &'static str,
    /// Above the plot: what is seen, of which bodies, with which steps.
    pub title: String,
    /// Below the plot, with unit.
    pub x: String,
    /// Beside the plot, with unit.
    pub y: String,
    scales: [Scale; 2],
    /// Whether lines join the points of a series.
    joined: bool,
    /// Whether both axes have the same scale.
    equal: bool,
    /// Width and height, pixels, where they are not those of a column.
    size: Option<[f64; 2]>,
    /// Half width of a grey band about zero.
    band: Option<f64>,
    /// The curves.
    pub series: Vec<Curve>,
    guides: Vec<Guide>,
    events: Vec<Events>,
}

impl Curve {
    /// A curve through points, with a mark at each.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, spread: Vec::new(), look: Look::Marked, colour: None }
    }

    /// With a bar from the lowest to the highest value at each point.
    pub fn with_spread(self, spread: Vec<(f64, f64)>) -> Self {
        Self { spread, ..self }
    }

    /// One more point, with a bar from the lowest to the highest value.
    pub fn push(&mut self, point: (f64, f64), bar: (f64, f64)) {
        self.points.push(point);
        self.spread.push(bar);
    }

    /// Drawn twice as wide and without marks, as an envelope is.
    pub fn wide(self) -> Self {
        Self { look: Look::Wide, ..self }
    }

    /// Drawn without marks.
    pub fn plain(self) -> Self {
        Self { look: Look::Plain, ..self }
    }

    /// Drawn as a dot for each point, as measurements are.
    pub fn dots(self) -> Self {
        Self { look: Look::Dots, ..self }
    }

    /// In the k-th colour.
    pub fn coloured(self, k: usize) -> Self {
        Self { colour: Some(k), ..self }
    }
}

impl Figure {
    /// A figure without curves, with axes of the given scales: below, and beside.
    pub fn new(
        name: &'static str,
        title: impl Into<String>,
        (x, x_scale): (impl Into<String>, Scale),
        (y, y_scale): (impl Into<String>, Scale),
    ) -> Self {
        Self {
            name,
            title: title.into(),
            x: x.into(),
            y: y.into(),
            scales: [x_scale, y_scale],
            joined: true,
            equal: false,
            size: None,
            band: None,
            series: Vec::new(),
            guides: Vec::new(),
            events: Vec::new(),
        }
    }

    /// A figure without curves, both axes logarithmic.
    pub fn log_log(
        name: &'static str,
        title: impl Into<String>,
        x: impl Into<String>,
        y: impl Into<String>,
    ) -> Self {
        Self::new(name, title, (x, Scale::Log), (y, Scale::Log))
    }

    /// The same, with points that are not joined by lines.
    pub fn scatter(self) -> Self {
        Self { joined: false, ..self }
    }

    /// The same, with one scale for both axes.
    pub fn equal(self) -> Self {
        Self { equal: true, ..self }
    }

    /// The same, of a width and a height, pixels.
    pub fn sized(self, width: f64, height: f64) -> Self {
        Self { size: Some([width, height]), ..self }
    }

    /// A grey band from `-half` to `half`.
    pub fn band(&mut self, half: f64) {
        self.band = Some(half);
    }

    /// A dotted line of the slope `slope` through a point, of a figure with two logarithmic axes; `ends` are the abscissas
    /// between which it is drawn.
    pub fn guide(&mut self, label: impl Into<String>, slope: f64, through: (f64, f64), ends: [f64; 2]) {
        self.guides.push(Guide { label: label.into(), slope, through, ends: Some(ends) });
    }

    /// A dotted level line from side to side.
    pub fn level(&mut self, label: impl Into<String>, y: f64) {
        self.guides.push(Guide { label: label.into(), slope: 0.0, through: (1.0, y), ends: None });
    }

    /// Marks moments; `class` names them in the SVG.
    pub fn events(&mut self, label: impl Into<String>, class: &'static str, at: Vec<f64>) {
        self.events.push(Events { label: label.into(), class, at });
    }

    /// The figure on its page.
    pub fn page(&self) -> Canvas {
        plot::sheet("", 1, &[self])
    }

    /// The figure as SVG.
    pub fn svg(&self) -> String {
        self.page().svg()
    }
}

/// Several figures as one, `columns` side by side, with `title` above them.
pub fn sheet(name: &'static str, title: &str, columns: usize, panels: &[Figure]) -> Drawing {
    Drawing { name, svg: page_of(title, columns, panels).svg() }
}

/// The page of several figures, `columns` side by side, with `title` above them.
pub fn page_of(title: &str, columns: usize, panels: &[Figure]) -> Canvas {
    plot::sheet(title, columns, &panels.iter().collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(curves: usize) -> Figure {
        let mut figure = Figure::log_log("test", "Curves & more", "steps", "error (rad)");
        for k in 0..curves {
            let curve = (1..9).map(|n| (f64::from(n), f64::from(n) * libm::exp10(-(k as f64)))).collect();
            figure.series.push(Curve::new(format!("curve-{k}"), curve));
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
            let texts = texts(&figure(curves).svg());
            for k in 0..curves {
                let name = format!("curve-{k}");
                assert_eq!(texts.iter().filter(|text| **text == name).count(), 1, "{curves}: {texts:?}");
            }
        }
    }

    #[test]
    fn labels_beside_the_ends_of_curves_do_not_overlap() {
        let svg = figure(24).svg();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let names = document.descendants().filter(|n| n.text().is_some_and(|t| t.contains("curve-")));
        let mut heights: Vec<f64> =
            names.filter(|n| n.has_tag_name("text")).filter_map(|n| n.attribute("y")?.parse().ok()).collect();
        heights.sort_by(f64::total_cmp);
        assert_eq!(heights.len(), 24);
        assert!(heights.windows(2).all(|pair| pair[1] - pair[0] >= 12.0), "{heights:?}");
    }

    #[test]
    fn nothing_reaches_beyond_the_page() {
        let mut crowded = figure(24);
        crowded.title = "A title that is longer than a line and has to be broken ".repeat(3);
        crowded.events("flips", "flip", vec![2.0, 3.0]);
        crowded.guide("slope 1", 1.0, (2.0, 1.0), [1.0, 8.0]);
        let mut square = figure(1).equal().sized(640.0, 300.0);
        square.scales = [Scale::Linear; 2];
        for page in [figure(2).page(), crowded.page(), square.page(), figure(3).scatter().page()] {
            let [[left, top], [right, bottom]] = page.bounds();
            let inside = left >= 0.0 && top >= 0.0 && right <= page.width && bottom <= page.height;
            assert!(inside, "{left} {top} {right} {bottom} of {} x {}", page.width, page.height);
        }
    }

    #[test]
    fn guides_levels_and_panels_are_drawn_and_named() {
        let mut one = figure(2);
        one.guide("slope 1", 1.0, (2.0, 1.0), [1.0, 4.0]);
        one.level("lost beyond 1 rad", 1.0);
        one.series.push(Curve::new("envelope", vec![(1.0, 2.0), (8.0, 3.0)]).wide());
        let drawing = sheet("sheet", "Two panels", 2, &[one, figure(7)]);
        let texts = texts(&drawing.svg);
        for name in ["slope 1", "lost beyond 1 rad", "envelope", "Two panels", "curve-6"] {
            assert!(texts.iter().any(|text| text == name), "{name}: {texts:?}");
        }
    }
}
