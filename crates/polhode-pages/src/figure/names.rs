//! Names of curves and levels beside a plot, and the legend above it.

use super::canvas::{Anchor, Canvas, Fill, Stroke};
use super::labels::spread;
use super::marks::mark;
use super::style::{BLACK, CURVE, Colour, DOTTED, GREY, LINE, NAME, NAMES, WIDE};
use super::{Curve, Figure, Guide, Look, font};

/// What a line of a legend shows.
pub(super) enum Entry<'a> {
    Curve(usize, &'a Curve),
    Events(&'a str),
}

impl Figure {
    /// Whether the curves are named beside their ends.
    pub(super) fn is_direct(&self) -> bool {
        self.joined && self.named().count() > 1
    }

    pub(super) fn named(&self) -> impl Iterator<Item = (usize, &Curve)> {
        self.series.iter().enumerate().filter(|(_, series)| !series.name.is_empty())
    }

    pub(super) fn levels(&self) -> impl Iterator<Item = &Guide> {
        self.guides.iter().filter(|guide| guide.ends.is_none())
    }

    /// Names beside the plot.
    pub(super) fn labels(&self) -> usize {
        self.named().count() + self.levels().count()
    }

    /// Room at the right for names.
    pub(super) fn names(&self) -> f64 {
        let widest = |names: &mut dyn Iterator<Item = &str>| {
            names.map(|name| font::width(name, NAME)).fold(0.0, f64::max)
        };
        let levels = widest(&mut self.levels().map(|level| level.label.as_str()));
        if self.is_direct() {
            widest(&mut self.named().map(|(_, series)| series.name.as_str())).max(levels) + 40.0
        } else {
            16.0_f64.max(levels + 14.0)
        }
    }

    /// Lines of the legend below the title.
    pub(super) fn legend(&self) -> Vec<Vec<Entry<'_>>> {
        let mut entries: Vec<Entry<'_>> = Vec::new();
        if !self.joined && self.named().count() > 1 {
            entries.extend(self.named().map(|(k, series)| Entry::Curve(k, series)));
        }
        entries.extend(self.events.iter().map(|events| Entry::Events(&events.label)));
        let mut rows: Vec<Vec<Entry<'_>>> = Vec::new();
        let mut used = f64::INFINITY;
        for entry in entries {
            // with the mark before the label and the gap behind it
            let width = font::width(entry.label(), NAME) + 42.0;
            if used + width > self.width() - 20.0 {
                used = 0.0;
                rows.push(Vec::new());
            }
            used += width;
            if let Some(row) = rows.last_mut() {
                row.push(entry);
            }
        }
        rows
    }

    /// Names beside the ends of the curves, and the legend.
    pub(super) fn draw_names(
        &self,
        page: &mut Canvas,
        ends: &[Option<[f64; 2]>],
        heights: &[f64],
        [[left, right], [top, bottom]]: [[f64; 2]; 2],
    ) {
        let named: Vec<(usize, &Curve)> = if self.is_direct() { self.named().collect() } else { Vec::new() };
        let inside = |at: f64| at.clamp(top, bottom);
        let mut wanted: Vec<f64> =
            named.iter().map(|(k, _)| ends[*k].map_or(bottom, |end| inside(end[1]))).collect();
        wanted.extend(heights.iter().map(|at| inside(*at)));
        let places = spread(&wanted, NAMES, [top + 4.0, bottom - 2.0]);
        let (of_curves, of_levels) = places.split_at(named.len());
        for (&y, (k, series)) in of_curves.iter().zip(named) {
            let colour = series.colour(k);
            if let Some(end) = ends[k] {
                let leader = vec![end, [right + 12.0, y]];
                page.line(leader, Stroke::new(GREY, 0.8).opacity(0.7));
            }
            self.sample(page, k, [right + 14.0, y], 14.0, colour);
            page.text([right + 33.0, y + 0.36 * NAME], &series.name, NAME, Anchor::Start, BLACK);
        }
        // a level is named beside its end, among the names of the curves
        let from = if self.is_direct() { 33.0 } else { 6.0 };
        for ((&y, level), at) in of_levels.iter().zip(self.levels()).zip(heights) {
            if self.is_direct() {
                let leader = vec![[right, *at], [right + 12.0, y], [right + 28.0, y]];
                page.line(leader, Stroke::new(GREY, 1.2).dashed(Some(DOTTED)));
            }
            page.text([right + from, y + 0.36 * NAME], &level.label, NAME, Anchor::Start, GREY);
        }
        let first = 18.0 + LINE * self.title_lines().len() as f64;
        for (n, row) in self.legend().into_iter().enumerate() {
            let (mut x, y) = (left.min(40.0), first + LINE * n as f64);
            for entry in row {
                match entry {
                    Entry::Curve(k, series) => mark(page, k, [x + 8.0, y - 4.0], series.colour(k), 1.0),
                    Entry::Events(_) => arrow_down(page, [x + 8.0, y - 0.5]),
                }
                x += 20.0;
                page.text([x, y], entry.label(), NAME, Anchor::Start, BLACK);
                x += font::width(entry.label(), NAME) + 22.0;
            }
        }
    }

    /// A piece of the k-th curve, `length` pixels from `at` on.
    fn sample(&self, page: &mut Canvas, k: usize, at: [f64; 2], length: f64, colour: Colour) {
        let series = &self.series[k];
        let [x, y] = at;
        match series.look {
            Look::Marked => mark(page, k, [x + 0.5 * length, y], colour, 1.0),
            Look::Dots => page.circle([x + 0.5 * length, y], 2.0, Some(Fill::Flat(colour, 0.7)), None),
            Look::Plain | Look::Wide => {
                let width = if series.look == Look::Wide { WIDE } else { CURVE };
                let dash = series.dash(k).then_some([5.0, 3.0]);
                page.line(vec![[x, y], [x + length, y]], Stroke::new(colour, width).dashed(dash));
            }
        }
    }
}

impl Entry<'_> {
    fn label(&self) -> &str {
        match self {
            Entry::Curve(_, series) => &series.name,
            Entry::Events(label) => label,
        }
    }
}

/// A small triangle whose tip touches `at` from above.
pub(super) fn arrow_down(page: &mut Canvas, [x, y]: [f64; 2]) {
    page.area(vec![[x, y], [x - 4.0, y - 8.0], [x + 4.0, y - 8.0]], Some(Fill::Flat(BLACK, 1.0)), None);
}
