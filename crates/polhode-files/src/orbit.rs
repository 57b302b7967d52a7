//! A table of an orbit: where a body is at which time.

use std::path::Path;

use polhode::units::TimeUnit;

use crate::error::Error;
use crate::instant::duration;
use crate::numbers::number;
use crate::table::{Delimiter, Lines, Name, plain};
use crate::text::visible;

/// Names of the columns.
const NAMES: [&str; 4] = ["t", "x", "y", "z"];

/// Times, s, and places of a table with the columns t, x, y and z; a time may have a unit, as 12h, or all of them one in the header, as t (h).
///
/// # Errors
/// A file that cannot be read, a column that is missing or named twice, cells that are no numbers; with file, line and column.
///
/// ```
/// # let folder = std::env::temp_dir().join(format!("polhode-orbit-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// let path = folder.join("orbit.csv");
/// std::fs::write(&path, "t,x,y,z\n0,7e6,0,0\n1min,6.99e6,4.5e5,0\n")?;
/// let (times, places) = polhode_files::orbit::read(&path)?;
/// assert_eq!((times, places[1]), (vec![0.0, 60.0], [6.99e6, 4.5e5, 0.0]));
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(path: &Path) -> Result<(Vec<f64>, Vec<[f64; 3]>), Error> {
    let text = crate::read(path, "name a CSV with the columns t, x, y, z")?;
    let mut lines = Lines::of_text(&text, &path.display().to_string());
    let place = |line: u64| format!("{}:{line}", path.display());
    let (mut times, mut places) = (Vec::new(), Vec::new());
    let mut header: Option<(Delimiter, [usize; 4], usize)> = None;
    // of times that name none
    let mut unit = None;
    while lines.advance_to_row()? {
        let line = lines.text.trim();
        let Some((delimiter, columns, width)) = header else {
            let delimiter = Delimiter::of(line);
            let names = delimiter.names(line);
            let mut found = [0; 4];
            for (column, wanted) in found.iter_mut().zip(NAMES) {
                let mut named = names.iter().enumerate().filter(|(_, name)| Name::of(name).letters == wanted);
                let (Some((at, _)), None) = (named.next(), named.next()) else {
                    let rule = format!("no single column {wanted}; the columns are t, x, y, z");
                    return Err(Error::Input(format!("{}: {rule}", place(lines.number))));
                };
                *column = at;
                let stated = Name::of(&names[at]).unit;
                let known = if wanted == "t" { "s, ms, us, ns, min, h, d" } else { "m" };
                match stated.as_deref() {
                    None => {}
                    Some(text) if wanted == "t" && TimeUnit::named(text).is_some() => {
                        unit = TimeUnit::named(text)
                    }
                    Some("m") if wanted != "t" => {}
                    Some(text) => {
                        let rule = format!("column {wanted} is in '{}'; write it in {known}", visible(text));
                        return Err(Error::Input(format!("{}: {rule}", place(lines.number))));
                    }
                }
            }
            header = Some((delimiter, found, names.len()));
            continue;
        };
        let cells = delimiter.names(line);
        if cells.len() != width {
            let rule = format!("{} cells, and the header has {width}; give every row as many", cells.len());
            return Err(Error::Input(format!("{}: {rule}", place(lines.number))));
        }
        let cell = |k: usize| delimiter.number(plain(&cells[columns[k]])).into_owned();
        let refused = |k: usize, error: String| {
            Error::Input(format!("{}: column {}: {error}", place(lines.number), NAMES[k]))
        };
        let time = cell(0);
        times.push(match (unit, time.parse::<f64>()) {
            (Some(unit), Ok(value)) if value.is_finite() => unit.seconds(value),
            _ => duration(&time).map_err(|error| refused(0, error))?,
        });
        let mut row = [0.0; 3];
        for (k, value) in row.iter_mut().enumerate() {
            *value = number(&cell(k + 1)).map_err(|error| refused(k + 1, error))?;
        }
        places.push(row);
    }
    Ok((times, places))
}
