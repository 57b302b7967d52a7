//! What is looked for along the motion of each member.

use polhode_files::error::Error;
use polhode_files::toml_file::Section;

use super::{Motion, Spec};
use crate::flags::event::{FORMS, TypedEvent, event, spacing};

/// An event, the first of which is looked for along the motion of each member.
#[derive(Clone, Debug)]
pub(in crate::ensemble) struct Watched {
    pub(in crate::ensemble) event: TypedEvent,
    /// From the start to the last time, s.
    pub(in crate::ensemble) span: [f64; 2],
    /// Time between looks, s.
    pub(in crate::ensemble) spacing: f64,
    /// Whether what begins and ends between two looks may be missed.
    pub(in crate::ensemble) may_miss: bool,
}

impl Watched {
    pub(super) fn read(event_of: &Section<'_>, spec: &Spec) -> Result<Option<Self>, Error> {
        event_of.only("[event]", &["first", "every"])?;
        if event_of.keys.is_empty() {
            return Ok(None);
        }
        let refused = |error: &dyn std::fmt::Display| event_of.at("first", &error.to_string());
        let missing = || refused(&format!("missing in [event]; {FORMS}"));
        let typed = event(event_of.text("first")?.ok_or_else(missing)?).map_err(|error| refused(&error))?;
        let start = spec.plan.start;
        let last = spec.plan.times.iter().fold(start, |last, t| t.max(last));
        if last == start {
            return Err(refused(&"is looked for up to the last time in [run], which is not after the start"));
        }
        // what is wrong with it is wrong for every member
        let member = spec.member(0).map_err(|error| refused(&error))?;
        let body = spec.acting.of_start(member.inertia, start, member.omega_body);
        let body = body.map_err(|error| refused(&error))?;
        let bounded = typed.made(&body).map_err(|error| refused(&error))?.is_bounded();
        let every = event_of.seconds("every")?;
        if every.is_some_and(|every| every <= 0.0) {
            return Err(event_of.at("every", "the time between looks must be positive"));
        }
        let spacing = every.unwrap_or_else(|| spacing(member.omega_body.norm(), last - start));
        let (spacing, may_miss) = match &spec.plan.motion {
            Motion::Exact { .. } => (spacing, !bounded),
            // along a run each step is looked at
            Motion::Stepped { clock, .. } => (spacing.min(clock.step), true),
        };
        Ok(Some(Self { event: typed, span: [start, last], spacing, may_miss }))
    }
}
