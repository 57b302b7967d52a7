//! Two passes over the same times, one beside the other.

use std::sync::mpsc;
use std::thread;

/// Looks that the second pass may be ahead.
const AHEAD: usize = 4;

/// What the passes `pass(0)` and `pass(1)` give at each of `times`, in pairs, as long as `each` wants more. The second is taken on a
/// thread of its own, where the system grants one.
pub(super) fn together<T, E, P>(
    times: &[f64],
    pass: impl Fn(usize) -> P,
    mut each: impl FnMut(T, T) -> bool,
) -> Result<(), E>
where
    T: Send,
    E: Send,
    P: FnMut(&f64) -> Result<T, E> + Send,
{
    thread::scope(|scope| {
        let (send, sent) = mpsc::sync_channel(AHEAD);
        let second = pass(1);
        let spawned = thread::Builder::new().spawn_scoped(scope, move || {
            // nobody receives any more once the first has ended
            let _ = times.iter().map(second).all(|look| send.send(look).is_ok());
        });
        let second: Box<dyn Iterator<Item = Result<T, E>>> = match spawned {
            Ok(_) => Box::new(sent.into_iter()),
            Err(_) => Box::new(times.iter().map(pass(1))),
        };
        for (one, other) in times.iter().map(pass(0)).zip(second) {
            if !each(one?, other?) {
                break;
            }
        }
        Ok(())
    })
}
