//! A fit, or a refusal, as one page that needs no other file.

pub(super) mod figures;
mod noise;

use polhode_fit::{Estimate, FittedMotion, Nuisance, Record};
use polhode_pages::document::{Block, Form, Tone};

use super::as_read::AsRead;
use super::flights::Spans;
use super::report::{
    ENTRIES, Facts, MODELS, SURE, Segments, Sources, about_gains, about_models, attitudes, component, digits,
    error_sizes, four_digits, in_bursts, mirror, models, sensor_lines, sizes, systematic, two_places,
    unexplained, unseen, unused, with_error,
};

/// The page of an estimate from the files `names`.
pub(super) fn estimated(
    e: &Estimate,
    record: &Record,
    motion: &[FittedMotion],
    (spans, read, as_read): Sources<'_>,
    names: &str,
    form: Form,
) -> String {
    let mut parts = answer(e, as_read);
    let sentences = attitudes::sentences(e, read);
    if !sentences.is_empty() {
        parts.push(Block::Heading("Attitudes".into()));
        parts.push(Block::List(sentences));
    }
    if !e.warnings.is_empty() {
        parts.push(Block::Heading("Warnings".into()));
        parts.push(Block::List(e.warnings.iter().map(ToString::to_string).collect()));
    }
    parts.extend(next(e));
    parts.extend(spans.parts());
    parts.extend(torques(e));
    parts.extend(of_models(e));
    parts.extend(sensor(e));
    parts.push(Block::Heading("Segments".into()));
    parts.extend(segments(e, record, motion));
    parts.extend(figures::motions(motion, record, read.is_some_and(|read| !read.poses.has_rates())));
    parts.extend(figures::residuals(e, motion, record));
    parts.push(figures::invariants(e, motion, record));
    parts.extend(spikes(e, record));
    let columns = unused(record);
    if !columns.is_empty() {
        parts.push(Block::Paragraph(format!("Columns not used: {}.", columns.join(", "))));
    }
    form.write(&format!("Inertia from {names}"), &parts)
}

/// The page of a refusal.
pub(super) fn refused(
    reason: &str,
    facts: Option<&Facts>,
    (record, as_read): (&Record, &AsRead),
    spans: &Spans,
    names: &str,
    form: Form,
) -> String {
    // what is open stands below
    let why = match facts.and_then(|facts| facts.rank) {
        Some(rank) => format!("the record determines {rank} of its 5 numbers"),
        None => reason.into(),
    };
    let mut parts = vec![Block::Verdict(Tone::Bad, format!("No inertia tensor: {why}."))];
    if let Some(facts) = facts {
        parts.push(Block::Heading("Known".into()));
        let known = if facts.known.is_empty() { vec!["nothing".into()] } else { facts.known.clone() };
        parts.push(Block::List(known));
        parts.push(Block::Heading("Undetermined".into()));
        parts.push(Block::List(facts.open.clone()));
        parts.push(Block::Heading("Next record".into()));
        parts.push(Block::List(vec![facts.next.clone()]));
    }
    parts.extend(read(as_read));
    parts.extend(spans.parts());
    parts.push(Block::Heading("Readings".into()));
    parts.extend(figures::readings(record));
    form.write(&format!("No inertia from {names}"), &parts)
}

/// How the files were read.
fn read(as_read: &AsRead) -> impl Iterator<Item = Block> {
    // names of files stay as they are
    let begun = |sentence: String| match sentence.strip_prefix("read:") {
        Some(rest) => format!("Read:{rest}"),
        None => sentence,
    };
    as_read.sentences().into_iter().map(move |sentence| Block::Paragraph(format!("{}.", begun(sentence))))
}

