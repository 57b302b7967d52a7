//! Tables, figures, documents, scenes and verdicts, written whole or not at all.
#![doc = include_str!("../README.md")]

pub mod character;
pub mod document;
pub mod figure;
pub mod output;
pub mod scene;
pub mod screen;
pub mod table;
pub mod verdict;
