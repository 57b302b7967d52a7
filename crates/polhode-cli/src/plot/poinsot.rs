//! Poinsot's construction: the ellipsoid of inertia rolls on the invariable plane without slipping, and ω reaches from its
//! centre to the point of contact (L. Poinsot, Théorie nouvelle de la rotation des corps, 1834).

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use polhode_files::error::Error;
use polhode_pages::figure::sphere::View;
use polhode_pages::figure::style::{BLACK, BLUE, Colour, GREEN, GREY, ORANGE};
use polhode_pages::figure::{Canvas, Fill, Stroke};

use super::Plot;
use super::looks::Looks;

type V = Vector3<f64>;

/// The ellipsoid ω·Iω = 2T with its plane, L downwards.
pub(crate) struct Construction {
    /// Turns axes of space to those of the page: L becomes −Z.
    pub(crate) upright: UnitQuaternion<f64>,
    /// Semi-axes along the principal axes, rad/s.
    pub(super) semi_axes: [f64; 3],
    /// Columns are the principal axes in body axes.
    pub(super) frame: Rotation3<f64>,
    /// Distance of the plane from the centre, 2T/|L|, rad/s.
    pub(super) distance: f64,
    /// The largest radius of the herpolhode, rad/s.
    pub(super) reach: f64,
}

impl Construction {
    /// # Errors
    /// A body at rest, or one that is not free.
    pub(crate) fn of(looks: &Looks) -> Result<Self, Error> {
        if looks.body.problem() != polhode::body::Problem::Free {
            return Err(Error::Input(
                "poinsot: the construction is for free bodies, and a torque acts on this one; leave the torque out, or plot trace".into(),
            ));
        }
        let (Some(state), Some(omega)) = (looks.states.first(), looks.omegas.first()) else {
            return Err(Error::Failed("poinsot: the run has no state".into()));
        };
        let (momentum, twice) = (state.momentum_space(), omega.dot(&state.momentum()));
        if twice <= 0.0 {
            return Err(Error::Input(
                "--omega: the body is at rest, and nothing rolls; give it a spin".into(),
            ));
        }
        let down = momentum.normalize();
        let upright = UnitQuaternion::rotation_between(&down, &-V::z())
            .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&V::x_axis(), core::f64::consts::PI));
        let across = |(state, omega): (&polhode::body::State, &V)| {
            let omega = state.rotation() * omega;
            (omega - down * omega.dot(&down)).norm()
        };
        Ok(Construction {
            upright,
            semi_axes: looks.body.inertia().principal_moments().map(|moment| libm::sqrt(twice / moment)),
            frame: Rotation3::from(looks.body.inertia().principal_axes()),
            distance: twice / momentum.norm(),
            reach: looks.states.iter().zip(&looks.omegas).map(across).fold(0.0, f64::max),
        })
    }

    /// Half the size of the plane that is drawn, rad/s.
    pub(super) fn plane(&self) -> f64 {
        1.15 * self.reach.max(0.55 * self.semi_axes[0])
    }
}

/// The arrow of L ends at so many distances of the plane.
const LOWER: f64 = 1.3;
const PLANE: Colour = Colour(238, 238, 238);
const BODY: Colour = Colour(214, 228, 240);

