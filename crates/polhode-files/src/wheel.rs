//! Wheels of a body: as text of a flag, in TOML and in JSON.

use polhode::body::{Wheel, WheelAtStart};
use polhode::units::RateUnit;
use serde_json::Value;
use toml::Spanned;
use toml::de::DeValue;

use crate::error::Error;
use crate::numbers::{list, number};
use crate::toml_file::Section;

/// Of a wheel in a file.
const KEYS: [&str; 8] = ["axis", "inertia", "speed", "speed_unit", "free", "torque", "from", "until"];

/// What a text has to look like.
const FORM: &str =
    "write it as ax,ay,az,I@3000rpm, then ,free or ,torque=T[,from=t][,until=t] if the speed is not held";

/// From `ax,ay,az,I@SPEED[,free|,torque=T[,from=t][,until=t]]`; a speed without unit is in rad/s.
///
/// # Errors
/// What is wrong with the text, or with the wheel.
pub fn parse(text: &str) -> Result<WheelAtStart, String> {
    let (front, behind) = text.split_once('@').ok_or_else(|| format!("no '@' and speed; {FORM}"))?;
    let found = list(front)?;
    let [x, y, z, inertia]: [f64; 4] = found
        .try_into()
        .map_err(|found: Vec<f64>| format!("{} numbers before '@', 4 needed; {FORM}", found.len()))?;
    let mut parts = behind.split(',');
    let speed = parts.next().unwrap_or_default();
    let speed = speed_of(speed).map_err(|error| format!("the speed: {error}"))?;
    let (mut free, mut torque, mut from, mut until) = (false, None, None, None);
    for part in parts {
        let (key, value) = part.trim().split_once('=').unwrap_or((part.trim(), ""));
        let place = match (key, value) {
            ("free", "") => {
                free = true;
                continue;
            }
            ("torque", _) => &mut torque,
            ("from", _) => &mut from,
            ("until", _) => &mut until,
            _ => return Err(format!("'{}' is unknown; {FORM}", part.trim())),
        };
        let value = number(value).map_err(|error| format!("{key}: {error}"))?;
        if place.replace(value).is_some() {
            return Err(format!("{key} is given twice"));
        }
    }
    driven([x, y, z], inertia, speed, Told { free, torque, from, until })
}

/// The wheel that is held, free or driven as `told`.
fn driven(axis: [f64; 3], inertia: f64, speed: f64, told: Told) -> Result<WheelAtStart, String> {
    let held = Wheel::new(axis.into(), inertia, speed).map_err(|error| error.to_string())?;
    match told {
        Told { free: true, torque: Some(_), .. } => {
            Err("give free or torque, not both; a wheel is free before and after its motor acts".into())
        }
        Told { torque: Some(torque), from, until, .. } => {
            let times = [from.unwrap_or(0.0), until.unwrap_or(f64::INFINITY)];
            WheelAtStart::driven(held, torque, times).map_err(|error| error.to_string())
        }
        Told { from: None, until: None, free: true, .. } => Ok(WheelAtStart::free(held)),
        Told { from: None, until: None, .. } => Ok(WheelAtStart::held(held)),
        _ => Err("from and until belong to a motor; give its torque too".into()),
    }
}

/// Those of the list `wheels` of a TOML file; none where there is no such key.
///
/// # Errors
/// As [`of_toml`], and a value that is no list of tables.
pub fn list_of_toml(section: &Section<'_>) -> Result<Vec<WheelAtStart>, Error> {
    let needed = || {
        section.at("wheels", "expected a list of tables {axis = [x, y, z], inertia = J, speed = \"3000rpm\"}")
    };
    let Some(value) = section.value("wheels") else { return Ok(Vec::new()) };
    let DeValue::Array(tables) = value.get_ref() else { return Err(needed()) };
    let wheel = |table: &Spanned<DeValue<'_>>| {
        let keys = table.get_ref().as_table().ok_or_else(needed)?;
        of_toml(&Section { file: section.file, place: table.span().start, keys })
    };
    tables.iter().map(wheel).collect()
}

