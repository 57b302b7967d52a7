//! `polhode gather`: the shards of an ensemble, made into the results of one run.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::Args;
use polhode_files::error::{Error, unexpected};
use polhode_files::{inputs, npy};
use polhode_pages::output::{MARK, Output, unwritable};

use super::checksum::Checksum;
use super::folder::{ERRORS, Finished, check_replaced, finished, record_of_results, replacing};
use super::record::{Identity, Record};
use super::reduce::{self, reduce};
use super::results::Results;
use super::verify::{unchanged, verified};
use super::work::{ATTITUDES, Largest, OMEGAS, Shares};
use super::{said, threads_of};
use crate::memory;

const EXAMPLES: &str = "Examples:
  polhode ensemble examples/ensemble.toml --out halves --shard 1/2
  polhode ensemble examples/ensemble.toml --out halves --shard 2/2
  polhode gather halves";

/// Join the shards of an ensemble into the results of one run
///
/// `polhode ensemble --shard K/N` writes its shards to DIR/shards. All shards of one run must be there: with the same specification,
/// seed, version and number of shards, and with unchanged files (the run.toml beside them has each SHA-256). The results in DIR are
/// those of the run without shards, to the last bit, and their run.toml has the SHA-256 of each. The shards can then be removed.
/// Files of another run, or of none, that stand in DIR under these names are replaced only with --replace.
/// Exit code 1: every member failed.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Gather {
    /// Folder that --out of `polhode ensemble` named
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Replace the results of another run in DIR
    #[arg(long)]
    replace: bool,
    /// Threads [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

impl Gather {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let threads = threads_of(self.threads);
        let shards = finished(&self.folder)?;
        let identity = self.check(&shards)?;
        if !self.replace {
            check_replaced("gather", &self.folder, &identity)?;
        }
        let needed = reduce::memory(identity.members, threads, !identity.observer.is_empty());
        if let Some(free) = memory::free().filter(|free| needed > *free) {
            let rule = format!(
                "reducing {} members takes {} of memory, and {} are free",
                identity.members,
                memory::shown(needed),
                memory::shown(free)
            );
            let place = self.folder.display().to_string();
            return Err(Error::input(
                "gather",
                &place,
                &rule,
                "give fewer --threads, or use a machine with more",
            ));
        }
        // nothing is written before every byte of every shard has been looked at
        let shares = together(&shards)?;
        let mut arrays = shards.iter().map(Finished::attitudes).collect::<Result<Vec<_>, _>>()?;
        let unreadable = |error: std::io::Error| Error::Input(format!("{}: {error}", self.folder.display()));
        let reduced =
            reduce(&mut arrays, identity.members, threads, &identity.directions()).map_err(unreadable)?;
        let records: Vec<Record> = shards.iter().map(|shard| shard.record.clone()).collect();
        let record = Record::of_shards(&records).ok_or_else(|| unexpected("no shards"))?;
        let results = Results::new(&reduced, &shares, record);

