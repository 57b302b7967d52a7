//! Events as they are typed: `flip`, `angle(body z, space x) < 10deg`, `rate > 5rad/s`, `nearest(1,0,0,0)`.

use nalgebra::{UnitQuaternion, Vector3};
use polhode::body::Body;
use polhode::events::{Event, EventError};
use polhode_files::error::Error;
use polhode_files::numbers::{numbers, quaternion, turn};

use super::start::{Factor, angle_unit, rate_unit, with_unit};

/// The forms, for messages.
pub(crate) const FORMS: &str =
    "write flip, angle(body z, space x) < 10deg, rate > 5rad/s or nearest(w,x,y,z)";

/// What `--event` names.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TypedEvent {
    text: String,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Flip,
    /// Axes of body and of space, and the angle between them, rad.
    Cone([f64; 3], [f64; 3], Limit),
    /// rad/s.
    Rate(Limit),
    Nearest(UnitQuaternion<f64>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Limit {
    Below(f64),
    Above(f64),
}

pub(crate) fn event(text: &str) -> Result<TypedEvent, String> {
    let text = text.trim();
    let kind = match text {
        "flip" => Kind::Flip,
        _ if text.starts_with("angle") => cone(&text["angle".len()..])?,
        _ if text.starts_with("rate") => Kind::Rate(limit(&text["rate".len()..], rate_unit, "5rad/s")?),
        _ => match text.strip_prefix("nearest").and_then(|rest| inside(rest)) {
            Some((components, "")) => {
                let target = turn(quaternion(components)?);
                Kind::Nearest(target.ok_or("the quaternion is zero, which is not an attitude")?)
            }
            _ => return Err(format!("unknown event; {FORMS}")),
        },
    };
    Ok(TypedEvent { text: text.into(), kind })
}

/// What stands in the parentheses at the beginning of `text`, and what follows them.
fn inside(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start().strip_prefix('(')?;
    let mut depth = 1;
    let end = text.find(|c: char| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth == 0
    })?;
    Some((&text[..end], text[end + 1..].trim()))
}

/// `(body z, space x) < 10deg`
fn cone(text: &str) -> Result<Kind, String> {
    let form = || "an angle needs two axes: write angle(body z, space x) < 10deg".to_owned();
    let (axes, rest) = inside(text).ok_or_else(form)?;
    let found = [axes.find("body"), axes.find("space")];
    let [Some(of_body), Some(of_space)] = found else { return Err(form()) };
    let (first, second) = axes.split_at(of_body.max(of_space));
    let first = first.trim().strip_suffix(',').ok_or_else(form)?;
    let (body, space) = if of_body < of_space { (first, second) } else { (second, first) };
    let one = |text: &str, name: &str| axis(text.trim().strip_prefix(name).ok_or_else(form)?.trim());
    let limit = limit(rest, angle_unit, "10deg")?;
    let (Limit::Below(angle) | Limit::Above(angle)) = limit;
    if !(angle > 0.0 && angle < core::f64::consts::PI) {
        return Err("the limit of an angle of two axes must be between 0 and pi rad, 180 deg".into());
    }
    Ok(Kind::Cone(one(body, "body")?, one(space, "space")?, limit))
}

/// `x`, `-z`, or the components `(1,0,2)`.
fn axis(text: &str) -> Result<[f64; 3], String> {
    if let Some((components, "")) = inside(text) {
        return numbers::<3>(components);
    }
    let (sign, name) = match text.strip_prefix(['+', '-']) {
        Some(name) if text.starts_with('-') => (-1.0, name),
        Some(name) => (1.0, name),
        None => (1.0, text),
    };
    let place = ["x", "y", "z"].iter().position(|known| *known == name);
    let place = place.ok_or_else(|| format!("'{text}' is not an axis; write x, -z or (1,0,2)"))?;
    let mut axis = [0.0; 3];
    axis[place] = sign;
    Ok(axis)
}

