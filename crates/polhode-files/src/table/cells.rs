//! Cells of a line: what separates them, quotes, decimal commas, marks of comments.

use std::borrow::Cow;
use std::ops::Range;

use crate::error::Rule;

/// What separates the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Delimiter {
    /// A semicolon, a tab or a comma.
    Mark(char),
    /// Blanks.
    Blanks,
    /// Two blanks or more, as names of several words need it.
    Wide,
}

/// What follows the mark of a comment.
pub(crate) fn uncommented(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let marked = ["#", "%", "//"].into_iter().find(|mark| line.starts_with(mark))?;
    Some(line.trim_start_matches(marked).trim())
}

pub(crate) fn is_number(cell: &str) -> bool {
    cell.parse::<f64>().is_ok()
}

/// Ends of the parts of a line between separators that stand outside of quotes; a quote opens at the start of a part only.
fn parts(line: &str, separates: impl Fn(char) -> bool, found: &mut Vec<Range<usize>>) {
    found.clear();
    let (mut start, mut quoted) = (0, false);
    for (i, c) in line.char_indices() {
        if c == '"' {
            let part = line[start..i].trim_start();
            quoted ^= part.is_empty() || part.starts_with('"');
        } else if separates(c) && !quoted {
            found.push(start..i);
            start = i + c.len_utf8();
        }
    }
    found.push(start..line.len());
}

impl Delimiter {
    /// Of a line: the first of semicolon, tab and comma that separates cells in it, else blanks.
    pub(crate) fn of(line: &str) -> Self {
        if line.contains(',') && !line.contains([';', '\t', '"']) {
            return Self::Mark(',');
        }
        let mut found = Vec::new();
        let mut separates = |mark: &char| {
            parts(line.trim(), |c| c == *mark, &mut found);
            found.len() > 1
        };
        let mark = [';', '\t', ','].into_iter().find(|mark| line.contains(*mark) && separates(mark));
        mark.map_or(Self::Blanks, Self::Mark)
    }

    /// The character that stands for it in messages.
    pub(crate) fn mark(self) -> char {
        match self {
            Self::Mark(mark) => mark,
            Self::Blanks | Self::Wide => ' ',
        }
    }

    /// Where the cells of a line stand.
    pub(crate) fn split(self, line: &str, cells: &mut Vec<Range<usize>>) {
        match self {
            Self::Mark(mark) if !line.contains('"') => {
                cells.clear();
                let mut start = 0;
                for (end, _) in line.match_indices(mark) {
                    cells.push(start..end);
                    start = end + mark.len_utf8();
                }
                cells.push(start..line.len());
            }
            Self::Mark(mark) => parts(line, |c| c == mark, cells),
            Self::Blanks => {
                parts(line, char::is_whitespace, cells);
                cells.retain(|cell| !cell.is_empty());
            }
            Self::Wide => {
                parts(line, char::is_whitespace, cells);
                // two blanks leave an empty part between them
                let mut wide: Vec<Range<usize>> = Vec::new();
                let mut apart = true;
                for cell in cells.iter() {
                    match wide.last_mut() {
                        _ if cell.is_empty() => apart = true,
                        Some(last) if !apart => last.end = cell.end,
                        _ => {
                            wide.push(cell.clone());
                            apart = false;
                        }
                    }
                }
                *cells = wide;
            }
        }
    }

    /// The cells of a line without quotes, for names and units.
    pub(crate) fn names(self, line: &str) -> Vec<String> {
        let mut cells = Vec::new();
        self.split(line, &mut cells);
        cells.into_iter().map(|cell| plain(&line[cell]).to_string()).collect()
    }

    /// A number as Rust reads it: a comma is a decimal one where semicolons or tabs separate the cells, and elsewhere where it
    /// cannot separate thousands.
    pub(crate) fn number(self, cell: &str) -> Cow<'_, str> {
        if !cell.contains(',') {
            return cell.into();
        }
        let is_decimal = matches!(self, Self::Mark(';' | '\t')) || !may_part_thousands(cell);
        let pointed = cell.replace(',', ".");
        if is_decimal && is_number(&pointed) { pointed.into() } else { cell.into() }
    }
}

/// The rule that a line breaks of whose cells there are other than `columns`: `last` is the last place that is read, from 0,
/// `before` the cells of the line before.
pub(crate) fn width_rule(
    (line, is_ended): (&str, bool),
    delimiter: Delimiter,
    (cells, columns): (usize, usize),
    last: usize,
    before: usize,
) -> Option<Rule> {
    if cells == columns {
        return None;
    }
    let (of_header, of_line) = (delimiter.mark(), Delimiter::of(line).mark());
    let is_decimal = of_line == ',' && matches!(of_header, ';' | '\t');
    if of_line != of_header
        && !is_decimal
        && (of_line != ' ' || cells == 1 && line.split_whitespace().nth(1).is_some())
    {
        return Some(Rule::Delimiter(of_header, of_line));
    }
    // the logger was switched off in the middle of it
    if cells < columns && !is_ended && cells < before {
        return Some(Rule::Torn);
    }
    match cells > columns {
        true => Some(Rule::Longer(cells, columns)),
        false => (last >= cells).then_some(Rule::Shorter(cells, columns)),
    }
}

/// A cell without blanks and quotes around it.
pub(crate) fn plain(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

/// Whether a comma in a number has three digits after it and up to three before it, as one between thousands has.
pub(crate) fn may_part_thousands(cell: &str) -> bool {
    let Some((whole, rest)) = cell.trim_start_matches(['+', '-']).split_once(',') else { return false };
    let digits = rest.chars().take_while(char::is_ascii_digit).count();
    digits == 3
        && (1..=3).contains(&whole.len())
        && !whole.starts_with('0')
        && whole.chars().all(|c| c.is_ascii_digit())
}

/// Significant digits of a number as it is written, without leading zeros.
pub(crate) fn digits(text: &str) -> u32 {
    let mut count = 0;
    for c in text.bytes() {
        match c {
            b'0' if count == 0 => {}
            b'0'..=b'9' => count += 1,
            b'e' | b'E' => break,
            _ => {}
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted_from_the_first_that_is_not_zero() {
        for (text, count) in [("0", 0), ("-0.00120", 3), ("1.50e-300", 3), ("12.5", 3), ("0.1234567", 7)] {
            assert_eq!(digits(text), count, "{text}");
        }
    }

    #[test]
    fn cells_are_separated_outside_of_quotes() {
        for (line, delimiter, cells) in [
            ("t,\"w, x\" ,wy", Delimiter::Mark(','), vec!["t", "w, x", "wy"]),
            ("t  w x", Delimiter::Blanks, vec!["t", "w", "x"]),
            ("a, b;c", Delimiter::Mark(';'), vec!["a, b", "c"]),
            ("\"0,5\" 1", Delimiter::Blanks, vec!["0,5", "1"]),
            ("t,tube 5\",x", Delimiter::Mark(','), vec!["t", "tube 5", "x"]),
        ] {
            assert_eq!(
                (Delimiter::of(line), delimiter.names(line)),
                (delimiter, cells.iter().map(ToString::to_string).collect())
            );
        }
        assert_eq!(Delimiter::Wide.names("run 1  t   w"), ["run 1", "t", "w"]);
    }
}
