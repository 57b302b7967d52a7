//! Names of columns: which hold the time, the attitude, the angular velocity and the angular momentum.

use polhode::audit::{AngleUnit, Claims, Frame, QuaternionOrder, RateUnit};

use super::layout::{AttitudeKind, TimeUnit};

/// What a group of columns holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Attitude(AttitudeKind),
    Rates,
    Momentum,
}

/// Columns of one quantity, by their places.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    pub(super) role: Role,
    pub(super) places: Vec<usize>,
    /// What the names claim of the convention.
    pub(super) claims: Claims,
}

/// Spellings of one quantity.
struct Family {
    role: Role,
    stems: &'static [&'static str],
    components: &'static [&'static [&'static str]],
}

const VECTOR: &[&[&str]] = &[&["x", "y", "z"], &["1", "2", "3"], &["0", "1", "2"], &["i", "j", "k"]];
const LETTERS: &[&[&str]] = &[&["w", "x", "y", "z"], &["s", "x", "y", "z"], &["w", "i", "j", "k"]];
const NUMBERS: &[&[&str]] = &[&["0", "1", "2", "3"], &["1", "2", "3", "4"]];
const ENTRIES: &[&[&str]] = &[
    &["11", "12", "13", "21", "22", "23", "31", "32", "33"],
    &["00", "01", "02", "10", "11", "12", "20", "21", "22"],
    &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"],
];
const QUATERNION: &[&str] = &[
    "q",
    "quat",
    "quaternion",
    "orientation",
    "attitude",
    "rotation",
    "rot",
    "qbn",
    "qib",
    "ep",
    "cquat",
    "cq",
];

const FAMILIES: &[Family] = &[
    Family { role: Role::Attitude(AttitudeKind::Named), stems: QUATERNION, components: LETTERS },
    Family { role: Role::Attitude(AttitudeKind::Numbered), stems: QUATERNION, components: NUMBERS },
    Family {
        role: Role::Attitude(AttitudeKind::Matrix),
        stems: &["r", "rot", "rotmat", "rotation", "dcm", "matrix", "mat", "m", "a", "c", "bn"],
        components: ENTRIES,
    },
    Family {
        role: Role::Attitude(AttitudeKind::Rodrigues),
        stems: &["sigma", "sigmabn", "mrp"],
        components: VECTOR,
    },
    Family {
        role: Role::Attitude(AttitudeKind::Angles),
        stems: &["euler", "angle", "eulerangle", "eul"],
        components: VECTOR,
    },
    Family {
        role: Role::Attitude(AttitudeKind::Angles),
        stems: &[""],
        components: &[&["phi", "theta", "psi"], &["roll", "pitch", "yaw"], &["alpha", "beta", "gamma"]],
    },
    Family {
        role: Role::Rates,
        stems: &[
            "w",
            "omega",
            "ω",
            "angvel",
            "angularvelocity",
            "av",
            "rate",
            "angrate",
            "wbody",
            "wb",
            "omegabody",
            "omegab",
            "omegabnb",
            "gyro",
            "gyr",
            "wspace",
            "wworld",
            "omegaspace",
            "omegaworld",
            "omegabnn",
            "omegas",
        ],
        components: VECTOR,
    },
    Family { role: Role::Rates, stems: &[""], components: &[&["p", "q", "r"]] },
    Family {
        role: Role::Momentum,
        stems: &[
            "l",
            "angmom",
            "angularmomentum",
            "h",
            "momentum",
            "lbody",
            "hbody",
            "momentumbody",
            "lspace",
            "hspace",
            "momentumspace",
        ],
        components: VECTOR,
    },
    // letters alone are a quaternion where nothing else is
    Family { role: Role::Attitude(AttitudeKind::Named), stems: &[""], components: LETTERS },
];

const TIMES: &[&str] = &["t", "time", "times", "timestamp", "simtime", "elapsed", "elapsedtime"];
const IDS: &[&str] = &["id", "body", "bodyid", "bodyname", "name", "link", "entity", "object"];

