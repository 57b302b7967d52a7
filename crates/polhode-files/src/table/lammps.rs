//! Dumps of LAMMPS as rows: blocks of atoms or of local entries, each with a time step and, where it was asked for, a time.

use polhode::units::TimeUnit;

use super::lines::{Line, Lines};
use crate::error::{Rule, TableError};

/// Styles of units, and the unit of time of each; `lj` is without dimension.
const STYLES: [(&str, Option<TimeUnit>); 8] = [
    ("lj", None),
    ("real", Some(TimeUnit::Multiple(1e-15))),
    ("metal", Some(TimeUnit::Multiple(1e-12))),
    ("si", Some(TimeUnit::Seconds)),
    ("cgs", Some(TimeUnit::Seconds)),
    ("electron", Some(TimeUnit::Multiple(1e-15))),
    ("micro", Some(TimeUnit::Microseconds)),
    ("nano", Some(TimeUnit::Nanoseconds)),
];
const STYLE_NAMES: &str = "lj, real, metal, si, cgs, electron, micro, nano";

/// Blocks of a dump; each atom or entry is a row, with the time of its block in front.
pub(crate) struct Dump<'t> {
    pub(crate) lines: Lines<'t>,
    /// The item that was read last.
    item: Option<String>,
    /// The unit of time, where the dump names its units.
    pub(crate) unit: Option<TimeUnit>,
    /// What the block says before its rows.
    step: Option<String>,
    time: Option<String>,
    rows: Option<u64>,
    /// Rows of the block that are left, and of how many.
    left: (u64, u64),
    /// Whether the present line is of the rows of a block.
    is_in_rows: bool,
    /// The time of the block.
    now: String,
    /// The columns of the first block.
    names: Option<String>,
}

impl<'t> Dump<'t> {
    /// Of lines whose first, `item`, was read.
    pub(crate) fn new(lines: Lines<'t>, item: &str) -> Self {
        let item = item.strip_prefix("ITEM:").map(|item| item.trim().to_string());
        Self {
            lines,
            item,
            unit: None,
            step: None,
            time: None,
            rows: None,
            left: (0, 0),
            is_in_rows: false,
            now: String::new(),
            names: None,
        }
    }

    /// The unit of the times in front of the rows, where the dump names its units and has times.
    pub(crate) fn time_unit(&self) -> Option<TimeUnit> {
        self.unit.filter(|_| self.names.as_ref().is_some_and(|names| names.starts_with("t ")))
    }

    /// Reads the header, then a row for each atom or entry.
    pub(crate) fn advance(&mut self, line: &mut Line) -> Result<bool, TableError> {
        while self.left.0 == 0 {
            let Some(item) = self.item.take() else {
                if !self.lines.advance()? {
                    return if self.names.is_some() {
                        Ok(false)
                    } else {
                        Err(self.lines.refused(Rule::Rows))
                    };
                }
                let text = self.lines.text.trim();
                self.item = text.strip_prefix("ITEM:").map(|item| item.trim().to_string());
                if self.is_in_rows && self.item.is_none() && !text.is_empty() {
                    let rule = format!("one row more than the {} that the block announces", self.left.1);
                    return Err(self
                        .lines
                        .refused(Rule::Other(rule))
                        .with_remedy("correct ITEM: NUMBER OF ATOMS, or leave the row out"));
                }
                self.is_in_rows &= self.item.is_none();
                continue;
            };
            match item.as_str() {
                "UNITS" => {
                    self.lines.advance()?;
                    let text = self.lines.text.trim();
                    let Some((_, unit)) = STYLES.iter().find(|(style, _)| *style == text) else {
                        let refused = self.lines.refused(Rule::KnownUnit(STYLE_NAMES)).value(text);
                        return Err(refused.with_remedy("write the `units` style of the LAMMPS run"));
                    };
                    self.unit = *unit;
                }
                "TIMESTEP" => self.step = Some(self.number()?),
                "TIME" => self.time = Some(self.number()?),
                "NUMBER OF ATOMS" | "NUMBER OF ENTRIES" => self.rows = self.number()?.parse().ok(),
                // others, as the bounds of the box, are of no interest here
                text => {
                    let is_block = text.starts_with("ATOMS") || text.starts_with("ENTRIES");
                    if is_block && self.begin(text, line)? {
                        return Ok(true);
                    }
                }
            }
        }
        if !self.lines.advance()? {
            let rule = format!("the file ends within a block of {} rows", self.left.1);
            return Err(self
                .lines
                .refused(Rule::Other(rule))
                .with_remedy("leave the block out, or complete it"));
        }
        self.left.0 -= 1;
        line.text = format!("{} {}", self.now, self.lines.text.trim());
        (line.number, line.is_ended) = (self.lines.number, self.lines.is_ended);
        Ok(true)
    }

