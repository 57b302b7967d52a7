//! Which share of the members a process has: by a flag, or by what its launcher tells it.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use polhode_files::error::Error;

/// Share `number`, from 1, of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shard {
    pub(super) number: u64,
    pub(super) count: u64,
}

/// What a launcher sets: one variable for the place among all, and one for how many there are.
const LAUNCHERS: [[&str; 2]; 2] =
    [["OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"], ["PMI_RANK", "PMI_SIZE"]];
/// What Slurm sets for the task of an array.
const TASK: &str = "SLURM_ARRAY_TASK_ID";

/// How many tasks `srun` has started beside each other, which also an array may do; a batch script itself has it not, whatever its
/// `SLURM_NTASKS` says.
const STEP: &str = "SLURM_STEP_NUM_TASKS";
/// The place of a process of PMIx among all, from 0; how many there are stands in no variable.
const PMIX: &str = "PMIX_RANK";

impl Shard {
    /// All members.
    pub(super) const WHOLE: Self = Self { number: 1, count: 1 };

    /// Its members among `members`: shards differ by one member at most, and follow each other.
    pub(super) fn range(self, members: u64) -> Range<u64> {
        let bound = |number: u64| {
            (u128::from(members) * u128::from(number) / u128::from(self.count)).try_into().unwrap_or(members)
        };
        bound(self.number - 1)..bound(self.number)
    }

    /// The name of its folder; names sort as the shards do.
    pub(super) fn folder(self) -> String {
        let width = self.count.to_string().len();
        format!("{:0width$}-of-{}", self.number, self.count)
    }