fn answer(e: &Estimate, as_read: &AsRead) -> Vec<Block> {
    let off = systematic(e);
    let row = |name: String, value: f64, sigma: f64, off: Option<f64>| {
        let places = digits(SURE * sigma);
        let number = |x: f64| format!("{x:.places$}");
        let off = off.map_or("–".into(), |off| format!("± {}", number(off)));
        vec![name, number(value), format!("± {}", number(SURE * sigma)), off]
    };
    let [a, b, c] = [0, 1, 2].map(|k| format!("{:.*}", digits(e.sigma_principal[k]).min(6), e.principal[k]));
    let head = ["", "value", "95 %, statistical", "systematic"].map(String::from).to_vec();
    let mut rows: Vec<Vec<String>> = (0..3)
        .map(|k| row(format!("I{}/trace", k + 1), e.principal[k], e.sigma_principal[k], off.map(|o| o[k])))
        .collect();
    for (k, name) in ["I1/I3", "I2/I3"].into_iter().enumerate() {
        let squares = sensor_lines(e).map(|line| line.ratios[k] * line.ratios[k]);
        let off = off.map(|_| squares.sum::<f64>().sqrt());
        rows.push(row(name.into(), e.ratios[k], e.sigma_ratios[k], off));
    }
    let (tone, against) = against(e.warnings.len());
    let mut parts = vec![
        Block::Verdict(tone, format!("I1 : I2 : I3 = {a} : {b} : {c}, as shares of the trace{against}.")),
        Block::Table(head, rows),
    ];
    if off.is_some() {
        parts.push(Block::Paragraph(format!("Systematic: if the sensor is off by {}.", sizes(e))));
    }
    let noise =
        if e.noise_sigma > 0.0 { format!(", noise {:.2e} rad/s", e.noise_sigma) } else { String::new() };
    let samples = counted(e.samples, "sample");
    let record = format!(
        "{samples} in {}, rate {} rad/s (rms){noise}",
        counted(e.segments, "segment"),
        four_digits(e.rms_rate)
    );
    parts.push(Block::Paragraph(format!("{record}.")));
    parts.extend(read(as_read));
    let facts = [unexplained(e), mirror(e), Some(unseen(e))].into_iter().flatten();
    parts.extend(facts.map(|fact| Block::Paragraph(format!("{}.", capital(&fact)))));
    if let Some(prior) = e.prior {
        parts.push(Block::Paragraph(format!(
            "With a prior tensor; χ² of its distance from the record is {:.1} at {} degrees of freedom.",
            prior.chi2, prior.dof
        )));
        let rank = e.identifiability.rank;
        if rank < 5 {
            let text = format!(
                "The record alone determines {rank} of the 5 numbers of the shape, the prior the rest."
            );
            parts.push(Block::Paragraph(text));
        }
    }
    let axes = e.axes.to_rotation_matrix();
    let head = ["axis", "x", "y", "z", "turn about it"].map(String::from).to_vec();
    let rows = (0..3).map(|k| {
        let turn = e.sigma_axes[k].to_degrees();
        let turn = if turn < 90.0 { format!("± {turn:.*}°", digits(turn)) } else { "any".into() };
        let mut cells = vec![format!("{}", k + 1)];
        cells.extend(axes.matrix().column(k).iter().map(|v| minus(&component(*v))));
        cells.push(turn);
        cells
    });
    parts.push(Block::Table(head, rows.collect()));
    if let Some(inertia) = &e.inertia {
        parts.push(Block::Paragraph("Inertia tensor, kg m², sensor axes:".into()));
        let entries = inertia.tensor();
        let head = ["", "x", "y", "z"].map(String::from).to_vec();
        let row = |i: usize| {
            let mut cells = vec![["x", "y", "z"][i].to_string()];
            cells.extend((0..3).map(|k| minus(&format!("{:.6e}", entries[(i, k)]))));
            cells
        };
        parts.push(Block::Table(head, (0..3).map(row).collect()));
    }
    parts.extend(correlations(e));
    parts
}

/// How a verdict with so many warnings looks, and what it says of them.
pub(in crate::fit) fn against(warnings: usize) -> (Tone, String) {
    match warnings {
        0 => (Tone::Good, String::new()),
        count => (Tone::Doubtful, format!("; {}", counted(count, "warning"))),
    }
}

