//! A shard on the disk: arrays, largest errors, failures, and the record that it is whole.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use polhode_files::error::{Error, unexpected};
use polhode_files::npy::Array;
use polhode_files::text::visible;
use polhode_files::{inputs, read, read_own};
use polhode_pages::output::{MARK, Staging};
use polhode_pages::table::{Cell, Column, Table};

use super::checksum::Checksum;
use super::passages::{self, PASSAGES, Passage};
use super::record::{Identity, Record};
use super::shard::Shard;
use super::work::{ATTITUDES, Failure, Largest, OMEGAS, Shares};

/// Folder of the shards in that of the results.
pub(super) const SHARDS: &str = "shards";
pub(super) const ERRORS: &str = "errors";
pub(super) const FAILURES: &str = "failures";

/// A shard that stands whole on the disk.
pub(super) struct Finished {
    pub(super) path: PathBuf,
    pub(super) shard: Shard,
    pub(super) record: Record,
}

/// What stands in the folder of shards, by number; hidden names are shards in the making.
pub(super) fn finished(out: &Path) -> Result<Vec<Finished>, Error> {
    let folder = out.join(SHARDS);
    let mut found = Vec::new();
    for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        if name.to_string_lossy().starts_with('.') {
            continue;
        }
        let path = entry.path();
        let record = record(&path, read)?;
        let shard = record.as_ref().and_then(Record::place);
        let Some((record, shard)) = record.zip(shard) else {
            let rule = format!("is not a shard of an ensemble: it has no {MARK} of one");
            let place = path.display().to_string();
            return Err(Error::input(&out.display().to_string(), &place, &rule, "move it away"));
        };
        found.push(Finished { path, shard, record });
    }
    found.sort_by_key(|found| (found.shard.count, found.shard.number));
    Ok(found)
}

/// The record of results, which the next run writes again.
pub(super) fn record_of_results(folder: &Path) -> Result<Option<Record>, Error> {
    record(folder, read_own)
}

/// Refuses to replace a record that is not of the run `identity`, and with it the results that it belongs to.
pub(super) fn check_replaced(flag: &str, folder: &Path, identity: &Identity) -> Result<(), Error> {
    let rule = match record_of_results(folder)?.filter(Record::is_results) {
        Some(record) => match identity.difference(&record.identity) {
            Some(difference) => format!("holds results of another run: {difference}"),
            None => return Ok(()),
        },
        None if folder.join(MARK).exists() => format!("holds a {MARK} that is not of results of an ensemble"),
        None => return Ok(()),
    };
    Err(replacing(flag, folder, &rule))
}

/// Refuses to replace a folder of results that holds what no run of an ensemble wrote.
pub(super) fn check_alone(folder: &Path) -> Result<(), Error> {
    let Some(record) = record_of_results(folder)? else { return Ok(()) };
    let is_own = |name: &str| name == MARK || record.sha256.contains_key(name);
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
    match names.filter(|name| !is_own(name)).min() {
        Some(name) => {
            let rule = format!("holds '{}', which is not of the results there", visible(&name));
            Err(replacing("--out", folder, &rule))
        }
        None => Ok(()),
    }
}

pub(super) fn replacing(flag: &str, folder: &Path, rule: &str) -> Error {
    let remedy = "move it away, or give --replace, and it is replaced";
    Error::input(flag, &folder.display().to_string(), rule, remedy)
}

/// The record of a folder, if it has one.
fn record(folder: &Path, read: fn(&Path, &str) -> Result<String, Error>) -> Result<Option<Record>, Error> {
    let path = folder.join(MARK);
    if !path.is_file() {
        return Ok(None);
    }
    let text = read(&path, "restore it, or remove the folder and run it again")?;
    Ok(Record::parse(&text).ok())
}

/// Largest errors of each time.
fn errors_table() -> Table {
    let columns = vec![
        Column::new("t", "s", "time"),
        Column::new("energy_error_max", "", "largest relative energy error of the members at this time"),
        Column::new(
            "momentum_vector_error_max",
            "",
            "largest relative error of L in space of the members at this time",
        ),
    ];
    Table::new(ERRORS, "Largest errors at each time.", columns)
}

/// Members that have no rows from some time on.
pub(super) fn failures_table(failures: &[Failure]) -> Table {
    let columns = vec![
        Column::new("member", "", "its number, from 1"),
        Column::new("t", "s", "first time at which it has no row"),
        Column::new("reason", "", "why"),
    ];
    let mut table = Table::new(FAILURES, "Members that have no rows from some time on.", columns);
    for failure in failures {
        table.push([Cell::from(failure.member), Cell::from(failure.t), Cell::from(failure.reason.as_str())]);
    }
    table
}