/// The construction at the start.
pub(super) fn still(plot: &Plot, looks: &Looks) -> Result<Canvas, Error> {
    let scene = Construction::of(looks)?;
    let [width, height] = plot.size();
    let mut page = Canvas::new(width, height);
    let mut title = plot.title("Poinsot's construction", looks) + &looks.remark();
    let spins = looks.free().is_some_and(|motion| motion.pure_spin().is_some());
    if spins {
        title += "; polhode and herpolhode are points";
    }
    let head = page.heading(&title);
    let room = (height - head - 60.0).max(120.0);
    let omegas = looks.states.iter().zip(&looks.omegas);
    let herpolhode: Vec<V> =
        omegas.map(|(state, omega)| scene.upright * (state.rotation() * omega)).collect();
    let Some((state, contact)) = looks.states.first().zip(herpolhode.first().copied()) else {
        return Ok(page);
    };
    // ω is seen to the right of L
    let aside = if contact.xy().norm() > 0.0 { libm::atan2(-contact.x, contact.y) } else { 0.5 };
    let (azimuth, elevation) = match plot.view {
        Some([azimuth, elevation]) => (azimuth.to_radians(), elevation.to_radians()),
        None => (aside, 0.24),
    };
    let (sin, cos) = libm::sincos(elevation.abs());
    let corner = core::f64::consts::SQRT_2 * scene.plane();
    let top = scene.semi_axes[0];
    let below = (LOWER * scene.distance * cos).max(scene.distance * cos + corner * sin);
    let unit = (0.5 * (width - 30.0) / corner.max(top)).min(room / (top + below));
    let centre = [0.5 * width, head + unit * top];
    let view = View::from_angles(centre, unit, azimuth, elevation);

    let bottom = V::new(0.0, 0.0, -scene.distance);
    let half = scene.plane();
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let corners = corners.map(|[x, y]| view.place(bottom + V::new(x, y, 0.0))).to_vec();
    page.as_class("plane", |page| {
        page.area(corners, Some(Fill::Flat(PLANE, 1.0)), Some(Stroke::new(GREY, 0.8)));
    });
    page.as_class("herpolhode", |page| view.line(page, &herpolhode, ORANGE, 1.4, false));

    let to_page = scene.upright * state.rotation();
    let stretch = Matrix3::from_diagonal(&V::from(scene.semi_axes));
    let place = |u: V| to_page * (scene.frame * (stretch * u));
    let shrink = Matrix3::from_diagonal(&V::from(scene.semi_axes.map(f64::recip)));
    let normal = |v: V| {
        let u = shrink * (scene.frame.inverse() * (to_page.inverse() * v));
        to_page * (scene.frame * (shrink * u))
    };
    // the outline: where the normal is at right angles to the line of sight
    let sight = shrink * (scene.frame.inverse() * (to_page.inverse() * view.towards()));
    let outline = ring(sight.normalize()).map(|u| view.place(place(u))).collect();
    page.as_class("ellipsoid", |page| {
        page.area(outline, Some(Fill::Flat(BODY, 0.78)), Some(Stroke::new(GREY, 1.2)));
    });
    // what the body hides of it is dashed
    page.as_class("herpolhode", |page| view.line(page, &herpolhode, ORANGE, 1.6, true));
    for axis in 0..3 {
        let section: Vec<V> = ring(V::ith(axis, 1.0)).map(place).collect();
        view.curve_on(&mut page, &section, normal, Colour(140, 155, 170), 0.9);
    }
    let polhode: Vec<V> = looks.omegas.iter().map(|omega| to_page * omega).collect();
    page.as_class("polhode", |page| view.curve_on(page, &polhode, normal, BLUE, 2.0));
    view.arrow(&mut page, V::zeros(), contact, BLACK, "");
    let [x, y] = view.place(contact * 0.55);
    page.note([x + 8.0, y], "ω", 16.0, polhode_pages::figure::Anchor::Start);
    view.arrow(&mut page, V::zeros(), bottom * LOWER, GREEN, "L");
    page.as_class("point", |page| page.circle(view.place(contact), 3.4, Some(Fill::Flat(BLACK, 1.0)), None));
    if !spins {
        let key = "blue: polhode on the ellipsoid; orange: herpolhode on the plane";
        page.text([0.5 * width, height - 10.0], key, 12.0, polhode_pages::figure::Anchor::Middle, BLACK);
    }
    Ok(page)
}

/// The unit circle across `axis`.
fn ring(axis: V) -> impl Iterator<Item = V> {
    let first = axis.cross(&V::ith(axis.iamin(), 1.0)).normalize();
    let second = axis.cross(&first);
    (0..=180).map(move |k| {
        let (sin, cos) = libm::sincos(core::f64::consts::TAU * f64::from(k) / 180.0);
        first * cos + second * sin
    })
}
