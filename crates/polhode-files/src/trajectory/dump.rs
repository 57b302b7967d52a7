//! Dump files of LAMMPS: blocks of rows, each with a time step and, where it was asked for, a time.

use super::Found;
use super::layout::{ColumnNames, Layout};
use super::lines::{Delimiter, Lines};
use super::rows::Rows;
use crate::error::Error;

/// What a block says before its rows.
#[derive(Default)]
struct Head {
    step: Option<f64>,
    time: Option<f64>,
    atoms: Option<u64>,
}

/// The rows of a dump, whose first line stands in `lines`; `unit` is the length of a time step, s, if it was given.
pub(super) fn read(mut lines: Lines, flags: &ColumnNames, unit: Option<f64>) -> Result<Found, Error> {
    let mut rows: Option<Rows> = None;
    let mut head = Head::default();
    let mut counts_steps = false;
    let mut item = lines_item(&mut lines, true)?;
    while let Some(found) = item {
        match found.as_str() {
            "TIMESTEP" => head = Head { step: Some(one_number(&mut lines)?), ..Head::default() },
            "TIME" => head.time = Some(one_number(&mut lines)?),
            "NUMBER OF ATOMS" => head.atoms = Some(one_number(&mut lines)? as u64),
            text if text.starts_with("ATOMS") => {
                let names = named(text.split_whitespace().skip(1));
                let (time, by_step) = match (head.time, head.step) {
                    (Some(time), _) => (time, false),
                    (None, Some(step)) => (step * unit.unwrap_or(1.0), true),
                    (None, None) => {
                        return Err(lines.refused(
                            "",
                            "a block of atoms without a time step",
                            "dump it with ITEM: TIMESTEP",
                        ));
                    }
                };
                counts_steps |= by_step && unit.is_none();
                let Some(atoms) = head.atoms else {
                    return Err(lines.refused(
                        "",
                        "a block of atoms without their number",
                        "dump it with ITEM: NUMBER OF ATOMS",
                    ));
                };
                let known = match rows.take() {
                    Some(rows) if rows.names() == names => rows,
                    Some(_) => {
                        return Err(lines.refused(
                            "",
                            "other columns than in the block before",
                            "dump one set of columns",
                        ));
                    }
                    None => {
                        let layout = Layout::of(&names, flags, true)
                            .map_err(|(rule, remedy)| lines.refused("", &rule, &remedy))?;
                        Rows::new(layout, names, 1.0)
                    }
                };
                let rows = rows.insert(known);
                for _ in 0..atoms {
                    if lines.next()?.is_none() {
                        let rule = format!("the file ends within a block of {atoms} atoms");
                        return Err(lines.refused("", &rule, "leave the block out, or complete it"));
                    }
                    lines.split(Delimiter::Blanks);
                    rows.push(&lines, Some(time))?;
                }
            }
            // bounds of the box, units: of no interest here
            _ => {}
        }
        item = lines_item(&mut lines, false)?;
    }
    let Some(rows) = rows else {
        return Err(lines.refused("", "no block ITEM: ATOMS", "dump id, the quaternion and angmom or omega"));
    };
    let (bodies, layout) = rows.finish();
    Ok(Found { bodies, claims: layout.claims, counts_steps, comments: Vec::new() })
}

/// The next line that begins with `ITEM:`, without that; `here`: the present one.
fn lines_item(lines: &mut Lines, here: bool) -> Result<Option<String>, Error> {
    if here {
        return Ok(Some("TIMESTEP".into()));
    }
    loop {
        match lines.next()? {
            None => return Ok(None),
            Some(line) => {
                if let Some(item) = line.strip_prefix("ITEM:") {
                    return Ok(Some(item.trim().to_string()));
                }
            }
        }
    }
}

fn one_number(lines: &mut Lines) -> Result<f64, Error> {
    let text = lines.next()?.unwrap_or("").to_string();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(lines.refused(&text, "is not a number", "dump the file again")),
    }
}

/// Names of columns without the marks of computes, fixes and variables; four components of one compute are a quaternion.
fn named<'a>(columns: impl Iterator<Item = &'a str>) -> Vec<String> {
    let columns: Vec<&str> = columns.collect();
    let part = |name: &'a str| -> Option<(&'a str, &'a str)> {
        let (stem, number) = name.strip_suffix(']')?.rsplit_once('[')?;
        Some((stem, number))
    };
    let size =
        |stem: &str| columns.iter().filter(|name| part(name).is_some_and(|(other, _)| other == stem)).count();
    let plain = |name: &str| {
        let stripped = ["c_", "f_", "v_"].iter().find_map(|mark| name.strip_prefix(mark));
        stripped.unwrap_or(name).to_string()
    };
    columns
        .iter()
        .map(|name| match part(name) {
            Some((stem, number)) if size(stem) == 4 => {
                let letter = match number {
                    "1" => "w",
                    "2" => "x",
                    "3" => "y",
                    _ => "z",
                };
                format!("q_{letter}")
            }
            _ => plain(name),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::named;

    #[test]
    fn four_components_of_a_compute_are_a_quaternion() {
        let header = "id type c_orient[1] c_orient[2] c_orient[3] c_orient[4] angmomx c_omega[1] v_k";
        let names = named(header.split_whitespace());
        assert_eq!(names, ["id", "type", "q_w", "q_x", "q_y", "q_z", "angmomx", "omega[1]", "k"]);
    }
}
