//! A page as SVG.

use std::fmt::Write as _;

use super::canvas::{Anchor, Canvas, Fill, Shape, Stroke};
use super::style::{Colour, FAMILY};

impl Canvas {
    /// The page as SVG.
    pub fn svg(&self) -> String {
        let (width, height) = (short(self.width), short(self.height));
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"{FAMILY}\">\n"
        );
        if self.items.iter().any(|item| item.shape.is_shaded()) {
            svg += "<defs><radialGradient id=\"ball\" cx=\"0.38\" cy=\"0.32\" r=\"0.75\"><stop offset=\"0\" stop-color=\"#ffffff\"/>\
                    <stop offset=\"1\" stop-color=\"#e4e4e4\"/></radialGradient></defs>\n";
        }
        let _ = writeln!(svg, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>");
        for item in &self.items {
            let class = item.class.map_or(String::new(), |class| format!(" class=\"{class}\""));
            let _ = match &item.shape {
                Shape::Path { points, closed, stroke, fill } => {
                    let name = if *closed { "polygon" } else { "polyline" };
                    let points: Vec<String> =
                        points.iter().map(|[x, y]| format!("{},{}", short(*x), short(*y))).collect();
                    let (points, look) = (points.join(" "), look(*stroke, *fill));
                    writeln!(svg, "<{name}{class} points=\"{points}\"{look}/>")
                }
                Shape::Circle { centre: [x, y], radius, stroke, fill } => {
                    let [x, y, r] = [*x, *y, *radius].map(short);
                    writeln!(svg, "<circle{class} cx=\"{x}\" cy=\"{y}\" r=\"{r}\"{}/>", look(*stroke, *fill))
                }
                Shape::Words(words) => {
                    let [x, y] = words.at.map(short);
                    let turn = if words.upwards {
                        format!(" transform=\"rotate(-90 {x} {y})\"")
                    } else {
                        String::new()
                    };
                    let anchor = match words.anchor {
                        Anchor::Start => "start",
                        Anchor::Middle => "middle",
                        Anchor::End => "end",
                    };
                    let (size, colour) = (short(words.size), hex(words.colour));
                    let text = words.text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
                    writeln!(
                        svg,
                        "<text{class} x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{colour}\"{turn}>{text}</text>"
                    )
                }
            };
        }
        svg + "</svg>\n"
    }
}

impl Shape {
    pub(super) fn is_shaded(&self) -> bool {
        matches!(
            self,
            Shape::Path { fill: Some(Fill::Shaded), .. } | Shape::Circle { fill: Some(Fill::Shaded), .. }
        )
    }
}

fn look(stroke: Option<Stroke>, fill: Option<Fill>) -> String {
    let mut look = match fill {
        None => " fill=\"none\"".to_owned(),
        Some(Fill::Flat(colour, opacity)) => {
            format!(" fill=\"{}\"{}", hex(colour), share("fill-opacity", opacity))
        }
        Some(Fill::Shaded) => " fill=\"url(#ball)\"".to_owned(),
    };
    if let Some(stroke) = stroke {
        let (colour, width) = (hex(stroke.colour), short(stroke.width));
        let _ = write!(look, " stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"");
        look += &share("stroke-opacity", stroke.opacity);
        match stroke.dash {
            Some([dash, gap]) => {
                let _ = write!(look, " stroke-dasharray=\"{} {}\"", short(dash), short(gap));
            }
            None => look += " stroke-linecap=\"round\"",
        }
    }
    look
}

fn share(name: &str, opacity: f64) -> String {
    if opacity < 1.0 { format!(" {name}=\"{}\"", short(opacity)) } else { String::new() }
}

fn hex(Colour(r, g, b): Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Hundredths of a pixel are seen by nobody.
fn short(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}
