//! The equations of a weak estimate with the columns of every torque and every error of the sensor: a triangle for each segment, in which
//! each model is a choice of columns.

use crate::columns::column::{Column, Unknowns};
use crate::columns::sets::torque_columns;
use crate::models::MODELS;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::solve::blocks::TOGETHER;
use crate::solve::linearised::residuals;
use crate::solve::stacked::{SmallTriangle, Stacked, small_triangle};
use crate::solve::triangle::Triangle;
use crate::solve::weak_estimate::WeakEstimate;

/// The equations of an estimate, linearised where it stands, with its noise as it was estimated.
pub(crate) struct Equations {
    /// Errors of the sensor that the fit takes to be zero, then every torque, then those that every model has.
    columns: Vec<Column>,
    errors: usize,
    torques: usize,
    origin: Unknowns,
    segments: Vec<Segment>,
    deviation: f64,
}

/// The equations of a segment.
struct Segment {
    /// How many they are.
    equations: usize,
    /// Their triangle row by row.
    rows: Vec<f64>,
}

/// The equations of one model.
pub(crate) struct OfModel {
    columns: Vec<Column>,
    origin: Unknowns,
    segments: Vec<Segment>,
    deviation: f64,
}

impl Equations {
    /// Of an estimate whose last columns are `common`, which every model has, and that takes `errors` to be zero; `variance` is that of the
    /// noise.
    pub(crate) fn new(
        stretches: &[Stretch],
        weak: &WeakEstimate,
        errors: &[Column],
        common: &[Column],
        variance: f64,
    ) -> Option<Self> {
        let torques = MODELS.into_iter().flat_map(torque_columns);
        let columns: Vec<Column> =
            errors.iter().copied().chain(torques).chain(common.iter().copied()).collect();
        let value = |column: &Column| {
            let own = weak.columns.iter().position(|own| own.is_alike(column));
            own.map_or(0.0, |k| weak.at.c[k])
        };
        let origin = Unknowns { x: weak.at.x, c: columns.iter().map(value).collect() };
        let width = columns.len() + 6;
        let each = weak.parts.iter().map(|part| {
            let stretch = &stretches[part.stretch];
            let may_act = |k: &usize| columns.get(*k).is_none_or(|column| column.acts_on(stretch));
            let mut small = SmallTriangle::new(width, (0..width).filter(may_act).collect());
            part.with_columns(stretch, &columns, &origin, TOGETHER, |rows| small.push(rows))?;
            Some(Segment { equations: 3 * part.linearised.tests.count, rows: small.finished() })
        });
        let segments = each.collect::<Option<Vec<Segment>>>()?;
        let (errors, torques) = (errors.len(), columns.len() - errors.len() - common.len());
        Some(Equations { columns, errors, torques, origin, segments, deviation: variance.sqrt() })
    }

    /// The errors that are taken to be zero.
    pub(crate) fn errors(&self) -> &[Column] {
        &self.columns[..self.errors]
    }

    /// Rows that stand for those of each segment, with the columns of the errors and then `own`, the columns of the estimate.
    pub(crate) fn with_errors(&self, own: &[Column]) -> Option<Vec<Vec<f64>>> {
        let place = |own: &Column| (self.errors..self.columns.len()).find(|&k| self.columns[k].is_alike(own));
        let own = own.iter().map(place).collect::<Option<Vec<usize>>>()?;
        let last = self.columns.len()..self.columns.len() + 6;
        let kept: Vec<usize> = (0..self.errors).chain(own).chain(last.clone()).collect();
        let rows = |segment: &Segment| {
            let rows = segment.rows.chunks_exact(last.end);
            rows.flat_map(|row| kept.iter().map(|&k| row[k])).collect()
        };
        Some(self.segments.iter().map(rows).collect())
    }

    /// Those of one model: the torques that it has not, and the errors of the sensor, are zero.
    pub(crate) fn of(&self, model: TorqueModel) -> OfModel {
        self.of_all(&[model])
    }

    /// Those of several models together.
    pub(crate) fn of_all(&self, models: &[TorqueModel]) -> OfModel {
        let own: Vec<Column> = models.iter().copied().flat_map(torque_columns).collect();
        self.with(self.errors..self.errors + self.torques, &own)
    }

    /// Those of errors of the record with their priors, without a torque; `None` where the fit has these errors, or they are not among those
    /// that it takes to be zero.
    pub(crate) fn of_errors(&self, own: &[Column]) -> Option<OfModel> {
        let is_here = |column: &Column| self.errors().iter().any(|other| other.is_alike(column));
        own.iter().all(is_here).then(|| self.with(0..self.errors, own))
    }