    /// The share that the environment names, with the variable that does; `None` outside of arrays and of MPI.
    pub(super) fn of_environment(
        variable: impl Fn(&str) -> Option<String>,
    ) -> Result<Option<(Self, &'static str)>, Error> {
        let number = |name: &'static str| -> Result<Option<u64>, Error> {
            let Some(text) = variable(name) else { return Ok(None) };
            let parsed = text.trim().parse().map(Some);
            parsed.map_err(|_| {
                Error::input(name, &text, "is not a whole number", "unset it, or give --shard K/N")
            })
        };
        let needed = |name: &'static str, beside: &str| {
            let missing = || Error::input(name, "", &format!("missing beside {beside}"), "give --shard K/N");
            number(name)?.ok_or_else(missing)
        };
        let mut found: Vec<(Self, &'static str)> = Vec::new();
        if let Some(task) = number(TASK)? {
            let count = needed("SLURM_ARRAY_TASK_COUNT", TASK)?;
            let first = needed("SLURM_ARRAY_TASK_MIN", TASK)?;
            let last = needed("SLURM_ARRAY_TASK_MAX", TASK)?;
            if last < first || last - first + 1 != count || !(first..=last).contains(&task) {
                let rule =
                    format!("{count} tasks from {first} to {last} have gaps, so its share is not known");
                let remedy = "submit an array without gaps, as --array=1-16 (finished shards are skipped), or give --shard K/N";
                return Err(Error::input(TASK, &task.to_string(), &rule, remedy));
            }
            found.push((Self { number: task - first + 1, count }, TASK));
        }
        for [rank, size] in LAUNCHERS {
            if let Some(place) = number(rank)? {
                let count = needed(size, rank)?;
                if place >= count {
                    let rule = format!("ranks count from 0 to {size} - 1, and {size} is {count}");
                    return Err(Error::input(rank, &place.to_string(), &rule, "give --shard K/N"));
                }
                found.push((Self { number: place + 1, count }, rank));
            }
        }
        // one process alone says nothing beside an array, and the two of MPI may say the same
        let mut told: Vec<(Self, &'static str)> = Vec::new();
        for (shard, name) in found {
            if shard != Self::WHOLE && told.iter().all(|(other, _)| *other != shard) {
                told.push((shard, name));
            }
        }
        let is_of_mpi = told.iter().any(|(_, name)| *name != TASK);
        let unshared = match (number(STEP)?, number(PMIX)?) {
            _ if is_of_mpi => None,
            (Some(tasks), _) if tasks > 1 => Some((STEP, tasks)),
            (None, Some(rank)) if rank > 0 => Some((PMIX, rank)),
            _ => None,
        };
        if let Some((name, value)) = unshared {
            let rule =
                "several processes are started, and all would run the same members into the same files";
            let remedy = "give each its part by --shard K/N, with srun as in bash -c 'polhode ensemble SPEC.toml --out DIR --shard \
                          $((SLURM_PROCID + 1))/$SLURM_NTASKS', or --shard 1/1 if each has an --out of its own";
            return Err(Error::input(name, &value.to_string(), rule, remedy));
        }
        match told[..] {
            [] => Ok(None),
            [one] => Ok(Some(one)),
            [(one, name), (other, beside), ..] => Err(Error::input(
                name,
                &one.to_string(),
                &format!("contradicts {beside}, which is {other}"),
                "give --shard K/N",
            )),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('/').and_then(|(k, n)| Some((k.trim().parse().ok()?, n.trim().parse().ok()?)));
        match parts {
            Some((number, count)) if (1..=count).contains(&number) => Ok(Self { number, count }),
            Some((number, count)) => {
                Err(format!("{number} is not among 1 to {count}; shards count from 1, as in 1/16 to 16/16"))
            }
            None => Err("expected K/N, as in 3/16".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_follow_each_other_and_differ_by_one_member_at_most() {
        for (members, count) in [(10, 3), (3, 3), (1_000_000, 16), (7, 1), (u64::MAX, 1000)] {
            let mut end = 0;
            for number in 1..=count {
                let range = Shard { number, count }.range(members);
                assert_eq!(range.start, end);
                let size = range.end - range.start;
                assert!(size == members / count || size == members / count + 1, "{members}/{count}: {size}");
                end = range.end;
            }
            assert_eq!(end, members);
        }
        assert_eq!(Shard { number: 3, count: 16 }.folder(), "03-of-16");
    }

    #[test]
    fn flags_are_read_and_refused() {
        assert_eq!("3/16".parse(), Ok(Shard { number: 3, count: 16 }));
        for (text, says) in [
            ("0/3", "count from 1"),
            ("4/3", "not among 1 to 3"),
            ("3", "K/N"),
            ("a/b", "K/N"),
            ("1/0", "not among"),
        ] {
            assert!(text.parse::<Shard>().unwrap_err().contains(says), "{text}");
        }
    }

    fn told(variables: &[(&str, &str)]) -> Result<Option<(Shard, &'static str)>, String> {
        let value =
            |name: &str| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).into());
        Shard::of_environment(value).map_err(|error| error.to_string())
    }

    fn task(
        id: &'static str,
        count: &'static str,
        [first, last]: [&'static str; 2],
    ) -> [(&'static str, &'static str); 4] {
        [
            ("SLURM_ARRAY_TASK_ID", id),
            ("SLURM_ARRAY_TASK_COUNT", count),
            ("SLURM_ARRAY_TASK_MIN", first),
            ("SLURM_ARRAY_TASK_MAX", last),
        ]
    }

    #[test]
    fn launchers_say_the_share() {
        assert_eq!(told(&[]), Ok(None));
        for first in [["0", "15"], ["1", "16"]] {
            let id = if first[0] == "0" { "2" } else { "3" };
            let shard = Shard { number: 3, count: 16 };
            assert_eq!(told(&task(id, "16", first)), Ok(Some((shard, "SLURM_ARRAY_TASK_ID"))));
        }
        let mpi = [("OMPI_COMM_WORLD_RANK", "0"), ("OMPI_COMM_WORLD_SIZE", "4")];
        assert_eq!(told(&mpi), Ok(Some((Shard { number: 1, count: 4 }, "OMPI_COMM_WORLD_RANK"))));
        let both = [mpi[0], mpi[1], ("PMI_RANK", "0"), ("PMI_SIZE", "4")];
        assert_eq!(told(&both), told(&mpi));
        // srun without MPI, inside an array
        let alone = [&task("2", "3", ["1", "3"])[..], &[("PMI_RANK", "0"), ("PMI_SIZE", "1")]].concat();
        assert_eq!(told(&alone), told(&task("2", "3", ["1", "3"])));
        // the whole in an array of one task
        assert_eq!(told(&task("7", "1", ["7", "7"])), Ok(None));
    }

    #[test]
    fn an_environment_that_is_not_clear_is_refused() {
        let refused = |variables: &[(&str, &str)], says: &str| {
            let message = told(variables).unwrap_err();
            assert!(message.contains(says), "{message}");
        };
        refused(&task("7", "2", ["3", "7"]), "2 tasks from 3 to 7 have gaps");
        refused(&task("x", "2", ["3", "7"]), "SLURM_ARRAY_TASK_ID: 'x': is not a whole number");
        refused(
            &[("SLURM_ARRAY_TASK_ID", "1")],
            "SLURM_ARRAY_TASK_COUNT: missing beside SLURM_ARRAY_TASK_ID",
        );
        refused(&[("PMI_RANK", "4"), ("PMI_SIZE", "4")], "ranks count from 0");
        let both = [&task("2", "3", ["1", "3"])[..], &[("PMI_RANK", "0"), ("PMI_SIZE", "4")]].concat();
        refused(&both, "SLURM_ARRAY_TASK_ID: '2/3': contradicts PMI_RANK, which is 1/4");
    }

    /// Ranks of which no variable tells the share would all run all members, or the same share of an array.
    #[test]
    fn ranks_that_no_launcher_counts_are_refused() {
        let srun =
            [("SLURM_PROCID", "0"), ("SLURM_STEP_NUM_TASKS", "4"), ("SLURM_NTASKS", "4"), ("PMIX_RANK", "0")];
        let says = "SLURM_STEP_NUM_TASKS: '4': several processes are started";
        let array = task("2", "3", ["1", "3"]);
        let within = [&array[..], &srun[..]].concat();
        for variables in [&srun[..], &srun[..3], &within[..]] {
            let message = told(variables).unwrap_err();
            assert!(message.contains(says) && message.contains("--shard K/N"), "{message}");
        }
        let message = told(&[("PMIX_RANK", "1")]).unwrap_err();
        assert!(message.contains("PMIX_RANK: '1': several processes"), "{message}");
        // one process, as that of a batch script with many processors
        assert_eq!(told(&[("SLURM_PROCID", "0"), ("SLURM_NTASKS", "4")]), Ok(None));
        let alone = [("SLURM_PROCID", "0"), ("SLURM_STEP_NUM_TASKS", "1"), ("PMIX_RANK", "0")];
        assert_eq!(told(&alone), Ok(None));
        assert_eq!(told(&[&array[..], &alone[..]].concat()), told(&array));
        // daemons of mpirun are tasks of srun, one on each node
        let mpi = [("OMPI_COMM_WORLD_RANK", "2"), ("OMPI_COMM_WORLD_SIZE", "8")];
        assert_eq!(told(&[&mpi[..], &srun[..]].concat()), told(&mpi));
    }
}
