//! Where the header of a table stands.

use std::collections::VecDeque;

use super::ReadOptions;
use super::cells::{Delimiter, is_number, uncommented};
use super::header::Header;
use super::lammps::spelled;
use super::lines::Line;
use super::name::Name;
use super::source::Source;
use crate::error::{Rule, TableError};

/// Lines in which a header is looked for.
const MOST_LINES: usize = 10_000;

/// Rows that are looked at where there is no header.
const ALIKE: usize = 50;

/// Columns of a message of the type sensor_msgs/Imu that ROS 2 prints as CSV: seconds, nanoseconds, frame, orientation with
/// covariance, then the angular velocity.
const ROS_2_COLUMNS: usize = 40;

/// A header, and what was read to find it.
pub(crate) struct Looked {
    pub(crate) header: Header,
    /// The line that it stands in, if any.
    pub(crate) named_at: Option<u64>,
    /// What separates the cells of rows.
    pub(crate) delimiter: Delimiter,
    /// Lines up to the header.
    pub(crate) before: Vec<Line>,
    /// Lines behind it that were read.
    pub(crate) ahead: VecDeque<Line>,
}

/// A line that names columns.
struct Candidate {
    /// How many lines end with it.
    end: usize,
    header: Header,
    delimiter: Delimiter,
    is_comment: bool,
}

/// Looks for the header: the last line to name a time and a quantity before the first row of numbers.
pub(crate) fn look(source: &mut Source, reading: &ReadOptions) -> Result<Looked, TableError> {
    let mut lines: Vec<Line> = Vec::new();
    let mut best: Option<Candidate> = None;
    let mut line = Line::default();
    let mut is_first_row = false;
    while !is_first_row && lines.len() < MOST_LINES && source.advance(&mut line)? {
        if line.text.is_empty() {
            continue;
        }
        let comment = uncommented(&line.text);
        let text = comment.unwrap_or(&line.text);
        if let Some((header, delimiter)) = header_of(text, source.is_dump(), reading) {
            // prose may name t, x, y, z as well
            if comment.is_none() || best.as_ref().is_none_or(|best| best.is_comment) {
                let (end, is_comment) = (lines.len() + 1, comment.is_some());
                best = Some(Candidate { end, header, delimiter, is_comment });
            }
        } else if comment.is_none() {
            is_first_row = is_row(text, best.as_ref());
        }
        lines.push(std::mem::take(&mut line));
    }
    let ahead_from = |lines: &mut Vec<Line>, end: usize| lines.split_off(end).into();
    if let Some(Candidate { end, header, delimiter, is_comment }) = best {
        let ahead: VecDeque<Line> = ahead_from(&mut lines, end);
        let first = ahead.iter().find(|line| uncommented(&line.text).is_none());
        let delimiter =
            if is_comment { first.map_or(delimiter, |row| Delimiter::of(&row.text)) } else { delimiter };
        let named_at = lines.last().map(|line| line.number);
        return Ok(Looked { header, named_at, delimiter, before: lines, ahead });
    }
    let end = lines.iter().position(|line| uncommented(&line.text).is_none() && is_row(&line.text, None));
    // names above the rows are a header, also where they are not known
    if let Some(end) = end.filter(|end| lines[..*end].iter().all(|line| uncommented(&line.text).is_some())) {
        while lines.len() < end + ALIKE && source.advance(&mut line)? {
            if !line.text.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
        }
        let named = end > 0 && names_columns(&lines[end - 1].text, &lines[end].text);
        let is_open = !named || reading.columns != super::ColumnNames::default();
        if let Some((header, delimiter)) = headless(&lines[end..], reading).filter(|_| is_open) {
            let ahead = ahead_from(&mut lines, end);
            return Ok(Looked { header, named_at: None, delimiter, before: lines, ahead });
        }
    }
    // a message needs the line that was meant
    let (names, number) = meant(&lines, end);
    let error = TableError::of(
        source.name(),
        match Header::of(&names, &reading.columns, reading.sample_rate.is_some()) {
            _ if lines.is_empty() => Rule::Rows,
            Err(rule) => rule,
            Ok(_) => Rule::Quantity(names),
        },
    );
    Err(if let Some(number) = number { error.at(number) } else { error })
}

/// The header in a line, if it is one. Names separated by blanks may hold single blanks.
fn header_of(text: &str, is_dump: bool, reading: &ReadOptions) -> Option<(Header, Delimiter)> {
    let of = |delimiter: Delimiter| {
        let cells = delimiter.names(text);
        let spelled = if is_dump { spelled(&cells) } else { cells.clone() };
        let header =
            Header::spelled(&cells, &spelled, &reading.columns, reading.sample_rate.is_some()).ok()?;
        // a row of numbers has columns of these numbers as well
        let is_row = header.columns().iter().any(|place| is_number(&cells[*place]));
        (!is_row).then_some((header, delimiter))
    };
    match Delimiter::of(text) {
        Delimiter::Mark(mark) => of(Delimiter::Mark(mark)),
        _ => of(Delimiter::Wide).or_else(|| of(Delimiter::Blanks)),
    }
}

