//! When something first happens to each member.

use std::borrow::Cow;

use polhode::events::Crossing;
use polhode::num::Dd;
use polhode::run::Ensemble;
use polhode_pages::table::{Cell, Column, Table};

use super::spec::{Motion, Spec, Watched};

/// Name of the table.
pub(super) const PASSAGES: &str = "passages";

/// Bytes that the passage of a member takes, from the search to the table.
pub(super) const BYTES: u64 = 512;

const HAPPENS: &str = "happens";
const AT_START: &str = "at start";
const NEVER: &str = "not by the last time";

/// The columns that are empty where it does not happen.
const NUMBERS: [(&str, &str, &str); 8] = [
    ("t", "s", "when it first happens"),
    ("q_w", "", "attitude then, body to space, scalar part"),
    ("q_x", "", "attitude then, x"),
    ("q_y", "", "attitude then, y"),
    ("q_z", "", "attitude then, z"),
    ("omega_body_x", "rad/s", "angular velocity then, body axis x"),
    ("omega_body_y", "rad/s", "angular velocity then, body axis y"),
    ("omega_body_z", "rad/s", "angular velocity then, body axis z"),
];

/// What is found of a member.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Passage {
    /// Its number, from 1.
    pub(super) member: u64,
    /// Whether it happens, or why that is not known.
    outcome: Cow<'static, str>,
    numbers: Option<[f64; 8]>,
}

/// The first passage of each member of `ensemble`, which are those of `spec` behind the first `before`.
pub(super) fn passages(spec: &Spec, watched: &Watched, ensemble: &Ensemble, before: u64) -> Vec<Passage> {
    let event = |body: &_| watched.event.made(body);
    let [start, last] = watched.span;
    let (origin, found) = match &spec.plan.motion {
        Motion::Exact { .. } => (start, ensemble.first(event, last - start, watched.spacing)),
        Motion::Stepped { method, clock, .. } => {
            (0.0, ensemble.first_by(method.as_ref(), *clock, event, last, watched.spacing))
        }
    };
    let of = |(k, found): (usize, Result<_, _>)| {
        let (outcome, numbers) = match found {
            Ok(None) => (NEVER.into(), None),
            Err(error) => (format!("{error}").into(), None),
            Ok(Some(one)) => {
                let one: polhode::events::Occurrence = one;
                let [w, x, y, z] = one.state.attitude.components();
                let numbers = ensemble.body(k).map(|body| {
                    let omega = body.omega_body(&one.state);
                    [(Dd::from(origin) + one.time).hi(), w, x, y, z, omega.x, omega.y, omega.z]
                });
                (if one.crossing == Crossing::AtStart { AT_START } else { HAPPENS }.into(), numbers)
            }
        };
        Passage { member: before + k as u64 + 1, outcome, numbers }
    };
    found.into_iter().enumerate().map(of).collect()
}

/// A row a member.
pub(super) fn table(passages: &[Passage]) -> Table {
    let mut columns = vec![
        Column::new("member", "", "its number, from 1"),
        Column::new("outcome", "", "whether the event happens, or why that is not known"),
    ];
    columns.extend(NUMBERS.map(|(name, unit, meaning)| Column::new(name, unit, meaning)));
    let mut table = Table::new(PASSAGES, "When the event first happens to each member.", columns);
    for passage in passages {
        let mut cells = vec![Cell::from(passage.member), Cell::from(&*passage.outcome)];
        cells.extend((0..NUMBERS.len()).map(|k| Cell::from(passage.numbers.map(|numbers| numbers[k]))));
        table.push(cells);
    }
    table
}

impl Passage {
    /// Why it is not known whether the event happens, if it is not.
    pub(super) fn unknown(&self) -> Option<&str> {
        (self.numbers.is_none() && self.outcome != NEVER).then_some(&*self.outcome)
    }

    /// Of the cells of a row.
    pub(super) fn parsed(row: &csv::StringRecord) -> Option<Self> {
        let cells: Vec<&str> = row.iter().collect();
        let [member, outcome, numbers @ ..] = &cells[..] else { return None };
        let is_empty = numbers.iter().all(|cell| cell.is_empty());
        let parsed =
            || numbers.iter().map(|cell| cell.parse().ok()).collect::<Option<Vec<f64>>>()?.try_into().ok();
        let numbers = if is_empty && numbers.len() == NUMBERS.len() { None } else { Some(parsed()?) };
        Some(Self { member: member.parse().ok()?, outcome: outcome.to_string().into(), numbers })
    }
}

/// To how many members it happens by the time `last`, s, and when.
pub(super) fn sentence(passages: &[Passage], event: &str, last: f64) -> String {
    let mut times: Vec<f64> = passages.iter().filter_map(|one| Some(one.numbers?[0])).collect();
    times.sort_by(f64::total_cmp);
    let members = passages.len();
    let mut said = format!("{event}: happens to {} of {members} members by t = {last} s", times.len());
    // the time by which it has happened to so much of all members
    for percent in [5, 50, 95] {
        if let Some(t) = times.get((percent * members).div_ceil(100).saturating_sub(1)) {
            said += &format!(", to {percent} % by {t:.6} s");
        }
    }
    let unknown = passages.iter().filter(|one| one.unknown().is_some()).count();
    if unknown > 0 {
        said += &format!("; not known for {unknown}");
    }
    said + ".\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_is_told_apart_from_what_does_not_happen() {
        let one = |outcome: &'static str, numbers: Option<[f64; 8]>| Passage {
            member: 1,
            outcome: outcome.into(),
            numbers,
        };
        let mut passages = vec![one(HAPPENS, Some([2.0; 8])), one(NEVER, None)];
        let known = "flip: happens to 1 of 2 members by t = 9 s, to 5 % by 2.000000 s, to 50 % by 2.000000 s";
        assert_eq!(sentence(&passages, "flip", 9.0), format!("{known}.\n"));
        passages.push(one("too many looks", None));
        let unknown = "flip: happens to 1 of 3 members by t = 9 s, to 5 % by 2.000000 s; not known for 1";
        assert_eq!(sentence(&passages, "flip", 9.0), format!("{unknown}.\n"));
        assert_eq!(passages[2].unknown(), Some("too many looks"));
    }
}
