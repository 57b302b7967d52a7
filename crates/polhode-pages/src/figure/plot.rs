//! A figure on its page: axes, curves, guides, names.

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Fill, Stroke};
use super::labels::lines;
use super::marks::{is_hollow, mark};
use super::names::arrow_down;
use super::style::{
    AXIS, BLACK, COLOURS, COLUMN, CURVE, Colour, DASHED, DOTTED, FAINT, GREY, HEIGHT, LABEL, LINE, NAME,
    NAMES, THIN, TITLE, WIDE, is_dashed,
};
use super::{Curve, Figure, Guide, Look, font};

/// A curve has about so many marks.
const MARKS: f64 = 9.0;
/// Room below a plot for labels and the name of the axis, and at the left besides the labels.
const BELOW: f64 = 46.0;
const BESIDE: f64 = 34.0;

/// What surrounds a plot, pixels.
#[derive(Clone, Copy)]
struct Margins {
    top: f64,
    left: f64,
    right: f64,
}

/// `panels` in rows of `columns` below the lines of `title`.
pub(super) fn sheet(title: &str, columns: usize, panels: &[&Figure]) -> Canvas {
    let columns = columns.clamp(1, panels.len().max(1));
    let width = panels.iter().map(|panel| panel.width()).fold(1.0, f64::max);
    let full = width * columns as f64;
    let head =
        if title.is_empty() { 0.0 } else { LINE * lines(title, full - 20.0, TITLE).len() as f64 + 10.0 };
    let axes: Vec<[Axis; 2]> = panels.iter().map(|panel| panel.axes()).collect();
    // plots below each other have the same sides
    let lefts: Vec<f64> = panels.iter().zip(&axes).map(|(panel, axes)| panel.left(&axes[1])).collect();
    let side = |k: usize, of: &dyn Fn(usize) -> f64| {
        (0..panels.len()).filter(|n| n % columns == k % columns).map(of).fold(0.0, f64::max)
    };
    let margins = |k: usize| Margins {
        top: panels[k].head(),
        left: side(k, &|n| lefts[n]),
        right: side(k, &|n| panels[n].names()),
    };
    let heights: Vec<f64> = panels
        .chunks(columns)
        .map(|row| row.iter().map(|panel| panel.height()).fold(1.0, f64::max))
        .collect();
    let mut page = Canvas::new(full, head + heights.iter().sum::<f64>());
    page.heading(title);
    let mut y = head;
    for (row, height) in heights.iter().enumerate() {
        for k in row * columns..((row + 1) * columns).min(panels.len()) {
            let panel = panels[k].on_page(&axes[k], margins(k), [width, *height]);
            page.place([width * (k % columns) as f64, y], panel);
        }
        y += height;
    }
    page
}

impl Figure {
    pub(super) fn width(&self) -> f64 {
        self.size.map_or(COLUMN, |size| size[0])
    }

    fn height(&self) -> f64 {
        let least = self.size.map_or(HEIGHT, |size| size[1]);
        let named = if self.is_direct() { NAMES * self.labels() as f64 } else { 0.0 };
        let square = if self.equal { self.width() - self.names() - 70.0 } else { 0.0 };
        least.max(named.max(square) + BELOW + self.head() + 6.0)
    }

    fn axes(&self) -> [Axis; 2] {
        let values = |pick: fn(&(f64, f64)) -> f64| {
            self.series.iter().flat_map(move |s| s.points.iter().map(pick)).collect::<Vec<_>>()
        };
        let bars = self.series.iter().flat_map(|s| s.spread.iter().flat_map(|bar| [bar.0, bar.1]));
        let levels = self.levels().map(|level| level.through.1);
        let band = self.band.into_iter().flat_map(|half| [-half, half]);
        let ordinates: Vec<f64> = values(|p| p.1).into_iter().chain(bars).chain(levels).chain(band).collect();
        let mut axes = [(0, values(|p| p.0)), (1, ordinates)].map(|(k, values)| {
            Axis::over(self.scales[k], values.into_iter().filter(|value| value.is_finite()))
        });
        if self.equal {
            Axis::equalize(&mut axes, [1.0; 2]);
        }
        axes
    }

    pub(super) fn title_lines(&self) -> Vec<String> {
        lines(&self.title, self.width() - 20.0, TITLE)
    }

