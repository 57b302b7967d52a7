//! Named bodies with their sources, for tests, benches and experiments alike.
//!
//! Moments are in kg m² where the body has a size and dimensionless where only ratios are known; free motion does
//! not tell the difference. Each comes with the start that the experiments give it. Tops have a fixed point, which
//! their moments are about, and a weight.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::body::{Body, Force, Orbit, Wheel, WheelAtStart};
use crate::error::Error;
use crate::flow::{Mode, TumblingElements};
use crate::inertia::{Amount, Inertia, MassError, MassProperties, Solid};
use crate::rotation::{EulerSequence, Quat};

mod hyperion;

/// A catalogued body.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct NamedBody {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is.
    pub summary: &'static str,
    /// Where its moments come from.
    pub source: &'static str,
    /// `kg m^2`, or `ratio` where only ratios are known.
    pub unit: &'static str,
    /// Its inertia, in principal axes.
    pub inertia: Inertia,
    /// Weight times centre of mass, body axes, N m; zero for a free body.
    pub weight_moment: [f64; 3],
    /// Attitude at the start of the reference motion, from body axes to those of `orientation`, w, x, y, z; the identity where
    /// none is known.
    pub attitude: [f64; 4],
    /// What the attitude refers to, if it is known.
    pub orientation: Option<Orientation>,
    /// Angular velocity of the reference motion, body axes, rad/s.
    pub omega_body: [f64; 3],
    /// The orbit whose gravity gradient turns it, of a body that has no free motion.
    pub orbit: Option<NamedOrbit>,
    /// The wheels that it carries, which its inertia includes.
    pub wheels: Vec<WheelAtStart>,
}

/// The orbit of a catalogued body.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct NamedOrbit {
    /// What it goes round.
    pub primary: &'static str,
    /// Mean motion, rad/s.
    pub mean_motion: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Mean anomaly at the start of the reference motion, rad.
    pub mean_anomaly: f64,
    /// Where they come from.
    pub source: &'static str,
    /// The orbit in the axes of space of the attitude, from t = 0 at that start.
    pub orbit: Orbit,
}

/// What the attitude of a catalogued body refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Orientation {
    /// The axes of space.
    pub frame: &'static str,
    /// The date of the reference motion's start with its time scale, if it has one.
    pub epoch: Option<&'static str>,
    /// Where the attitude comes from.
    pub source: &'static str,
}

impl NamedBody {
    /// What is known of the attitude at the start, in words.
    ///
    /// ```
    /// use polhode::catalogue::body;
    /// let words = |name: &str| body(name).map(|found| found.attitude_known());
    /// assert_eq!(words("toutatis").as_deref(), Some("attitude in the frame ecliptic J2000 at 1992-11-09T17:49:47 UTC"));
    /// assert_eq!(words("phone").as_deref(), Some("attitude unknown, taken as the identity"));
    /// ```
    pub fn attitude_known(&self) -> String {
        match self.orientation {
            Some(Orientation { frame, epoch: Some(epoch), .. }) => {
                format!("attitude in the frame {frame} at {epoch}")
            }
            Some(Orientation { frame, .. }) => format!("attitude in the frame {frame}"),
            None => "attitude unknown, taken as the identity".into(),
        }
    }

    /// The body with its weight, the gravity gradient of its orbit and its wheels, which have their speeds at the start of the reference
    /// motion.
    ///
    /// # Errors
    /// None of the catalogue's.
    pub fn body(&self) -> Result<Body, Error> {
        let body = Body::heavy(self.inertia.clone(), self.weight_moment.into())?;
        let body = body.with_wheels_at_start(&self.wheels, 0.0, self.omega_body.into())?;
        Ok(match &self.orbit {
            Some(named) => body.with(Force::gravity_gradient_on(named.orbit.clone())),
            None => body,
        })
    }
}

