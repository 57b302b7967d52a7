//! A tumbling body in the quantities that light curves are analysed in.

use thiserror::Error;

use super::character::Mode;
use super::motion::FreeMotion;
use crate::body::{Body, Point};
use crate::inertia::Inertia;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// The motion of a tumbling asteroid or satellite at the epoch t = 0, as light-curve work states it.
///
/// Body axes z' (the axis of the mode: of the smallest moment in long-axis mode, of the largest in short-axis mode), x' and y'
/// follow each other cyclically. φ, θ, ψ are their Euler angles z-x-z in a frame with Z along the angular momentum L and
/// X = R_z(λ) R_y(90° − β) e_x, λ and β being longitude and latitude of L in space, ecliptic where space is. θ nods between
/// [two limits](FreeMotion::tilt_range) that the moments and the periods determine.
///
/// Source: M. Kaasalainen, Astron. Astrophys. 376 (2001) 302; N. H. Samarasinha and M. F. A'Hearn, Icarus 93 (1991) 194.
///
/// ```
/// use polhode::flow::{FreeMotion, Mode, TumblingElements};
/// use polhode::inertia::Inertia;
/// let ratios = Inertia::from_moments([0.61, 0.965, 1.0])?; // (99942) Apophis
/// let [periods, pole, angles] = [[27.38, 263.0], [250.0, -75.0], [152.0, 14.0]]; // h, degrees
/// let published = TumblingElements::new(Mode::ShortAxis, periods)
///     .with_pole(pole.map(f64::to_radians))
///     .with_angles(angles.map(f64::to_radians));
/// let motion = FreeMotion::from_point(&ratios, published.point(&ratios)?);
/// let found = motion.tumbling().ok_or("it tumbles")?;
/// assert!((found.rotation_period / 263.0 - 1.0).abs() < 1e-12);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TumblingElements {
    /// [`Mode::LongAxis`] or [`Mode::ShortAxis`].
    pub mode: Mode,
    /// P_φ, mean period in which the axis z' goes once round L.
    pub precession_period: f64,
    /// P_ψ, period in which L goes once round z' in the body.
    pub rotation_period: f64,
    /// Longitude λ and latitude β of L in space, rad.
    pub pole: [f64; 2],
    /// φ and ψ at t = 0, rad.
    pub angles: [f64; 2],
    /// Whether z' points away from L, so that θ is above 90°.
    pub is_reversed: bool,
}

/// Why no motion has these elements.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TumblingError {
    /// The mode is none of the two, or the body has no such mode.
    #[error("no {} motion with the moments {}, {}, {}; {}", .mode.name(), .moments[0], .moments[1], .moments[2],
        "long-axis mode needs one moment below the other two, short-axis mode one above them")]
    Mode {
        /// The mode.
        mode: Mode,
        /// Principal moments in the order in which they were given; of a tensor, ascending.
        moments: [f64; 3],
    },
    /// A period, or an angle, is not usable.
    #[error("{quantity} is {value}; periods must be above 0, and all numbers finite")]
    Value {
        /// Which quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// P_1 leaves no other period.
    #[error(
        "P_1 = {combined:?} and the other period, {other:?}, contradict each other; in {} mode 1/P_1 = 1/P_phi {} 1/P_psi",
        .mode.name(),
        if *.mode == Mode::LongAxis { "+" } else { "-" }
    )]
    Combined {
        /// The mode.
        mode: Mode,
        /// P_1.
        combined: f64,
        /// The other period that was given.
        other: f64,
    },
    /// The periods do not fit the moments.
    #[error(
        "P_psi/P_phi = {ratio:?}; for these moments in {} mode it must be above {least:?} and below about {most:.1}",
        .mode.name()
    )]
    Ratio {
        /// P_ψ/P_φ.
        ratio: f64,
        /// The mode.
        mode: Mode,
        /// That of a spin about the axis of the mode, the least.
        least: f64,
        /// That next to the separatrix, in double precision.
        most: f64,
    },
}

