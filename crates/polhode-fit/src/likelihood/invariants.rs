//! First tensors from rates alone, however sparse: ω·J ω and |J ω|² are the same at all samples of a stretch.
//!
//! Every S of span{J, J²} has a constant ω·S ω. The two symmetric S whose ω·S ω vary least give the axes, in which all of them are
//! diagonal, and a plane of moments and squared moments: two tensors lie in it, one the mirror image of the other.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::likelihood::momentum::physical;
use crate::physical::coordinates::{Coordinates, ENTRIES, coordinates, eigen};

/// Twice the off-diagonal entries in a norm that counts them once.
const ROOT: f64 = core::f64::consts::SQRT_2;

/// Coordinates of both; fewer where moments would not be positive.
pub(crate) fn tensors_of(stretches: &[&[Vector3<f64>]]) -> Vec<Coordinates> {
    let mut scatter = SMatrix::<f64, 6, 6>::zeros();
    for rates in stretches {
        let features: Vec<SVector<f64, 6>> = rates.iter().map(features).collect();
        let mean = features.iter().sum::<SVector<f64, 6>>() / features.len().max(1) as f64;
        features.iter().for_each(|f| scatter += (f - mean) * (f - mean).transpose());
    }
    let (_, vectors) = eigen(scatter);
    let [first, second] = [0, 1].map(|k| symmetric(&vectors.column(k).into_owned()));
    let gap = |m: &Matrix3<f64>| {
        let (values, _) = eigen(*m);
        (values[1] - values[0]).min(values[2] - values[1]) / m.norm()
    };
    let mixtures = [first, second, first + second, first - second];
    let Some(best) = mixtures.into_iter().max_by(|a, b| gap(a).total_cmp(&gap(b))) else { return Vec::new() };
    let (_, axes) = eigen(best);
    let along = |m: &Matrix3<f64>| (axes.transpose() * m * axes).diagonal();
    let normal = along(&first).cross(&along(&second));
    moments(&normal)
        .into_iter()
        .filter_map(|moments| {
            let tensor = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
            physical(coordinates(&tensor))
        })
        .collect()
}

/// xx, yy, zz, √2 xy, √2 xz, √2 yz of ω ωᵀ.
fn features(w: &Vector3<f64>) -> SVector<f64, 6> {
    SVector::from_fn(|k, _| {
        let (i, j) = ENTRIES[k];
        w[i] * w[j] * if i == j { 1.0 } else { ROOT }
    })
}

fn symmetric(of: &SVector<f64, 6>) -> Matrix3<f64> {
    let mut m = Matrix3::zeros();
    for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
        let entry = of[k] / if i == j { 1.0 } else { ROOT };
        (m[(i, j)], m[(j, i)]) = (entry, entry);
    }
    m
}

