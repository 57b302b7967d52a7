//! A page of lines, areas and texts, in pixels, downwards; written as SVG or as PNG.

use super::font;
use super::labels::lines;
use super::style::{BLACK, Colour, GREY, LINE, TITLE, WHITE};

/// A line: its colour, its width, its dashes if it has any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Pixels.
    pub width: f64,
    /// Dash and gap, pixels.
    pub dash: Option<[f64; 2]>,
    /// From 0 to 1.
    pub opacity: f64,
}

impl Stroke {
    /// A solid line.
    pub fn new(colour: Colour, width: f64) -> Self {
        Self { colour, width, dash: None, opacity: 1.0 }
    }

    /// With this dash and gap, pixels.
    pub fn dashed(self, dash: Option<[f64; 2]>) -> Self {
        Self { dash, ..self }
    }

    /// With this opacity, from 0 to 1.
    pub fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// What an area is filled with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fill {
    /// One colour, and its opacity.
    Flat(Colour, f64),
    /// White at the light, grey at the edge: a ball.
    Shaded,
}

/// Where a text stands from its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// Ends there.
    End,
}

/// Words on a page.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Words {
    pub at: [f64; 2],
    pub text: String,
    pub size: f64,
    pub anchor: Anchor,
    pub colour: Colour,
    /// Whether it is read upwards.
    pub upwards: bool,
}

impl Words {
    /// Pixels from the point to the beginning.
    pub(super) fn offset(&self) -> f64 {
        let width = font::width(&self.text, self.size);
        match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        }
    }

    /// The corners of what it covers: left and top, right and bottom.
    fn bounds(&self) -> [[f64; 2]; 2] {
        let (from, width) = (self.offset(), font::width(&self.text, self.size));
        let [x, y] = self.at;
        let (above, below) = (0.8 * self.size, 0.25 * self.size);
        if self.upwards {
            [[x - above, y - from - width], [x + below, y - from]]
        } else {
            [[x + from, y - above], [x + from + width, y + below]]
        }
    }
}