/// Which of the solver's axes is z' of the mode, and which the axis of the middle moment.
fn axes(moments: Vec3<Dd>, mode: Mode) -> Option<(usize, usize)> {
    let [smallest, middle, largest] = moments.ascending();
    let axis = match mode {
        Mode::LongAxis => smallest,
        Mode::ShortAxis => largest,
        Mode::Separatrix | Mode::Steady => return None,
    };
    (moments[axis] != moments[middle]).then_some((axis, middle))
}

/// The turn that takes x', y', z' to the solver's axes.
fn cyclic(axis: usize) -> Quat<Dd> {
    let (half, minus) = (Dd::of(0.5), Dd::of(-0.5));
    match axis {
        0 => Quat::new(half, Vec3([half; 3])),
        1 => Quat::new(half, Vec3([minus; 3])),
        _ => Quat::identity(),
    }
}

/// Of 1/P_ψ in 1/P_1.
fn sign(mode: Mode) -> f64 {
    if mode == Mode::LongAxis { 1.0 } else { -1.0 }
}

fn turn(axis: usize, angle: Dd) -> Quat<Dd> {
    let (sin, cos) = (angle * 0.5).sin_cos();
    Quat::new(cos, Vec3::unit(axis) * sin)
}

/// The turn that takes Z to the direction of L.
fn to_pole(longitude: Dd, latitude: Dd) -> Quat<Dd> {
    turn(2, longitude) * turn(1, Dd::FRAC_PI_2 - latitude)
}

impl TumblingElements {
    /// Of a motion with the periods `[P_φ, P_ψ]` in this mode, in one unit of time: L along z of space, both angles 0 at t = 0,
    /// z' on the side of L.
    #[must_use]
    pub fn new(mode: Mode, [precession_period, rotation_period]: [f64; 2]) -> Self {
        let (pole, angles) = ([0.0, core::f64::consts::FRAC_PI_2], [0.0; 2]);
        TumblingElements { mode, precession_period, rotation_period, pole, angles, is_reversed: false }
    }

    /// The same by `[P_φ, P_1]`, P_1 being the [combined period](Self::combined_period).
    ///
    /// # Errors
    /// Periods that leave no positive P_ψ.
    pub fn from_precession_and_combined(
        mode: Mode,
        [precession, combined]: [f64; 2],
    ) -> Result<Self, TumblingError> {
        let rate = (1.0 / combined - 1.0 / precession) * sign(mode);
        Self::with_rate(mode, combined, precession, rate, |rotation| [precession, rotation])
    }

    /// The same by `[P_1, P_ψ]`.
    ///
    /// # Errors
    /// Periods that leave no positive P_φ.
    pub fn from_combined_and_rotation(
        mode: Mode,
        [combined, rotation]: [f64; 2],
    ) -> Result<Self, TumblingError> {
        let rate = 1.0 / combined - sign(mode) / rotation;
        Self::with_rate(mode, combined, rotation, rate, |precession| [precession, rotation])
    }

    fn with_rate(
        mode: Mode,
        combined: f64,
        other: f64,
        rate: f64,
        periods: impl Fn(f64) -> [f64; 2],
    ) -> Result<Self, TumblingError> {
        if !(rate.is_finite() && rate > 0.0) {
            return Err(TumblingError::Combined { mode, combined, other });
        }
        Ok(Self::new(mode, periods(1.0 / rate)))
    }

    /// P_1, with 1/P_1 = 1/P_φ + 1/P_ψ in long-axis mode and 1/P_φ − 1/P_ψ in short-axis mode: twice its frequency often leads in a
    /// light curve. In short-axis mode it is the mean period in which the *long* axis goes round L, P_φ of papers that follow the
    /// long axis in either mode.
    ///
    /// Sources: P. Pravec et al., Icarus 173 (2005) 108; N. H. Samarasinha and B. E. A. Mueller, Icarus 248 (2015) 347.
    #[must_use]
    pub fn combined_period(&self) -> f64 {
        1.0 / (1.0 / self.precession_period + sign(self.mode) / self.rotation_period)
    }

