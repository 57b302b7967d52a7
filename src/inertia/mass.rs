//! Mass, centre of mass and inertia of a body and of its parts.

use core::ops::RangeInclusive;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::checks::{ROUNDING, check_symmetric, check_triangle, triangle_margins};
use super::principal::frame_quaternion;
use super::symmetric::{Spectrum, Tensor};
use super::{Class, Inertia, InertiaError, MassError, Symmetry};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// Masses and moments for which Dekker products stay clear of both ends of the range.
pub(super) const SIZES: RangeInclusive<f64> = 1e-290..=1e290;
/// Lengths whose squares do.
pub(super) const LENGTHS: RangeInclusive<f64> = 1e-140..=1e140;

/// How much matter a shape holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// Its mass, kg.
    Mass(f64),
    /// Its density: kg/m³ of a solid, kg/m² of a surface, kg/m of a line.
    Density(f64),
}

impl Amount {
    /// The mass of a shape of volume, area or length `measure`.
    pub(super) fn mass(self, measure: f64) -> Result<f64, MassError> {
        match self {
            Amount::Mass(mass) => positive("mass", mass),
            Amount::Density(density) => match positive("density", density)? * measure {
                mass if SIZES.contains(&mass) && measure.is_normal() => Ok(mass),
                _ => Err(MassError::OutOfRange),
            },
        }
    }
}

/// Mass, centre of mass, and inertia tensor about it, all in the axes of one frame.
///
/// Unlike [`Inertia`], which a rotating body needs, this also holds points, rods and plates: a moment may be
/// zero. The law is the same, ½ tr(I)·1 − I ⪰ 0 up to 1e-12 of the trace. Lengths are in m, masses in kg, or in
/// any consistent units.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::inertia::MassProperties;
///
/// // two balls on a light rod
/// let dumbbell = MassProperties::of_points([
///     (1.0, Vector3::new(0.0, 0.0, 0.0)),
///     (3.0, Vector3::new(0.0, 0.0, 4.0)),
/// ])?;
/// assert_eq!(dumbbell.center_of_mass(), Vector3::new(0.0, 0.0, 3.0));
/// assert_eq!(dumbbell.tensor()[(0, 0)], 12.0); // reduced mass times distance squared
/// assert_eq!(dumbbell.tensor_about(Vector3::zeros())?[(0, 0)], 48.0);
/// assert_eq!(dumbbell.class().name(), "linear");
/// assert!(dumbbell.inertia().is_err()); // nothing resists a turn about the rod
/// # Ok::<(), polhode::inertia::MassError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct MassProperties {
    mass: f64,
    center_of_mass: Vector3<f64>,
    tensor: Matrix3<f64>,
}

impl MassProperties {
    /// From the mass, the centre of mass and the tensor about it (entries `I_xy = −∫ x y dm`).
    ///
    /// # Errors
    /// A mass that is not positive, components that are not finite, a tensor that is not symmetric or that no
    /// mass distribution has.
    pub fn new(mass: f64, center_of_mass: Vector3<f64>, tensor: Matrix3<f64>) -> Result<Self, MassError> {
        positive("mass", mass)?;
        finite("centre of mass", &center_of_mass)?;
        check_tensor(&tensor)?;
        Self::checked(mass, center_of_mass, Tensor::symmetric_part(&tensor).rounded())
    }

    /// From the tensor about any `point`: the parallel-axis theorem from there to the centre of mass.
    ///
    /// # Errors
    /// As [`new`](Self::new); a tensor that is too small for the distance is not physically valid.
    pub fn from_tensor_about(
        point: Vector3<f64>,
        mass: f64,
        center_of_mass: Vector3<f64>,
        tensor: Matrix3<f64>,
    ) -> Result<Self, MassError> {
        positive("mass", mass)?;
        finite("centre of mass", &center_of_mass)?;
        finite("point", &point)?;
        check_symmetric(&tensor)?;
        let term = Tensor::of_point(Dd::of(mass), difference(center_of_mass, point));
        let central = Tensor::symmetric_part(&tensor) - term;
        Self::new(mass, center_of_mass, central.rounded())
    }

    /// One point of mass `mass` at `at`.
    ///
    /// # Errors
    /// A mass that is not positive, components that are not finite.
    pub fn point(mass: f64, at: Vector3<f64>) -> Result<Self, MassError> {
        Self::new(mass, at, Matrix3::zeros())
    }

