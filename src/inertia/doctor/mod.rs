//! What is wrong with a tensor, what probably happened, and what would be right.

mod causes;
mod nearest;
mod oddity;
mod twin;

use nalgebra::{Matrix3, Vector3};

use super::checks::{ROUNDING, check_symmetric, triangle_margins};
use super::mass::{LENGTHS, SIZES, check_tensor, finite, length, positive};
use super::symmetric::{Spectrum, Tensor};
use super::{InertiaError, MassError};
use crate::num::{Dd, Real};
use crate::rotation::{AXES, Vec3};
pub use causes::{Cause, Entry};
pub use oddity::Oddity;
pub use twin::Twin;

/// A density within e^±14 of water's, 1e-3 to 1e9 kg/m³, is no evidence against a tensor.
const ORDINARY: f64 = 14.0;

/// Known properties of the body besides its tensor. All are optional; each narrows the causes down.
///
/// ```
/// use polhode::inertia::Evidence;
/// let evidence = Evidence::default().with_mass(0.5).with_extents([0.2, 0.2, 0.1]);
/// assert_eq!((evidence.mass, evidence.twin), (Some(0.5), None));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Evidence {
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Centre of mass as seen from the origin of the frame, m: the other point that a tensor may be about.
    pub center_of_mass: Option<Vector3<f64>>,
    /// Edges of the box around the body along the axes of the tensor, m.
    pub extents: Option<[f64; 3]>,
    /// The body that it mirrors, as a left arm does a right one.
    pub twin: Option<Twin>,
}

/// The outcome of an examination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Validity {
    /// No law is broken, and no likelier tensor is near.
    Valid,
    /// The tensor is physically valid, but a common mistake explains it better than the body described, or it is odd.
    Suspicious,
    /// The tensor is not physically valid, or no body of this mass and tensor fits into the extents.
    Invalid,
}

impl Validity {
    /// In one lowercase word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Validity::Valid => "valid",
            Validity::Suspicious => "suspicious",
            Validity::Invalid => "invalid",
        }
    }
}

/// A cause that would explain the tensor.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Explanation {
    /// What happened.
    pub cause: Cause,
    /// The tensor with the mistake undone.
    pub corrected: Matrix3<f64>,
    /// How unlikely: rareness of the mistake plus oddness of the corrected body. Only the order of costs has a meaning.
    pub cost: f64,
}

/// Costs closer than this say nothing.
const TIE: f64 = 0.25;

impl Explanation {
    /// Whether nothing decides between this explanation and `other`.
    #[must_use]
    pub fn is_tied_with(&self, other: &Explanation) -> bool {
        (self.cost - other.cost).abs() < TIE
    }
}

/// A second moment that is too large for the extents of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Misfit {
    /// Name of the axis.
    pub axis: char,
    /// ∫ x² dm about the centre of mass over its greatest value M L²/4, which half the mass at either end has.
    pub ratio: f64,
}

/// What an examination found.
///
/// ```
/// use nalgebra::Matrix3;
/// use polhode::inertia::{Cause, Evidence, Validity, diagnose};
///
/// // a designer's +∫ x y dm typed where tensor entries belong
/// let typed = Matrix3::new(0.75, 0.3125, 0.3125, 0.3125, 0.75, 0.3125, 0.3125, 0.3125, 0.75);
/// let found = diagnose(typed, &Evidence::default())?;
/// assert_eq!(found.verdict, Validity::Invalid);
/// assert_eq!(
///     found.violation.unwrap().to_string(),
///     "principal moments 0.4375, 0.4375, 1.375 violate I1 + I2 >= I3 by 0.5 (36.364 % of the largest); no mass distribution has them"
/// );
/// assert_eq!(found.causes[0].cause, Cause::ProductSigns);
/// assert_eq!(found.causes[0].corrected[(0, 1)], -0.3125);
/// # Ok::<(), polhode::inertia::MassError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct Diagnosis {
    /// The outcome.
    pub verdict: Validity,
    /// The law of inertia tensors that is broken, with its numbers.
    pub violation: Option<InertiaError>,
    /// The worst second moment that the extents leave no room for.
    pub misfit: Option<Misfit>,
    /// Principal moments of the symmetric part, ascending, in the unit of the tensor.
    pub principal_moments: [f64; 3],
    /// By how much the sum of the other two moments exceeds the k-th, in the unit of the tensor.
    pub triangle_margins: [f64; 3],
    /// Causes that would explain it, the likeliest first; none if the tensor is valid, or a placeholder.
    pub causes: Vec<Explanation>,
    /// What is odd about it.
    pub oddity: Option<Oddity>,
    /// The nearest physically valid tensor in Frobenius norm; a moment of it may be zero.
    pub nearest: Matrix3<f64>,
    /// Frobenius distance to it, in the unit of the tensor.
    pub distance: f64,
    /// Edges of the homogeneous box of the nearest tensor, along its principal axes (ascending moments, so the longest
    /// edge first): in m with a known mass, else relative to the longest.
    pub equivalent_box: [f64; 3],
}