    /// With longitude λ and latitude β of L in space, rad.
    #[must_use]
    pub fn with_pole(self, pole: [f64; 2]) -> Self {
        TumblingElements { pole, ..self }
    }

    /// With φ and ψ at t = 0, rad.
    #[must_use]
    pub fn with_angles(self, angles: [f64; 2]) -> Self {
        TumblingElements { angles, ..self }
    }

    /// With z' pointing away from L, or not.
    #[must_use]
    pub fn with_reversed(self, is_reversed: bool) -> Self {
        TumblingElements { is_reversed, ..self }
    }

    /// The point of the solver frame at t = 0 of a body with `inertia`, of which only the ratios matter.
    ///
    /// # Errors
    /// A mode that the body does not have, values that are not usable, and periods that do not fit the moments.
    pub fn point(&self, inertia: &Inertia) -> Result<Point<Dd>, TumblingError> {
        self.check()?;
        let moments: Vec3<Dd> = Body::free(inertia.clone()).rotor().moments();
        let Some((axis, middle)) = axes(moments, self.mode) else {
            return Err(TumblingError::Mode { mode: self.mode, moments: inertia.moments_along_axes() });
        };
        let inverse = |k: usize| Dd::ONE / moments[k];
        // the momentum of size 1 that leans by `tilt` from the axis to that of the middle moment
        let periods = |tilt: f64| {
            let (sin, cos) = Dd::of(tilt).sin_cos();
            let momentum = Vec3::unit(axis) * cos + Vec3::unit(middle) * sin;
            let found = FreeMotion::from_point(inertia, Point::new(Quat::identity(), momentum)).character();
            let found = found.ok()?;
            Some((found.precession_rate?.abs(), found.polhode_period?))
        };
        let ratio = |tilt| periods(tilt).map(|(rate, period)| rate * period / core::f64::consts::TAU);
        let tilt = self.tilt(moments, axis, ratio)?;
        let period = periods(tilt).map_or(f64::NAN, |(_, period)| period);
        let norm = Dd::of(period) / Dd::of(self.rotation_period);

        let [phi, psi] = self.angles.map(Dd::of);
        let (sin_psi, cos_psi) = psi.sin_cos();
        let across =
            inverse((axis + 1) % 3) * sin_psi * sin_psi + inverse((axis + 2) % 3) * cos_psi * cos_psi;
        let lean = Dd::of(tilt).sin_cos().0;
        let (whole, part) = (inverse(axis) - across, (inverse(axis) - inverse(middle)) * lean * lean);
        let (sin, cos) = ((part / whole).sqrt(), ((whole - part) / whole).sqrt());
        let cos = if self.is_reversed { -cos } else { cos };
        let primed = Vec3([sin * sin_psi, sin * cos_psi, cos]) * norm;
        let [longitude, latitude] = self.pole.map(Dd::of);
        let euler = turn(2, phi) * turn(0, sin.atan2(cos)) * turn(2, psi);
        let cyclic = cyclic(axis);
        let attitude = (to_pole(longitude, latitude) * euler * cyclic.conjugate()).normalized();
        Ok(Point::new(attitude, cyclic.rotate(primed)))
    }

    fn check(&self) -> Result<(), TumblingError> {
        let periods = [("P_phi", self.precession_period), ("P_psi", self.rotation_period)];
        let angles = [self.pole, self.angles].concat();
        let unusable = periods.into_iter().find(|(_, period)| !(period.is_finite() && *period > 0.0));
        let unusable = unusable.or(angles.into_iter().find(|x| !x.is_finite()).map(|x| ("an angle", x)));
        match unusable {
            Some((quantity, value)) => Err(TumblingError::Value { quantity, value }),
            None => Ok(()),
        }
    }

