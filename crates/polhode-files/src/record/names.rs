//! Names of columns as phones, loggers and flight controllers write them, and the units that they imply.

use polhode::record::RecordError;
use polhode::units::{RateUnit, TimeUnit};

/// Where time and rates stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    /// Time, and the rates about x, y and z, from 0.
    pub(super) columns: [usize; 4],
    /// Nanoseconds beside whole seconds.
    pub(super) nanoseconds: Option<usize>,
    /// Units that the layout implies where the header names none.
    pub(super) time_unit: Option<TimeUnit>,
    pub(super) rate_unit: Option<RateUnit>,
}

/// Names of times, reduced, in the order of preference, with the unit that a name implies. Words for time are those of the
/// languages that phyphox speaks.
const TIMES: [(&str, Option<TimeUnit>); 35] = [
    ("secondselapsed", Some(TimeUnit::Seconds)),
    ("gyrotimestampsincereboot", Some(TimeUnit::Seconds)),
    ("motiontimestampsincereboot", Some(TimeUnit::Seconds)),
    ("timestampsincereboot", Some(TimeUnit::Seconds)),
    ("timesincestartinms", Some(TimeUnit::Milliseconds)),
    ("t", None),
    ("time", None),
    ("zeit", None),
    ("temps", None),
    ("tiempo", None),
    ("tempo", None),
    ("tijd", None),
    ("czas", None),
    ("čas", None),
    ("tid", None),
    ("zaman", None),
    ("χρόνος", None),
    ("время", None),
    ("时间", None),
    ("時間", None),
    ("시간", None),
    ("timestamp", None),
    ("elapsed", None),
    ("millis", Some(TimeUnit::Milliseconds)),
    ("micros", Some(TimeUnit::Microseconds)),
    ("sampletimefine", None),
    ("packetcounter", None),
    ("timestampsample", None),
    ("fieldheaderstamp", None),
    ("epoc", None),
    ("epoch", None),
    ("loggingtime", None),
    ("datetime", None),
    ("date", None),
    ("frame", None),
];

/// Names of rates without the letter of the axis, in the order of preference.
const RATES: [&str; 40] = [
    "w",
    "omega",
    "omegabody",
    "gyro",
    "gyr",
    "gyroscope",
    "g",
    "angularvelocity",
    "angularvelocitybody",
    "rate",
    "rotationrate",
    "gyrorotation",
    "motionrotationrate",
    "gyrorad",
    "xyz",
    "gyroadc",
    "fieldangularvelocity",
    "imuangularvelocity",
    "imugyro",
    "gyrodata",
    "angvel",
    "angularrate",
    "sensorangularvelocity",
    "gyroskop",
    "gyroscoop",
    "giroscopio",
    "giroscópio",
    "giroskop",
    "żyroskop",
    "jiroskop",
    "γυροσκόπιο",
    "гироскоп",
    "陀螺仪",
    "ジャイロスコープ",
    "자이로스코프",
    "winkelgeschwindigkeit",
    "vitesseangulaire",
    "velocidadangular",
    "velocitàangolare",
    "",
];

/// What may stand behind the letter of an axis that comes first, as in `x-axis`.
const AXIS_FIRST: [&str; 6] = ["axis", "gyro", "gyr", "gyroscope", "rate", "angularvelocity"];

/// Units at the end of the names of rates, reduced.
const RATE_SUFFIXES: [(&str, RateUnit); 8] = [
    ("radpersec", RateUnit::RadiansPerSecond),
    ("radps", RateUnit::RadiansPerSecond),
    ("rads", RateUnit::RadiansPerSecond),
    ("degpersec", RateUnit::DegreesPerSecond),
    ("degps", RateUnit::DegreesPerSecond),
    ("degs", RateUnit::DegreesPerSecond),
    ("dps", RateUnit::DegreesPerSecond),
    ("rpm", RateUnit::RevolutionsPerMinute),
];

