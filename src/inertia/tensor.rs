//! Inertia tensors, which are checked when they are made.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::checks::{check_finite, check_symmetric, check_triangle};
use super::principal::{frame_quaternion, principal_axes};
use super::symmetric::{Spectrum, Tensor, from_entries, power_of_two_below};
use super::{InertiaError, Symmetry};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

/// 2⁻²⁰⁰. Products of moments and momenta of bodies that are more slender than that leave the range of a double.
const SLENDER: f64 = 6.223_015_277_861_142e-61;

/// The inertia tensor of a rigid body about a stated point, kg m² (or any consistent unit), in body axes.
///
/// Valid by construction: finite, symmetric, positive, and ½ tr(I)·1 − I ⪰ 0, which in principal axes are the
/// triangle inequalities. There is no absolute tolerance: a molecule and an asteroid are both ordinary bodies.
///
/// ```
/// use polhode::inertia::{Inertia, Symmetry};
/// use nalgebra::Matrix3;
///
/// let box_like = Inertia::from_moments([3.0, 1.0, 2.5])?;
/// assert_eq!(box_like.principal_moments(), [1.0, 2.5, 3.0]); // ascending
/// assert_eq!(box_like.symmetry(), Symmetry::Asymmetric);
///
/// // tensor entries carry the minus sign: I_xy = -∫ x y dm
/// let tilted = Inertia::from_tensor(Matrix3::new(2.0, -0.1, 0.0, -0.1, 3.0, 0.2, 0.0, 0.2, 4.0))?;
/// assert!(tilted.principal_moments()[0] < 2.0);
///
/// let error = Inertia::from_moments([1.0, 2.0, 4.0]).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "principal moments 1, 2, 4 violate I1 + I2 >= I3 by 1 (25.000 % of the largest); no mass distribution has them"
/// );
/// # Ok::<(), polhode::inertia::InertiaError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Inertia {
    tensor: Matrix3<f64>,
    /// A power of two, the exponent of the largest moment: what follows is divided by it.
    scale: f64,
    moments: [Dd; 3],
    /// Takes coordinates along the kernel's principal axes to body coordinates; the identity for typed moments.
    frame: Quat<Dd>,
}

impl Inertia {
    /// From principal moments: the k-th belongs to the k-th body axis, in any order.
    ///
    /// # Errors
    /// A moment that is not finite, not positive, or less than 2⁻²⁰⁰ of the largest; moments that break a triangle
    /// inequality. Moments below 2.2e-308, which [`from_tensor`](Self::from_tensor) refuses, are taken as they are typed.
    pub fn from_moments(moments: [f64; 3]) -> Result<Self, InertiaError> {
        let inertia = Self::from_positive_moments(moments)?;
        check_triangle(moments.map(|i| i / inertia.scale), inertia.scale)?;
        Ok(inertia)
    }

    /// From three positive numbers that may break a triangle inequality.
    ///
    /// No body has such moments, but Euler's equations are defined for them, and published test problems use them.
    ///
    /// # Errors
    /// A moment that is not finite, not positive, or less than 2⁻²⁰⁰ of the largest.
    pub fn from_positive_moments(moments: [f64; 3]) -> Result<Self, InertiaError> {
        check_finite(&moments)?;
        if moments.iter().any(|&i| i <= 0.0) {
            return Err(InertiaError::NotPositive { moments });
        }
        let scale = power_of_two_below(moments[0].max(moments[1]).max(moments[2]));
        if is_slender(moments.map(|i| i / scale)) {
            return Err(InertiaError::Slender { moments });
        }
        Ok(Inertia {
            tensor: Matrix3::from_diagonal(&Vector3::from(moments)),
            scale,
            moments: moments.map(|i| Dd::of(i / scale)),
            frame: Quat::identity(),
        })
    }

    /// From a full tensor, entries `I_xy = −∫ x y dm`.
    ///
    /// Differences across the diagonal below 1e-12 of the trace are taken for rounding and averaged.
    ///
    /// # Errors
    /// Entries that are not finite, a tensor that is not symmetric, a moment outside the range in which a double has all its digits,
    /// from 2.2e-308 on, moments that are not positive, break a triangle inequality, or are less than 2⁻²⁰⁰ of the largest.
    pub fn from_tensor(tensor: Matrix3<f64>) -> Result<Self, InertiaError> {
        check_symmetric(&tensor)?;
        Self::of_spectrum(tensor, Spectrum::of_finite(&tensor))
    }