/// A name without case, separators and unit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Name {
    letters: String,
    unit: Option<String>,
}

impl Name {
    pub(super) fn of(text: &str) -> Self {
        let lower = text.trim().to_lowercase();
        let (stem, mut unit) = match lower.rsplit_once(['(', '[']) {
            Some((stem, rest)) => {
                let inside = rest.trim_end_matches([')', ']', ' ']);
                let is_unit = !stem.trim().is_empty() && inside.chars().any(char::is_alphabetic);
                if is_unit && !inside.is_empty() {
                    (stem.trim(), Some(inside.to_string()))
                } else {
                    (&*lower, None)
                }
            }
            None => (&*lower, None),
        };
        let mut words: Vec<&str> =
            stem.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        if unit.is_none() {
            for (ending, known) in UNIT_WORDS {
                if words.len() > ending.len() && words.ends_with(ending) {
                    let is_time = TIMES.contains(&words[0]);
                    // q_s is the scalar part, time_s a time
                    if is_time == is_duration(known) {
                        unit = Some((*known).to_string());
                        words.truncate(words.len() - ending.len());
                        break;
                    }
                }
            }
        }
        Name { letters: words.concat(), unit }
    }

    pub(super) fn is_time(&self) -> bool {
        TIMES.contains(&&*self.letters)
    }

    pub(super) fn is_id(&self) -> bool {
        IDS.contains(&&*self.letters)
    }

    pub(super) fn time_unit(&self) -> Option<TimeUnit> {
        self.unit.as_deref().and_then(TimeUnit::named)
    }

    /// The number behind `stem`, as 3 of qpos[3].
    pub(super) fn number_after(&self, stem: &str) -> Option<usize> {
        self.letters.strip_prefix(stem)?.parse().ok()
    }
}

/// Units as words at the end of a name.
const UNIT_WORDS: &[(&[&str], &str)] = &[
    (&["rad", "s"], "rad/s"),
    (&["rads"], "rad/s"),
    (&["deg", "s"], "deg/s"),
    (&["dps"], "deg/s"),
    (&["rpm"], "rpm"),
    (&["deg"], "deg"),
    (&["rad"], "rad"),
    (&["ms"], "ms"),
    (&["us"], "us"),
    (&["ns"], "ns"),
    (&["nanos"], "ns"),
    (&["sec"], "s"),
    (&["s"], "s"),
];

fn is_duration(unit: &str) -> bool {
    TimeUnit::named(unit).is_some()
}

/// Every complete group of columns; of equal role several where the names allow it.
pub(super) fn groups(names: &[Name]) -> Vec<Group> {
    let place = |letters: &str| names.iter().position(|name| name.letters == letters);
    let mut found: Vec<Group> = Vec::new();
    for family in FAMILIES {
        for stem in family.stems {
            let is_last_resort = stem.is_empty() && family.components == LETTERS;
            let complete = family.components.iter().find_map(|components| {
                components
                    .iter()
                    .map(|component| place(&format!("{stem}{component}")))
                    .collect::<Option<Vec<_>>>()
            });
            let Some(places) = complete else { continue };
            if is_last_resort && found.iter().any(|group| matches!(group.role, Role::Attitude(_))) {
                continue;
            }
            // the same columns under two spellings
            if found.iter().any(|group| group.places == places) {
                continue;
            }
            let claims = claims(stem, family.role, &names[places[0]]);
            found.push(Group { role: family.role, places, claims });
        }
    }
    found
}

/// What a name claims of the convention.
fn claims(stem: &str, role: Role, name: &Name) -> Claims {
    let frame = || match stem {
        s if s.ends_with("body") || s.ends_with("bnb") || ["wb", "omegab", "gyro", "gyr"].contains(&s) => {
            Some(Frame::Body)
        }
        s if s.ends_with("space") || s.ends_with("world") || s.ends_with("bnn") || s == "omegas" => {
            Some(Frame::Space)
        }
        _ => None,
    };
    let mut claims = Claims::default();
    match role {
        Role::Rates => {
            claims.omega_frame = frame();
            claims.rate_unit = name.unit.as_deref().and_then(rate_unit);
        }
        Role::Momentum => claims.momentum_frame = frame(),
        Role::Attitude(AttitudeKind::Named) => claims.quaternion = Some(QuaternionOrder::ScalarFirst),
        Role::Attitude(AttitudeKind::Angles) => claims.angle_unit = name.unit.as_deref().and_then(angle_unit),
        Role::Attitude(_) => {}
    }
    claims
}

