//! What is known of the moments beforehand, and whether it agrees with itself and with the physical law.

use crate::thresholds::limits::{MET, PUSHES, ROOM, ROUNDS};
use nalgebra::Vector3;

use crate::error::{Clash, FitError};
use crate::physical::conic::Conditions;
use crate::physical::constraint::Constraint;
use crate::physical::coordinates::{Coordinates, eigen, pair, tensor};
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;

/// Limits on the moment of inertia about an axis, as shares of the trace, that are known beforehand.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{FitError, Limit, Record, Settings, fit, simulate};
/// use polhode::inertia::Inertia;
/// use polhode::num::Random;
/// # let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// # let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// # let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-3, &mut Random::new(7))?;
/// let record = Record::from_samples(&times, &rates)?;
/// let with = |limit| fit(&record, &Settings::default().with_limits(vec![limit]));
/// let held = with(Limit { axis: Vector3::x(), at_least: Some(0.2), at_most: None })?;
/// assert!((held.shape.tensor()[(0, 0)] - 0.2).abs() < 1e-12 && held.pull > 10.0);
///
/// // no moment exceeds half the trace
/// let refused = with(Limit { axis: Vector3::x(), at_least: Some(0.6), at_most: None });
/// assert!(matches!(refused, Err(FitError::Contradiction(_))));
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Any non-zero vector along the axis, in sensor axes.
    pub axis: Vector3<f64>,
    /// Smallest share; physically not below 0.
    pub at_least: Option<f64>,
    /// Largest share; physically not above ½.
    pub at_most: Option<f64>,
}

/// One side of a limit as a constraint.
pub(crate) fn side(index: usize, given: &Limit, upper: bool) -> Constraint {
    let (limit, axis) = (index + 1, given.axis);
    if upper {
        Constraint::AtMost { limit, axis, share: given.at_most.unwrap_or(f64::INFINITY) }
    } else {
        Constraint::AtLeast { limit, axis, share: given.at_least.unwrap_or(f64::INFINITY) }
    }
}

pub(crate) fn check_limits(limits: &[Limit]) -> Result<(), FitError> {
    for (k, limit) in limits.iter().enumerate() {
        let size = limit.axis.norm();
        if !(size > 0.0 && size.is_finite()) {
            return Err(FitError::LimitAxis { limit: k + 1, axis: limit.axis.into() });
        }
        for value in [limit.at_least, limit.at_most].into_iter().flatten() {
            if !(0.0..=1.0).contains(&value) {
                return Err(FitError::LimitValue { limit: k + 1, value });
            }
        }
    }
    Ok(())
}