struct Entry {
    name: &'static str,
    summary: &'static str,
    source: &'static str,
    unit: &'static str,
    moments: Result<[f64; 3], MassError>,
    omega_body: [f64; 3],
    /// Attitude and what it refers to, where it is known.
    attitude: Option<([f64; 4], Orientation)>,
}

/// A body with a fixed point.
struct Top {
    entry: Entry,
    weight_moment: [f64; 3],
}

const SI: &str = "kg m^2";
const RATIO: &str = "ratio";

/// All bodies without a fixed point, real ones first.
///
/// ```
/// let names: Vec<_> = polhode::catalogue::bodies().iter().map(|body| body.name).collect();
/// assert_eq!(names[0], "toutatis");
/// ```
pub fn bodies() -> Vec<NamedBody> {
    entries().into_iter().filter_map(Entry::build).collect()
}

/// All tops, toys first.
///
/// ```
/// assert!(polhode::catalogue::tops().iter().any(|top| top.name == "bicycle-wheel"));
/// ```
pub fn tops() -> Vec<NamedBody> {
    top_entries().into_iter().filter_map(Top::build).collect()
}

/// The top called `name`.
///
/// ```
/// use polhode::flow::LagrangeTop;
/// let wheel = polhode::catalogue::top("bicycle-wheel").ok_or("not in the catalogue")?;
/// let motion = LagrangeTop::from_omega(&wheel.body()?, Default::default(), wheel.omega_body.into())?;
/// assert!(motion.nutation_period().is_none()); // upright, it sleeps
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn top(name: &str) -> Option<NamedBody> {
    top_entries().into_iter().find(|top| top.entry.name == name).and_then(Top::build)
}

/// The body without a fixed point called `name`.
///
/// ```
/// use polhode::catalogue::body;
/// let toutatis = body("toutatis").ok_or("not in the catalogue")?;
/// assert_eq!(toutatis.unit, "ratio"); // only ratios of its moments are known
/// assert!(body("no-such-body").is_none());
/// # Ok::<(), polhode::Error>(())
/// ```
pub fn body(name: &str) -> Option<NamedBody> {
    entries().into_iter().find(|entry| entry.name == name).and_then(Entry::build)
}

impl Entry {
    fn build(self) -> Option<NamedBody> {
        let Entry { name, summary, source, unit, moments, omega_body, attitude } = self;
        let inertia = Inertia::from_moments(moments.ok()?).ok()?;
        let weight_moment = [0.0; 3];
        let orientation = attitude.map(|(_, orientation)| orientation);
        let attitude = attitude.map_or([1.0, 0.0, 0.0, 0.0], |(attitude, _)| attitude);
        Some(NamedBody {
            name,
            summary,
            source,
            unit,
            inertia,
            weight_moment,
            attitude,
            orientation,
            omega_body,
            orbit: hyperion::orbit(name),
            wheels: wheels(name).unwrap_or_default(),
        })
    }
}

impl Top {
    fn build(self) -> Option<NamedBody> {
        let Top { entry, weight_moment } = self;
        Some(NamedBody { weight_moment, ..entry.build()? })
    }
}

fn entries() -> Vec<Entry> {
    let mut all = Vec::from(states());
    all.splice(1..1, tumblers().chain(hyperion::entries()));
    all
}

