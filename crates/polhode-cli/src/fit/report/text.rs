//! A fit as text for a terminal.

use nalgebra::Matrix3;
use polhode_fit::{Estimate, InvariantTrend, Nuisance, Record};
use polhode_pages::screen::wrapped;

use super::{
    ENTRIES, MODELS, SURE, Segments, Sources, WIDTH, about_gains, about_models, attitudes, component, digits,
    error_sizes, four_digits, in_bursts, mirror, models, sizes, systematic, two_places, unexplained, unseen,
    unused, with_error, wrapped_lines,
};

/// The answer first, then what it rests on.
pub(super) fn text(e: &Estimate, record: &Record, (spans, read, as_read): Sources<'_>) -> String {
    let mut lines = answer(e);
    lines.extend(wrapped_lines(&as_read.sentences()));
    lines.extend(wrapped_lines(&attitudes::sentences(e, read)));
    lines.extend(next(e));
    lines.push(String::new());
    lines.extend(axes(e));
    lines.push(tensor("shape (trace 1)", &e.shape.tensor()));
    if let Some(inertia) = &e.inertia {
        lines.push(tensor("inertia (kg m^2)", &inertia.tensor()));
    }
    lines.extend(correlations(e));
    lines.extend(torques(e));
    lines.extend(of_models(e));
    lines.extend(sensor(e));
    lines.extend(spans.lines());
    lines.extend(segments(e));
    lines.push(String::new());
    if e.quanta.iter().any(|quantum| *quantum > 0.0) {
        let [x, y, z] = e.quanta;
        lines.push(format!("steps of the readings: {x:.3e}, {y:.3e}, {z:.3e} rad/s"));
    }
    let names = unused(record);
    if !names.is_empty() {
        lines.push(format!("columns not used: {}", names.join(", ")));
    }
    lines.extend(prior(e));
    lines.extend(quality(e));
    lines.join("\n") + "\n"
}

/// The moments with what they are uncertain by, and the ratios.
fn answer(e: &Estimate) -> Vec<String> {
    let [a, b, c] = [0, 1, 2].map(|k| format!("{:.*}", digits(e.sigma_principal[k]).min(6), e.principal[k]));
    let off = systematic(e);
    let mut lines = vec![format!("I1 : I2 : I3 = {a} : {b} : {c}, as shares of the trace")];
    for k in 0..3 {
        let sigma = SURE * e.sigma_principal[k];
        let places = digits(sigma);
        let mut line =
            format!("  I{}     {:.places$} +- {sigma:.places$} (95 %, statistical)", k + 1, e.principal[k]);
        if let Some(off) = off {
            line += &format!(" +- {:.places$} (systematic)", off[k]);
        }
        lines.push(line);
    }
    for (k, name) in ["I1/I3", "I2/I3"].into_iter().enumerate() {
        let sigma = SURE * e.sigma_ratios[k];
        let places = digits(sigma);
        lines.push(format!("  {name}  {:.places$} +- {sigma:.places$} (95 %, statistical)", e.ratios[k]));
    }
    if off.is_some() {
        lines.extend(["systematic: if the sensor is off by".into(), format!("  {}", sizes(e))]);
    }
    let noise =
        if e.noise_sigma > 0.0 { format!(", noise {:.3e} rad/s", e.noise_sigma) } else { String::new() };
    let left_out = match (e.spikes.len(), in_bursts(&e.spikes)) {
        (0, _) => String::new(),
        (spikes, None) => format!(", spikes left out: {spikes}"),
        (spikes, Some(of_these)) => format!(", spikes left out: {spikes} ({of_these})"),
    };
    let rate = four_digits(e.rms_rate);
    let record =
        format!("{} samples, segments: {}, rate {rate} rad/s (rms){noise}{left_out}", e.samples, e.segments);
    lines.push(wrapped(&record, WIDTH, 2));
    lines.extend(unexplained(e));
    lines.extend(mirror(e).map(|line| line.replacen(": I1", ":\n  I1", 1)));
    lines.push(wrapped(&unseen(e), WIDTH, 2));
    lines
}