    /// Those with the columns that every model has, and of a range of the others those alike to `own`, with the priors of these.
    fn with(&self, range: core::ops::Range<usize>, own: &[Column]) -> OfModel {
        let alike = |k: &usize| own.iter().find(|column| column.is_alike(&self.columns[*k])).copied();
        let common = self.errors + self.torques;
        let (kept, left): (Vec<usize>, Vec<usize>) =
            (0..self.columns.len()).partition(|k| *k >= common || (range.contains(k) && alike(k).is_some()));
        let prior = |k: &usize| if *k < common { alike(k)?.prior } else { self.columns[*k].prior };
        let width = self.columns.len() + 6;
        let row = |row: &[f64]| {
            let gone: f64 = left.iter().map(|&k| row[k] * self.origin.c[k]).sum();
            let unknowns = kept.iter().copied().chain(self.columns.len()..width - 1).map(|k| row[k]);
            unknowns.chain([row[width - 1] - gone]).collect::<Vec<f64>>()
        };
        let of_segment = |segment: &Segment| Segment {
            rows: segment.rows.chunks_exact(width).flat_map(row).collect(),
            ..*segment
        };
        OfModel {
            columns: kept.iter().map(|k| self.columns[*k].with_prior(prior(k))).collect(),
            origin: Unknowns { x: self.origin.x, c: kept.iter().map(|&k| self.origin.c[k]).collect() },
            segments: self.segments.iter().map(of_segment).collect(),
            deviation: self.deviation,
        }
    }
}

impl OfModel {
    /// All segments together, the unknowns at their best.
    pub(crate) fn stacked(&self) -> Stacked {
        let rows: Vec<&[f64]> = self.segments.iter().map(|segment| segment.rows.as_slice()).collect();
        self.of_rows(&rows)
    }

    fn of_rows(&self, rows: &[&[f64]]) -> Stacked {
        Stacked::new(rows, &self.columns, &self.origin, self.deviation)
    }

    /// The segments before and after the border at which two tensors, each with columns of its own, explain them best, and the share of the
    /// equations before it; `None` of one segment.
    pub(crate) fn parted(&self) -> Option<(f64, [Stacked; 2])> {
        let width = self.columns.len() + 6;
        let small = |segment: &Segment| small_triangle(&segment.rows, width);
        let small: Vec<Vec<f64>> = self.segments.iter().map(small).collect();
        let rows: Vec<&[f64]> = small.iter().map(Vec::as_slice).collect();
        let count = |segments: &[Segment]| segments.iter().map(|segment| segment.equations).sum::<usize>();
        let at = |k: usize| {
            let share = count(&self.segments[..k]) as f64 / count(&self.segments) as f64;
            (share, [self.of_rows(&rows[..k]), self.of_rows(&rows[k..])])
        };
        let squares = |parts: &[Stacked; 2]| parts[0].squares + parts[1].squares;
        (1..rows.len()).map(at).min_by(|a, b| squares(&a.1).total_cmp(&squares(&b.1)))
    }

    /// Mean square of the equations of each segment, over their noise, at what the others say; `None` of one segment.
    pub(crate) fn held_out(&self) -> Option<f64> {
        if self.segments.len() < 2 {
            return None;
        }
        let width = self.columns.len() + 6;
        // triangles of all segments before each one, and of all after it
        let grown = |rows: &Vec<f64>, segment: &Segment| triangle(&[rows, &segment.rows], width);
        let mut before = vec![Vec::new()];
        for segment in &self.segments[..self.segments.len() - 1] {
            before.extend(before.last().map(|rows| grown(rows, segment)));
        }
        let (mut after, mut squares, mut equations) = (Vec::new(), 0.0, 0);
        for (segment, before) in self.segments.iter().zip(&before).rev() {
            let at = self.of_rows(&[before, &after]).minimiser()?;
            let left = residuals(&segment.rows, width, &self.origin, &at);
            squares += left.iter().map(|r| r * r).sum::<f64>();
            equations += segment.equations;
            after = grown(&after, segment);
        }
        Some(squares / equations as f64 / (self.deviation * self.deviation)).filter(|mean| mean.is_finite())
    }
}

