//! TOML files that users write: values with the line on which they stand.

use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::Error;
use crate::instant::{Epoch, seconds};
use crate::numbers::number;
use crate::text::visible;

/// A file and its text.
pub struct TomlFile<'t> {
    /// Its path, for messages.
    pub path: &'t Path,
    /// Its text.
    pub text: &'t str,
}

impl<'t> TomlFile<'t> {
    /// Its tables.
    pub fn parse(&self) -> Result<Spanned<DeTable<'t>>, Error> {
        DeTable::parse(self.text).map_err(|error| {
            let place = error.span().map_or(0, |span| span.start);
            self.error(place, error.message())
        })
    }

    /// File and line of a place in the text.
    pub fn line(&self, place: usize) -> String {
        let before = &self.text.as_bytes()[..place.min(self.text.len())];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        format!("{}:{line}", self.path.display())
    }

    /// A message with file and line.
    pub fn error(&self, place: usize, message: &str) -> Error {
        Error::Input(format!("{}: {}", self.line(place), visible(message)))
    }
}

/// The keys of one table.
pub struct Section<'t> {
    /// The file that it stands in.
    pub file: &'t TomlFile<'t>,
    /// Where it begins.
    pub place: usize,
    /// Its keys and values.
    pub keys: &'t DeTable<'t>,
}

impl<'t> Section<'t> {
    /// The value of a key.
    pub fn value(&self, key: &str) -> Option<&'t Spanned<DeValue<'t>>> {
        self.keys.get(key)
    }

