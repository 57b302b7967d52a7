//! Which column, and with which sign, is the rate about each axis.

use core::fmt;

/// A permutation of three columns with signs: `x,-y,z` reverses the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedAxes {
    /// For each axis the column that it takes, from 0.
    columns: [usize; 3],
    /// And its sign.
    signs: [f64; 3],
}

impl fmt::Display for SignedAxes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = |k: usize| {
            let sign = if self.signs[k] < 0.0 { "-" } else { "" };
            format!("{sign}{}", ["x", "y", "z"][self.columns[k]])
        };
        f.write_str(&[0, 1, 2].map(named).join(", "))
    }
}

impl SignedAxes {
    /// Three of x, y and z, each once, with a sign before those that are reversed.
    ///
    /// ```
    /// use polhode_files::SignedAxes;
    /// let axes = SignedAxes::parse("y,-x,z")?;
    /// assert_eq!(axes.apply([1.0, 2.0, 3.0]), [2.0, -1.0, 3.0]);
    /// assert!(!axes.is_mirror() && SignedAxes::parse("x,-y,z")?.is_mirror());
    /// assert!(SignedAxes::parse("x,x,z").is_err());
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// Another number of axes, other names, an axis that is named twice.
    pub fn parse(text: &str) -> Result<Self, String> {
        let rule = "give x, y and z, each once, with a sign before those that are reversed, such as x,-y,z";
        let names: Vec<&str> = text.split(',').map(str::trim).collect();
        let [a, b, c] = names[..] else { return Err(format!("'{text}' has {} axes; {rule}", names.len())) };
        let (mut columns, mut signs) = ([0; 3], [1.0; 3]);
        for (k, name) in [a, b, c].into_iter().enumerate() {
            let (sign, letter) = match name.strip_prefix('-') {
                Some(letter) => (-1.0, letter),
                None => (1.0, name.strip_prefix('+').unwrap_or(name)),
            };
            let place = ["x", "y", "z"].into_iter().position(|axis| axis == letter);
            columns[k] = place.ok_or(format!("'{name}' is not an axis; {rule}"))?;
            signs[k] = sign;
        }
        match (0..3).all(|axis| columns.contains(&axis)) {
            true => Ok(SignedAxes { columns, signs }),
            false => Err(format!("'{text}' names an axis twice; {rule}")),
        }
    }

    /// The rates about the axes, of the numbers in the columns.
    pub fn apply(&self, read: [f64; 3]) -> [f64; 3] {
        core::array::from_fn(|k| self.signs[k] * read[self.columns[k]])
    }

    /// Whether it takes left-handed axes to right-handed ones, and no turn does.
    pub fn is_mirror(&self) -> bool {
        let [a, b, c] = self.columns;
        let is_even = (b + 3 - a) % 3 == 1 && (c + 3 - b) % 3 == 1;
        let sign: f64 = self.signs.iter().product();
        (sign > 0.0) != is_even
    }
}
