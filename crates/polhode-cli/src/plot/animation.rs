//! Poinsot's construction as a page that moves, without network.

use polhode_files::error::{Error, unexpected};
use serde::Serialize;

use super::Plot;
use super::looks::Looks;
use super::poinsot::Construction;

const PAGE: &str = include_str!("animation.html");
/// What the page draws; lengths in rad/s, quaternions w, x, y, z.
#[derive(Serialize)]
struct Scene {
    times: Vec<f64>,
    /// Body to page.
    attitudes: Vec<[f64; 4]>,
    /// Body axes.
    omegas: Vec<[f64; 3]>,
    semi_axes: [f64; 3],
    /// Frames of the first round of the polhode.
    round: usize,
    /// Rows of the matrix from principal to body axes.
    frame: [[f64; 3]; 3],
    distance: f64,
    plane: f64,
}

/// The page.
pub(super) fn page(plot: &Plot, looks: &Looks) -> Result<String, Error> {
    let found = Construction::of(looks)?;
    let kept = || 0..looks.times.len();
    let period = looks.free().and_then(|motion| motion.character().ok()?.polhode_period);
    let round = |period: f64| looks.times.partition_point(|t| *t <= looks.times[0] + 1.02 * period);
    let attitude = |k: usize| {
        let q = found.upright * looks.states[k].rotation();
        [q.w, q.i, q.j, q.k].map(|x| rounded(x, 1.0))
    };
    let largest = found.semi_axes[0];
    let frame = found.frame.matrix();
    let scene = Scene {
        times: kept().map(|k| looks.times[k]).collect(),
        attitudes: kept().map(attitude).collect(),
        omegas: kept().map(|k| <[f64; 3]>::from(looks.omegas[k]).map(|w| rounded(w, largest))).collect(),
        semi_axes: found.semi_axes,
        round: period.map_or(looks.times.len(), round),
        frame: [0, 1, 2].map(|row| [0, 1, 2].map(|column| frame[(row, column)])),
        distance: found.distance,
        plane: found.plane(),
    };
    let title = plot.title("Poinsot's construction", looks) + &looks.remark();
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    // a name may hold the end of a script
    let data = serde_json::to_string(&scene).map_err(unexpected)?.replace('<', "\\u003c");
    Ok(PAGE.replace("{{title}}", &title).replace("{{scene}}", &data))
}

/// To a millionth of `scale`: a page shows no more.
fn rounded(x: f64, scale: f64) -> f64 {
    let digits = 7 - libm::ceil(libm::log10(scale)) as i32;
    let unit = libm::exp10(f64::from(digits));
    if unit.is_finite() && unit > 0.0 { libm::round(x * unit) / unit } else { x }
}
