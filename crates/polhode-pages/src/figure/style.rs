//! The style of every figure: sizes, widths of lines, colours, dashes.
//!
//! The palette is that of Okabe and Ito, distinct to readers of any colour vision; curves that follow each other also differ
//! in grey, in their dashes and in their marks.

/// A colour of the screen, red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub u8, pub u8, pub u8);

/// Of axes, words and the first curve.
pub const BLACK: Colour = Colour(0, 0, 0);
/// Of the page.
pub const WHITE: Colour = Colour(255, 255, 255);
/// Of the third curve.
pub const BLUE: Colour = Colour(0, 114, 178);
/// Of the fourth curve.
pub const GREEN: Colour = Colour(0, 158, 115);
/// Of the second curve.
pub const ORANGE: Colour = Colour(213, 94, 0);
/// Of guides, leaders and what lies behind.
pub const GREY: Colour = Colour(95, 95, 95);
/// Of the lines of a grid.
pub const FAINT: Colour = Colour(222, 222, 222);

/// Colours of the curves, in their order.
pub const COLOURS: [Colour; 9] = [
    BLACK,
    ORANGE,
    BLUE,
    GREEN,
    Colour(204, 121, 167),
    Colour(150, 110, 0),
    Colour(86, 180, 233),
    Colour(120, 120, 120),
    Colour(170, 30, 60),
];

/// Outline of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A circle.
    Circle,
    /// A square.
    Square,
    /// A triangle with its tip above.
    Triangle,
    /// A triangle with its tip below.
    Falling,
    /// A square on its corner.
    Diamond,
}

/// Marks of the curves, in their order, with their radii in pixels: every second one is hollow and larger, so that one is seen
/// within the other.
pub const MARKS: [(Shape, f64); 8] = [
    (Shape::Circle, 3.2),
    (Shape::Square, 4.6),
    (Shape::Triangle, 4.6),
    (Shape::Circle, 5.4),
    (Shape::Square, 3.0),
    (Shape::Falling, 6.0),
    (Shape::Diamond, 4.2),
    (Shape::Diamond, 6.6),
];

/// Width of a figure for a column of an article, pixels; in print it is reduced to a half.
pub const COLUMN: f64 = 500.0;
/// Height of a plot with its title and axes.
pub const HEIGHT: f64 = 400.0;

/// Size of the letters of titles, pixels.
pub const TITLE: f64 = 15.0;
/// Of the names of axes.
pub const AXIS: f64 = 14.0;
/// Of the numbers at axes.
pub const LABEL: f64 = 13.0;
/// Of the names of curves.
pub const NAME: f64 = 13.0;

/// Distance of the lines of a text, pixels.
pub const LINE: f64 = 19.0;
/// Distance of names beside curves, pixels.
pub const NAMES: f64 = 15.0;

/// Width of curves, pixels.
pub const CURVE: f64 = 1.8;
/// Width of envelopes, pixels.
pub const WIDE: f64 = 3.6;
/// Width of axes and grids, pixels.
pub const THIN: f64 = 1.0;

/// Dash and gap of dashed curves, pixels.
pub const DASHED: [f64; 2] = [7.0, 4.0];
/// Of guides.
pub const DOTTED: [f64; 2] = [1.5, 3.5];
/// Of what lies behind a sphere.
pub const HIDDEN: [f64; 2] = [4.0, 4.0];

/// Whether the k-th curve is dashed.
pub fn is_dashed(k: usize) -> bool {
    k % 2 == 1
}

/// The family of letters where the font of the program is not installed: others that are not wider.
pub const FAMILY: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

/// Pixels of a PNG for each of the drawing.
pub const PNG_SCALE: f32 = 2.0;