/// A name without its unit, reduced to letters and digits, with sub- and superscripts, and the numbers of components, as
/// letters.
fn reduced(name: &str) -> String {
    let indexed = ["[0]", "[1]", "[2]"].into_iter().zip(["x", "y", "z"]);
    let name = indexed.fold(name.to_string(), |name, (index, axis)| name.replace(index, axis));
    let letters = split_unit(&name).0.to_lowercase();
    letters
        .chars()
        .filter_map(|c| match c {
            'ω' => Some('w'),
            'ₓ' | 'ˣ' => Some('x'),
            'ᵧ' | 'ʸ' => Some('y'),
            'ᶻ' => Some('z'),
            c if c.is_alphanumeric() => Some(c),
            _ => None,
        })
        .collect()
}

/// "Gyroscope x (rad/s)" as its name and its unit; the number of a component, the note that a date is a text, and the offset
/// of a clock are none.
fn split_unit(name: &str) -> (&str, Option<&str>) {
    let opens = name.match_indices(['(', '[']).map(|(place, _)| place);
    let mut rest = opens.filter(|&place| !["[0]", "[1]", "[2]"].iter().any(|i| name[place..].starts_with(i)));
    let Some(open) = rest.next() else { return (name, None) };
    let unit = name[open + 1..].trim_end().trim_end_matches([')', ']']);
    let is_note = unit == "txt" || unit.starts_with(['+', '-']);
    (&name[..open], (!is_note).then_some(unit))
}

/// The unit in the name of a time, as in `time_ms`, or the one that the name implies.
fn time_suffix(name: &str) -> Option<TimeUnit> {
    let reduced = reduced(name);
    TIMES.iter().find_map(|(stem, implied)| match reduced.strip_prefix(stem)? {
        "" => *implied,
        "ms" => Some(TimeUnit::Milliseconds),
        "us" => Some(TimeUnit::Microseconds),
        "ns" => Some(TimeUnit::Nanoseconds),
        // `ts` and `times` name no unit, `t_s` does
        "s" if !name.trim_end().to_lowercase().strip_suffix('s')?.ends_with(char::is_alphanumeric) => {
            Some(TimeUnit::Seconds)
        }
        _ => None,
    })
}

/// How late a column is considered for the time, if it is one: names with a unit come first, since a bare time may be
/// anything, such as nanoseconds since 1970.
fn time_rank(name: &str) -> Option<(bool, usize, usize)> {
    let reduced = reduced(name);
    let (stem, suffix) = TIMES.iter().enumerate().find_map(|(stem, (text, _))| {
        let rest = reduced.strip_prefix(text)?;
        Some((stem, ["", "s", "ms", "us", "ns"].iter().position(|suffix| *suffix == rest)?))
    })?;
    let unit = split_unit(name).1.and_then(TimeUnit::named).or_else(|| time_suffix(name));
    Some((unit.is_none(), stem, suffix))
}

/// How late a column is considered for the rate about `axis`, if it is one.
fn rate_rank(reduced: &str, axis: char) -> Option<usize> {
    let plain = |name: &str| {
        let stem = name.strip_suffix(axis)?;
        RATES.iter().position(|known| *known == stem)
    };
    let suffixed = || {
        let stem = RATE_SUFFIXES.iter().find_map(|(suffix, _)| reduced.strip_suffix(suffix))?;
        plain(stem)
    };
    let first = || {
        let rest = reduced.strip_prefix(axis)?;
        AXIS_FIRST.iter().position(|known| *known == rest).map(|place| RATES.len() + place)
    };
    plain(reduced).or_else(suffixed).or_else(first)
}

