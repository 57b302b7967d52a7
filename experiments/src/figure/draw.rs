//! The drawing itself, in pixels.

use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::Axis;
use super::labels::{lines, spread};
use super::{COLOURS, Figure, Guide, Series};
use crate::error::Error;

/// Width of a figure for a column, and of one with a legend of many marks.
const WIDTH: u32 = 500;
const SCATTER_WIDTH: u32 = 860;
const HEIGHT: u32 = 400;
/// Lines of text and labels are so far apart.
const LINE: i32 = 17;
const LABEL: i32 = 14;
/// Up to so many curves have a legend.
const LEGEND: usize = 5;
/// A curve has about so many marks.
const MARKS: i32 = 9;
/// Average width of a letter in the sizes of titles and of labels.
const LETTER: f64 = 7.0;
const SMALL_LETTER: f64 = 6.2;
/// Distance of the labels below the plot.
const TICK: i32 = 48;

const GREY: RGBColor = RGBColor(90, 90, 90);

impl Figure {
    fn is_direct(&self) -> bool {
        self.joined && self.series.len() > LEGEND
    }

    fn width(&self) -> u32 {
        if self.joined { WIDTH } else { SCATTER_WIDTH }
    }

    fn title_lines(&self) -> Vec<String> {
        lines(&self.title, (f64::from(self.width()) / LETTER) as usize)
    }

    /// Room at the right for names.
    fn names(&self) -> i32 {
        let longest = self.series.iter().map(|series| series.name.chars().count()).max().unwrap_or(0);
        if self.is_direct() {
            (SMALL_LETTER * longest as f64) as i32 + 40
        } else if self.joined {
            12
        } else {
            (SMALL_LETTER * longest as f64) as i32 + 44
        }
    }

    /// Lines of the legend below the title.
    fn legend_rows(&self) -> Vec<Vec<usize>> {
        let mut rows: Vec<Vec<usize>> = Vec::new();
        if !self.joined || self.is_direct() || self.series.len() < 2 {
            return rows;
        }
        let mut used = f64::INFINITY;
        for (k, series) in self.series.iter().enumerate() {
            let width = legend_width(series);
            if used + width > f64::from(self.width()) {
                (used, rows) = (60.0, [rows, vec![Vec::new()]].concat());
            }
            used += width;
            if let Some(row) = rows.last_mut() {
                row.push(k);
            }
        }
        rows
    }

    fn head(&self) -> i32 {
        LINE * (self.title_lines().len() + self.legend_rows().len()) as i32 + 10
    }

    fn height(&self) -> u32 {
        let names = if self.is_direct() {
            LABEL * self.series.len() as i32
        } else if self.joined {
            0
        } else {
            24 * self.series.len() as i32
        };
        HEIGHT.max((names + 80 + self.head()) as u32)
    }
}

fn legend_width(series: &Series) -> f64 {
    SMALL_LETTER * series.name.chars().count() as f64 + 54.0
}

/// `panels` in rows of `columns` below the lines of `title`.
pub(super) fn svg(name: &str, title: &str, columns: usize, panels: &[&Figure]) -> Result<String, Error> {
    let columns = columns.clamp(1, panels.len().max(1));
    let width = panels.iter().map(|panel| panel.width()).max().unwrap_or(WIDTH);
    let rows: Vec<&[&Figure]> = panels.chunks(columns).collect();
    let heights: Vec<u32> =
        rows.iter().map(|row| row.iter().map(|panel| panel.height()).max().unwrap_or(HEIGHT)).collect();
    let full = width * columns as u32;
    let title = lines(title, (f64::from(full) / LETTER) as usize);
    let head = if title.is_empty() { 0 } else { LINE * title.len() as i32 + 8 };
    let size = (full, heights.iter().sum::<u32>() + head as u32);
    let mut text = String::new();
    let root = SVGBackend::with_string(&mut text, size).into_drawing_area();
    let drawn = (|| {
        root.fill(&WHITE)?;
        write(&root, &title, (10, 4), 16)?;
        let mut y = head;
        for (row, height) in rows.into_iter().zip(heights) {
            for (k, panel) in row.iter().enumerate() {
                let x = (k as u32 * width) as i32;
                let place = root.clone().shrink((x, y), (width, height));
                panel.draw(&root, &place)?;
            }
            y += height as i32;
        }
        root.present()
    })();
    drawn.map_err(|error| Error::Failed(format!("figure {name}: {error}")))?;
    drop(root);
    Ok(text)
}