/// From a table of a TOML file with the keys `axis`, `inertia`, `speed`, and `free` or `torque`, `from`, `until`.
///
/// # Errors
/// A key that is unknown or missing, with its line, or what is wrong with the wheel.
pub fn of_toml(section: &Section<'_>) -> Result<WheelAtStart, Error> {
    section.only("a wheel", &KEYS)?;
    let one = |key: &str| Ok::<_, Error>(section.numbers::<1>(key)?.map(|[number]| number));
    let missing = |key: &str, remedy: &str| {
        section.file.error(section.place, &format!("key '{key}': missing in this wheel; {remedy}"))
    };
    let axis = section.numbers::<3>("axis")?.ok_or_else(|| missing("axis", "give [x, y, z], body axes"))?;
    let inertia = section.positive("inertia")?.ok_or_else(|| missing("inertia", "give it in kg m^2"))?;
    let told = match section.value("speed").map(Spanned::get_ref) {
        None => return Err(missing("speed", "give it as \"3000rpm\"")),
        Some(DeValue::String(text)) => Speed::Text(text.to_string()),
        Some(_) => Speed::Number(one("speed")?.unwrap_or_default()),
    };
    let speed = told.in_unit(section.text("speed_unit")?).map_err(|error| section.at("speed", &error))?;
    let free = match section.value("free").map(Spanned::get_ref) {
        None => false,
        Some(DeValue::Boolean(free)) => *free,
        Some(_) => return Err(section.at("free", "expected true or false")),
    };
    let [torque, from, until] = [one("torque")?, section.seconds("from")?, section.seconds("until")?];
    let wheel = driven(axis, inertia, speed, Told { free, torque, from, until });
    wheel.map_err(|error| section.file.error(section.place, &error))
}

/// From an object of JSON with the same keys.
///
/// # Errors
/// What is wrong with it.
pub fn of_json(object: &Value) -> Result<WheelAtStart, String> {
    let keys = object.as_object().ok_or("a wheel is not a JSON object")?;
    if let Some(unknown) = keys.keys().find(|key| !KEYS.contains(&key.as_str())) {
        return Err(format!("\"{unknown}\" is unknown in a wheel; known: {}", KEYS.join(", ")));
    }
    let number = |key: &str| match &object[key] {
        Value::Null => Ok(None),
        value => value.as_f64().map(Some).ok_or_else(|| format!("\"{key}\" of a wheel is not a number")),
    };
    let needed = |key: &str| format!("\"{key}\" is missing in a wheel");
    let axis: [f64; 3] = serde_json::from_value(object["axis"].clone())
        .map_err(|_| "\"axis\" of a wheel is not a list of 3 numbers".to_string())?;
    let inertia = number("inertia")?.ok_or_else(|| needed("inertia"))?;
    let told = match &object["speed"] {
        Value::String(text) => Speed::Text(text.clone()),
        _ => Speed::Number(number("speed")?.ok_or_else(|| needed("speed"))?),
    };
    let speed = told.in_unit(object["speed_unit"].as_str())?;
    let free = match &object["free"] {
        Value::Null => false,
        Value::Bool(free) => *free,
        _ => return Err("\"free\" of a wheel is neither true nor false".into()),
    };
    let [torque, from, until] = [number("torque")?, number("from")?, number("until")?];
    driven(axis, inertia, speed, Told { free, torque, from, until })
}

/// What is told of how a wheel is driven.
struct Told {
    free: bool,
    torque: Option<f64>,
    from: Option<f64>,
    until: Option<f64>,
}

/// A speed in a file.
enum Speed {
    Text(String),
    Number(f64),
}

impl Speed {
    /// In rad/s: a text has its unit behind the number, and a number its unit beside it.
    fn in_unit(self, unit: Option<&str>) -> Result<f64, String> {
        match (self, unit) {
            (Speed::Text(_), Some(_)) => Err("already has a unit; leave speed_unit out".into()),
            (Speed::Text(text), None) if text.trim().parse::<f64>().is_ok() => {
                Err(format!("'{text}' has no unit; write it as \"3000rpm\" or \"300rad/s\""))
            }
            (Speed::Text(text), None) => speed_of(&text),
            (Speed::Number(value), None) => {
                Err(format!("{value:?} has no unit; write it as \"3000rpm\", or give speed_unit"))
            }
            (Speed::Number(value), Some(unit)) => Ok(rate(unit)?.radians_per_second(value)),
        }
    }
}