/// The triangle of rows of `width` numbers, row by row.
fn triangle(rows: &[&[f64]], width: usize) -> Vec<f64> {
    let mut triangle = Triangle::new(width);
    for row in rows.iter().flat_map(|rows| rows.chunks_exact(width)) {
        triangle.push(row.iter().copied());
    }
    let r = triangle.finished();
    (0..width).flat_map(|i| (0..width).map(move |k| (i, k))).map(|at| r[at]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::constant::Constant;
    use crate::columns::drag::Drag;
    use crate::columns::offset::Offset;
    use crate::columns::scale::Scale;
    use crate::physical::coordinates::{Coordinates, coordinates};
    use crate::signal::covariance::Levels;
    use crate::signal::test_functions::TestFunctions;
    use crate::solve::linearised::Linearised;
    use crate::solve::weak_estimate::Part;
    use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
    use polhode::num::Random;

    const DEVIATION: f64 = 0.7;

    /// Of three segments with an error of the sensor, two torques, and a scale that every model has.
    fn example() -> Equations {
        let mut random = Random::new(11);
        let columns = vec![
            Column::new(Offset(0), None),
            Column::new(Drag, None),
            Column::new(Constant(0), None),
            Column::new(Scale, Some(0.2)),
        ];
        let origin =
            Unknowns { x: Coordinates::from_fn(|_, _| 0.1 * random.normal()), c: vec![0.3, -0.2, 0.5, 0.1] };
        let segments = [12, 15, 9].map(|rows| Segment {
            equations: 10 * rows,
            rows: (0..10 * rows).map(|_| random.normal()).collect(),
        });
        Equations { columns, errors: 1, torques: 2, origin, segments: segments.into(), deviation: DEVIATION }
    }

    /// The equations of an estimate have every torque between the errors and what all models have, each at its value in the estimate or zero.
    #[test]
    fn equations_stand_where_the_estimate_does() {
        let times: Vec<f64> = (0..60).map(|k| 0.25 * f64::from(k)).collect();
        let rates = times.iter().map(|t| Vector3::new(0.5 + 0.1 * t, 0.8 - 0.05 * t, 0.3)).collect();
        let (stretch, noise) = (Stretch::new(times, rates), vec![Vector3::<f64>::zeros(); 60]);
        let (drag, scale) = (Column::new(Drag, None), Column::new(Scale, Some(0.2)));
        let columns = vec![drag, scale];
        let x = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        let at = Unknowns { x, c: vec![0.05, 0.015] };
        let tests = TestFunctions::new(&stretch, 1.5).unwrap();
        let equations = 3 * tests.count;
        let linearised = Linearised::new(&stretch, &noise, &columns, at.clone(), tests);
        let (rows, left, levels) = (Vec::new(), Vec::new(), Levels::WHITE);
        let part = Part { stretch: 0, linearised, rows, left, levels, log_determinant: 0.0, noise };
        let plain = WeakEstimate::plain(columns, at, equations);
        let weak = WeakEstimate { radius: 1.5, parts: vec![part], ..plain };
        let offsets = [0, 1, 2].map(|k| Column::new(Offset(k), None));
        let found = Equations::new(&[stretch], &weak, &offsets, &[scale], 0.25).unwrap();
        // one of drag, one with the square of the rate, and three each of viscous drag and of a constant torque
        assert_eq!((found.errors().len(), found.torques, found.columns.len()), (3, 8, 12));
        assert!(found.columns[3].is_alike(&drag) && found.columns[11] == scale && found.deviation == 0.5);
        let mut values = vec![0.0; 12];
        (values[3], values[11]) = (0.05, 0.015);
        assert_eq!(found.origin, Unknowns { x, c: values });
        assert_eq!(found.segments.iter().map(|segment| segment.equations).collect::<Vec<_>>(), [equations]);
    }

    /// A model has the columns of its torque and those of every model; what it has not is zero, and its part is taken off the residuals.
    #[test]
    fn models_are_choices_of_columns() {
        let all = example();
        let offset = Column::new(Offset(0), Some(0.4));
        let names = |of: &OfModel| of.columns.iter().map(|c| (c.label().name, c.prior)).collect::<Vec<_>>();
        let check = |of: &OfModel, kept: &[usize], left: &[usize]| {
            assert_eq!(of.origin.c, kept.iter().map(|&k| all.origin.c[k]).collect::<Vec<f64>>());
            assert_eq!((of.origin.x, of.deviation), (all.origin.x, DEVIATION));
            for (own, segment) in of.segments.iter().zip(&all.segments) {
                assert_eq!(own.equations, segment.equations);
                let rows = own.rows.chunks_exact(kept.len() + 6).zip(segment.rows.chunks_exact(10));
                for (own, row) in rows {
                    let taken: f64 = left.iter().map(|&k| row[k] * all.origin.c[k]).sum();
                    let expected = kept.iter().map(|&k| row[k]).chain(row[4..9].iter().copied());
                    assert!(own.iter().zip(expected).all(|(a, b)| *a == b), "{own:?} {row:?}");
                    assert!((own[own.len() - 1] - row[9] + taken).abs() < 1e-14);
                }
            }
        };
        let (scale, drag) = (("scale", Some(0.2)), ("drag", None));
        let none = all.of(TorqueModel::None);
        assert_eq!(names(&none), [scale]);
        check(&none, &[3], &[0, 1, 2]);
        let one = all.of(TorqueModel::Drag);
        assert_eq!(names(&one), [drag, scale]);
        check(&one, &[1, 3], &[0, 2]);
        let both = all.of_all(&[TorqueModel::Constant, TorqueModel::Drag]);
        assert_eq!(names(&both), [drag, ("torque_x", None), scale]);
        check(&both, &[1, 2, 3], &[0]);
        // an error has the prior that is given with it, and no torque beside it
        let error = all.of_errors(&[offset]).unwrap();
        assert_eq!(names(&error), [("offset_x", Some(0.4)), scale]);
        check(&error, &[0, 3], &[1, 2]);
        assert!(all.of_errors(&[offset, Column::new(Offset(1), None)]).is_none());
        assert!(all.of_errors(&[Column::new(Drag, None)]).is_none());

        assert!(all.errors().len() == 1 && all.errors()[0].is_alike(&offset));
        let with = all.with_errors(&[Column::new(Scale, None), Column::new(Drag, None)]).unwrap();
        assert_eq!(with.len(), 3);
        for (own, segment) in with.iter().zip(&all.segments) {
            for (own, row) in own.chunks_exact(9).zip(segment.rows.chunks_exact(10)) {
                assert_eq!(own[..3], [row[0], row[3], row[1]]);
                assert_eq!(own[3..], row[4..]);
            }
        }
        // errors are not columns of the estimate
        assert!(all.with_errors(&[offset]).is_none());
    }

    /// The least of |A (u − origin) + e|² over rows of some segments and the prior of the scale, and where it is.
    fn least(of: &OfModel, segments: &[usize]) -> (DVector<f64>, f64) {
        let rows = || segments.iter().flat_map(|&k| of.segments[k].rows.chunks_exact(7));
        let weight = DEVIATION / 0.2;
        let prior = [weight, 0.0, 0.0, 0.0, 0.0, 0.0, weight * of.origin.c[0]];
        let all: Vec<&[f64]> = rows().chain([&prior[..]]).collect();
        let a = DMatrix::from_fn(all.len(), 6, |i, k| all[i][k]);
        let e = DVector::from_fn(all.len(), |i, _| all[i][6]);
        let step = a.tr_mul(&a).cholesky().unwrap().solve(&-a.tr_mul(&e));
        let squares = (a * &step + e).norm_squared();
        (step, squares)
    }

    /// Each segment is foretold by the others, and the mean counts its equations.
    #[test]
    fn segments_are_foretold_by_the_others() {
        let mut of = example().of(TorqueModel::None);
        let mut squares = 0.0;
        for (k, others) in [[1, 2], [0, 2], [0, 1]].into_iter().enumerate() {
            let (step, _) = least(&of, &others);
            for row in of.segments[k].rows.chunks_exact(7) {
                let left = row[6] + (0..6).map(|i| row[i] * step[i]).sum::<f64>();
                squares += left * left;
            }
        }
        let expected = squares / 360.0 / (DEVIATION * DEVIATION);
        let found = of.held_out().unwrap();
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        of.segments.truncate(1);
        assert!(of.held_out().is_none());
    }

    /// A record is parted where both tensors leave least, each with a scale of its own; its share is that of the equations.
    #[test]
    fn a_record_is_parted_where_both_parts_leave_least() {
        let mut of = example().of(TorqueModel::None);
        for (parted, share) in [(1, 12.0 / 36.0), (2, 27.0 / 36.0)] {
            // the segments beyond the border are of another tensor
            let mut random = Random::new(3);
            for (k, segment) in of.segments.iter_mut().enumerate() {
                let size = if k < parted { 10.0 } else { -10.0 };
                for row in segment.rows.chunks_exact_mut(7) {
                    row[6] = size * row[3] + 0.1 * random.normal();
                }
            }
            let (found, [before, after]) = of.parted().unwrap();
            assert!((found - share).abs() < 1e-14, "{found} {share}");
            let parts: [&[usize]; 2] = if parted == 1 { [&[0], &[1, 2]] } else { [&[0, 1], &[2]] };
            for (part, segments) in [before, after].iter().zip(parts) {
                let (step, squares) = least(&of, segments);
                assert!((part.squares / squares - 1.0).abs() < 1e-9, "{} {squares}", part.squares);
                let x = part.minimiser().unwrap().x - of.origin.x;
                assert!((0..5).all(|k| (x[k] - step[k + 1]).abs() < 1e-9));
            }
        }
        of.segments.truncate(1);
        assert!(of.parted().is_none());
    }
}