/// Bodies that are published by the elements of their light curves.
fn tumblers() -> impl Iterator<Item = Entry> {
    const HOUR: f64 = 3600.0;
    const DAY: f64 = 86_400.0;
    let degrees = |angles: [f64; 2]| angles.map(f64::to_radians);
    let apophis = TumblingElements::new(Mode::ShortAxis, [27.38 * HOUR, 263.0 * HOUR])
        .with_pole(degrees([250.0, -75.0]))
        .with_angles(degrees([152.0, 14.0]));
    let halley = TumblingElements::new(Mode::LongAxis, [3.69 * DAY, 7.1 * DAY]);
    const MINUTE: f64 = 60.0;
    // of a uniform ellipsoid of 14.9 by 8.0 by 6.2 m, over the largest
    let [a, b, c] = [14.9 * 14.9, 8.0 * 8.0, 6.2 * 6.2];
    let tc4_moments = [(b + c) / (a + b), (a + c) / (a + b), 1.0];
    let tc4 = TumblingElements::new(Mode::LongAxis, [12.25 * MINUTE, 8.47 * MINUTE]);
    // of a uniform ellipsoid of 6 by 1 by 1
    let oumuamua_moments = [2.0 / 37.0, 1.0, 1.0];
    let oumuamua = TumblingElements::new(Mode::LongAxis, [8.67 * HOUR, 54.48 * HOUR]);
    let apophis_source = "Pravec et al., Icarus 233 (2014) 48: pole 250, -75, phases 152, 14 degrees, light time taken off; periods 27.38 and 263 h (3 sigma: 0.07 and 6 h, pole within 27 by 14 degrees)";
    let listed = [
        (
            "apophis",
            "asteroid 99942 Apophis, tumbling in short-axis mode; ratios of moments",
            apophis_source,
            [0.61, 0.965, 1.0],
            apophis,
            Some(Orientation {
                frame: "ecliptic J2000",
                epoch: Some("2456284.676388 UTC"),
                source: apophis_source,
            }),
        ),
        (
            "2012-tc4",
            "asteroid 2012 TC4, tumbling in long-axis mode; ratios of moments, pole and phases unknown",
            "Urakawa et al., arXiv:1903.05687: precession 12.25 and rotation 8.47 min, both +- 0.01 min, axes 14.9, 8.0 and 6.2 m; as an ellipsoid of uniform density",
            tc4_moments,
            tc4,
            None,
        ),
        (
            "halley",
            "nucleus of comet 1P/Halley, tumbling in long-axis mode; ratios of moments, pole and phases unknown",
            "Belton et al., Icarus 93 (1991) 183: periods 3.69 and 7.1 d, long axis 66 degrees from the angular momentum; as a symmetric body, whose ratio follows from these",
            [1.0, 2.278, 2.278],
            halley,
            None,
        ),
        (
            "oumuamua",
            "interstellar object 1I/'Oumuamua, the likeliest of its long-axis modes; ratios of moments, pole and phases unknown",
            "Belton et al., arXiv:1804.03471: long axis round the angular momentum in 8.67 +- 0.34 h, body round it in 54.48 h; as an ellipsoid of uniform density, 6 +- 1 : 1 : 1 of McNeill, Trilling and Mommert, arXiv:1803.09864",
            oumuamua_moments,
            oumuamua,
            None,
        ),
    ];
    listed.into_iter().filter_map(|(name, summary, source, moments, elements, orientation)| {
        let body = Body::free(Inertia::from_moments(moments).ok()?);
        let start = elements.point(body.inertia()).ok()?;
        let attitude = body.leave(&start).attitude.components();
        Some(Entry {
            name,
            summary,
            source,
            unit: RATIO,
            moments: Ok(moments),
            omega_body: body.omega_of(&start).into(),
            attitude: orientation.map(|orientation| (attitude, orientation)),
        })
    })
}

/// The wheels of the body `name`, which turn freely: three along its axes, of 50 N m s at 6000 rpm.
fn wheels(name: &str) -> Option<Vec<WheelAtStart>> {
    const RPM: f64 = core::f64::consts::PI / 30.0;
    if name != BSK_SAT {
        return None;
    }
    let wheel = |(axis, speed): (usize, f64)| {
        let along = Vector3::ith(axis, 1.0);
        Wheel::new(along, 50.0 / (6000.0 * RPM), speed * RPM).ok().map(WheelAtStart::free)
    };
    [100.0, 200.0, 300.0].into_iter().enumerate().map(wheel).collect()
}

const BSK_SAT: &str = "bsk-sat";

