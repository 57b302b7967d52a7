//! The rows for a terminal, as wide as it is.

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, Width, presets};
use polhode_files::text::visible;

use super::markup::with_unit;
use super::rounded::rounded;
use super::{Cell, Column, Table};
use crate::screen::width;

/// Texts are wrapped rather than let push numbers out of sight.
const TEXT_WIDTH: usize = 36;
/// Blanks around a cell.
const PADDING: usize = 2;

impl Table {
    /// Rounded rows; a table too wide is cut into blocks that each repeat the columns that tell rows apart. A column without a
    /// value in any row is left out.
    pub fn terminal(&self) -> String {
        self.within(width())
    }

    fn within(&self, most: usize) -> String {
        let is_empty =
            |k: usize| !self.rows().is_empty() && self.rows().iter().all(|row| row[k] == Cell::Empty);
        let shown: Vec<_> = self.shown().into_iter().filter(|(k, _)| !is_empty(*k)).collect();
        let width = |(k, column): &(usize, &Column)| self.width(*k, column) + PADDING;
        let of = |columns: &[(usize, &Column)]| columns.iter().map(width).sum::<usize>();
        // half of a line at most, and one column at least
        let fitting = (1..=shown.len()).rev().find(|count| 2 * of(&shown[..*count]) <= most).unwrap_or(1);
        let (keys, others) = shown.split_at(self.keys(&shown).min(fitting).min(shown.len()));
        let mut blocks = vec![keys.to_vec()];
        let mut used = of(keys);
        for column in others {
            if used + width(column) > most && used > of(keys) {
                blocks.push(keys.to_vec());
                used = of(keys);
            }
            used += width(column);
            if let Some(block) = blocks.last_mut() {
                block.push(*column);
            }
        }
        blocks.iter().map(|block| self.block(block, most) + "\n").collect::<Vec<_>>().join("\n")
    }

    /// How many of the first columns it takes to tell all rows apart.
    fn keys(&self, shown: &[(usize, &Column)]) -> usize {
        let tells = |count: &usize| {
            let key =
                |row: &Vec<Cell>| shown[..*count].iter().map(|(k, _)| row[*k].exact()).collect::<Vec<_>>();
            let distinct: std::collections::HashSet<_> = self.rows().iter().map(key).collect();
            distinct.len() == self.rows().len()
        };
        (1..shown.len()).find(tells).unwrap_or(1)
    }

    fn width(&self, k: usize, column: &Column) -> usize {
        let heading = headings(column).split('\n').map(length).max().unwrap_or(0);
        let cells = self.rows().iter().map(|row| length(&text(&row[k], column))).max().unwrap_or(0);
        if self.is_numeric(k) { heading.max(cells) } else { heading.max(cells).min(TEXT_WIDTH) }
    }

    fn block(&self, columns: &[(usize, &Column)], most: usize) -> String {
        let mut table = comfy_table::Table::new();
        table.load_preset(presets::NOTHING);
        table.set_content_arrangement(ContentArrangement::Dynamic).set_width(most as u16);
        table.set_header(columns.iter().map(|(_, column)| headings(column)));
        for row in self.rows() {
            table.add_row(columns.iter().map(|(k, column)| text(&row[*k], column)));
        }
        for (place, (k, column)) in columns.iter().enumerate() {
            let Some(printed) = table.column_mut(place) else { continue };
            printed.set_constraint(ColumnConstraint::Absolute(Width::Fixed(
                (self.width(*k, column) + PADDING) as u16,
            )));
            if self.is_numeric(*k) {
                printed.set_cell_alignment(CellAlignment::Right);
            }
        }
        table.trim_fmt()
    }
}

/// The unit stands below the name.
fn headings(column: &Column) -> String {
    with_unit(column).replacen(" [", "\n[", 1)
}

fn text(cell: &Cell, column: &Column) -> String {
    match cell {
        Cell::Number(x) => rounded(*x, column.digits).plain(),
        other => visible(&other.exact()).into_owned(),
    }
}

fn length(text: &str) -> usize {
    text.chars().count()
}

#[cfg(test)]
mod tests {
    use super::super::{Column, Table, row, tests::example};
    use super::*;
    use crate::screen::WIDTH;

    #[test]
    fn every_line_fits_and_no_number_is_broken() {
        let names = ["alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota"];
        let columns = names.map(|name| Column::new(name, "rad/s", "").digits(6));
        let mut table = Table::new("wide", "", columns.into());
        table.push(names.map(|_| Cell::from(-1.234_567_89e-100)));
        let printed = table.terminal();
        assert!(printed.lines().all(|line| length(line) <= WIDTH), "{printed}");
        assert_eq!(printed.matches("-1.23457e-100").count(), 10, "{printed}"); // the first column twice
    }

    #[test]
    fn a_wide_terminal_is_used_and_empty_columns_are_left_out() {
        let names = ["alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota"];
        let mut table = Table::new("wide", "", names.map(|name| Column::new(name, "", "")).into());
        let mut cells = names.map(|_| Cell::from(-1.25e-100));
        cells[3] = Cell::Empty;
        table.push(cells);
        let printed = table.within(200);
        assert_eq!((printed.lines().count(), printed.matches("-1.25e-100").count()), (2, 8), "{printed}");
        assert!(!printed.contains("delta"), "{printed}");
        assert!(table.within(40).lines().all(|line| length(line) <= 40));
    }

    #[test]
    fn each_block_repeats_the_columns_that_tell_rows_apart() {
        let names = ["method", "h", "alpha", "beta", "gamma"];
        let columns = names.map(|name| Column::new(name, "", "").digits(6));
        let mut table = Table::new("steps", "", columns.into());
        for h in [0.5, 0.25] {
            table.push(row!["rk4", h, -1.234_567_89e-100, -1.234_567_89e-100, -1.234_567_89e-100]);
        }
        let printed = table.within(40);
        assert_eq!((printed.matches("rk4").count(), printed.matches("0.25").count()), (6, 3), "{printed}");
    }

    #[test]
    fn long_texts_wrap() {
        let mut table =
            Table::new("notes", "", vec![Column::new("name", "", ""), Column::new("note", "", "")]);
        table.push(row![
            "rk4",
            "a long remark that has to be wrapped because it will not fit into one line of text"
        ]);
        let printed = table.terminal();
        assert!(printed.lines().all(|line| length(line) <= WIDTH), "{printed}");
        assert!(printed.contains("wrapped"), "{printed}");
    }

    #[test]
    fn numbers_stand_at_the_right() {
        let printed = example().terminal();
        assert!(printed.lines().any(|line| line.ends_with("4.3e-10")), "{printed}");
    }
}