/// Phase 1: the least common relaxation t of all limits over the physical tensors.
///
/// Where t > 0 the limits with the largest multipliers are those that clash.
pub(crate) fn feasible(limits: &[Limit]) -> Result<(), FitError> {
    let mut sides: Vec<(Coordinates, f64, Constraint)> = Vec::new();
    for (k, limit) in limits.iter().enumerate() {
        let n = limit.axis.normalize();
        let g = pair(&n, &n);
        if let Some(low) = limit.at_least {
            sides.push((-g, 1.0 / 3.0 - low, side(k, limit, false)));
        }
        if let Some(high) = limit.at_most {
            sides.push((g, high - 1.0 / 3.0, side(k, limit, true)));
        }
    }
    let mut cuts: Vec<Vector3<f64>> = (0..3).map(|k| Vector3::ith(k, 1.0)).collect();
    let six = |g: &Coordinates, t: f64| [g[0], g[1], g[2], g[3], g[4], t];
    for _ in 0..ROUNDS {
        let mut conditions = Conditions::new(6);
        for (g, right, _) in &sides {
            conditions.nonnegative(&six(g, -1.0), *right);
        }
        for v in &cuts {
            conditions.nonnegative(&six(&pair(v, v), 0.0), LARGEST_SHARE - v.norm_squared() / 3.0);
        }
        for k in 0..6 {
            // any physical tensor lies well inside, and so does any t, since limits and moments are shares
            for sign in [1.0, -1.0] {
                let unit: [f64; 6] = core::array::from_fn(|i| if i == k { sign } else { 0.0 });
                conditions.nonnegative(&unit, 1.0);
            }
        }
        let (answer, duals) = conditions
            .solve_with_duals(&[0.0; 6], &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
            .map_err(FitError::Solver)?;
        let x = Coordinates::from_column_slice(&answer[..5]);
        let (moments, axes) = eigen(tensor(&x));
        if moments[2] - LARGEST_SHARE > MET * ROOM {
            cuts.extend((0..3).map(|k| axes.column(k).into_owned()));
            continue;
        }
        if answer[5] <= -ROOM {
            return Ok(());
        }
        let mut order: Vec<usize> = (0..sides.len()).collect();
        order.sort_by(|&a, &b| duals[b].total_cmp(&duals[a]));
        let first = sides[order[0]].2;
        let with = order.get(1).filter(|&&k| duals[k] > PUSHES).map(|&k| sides[k].2);
        let second = with.unwrap_or(Constraint::Triangle);
        let clash = Box::new(Clash { first, second, gap: answer[5] });
        let error = if answer[5] > ROOM { FitError::Contradiction(clash) } else { FitError::NoRoom(clash) };
        return Err(error);
    }
    Err(FitError::Solver(SolverFailure::Limits))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about_x(at_least: Option<f64>, at_most: Option<f64>) -> Limit {
        Limit { axis: Vector3::x() * 2.0, at_least, at_most }
    }

    /// An axis has a direction, and a share is one of the whole; the limit is named by its place.
    #[test]
    fn limits_that_are_none_are_refused_by_their_number() {
        let fine = [about_x(Some(0.0), Some(1.0)), about_x(None, None)];
        assert_eq!(check_limits(&fine), Ok(()));
        for value in [-1e-9, 1.0 + 1e-9] {
            for bad in [about_x(Some(value), None), about_x(None, Some(value))] {
                let found = check_limits(&[fine[0], bad]);
                assert_eq!(found, Err(FitError::LimitValue { limit: 2, value }));
            }
        }
        assert!(check_limits(&[about_x(Some(f64::NAN), None)]).is_err());
        for axis in [Vector3::zeros(), Vector3::new(f64::INFINITY, 0.0, 0.0)] {
            let found = check_limits(&[fine[0], fine[1], Limit { axis, ..fine[0] }]);
            assert_eq!(found, Err(FitError::LimitAxis { limit: 3, axis: axis.into() }));
        }
    }

    /// Half of what two limits about one axis are apart, or two of three moments are too small, is the least that all must give way;
    /// alone beyond the law, a limit gives all.
    #[test]
    fn a_clash_is_as_large_as_what_all_limits_must_give() {
        let of = |limits: &[Limit]| match feasible(limits) {
            Err(FitError::Contradiction(clash)) => *clash,
            other => panic!("{other:?}"),
        };
        let apart = [about_x(Some(0.4), None), about_x(None, Some(0.3))];
        let Clash { first, second, gap } = of(&apart);
        assert!((gap - 0.05).abs() < 1e-6, "{gap}");
        let sides = [side(0, &apart[0], false), side(1, &apart[1], true)];
        assert!(first != second && sides.contains(&first) && sides.contains(&second), "{first} {second}");
        // another limit, wherever it is given, has no part in it
        let idle = Limit { axis: Vector3::z(), at_least: Some(0.1), at_most: Some(0.45) };
        for (place, [low, high]) in [[1, 2], [0, 2], [0, 1]].into_iter().enumerate() {
            let mut three = apart.to_vec();
            three.insert(place, idle);
            let Clash { first, second, gap } = of(&three);
            let sides = [side(low, &three[low], false), side(high, &three[high], true)];
            assert!((gap - 0.05).abs() < 1e-6 && first != second, "{place}: {gap}");
            assert!(sides.contains(&first) && sides.contains(&second), "{place}: {first} {second}");
        }
        let about_y = Limit { axis: Vector3::y(), at_least: None, at_most: Some(0.2) };
        assert!((of(&[about_x(None, Some(0.2)), about_y]).gap - 0.05).abs() < 1e-6);
        let alone = of(&[about_x(Some(0.6), None)]);
        assert!((alone.gap - 0.1).abs() < 1e-6, "{}", alone.gap);
        assert_eq!(alone.first, side(0, &about_x(Some(0.6), None), false));
        assert_eq!(alone.second, Constraint::Triangle);
        assert_eq!(feasible(&[about_x(Some(0.3), Some(0.31))]), Ok(()));
    }
}