    /// Point masses, each with its position.
    ///
    /// # Errors
    /// As [`point`](Self::point), and when there is none.
    pub fn of_points(points: impl IntoIterator<Item = (f64, Vector3<f64>)>) -> Result<Self, MassError> {
        let parts = points.into_iter().map(|(mass, at)| Self::point(mass, at));
        Self::sum(parts.collect::<Result<Vec<_>, _>>()?)
    }

    /// The body made of `parts` that are given in one frame.
    ///
    /// Centre and tensor are summed in double-double, so that far or nearly balanced parts lose no digits.
    ///
    /// # Errors
    /// No part, or sums outside the range of a double.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::inertia::{Amount, MassProperties, Solid};
    ///
    /// let handle = Solid::Cylinder { radius: 0.01, height: 0.3 }.with(Amount::Density(700.0))?;
    /// let head = Solid::Box([0.05, 0.12, 0.05]).with(Amount::Density(7800.0))?;
    /// let hammer = MassProperties::sum([handle, head.moved(Vector3::new(0.0, 0.0, 0.175))?])?;
    /// assert!(hammer.center_of_mass().z > 0.16);
    /// # Ok::<(), polhode::inertia::MassError>(())
    /// ```
    pub fn sum(parts: impl IntoIterator<Item = Self>) -> Result<Self, MassError> {
        let parts: Vec<Self> = parts.into_iter().collect();
        let Some(first) = parts.first() else { return Err(MassError::Empty) };
        // distances from the first part, so that the offset of all parts together does not cancel digits
        let origin = first.center_of_mass;
        let (mut mass, mut moment) = (Dd::ZERO, Vec3::zero());
        for part in &parts {
            mass = mass + Dd::of(part.mass);
            moment = moment + difference(part.center_of_mass, origin) * Dd::of(part.mass);
        }
        let center = moment * (Dd::ONE / mass);
        let mut tensor = Tensor::zero();
        let mut apart = 0.0_f64;
        for part in &parts {
            let offset = difference(part.center_of_mass, origin) - center;
            apart = apart.max(offset.magnitude());
            tensor =
                tensor + Tensor::symmetric_part(&part.tensor) + Tensor::of_point(Dd::of(part.mass), offset);
        }
        // parts so close to one another that squares of their distances vanish are no point
        if apart > 0.0 && tensor.rounded().trace() == 0.0 {
            return Err(MassError::OutOfRange);
        }
        let center = Vec3::of(origin.into()) + center;
        Self::checked(mass.hi(), center.map(Dd::hi).into(), tensor.rounded())
    }

    /// The body shifted by `by`.
    ///
    /// # Errors
    /// A shift that is not finite, or out of range.
    pub fn moved(&self, by: Vector3<f64>) -> Result<Self, MassError> {
        finite("shift", &by)?;
        Self::checked(self.mass, self.center_of_mass + by, self.tensor)
    }

    /// The body turned about the origin: a point v of it moves to q v q*.
    pub fn turned(&self, rotation: UnitQuaternion<f64>) -> Self {
        let q = Quat::of(rotation.into()).normalized();
        let center = q.rotate(Vec3::of(self.center_of_mass.into()));
        MassProperties {
            mass: self.mass,
            center_of_mass: center.map(Dd::hi).into(),
            tensor: Tensor::symmetric_part(&self.tensor).turned(q).rounded(),
        }
    }

    /// Mass, kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Centre of mass, m.
    #[must_use]
    pub fn center_of_mass(&self) -> Vector3<f64> {
        self.center_of_mass
    }

    /// Tensor about the centre of mass, kg m², entries `I_xy = −∫ x y dm`.
    #[must_use]
    pub fn tensor(&self) -> Matrix3<f64> {
        self.tensor
    }

    /// Tensor about `point` (m), kg m²: I_Q = I + M (R² 1 − R Rᵀ), R from the point to the centre of mass.
    ///
    /// # Errors
    /// A point that is not finite, or so far away that the tensor is outside the range of a double.
    pub fn tensor_about(&self, point: Vector3<f64>) -> Result<Matrix3<f64>, MassError> {
        finite("point", &point)?;
        let term = Tensor::of_point(Dd::of(self.mass), difference(self.center_of_mass, point));
        let tensor = (Tensor::symmetric_part(&self.tensor) + term).rounded();
        let in_range = tensor.iter().all(|value| value.abs() < *SIZES.end());
        if in_range { Ok(tensor) } else { Err(MassError::OutOfRange) }
    }

    /// The inertia about the centre of mass, as a rotating body needs it.
    ///
    /// # Errors
    /// A moment that is zero up to rounding: points and rods.
    pub fn inertia(&self) -> Result<Inertia, InertiaError> {
        rotating(self.tensor)
    }

