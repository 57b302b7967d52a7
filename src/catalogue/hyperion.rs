//! Hyperion at the four flybys that saw it turn.

use nalgebra::Vector3;

use super::{Entry, NamedOrbit, Orientation, RATIO, by_middle_short_long};
use crate::body::Orbit;

/// Once round Saturn, d: as published programs have it.
const PERIOD: f64 = 21.276_609;

/// About the long, the middle and the short axis, over M R²: as a public program of the rotation of Hyperion has them, beside the spin of
/// 2005-09-25 of Harbison, Thomas and Nicholson (2011).
const MOMENTS: [f64; 3] = [0.314, 0.474, 0.542];
const MOMENTS_SOURCE: &str = "moments over M R^2 as quoted in a public program of Hyperion's rotation, which takes its start from Harbison, Thomas and Nicholson, Celest. Mech. Dyn. Astr. 110 (2011) 1";

const SPIN_SOURCE: &str = "Black, Nicholson and Thomas (1995) and Harbison, Thomas and Nicholson (2011) in table 1 of Goldberg et al., Astron. Astrophys. 692 (2024) A9, before its correction of the axes: three digits, no deviations. Its angles turn space to the body, and its axes A, B, C are the middle, the short and the long one; so read they give the angles 2.989, 1.685, 1.641 that the program above quotes for 2005-09-25, to the digits of both. x to the periapsis and z along the normal of the orbit are our reading; the hour is not printed, the mean anomaly is";
const ORBIT_SOURCE: &str = "eccentricity and mean anomaly of the same table; period 21.276609 d";

/// z along the normal of the orbit and x to the periapsis: what the angles of the table are counted from is not said in it.
const FRAME: &str = "orbit of Hyperion";

/// A row of the table.
struct Flyby {
    name: &'static str,
    summary: &'static str,
    date: &'static str,
    eccentricity: f64,
    /// Mean anomaly, rad.
    anomaly: f64,
    /// θ, φ, ψ, z-x-z, rad, from space to A, B, C, the middle, the short and the long axis.
    angles: [f64; 3],
    /// Direction of the angular velocity, about A, B, C.
    direction: [f64; 3],
    /// |ω| over the mean motion.
    rate: f64,
}

const FLYBYS: [Flyby; 4] = [
    Flyby {
        name: "hyperion",
        summary: "moon of Saturn, as Cassini saw it last in 2005; turned by Saturn; ratios of moments",
        date: "2005-09-25",
        eccentricity: 0.113,
        anomaly: 5.288,
        angles: [5.734, 0.134, 0.705],
        direction: [0.133, 0.411, 0.902],
        rate: 4.255,
    },
    Flyby {
        name: "hyperion-2005-08",
        summary: "the same, at the second flyby of Cassini",
        date: "2005-08-16",
        eccentricity: 0.115,
        anomaly: 5.969,
        angles: [0.559, 0.661, 0.587],
        direction: [0.162, 0.389, 0.907],
        rate: 4.255,
    },
    Flyby {
        name: "hyperion-2005-06",
        summary: "the same, at the first flyby of Cassini",
        date: "2005-06-10",
        eccentricity: 0.115,
        anomaly: 5.149,
        angles: [1.713, 1.148, 1.508],
        direction: [0.067, 0.451, 0.890],
        rate: 4.433,
    },
    Flyby {
        name: "hyperion-1981",
        summary: "the same, at the flyby of Voyager 2",
        date: "1981-08-23",
        eccentricity: 0.124,
        anomaly: 0.349,
        angles: [5.676, 0.965, 3.448],
        direction: [0.211, -0.019, 0.977],
        rate: 4.225,
    },
];

/// Of the orbit, rad/s.
fn mean_motion() -> f64 {
    core::f64::consts::TAU / (PERIOD * 86_400.0)
}

pub(super) fn entries() -> impl Iterator<Item = Entry> {
    FLYBYS.into_iter().map(|flyby| {
        // three digits of a direction are no unit vector
        let direction = Vector3::from(flyby.direction).normalize() * (flyby.rate * mean_motion());
        let [across, up, along] = direction.into();
        let [theta, phi, psi] = flyby.angles;
        Entry {
            name: flyby.name,
            summary: flyby.summary,
            source: MOMENTS_SOURCE,
            unit: RATIO,
            moments: Ok(MOMENTS),
            omega_body: [along, across, up],
            attitude: Some((
                by_middle_short_long([-psi, -phi, -theta]),
                Orientation { frame: FRAME, epoch: Some(flyby.date), source: SPIN_SOURCE },
            )),
        }
    })
}

