//! A fit as text, as rows and as JSON.

pub(super) mod attitudes;
mod json;
mod rows;
mod segments;
mod text;

use polhode::num::Shown;
use polhode_fit::{
    AverageAxis, ErrorFit, Estimate, Identifiability, Method, ModelFit, Record, Spike, Systematic,
};
use polhode_pages::screen::wrapped;
use polhode_pages::table::{Column, Format, Table, row};
use serde_json::{Value, json};

pub(super) use self::json::nuisances;
pub(super) use self::segments::Segments;
pub(super) use self::text::tensor;
use super::as_read::AsRead;
use super::attitudes::Read;
use super::flights::Spans;

pub(super) const ENTRIES: [(&str, usize, usize); 6] =
    [("xx", 0, 0), ("yy", 1, 1), ("zz", 2, 2), ("xy", 0, 1), ("xz", 0, 2), ("yz", 1, 2)];

/// A correlation to two places, none with a minus sign before nothing.
pub(super) fn two_places(correlation: f64) -> String {
    format!("{:.2}", (100.0 * correlation).round() / 100.0 + 0.0)
}

/// Where a record comes from: the spans of it that are fitted, its attitudes, and how its files were read.
pub(super) type Sources<'a> = (&'a Spans, Option<&'a Read>, &'a AsRead);

/// A tensor in full.
pub(super) fn identified(e: &Estimate, record: &Record, sources: Sources<'_>, format: Format) -> String {
    match format {
        Format::Table => text::text(e, record, sources),
        Format::Csv => rows::rows(e).csv(),
        Format::Json => pretty(&json::object(e, record, sources)),
    }
}

/// Columns that sentences are wrapped at.
pub(super) const WIDTH: usize = 78;

/// Sentences as lines of text, each begun anew.
pub(super) fn wrapped_lines(sentences: &[String]) -> Vec<String> {
    sentences.iter().map(|sentence| wrapped(sentence, WIDTH, 2)).collect()
}

/// A table of estimated quantities, without rows.
pub(super) fn estimates(name: &str, caption: &str) -> Table {
    let columns = vec![
        Column::new("quantity", "", "what"),
        Column::new("value", "", "estimate"),
        Column::new("sigma", "", "standard deviation"),
        Column::new("unit", "", "unit of value and sigma, empty of ratios and other plain numbers"),
    ];
    Table::new(name, caption, columns)
}

/// `x` to four digits.
pub(super) fn four_digits(x: f64) -> Shown {
    Shown(format!("{x:.3e}").parse().unwrap_or(x))
}

/// A component of a unit vector, none with a minus sign before nothing.
pub(super) fn component(x: f64) -> String {
    format!("{:.5}", if x.abs() < 5e-6 { 0.0 } else { x })
}

