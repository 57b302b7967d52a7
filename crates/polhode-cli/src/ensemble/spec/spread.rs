//! How members are spread: standard deviations, covariances or ranges.

use std::path::{Path, PathBuf};

use polhode::body::{AttitudeSpread, Population, Tensors};
use polhode::inertia::Inertia;
use polhode::num::{Covariance, Distribution};
use polhode_files::error::Error;
use polhode_files::toml_file::Section;
use toml::Spanned;
use toml::de::DeValue;

use super::elements;
use super::nominal::{Nominal, Units};

const KEYS: [&str; 6] = ["omega", "attitude", "moments", "covariance", "range", "members_file"];

/// The file that lists the members, if they are not drawn.
pub(super) fn members_file(spread: &Section<'_>) -> Result<Option<PathBuf>, Error> {
    spread.only("[spread]", &[&KEYS[..], &elements::SPREAD].concat())?;
    let Some(name) = spread.text("members_file")? else { return Ok(None) };
    if let Some(other) = spread.keys.keys().map(Spanned::get_ref).find(|key| key.as_ref() != "members_file") {
        return Err(
            spread.at(other, "given beside members_file, which lists the members; leave one of them out")
        );
    }
    Ok(Some(spread.file.path.parent().unwrap_or(Path::new("")).join(name)))
}

/// The table of that name in `[spread]`.
fn table<'t>(spread: &Section<'t>, name: &str) -> Result<Option<Section<'t>>, Error> {
    match spread.value(name) {
        None => Ok(None),
        Some(value) => match value.get_ref() {
            DeValue::Table(keys) => Ok(Some(Section { file: spread.file, place: value.span().start, keys })),
            other => {
                let needed = format!("{} given, a table [spread.{name}] needed", other.type_str());
                Err(spread.at(name, &needed))
            }
        },
    }
}

/// What `[spread]` says of a nominal body and start.
pub(super) fn population(spread: &Section<'_>, nominal: &Nominal) -> Result<Population, Error> {
    let (Some(inertia), Some(omega)) = (nominal.inertia.clone(), nominal.omega) else {
        return Err(spread.at("members_file", "missing; without it give [body] and [start]"));
    };
    if let Some(key) = elements::SPREAD.into_iter().find(|key| spread.value(key).is_some()) {
        return Err(spread.at(key, "needs periods and mode in [start]"));
    }
    let covariance = table(spread, "covariance")?;
    let range = table(spread, "range")?;
    if let Some(covariance) = &covariance {
        covariance.only("[spread.covariance]", &["omega", "attitude", "inertia", "joint"])?;
    }
    if let Some(range) = &range {
        range.only("[spread.range]", &["omega", "attitude", "moments"])?;
    }
    if let Some(covariance) = &covariance
        && let Some(matrix) = covariance.rows::<12, 12>("joint")?
    {
        let others = spread.keys.len() + covariance.keys.len();
        if others > 2 {
            return Err(
                covariance.at("joint", "contains the whole spread; leave the other keys of [spread] out")
            );
        }
        let Units { rate, angle } = nominal.units;
        let unit = |k: usize| {
            if k < 3 {
                angle
            } else if k < 6 {
                rate
            } else {
                1.0
            }
        };
        let covariance = Box::new(matrix_of(covariance, "joint", unit, matrix)?);
        return Ok(Population::Joint { attitude: nominal.attitude, omega_body: omega, inertia, covariance });
    }
    let sources = Sources { spread, covariance, range, units: nominal.units };
    let omega_body = sources.vector("omega", omega.0)?.unwrap_or(Distribution::Fixed(omega.0));
    Ok(Population::Independent {
        attitude: sources.attitude(nominal)?,
        omega_body,
        inertia: Box::new(sources.inertia(nominal, inertia)?),
    })
}

/// The three places where a quantity's spread may stand.
struct Sources<'t> {
    spread: &'t Section<'t>,
    covariance: Option<Section<'t>>,
    range: Option<Section<'t>>,
    units: Units,
}