type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

fn write<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    lines: &[String],
    (x, y): (i32, i32),
    size: i32,
) -> Drawn<B> {
    for (k, line) in lines.iter().enumerate() {
        area.draw(&Text::new(line.as_str(), (x, y + LINE * k as i32), ("sans-serif", size)))?;
    }
    Ok(())
}

impl Figure {
    /// Draws itself on `place`, a part of `root`.
    fn draw<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
        place: &DrawingArea<B, Shift>,
    ) -> Drawn<B> {
        let values = |pick: fn(&(f64, f64)) -> f64| {
            self.series.iter().flat_map(move |s| s.points.iter().map(pick)).collect::<Vec<_>>()
        };
        let bars = self.series.iter().flat_map(|s| s.spread.iter().flat_map(|bar| [bar.0, bar.1]));
        let levels = self.guides.iter().filter(|guide| guide.ends.is_none()).map(|guide| guide.through.1);
        let ordinates: Vec<f64> = values(|p| p.1).into_iter().chain(bars).chain(levels).collect();
        let x = Axis::over(self.scales[0], values(|p| p.0).into_iter());
        let y = Axis::over(self.scales[1], ordinates.into_iter());

        write(place, &self.title_lines(), (10, 4), 15)?;
        let mut chart = ChartBuilder::on(place)
            .margin_top(self.head())
            .margin_left(4)
            .margin_bottom(4)
            .margin_right(self.names())
            .x_label_area_size(44)
            .y_label_area_size(64)
            .build_cartesian_2d(x.clone(), y.clone())?;
        let wide = place.dim_in_pixel().0 as i32 - self.names() - 68;
        chart
            .configure_mesh()
            .x_labels((wide / TICK).max(2) as usize)
            .x_desc(self.x)
            .y_desc(self.y)
            .axis_desc_style(("sans-serif", 15))
            .label_style(("sans-serif", 14))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .draw()?;
        let pixel = |at: &(f64, f64)| chart.backend_coord(at);
        let [left, right] = x.limits().map(|x| pixel(&(x, 0.0)).0);
        let [bottom, top] = y.limits().map(|y_end| pixel(&(x.limits()[0], y_end)).1);

        let mut ends = Vec::new();
        for (k, series) in self.series.iter().enumerate() {
            let place = |p: &(f64, f64)| pixel(&(x.place(p.0), y.place(p.1)));
            let places: Vec<(i32, i32)> = series.points.iter().map(place).collect();
            let mut by_place = places.clone();
            by_place.sort_by_key(|at| at.0);
            ends.push(by_place.last().copied());
            let colour = COLOURS[k % COLOURS.len()];
            for (p, bar) in series.points.iter().zip(&series.spread) {
                let line = [place(&(p.0, bar.0)), place(&(p.0, bar.1))];
                root.draw(&PathElement::new(line, colour.mix(0.6).stroke_width(1)))?;
            }
            if self.joined {
                let style = colour.stroke_width(if series.wide { 4 } else { 2 });
                polyline(root, &places, dashes(k), style)?;
            }
            // the marks of neighbouring curves stand at different places
            let all = !self.joined || places.len() as i32 <= MARKS;
            let between = (right - left) / MARKS;
            let mut next = left + between * (k as i32 % 4) / 4;
            for &at in by_place.iter().filter(|_| !series.wide) {
                if all || at.0 >= next {
                    root.draw(&mark(k, at, colour))?;
                    next = at.0 + between;
                }
            }
        }
        for guide in &self.guides {
            let Some(line) = guide.line(&x, &y) else { continue };
            let line = line.map(|at| pixel(&at));
            let label = line[1];
            polyline(root, &line, Some((2, 4)), GREY.stroke_width(1))?;
            let at = Pos::new(HPos::Right, VPos::Bottom);
            let style = ("sans-serif", 13).into_text_style(root).color(&GREY).pos(at);
            root.draw(&Text::new(guide.label.as_str(), (label.0, label.1 - 2), style))?;
        }
        self.name_curves(root, &ends, [left, right], [top, bottom], place)
    }

    /// Names beside the ends of the curves, or a legend.
    fn name_curves<B: DrawingBackend>(
        &self,
        root: &DrawingArea<B, Shift>,
        ends: &[Option<(i32, i32)>],
        [left, right]: [i32; 2],
        [top, bottom]: [i32; 2],
        place: &DrawingArea<B, Shift>,
    ) -> Drawn<B> {
        let name = |at: (i32, i32), series: &Series| {
            let style = ("sans-serif", 13).into_text_style(root).color(&BLACK);
            let style = style.pos(Pos::new(HPos::Left, VPos::Center));
            root.draw(&Text::new(series.name.clone(), at, style))
        };
        if self.is_direct() {
            let wanted: Vec<i32> =
                ends.iter().map(|end| end.map_or(bottom, |end| end.1.clamp(top, bottom))).collect();
            for (k, (y, series)) in
                spread(&wanted, LABEL, [top + 4, bottom - 2]).into_iter().zip(&self.series).enumerate()
            {
                let colour = COLOURS[k % COLOURS.len()];
                if let Some(end) = ends[k] {
                    let leader = [end, (right + 14, y)];
                    root.draw(&PathElement::new(leader, GREY.mix(0.6).stroke_width(1)))?;
                }
                if !series.wide {
                    root.draw(&mark(k, (right + 21, y), colour))?;
                }
                name((right + 31, y), series)?;
            }
        } else if self.joined {
            let y = place.get_base_pixel().1 + 10 + LINE * self.title_lines().len() as i32;
            for (n, row) in self.legend_rows().into_iter().enumerate() {
                let (mut x, y) = (left, y + LINE * n as i32);
                for k in row {
                    let colour = COLOURS[k % COLOURS.len()];
                    let line = [(x, y), (x + 30, y)];
                    polyline(root, &line, dashes(k), colour.stroke_width(2))?;
                    root.draw(&mark(k, (x + 15, y), colour))?;
                    name((x + 36, y), &self.series[k])?;
                    x += legend_width(&self.series[k]) as i32;
                }
            }
        } else {
            for (k, series) in self.series.iter().enumerate() {
                let (y, colour) = (top + 10 + 24 * k as i32, COLOURS[k % COLOURS.len()]);
                root.draw(&mark(k, (right + 18, y), colour))?;
                name((right + 34, y), series)?;
            }
        }
        Ok(())
    }
}

