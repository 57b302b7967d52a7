//! Whether there is room for work, in memory and on the disk.

use std::path::{Path, PathBuf};

use polhode_files::error::Error;
use polhode_files::inputs;

/// Of what the shell allows, bytes for the stacks of threads and for work that is small.
const SPARE: u64 = 16_000_000;

/// Refuses files of measurements that do not fit into memory; what is made of them takes `times` their size.
pub(crate) fn check_files(paths: &[PathBuf], times: u64) -> Result<(), Error> {
    let size = |path: &PathBuf| path.metadata().map_or(0, |found| found.len());
    let needed = paths.iter().map(size).fold(0, u64::saturating_add).saturating_mul(times);
    match (free().filter(|free| needed > *free), paths.first()) {
        (Some(free), Some(first)) => Err(Error::input(
            &first.display().to_string(),
            "",
            &format!("it takes about {} of memory, and {} are free", shown(needed), shown(free)),
            "use a part of it, or a machine with more",
        )),
        _ => Ok(()),
    }
}

/// Bytes that this process can still take: what the system has, what its group may have, and what the shell allows (`ulimit -v`);
/// `None` where nothing is told.
pub(crate) fn free() -> Option<u64> {
    let kilobytes = of_system("/proc/meminfo");
    let system = kilobytes.as_deref().and_then(available);
    // a container or a job of a scheduler
    let number = |name: &str| of_system(name)?.trim().parse::<u64>().ok();
    let group = number("/sys/fs/cgroup/memory.max")
        .map(|most| most.saturating_sub(number("/sys/fs/cgroup/memory.current").unwrap_or(0)));
    let text = |name: &str| of_system(name).unwrap_or_default();
    let addresses = addresses(&text("/proc/self/limits"), &text("/proc/self/status"));
    [system, group, addresses].into_iter().flatten().min()
}

/// What a file of the system says.
fn of_system(name: &str) -> Option<String> {
    std::io::read_to_string(inputs::open_own(Path::new(name)).ok()?).ok()
}

/// What is left of the limit on addresses, where there is one.
fn addresses(limits: &str, status: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let most: u64 = line.split_whitespace().next()?.parse().ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmSize:"))?;
    let taken: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(most.saturating_sub(taken.saturating_mul(1024)).saturating_sub(SPARE))
}

fn available(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kilobytes.checked_mul(1024)
}

/// Bytes that can still be written at `folder`, or at the folder above it that exists.
#[cfg(target_os = "linux")]
pub(crate) fn disk(folder: &Path) -> Option<u64> {
    let absolute = std::path::absolute(folder).ok()?;
    let found = absolute.ancestors().find_map(|folder| rustix::fs::statvfs(folder).ok())?;
    found.f_bavail.checked_mul(found.f_frsize)
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn disk(_: &Path) -> Option<u64> {
    None
}

/// A number of bytes for reading.
pub(crate) fn shown(bytes: u64) -> String {
    let units = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let mut size = bytes as f64;
    let mut unit = 0;
    while size >= 1000.0 && unit + 1 < units.len() {
        size /= 1000.0;
        unit += 1;
    }
    if unit == 0 { format!("{bytes} bytes") } else { format!("{size:.1} {}", units[unit]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_shown() {
        let text = "MemTotal:       16384000 kB\nMemFree:  1 kB\nMemAvailable:    8192000 kB\n";
        assert_eq!(available(text), Some(8_388_608_000));
        assert_eq!(available("MemTotal: 5 kB"), None);
        let limits =
            "Limit  Soft Limit  Hard Limit  Units\nMax address space   50000000   unlimited  bytes\n";
        assert_eq!(
            addresses(limits, "Name: polhode\nVmSize:\t   10000 kB\n"),
            Some(50_000_000 - 10_240_000 - SPARE)
        );
        assert_eq!(addresses(limits, "VmSize:\t 100000 kB\n"), Some(0));
        assert_eq!(addresses(&limits.replace("50000000", "unlimited"), "VmSize:\t 1 kB\n"), None);
        for (bytes, text) in
            [(999, "999 bytes"), (1500, "1.5 kB"), (16_000_000_000, "16.0 GB"), (u64::MAX, "18.4 EB")]
        {
            assert_eq!(shown(bytes), text);
        }
    }
}
