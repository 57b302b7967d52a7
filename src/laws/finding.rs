//! One line of a report.

use super::words::{Law, Quantity, Verdict, word_of};
use crate::body::Problem;
use crate::num::Shown;
use crate::observe::Drift;

/// One law of one quantity in one kind of motion: what was claimed, what was measured, and whether the claim holds.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
#[non_exhaustive]
pub struct Finding {
    /// The kind of motion.
    pub problem: Problem,
    /// The law.
    pub law: Law,
    /// Of what.
    pub quantity: Quantity,
    /// The claim in words: `2` of an order, `kept`, `no`.
    pub claim: String,
    /// The measured number: an order, a relative error or defect, a secular slope of a relative error in 1/s, a count, a time
    /// in s.
    pub measured: Option<f64>,
    /// Half of the interval of that number, where it is a mean or a slope; of an order how far the halvings are apart.
    pub half_width: Option<f64>,
    /// What the number was compared with: the largest difference from the claimed one, or the largest error of a law that holds.
    pub limit: Option<f64>,
    /// The secular slope of the error, 1/s, with its interval of 95 %, where the number is the largest error of a series.
    pub drift: Option<Drift>,
    /// Whether the claim holds.
    pub verdict: Verdict,
    /// Why nothing is decided, or what else there is to say; empty where the numbers say all.
    pub why: String,
}

impl Finding {
    /// Nothing measured yet, nothing decided.
    pub(super) fn new(problem: Problem, law: Law, quantity: Quantity, claim: impl Into<String>) -> Self {
        Finding {
            problem,
            law,
            quantity,
            claim: claim.into(),
            measured: None,
            half_width: None,
            limit: None,
            drift: None,
            verdict: Verdict::Undecided,
            why: String::new(),
        }
    }

    /// With the number `measured`, and the verdict where the law holds below `holds` and is seen to be broken above `broken`.
    pub(super) fn judged(self, claimed: bool, measured: f64, holds: f64, broken: f64) -> Self {
        let (verdict, why) = match () {
            _ if measured < holds && claimed => (Verdict::Holds, ""),
            _ if claimed && measured.is_nan() => (Verdict::False, NOT_FINITE),
            _ if claimed => (Verdict::False, ""),
            _ if measured < holds => (Verdict::Unclaimed, ""),
            _ if measured > broken => (Verdict::Holds, ""),
            _ if measured.is_nan() => (Verdict::Undecided, NOT_FINITE),
            _ => (Verdict::Undecided, "the loss is too small to tell from zero"),
        };
        Finding { measured: number(measured), limit: Some(holds), verdict, ..self }.because(why)
    }

    /// With the verdict of `claimed == counted`.
    pub(super) fn counted(self, claimed: u32, counted: u64) -> Self {
        let verdict = if u64::from(claimed) == counted { Verdict::Holds } else { Verdict::False };
        Finding { measured: Some(counted as f64), limit: Some(0.0), verdict, ..self }
    }

    /// With a verdict.
    pub(super) fn verdict(self, verdict: Verdict) -> Self {
        Finding { verdict, ..self }
    }

    /// With a reason, on one line.
    pub(super) fn because(self, why: impl AsRef<str>) -> Self {
        Finding { why: one_line(why.as_ref()), ..self }
    }

    /// The word of the kind of motion: `free`, `gravity`, `potential`, `torque`, `wheels` or `wheels+U`.
    #[must_use]
    pub fn motion(&self) -> &'static str {
        word_of(self.problem)
    }

    /// The finding in words, as in `free, order, attitude: claimed 4, measured 2`.
    #[must_use]
    pub fn sentence(&self) -> String {
        let mut words = format!("{}, {}, {}: claimed {}", self.motion(), self.law, self.quantity, self.claim);
        if let Some(measured) = self.measured {
            words += &format!(", measured {}", short(measured));
        }
        if let Some(half_width) = self.half_width {
            words += &format!(" ± {}", short(half_width));
        }
        match (self.limit, self.verdict) {
            (Some(limit), Verdict::False) if limit != 0.0 => words += &format!(", limit {}", short(limit)),
            _ => {}
        }
        if !self.why.is_empty() {
            words += &format!(" ({})", self.why);
        }
        words
    }
}

/// `x`, if it is a number.
pub(super) fn number(x: f64) -> Option<f64> {
    Some(x).filter(|x| !x.is_nan())
}

/// What is said of numbers that are none.
pub(super) const NOT_FINITE: &str = "the numbers are not finite";

/// The words of yes and no.
pub(super) fn yes(claimed: bool) -> &'static str {
    if claimed { "yes" } else { "no" }
}

/// `text` without line breaks and tabs.
pub(super) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// A number of a report in few digits.
pub(super) fn short(x: f64) -> String {
    let plain = x == 0.0 || !x.is_finite() || (0.01..1e5).contains(&x.abs());
    match plain {
        true if x.fract() == 0.0 => Shown(x).to_string(),
        true => format!("{x:.3}"),
        false => format!("{x:.1e}"),
    }
}
