//! Curves on a sphere as SVG.
use crate::error::Error;
use crate::experiment::Drawing;
pub(crate) fn polhodes() -> Result<Drawing, Error> {
    Ok(Drawing { name: "polhodes", svg: String::new() })
}
pub(crate) fn cones() -> Result<Drawing, Error> {
    Ok(Drawing { name: "cones", svg: String::new() })
}
pub(crate) fn axis_paths() -> Result<Drawing, Error> {
    Ok(Drawing { name: "axis", svg: String::new() })
}
