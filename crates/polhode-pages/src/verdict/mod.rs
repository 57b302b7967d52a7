//! The verdict of an audit in words, as rows and JSON, as a figure and as a page.

mod advice;
mod figure;
mod json;
mod outcome;
mod page;
mod text;

pub use advice::Adviser;
pub use figure::panels;
pub use json::{object, text as json};
pub use outcome::{Difference, Outcome};
pub use page::page;
pub use text::{rows, text};

/// Readings of the ranking that are shown.
const RANKED: usize = 5;
