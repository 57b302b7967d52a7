//! The committed results of one experiment: tables, and what is made of them for documents.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use polhode_files::error::Error;
use polhode_files::read_own;
use polhode_pages::output::MARK;
use polhode_pages::table::{Selection, ShownColumn, Table};
use serde::Deserialize;

use crate::experiments::Which;

/// What is made of the costs that the experiment `COSTED` measured.
const COSTED: &str = "work-precision";
const WHICH: &str = "which";
const CLAIM: &str = "claim";
const SPANS: &str = "spans";
const CURVES: &str = "curves";
pub(super) const NAMES: &str = "names have small letters, digits and hyphens";
pub(super) const REMEDY: &str =
    "run `polhode experiment run all --scale paper`, then `polhode experiment publish --from results/paper`";

/// What is read of a `run.toml`.
#[derive(Deserialize)]
pub(super) struct Origin {
    pub(super) experiment: String,
    pub(super) scale: String,
    commit: String,
    changed: String,
    #[serde(default)]
    tables: BTreeMap<String, Described>,
    #[serde(default)]
    views: BTreeMap<String, Selection>,
}

#[derive(Deserialize)]
struct Described {
    #[serde(default)]
    shown: Vec<ShownColumn>,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let changes = if self.changed == "false" { "" } else { " with changes" };
        write!(f, "{}, commit {}{changes}, scale {}", self.experiment, self.commit, self.scale)
    }
}

/// The committed results of one experiment.
pub(super) struct Results {
    pub(super) folder: PathBuf,
    pub(super) origin: Origin,
}

impl Results {
    /// The results in `folder`, which is called as their experiment.
    ///
    /// # Errors
    /// A `run.toml` that cannot be read, or names another experiment.
    pub(super) fn open(folder: PathBuf) -> Result<Self, Error> {
        let path = folder.join(MARK);
        let origin: Origin = toml::from_str(&read_own(&path, REMEDY)?)
            .map_err(|error| Error::Input(format!("{}: {error}", path.display())))?;
        let name = &origin.experiment;
        if !is_name(name) || !folder.ends_with(name) {
            let rule = if is_name(name) { "is not the name of its folder" } else { NAMES };
            return Err(Error::input(&format!("{}: experiment", path.display()), name, rule, REMEDY));
        }
        Ok(Self { folder, origin })
    }

    /// A table for programs, as it is committed or made of one.
    pub(super) fn csv(&self, table: &str) -> Result<String, Error> {
        if self.origin.experiment == COSTED && table == CURVES {
            return Ok(self.which()?.curves().csv());
        }
        read_own(&within(&self.folder, self.folder.join(format!("{table}.csv")))?, REMEDY)
    }

    /// The quickest methods, of the costs of `work-precision`.
    pub(super) fn which(&self) -> Result<Which, Error> {
        Which::of(&self.csv("costs")?).map_err(|reason| {
            Error::Input(format!("{}/costs.csv: {reason}; {REMEDY}", self.folder.display()))
        })
    }

    /// Whether `name` is the claim about the costs of `work-precision`.
    pub(super) fn is_claim(&self, name: &str) -> bool {
        self.origin.experiment == COSTED && name == CLAIM
    }

    /// The table or view of that name, to be rounded.
    pub(super) fn table(&self, name: &str) -> Result<Table, Error> {
        match (self.origin.experiment.as_str(), name) {
            (COSTED, WHICH) => return Ok(self.which()?.table()),
            (COSTED, SPANS) => return Ok(self.which()?.spans()),
            _ => {}
        }
        let part = self.origin.views.get(name);
        let whole = part.map_or(name, |part| &part.table);
        let described = self.origin.tables.get(&format!("{whole}.csv"));
        let Some(described) = described.filter(|found| is_name(whole) && !found.shown.is_empty()) else {
            let place = self.folder.join(MARK).display().to_string();
            return Err(Error::input(&place, name, "is no table that it describes for readers", REMEDY));
        };
        let table = Table::from_csv(whole, &self.csv(whole)?, &described.shown).map_err(|reason| {
            Error::Input(format!("{}/{whole}.csv: {reason}; {REMEDY}", self.folder.display()))
        })?;
        Ok(part.map_or_else(|| table.clone(), |part| part.of(&table)))
    }
}

/// Whether `name` can be that of an experiment or a table: it leads to no other folder.
pub(super) fn is_name(name: &str) -> bool {
    !name.is_empty() && name.bytes().all(|b| matches!(b, b'a'..=b'z' | b'0'..=b'9' | b'-'))
}

/// `path`, if no link leads out of `root`.
pub(super) fn within(root: &Path, path: PathBuf) -> Result<PathBuf, Error> {
    let leads_out = match (root.canonicalize(), path.canonicalize()) {
        (Ok(root), Ok(end)) => !end.starts_with(root),
        // what is not there yet is made here, unless a link says where
        _ => path.is_symlink(),
    };
    if leads_out {
        let value = path.display().to_string();
        let remedy = "put a file or folder in its place";
        return Err(Error::input("--root", &value, "is a link that leads out of it", remedy));
    }
    Ok(path)
}