/// `< 10deg`
fn limit(text: &str, unit: impl Fn(&str) -> Result<Factor, String>, example: &str) -> Result<Limit, String> {
    let text = text.trim();
    let Some(rest) = text.strip_prefix(['<', '>']) else {
        return Err(format!("a limit is missing; write < or > and a number with its unit, as {example}"));
    };
    let value = with_unit(rest.trim(), unit, example)?;
    Ok(if text.starts_with('<') { Limit::Below(value) } else { Limit::Above(value) })
}

impl TypedEvent {
    /// As it was typed.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn of(&self, body: &Body) -> Result<Event, Error> {
        let [least, middle, most] = body.inertia().principal_moments();
        if self.kind == Kind::Flip && (least == middle || middle == most) {
            let rule = "two moments are equal, so that there is no middle axis and no flip";
            let remedy = "name an angle, as angle(body z, space x) < 10deg";
            return Err(Error::input("--event", &self.text, rule, remedy));
        }
        self.made(body).map_err(|error| Error::input("--event", &self.text, &error.to_string(), FORMS))
    }

    pub(crate) fn made(&self, body: &Body) -> Result<Event, EventError> {
        match &self.kind {
            Kind::Flip => Ok(Event::flip(body)),
            Kind::Cone(of_body, in_space, limit) => {
                let (a, b) = (Vector3::from(*of_body), Vector3::from(*in_space));
                match *limit {
                    Limit::Below(angle) => Event::enters_cone(a, b, angle),
                    Limit::Above(angle) => Event::enters_cone(a, -b, core::f64::consts::PI - angle),
                }
            }
            Kind::Rate(Limit::Above(limit)) => Event::rate_above(body, *limit),
            Kind::Rate(Limit::Below(limit)) => Event::rate_below(body, *limit),
            Kind::Nearest(target) => Ok(Event::nearest(body, *target)),
        }
    }
}

/// Time between looks at a body that turns at `rate` rad/s, of `whole` s: the largest power of two in which it turns by a
/// quarter of a radian at most.
pub(crate) fn spacing(rate: f64, whole: f64) -> f64 {
    let short = libm::exp2(libm::floor(libm::log2(0.25 / rate)));
    if rate > 0.0 { short.min(whole) } else { whole }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_is_read() {
        let kind = |text: &str| event(text).unwrap().kind;
        assert_eq!(kind(" flip "), Kind::Flip);
        let below = Limit::Below(10.0 * (core::f64::consts::PI / 180.0));
        let tilted = Kind::Cone([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], below);
        assert_eq!(kind("angle(body z, space x) < 10deg"), tilted);
        assert_eq!(kind("angle (space +x,body z)<1e1 deg"), tilted);
        assert_eq!(
            kind("angle(body (1,0,-2), space -y) > 0.5rad"),
            Kind::Cone([1.0, 0.0, -2.0], [0.0, -1.0, 0.0], Limit::Above(0.5))
        );
        assert_eq!(kind("rate > 2rad/s"), Kind::Rate(Limit::Above(2.0)));
        assert_eq!(
            kind("rate<1.5e+1rev/h"),
            Kind::Rate(Limit::Below(15.0 * (core::f64::consts::TAU / 3600.0)))
        );
        let Kind::Nearest(target) = kind("nearest(1, 0,0,-1)") else { panic!("another kind") };
        assert!((target.euler_angles().2 + core::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn what_is_none_is_refused_by_its_part() {
        for (text, part) in [
            ("", "unknown event"),
            ("flips", "unknown event"),
            ("nearest(1,0,0,0) now", "unknown event"),
            ("nearest(1,0,0)", "4"),
            ("nearest(0,0,0,0)", "not a rotation"),
            ("angle(body z) < 1deg", "needs two axes"),
            ("angle(body z, body x) < 1deg", "needs two axes"),
            ("angle(body w, space x) < 1deg", "'w' is not an axis"),
            ("angle(body z, space x) < 10", "has no unit"),
            ("angle(body z, space x) < 10rev", "unknown unit of angles"),
            ("angle(body z, space x) 10deg", "a limit is missing"),
            ("angle(body z, space x) > 190deg", "between 0 and pi rad"),
            ("rate > 5", "has no unit"),
            ("rate > 5deg", "unknown unit of rates"),
            ("rate > NaN rad/s", "a number is missing"),
            ("rate", "a limit is missing"),
        ] {
            let error = event(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
