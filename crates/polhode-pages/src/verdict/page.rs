//! Verdicts as one page that needs no other file.

use crate::document::{Block, Form, Tone};
use polhode::audit::Judgement;
use polhode_files::text::short;

use super::figure::panels;
use super::outcome::{Outcome, named, sentence};
use super::text::{attitude, causes};

/// The page of the record `name`.
pub fn page(name: &str, outcomes: &[Outcome], form: Form) -> String {
    let mut parts = Vec::new();
    for outcome in outcomes {
        if let Some(body) = &outcome.body {
            parts.push(Block::Heading(format!("Body {body}")));
        }
        parts.extend(one(outcome));
    }
    parts.push(Block::Heading("Errors against time".into()));
    let caption = "Energy and |m| as relative changes from the first row, the angle of L in space from its first direction, and \
                   the angle of the attitude from the motion; the axes are logarithmic, with positive values above the middle and negative ones below.";
    parts.push(Block::Figure(panels(name, outcomes).svg, caption.into()));
    form.write(&format!("Audit of {name}"), &parts)
}

fn one(outcome: &Outcome) -> Vec<Block> {
    let verdict = &outcome.verdict;
    let suspect =
        if outcome.is_suspected() { format!(" Suspect: {}.", outcome.suspect()) } else { String::new() };
    let tone = match outcome.judged() {
        Judgement::Right => Tone::Good,
        Judgement::Wrong => Tone::Bad,
        Judgement::Undecided => Tone::Doubtful,
    };
    let mut parts = vec![
        Block::Verdict(tone, format!("Verdict on {} rows: {}.{suspect}", outcome.rows, outcome.judgement())),
        Block::Paragraph(format!("Reading: {}.", outcome.reading())),
    ];
    if let Some(tie) = &verdict.tie {
        parts.push(Block::Paragraph(format!(
            "{} readings fit equally well: {}.",
            tie.readings.len(),
            tie.reason
        )));
        parts.push(Block::List(tie.readings.iter().map(ToString::to_string).collect()));
    }
    parts.extend(attitude(outcome).into_iter().map(Block::Paragraph));
    parts.extend(causes(outcome).into_iter().map(Block::Paragraph));
    let number = |x: f64| format!("{x:.1e}").replace('-', "\u{2212}");
    let optional = |x: Option<f64>| x.map_or("–".into(), number);
    let head = ["quantity", "largest relative change", "slope (1/s)", "±", "resolution", "conserved"];
    let rows = verdict.conservation.iter().map(|line| {
        vec![
            named(&line.quantity).1.into(),
            number(line.error),
            optional(line.drift.map(|drift| drift.slope)),
            optional(line.drift.map(|drift| drift.half_width)),
            number(line.resolution),
            if line.conserved { "yes" } else { "no" }.into(),
        ]
    });
    parts.push(Block::Table(head.map(String::from).to_vec(), rows.collect()));
    let tie = usize::from(verdict.tie.is_some());
    let warnings = outcome.warnings();
    let remarks: Vec<String> = warnings[..warnings.len() - tie].iter().map(|text| sentence(text)).collect();
    if !remarks.is_empty() {
        parts.push(Block::List(remarks));
    }
    parts.push(Block::Heading("Readings, the most likely first".into()));
    let head = ["reading", "log-likelihood ratio", "attitude defect (rad)", "rate defect"];
    let rows = verdict.ranking.iter().take(super::RANKED).map(|ranked| {
        vec![
            ranked.reading.to_string(),
            short((10.0 * ranked.log_likelihood_ratio).round() / 10.0),
            optional(ranked.attitude_defect),
            optional(ranked.rate_defect),
        ]
    });
    parts.push(Block::Table(head.map(String::from).to_vec(), rows.collect()));
    parts
}