/// Examines a tensor (entries `I_xy = −∫ x y dm`, supposed to be about the centre of mass).
///
/// The law is ½ tr(I)·1 − I ⪰ 0 up to 1e-12 of the trace; rods and plates obey it. A tensor of zeros is invalid.
///
/// A cause is tested by undoing it: it explains the tensor if the corrected one obeys the law and fits into the extents.
/// Explanations are ranked by how rare the mistake is, how well the corrected body fills the extents (or how ordinary its
/// density is, if only the mass is known, in kg and m), how large its products are, and how flat it is.
///
/// # Errors
/// Entries or evidence that are not finite, a mass or extents that are not positive, sizes outside the range of a double.
///
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use polhode::inertia::{Cause, Evidence, Validity, diagnose};
/// // a cube of 12 kg and 1 m, its tensor taken about a point 1 m below its centre
/// let tensor = Matrix3::from_diagonal(&Vector3::new(14.0, 14.0, 2.0));
/// let center_of_mass = Some(Vector3::new(0.0, 0.0, 1.0));
/// let evidence =
///     Evidence::default().with_mass(12.0).with_center_of_mass(center_of_mass).with_extents([1.0; 3]);
/// let found = diagnose(tensor, &evidence)?;
/// assert_eq!(found.verdict, Validity::Invalid); // no such mass distribution fits into the cube
/// assert_eq!((&found.causes[0].cause, found.causes[0].corrected[(0, 0)]), (&Cause::AboutOrigin, 2.0));
/// # Ok::<(), polhode::inertia::MassError>(())
/// ```
pub fn diagnose(tensor: Matrix3<f64>, evidence: &Evidence) -> Result<Diagnosis, MassError> {
    let spectrum = Spectrum::of(&tensor)?;
    let is_zero = tensor.amax() == 0.0;
    let mut in_range = is_zero || SIZES.contains(&tensor.amax());
    if let Some(mass) = evidence.mass {
        positive("mass", mass)?;
    }
    if let Some(center) = evidence.center_of_mass {
        finite("centre of mass", &center)?;
        in_range &= center.amax() < *LENGTHS.end();
    }
    for extent in evidence.extents.into_iter().flatten() {
        length("extent", extent)?;
    }
    if !in_range || evidence.fill(&tensor).into_iter().flatten().any(|share| !share.is_finite()) {
        return Err(MassError::OutOfRange);
    }
    let violation = if is_zero {
        Some(InertiaError::NotPositive { moments: [0.0; 3] })
    } else {
        check_tensor(&tensor).err()
    };
    let misfit = evidence.misfit(&tensor);
    let broken = violation.is_some() || misfit.is_some();
    // a valid tensor is believed unless another one is clearly less odd
    let accepted = if broken { f64::INFINITY } else { evidence.oddness(&tensor, ORDINARY) - 1.0 };
    // from zeros nothing can be told
    let candidates = if is_zero { Vec::new() } else { causes::candidates(&tensor, evidence) };
    let explains =
        |corrected: &Matrix3<f64>| check_tensor(corrected).is_ok() && evidence.misfit(corrected).is_none();
    let mut causes: Vec<Explanation> = candidates
        .into_iter()
        .filter(|(_, corrected, _)| SIZES.contains(&corrected.amax()) && explains(corrected))
        .map(|(cause, corrected, rareness)| {
            let cost = rareness + evidence.oddness(&corrected, 0.0);
            Explanation { cause, corrected, cost }
        })
        .filter(|explanation| explanation.cost < accepted)
        .collect();
    // no rarer than any other: the twin says so
    let mirrored = twin::contradiction(&tensor, evidence).filter(|(_, corrected)| explains(corrected));
    if let Some((axis, corrected)) = mirrored {
        let cost = evidence.oddness(&corrected, 0.0);
        causes.push(Explanation { cause: Cause::MirroredTwin { axis }, corrected, cost });
    }
    causes.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let oddity = if is_zero { None } else { oddity::oddity(&tensor, evidence) };
    if oddity.is_some_and(|oddity| oddity.is_placeholder()) {
        causes.clear();
    }
    let verdict = match (broken, causes.is_empty() && oddity.is_none()) {
        (true, _) => Validity::Invalid,
        (false, false) => Validity::Suspicious,
        (false, true) => Validity::Valid,
    };
    let (nearest, distance) = nearest::nearest_valid(&tensor);
    let principal_moments = spectrum.moments.map(|i| i.hi() * spectrum.scale);
    Ok(Diagnosis {
        verdict,
        violation,
        misfit,
        oddity,
        principal_moments,
        triangle_margins: triangle_margins(principal_moments),
        causes,
        nearest,
        distance,
        equivalent_box: equivalent_box(&nearest, evidence.mass),
    })
}