const BSK_SAT_START: Orientation = Orientation {
    frame: "inertial axes of the example",
    epoch: None,
    source: "modified Rodrigues parameters 0.1, 0.2, -0.3 of the example",
};

fn states() -> [Entry; 12] {
    // °/day to rad/s
    const DEGREE_PER_DAY: f64 = core::f64::consts::PI / 180.0 / 86_400.0;
    [
        Entry {
            name: "toutatis",
            summary: "asteroid 4179 Toutatis, tumbling about its long axis; ratios of moments",
            source: "Takahashi, Busch and Scheeres, Astron. J. 146 (2013) 95; spin of 1992-11-09",
            unit: RATIO,
            moments: Ok([1.0, 3.0836, 3.235]),
            omega_body: [-98.5 * DEGREE_PER_DAY, 14.5 * DEGREE_PER_DAY, 33.7 * DEGREE_PER_DAY],
            attitude: Some((toutatis(), TOUTATIS)),
        },
        Entry {
            name: "racket",
            summary: "tennis racket, thrown to turn about its middle axis; ratios of moments",
            source: "fit to tosses of a racket with a gyroscope (data: doi 10.14288/1.0448943); axes handle, face, normal",
            unit: RATIO,
            moments: Ok([0.0389, 0.4619, 0.4993]),
            omega_body: [0.3, 15.0, 0.2],
            attitude: None,
        },
        Entry {
            name: "t-handle",
            summary: "aluminium T: bar 80 mm and stem 40 mm, 10 mm thick; flips when spun about its stem",
            source: "closed form of two solid cylinders, 2700 kg/m^3; axes stem, bar, normal",
            unit: SI,
            moments: t_handle(),
            omega_body: [20.0, 0.02, 0.01],
            attitude: None,
        },
        Entry {
            name: "phone",
            summary: "telephone as a uniform box, 146.7 x 71.5 x 7.7 mm, 164 g, tossed about its middle axis",
            source: "closed form of a solid box; axes along length, width, thickness",
            unit: SI,
            moments: phone(),
            omega_body: [0.2, 10.0, 0.3],
            attitude: None,
        },
        Entry {
            name: "water",
            summary: "water molecule as three point masses, a planar body of 1e-47 kg m^2",
            source: "OH 95.72 pm, angle 104.52 degrees: Benedict, Gailar and Plyler, J. Chem. Phys. 24 (1956) 1139; axes a, b, c",
            unit: SI,
            moments: water(),
            omega_body: [2.0e13, 1.0e13, 0.5e13],
            attitude: None,
        },
        Entry {
            name: "spacecraft",
            summary: "SPHERES satellite of the space station, nearly symmetric",
            source: "CAD values of the SPHERES satellites as quoted by Setterfield, MIT thesis (2018)",
            unit: SI,
            moments: Ok([2.41e-2, 2.34e-2, 2.01e-2]),
            omega_body: [0.3, 1.0, 0.4],
            attitude: None,
        },
        Entry {
            name: BSK_SAT,
            summary: "example spacecraft with a freely turning reaction wheel along each axis",
            source: "Basilisk (github.com/AVSLab/basilisk), examples/scenarioAttitudeFeedbackRW.py, without its control and gravity: wheels Honeywell HR16 of 50 N m s at 6000 rpm, at 100, 200 and 300 rpm",
            unit: SI,
            moments: Ok([900.0, 800.0, 600.0]),
            omega_body: [0.001, -0.01, 0.03],
            // (1 - s^2, 2 s)/(1 + s^2) with s^2 = 0.14
            attitude: Some(([0.86 / 1.14, 0.2 / 1.14, 0.4 / 1.14, -0.6 / 1.14], BSK_SAT_START)),
        },
        Entry {
            name: "textbook",
            summary: "moments 1, 2, 3: planar, and the body of most published comparisons",
            source: "by definition",
            unit: RATIO,
            moments: Ok([1.0, 2.0, 3.0]),
            omega_body: [0.4, 1.0, -0.3],
            attitude: None,
        },
        Entry {
            name: "dyadic",
            summary: "moments 5/8, 3/4, 1, exact in binary, so that input rounding masks nothing",
            source: "dyadic twin of the driver of Hairer and Vilmart, J. Phys. A 39 (2006) 13225",
            unit: RATIO,
            moments: Ok([0.625, 0.75, 1.0]),
            omega_body: [2.8, 0.5, -0.875],
            attitude: None,
        },
        Entry {
            name: "prolate",
            summary: "symmetric and elongated",
            source: "by definition",
            unit: RATIO,
            moments: Ok([1.0, 1.0, 0.25]),
            omega_body: [0.3, 0.0, 1.0],
            attitude: None,
        },
        Entry {
            name: "oblate",
            summary: "symmetric and flat: a disk",
            source: "by definition",
            unit: RATIO,
            moments: Ok([1.0, 1.0, 2.0]),
            omega_body: [0.3, 0.0, 1.0],
            attitude: None,
        },
        Entry {
            name: "sphere",
            summary: "all moments equal: turns about a fixed axis whatever the spin",
            source: "by definition",
            unit: RATIO,
            moments: Ok([1.0, 1.0, 1.0]),
            omega_body: [0.3, 0.5, 1.0],
            attitude: None,
        },
    ]
}

