//! The nearest physical tensor within limits.

use crate::thresholds::limits::PARALLEL;
use nalgebra::{DMatrix, DVector, Matrix3};

use crate::error::FitError;
use crate::physical::coordinates::pair;
use crate::physical::dissipation::Dissipation;
use crate::physical::face::Nearest;
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;
use crate::physical::limits::{Limit, check_limits, feasible, side};
use crate::physical::program::{Program, Row};

/// A normal distribution of unknowns: its mean, and the upper triangular root R of its information Rᵀ R. The last five
/// are the coordinates of the tensor.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    pub(crate) centre: DVector<f64>,
    pub(crate) root: DMatrix<f64>,
}

impl Normal {
    /// With the further squares |rows · z − values|²; and the sum of squares that no unknowns remove.
    pub(crate) fn with(&self, rows: &DMatrix<f64>, values: &DVector<f64>) -> Option<(Normal, f64)> {
        let (size, further) = (self.centre.len(), rows.nrows());
        let mut stack = DMatrix::zeros(size + further, size + 1);
        stack.view_mut((0, 0), (size, size)).copy_from(&self.root);
        stack.view_mut((size, 0), (further, size)).copy_from(rows);
        stack.view_mut((size, size), (further, 1)).copy_from(&(rows * &self.centre - values));
        let r = stack.qr().r();
        let root = r.view((0, 0), (size, size)).into_owned();
        let step = root.solve_upper_triangular(&-r.view((0, size), (size, 1)).column(0).into_owned())?;
        let left = r[(size, size)];
        Some((Normal { centre: &self.centre + step, root }, left * left))
    }
}

/// The unknowns with a physical tensor within `limits`, and drag that takes energy, that are nearest to the centre of
/// `told` in the metric of its information.
pub(crate) fn nearest(
    told: &Normal,
    limits: &[Limit],
    dissipation: &[Dissipation],
) -> Result<Nearest, FitError> {
    check_limits(limits)?;
    let mut program = Program::new(told.centre.clone(), told.root.clone(), dissipation);
    let first = told.centre.len() - 5;
    for (k, limit) in limits.iter().enumerate() {
        let n = limit.axis.normalize();
        let mut p = DVector::zeros(told.centre.len());
        p.rows_mut(first, 5).copy_from(&pair(&n, &n));
        let share = Row { base: 1.0 / 3.0 + told.centre.dot(&p), g: program.gradient(&p) };
        // of limits about one axis the tighter one, since two of them could not be told apart
        let twins =
            || limits.iter().enumerate().filter(|(_, b)| b.axis.normalize().dot(&n).abs() > 1.0 - PARALLEL);
        let tighter = |of: fn(&Limit) -> Option<f64>, sign: f64| {
            let value = of(limit)?;
            let outdoes = |(i, b): (usize, &Limit)| {
                of(b).is_some_and(|other| sign * other > sign * value || (other == value && i < k))
            };
            (!twins().any(outdoes)).then_some(value)
        };
        // what the law says anyway would only stand beside it
        if let Some(low) = tighter(|b| b.at_least, 1.0).filter(|low| *low > 0.0) {
            let row = Row { base: low - share.base, g: -&share.g };
            program.rows.push((row, side(k, limit, false), 1.0));
        }
        if let Some(high) = tighter(|b| b.at_most, -1.0).filter(|high| *high < LARGEST_SHARE) {
            let row = Row { base: share.base - high, g: share.g };
            program.rows.push((row, side(k, limit, true), 1.0));
        }
    }
    if !limits.is_empty() {
        feasible(limits)?;
    }
    let (y, rounds) = program.cut().map_err(FitError::Solver)?;
    let mut answer = program.polish(y, rounds).map_err(FitError::Solver)?;
    let mut others = DVector::from_column_slice(&answer.others);
    dissipation.iter().for_each(|of| of.clip(&mut others));
    answer.others = others.as_slice().to_vec();
    Ok(answer)
}