/// A unit of rates by name.
pub fn rate_unit(text: &str) -> Option<RateUnit> {
    match text {
        "rad/s" | "rad s-1" | "rad·s⁻¹" => Some(RateUnit::RadiansPerSecond),
        "deg/s" | "°/s" | "dps" => Some(RateUnit::DegreesPerSecond),
        "rpm" | "1/min" => Some(RateUnit::RevolutionsPerMinute),
        _ => None,
    }
}

/// A unit of angles by name.
pub fn angle_unit(text: &str) -> Option<AngleUnit> {
    match text {
        "rad" => Some(AngleUnit::Radians),
        "deg" | "°" => Some(AngleUnit::Degrees),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(header: &str) -> Vec<(Role, Vec<usize>)> {
        let names: Vec<Name> = header.split(',').map(Name::of).collect();
        groups(&names).into_iter().map(|group| (group.role, group.places)).collect()
    }

    #[test]
    fn spellings_of_the_common_programs() {
        let (named, numbered) = (Role::Attitude(AttitudeKind::Named), Role::Attitude(AttitudeKind::Numbered));
        assert_eq!(found("t,w,x,y,z"), [(named, vec![1, 2, 3, 4])]);
        assert_eq!(
            found("t,q_w,q_x,q_y,q_z,omega_body_x,omega_body_y,omega_body_z,energy,momentum"),
            [(named, vec![1, 2, 3, 4]), (Role::Rates, vec![5, 6, 7])]
        );
        assert_eq!(found("time,x,y,z,qx,qy,qz,qw"), [(named, vec![7, 4, 5, 6])]);
        assert_eq!(
            found("t,q0,q1,q2,q3,wx,wy,wz"),
            [(numbered, vec![1, 2, 3, 4]), (Role::Rates, vec![5, 6, 7])]
        );
        assert_eq!(
            found("Time [s],sigma_BN[0],sigma_BN[1],sigma_BN[2],omega_BN_B_1,omega_BN_B_2,omega_BN_B_3"),
            [(Role::Attitude(AttitudeKind::Rodrigues), vec![1, 2, 3]), (Role::Rates, vec![4, 5, 6])]
        );
        assert_eq!(
            found("t,R[0][0],R[0][1],R[0][2],R[1][0],R[1][1],R[1][2],R[2][0],R[2][1],R[2][2]").len(),
            1
        );
        assert_eq!(found("t,roll,pitch,yaw,p,q,r").len(), 2);
        assert_eq!(
            found("id,quatw,quati,quatj,quatk,angmomx,angmomy,angmomz"),
            [(named, vec![1, 2, 3, 4]), (Role::Momentum, vec![5, 6, 7])]
        );
        assert_eq!(found("t,a,b"), []);
    }

    #[test]
    fn units_and_frames_stand_in_names() {
        let names: Vec<Name> =
            ["time (ms)", "omega_space_x_deg_s", "omega_space_y", "omega_space_z"].map(Name::of).into();
        assert_eq!(names[0].time_unit(), Some(TimeUnit(1e-3)));
        assert!(names[0].is_time());
        let groups = groups(&names);
        assert_eq!(groups[0].claims.omega_frame, Some(Frame::Space));
        assert_eq!(groups[0].claims.rate_unit, Some(RateUnit::DegreesPerSecond));
        assert_eq!(Name::of("t_ns").time_unit(), Some(TimeUnit(1e-9)));
        assert_eq!(Name::of("q_s").letters, "qs");
        assert_eq!(Name::of("qpos[3]").number_after("qpos"), Some(3));
    }
}