    /// Room at the left for labels and the name of the axis.
    fn left(&self, y: &Axis) -> f64 {
        let plot = self.height() - self.head() - BELOW;
        let labels = y.ticks(plot, 17.0);
        let widths =
            labels.iter().filter_map(|tick| tick.label.as_deref()).map(|label| font::width(label, LABEL));
        BESIDE + widths.fold(20.0, f64::max)
    }

    fn head(&self) -> f64 {
        LINE * (self.title_lines().len() + self.legend().len()) as f64 + 14.0
    }

    fn on_page(&self, axes: &[Axis; 2], margins: Margins, [width, height]: [f64; 2]) -> Canvas {
        let mut page = Canvas::new(width, height);
        let (left, right) = (margins.left, width - margins.right);
        let (top, bottom) = (margins.top, height - BELOW);
        page.heading(&self.title);
        let mut axes = axes.clone();
        if self.equal {
            Axis::equalize(&mut axes, [right - left, bottom - top]);
        }
        let [x, y] = &axes;
        let across = |share: f64| left + share * (right - left);
        let down = |share: f64| bottom - share * (bottom - top);
        let place = |p: &(f64, f64)| [across(x.share(p.0)), down(y.share(p.1))];

        if let Some(half) = self.band {
            let (above, below) = (place(&(0.0, half))[1], place(&(0.0, -half))[1]);
            page.rectangle([left, above], [right, below], Some(Fill::Flat(FAINT, 0.6)), None);
        }
        self.draw_axes(&mut page, [x, y], [[left, right], [top, bottom]]);
        let (ends, marks) = self.draw_series(&mut page, place, [left, right]);
        for events in &self.events {
            // many lines would hide the curves
            let lines = if events.at.len() > MOST_LINES { &[][..] } else { &events.at[..] };
            page.as_class("event", |page| {
                for at in lines {
                    let at = across(x.share(*at));
                    page.line(vec![[at, top], [at, bottom]], Stroke::new(GREY, THIN).dashed(Some(DOTTED)));
                }
            });
            page.as_class(events.class, |page| {
                for at in &events.at {
                    arrow_down(page, [across(x.share(*at)), top]);
                }
            });
        }
        for (k, at, colour) in marks {
            page.as_class("mark", |page| mark(page, k, at, colour, 1.0));
        }
        for guide in &self.guides {
            let Some(line) = guide.line(x, y) else { continue };
            let share = |(u, v): (f64, f64)| {
                let [x, y] = [(x, u), (y, v)].map(|(axis, at)| axis.share_of_place(at));
                [across(x), down(y)]
            };
            let line = line.map(share);
            page.line(line.to_vec(), Stroke::new(GREY, 1.2).dashed(Some(DOTTED)));
            if guide.ends.is_some() {
                let above = [line[1][0] - 3.0, line[1][1] - 5.0];
                page.note(above, &guide.label, NAME, Anchor::End);
            }
        }
        let heights: Vec<f64> = self.levels().map(|level| down(y.share(level.through.1))).collect();
        self.draw_names(&mut page, &ends, &heights, [[left, right], [top, bottom]]);
        page
    }

    /// Draws the curves, dots and bars; where each series ends, and the marks that belong on top.
    fn draw_series(
        &self,
        page: &mut Canvas,
        place: impl Fn(&(f64, f64)) -> [f64; 2],
        [left, right]: [f64; 2],
    ) -> (Vec<Option<[f64; 2]>>, Vec<Mark>) {
        let (mut ends, mut hollow, mut filled) = (Vec::new(), Vec::new(), Vec::new());
        for (k, series) in self.series.iter().enumerate() {
            let places: Vec<[f64; 2]> = series.points.iter().map(&place).collect();
            let colour = series.colour(k);
            for (p, bar) in series.points.iter().zip(&series.spread) {
                let line = vec![place(&(p.0, bar.0)), place(&(p.0, bar.1))];
                page.line(line, Stroke::new(colour, THIN).opacity(0.6));
            }
            let is_joined = self.joined && series.look != Look::Dots;
            if is_joined {
                let width = if series.look == Look::Wide { WIDE } else { CURVE };
                let dash = (series.dash(k)).then_some(DASHED);
                let points = thinned(&places);
                page.as_class("curve", |page| page.line(points, Stroke::new(colour, width).dashed(dash)));
            }
            let mut by_place = places;
            by_place.sort_by(|a, b| a[0].total_cmp(&b[0]));
            ends.push(by_place.last().copied());
            if series.look == Look::Dots {
                let every = by_place.len().div_ceil(DOTS).max(1);
                page.as_class("dot", |page| {
                    for at in by_place.into_iter().step_by(every) {
                        page.circle(at, 1.5, Some(Fill::Flat(colour, 0.55)), None);
                    }
                });
                continue;
            }
            if series.look != Look::Marked {
                continue;
            }
            // the marks of neighbouring curves stand at different places
            let all = !self.joined || by_place.len() as f64 <= MARKS;
            let between = (right - left) / MARKS;
            let mut next = left + between * (k % 4) as f64 / 4.0;
            for at in by_place {
                if all || at[0] >= next {
                    let marks = if is_hollow(k) { &mut hollow } else { &mut filled };
                    marks.push((k, at, colour));
                    next = at[0] + between;
                }
            }
        }
        hollow.append(&mut filled);
        (ends, hollow)
    }

