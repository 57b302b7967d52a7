//! A row for each name, with a dot for each value: many methods over several bodies, where curves would be too many.

use super::axis::{Axis, Scale};
use super::canvas::{Anchor, Canvas, Fill, Stroke};
use super::font;
use super::labels::lines;
use super::marks::mark;
use super::style::{AXIS, BLACK, COLOURS, COLUMN, FAINT, GREY, LABEL, LINE, NAME, THIN, TITLE};

/// Height of a row of each kind, and the gap between rows.
const KIND: f64 = 10.0;
const GAP: f64 = 8.0;
const BELOW: f64 = 46.0;

/// Values of one name in one panel, of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values {
    /// In any order.
    pub seen: Vec<f64>,
    /// How many have no value.
    pub lost: usize,
}

/// A row: its name, and its values by panel and kind.
#[derive(Clone, Debug)]
pub struct Group {
    /// Its name.
    pub name: String,
    /// By panel and kind.
    pub values: Vec<Vec<Values>>,
}

/// Rows over common logarithmic axes.
#[derive(Clone, Debug)]
pub struct RowPlot {
    /// Above the plot.
    pub title: String,
    /// What the kinds are, in the legend.
    pub kinds: Vec<String>,
    /// Quantity of each panel, with unit.
    pub panels: Vec<String>,
    /// Heading of the column of what has no value, in the first panel.
    pub lost: String,
    /// From the top down.
    pub rows: Vec<Group>,
}

impl RowPlot {
    /// Drawn.
    pub fn page(&self) -> Canvas {
        let title = lines(&self.title, COLUMN - 20.0, TITLE);
        let head = LINE * (title.len() + 1) as f64 + 30.0;
        let row = KIND * self.kinds.len() as f64 + GAP;
        let mut page = Canvas::new(COLUMN, head + row * self.rows.len() as f64 + BELOW);
        for (n, line) in title.iter().enumerate() {
            page.text([10.0, 18.0 + LINE * n as f64], line, TITLE, Anchor::Start, BLACK);
        }
        let mut x = 10.0;
        for (kind, name) in self.kinds.iter().enumerate() {
            let y = 18.0 + LINE * title.len() as f64;
            mark(&mut page, of_kind(kind), [x + 6.0, y - 4.0], COLOURS[of_kind(kind)], 0.9);
            page.text([x + 16.0, y], name, NAME, Anchor::Start, BLACK);
            x += 40.0 + font::width(name, NAME);
        }
        let names = self.rows.iter().map(|row| font::width(&row.name, NAME)).fold(0.0, f64::max);
        let left = names + 18.0;
        let lost = font::width(&self.lost, LABEL).max(36.0) + 8.0;
        let panels = self.panels.len().max(1) as f64;
        let wide = (COLUMN - left - lost - 14.0 - 16.0 * (panels - 1.0)) / panels;
        let bottom = head + row * self.rows.len() as f64;
        for (k, group) in self.rows.iter().enumerate() {
            let y = head + row * (k as f64 + 0.5);
            page.text([left - 10.0, y + 0.36 * NAME], &group.name, NAME, Anchor::End, BLACK);
            page.line(vec![[left, y], [COLUMN - 10.0, y]], Stroke::new(FAINT, 0.7));
        }
        let mut from = left;
        for (panel, label) in self.panels.iter().enumerate() {
            let seen = self
                .rows
                .iter()
                .flat_map(|row| row.values[panel].iter().flat_map(|v| v.seen.iter().copied()));
            let axis = Axis::over(Scale::Log, seen.collect::<Vec<_>>().into_iter());
            let to = from + wide;
            let edge = Stroke::new(BLACK, THIN);
            for tick in axis.ticks(wide, 36.0) {
                let at = from + axis.share_of_place(tick.at) * wide;
                if let Some(label) = &tick.label {
                    page.line(vec![[at, head], [at, bottom]], Stroke::new(FAINT, THIN));
                    page.text([at, bottom + 18.0], label, LABEL, Anchor::Middle, BLACK);
                }
                let length = if tick.label.is_some() { 5.0 } else { 3.0 };
                page.line(vec![[at, bottom], [at, bottom + length]], edge);
            }
            page.line(vec![[from, head], [from, bottom], [to, bottom]], edge);
            page.text([0.5 * (from + to), bottom + 39.0], label, AXIS, Anchor::Middle, BLACK);
            for (k, group) in self.rows.iter().enumerate() {
                for (kind, values) in group.values[panel].iter().enumerate() {
                    let y = head + row * k as f64 + 0.5 * GAP + KIND * (kind as f64 + 0.5);
                    draw(&mut page, values, kind, |value| [from + axis.share(value) * wide, y]);
                    if panel == 0 && values.lost > 0 {
                        let text = values.lost.to_string();
                        page.text([to + 0.5 * lost, y + 4.0], &text, LABEL - 2.0, Anchor::Middle, GREY);
                    }
                }
            }
            if panel == 0 {
                page.text([to + 0.5 * lost, head - 6.0], &self.lost, LABEL, Anchor::Middle, GREY);
            }
            from = to + 16.0 + if panel == 0 { lost } else { 0.0 };
        }
        page
    }
}

/// The number among colours and marks: a hollow one and a filled one.
fn of_kind(kind: usize) -> usize {
    [3, 0, 1, 2][kind % 4]
}

/// A thin line from the least to the largest value, a dot for each, a mark for the median.
fn draw(page: &mut Canvas, values: &Values, kind: usize, place: impl Fn(f64) -> [f64; 2]) {
    let mut seen = values.seen.clone();
    seen.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (seen.first(), seen.last()) else { return };
    let colour = COLOURS[of_kind(kind)];
    page.line(vec![place(*first), place(*last)], Stroke::new(colour, THIN).opacity(0.6));
    page.as_class("value", |page| {
        for value in &seen {
            page.circle(place(*value), 1.5, Some(Fill::Flat(colour, 0.8)), None);
        }
    });
    // the lower one of two in the middle: a value that was seen
    let median = seen[(seen.len() - 1) / 2];
    page.as_class("median", |page| mark(page, of_kind(kind), place(median), colour, 0.8));
}
