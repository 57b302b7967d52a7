//! What can go wrong with a file, a flag or a run, and how it is told.

use std::cell::RefCell;
use std::fmt::{self, Write as _};
use std::io::Write as _;

use crate::text::{short, visible, visible_lines};

/// A message for standard error and the exit code that goes with it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A claim, a fit or a check failed: the input was usable, the answer is no. Exit code 1.
    #[error("{0}")]
    Failed(String),
    /// Input that cannot be used. Exit code 2.
    #[error("{0}")]
    Input(String),
    /// A place in a table that cannot be used. Exit code 2.
    #[error("{0}")]
    Table(TableError),
    /// The reader of standard output has seen enough, and the work ends. Exit code 0, and nothing is said.
    #[error("standard output is read no further")]
    Unread,
}

/// Where a table breaks which rule, and what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct TableError(Box<Broken>);

/// The parts of a [`TableError`]. Lines and columns count from 1, the header included.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Broken {
    /// Name of the file.
    pub file: String,
    /// The line; `None` of the file as a whole.
    pub line: Option<u64>,
    /// Number and name of the column.
    pub column: Option<(usize, String)>,
    /// What stands there; empty where nothing does.
    pub value: String,
    /// The rule that it breaks.
    pub rule: Rule,
    /// What to do.
    pub remedy: String,
}

