//! The JSON that `polhode inertia` and `polhode fit` write.

use std::path::Path;

use nalgebra::Matrix3;
use serde_json::Value;

use super::Named;
use crate::error::Error;
use crate::read;
use crate::text::visible;
use crate::wheel;

/// The bodies of a joint fit of carrier and object.
const JOINT: [&str; 3] = ["carrier", "object", "object_itself"];

/// Every body of a file.
pub(super) fn tensors(flag: &str, path: &Path) -> Result<Vec<Named>, Error> {
    let text = read(path, "name a JSON file of polhode inertia or polhode fit")?;
    let refused =
        |error: &dyn std::fmt::Display| Error::Input(format!("{flag}: {}: {error}", path.display()));
    let value: Value = serde_json::from_str(&text).map_err(|error| refused(&error))?;
    let is_joint = value.get("carrier").is_some_and(Value::is_object);
    let of_all = if is_joint { of_joint(&value) } else { Ok(Vec::new()) };
    let of_all = of_all.map_err(|error| refused(&error))?;
    let named = |object: Value| (object["name"].as_str().unwrap_or_default().to_string(), object);
    let objects: Vec<(String, Value)> = match value {
        Value::Array(objects) => objects.into_iter().map(named).collect(),
        Value::Object(mut joint) if is_joint => {
            let own = |name: &str| Some((name.to_string(), joint.remove(name).filter(Value::is_object)?));
            JOINT.into_iter().filter_map(own).collect()
        }
        object => vec![named(object)],
    };
    let each = objects.into_iter().map(|(name, object)| {
        let matrix = |key: &str| serde_json::from_value::<[[f64; 3]; 3]>(object[key].clone()).ok();
        if !object["inertia"].is_null() && matrix("inertia").is_none() {
            return Err(refused(&"\"inertia\" is not an array of 3 x 3 numbers"));
        }
        let mut remarks: Vec<String> = Vec::new();
        let entries = match (matrix("inertia"), matrix("shape")) {
            (Some(entries), _) => entries,
            (None, Some(entries)) => {
                remarks.push("the tensor is known up to a factor, and its trace is taken as 1".into());
                entries
            }
            (None, None) => {
                return Err(refused(
                    &"no \"inertia\" and no \"shape\" of 3 x 3 numbers; give the JSON of polhode inertia or polhode fit",
                ));
            }
        };
        let wheels = match &object["wheels"] {
            Value::Null => Ok(Vec::new()),
            Value::Array(wheels) => wheels.iter().map(wheel::of_json).collect(),
            _ => Err("\"wheels\" is not a list".into()),
        };
        let wheels = wheels.map_err(|error| refused(&error))?;
        let own = warnings(&object).map_err(|error| refused(&error))?;
        if object["verdict"] == "suspicious" {
            let trouble = object["trouble"].as_str().unwrap_or("as polhode inertia says");
            remarks.push(super::doubt(trouble, object["cause"].as_str()));
        }
        remarks.extend(of_all.iter().chain(&own).map(|warning| format!("the fit warns: {warning}")));
        Ok((name, Matrix3::from_fn(|j, k| entries[j][k]), wheels, remarks))
    });
    each.collect()
}

/// What a fit wrote of the limits of its answer.
fn warnings(of: &Value) -> Result<Vec<String>, &'static str> {
    const RULE: &str = "\"warnings\" is not a list of texts";
    let text = |warning: &Value| warning.as_str().map(|text| visible(text).into_owned()).ok_or(RULE);
    match &of["warnings"] {
        Value::Null => Ok(Vec::new()),
        Value::Array(all) => all.iter().map(text).collect(),
        _ => Err(RULE),
    }
}

/// The same of a joint fit: of each record, and of all together.
fn of_joint(fit: &Value) -> Result<Vec<String>, &'static str> {
    let mut all = Vec::new();
    for record in fit["records"].as_array().into_iter().flatten() {
        let attached = visible(record["attached"].as_str().unwrap_or("a record"));
        all.extend(warnings(record)?.iter().map(|warning| format!("{attached}: {warning}")));
    }
    all.extend(warnings(fit)?);
    Ok(all)
}
