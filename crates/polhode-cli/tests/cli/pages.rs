//! Pages in which a body turns, as a test reads them.

use std::fs;
use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde_json::Value;

/// A page and the scene in it.
pub(crate) struct Page {
    pub(crate) text: String,
    pub(crate) scene: Value,
}

/// A track of a scene.
pub(crate) struct Track {
    pub(crate) name: String,
    /// s.
    pub(crate) times: Vec<f64>,
    pub(crate) attitudes: Vec<UnitQuaternion<f64>>,
    /// rad/s.
    pub(crate) omegas: Vec<Vector3<f64>>,
    /// rad.
    pub(crate) angles: Vec<f64>,
    pub(crate) energy_changes: Vec<f64>,
    pub(crate) written: Value,
}

impl Page {
    /// The page of a file, which is whole, needs no network and holds no number that is none.
    pub(crate) fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        assert!(text.starts_with("<!DOCTYPE html>") && text.ends_with("</html>\n"));
        for absent in ["http:", "https:", "src=", "href=", "@import", "fetch(", "{{"] {
            assert!(!text.contains(absent), "{absent}");
        }
        for tag in ["script", "div", "table", "form", "style", "label", "button", "p", "h1"] {
            let [open, close] =
                [format!("<{tag}"), format!("</{tag}>")].map(|part| text.matches(&part).count());
            assert!(open >= close && close > 0, "{tag}: {open} opened, {close} closed");
        }
        let (_, rest) = text.split_once("id=\"scene\">").unwrap();
        let scene = serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap();
        check_numbers(&scene, "scene");
        Page { text, scene }
    }

    pub(crate) fn body(&self) -> Track {
        Track::of(&self.scene["body"])
    }

    pub(crate) fn rival(&self, k: usize) -> Track {
        Track::of(&self.scene["rivals"][k])
    }

    /// What stands below the picture.
    pub(crate) fn notes(&self) -> &str {
        self.text.split_once("<div id=\"notes\">").unwrap().1.split_once("</div>").unwrap().0
    }

    /// Vertices of the shape, whose radius is 1, and triangles.
    pub(crate) fn shape(&self) -> (Vec<Vector3<f64>>, usize) {
        let shape = &self.scene["shape"];
        let vertices = shares(&shape["vertices"]);
        let vertices = vertices.chunks(3).map(Vector3::from_column_slice).collect();
        (vertices, bytes(&shape["tints"]).len())
    }
}

impl Track {
    fn of(written: &Value) -> Self {
        let unit = written["omega_unit"].as_f64().unwrap();
        let singles = |value: &Value| -> Vec<f64> {
            bytes(value)
                .chunks(4)
                .map(|four| f64::from(f32::from_le_bytes(four.try_into().unwrap())))
                .collect()
        };
        let times = &written["times"];
        let times = if let Some(count) = times["count"].as_u64() {
            let [first, last] = ["first", "last"].map(|name| times[name].as_f64().unwrap());
            let share = |k: u64| k as f64 / (count.max(2) - 1) as f64;
            (0..count).map(|k| first + (last - first) * share(k)).collect()
        } else {
            let listed = bytes(&times["listed"]);
            listed.chunks(8).map(|eight| f64::from_le_bytes(eight.try_into().unwrap())).collect()
        };
        let attitude = |q: &[f64]| UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3]));
        let found = Track {
            name: written["name"].as_str().unwrap().to_owned(),
            times,
            attitudes: shares(&written["attitudes"]).chunks(4).map(attitude).collect(),
            omegas: shares(&written["omegas"])
                .chunks(3)
                .map(|w| Vector3::from_column_slice(w) * unit)
                .collect(),
            angles: singles(&written["angles"]),
            energy_changes: singles(&written["energy_changes"]),
            written: written.clone(),
        };
        assert_eq!(found.times.len(), found.attitudes.len());
        let lists = [&found.times, &found.angles, &found.energy_changes];
        assert!(lists.into_iter().flatten().all(|x| x.is_finite()), "{}", found.name);
        assert!(found.times.is_sorted(), "{}", found.name);
        found
    }

    pub(crate) fn flips(&self) -> Option<u64> {
        self.written["flips"]["count"].as_u64()
    }
}

/// What is no number is written as null, which stands only where something is not there.
fn check_numbers(value: &Value, name: &str) {
    match value {
        Value::Null => assert!(["flips", "ending", "shape", "ellipsoid"].contains(&name), "{name}"),
        Value::Array(list) => list.iter().for_each(|item| check_numbers(item, "item")),
        Value::Object(keys) => keys.iter().for_each(|(name, value)| check_numbers(value, name)),
        _ => {}
    }
}

fn shares(value: &Value) -> Vec<f64> {
    let share = |two: &[u8]| f64::from(i16::from_le_bytes(two.try_into().unwrap())) / 32767.0;
    bytes(value).chunks(2).map(share).collect()
}

/// Of base 64.
fn bytes(value: &Value) -> Vec<u8> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let mut found = Vec::new();
    for four in value.as_str().unwrap().as_bytes().chunks(4) {
        let kept = four.iter().filter(|c| **c != b'=').count() - 1;
        let bits =
            four.iter().fold(0_u32, |bits, c| bits << 6 | if *c == b'=' { 0 } else { u32::from(digit(*c)) });
        found.extend(&bits.to_be_bytes()[1..=kept]);
    }
    found
}