/// The orbit of the body called `name`, if it is one of these.
pub(super) fn orbit(name: &str) -> Option<NamedOrbit> {
    let Flyby { eccentricity, anomaly, .. } = FLYBYS.into_iter().find(|flyby| flyby.name == name)?;
    let mean_motion = mean_motion();
    let orbit = Orbit::ellipse(mean_motion, eccentricity).and_then(|o| o.passing_at(-anomaly / mean_motion));
    let (primary, source) = ("Saturn", ORBIT_SOURCE);
    Some(NamedOrbit { primary, mean_motion, eccentricity, mean_anomaly: anomaly, source, orbit: orbit.ok()? })
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::super::body;
    use super::super::tests::{attitude_of, motion_of};
    use super::FLYBYS;
    use crate::flow::Mode;
    use crate::rotation::EulerSequence;

    const NAMES: [&str; 4] = ["hyperion", "hyperion-2005-08", "hyperion-2005-06", "hyperion-1981"];

    /// The other print of the last flyby: Euler angles z-x-z of the long, the middle and the short axis, 72 degrees a day about
    /// (0.902, 0.133, 0.411), each to its last digit.
    #[test]
    fn two_prints_of_one_flyby_agree() {
        let named = body("hyperion").unwrap();
        let other = EulerSequence::default().attitude([2.989, 1.685, 1.641]);
        let apart = attitude_of(&named).angle_to(&other);
        assert!(apart < 1e-3, "{apart}");
        let omega = Vector3::from(named.omega_body);
        let per_day = omega.norm().to_degrees() * 86_400.0;
        assert!((per_day - 72.0).abs() < 0.05, "{per_day}");
        assert!((omega.normalize() - Vector3::new(0.902, 0.133, 0.411)).amax() < 1e-3);
    }

    #[test]
    fn rates_are_those_of_the_table() {
        for flyby in FLYBYS {
            let named = body(flyby.name).unwrap();
            let rate = Vector3::from(named.omega_body).norm() / named.orbit.unwrap().mean_motion;
            assert!((rate / flyby.rate - 1.0).abs() < 1e-14, "{}: {rate}", flyby.name);
        }
    }

    /// Harbison and others (2011): in 2005 4.2 to 4.5 times the rate of the orbit, about an axis some 30 degrees off the long one, which
    /// goes round in the body in some 16 days.
    #[test]
    fn the_flybys_of_cassini_are_as_their_abstract_says() {
        for name in &NAMES[..3] {
            let named = body(name).unwrap();
            let omega = Vector3::from(named.omega_body);
            let rate = omega.norm() / named.orbit.as_ref().unwrap().mean_motion;
            assert!(rate > 4.2 && rate < 4.5, "{name}: {rate}");
            let off = libm::acos(omega.x / omega.norm()).to_degrees();
            assert!(off > 24.0 && off < 36.0, "{name}: {off}");
            let elements = motion_of(&named).tumbling().unwrap();
            assert_eq!(elements.mode, Mode::LongAxis);
            let days = elements.rotation_period / 86_400.0;
            assert!((days - 16.0).abs() < 1.0, "{name}: {days}");
        }
    }

    /// The mean anomalies of the table are those of its dates, as far as dates without an hour tell: within half a day and what Titan
    /// does to the orbit meanwhile.
    #[test]
    fn the_table_keeps_its_own_calendar() {
        let anomaly = |name| body(name).unwrap().orbit.unwrap();
        for (first, second, days) in
            [("hyperion-2005-06", "hyperion-2005-08", 67.0), ("hyperion-2005-08", "hyperion", 40.0)]
        {
            let (first, second) = (anomaly(first), anomaly(second));
            let gone = first.mean_motion * days * 86_400.0;
            let off = (second.mean_anomaly - first.mean_anomaly - gone).rem_euclid(core::f64::consts::TAU);
            let off = off.min(core::f64::consts::TAU - off) / (first.mean_motion * 86_400.0);
            assert!(off < 0.6, "{off} d");
        }
    }

    /// Its potential is that of the place that the table says, 3/2 n² (a/r)³ r̂·I r̂ by Kepler's equation.
    #[test]
    fn saturn_pulls_from_where_the_anomaly_says() {
        for name in NAMES {
            let named = body(name).unwrap();
            let orbit = named.orbit.clone().unwrap();
            let (e, mut eccentric) = (orbit.eccentricity, orbit.mean_anomaly);
            for _ in 0..60 {
                eccentric = orbit.mean_anomaly + e * libm::sin(eccentric);
            }
            let (sin, cos) = libm::sincos(eccentric);
            let near = 1.0 / (1.0 - e * cos);
            let place = Vector3::new(cos - e, (1.0 - e * e).sqrt() * sin, 0.0) * near;
            let tensor = Matrix3::from_diagonal(&Vector3::new(0.314, 0.474, 0.542));
            let seen = attitude_of(&named).inverse_transform_vector(&place);
            let rate = orbit.mean_motion * near;
            let expected = 1.5 * rate * rate * near * seen.dot(&(tensor * seen));
            let acting = named.body().unwrap();
            let at_rest = acting.state(attitude_of(&named), Vector3::zeros()).unwrap();
            let found = acting.energy(&at_rest);
            assert!((found / expected - 1.0).abs() < 1e-12, "{name}: {found:e} {expected:e}");
        }
    }
}
