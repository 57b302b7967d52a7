//! Tables, figures and documents, written whole or not at all.

#![allow(missing_docs)]

pub mod document;
pub mod figure;
pub mod output;
pub mod table;
