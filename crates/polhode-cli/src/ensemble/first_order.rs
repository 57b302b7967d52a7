//! What the derivative of the exact motion says of an ensemble, beside its members.

use polhode::body::Problem;
use polhode::flow::StartCovariance;
use polhode_pages::table::{Cell, Column, Table, row};

use super::reduce::Reduced;
use super::spec::{Motion, Spec};

/// Above this the first order leaves out too much.
const TRUSTED: f64 = 0.1;

/// Spread of the members and to first order at some times, where the motion is exact and the bodies are free and drawn.
pub(super) fn beside(spec: &Spec, reduced: &[Option<Reduced>], rows: &[usize]) -> Option<String> {
    let Motion::Exact { elapsed } = &spec.plan.motion else { return None };
    let (motion, start) = StartCovariance::of(spec.population()?)?;
    let acting = spec.acting();
    let body = acting.on(motion.body().inertia().clone()).ok()?;
    if body.problem() != Problem::Free || !acting.wheels().is_empty() {
        return None;
    }
    let mut table = Table::new(
        "first-order",
        "",
        vec![
            Column::new("elapsed", "s", "time since the start").digits(6),
            Column::new("angle_rms", "rad", "root mean square of the angles of the members")
                .heading("angle rms"),
            Column::new("first_order", "rad", "the same by the derivative of the motion")
                .heading("first order"),
            Column::new("nonlinearity", "", "share that the first order leaves out").digits(2),
        ],
    );
    let mut worst = 0.0_f64;
    for &n in rows {
        let (t, members) = (*elapsed.get(n)?, reduced.get(n)?.as_ref()?.root_mean_square);
        // where there is no covariance, as where it has grown beyond a double, the row says so by empty cells
        let found = motion.covariance(t, &start).ok();
        let angle = found.map(|found| found.state.fixed_view::<3, 3>(0, 0).trace().sqrt());
        let nonlinearity = found.map(|found| found.nonlinearity);
        worst = worst.max(nonlinearity.unwrap_or(f64::INFINITY));
        table.push(row![t, members, Cell::from(angle), Cell::from(nonlinearity)]);
    }
    let judged = if worst <= TRUSTED {
        "the first-order covariance agrees"
    } else {
        "where the nonlinearity is above 0.1, do not trust the first-order covariance"
    };
    Some(format!("{}\nMembers compared with the first order: {judged}.\n", table.terminal()))
}