const TOUTATIS: Orientation = Orientation {
    frame: "ecliptic J2000",
    epoch: Some("1992-11-09T17:49:47 UTC"),
    source: "3-1-3 angles of Takahashi, Busch and Scheeres, Astron. J. 146 (2013) 95, with body axes middle, short, long, as quoted in the tests of Principia; they give the pole 180.2, -54.75 degrees of Zhao et al., arXiv:1504.02024, to 0.3 degrees",
};

fn toutatis() -> [f64; 4] {
    let degrees = core::f64::consts::PI / 180.0;
    by_middle_short_long([147.5, 63.9, 241.5].map(|angle| angle * degrees))
}

/// The attitude by angles z-x-z, rad, of axes along the middle, the short and the long axis; ours are long, middle, short.
fn by_middle_short_long(angles: [f64; 3]) -> [f64; 4] {
    let published = EulerSequence::default().attitude(angles);
    // x to z, y to x, z to y
    let named = UnitQuaternion::new_unchecked(Quaternion::new(0.5, -0.5, -0.5, -0.5));
    Quat::<f64>::from(published * named).components()
}

/// Tops stand where their problem puts them.
const UPRIGHT: Orientation =
    Orientation { frame: "gravity along -z", epoch: None, source: "by definition of the problem" };

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;

