//! Which columns of a file hold which quantity, of which bodies.

use polhode::audit::{Claims, Direction, Frame, QuaternionOrder, RateUnit};

use super::names::{Group, Name, Role, groups};
use crate::text::visible;

/// How the columns of an attitude are to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AttitudeKind {
    /// A quaternion whose scalar part is told by its name; it stands first here.
    Named,
    /// A quaternion whose components are numbered: where its scalar part stands is open.
    Numbered,
    /// The nine entries of a matrix, by rows.
    Matrix,
    /// Three Euler angles.
    Angles,
    /// Modified Rodrigues parameters.
    Rodrigues,
}

impl AttitudeKind {
    fn width(self) -> usize {
        match self {
            Self::Named | Self::Numbered => 4,
            Self::Matrix => 9,
            Self::Angles | Self::Rodrigues => 3,
        }
    }
}

/// A unit of time, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TimeUnit(pub f64);

impl TimeUnit {
    pub(super) fn named(text: &str) -> Option<Self> {
        let seconds = match text.trim() {
            "s" | "sec" | "second" | "seconds" => 1.0,
            "ms" => 1e-3,
            "us" | "µs" => 1e-6,
            "ns" => 1e-9,
            "min" => 60.0,
            "h" => 3600.0,
            _ => return None,
        };
        Some(Self(seconds))
    }
}

/// What either claims; the first where both do.
pub(super) fn merged(first: Claims, second: Claims) -> Claims {
    let mut merged = first;
    merged.quaternion = first.quaternion.or(second.quaternion);
    merged.attitude = first.attitude.or(second.attitude);
    merged.angles = first.angles.or(second.angles);
    merged.angle_unit = first.angle_unit.or(second.angle_unit);
    merged.omega_frame = first.omega_frame.or(second.omega_frame);
    merged.rate_unit = first.rate_unit.or(second.rate_unit);
    merged.momentum_frame = first.momentum_frame.or(second.momentum_frame);
    merged
}

/// The columns of one body, by their places.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BodyColumns {
    pub(super) label: Option<String>,
    pub(super) attitude: Option<(AttitudeKind, Vec<usize>)>,
    pub(super) rates: Option<Vec<usize>>,
    pub(super) momentum: Option<Vec<usize>>,
}

/// The columns of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// None where the file tells the time of whole blocks of rows.
    pub(super) time: Option<usize>,
    pub(super) time_unit: Option<TimeUnit>,
    pub(super) id: Option<usize>,
    pub(super) bodies: Vec<BodyColumns>,
    /// What names and layout claim of the convention.
    pub(super) claims: Claims,
}

/// Columns that are named by a flag: keys, and names or numbers from 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnNames(pub Vec<(String, String)>);

/// Keys of the flag, by quantity; a key alone is a time or a body.
const KEYS: &[(Role, &[&str])] = &[
    (Role::Attitude(AttitudeKind::Named), &["qw", "qx", "qy", "qz"]),
    (Role::Attitude(AttitudeKind::Numbered), &["q0", "q1", "q2", "q3"]),
    (Role::Attitude(AttitudeKind::Matrix), &["r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"]),
    (Role::Attitude(AttitudeKind::Angles), &["e1", "e2", "e3"]),
    (Role::Attitude(AttitudeKind::Rodrigues), &["s1", "s2", "s3"]),
    (Role::Rates, &["wx", "wy", "wz"]),
    (Role::Momentum, &["lx", "ly", "lz"]),
];

/// The flag that names columns, as messages show it.
pub(super) const FLAG: &str = "--columns t=NAME,qw=NAME,qx=NAME,... (keys in --help)";

impl ColumnNames {
    pub fn parse(text: &str) -> Result<Self, String> {
        let known =
            |key: &str| ["t", "id"].contains(&key) || KEYS.iter().any(|(_, keys)| keys.contains(&key));
        let mut found: Vec<(String, String)> = Vec::new();
        for part in text.split(',') {
            match part.split_once('=') {
                Some((key, name)) if known(key.trim()) => {
                    let key = key.trim();
                    if found.iter().any(|(other, _)| other == key) {
                        return Err(format!("'{key}' is named twice"));
                    }
                    found.push((key.into(), name.trim().into()));
                }
                // a name may hold a comma: it goes on up to the next key
                _ => match found.last_mut() {
                    Some((_, name)) => *name += &format!(",{part}"),
                    None => return Err(format!("'{part}' has no known key; keys: {}", all_keys())),
                },
            }
        }
        Ok(Self(found))
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.0.iter().find(|(known, _)| known == key).map(|(_, name)| &**name)
    }
}

fn all_keys() -> String {
    let keys: Vec<String> = KEYS.iter().map(|(_, keys)| keys.join(" ")).collect();
    format!("t, id, {}", keys.join(", "))
}

/// A rule that the header breaks, and what helps.
pub(super) type Refusal = (String, String);

