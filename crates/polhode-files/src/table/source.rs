//! What rows come from: plain lines, messages of ROS, dumps of LAMMPS.

use polhode::units::TimeUnit;

use super::lammps::Dump;
use super::lines::{Line, Lines};
use super::ros::Echo;
use crate::error::TableError;

/// Lines of a table.
pub(crate) enum Source<'t> {
    /// As they are; the first line that is not empty was read already.
    Plain(Lines<'t>, Option<Line>),
    Echo(Echo<'t>),
    Dump(Dump<'t>),
}

impl<'t> Source<'t> {
    /// Of lines, by the first that is not empty.
    pub(crate) fn new(mut lines: Lines<'t>) -> Result<Self, TableError> {
        let mut first = Line::default();
        while plain(&mut lines, &mut first)? {
            if first.text.starts_with("ITEM:") {
                return Ok(Self::Dump(Dump::new(lines, &first.text)));
            }
            if matches!(first.text.as_str(), "header:" | "---") {
                return Ok(Self::Echo(Echo::new(lines)));
            }
            if !first.text.is_empty() {
                return Ok(Self::Plain(lines, Some(first)));
            }
        }
        Ok(Self::Plain(lines, None))
    }

    /// Reads the next line; `false` behind the last.
    pub(crate) fn advance(&mut self, line: &mut Line) -> Result<bool, TableError> {
        match self {
            Self::Plain(lines, first) => match first.take() {
                Some(first) => {
                    *line = first;
                    Ok(true)
                }
                None => plain(lines, line),
            },
            Self::Echo(echo) => echo.advance(line),
            Self::Dump(dump) => dump.advance(line),
        }
    }

    /// As messages name it.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Plain(lines, _) => &lines.name,
            Self::Echo(echo) => &echo.lines.name,
            Self::Dump(dump) => &dump.lines.name,
        }
    }

    pub(crate) fn is_dump(&self) -> bool {
        matches!(self, Self::Dump(_))
    }

    /// The unit of time of a dump that names its units, whether it has times or not.
    pub(crate) fn style_unit(&self) -> Option<TimeUnit> {
        match self {
            Self::Dump(dump) => dump.unit,
            _ => None,
        }
    }

    /// The unit of the times of a dump that names its units.
    pub(crate) fn time_unit(&self) -> Option<TimeUnit> {
        match self {
            Self::Dump(dump) => dump.time_unit(),
            _ => None,
        }
    }
}

fn plain(lines: &mut Lines, line: &mut Line) -> Result<bool, TableError> {
    let found = lines.advance()?;
    (line.number, line.is_ended) = (lines.number, lines.is_ended);
    std::mem::swap(&mut line.text, &mut lines.text);
    let end = line.text.trim_end().len();
    line.text.truncate(end);
    let start =
        line.text.len() - line.text.trim_start_matches(|c: char| c.is_whitespace() && c != '\t').len();
    line.text.drain(..start);
    Ok(found)
}