    fn draw_axes(
        &self,
        page: &mut Canvas,
        [x, y]: [&Axis; 2],
        [[left, right], [top, bottom]]: [[f64; 2]; 2],
    ) {
        let (grid, edge) = (Stroke::new(FAINT, THIN), Stroke::new(BLACK, THIN));
        // labels of the abscissa as wide as they come out, told apart by a gap
        let widest = |room: f64| {
            let ticks = x.ticks(right - left, room);
            let widths =
                ticks.iter().filter_map(|tick| tick.label.as_deref()).map(|label| font::width(label, LABEL));
            widths.fold(0.0, f64::max)
        };
        let room = widest(widest(40.0).max(20.0) + 14.0) + 14.0;
        for tick in x.ticks(right - left, room) {
            let at = left + x.share_of_place(tick.at) * (right - left);
            if let Some(label) = &tick.label {
                page.line(vec![[at, top], [at, bottom]], grid);
                page.text([at, bottom + 18.0], label, LABEL, Anchor::Middle, BLACK);
            }
            let length = if tick.label.is_some() { 5.0 } else { 3.0 };
            page.line(vec![[at, bottom], [at, bottom + length]], edge);
        }
        for tick in y.ticks(bottom - top, 17.0) {
            let at = bottom - y.share_of_place(tick.at) * (bottom - top);
            if let Some(label) = &tick.label {
                page.line(vec![[left, at], [right, at]], grid);
                page.text([left - 8.0, at + 0.36 * LABEL], label, LABEL, Anchor::End, BLACK);
            }
            let length = if tick.label.is_some() { 5.0 } else { 3.0 };
            page.line(vec![[left - length, at], [left, at]], edge);
        }
        page.line(vec![[left, top], [left, bottom], [right, bottom]], edge);
        page.text([0.5 * (left + right), bottom + 39.0], &self.x, AXIS, Anchor::Middle, BLACK);
        page.text_upwards([16.0, 0.5 * (top + bottom)], &self.y, AXIS);
    }
}

/// A mark of a series by its number, its place and its colour.
type Mark = (usize, [f64; 2], Colour);

/// Events beyond which no lines go down from their marks.
const MOST_LINES: usize = 16;
/// Dots of a series beyond which every so many-th is drawn.
const DOTS: usize = 1500;

/// Of many points, the first, the last, the lowest and the highest of each column of pixels.
fn thinned(places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    if places.len() < 4000 || places.windows(2).any(|pair| pair[1][0] < pair[0][0]) {
        return places.to_vec();
    }
    let mut kept = Vec::new();
    for column in places.chunk_by(|a, b| libm::floor(a[0]) == libm::floor(b[0])) {
        let extreme = |sign: f64| {
            (0..column.len())
                .max_by(|a, b| (sign * column[*a][1]).total_cmp(&(sign * column[*b][1])))
                .unwrap_or(0)
        };
        let mut chosen = vec![0, extreme(1.0), extreme(-1.0), column.len() - 1];
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|k| column[k]));
    }
    kept
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

impl Curve {
    pub(super) fn colour(&self, k: usize) -> Colour {
        COLOURS[self.colour.unwrap_or(k) % COLOURS.len()]
    }

    /// Every second curve is dashed.
    pub(super) fn dash(&self, k: usize) -> bool {
        is_dashed(self.colour.unwrap_or(k))
    }
}
