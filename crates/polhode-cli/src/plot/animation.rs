//! Poinsot's construction as a page that moves, without network.

use nalgebra::UnitQuaternion;
use polhode_files::error::Error;
use polhode_pages::scene::{Ellipsoid, Flips, Scene, Shown, Track};

use super::Plot;
use super::looks::{Course, Looks};
use super::poinsot::Construction;

/// The page.
pub(super) fn page(plot: &Plot, looks: &Looks) -> Result<String, Error> {
    let found = Construction::of(looks)?;
    let mut scene = Scene::new(
        plot.title("Poinsot's construction", looks) + &looks.remark(),
        track(&plot.course(), looks, found.upright),
    );
    scene.body.energy_changes = looks.energy_changes.clone();
    scene.ellipsoid = Some(found.ellipsoid(looks));
    scene.shown = Shown { omega: true, momentum: true, polhode: true, herpolhode: true };
    scene.notes.push(
        "The ellipsoid ω·Iω = 2T rolls without slipping on the plane across L; ω reaches from its centre to the point of contact. The \
         contact draws the polhode on the ellipsoid and the herpolhode on the plane."
            .into(),
    );
    scene.notes.extend((!looks.keeps_ellipsoid()).then(|| OF_THE_TIME.to_owned()));
    scene.page()
}

/// What is to be known of an ellipsoid that changes.
pub(crate) const OF_THE_TIME: &str = "The energy changes: the ellipsoid and the plane are those of the energy at the time that is shown, and \
     the polhode is scaled with them.";

/// The motion as a page shows it, `upright` turning the axes of space to those of the page.
pub(crate) fn track(course: &Course, looks: &Looks, upright: UnitQuaternion<f64>) -> Track {
    Track {
        name: course.method.to_owned(),
        times: looks.times.clone(),
        attitudes: looks.states.iter().map(|state| upright * state.rotation()).collect(),
        omegas: looks.omegas.clone(),
        momenta: looks
            .states
            .iter()
            .zip(looks.momenta())
            .map(|(state, m)| upright * (state.rotation() * m))
            .collect(),
        flips: looks.flips.as_ref().map(|flips| Flips { count: flips.count, times: flips.times.clone() }),
        ..Track::default()
    }
}

impl Construction {
    /// As a page draws it.
    pub(crate) fn ellipsoid(&self, looks: &Looks) -> Ellipsoid {
        let first = looks.times.first().copied().unwrap_or(0.0);
        let last = looks.times.last().copied().unwrap_or(first);
        let closed = looks.free().filter(|_| looks.keeps_ellipsoid());
        let period = closed.and_then(|motion| motion.character().ok()?.polhode_period);
        let frame = UnitQuaternion::from_rotation_matrix(&self.frame);
        Ellipsoid {
            semi_axes: self.semi_axes,
            frame: [frame.w, frame.i, frame.j, frame.k],
            distance: self.distance,
            plane: self.plane(),
            round: period.map_or(last, |period| last.min(first + 1.02 * period)),
        }
    }
}
