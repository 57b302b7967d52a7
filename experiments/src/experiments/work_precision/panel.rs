//! One panel of the figure.

use polhode_pages::figure::{Curve, Figure};

use super::super::contestants::knows_the_motion;
use super::contest::{CLOSED_FORM, Contestant, Currency};
use super::tables::Contest;

/// The methods that win at some accuracy, and two that everybody knows, at the last horizon to which the motion is known.
pub(super) fn panel(contest: &Contest, currency: Currency) -> Figure {
    let case = contest.case;
    let last = (0..case.horizons.len()).rfind(|k| !contest.starts(*k).is_empty()).unwrap_or(0);
    let starts = contest.starts(last);
    let (x, least) = match currency {
        Currency::Time => ("processor time per unit of time (steps of rk4)", "least time"),
        Currency::Evaluations => ("evaluations per unit of time", "fewest evaluations"),
    };
    let (horizon, unit) = (case.horizons[last], case.unit);
    let title = format!("{}: {}; after {horizon:e} units of {unit} s", case.name, case.what);
    let mut figure = Figure::log_log("panel", title, x, "largest attitude error (rad)");
    let others: Vec<&Contestant> =
        contest.contestants.iter().filter(|one| !knows_the_motion(&one.name)).collect();
    let mut shown: Vec<&str> = vec!["rk4", "dop853"];
    let mut envelope: Vec<(f64, f64)> = Vec::new();
    for k in 0..=26 {
        let accuracy = libm::exp10(-0.5 * f64::from(k));
        if accuracy < case.finest(case.horizons[last]) * (1.0 - 1e-9) {
            break;
        }
        let costs = others.iter().filter_map(|&one| {
            let cost = one.cost_of(accuracy, last, currency, &starts)?;
            Some((one.name.as_str(), cost.median))
        });
        let cheapest = costs.min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((name, cost)) = cheapest {
            envelope.push((cost, accuracy));
            // the names of whole accuracies suffice
            if k >= 4 && k % 4 == 0 && !shown.contains(&name) {
                shown.push(name);
            }
        }
    }
    envelope.sort_by(|a, b| a.0.total_cmp(&b.0));
    if envelope.len() > 1 {
        figure.series.push(Curve::new(least, envelope).wide());
    }
    for name in shown.into_iter().chain([CLOSED_FORM]) {
        let Some(one) = contest.contestants.iter().find(|one| one.name == name) else { continue };
        let points = one.points(last, currency);
        if !points.is_empty() {
            // starts that are lost are beyond the frame
            let spread = points.iter().map(|(_, errors)| (errors.low, errors.high.min(1.0))).collect();
            let medians = points.iter().map(|(cost, errors)| (*cost, errors.median)).collect();
            figure.series.push(Curve::new(name, medians).with_spread(spread));
        }
    }
    figure.level("1 rad", 1.0);
    figure
}
