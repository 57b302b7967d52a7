//! A table of the members of an ensemble: inertia, attitude and angular velocity, a member a row.

use std::path::Path;

use crate::error::{Error, Rule};
use crate::numbers::number;
use crate::table::{Delimiter, Lines, plain, width_rule};

/// Columns by what they are together; each group is stated in whole or not at all.
const GROUPS: [(&str, &[&str]); 4] = [
    ("moments", &["i1", "i2", "i3"]),
    ("tensor", &["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]),
    ("attitude", &["q_w", "q_x", "q_y", "q_z"]),
    ("angular velocity", &["omega_x", "omega_y", "omega_z"]),
];
/// Columns that say nothing of the motion.
const NAMES: [&str; 2] = ["name", "id"];

/// Places of the groups among the numbers of a row, in this order.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct Columns {
    /// Principal moments, kg m².
    pub moments: Option<usize>,
    /// Ixx, Iyy, Izz, Ixy, Ixz, Iyz, kg m².
    pub tensor: Option<usize>,
    /// Quaternion w, x, y, z, body → space.
    pub attitude: Option<usize>,
    /// Angular velocity in body axes, in the unit of its reader.
    pub omega: Option<usize>,
    /// Numbers of a row.
    pub width: usize,
}

/// Reads a table of members: `header` looks at its columns, `row` at the numbers of each row.
///
/// # Errors
/// A file that cannot be read; columns that are unknown, incomplete or named twice; rows that are none; what `header` (a rule and
/// what to do) and `row` refuse. Each with file and line.
///
/// ```
/// use polhode_files::members;
/// # let folder = std::env::temp_dir().join(format!("polhode-members-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// let path = folder.join("members.csv");
/// std::fs::write(&path, "name,i1,i2,i3\nbrick,1,2,2.5\nplate,1,1,2\n")?;
/// let mut moments = Vec::new();
/// let columns = members::read(&path, |_| Ok(()), |_, numbers| {
///     moments.push(numbers.to_vec());
///     Ok(())
/// })?;
/// assert_eq!((columns.moments, columns.tensor), (Some(0), None));
/// assert_eq!(moments, [[1.0, 2.0, 2.5], [1.0, 1.0, 2.0]]);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(
    path: &Path,
    header: impl FnOnce(&Columns) -> Result<(), (&'static str, &'static str)>,
    mut row: impl FnMut(&Columns, &[f64]) -> Result<(), String>,
) -> Result<Columns, Error> {
    let text = crate::read(path, "name a CSV with a header and a member a row")?;
    let mut lines = Lines::of_text(&text, &path.display().to_string());
    let place = |line: u64| format!("{}:{line}", path.display());
    let mut names: Vec<String> = Vec::new();
    let mut delimiter = Delimiter::Mark(',');
    if lines.advance_to_row()? {
        delimiter = Delimiter::of(&lines.text);
        names = delimiter.names(&lines.text);
    }
    let named_at = lines.number.max(1);
    let (columns, sources) = Columns::of(&names, &lines, &place(named_at))?;
    header(&columns).map_err(|(rule, remedy)| Error::input(&place(named_at), "", rule, remedy))?;
    let (mut cells, mut numbers) = (Vec::new(), Vec::with_capacity(columns.width));
    let mut is_empty = true;
    while lines.advance_to_row()? {
        let (line, before) = (lines.text.trim(), cells.len());
        delimiter.split(line, &mut cells);
        if cells.len() == names.len() + 1
            && cells.last().is_some_and(|cell| line[cell.clone()].trim().is_empty())
        {
            cells.pop();
        }
        let widths = (cells.len(), names.len());
        match width_rule((line, lines.is_ended), delimiter, widths, names.len() - 1, before) {
            Some(Rule::Shorter(cells, columns)) => {
                let rule = format!("{cells} cells, and the header has {columns}; give every row as many");
                return Err(Error::Input(format!("{}: {rule}", place(lines.number))));
            }
            Some(rule) => return Err(lines.refused(rule).into()),
            None => {}
        }
        numbers.clear();
        for &source in &sources {
            let cell = plain(&line[cells[source].clone()]);
            let value = number(&delimiter.number(cell)).map_err(|error| {
                Error::Input(format!("{}: column {}: {error}", place(lines.number), names[source]))
            })?;
            numbers.push(value);
        }
        row(&columns, &numbers).map_err(|error| {
            Error::Input(format!("{}: {error}; mend or remove the row", place(lines.number)))
        })?;
        is_empty = false;
    }
    if is_empty {
        return Err(Error::Input(format!("{}: no rows; give a member a row", place(named_at))));
    }
    Ok(columns)
}

