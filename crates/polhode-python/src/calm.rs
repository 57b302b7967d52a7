//! Long work: the interpreter is free meanwhile, and Ctrl-C ends it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

use crate::error::refused;

/// How often Ctrl-C is looked for.
pub(crate) const LISTEN: Duration = Duration::from_millis(50);

/// What `work` returns, done on a thread of its own while this one listens for Ctrl-C. Work that is given up is told so by its flag, or
/// ends by itself.
pub(crate) fn aside<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    aside_telling(py, work, || Ok(()))
}

/// The same; `tell` is called now and then, and at the end, and what it raises ends the work too.
pub(crate) fn aside_telling<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
    tell: impl Fn() -> PyResult<()>,
) -> PyResult<T> {
    let (sender, mut receiver) = channel();
    let stop = Arc::new(AtomicBool::new(false));
    let told = Arc::clone(&stop);
    thread::Builder::new()
        .stack_size(8 << 20)
        .spawn(move || sender.send(work(&told)))
        .map_err(|error| refused(format!("the system gives no thread: {error}")))?;
    loop {
        let (found, again) = py.detach(move || (receiver.recv_timeout(LISTEN), receiver));
        receiver = again;
        match found {
            Ok(found) => return tell().map(|()| found),
            Err(RecvTimeoutError::Timeout) => {
                let heard = py.check_signals().and_then(|()| tell());
                heard.inspect_err(|_| stop.store(true, Ordering::Relaxed))?;
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(refused("the computation ended without a result; please report it"));
            }
        }
    }
}

/// The argument `name`, which is called as `form`.
pub(crate) fn called(name: &str, form: &str, value: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    if value.is_callable() {
        Ok(value.clone().unbind())
    } else {
        Err(refused(format!("{name}: {}; it must be a function, which is called as {form}", value.repr()?)))
    }
}

/// What is told how far long work is, for `pyo3`.
pub(crate) fn progress(value: &Bound<'_, PyAny>) -> PyResult<Option<Py<PyAny>>> {
    let form = "progress(stage, done, seconds)";
    (!value.is_none()).then(|| called("progress", form, value)).transpose()
}

/// Looks for Ctrl-C from time to time, in work that does not hold the interpreter, and tells how far that has come.
pub(crate) struct Listener {
    heard: Instant,
    /// Of what, to whom.
    progress: Option<(String, Py<PyAny>)>,
}

impl Listener {
    pub(crate) fn new() -> Self {
        Listener { heard: Instant::now(), progress: None }
    }

    /// One that calls `progress`, if there is one, as `progress(stage, done, seconds)`.
    pub(crate) fn telling(stage: &str, progress: Option<Py<PyAny>>) -> Self {
        Listener { progress: progress.map(|progress| (stage.into(), progress)), ..Listener::new() }
    }

    /// Tells that all is done.
    pub(crate) fn end(&self) -> PyResult<()> {
        let Some((stage, progress)) = &self.progress else { return Ok(()) };
        Python::attach(|py| progress.call1(py, (stage, 1.0, py.None())).map(drop))
    }

    /// `done`: the part of the work that is done.
    ///
    /// # Errors
    /// `KeyboardInterrupt`, and what else a handler of signals or the function that is told raises.
    pub(crate) fn listen(&mut self, done: f64) -> PyResult<()> {
        if self.heard.elapsed() < LISTEN {
            return Ok(());
        }
        self.heard = Instant::now();
        Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some((stage, progress)) => progress.call1(py, (stage, done, py.None())).map(drop),
                None => Ok(()),
            }
        })
    }
}
