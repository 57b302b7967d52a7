//! Columns that a flag names.

use super::header::Group;
use super::spellings::Quantity;
use crate::error::Rule;

/// Columns that are named by a flag: keys, and names or numbers from 1.
///
/// ```
/// use polhode_files::ColumnNames;
/// assert!(ColumnNames::parse("t=clock,wx=a,wy=b,wz=c").is_ok());
/// assert!(ColumnNames::parse("speed=a").unwrap_err().contains("no known key"));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnNames(Vec<(String, String)>);

/// Keys of the flag, by quantity; a key alone is a time or a body.
const KEYS: &[(Quantity, &[&str])] = &[
    (Quantity::Quaternion, &["qw", "qx", "qy", "qz"]),
    (Quantity::Numbered, &["q0", "q1", "q2", "q3"]),
    (Quantity::Matrix, &["r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"]),
    (Quantity::Angles, &["e1", "e2", "e3"]),
    (Quantity::Rodrigues, &["s1", "s2", "s3"]),
    (Quantity::Rates, &["wx", "wy", "wz"]),
    (Quantity::Momentum, &["lx", "ly", "lz"]),
];

/// Short forms of keys, as records of rates alone have them.
const SHORT: [(&str, &str); 3] = [("x", "wx"), ("y", "wy"), ("z", "wz")];

impl ColumnNames {
    /// Of a text `KEY=NAME,KEY=NAME,...`. A name may hold a comma: it goes on up to the next key.
    ///
    /// # Errors
    /// A key that is not known, or named twice; the text says which are known.
    pub fn parse(text: &str) -> Result<Self, String> {
        let known = |key: &str| {
            let key = SHORT.iter().find(|(short, _)| *short == key).map_or(key, |(_, key)| key);
            let named = KEYS
                .iter()
                .flat_map(|(_, keys)| keys.iter())
                .chain(&["t", "id"])
                .find(|known| **known == key);
            named.map(|key| (*key).to_string())
        };
        let mut found: Vec<(String, String)> = Vec::new();
        for part in text.split(',') {
            let keyed = part.split_once('=').and_then(|(key, name)| Some((known(key.trim())?, name)));
            match keyed {
                Some((key, _)) if found.iter().any(|(other, _)| *other == key) => {
                    return Err(format!("'{key}' is named twice"));
                }
                Some((key, name)) => found.push((key, name.trim().into())),
                None => {
                    if let Some((_, name)) = found.last_mut() {
                        *name += &format!(",{part}");
                        continue;
                    }
                    let keys: Vec<String> = KEYS.iter().map(|(_, keys)| keys.join(" ")).collect();
                    return Err(format!("'{part}' has no known key; keys: t, id, {}", keys.join(", ")));
                }
            }
        }
        Ok(Self(found))
    }

    /// Whether columns of a quantity are named, and not only those of times and bodies.
    #[must_use]
    pub fn name_quantities(&self) -> bool {
        self.0.iter().any(|(key, _)| key != "t" && key != "id")
    }

    /// The place of the column that `key` names among `cells`, if it names one.
    pub(crate) fn place(&self, key: &str, cells: &[String]) -> Result<Option<usize>, Rule> {
        let Some((_, wanted)) = self.0.iter().find(|(known, _)| known == key) else { return Ok(None) };
        // a number is that of a column, also where a cell of numbers holds the same
        if let Ok(number) = wanted.parse::<usize>()
            && (1..=cells.len()).contains(&number)
        {
            return Ok(Some(number - 1));
        }
        let exact = cells.iter().position(|cell| cell.trim() == wanted);
        let place = exact.or_else(|| cells.iter().position(|cell| cell.trim().eq_ignore_ascii_case(wanted)));
        let Some(place) = place else { return Err(Rule::Column(format!("'{wanted}'"), cells.to_vec())) };
        match cells.iter().skip(place + 1).position(|cell| *cell == cells[place]) {
            Some(second) => Err(Rule::Unique(place + 1, place + second + 2)),
            None => Ok(Some(place)),
        }
    }

    /// The groups of columns that are named.
    pub(crate) fn groups(&self, cells: &[String]) -> Result<Vec<Group>, Rule> {
        let mut groups = Vec::new();
        for (quantity, keys) in KEYS {
            let places = keys.iter().map(|key| self.place(key, cells)).collect::<Result<Vec<_>, _>>()?;
            if places.iter().all(Option::is_none) {
                continue;
            }
            let Some(places) = places.iter().copied().collect::<Option<Vec<usize>>>() else {
                let missing = keys.iter().zip(&places).find(|(_, place)| place.is_none());
                let missing = missing.map_or("", |(key, _)| key);
                return Err(Rule::Complete(format!(
                    "{} in --columns: {missing}=NAME is missing",
                    keys.join(", ")
                )));
            };
            groups.push(Group::of(*quantity, places));
        }
        Ok(groups)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_name_columns_or_their_numbers() {
        let flags = ColumnNames::parse("t=A, b,x=2,y=3,z=c").unwrap();
        let cells = ["A, b", "x", "y", "C"].map(String::from);
        assert_eq!(flags.place("t", &cells), Ok(Some(0)));
        assert_eq!(flags.groups(&cells).unwrap()[0].places, [1, 2, 3]);
        assert!(flags.name_quantities() && !ColumnNames::parse("t=1,id=2").unwrap().name_quantities());
        assert!(ColumnNames::parse("t=1,t=2").unwrap_err().contains("twice"));
        let part = ColumnNames::parse("wx=x").unwrap().groups(&cells).unwrap_err();
        assert!(part.to_string().contains("wy=NAME is missing"), "{part}");
    }
}