        let (mut outputs, mut sums) = (Vec::new(), BTreeMap::new());
        if identity.attitudes {
            let (output, sum) = self.joined(ATTITUDES, &mut arrays)?;
            outputs.push(output);
            sums.insert(ATTITUDES.into(), sum);
        }
        if identity.omegas {
            let mut omegas = shards.iter().map(Finished::omegas).collect::<Result<Vec<_>, _>>()?;
            let (output, sum) = self.joined(OMEGAS, &mut omegas)?;
            outputs.push(output);
            sums.insert(OMEGAS.into(), sum);
        }
        let mut write = |name: &str, content: &str| {
            let mut output = Output::to_file("gather", &self.folder.join(name))?;
            output.write(content)?;
            outputs.push(output);
            Ok::<_, Error>(())
        };
        for (name, content) in results.files() {
            write(&name, &content)?;
            let sum = Checksum::of(content.as_bytes()).map_err(unexpected)?;
            sums.insert(name, sum);
        }
        self.check_unrecorded(&sums)?;
        write(MARK, &results.record(sums)?)?;
        // without its record a folder of results is not whole; the new one comes last
        let other = record_of_results(&self.folder)?.filter(Record::is_results);
        let remove = |name: &str| match std::fs::remove_file(self.folder.join(name)) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(unwritable("gather", &self.folder.join(name), &error))
            }
            _ => Ok(()),
        };
        remove(MARK)?;
        // what other results had, and these have not, would be taken for theirs
        if other.is_some() {
            for (name, is_written) in [
                (ATTITUDES, identity.attitudes),
                (OMEGAS, identity.omegas),
                ("observer.csv", !identity.observer.is_empty()),
                ("passages.csv", identity.event.is_some()),
            ] {
                if !is_written {
                    remove(name)?;
                }
            }
        }
        for output in outputs {
            output.finish()?;
        }
        said(&results, &shares, &identity, &self.folder)
    }

    /// Refuses to replace a file that no record belongs to; what a gathering that was killed has left is the same as that which replaces it.
    fn check_unrecorded(&self, sums: &BTreeMap<String, String>) -> Result<(), Error> {
        if self.replace || self.folder.join(MARK).exists() {
            return Ok(());
        }
        for (name, sum) in sums {
            let found = inputs::open_own(&self.folder.join(name)).and_then(Checksum::of);
            let is_free = match &found {
                Ok(found) => found == sum,
                Err(error) => error.kind() == ErrorKind::NotFound,
            };
            if !is_free {
                return Err(replacing("gather", &self.folder, &format!("holds a {name} of no ensemble")));
            }
        }
        Ok(())
    }

    /// The array of all members, from those of the shards, and its checksum.
    fn joined<const N: usize>(
        &self,
        name: &str,
        arrays: &mut [npy::Array<N>],
    ) -> Result<(Output, String), Error> {
        let path = self.folder.join(name);
        let times = arrays.first().map_or(0, npy::Array::times);
        let members = arrays.iter().map(npy::Array::members).sum();
        let (mut output, mut sum) = (Output::to_file("gather", &path)?, Checksum::new());
        let head = npy::head([times, members, N as u64]);
        output.write_bytes(&head)?;
        sum.add(&head);
        for time in 0..times {
            for array in arrays.iter_mut() {
                let bytes = array.read(time).map_err(|error| unwritable("gather", &path, &error))?;
                output.write_bytes(bytes)?;
                sum.add(bytes);
            }
        }
        Ok((output, sum.hexadecimal()))
    }

    /// Whether the shards belong together and none is missing.
    fn check(&self, shards: &[Finished]) -> Result<Identity, Error> {
        let refused = |rule: &str, remedy: &str| {
            Err(Error::input("gather", &self.folder.display().to_string(), rule, remedy))
        };
        let Some(first) = shards.first() else {
            return refused(
                "has no finished shards",
                "run polhode ensemble SPEC.toml --out DIR --shard K/N first",
            );
        };
        let count = first.shard.count;
        if let Some(other) = shards.iter().find(|shard| shard.shard.count != count) {
            return refused(
                &format!("holds shards of {count} and of {}", other.shard.count),
                "remove those of one of the two",
            );
        }
        if let Some(pair) = shards.windows(2).find(|pair| pair[0].shard == pair[1].shard) {
            let mut places = [&pair[0], &pair[1]].map(|shard| shard.path.display().to_string());
            places.sort();
            let rule = format!("holds shard {} twice, as {} and as {}", pair[0].shard, places[0], places[1]);
            return refused(&rule, "remove one of the two");
        }
        let identity = &first.record.identity;
        // the one that most agree with is the run; the others are told
        let agree =
            |identity: &Identity| shards.iter().filter(|shard| shard.record.identity == *identity).count();
        let most = shards
            .iter()
            .map(|shard| &shard.record.identity)
            .max_by_key(|other| (agree(other), *other == identity));
        let identity = most.unwrap_or(identity);
        let foreign: Vec<String> = shards
            .iter()
            .filter_map(|shard| {
                let difference = identity.difference(&shard.record.identity)?;
                Some(format!("{} is {difference}", shard.shard))
            })
            .collect();
        if !foreign.is_empty() {
            let rule = format!("holds shards of another run: {}", foreign.join("; "));
            return refused(&rule, "remove them and run them again");
        }
        let missing: Vec<String> = (1..=count)
            .filter(|k| shards.iter().all(|shard| shard.shard.number != *k))
            .map(|k| k.to_string())
            .collect();
        if let Some(one) = missing.first() {
            let rule = format!("lacks shards {} of {count}", missing.join(", "));
            return refused(&rule, &format!("run them, as with --shard {one}/{count}"));
        }
        if identity.version != env!("CARGO_PKG_VERSION") {
            let rule = format!("holds shards of version {}", identity.version);
            return refused(
                &rule,
                &format!("gather them with that version; this is {}", env!("CARGO_PKG_VERSION")),
            );
        }
        if let Some(other) = shards.iter().find(|shard| !shard.record.is_alike(&first.record)) {
            let of = |shard: &Finished| {
                let seed = shard.record.seed.map_or("no seed".into(), |seed| format!("seed {seed}"));
                format!("{} is of method {} and {seed}", shard.shard, shard.record.method)
            };
            let rule = format!("holds shards of two runs: {}, and {}", of(first), of(other));
            return refused(&rule, "remove those of one of the two");
        }
        Ok(identity.clone())
    }
}

/// Largest errors and failures of all shards.
fn together(shards: &[Finished]) -> Result<Shares, Error> {
    let mut all = Shares::default();
    for shard in shards {
        let shares = verified(shard)?;
        if all.times.is_empty() {
            all.times = shares.times;
            all.largest = vec![Largest::default(); all.times.len()];
        } else if let Some(k) = (0..all.times.len()).find(|k| all.times[*k] != shares.times[*k]) {
            let rule = format!(
                "row {} is of t = {}, and that of shard 1 of t = {}",
                k + 1,
                shares.times[k],
                all.times[k]
            );
            return Err(shard.wrong(&shard.path.join(format!("{ERRORS}.csv")), &rule));
        }
        for (all, one) in all.largest.iter_mut().zip(shares.largest) {
            *all = all.or(one);
        }
        all.failures.extend(shares.failures);
        all.passages.extend(shares.passages);
        all.draws += shares.draws;
    }
    Ok(all)
}

/// How many members failed in the run `identity`, where a folder holds its results, with every file that its record names.
///
/// # Errors
/// A file that is not as the run wrote it.
pub(super) fn has_results(folder: &Path, identity: &Identity) -> Result<Option<u64>, Error> {
    let is_whole = |record: &Record| {
        let mut names = record.files.keys().chain(record.sha256.keys());
        record.is_results() && names.all(|name| folder.join(name).is_file())
    };
    let record = record_of_results(folder)?.filter(|record| record.identity == *identity);
    match record.filter(is_whole) {
        Some(record) => unchanged(folder, &record).map(|()| Some(record.failed)),
        None => Ok(None),
    }
}