/// A speed with its unit behind it, or in rad/s.
fn speed_of(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let end = text.find(|c: char| c.is_alphabetic() && !matches!(c, 'e' | 'E')).unwrap_or(text.len());
    let (value, unit) = text.split_at(end);
    let value = number(value)?;
    Ok(if unit.is_empty() { value } else { rate(unit)?.radians_per_second(value) })
}

fn rate(unit: &str) -> Result<RateUnit, String> {
    // not every spelling that a column may have: rps is revolutions to some
    match unit.trim() {
        "rad/s" => Ok(RateUnit::RadiansPerSecond),
        "deg/s" => Ok(RateUnit::DegreesPerSecond),
        "rpm" => Ok(RateUnit::RevolutionsPerMinute),
        _ => Err(format!("unknown unit of rates '{unit}'; known: rad/s, deg/s, rpm")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_names_axis_inertia_speed_and_drive() {
        let wheel = parse("0,0,2,0.01@3000rpm").unwrap();
        assert!(wheel.is_held());
        assert!(
            (wheel.at_speed().speed(0.0, Default::default()) - 100.0 * core::f64::consts::PI).abs() < 1e-12
        );
        assert_eq!(wheel.at_speed().axis().z, 1.0);
        for text in [
            "1,0,0,0.5@-20",
            "0,1,0,0.5@3,free",
            "0,0,1,0.5@3,torque=-2,from=1",
            "0,0,1,0.5@3,torque=2,from=1,until=3",
        ] {
            let wheel = parse(text).unwrap();
            assert_eq!(parse(&wheel.to_string()), Ok(wheel), "{text}");
        }
        let free = parse("1,0,0,0.5@-2e1,free").unwrap().of_start(0.0, [3.0, 0.0, 0.0].into());
        assert_eq!(free.speed(5.0, [3.0, 1.0, 1.0].into()), -20.0);
        let driven = parse("1,0,0,0.5@2, torque=0.25, from=1, until=3").unwrap();
        assert_eq!(driven.of_start(0.0, Default::default()).speed(9.0, Default::default()), 3.0);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let error = |text: &str| parse(text).unwrap_err();
        assert!(error("1,0,0,0.1").starts_with("no '@' and speed"));
        assert!(error("1,0,0@3").starts_with("3 numbers before '@', 4 needed"));
        assert_eq!(error("1,0,0,0.1@3Hz"), "the speed: unknown unit of rates 'Hz'; known: rad/s, deg/s, rpm");
        assert!(error("0,0,0,0.1@3").contains("no direction"));
        assert!(error("1,0,0,0.1@3,spins").starts_with("'spins' is unknown"));
        assert!(error("1,0,0,0.1@3,free,torque=1").starts_with("give free or torque"));
        assert!(error("1,0,0,0.1@3,until=1").starts_with("from and until belong to a motor"));
        assert!(
            error("1,0,0,0.1@3,torque=1,until=-1")
                .starts_with("the motor of the wheel works from 0 s to -1 s")
        );
        let json = |text: &str| of_json(&serde_json::from_str(text).unwrap()).unwrap_err();
        assert!(json(r#"{"axis":[1,0,0],"inertia":0.1,"speed":3}"#).starts_with("3.0 has no unit"));
        assert!(json(r#"{"axis":[1,0],"inertia":0.1,"speed":"3rpm"}"#).starts_with("\"axis\" of a wheel"));
        let more = |keys: &str| json(&format!(r#"{{"axis":[1,0,0],"inertia":0.1,"speed":"3rpm",{keys}}}"#));
        assert!(more(r#""free":"yes""#).starts_with("\"free\" of a wheel is neither"));
        assert!(more(r#""torqe":1"#).starts_with("\"torqe\" is unknown in a wheel"));
    }
}
