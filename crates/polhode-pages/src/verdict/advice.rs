//! What to do about a record that is wrong by its integrator: another method, from `advise`.

use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use crate::table::to_digits;
use nalgebra::{UnitQuaternion, Vector3};
use polhode::advise::{Choice, Demand, Setting, advise};
use polhode::audit::{Judgement, Suspect, Trajectory, Verdict};
use polhode::body::Problem;
use polhode_files::text::short;
use serde_json::{Value, json};

/// Longest thought about all bodies of a file.
const THOUGHT: Duration = Duration::from_secs(2);

/// Methods that a program with forces of its own cannot step by, or that choose their steps.
const EXCLUDED: [&str; 4] = ["exact", "taylor", "dop853", "tsit5"];

/// How long may still be thought.
#[derive(Debug)]
pub struct Adviser {
    until: Instant,
}

impl Default for Adviser {
    fn default() -> Self {
        Self::new()
    }
}

impl Adviser {
    /// Two seconds from now on.
    #[must_use]
    pub fn new() -> Self {
        Adviser { until: Instant::now() + THOUGHT }
    }

    /// The method that keeps the body of `record` within `tolerance` over its time; `None` where its integrator is not what is
    /// wrong, where no method does, or where that is not found in time.
    #[must_use]
    pub fn advice(&self, record: &Trajectory, verdict: &Verdict, tolerance: f64) -> Option<Choice> {
        if verdict.judgement != Judgement::Wrong || !matches!(verdict.suspect, Suspect::Integrator(_)) {
            return None;
        }
        let body = verdict.body.clone();
        let attitude = verdict.reading.attitude(record, 0);
        if attitude.is_none() && body.problem() != Problem::Free {
            return None;
        }
        let omega = verdict.reading.omega_body(record, 0)?;
        let attitude = attitude.map_or(UnitQuaternion::identity(), Into::into);
        let start = body.state(attitude, Vector3::from(omega)).ok()?;
        let (first, last) = (record.times.first()?, record.times.last()?);
        let mut demand = Demand::new(last - first, tolerance);
        demand.start_time = *first;
        demand.excluded = EXCLUDED.map(String::from).to_vec();
        let left = self.until.checked_duration_since(Instant::now())?;
        let (sender, receiver) = mpsc::channel();
        // a thought that takes longer ends with the process
        thread::Builder::new()
            .spawn(move || sender.send(advise(&body, &start, &demand).map(|advice| advice.best).ok()))
            .ok()?;
        receiver.recv_timeout(left).ok()?
    }
}

/// The advice in a sentence.
pub(super) fn sentence(choice: &Choice) -> String {
    let setting = match choice.setting {
        Setting::Step(step) => format!(", step {} s", to_digits(step, 6)),
        Setting::Tolerance { tolerance, .. } => format!(", tolerance {}", short(tolerance)),
        _ => String::new(),
    };
    format!(
        "Switch to {}{setting}: it is expected to stay within {:.1e} rad over the time of this record (polhode advise tells more).",
        choice.method, choice.attitude_error.value
    )
}

pub(super) fn object(choice: &Choice) -> Value {
    let (step, tolerance) = match choice.setting {
        Setting::Step(step) => (Some(step), None),
        Setting::Tolerance { tolerance, step } => (Some(step), Some(tolerance)),
        _ => (None, None),
    };
    json!({
        "method": choice.method, "step": step, "tolerance": tolerance, "predicted_error": choice.attitude_error.value,
        "predicted_cost": choice.seconds.value,
    })
}
