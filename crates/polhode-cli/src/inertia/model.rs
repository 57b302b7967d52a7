//! A robot model as it was examined.

use polhode_files::examined::Examined;

/// A model with the text that its links were read from.
pub(super) struct Model {
    pub(super) path: String,
    pub(super) text: String,
    pub(super) links: Vec<Examined>,
}
