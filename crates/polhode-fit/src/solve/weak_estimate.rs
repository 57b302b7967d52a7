//! The weak estimate of a record: where its rounds ended.

use crate::thresholds::rounds::{BEYOND, RESTLESS, STILL};
use crate::thresholds::stacked::ITERATIONS;
use core::ops::Range;
use nalgebra::Vector3;

use crate::columns::column::{Column, Unknowns};
use crate::physical::coordinates::{Coordinates, Form, eigen, pair, tensor};
use crate::physical::law::LARGEST_SHARE;
use crate::signal::covariance::{Covariance, Levels, Whites};
use crate::signal::stretch::Stretch;
use crate::solve::blocks::whitened;
use crate::solve::driven::Driven;
use crate::solve::linearised::{Linearised, last_column, residuals};
use crate::solve::rows::{Rows, rows};
use crate::solve::stacked::Stacked;
use crate::thresholds::noise::{DEVIATIONS, SURE};

/// How near rounds ended to a fixed point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Convergence {
    /// They stood still there.
    Still,
    /// A further round would move the tensor by a part of its standard deviation.
    Near,
    /// They went on, and there is no answer.
    None,
}

/// The weak estimate of a record: where its rounds ended.
pub(crate) struct WeakEstimate {
    pub(crate) radius: f64,
    pub(crate) columns: Vec<Column>,
    pub(crate) at: Unknowns,
    /// Standard deviations by which a further round would move x; infinite where no round could be made, and this is
    /// good for one question only: what is undetermined.
    pub(crate) moved: f64,
    /// Upper triangular, Rᵀ R = H at a motion free of noise.
    pub(crate) root: Form,
    /// The equations of all stretches; `None` where no round could be made.
    pub(crate) stacked: Option<Stacked>,
    /// D of the mean rates; zero where R is taken at a motion that stands out of the noise.
    pub(crate) doubt: Form,
    /// Sum of squares of the whitened residuals.
    pub(crate) squares: f64,
    /// Equations beyond the columns without a prior.
    pub(crate) rows: usize,
    /// Each stretch that is long enough.
    pub(crate) parts: Vec<Part>,
}

/// The equations of one stretch.
pub(crate) struct Part {
    pub(crate) stretch: usize,
    /// Without its rows.
    pub(crate) linearised: Linearised,
    /// These whitened.
    pub(crate) rows: Vec<f64>,
    /// Residuals where the rounds ended, not whitened.
    pub(crate) left: Vec<f64>,
    pub(crate) levels: Levels,
    /// log |C| less that of the noise of the rates alone; infinite where that is not positive.
    pub(crate) log_determinant: f64,
    /// The noise of the samples so far.
    pub(crate) noise: Vec<Vector3<f64>>,
}

impl Part {
    /// Hands over the rows of the same samples with other columns, whitened alike, those of so many tests `together`: all of them would be the
    /// most that a fit keeps. `None` where the covariance is not positive.
    pub(crate) fn with_columns(
        &self,
        stretch: &Stretch,
        columns: &[Column],
        at: &Unknowns,
        together: usize,
        take: impl FnMut(&[f64]),
    ) -> Option<()> {
        let Linearised { tests, terms, .. } = &self.linearised;
        // of torque noise all residuals tell what it does to each row; without it nothing of the covariance is kept
        let factor = match self.levels.torque > 0.0 {
            true => Some(self.covariance(stretch).into_factor(self.levels)?),
            false => None,
        };
        let driven = factor.as_ref().and_then(|factor| {
            let residuals = || self.residuals_with(stretch, columns, at);
            Driven::new(residuals, columns, &terms.j, factor, self.levels, tests)
        });
        let whites = Whites::new(stretch, &self.noise, terms, tests, self.levels.white);
        let rows = Rows::new(stretch, &self.noise, columns, at, tests);
        let made = |own: Range<usize>| {
            let mut block = rows.of(own.clone());
            driven.iter().for_each(|driven| driven.take_out(&mut block, own.start));
            let columns = match &factor {
                Some(factor) => factor.columns(3 * own.start..3 * own.end),
                None => whites.of(own),
            };
            (columns, block)
        };
        whitened(tests.count, together, factor.is_some(), made, take)
    }

    /// The residuals of the same samples with other columns. Those that are zero do not change them.
    fn residuals_with(&self, stretch: &Stretch, columns: &[Column], at: &Unknowns) -> Vec<f64> {
        let (columns, c): (Vec<Column>, Vec<f64>) =
            columns.iter().copied().zip(at.c.iter().copied()).filter(|(_, c)| *c != 0.0).unzip();
        let at = Unknowns { x: at.x, c };
        let rows = rows(stretch, &self.noise, &columns, &at, &self.linearised.tests);
        last_column(&rows, columns.len() + 6)
    }