fn axes(e: &Estimate) -> Vec<String> {
    let mut lines = vec!["principal axes in sensor axes; +- is one standard deviation of the turn:".into()];
    let axes = e.axes.to_rotation_matrix();
    for k in 0..3 {
        let v = axes.matrix().column(k);
        let turn = e.sigma_axes[k].to_degrees();
        let turn = if turn < 90.0 {
            format!("{turn:.*} deg about it", digits(turn))
        } else {
            "any turn about it".into()
        };
        let [x, y, z] = [0, 1, 2].map(|i| component(v[i]));
        lines.push(format!("  {}  ({x:>8}, {y:>8}, {z:>8}) +- {turn}", k + 1));
    }
    lines
}

/// A matrix under its name.
pub(in crate::fit) fn tensor(name: &str, m: &Matrix3<f64>) -> String {
    let row = |i: usize| format!("  {:13.6e} {:13.6e} {:13.6e}", m[(i, 0)], m[(i, 1)], m[(i, 2)]);
    format!("\n{name}:\n{}\n{}\n{}", row(0), row(1), row(2))
}

/// What would make the answer surer.
fn next(e: &Estimate) -> Vec<String> {
    let steps = e.next_steps();
    let each = steps.iter().map(|step| wrapped(&format!("  - {step}"), WIDTH, 4));
    let each: Vec<String> = each.map(|step| format!("  {step}")).collect();
    if each.is_empty() { each } else { core::iter::once("what to do next:".into()).chain(each).collect() }
}

fn correlations(e: &Estimate) -> Vec<String> {
    let head: String = ENTRIES.iter().map(|(name, ..)| format!("{name:>7}")).collect();
    let all = e.correlation();
    let row = |row: usize| all.row(row).iter().map(|c| format!("{:>7}", two_places(*c))).collect::<String>();
    let named = ENTRIES.iter().enumerate().map(|(k, (name, ..))| format!("  {name}{}", row(k)));
    [String::new(), "correlations of its entries:".into(), format!("    {head}")]
        .into_iter()
        .chain(named)
        .collect()
}

fn number(n: &Nuisance) -> String {
    let unit = if n.unit.is_empty() { String::new() } else { format!(" {}", n.unit) };
    let prior = n.prior.map_or(String::new(), |prior| format!(", prior +- {prior}"));
    format!("  {:<16} {}{unit}{prior}", n.name, with_error(n.value, n.sigma))
}

fn torques(e: &Estimate) -> Vec<String> {
    if e.torque.coefficients.is_empty() {
        return Vec::new();
    }
    let mut lines = vec![
        String::new(),
        match e.torque.gain {
            Some(gain) => format!("torque: {}, gain of log-likelihood {gain:.1}", e.torque.model),
            None => format!("torque: {}", e.torque.model),
        },
    ];
    lines.extend(e.torque.coefficients.iter().map(number));
    if let Some([a, b]) = e.torque.ratios_without {
        lines.push(format!("  without it I1/I3 would be {a:.4} and I2/I3 {b:.4}"));
    }
    lines
}

fn of_models(e: &Estimate) -> Vec<String> {
    let rows = models(e);
    if rows.is_empty() {
        return Vec::new();
    }
    let heads = MODELS.map(String::from);
    let all = || core::iter::once(&heads).chain(&rows);
    let width = |k: usize| all().map(|row| row[k].len()).max().unwrap_or(0);
    let widths: [usize; 7] = core::array::from_fn(width);
    let line = |row: &[String; 7]| {
        let cells = row.iter().zip(widths).skip(1).map(|(cell, width)| format!("  {cell:>width$}"));
        format!("  {:<width$}{}", row[0], cells.collect::<String>(), width = widths[0])
    };
    let about = about_models(e);
    let (what, deviations) = about.split_once("; ").unwrap_or((&about, ""));
    let mut lines = vec![String::new(), format!("{what};"), format!("{deviations}:")];
    lines.extend(all().map(line));
    lines.extend(about_gains(e).iter().map(|said| format!("  {}", wrapped(said, WIDTH - 2, 2))));
    lines.extend(error_sizes(e).chunks(3).map(|sizes| format!("  {}", sizes.join(", "))));
    lines
}

