//! The style of figures as pgfplots reads it: the article's curves look like those of the program.

use std::fmt::Write as _;

use super::marks::is_hollow;
use super::style::{COLOURS, CURVE, Colour, DASHED, DOTTED, FAINT, GREY, MARKS, Shape, THIN, is_dashed};

/// Points of print for a pixel: a column of an article is about half as many points wide as a figure has pixels.
const POINT: f64 = 0.5;

/// Colours `curve-1`, `curve-2`, ..., `guide` and `faint`; styles `curve 1`, `curve 2`, ... of line and marks, `guide` of the lines
/// that curves are compared with, and `figure lines` of axes and grids.
pub fn latex() -> String {
    let mut text = String::new();
    let mut colour = |name: &str, Colour(red, green, blue): Colour| {
        writeln!(text, "\\definecolor{{{name}}}{{RGB}}{{{red},{green},{blue}}}").unwrap_or_default();
    };
    for (k, of) in COLOURS.into_iter().enumerate() {
        colour(&format!("curve-{}", k + 1), of);
    }
    colour("guide", GREY);
    colour("faint", FAINT);
    text += "\\pgfplotsset{\n";
    for k in 0..COLOURS.len() {
        text += &format!("  {},\n", curve(k));
    }
    let [dot, gap] = DOTTED.map(print);
    text += &format!(
        "  guide/.style={{guide, line width={}, dash pattern=on {dot} off {gap}}},\n  figure lines/.style={{axis line \
         style={{line width={}}}, grid style={{faint, line width={}}}}},\n}}\n",
        print(1.2),
        print(THIN),
        print(THIN),
    );
    text
}

fn curve(k: usize) -> String {
    let (shape, radius) = MARKS[k % MARKS.len()];
    let (mark, turned) = match shape {
        Shape::Circle => ("*", ""),
        Shape::Square => ("square*", ""),
        Shape::Triangle => ("triangle*", ""),
        Shape::Falling => ("triangle*", ", rotate=180"),
        Shape::Diamond => ("diamond*", ""),
    };
    let name = k + 1;
    let inside = if is_hollow(k) { "white".to_owned() } else { format!("curve-{name}") };
    let line = match DASHED.map(print) {
        [dash, gap] if is_dashed(k) => format!("dash pattern=on {dash} off {gap}"),
        _ => "solid".into(),
    };
    format!(
        "curve {name}/.style={{curve-{name}, line width={}, {line}, mark={mark}, mark size={}, mark options={{solid, line width={}, \
         draw=curve-{name}, fill={inside}{turned}}}}}",
        print(CURVE),
        print(radius),
        print(1.2),
    )
}

fn print(pixels: f64) -> String {
    format!("{:.2}pt", POINT * pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_and_mark_of_the_figures_is_named() {
        let text = latex();
        assert!(text.contains("\\definecolor{curve-3}{RGB}{0,114,178}\n"), "{text}");
        for k in 1..=COLOURS.len() {
            let style = text.lines().find(|line| line.contains(&format!("curve {k}/.style"))).unwrap();
            assert_eq!(style.contains("dash pattern"), k % 2 == 0, "{style}");
            assert_eq!(style.contains("fill=white"), k % 2 == 0, "{style}");
        }
    }
}
