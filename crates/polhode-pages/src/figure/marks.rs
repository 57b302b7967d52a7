//! The marks of curves: filled ones are small and the others hollow, so that one is seen within the other.

use super::canvas::{Canvas, Fill, Stroke};
use super::style::{Colour, MARKS, Shape, WHITE};

/// Whether the mark of the k-th curve is hollow.
pub(super) fn is_hollow(k: usize) -> bool {
    k % 2 == 1
}

/// The mark of the k-th curve. No line is seen within a hollow one.
pub(super) fn mark(page: &mut Canvas, k: usize, [x, y]: [f64; 2], colour: Colour, size: f64) {
    let (inside, thin) = if is_hollow(k) {
        (Some(Fill::Flat(WHITE, 1.0)), Some(Stroke::new(colour, 1.2)))
    } else {
        (Some(Fill::Flat(colour, 1.0)), None)
    };
    let (shape, radius) = MARKS[k % MARKS.len()];
    let r = size * radius;
    let corners: &[[f64; 2]] = match shape {
        Shape::Circle => return page.circle([x, y], r, inside, thin),
        Shape::Square => &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
        Shape::Triangle => &[[0.0, -1.0], [0.92, 0.66], [-0.92, 0.66]],
        Shape::Falling => &[[0.0, 1.0], [0.92, -0.66], [-0.92, -0.66]],
        Shape::Diamond => &[[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]],
    };
    page.area(corners.iter().map(|[u, v]| [x + r * u, y + r * v]).collect(), inside, thin);
}
