//! What the mirrored twin of a body says of it: left and right of a robot.

use nalgebra::{Matrix3, Vector3};

use super::Evidence;
use crate::rotation::AXES;

/// Numbers closer than this share of the largest are typed alike.
const ALIKE: f64 = 1e-3;

/// A body that is the mirror image of the one examined, in the axes of its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twin {
    /// Its centre of mass, m.
    pub center_of_mass: Vector3<f64>,
    /// Its tensor about that, kg m².
    pub tensor: Matrix3<f64>,
}

/// The axis whose reversal takes the twin to the body, if the centres of mass name one and the tensor contradicts it, and the tensor
/// that they would have it be.
///
/// The reversal of two axes, a half turn, does to a tensor what that of the third does. A twin whose entries differ in
/// more than their signs says nothing.
pub(super) fn contradiction(tensor: &Matrix3<f64>, evidence: &Evidence) -> Option<(char, Matrix3<f64>)> {
    let (twin, center) = (evidence.twin?, evidence.center_of_mass?);
    let alike = |a: f64, b: f64, size: f64| (a - b).abs() <= ALIKE * size;
    let size = twin.tensor.amax();
    if !tensor.iter().zip(twin.tensor.iter()).all(|(a, b)| alike(a.abs(), b.abs(), size)) {
        return None;
    }
    let length = twin.center_of_mass.amax();
    // all three as they are, then one reversed, or, which does the same to a tensor, the two others
    let mut expected = None;
    for axis in [None, Some(0), Some(1), Some(2)] {
        let sign = |k: usize| if axis == Some(k) { -1.0 } else { 1.0 };
        let image = Vector3::from_fn(|k, _| sign(k) * twin.center_of_mass[k]);
        let fits = |sense: f64| (0..3).all(|k| alike(center[k], sense * image[k], length));
        if !fits(1.0) && (axis.is_none() || !fits(-1.0)) {
            continue;
        }
        let mirrored = Matrix3::from_fn(|j, k| sign(j) * sign(k) * twin.tensor[(j, k)]);
        if tensor.iter().zip(mirrored.iter()).all(|(a, b)| alike(*a, *b, size)) {
            return None;
        }
        match (expected, axis) {
            // two ways to mirror the centre, and nothing decides between them
            (Some(_), _) => return None,
            (None, Some(axis)) => expected = Some((AXES[axis], mirrored)),
            (None, None) => {}
        }
    }
    expected
}