/// Moments with Σ n_k J_k = 0, Σ n_k J_k² = 0 and Σ J_k = 1: the ends of a chord, or its middle where the line misses the quadric.
fn moments(n: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let ones = Vector3::repeat(1.0);
    let along = n.cross(&ones);
    if along.norm_squared() <= f64::EPSILON * n.norm_squared() {
        return Vec::new();
    }
    // a point of the line of both linear equations
    let across = ones - n * (n.sum() / n.norm_squared());
    let from = across / across.sum();
    let weighted = |a: &Vector3<f64>, b: &Vector3<f64>| n.component_mul(a).dot(b);
    let (a, b, c) = (weighted(&along, &along), weighted(&along, &from), weighted(&from, &from));
    let root = (b * b - a * c).max(0.0).sqrt();
    let at = |s: f64| from + along * s;
    // the form that loses no digits where the sum cancels
    let q = -(b + root.copysign(b));
    [q / a, if q == 0.0 { q / a } else { c / q }].into_iter().filter(|s| s.is_finite()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::tensor;
    use crate::thresholds::likelihood::SMALLEST;
    use nalgebra::UnitQuaternion;
    use polhode::flow::FreeMotion;
    use polhode::inertia::Inertia;
    use polhode::num::Random;
    use polhode::rotation::{Quat, Vec3};

    #[test]
    fn a_few_rates_far_apart_tell_the_tensor_and_its_mirror_image() {
        let j = Matrix3::new(2.0, 0.3, -0.1, 0.3, 1.7, 0.2, -0.1, 0.2, 1.1) / 4.8;
        let body = Inertia::from_tensor(j).unwrap();
        let motion =
            FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::new(0.3, -0.8, 0.6)).unwrap();
        let rates: Vec<Vector3<f64>> =
            (0..20).map(|k| motion.omega_at(7.0 * f64::from(k)).unwrap()).collect();
        let found = tensors_of(&[&rates]);
        assert_eq!(found.len(), 2);
        assert!(found.iter().any(|x| (tensor(x) - j).norm() < 1e-9), "{found:?}");
        assert!(
            found.iter().any(|x| (tensor(x) - crate::report::mirror::mirrored(&j)).norm() < 1e-9),
            "{found:?}"
        );
    }

    /// With n = J × J², component by component, J itself is an end of the chord; the other is another triple of the same three equations.
    #[test]
    fn both_ends_of_the_chord_solve_the_three_equations() {
        for moments in [[0.2, 0.3, 0.5], [0.5, 0.2, 0.3], [0.1, 0.42, 0.48]] {
            let j = Vector3::from(moments);
            let own = j.cross(&j.component_mul(&j));
            for n in [own, own * -7.0] {
                let found = super::moments(&n);
                assert_eq!(found.len(), 2);
                for end in &found {
                    let sums = [n.dot(end), n.dot(&end.component_mul(end)), end.sum() - 1.0];
                    assert!(sums.iter().all(|sum| sum.abs() < 1e-12), "{moments:?}: {sums:?}");
                }
                assert!(found.iter().any(|end| (end - j).norm() < 1e-11), "{moments:?}: {found:?}");
                assert!((found[0] - found[1]).norm() > 1e-3, "{moments:?}");
            }
        }
        // all moments, and all of a body whose first two are one
        assert!(super::moments(&Vector3::repeat(2.0)).is_empty());
        assert!(super::moments(&Vector3::new(1.0, -1.0, 0.0)).is_empty());
    }

    /// Products of two rates are those of their features, which are the entries of one matrix.
    #[test]
    fn features_are_the_entries_of_a_square() {
        let (a, b) = (Vector3::new(0.3, -0.5, 0.7), Vector3::new(-0.2, 0.4, 0.9));
        assert!((features(&a).dot(&features(&b)) - a.dot(&b) * a.dot(&b)).abs() < 1e-15);
        assert!((symmetric(&features(&a)) - a * a.transpose()).amax() < 1e-15);
    }

    /// Of the forms (2, 2, −1)/3 and (−1, 2, 2)/3 each has two equal eigenvalues, and so has one of their sum and difference: the other tells
    /// the axes. By n = (2, −1, 2) the middle moment is 2/3, and the outer ones (1 ± √3)/6, of which one is drawn inwards.
    #[test]
    fn one_of_four_mixtures_tells_the_axes() {
        let (little, much) = (Vector3::new(-1.0, 2.0, 2.0) / 3.0, Vector3::new(2.0, -1.0, 2.0) / 3.0);
        let mut rates: Vec<Vector3<f64>> = Vec::new();
        for (a, b) in [(0.06, 0.6), (0.06, -0.6), (-0.06, 0.6), (-0.06, -0.6)] {
            let squares = Vector3::repeat(1.0) + little * a + much * b;
            for signs in [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]] {
                rates.push(squares.map(f64::sqrt).component_mul(&Vector3::from(signs)));
            }
        }
        let root = 3.0_f64.sqrt();
        let moments = [(1.0 + root) / 6.0, 2.0 / 3.0, (1.0 - root) / 6.0];
        let third = 1.0 / 3.0;
        let share = (third - SMALLEST) / (third - moments[2]);
        let [high, middle, low] = moments.map(|moment| third + (moment - third) * share);
        let mut random = Random::new(3);
        for trial in 0..8 {
            let turn: UnitQuaternion<f64> = Quat::exponential(Vec3::from(random.normal_vector())).into();
            let turn = *turn.to_rotation_matrix().matrix();
            let turned: Vec<Vector3<f64>> = rates.iter().map(|w| turn * w).collect();
            let found = tensors_of(&[&turned]);
            let along: Vec<Matrix3<f64>> =
                found.iter().map(|x| turn.transpose() * tensor(x) * turn).collect();
            assert_eq!(along.len(), 2, "{trial}");
            for ends in [[high, middle, low], [low, middle, high]] {
                let expected = Matrix3::from_diagonal(&Vector3::from(ends));
                assert!(along.iter().any(|own| (own - expected).amax() < 1e-9), "{trial}: {along:?}");
            }
        }
    }

    /// Stretches of one body have energies and momenta of their own.
    #[test]
    fn several_stretches_tell_one_tensor() {
        let j = Matrix3::new(2.0, 0.3, -0.1, 0.3, 1.7, 0.2, -0.1, 0.2, 1.1) / 4.8;
        let body = Inertia::from_tensor(j).unwrap();
        let all = [[0.3, -0.8, 0.6], [1.0, 0.7, -0.2], [-0.1, 0.4, 0.9]].map(|start| {
            let motion =
                FreeMotion::from_omega(&body, UnitQuaternion::identity(), Vector3::from(start)).unwrap();
            let at = |k: u32| motion.omega_at(3.0 * f64::from(k)).unwrap();
            (0..9).map(at).collect::<Vec<Vector3<f64>>>()
        });
        let found = tensors_of(&all.each_ref().map(Vec::as_slice));
        assert!(found.iter().any(|x| (tensor(x) - j).norm() < 1e-8), "{found:?}");
    }
}
