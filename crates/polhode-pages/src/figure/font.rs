//! The letters of figures: their widths, and their outlines for PNG.

use std::sync::OnceLock;

use ttf_parser::{Face, OutlineBuilder};

/// DejaVu Sans, as much of it as figures use.
static BYTES: &[u8] = include_bytes!("../../assets/DejaVuSans.ttf");

fn face() -> Option<&'static Face<'static>> {
    static FACE: OnceLock<Option<Face<'static>>> = OnceLock::new();
    FACE.get_or_init(|| Face::parse(BYTES, 0).ok()).as_ref()
}

/// Width of a text, pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    // a letter that the font lacks is as wide as an average one
    let advance = |letter: char| {
        let found = face().and_then(|face| {
            let glyph = face.glyph_index(letter)?;
            Some(f64::from(face.glyph_hor_advance(glyph)?) / f64::from(face.units_per_em()))
        });
        found.unwrap_or(0.6)
    };
    size * text.chars().map(advance).sum::<f64>()
}

/// A path in the making, in pixels, downwards.
pub(super) trait Pen {
    fn move_to(&mut self, at: [f64; 2]);
    fn line_to(&mut self, to: [f64; 2]);
    fn curve_to(&mut self, by: [f64; 2], to: [f64; 2]);
    fn close(&mut self);
}

/// Draws the outlines of a text with `pen`; `place` takes a point of the line of writing, pixels to the right of its beginning
/// and above it, to the page.
pub(super) fn outline(text: &str, size: f64, place: impl Fn([f64; 2]) -> [f64; 2], pen: &mut impl Pen) {
    let Some(face) = face() else { return };
    let scale = size / f64::from(face.units_per_em());
    let mut x = 0.0;
    for letter in text.chars() {
        let Some(glyph) = face.glyph_index(letter) else {
            x += width(letter.encode_utf8(&mut [0; 4]), size);
            continue;
        };
        face.outline_glyph(glyph, &mut Builder { pen, at: |u, v| place([x + scale * u, scale * v]) });
        x += scale * f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
}

struct Builder<'a, P, F> {
    pen: &'a mut P,
    at: F,
}

impl<P: Pen, F: Fn(f64, f64) -> [f64; 2]> OutlineBuilder for Builder<'_, P, F> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.pen.move_to((self.at)(x.into(), y.into()));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.pen.line_to((self.at)(x.into(), y.into()));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.pen.curve_to((self.at)(x1.into(), y1.into()), (self.at)(x.into(), y.into()));
    }

    // outlines of TrueType have quadratic curves only
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let by = (0.5 * (x1 + x2), 0.5 * (y1 + y2));
        self.quad_to(by.0, by.1, x, y);
    }

    fn close(&mut self) {
        self.pen.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_letters_of_figures_are_there() {
        for letter in "aZ09 ωθφψ′⁻¹²³⁰₁₂₃√∝≤−·×°²σλμΔ̇|ñé".chars() {
            assert!(face().unwrap().glyph_index(letter).is_some(), "{letter}");
        }
        // the widths of DejaVu Sans: i 569, m 1995 of 2048
        assert!((width("im", 2048.0) - 2564.0).abs() < 1.0, "{}", width("im", 2048.0));
        assert_eq!(width("ω\u{307}", 100.0), width("ω", 100.0));
    }
}
