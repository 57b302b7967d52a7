//! The answer: a method with its setting, and what it is expected to do.

/// What is set for a method.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Setting {
    /// Nothing: the closed form.
    Nothing,
    /// The step, s.
    Step(f64),
    /// The tolerance of a method that chooses its steps, with the interval of its output, s.
    Tolerance {
        /// Relative to the state.
        tolerance: f64,
        /// s.
        step: f64,
    },
}

/// A predicted quantity, and by which factor it may be wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Predicted {
    /// The quantity.
    pub value: f64,
    /// Between `value / factor` and `value · factor`.
    pub factor: f64,
}

/// A method with its setting, and what it is expected to do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Choice {
    /// Name of the method, as [`method()`](crate::method()) takes it; of a method that takes a tolerance without it.
    pub method: String,
    /// Step or tolerance.
    pub setting: Setting,
    /// Steps in all, of a method with a fixed step.
    pub steps: Option<u64>,
    /// Largest attitude error up to the end, rad.
    pub attitude_error: Predicted,
    /// Largest relative energy error up to the end; `None` where energy is not conserved.
    pub energy_error: Option<f64>,
    /// Processor time on this machine, s, with what a method works out before its first step.
    pub seconds: Predicted,
    /// Whether the runs behind the prediction went as far as the whole time.
    pub whole_time: bool,
}

/// The best choice, and those that were not taken.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Advice {
    /// The quickest that meets the demand.
    pub best: Choice,
    /// The others that meet it, the quicker first. The first few were run as far as the best; of the rest times and errors are
    /// those of a first short run.
    pub others: Vec<Choice>,
    /// Methods that meet the demand at no setting that was tried, or in more than thirty times the time of the quickest, with
    /// the attitude error of the run that came nearest to the demand, rad.
    pub unfit: Vec<(String, Option<f64>)>,
    /// How far a start with other last digits is away at the end, rad.
    pub conditioning: f64,
    /// When the torque first jumps, s since the start, where two runs parted there: settings hold for this run alone.
    pub jump: Option<f64>,
}
