//! The five ways in which MJCF writes an orientation.

use nalgebra::{UnitQuaternion, Vector3};

use super::super::element::Element;
use super::super::pose::{about, euler, quarter_turns_exact, unit, x_and_y, z_to};
use super::compiler::Compiler;
use crate::numbers::turn;

/// The attributes, of which one at most is given.
pub(super) const ATTRIBUTES: [&str; 5] = ["quat", "axisangle", "xyaxes", "zaxis", "euler"];

/// The orientation of an element; without one it is not turned.
pub(super) fn orientation(element: &Element, compiler: &Compiler) -> Result<UnitQuaternion<f64>, String> {
    let given: Vec<&str> =
        ATTRIBUTES.into_iter().filter(|attribute| element.attribute(attribute).is_some()).collect();
    let attribute = match given.as_slice() {
        [] => return Ok(UnitQuaternion::identity()),
        [one] => *one,
        [first, second, ..] => {
            return Err(element.error(&format!("has both {first} and {second}; leave one out")));
        }
    };
    let found = match attribute {
        "quat" => turn(element.needed::<4>("quat")?),
        "axisangle" => {
            let [x, y, z, angle] = element.needed::<4>("axisangle")?;
            unit(Vector3::new(x, y, z)).map(|axis| about(axis, angle * compiler.angle))
        }
        "xyaxes" => {
            let [a, b, c, d, e, f] = element.needed::<6>("xyaxes")?;
            x_and_y(Vector3::new(a, b, c), Vector3::new(d, e, f))
        }
        "zaxis" => z_to(Vector3::from(element.needed::<3>("zaxis")?)),
        _ => {
            let angles = element.needed::<3>("euler")?.map(|angle| angle * compiler.angle);
            euler(angles, &compiler.sequence)
        }
    };
    let found = found.ok_or_else(|| {
        let rule = match attribute {
            "quat" => "is zero; 1 0 0 0 is the identity",
            "xyaxes" => "spans no plane; give two axes that are not parallel",
            "euler" => "has no meaning, because eulerseq is not three of the letters x, y, z, X, Y, Z",
            _ => "has a zero axis; give its direction",
        };
        element.error(&format!("{attribute} {rule}"))
    })?;
    Ok(quarter_turns_exact(found))
}
