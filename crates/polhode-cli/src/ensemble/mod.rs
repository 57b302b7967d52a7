//! `polhode ensemble`: many bodies from uncertain starts, on one machine or in shares on many.

mod checksum;
mod first_order;
mod folder;
mod gather;
mod passages;
mod record;
mod reduce;
mod results;
mod shard;
mod spec;
mod verify;
mod work;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use polhode::num::Instructions;
use polhode_files::error::{Error, tell, warn};
use polhode_files::npy;
use polhode_pages::output::{MARK, Staging, emit};

use crate::{cost, memory};
pub(crate) use gather::Gather;
use record::{Identity, Record};
use results::Results;
use shard::Shard;
use spec::Spec;
use work::{ATTITUDES, OMEGAS, Shares};

/// Bytes that a member takes while it is propagated, with a tensor of its own.
const BYTES_OF_MEMBER: u64 = 264;
/// Bytes that a thread takes for the rows in work.
const BYTES_OF_THREAD: u64 = 3 * 21_000_000;

const AFTER_HELP: &str = "SPEC.toml:
  [body]    moments = [3], inertia = [6] (xx, yy, zz, xy, xz, yz), or body
  [start]   omega = [3], rad/s; attitude = [4], quaternion from body to space,
            scalar first; rate_unit and angle_unit, such as \"deg/s\" and
            \"deg\", hold for [spread] and the members too; or of a tumbling
            body periods, mode, pole, phases, reversed; epoch and time_scale
            turn the times in [run] into dates
  [spread]  standard deviations, one or three each: omega, rad/s; attitude,
            rad, about the body axes; moments, relative; for a tumbling body
            one or two each: periods, pole, phases, ratios
  [spread.covariance]  omega 3x3, attitude 3x3, inertia 6x6, or joint 12x12;
                       elements 8x8
  [spread.range]       omega, attitude, moments: [[low, high], ...]; \"all\"
  [[solution]]  weight, and what differs in periods, mode, pole, phases, spread
  [observer]    direction = [lambda, beta], or directions, one for each time
  [run]     members, seed, method, step, tolerance, start_time, times,
            times_file and times_column, or until and every;
            errors = false leaves out the errors of energy and L
  [[body.wheels]]  axis, inertia, speed = \"3000rpm\" at the start, held;
            free = true, or torque, from, until of a motor
  [force]   weight_moment, gravity_gradient or orbit, orbit_plane or
            orbit_table, gm; torque_body, torque_space, drag
  [event]   first = \"flip\", or another event of propagate --event, up to the
            last time; every, the time between looks in the search
  [output]  arrays = [\"attitudes\", \"omegas\"]

Examples:
  polhode ensemble examples/ensemble.toml --out ensemble
  polhode ensemble examples/ensemble.toml --out halves --shard 1/2
  polhode ensemble examples/ensemble.toml --out halves --shard 2/2
  polhode gather halves";

/// Many bodies from uncertain starts: mean attitude and dispersion over time
///
/// Members are drawn from standard deviations, covariances or ranges of start and inertia, or listed in a CSV (members_file). The
/// elements of a tumbling body are drawn about one or several solutions of its light curve. A tensor that violates the triangle
/// inequalities is drawn again. Member k is the same in any division of the work. DIR gets summary.csv, dispersion.csv,
/// dispersion.svg, failures.csv, attitudes.npy (times x members x 4), omegas.npy (times x members x 3) and run.toml; with an [event]
/// also passages.csv, the time at which it first happens to each member. For free bodies in exact motion the spread to first order is
/// printed beside that of the members.
///
/// A folder with the results of another run, or with anything beside those of this one, is replaced only with --replace.
///
/// With --shard K/N, in a Slurm array or under an MPI launcher, only part K of N of the members is run. Processes that srun starts
/// side by side need --shard. The results of a part, a shard, go to DIR/shards, and `polhode gather DIR` joins all shards. A shard
/// that is finished is not run again. Exit code 1: every member failed; with shards `gather` has it.
#[derive(Args, Clone, Debug)]
#[command(after_help = AFTER_HELP)]
pub(crate) struct Ensemble {
    /// What is drawn, propagated and kept: a TOML file
    #[arg(value_name = "SPEC.toml")]
    spec: PathBuf,
    /// Folder of the results
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Run, and replace the results that DIR holds, with all else in that folder
    #[arg(long)]
    replace: bool,
    /// Part K of N of the members, K from 1 [default: what the launcher says, else all members]
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
    /// Threads [default: as many as there are cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Widest vector instructions that may be used; the results do not depend on it
    #[arg(long, value_name = "SET", value_enum, default_value_t, hide_default_value = true)]
    instructions: Set,
}

/// Sets of vector instructions.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Set {
    /// All that the processor has (default)
    #[default]
    Widest,
    /// Nothing beyond AVX2
    Avx2,
    /// What the program was compiled for
    Baseline,
}

