//! Whether there is room for the work, in memory and on the disk.

use std::path::Path;

/// Bytes that this process can still take: what the system has, and what its group may have; `None` where neither is told.
pub(super) fn free() -> Option<u64> {
    let kilobytes = std::fs::read_to_string("/proc/meminfo").ok();
    let system = kilobytes.as_deref().and_then(available);
    // a container or a job of a scheduler
    let number = |name: &str| std::fs::read_to_string(name).ok()?.trim().parse::<u64>().ok();
    let group = number("/sys/fs/cgroup/memory.max")
        .map(|most| most.saturating_sub(number("/sys/fs/cgroup/memory.current").unwrap_or(0)));
    match (system, group) {
        (Some(system), Some(group)) => Some(system.min(group)),
        (system, group) => system.or(group),
    }
}

fn available(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kilobytes.checked_mul(1024)
}

/// Bytes that can still be written at `folder`, or at the folder above it that exists.
#[cfg(target_os = "linux")]
pub(super) fn disk(folder: &Path) -> Option<u64> {
    let absolute = std::path::absolute(folder).ok()?;
    let found = absolute.ancestors().find_map(|folder| rustix::fs::statvfs(folder).ok())?;
    found.f_bavail.checked_mul(found.f_frsize)
}

#[cfg(not(target_os = "linux"))]
pub(super) fn disk(_: &Path) -> Option<u64> {
    None
}

/// A number of bytes for reading.
pub(super) fn shown(bytes: u64) -> String {
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
        for (bytes, text) in
            [(999, "999 bytes"), (1500, "1.5 kB"), (16_000_000_000, "16.0 GB"), (u64::MAX, "18.4 EB")]
        {
            assert_eq!(shown(bytes), text);
        }
    }
}
