//! Pages in which a body turns: one file without network, drawn by WebGL from attitudes that were computed before.

mod decimated;
mod packed;
mod shape;
mod solids;
mod track;

use polhode_files::error::{Error, unexpected};
use polhode_files::text::escaped_html;
use serde::Serialize;

use crate::document::STYLE;
pub use shape::{MOST_TRIANGLES, Shape, Tint};
pub use track::{Flips, Track};

const PAGE: &str = include_str!("page.html");
const SCENE_STYLE: &str = include_str!("scene.css");
const RENDERER: &str = include_str!("renderer.js");
const PLAYER: &str = include_str!("player.js");

/// What a page shows: a body that moves, others beside it, and what is drawn on demand.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::inertia::Solid;
/// use polhode_pages::scene::{Scene, Shape, Track};
///
/// let times: Vec<f64> = (0..=100).map(|k| 0.1 * f64::from(k)).collect();
/// let turn = |t: &f64| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), *t);
/// let body = Track { name: "even".into(), attitudes: times.iter().map(turn).collect(), times, ..Track::default() };
/// let mut scene = Scene::new("A box", body);
/// scene.shape = Shape::of_solid(&Solid::Box([1.0, 2.0, 3.0]));
/// let page = scene.page()?;
/// assert!(page.starts_with("<!DOCTYPE html>") && !page.contains("http"));
/// # Ok::<(), polhode_files::Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Scene {
    /// Of the page.
    pub title: String,
    /// What is to be known of the drawing, a sentence each.
    pub notes: Vec<String>,
    /// The body; time runs from its first state to its last.
    pub body: Track,
    /// Bodies that are drawn faded beside it.
    pub rivals: Vec<Track>,
    /// What the bodies look like; nothing where the ellipsoid stands for the body.
    pub shape: Shape,
    /// Poinsot's construction, of a free body.
    pub ellipsoid: Option<Ellipsoid>,
    /// What is drawn from the beginning.
    pub shown: Shown,
}

/// The ellipsoid ω·Iω = 2T and the invariable plane, across −z of the page, at the start: the page scales both to the energy of the
/// time that it shows, by [`Track::energy_changes`] of the body.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Ellipsoid {
    /// Along the principal axes, rad/s.
    pub semi_axes: [f64; 3],
    /// From principal to body axes: w, x, y, z.
    pub frame: [f64; 4],
    /// Of the plane from the centre, rad/s.
    pub distance: f64,
    /// Half the side of the plane that is drawn, rad/s.
    pub plane: f64,
    /// The polhode is drawn up to this time: one round of it where it is closed, s.
    pub round: f64,
}

/// What is drawn besides the bodies.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Shown {
    /// The angular velocity.
    pub omega: bool,
    /// The angular momentum.
    pub momentum: bool,
    /// The path of ω on the ellipsoid of inertia.
    pub polhode: bool,
    /// Its path on the invariable plane.
    pub herpolhode: bool,
}

/// A scene as the page reads it.
#[derive(Serialize)]
struct Written {
    body: track::Written,
    rivals: Vec<track::Written>,
    shape: Option<shape::Written>,
    ellipsoid: Option<Ellipsoid>,
    shown: Shown,
    pace: f64,
}

impl Scene {
    /// A body that moves, and nothing else.
    pub fn new(title: impl Into<String>, body: Track) -> Self {
        Scene {
            title: title.into(),
            notes: Vec::new(),
            body,
            rivals: Vec::new(),
            shape: Shape::default(),
            ellipsoid: None,
            shown: Shown::default(),
        }
    }

    /// The page.
    ///
    /// # Errors
    /// None of scenes whose numbers are finite.
    pub fn page(&self) -> Result<String, Error> {
        let written = Written {
            body: self.body.written(),
            rivals: self.rivals.iter().map(Track::written).collect(),
            shape: (self.shape.triangles() > 0).then(|| self.shape.written()),
            ellipsoid: self.ellipsoid,
            shown: self.shown,
            pace: self.pace(),
        };
        // a name may hold the end of a script
        let data = serde_json::to_string(&written).map_err(unexpected)?.replace('<', "\\u003c");
        let notes: String =
            self.notes.iter().map(|note| format!("<p>{}</p>\n", escaped_html(note))).collect();
        Ok(filled(
            PAGE,
            &[
                ("title", &escaped_html(&self.title)),
                ("notes", &notes),
                ("style", &format!("{STYLE}\n{SCENE_STYLE}")),
                ("scene", &data),
                ("renderer", RENDERER),
                ("player", PLAYER),
            ],
        ))
    }

    /// How many seconds of the motion pass in one of the page: one where the body then turns at a pace that the eye follows, else
    /// the nearest of 1, 2, 5, 10, … that makes it so.
    fn pace(&self) -> f64 {
        let pairs = self.body.attitudes.windows(2);
        let turned: f64 = pairs.map(|pair| track::angle(&pair[0], &pair[1])).sum();
        let span =
            self.body.times.last().zip(self.body.times.first()).map_or(0.0, |(last, first)| last - first);
        let rate = turned / span;
        if !(rate > 0.0 && rate.is_finite()) || SEEN.contains(&rate) {
            return 1.0;
        }
        let wanted = PACE / rate;
        let power = libm::exp10(libm::floor(libm::log10(wanted)));
        let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power <= wanted).unwrap_or(1.0);
        digit * power
    }
}

/// rad/s that the eye follows, and that a body is slowed down or sped up to.
const SEEN: core::ops::RangeInclusive<f64> = 0.5..=6.0;
const PACE: f64 = 4.0;

/// A text with every `{{name}}` replaced, those that come in with a replacement left alone.
fn filled(template: &str, values: &[(&str, &str)]) -> String {
    let mut text = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        text += before;
        let (name, after) = after.split_once("}}").unwrap_or(("", after));
        text += values.iter().find(|(known, _)| *known == name).map_or("", |(_, value)| *value);
        rest = after;
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};

    use super::*;

    fn turning(rate: f64) -> Scene {
        let times: Vec<f64> = (0..=20).map(|k| f64::from(k) / 10.0 / rate).collect();
        let turn = |t: &f64| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), rate * t);
        let attitudes = times.iter().map(turn).collect();
        Scene::new("{{scene}} </script> & co", Track { times, attitudes, ..Track::default() })
    }

    #[test]
    fn a_title_is_neither_markup_nor_a_place_to_fill() {
        let mut scene = turning(1.0);
        scene.body.name = "</script>{{title}}".into();
        let page = scene.page().unwrap();
        assert!(page.contains("<h1>{{scene}} &lt;/script&gt; &amp; co</h1>"));
        assert!(page.contains("\\u003c/script>{{title}}"));
        assert_eq!(page.matches("</script>").count(), page.matches("<script").count());
        assert_eq!(page, scene.page().unwrap());
    }

    #[test]
    fn fast_and_slow_bodies_are_shown_at_a_pace_that_the_eye_follows() {
        let paces = [1.0, 20.0, 2e13, 2e-6].map(|rate| turning(rate).pace());
        assert_eq!(paces[..2], [1.0, 0.2]);
        assert!((paces[2] / 2e-13 - 1.0).abs() < 1e-12 && (paces[3] / 2e6 - 1.0).abs() < 1e-12, "{paces:?}");
    }
}