    /// The inertia about `point`, for a body that turns about it.
    ///
    /// # Errors
    /// As [`tensor_about`](Self::tensor_about); a moment that is zero up to rounding: points and rods that hold the point.
    pub fn inertia_about(&self, point: Vector3<f64>) -> Result<Inertia, MassError> {
        Ok(rotating(self.tensor_about(point)?)?)
    }

    /// Principal moments about the centre of mass, ascending, kg m²; never negative.
    #[must_use]
    pub fn principal_moments(&self) -> [f64; 3] {
        let spectrum = self.spectrum();
        spectrum.moments.map(|i| i.hi().max(0.0) * spectrum.scale)
    }

    /// The rotation that takes coordinates along the principal axes (moments ascending, right-handed) to the
    /// axes of the frame. Axes of equal moments are one choice among many.
    pub fn principal_axes(&self) -> UnitQuaternion<f64> {
        let q = frame_quaternion(self.spectrum().axes);
        q.map(Dd::hi).into()
    }

    /// By how much the sum of the other two principal moments exceeds the k-th, kg m²: 0 for a plate's third.
    #[must_use]
    pub fn triangle_margins(&self) -> [f64; 3] {
        triangle_margins(self.principal_moments())
    }

    /// What the principal moments say about the shape.
    #[must_use]
    pub fn class(&self) -> Class {
        let [low, middle, high] = self.principal_moments();
        let rounding = ROUNDING * (low + middle + high);
        if high == 0.0 {
            Class::Point
        } else if low <= rounding {
            Class::Linear
        } else if self.triangle_margins()[2] <= rounding {
            Class::Planar
        } else {
            Class::Solid(Symmetry::of([low, middle, high]))
        }
    }

    fn spectrum(&self) -> Spectrum {
        Spectrum::of_finite(&self.tensor)
    }

    /// From numbers that the operations of this module have made: only their range is in question.
    pub(super) fn checked(
        mass: f64,
        center_of_mass: Vector3<f64>,
        tensor: Matrix3<f64>,
    ) -> Result<Self, MassError> {
        let trace = tensor.trace();
        let clear = SIZES.contains(&mass)
            && center_of_mass.iter().all(|value| value.abs() < *LENGTHS.end())
            && tensor.iter().all(|value| value.abs() < *SIZES.end())
            && (trace == 0.0 || trace > *SIZES.start());
        if clear { Ok(MassProperties { mass, center_of_mass, tensor }) } else { Err(MassError::OutOfRange) }
    }
}

/// a − b without rounding.
fn difference(a: Vector3<f64>, b: Vector3<f64>) -> Vec3<Dd> {
    Vec3([0, 1, 2].map(|k| Dd::sum(a[k], -b[k])))
}

/// An inertia, unless a moment is no more than what rounding leaves of zero.
fn rotating(tensor: Matrix3<f64>) -> Result<Inertia, InertiaError> {
    let spectrum = Spectrum::of(&tensor)?;
    if spectrum.moments[0].hi() <= 8.0 * f64::EPSILON * spectrum.trace() {
        let moments = spectrum.moments.map(|i| i.hi() * spectrum.scale);
        return Err(InertiaError::NotPositive { moments: [0.0, moments[1], moments[2]] });
    }
    Inertia::from_tensor(tensor)
}

/// The laws of a tensor of mass, of which moments may be zero.
pub(super) fn check_tensor(tensor: &Matrix3<f64>) -> Result<(), InertiaError> {
    check_symmetric(tensor)?;
    let spectrum = Spectrum::of(tensor)?;
    let moments = spectrum.moments.map(Dd::hi);
    if moments[0] < -ROUNDING * spectrum.trace().abs() {
        return Err(InertiaError::NotPositive { moments: moments.map(|i| i * spectrum.scale) });
    }
    check_triangle(moments, spectrum.scale)
}

pub(super) fn positive(quantity: &'static str, value: f64) -> Result<f64, MassError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(MassError::NotPositive { quantity, value }) }
}

/// A positive length whose square is a double with all its digits.
pub(super) fn length(quantity: &'static str, value: f64) -> Result<f64, MassError> {
    positive(quantity, value)?;
    if LENGTHS.contains(&value) { Ok(value) } else { Err(MassError::OutOfRange) }
}

pub(super) fn finite(quantity: &'static str, v: &Vector3<f64>) -> Result<(), MassError> {
    match v.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(MassError::NotFinite { quantity, value }),
        None => Ok(()),
    }
}