impl Layout {
    /// From the names of the columns; `has_times` where rows carry no time of their own.
    pub(super) fn of(header: &[String], flags: &ColumnNames, has_times: bool) -> Result<Self, Refusal> {
        let names: Vec<Name> = header.iter().map(|name| Name::of(name)).collect();
        let listed = || {
            let shown: Vec<String> = header.iter().map(|name| format!("'{}'", visible(name))).collect();
            shown.join(", ")
        };
        let by_flag = |key: &str| -> Result<Option<usize>, Refusal> {
            let Some(wanted) = flags.get(key) else { return Ok(None) };
            let named = header.iter().position(|name| name.trim() == wanted);
            let number =
                || wanted.parse().ok().filter(|n| (1..=header.len()).contains(n)).map(|n: usize| n - 1);
            let refused = || {
                let rule = format!("no column '{}' for {key}; the file has {}", visible(wanted), listed());
                (rule, "name one of them in --columns, or give its number from 1".to_string())
            };
            named.or_else(number).map(Some).ok_or_else(refused)
        };
        let time = match by_flag("t")? {
            Some(place) => Some(place),
            None => names.iter().position(Name::is_time),
        };
        if time.is_none() && !has_times {
            let rule = format!("no column of times among {}", listed());
            return Err((rule, "name it by --columns t=NAME".into()));
        }
        let id = match by_flag("id")? {
            Some(place) => Some(place),
            None => names.iter().position(Name::is_id),
        };
        let mut layout = Layout {
            time,
            time_unit: time.and_then(|place| names[place].time_unit()),
            id,
            bodies: Vec::new(),
            claims: Claims::default(),
        };
        let mut wanted = Vec::new();
        for (role, keys) in KEYS {
            let places = keys.iter().map(|key| by_flag(key)).collect::<Result<Vec<_>, _>>()?;
            if places.iter().all(Option::is_none) {
                continue;
            }
            let Some(places) = places.iter().copied().collect::<Option<Vec<usize>>>() else {
                let missing = keys.iter().zip(&places).find(|(_, place)| place.is_none());
                let missing = missing.map_or("", |(key, _)| key);
                return Err((
                    format!("--columns names a part of {}", keys.join(", ")),
                    format!("add {missing}=NAME"),
                ));
            };
            wanted.push(Group { role: *role, places, claims: Claims::default() });
        }
        if wanted.is_empty() && layout.is_generalized(&names)? {
            return Ok(layout);
        }
        let mut body = BodyColumns::default();
        let found = if wanted.is_empty() { groups(&names) } else { wanted };
        for group in found {
            let Group { role, places, claims } = group;
            let double = |what: &str, before: &[usize]| {
                let name = |places: &[usize]| visible(&header[places[0]]).into_owned();
                let rule = format!("two {what}: from '{}' and from '{}' on", name(before), name(&places));
                (rule, format!("name the columns of one by {FLAG}"))
            };
            layout.claims = merged(layout.claims, claims);
            match role {
                Role::Attitude(kind) => {
                    if let Some((_, before)) = &body.attitude {
                        return Err(double("attitudes", before));
                    }
                    debug_assert_eq!(kind.width(), places.len());
                    body.attitude = Some((kind, places));
                }
                Role::Rates => {
                    if let Some(before) = &body.rates {
                        return Err(double("angular velocities", before));
                    }
                    body.rates = Some(places);
                }
                Role::Momentum => {
                    if let Some(before) = &body.momentum {
                        return Err(double("angular momenta", before));
                    }
                    body.momentum = Some(places);
                }
            }
        }
        if body.attitude.is_none() && body.rates.is_none() && body.momentum.is_none() {
            let rule =
                format!("neither an attitude nor an angular velocity is told by the names {}", listed());
            return Err((rule, format!("name the columns by {FLAG}")));
        }
        if has_times {
            // LAMMPS: momenta and rates of atoms are in the axes of space
            layout.claims.omega_frame = Some(Frame::Space);
            layout.claims.momentum_frame = Some(Frame::Space);
            layout.claims.attitude = Some(Direction::BodyToSpace);
        }
        if matches!(body.attitude, Some((AttitudeKind::Rodrigues, _))) {
            layout.claims.attitude = Some(Direction::BodyToSpace);
        }
        layout.bodies.push(body);
        Ok(layout)
    }

    /// Free joints of MuJoCo: `qpos` holds three positions and a quaternion, scalar first, for each; `qvel` three velocities
    /// and the angular velocity in body axes.
    fn is_generalized(&mut self, names: &[Name]) -> Result<bool, Refusal> {
        let numbered = |stem: &str| {
            let mut found: Vec<(usize, usize)> = names
                .iter()
                .enumerate()
                .filter_map(|(place, name)| Some((name.number_after(stem)?, place)))
                .collect();
            found.sort_unstable();
            found.into_iter().map(|(_, place)| place).collect::<Vec<usize>>()
        };
        let (positions, velocities) = (numbered("qpos"), numbered("qvel"));
        if positions.is_empty() {
            return Ok(false);
        }
        let bodies = positions.len() / 7;
        let fits = positions.len() % 7 == 0 && (velocities.is_empty() || velocities.len() == 6 * bodies);
        if !fits {
            let rule = format!(
                "{} columns qpos and {} columns qvel are not those of free joints alone, 7 and 6 for each",
                positions.len(),
                velocities.len()
            );
            return Err((rule, format!("name the columns of one body by {FLAG}")));
        }
        for body in 0..bodies {
            let attitude = positions[7 * body + 3..7 * body + 7].to_vec();
            let rates = (!velocities.is_empty()).then(|| velocities[6 * body + 3..6 * body + 6].to_vec());
            self.bodies.push(BodyColumns {
                label: (bodies > 1).then(|| format!("free joint {}", body + 1)),
                attitude: Some((AttitudeKind::Named, attitude)),
                rates,
                momentum: None,
            });
        }
        self.claims.quaternion = Some(QuaternionOrder::ScalarFirst);
        self.claims.attitude = Some(Direction::BodyToSpace);
        self.claims.omega_frame = Some(Frame::Body);
        self.claims.rate_unit = Some(RateUnit::RadiansPerSecond);
        Ok(true)
    }
}
