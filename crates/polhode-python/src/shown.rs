//! How results print.

use polhode_files::text::escaped_html;
use polhode_pages::table::Table;

/// Rows that are printed of a long table.
const MOST: usize = 12;

/// The rows of `all` that are printed: all, or the first and the last.
pub(crate) fn places(all: usize) -> impl Iterator<Item = usize> {
    let head = if all <= MOST { all } else { MOST / 2 };
    (0..head).chain(if all <= MOST { 0..0 } else { all - MOST / 2..all })
}

/// A table of which [`places`] are shown of `all` rows.
pub(crate) fn text(table: &Table, all: usize) -> String {
    let mut text = table.terminal();
    if all > MOST {
        text += &format!("({all} rows, of which the first and the last are shown)\n");
    }
    text.trim_end().into()
}

/// Words and a picture for a notebook.
pub(crate) fn page(words: &str, svg: &str) -> String {
    format!("<pre>{}</pre>{svg}", escaped_html(words))
}
