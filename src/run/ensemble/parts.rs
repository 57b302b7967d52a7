//! Members part by part, on one thread or several, and their rows in order.

use core::ops::Range;

use super::{Ensemble, Rows};

/// Most members of a part. Enough to fill blocks of lanes although members are sorted into kinds first.
const MOST: usize = 8192;

/// Rows of a part of exact motion: some 1.3 MB, which stay in the cache until they are read.
const EXACT_ROWS: usize = 1 << 14;

/// Rows of a part of steps: 21 MB, a few hundred members at a thousand times.
const STEPPED_ROWS: usize = 1 << 18;

/// Parts of exact motion at `times` times.
pub(super) fn of_exact(members: usize, times: usize) -> Vec<Range<usize>> {
    divided(members, EXACT_ROWS / times.max(1))
}

/// Parts of steps that are read `times` times.
pub(super) fn of_stepped(members: usize, times: usize) -> Vec<Range<usize>> {
    divided(members, STEPPED_ROWS / times.max(1))
}

fn divided(members: usize, size: usize) -> Vec<Range<usize>> {
    let size = size.clamp(64, MOST);
    (0..members).step_by(size).map(|first| first..members.min(first + size)).collect()
}

impl Ensemble {
    /// Takes `rows` of every part to `each`, in order.
    #[cfg(not(feature = "parallel"))]
    pub(super) fn in_parts<E>(
        &self,
        parts: Vec<Range<usize>>,
        rows: impl Fn(Range<usize>) -> Rows + Sync,
        each: &mut impl FnMut(&Rows) -> Result<(), E>,
    ) -> Result<(), E> {
        parts.into_iter().try_for_each(|part| each(&rows(part)))
    }

    /// Takes `rows` of every part to `each`, in order. Where the system refuses so many threads the calling one does all.
    #[cfg(feature = "parallel")]
    pub(super) fn in_parts<E>(
        &self,
        parts: Vec<Range<usize>>,
        rows: impl Fn(Range<usize>) -> Rows + Sync,
        each: &mut impl FnMut(&Rows) -> Result<(), E>,
    ) -> Result<(), E> {
        let pool = match self.threads {
            1 => None,
            threads => rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok(),
        };
        let Some(pool) = pool.filter(|_| parts.len() > 1) else {
            return parts.into_iter().try_for_each(|part| each(&rows(part)));
        };
        // parts that are worked on or wait to be read: enough that no thread waits, and few enough to bound the memory
        let ahead = 2 * pool.current_num_threads();
        let rows = &rows;
        pool.in_place_scope(|scope| {
            let begin = |part: Range<usize>| {
                let (done, result) = std::sync::mpsc::sync_channel(1);
                // nobody waits for it any more where `each` has failed
                scope.spawn(move |_| drop(done.send(rows(part))));
                result
            };
            let mut parts = parts.into_iter();
            let mut begun: std::collections::VecDeque<_> = parts.by_ref().take(ahead).map(begin).collect();
            while let Some(result) = begun.pop_front() {
                // an error only where the thread has panicked, which the scope then does too
                let Ok(rows) = result.recv() else { break };
                begun.extend(parts.next().map(begin));
                each(&rows)?;
            }
            Ok(())
        })
    }
}