/// Edges √(12 J/M) from the second moments J = ½ tr(I) − I along the principal axes.
fn equivalent_box(tensor: &Matrix3<f64>, mass: Option<f64>) -> [f64; 3] {
    let spectrum = Spectrum::of_finite(tensor);
    let second = second_moments(&spectrum);
    match mass {
        Some(mass) => {
            // powers of two apart: the quotient may have no double where its root has one
            let n = libm::ilogb(spectrum.scale);
            let half = (n - libm::ilogb(mass)) / 2;
            let quotient = libm::scalbn(spectrum.scale, -n) / libm::scalbn(mass, 2 * half - n);
            second.map(|j| libm::scalbn((12.0 * j * quotient).sqrt(), half))
        }
        None if second[0] > 0.0 => second.map(|j| (j / second[0]).sqrt()),
        None => [0.0; 3],
    }
}

/// Second moments along the principal axes over the scale, descending, never negative.
fn second_moments(spectrum: &Spectrum) -> [f64; 3] {
    triangle_margins(spectrum.moments).map(|twice| (0.5 * twice.hi()).max(0.0))
}

impl Evidence {
    /// With the mass, kg; `None` where it is not known.
    #[must_use]
    pub fn with_mass(self, mass: impl Into<Option<f64>>) -> Self {
        Evidence { mass: mass.into(), ..self }
    }

    /// With the centre of mass as seen from the origin of the frame, m; `None` where it is not known.
    #[must_use]
    pub fn with_center_of_mass(self, center_of_mass: impl Into<Option<Vector3<f64>>>) -> Self {
        Evidence { center_of_mass: center_of_mass.into(), ..self }
    }

    /// With the edges of the box around the body along the axes of the tensor, m; `None` where they are not known.
    #[must_use]
    pub fn with_extents(self, extents: impl Into<Option<[f64; 3]>>) -> Self {
        Evidence { extents: extents.into(), ..self }
    }

    /// With the body that it mirrors; `None` where there is none.
    #[must_use]
    pub fn with_twin(self, twin: impl Into<Option<Twin>>) -> Self {
        Evidence { twin: twin.into(), ..self }
    }

    /// The axis whose second moment most exceeds M L²/4 (Popoviciu's bound on a variance), if one does.
    fn misfit(&self, tensor: &Matrix3<f64>) -> Option<Misfit> {
        let ratios = self.fill(tensor)?;
        let k = [0, 1, 2].into_iter().max_by(|&i, &j| ratios[i].total_cmp(&ratios[j]))?;
        let ratio = ratios[k] / 3.0;
        (ratio > 1.0 + 1e-9).then_some(Misfit { axis: AXES[k], ratio })
    }

    /// Second moments along the axes over those of a homogeneous box of the extents: 1 for a box, 3 at most.
    fn fill(&self, tensor: &Matrix3<f64>) -> Option<[f64; 3]> {
        let (mass, extents) = (self.mass?, self.extents?);
        let half = 0.5 * tensor.trace();
        Some([0, 1, 2].map(|k| 12.0 * (half - tensor[(k, k)]) / (mass * extents[k] * extents[k])))
    }

    /// How odd a body of this tensor is: 0 for a compact body of ordinary size whose axes are principal.
    ///
    /// Without extents the density of the equivalent box is judged; within e^±`tolerance` of water's it is ordinary.
    fn oddness(&self, tensor: &Matrix3<f64>, tolerance: f64) -> f64 {
        let spectrum = Spectrum::of_finite(tensor);
        let second = second_moments(&spectrum);
        let square = |x: f64| x * x;
        // from e⁻⁴ on a body is as flat as a plate
        let flatness =
            if second[0] > 0.0 { -libm::log((second[2] / second[0]).max(libm::exp(-4.0))) } else { 4.0 };
        let products = square(tensor[(0, 1)]) + square(tensor[(0, 2)]) + square(tensor[(1, 2)]);
        let diagonal = square(tensor[(0, 0)]) + square(tensor[(1, 1)]) + square(tensor[(2, 2)]);
        let tilt = if diagonal > 0.0 { 8.0 * products / diagonal } else { 0.0 };
        let is_flat = second[2] <= ROUNDING * second[0];
        let size = match (self.fill(tensor), self.mass) {
            // real bodies are emptier than a box: most have a third to one and a half of its second moments
            (Some(fill), _) => {
                fill.map(|r| square(libm::log(r.max(1e-12) / 0.7) / libm::log(2.5))).iter().sum()
            }
            (None, Some(mass)) if !is_flat => {
                let edges = second.map(|j| (12.0 * j * (spectrum.scale / mass)).sqrt());
                let density = mass / (edges[0] * edges[1] * edges[2]);
                let orders = libm::log(density / 1000.0).abs();
                if orders <= tolerance { 0.0 } else { square(orders) / 8.0 }
            }
            _ => 0.0,
        };
        0.5 * flatness + tilt + size
    }
}

/// The parallel-axis term of the evidence, if it has a mass and a centre away from the origin.
fn parallel_axis_term(evidence: &Evidence) -> Option<Matrix3<f64>> {
    let (mass, center) = (evidence.mass?, evidence.center_of_mass?);
    (center != Vector3::zeros()).then(|| Tensor::of_point(Dd::of(mass), Vec3::of(center.into())).rounded())
}
