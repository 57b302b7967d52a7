//! `propagate --event`: when something happens.

use polhode::body::{Body, Clock, Point, Time};
use polhode::events::{Crossing, Event, EventError, Events};
use polhode::num::Dd;
use polhode::run::{RunError, Watch};
use polhode_files::error::{Error, tell};
use polhode_pages::table::{Cell, Column, RowWriter, Table};

use super::columns::{Columns, Reading};
use super::{Propagate, run_of};
use crate::cost;
use crate::flags::event::spacing;

impl Propagate {
    /// Writes a row of each event, by time.
    pub(super) fn look_for_events(&self, body: &Body) -> Result<(), Error> {
        let columns = Columns::of_states(&self.fields, self.asked()?, body)?;
        let [from, to] = self.times.span()?;
        let start = self.motion.start(body, from)?;
        if !(to > from && (to - from).is_finite()) {
            let rule = format!("does not come after the start, {from:?} s");
            return Err(Error::input("--until", &format!("{to:?}"), &rule, "give a later time"));
        }
        self.compare_epoch();
        let events = self.events.iter().map(|typed| {
            let event = typed.of(body)?;
            Ok(if self.stop { event.stopping() } else { event })
        });
        let events: Vec<Event> = events.collect::<Result<_, Error>>()?;
        let spacing = self.spacing(body, &start, to - from)?;
        let (found, ended) = if self.method == "exact" {
            let motion = self.exact_motion(body, start)?;
            let (found, ended) = motion.events_so_far(&events, 0.0, to - from, spacing);
            (found, ended.map_err(|error| self.search_ended(error.into())))
        } else {
            self.along_run(body, start, &events, [from, to, spacing])?
        };
        if found.found.is_empty() && matches!(ended, Err(Error::Input(_))) {
            return ended;
        }
        let origin = if self.method == "exact" { from } else { 0.0 };
        self.write_events(body, &columns, &found, Dd::from(origin))?;
        self.tell_of_events(&found);
        if found.found.is_empty() && ended.is_ok() {
            tell("note", &format!("none of the events happens from {from} s to {to} s"));
        }
        ended
    }

    /// Time between looks, s.
    fn spacing(&self, body: &Body, start: &Point<Dd>, whole: f64) -> Result<f64, Error> {
        match self.times.every() {
            Some(every) if every > 0.0 => Ok(every),
            Some(every) => Err(Error::input(
                "--every",
                &format!("{every:?}"),
                "the time between looks must be positive",
                "give a positive one",
            )),
            None => Ok(spacing(body.omega_of(start).norm(), whole)),
        }
    }

    /// What happens along the run, and whether it comes to its end by numbers of a rotation.
    fn along_run(
        &self,
        body: &Body,
        start: Point<Dd>,
        events: &[Event],
        [from, to, spacing]: [f64; 3],
    ) -> Result<(Events, Result<(), Error>), Error> {
        let method = self.stepping_method()?;
        let h = self.step_or(method.tolerance().map(|_| spacing))?;
        let steps = (to - from) / h;
        cost::check("--step", h, steps, "use a larger step or an earlier time")?;
        if method.tolerance().is_none() {
            cost::warn_coarse("--step", h, body.omega_of(&start).norm());
        }
        let clock = Clock { start: from, step: h };
        cost::announce(method.as_ref(), body, start.to_f64(), clock, steps as u64);
        let mut run = run_of(method.as_ref(), body, start, clock)?.watching(Watch::Never);
        let (found, ended) = run.events_so_far(events, to, spacing);
        let ended = ended.map_err(|error| self.search_ended(error));
        let ended = ended.and_then(|()| self.check_sense(&run.sample()));
        Ok((found, ended))
    }

    /// Why a search cannot go on.
    fn search_ended(&self, error: RunError) -> Error {
        match error {
            // it is of the motion that was found
            RunError::Event(error @ (EventError::NotANumber { .. } | EventError::NotContinuous { .. })) => {
                Error::Failed(format!("--method {}: {error}", self.method))
            }
            RunError::Event(error) => Error::Input(format!("{}: {error}", flag_of(&error))),
            error => self.ended(error),
        }
    }

    /// A row of each, whose times count from `origin`.
    fn write_events(&self, body: &Body, columns: &Columns, found: &Events, origin: Dd) -> Result<(), Error> {
        let mut all = vec![Column::new("event", "", "what happens")];
        all.extend(columns.columns());
        let table = Table::new("events", "When something happens.", all);
        let mut rows = RowWriter::new(table, self.format, self.out.as_deref(), Some(found.found.len()))?;
        for one in &found.found {
            let point = body.enter(&one.state).map_err(|error| Error::Failed(error.to_string()))?.to_f64();
            let reading = Reading {
                state: one.state,
                omega: body.omega_body(&one.state),
                at: Time::from_dd(origin + one.time),
                point: &point,
                worst: None,
                attitude_error: None,
            };
            let mut cells = vec![Cell::from(self.events[one.event].text())];
            cells.extend(columns.cells(body, &reading));
            rows.push(cells)?;
        }
        rows.finish()
    }

    /// What the rows do not say.
    fn tell_of_events(&self, found: &Events) {
        for one in found.found.iter().filter(|one| one.crossing == Crossing::AtStart) {
            tell("note", &format!("{}: already true at the start", self.events[one.event].text()));
        }
        for &event in &found.may_miss {
            tell(
                "note",
                &format!(
                    "{}: what begins and ends within {} s may be missed; --every sets the time between looks",
                    self.events[event].text(),
                    found.spacing
                ),
            );
        }
    }
}

/// The flag that an error of the search is about.
fn flag_of(error: &EventError) -> &'static str {
    match error {
        EventError::Spacing { .. } | EventError::TooMany { .. } => "--every",
        EventError::Time(_) | EventError::NotAscending { .. } => "--until",
        _ => "--event",
    }
}