/// Numbers below zero with a true minus; names keep their hyphens.
fn with_minus(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let is_sign = |k: usize| {
        letters[k] == '-'
            && (k == 0 || matches!(letters[k - 1], ' ' | '('))
            && letters.get(k + 1).is_some_and(char::is_ascii_digit)
    };
    (0..letters.len()).map(|k| if is_sign(k) { '−' } else { letters[k] }).collect()
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Path { points: Vec<[f64; 2]>, closed: bool, stroke: Option<Stroke>, fill: Option<Fill> },
    Circle { centre: [f64; 2], radius: f64, stroke: Option<Stroke>, fill: Option<Fill> },
    Words(Words),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Item {
    pub(super) shape: Shape,
    /// What it is, for those who read the SVG.
    pub(super) class: Option<&'static str>,
}

/// A white page.
#[derive(Clone, Debug)]
pub struct Canvas {
    /// Pixels.
    pub width: f64,
    /// Pixels.
    pub height: f64,
    pub(super) items: Vec<Item>,
    class: Option<&'static str>,
}

impl Canvas {
    /// An empty page; sizes in pixels.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, items: Vec::new(), class: None }
    }

    /// Draws what `draw` draws, marked as a `class`.
    pub fn as_class(&mut self, class: &'static str, draw: impl FnOnce(&mut Self)) {
        let before = self.class.replace(class);
        draw(self);
        self.class = before;
    }

    fn push(&mut self, shape: Shape) {
        self.items.push(Item { shape, class: self.class });
    }

    /// A line through points.
    pub fn line(&mut self, points: Vec<[f64; 2]>, stroke: Stroke) {
        if points.len() > 1 {
            self.push(Shape::Path { points, closed: false, stroke: Some(stroke), fill: None });
        }
    }

    /// An area within points.
    pub fn area(&mut self, points: Vec<[f64; 2]>, fill: Option<Fill>, stroke: Option<Stroke>) {
        self.push(Shape::Path { points, closed: true, stroke, fill });
    }

    /// A rectangle between two corners.
    pub fn rectangle(
        &mut self,
        [left, top]: [f64; 2],
        [right, bottom]: [f64; 2],
        fill: Option<Fill>,
        stroke: Option<Stroke>,
    ) {
        self.area(vec![[left, top], [right, top], [right, bottom], [left, bottom]], fill, stroke);
    }

    /// A disk or its rim.
    pub fn circle(&mut self, centre: [f64; 2], radius: f64, fill: Option<Fill>, stroke: Option<Stroke>) {
        self.push(Shape::Circle { centre, radius, stroke, fill });
    }

    /// A title in as many lines as it needs; what they take, pixels.
    pub fn heading(&mut self, title: &str) -> f64 {
        let lines = lines(&with_minus(title), self.width - 20.0, TITLE);
        for (n, line) in lines.iter().enumerate() {
            self.text([10.0, 18.0 + LINE * n as f64], line, TITLE, Anchor::Start, BLACK);
        }
        LINE * lines.len() as f64 + 10.0
    }

    /// A line of text.
    pub fn text(&mut self, at: [f64; 2], text: &str, size: f64, anchor: Anchor, colour: Colour) {
        let text = text.to_owned();
        self.push(Shape::Words(Words { at, text, size, anchor, colour, upwards: false }));
    }

    /// A line of text that is read upwards, around its point.
    pub fn text_upwards(&mut self, at: [f64; 2], text: &str, size: f64) {
        let text = text.to_owned();
        self.push(Shape::Words(Words {
            at,
            text,
            size,
            anchor: Anchor::Middle,
            colour: BLACK,
            upwards: true,
        }));
    }

    /// Grey words on a white ground that covers what is below them.
    pub fn note(&mut self, at: [f64; 2], text: &str, size: f64, anchor: Anchor) {
        let words = Words { at, text: text.to_owned(), size, anchor, colour: GREY, upwards: false };
        let [[left, top], [right, bottom]] = words.bounds();
        self.rectangle([left - 2.0, top], [right + 2.0, bottom], Some(Fill::Flat(WHITE, 0.85)), None);
        self.push(Shape::Words(words));
    }

    /// Puts another page on this one, its corner at `at`.
    pub fn place(&mut self, [x, y]: [f64; 2], page: Canvas) {
        let moved = |[u, v]: [f64; 2]| [u + x, v + y];
        for mut item in page.items {
            match &mut item.shape {
                Shape::Path { points, .. } => points.iter_mut().for_each(|point| *point = moved(*point)),
                Shape::Circle { centre, .. } => *centre = moved(*centre),
                Shape::Words(words) => words.at = moved(words.at),
            }
            self.items.push(item);
        }
    }

    /// The corners of all that is drawn: left and top, right and bottom.
    #[cfg(test)]
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let around = |[x, y]: [f64; 2], r: f64| [[x - r, y - r], [x + r, y + r]];
        let corners = self.items.iter().flat_map(|item| match &item.shape {
            Shape::Path { points, stroke, .. } => {
                let half = stroke.map_or(0.0, |stroke| 0.5 * stroke.width);
                points.iter().flat_map(|point| around(*point, half)).collect::<Vec<_>>()
            }
            Shape::Circle { centre, radius, .. } => around(*centre, *radius).to_vec(),
            Shape::Words(words) => words.bounds().to_vec(),
        });
        let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        corners.fold(start, |[low, high], at| {
            [[low[0].min(at[0]), low[1].min(at[1])], [high[0].max(at[0]), high[1].max(at[1])]]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_below_zero_have_a_minus_and_names_a_hyphen() {
        assert_eq!(
            with_minus("-1, (-2) of rk4-normalized by 1e-3 -x"),
            "−1, (−2) of rk4-normalized by 1e-3 -x"
        );
    }
}
