//! Text for a terminal: how wide it is, lines that fit, bars.

use std::io::IsTerminal;

/// Where nothing tells the width of a line.
pub const WIDTH: usize = 80;
/// A narrower terminal breaks lines itself.
const LEAST_WIDTH: usize = 40;

/// Shades of a cell by eighths.
const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];

/// A bar as long as `share`, from 0 to 1, of `width` cells.
///
/// ```
/// assert_eq!(polhode_pages::screen::bar(0.4375, 8), "███▌");
/// assert_eq!(polhode_pages::screen::bar(7.0, 2), "██");
/// ```
#[must_use]
pub fn bar(share: f64, width: usize) -> String {
    let eighths = (share.clamp(0.0, 1.0) * 8.0 * width as f64).round() as usize;
    "█".repeat(eighths / 8) + EIGHTHS[eighths % 8]
}

/// Columns of the terminal where standard output is one, 80 elsewhere.
#[must_use]
pub fn width() -> usize {
    if !std::io::stdout().is_terminal() {
        return WIDTH;
    }
    terminal_size::terminal_size().map_or(WIDTH, |(width, _)| usize::from(width.0).max(LEAST_WIDTH))
}

/// `text` in lines of at most `width` characters where its words allow it, all but the first after `indent` blanks.
///
/// ```
/// assert_eq!(polhode_pages::screen::wrapped("one two three", 9, 2), "one two\n  three");
/// ```
#[must_use]
pub fn wrapped(text: &str, width: usize, indent: usize) -> String {
    let (mut lines, mut column) = (String::new(), 0);
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if column > indent && column + 1 + length > width {
            lines += "\n";
            lines += &" ".repeat(indent);
            column = indent;
        } else if column > 0 {
            lines.push(' ');
            column += 1;
        }
        lines += word;
        column += length;
    }
    lines
}
