//! The tensor that explains a record as well where its axes are left-handed.
//!
//! In left-handed axes the cross product changes sign: J ω' = ω × J ω. The ratios (I₂ − I₃)/I₁ … of the body are then the
//! negatives of those that right-handed axes show, and for every body there is one with the negated ratios.

use nalgebra::{Matrix3, Vector3};
use polhode::record::{Record, Segment};

use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};

/// The tensor of trace 1 with the same axes and the negated ratios.
pub(crate) fn mirrored(j: &Matrix3<f64>) -> Matrix3<f64> {
    let (moments, axes) = eigen(*j);
    let [a, b] = [(moments[1] - moments[2]) / moments[0], (moments[2] - moments[0]) / moments[1]];
    // (I₂ − I₃)/I₁ = −a and (I₃ − I₁)/I₂ = −b
    let other = Vector3::new(1.0 + b, 1.0 - a, 1.0 + a * b).map(|moment| moment.max(0.0));
    axes * Matrix3::from_diagonal(&(other / other.sum())) * axes.transpose()
}

/// Standard deviations of its principal moments, ascending; `factor` is one of the covariance of the coordinates `x` of the answer.
pub(crate) fn mirror_sigmas(x: &Coordinates, factor: &Form) -> [f64; 3] {
    let moments = |x: Coordinates| eigen(mirrored(&tensor(&x))).0;
    let squares = factor.column_iter().map(|by| {
        let apart = (moments(x + by) - moments(x - by)) * 0.5;
        apart.component_mul(&apart)
    });
    squares.sum::<Vector3<f64>>().map(f64::sqrt).into()
}

/// The record with all rates reversed: the same body in axes of the other hand. `None` where wheels or torques act.
pub(crate) fn reversed(record: &Record) -> Option<Record> {
    let mut other = Record::default();
    for segment in &record.segments {
        if segment.inputs().is_some() {
            return None;
        }
        let rates = segment.rates().iter().map(|w| -w).collect();
        other.segments.push(Segment::new(segment.source(), segment.times().to_vec(), rates).ok()?);
    }
    Some(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::basis;

    #[test]
    fn the_mirror_has_the_negated_ratios_and_is_its_own_inverse() {
        // by hand: (1, 2, 2.6) has the ratios -0.6, 0.8, -0.3846; 1.8 : 1.6 : 0.52 has their negatives
        let j = Matrix3::from_diagonal(&(Vector3::new(1.0, 2.0, 2.6) / 5.6));
        let other = mirrored(&j);
        let expected = Vector3::new(1.8, 1.6, 0.52) / 3.92;
        assert!((other.diagonal() - expected).amax() < 1e-12, "{other}");
        assert!((mirrored(&other) - j).amax() < 1e-12);
    }

    #[test]
    fn the_mirror_is_as_uncertain_as_its_derivatives_say() {
        let moments = |e: f64| {
            let [a, b, c] = [1.0 + e, 2.0, 2.6];
            mirrored(&(Matrix3::from_diagonal(&Vector3::new(a, b, c)) / (a + b + c)))
        };
        let e = 1e-4;
        let of = |j: Matrix3<f64>| Coordinates::from_fn(|k, _| basis(k).dot(&j));
        let x = |e: f64| of(Matrix3::from_diagonal(&(Vector3::new(1.0 + e, 2.0, 2.6) / (5.6 + e))));
        let mut factor = Form::zeros();
        factor.set_column(0, &((x(e) - x(-e)) * 0.5));
        let sigmas = mirror_sigmas(&x(0.0), &factor);
        for (k, sigma) in sigmas.into_iter().enumerate() {
            let own = (eigen(moments(e)).0[k] - eigen(moments(-e)).0[k]).abs() * 0.5;
            assert!((sigma / own - 1.0).abs() < 1e-6, "{k}: {sigma:e} {own:e}");
        }
    }

    /// All rates are reversed and nothing else; twice, the record is as it was. What is told of wheels or torques has no mirror.
    #[test]
    fn a_record_is_reversed_segment_by_segment() {
        let of = |source: &str, size: f64| {
            let rates = (0..3).map(|k| Vector3::new(size, -2.0, f64::from(k))).collect();
            Segment::new(source, vec![0.0, 0.5, 1.5], rates).unwrap()
        };
        let mut record = Record::default();
        record.segments.extend([of("one", 0.3), of("two", -0.7)]);
        let other = reversed(&record).unwrap();
        assert_eq!(other.segments.len(), 2);
        for (a, b) in record.segments.iter().zip(&other.segments) {
            assert_eq!((a.source(), a.times()), (b.source(), b.times()));
            assert!(a.rates().iter().zip(b.rates()).all(|(a, b)| *a == -b));
        }
        let back = reversed(&other).unwrap();
        assert!(back.segments.iter().zip(&record.segments).all(|(a, b)| a.rates() == b.rates()));
        record.segments.push(of("three", 0.1).with_wheel(vec![Vector3::x(); 3]).unwrap());
        assert!(reversed(&record).is_none());
    }

    /// A slender body looks like a flat one in axes of the other hand.
    #[test]
    fn the_mirror_of_a_rod_is_flat() {
        let j = Matrix3::from_diagonal(&Vector3::new(0.02, 0.49, 0.49));
        let other = mirrored(&j);
        // a = 0 and b = 0.47/0.49: 1 + b, 1, 1
        let b = 0.47 / 0.49;
        let expected = Vector3::new(1.0 + b, 1.0, 1.0) / (3.0 + b);
        assert!((other.diagonal() - expected).amax() < 1e-12, "{other}");
        assert!((other.trace() - 1.0).abs() < 1e-15);
    }
}
