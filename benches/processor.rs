//! Which processor this is: tables of times are those of one.

/// Processors whose times are in the tables, in the order of their columns: name, and what Linux says of them.
const COLUMNS: [(&str, [&str; 3]); 2] =
    [("Sapphire Rapids", ["GenuineIntel", "6", "143"]), ("Milan", ["AuthenticAMD", "25", "1"])];

/// The column of this processor, and its name; `None` of another one, or where the system does not tell.
pub(crate) fn column() -> Option<(usize, &'static str)> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let value = |key: &str| {
        let mut lines = text.lines().filter_map(|line| line.split_once(':'));
        lines.find(|(name, _)| name.trim() == key).map(|(_, value)| value.trim())
    };
    let here = ["vendor_id", "cpu family", "model"].map(|key| value(key).unwrap_or_default());
    let known = COLUMNS.iter().enumerate().find(|(_, (_, processor))| *processor == here);
    known.map(|(column, (name, _))| (column, *name))
}

/// What is said where there is none. The exit code is 2 then: a run that judges nothing is no success.
pub(crate) const UNKNOWN: &str = "the table has no column for this: nothing is judged";
