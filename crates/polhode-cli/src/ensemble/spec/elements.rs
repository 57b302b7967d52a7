//! A tumbling body in the elements that observers publish: `[start]`, `[spread]` and the solutions of `[[solution]]`.

use clap::ValueEnum;
use polhode::flow::{Mode, TumblingElements, TumblingPopulation, TumblingSolution};
use polhode::inertia::Inertia;
use polhode::num::Covariance;
use polhode_files::error::Error;
use polhode_files::toml_file::Section;
use toml::de::DeValue;

use super::nominal::Units;
use super::spread::matrix_of;
use crate::flags::tumbling::{ModeArgument, Periods, latitude, periods};

/// Keys of `[start]` and of a solution.
pub(super) const START: [&str; 5] = ["periods", "mode", "pole", "phases", "reversed"];

/// Keys of `[spread]` and of the spread of a solution.
pub(super) const SPREAD: [&str; 4] = ["periods", "pole", "phases", "ratios"];

/// Elements as a table says them; what it leaves out is that of `before`.
pub(super) fn elements(
    table: &Section<'_>,
    units: Units,
    before: Option<&TumblingElements>,
) -> Result<Option<TumblingElements>, Error> {
    let given = START.into_iter().find(|key| table.value(key).is_some());
    let (Some(given), Some(periods)) = (given, periods_of(table)?) else {
        return match (given, before) {
            (Some(key), None) => Err(table.at(key, "needs the periods; give periods = [P_phi, P_psi] too")),
            (Some("mode"), Some(_)) => Err(table.at("mode", "needs the periods of that mode")),
            _ => before.map(|before| rest(table, units, *before)).transpose(),
        };
    };
    let mode = match (table.text("mode")?, before) {
        (Some(name), _) => ModeArgument::from_str(name, true)
            .map(Mode::from)
            .map_err(|_| table.at("mode", &format!("unknown mode '{name}'; write \"lam\" or \"sam\"")))?,
        (None, Some(before)) => before.mode,
        (None, None) => return Err(table.at(given, "needs a mode; give mode = \"lam\" or \"sam\"")),
    };
    let found = periods.elements(mode).map_err(|error| table.at("periods", &error.to_string()))?;
    let found = match before {
        Some(before) => {
            found.with_pole(before.pole).with_angles(before.angles).with_reversed(before.is_reversed)
        }
        None => found,
    };
    rest(table, units, found).map(Some)
}

/// A list of two times, or a text as the flag takes it.
fn periods_of(table: &Section<'_>) -> Result<Option<Periods>, Error> {
    match table.value("periods").map(|value| value.get_ref()) {
        None => Ok(None),
        Some(DeValue::String(text)) => periods(text).map(Some).map_err(|error| table.at("periods", &error)),
        Some(_) => match table.times("periods")?.as_deref() {
            Some(&[precession, rotation]) if precession > 0.0 && rotation > 0.0 => {
                Ok(Some(Periods::Both([precession, rotation])))
            }
            _ => Err(table.at("periods", "expected two times above zero, [P_phi, P_psi]")),
        },
    }
}

/// Pole, phases and side of the axis.
fn rest(table: &Section<'_>, units: Units, elements: TumblingElements) -> Result<TumblingElements, Error> {
    let angles = |key: &str, before: [f64; 2]| -> Result<[f64; 2], Error> {
        let typed = table.numbers::<2>(key)?;
        Ok(typed.map_or(before, |typed| typed.map(|angle| angle * units.angle)))
    };
    if let Some(pole) = table.numbers::<2>("pole")? {
        latitude(pole, units.angle).map_err(|error| table.at("pole", &error))?;
    }
    let reversed = match table.value("reversed").map(|value| value.get_ref()) {
        None => elements.is_reversed,
        Some(DeValue::Boolean(reversed)) => *reversed,
        Some(_) => return Err(table.at("reversed", "expected true or false")),
    };
    let (pole, phases) = (angles("pole", elements.pole)?, angles("phases", elements.angles)?);
    Ok(elements.with_pole(pole).with_angles(phases).with_reversed(reversed))
}

/// Standard deviations of the eight quantities, or their covariance; what a table leaves out is that of `before`.
#[derive(Clone, Debug)]
struct Spread {
    deviations: [f64; 8],
    covariance: Option<Covariance<8>>,
}