/// Where time and the three rates stand, or what is missing.
pub(super) fn find_columns(names: &[String]) -> Result<Found, &'static str> {
    fn least<R: Ord>(ranks: impl Iterator<Item = Option<R>>) -> Option<usize> {
        let ranked = ranks.enumerate().filter_map(|(k, rank)| rank.map(|r| (r, k)));
        ranked.min().map(|(_, k)| k)
    }
    let reduced: Vec<String> = names.iter().map(|n| reduced(n)).collect();
    let ending = |end: &str| reduced.iter().position(|name| name.ends_with(end));
    // whole seconds and nanoseconds apart, as messages of ROS have them
    let stamp =
        ending("stampsecs").zip(ending("stampnsecs")).or(ending("stampsec").zip(ending("stampnanosec")));
    let time = least(names.iter().map(|n| time_rank(n)));
    let (time, nanoseconds) = match (time, stamp) {
        (Some(time), _) => (time, None),
        (None, Some((seconds, nanoseconds))) => (seconds, Some(nanoseconds)),
        (None, None) => return Err("time"),
    };
    let named = |letter: &str| reduced.iter().position(|name| name == letter);
    let pqr = named("p").zip(named("q")).zip(named("r"));
    let rate = |axis: char| least(reduced.iter().map(|name| rate_rank(name, axis)));
    let rates = match (rate('x'), rate('y'), rate('z'), pqr) {
        (Some(x), Some(y), Some(z), _) => [x, y, z],
        (_, _, _, Some(((p, q), r))) => [p, q, r],
        (None, ..) => return Err("the rate about x"),
        (_, None, ..) => return Err("the rate about y"),
        _ => return Err("the rate about z"),
    };
    let stem = |place: usize| reduced[place].trim_end_matches(['x', 'y', 'z']);
    let first = stem(rates[0]);
    let time_unit = match reduced[time].as_str() {
        _ if nanoseconds.is_some() => Some(TimeUnit::Seconds),
        // the logs of PX4 and the messages of ROS
        "timestamp" | "timestampsample" if first == "gyrorad" || reduced[rates[0]] == "xyzx" => {
            Some(TimeUnit::Microseconds)
        }
        "time" | "fieldheaderstamp" if first == "fieldangularvelocity" => Some(TimeUnit::Nanoseconds),
        // the explorer of Betaflight's logs
        "time" if first == "gyroadc" => Some(TimeUnit::Microseconds),
        _ => None,
    };
    let rate_unit = match first {
        "gyroadc" => Some(RateUnit::DegreesPerSecond),
        "gyrorad" => Some(RateUnit::RadiansPerSecond),
        _ => None,
    };
    Ok(Found { columns: [time, rates[0], rates[1], rates[2]], nanoseconds, time_unit, rate_unit })
}

/// The unit of the time column, from its header or the setting, which must not contradict each other.
pub(super) fn time_unit(
    name: &str,
    file: &str,
    setting: Option<TimeUnit>,
) -> Result<Option<TimeUnit>, RecordError> {
    let known = split_unit(name).1.map(|text| (text, TimeUnit::named(text)));
    resolved(name, file, setting, known.or_else(|| time_suffix(name).map(|unit| ("", Some(unit)))))
}

/// The same of a column of rates.
pub(super) fn rate_unit(
    name: &str,
    file: &str,
    setting: Option<RateUnit>,
) -> Result<Option<RateUnit>, RecordError> {
    let suffix = || {
        let reduced = reduced(name);
        let found = RATE_SUFFIXES.iter().find(|(suffix, _)| reduced.ends_with(suffix));
        found.map(|(_, unit)| ("", Some(*unit)))
    };
    let known = split_unit(name).1.map(|text| (text, RateUnit::named(text)));
    resolved(name, file, setting, known.or_else(suffix))
}

fn resolved<U: PartialEq + Copy + core::fmt::Display>(
    name: &str,
    file: &str,
    setting: Option<U>,
    header: Option<(&str, Option<U>)>,
) -> Result<Option<U>, RecordError> {
    let Some((text, header)) = header else { return Ok(setting) };
    let header = header.ok_or_else(|| RecordError::Unit {
        file: file.into(),
        name: name.into(),
        unit: text.into(),
    })?;
    match setting {
        Some(setting) if setting != header => Err(RecordError::UnitClash {
            file: file.into(),
            name: name.into(),
            header: header.to_string(),
            setting: setting.to_string(),
        }),
        _ => Ok(Some(header)),
    }
}