/// The unknowns nearest to the centre of `told` at which every body has a physical tensor, their distance in standard deviations; of each
/// body the place of its first entry, and what is added to them.
pub(crate) fn nearest_bodies(
    told: &Normal,
    bodies: &[(usize, Matrix3<f64>)],
) -> Result<(DVector<f64>, f64), SolverFailure> {
    let program = Program::of_bodies(told.centre.clone(), told.root.clone(), bodies);
    let (y, rounds) = program.cut()?;
    let answer = program.polish(y, rounds)?;
    let unknowns = answer.others.iter().chain(answer.x.iter()).copied();
    Ok((DVector::from_iterator(told.centre.len(), unknowns), answer.pull))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::constraint::Constraint;
    use crate::physical::coordinates::{Coordinates, Form, basis, coordinates, eigen, tensor};
    use nalgebra::{Matrix3, Vector3};
    use polhode::num::Random;

    /// The tensor alone.
    fn tensor_nearest(centre: Coordinates, root: Form, limits: &[Limit]) -> Result<Nearest, FitError> {
        let told = Normal {
            centre: DVector::from_column_slice(centre.as_slice()),
            root: DMatrix::from_fn(5, 5, |i, k| root[(i, k)]),
        };
        nearest(&told, limits, &[])
    }

    /// Uniform on (−1, 1).
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut random = Random::new(seed);
        move || random.between(-1.0, 1.0)
    }

    #[test]
    fn a_physical_centre_is_its_own_answer() {
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        let answer = tensor_nearest(centre, Form::identity() * 1e3, &[]).unwrap();
        assert_eq!(answer.x, centre);
        assert!(answer.active.is_empty());
    }

    #[test]
    fn with_the_identity_as_metric_the_answer_is_the_clipped_spectrum() {
        // eigenvalues (0.05, 0.25, 0.7): the nearest with trace 1 and λ ≤ ½ shares the excess equally among the others
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.05, 0.25, 0.7)));
        let answer = tensor_nearest(centre, Form::identity() * 1e4, &[]).unwrap();
        let expected = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.15, 0.35, 0.5)));
        assert!((answer.x - expected).norm() < 1e-14, "{}", (answer.x - expected).norm());
        assert_eq!(answer.active.len(), 1);
        // two eigenvalues above: both end at ½, and the third is nothing: a rod
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(-0.4, 0.65, 0.75)));
        let answer = tensor_nearest(centre, Form::identity() * 1e4, &[]).unwrap();
        let expected = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.0, 0.5, 0.5)));
        assert!((answer.x - expected).norm() < 1e-14);
        assert!(answer.active[0].constraint == Constraint::Rod);
    }

    /// Every answer is certified inside; here hard metrics (condition up to 1e8 and more) and centres far outside the cone.
    #[test]
    fn hard_random_programs_end_certified_and_no_feasible_tensor_is_nearer() {
        let mut next = numbers(4);
        let (mut held, mut negative) = (0, 0);
        for trial in 0..300 {
            let mut root = Form::from_fn(|i, k| if i < k { next() } else { 0.0 });
            for k in 0..5 {
                root[(k, k)] = libm::pow(10.0, 2.5 + 2.0 * next());
            }
            let centre = Coordinates::from_fn(|_, _| 0.5 * next());
            let answer = tensor_nearest(centre, root, &[]).unwrap_or_else(|error| panic!("{trial}: {error}"));
            let (moments, _) = eigen(tensor(&answer.x));
            assert!(moments[2] <= LARGEST_SHARE + 1e-12 && moments[0] >= -1e-12, "{trial}: {moments}");
            held += answer.active.len();
            // rounding leaves some multipliers a little below zero, which counts as their violation
            let dual = answer.certificate.dual_violation;
            assert!((0.0..1e-9).contains(&dual), "{trial}: {dual:e}");
            negative += usize::from(dual > 0.0);
            let cost = (root * (answer.x - centre)).norm();
            for _ in 0..20 {
                // a step towards any physical tensor stays physical, and must not help
                let other = Coordinates::from_fn(|_, _| 0.06 * next());
                let step = answer.x + (other - answer.x) * 1e-5;
                assert!((root * (step - centre)).norm() >= cost * (1.0 - 1e-13), "{trial}");
            }
        }
        assert!(held > 100 && negative > 10, "{held}, {negative}");
    }

    /// The answers of a semidefinite cone, in standard deviations: the cuts are another way to the same point. That solver
    /// stops within its own residual of it.
    #[test]
    fn answers_are_those_of_a_semidefinite_program() {
        let programs = include_str!("../../tests/data/fit/semidefinite.csv");
        let mut held = 0;
        let mut distances = Vec::new();
        for (trial, line) in programs.lines().skip(1).enumerate() {
            let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let vector = |at: usize| Coordinates::from_fn(|k, _| numbers[at + k]);
            let mut upper = numbers[6..21].iter();
            let mut root = Form::zeros();
            for i in 0..5 {
                for k in i..5 {
                    root[(i, k)] = *upper.next().unwrap();
                }
            }
            let answer =
                tensor_nearest(vector(1), root, &[]).unwrap_or_else(|error| panic!("{trial}: {error}"));
            let (distance, residual) = ((root * (answer.x - vector(21))).norm(), numbers[26]);
            assert!(distance < residual + 1e-6, "{trial}: {distance:e} beyond {residual:e}");
            assert!(answer.certificate.stationarity < 1e-9, "{trial}");
            distances.push(distance);
            held += answer.active.len();
        }
        distances.sort_by(f64::total_cmp);
        let (half, all) = (distances[distances.len() / 2], distances[distances.len() - 1]);
        println!(
            "{held} constraints active; half of the answers differ by less than {half:.1e}, all by {all:.1e}"
        );
        assert!(held > 30 && half < 1e-6 && all < 1e-3, "{held} {half:e} {all:e}");
    }

    /// A flat body well measured: the law is a hair's breadth away, the other walls 1e5 standard deviations.
    #[test]
    fn remote_walls_do_not_stop_the_solver() {
        let mut next = numbers(31);
        for trial in 0..200 {
            let mut root = Form::from_fn(|i, k| if i < k { 1e4 * next() } else { 0.0 });
            for k in 0..5 {
                root[(k, k)] = libm::pow(10.0, 5.5 + 1.5 * next());
            }
            let (a, b) = (0.2 + 0.05 * next(), 1e-6 * next().abs());
            let flat = Matrix3::from_diagonal(&Vector3::new(a, 0.5 - a - b, 0.5 + b));
            let centre = coordinates(&flat) + Coordinates::from_fn(|_, _| 1e-6 * next());
            let answer = tensor_nearest(centre, root, &[]).unwrap_or_else(|error| panic!("{trial}: {error}"));
            assert!(eigen(tensor(&answer.x)).0[2] <= LARGEST_SHARE, "{trial}");
        }
    }

    #[test]
    fn the_answer_turns_with_the_axes() {
        let turn = *nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), 0.7).matrix()
            * nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), -1.1).matrix();
        let map = Form::from_fn(|i, k| basis(i).dot(&(turn * basis(k) * turn.transpose())));
        let mut next = numbers(11);
        for _ in 0..20 {
            let root = Form::from_fn(|i, k| {
                if i < k {
                    next()
                } else if i == k {
                    5.0 + 4.0 * next()
                } else {
                    0.0
                }
            }) * 100.0;
            let centre = Coordinates::from_fn(|_, _| 0.4 * next());
            let a = tensor_nearest(centre, root, &[]).unwrap();
            let turned = (root * map.transpose()).qr().r();
            let b = tensor_nearest(map * centre, turned, &[]).unwrap();
            assert!((map * a.x - b.x).norm() < 1e-13, "{:e}", (map * a.x - b.x).norm());
        }
    }

    #[test]
    fn limits_hold_and_contradictions_are_named() {
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        let root = Form::identity() * 100.0;
        let x = |at_least, at_most| Limit { axis: Vector3::x(), at_least, at_most };
        let answer = tensor_nearest(centre, root, &[x(Some(0.25), None)]).unwrap();
        assert!((tensor(&answer.x)[(0, 0)] - 0.25).abs() < 1e-15);
        assert!(
            matches!(answer.active[0].constraint, Constraint::AtLeast { limit: 1, .. }),
            "{:?}",
            answer.active
        );
        assert!(answer.active[0].multiplier > 0.0);

        let clash = tensor_nearest(centre, root, &[x(Some(0.4), None), x(None, Some(0.3))])
            .err()
            .unwrap()
            .to_string();
        assert!(clash.contains("limit 1") && clash.contains("limit 2"), "{clash}");
        let law = tensor_nearest(centre, root, &[x(Some(0.6), None)]).err().unwrap().to_string();
        assert!(law.contains("half the trace"), "{law}");

        // the same limit twice, once looser, and one that the law implies
        let twice = [x(Some(0.25), None), x(Some(0.25), None), x(Some(0.22), Some(0.5))];
        let answer = tensor_nearest(centre, root, &twice).unwrap();
        assert!((tensor(&answer.x)[(0, 0)] - 0.25).abs() < 1e-15);
        assert_eq!(answer.active.len(), 1);
        for edge in [
            &[x(Some(0.3), Some(0.3))][..],
            &[x(Some(0.3), None), x(None, Some(0.300_000_1))],
            &[x(Some(0.2), Some(0.199_999_9))],
            &[x(Some(0.5), None)],
            &[x(None, Some(0.0))],
        ] {
            let error = tensor_nearest(centre, root, edge).err().unwrap();
            assert!(matches!(error, FitError::NoRoom(_)), "{error}");
        }
        let outside = tensor_nearest(centre, root, &[x(Some(5000.0), None)]).err().unwrap().to_string();
        assert!(outside.contains("limit 1 is 5000"), "{outside}");
    }

    /// Of two limits about one axis, whatever its sense, the tighter one holds the moment and is named; of two that are one the first.
    #[test]
    fn the_tighter_of_two_limits_is_named() {
        let inside = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.35, 0.3, 0.35)));
        let of = |sense: f64, at_least, at_most| Limit { axis: Vector3::x() * sense, at_least, at_most };
        let most = |shares: [f64; 2]| [of(1.0, None, Some(shares[0])), of(-2.0, None, Some(shares[1]))];
        let least = |shares: [f64; 2]| [of(1.0, Some(shares[0]), None), of(-2.0, Some(shares[1]), None)];
        for (limits, named, share) in [
            (most([0.3, 0.2]), 2, 0.2),
            (most([0.2, 0.3]), 1, 0.2),
            (most([0.2, 0.2]), 1, 0.2),
            (least([0.38, 0.4]), 2, 0.4),
            (least([0.4, 0.38]), 1, 0.4),
            (least([0.4, 0.4]), 1, 0.4),
        ] {
            let answer = tensor_nearest(inside, Form::identity() * 100.0, &limits).unwrap();
            let [active] = &answer.active[..] else { panic!("{:?}", answer.active) };
            let (Constraint::AtMost { limit, .. } | Constraint::AtLeast { limit, .. }) = active.constraint
            else {
                panic!("{active:?}")
            };
            assert_eq!(limit, named, "{limits:?}");
            assert!((tensor(&answer.x)[(0, 0)] - share).abs() < 1e-14, "{limits:?}");
            // the gradient of a moment has the square 2/3
            let multiplier = 1.5e4 * (share - 0.35).abs();
            assert!((active.multiplier / multiplier - 1.0).abs() < 1e-6, "{active:?}");
        }
    }

    /// Of a limit so narrow that both of its sides are near, the side towards the centre holds.
    #[test]
    fn the_side_towards_the_centre_holds_a_narrow_limit() {
        let (low, high) = (0.3, 0.300_004);
        let narrow = [Limit { axis: Vector3::x(), at_least: Some(low), at_most: Some(high) }];
        for (moments, share) in [([0.2, 0.35, 0.45], low), ([0.4, 0.25, 0.35], high)] {
            let centre = coordinates(&Matrix3::from_diagonal(&Vector3::from(moments)));
            let answer = tensor_nearest(centre, Form::identity() * 100.0, &narrow).unwrap();
            let [active] = &answer.active[..] else { panic!("{:?}", answer.active) };
            let is_lower = matches!(active.constraint, Constraint::AtLeast { limit: 1, .. });
            let is_upper = matches!(active.constraint, Constraint::AtMost { limit: 1, .. });
            assert_eq!((is_lower, is_upper), (share == low, share == high));
            assert!((tensor(&answer.x)[(0, 0)] - share).abs() < 1e-14, "{share}");
            assert!(
                (active.multiplier / (1.5e4 * (share - moments[0]).abs()) - 1.0).abs() < 1e-6,
                "{active:?}"
            );
        }
    }

    /// Random metrics, where nothing is known beforehand but the conditions of optimality.
    #[test]
    fn random_programs_with_drag_end_certified() {
        let mut next = numbers(23);
        let mut active = 0;
        for trial in 0..300 {
            let size = 11;
            let mut root = DMatrix::from_fn(size, size, |i, k| if i < k { 300.0 * next() } else { 0.0 });
            for k in 0..size {
                root[(k, k)] = libm::pow(10.0, 3.0 + next());
            }
            let centre = DVector::from_fn(size, |k, _| if k < 6 { 1e-3 * next() } else { 0.2 * next() });
            let of: Vec<_> = (0..6).map(|place| Dissipation { place, name: "drag" }).collect();
            let answer = nearest(&Normal { centre, root }, &[], &of)
                .unwrap_or_else(|error| panic!("{trial}: {error}"));
            active += answer.active.len();
            let others = DVector::from_column_slice(&answer.others);
            assert!(of.iter().all(|of| {
                let mut clipped = others.clone();
                of.clip(&mut clipped);
                (clipped - &others).amax() < 1e-15
            }));
        }
        assert!(active > 300, "{active}");
    }

    /// Every answer is certified inside; law and limits hold it together, and the face that the solver's answer is near is
    /// not always the one that it lies on.
    #[test]
    fn random_programs_with_a_lower_limit_end_certified() {
        with_limits(7, 25, |axis, s| Limit { axis, at_least: Some(0.4 + 0.05 * s), at_most: None });
    }

    #[test]
    fn random_programs_with_an_upper_limit_end_certified() {
        with_limits(8, 75, |axis, s| Limit { axis, at_least: None, at_most: Some(0.2 + 0.05 * s) });
    }

    fn with_limits(seed: u64, trials: usize, limit: impl Fn(Vector3<f64>, f64) -> Limit) {
        let mut next = numbers(seed);
        let (mut of_law, mut of_limits) = (0, 0);
        for trial in 0..trials {
            let mut root = Form::from_fn(|i, k| if i < k { 50.0 * next() } else { 0.0 });
            for k in 0..5 {
                root[(k, k)] = libm::pow(10.0, 2.0 + next());
            }
            let centre = Coordinates::from_fn(|_, _| 0.3 * next());
            let axis = Vector3::new(next(), next(), next());
            let limit = limit(axis, next());
            let answer =
                tensor_nearest(centre, root, &[limit]).unwrap_or_else(|error| panic!("{trial}: {error}"));
            let j = tensor(&answer.x);
            let share = axis.normalize().dot(&(j * axis.normalize()));
            assert!(eigen(j).0[2] <= LARGEST_SHARE + 1e-12, "{trial}");
            assert!(limit.at_least.is_none_or(|low| share >= low - 1e-9), "{trial}: {share}");
            assert!(limit.at_most.is_none_or(|high| share <= high + 1e-9), "{trial}: {share}");
            let is_law = |c: Constraint| matches!(c, Constraint::Triangle | Constraint::Rod);
            of_law += usize::from(answer.active.iter().any(|a| is_law(a.constraint)));
            of_limits += usize::from(answer.active.iter().any(|a| !is_law(a.constraint)));
        }
        assert!(6 * of_law > trials && 6 * of_limits > trials, "{of_law}, {of_limits}");
    }

    /// Half the squares of the distance fall by a multiplier per unit by which its constraint gives way: of a drag of −0.02 ± 0.02, of a
    /// moment a twentieth beyond its limit, and of one a fifth beyond the law.
    #[test]
    fn multipliers_are_slopes_of_half_the_squares() {
        let inside = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        let centre = DVector::from_iterator(6, core::iter::once(-0.02).chain(inside.iter().copied()));
        let mut root = DMatrix::identity(6, 6) * 1e3;
        root[(0, 0)] = 50.0;
        let of = [Dissipation { place: 0, name: "drag" }];
        let answer = nearest(&Normal { centre, root }, &[], &of).unwrap();
        assert!((0.0..1e-12).contains(&answer.others[0]) && (answer.x - inside).norm() < 1e-9);
        assert_eq!(answer.active.len(), 1);
        assert_eq!(answer.active[0].constraint, Constraint::Drag { name: "drag" });
        assert!((answer.active[0].multiplier / 50.0 - 1.0).abs() < 1e-6, "{:?}", answer.active);
        assert!((answer.pull - 1.0).abs() < 1e-9, "{}", answer.pull);

        // the gradient of a moment has the square 2/3
        let at_least = Limit { axis: Vector3::x() * 3.0, at_least: Some(0.25), at_most: None };
        let at_most = Limit { axis: Vector3::y() * 0.1, at_least: None, at_most: Some(0.3) };
        let flat = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.05, 0.25, 0.7)));
        for (centre, limits, beyond) in
            [(inside, &[at_least][..], 0.05), (inside, &[at_most][..], 0.05), (flat, &[][..], 0.2)]
        {
            let answer = tensor_nearest(centre, Form::identity() * 100.0, limits).unwrap();
            let [active] = &answer.active[..] else { panic!("{:?}", answer.active) };
            assert!((active.multiplier / (1.5e4 * beyond) - 1.0).abs() < 1e-6, "{active:?}");
            let pull = 100.0 * beyond * 1.5_f64.sqrt();
            assert!((answer.pull / pull - 1.0).abs() < 1e-9, "{}", answer.pull);
        }
    }

    /// The nearest body to moments of which one exceeds the sum of the others by 1: each changes by a third, and what is added stays.
    #[test]
    fn a_body_gives_a_third_to_each_moment() {
        let base = Matrix3::from_diagonal(&Vector3::new(0.5, 0.0, 0.0));
        let told = |centre: [f64; 6]| Normal {
            centre: DVector::from_column_slice(&centre),
            root: DMatrix::identity(6, 6) * 10.0,
        };
        let (found, pull) = nearest_bodies(&told([0.5, 1.0, 3.0, 0.0, 0.0, 0.0]), &[(0, base)]).unwrap();
        let expected = DVector::from_vec(vec![0.5 + 1.0 / 3.0, 4.0 / 3.0, 8.0 / 3.0, 0.0, 0.0, 0.0]);
        assert!((found - expected).amax() < 1e-9);
        assert!((pull - 10.0 / 3.0_f64.sqrt()).abs() < 1e-7, "{pull}");
        let inside = told([0.5, 1.0, 1.5, 0.1, 0.0, -0.1]);
        let (found, pull) = nearest_bodies(&inside, &[(0, base)]).unwrap();
        assert!((found - &inside.centre).amax() < 1e-15 && pull == 0.0, "{pull}");
    }
}
