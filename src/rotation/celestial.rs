//! Axes of space that the sky is measured in.

use nalgebra::{UnitQuaternion, Vector3};

use crate::num::Real;

/// Obliquity of the ecliptic of J2000, arcseconds: that of the International Astronomical Union of 1976, which published elements of
/// small bodies refer to.
const OBLIQUITY: f64 = 84_381.448;

/// Axes of space that poles and attitudes of celestial bodies are published in.
///
/// ```
/// use polhode::nalgebra::Vector3;
/// use polhode::rotation::CelestialFrame;
/// let to_equator = CelestialFrame::EclipticJ2000.turn_to(CelestialFrame::Icrf);
/// let ecliptic_pole = to_equator * Vector3::z(); // right ascension 18 h, declination 66.56 degrees
/// assert!((ecliptic_pole.z.asin().to_degrees() - 66.560_71).abs() < 1e-5);
/// assert_eq!(CelestialFrame::named("ICRF"), Some(CelestialFrame::Icrf));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum CelestialFrame {
    /// Ecliptic and mean equinox of J2000: x to the equinox, z to the pole of the ecliptic.
    EclipticJ2000,
    /// The International Celestial Reference Frame, whose axes are those of the mean equator and equinox of J2000 to 0.03
    /// arcseconds, which are left out here.
    Icrf,
}

impl CelestialFrame {
    /// Its name in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            CelestialFrame::EclipticJ2000 => "ecliptic J2000",
            CelestialFrame::Icrf => "ICRF",
        }
    }

    /// The one called so: `ecliptic`, `ecliptic J2000`, `icrf`, in letters of either case.
    #[must_use]
    pub fn named(name: &str) -> Option<CelestialFrame> {
        let is = |known: &str| name.eq_ignore_ascii_case(known);
        match () {
            () if is("ecliptic") || is("ecliptic J2000") => Some(CelestialFrame::EclipticJ2000),
            () if is("icrf") => Some(CelestialFrame::Icrf),
            () => None,
        }
    }

    /// The turn that takes components in these axes to components in those of `other`: an attitude to this frame becomes one to the
    /// other when it is multiplied by it from the left.
    #[must_use]
    pub fn turn_to(self, other: CelestialFrame) -> UnitQuaternion<f64> {
        let angle = match (self, other) {
            (CelestialFrame::EclipticJ2000, CelestialFrame::Icrf) => OBLIQUITY,
            (CelestialFrame::Icrf, CelestialFrame::EclipticJ2000) => -OBLIQUITY,
            _ => 0.0,
        };
        let (sin, cos) = Real::sin_cos(0.5 * (angle / 3600.0).to_radians());
        UnitQuaternion::new_unchecked(nalgebra::Quaternion::from_parts(cos, Vector3::new(sin, 0.0, 0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pole_of_the_equator_is_seen_from_the_ecliptic() {
        let turn = CelestialFrame::Icrf.turn_to(CelestialFrame::EclipticJ2000);
        // longitude 90 degrees, latitude of the complement of the obliquity
        let pole = turn * Vector3::z();
        let expected = Vector3::new(0.0, 0.397_777_156, 0.917_482_062);
        assert!((pole - expected).norm() < 1e-9, "{pole}");
        let back = turn * CelestialFrame::EclipticJ2000.turn_to(CelestialFrame::Icrf);
        assert!(back.angle() < 1e-15);
        assert_eq!(CelestialFrame::named("equator"), None);
    }
}