    /// A text in quotes.
    ///
    /// # Errors
    /// A value of another kind.
    pub fn text(&self, key: &str) -> Result<Option<&'t str>, Error> {
        match self.value(key).map(Spanned::get_ref) {
            None => Ok(None),
            Some(DeValue::String(text)) => Ok(Some(text)),
            Some(other) => Err(self.at(key, &format!("{} given, a text in quotes needed", other.type_str()))),
        }
    }

    /// A number above zero.
    ///
    /// # Errors
    /// Another number, or a value of another kind.
    pub fn positive(&self, key: &str) -> Result<Option<f64>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let number = self.number(key, value)?;
        if number > 0.0 {
            return Ok(Some(number));
        }
        Err(self.at(key, &format!("{number:?} is not positive; give a number above zero")))
    }

    /// A time span: a number of seconds, or a text with a unit.
    pub fn seconds(&self, key: &str) -> Result<Option<f64>, Error> {
        self.moment(key, None)
    }

    /// The same for a list.
    pub fn times(&self, key: &str) -> Result<Option<Vec<f64>>, Error> {
        self.moments(key, None)
    }

    /// A time: as a span or, where t = 0 has a date, as a date in quotes; numbers are Julian dates then.
    pub fn moment(&self, key: &str, epoch: Option<Epoch>) -> Result<Option<f64>, Error> {
        self.value(key).map(|value| self.moment_of(key, value, epoch)).transpose()
    }

    /// The same for a list.
    pub fn moments(&self, key: &str, epoch: Option<Epoch>) -> Result<Option<Vec<f64>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::Array(items) => {
                items.iter().map(|item| self.moment_of(key, item, epoch)).collect::<Result<_, _>>().map(Some)
            }
            _ => Ok(Some(vec![self.moment_of(key, value, epoch)?])),
        }
    }

    fn moment_of(&self, key: &str, value: &Spanned<DeValue<'_>>, epoch: Option<Epoch>) -> Result<f64, Error> {
        let text = match (value.get_ref(), epoch) {
            (DeValue::String(text), _) => text.as_ref(),
            (DeValue::Integer(integer), _) if integer.radix() == 10 => integer.as_str(),
            (DeValue::Float(float), Some(_)) => float.as_str(),
            _ => return self.number(key, value),
        };
        seconds(text, epoch)
            .map_err(|error| self.at(key, &error.replace("by --epoch", "by epoch in [start]")))
    }

    /// A count.
    pub fn count(&self, key: &str) -> Result<Option<u64>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let parsed = match value.get_ref() {
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
            _ => None,
        };
        let refused =
            || self.at(key, "expected a whole number from 0 to 18446744073709551615, without quotes");
        parsed.map(Some).ok_or_else(refused)
    }

    /// `N` numbers in brackets.
    ///
    /// # Errors
    /// Another count, or values of another kind.
    pub fn numbers<const N: usize>(&self, key: &str) -> Result<Option<[f64; N]>, Error> {
        let Some(list) = self.list(key)? else { return Ok(None) };
        let found = list.len();
        list.try_into().map(Some).map_err(|_| self.at(key, &format!("{found} given, {N} needed")))
    }

    /// `N` lists of `M` numbers each.
    pub fn rows<const N: usize, const M: usize>(&self, key: &str) -> Result<Option<[[f64; M]; N]>, Error> {
        let needed = || self.at(key, &format!("expected {N} lists of {M} numbers, as [[...], [...]]"));
        self.lists(key, needed)?.map(|rows| rows.try_into().map_err(|_| needed())).transpose()
    }

    /// Any number of lists of two numbers each; none where the key is missing.
    pub fn pairs(&self, key: &str) -> Result<Vec<[f64; 2]>, Error> {
        let needed = || self.at(key, "expected lists of 2 numbers, as [[...], [...]]");
        Ok(self.lists(key, needed)?.unwrap_or_default())
    }

    fn lists<const M: usize>(
        &self,
        key: &str,
        needed: impl Fn() -> Error,
    ) -> Result<Option<Vec<[f64; M]>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        let DeValue::Array(rows) = value.get_ref() else { return Err(needed()) };
        let row = |row: &Spanned<DeValue<'_>>| -> Result<[f64; M], Error> {
            let DeValue::Array(items) = row.get_ref() else { return Err(needed()) };
            let numbers: Vec<f64> =
                items.iter().map(|item| self.number(key, item)).collect::<Result<_, _>>()?;
            numbers.try_into().map_err(|_| needed())
        };
        rows.iter().map(row).collect::<Result<_, _>>().map(Some)
    }

    /// Several numbers in brackets, or one without.
    pub fn list(&self, key: &str) -> Result<Option<Vec<f64>>, Error> {
        let Some(value) = self.value(key) else { return Ok(None) };
        match value.get_ref() {
            DeValue::Array(items) => {
                items.iter().map(|item| self.number(key, item)).collect::<Result<_, _>>().map(Some)
            }
            _ => Ok(Some(vec![self.number(key, value)?])),
        }
    }

    fn number(&self, key: &str, value: &Spanned<DeValue<'_>>) -> Result<f64, Error> {
        let text = match value.get_ref() {
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
            DeValue::Float(float) => float.as_str(),
            other => return Err(self.at(key, &format!("{} given, a number needed", other.type_str()))),
        };
        number(text).map_err(|error| self.at(key, &error))
    }

    /// Where a key stands, or the table.
    pub fn place_of(&self, key: &str) -> usize {
        let found = self.keys.iter().find(|(found, _)| found.get_ref() == key);
        found.map_or(self.place, |(found, _)| found.span().start)
    }

    /// A message about a key, with file and line.
    pub fn at(&self, key: &str, message: &str) -> Error {
        self.file.error(self.place_of(key), &format!("key '{key}': {message}"))
    }

    /// The first key that is not `known`, with the nearest one that is, is refused.
    pub fn only(&self, name: &str, known: &[&str]) -> Result<(), Error> {
        match self.keys.keys().find(|key| !known.contains(&key.get_ref().as_ref())) {
            Some(key) => Err(Error::unknown_name(
                &self.file.line(key.span().start),
                &format!("key in {name}"),
                key.get_ref(),
                known.iter().copied(),
            )),
            None => Ok(()),
        }
    }
}
