//! What can go wrong on the command line, and how it is told.

use std::fmt::Write as _;
use std::io::Write as _;

use crate::text::{visible, visible_lines};

/// A message for standard error and the exit code that goes with it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A claim, a fit or a check failed: the input was usable, the answer is no. Exit code 1.
    #[error("{0}")]
    Failed(String),
    /// Input that cannot be used. Exit code 2.
    #[error("{0}")]
    Input(String),
    /// The reader of standard output has seen enough, and the work ends. Exit code 0, and nothing is said.
    #[error("standard output is read no further")]
    Unread,
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

    /// A name that is not among `known`, with the nearest one that is.
    pub fn unknown_name<'a>(
        place: &str,
        kind: &str,
        name: &str,
        known: impl IntoIterator<Item = &'a str> + Clone,
    ) -> Self {
        let remedy = match nearest(name, known.clone()) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("known: {}", known.into_iter().collect::<Vec<_>>().join(", ")),
        };
        Self::input(place, name, &format!("no such {kind}"), &remedy)
    }

    /// The exit code of the process.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Unread => 0,
            Self::Failed(_) => 1,
            Self::Input(_) => 2,
        }
    }
}

/// A remark on standard error; the run goes on.
pub fn warn(message: &str) {
    tell("warning", message);
}

/// A line on standard error. Where nobody listens (`2>&1 | head`), nothing is said.
pub fn tell(kind: &str, message: &str) {
    let _ = writeln!(std::io::stderr(), "{kind}: {}", visible_lines(message));
}

/// The known name with the fewest edits from `name`, if more than half of the letters are right.
fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    known
        .into_iter()
        .map(|candidate| (edits(&name, candidate), candidate))
        .filter(|(edits, candidate)| 2 * edits < name.chars().count().max(candidate.chars().count()))
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance, one row of the table at a time.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edit_distances_of_the_textbook() {
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("sunday", "saturday"), 3);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("abc", "abc"), 0);
    }

    #[test]
    fn nearest_name_or_the_whole_list() {
        let known = ["rk4", "rattle", "lie-poisson"];
        assert_eq!(nearest("ratle", known), Some("rattle"));
        assert_eq!(nearest("Lie-Poison", known), Some("lie-poisson"));
        assert_eq!(nearest("verlet", known), None);
        let message = Error::unknown_name("--method", "method", "verlet", known).to_string();
        assert_eq!(message, "--method: 'verlet': no such method; known: rk4, rattle, lie-poisson");
    }

    #[test]
    fn codes_tell_a_refusal_from_unusable_input() {
        assert_eq!(Error::Failed(String::new()).exit_code(), 1);
        assert_eq!(Error::input("--step", "0", "must be positive", "give --step 0.01").exit_code(), 2);
    }
}