impl From<Set> for Instructions {
    fn from(set: Set) -> Self {
        match set {
            Set::Widest => Self::Widest,
            Set::Avx2 => Self::Avx2,
            Set::Baseline => Self::Baseline,
        }
    }
}

/// What the members are propagated by; results depend on none of it.
#[derive(Clone, Copy, Debug)]
struct Means {
    threads: usize,
    instructions: Instructions,
}

/// The threads asked for, or one for each core.
fn threads_of(asked: Option<u16>) -> usize {
    asked.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from)
}

impl Ensemble {
    pub(crate) fn run(&self) -> Result<(), Error> {
        let spec = Spec::read(&self.spec)?;
        let shard = self.share()?;
        match shard {
            None => self.whole(&spec),
            Some(shard) if self.replace => Err(Error::input(
                "--replace",
                "",
                &format!("given with shard {shard}, which replaces nothing"),
                "leave it out here, and give it to `polhode gather`",
            )),
            Some(shard) => self.part(&spec, shard),
        }
    }

    fn means(&self) -> Means {
        Means { threads: threads_of(self.threads), instructions: self.instructions.into() }
    }

    /// The share of the members; `None` for all, as one run.
    fn share(&self) -> Result<Option<Shard>, Error> {
        let found = match self.shard {
            Some(shard) => Some(shard),
            None => {
                let told = Shard::of_environment(|name| std::env::var(name).ok())?;
                if let Some((shard, name)) = told {
                    tell("note", &format!("shard {shard}, from {name}; --shard K/N names another"));
                }
                told.map(|(shard, _)| shard)
            }
        };
        Ok(found.filter(|shard| *shard != Shard::WHOLE))
    }

    /// All members in one run.
    fn whole(&self, spec: &Spec) -> Result<(), Error> {
        let identity = Identity::of(spec);
        if self.out.join(folder::SHARDS).exists() {
            let rule = "holds shards, which results of another run would belong to";
            let place = self.out.display().to_string();
            return Err(Error::input(
                "--out",
                &place,
                rule,
                "gather them with `polhode gather`, or name another folder",
            ));
        }
        if !self.replace {
            if let Some(failed) = gather::has_results(&self.out, &identity)? {
                let of_failed = of_failed(failed, identity.members);
                tell(
                    "note",
                    &format!("{} holds the results of this run already{of_failed}", self.out.display()),
                );
                return check_left(failed, identity.members, &self.out);
            }
            folder::check_replaced("--out", &self.out, &identity)?;
            folder::check_alone(&self.out)?;
        }
        self.check_room(spec, Shard::WHOLE)?;
        let means = self.means();
        let staging = Staging::new(&self.out)?;
        let range = Shard::WHOLE.range(spec.members);
        let (arrays, shares) = work::propagate(spec, range, means, &staging, &self.out)?;
        let mut attitudes = [arrays.attitudes];
        let reduced = reduce::reduce(&mut attitudes, spec.members, means.threads, &identity.directions())
            .map_err(|error| Error::Input(format!("{}: {error}", self.out.display())))?;
        let record = Record::new(spec, None, shares.draws, shares.failures.len() as u64);
        let results = Results::new(&reduced, &shares, record);
        let files = results.files();
        for (name, content) in &files {
            staging.write(name, content.as_bytes())?;
        }
        drop(attitudes);
        if !spec.attitudes {
            staging.remove(ATTITUDES)?;
        }
        let arrays = [spec.attitudes.then_some(ATTITUDES), spec.omegas.then_some(OMEGAS)];
        let names = files.iter().map(|(name, _)| name.as_str()).chain(arrays.into_iter().flatten());
        let sums = folder::checksums(&staging, names)?;
        staging.write(MARK, results.record(sums)?.as_bytes())?;
        staging.commit()?;
        said(&results, &shares, &identity, &self.out)?;
        match first_order::beside(spec, &reduced, &results.rows_shown()) {
            Some(text) => emit(&text, None),
            None => Ok(()),
        }
    }