impl Sources<'_> {
    /// Refuses a quantity whose spread is said twice.
    fn once(&self, names: [&str; 3]) -> Result<(), Error> {
        let [plain, covariance, range] = names;
        let tables = [
            (Some(self.spread), plain),
            (self.covariance.as_ref(), covariance),
            (self.range.as_ref(), range),
        ];
        let mut said = tables
            .into_iter()
            .filter_map(|(table, key)| table.filter(|table| table.value(key).is_some()).zip(Some(key)));
        match (said.next(), said.next()) {
            (Some(_), Some((table, key))) => {
                Err(table.at(key, "its spread is given twice; leave one of them out"))
            }
            _ => Ok(()),
        }
    }

    /// The unit of a quantity.
    fn unit(&self, key: &str) -> f64 {
        match key {
            "omega" => self.units.rate,
            "attitude" => self.units.angle,
            _ => 1.0,
        }
    }

    /// Standard deviations of three components, a covariance, or ranges.
    fn vector(&self, key: &str, mean: [f64; 3]) -> Result<Option<Distribution<3>>, Error> {
        self.once([key; 3])?;
        if let Some(list) = self.spread.list(key)? {
            let deviations = match list[..] {
                [all] => [all; 3],
                [x, y, z] => [x, y, z],
                _ => {
                    return Err(self
                        .spread
                        .at(key, &format!("{} given, 1 or 3 standard deviations needed", list.len())));
                }
            };
            let covariance = Covariance::independent(deviations.map(|x| x * self.unit(key)));
            let covariance = covariance.map_err(|error| self.spread.at(key, &error.to_string()))?;
            return Ok(Some(Distribution::Normal { mean, covariance }));
        }
        if let Some(covariance) = &self.covariance
            && let Some(matrix) = covariance.rows::<3, 3>(key)?
        {
            let covariance = matrix_of(covariance, key, |_| self.unit(key), matrix)?;
            return Ok(Some(Distribution::Normal { mean, covariance }));
        }
        self.range(key)
    }

    fn range(&self, key: &str) -> Result<Option<Distribution<3>>, Error> {
        let Some(range) = &self.range else { return Ok(None) };
        let Some(ranges) = range.rows::<3, 2>(key)? else { return Ok(None) };
        let ranges = ranges.map(|range| range.map(|x| x * self.unit(key)));
        Distribution::uniform(ranges).map(Some).map_err(|error| range.at(key, &error.to_string()))
    }

    fn attitude(&self, nominal: &Nominal) -> Result<AttitudeSpread, Error> {
        if let Some(range) = &self.range
            && let Some(DeValue::String(name)) = range.value("attitude").map(Spanned::get_ref)
        {
            self.once(["attitude"; 3])?;
            return match name.as_ref() {
                "all" => Ok(AttitudeSpread::Uniform),
                _ => Err(range
                    .at("attitude", "expected \"all\", or [[low, high], ...] of the rotation vector in rad")),
            };
        }
        let turn = self.vector("attitude", [0.0; 3])?;
        let mean = nominal.attitude;
        Ok(turn.map_or(AttitudeSpread::Fixed(mean), |turn| AttitudeSpread::Near { mean, turn }))
    }

    fn inertia(&self, nominal: &Nominal, inertia: Inertia) -> Result<Tensors, Error> {
        self.once(["moments", "inertia", "moments"])?;
        if let Some(list) = self.spread.list("moments")? {
            let relative = match list[..] {
                [all] => [all; 3],
                [a, b, c] => [a, b, c],
                _ => {
                    let message = format!("{} given, 1 or 3 relative standard deviations needed", list.len());
                    return Err(self.spread.at("moments", &message));
                }
            };
            let tensors = Tensors::moments(inertia, relative);
            return tensors.map_err(|error| self.spread.at("moments", &error.to_string()));
        }
        if let Some(covariance) = &self.covariance
            && let Some(matrix) = covariance.rows::<6, 6>("inertia")?
        {
            let t = inertia.tensor();
            let mean = [t[(0, 0)], t[(1, 1)], t[(2, 2)], t[(0, 1)], t[(0, 2)], t[(1, 2)]];
            let covariance = matrix_of(covariance, "inertia", |_| 1.0, matrix)?;
            return Ok(Tensors::Entries(Distribution::Normal { mean, covariance }));
        }
        let axes = nominal.inertia.clone().unwrap_or(inertia);
        Ok(match self.range("moments")? {
            Some(moments) => Tensors::Moments { axes, moments },
            None => Tensors::Fixed(axes),
        })
    }
}

/// The covariance of numbers that are typed in the units `unit`.
pub(super) fn matrix_of<const N: usize>(
    table: &Section<'_>,
    key: &str,
    unit: impl Fn(usize) -> f64,
    mut matrix: [[f64; N]; N],
) -> Result<Covariance<N>, Error> {
    for (j, row) in matrix.iter_mut().enumerate() {
        for (k, entry) in row.iter_mut().enumerate() {
            *entry *= unit(j) * unit(k);
        }
    }
    Covariance::new(matrix).map_err(|error| table.at(key, &format!("the covariance {error}")))
}
