//! A page as PNG.

use polhode_files::error::{Error, unexpected};
use tiny_skia::{
    Color, FillRule, GradientStop, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Point,
    RadialGradient, Shader, SpreadMode, StrokeDash, Transform,
};

use super::canvas::{Canvas, Fill, Item, Shape, Stroke};
use super::font::{self, Pen};
use super::style::{Colour, PNG_SCALE};

impl Canvas {
    /// The page as PNG.
    ///
    /// # Errors
    /// A page without extent, or beyond memory.
    pub fn png(&self) -> Result<Vec<u8>, Error> {
        let [width, height] =
            [self.width, self.height].map(|length| libm::ceil(length * f64::from(PNG_SCALE)) as u32);
        let mut pixels =
            Pixmap::new(width, height).ok_or_else(|| unexpected("a page that no memory holds"))?;
        pixels.fill(Color::WHITE);
        for Item { shape, .. } in &self.items {
            draw(&mut pixels, shape);
        }
        pixels.encode_png().map_err(unexpected)
    }
}

/// Outlines of letters as they are filled.
struct Letters(PathBuilder);

impl Pen for Letters {
    fn move_to(&mut self, [x, y]: [f64; 2]) {
        self.0.move_to(x as f32, y as f32);
    }

    fn line_to(&mut self, [x, y]: [f64; 2]) {
        self.0.line_to(x as f32, y as f32);
    }

    fn curve_to(&mut self, [u, v]: [f64; 2], [x, y]: [f64; 2]) {
        self.0.quad_to(u as f32, v as f32, x as f32, y as f32);
    }

    fn close(&mut self) {
        self.0.close();
    }
}

fn draw(pixels: &mut Pixmap, shape: &Shape) {
    match shape {
        Shape::Path { points, closed, stroke, fill } => {
            let mut path = PathBuilder::new();
            for (k, [x, y]) in points.iter().map(|point| point.map(|x| x as f32)).enumerate() {
                if k == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
            }
            if *closed {
                path.close();
            }
            paint(pixels, path.finish(), *stroke, *fill);
        }
        Shape::Circle { centre: [x, y], radius, stroke, fill } => {
            let circle = PathBuilder::from_circle(*x as f32, *y as f32, *radius as f32);
            paint(pixels, circle, *stroke, *fill);
        }
        Shape::Words(words) => {
            let ([x, y], offset) = (words.at, words.offset());
            let place = |[u, v]: [f64; 2]| {
                let along = offset + u;
                if words.upwards { [x - v, y - along] } else { [x + along, y - v] }
            };
            let mut letters = Letters(PathBuilder::new());
            font::outline(&words.text, words.size, place, &mut letters);
            paint(pixels, letters.0.finish(), None, Some(Fill::Flat(words.colour, 1.0)));
        }
    }
}

fn paint(pixels: &mut Pixmap, path: Option<Path>, stroke: Option<Stroke>, fill: Option<Fill>) {
    // nothing is drawn of a path without extent
    let Some(path) = path else { return };
    let scale = Transform::from_scale(PNG_SCALE, PNG_SCALE);
    if let Some(fill) = fill {
        let shader = match fill {
            Fill::Flat(colour, opacity) => flat(colour, opacity),
            Fill::Shaded => ball(&path).unwrap_or_else(|| flat(Colour(240, 240, 240), 1.0)),
        };
        let paint = Paint { shader, anti_alias: true, ..Paint::default() };
        pixels.fill_path(&path, &paint, FillRule::Winding, scale, None);
    }
    if let Some(stroke) = stroke {
        let paint =
            Paint { shader: flat(stroke.colour, stroke.opacity), anti_alias: true, ..Paint::default() };
        let dash = stroke.dash.and_then(|dash| StrokeDash::new(dash.map(|x| x as f32).to_vec(), 0.0));
        let line_cap = if dash.is_some() { LineCap::Butt } else { LineCap::Round };
        let look = tiny_skia::Stroke {
            width: stroke.width as f32,
            line_cap,
            line_join: LineJoin::Round,
            dash,
            ..tiny_skia::Stroke::default()
        };
        pixels.stroke_path(&path, &paint, &look, scale, None);
    }
}

fn flat(Colour(r, g, b): Colour, opacity: f64) -> Shader<'static> {
    let alpha = libm::round(255.0 * opacity.clamp(0.0, 1.0)) as u8;
    Shader::SolidColor(Color::from_rgba8(r, g, b, alpha))
}

/// The light of a ball, as in the SVG.
fn ball(path: &Path) -> Option<Shader<'static>> {
    let bounds = path.bounds();
    let size = bounds.width().max(bounds.height());
    let light = Point::from_xy(bounds.left() + 0.38 * size, bounds.top() + 0.32 * size);
    let stops = vec![
        GradientStop::new(0.0, Color::WHITE),
        GradientStop::new(1.0, Color::from_rgba8(0xe4, 0xe4, 0xe4, 0xff)),
    ];
    RadialGradient::new(light, 0.0, light, 0.75 * size, stops, SpreadMode::Pad, Transform::identity())
}

#[cfg(test)]
mod tests {
    use super::super::canvas::{Anchor, Fill};
    use super::super::style::BLACK;
    use super::*;

    #[test]
    fn a_png_has_what_the_page_has() {
        let mut page = Canvas::new(60.0, 30.0);
        page.rectangle([5.0, 5.0], [15.0, 25.0], Some(Fill::Flat(BLACK, 1.0)), None);
        page.text([30.0, 20.0], "E", 20.0, Anchor::Start, BLACK);
        let pixels = Pixmap::decode_png(&page.png().unwrap()).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (120, 60));
        let red =
            |x: f64, y: f64| pixels.pixel((x * 2.0) as u32, (y * 2.0) as u32).unwrap().demultiply().red();
        assert_eq!([red(10.0, 15.0), red(2.0, 2.0), red(20.0, 15.0)], [0, 255, 255]);
        // the stem of the letter, and the space between its bars
        assert!(red(32.8, 13.0) < 60 && red(38.0, 16.5) > 200);
    }
}
