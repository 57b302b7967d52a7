//! Where results come from: `run.toml` beside them.

use std::collections::BTreeMap;
use std::path::Path;

use polhode_files::read_own;
use polhode_pages::output::MARK;
use polhode_pages::table::{Selection, ShownColumn, Table};
use serde::{Deserialize, Serialize};

use crate::build;
use crate::experiment::{Report, Scale};

#[derive(Serialize)]
struct Provenance<'a> {
    experiment: &'a str,
    scale: String,
    version: &'static str,
    commit: &'static str,
    /// Whether sources differ from the commit.
    changed: &'static str,
    rustc: &'static str,
    profile: &'static str,
    target: &'static str,
    cpu_features: Vec<&'static str>,
    /// Cores that the run could use.
    cores: usize,
    /// Wall time of the run; like the cores, for readers only: nothing that is published or compared depends on it.
    seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    seed: Option<u64>,
    /// Claims that the run contradicts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    failures: Vec<String>,
    /// Files of times, which are this machine's.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    timing: Vec<String>,
    tables: BTreeMap<String, Columns<'a>>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    views: BTreeMap<&'a str, &'a Selection>,
}

#[derive(Serialize)]
struct Columns<'a> {
    caption: String,
    /// Name to meaning, with the unit in brackets.
    columns: BTreeMap<&'a str, String>,
    /// How the rows are rounded for readers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    shown: Vec<ShownColumn>,
}

/// The contents of `run.toml`.
pub(super) fn describe<'a>(experiment: &'a str, scale: Scale, report: &'a Report) -> String {
    let meaning = |unit: &str, meaning: &str| {
        if unit.is_empty() { meaning.into() } else { format!("{meaning} [{unit}]") }
    };
    let described = |table: &'a Table, shown| {
        let columns = table.columns.iter().map(|c| (&*c.name, meaning(&c.unit, c.meaning))).collect();
        (format!("{}.csv", table.name), Columns { caption: table.caption.clone(), columns, shown })
    };
    let rounded = report.tables.iter().map(|table| described(table, table.layout()));
    let others = report
        .data
        .iter()
        .chain(&report.timing)
        .chain(&report.times)
        .map(|table| described(table, Vec::new()));
    let views = report.views.iter().filter_map(|view| Some((view.name.as_str(), view.part.as_ref()?)));
    let provenance = Provenance {
        experiment,
        scale: scale.to_string(),
        version: env!("CARGO_PKG_VERSION"),
        commit: build::COMMIT,
        changed: build::CHANGED,
        rustc: build::RUSTC,
        profile: build::PROFILE,
        target: build::TARGET,
        cpu_features: cpu_features(),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        seconds: (report.took.as_secs_f64() * 10.0).round() / 10.0,
        seed: report.seed,
        failures: report.failures.clone(),
        timing: report
            .timing
            .iter()
            .chain(&report.times)
            .map(|table| format!("{}.csv", table.name))
            .collect(),
        tables: rounded.chain(others).collect(),
        views: views.collect(),
    };
    toml::to_string(&provenance).unwrap_or_default()
}

/// What is told of a run that this very program has finished.
#[derive(Deserialize)]
pub(super) struct Finished {
    scale: String,
    version: String,
    commit: String,
    changed: String,
    profile: String,
    target: String,
    /// Claims that it contradicts.
    #[serde(default)]
    pub(super) failures: Vec<String>,
    /// Files of times.
    #[serde(default)]
    pub(super) timing: Vec<String>,
}

impl Finished {
    /// Of the results in `folder`; `None` where another commit, changed sources or another scale made them.
    pub(super) fn of(folder: &Path, scale: Scale) -> Option<Self> {
        let text = read_own(&folder.join(MARK), "").ok()?;
        let found: Self = toml::from_str(&text).ok()?;
        let is_same = found.scale == scale.to_string()
            && (&*found.version, &*found.commit) == (env!("CARGO_PKG_VERSION"), build::COMMIT)
            && (&*found.profile, &*found.target) == (build::PROFILE, build::TARGET);
        (is_same && found.changed == "false" && build::CHANGED == "false").then_some(found)
    }
}

#[cfg(target_arch = "x86_64")]
fn cpu_features() -> Vec<&'static str> {
    [
        ("avx", std::is_x86_feature_detected!("avx")),
        ("avx2", std::is_x86_feature_detected!("avx2")),
        ("fma", std::is_x86_feature_detected!("fma")),
        ("avx512f", std::is_x86_feature_detected!("avx512f")),
    ]
    .into_iter()
    .filter_map(|(name, there)| there.then_some(name))
    .collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn cpu_features() -> Vec<&'static str> {
    Vec::new()
}
