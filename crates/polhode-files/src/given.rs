//! A body as it was given, before anything is known to be right with it.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::inertia::{MassProperties, Twin};
use serde::Deserialize;

use crate::error::{Error, warn};
use crate::text::visible;

/// A body as it was given: what its file states, and where.
#[derive(Clone, Debug)]
pub struct Given {
    /// Of the link or body in a model, else empty.
    pub name: String,
    /// kg.
    pub mass: Option<f64>,
    /// In the axes of the frame.
    pub center_of_mass: Vector3<f64>,
    /// Takes the axes of the tensor to those of the frame.
    pub turn: UnitQuaternion<f64>,
    /// About the centre of mass.
    pub tensor: Matrix3<f64>,
    /// Along the axes of the tensor.
    pub extents: Option<[f64; 3]>,
    /// The link that it mirrors, in the axes of the tensor.
    pub twin: Option<Twin>,
    /// Whether the tensor was computed here, so that there is no mistake of a user's to look for.
    pub computed: bool,
    /// File and line of a link.
    pub place: Option<String>,
    /// What is wrong with a link that states no tensor that could be examined.
    pub defect: Option<String>,
    /// A frame without a body.
    pub massless: bool,
    /// What else is to be known of a tensor that was computed.
    pub remark: Option<String>,
    /// Where the tensor stands in its file.
    pub writing: Option<Writing>,
    /// Whether it is written as three moments.
    pub diagonal: bool,
}

/// The bytes of a file that hold a tensor.
#[derive(Clone, Debug)]
pub struct Writing {
    /// The file.
    pub file: Arc<Path>,
    /// Of xx, yy, zz, xy, xz, yz each.
    pub entries: [Option<Range<usize>>; 6],
    /// Of all entries, where they stand in one list.
    pub list: Option<Range<usize>>,
}

impl Given {
    /// A tensor and nothing else.
    pub fn of_tensor(tensor: Matrix3<f64>) -> Self {
        Self {
            name: String::new(),
            mass: None,
            center_of_mass: Vector3::zeros(),
            turn: UnitQuaternion::identity(),
            tensor,
            extents: None,
            twin: None,
            computed: false,
            place: None,
            defect: None,
            massless: false,
            remark: None,
            writing: None,
            diagonal: false,
        }
    }

    /// A frame without a body.
    pub fn massless() -> Self {
        Self { massless: true, mass: Some(0.0), ..Self::of_tensor(Matrix3::zeros()) }
    }

    /// A link that states no tensor that could be examined, and why.
    pub fn defective(defect: String) -> Self {
        Self { defect: Some(defect), ..Self::of_tensor(Matrix3::zeros()) }
    }

    /// With one remark more.
    pub fn add_remark(&mut self, remark: &str) {
        self.remark = Some(match self.remark.take() {
            Some(before) => format!("{before}; {remark}"),
            None => remark.into(),
        });
    }

    /// A body that is right by construction.
    pub fn body(body: MassProperties) -> Self {
        Self {
            mass: Some(body.mass()),
            center_of_mass: body.center_of_mass(),
            computed: true,
            ..Self::of_tensor(body.tensor())
        }
    }
}

/// What this command writes as JSON, as far as it says what the body is.
#[derive(Deserialize)]
struct Written {
    #[serde(default)]
    name: String,
    mass: Option<f64>,
    #[serde(default)]
    center_of_mass: [f64; 3],
    inertia: [[f64; 3]; 3],
    /// Which no form of the output has.
    #[serde(default)]
    wheels: Option<Vec<serde_json::Value>>,
    /// Of the fit that found it.
    #[serde(default)]
    warnings: Vec<String>,
}

/// From the JSON that this command writes: an object, or an array of them.
pub fn from_json(path: &Path, text: &str) -> Result<Vec<Given>, Error> {
    let written: Result<Vec<Written>, _> = if text.trim_start().starts_with('[') {
        serde_json::from_str(text)
    } else {
        serde_json::from_str(text).map(|one| vec![one])
    };
    let written = written.map_err(|error| {
        Error::Input(format!(
            "{}: {error}; needed: \"inertia\": [[3x3]], and \"mass\" and \"center_of_mass\": [3] if known",
            path.display()
        ))
    })?;
    if written.iter().any(|body| body.wheels.as_ref().is_some_and(|wheels| !wheels.is_empty())) {
        warn(&format!(
            "{}: the wheels of the body are left out of the output; copy the key \"wheels\" into it to keep them",
            visible(&path.display().to_string())
        ));
    }
    for warning in written.iter().flat_map(|body| &body.warnings) {
        let name = path.display().to_string();
        warn(&format!("{}: the fit warns: {}", visible(&name), visible(warning)));
    }
    let given = |written: Written| Given {
        name: written.name,
        mass: written.mass,
        center_of_mass: written.center_of_mass.into(),
        ..Given::of_tensor(Matrix3::from_fn(|j, k| written.inertia[j][k]))
    };
    Ok(written.into_iter().map(given).collect())
}
