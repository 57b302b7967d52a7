//! The weak estimate of a record that leaves the tensor open, with a tensor that is known beforehand.

use nalgebra::SMatrix;

use crate::columns::column::Unknowns;
use crate::physical::coordinates::{Coordinates, Form};
use crate::signal::stretch::Stretch;
use crate::solve::rounds::Rounds;
use crate::solve::stacked::Pull;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::rounds::{RESTLESS, TORQUES};

/// What a record and a prior tell together where the record alone leaves something open.
pub(crate) struct Completed {
    /// Its R is that of both.
    pub(crate) weak: WeakEstimate,
    /// Singular values of what the record tells alone, one over the standard deviations, and their directions.
    pub(crate) alone: (Coordinates, Form),
    /// Square of the distance of the two, in standard deviations.
    pub(crate) chi2: f64,
}

/// Rounds with the radius and the columns of `open`, begun at the centre of a prior; `root` is a root of its information.
/// `None` where they do not settle, or the noise does not carry their residuals.
pub(crate) fn completed(
    stretches: &[Stretch],
    open: &WeakEstimate,
    root: &Form,
    centre: Coordinates,
    variance: f64,
) -> Option<Completed> {
    let pull = Pull { root: root * variance.sqrt(), centre };
    let start = Unknowns::at(centre, &open.columns);
    let mut rounds = Rounds::new(stretches, open.radius, &open.columns, start)?.with_pull(pull);
    let moved = rounds.settle(variance).filter(|&moved| moved <= RESTLESS)?;
    let weak = rounds.finish(variance, moved)?;
    let misfit = weak.misfit(variance).max(1.0);
    if misfit > TORQUES {
        return None;
    }
    let deviation = (variance * misfit).sqrt();
    let stacked = weak.stacked.as_ref()?;
    let apart = stacked.squares_at(&weak.x()) - stacked.squares;
    let chi2 = apart / variance / misfit + (root * (weak.x() - centre)).norm_squared();
    // what the record tells of the five numbers, less what is in doubt of it, above what the prior does
    let (singular, directions) = weak.spectrum()?;
    let mut both = SMatrix::<f64, 10, 5>::zeros();
    both.fixed_view_mut::<5, 5>(0, 0).copy_from(&(Form::from_diagonal(&singular) * directions.transpose()));
    both.fixed_view_mut::<5, 5>(5, 0).copy_from(&(root * deviation));
    let joined = both.qr().r();
    let alone = (singular / deviation, directions);
    Some(Completed { weak: WeakEstimate { root: joined, doubt: Form::zeros(), ..weak }, alone, chi2 })
}
