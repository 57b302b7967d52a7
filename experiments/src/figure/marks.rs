//! The marks of curves: filled ones are small and the others hollow, so that one is seen within the other.

use super::canvas::{Canvas, Fill, Stroke};
use super::style::{Colour, WHITE};

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
    let polygon = |points: &[[f64; 2]]| points.iter().map(|[u, v]| [x + size * u, y + size * v]).collect();
    let square = |r: f64| polygon(&[[-r, -r], [r, -r], [r, r], [-r, r]]);
    let diamond = |r: f64| polygon(&[[0.0, -r], [r, 0.0], [0.0, r], [-r, 0.0]]);
    match k % 8 {
        0 => page.circle([x, y], 3.2 * size, inside, thin),
        1 => page.area(square(4.6), inside, thin),
        2 => page.area(polygon(&[[0.0, -4.6], [4.2, 3.0], [-4.2, 3.0]]), inside, thin),
        3 => page.circle([x, y], 5.4 * size, inside, thin),
        4 => page.area(square(3.0), inside, thin),
        5 => page.area(polygon(&[[0.0, 6.0], [5.6, -4.0], [-5.6, -4.0]]), inside, thin),
        6 => page.area(diamond(4.2), inside, thin),
        _ => page.area(diamond(6.6), inside, thin),
    }
}
