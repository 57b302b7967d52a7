//! Whether a shard is what its run wrote: bytes, numbers that can be, and members that add up; and the bytes of results.

use std::collections::HashMap;
use std::path::Path;

use polhode::body::Problem;
use polhode::method::method;
use polhode_files::error::Error;
use polhode_files::inputs;
use polhode_files::npy::{Array, head};
use polhode_pages::output::MARK;

use super::checksum::Checksum;
use super::folder::{FAILURES, Finished};
use super::record::Record;
use super::work::{ATTITUDES, OMEGAS, Shares};

/// What rounding makes of a norm of 1 at most, by a method that keeps it: the random walk of 2^53 steps, half an ulp each.
pub(super) const NORM: f64 = 1e-8;

/// Largest errors and failures of a shard of which nothing contradicts its record.
///
/// # Errors
/// The first file that is not as it was written, the first quaternion that has not the norm 1, the first number that is not
/// finite, and members that do not add up.
pub(super) fn verified(shard: &Finished) -> Result<Shares, Error> {
    if !shard.record.is_as_written() {
        return Err(shard.wrong(&shard.mark(), "it has changed since its run wrote it"));
    }
    for name in shard.tables().map(|name| format!("{name}.csv")) {
        let path = shard.path.join(&name);
        let found =
            inputs::open(&path).and_then(Checksum::of).map_err(|error| shard.damaged(&path, &error))?;
        same(shard, &name, &found)?;
    }
    let shares = shard.shares()?;
    let missing = missing(shard, &shares)?;
    let unit = keeps_norm(&shard.record.method);
    array(shard, ATTITUDES, shard.attitudes()?, |place, q: &[f64; 4]| {
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        let has_failed = missing.get(&place.member).is_some_and(|from| place.time >= *from);
        if q.iter().any(|x| !x.is_finite()) {
            Some("is not finite".into())
        } else if *q == [0.0; 4] {
            (!has_failed).then(|| format!("is zero, although {FAILURES}.csv does not name the member"))
        } else if has_failed {
            Some(format!("is not zero, although {FAILURES}.csv names the member"))
        } else if unit && (norm - 1.0).abs() > NORM {
            Some(format!("has the norm {norm}, not 1"))
        } else {
            None
        }
    })?;
    if shard.record.identity.omegas {
        array(shard, OMEGAS, shard.omegas()?, |_, omega: &[f64; 3]| {
            omega.iter().any(|x| !x.is_finite()).then(|| "is not finite".into())
        })?;
    }
    Ok(shares)
}

/// Refuses results that are not as the run of their `record` wrote them.
///
/// # Errors
/// The first file that is not.
pub(super) fn unchanged(folder: &Path, record: &Record) -> Result<(), Error> {
    let refused = |name: &str, rule: &str| {
        let (path, folder) = (folder.join(name), folder.display());
        let remedy = format!("remove {folder} and run the ensemble again, or name another --out");
        Err(Error::Input(format!("{}: {rule}; {remedy}", path.display())))
    };
    if !record.is_as_written() {
        return refused(MARK, "it has changed since its run wrote it");
    }
    for (name, written) in record.sha256.iter().filter(|(name, _)| *name != MARK) {
        match inputs::open_own(&folder.join(name)).and_then(Checksum::of) {
            Ok(found) if found == *written => {}
            Ok(found) => {
                let rule = format!("it has changed since its run wrote it: SHA-256 {found}, not {written}");
                return refused(name, &rule);
            }
            Err(error) => return refused(name, &error.to_string()),
        }
    }
    Ok(())
}

/// A row of an array: its number among the times, and the member.
struct Place {
    time: u64,
    member: u64,
}

/// Reads an array once: every entry is one that can be, and the bytes are those that were written.
fn array<const N: usize>(
    shard: &Finished,
    name: &str,
    mut array: Array<N>,
    fault: impl Fn(&Place, &[f64; N]) -> Option<String>,
) -> Result<(), Error> {
    let path = shard.path.join(name);
    let first = shard.shard.range(shard.record.identity.members).start;
    let mut sum = Checksum::new();
    sum.add(&head([array.times(), array.members(), N as u64]));
    let mut found: Option<String> = None;
    for time in 0..array.times() {
        let bytes = array.read(time).map_err(|error| shard.damaged(&path, &error))?;
        sum.add(bytes);
        let entries = bytes.as_chunks::<8>().0.as_chunks::<N>().0;
        if found.is_none() {
            found = entries.iter().enumerate().find_map(|(k, entry)| {
                let place = Place { time, member: first + k as u64 + 1 };
                let fault = fault(&place, &entry.map(f64::from_le_bytes))?;
                Some(format!("row {} of member {} {fault}", time + 1, place.member))
            });
        }
    }
    // bytes that were changed explain what is wrong with the numbers
    same(shard, name, &sum.hexadecimal())?;
    found.map_or(Ok(()), |fault| Err(shard.wrong(&path, &fault)))
}

/// Whether a file has the checksum that the record of its shard names.
fn same(shard: &Finished, name: &str, found: &str) -> Result<(), Error> {
    let path = shard.path.join(name);
    match shard.record.sha256.get(name) {
        Some(written) if written == found => Ok(()),
        Some(written) => Err(shard
            .wrong(&path, &format!("it has changed since its run wrote it: SHA-256 {found}, not {written}"))),
        None => Err(shard.wrong(&path, "run.toml beside it has no SHA-256 of it")),
    }
}

/// The members that fail, with the number of the first time at which each has no row.
fn missing(shard: &Finished, shares: &Shares) -> Result<HashMap<u64, u64>, Error> {
    let wrong = |rule: String| Err(shard.wrong(&shard.path.join(format!("{FAILURES}.csv")), &rule));
    let record = &shard.record;
    if shares.failures.len() as u64 != record.failed {
        return wrong(format!("it names {} members, and run.toml {}", shares.failures.len(), record.failed));
    }
    if record.seed.is_some() && record.draws < shard.members() {
        let rule = format!("{} tensors are drawn for {} members", record.draws, shard.members());
        return Err(shard.wrong(&shard.mark(), &rule));
    }
    let range = shard.shard.range(record.identity.members);
    let mut from = HashMap::new();
    for failure in &shares.failures {
        if !(range.start + 1..=range.end).contains(&failure.member) {
            let rule = format!("member {} is not among {} to {}", failure.member, range.start + 1, range.end);
            return wrong(rule);
        }
        let Some(time) = shares.times.iter().position(|t| *t == failure.t) else {
            return wrong(format!(
                "member {} has failed at {}, which is not the time of a row",
                failure.member, failure.t
            ));
        };
        if from.insert(failure.member, time as u64).is_some() {
            return wrong(format!("it names member {} twice", failure.member));
        }
    }
    Ok(from)
}

/// Whether the method of that name keeps |q| = 1.
fn keeps_norm(name: &str) -> bool {
    match method(name) {
        Ok(method) => {
            Problem::ALL.iter().filter_map(|problem| method.claims(*problem)).all(|claims| claims.kept.norm)
        }
        // the closed form is no method of steps
        Err(_) => true,
    }
}