impl Guide {
    /// Its ends within the axes, in coordinates; the label stands at the second.
    fn line(&self, x: &Axis, y: &Axis) -> Option<[(f64, f64); 2]> {
        let ([left, right], [low, high]) = (x.limits(), y.limits());
        // the label has room above its end
        let high = high - 0.06 * (high - low);
        let through = (x.place(self.through.0), y.place(self.through.1));
        let at = |x: f64| (x, through.1 + self.slope * (x - through.0));
        let [mut from, mut to] = self.ends.map_or([left, right], |ends| ends.map(|end| x.place(end)));
        (from, to) = (from.max(left), to.min(right));
        if self.slope != 0.0 {
            // what leaves the plot above or below is cut off
            let [a, b] = [low, high].map(|edge| through.0 + (edge - through.1) / self.slope);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from < to).then(|| [at(from), at(to)])
    }
}

/// Lengths of dash and gap, for every second curve; none is a full line.
fn dashes(k: usize) -> Option<(i32, i32)> {
    (k % 2 == 1).then_some((7, 5))
}

fn polyline<B: DrawingBackend>(
    root: &DrawingArea<B, Shift>,
    places: &[(i32, i32)],
    dashes: Option<(i32, i32)>,
    style: ShapeStyle,
) -> Drawn<B> {
    match dashes {
        None => root.draw(&PathElement::new(places.to_vec(), style)),
        Some((dash, gap)) => root.draw(&DashedPathElement::new(places.iter().copied(), dash, gap, style)),
    }
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