    /// The covariance of its equations, which is not kept.
    pub(crate) fn covariance(&self, stretch: &Stretch) -> Covariance {
        self.linearised.covariance(stretch, &self.noise)
    }

    /// Three for each centre, whitened.
    pub(crate) fn residuals(&self, at: &Unknowns) -> Vec<f64> {
        residuals(&self.rows, self.linearised.width, &self.linearised.origin, at)
    }

    /// Centres of the test functions.
    pub(crate) fn centres(&self) -> Vec<f64> {
        self.linearised.tests.centres()
    }
}

impl WeakEstimate {
    /// The coordinates of the tensor.
    pub(crate) fn x(&self) -> Coordinates {
        self.at.x
    }

    /// How near the rounds ended to a fixed point.
    pub(crate) fn convergence(&self) -> Convergence {
        match self.moved {
            moved if moved <= STILL => Convergence::Still,
            moved if moved <= RESTLESS => Convergence::Near,
            _ => Convergence::None,
        }
    }

    /// Whether that is near enough for an answer.
    pub(crate) fn has_settled(&self) -> bool {
        self.convergence() != Convergence::None
    }

    /// Whether a body may have this tensor, or one near it: J = n nᵀ solves the equations of any spin about n, with
    /// residuals and covariance that vanish together, and rounds may end there.
    pub(crate) fn possible(&self, variance: f64) -> bool {
        let (moments, axes) = eigen(tensor(&self.at.x));
        let top = axes.column(2).into_owned();
        let share = self.root.transpose().solve_lower_triangular(&pair(&top, &top));
        let excess = variance * self.misfit(variance).max(1.0);
        let deviation = share.map_or(f64::INFINITY, |g| g.norm() * excess.sqrt());
        moments[2] - LARGEST_SHARE <= (SURE * deviation).max(BEYOND)
    }

    /// Whether torque noise has a part in it.
    pub(crate) fn has_torque_noise(&self) -> bool {
        self.parts.iter().any(|part| part.levels.torque > 0.0)
    }

    /// Equations beyond the unknowns.
    pub(crate) fn dof(&self) -> usize {
        self.rows.saturating_sub(5)
    }

    /// Mean square of the residuals over the noise.
    pub(crate) fn misfit(&self, variance: f64) -> f64 {
        self.squares / variance / self.dof().max(1) as f64
    }

    /// Misfit beyond which noise alone does not carry it.
    pub(crate) fn expected_misfit(&self) -> f64 {
        1.0 + DEVIATIONS * (2.0 / self.dof().max(1) as f64).sqrt()
    }

    /// R as it would be without some of the columns.
    pub(crate) fn without(&self, left_out: &[usize], deviation: f64) -> Option<Form> {
        let stacked = self.stacked.as_ref()?;
        let kept: Vec<usize> = (0..self.columns.len()).filter(|k| !left_out.contains(k)).collect();
        let columns: Vec<Column> = kept.iter().map(|&k| self.columns[k]).collect();
        let origin = Unknowns { x: stacked.origin.x, c: kept.iter().map(|&k| stacked.origin.c[k]).collect() };
        let width = self.columns.len() + 6;
        let rows: Vec<Vec<f64>> = self
            .parts
            .iter()
            .map(|part| {
                let each = part.rows.chunks_exact(width);
                let kept = |row: &[f64]| {
                    let own = kept.iter().map(|&k| row[k]);
                    own.chain(row[width - 6..].iter().copied()).collect::<Vec<f64>>()
                };
                each.flat_map(kept).collect()
            })
            .collect();
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        Some(Stacked::new(&rows, &columns, &origin, deviation).root)
    }

