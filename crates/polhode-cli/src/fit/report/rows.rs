//! A fit as rows.

use polhode_fit::Estimate;
use polhode_pages::table::{Table, row};

use super::{ENTRIES, estimates};

/// The unit of moments of a tensor of trace 1.
const OF_TRACE: &str = "of the trace";

pub(super) fn rows(e: &Estimate) -> Table {
    let mut table = estimates("fit", "Inertia from measured angular velocity.");
    for k in 0..3 {
        table.push(row![format!("principal_{}", k + 1), e.principal[k], e.sigma_principal[k], OF_TRACE]);
    }
    table.push(row!["ratio_1_3", e.ratios[0], e.sigma_ratios[0], ""]);
    table.push(row!["ratio_2_3", e.ratios[1], e.sigma_ratios[1], ""]);
    for (k, (name, i, j)) in ENTRIES.into_iter().enumerate() {
        table.push(row![
            format!("shape_{name}"),
            e.shape.tensor()[(i, j)],
            e.covariance[(k, k)].sqrt(),
            OF_TRACE
        ]);
    }
    let q = e.axes.quaternion();
    for (name, value) in [("axes_w", q.w), ("axes_x", q.i), ("axes_y", q.j), ("axes_z", q.k)] {
        table.push(row![name, value, None::<f64>, ""]);
    }
    if let (Some(inertia), Some(covariance)) = (&e.inertia, &e.inertia_covariance) {
        for (k, (name, i, j)) in ENTRIES.into_iter().enumerate() {
            table.push(row![
                format!("inertia_{name}"),
                inertia.tensor()[(i, j)],
                covariance[(k, k)].sqrt(),
                "kg m^2"
            ]);
        }
    }
    for n in e.torque.coefficients.iter().chain(&e.nuisances) {
        table.push(row![n.name, n.value, n.sigma, n.unit]);
    }
    for line in &e.systematic {
        for k in 0..3 {
            table.push(row![
                format!("systematic_{}_principal_{}", line.name, k + 1),
                line.principal[k],
                None::<f64>,
                OF_TRACE
            ]);
        }
    }
    table.push(row!["triangle_slack", e.triangle_slack, 2.0 * e.sigma_principal[2], OF_TRACE]);
    table.push(row!["rms_rate", e.rms_rate, None::<f64>, "rad/s"]);
    table.push(row!["noise_sigma", e.noise_sigma, None::<f64>, "rad/s"]);
    if let Some(attitudes) = &e.attitudes {
        table.push(row!["attitude_noise_sigma", attitudes.noise_sigma, None::<f64>, "rad"]);
    }
    table.push(row!["chi2_per_dof", e.chi2_per_dof, (2.0 / e.dof.max(1) as f64).sqrt(), ""]);
    if let Some(prior) = e.prior {
        table.push(row!["prior_chi2", prior.chi2, (2.0 * prior.dof as f64).sqrt(), ""]);
    }
    table.push(row!["bound_ratio", e.bound_ratio, None::<f64>, ""]);
    for (name, trend) in [("momentum_drift", e.momentum_trend), ("energy_drift", e.energy_trend)] {
        if let Some(trend) = trend {
            table.push(row![name, trend.rate, trend.sigma, "1/s"]);
        }
    }
    table.push(row!["whiteness", e.whiteness.correlation, e.whiteness.sigma, ""]);
    table.push(row!["unexplained", e.unexplained, None::<f64>, ""]);
    if let Some(mirror) = &e.mirror {
        // the moments if the axes are left-handed
        for (k, moment) in mirror.principal_moments().into_iter().enumerate() {
            let sigma = e.sigma_mirror.map(|sigmas| sigmas[k]);
            table.push(row![format!("mirror_principal_{}", k + 1), moment, sigma, OF_TRACE]);
        }
    }
    if let Some(unseen) = e.unseen_change {
        for (k, most) in unseen.into_iter().enumerate() {
            table.push(row![format!("unseen_change_{}", k + 1), most, None::<f64>, OF_TRACE]);
        }
    }
    table
}