    fn of_spectrum(tensor: Matrix3<f64>, spectrum: Spectrum) -> Result<Self, InertiaError> {
        let Spectrum { scale, moments, axes } = spectrum;
        let rounded = moments.map(Dd::hi);
        if rounded.iter().any(|i| !(i * scale).is_finite()) {
            return Err(InertiaError::OutOfRange { value: tensor.amax() });
        }
        if rounded[0] <= 0.0 {
            return Err(InertiaError::NotPositive { moments: rounded.map(|i| i * scale) });
        }
        if rounded.iter().any(|i| !(i * scale).is_normal()) {
            return Err(InertiaError::OutOfRange { value: tensor.amax() });
        }
        check_triangle(rounded, scale)?;
        if is_slender(rounded) {
            return Err(InertiaError::Slender { moments: rounded.map(|i| i * scale) });
        }
        // the largest moment, not the largest entry, sets the scale of everything that follows
        let rescale = power_of_two_below(rounded[2]);
        Ok(Inertia {
            tensor: (tensor / scale + tensor.transpose() / scale) * 0.5 * scale,
            scale: scale * rescale,
            moments: moments.map(|i| i / Dd::of(rescale)),
            frame: frame_quaternion(axes),
        })
    }

    /// From diagonal moments and CAD products `+∫ x y dm`, in the order xy, xz, yz.
    ///
    /// # Errors
    /// As [`from_tensor`](Self::from_tensor).
    pub fn from_products(diagonal: [f64; 3], products: [f64; 3]) -> Result<Self, InertiaError> {
        let ([xx, yy, zz], [xy, xz, yz]) = (diagonal, products);
        Self::from_tensor(from_entries([xx, yy, zz, -xy, -xz, -yz]))
    }

    /// The tensor in body axes.
    #[must_use]
    pub fn tensor(&self) -> Matrix3<f64> {
        self.tensor
    }

    /// Principal moments, ascending.
    pub fn principal_moments(&self) -> [f64; 3] {
        let mut moments = self.moments.map(|i| i.hi() * self.scale);
        moments.sort_by(f64::total_cmp);
        moments
    }

    /// The rotation that takes coordinates along the principal axes (moments ascending, right-handed) to body axes.
    ///
    /// Of the first two axes the largest component is positive. Where [`symmetry`](Self::symmetry) reports a
    /// degenerate pair, its axes are one choice among infinitely many.
    pub fn principal_axes(&self) -> UnitQuaternion<f64> {
        let diagonal = |i: usize, j: usize| if i == j { self.moments[i] } else { Dd::of(0.0) };
        let (_, axes) = principal_axes([0, 1, 2].map(|i| [0, 1, 2].map(|j| diagonal(i, j))));
        let q = self.frame * frame_quaternion(axes);
        q.map(Dd::hi).into()
    }

    /// Which principal moments are equal.
    pub fn symmetry(&self) -> Symmetry {
        let mut moments = self.moments.map(Dd::hi);
        moments.sort_by(f64::total_cmp);
        Symmetry::of(moments)
    }

    /// The tensor without its size, which is all that free motion determines.
    pub fn shape(&self) -> InertiaShape {
        InertiaShape { tensor: self.tensor / self.scale / (self.tensor / self.scale).trace() }
    }

    /// Angular momentum `I ω` of the angular velocity `omega_body`, both in body axes.
    #[must_use]
    pub fn momentum(&self, omega_body: Vector3<f64>) -> Vector3<f64> {
        self.tensor * omega_body
    }

    /// The moments along the kernel's axes: as typed, or ascending along those of a tensor.
    pub(crate) fn moments_along_axes(&self) -> [f64; 3] {
        self.moments.map(|i| i.hi() * self.scale)
    }

    /// A body with the same principal axes and these moments along them, in the order of
    /// [`moments_along_axes`](Self::moments_along_axes).
    ///
    /// # Errors
    /// As [`from_moments`](Self::from_moments).
    #[cfg(any(test, feature = "random"))]
    pub(crate) fn with_moments(&self, moments: [f64; 3]) -> Result<Self, InertiaError> {
        let along = Self::from_moments(moments)?;
        if self.is_along_principal_axes() {
            return Ok(along);
        }
        let frame = UnitQuaternion::from(self.frame.map(Dd::hi));
        let axes = frame.to_rotation_matrix();
        let turned = axes.matrix() * along.tensor * axes.matrix().transpose();
        Self::from_tensor((turned + turned.transpose()) * 0.5)
    }

    /// Less `J a aᵀ` of each axis a of length 1 and moment J about it, to the digits of double-double.
    pub(crate) fn less_axial(
        &self,
        parts: impl Iterator<Item = (Vec3<Dd>, f64)>,
    ) -> Result<Self, InertiaError> {
        let whole = Tensor::symmetric_part(&(self.tensor / self.scale));
        let rest = parts.fold(whole, |rest, (axis, moment)| {
            let moment = moment / self.scale;
            rest - Tensor([0, 1, 2].map(|j| [0, 1, 2].map(|k| axis[j] * axis[k] * moment)))
        });
        let tensor = rest.rounded();
        if self.is_along_principal_axes() && tensor == Matrix3::from_diagonal(&tensor.diagonal()) {
            // typed moments keep their axes
            let inertia = Self::from_moments([0, 1, 2].map(|k| tensor[(k, k)] * self.scale))?;
            let moments = [0, 1, 2].map(|k| rest.0[k][k] * (self.scale / inertia.scale));
            return Ok(Inertia { moments, ..inertia });
        }
        Self::of_spectrum(tensor * self.scale, Spectrum::of_scaled(self.scale, &rest))
    }