    /// Singular values of R less what is in doubt, descending, and the directions they belong to: the eigenvalues of H
    /// without its squares.
    pub(crate) fn spectrum(&self) -> Option<(Coordinates, Form)> {
        let svd = self.root.try_svd(false, true, f64::EPSILON, ITERATIONS)?;
        let directions = svd.v_t?;
        let mut pairs: [(f64, Coordinates); 5] = core::array::from_fn(|k| {
            let (value, direction) = (svd.singular_values[k], directions.row(k).transpose());
            let sure = value * value - (self.doubt * direction).norm_squared();
            (sure.max(0.0).sqrt(), direction)
        });
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        Some((Coordinates::from_fn(|k, _| pairs[k].0), Form::from_fn(|i, k| pairs[k].1[i])))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use crate::signal::test_functions::TestFunctions;
    use nalgebra::Matrix3;

    impl WeakEstimate {
        /// Of an information of 1 at these unknowns, by so many equations, which are not kept.
        pub(crate) fn plain(columns: Vec<Column>, at: Unknowns, rows: usize) -> WeakEstimate {
            let (root, doubt, stacked, parts) = (Form::identity(), Form::zeros(), None, Vec::new());
            WeakEstimate {
                radius: 1.0,
                columns,
                at,
                moved: 0.0,
                root,
                stacked,
                doubt,
                squares: 0.0,
                rows,
                parts,
            }
        }

        /// Of whitened rows of several parts at `at`, for noise of this deviation; of what they are made of nothing is to be asked.
        pub(crate) fn of_rows(
            columns: &[Column],
            at: &Unknowns,
            parts: Vec<Vec<f64>>,
            deviation: f64,
        ) -> WeakEstimate {
            let times: Vec<f64> = (0..17).map(|k| 0.125 * f64::from(k)).collect();
            let stretch = Stretch::new(times, vec![Vector3::x(); 17]);
            let part = |(k, rows): (usize, Vec<f64>)| {
                let (noise, tests) = (vec![Vector3::zeros(); 17], TestFunctions::new(&stretch, 1.0).unwrap());
                let linearised = Linearised::new(&stretch, &noise, columns, at.clone(), tests);
                let (left, levels) = (Vec::new(), Levels::WHITE);
                Part { stretch: k, linearised, rows, left, levels, log_determinant: 0.0, noise }
            };
            let parts: Vec<Part> = parts.into_iter().enumerate().map(part).collect();
            let rows: Vec<&[f64]> = parts.iter().map(|part| part.rows.as_slice()).collect();
            let stacked = Stacked::new(&rows, columns, at, deviation);
            let (root, squares) = (stacked.root, stacked.squares);
            let plain = WeakEstimate::plain(columns.to_vec(), at.clone(), stacked.rows);
            WeakEstimate { root, squares, stacked: Some(stacked), parts, ..plain }
        }
    }

    /// One row for each unknown that tells it alone with this weight, and leaves so much.
    pub(crate) fn one_row_each(weights: &[f64], left: &[f64]) -> Vec<f64> {
        let count = weights.len();
        let row = |i: usize| {
            let entry = move |k: usize| match k {
                k if k == i => weights[i],
                k if k == count => left[i],
                _ => 0.0,
            };
            (0..=count).map(entry)
        };
        (0..count).flat_map(row).collect()
    }

    /// Of moments of which the largest is this one, with an information of the square of `root` and a hundred degrees of freedom that leave
    /// four times the noise of variance 0.25.
    fn estimate(largest: f64, root: f64) -> WeakEstimate {
        let j = Matrix3::from_diagonal(&Vector3::new(0.1, largest, 0.9 - largest));
        let at = Unknowns { x: coordinates(&j), c: Vec::new() };
        let root = Form::identity() * root;
        WeakEstimate { root, squares: 100.0, ..WeakEstimate::plain(Vec::new(), at, 105) }
    }

    /// Rounds stand still up to a hundredth of a deviation, and are near up to a half.
    #[test]
    fn rounds_converge_by_their_last_move() {
        for (moved, expected) in [
            (0.0, Convergence::Still),
            (STILL, Convergence::Still),
            (1.01 * STILL, Convergence::Near),
            (RESTLESS, Convergence::Near),
            (1.01 * RESTLESS, Convergence::None),
            (f64::INFINITY, Convergence::None),
            (f64::NAN, Convergence::None),
        ] {
            let weak = WeakEstimate { moved, ..estimate(0.5, 1.0) };
            assert_eq!(weak.convergence(), expected, "{moved}");
            assert_eq!(weak.has_settled(), expected != Convergence::None, "{moved}");
        }
    }

    /// A largest moment may exceed half the trace by a twentieth, or by five of its deviations, which the misfit enlarges; a moment has the
    /// deviation √(2/3) of a coordinate.
    #[test]
    fn a_body_may_have_a_tensor_near_the_law() {
        let variance = 0.25;
        let sure = 1e6;
        assert!(estimate(0.5 + 0.99 * BEYOND, sure).possible(variance));
        assert!(!estimate(0.5 + 1.01 * BEYOND, sure).possible(variance));
        assert!((estimate(0.5, sure).misfit(variance) - 4.0).abs() < 1e-14);
        // 5 √(2/3) √(4 · 0.25)/root beyond the law
        let root = SURE * (2.0_f64 / 3.0).sqrt() / 0.1;
        assert!(estimate(0.6, root * 0.999).possible(variance));
        assert!(!estimate(0.6, root * 1.001).possible(variance));
        // residuals of less than the noise narrow nothing: five deviations are half as many
        let quiet = |root: f64| WeakEstimate { squares: 10.0, ..estimate(0.6, root) };
        assert!(quiet(0.4995 * root).possible(variance));
        assert!(!quiet(0.5005 * root).possible(variance));
    }
}
