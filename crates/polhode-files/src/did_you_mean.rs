//! Suggestions for names that are misspelt: "did you mean 'rattle'?".

use crate::error::Error;

impl Error {
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
}