/// Writes what goes beside the arrays of a shard, with the checksums of all, and puts it in its place.
pub(super) fn commit(staging: Staging, shares: &Shares, mut record: Record) -> Result<(), Error> {
    let mut errors = errors_table();
    for (t, largest) in shares.times.iter().zip(&shares.largest) {
        errors.push([Cell::from(*t), Cell::from(largest.energy), Cell::from(largest.momentum_vector)]);
    }
    let passages = record.identity.event.is_some().then(|| passages::table(&shares.passages));
    let tables = [errors, failures_table(&shares.failures)].into_iter().chain(passages);
    let tables: Vec<_> = tables.map(|table| (format!("{}.csv", table.name), table)).collect();
    for (name, table) in &tables {
        staging.write(name, table.csv().as_bytes())?;
    }
    let arrays = [Some(ATTITUDES), record.identity.omegas.then_some(OMEGAS)].into_iter().flatten();
    record.sha256 = checksums(&staging, tables.iter().map(|(name, _)| name.as_str()).chain(arrays))?;
    staging.write(MARK, record.sealed_text().map_err(unexpected)?.as_bytes())?;
    staging.commit()
}

/// The checksums of files of a folder in the making.
pub(super) fn checksums<'n>(
    staging: &Staging,
    names: impl Iterator<Item = &'n str>,
) -> Result<BTreeMap<String, String>, Error> {
    let sum = |name: &str| Checksum::of(staging.open(name)?).map_err(unexpected);
    names.map(|name| Ok((name.into(), sum(name)?))).collect()
}

impl Finished {
    pub(super) fn members(&self) -> u64 {
        let range = self.shard.range(self.record.identity.members);
        range.end - range.start
    }

    pub(super) fn attitudes(&self) -> Result<Array<4>, Error> {
        self.array(ATTITUDES)
    }

    pub(super) fn omegas(&self) -> Result<Array<3>, Error> {
        self.array(OMEGAS)
    }

    fn array<const N: usize>(&self, name: &str) -> Result<Array<N>, Error> {
        let path = self.path.join(name);
        let opened = inputs::open(&path)
            .and_then(|file| Array::open(file, self.record.identity.times, self.members()));
        opened.map_err(|error| self.damaged(&path, &error))
    }

    /// What is wrong with a file of a shard that says that it is whole.
    pub(super) fn damaged(&self, path: &Path, error: &io::Error) -> Error {
        let remedy = format!("remove {} and run shard {} again", self.path.display(), self.shard);
        Error::Input(format!("{}: {error}; {remedy}", path.display()))
    }

    /// The same of what contradicts the others.
    pub(super) fn wrong(&self, path: &Path, rule: &str) -> Error {
        self.damaged(path, &io::Error::new(io::ErrorKind::InvalidData, rule))
    }

    /// The tables beside the arrays.
    pub(super) fn tables(&self) -> impl Iterator<Item = &'static str> {
        [ERRORS, FAILURES].into_iter().chain(self.record.identity.event.as_ref().map(|_| PASSAGES))
    }

    /// Where its record stands.
    pub(super) fn mark(&self) -> PathBuf {
        self.path.join(MARK)
    }

    /// Largest errors, failures and passages.
    pub(super) fn shares(&self) -> Result<Shares, Error> {
        let rows = |name: &str| -> Result<Vec<csv::StringRecord>, Error> {
            let path = self.path.join(format!("{name}.csv"));
            let damaged = |error: csv::Error| self.damaged(&path, &io::Error::other(error));
            let file = inputs::open(&path).map_err(|error| self.damaged(&path, &error))?;
            csv::Reader::from_reader(file).into_records().collect::<Result<_, _>>().map_err(damaged)
        };
        let wrong = |name: &str| {
            let path = self.path.join(format!("{name}.csv"));
            self.wrong(&path, "its rows are not those of a shard")
        };
        let cell = |text: &str| -> Result<Option<f64>, Error> {
            if text.is_empty() { Ok(None) } else { text.parse().map(Some).map_err(|_| wrong(ERRORS)) }
        };
        let rows_of_errors = rows(ERRORS)?;
        let each = rows_of_errors.iter().map(|row| match [row.get(0), row.get(1), row.get(2)] {
            [Some(t), Some(energy), Some(momentum)] => {
                let largest = Largest { energy: cell(energy)?, momentum_vector: cell(momentum)? };
                Ok((cell(t)?.ok_or_else(|| wrong(ERRORS))?, largest))
            }
            _ => Err(wrong(ERRORS)),
        });
        let (times, largest): (Vec<f64>, Vec<Largest>) = each.collect::<Result<_, Error>>()?;
        if largest.len() as u64 != self.record.identity.times {
            return Err(wrong(ERRORS));
        }
        let failures = rows(FAILURES)?.into_iter().map(|row| {
            let parsed = || {
                let reason = row.get(2)?.to_string();
                Some(Failure { member: row.get(0)?.parse().ok()?, t: row.get(1)?.parse().ok()?, reason })
            };
            parsed().ok_or_else(|| wrong(FAILURES))
        });
        let failures = failures.collect::<Result<_, _>>()?;
        let mut passages: Vec<Passage> = Vec::new();
        if self.record.identity.event.is_some() {
            let each = rows(PASSAGES)?.into_iter();
            let each = each.map(|row| Passage::parsed(&row).ok_or_else(|| wrong(PASSAGES)));
            passages = each.collect::<Result<_, _>>()?;
            let members = self.shard.range(self.record.identity.members);
            if !passages.iter().map(|one| one.member).eq(members.start + 1..=members.end) {
                return Err(wrong(PASSAGES));
            }
        }
        Ok(Shares { times, largest, failures, passages, draws: self.record.draws })
    }
}