    /// One share, into a folder of its own.
    fn part(&self, spec: &Spec, shard: Shard) -> Result<(), Error> {
        let identity = Identity::of(spec);
        if shard.count > spec.members {
            let rule = format!("more shards than the {} members", spec.members);
            return Err(Error::input("--shard", &shard.to_string(), &rule, "use fewer shards"));
        }
        for other in folder::finished(&self.out)? {
            let foreign = |rule: &str| {
                let place = other.path.display().to_string();
                Err(Error::input("--out", &place, rule, "remove it, or name another folder"))
            };
            if let Some(difference) = identity.difference(&other.record.identity) {
                return foreign(&format!("is a shard of another run: {difference}"));
            }
            if other.shard.count != shard.count {
                return foreign(&format!(
                    "is a shard of {}, and this is one of {}",
                    other.shard.count, shard.count
                ));
            }
            if other.shard == shard {
                let of_failed = of_failed(other.record.failed, other.members());
                tell("note", &format!("shard {shard} is finished already{of_failed}"));
                return Ok(());
            }
        }
        self.check_room(spec, shard)?;
        let range = shard.range(spec.members);
        let folder = self.out.join(folder::SHARDS).join(shard.folder());
        let staging = Staging::new(&folder)?;
        let (_, shares) = work::propagate(spec, range.clone(), self.means(), &staging, &folder)?;
        let record = Record::new(spec, Some(shard), shares.draws, shares.failures.len() as u64);
        folder::commit(staging, &shares, record)?;
        warn_of(&shares, range.end - range.start);
        emit(
            &format!("Shard {shard}, members {} to {}: {}\n", range.start + 1, range.end, folder.display()),
            None,
        )
    }

    /// Refuses work of more steps than can be taken, and work that needs more memory or more room on the disk than there is, before it begins.
    fn check_room(&self, spec: &Spec, shard: Shard) -> Result<(), Error> {
        let range = shard.range(spec.members);
        cost::check_all(&spec.place, range.end - range.start, spec.steps())?;
        spec.warn_coarse();
        let (members, threads) = (range.end - range.start, threads_of(self.threads));
        let times = spec.plan.times.len() as u64;
        let is_observed = !spec.observer.is_empty();
        let reduction = if shard == Shard::WHOLE { reduce::memory(members, threads, is_observed) } else { 0 };
        let rows = members.saturating_mul(times).saturating_mul(80);
        let work = BYTES_OF_MEMBER
            .saturating_mul(members)
            .saturating_add(rows.min(BYTES_OF_THREAD.saturating_mul(threads as u64)))
            .saturating_add(if spec.watched.is_some() { passages::BYTES.saturating_mul(members) } else { 0 });
        let needed = work.max(reduction).saturating_add(spec.bytes_of_source());
        let refused = |what: &str, needed: u64, free: u64, remedy: &str| {
            let rule = format!(
                "{members} members take about {} {what}, and {} are free",
                memory::shown(needed),
                memory::shown(free)
            );
            Err(Error::Input(format!("{}: {rule}; {remedy}", spec.place)))
        };
        if let Some(free) = memory::free().filter(|free| needed > *free) {
            return refused("of memory", needed, free, "use fewer members, or split them with --shard K/N");
        }
        let arrays = npy::Array::<4>::size(times, members).saturating_add(if spec.omegas {
            npy::Array::<3>::size(times, members)
        } else {
            0
        });
        match memory::disk(&self.out).filter(|free| arrays > *free) {
            Some(free) => refused(
                "on the disk of --out",
                arrays,
                free,
                "use fewer members or times, or leave omegas out of [output] arrays",
            ),
            None => Ok(()),
        }
    }
}

/// Says what befell members.
fn warn_of(shares: &Shares, members: u64) {
    if let Some(first) = shares.failures.first() {
        let (failed, one) = (shares.failures.len(), first.member);
        warn(&format!(
            "{failed} of {members} members failed, the first of them member {one}: {}; see failures.csv",
            first.reason
        ));
    }
    let mut unknown = shares.passages.iter().filter_map(|one| Some((one.member, one.unknown()?)));
    if let Some((first, reason)) = unknown.next() {
        let count = 1 + unknown.count();
        warn(&format!(
            "whether the event happens is not known for {count} of {members} members, the first of them member {first}: \
             {reason}; see passages.csv"
        ));
    }
}

/// Some rows, and where all of them are.
fn said(results: &Results, shares: &Shares, identity: &Identity, out: &Path) -> Result<(), Error> {
    let members = identity.members;
    warn_of(shares, members);
    let draws = shares.draws;
    let redrawn = if draws > members {
        format!("{} of {draws} draws are not physical and were drawn again.\n", draws - members)
    } else {
        String::new()
    };
    let last = shares.times.iter().fold(f64::NEG_INFINITY, |last, t| t.max(last));
    let event = identity.event.as_ref().map(|event| passages::sentence(&shares.passages, event, last));
    let redrawn = redrawn + &event.unwrap_or_default();
    emit(&format!("{}\n{redrawn}Written to {}\n", results.shown(), out.display()), None)?;
    check_left(shares.failures.len() as u64, members, out)
}

fn of_failed(failed: u64, members: u64) -> String {
    if failed == 0 { String::new() } else { format!(", in which {failed} of {members} members failed") }
}

/// Fails where no member came to the end; of a shard it is left to `gather`, as a launcher would end the other shards, in which members may
/// be left.
fn check_left(failed: u64, members: u64, out: &Path) -> Result<(), Error> {
    if failed < members {
        return Ok(());
    }
    Err(Error::Failed(format!("{}: every member failed; see failures.csv", out.display())))
}
