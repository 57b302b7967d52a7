//! One name of a column: its letters, and the unit that it states.

use polhode::units::TimeUnit;

use super::spellings::{Endings, TIME_ENDINGS, counter, times};

/// A name, reduced.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Name {
    /// As the header has it.
    pub(crate) text: String,
    /// Letters and digits in lower case, without the unit.
    pub(crate) letters: String,
    /// What stands in brackets behind it.
    pub(crate) unit: Option<String>,
}

impl Name {
    pub(crate) fn of(text: &str) -> Self {
        let (stem, unit) = split_unit(text);
        let lower = stem.to_lowercase();
        // Delsys: `Sensor 1: Gyro.X 1`
        let own = lower
            .rsplit_once(": ")
            .map_or(lower.as_str(), |(_, own)| own.trim_end().trim_end_matches(|c: char| c.is_ascii_digit()));
        let mut words: Vec<&str> =
            own.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        // Shimmer: `Shimmer_5E3B_Gyro_X_CAL`
        if words.first() == Some(&"shimmer") && words.len() > 2 {
            words.drain(..2);
            if words.last() == Some(&"cal") {
                words.pop();
            }
        }
        let plain = |c: char| match c {
            'ω' => 'w',
            'ₓ' | 'ˣ' => 'x',
            'ᵧ' | 'ʸ' => 'y',
            'ᶻ' => 'z',
            c => c,
        };
        let letters = words.concat().chars().map(plain).collect();
        Self { text: text.into(), letters, unit: unit.map(String::from) }
    }

    /// How late it is considered for the time, if it is one: names with a unit come first, since a bare time may be anything,
    /// such as nanoseconds since 1970; counters come last.
    pub(crate) fn time_rank(&self) -> Option<(bool, usize, usize)> {
        let last = times().count();
        if let Some(place) = counter(&self.letters) {
            return Some((true, last + place, 0));
        }
        // Delsys names its times X[s]
        let is_delsys = || self.letters == "x" && self.unit.as_deref().and_then(TimeUnit::named).is_some();
        let found = times().enumerate().find_map(|(place, (stem, _))| {
            let rest = self.letters.strip_prefix(stem)?;
            let ending = if rest.is_empty() { 0 } else { TIME_ENDINGS.unit(rest)?.0 + 1 };
            Some((place, ending))
        });
        let (place, ending) = found.or_else(|| is_delsys().then_some((last, 0)))?;
        // of dates in days a double holds some ten microseconds
        let is_coarse = ["jd", "mjd"].contains(&self.letters.as_str());
        Some((is_coarse || self.time_unit().is_none_or(|unit| unit.1.is_none()), place, ending))
    }

    /// Whether it counts samples.
    pub(crate) fn is_counter(&self) -> bool {
        counter(&self.letters).is_some()
    }

    /// The unit of time that it states, as written and as known: in brackets, at its end, or by its meaning.
    pub(crate) fn time_unit(&self) -> Option<(&str, Option<TimeUnit>)> {
        if let Some(unit) = &self.unit {
            return Some((unit, TimeUnit::named(unit)));
        }
        times().find_map(|(stem, implied)| {
            let rest = self.letters.strip_prefix(stem)?;
            if rest.is_empty() {
                return implied.map(|unit| ("", TimeUnit::named(unit)));
            }
            let (_, unit) = TIME_ENDINGS.unit(rest)?;
            // `ts` and `times` name no unit, `t_s` does
            let before = self.text.trim_end().to_lowercase();
            let is_apart =
                || !before.strip_suffix('s').is_some_and(|before| before.ends_with(char::is_alphanumeric));
            (rest != "s" || is_apart()).then(|| (unit, TimeUnit::named(unit)))
        })
    }

    /// Whether it is `target`, with a unit of `endings` behind it or without.
    pub(crate) fn is(&self, target: &str, endings: Endings) -> bool {
        let rest = self.letters.strip_prefix(target);
        rest.is_some_and(|rest| rest.is_empty() || self.unit.is_none() && endings.unit(rest).is_some())
    }

    /// The unit that it states, where it is `target`.
    pub(crate) fn unit_behind(&self, target: &str, endings: Endings) -> Option<String> {
        let behind = || endings.unit(self.letters.strip_prefix(target)?).map(|(_, unit)| unit.to_string());
        self.unit.clone().or_else(behind)
    }

    /// The number behind `stem`, as 3 of qpos[3].
    pub(crate) fn number_after(&self, stem: &str) -> Option<usize> {
        self.letters.strip_prefix(stem)?.parse().ok()
    }
}

/// "Gyroscope x (rad/s)" as its name and its unit; the number of a component, the note that a date is a text, the offset of a
/// clock and empty brackets are none.
fn split_unit(text: &str) -> (&str, Option<&str>) {
    for (open, _) in text.match_indices(['(', '[']) {
        let rest = &text[open + 1..];
        let inside = rest.split([')', ']']).next().unwrap_or(rest).trim();
        if open == 0 || !inside.is_empty() && inside.chars().all(|c| c.is_ascii_digit()) {
            continue;
        }
        let unit = rest.trim_end().trim_end_matches([')', ']']).trim();
        let is_note = unit.is_empty() || unit == "txt" || unit.starts_with(['+', '-']);
        return (&text[..open], (!is_note).then_some(unit));
    }
    (text, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_letters_and_units() {
        for (text, letters, unit) in [
            ("Gyroscope x (rad/s)", "gyroscopex", Some("rad/s")),
            ("w_RS_S_x [rad s^-1]", "wrssx", Some("rad s^-1")),
            ("q_RS_w []", "qrsw", None),
            ("gyro_rad[0]", "gyrorad0", None),
            ("R[0][1]", "r01", None),
            ("gyroADC[2] (rad/s)", "gyroadc2", Some("rad/s")),
            ("timestamp (+0200)", "timestamp", None),
            ("ωₓ (rad/s)", "wx", Some("rad/s")),
            ("Shimmer_5E3B_Gyro_X_CAL", "gyrox", None),
            ("Sensor 1: Gyro.X 1", "gyrox", None),
        ] {
            let name = Name::of(text);
            assert_eq!((name.letters.as_str(), name.unit.as_deref()), (letters, unit), "{text}");
        }
    }

    #[test]
    fn times_state_their_unit_in_several_ways() {
        for (text, unit) in [
            ("time (ms)", Some(TimeUnit::Milliseconds)),
            ("timestampNs", Some(TimeUnit::Nanoseconds)),
            ("t_s", Some(TimeUnit::Seconds)),
            ("ts", None),
            ("TimeStartup(ns)", Some(TimeUnit::Nanoseconds)),
            ("millis", Some(TimeUnit::Milliseconds)),
            ("X[s]", Some(TimeUnit::Seconds)),
            ("jd", Some(TimeUnit::Days)),
        ] {
            let name = Name::of(text);
            assert!(name.time_rank().is_some(), "{text}");
            assert_eq!(name.time_unit().and_then(|(_, unit)| unit), unit, "{text}");
        }
        assert!(Name::of("temperature").time_rank().is_none() && Name::of("Counter").is_counter());
        assert!(Name::of("t").time_rank() < Name::of("jd").time_rank());
    }
}
