//! Members part by part, on one thread or several, and what is found of them in order.

use core::ops::Range;

use super::Ensemble;

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

/// Parts of members of which each is followed by itself, as long as it takes.
pub(super) fn of_single(members: usize) -> Vec<Range<usize>> {
    divided(members, 0)
}

fn divided(members: usize, size: usize) -> Vec<Range<usize>> {
    let size = size.clamp(64, MOST);
    (0..members).step_by(size).map(|first| first..members.min(first + size)).collect()
}

impl Ensemble {
    /// Takes what `work` makes of every part to `each`, in order.
    #[cfg(not(feature = "parallel"))]
    pub(super) fn in_parts<R, E>(
        &self,
        parts: Vec<Range<usize>>,
        work: impl Fn(Range<usize>) -> R + Sync,
        mut each: impl FnMut(R) -> Result<(), E>,
    ) -> Result<(), E> {
        parts.into_iter().try_for_each(|part| each(work(part)))
    }

    /// Takes what `work` makes of every part to `each`, in order. Where the system refuses so many threads the calling one does all.
    #[cfg(feature = "parallel")]
    pub(super) fn in_parts<R: Send, E>(
        &self,
        parts: Vec<Range<usize>>,
        work: impl Fn(Range<usize>) -> R + Sync,
        mut each: impl FnMut(R) -> Result<(), E>,
    ) -> Result<(), E> {
        let pool = match self.threads {
            1 => None,
            threads => rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok(),
        };
        let Some(pool) = pool.filter(|_| parts.len() > 1) else {
            return parts.into_iter().try_for_each(|part| each(work(part)));
        };
        // parts that are worked on or wait to be read: enough that no thread waits, and few enough to bound the memory
        let ahead = 2 * pool.current_num_threads();
        let work = &work;
        pool.in_place_scope(|scope| {
            let begin = |part: Range<usize>| {
                let (done, result) = std::sync::mpsc::sync_channel(1);
                // nobody waits for it any more where `each` has failed
                scope.spawn(move |_| drop(done.send(work(part))));
                result
            };
            let mut parts = parts.into_iter();
            let mut begun: std::collections::VecDeque<_> = parts.by_ref().take(ahead).map(begin).collect();
            while let Some(result) = begun.pop_front() {
                // an error only where the thread has panicked, which the scope then does too
                let Ok(done) = result.recv() else { break };
                begun.extend(parts.next().map(begin));
                each(done)?;
            }
            Ok(())
        })
    }
}
