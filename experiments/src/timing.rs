//! Processor time of a step, beside that of a step of the classical Runge–Kutta method in the same moments; and the time of any work.

use std::time::Instant;

use polhode::body::{Body, Clock, Point};
use polhode::method::{AnyMethod, Step, method};
use polhode::truth::Truth;
use polhode_files::error::{Error, unexpected};

/// Bursts of each; the least counts, because whatever else the machine does only adds.
const BURSTS: u32 = 9;

/// Length of a burst, s.
const BURST: f64 = 2e-4;

/// Processor time of one step, beside that of `rk4` in the same moments.
#[derive(Clone, Copy, Debug)]
pub struct StepTime {
    /// Of the method, s.
    pub seconds: f64,
    /// Of `rk4` on the same body, s.
    pub rk4: f64,
}

impl StepTime {
    /// Of `timed` with the steps of `clock`, in bursts that alternate with those of `rk4`.
    ///
    /// # Errors
    /// A body or a step that the method is not for.
    pub fn measure(
        timed: &dyn AnyMethod,
        body: &Body,
        start: Point<f64>,
        clock: Clock,
    ) -> Result<Self, Error> {
        // by its name as the other: the same machine code, whichever crate compiles it
        let unit = method("rk4").map_err(unexpected)?;
        let prepared = |method: &dyn AnyMethod| method.prepare_f64(clock, body).map_err(unexpected);
        let mut contestants =
            [Contestant::new(prepared(timed)?, start), Contestant::new(prepared(unit.as_ref())?, start)];
        for _ in 0..BURSTS {
            contestants.iter_mut().for_each(Contestant::burst);
        }
        let [seconds, rk4] = contestants.map(|contestant| contestant.least);
        Ok(StepTime { seconds, rk4 })
    }

    /// Of `timed` on the body of `truth` from its start, by steps of `step` s; of a method that chooses its steps, an interval of
    /// output.
    ///
    /// # Errors
    /// As [`measure`](Self::measure).
    pub fn of(timed: &dyn AnyMethod, truth: &Truth, step: f64) -> Result<Self, Error> {
        let clock = Clock { start: truth.start_time(), step };
        StepTime::measure(timed, truth.body(), truth.start(), clock)
    }
}

/// The least time of `repeat` runs of `work`, s.
pub(crate) fn best(repeat: usize, work: &dyn Fn()) -> f64 {
    let one = || {
        let clock = Instant::now();
        work();
        clock.elapsed().as_secs_f64()
    };
    (0..repeat).map(|_| one()).fold(f64::INFINITY, f64::min)
}

/// Makes sure that the value is worked out.
pub(crate) fn discard<T>(value: T) {
    let _ = std::hint::black_box(value);
}

struct Contestant {
    step: Box<dyn Step<f64>>,
    /// In the form in which the step moves it, and what the step then remembers.
    start: Point<f64>,
    memory: Vec<f64>,
    steps: u64,
    least: f64,
}

impl Contestant {
    /// With as many steps in a burst as fill its time.
    fn new(mut step: Box<dyn Step<f64>>, mut start: Point<f64>) -> Self {
        step.open(&mut start);
        let memory = step.memory();
        let mut contestant = Contestant { step, start, memory, steps: 1, least: f64::INFINITY };
        for _ in 0..3 {
            contestant.least = f64::INFINITY;
            contestant.burst();
            let wanted = BURST / contestant.least.max(1e-9);
            contestant.steps = (wanted as u64).clamp(1, 16 * contestant.steps);
        }
        contestant
    }

    fn burst(&mut self) {
        let mut x = self.start;
        self.step.remember(&self.memory);
        let clock = Instant::now();
        self.step.advance(&mut x, self.steps);
        self.least = self.least.min(clock.elapsed().as_secs_f64() / self.steps as f64);
    }
}