fn top_entries() -> [Top; 4] {
    // turned about x by the angle in rad
    let tilted = |angle: f64| {
        let (sin, cos) = libm::sincos(0.5 * angle);
        [cos, sin, 0.0, 0.0]
    };
    let degrees = core::f64::consts::PI / 180.0;
    [
        Top {
            entry: Entry {
                name: "gyroscope",
                summary: "toy gyroscope: brass disk of 100 g, 30 mm radius, 40 mm above the tip, tilted by 30 degrees",
                source: "closed form of a solid disk, 8 mm thick, about the tip; frame neglected; axes across, across, axle",
                unit: SI,
                moments: gyroscope(),
                omega_body: [0.0, 0.0, 400.0],
                attitude: Some((tilted(30.0 * degrees), UPRIGHT)),
            },
            weight_moment: [0.0, 0.0, 0.1 * GRAVITY * 0.040],
        },
        Top {
            entry: Entry {
                name: "bicycle-wheel",
                summary: "bicycle wheel of 1.5 kg hung by one end of its level axle, 120 mm from the hub",
                source: "closed form of a hoop of 310 mm radius about the end of the axle; axes across, across, axle",
                unit: SI,
                moments: bicycle_wheel(),
                omega_body: [0.0, 0.0, 25.0],
                attitude: Some((tilted(90.0 * degrees), UPRIGHT)),
            },
            weight_moment: [0.0, 0.0, 1.5 * GRAVITY * 0.120],
        },
        Top {
            entry: Entry {
                name: "simo-wong",
                summary: "fast top next to upright, a test problem of structural dynamics",
                source: "Simo and Wong, Int. J. Numer. Meth. Engng. 31 (1991) 19",
                unit: SI,
                moments: Ok([5.0, 5.0, 1.0]),
                omega_body: [0.0, 0.0, 50.0],
                attitude: Some((tilted(0.05), UPRIGHT)),
            },
            weight_moment: [0.0, 0.0, 20.0],
        },
        Top {
            entry: Entry {
                name: "bruls-cardona",
                summary: "top that starts with its axis level, a test problem of multibody dynamics",
                source: "Bruls and Cardona, J. Comput. Nonlinear Dyn. 5 (2010) 031002; moments about the fixed point",
                unit: SI,
                moments: Ok([15.234_375, 0.468_75, 15.234_375]),
                omega_body: [0.0, 150.0, -4.615_38],
                attitude: Some((tilted(0.0), UPRIGHT)),
            },
            weight_moment: [0.0, 15.0 * 9.81, 0.0],
        },
    ]
}

/// Moments about the body axes of parts that lie symmetrically to them.
fn on_axes(tensor: Matrix3<f64>) -> [f64; 3] {
    tensor.diagonal().into()
}

fn phone() -> Result<[f64; 3], MassError> {
    Ok(on_axes(Solid::Box([0.1467, 0.0715, 0.0077]).with(Amount::Mass(0.164))?.tensor()))
}

/// About the tip of the axle.
fn gyroscope() -> Result<[f64; 3], MassError> {
    let disk = Solid::Cylinder { radius: 0.030, height: 0.008 }.with(Amount::Mass(0.1))?;
    disk.tensor_about(Vector3::new(0.0, 0.0, -0.040)).map(on_axes)
}

/// About the end of the axle.
fn bicycle_wheel() -> Result<[f64; 3], MassError> {
    let hoop = Solid::Hoop { radius: 0.310 }.with(Amount::Mass(1.5))?;
    hoop.tensor_about(Vector3::new(0.0, 0.0, -0.120)).map(on_axes)
}

/// A bar along y and a stem along x that ends on its middle.
fn t_handle() -> Result<[f64; 3], MassError> {
    let radius = 0.005;
    let cylinder = |height| Solid::Cylinder { radius, height }.with(Amount::Density(2700.0));
    let (bar, stem) = (0.08, 0.04);
    // x to y, y to z, z to x
    let cyclic = UnitQuaternion::new_unchecked(Quaternion::new(0.5, 0.5, 0.5, 0.5));
    let bar = cylinder(bar)?.turned(cyclic.inverse());
    let stem = cylinder(stem)?.turned(cyclic).moved(Vector3::new(radius + stem / 2.0, 0.0, 0.0))?;
    Ok(on_axes(MassProperties::sum([bar, stem])?.tensor()))
}