    /// How far L leans from the axis of the mode to the axis of the middle moment, rad: P_ψ/P_φ grows with it.
    fn tilt(
        &self,
        moments: Vec3<Dd>,
        axis: usize,
        ratio: impl Fn(f64) -> Option<f64>,
    ) -> Result<f64, TumblingError> {
        let wanted = self.rotation_period / self.precession_period;
        let (a, b) = (moments[(axis + 1) % 3], moments[(axis + 2) % 3]);
        // rates of a small circulation about the axis, over the spin
        let circulation = ((moments[axis] - a) * (moments[axis] - b) / (a * b)).sqrt();
        let turns = if self.mode == Mode::LongAxis { -Dd::ONE } else { Dd::ONE };
        let least = (Dd::ONE / circulation + turns).to_f64();
        let (mut low, mut high) = (0.0, core::f64::consts::FRAC_PI_2.next_down());
        let most = ratio(high).unwrap_or(f64::INFINITY);
        let outside = TumblingError::Ratio { ratio: wanted, mode: self.mode, least, most };
        if !(wanted > least && wanted < most) {
            return Err(outside);
        }
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                // in the last digits of the bounds the lean is lost
                return ratio(middle).map(|_| middle).ok_or(outside);
            }
            // a lean that is lost in rounding has the ratio of the spin
            if ratio(middle).unwrap_or(least) < wanted { low = middle } else { high = middle }
        }
    }
}

impl FreeMotion {
    /// The elements of a body that tumbles; `None` at rest, of a steady spin and on the separatrix.
    #[must_use]
    pub fn tumbling(&self) -> Option<TumblingElements> {
        let character = self.character().ok()?;
        let (axis, start) = (self.axis_of_mode()?, self.point_at_dd(Dd::ZERO));
        let rotation_period = character.polhode_period?;
        let precession_period = core::f64::consts::TAU / character.precession_rate?.abs();
        let cyclic = cyclic(axis);
        let [x, y, z] = cyclic.rotate_back(start.momentum_body).0;
        let [l_x, l_y, l_z] = start.momentum_space().0;
        let (longitude, latitude) = (l_y.atan2(l_x), l_z.atan2((l_x * l_x + l_y * l_y).sqrt()));
        let axis_in_space = (start.attitude * cyclic).rotate(Vec3::unit(2));
        let [a_x, a_y, _] = to_pole(longitude, latitude).rotate_back(axis_in_space).0;
        Some(TumblingElements {
            mode: character.mode,
            precession_period,
            rotation_period,
            pole: [longitude.to_f64(), latitude.to_f64()],
            angles: [a_x.atan2(-a_y).to_f64(), x.atan2(y).to_f64()],
            is_reversed: z.hi() < 0.0,
        })
    }

    /// The least and the largest angle θ, rad, between the axis of the mode and L; `None` where [`tumbling`](Self::tumbling) is.
    #[must_use]
    pub fn tilt_range(&self) -> Option<[f64; 2]> {
        let (axis, start) = (self.axis_of_mode()?, self.point_at_dd(Dd::ZERO));
        let moments: Vec3<Dd> = self.body().rotor().moments();
        let m = cyclic(axis).rotate_back(start.momentum_body);
        let inverse = [1, 2, 0].map(|k| Dd::ONE / moments[(axis + k) % 3]);
        // (1/I_z' − 2E/L²) L², a sum of terms of one sign
        let lean = m[0] * m[0] * (inverse[2] - inverse[0]) + m[1] * m[1] * (inverse[2] - inverse[1]);
        let angle = |across: Dd| {
            let sin_squared = lean / (inverse[2] - across) / m.norm_squared();
            let rest = Dd::ONE - sin_squared;
            let cos = if rest.hi() > 0.0 { rest.sqrt() } else { Dd::ZERO };
            let cos = if m[2].hi() < 0.0 { -cos } else { cos };
            sin_squared.sqrt().atan2(cos).to_f64()
        };
        let [a, b] = [angle(inverse[0]), angle(inverse[1])];
        Some([a.min(b), a.max(b)])
    }

    /// Which of the solver's axes the momentum circulates about.
    fn axis_of_mode(&self) -> Option<usize> {
        let mode = self.character().ok()?.mode;
        axes(self.body().rotor().moments(), mode).map(|(axis, _)| axis)
    }
}
