//! Lines and cells of a text: separators, comments, and where the header is.

use super::names::find_columns;

/// What follows the mark of a comment.
pub(super) fn uncommented(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let marked = ["#", "%", "//"].into_iter().find(|mark| line.starts_with(mark))?;
    Some(line.trim_start_matches(marked).trim())
}

fn is_number(cell: &str) -> bool {
    cell.parse::<f64>().is_ok()
}

/// The names of the columns, and where the lines after them begin.
///
/// That is the last line to name all columns before the first with numbers in them. Where no line does, a message needs
/// the one that was meant: that before the first line of numbers, or else the first with as many cells as the last.
pub(super) fn find_header(lines: &[(usize, &str)]) -> (usize, Vec<String>) {
    let mut header: Option<(usize, Vec<String>, [usize; 4])> = None;
    let mut named_by_comment = true;
    for (k, (_, line)) in lines.iter().enumerate() {
        let comment = uncommented(line);
        let row = cells(comment.unwrap_or(line));
        if let Ok(columns) = find_columns(&row).map(|found| found.columns) {
            // prose may name t, x, y, z as well
            if named_by_comment || comment.is_none() {
                header = Some((k, row, columns));
                named_by_comment = comment.is_some();
            }
        } else if comment.is_none() {
            let numbers = |columns: &[usize; 4]| {
                columns.iter().filter(|c| row.get(**c).is_some_and(|cell| is_number(cell))).count()
            };
            // one number alone may stand in a preamble
            let is_row = header.as_ref().is_some_and(|(_, _, columns)| numbers(columns) > 1);
            if is_row || row.first().is_some_and(|cell| is_number(cell)) {
                break;
            }
        }
    }
    if let Some((k, names, _)) = header {
        return (k + 1, names);
    }
    let mut before = Vec::new();
    for (_, line) in lines {
        let comment = uncommented(line);
        let row = cells(comment.unwrap_or(line));
        let numbers = row.iter().filter(|cell| is_number(cell)).count();
        if comment.is_none() && (2 * numbers > row.len() || row.first().is_some_and(|cell| is_number(cell))) {
            return (lines.len(), before);
        }
        if !row.is_empty() {
            before = row;
        }
    }
    let mut rows = lines.iter().map(|(_, line)| cells(uncommented(line).unwrap_or(line)));
    (lines.len(), rows.find(|row| row.len() == before.len()).unwrap_or_default())
}

/// The parts of a line between separators that stand outside of quotes; a quote opens at the start of a part only.
fn parts(line: &str, separates: impl Fn(char) -> bool) -> Vec<&str> {
    let (mut parts, mut start, mut quoted) = (Vec::new(), 0, false);
    for (i, c) in line.char_indices() {
        if c == '"' {
            let part = line[start..i].trim_start();
            quoted ^= part.is_empty() || part.starts_with('"');
        } else if separates(c) && !quoted {
            parts.push(&line[start..i]);
            start = i + c.len_utf8();
        }
    }
    parts.push(&line[start..]);
    parts
}

/// Whether a comma in a number has three digits after it and up to three before it, as one between thousands has.
pub(super) fn may_part_thousands(cell: &str) -> bool {
    let Some((whole, rest)) = cell.trim_start_matches(['+', '-']).split_once(',') else { return false };
    let digits = rest.chars().take_while(char::is_ascii_digit).count();
    digits == 3
        && (1..=3).contains(&whole.len())
        && !whole.starts_with('0')
        && whole.chars().all(|c| c.is_ascii_digit())
}

/// The cells of a line, quotes removed. A comma in a number is a decimal one where semicolons or tabs part the cells, and
/// within quotes where it cannot part thousands.
pub(super) fn cells(line: &str) -> Vec<String> {
    // the usual row
    if line.contains(',') && !line.contains([';', '\t', '"']) {
        return line.split(',').map(|cell| cell.trim().to_string()).collect();
    }
    let delimiter =
        [';', '\t', ','].into_iter().find(|&d| line.contains(d) && parts(line.trim(), |c| c == d).len() > 1);
    let clean = |cell: &str| {
        let cell = cell.trim().trim_matches('"').trim();
        let is_decimal = matches!(delimiter, Some(';' | '\t')) || !may_part_thousands(cell);
        let pointed = cell.replace(',', ".");
        if is_decimal && is_number(&pointed) { pointed } else { cell.to_string() }
    };
    if let Some(delimiter) = delimiter {
        return parts(line, |c| c == delimiter).into_iter().map(clean).collect();
    }
    // two spaces leave an empty part between them
    let words = parts(line, char::is_whitespace);
    let wide: Vec<String> =
        words.split(|w| w.is_empty()).filter(|w| !w.is_empty()).map(|w| clean(&w.join(" "))).collect();
    if wide.len() > 1 { wide } else { words.into_iter().filter(|w| !w.is_empty()).map(clean).collect() }
}