    /// Begins a block of rows. Whether it is the first, whose columns are the header, in `line`.
    fn begin(&mut self, item: &str, line: &mut Line) -> Result<bool, TableError> {
        let other =
            |rule: &str, remedy: &str| Err(self.lines.refused(Rule::Other(rule.into())).with_remedy(remedy));
        let Some(rows) = self.rows.take() else {
            return other(
                "a block of rows without their number",
                "dump it with ITEM: NUMBER OF ATOMS or ENTRIES",
            );
        };
        let (time, name) = match (self.time.take(), self.step.take()) {
            (Some(time), _) => (time, "t"),
            (None, Some(step)) => (step, "timestep"),
            (None, None) => {
                return other("a block of rows without a time step", "dump it with ITEM: TIMESTEP");
            }
        };
        let names: Vec<&str> = item.split_whitespace().skip(1).collect();
        let names = format!("{name} {}", names.join(" "));
        (self.now, self.left, self.is_in_rows) = (time, (rows, rows), true);
        match &self.names {
            None => {
                line.text.clone_from(&names);
                (line.number, line.is_ended, self.names) = (self.lines.number, true, Some(names));
                Ok(true)
            }
            Some(before) if *before != names => {
                other("other columns than in the block before", "dump one set of columns")
            }
            Some(_) => Ok(false),
        }
    }

    /// The number on the next line.
    fn number(&mut self) -> Result<String, TableError> {
        self.lines.advance()?;
        let text = self.lines.text.trim();
        if text.parse::<f64>().is_ok_and(f64::is_finite) {
            return Ok(text.into());
        }
        Err(self.lines.refused(Rule::Number).value(text).with_remedy("dump the file again"))
    }
}

/// Names of columns without the marks of computes, fixes and variables; four components of one compute are a quaternion, scalar
/// first but for `orient`, which the documentation of OVITO has scalar last: its order is open.
pub(crate) fn spelled(columns: &[String]) -> Vec<String> {
    fn part(name: &str) -> Option<(&str, &str)> {
        name.strip_suffix(']')?.rsplit_once('[')
    }
    let size =
        |stem: &str| columns.iter().filter(|name| part(name).is_some_and(|(other, _)| other == stem)).count();
    let plain = |name: &str| {
        let stripped = ["c_", "f_", "v_"].iter().find_map(|mark| name.strip_prefix(mark));
        stripped.unwrap_or(name).to_string()
    };
    let name = |name: &String| match part(name) {
        Some(("c_orient", number)) if size("c_orient") == 4 => format!("q_{number}"),
        Some((stem, number)) if size(stem) == 4 => {
            let letters = ["w", "x", "y", "z"];
            let letter = number.parse::<usize>().ok().and_then(|n| letters.get(n.checked_sub(1)?));
            letter.map_or_else(|| plain(name), |letter| format!("q_{letter}"))
        }
        _ => plain(name),
    };
    columns.iter().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::spelled;

    #[test]
    fn four_components_of_a_compute_are_a_quaternion() {
        let header = "id type c_quat[1] c_quat[2] c_quat[3] c_quat[4] angmomx c_omega[1] v_k";
        let of = |header: &str| spelled(&header.split_whitespace().map(String::from).collect::<Vec<_>>());
        assert_eq!(of(header), ["id", "type", "q_w", "q_x", "q_y", "q_z", "angmomx", "omega[1]", "k"]);
        let names = of(&header.replace("c_quat", "c_orient"));
        assert_eq!(names[2..6], ["q_1", "q_2", "q_3", "q_4"]);
    }
}
