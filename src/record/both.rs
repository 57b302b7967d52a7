//! Two halves of a long computation side by side.

use std::sync::Mutex;
use std::thread::{Builder, scope};

/// Both results, the first by a thread of its own where the work is `long` and the system has one. What each computes does not depend
/// on that.
#[doc(hidden)]
pub fn both<A: Send, B>(long: bool, first: impl FnOnce() -> A + Send, second: impl FnOnce() -> B) -> (A, B) {
    if !long {
        return (first(), second());
    }
    // where there is no thread the work is still here
    let work = Mutex::new(Some(first));
    let take = || work.lock().ok().and_then(|mut work| work.take()).map(|first| first());
    scope(|threads| {
        let thread = Builder::new().spawn_scoped(threads, take);
        let second = second();
        let first = match thread.map(|thread| thread.join()) {
            Ok(Ok(first)) => first,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            Err(_) => take(),
        };
        // it is taken once
        first.map(|first| (first, second))
    })
    .unwrap_or_else(|| unreachable!("the work is taken by one of two"))
}

#[cfg(test)]
mod tests {
    use super::both;

    #[test]
    fn results_are_those_of_one_after_the_other() {
        let sum = |from: u64| (from..from + 1000).map(|k| k * k).sum::<u64>();
        assert_eq!(both(true, || sum(1), || sum(7)), (sum(1), sum(7)));
        assert_eq!(both(false, || sum(1), || sum(7)), (sum(1), sum(7)));
    }
}