fn sensor(e: &Estimate) -> Vec<String> {
    let mut lines = Vec::new();
    if !e.nuisances.is_empty() {
        lines.extend([String::new(), "sensor:".into()]);
        lines.extend(e.nuisances.iter().map(number));
    }
    if !e.systematic.is_empty() {
        lines.extend([
            String::new(),
            "change of (I1, I2, I3), shares of the trace, by an error of the sensor, or a".into(),
            "wheel or magnet inside:".into(),
        ]);
        for line in &e.systematic {
            let [a, b, c] = line.principal;
            let size = format!("{} {}", line.size, line.unit);
            lines.push(format!("  {:<16} {:<20} ({a:9.1e}, {b:9.1e}, {c:9.1e})", line.name, size.trim()));
        }
    }
    lines
}

/// Where there are several.
fn segments(e: &Estimate) -> Vec<String> {
    if e.per_segment.len() < 2 {
        return Vec::new();
    }
    let Segments { heads, legend, rows } = Segments::of(e);
    let head = heads.iter().map(|head| head.to_string());
    let head: Vec<String> = core::iter::once("segment".into()).chain(head).collect();
    let row = |(segment, cells): (usize, Vec<String>)| {
        core::iter::once((segment + 1).to_string()).chain(cells).collect::<Vec<String>>()
    };
    let all: Vec<Vec<String>> = core::iter::once(head).chain(rows.into_iter().map(row)).collect();
    let line = |cells: &Vec<String>| {
        let width = |k: usize| all.iter().map(|cells| cells[k].len()).max().unwrap_or(0);
        let cells: Vec<String> =
            cells.iter().enumerate().map(|(k, cell)| format!("{cell:>width$}", width = width(k))).collect();
        cells.join("  ")
    };
    let mut lines = vec![String::new()];
    lines.extend(all.iter().map(line));
    lines.push(wrapped(legend, WIDTH, 2));
    lines
}

fn prior(e: &Estimate) -> Vec<String> {
    let Some(p) = e.prior else { return Vec::new() };
    let mut lines =
        vec![format!("record against prior tensor: chi^2 {:.1} of {} degrees of freedom", p.chi2, p.dof)];
    let rank = e.identifiability.rank;
    if rank < 5 {
        lines.push(format!(
            "the record alone determines {rank} of the 5 numbers of the shape, the prior the rest"
        ));
    }
    lines
}

fn quality(e: &Estimate) -> Vec<String> {
    let drift = |name: &str, of: Option<InvariantTrend>| {
        let percent = |drift: InvariantTrend| with_error(100.0 * drift.rate, 100.0 * drift.sigma);
        of.map(|trend| format!("drift of {name}: {} per cent per second", percent(trend)))
    };
    let told = |d: f64| if d.is_finite() { format!("{d:.1e}") } else { "none".into() };
    let spectrum = e.identifiability.deviations.map(told).join(", ");
    let mut lines = vec![wrapped(&format!("method: {}", e.method.words()), WIDTH, 2)];
    lines.extend(e.radius.map(|radius| format!("half width of the test functions: {radius:.4} s")));
    lines.extend([
        "standard deviations of the five determined combinations, shares of the trace:".into(),
        format!("  {spectrum}"),
        e.bound_ratio.map_or("no Cramer-Rao bound for this tensor".into(), |r| {
            format!("standard deviation over the Cramer-Rao bound: {r:.3}")
        }),
        format!("chi^2 per degree of freedom: {:.3} ({} degrees)", e.chi2_per_dof, e.dof),
        format!(
            "correlation of neighbouring residuals: {:.3} +- {:.3}",
            e.whiteness.correlation, e.whiteness.sigma
        ),
    ]);
    lines.extend(drift("|J w|", e.momentum_trend));
    lines.extend(drift("w J w", e.energy_trend));
    lines.extend([format!(
        "I1 + I2 - I3: {} of the trace, 0 for a flat body",
        with_error(e.triangle_slack, 2.0 * e.sigma_principal[2])
    )]);
    lines
}