/// A rule for tables.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Rule {
    /// The file can be read; the reason why it cannot.
    Readable(String),
    /// A line is no longer than this many bytes.
    Length(usize),
    /// Text is UTF-8.
    Utf8,
    /// There are rows.
    Rows,
    /// A column of this quantity is needed; the names that were found.
    Column(String, Vec<String>),
    /// Some columns hold an attitude, an angular velocity or an angular momentum; the names that were found.
    Quantity(Vec<String>),
    /// One column has the name.
    Unique(usize, usize),
    /// One group of columns holds the quantity: what, and the first names of both.
    OneGroup(&'static str, String, String),
    /// The columns of a quantity are complete.
    Complete(String),
    /// The unit is known; those that are.
    KnownUnit(&'static str),
    /// The header and a flag name one unit: that of the header, that of the flag.
    OneUnit(String, String),
    /// The header names a unit, such as this one.
    Unit(&'static str),
    /// Times are in a unit of time; this column counts samples.
    Time,
    /// Rows have no more cells than the header: cells and columns.
    Longer(usize, usize),
    /// Rows reach the last column that is read: cells and columns.
    Shorter(usize, usize),
    /// The file ends at the end of a row.
    Torn,
    /// One mark parts the cells of all lines: that of the header, that of the line.
    Delimiter(char, char),
    /// A number is there.
    Missing,
    /// The cell is a number.
    Number,
    /// The number is finite.
    Finite,
    /// No comma in a number may part thousands or decimals.
    Comma,
    /// Times do not decrease, or ascend where that is `true`; the time before, s.
    Order(f64, bool),
    /// An attitude is not zero.
    Turn,
    /// What else a layout asks for.
    Other(String),
}

impl Rule {
    /// The rule in words, and what to do where nothing better is known.
    fn words(&self) -> (String, &'static str) {
        const FILE: &str = "name a text file of rows";
        const ROW: &str = "leave the row out, or complete it";
        match self {
            Self::Readable(reason) => (format!("cannot be read: {reason}"), FILE),
            Self::Length(most) => (format!("longer than {most} bytes"), FILE),
            Self::Utf8 => ("not UTF-8".into(), FILE),
            Self::Rows => ("no rows".into(), "name a file with a header and one row for each time"),
            Self::Column(missing, found) => (
                format!("no column for {missing}; the header has {}", listed(found)),
                "name the columns t, wx, wy, wz (or \"Time (s)\", \"Gyroscope x (rad/s)\", ...), or say which they are: --columns t=NAME,wx=NAME,... (keys in --help)",
            ),
            Self::Quantity(found) => (
                format!("no attitude and no angular velocity among the columns {}", listed(found)),
                "name the columns by --columns t=NAME,qw=NAME,qx=NAME,... (keys in --help)",
            ),
            Self::Unique(first, second) => (
                format!("columns {first} and {second} both have this name"),
                "rename one, or give the number of the column that is meant in --columns",
            ),
            Self::OneGroup(what, first, second) => (
                format!(
                    "two {what}: one from column '{}' on, one from '{}' on",
                    visible(first),
                    visible(second)
                ),
                "name the columns of one by --columns (keys in --help)",
            ),
            Self::Complete(keys) => (format!("only a part of {keys}"), "name all of them, or none"),
            Self::KnownUnit(known) => {
                (format!("unknown unit; known: {known}"), "convert the column, or correct its header")
            }
            Self::OneUnit(header, flag) => {
                (format!("the header says {header}, the flag says {flag}"), "drop one of the two")
            }
            Self::Unit(unit) => (
                format!("the column has no unit; {unit} is needed"),
                "write it in the header, as NAME (UNIT)",
            ),
            Self::Time => {
                ("counts samples and is not a time".into(), "give the rate of the samples: --sample-rate HZ")
            }
            Self::Longer(cells, columns) => (
                format!("{cells} cells where the header has {columns}"),
                "every row must have as many cells as the header, with decimal points where commas separate them",
            ),
            Self::Shorter(cells, columns) => (format!("the row has {cells} of {columns} columns"), ROW),
            Self::Torn => ("the file ends in the middle of this row".into(), ROW),
            Self::Delimiter(header, line) => (
                format!("cells separated by {} where the header has {}", mark(*line), mark(*header)),
                "separate the cells of every line by the same mark",
            ),
            Self::Missing => ("a number is missing".into(), ROW),
            Self::Number => ("is not a number".into(), "write it like 0.5 or 1e-3"),
            Self::Finite => ("is not a finite number".into(), "leave the row out"),
            Self::Comma => (
                "has a comma that may separate thousands or decimals".into(),
                "write a decimal point and no other mark",
            ),
            Self::Order(before, true) => (
                format!("does not come after the time before it, {} s", short(*before)),
                "sort the rows by time; rows of several bodies need a column id",
            ),
            Self::Order(before, false) => (
                format!("comes before the time above it, {} s", short(*before)),
                "sort the rows by time, or give the files apart",
            ),
            Self::Turn => (
                "every component of the attitude is zero, which is not a rotation".into(),
                "leave the row out",
            ),
            Self::Other(rule) => (rule.clone(), "name a table with a header"),
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words().0)
    }
}

fn mark(c: char) -> &'static str {
    match c {
        ',' => "commas",
        ';' => "semicolons",
        '\t' => "tabs",
        _ => "blanks",
    }
}

/// Names of columns that a message lists, and their characters in all.
const LISTED: (usize, usize) = (60, 1500);

/// All names of a header; of a file of another kind, which has none, the beginning.
fn listed(names: &[String]) -> String {
    let length: usize = names.iter().map(String::len).sum();
    let shown: Vec<String> = names.iter().map(|name| format!("'{}'", visible(name))).collect();
    let all = if shown.is_empty() { "none".into() } else { shown.join(", ") };
    let is_header = names.len() <= LISTED.0 && length <= LISTED.1;
    if is_header && !names.iter().any(|name| name.contains(char::is_control)) {
        all
    } else {
        begun(&all).into_owned()
    }
}

/// Characters of a value that a message shows; a file of another kind may be a single line.
const SHOWN: usize = 50;

fn begun(text: &str) -> std::borrow::Cow<'_, str> {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]).into(),
        None => text.into(),
    }
}

impl TableError {
    /// Of a rule, with its usual remedy, at no line yet.
    pub(crate) fn of(file: &str, rule: Rule) -> Self {
        let remedy = rule.words().1.into();
        let (file, value) = (file.into(), String::new());
        Self(Box::new(Broken { file, line: None, column: None, value, rule, remedy }))
    }

    /// At this line.
    pub(crate) fn at(mut self, line: u64) -> Self {
        self.0.line = Some(line);
        self
    }

