//! The JSON that `polhode inertia` and `polhode fit` write.

use std::path::Path;

use nalgebra::Matrix3;
use serde_json::Value;

use super::Named;
use crate::error::{Error, warn};
use crate::read;

/// Every body of a file.
pub(super) fn tensors(flag: &str, path: &Path) -> Result<Vec<Named>, Error> {
    let text = read(path, "name a JSON file of polhode inertia or polhode fit")?;
    let refused =
        |error: &dyn std::fmt::Display| Error::Input(format!("{flag}: {}: {error}", path.display()));
    let value: Value = serde_json::from_str(&text).map_err(|error| refused(&error))?;
    let objects = match value {
        Value::Array(objects) => objects,
        object => vec![object],
    };
    let each = objects.into_iter().map(|object| {
        let name = object["name"].as_str().unwrap_or_default().to_string();
        let matrix = |key: &str| serde_json::from_value::<[[f64; 3]; 3]>(object[key].clone()).ok();
        let entries = match (matrix("inertia"), matrix("shape")) {
            (Some(entries), _) => entries,
            (None, Some(entries)) => {
                warn(&format!(
                    "{flag}: {}: the tensor is known up to a factor, and its trace is taken as 1",
                    path.display()
                ));
                entries
            }
            (None, None) => {
                return Err(refused(
                    &"no \"inertia\" and no \"shape\" of 3 x 3 numbers; give the JSON of polhode inertia or polhode fit",
                ));
            }
        };
        Ok((name, Matrix3::from_fn(|j, k| entries[j][k])))
    });
    each.collect()
}
