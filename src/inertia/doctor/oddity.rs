//! Tensors that are possible, and yet of no body that anybody built.

use core::fmt;

use nalgebra::Matrix3;

use super::{Evidence, second_moments};
use crate::inertia::symmetric::Spectrum;
use crate::num::Shown;

/// Osmium at 20 °C, kg/m³, the densest matter there is on Earth.
const OSMIUM: f64 = 22_590.0;
/// A twelfth of the density of air, kg/m³: below it is no foam and no frame.
const LIGHTEST: f64 = 0.1;
/// Least share of the smallest second moment in the largest of a body with a volume to speak of.
const FLAT: f64 = 1e-4;
/// Bodies lighter than this, kg, are clusters of atoms, whose density is not that of matter.
const CLUSTER: f64 = 1e-12;

/// What is odd about a tensor, though no law is broken by it or none alone explains it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Oddity {
    /// Every one of the six entries has the same value.
    AllAlike {
        /// The value, kg m².
        entry: f64,
    },
    /// The three moments are the same power of ten, without products.
    PowerOfTen {
        /// The value, kg m².
        moment: f64,
    },
    /// The moments are those of a box with edges of 1 m.
    UnitBox,
    /// The matter would be denser than any.
    Dense {
        /// Mean density of the ellipsoid of these moments, the smallest body that has them, kg/m³.
        density: f64,
    },
    /// The matter would be lighter than any.
    Light {
        /// Mean density of the ellipsoid of these moments, kg/m³.
        density: f64,
    },
}

impl Oddity {
    /// Whether somebody wrote down a number instead of a measurement, so that there is no mistake to undo.
    #[must_use]
    pub fn is_placeholder(&self) -> bool {
        matches!(self, Oddity::AllAlike { .. } | Oddity::PowerOfTen { .. } | Oddity::UnitBox)
    }
}

impl fmt::Display for Oddity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Oddity::AllAlike { entry } => {
                write!(f, "placeholder: all six entries are {}", Shown(entry))
            }
            Oddity::PowerOfTen { moment } => {
                write!(f, "placeholder: all three moments are {}", Shown(moment))
            }
            Oddity::UnitBox => write!(f, "placeholder: the moments of a box with edges of 1 m"),
            Oddity::Dense { density } => write!(
                f,
                "implausible density: even an ellipsoid of these moments has {density:.3e} kg/m^3, osmium has {OSMIUM}"
            ),
            Oddity::Light { density } => write!(
                f,
                "implausible density: an ellipsoid of these moments has {density:.3e} kg/m^3, air has 1.2"
            ),
        }
    }
}

/// What is odd about `tensor`, if anything; of a body without a known mass only that all entries are alike.
pub(super) fn oddity(tensor: &Matrix3<f64>, evidence: &Evidence) -> Option<Oddity> {
    let [xx, yy, zz] = [0, 1, 2].map(|k| tensor[(k, k)]);
    let products = [(0, 1), (0, 2), (1, 2)].map(|place| tensor[place]);
    let alike = xx == yy && yy == zz;
    if alike && xx != 0.0 && products.iter().all(|product| *product == xx) {
        return Some(Oddity::AllAlike { entry: xx });
    }
    let mass = evidence.mass.filter(|mass| *mass > CLUSTER)?;
    if alike && products == [0.0; 3] && format!("{xx:e}").starts_with("1e") {
        return Some(Oddity::PowerOfTen { moment: xx });
    }
    let unit = mass / 6.0;
    if [xx, yy, zz].iter().all(|moment| (moment / unit - 1.0).abs() < 5e-3) && products == [0.0; 3] {
        return Some(Oddity::UnitBox);
    }
    if evidence.extents.is_some() {
        return None; // they say more of the size than the density does
    }
    let spectrum = Spectrum::of_finite(tensor);
    let second = second_moments(&spectrum);
    if second[2] <= FLAT * second[0] {
        return None;
    }
    // of all bodies with these second moments and a greatest density the ellipsoid is the smallest: J = M a²/5
    let axes = second.map(|j| (5.0 * j * (spectrum.scale / mass)).sqrt());
    let density = mass / (4.0 / 3.0 * core::f64::consts::PI * axes[0] * axes[1] * axes[2]);
    if density > OSMIUM {
        Some(Oddity::Dense { density })
    } else if density < LIGHTEST {
        Some(Oddity::Light { density })
    } else {
        None
    }
}
