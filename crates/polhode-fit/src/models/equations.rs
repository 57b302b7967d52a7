//! The equations of a weak estimate with the columns of every torque and every error of the sensor: a triangle for each segment, in which
//! each model is a choice of columns.

use crate::columns::column::{Column, Unknowns};
use crate::columns::sets::torque_columns;
use crate::models::MODELS;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::solve::linearised::residuals;
use crate::solve::stacked::{Stacked, small_triangle};
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
            let rows = part.with_columns(&stretches[part.stretch], &columns, &origin)?;
            Some(Segment { equations: rows.len() / width, rows: small_triangle(&rows, width) })
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
        let place = |column: &Column| {
            let torques_on = self.columns.iter().enumerate().skip(self.errors);
            torques_on.filter(|(_, other)| other.is_alike(column)).map(|(k, _)| k).next()
        };
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