impl Columns {
    /// The groups that a header states, and for each number of a row the column it comes from.
    fn of(header: &[String], lines: &Lines<'_>, place: &str) -> Result<(Self, Vec<usize>), Error> {
        let known = || GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).chain(NAMES);
        // other tables here call it by its full name
        let short = |name: &String| name.replace("omega_body_", "omega_").to_lowercase();
        let names: Vec<String> = header.iter().map(short).collect();
        if let Some(k) = names.iter().position(|name| !known().any(|known| known == name)) {
            return Err(Error::unknown_name(place, "column", &header[k], known().collect::<Vec<_>>()));
        }
        let same = |k: usize| Some((names[..k].iter().position(|name| *name == names[k])? + 1, k + 1));
        if let Some((first, second)) = (0..names.len()).find_map(same) {
            return Err(lines.refused(Rule::Unique(first, second)).with_remedy("rename one").into());
        }
        let mut places = [None; 4];
        let mut sources: Vec<usize> = Vec::new();
        for ((what, group), start) in GROUPS.iter().zip(&mut places) {
            let found: Vec<Option<usize>> =
                group.iter().map(|wanted| names.iter().position(|name| name == wanted)).collect();
            if found.iter().all(Option::is_none) {
                continue;
            }
            *start = Some(sources.len());
            for (column, wanted) in found.into_iter().zip(*group) {
                let rule = format!("missing beside the other columns of the {what}");
                sources.push(column.ok_or_else(|| Error::input(place, wanted, &rule, "add the column"))?);
            }
        }
        let [moments, tensor, attitude, omega] = places;
        if moments.is_some() && tensor.is_some() {
            let rule = "moments and a tensor are given";
            return Err(Error::input(place, "", rule, "leave one of them out"));
        }
        let width = sources.len();
        Ok((Self { moments, tensor, attitude, omega, width }, sources))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows of a text, or its refusal behind the name of the file.
    fn rows(text: &str) -> Result<Vec<Vec<f64>>, String> {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("members.csv");
        std::fs::write(&path, text).unwrap();
        let mut rows = Vec::new();
        let keep = |_: &Columns, numbers: &[f64]| {
            rows.push(numbers.to_vec());
            Ok(())
        };
        let found = read(&path, |_| Ok(()), keep);
        found.map_err(|error| error.to_string().rsplit("members.csv").next().unwrap().to_string())?;
        Ok(rows)
    }

    #[test]
    fn any_delimiter_order_and_comment_is_read() {
        let expected = vec![vec![1.0, 2.0, 2.5], vec![1.0, 1.0, 2.0]];
        for text in [
            "i1,i2,i3\n1,2,2.5\n1,1,2\n",
            "# made by hand\nI3;name;I1;I2\n2,5;\"a\";1;2\n\n2;b;1;1\n",
            "id i1 i2 i3\n0 1 2 2.5\n1 1 1 2",
        ] {
            assert_eq!(rows(text).as_ref(), Ok(&expected), "{text}");
        }
    }

    #[test]
    fn broken_tables_are_refused_in_the_words_of_every_table() {
        for (text, told) in [
            ("i1,i2,I2,i3\n1,2,2,2.5\n", ", line 1: columns 2 and 3 both have this name; rename one"),
            ("i1,i2,i3\n1;2;2.5\n", ", line 2: cells separated by semicolons where the header has commas"),
            ("i1,i2,i3\n1,2,2.5,7\n", ", line 2: 4 cells where the header has 3"),
            ("i1,i2,i3\n1,2,2.5\n1,2", ", line 3: the file ends in the middle of this row"),
            ("i1,i2,i3\n", ":1: no rows; give a member a row"),
        ] {
            let error = rows(text).unwrap_err();
            assert!(error.starts_with(told), "{text}: {error}");
        }
    }
}