/// Whether a line is a row: numbers stand in the columns of the header, or a number first.
fn is_row(text: &str, header: Option<&Candidate>) -> bool {
    let number = |cell: &&String| is_number(cell);
    let delimiter =
        header.filter(|best| !best.is_comment).map_or_else(|| Delimiter::of(text), |best| best.delimiter);
    let cells = delimiter.names(text);
    let numbers = |best: &Candidate| {
        let places = best.header.columns().into_iter().chain(best.header.time);
        places.filter_map(|place| cells.get(place)).filter(number).count()
    };
    // one number alone may stand in a preamble
    header.is_some_and(|best| numbers(best) > 1) || cells.first().is_some_and(|cell| number(&cell))
}

/// Rows of numbers without a header: columns that are named by number, time and three rates, or messages of ROS 2.
fn headless(lines: &[Line], reading: &ReadOptions) -> Option<(Header, Delimiter)> {
    let mut rows = lines.iter().map(|line| line.text.as_str()).filter(|text| uncommented(text).is_none());
    let first = rows.next()?;
    let delimiter = Delimiter::of(first);
    let row = delimiter.names(first);
    let numbers = |row: &[String]| row.iter().filter(|cell| is_number(&delimiter.number(cell))).count();
    let numbered: Vec<String> = (1..=row.len()).map(|n| n.to_string()).collect();
    if reading.columns != super::ColumnNames::default() {
        let header = Header::of(&numbered, &reading.columns, reading.sample_rate.is_some()).ok()?;
        return Some((header, delimiter));
    }
    let is_alike = rows.all(|other| numbers(&delimiter.names(other)) + 1 >= numbers(&row));
    let header = match row.len() {
        4 if numbers(&row) == 4 => Header::numbered(4, (0, None), [1, 2, 3]),
        ROS_2_COLUMNS if numbers(&row) == ROS_2_COLUMNS - 1 => {
            Header::numbered(ROS_2_COLUMNS, (0, Some(1)), [16, 17, 18])
        }
        _ => return None,
    };
    is_alike.then_some((header, delimiter))
}

/// Whether the comment above rows without a header names their columns: words as many as cells, of which one is a time, or that
/// are a name a cell, or three of which name axes. Prose of as many words is none.
fn names_columns(comment: &str, row: &str) -> bool {
    let Some(comment) = uncommented(comment) else { return false };
    let delimiter = Delimiter::of(comment);
    let words = delimiter.names(comment);
    let is_prose = |word: &String| {
        let lower = word.to_lowercase();
        let is_particle = ["and", "at", "in", "is", "of", "the", "with"].contains(&lower.as_str());
        word.is_empty() || is_number(word) || is_particle || word.ends_with([':', '.', '!', '?'])
    };
    if words.len() != Delimiter::of(row).names(row).len() || words.iter().any(is_prose) {
        return false;
    }
    let names: Vec<Name> = words.iter().map(|word| Name::of(word)).collect();
    let is_axis = |stem: &str, axis: char| names.iter().any(|name| name.letters == format!("{stem}{axis}"));
    let mut stems = names.iter().filter_map(|name| name.letters.strip_suffix('x'));
    let is_listed = matches!(delimiter, Delimiter::Mark(_)) && !words.iter().any(|word| word.contains(' '));
    is_listed
        || names.iter().any(|name| name.time_rank().is_some())
        || stems.any(|stem| is_axis(stem, 'y') && is_axis(stem, 'z'))
}

/// The line that was meant for a header, and its number: that before the first row, or else the first line with as many cells
/// as the last.
fn meant(lines: &[Line], row: Option<usize>) -> (Vec<String>, Option<u64>) {
    let split = |line: &Line| {
        let text = uncommented(&line.text).unwrap_or(&line.text);
        Delimiter::of(text).names(text)
    };
    let full = |lines: &[Line]| {
        lines.iter().rev().map(|line| (split(line), line.number)).find(|(cells, _)| !cells.is_empty())
    };
    let found = match row {
        Some(row) => full(&lines[..row]),
        None => {
            let count = full(lines).map_or(0, |(cells, _)| cells.len());
            lines.iter().map(|line| (split(line), line.number)).find(|(cells, _)| cells.len() == count)
        }
    };
    found.map_or((Vec::new(), None), |(cells, number)| (cells, Some(number)))
}