/// Names of the columns that are not used, each once.
pub(super) fn unused(record: &Record) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for (_, name) in record.unused_columns() {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

/// What a record tells that does not determine the tensor.
#[derive(Clone, Debug)]
pub(super) struct Facts {
    /// How many of the five numbers are known, where they can be counted.
    pub(super) rank: Option<usize>,
    pub(super) known: Vec<String>,
    pub(super) open: Vec<String>,
    /// Which record would tell more.
    pub(super) next: String,
}

impl Facts {
    pub(super) fn unidentified(what: &Identifiability) -> Self {
        Facts {
            rank: Some(what.rank),
            known: what.known.iter().map(ToString::to_string).collect(),
            open: what.null_directions.iter().map(ToString::to_string).collect(),
            next: what.next_record(),
        }
    }

    pub(super) fn unsettled(axes: &[AverageAxis]) -> Self {
        let open = "the ratios of the moments and all other axes: the iteration did not converge";
        let known = axes.iter().map(AverageAxis::to_string).collect();
        Facts { known, ..Facts::nothing(open, "record longer, with a larger wobble") }
    }

    pub(super) fn not_free() -> Self {
        let open = "the tensor: nowhere in the record does the body rotate freely";
        Facts::nothing(open, "throw the body, so that only the air acts on it")
    }

    pub(super) fn direction_open() -> Self {
        let open =
            "the tensor: the motion does not show whether the attitudes are body to space or space to body";
        Facts::nothing(open, "none: state the direction, which no motion of an axisymmetric body shows")
    }

    pub(super) fn several() -> Self {
        let open = "the ratios of the moments and all other axes: bodies with very different moments follow the samples nearly as well";
        Facts::nothing(open, "throw the body with a larger wobble, or record longer")
    }

    /// A torque whose coefficients are not told; with them `rank` of the five numbers of the tensor are.
    pub(super) fn untold(names: &[&str], rank: usize) -> Self {
        let (names, is_whole) = (names.join(", "), rank == 5);
        let open = match is_whole {
            true => format!("of the torque: {names}"),
            false => format!("the tensor together with a torque: {names}"),
        };
        let next =
            "record longer, or with a larger wobble, or throws about other axes; or ask for a simpler torque";
        Facts { rank: Some(rank).filter(|_| !is_whole), ..Facts::nothing(&open, next) }
    }

    pub(super) fn untold_sensor() -> Self {
        let open = "the tensor together with the errors of the sensor that are to be fitted";
        Facts::nothing(
            open,
            "record longer; or fit fewer errors of the sensor, or give them smaller standard deviations",
        )
    }

    pub(super) fn driven() -> Self {
        let open = "the tensor: torques drive the body";
        Facts::nothing(open, "throw the body, or fit only the part of the record in which it is free")
    }

    pub(super) fn contradicted() -> Self {
        let open = "the tensor: wheel momenta and torques contradict the rates";
        Facts::nothing(
            open,
            "with the wheels at rest and without these torques: it shows whether something else drives the body",
        )
    }

    fn nothing(open: &str, next: &str) -> Self {
        Facts { rank: None, known: Vec::new(), open: vec![open.into()], next: next.into() }
    }

    pub(super) fn report(
        &self,
        record: &Record,
        spans: &Spans,
        (as_read, reason, method): (&AsRead, &str, Method),
        format: Format,
    ) -> String {
        match format {
            Format::Json => pretty(&json!({
                "shape": null, "principal": null, "axes": null, "covariance": null, "sigma_principal": null,
                "inertia": null, "inertia_covariance": null, "noise_sigma": null,
                "samples": record.samples(), "segments": record.segments.len(), "method": method.words(),
                "identifiable": false, "rank": self.rank, "null_directions": self.open, "known": self.known,
                "reason": reason, "next_steps": [self.next],
                "triangle_slack": null, "active_constraints": [], "chi2_per_dof": null, "warnings": [],
                "unused_columns": unused(record), "read_as": as_read.json(),
                "flights": spans.json(), "flight_limits": spans.limits(),
            })),
            Format::Csv => {
                let columns = vec![
                    Column::new("kind", "", "known, undetermined, or next record"),
                    Column::new("fact", "", "in words"),
                ];
                let mut table = Table::new("facts", "What the record tells.", columns);
                self.known.iter().for_each(|fact| table.push(row!["known", fact.clone()]));
                self.open.iter().for_each(|fact| table.push(row!["undetermined", fact.clone()]));
                table.push(row!["next record", self.next.clone()]);
                table.csv()
            }
            Format::Table => {
                let lines = |facts: &[String]| {
                    let each = facts.iter().map(|fact| format!("  {}\n", wrapped(fact, WIDTH - 2, 4)));
                    each.collect::<String>()
                };
                let counted = self.rank.map(|rank| format!("{rank} of 5 numbers of the tensor are known.\n"));
                let known = match (self.known.is_empty(), self.rank) {
                    (true, None | Some(0)) => "  nothing\n".into(),
                    (true, _) => "  no axis and no ratio, only combinations of them\n".into(),
                    _ => lines(&self.known),
                };
                let read = wrapped_lines(&as_read.sentences());
                format!(
                    "{}Known:\n{known}Undetermined:\n{}Next record:\n{}{}",
                    counted.unwrap_or_default(),
                    lines(&self.open),
                    lines(core::slice::from_ref(&self.next)),
                    spans.lines().into_iter().chain(read).map(|line| format!("{line}\n")).collect::<String>()
                )
            }
        }
    }
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

/// `value +- sigma` with two digits of the deviation.
pub(super) fn with_error(value: f64, sigma: f64) -> String {
    if !(sigma > 0.0 && sigma.is_finite()) {
        return format!("{value:.6}");
    }
    let digits = digits(sigma);
    format!("{value:.digits$} +- {sigma:.digits$}")
}

/// In scientific notation, with the digits that the deviation leaves.
pub(super) fn scaled(value: f64, sigma: f64) -> String {
    let power = if value == 0.0 { 0 } else { libm::floor(libm::log10(value.abs())) as i32 };
    let unit = libm::pow(10.0, f64::from(power));
    let places = digits(sigma / unit);
    format!("({:.places$} +- {:.places$})e{power}", value / unit, sigma / unit)
}

/// A value with two digits of its deviation in brackets, in units of the last place: 0.2130(14) is 0.2130 ± 0.0014.
fn concise(value: f64, sigma: f64) -> String {
    let digits = digits(sigma);
    let in_places = sigma * libm::pow(10.0, digits as f64);
    match in_places.is_finite() {
        true => format!("{value:.digits$}({in_places:.0})"),
        false => format!("{value:.6}"),
    }
}

/// Decimals that show two digits of a deviation.
pub(super) fn digits(sigma: f64) -> usize {
    let place = if sigma > 0.0 && sigma.is_finite() { 1.0 - libm::floor(libm::log10(sigma)) } else { 6.0 };
    place.clamp(0.0, 15.0) as usize
}

/// Half widths of 95 % intervals in standard deviations.
pub(super) const SURE: f64 = 1.959_963_984_540_054;

/// The systematic lines of constant errors of the sensor, which every sensor has; most bodies have neither wheel nor magnet.
pub(super) fn sensor_lines(e: &Estimate) -> impl Iterator<Item = &Systematic> {
    e.systematic.iter().filter(|line| line.is_of_sensor() && line.name != "walk")
}

/// What an error of each of the sizes of the systematic lines would make of the principal moments together, shares of
/// the trace; `None` where there are no lines.
pub(super) fn systematic(e: &Estimate) -> Option<[f64; 3]> {
    let sum =
        |k: usize| sensor_lines(e).map(|line| line.principal[k] * line.principal[k]).sum::<f64>().sqrt();
    (!e.systematic.is_empty()).then(|| [0, 1, 2].map(sum))
}

/// The sizes of the systematic lines in words, one for each kind of error.
pub(super) fn sizes(e: &Estimate) -> String {
    let mut words: Vec<String> = Vec::new();
    for line in sensor_lines(e) {
        let kind = line.name.split('_').next().unwrap_or_default();
        let word = match line.unit {
            "" => format!("{} % of {kind}", 100.0 * line.size),
            unit => format!("{} {unit} of {kind}", line.size),
        };
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words.join(", ")
}

/// How much of the motion is not free, in one sentence.
pub(super) fn unexplained(e: &Estimate) -> Option<String> {
    let share = 100.0 * e.unexplained?;
    let places = digits(share).min(4);
    Some(format!("free motion leaves {share:.places$} % of |dw/dt|^2 unexplained"))
}

/// How many of the samples that were left out lie in bursts, where any do.
pub(super) fn in_bursts(spikes: &[Spike]) -> Option<String> {
    match Spike::bursts(spikes) {
        (0, _) => None,
        (samples, 1) => Some(format!("{samples} of them in a burst")),
        (samples, bursts) => Some(format!("{samples} of them in {bursts} bursts")),
    }
}

/// The moments that left-handed axes would mean, in one sentence.
pub(super) fn mirror(e: &Estimate) -> Option<String> {
    let (moments, sigmas) = (e.mirror.as_ref()?.principal_moments(), e.sigma_mirror?);
    let [a, b, c] = [0, 1, 2].map(|k| concise(moments[k], sigmas[k]));
    Some(format!("if the axes are left-handed (--axes): I1 : I2 : I3 = {a} : {b} : {c}"))
}

/// Up to which size a change of the tensor midway may go unseen, in one sentence.
pub(super) fn unseen(e: &Estimate) -> String {
    match e.unseen_change {
        Some([a, b, c]) => format!(
            "a change of the tensor midway may go unseen: of I1 up to {a:.1e}, I2 {b:.1e}, I3 {c:.1e} of the trace; near an end of the record \
             also larger ones"
        ),
        None => {
            "parts of the record are not compared: a change of the tensor shows only in the residuals".into()
        }
    }
}

/// The models of the torque, and errors of the record without one, beside each other: name, gain of log-likelihood, share, both ratios with their deviations, what free
/// motion leaves, what they make of a segment that is held out.
pub(super) fn models(e: &Estimate) -> Vec<[String; 7]> {
    let ratio = |one: &ModelFit, k: usize| concise(one.ratios[k], one.sigma_ratios[k]);
    let percent = |share: f64| format!("{:.*} %", digits(100.0 * share).min(4), 100.0 * share);
    let is_mixed = noise_differs(e);
    let name = |name: String, is_noisy: bool| if is_mixed && is_noisy { name + "*" } else { name };
    let row = |one: &ModelFit| {
        [
            name(one.model.to_string(), one.has_torque_noise),
            gain(one.gain),
            format!("{:.3}", one.share),
            ratio(one, 0),
            ratio(one, 1),
            one.unexplained.map_or("-".into(), percent),
            one.held_out.map_or("-".into(), |square| format!("{square:.3}")),
        ]
    };
    let of_sensor = |one: &ErrorFit| {
        let ratio = |k: usize| concise(one.ratios[k], one.sigma_ratios[k]);
        let held_out = one.held_out.map_or("-".into(), |square| format!("{square:.3}"));
        let [gain, share] = [gain(one.gain), format!("{:.3}", one.share)];
        let name = name(error_name(one), one.has_torque_noise);
        [name, gain, share, ratio(0), ratio(1), "-".into(), held_out]
    };
    e.models.iter().map(row).chain(e.reading_errors.iter().map(of_sensor)).collect()
}

/// Whether some of the models have torque noise, and others none.
fn noise_differs(e: &Estimate) -> bool {
    let of_torques = e.models.iter().map(|one| one.has_torque_noise);
    let mut all = of_torques.chain(e.reading_errors.iter().map(|one| one.has_torque_noise));
    all.next().is_some_and(|first| all.any(|other| other != first))
}

/// A gain of log-likelihood; so far below a model is refuted, and the number is that of a first order, which does not reach so far.
const LEAST_GAIN: f64 = -1000.0;

fn gain(gain: f64) -> String {
    if gain < LEAST_GAIN { "-".into() } else { format!("{gain:.1}") }
}

/// What is to be known of the gains, a sentence each: that some are of models with torque noise, and that some are not told.
pub(super) fn about_gains(e: &Estimate) -> Vec<String> {
    let of_torques = e.models.iter().map(|one| one.gain);
    let mut gains = of_torques.chain(e.reading_errors.iter().map(|one| one.gain));
    let noise = "*: with torque noise, which may take the place of a torque and counts as a coefficient";
    let far = "gain -: below -1000, where the first-order estimate does not hold: refuted at the torque noise of the answer";
    let is_far = gains.any(|gain| gain < LEAST_GAIN);
    [(noise_differs(e), noise), (is_far, far)]
        .into_iter()
        .filter(|said| said.0)
        .map(|said| said.1.into())
        .collect()
}

/// The heads of its columns.
pub(super) const MODELS: [&str; 7] = ["torque", "gain", "share", "I1/I3", "I2/I3", "unexplained", "held out"];

/// What they say, in words.
pub(super) fn about_models(e: &Estimate) -> String {
    let deviations = match e.torque.is_chosen {
        true => "the answer's standard deviations include their spread, weighted by share",
        false => "the answer's standard deviations are those of the torque that was asked for",
    };
    let what = match e.reading_errors.is_empty() {
        true => "models of the torque, each with its own standard deviation in brackets",
        false => "models of the torque, or of an error of the record, with standard deviations",
    };
    format!("{what}; {deviations}")
}

/// The sizes of these errors, each with its name.
pub(super) fn error_sizes(e: &Estimate) -> Vec<String> {
    let size = |one: &ErrorFit| one.to_string().replace(&one.error.to_string(), &error_name(one));
    e.reading_errors.iter().map(size).collect()
}

fn error_name(one: &ErrorFit) -> String {
    one.error.to_string().replace('-', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is surely refuted has no number that a reader could take for one.
    #[test]
    fn gains_are_told_down_to_a_thousand() {
        for (value, text) in [(1234.56, "1234.6"), (-1000.0, "-1000.0"), (-1_198_375.5, "-")] {
            assert_eq!(gain(value), text);
        }
    }
}
