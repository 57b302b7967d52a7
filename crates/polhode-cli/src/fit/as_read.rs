//! How the files of a fit were read: units, samples a second, and the hand of the axes.

use polhode_files::ReadAs;
use serde_json::{Value, json};

use super::report::four_digits;

/// The files of a fit, each as it was read.
#[derive(Clone, Debug, Default)]
pub(super) struct AsRead(pub(super) Vec<ReadAs>);

impl AsRead {
    /// A sentence for all files that were read alike, without its full stop.
    pub(super) fn sentences(&self) -> Vec<String> {
        let mut groups: Vec<(String, Vec<&ReadAs>)> = Vec::new();
        for file in &self.0 {
            let units = file.units();
            match groups.iter_mut().find(|(of, _)| *of == units) {
                Some((_, alike)) => alike.push(file),
                None => groups.push((units, vec![file])),
            }
        }
        let is_one = groups.len() == 1;
        let sentence = |(units, files): (String, Vec<&ReadAs>)| {
            let names: Vec<&str> = files.iter().map(|file| file.file.as_str()).collect();
            let named = if is_one { "read".into() } else { names.join(", ") };
            format!("{named}: {units}{}{}", sample_rates(&files), hand(&files))
        };
        groups.into_iter().map(sentence).collect()
    }

    pub(super) fn json(&self) -> Value {
        let file = |of: &ReadAs| {
            json!({
                "file": of.file,
                "rate_unit": of.rates.map(|(unit, _)| unit.to_string()),
                "rate_unit_by": of.rates.map(|(_, by)| by.name()),
                "time_unit": of.times.0,
                "time_unit_by": of.times.1.name(),
                "sample_rate": of.sample_rate,
                "axes": of.axes.map(|axes| axes.to_string()),
                "taken_as_right_handed": of.rates.is_some(),
            })
        };
        self.0.iter().map(file).collect()
    }
}

/// Rates along left-handed axes fit another tensor as well; attitudes alone have no hand.
fn hand(files: &[&ReadAs]) -> String {
    let with_rates = files.iter().find(|file| file.rates.is_some());
    match with_rates.map(|file| file.axes) {
        None => String::new(),
        Some(None) => "; axes taken as right-handed".into(),
        Some(Some(axes)) => format!("; axes {axes} of the columns (--axes), taken as right-handed"),
    }
}

/// The lowest and the highest of some files.
fn sample_rates(files: &[&ReadAs]) -> String {
    let rates = || files.iter().filter_map(|file| file.sample_rate);
    let (low, high) = (rates().fold(f64::INFINITY, f64::min), rates().fold(0.0, f64::max));
    let shown = |rate: f64| four_digits(rate).to_string();
    match (shown(low), shown(high)) {
        _ if high == 0.0 => String::new(),
        (low, high) if low == high => format!(", {high} Hz"),
        (low, high) => format!(", {low} to {high} Hz"),
    }
}