/// Two hydrogen atoms and an oxygen atom: axis a joins the hydrogen atoms, b is the symmetry axis.
fn water() -> Result<[f64; 3], MassError> {
    const UNIT: f64 = 1.660_539_068_92e-27; // kg, CODATA 2022
    let (hydrogen, oxygen, bond) = (1.007_825_031_9 * UNIT, 15.994_914_619_6 * UNIT, 95.72e-12);
    let (sin, cos) = libm::sincos(104.52 / 2.0 * core::f64::consts::PI / 180.0);
    let [left, right] = [-1.0, 1.0].map(|side| (hydrogen, Vector3::new(side * sin, cos, 0.0) * bond));
    Ok(on_axes(MassProperties::of_points([(oxygen, Vector3::zeros()), left, right])?.tensor()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::FreeMotion;

    pub(super) fn attitude_of(named: &NamedBody) -> UnitQuaternion<f64> {
        Quat::from_components(named.attitude).into()
    }

    pub(super) fn motion_of(named: &NamedBody) -> FreeMotion {
        FreeMotion::from_omega(&named.inertia, attitude_of(named), named.omega_body.into()).unwrap()
    }

    #[test]
    fn every_entry_is_a_valid_body() {
        assert_eq!(bodies().len(), entries().len());
        assert_eq!(tops().len(), top_entries().len());
        assert!(bodies().iter().chain(&tops()).all(|named| named.body().is_ok()));
    }

    /// Zhao et al., arXiv:1504.02024: the pole of the angular momentum, which does not come from these angles.
    #[test]
    fn toutatis_points_to_its_published_pole() {
        let motion = motion_of(&body("toutatis").unwrap());
        let [longitude, latitude] = motion.tumbling().unwrap().pole.map(f64::to_degrees);
        assert!((longitude.rem_euclid(360.0) - 180.2).abs() < 0.3, "{longitude}");
        assert!((latitude + 54.75).abs() < 0.3, "{latitude}");
    }

    /// Each paper's other figures come out of the elements that it gives.
    #[test]
    fn tumblers_reproduce_the_figures_of_their_papers() {
        let motion = |name: &str| motion_of(&body(name).unwrap());
        let apophis = motion("apophis");
        let elements = apophis.tumbling().unwrap();
        // P_1 = 30.56 +- 0.01 h and 2E I_3/L^2 = 1.024 +- 0.013
        assert!((elements.combined_period() / 3600.0 - 30.56).abs() < 0.01);
        let momentum = apophis.at(0.0).unwrap().momentum().norm();
        assert!((apophis.character().unwrap().spin / momentum - 1.024).abs() < 0.013);
        let [longitude, latitude] = elements.pole.map(f64::to_degrees);
        assert!((longitude.rem_euclid(360.0) - 250.0).abs() < 1e-9 && (latitude + 75.0).abs() < 1e-9);
        let tc4 = motion("2012-tc4").tumbling().unwrap();
        assert_eq!(tc4.mode, Mode::LongAxis);
        assert!((tc4.precession_period / 60.0 - 12.25).abs() < 1e-6);
        assert!((tc4.rotation_period / 60.0 - 8.47).abs() < 1e-6);
        // the frequencies of the light curve, 2.77 +- 0.11 and 6.42 +- 0.18 cycles a day: the long axis once round L, and either end of
        // the turning body
        let oumuamua = motion("oumuamua").tumbling().unwrap();
        assert_eq!(oumuamua.mode, Mode::LongAxis);
        assert!((86_400.0 / oumuamua.precession_period - 2.77).abs() < 0.005);
        assert!((2.0 * 86_400.0 / oumuamua.combined_period() - 6.42).abs() < 0.005);
        let halley = motion("halley");
        let [least, most] = halley.tilt_range().unwrap().map(f64::to_degrees);
        assert!((least - 66.0).abs() < 0.5 && (most - 66.0).abs() < 0.5, "{least} {most}");
        let periods =
            [halley.tumbling().unwrap().precession_period, halley.tumbling().unwrap().rotation_period];
        assert!((periods[0] / 86_400.0 - 3.69).abs() < 1e-6 && (periods[1] / 86_400.0 - 7.1).abs() < 1e-6);
    }

    #[test]
    fn water_has_the_moments_of_its_spectrum() {
        // h/(8π² c B) of the equilibrium rotational constants is near 1.02, 1.92, 2.94 in 1e-47 kg m²
        let moments = body("water").unwrap().inertia.principal_moments();
        for (moment, expected) in moments.into_iter().zip([1.02e-47, 1.92e-47, 2.94e-47]) {
            approx::assert_relative_eq!(moment, expected, max_relative = 0.01);
        }
    }
}