/// "1 sample", "2 samples".
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// With the sign of typography.
pub(in crate::fit) fn minus(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// With a capital letter first.
pub(in crate::fit) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn next(e: &Estimate) -> Vec<Block> {
    let steps: Vec<String> = e.next_steps().iter().map(ToString::to_string).collect();
    if steps.is_empty() {
        return Vec::new();
    }
    vec![Block::Heading("What to do next".into()), Block::List(steps)]
}

fn correlations(e: &Estimate) -> [Block; 2] {
    let head = core::iter::once("").chain(ENTRIES.map(|(name, ..)| name)).map(String::from).collect();
    let all = e.correlation();
    let rows = ENTRIES.iter().enumerate().map(|(k, (name, ..))| {
        let cells = all.row(k).iter().map(|c| minus(&two_places(*c))).collect::<Vec<_>>();
        core::iter::once(name.to_string()).chain(cells).collect()
    });
    let about = "Correlations of the entries of the tensor:".into();
    [Block::Paragraph(about), Block::Table(head, rows.collect())]
}

pub(in crate::fit) fn numbers(of: &[Nuisance]) -> Block {
    let head = ["", "value", "unit", "prior"].map(String::from).to_vec();
    let row = |n: &Nuisance| {
        let prior = n.prior.map_or("–".into(), |prior| format!("± {prior}"));
        vec![n.name.into(), with_error(n.value, n.sigma).replace("+-", "±"), n.unit.into(), prior]
    };
    Block::Table(head, of.iter().map(row).collect())
}

fn torques(e: &Estimate) -> Vec<Block> {
    if e.torque.coefficients.is_empty() {
        return Vec::new();
    }
    let mut parts = vec![Block::Heading("Torque".into())];
    let model = e.torque.model;
    parts.push(Block::Paragraph(match e.torque.gain {
        Some(gain) => format!("Model: {model}. It gains {gain:.1} in log-likelihood over none."),
        None => format!("Model: {model}."),
    }));
    parts.push(numbers(&e.torque.coefficients));
    if let Some(without) = e.torque.ratios_without {
        let head = ["", "with the torque", "without it"].map(String::from).to_vec();
        let row = |k: usize, name: &str| {
            let with = with_error(e.ratios[k], e.sigma_ratios[k]).replace("+-", "±");
            vec![name.to_string(), with, format!("{:.5}", without[k])]
        };
        parts.push(Block::Table(head, vec![row(0, "I1/I3"), row(1, "I2/I3")]));
    }
    parts
}

fn of_models(e: &Estimate) -> Vec<Block> {
    let rows = models(e);
    if rows.is_empty() {
        return Vec::new();
    }
    let cell = |cell: &String| minus(&cell.replace("+-", "±"));
    let rows = rows.iter().map(|row| row.iter().map(cell).collect()).collect();
    let mut blocks = vec![
        Block::Heading("Models of the torque".into()),
        Block::Paragraph(format!("{}:", capital(&about_models(e)))),
        Block::Table(MODELS.map(String::from).to_vec(), rows),
    ];
    blocks.extend(about_gains(e).iter().map(|said| Block::Paragraph(format!("{}.", capital(said)))));
    let sizes = error_sizes(e);
    if !sizes.is_empty() {
        blocks.push(Block::Paragraph(format!("Largest errors: {}.", sizes.join(", "))));
    }
    blocks
}

fn sensor(e: &Estimate) -> Vec<Block> {
    let mut parts = Vec::new();
    if !e.nuisances.is_empty() || !e.systematic.is_empty() {
        parts.push(Block::Heading("Sensor".into()));
    }
    if !e.nuisances.is_empty() {
        parts.push(numbers(&e.nuisances));
    }
    if !e.systematic.is_empty() {
        parts.push(Block::Paragraph(
            "Change of the moments, shares of the trace, with errors that the fit takes to be zero:".into(),
        ));
        let head = ["error", "size", "unit", "I1", "I2", "I3"].map(String::from).to_vec();
        let rows = e.systematic.iter().map(|line| {
            let mut cells = vec![line.name.to_string(), format!("{}", line.size), line.unit.to_string()];
            cells.extend(line.principal.iter().map(|x| minus(&format!("{x:.1e}"))));
            cells
        });
        parts.push(Block::Table(head, rows.collect()));
    }
    parts
}

fn segments(e: &Estimate, record: &Record, motion: &[FittedMotion]) -> [Block; 2] {
    let Segments { heads, legend, rows } = Segments::of(e);
    // of attitudes the motion is compared with rates that nobody has measured
    let has_rms = e.attitudes.is_none();
    let rms = ["rms (rad/s)"].into_iter().filter(|_| has_rms);
    let names = ["segment", "from (s)", "to (s)"].into_iter().chain(rms).chain(heads);
    let rows = rows.into_iter().filter_map(|(segment, cells)| {
        let s = record.segments.get(segment)?;
        let left = motion.iter().find(|m| m.segment == segment).and_then(FittedMotion::rms);
        let left = left.map_or("–".into(), |rms| format!("{rms:.2e}"));
        let time = |t: Option<&f64>| t.map_or(String::new(), |t| format!("{t:.3}"));
        let own =
            [format!("{} {}", segment + 1, s.source()), time(s.times().first()), time(s.times().last())];
        let all = own.into_iter().chain([left].into_iter().filter(|_| has_rms)).chain(cells);
        Some(all.enumerate().map(|(k, cell)| if k > 0 { minus(&cell) } else { cell }).collect())
    });
    let table = Block::Table(names.map(String::from).collect(), rows.collect());
    [table, Block::Paragraph(format!("{}.", capital(legend)))]
}

fn spikes(e: &Estimate, record: &Record) -> Vec<Block> {
    if e.spikes.is_empty() {
        return Vec::new();
    }
    let line = |s: &polhode_fit::Spike| {
        let source = record.segments.get(s.segment).map_or("", |segment| segment.source());
        let burst = s.burst.map_or(String::new(), |k| format!(", burst {}", k + 1));
        format!("{source}, line {} ({:.4} s){burst}", s.line, s.time)
    };
    let shown = e.spikes.iter().take(50).map(line).collect();
    let bursts = in_bursts(&e.spikes).map_or(String::new(), |of_these| format!(", {of_these}"));
    let mut parts = vec![
        Block::Heading(format!("Spikes: {} left out{bursts}", counted(e.spikes.len(), "sample"))),
        Block::List(shown),
    ];
    if e.spikes.len() > 50 {
        parts.push(Block::Paragraph(format!("and {} more.", e.spikes.len() - 50)));
    }
    parts
}