    /// In the column of this place, from 0, and name.
    pub(crate) fn in_column(mut self, place: usize, name: &str) -> Self {
        self.0.column = Some((place + 1, name.into()));
        self
    }

    /// Where this stands.
    pub(crate) fn value(mut self, value: &str) -> Self {
        self.0.value = value.into();
        self
    }

    /// With another remedy.
    #[must_use]
    pub fn with_remedy(mut self, remedy: &str) -> Self {
        self.0.remedy = remedy.into();
        self
    }

    /// Whether it concerns one row, so that the others are usable without it.
    #[must_use]
    pub fn is_of_a_row(&self) -> bool {
        use Rule::{Comma, Delimiter, Finite, Longer, Missing, Number, Order, Shorter, Torn, Turn};
        matches!(
            self.rule,
            Longer(..)
                | Shorter(..)
                | Torn
                | Delimiter(..)
                | Missing
                | Number
                | Finite
                | Comma
                | Order(..)
                | Turn
        )
    }
}

impl std::ops::Deref for TableError {
    type Target = Broken;
    fn deref(&self) -> &Broken {
        &self.0
    }
}

impl fmt::Display for TableError {
    /// File, line, column, value, rule and remedy.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if let Some((number, name)) = &self.column {
            write!(f, ", column {number} ({})", begun(&visible(name)))?;
        }
        f.write_str(": ")?;
        if !self.value.is_empty() {
            write!(f, "'{}': ", begun(&visible(&self.value)))?;
        }
        write!(f, "{}; {}", self.rule, self.remedy)
    }
}

impl From<TableError> for Error {
    fn from(error: TableError) -> Self {
        Self::Table(error)
    }
}

/// What ours alone can cause: catalogues and examples are valid; if one is not, that is what failed.
pub fn unexpected(error: impl std::fmt::Display) -> Error {
    Error::Failed(error.to_string())
}

impl Error {
    /// Unusable input: where it stands (flag or file:line), what it is, the rule it breaks, what to do.
    pub fn input(place: &str, value: &str, rule: &str, remedy: &str) -> Self {
        let mut message = format!("{place}: ");
        if !value.is_empty() {
            let _ = write!(message, "'{}': ", visible(value));
        }
        let _ = write!(message, "{rule}; {remedy}");
        Self::Input(message)
    }

    /// The exit code of the process.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Unread => 0,
            Self::Failed(_) => 1,
            Self::Input(_) | Self::Table(_) => 2,
        }
    }
}

thread_local! {
    /// Remarks of a program that shows them itself.
    static HEARD: RefCell<Option<Vec<String>>> = const { RefCell::new(None) };
}

/// What `work` returns, and its remarks on this thread, which then do not go to standard error.
pub fn hearing<T>(work: impl FnOnce() -> T) -> (T, Vec<String>) {
    HEARD.set(Some(Vec::new()));
    let found = work();
    (found, HEARD.take().unwrap_or_default())
}

/// A remark on standard error, unless somebody [hears](hearing) it; the run goes on.
pub fn warn(message: &str) {
    let heard = HEARD.with_borrow_mut(|heard| heard.as_mut().map(|all| all.push(message.into())));
    if heard.is_none() {
        tell("warning", message);
    }
}

/// A line on standard error. Where nobody listens (`2>&1 | head`), nothing is said.
pub fn tell(kind: &str, message: &str) {
    let _ = writeln!(std::io::stderr(), "{kind}: {}", visible_lines(message));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_are_heard_by_those_who_ask() {
        let (found, heard) = hearing(|| {
            warn("first");
            warn("second");
            7
        });
        assert_eq!((found, heard), (7, vec!["first".to_string(), "second".to_string()]));
        assert!(HEARD.take().is_none());
    }

    #[test]
    fn codes_tell_a_refusal_from_unusable_input() {
        assert_eq!(Error::Failed(String::new()).exit_code(), 1);
        assert_eq!(Error::input("--step", "0", "must be positive", "give --step 0.01").exit_code(), 2);
    }
}