    /// The power of two by which the kernels divide moments and momenta.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Moments along the kernel's axes, divided by [`scale`](Self::scale).
    pub(crate) fn scaled_moments(&self) -> [Dd; 3] {
        self.moments
    }

    /// Whether the kernel's axes are the body's.
    pub(crate) fn is_along_principal_axes(&self) -> bool {
        self.frame == Quat::identity()
    }

    /// Takes coordinates along the kernel's axes to body coordinates.
    pub(crate) fn frame(&self) -> Quat<Dd> {
        self.frame
    }

    /// `I ω` along the kernel's axes, divided by the scale: exact products of the given doubles, in double-double.
    pub(crate) fn scaled_momentum(&self, omega_body: Vec3<f64>) -> Vec3<Dd> {
        self.along_axes(Vec3::of(omega_body)).times(Vec3(self.moments))
    }

    /// The vector `v` of body axes along the kernel's axes.
    pub(crate) fn along_axes(&self, v: Vec3<Dd>) -> Vec3<Dd> {
        // adding zero leaves none that is negative, as the products do
        if self.is_along_principal_axes() { v.map(|x| x + 0.0) } else { self.frame.rotate_back(v) }
    }

    /// The attitude of the kernel's axes, of body axes with the attitude `q`.
    pub(crate) fn attitude_of_axes(&self, q: Quat<Dd>) -> Quat<Dd> {
        if self.is_along_principal_axes() { q.map(|x| x + 0.0) } else { q * self.frame }
    }
}

/// The dimensionless part of an inertia tensor: trace 1.
///
/// Motion without a torque determines a tensor only up to its scale, so a fit from it returns this type and
/// nothing that could be mistaken for kg m².
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct InertiaShape {
    tensor: Matrix3<f64>,
}

impl InertiaShape {
    /// The shape of a tensor of any size.
    ///
    /// # Errors
    /// As [`Inertia::from_tensor`].
    pub fn from_tensor(tensor: Matrix3<f64>) -> Result<Self, InertiaError> {
        Ok(Inertia::from_tensor(tensor)?.shape())
    }

    /// The tensor with trace 1, in body axes.
    #[must_use]
    pub fn tensor(&self) -> Matrix3<f64> {
        self.tensor
    }

    /// Principal moments over their sum, ascending.
    ///
    /// ```
    /// use polhode::inertia::{Inertia, Solid, Amount};
    /// let brick = Solid::Box([1.0, 2.0, 3.0]).with(Amount::Mass(12.0))?.inertia()?;
    /// let [low, middle, high] = brick.shape().principal_moments(); // (4 + 1) : (9 + 1) : (9 + 4)
    /// assert!((middle / low - 2.0).abs() < 1e-14 && (high / low - 2.6).abs() < 1e-14);
    /// assert!((low + middle + high - 1.0).abs() < 1e-15);
    /// # Ok::<(), polhode::inertia::MassError>(())
    /// ```
    #[must_use]
    pub fn principal_moments(&self) -> [f64; 3] {
        let spectrum = Spectrum::of_finite(&self.tensor);
        spectrum.moments.map(|moment| moment.hi() * spectrum.scale)
    }

    /// The inertia of this shape whose trace is `trace`, kg m².
    ///
    /// # Errors
    /// A trace that is not a positive finite number, or so small that entries would lose digits.
    pub fn with_trace(&self, trace: f64) -> Result<Inertia, InertiaError> {
        check_finite(&[trace])?;
        if trace.abs() < f64::MIN_POSITIVE / SLENDER {
            return Err(InertiaError::OutOfRange { value: trace });
        }
        Inertia::from_tensor(self.tensor * trace)
    }
}

/// Of moments in any unit in which the largest is near one.
fn is_slender([a, b, c]: [f64; 3]) -> bool {
    a.min(b).min(c) < SLENDER * a.max(b).max(c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_the_mass_by_a_power_of_two_changes_no_bit_inside() {
        let tensor = Matrix3::new(2.0, -0.1, 0.03, -0.1, 3.0, 0.2, 0.03, 0.2, 4.1);
        let tiny = 1.0 / f64::from(1_u32 << 20) / f64::from(1_u32 << 20);
        let (a, b) = (Inertia::from_tensor(tensor).unwrap(), Inertia::from_tensor(tensor * tiny).unwrap());
        assert_eq!(a.scaled_moments(), b.scaled_moments());
        assert_eq!(a.frame(), b.frame());
        assert_eq!(a.scale() * tiny, b.scale());
    }
}