impl Spread {
    fn read(spread: &Section<'_>, units: Units, before: Option<&Spread>) -> Result<Spread, Error> {
        let mut found = before.cloned().unwrap_or(Spread { deviations: [0.0; 8], covariance: None });
        if let (Some(_), Some(key)) =
            (&found.covariance, SPREAD.into_iter().find(|key| spread.value(key).is_some()))
        {
            return Err(spread.at(key, "given beside the covariance of all solutions; leave one of them out"));
        }
        for (place, key) in SPREAD.into_iter().enumerate() {
            let list = if key == "periods" { spread.times(key)? } else { spread.list(key)? };
            let unit = if matches!(key, "pole" | "phases") { units.angle } else { 1.0 };
            let pair = match list.as_deref() {
                None => continue,
                Some([both]) => [*both; 2],
                Some([one, two]) => [*one, *two],
                Some(list) => {
                    let rule = format!("{} given, 1 or 2 standard deviations needed", list.len());
                    return Err(spread.at(key, &rule));
                }
            };
            for (k, deviation) in pair.into_iter().enumerate() {
                found.deviations[2 * place + k] = deviation * unit;
            }
            let refused = Covariance::independent(pair).err().map(|error| spread.at(key, &error.to_string()));
            refused.map_or(Ok(()), Err)?;
        }
        if let Some(value) = spread.value("covariance") {
            let DeValue::Table(keys) = value.get_ref() else {
                return Err(spread.at("covariance", "a table [spread.covariance] needed"));
            };
            let table = Section { file: spread.file, place: value.span().start, keys };
            table.only("[spread.covariance] of elements", &["elements"])?;
            if let Some(key) = SPREAD.into_iter().find(|key| spread.value(key).is_some()) {
                return Err(spread.at(key, "its spread is given twice; leave one of them out"));
            }
            let matrix = table.rows::<8, 8>("elements")?;
            let matrix = matrix.ok_or_else(|| spread.at("covariance", "elements missing in it"))?;
            let unit = |k: usize| if (2..6).contains(&k) { units.angle } else { 1.0 };
            found.covariance = Some(matrix_of(&table, "elements", unit, matrix)?);
        }
        Ok(found)
    }

    fn covariance(&self, spread: &Section<'_>) -> Result<Covariance<8>, Error> {
        match &self.covariance {
            Some(covariance) => Ok(covariance.clone()),
            None => Covariance::independent(self.deviations)
                .map_err(|error| spread.at("periods", &error.to_string())),
        }
    }
}

/// The population about `elements`, or about each solution of `top`.
pub(super) fn population(
    top: &Section<'_>,
    spread: &Section<'_>,
    inertia: &Inertia,
    elements: &TumblingElements,
    units: Units,
) -> Result<TumblingPopulation, Error> {
    spread.only("[spread] of elements", &[&SPREAD[..], &["covariance"]].concat())?;
    let common = Spread::read(spread, units, None)?;
    let mut weighted = Vec::new();
    for table in solutions(top)? {
        table.only("[[solution]]", &[&START[..], &["weight", "spread"]].concat())?;
        let missing = || table.at("weight", "missing; a solution needs its weight");
        let weight = table.positive("weight")?.ok_or_else(missing)?;
        let own = self::elements(&table, units, Some(elements))?.unwrap_or(*elements);
        let own_spread = match table.value("spread").map(|value| (value.span().start, value.get_ref())) {
            None => common.clone(),
            Some((place, DeValue::Table(keys))) => {
                let section = Section { file: table.file, place, keys };
                section.only("spread of [[solution]]", &SPREAD)?;
                Spread::read(&section, units, Some(&common))?
            }
            Some(_) => return Err(table.at("spread", "a table needed, as { periods = [\"1h\", \"6h\"] }")),
        };
        let covariance = own_spread.covariance(spread)?;
        let solution = TumblingSolution::new(inertia.clone(), own, covariance);
        // each for itself, so that the message has its line
        let alone = TumblingPopulation::new(vec![(1.0, solution.clone())]);
        alone.map_err(|error| table.at("periods", &error.to_string()))?;
        weighted.push((weight, solution));
    }
    if weighted.is_empty() {
        weighted.push((1.0, TumblingSolution::new(inertia.clone(), *elements, common.covariance(spread)?)));
    }
    TumblingPopulation::new(weighted).map_err(|error| top.at("solution", &error.to_string()))
}

/// The tables of `[[solution]]`.
fn solutions<'t>(top: &Section<'t>) -> Result<Vec<Section<'t>>, Error> {
    let needed = || top.at("solution", "expected tables [[solution]], each with a weight");
    let Some(value) = top.value("solution") else { return Ok(Vec::new()) };
    let DeValue::Array(items) = value.get_ref() else { return Err(needed()) };
    let table = |item: &'t toml::Spanned<DeValue<'t>>| match item.get_ref() {
        DeValue::Table(keys) => Ok(Section { file: top.file, place: item.span().start, keys }),
        _ => Err(needed()),
    };
    items.iter().map(table).collect()
}
